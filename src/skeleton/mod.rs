//! Skeletons: joints with radii, each naming the joint that it grows from.
//!
//! A skeleton is what a plant is before it has a surface. Write one in code with [`Skeleton::builder`], or
//! load one with the asset server, which [`SkeletonPlugin`] teaches three kinds of file:
//!
//! | file | what it is | up | units |
//! |---|---|---|---|
//! | `*.skeleton.ron` | this crate's own, written by [`Skeleton::to_ron`] | y | metres |
//! | `*.swc` | points with radii, from tools that trace neurons and plants | y | any: [`SkeletonLoaderSettings::scale`] |
//! | `*.csv` | cylinders fitted to laser scans of trees, from TreeQSM and tools like it | z | metres |
//!
//! [`SkeletonLoaderSettings`] change what up and units are taken to be, widen radii of 0, and bring plants
//! in map coordinates near the origin. [`skeleton_from_bytes`] reads the same files without an asset server.
//!
//! A file that cannot be read gives a [`SkeletonFileError`] that names the file, the line or joint, and what
//! to do; so do joints in code, with a [`SkeletonError`]. No input makes reading panic or take memory out
//! of proportion to its size.
//!
//! # The `*.skeleton.ron` format
//!
//! ```ron
//! (
//!     joints: [
//!         (position: (0.0, 0.0, 0.0), radius: 0.2),
//!         (position: (0.0, 2.0, 0.0), radius: 0.15, parent: 0),
//!         (position: (0.5, 2.8, 0.0), radius: 0.08, parent: 1, twist: 0.5, texture_length: 0.4),
//!     ],
//! )
//! ```
//!
//! Joints are counted from 0, and have the fields of [`Joint`]: `position` and `radius` always, `parent`
//! unless they are roots, the others where they differ. A last field `offset: (x, y, z)` beside `joints` is
//! [`Skeleton::offset`].
//!
//! # `*.swc` files
//!
//! One sample a line, `id type x y z radius parent`, as R. C. Cannon et al. defined it (*An on-line archive
//! of reconstructed hippocampal neurons*, Journal of Neuroscience Methods 84, 1998) and NeuroMorpho.Org
//! uses it. Parent -1 is a root, and there may be several; lines come in any order, ids are any whole numbers,
//! `#` starts a comment. The type and columns after the seventh are not read.
//!
//! # `*.csv` files
//!
//! One cylinder a row, as TreeQSM (P. Raumonen et al., *Fast automatic precision tree models from terrestrial
//! laser scanner data*, Remote Sensing 5, 2013), SimpleForest and tools like them write it, separated by
//! commas, semicolons or tabs. Columns are found by name, case, punctuation and units in brackets aside:
//!
//! | what | names |
//! |---|---|
//! | start | `start_x`, `start_y`, `start_z`; also `start_1`, `start_point_x`, `sx`; or `start_point` for three columns |
//! | end, or | `end_x` and so on, in the same ways |
//! | axis and length | `axis_x` and so on, `axis_direction`; `length` |
//! | radius | `radius`, `r`; or `diameter`, which is halved |
//! | parent | `parent`, `parent_id`, `parent_cylinder`; -1, 0, nothing and `NA` are none, but 0 is an id if a row has it |
//! | id, if any | `id`, `cylinder_id`; without it parents are numbers of rows, counted from 1 |
//!
//! A cylinder's end becomes a joint of its radius. It grows from the end of the parent where its start is no
//! further from there than the larger of both radii. Else, as where a branch leaves the side of a trunk, its
//! start becomes a root: a segment from any joint of the parent would be wood that is not there. The cap of
//! such a root is hidden in the parent, and a tree may have many of them.
//!
//! # The files here, in reading order
//!
//! `joint`, `skeleton` (what is promised), `order` (parents first), `builder`; `document` (RON), `swc`,
//! `qsm` (CSV), with `settings`, `frame` (a file's coordinates), `text` (its encoding,
//! lines and numbers) and `file` (which of them); `error`; `asset` (all that knows Bevy's assets). Then plants:
//! `plant` (the component), `limb` (which child goes on), `pose` and `unfold` (two ways to bend), `roll` (what a
//! rotation does besides).

mod asset;
mod builder;
mod document;
mod error;
mod file;
mod frame;
mod joint;
mod limb;
mod order;
mod plant;
mod pose;
mod qsm;
mod roll;
mod settings;
#[expect(
    clippy::module_inception,
    reason = "the file of the type that the folder is named after"
)]
mod skeleton;
mod swc;
mod text;
mod unfold;

pub use asset::{SkeletonLoader, SkeletonPlugin};
pub use builder::SkeletonBuilder;
pub use error::{SkeletonError, SkeletonFileError, SkeletonFileErrorKind};
pub use file::skeleton_from_bytes;
pub use joint::{Joint, MAX_COORDINATE, MAX_RADIUS};
pub use limb::continuations;
pub use plant::{PlantPlugin, Skeleton3d};
pub use pose::{PosedJoints, SkeletonPose};
pub use settings::{Recentre, SkeletonLoaderSettings, UpAxis};
pub use skeleton::{MAX_JOINTS, Skeleton};
pub use text::MAX_FILE_BYTES;
pub use unfold::{SegmentEntities, SkeletonSegment, UnfoldSkeleton};

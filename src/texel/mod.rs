//! Texels: repeated cover on a surface, such as grass, fur, bushes or a far forest, from one small volume.
//!
//! The method is that of A. Meyer and F. Neyret, *Interactive Volumetric Textures*, Eurographics Workshop on
//! Rendering, 1998. A *reference volume* holds one repetitive detail in opaque or empty voxels. It is mapped over a
//! surface like a texture, (u, v) along it and w along *height vectors* at its vertices; each instance is a *texel*.
//! Volumes are seen as *slices*, textured polygons that are extruded from the surface's facets, along one of three
//! axes.
//!
//! What is here, in reading order:
//!
//! | file | question |
//! |---|---|
//! | `axis`, `volume` | what is a reference volume? (§2.1) |
//! | [`build`] | how is one made of triangles, heights, functions or images? (§3, appendix) |
//! | `topology` | may it be repeated? (§3, Figure 3) |
//! | `thickness` | e: how narrow are its contours? (§4.1, Figure 7) |
//! | `slice_sets` | its slices in three directions, in powers of two, with mip levels (§4.2, §4.3) |
//! | [`criteria`] | how many slices, and which? The formulas (§4.1 to §4.3) |
//! | [`facet`] | one triangle of the surface, the prism on it, and where slices cut it (§2.1, §4.2) |
//! | `choose` | direction and number for each facet of a view |
//! | `draw` | what the GPU draws: components, lists of slices, shaders (§2.2, §4, §5) |
//! | `bake` | light in the colours, as the paper has it, for comparison |
//! | [`mod@file`] | `*.texel.ron` and its images |
//!
//! [`TexelSurface`] on an entity with a mesh is all that a game needs. But for `draw`, all of it is plain mathematics, which
//! runs and is tested without a GPU. What else knows Bevy: `asset` (volumes as assets), and `from_mesh` (Bevy's meshes as
//! shapes).
//!
//! # Where this departs from the paper
//! * Volumes keep normals, so that the scene lights them; the paper bakes its light.
//! * Shapes are cut along all three axes and filled by flooding; the paper's cut from above with parity is
//!   [`Filling::Parity`](build::Filling::Parity), which says where it fails.
//! * Colour spreads in all directions, not within slices along w alone ([`Spreading`](build::Spreading)).
//! * e is measured, by what "narrowest" may mean for any contour; the paper leaves it to the user.
//! * Counts hold at the corners of a facet's prism; the paper takes angles at its centre, so that a large facet below the
//!   eye would be one slice.
//! * Where counts double slices move apart, and directions fade into one another, pixel by pixel; the paper's pop.
//! * The two slice counts, by depth and by distance, bound each other: the smaller will do.

mod asset;
mod axis;
mod bake;
pub mod build;
mod choose;
pub mod color;
pub mod criteria;
mod draw;
mod error;
pub mod facet;
pub mod file;
mod from_mesh;
mod parallel;
mod progress;
mod slice_sets;
mod thickness;
mod topology;
mod volume;

pub use asset::{TexelVolume, TexelVolumeLoader, TexelVolumePlugin};
pub use axis::SliceAxis;
pub use bake::BakedLight;
pub use choose::{
    AxisSlices, Choice, DirectionRule, DrawnSlices, TexelQuality, TexelView, VolumeMeasure, choose,
    choose_fading,
};
pub use draw::{
    ATTRIBUTE_HEIGHT_VECTOR, LiveTexels, MAX_SLICES, StrokedTexels, TexelBrush, TexelCycle,
    TexelHeights, TexelMaterial, TexelPlugin, TexelSettings, TexelSlices, TexelStats, TexelSurface,
    TexelSurfaceError,
};
pub use error::TexelError;
pub use from_mesh::ShapeMeshError;
pub use progress::{BuildStep, Progress, silent};
#[cfg(feature = "lab")]
pub(crate) use slice_sets::SliceBoxes;
pub use slice_sets::{SliceLevel, SliceSet, SliceSets};
pub use thickness::{MOST_PIXELS, Thickness};
pub use topology::{Topology, TopologyReport};
pub use volume::{MAX_SIDE, MAX_VOXELS, ReferenceVolume, VolumeParts};

//! Slicing: crowns of twigs and leaves as blended slices.

pub mod bake;
mod error;
mod limits;
pub mod octagon;
mod orientation;
mod pyramid;
#[expect(
    clippy::module_inception,
    reason = "the file of the type that the folder is named after"
)]
mod slicing;

pub use bake::{
    BakeError, BakeSettings, CrownMaterial, CrownMesh, CrownTexture, CrownTriangle, CrownVertex,
    Separation, bake, bake_with_progress, separate,
};
pub use error::{SlicingError, SlicingFileError, SlicingFileErrorKind};
pub use limits::{
    MAX_LAYERS, MAX_LEVELS, MAX_ORIENTATIONS, MAX_PIXELS, MAX_PIXELS_TOTAL, MAX_SLICES,
};
pub use octagon::Octagon;
pub use orientation::{Orientation, Orientations};
pub use slicing::{Slicing, SlicingShape};

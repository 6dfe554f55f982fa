//! Slicing: crowns of twigs and leaves as blended slices.

pub mod bake;
pub mod blend;
mod document;
mod error;
mod limits;
mod loader;
pub mod octagon;
mod orientation;
mod pyramid;
#[expect(
    clippy::module_inception,
    reason = "the file of the type that the folder is named after"
)]
mod slicing;
#[cfg(test)]
mod tests;

pub use bake::{
    BakeError, BakeSettings, CrownMaterial, CrownMesh, CrownTexture, CrownTriangle, CrownVertex,
    Separation, bake, bake_with_progress, separate,
};
pub use blend::{DrawnSlice, SliceOrder};
pub use document::{Picture, SlicingDocument, read_picture};
pub use error::{SlicingError, SlicingFileError, SlicingFileErrorKind};
pub use limits::{
    MAX_LAYERS, MAX_LEVELS, MAX_ORIENTATIONS, MAX_PIXELS, MAX_PIXELS_TOTAL, MAX_SLICES,
};
pub use loader::SlicingLoader;
pub use octagon::Octagon;
pub use orientation::{Orientation, Orientations};
pub use slicing::{Slicing, SlicingShape};

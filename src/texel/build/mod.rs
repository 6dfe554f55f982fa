//! Building a reference volume (§3 and the appendix).
//!
//! | from | how | needs filling |
//! |---|---|---|
//! | [`from_shape`]: triangles with paint | cut into slices (`rasterise`, §3.1) | yes, unless it is sparse foliage |
//! | [`from_height_field`]: an image of heights | one voxel a column (§3.3) | yes, downwards |
//! | [`from_implicit`]: a function that is greater than one inside | evaluated at every voxel (§3.3) | no |
//! | [`from_hypertexture`]: density and colour of every point | the same | no |
//! | [`from_images`]: a stack of pictures | as they are | no |
//!
//! A surface in slices is but a contour in each, and filling makes solids of them:
//!
//! 1. The inside is marked (`inside`): by the parity of crossings in a column as in the appendix, or by flooding what
//!    is outside, which also works on shapes where parity fails.
//! 2. Contours are closed where the surface jumps over slices (`close`, appendix).
//! 3. Colours and normals spread inward by averages of what is already coloured, in a separate buffer (`spread`, §3.2).
//!
//! All of it is done in `draft`, a volume whose voxels are still linear colours and marks. The result
//! does not depend on the number of cores, to the last byte.

mod close;
mod draft;
mod edges;
mod field;
mod height_field;
mod images;
mod inside;
mod paint;
mod rasterise;
mod shape;
mod spread;
#[cfg(test)]
mod tests;

use super::topology::TopologyReport;
use super::volume::ReferenceVolume;

pub use field::{from_hypertexture, from_implicit};
pub use height_field::{HeightField, from_height_field};
pub use images::{StackImage, from_images};
pub use paint::{Paint, PaintTexture};
pub use shape::{Filling, Shape, ShapeSettings, from_shape};
pub use spread::Spreading;

use bevy::math::{UVec3, Vec3};

use super::topology::Topology;

/// What a volume is built like, whatever it is built from.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeSettings {
    /// Voxels along u, v and w: powers of two.
    pub size: UVec3,
    /// Lengths of the volume's box along u, v and w, in metres.
    pub lengths: Vec3,
    /// How copies meet.
    pub topology: Topology,
    /// Where colour spreads to.
    pub spreading: Spreading,
}

impl VolumeSettings {
    /// A tiling volume of cubes a metre long in all.
    pub fn new(size: UVec3) -> Self {
        let longest = size.max_element().max(1) as f32;
        Self {
            size,
            lengths: size.as_vec3() / longest,
            topology: Topology::Tiling,
            spreading: Spreading::default(),
        }
    }
}

/// A volume, and how its building went.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The volume.
    pub volume: ReferenceVolume,
    /// What was done for it.
    pub report: BuildReport,
}

/// What was done to build a volume.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildReport {
    /// Voxels coloured by the shape itself.
    pub surface_voxels: usize,
    /// Voxels added to close contours.
    pub closing_voxels: usize,
    /// Voxels that colour spread to.
    pub inside_voxels: usize,
    /// Triangles without area, which were left out.
    pub zero_area_triangles: usize,
    /// Columns in which parity found no way out of the shape: its filling is wrong there.
    pub failed_columns: usize,
    /// What the sides of the volume are like. A tiling volume of which [`TopologyReport::tiles`] is false shows seams.
    pub topology: TopologyReport,
}

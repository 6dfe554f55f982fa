//! The reference volume (§2.1): what is stored once and mapped many times.

use bevy::math::{UVec3, Vec3};

use super::axis::SliceAxis;
use super::color::decode_normal;
use super::error::TexelError;
use super::progress::{BuildStep, Progress};
use super::thickness::{Thickness, measure};
use super::topology::Topology;

/// Most voxels along an axis.
pub const MAX_SIDE: u32 = 1024;

/// Most voxels of a volume, 512×512×128: colours and normals of its slices, of all directions and counts, would fill
/// two gigabytes.
pub const MAX_VOXELS: u32 = 1 << 25;

/// A box of voxels, each opaque with a colour and a normal, or empty.
///
/// Space in it is (u, v, w), from 0 to 1: u and v are the texture coordinates of the surface that it is mapped on, w is
/// height, 0 on the surface. Voxel (x, y, z) covers u from x/size.x to (x + 1)/size.x, and so on. Slices along w are
/// the layers of one z, the lowest first.
///
/// What [`new`](Self::new) has let through keeps these promises: sides are powers of two, at most [`MAX_SIDE`], and
/// at most [`MAX_VOXELS`] in all; alpha is 0 or 255; empty voxels are zero throughout; at least one voxel is opaque;
/// an isolated shape has no voxel on the sides along u and v.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferenceVolume {
    size: UVec3,
    lengths: Vec3,
    topology: Topology,
    thickness: Thickness,
    colors: Vec<[u8; 4]>,
    normals: Vec<[u8; 4]>,
}

/// What a volume is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeParts {
    /// Voxels along u, v and w.
    pub size: UVec3,
    /// L: lengths of the box along u, v and w, in metres, as the shape was sliced. A surface may stretch it.
    pub lengths: Vec3,
    /// How copies meet.
    pub topology: Topology,
    /// sRGB colour and alpha, 0 or 255, voxel by voxel: x runs fastest, then y, then z.
    pub colors: Vec<[u8; 4]>,
    /// Unit normals in (u, v, w), as a normal map has them, (n + 1)/2. The fourth byte is not used.
    pub normals: Vec<[u8; 4]>,
}

impl ReferenceVolume {
    /// Checks the parts, and measures the narrowest thickness.
    ///
    /// # Errors
    /// See the promises of [`ReferenceVolume`].
    pub fn new(parts: VolumeParts, progress: Progress) -> Result<Self, TexelError> {
        let mut volume = Self::with_thickness(parts, Thickness::NONE)?;
        volume.thickness = measure(&volume, progress);
        progress(BuildStep::Measuring, 1.0);
        Ok(volume)
    }

    /// The same with a thickness that was measured before.
    pub(super) fn with_thickness(
        mut parts: VolumeParts,
        thickness: Thickness,
    ) -> Result<Self, TexelError> {
        check_size(parts.size, parts.lengths)?;
        let voxels = parts.size.element_product() as usize;
        for (what, found) in [
            ("colours", parts.colors.len()),
            ("normals", parts.normals.len()),
        ] {
            if found != voxels {
                return Err(TexelError::Count {
                    what,
                    found,
                    expected: voxels,
                });
            }
        }
        let mut empty = true;
        let size = parts.size;
        let both = parts.colors.iter_mut().zip(&mut parts.normals).enumerate();
        for (index, (color, normal)) in both {
            match color[3] {
                0 => (*color, *normal) = ([0; 4], [0; 4]),
                255 => {
                    normal[3] = 255;
                    empty = false;
                }
                alpha => {
                    let voxel = voxel_at(index, size);
                    return Err(TexelError::HalfTransparent { voxel, alpha });
                }
            }
        }
        if empty {
            return Err(TexelError::Empty);
        }
        let volume = Self {
            size,
            lengths: parts.lengths,
            topology: parts.topology,
            thickness,
            colors: parts.colors,
            normals: parts.normals,
        };
        if volume.topology == Topology::Isolated {
            let report = volume.topology_report();
            if let Some(first) = report.first_on_border {
                return Err(TexelError::ReachesBorder {
                    voxels: report.on_border,
                    first,
                });
            }
        }
        Ok(volume)
    }

    /// The same with other colours, which are opaque where they were.
    pub(super) fn with_colors(&self, colors: Vec<[u8; 4]>) -> Self {
        Self {
            colors,
            ..self.clone()
        }
    }

    /// Voxels along u, v and w.
    pub fn size(&self) -> UVec3 {
        self.size
    }

    /// L: lengths of the box along u, v and w, in metres.
    pub fn lengths(&self) -> Vec3 {
        self.lengths
    }

    /// How copies meet.
    pub fn topology(&self) -> Topology {
        self.topology
    }

    /// e: the narrowest thickness of contours, in each direction of slices.
    pub fn thickness(&self) -> Thickness {
        self.thickness
    }

    /// h: the distance between slices along an axis, in metres, if there are `count` of them.
    pub fn slice_distance(&self, axis: SliceAxis, count: u32) -> f32 {
        self.lengths[axis.index()] / count as f32
    }

    /// sRGB colours and alpha, x fastest.
    pub fn colors(&self) -> &[[u8; 4]] {
        &self.colors
    }

    /// Normals, x fastest.
    pub fn normals(&self) -> &[[u8; 4]] {
        &self.normals
    }

    /// Index of a voxel in [`colors`](Self::colors) and [`normals`](Self::normals).
    pub fn index(&self, x: u32, y: u32, z: u32) -> usize {
        ((z * self.size.y + y) * self.size.x + x) as usize
    }

    /// Whether a voxel is opaque.
    ///
    /// # Panics
    /// If its [index](Self::index) is beyond the last voxel. Outside along u or v another voxel may be meant.
    pub fn is_opaque(&self, x: u32, y: u32, z: u32) -> bool {
        self.colors[self.index(x, y, z)][3] != 0
    }

    /// The colour of a voxel in sRGB, with alpha.
    ///
    /// # Panics
    /// As [`is_opaque`](Self::is_opaque).
    pub fn color(&self, x: u32, y: u32, z: u32) -> [u8; 4] {
        self.colors[self.index(x, y, z)]
    }

    /// The unit normal of an opaque voxel in (u, v, w).
    ///
    /// # Panics
    /// As [`is_opaque`](Self::is_opaque).
    pub fn normal(&self, x: u32, y: u32, z: u32) -> Vec3 {
        let [nx, ny, nz, _] = self.normals[self.index(x, y, z)];
        decode_normal([nx, ny, nz])
    }

    /// How many voxels are opaque.
    pub fn opaque_voxels(&self) -> usize {
        self.colors.iter().filter(|color| color[3] != 0).count()
    }
}

/// The voxel of an index.
pub(super) fn voxel_at(index: usize, size: UVec3) -> UVec3 {
    let index = index as u32;
    UVec3::new(
        index % size.x,
        index / size.x % size.y,
        index / (size.x * size.y),
    )
}

/// Whether a volume may have this size and these lengths.
pub(super) fn check_size(size: UVec3, lengths: Vec3) -> Result<(), TexelError> {
    for axis in SliceAxis::ALL {
        let side = size[axis.index()];
        if !side.is_power_of_two() {
            return Err(TexelError::NotPowerOfTwo {
                axis,
                side,
                nearest: nearest_power_of_two(side),
            });
        }
    }
    // Sides first: the product of larger ones would not fit.
    let voxels = || size.to_array().map(u64::from).iter().product::<u64>();
    if size.max_element() > MAX_SIDE || voxels() > u64::from(MAX_VOXELS) {
        return Err(TexelError::TooLarge { size });
    }
    if !lengths.is_finite() || lengths.min_element() <= 0.0 {
        return Err(TexelError::Lengths { lengths });
    }
    Ok(())
}

/// The power of two nearest to a number, from 1 to [`MAX_SIDE`].
fn nearest_power_of_two(side: u32) -> u32 {
    let upper = side.clamp(1, MAX_SIDE).next_power_of_two();
    let lower = upper / 2;
    if upper - side.min(upper) <= side.saturating_sub(lower) {
        upper
    } else {
        lower
    }
    .clamp(1, MAX_SIDE)
}

#[cfg(test)]
mod tests {
    use super::super::progress::silent;
    use super::*;

    fn parts(size: UVec3) -> VolumeParts {
        let voxels = size.element_product() as usize;
        VolumeParts {
            size,
            lengths: Vec3::ONE,
            topology: Topology::Tiling,
            colors: vec![[10, 20, 30, 255]; voxels],
            normals: vec![[128, 128, 255, 0]; voxels],
        }
    }

    fn error(parts: VolumeParts) -> String {
        ReferenceVolume::new(parts, &silent)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn sides_that_cannot_be_halved_are_refused_with_the_nearest_that_can() {
        for (side, nearest) in [(0, 1), (3, 4), (5, 4), (100, 128), (1025, 1024)] {
            let message = error(VolumeParts {
                size: UVec3::new(4, side, 2),
                ..parts(UVec3::ONE)
            });
            let expected =
                format!("{side} voxels along v, which is no power of two: take {nearest},");
            assert!(message.contains(&expected), "{message}");
        }
    }

    #[test]
    fn volumes_too_large_are_refused_before_anything_is_counted() {
        for size in [UVec3::new(2048, 1, 1), UVec3::splat(1024)] {
            let message = error(VolumeParts {
                size,
                ..parts(UVec3::ONE)
            });
            assert!(message.contains("take fewer"), "{message}");
        }
    }

    #[test]
    fn what_breaks_a_promise_is_named() {
        let size = UVec3::new(4, 4, 2);
        let mut half = parts(size);
        half.colors[4 * 4 + 5][3] = 128;
        assert!(error(half).contains("voxel [1, 1, 1] has alpha 128"));
        let mut short = parts(size);
        short.normals.pop();
        assert!(error(short).contains("31 normals, where 32"));
        let mut empty = parts(size);
        empty.colors.fill([255, 255, 255, 0]);
        assert!(error(empty).contains("no voxel is opaque"));
        let mut flat = parts(size);
        flat.lengths.y = f32::NAN;
        assert!(error(flat).contains("lengths"));
        let mut isolated = parts(size);
        isolated.topology = Topology::Isolated;
        assert!(error(isolated).contains("24 voxels lie on the sides"));
    }

    #[test]
    fn empty_voxels_hide_no_colour() {
        let mut parts = parts(UVec3::new(2, 1, 1));
        parts.colors[0][3] = 0;
        let volume = ReferenceVolume::new(parts, &silent).unwrap();
        assert_eq!(volume.colors(), [[0; 4], [10, 20, 30, 255]]);
        assert_eq!(volume.normals()[0], [0; 4]);
        assert_eq!(volume.opaque_voxels(), 1);
    }
}

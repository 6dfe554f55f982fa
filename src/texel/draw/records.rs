//! What the GPU gets of facets, surfaces and slices.

use bevy::math::{Affine3A, Mat4, Vec3};
use bevy::mesh::{VertexBufferLayout, VertexFormat};
use bevy::pbr::MeshFlags;
use bevy::render::render_resource::VertexStepMode;
use bytemuck::{Pod, Zeroable};

use super::super::choose::DrawnSlices;
use super::super::facet::Facet;
use super::super::slice_sets::Trim;

/// A facet, as the shaders have it.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct FacetRecord {
    /// Positions of the vertices; w is their u.
    positions: [[f32; 4]; 3],
    /// Height vectors; w is v.
    heights: [[f32; 4]; 3],
    /// Normals of the surface; w is not used.
    normals: [[f32; 4]; 3],
}

impl FacetRecord {
    pub(crate) fn new(facet: &Facet, normals: &[Vec3; 3]) -> Self {
        let vertices = [0, 1, 2];
        Self {
            positions: vertices.map(|i| facet.positions[i].extend(facet.uvs[i].x).to_array()),
            heights: vertices.map(|i| facet.heights[i].extend(facet.uvs[i].y).to_array()),
            normals: normals.map(|normal| normal.extend(0.0).to_array()),
        }
    }

    /// Texture coordinates of the vertices.
    pub(crate) fn uvs(&self) -> [[f32; 2]; 3] {
        [0, 1, 2].map(|i| [self.positions[i][3], self.heights[i][3]])
    }
}

/// A slice of a facet that a view shows: a vertex of the shader's, for each of its four corners.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SliceRecord {
    /// Its number in the buffer of facets.
    pub facet: u32,
    /// Number k of the slice.
    pub slice: i32,
    /// The exponent of N, of so many a texel, in the lowest bits; above it the number of the surface in this frame.
    set: u32,
    /// How far above the place that is seen light falls on it.
    stand_off: f32,
    /// How far it has moved apart from the one with which it takes the place of a coarser one.
    apart: f32,
    /// Which pixels are its, by their lots, in shares of 65,535.
    lots: [u16; 2],
    /// What of it is drawn.
    trim: Trim,
}

/// Bits of the exponent of a count.
const EXPONENT_BITS: u32 = 5;

/// The most surfaces that a frame may have.
pub(crate) const MAX_SURFACES: usize = 1 << (u32::BITS - EXPONENT_BITS);

impl SliceRecord {
    /// One of a power of two a texel, of a surface whose number is not known yet.
    pub(crate) fn new(
        facet: u32,
        slice: i32,
        drawn: &DrawnSlices,
        stand_off: f32,
        trim: Trim,
    ) -> Self {
        Self {
            facet,
            slice,
            set: drawn.count.ilog2(),
            stand_off,
            apart: drawn.apart,
            lots: drawn
                .lots
                .map(|lot| (lot * f32::from(u16::MAX)).round() as u16),
            trim,
        }
    }

    /// The same of a surface.
    pub(crate) fn of_surface(&self, surface: u32) -> Self {
        Self {
            set: self.set | surface << EXPONENT_BITS,
            ..*self
        }
    }
}

/// A surface, the same for all its slices.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SurfaceRecord {
    /// Rows of the transform from the surface to the world, now and in the frame before.
    world_from_local: [[f32; 4]; 3],
    previous: [[f32; 4]; 3],
    /// Bevy's flags of the mesh, and three more numbers: shaders have records in whole rows.
    flags: [u32; 4],
}

impl SurfaceRecord {
    pub(crate) fn new(world_from_local: &Affine3A, previous: &Affine3A, flags: &MeshFlags) -> Self {
        let rows = |affine: &Affine3A| {
            let rows = Mat4::from(*affine).transpose();
            [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.to_array())
        };
        Self {
            world_from_local: rows(world_from_local),
            previous: rows(previous),
            flags: [flags.bits(), 0, 0, 0],
        }
    }
}

/// How the vertex stage reads [`SliceRecord`]s.
pub(crate) fn vertex_buffer() -> VertexBufferLayout {
    let formats = [
        VertexFormat::Uint32x3,
        VertexFormat::Float32x2,
        VertexFormat::Unorm16x2,
        VertexFormat::Unorm16x4,
    ];
    VertexBufferLayout::from_vertex_formats(VertexStepMode::Instance, formats)
}

#[cfg(test)]
mod tests {
    use core::mem::offset_of;

    use super::super::super::slice_sets::WHOLE;
    use super::*;

    #[test]
    fn records_are_as_long_as_the_shaders_take_them_to_be() {
        assert_eq!(size_of::<FacetRecord>(), 9 * 16);
        assert_eq!(size_of::<SurfaceRecord>(), 7 * 16);
        let layout = vertex_buffer();
        assert_eq!(layout.array_stride, size_of::<SliceRecord>() as u64);
        let offsets = [
            offset_of!(SliceRecord, facet),
            offset_of!(SliceRecord, stand_off),
            offset_of!(SliceRecord, lots),
            offset_of!(SliceRecord, trim),
        ];
        let attributes = layout.attributes.iter();
        assert!(attributes.map(|at| at.offset as usize).eq(offsets));
    }

    #[test]
    fn a_slice_s_count_and_surface_do_not_mix() {
        for count in [1, 2, 256, 1 << 31] {
            let drawn = DrawnSlices {
                count,
                apart: 1.0,
                lots: [0.0, 1.0],
            };
            let record = SliceRecord::new(7, -3, &drawn, 0.0, WHOLE);
            assert_eq!(record.lots, [0, u16::MAX]);
            let last = MAX_SURFACES as u32 - 1;
            for surface in [0, 1, last] {
                let set = record.of_surface(surface).set;
                assert_eq!((1 << (set & 31), set >> 5), (count, surface));
            }
        }
    }
}

//! What the GPU gets of facets, surfaces and slices.

use bevy::asset::RenderAssetUsages;
use bevy::math::{Affine3A, Mat4, Vec3};
use bevy::mesh::{VertexBufferLayout, VertexFormat};
use bevy::pbr::MeshFlags;
use bevy::render::render_resource::VertexStepMode;
use bevy::render::storage::ShaderBuffer;
use bytemuck::{Pod, Zeroable};

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
    /// Its number on the surface.
    pub facet: u32,
    /// Number k of the slice, and N, of so many a texel.
    pub slice: i32,
    pub count: u32,
    /// Which pixels are its, by their lots.
    pub lots: [f32; 2],
    /// How far above the place that is seen light falls on it.
    pub stand_off: f32,
    /// What of it is drawn.
    pub trim: Trim,
}

/// A surface, the same for all its slices.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct SurfaceRecord {
    /// Rows of the transform from the surface to the world, now and in the frame before.
    world_from_local: [[f32; 4]; 3],
    previous: [[f32; 4]; 3],
    /// Bevy's flags of the mesh.
    flags: u32,
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
            flags: flags.bits(),
        }
    }
}

/// How the vertex stage reads [`SliceRecord`]s and, the same one for all, a [`SurfaceRecord`].
pub(crate) fn vertex_buffers() -> Vec<VertexBufferLayout> {
    let slices = [
        VertexFormat::Uint32x3,
        VertexFormat::Float32x3,
        VertexFormat::Unorm16x4,
    ];
    let surface = core::iter::repeat_n(VertexFormat::Float32x4, 6).chain([VertexFormat::Uint32]);
    let mut slices = VertexBufferLayout::from_vertex_formats(VertexStepMode::Instance, slices);
    let mut surface = VertexBufferLayout::from_vertex_formats(VertexStepMode::Instance, surface);
    slices.array_stride = size_of::<SliceRecord>() as u64;
    surface = surface.offset_locations_by(3);
    surface.array_stride = 0;
    vec![slices, surface]
}

/// The buffer of a surface's facets, with room for `capacity`, which is at least one.
pub(crate) fn facet_buffer(records: &[FacetRecord], capacity: usize) -> ShaderBuffer {
    let mut buffer = ShaderBuffer::new(bytemuck::cast_slice(records), RenderAssetUsages::default());
    buffer.resize((capacity * size_of::<FacetRecord>()) as u64);
    buffer
}

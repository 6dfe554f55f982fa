//! What the GPU gets of a facet.

use bevy::asset::RenderAssetUsages;
use bevy::math::Vec3;
use bevy::render::storage::ShaderBuffer;
use bytemuck::{Pod, Zeroable};

use super::super::facet::Facet;

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

/// The buffer of a surface's facets, of which there is at least one.
pub(crate) fn facet_buffer(records: &[FacetRecord]) -> ShaderBuffer {
    ShaderBuffer::new(bytemuck::cast_slice(records), RenderAssetUsages::default())
}

//! The mesh of a surface's slices: *slots*, quads that only say which facet they are on, and which slice of it they
//! may become.
//!
//! There is a mesh for each axis. How many slices a facet shows, and in what direction, depends on the view, and the vertex shader finds it out for
//! each. So each facet has as many slots as it may ever need; those that a view does not need collapse to a point.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, Mesh, MeshVertexAttribute, PrimitiveTopology, VertexFormat};

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, slice_range};

/// The facet; the slot on it times four, plus the corner.
pub(crate) const ATTRIBUTE_SLOT: MeshVertexAttribute = MeshVertexAttribute::new(
    "Vertex_Texel_Slot",
    0x5645_5244_5552_4504,
    VertexFormat::Uint32x2,
);

/// The most slots of a surface across each axis. A mesh of them takes 56 bytes each.
pub const MAX_SLOTS: usize = 1 << 21;

/// How many slots a facet needs for at most so many slices a texel across an axis: for those, and for half as many, into
/// which they fade.
///
/// Fewer slices a texel are no more on a facet, but for what rounding adds: an interval of length ℓ meets at most ⌈ℓN⌉ of N
/// slices a texel.
pub(crate) fn slots_of(facet: &Facet, axis: SliceAxis, most: u32) -> usize {
    let on_facet = |count: u32| {
        let range = slice_range(facet.uvs, axis, count);
        range.end.abs_diff(range.start) as usize + usize::from(axis != SliceAxis::W)
    };
    match most {
        0 | 1 => on_facet(1),
        _ => on_facet(most) + on_facet(most / 2),
    }
}

/// The mesh for facets that need so many slots each.
pub(crate) fn slot_mesh(slots: impl Iterator<Item = usize>) -> Mesh {
    let mut corners = Vec::new();
    let mut indices = Vec::new();
    for (facet, count) in (0u32..).zip(slots) {
        for slot in 0..count as u32 {
            let first = corners.len() as u32;
            corners.extend([0, 1, 2, 3].map(|corner| [facet, slot * 4 + corner]));
            indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        }
    }
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(ATTRIBUTE_SLOT, corners)
    .with_inserted_indices(Indices::U32(indices))
}

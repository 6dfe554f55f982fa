//! The mesh of a crown: octagons that only say which corner of which slice they are.

use bevy::asset::RenderAssetUsages;
use bevy::math::Vec3;
use bevy::mesh::{Indices, Mesh, MeshVertexAttribute, PrimitiveTopology, VertexFormat};

use super::blend::PART_SLOTS;
use super::limits::MAX_SLICES;
use super::octagon::CORNERS;
use super::slicing::SlicingShape;

/// The corner in 3 bits, the number of the slice in drawing order in 13, and above them which slicing of its set it is of.
pub(crate) const ATTRIBUTE_CORNER: MeshVertexAttribute = MeshVertexAttribute::new(
    "Vertex_Slice_Corner",
    0x5645_5244_5552_4502,
    VertexFormat::Uint32,
);

// Two levels in as many slots as there may be.
const _: () = assert!(2 * MAX_SLICES as usize * PART_SLOTS * CORNERS <= 1 << 16);

/// The most slices that are drawn of a crown at once: those of two levels that fade into one another, in all `slots`.
pub(crate) fn most_slices(shape: &SlicingShape, slots: usize) -> u32 {
    let pairs = shape.levels.windows(2).map(|pair| pair[0] + pair[1]);
    pairs.max().unwrap_or(shape.levels[0]) * slots as u32
}

/// The mesh for a slicing at a `place` in its set, of which so many `slots` are drawn at once. Its positions are never
/// drawn: they are corners of a box round the crown, with room to sway, which tells Bevy the crown's bounds and the middle
/// that it is sorted by.
pub(crate) fn crown_mesh(shape: &SlicingShape, slots: usize, place: u32) -> Mesh {
    let count = most_slices(shape, slots) * CORNERS as u32;
    let reach = 1.1 * shape.radius;
    let position = |vertex: u32| {
        let side = |bit: u32| {
            if vertex >> bit & 1 == 0 {
                -reach
            } else {
                reach
            }
        };
        shape.centroid + Vec3::new(side(0), side(1), side(2))
    };
    let indices = (0..most_slices(shape, slots)).flat_map(|slice| {
        let first = slice * CORNERS as u32;
        (1..CORNERS as u32 - 1).flat_map(move |i| [first, first + i, first + i + 1])
    });
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_POSITION,
        (0..count).map(position).collect::<Vec<_>>(),
    )
    .with_inserted_attribute(
        ATTRIBUTE_CORNER,
        (0..count)
            .map(|corner| corner | place << 16)
            .collect::<Vec<_>>(),
    )
    .with_inserted_indices(Indices::U32(indices.collect()))
}

//! The meshes that are rasterised: eight corners and twelve triangles a segment, with no positions at all.
//!
//! A vertex only says which corner of which segment it is; the vertex shader finds out where that is. Plants with
//! nearly as many joints share a mesh, so that Bevy draws them, when they share a material, as instances in one
//! draw; the spare segments of the smaller ones collapse to a point.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, MeshVertexAttribute, PrimitiveTopology, VertexFormat};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;

/// Index of the segment times 8, plus the corner.
pub(crate) const ATTRIBUTE_CORNER: MeshVertexAttribute = MeshVertexAttribute::new(
    "Vertex_Frusta_Corner",
    0x5645_5244_5552_4501,
    VertexFormat::Uint32,
);

/// Corner indices of the twelve triangles, counter-clockwise from outside; bit 0 is the first side axis, bit 1
/// the second, bit 2 the limb's axis.
const TRIANGLES: [u8; 36] = [
    0, 2, 3, 0, 3, 1, // start
    4, 5, 7, 4, 7, 6, // end
    0, 1, 5, 0, 5, 4, // second side, negative
    2, 6, 7, 2, 7, 3, // second side, positive
    0, 4, 6, 0, 6, 2, // first side, negative
    1, 3, 7, 1, 7, 5, // first side, positive
];

/// The shared meshes, by the number of segments they have room for, as long as a plant uses them.
#[derive(Resource, Default)]
pub(crate) struct FrustaMeshes {
    by_size: HashMap<usize, AssetId<Mesh>>,
}

impl FrustaMeshes {
    /// The mesh for a plant of so many joints.
    pub(crate) fn with_segments(
        &mut self,
        count: usize,
        meshes: &mut Assets<Mesh>,
    ) -> Handle<Mesh> {
        let size = size_class(count);
        let known = self.by_size.get(&size);
        if let Some(mesh) = known.and_then(|id| meshes.get_strong_handle(*id)) {
            return mesh;
        }
        let mesh = meshes.add(corners(size));
        self.by_size.insert(size, mesh.id());
        mesh
    }
}

/// Fills the meshes anew for a device that has taken a lost one's place: the main world keeps nothing of what they were
/// filled with.
pub(crate) fn refill(known: Res<FrustaMeshes>, mut meshes: ResMut<Assets<Mesh>>) {
    for (size, id) in &known.by_size {
        if let Some(mut mesh) = meshes.get_mut(*id) {
            *mesh = corners(*size);
        }
    }
}

/// Rounds up to four steps an octave: at most a fifth of a mesh is spare.
fn size_class(count: usize) -> usize {
    let count = count.max(4);
    let step = (count.next_power_of_two() / 8).max(1);
    count.next_multiple_of(step)
}

fn corners(segments: usize) -> Mesh {
    let vertices: Vec<u32> = (0..segments as u32 * 8).collect();
    let indices = (0..segments as u32)
        .flat_map(|segment| TRIANGLES.map(|corner| segment * 8 + u32::from(corner)));
    let indices = if vertices.len() <= usize::from(u16::MAX) {
        Indices::U16(indices.map(|index| index as u16).collect())
    } else {
        Indices::U32(indices.collect())
    };
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::RENDER_WORLD,
    )
    .with_inserted_attribute(ATTRIBUTE_CORNER, vertices)
    .with_inserted_indices(indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_has_room_for_its_plant_and_at_most_a_fifth_to_spare() {
        for count in 4..5000 {
            let size = size_class(count);
            assert!(
                size >= count && (size - count) * 5 <= size,
                "{count} in {size}"
            );
        }
    }

    #[test]
    fn triangles_face_outwards() {
        // Corner of the unit cube, minus its centre.
        let at = |corner: u8| {
            Vec3::new(
                f32::from(corner & 1),
                f32::from(corner >> 1 & 1),
                f32::from(corner >> 2),
            ) - 0.5
        };
        for triangle in TRIANGLES.chunks(3) {
            let [a, b, c] = [at(triangle[0]), at(triangle[1]), at(triangle[2])];
            assert!((b - a).cross(c - a).dot(a + b + c) > 0.0, "{triangle:?}");
        }
    }
}

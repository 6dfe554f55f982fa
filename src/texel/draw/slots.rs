//! The mesh of a surface's slices: *slots*, quads that only say which facet they are on, and which slice of it they
//! may become.
//!
//! There is a mesh for each axis. How many slices a facet shows, and in what direction, depends on the view, and the vertex
//! shader finds it out for each. So each facet has as many slots as it may ever need; those that a view does not need
//! collapse to a point.

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

#[cfg(test)]
mod tests {
    use bevy::math::{Vec2, Vec3};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

        /// What the vertex shader may ask for: a count, and twice as many that fade in.
        #[test]
        fn there_are_slots_for_any_count_and_the_next(
            uvs in prop::array::uniform3(prop::array::uniform2(-3.0..3.0f32)),
            most in 0..9u32,
        ) {
            let facet = Facet {
                positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
                heights: [Vec3::Z; 3],
                uvs: uvs.map(Vec2::from),
            };
            for axis in SliceAxis::ALL {
                let slots = slots_of(&facet, axis, 1 << most);
                for exponent in 0..=most {
                    let on_facet = |count| slice_range(facet.uvs, axis, count).len();
                    let finer = if exponent < most { on_facet(2 << exponent) } else { 0 };
                    prop_assert!(on_facet(1 << exponent) + finer <= slots, "{axis:?} {exponent} {slots}");
                }
            }
        }
    }

    #[test]
    fn slots_are_quads_numbered_by_facet_and_corner() {
        let mesh = slot_mesh([2, 1].into_iter());
        let corners = mesh.attribute(ATTRIBUTE_SLOT).unwrap();
        assert_eq!(corners.len(), 12);
        let bevy::mesh::VertexAttributeValues::Uint32x2(corners) = corners else {
            panic!("{corners:?}");
        };
        assert_eq!(corners[5], [0, 5]);
        assert_eq!(corners[11], [1, 3]);
        assert_eq!(mesh.indices().unwrap().len(), 18);
    }
}

//! The meshes of a crown: octagons that only say which corner of which slice they are.

use core::ops::Range;

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

/// The most bands that a crown is drawn in.
const MOST_BANDS: u32 = 16;

/// Ranks in each band of a crown that shows so many; the last band may have fewer.
pub(crate) fn band_ranks(ranks: u32) -> u32 {
    ranks.div_ceil(MOST_BANDS).max(1)
}

/// The slices in bands, far to near, of a crown that shows so many ranks, by their numbers in drawing order. The last has
/// all that come after, if there are more.
pub(crate) fn bands(
    shape: &SlicingShape,
    slots: usize,
    ranks: u32,
) -> impl Iterator<Item = Range<u32>> {
    let each = band_ranks(ranks);
    let count = ranks.div_ceil(each);
    let all = most_slices(shape, slots);
    (0..count).map(move |band| {
        let first = |band: u32| {
            if band == count {
                all
            } else {
                band * each * slots as u32
            }
        };
        first(band)..first(band + 1)
    })
}

/// The mesh for some slices, by their numbers in drawing order, of a slicing at a `place` in its set. Its positions are
/// never drawn: they are corners of a box round the crown, with room to sway, which tells Bevy the crown's bounds and the
/// middle that it is sorted by.
pub(crate) fn crown_mesh(shape: &SlicingShape, slices: Range<u32>, place: u32) -> Mesh {
    let corners = CORNERS as u32;
    let count = slices.len() as u32 * corners;
    let first_corner = slices.start * corners;
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
    let indices = (0..slices.len() as u32).flat_map(|slice| {
        let first = slice * corners;
        (1..corners - 1).flat_map(move |i| [first, first + i, first + i + 1])
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
            .map(|corner| (first_corner + corner) | place << 16)
            .collect::<Vec<_>>(),
    )
    .with_inserted_indices(Indices::U32(indices.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slicing::blend::SLOTS;
    use crate::slicing::tests::leaves;

    #[test]
    fn bands_have_all_slices_once_and_in_order() {
        let mut shape = leaves(4).shape().clone();
        for finest in [2, 5, 8, 16, 17, 64] {
            shape.levels = vec![finest, 3, 1];
            for (slots, ranks) in [
                (SLOTS, finest),
                (PART_SLOTS, finest + 3),
                (SLOTS, 3),
                (SLOTS, 4),
            ] {
                let mut end = 0;
                for band in bands(&shape, slots, ranks) {
                    assert!(band.start == end && band.end > end, "{finest}: {band:?}");
                    assert!(
                        band.start.is_multiple_of(slots as u32),
                        "{finest}: {band:?}"
                    );
                    end = band.end;
                }
                assert_eq!(end, most_slices(&shape, slots), "{finest}");
                assert!(bands(&shape, slots, ranks).count() <= MOST_BANDS as usize);
            }
        }
    }
}

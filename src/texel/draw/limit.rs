//! How many slices a surface may show.

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, slice_range};

/// The most slices that a surface may show across each axis in one view. 32 bytes each.
pub const MAX_SLICES: usize = 1 << 21;

/// How many slices a facet may show of at most so many a texel across an axis, with half as many that fade into them.
///
/// Fewer slices a texel are no more on a facet, but for what rounding adds: an interval of length ℓ meets at most ⌈ℓN⌉ of N
/// slices a texel.
pub(crate) fn most_on_facet(facet: &Facet, axis: SliceAxis, most: u32) -> usize {
    let on_facet = |count: u32| {
        let range = slice_range(facet.uvs, axis, count);
        range.end.abs_diff(range.start) as usize + usize::from(axis != SliceAxis::W)
    };
    match most {
        0 | 1 => on_facet(1),
        _ => on_facet(most) + on_facet(most / 2),
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::{Vec2, Vec3};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

        /// What a view may show: a count, and twice as many that fade in.
        #[test]
        fn no_count_with_the_next_is_more(
            uvs in prop::array::uniform3(prop::array::uniform2(-3.0..3.0f32)),
            most in 0..9u32,
        ) {
            let facet = Facet {
                positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
                heights: [Vec3::Z; 3],
                uvs: uvs.map(Vec2::from),
            };
            for axis in SliceAxis::ALL {
                let limit = most_on_facet(&facet, axis, 1 << most);
                for exponent in 0..=most {
                    let on_facet = |count| slice_range(facet.uvs, axis, count).len();
                    let finer = if exponent < most { on_facet(2 << exponent) } else { 0 };
                    prop_assert!(on_facet(1 << exponent) + finer <= limit, "{axis:?} {exponent} {limit}");
                }
            }
        }
    }
}

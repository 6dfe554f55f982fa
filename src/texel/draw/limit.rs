//! How many slices and facets a surface may have.

use bevy::render::renderer::RenderDevice;

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, slice_range};
use super::records::FacetRecord;

/// The most slices that a surface may show across each axis in one view. 32 bytes each; those of all surfaces and views of a frame
/// are in one buffer, and what does not fit in that is left out, with an error.
pub const MAX_SLICES: usize = 1 << 21;

/// What of a surface and a volume fits on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DeviceLimits {
    /// Layers of a texture array.
    pub layers: u32,
    /// Facets in a storage buffer: a surface has one at most, and shares it if it can.
    pub facets: usize,
}

/// Layers of a texture array that every device has.
const LAYERS: u32 = 256;

/// Bytes of a storage buffer that shaders may read on every device: wgpu's default.
const BUFFER_BYTES: u64 = 1 << 27;

impl DeviceLimits {
    fn new(layers: u32, buffer_bytes: u64) -> Self {
        let facets = buffer_bytes / size_of::<FacetRecord>() as u64;
        Self {
            layers,
            facets: usize::try_from(facets).unwrap_or(usize::MAX),
        }
    }

    /// Those of a device, or of any if there is none.
    pub(crate) fn of(device: Option<&RenderDevice>) -> Self {
        let Some(device) = device else {
            return Self::new(LAYERS, BUFFER_BYTES);
        };
        let limits = device.limits();
        let bytes = limits.max_storage_buffer_binding_size;
        Self::new(
            limits.max_texture_array_layers,
            bytes.min(limits.max_buffer_size),
        )
    }

    /// The most slices a texel that a texture array has room for: sets of 1, 2, 4 and so on up to N are 2N − 1 layers.
    pub(crate) fn slices(self) -> u32 {
        self.layers.div_ceil(2).max(1)
    }
}

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

    #[test]
    fn a_storage_buffer_and_a_texture_array_bound_facets_and_slices() {
        let limits = DeviceLimits::of(None);
        assert_eq!(limits, DeviceLimits::new(256, 1 << 27));
        assert_eq!((limits.slices(), limits.facets), (128, (1 << 27) / 144));
        assert_eq!(DeviceLimits::new(1, 143).facets, 0);
        assert_eq!(DeviceLimits::new(0, 0).slices(), 1);
    }

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

//! How many slices and facets a surface may have.

use bevy::render::renderer::RenderDevice;

use super::super::axis::SliceAxis;
use super::super::facet::{Facet, slice_range};
use super::records::{FacetRecord, MAX_SURFACES, SurfaceRecord};

/// The most slices that a surface may show across each axis in one view. 32 bytes each; those of all surfaces and views of a
/// frame are in one buffer, and what does not fit in that is left out, with an error.
pub const MAX_SLICES: usize = 1 << 21;

/// What of a surface and a volume fits on a device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct DeviceLimits {
    /// Layers of a texture array.
    pub layers: u32,
    /// Facets in a storage buffer: a surface has one at most, and shares it if it can.
    pub facets: usize,
    /// Surfaces in a frame, which are in one storage buffer.
    pub surfaces: usize,
}

/// Layers of a texture array that every device has.
const LAYERS: u32 = 256;

/// Bytes of a storage buffer that shaders may read on every device: wgpu's default.
const BUFFER_BYTES: u64 = 1 << 27;

impl DeviceLimits {
    fn new(layers: u32, buffer_bytes: u64) -> Self {
        let bytes = usize::try_from(buffer_bytes).unwrap_or(usize::MAX);
        Self {
            layers,
            facets: bytes / size_of::<FacetRecord>(),
            surfaces: MAX_SURFACES.min(bytes / size_of::<SurfaceRecord>()),
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

/// How many slices a facet may show of at most so many a texel across an axis.
///
/// Fewer slices a texel are no more on a facet, but for what rounding adds: an interval of length ℓ meets ⌊ℓN⌋ or ⌈ℓN⌉ of N
/// slices a texel, and less than ℓN + 2 of them where pairs have not moved apart.
pub(crate) fn most_on_facet(facet: &Facet, axis: SliceAxis, most: u32) -> usize {
    let range = slice_range(facet.uvs, axis, most.max(1), 1.0);
    // A single one has none to move apart from.
    let has_pairs = axis != SliceAxis::W && most > 1;
    let rounding = if has_pairs { 2 } else { 0 };
    range.end.abs_diff(range.start) as usize + rounding
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
        assert_eq!(limits.surfaces, (1 << 27) / 112);
        assert_eq!(DeviceLimits::new(256, u64::MAX).surfaces, MAX_SURFACES);
        assert_eq!(DeviceLimits::new(1, 143).facets, 0);
        assert_eq!(DeviceLimits::new(0, 0).slices(), 1);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

        /// What a view may show: a count, evenly spaced or moving apart.
        #[test]
        fn no_count_that_moves_apart_is_more(
            uvs in prop::array::uniform3(prop::array::uniform2(-3.0..3.0f32)),
            most in 0..9u32,
            apart in 0.0..1.0f32,
        ) {
            let facet = Facet {
                positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
                heights: [Vec3::Z; 3],
                uvs: uvs.map(Vec2::from),
            };
            for axis in SliceAxis::ALL {
                let limit = most_on_facet(&facet, axis, 1 << most);
                for exponent in 0..=most {
                    // A single slice a texel is never one of a pair.
                    let shares = if exponent > 0 { &[0.0, apart, 1.0][..] } else { &[1.0] };
                    for &apart in shares {
                        let range = slice_range(facet.uvs, axis, 1 << exponent, apart);
                        prop_assert!(range.len() <= limit, "{axis:?} {exponent} {apart} {limit}");
                    }
                }
            }
        }
    }
}

//! Whether slices are compressed on the GPU.

use bevy::prelude::*;
use bevy::render::settings::WgpuFeatures;

use crate::texture_compression::has_whole_blocks;

/// Whether [`Slicing`](super::Slicing)s are compressed on the GPU, a resource. May be changed at any time; those in use
/// follow within the frame.
///
/// Compressed in blocks of four by four pixels (BC3) they take a quarter of the memory, and a moment of all cores when they
/// come into use; those that are gathered to be drawn at once are compressed again behind the frames. They look as much like
/// the mesh as before, but not like what they were: where leaves of many directions share a block, single pixels are lit
/// otherwise (`docs/slicing.md` has figures). So it is the user's choice.
#[derive(Resource, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Resource, Clone, Debug, Default, PartialEq)]
pub enum SlicingCompression {
    /// Eight bits a channel, as they were baked.
    #[default]
    Never,
    /// Where the device reads BC textures, as nearly all on desktops do; elsewhere not. Slices of less than 4 pixels never
    /// are.
    WhereSupported,
}

impl SlicingCompression {
    /// Whether slices of so many `pixels` along a side are compressed on a device with these features.
    pub fn applies(self, pixels: u32, features: WgpuFeatures) -> bool {
        self == Self::WhereSupported
            && features.contains(WgpuFeatures::TEXTURE_COMPRESSION_BC)
            && has_whole_blocks(pixels)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_are_compressed_where_device_and_size_and_user_allow() {
        let bc = WgpuFeatures::TEXTURE_COMPRESSION_BC;
        let others = WgpuFeatures::all() - bc;
        let [can, never] = [
            SlicingCompression::WhereSupported,
            SlicingCompression::Never,
        ];
        assert!(can.applies(256, bc) && can.applies(4, bc | others));
        assert!(!can.applies(256, others));
        assert!(!can.applies(256, WgpuFeatures::empty()));
        assert!(!can.applies(2, bc) && !can.applies(1, bc));
        assert!(!never.applies(256, bc));
    }
}

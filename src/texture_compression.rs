//! Pictures in blocks that a GPU reads as they are: BC3 (S3TC DXT5), four by four pixels in 16 bytes.
//!
//! Each block has two colours of 5, 6 and 5 bits with two between them, and two opacities of 8 bits with six between them.
//! The crate `texpresso` (libsquish) fits the colours to the ends of their principal axis.

use texpresso::{Algorithm, COLOUR_WEIGHTS_PERCEPTUAL, ColourWeights, Format, Params};

/// Bytes of a block, and pixels along its side.
const BLOCK: (u64, u32) = (16, 4);

/// What the three colour channels hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channels {
    /// Colours over alpha: green counts most, and what is transparent least.
    Colors,
    /// Numbers that have nothing to do with each other, of which the fourth is kept best and the second next.
    Numbers,
}

/// Whether a device takes pictures of this size in blocks: whole ones, in the finest level.
pub(crate) fn has_whole_blocks(side: u32) -> bool {
    side > 0 && side.is_multiple_of(BLOCK.1)
}

/// Bytes of all mip levels of a square picture in blocks; those smaller than a block take one.
pub(crate) fn compressed_bytes(side: u32) -> u64 {
    let blocks = |level: u32| u64::from((side >> level).div_ceil(BLOCK.1)).pow(2);
    BLOCK.0 * (0..=side.ilog2()).map(blocks).sum::<u64>()
}

/// All mip levels of a square picture, the finest first, in blocks. `levels` are the pixels of all of them; `side` is
/// the finest's, a power of two of at least 4.
pub(crate) fn compress(levels: &[[u8; 4]], side: u32, channels: Channels) -> Vec<u8> {
    let weights: ColourWeights = match channels {
        Channels::Colors => COLOUR_WEIGHTS_PERCEPTUAL,
        Channels::Numbers => [0.5, 1.0, 0.5],
    };
    let params = Params {
        algorithm: Algorithm::RangeFit,
        weights,
        weigh_colour_by_alpha: channels == Channels::Colors,
    };
    let mut blocks = vec![0; compressed_bytes(side) as usize];
    let (mut pixels, mut out) = (bytemuck::cast_slice(levels), blocks.as_mut_slice());
    for level in 0..=side.ilog2() {
        let side = (side >> level) as usize;
        let (these, coarser) = pixels.split_at(4 * side * side);
        let (written, rest) = out.split_at_mut(Format::Bc3.compressed_size(side, side));
        Format::Bc3.compress(these, side, side, params, written);
        (pixels, out) = (coarser, rest);
    }
    blocks
}

/// Pixels of all mip levels of a picture in blocks, as a device reads them.
#[cfg(test)]
pub(crate) fn decompress(blocks: &[u8], side: u32) -> Vec<[u8; 4]> {
    let mut pixels = Vec::new();
    let mut rest = blocks;
    for level in 0..=side.ilog2() {
        let side = (side >> level) as usize;
        let (these, coarser) = rest.split_at(Format::Bc3.compressed_size(side, side));
        let mut level = vec![[0; 4]; side * side];
        Format::Bc3.decompress(these, side, side, level.as_flattened_mut());
        pixels.extend(level);
        rest = coarser;
    }
    assert!(rest.is_empty());
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::Dice;

    /// Pixels of all mip levels of a picture.
    fn pixels_of(side: u32) -> usize {
        (0..=side.ilog2())
            .map(|level| (side >> level).pow(2) as usize)
            .sum()
    }

    #[test]
    fn an_even_picture_comes_back_in_every_level() {
        let color = [90, 140, 40, 200];
        for channels in [Channels::Colors, Channels::Numbers] {
            let blocks = compress(&vec![color; pixels_of(16)], 16, channels);
            for pixel in decompress(&blocks, 16) {
                for (was, is) in color.into_iter().zip(pixel) {
                    // Colours of 5 bits, and two between each two of them, are 8/3 apart.
                    assert!(was.abs_diff(is) <= 2, "{pixel:?}");
                }
                assert_eq!(pixel[3], color[3]);
            }
        }
    }

    #[test]
    fn a_ramp_errs_by_no_more_than_its_steps() {
        // From one end to the other in 16 pixels, block by block.
        let [low, high] = [[20.0, 60.0, 10.0, 0.0], [180.0, 220.0, 90.0, 255.0]];
        let levels: Vec<[u8; 4]> = (0..pixels_of(4))
            .map(|i| {
                let t = (i % 16) as f32 / 15.0;
                core::array::from_fn(|c| (low[c] + t * (high[c] - low[c])) as u8)
            })
            .collect();
        let back = decompress(&compress(&levels, 4, Channels::Numbers), 4);
        for (was, is) in levels.iter().zip(&back).take(16) {
            // Half of a third, and of a seventh, of the range; and half a step of 5 bits, 4, at both ends.
            for c in 0..3 {
                let most = (high[c] - low[c]) / 6.0 + 4.0 + 1.0;
                assert!(f32::from(was[c].abs_diff(is[c])) <= most, "{was:?} {is:?}");
            }
            assert!(f32::from(was[3].abs_diff(is[3])) <= 255.0 / 14.0 + 1.0);
        }
    }

    #[test]
    fn what_is_opaque_stays_so_and_what_is_not_does_not() {
        let mut dice = Dice::new(2);
        let levels: Vec<[u8; 4]> = (0..pixels_of(32))
            .map(|_| [60, 120, 30, if dice.roll() < 0.3 { 255 } else { 0 }])
            .collect();
        let back = decompress(&compress(&levels, 32, Channels::Colors), 32);
        for (was, is) in levels.iter().zip(&back) {
            assert_eq!(was[3], is[3]);
        }
    }

    #[test]
    fn sizes_are_those_of_whole_blocks() {
        // 8x8, 4x4, 2x2 and 1x1 pixels.
        assert_eq!(compressed_bytes(8), 16 * (4 + 1 + 1 + 1));
        assert_eq!(
            [0, 1, 2, 3, 4, 6, 8].map(has_whole_blocks),
            [false, false, false, false, true, false, true]
        );
    }
}

//! A picture that others are judged by: taken larger, without anti-aliasing, and averaged down.

use bevy::math::UVec2;

use crate::texel::color::{linear_to_srgb, srgb_to_linear};

/// Averages squares of `factor` × `factor` pixels of 8-bit sRGB colours, in linear light, as a sensor would.
///
/// # Panics
/// If there are fewer bytes than the size, `factor` times as large in both directions, asks for.
pub fn box_downsample(size: UVec2, factor: u32, rgb: &[u8]) -> Vec<u8> {
    let linear: [f32; 256] = core::array::from_fn(|byte| srgb_to_linear(byte as f32 / 255.0));
    let row = (size.x * factor * 3) as usize;
    let share = 1.0 / (factor * factor) as f32;
    let mut small = Vec::with_capacity((size.x * size.y * 3) as usize);
    let mut sums = vec![0.0f32; (size.x * 3) as usize];
    for y in 0..size.y {
        sums.fill(0.0);
        for sub in 0..factor {
            let start = (y * factor + sub) as usize * row;
            for (i, pixel) in rgb[start..start + row].chunks_exact(3).enumerate() {
                let at = i / factor as usize * 3;
                for (sum, byte) in sums[at..at + 3].iter_mut().zip(pixel) {
                    *sum += linear[usize::from(*byte)];
                }
            }
        }
        let bytes = sums.iter().map(|sum| linear_to_srgb(sum * share));
        small.extend(bytes.map(|value| (value * 255.0).round() as u8));
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_colour_stays_what_it_is() {
        for byte in 0..=255 {
            let rgb = [byte; 4 * 4 * 3];
            assert_eq!(box_downsample(UVec2::ONE, 4, &rgb), [byte; 3]);
        }
    }

    #[test]
    fn black_and_white_by_half_are_half_the_light_not_half_the_code() {
        // 2 × 1 pixels of 2 × 2 each: half black half white, and all white.
        let rows = [[0, 255, 255, 255], [255, 0, 255, 255]];
        let rgb: Vec<u8> = rows.as_flattened().iter().flat_map(|&b| [b; 3]).collect();
        let small = box_downsample(UVec2::new(2, 1), 2, &rgb);
        assert_eq!(small, [188, 188, 188, 255, 255, 255]);
    }
}

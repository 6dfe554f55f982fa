//! Mip levels of slices that keep their coverage.
//!
//! Averaging alpha keeps the mean opacity of a slice in every level, and crowns are drawn in ways that take alpha for
//! what it is, blended or hashed: none of them tests it against a fixed threshold, below which fine twigs would vanish.
//! Colours are averaged by weight of alpha, so that nothing of the transparent pixels comes in.

use super::bake::color::{decode, encode, unorm};

/// All mip levels of a picture of colours, from the finest of `size` × `size` pixels on.
pub(crate) fn color_levels(finest: &[[u8; 4]], size: u32) -> Vec<[u8; 4]> {
    let mut level: Vec<[f32; 4]> = finest
        .iter()
        .map(|&[r, g, b, a]| [decode(r), decode(g), decode(b), f32::from(a) / 255.0])
        .collect();
    let mut bytes = finest.to_vec();
    let mut side = size as usize;
    while side > 1 {
        level = halve(&level, side, |pixel| pixel[3], 3);
        side /= 2;
        bytes.extend(
            level
                .iter()
                .map(|&[r, g, b, a]| [encode(r), encode(g), encode(b), unorm(a)]),
        );
    }
    bytes
}

/// All mip levels of a picture of normals (and occlusion in alpha), weighted by the alpha of the colours.
pub(crate) fn normal_levels(finest: &[[u8; 4]], color: &[[u8; 4]], size: u32) -> Vec<[u8; 4]> {
    let mut level: Vec<[f32; 5]> = finest
        .iter()
        .zip(color)
        .map(|(normal, color)| {
            let [x, y, z, o] = normal.map(|byte| f32::from(byte) / 255.0);
            [x, y, z, o, f32::from(color[3]) / 255.0]
        })
        .collect();
    let mut bytes = finest.to_vec();
    let mut side = size as usize;
    while side > 1 {
        level = halve(&level, side, |pixel| pixel[4], 4);
        side /= 2;
        bytes.extend(level.iter().map(|&[x, y, z, o, _]| [x, y, z, o].map(unorm)));
    }
    bytes
}

/// The next coarser level: means of four pixels by weight, plain means of the `weighted` channel and of what weighs
/// nothing.
fn halve<const N: usize>(
    level: &[[f32; N]],
    side: usize,
    weight: impl Fn(&[f32; N]) -> f32,
    plain: usize,
) -> Vec<[f32; N]> {
    let half = side / 2;
    let pixels = (0..half * half).map(|i| {
        let (x, y) = (i % half * 2, i / half * 2);
        let four =
            [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| &level[(y + dy) * side + x + dx]);
        let sum: f32 = four.iter().map(|pixel| weight(pixel)).sum();
        core::array::from_fn(|c| {
            if c == plain || sum <= 0.0 {
                four.iter().map(|pixel| pixel[c]).sum::<f32>() / 4.0
            } else {
                four.iter()
                    .map(|pixel| pixel[c] * weight(pixel))
                    .sum::<f32>()
                    / sum
            }
        })
    });
    pixels.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::Dice;

    #[test]
    fn coverage_is_the_same_in_every_level() {
        let mut dice = Dice::new(5);
        // A few opaque pixels on transparent red.
        let finest: Vec<[u8; 4]> = (0..64 * 64)
            .map(|_| {
                if dice.roll() < 0.03 {
                    [20, 200, 40, 255]
                } else {
                    [255, 0, 0, 0]
                }
            })
            .collect();
        let mean = |pixels: &[[u8; 4]]| {
            pixels.iter().map(|p| f32::from(p[3])).sum::<f32>() / pixels.len() as f32
        };
        let all = color_levels(&finest, 64);
        let (mut start, mut side) = (0, 64);
        while side >= 1 {
            let level = &all[start..start + side * side];
            // Half a step of alpha's eight bits.
            assert!((mean(level) - mean(&finest)).abs() <= 0.5, "{side}");
            for [r, g, _, a] in level {
                assert!(
                    *a == 0 || (*r, *g) == (20, 200),
                    "transparent red comes in at {side}"
                );
            }
            start += side * side;
            side /= 2;
        }
        assert_eq!(start, all.len());
    }
}

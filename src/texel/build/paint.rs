//! What triangles are painted with: a colour, and a texture that is filtered down to the size of a voxel.

use bevy::math::{Vec2, Vec4};

use super::super::color::srgb_to_linear;

/// The material of a triangle, as far as a volume can keep it.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    /// Linear colour and alpha, which multiply those of the texture.
    pub color: Vec4,
    /// Alpha below this is a hole, where the shape is left unfilled. Filled shapes have no holes.
    pub alpha_cutoff: f32,
    /// A texture, which repeats.
    pub texture: Option<PaintTexture>,
}

impl Default for Paint {
    fn default() -> Self {
        Self {
            color: Vec4::ONE,
            alpha_cutoff: 0.5,
            texture: None,
        }
    }
}

/// A texture with all its mip levels, in linear colours.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintTexture {
    levels: Vec<Level>,
    /// Pixels that were given, and how many the size asks for.
    pub(super) counts: [usize; 2],
}

#[derive(Clone, Debug, PartialEq)]
struct Level {
    size: [u32; 2],
    pixels: Vec<Vec4>,
}

impl PaintTexture {
    /// A texture of sRGB colours and alpha, row by row from v = 0 on. A wrong number of pixels is an error
    /// when it is used.
    pub fn new(size: [u32; 2], pixels: &[[u8; 4]]) -> Self {
        let linear = pixels.iter().map(|&[r, g, b, a]| {
            let linear = |byte: u8| srgb_to_linear(f32::from(byte) / 255.0);
            Vec4::new(linear(r), linear(g), linear(b), f32::from(a) / 255.0)
        });
        let mut levels = vec![Level {
            size,
            pixels: linear.collect(),
        }];
        let expected = size[0] as usize * size[1] as usize;
        while let Some(last) = levels.last()
            && last.size != [1, 1]
            && pixels.len() == expected
            && expected > 0
        {
            levels.push(last.half());
        }
        Self {
            levels,
            counts: [pixels.len(), expected],
        }
    }

    /// The colour at a place, averaged over about `area` of the texture, of which the whole is 1.
    pub(super) fn sample(&self, uv: Vec2, area: f32) -> Vec4 {
        let [width, height] = self.levels[0].size.map(|side| side as f32);
        let pixels = (area * width * height).max(1.0);
        let level = (0.5 * pixels.log2()).round() as usize;
        let level = &self.levels[level.min(self.levels.len() - 1)];
        let at = |value: f32, side: u32| {
            let place = (value.rem_euclid(1.0) * side as f32) as u32;
            place.min(side - 1) as usize
        };
        level.pixels[at(uv.y, level.size[1]) * level.size[0] as usize + at(uv.x, level.size[0])]
    }
}

impl Level {
    /// Averages of 2×2 pixels; the last row or column of an odd side counts twice. Colours weigh as much as they are
    /// opaque.
    fn half(&self) -> Self {
        let size = self.size.map(|side| side.div_ceil(2));
        let mut pixels = Vec::with_capacity((size[0] * size[1]) as usize);
        for y in 0..size[1] {
            for x in 0..size[0] {
                let mut sum = Vec4::ZERO;
                let mut plain = Vec4::ZERO;
                for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                    let x = (2 * x + dx).min(self.size[0] - 1);
                    let y = (2 * y + dy).min(self.size[1] - 1);
                    let pixel = self.pixels[(y * self.size[0] + x) as usize];
                    sum += (pixel.truncate() * pixel.w).extend(pixel.w);
                    plain += pixel;
                }
                pixels.push(if sum.w > 0.0 {
                    (sum.truncate() / sum.w).extend(sum.w / 4.0)
                } else {
                    plain / 4.0
                });
            }
        }
        Self { size, pixels }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_area_gets_the_average_of_what_is_opaque() {
        // Opaque white, and holes that hide red.
        let pixels: Vec<_> = (0..16)
            .map(|i| if i % 4 < 2 { [255; 4] } else { [255, 0, 0, 0] })
            .collect();
        let texture = PaintTexture::new([4, 4], &pixels);
        assert_eq!(texture.sample(Vec2::new(0.1, 0.1), 0.0), Vec4::ONE);
        assert_eq!(
            texture.sample(Vec2::new(-0.1, 0.1), 0.0),
            Vec4::new(1.0, 0.0, 0.0, 0.0)
        );
        assert_eq!(
            texture.sample(Vec2::ZERO, 1.0),
            Vec4::new(1.0, 1.0, 1.0, 0.5)
        );
    }
}

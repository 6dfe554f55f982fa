//! The base colour textures of what is baked.

use bevy::color::ColorToPacked;
use bevy::image::Image;
use bevy::math::Vec2;

use super::error::BakeError;

/// A picture of 8-bit sRGB colours with linear alpha, which repeats.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CrownTexture {
    size: [u32; 2],
    /// Row by row, the top one first.
    pixels: Vec<[u8; 4]>,
}

impl CrownTexture {
    /// A texture of so many pixels, row by row.
    ///
    /// # Errors
    /// When their number is not width × height, or 0.
    pub fn new(size: [u32; 2], pixels: Vec<[u8; 4]>) -> Result<Self, BakeError> {
        let [width, height] = size;
        if pixels.is_empty() || pixels.len() as u64 != u64::from(width) * u64::from(height) {
            return Err(BakeError::TextureSize {
                width,
                height,
                pixels: pixels.len(),
            });
        }
        Ok(Self { size, pixels })
    }

    /// The texture of a Bevy image of two dimensions. Of its mip levels, the first is taken.
    ///
    /// # Errors
    /// When the image is compressed, or its pixels are kept on the GPU alone.
    pub fn from_image(image: &Image) -> Result<Self, BakeError> {
        let size = image.size();
        let mut pixels = Vec::with_capacity((size.x * size.y) as usize);
        for y in 0..size.y {
            for x in 0..size.x {
                let color = image.get_color_at(x, y).map_err(|error| BakeError::Image {
                    message: error.to_string(),
                })?;
                pixels.push(color.to_srgba().to_u8_array());
            }
        }
        Self::new(size.to_array(), pixels)
    }

    /// Colour at a place, linear; bilinear, and repeating.
    pub(super) fn sample(&self, uv: Vec2) -> [f32; 4] {
        let [width, height] = self.size;
        let x = uv.x.rem_euclid(1.0) * width as f32 - 0.5;
        let y = uv.y.rem_euclid(1.0) * height as f32 - 0.5;
        let (x0, y0) = (x.floor(), y.floor());
        let (fx, fy) = (x - x0, y - y0);
        let pixel = |dx: i64, dy: i64| {
            let x = (x0 as i64 + dx).rem_euclid(i64::from(width)) as usize;
            let y = (y0 as i64 + dy).rem_euclid(i64::from(height)) as usize;
            linear(self.pixels[y * width as usize + x])
        };
        let (a, b, c, d) = (pixel(0, 0), pixel(1, 0), pixel(0, 1), pixel(1, 1));
        core::array::from_fn(|i| {
            (a[i] * (1.0 - fx) + b[i] * fx) * (1.0 - fy) + (c[i] * (1.0 - fx) + d[i] * fx) * fy
        })
    }
}

fn linear(pixel: [u8; 4]) -> [f32; 4] {
    let [r, g, b, a] = pixel;
    let [r, g, b] = [r, g, b].map(super::color::decode);
    [r, g, b, f32::from(a) / 255.0]
}

//! From an image to heights with mip levels.

use bevy::image::Image;
use bevy::render::render_resource::{TextureDimension, TextureFormat};
use thiserror::Error;

/// Largest side of a relief map, in pixels: what every device can hold.
pub const LARGEST_SIDE: u32 = 8192;

/// A relief map's heights, 0 to 255, and all their mip levels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ReliefMap {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rows of each level, the finest first.
    pub levels: Vec<Vec<u8>>,
    /// The lowest and the highest pixel.
    pub range: [u8; 2],
    /// What is odd about the image, for the log.
    pub warning: Option<ReliefMapWarning>,
}

/// What is odd about an image that can be used as a relief map all the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ReliefMapWarning {
    /// A colour image.
    #[error("has colours; only red counts. Store heights as 8-bit grey")]
    Colour,
    /// A 16-bit image.
    #[error("has 16 bits a pixel; only the upper 8 count. Store heights as 8-bit grey")]
    SixteenBits,
}

/// Why an image is no relief map.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ReliefMapError {
    /// Cube maps, arrays, volumes.
    #[error("is no flat image ({0:?}). A relief map is one 8-bit grey image, such as a PNG")]
    NotFlat(TextureDimension),
    /// No pixel, or a side that no device can hold.
    #[error("is {0} x {1} pixels. A relief map has 1 to {LARGEST_SIDE} pixels a side")]
    Size(u32, u32),
    /// A format other than 8 or 16 bits a channel.
    #[error("has the format {0:?}. Store heights as 8-bit grey, such as in a PNG")]
    Format(TextureFormat),
    /// The image is only on the GPU.
    #[error(
        "has no pixels in the main world. Load it with RenderAssetUsages::MAIN_WORLD among its asset usages"
    )]
    NoPixels,
    /// Fewer bytes than its size asks for.
    #[error("has {0} bytes of pixels, {1} are needed")]
    Short(usize, usize),
}

/// How pixels of a format are read: bytes a pixel, which of them is the height, and whether there are other colours.
fn layout(format: TextureFormat) -> Option<(usize, usize, Option<usize>, bool)> {
    use TextureFormat as F;
    Some(match format {
        F::R8Unorm | F::R8Uint => (1, 0, None, false),
        F::Rg8Unorm | F::Rg8Uint => (2, 0, None, false),
        F::Rgba8Unorm | F::Rgba8UnormSrgb | F::Rgba8Uint => (4, 0, Some(1), false),
        F::Bgra8Unorm | F::Bgra8UnormSrgb => (4, 2, Some(1), false),
        // Little-endian: the upper byte comes last.
        F::R16Unorm | F::R16Uint => (2, 1, None, true),
        F::Rg16Unorm | F::Rg16Uint => (4, 1, None, true),
        F::Rgba16Unorm | F::Rgba16Uint => (8, 1, Some(2), true),
        _ => return None,
    })
}

impl ReliefMap {
    /// The heights of an image.
    pub fn from_image(image: &Image) -> Result<Self, ReliefMapError> {
        let descriptor = &image.texture_descriptor;
        let (width, height) = (image.width(), image.height());
        if descriptor.dimension != TextureDimension::D2
            || descriptor.size.depth_or_array_layers != 1
        {
            return Err(ReliefMapError::NotFlat(descriptor.dimension));
        }
        if !(1..=LARGEST_SIDE).contains(&width) || !(1..=LARGEST_SIDE).contains(&height) {
            return Err(ReliefMapError::Size(width, height));
        }
        let format = descriptor.format;
        let (stride, byte, green, wide) = layout(format).ok_or(ReliefMapError::Format(format))?;
        let data = image.data.as_ref().ok_or(ReliefMapError::NoPixels)?;
        let needed = width as usize * height as usize * stride;
        let pixels = data
            .get(..needed)
            .ok_or(ReliefMapError::Short(data.len(), needed))?;
        let heights = pixels.chunks_exact(stride).map(|pixel| pixel[byte]);
        let is_grey =
            |pixel: &[u8]| green.is_none_or(|green| pixel[byte] == pixel[green + byte % 2]);
        let warning = if wide {
            Some(ReliefMapWarning::SixteenBits)
        } else if !pixels.chunks_exact(stride).all(is_grey) {
            Some(ReliefMapWarning::Colour)
        } else {
            None
        };
        let map = Self::new([width, height], heights.collect());
        Ok(Self { warning, ..map })
    }

    /// A map of rows from v = 0 on; there are as many pixels as the size says, at least one.
    pub(super) fn new(size: [u32; 2], heights: Vec<u8>) -> Self {
        let lowest = heights.iter().copied().min().unwrap_or(0);
        let highest = heights.iter().copied().max().unwrap_or(0);
        let mut levels = vec![heights];
        let mut side = size;
        while side != [1, 1] {
            let finest = levels.last().expect("there is one from the start");
            levels.push(reduced(finest, side));
            side = half(side);
        }
        Self {
            size,
            levels,
            range: [lowest, highest],
            warning: None,
        }
    }

    /// A map that is level at height 0: what stands for one that is not there.
    pub fn flat() -> Self {
        Self::new([1, 1], vec![0])
    }
}

/// Size of the mip level after one of this size.
pub(super) fn half(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| (side / 2).max(1))
}

/// The next mip level: each pixel the mean of those that it covers. Odd sides are covered whole, by weights (as
/// for textures whose sides are no powers of two in general).
fn reduced(level: &[u8], [width, height]: [u32; 2]) -> Vec<u8> {
    let half = half([width, height]);
    // By rows first, then by columns, in integers: a box that covers `side / half` pixels.
    let (across, along) = (spans(width, half[0]), spans(height, half[1]));
    let mut reduced = Vec::with_capacity((half[0] * half[1]) as usize);
    for rows in &along {
        for columns in &across {
            let (mut sum, mut weights) = (0.0f32, 0.0f32);
            for (y, wy) in rows {
                for (x, wx) in columns {
                    sum += wx * wy * f32::from(level[(y * width + x) as usize]);
                    weights += wx * wy;
                }
            }
            reduced.push((sum / weights).round() as u8);
        }
    }
    reduced
}

/// For each of `to` pixels, those of `from` that it covers, and by how much.
fn spans(from: u32, to: u32) -> Vec<Vec<(u32, f32)>> {
    let scale = from as f32 / to as f32;
    (0..to)
        .map(|i| {
            let (low, high) = (i as f32 * scale, (i + 1) as f32 * scale);
            (low as u32..(high.ceil() as u32).min(from))
                .map(|x| (x, (high.min((x + 1) as f32) - low.max(x as f32)).max(0.0)))
                .filter(|(_, weight)| *weight > 0.0)
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::asset::RenderAssetUsages;
    use bevy::render::render_resource::Extent3d;

    fn image(size: [u32; 2], format: TextureFormat, data: Vec<u8>) -> Image {
        let mut image = Image::new_uninit(
            Extent3d {
                width: size[0],
                height: size[1],
                depth_or_array_layers: 1,
            },
            TextureDimension::D2,
            format,
            RenderAssetUsages::default(),
        );
        image.data = Some(data);
        image
    }

    #[test]
    fn heights_are_the_bytes_of_a_grey_image_whatever_it_is_stored_as() {
        let grey = [0, 10, 200, 255];
        let rgba = grey.iter().flat_map(|&g| [g, g, g, 255]).collect();
        let wide = grey.iter().flat_map(|&g| [77, g]).collect();
        for (format, data, warning) in [
            (TextureFormat::R8Unorm, grey.to_vec(), None),
            (TextureFormat::Rgba8UnormSrgb, rgba, None),
            (
                TextureFormat::R16Uint,
                wide,
                Some(ReliefMapWarning::SixteenBits),
            ),
        ] {
            let map = ReliefMap::from_image(&image([2, 2], format, data)).unwrap();
            assert_eq!(map.levels[0], grey, "{format:?}");
            assert_eq!((map.range, map.warning), ([0, 255], warning));
        }
    }

    #[test]
    fn colours_are_told_of() {
        let data = vec![9, 9, 9, 255, 200, 9, 9, 255];
        let map = ReliefMap::from_image(&image([2, 1], TextureFormat::Rgba8Unorm, data)).unwrap();
        assert_eq!(map.levels[0], [9, 200]);
        assert_eq!(map.warning, Some(ReliefMapWarning::Colour));
    }

    #[test]
    fn what_is_no_relief_map_is_told_with_the_reason() {
        let huge = image([LARGEST_SIDE + 1, 1], TextureFormat::R8Unorm, Vec::new());
        let empty = image([0, 4], TextureFormat::R8Unorm, Vec::new());
        let float = image([1, 1], TextureFormat::Rgba32Float, vec![0; 16]);
        let short = image([4, 4], TextureFormat::R8Unorm, vec![0; 15]);
        let mut gone = image([1, 1], TextureFormat::R8Unorm, vec![0]);
        gone.data = None;
        for (image, said) in [
            (huge, "8193 x 1"),
            (empty, "0 x 4"),
            (float, "Rgba32Float"),
            (short, "15 bytes"),
            (gone, "main world"),
        ] {
            let error = ReliefMap::from_image(&image).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }

    #[test]
    fn every_mip_level_has_the_same_mean_to_half_a_level_a_step_and_stays_in_range() {
        for size in [[8u32, 4u32], [7, 5], [1, 9], [3, 1]] {
            let heights: Vec<u8> = (0..size[0] * size[1])
                .map(|i| (i * 37 % 251) as u8)
                .collect();
            let map = ReliefMap::new(size, heights);
            let mean = |level: &Vec<u8>| {
                level.iter().map(|&h| f32::from(h)).sum::<f32>() / level.len() as f32
            };
            assert_eq!(map.levels.last().unwrap().len(), 1);
            for (i, level) in map.levels.iter().enumerate() {
                let off = (mean(level) - mean(&map.levels[0])).abs();
                // Each reduction rounds to whole levels: at most half a level each time.
                assert!(
                    off <= 0.5 * i as f32 + 1e-3,
                    "{size:?}: level {i} is off by {off}"
                );
                assert!(
                    level
                        .iter()
                        .all(|h| (map.range[0]..=map.range[1]).contains(h))
                );
            }
        }
    }
}

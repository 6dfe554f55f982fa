//! Pictures that came back from the GPU.

use std::path::Path;

use bevy::image::Image;
use bevy::math::UVec2;
use bevy::render::render_resource::TextureFormat;

/// A picture: either colours of 8 bits, sRGB, or figures of 32-bit floats, four a pixel.
#[derive(Clone, Debug)]
pub struct Pixels {
    size: UVec2,
    format: TextureFormat,
    bytes: Vec<u8>,
}

impl Pixels {
    pub(super) fn new(image: Image) -> Self {
        Self {
            size: image.size(),
            format: image.texture_descriptor.format,
            bytes: image.data.expect("pictures come back with their data"),
        }
    }

    /// Width and height.
    pub fn size(&self) -> UVec2 {
        self.size
    }

    /// The four floats of a pixel.
    ///
    /// # Panics
    /// If the picture is one of colours, or the pixel is outside.
    pub fn floats(&self, x: u32, y: u32) -> [f32; 4] {
        assert_eq!(self.format, TextureFormat::Rgba32Float);
        let start = ((y * self.size.x + x) * 16) as usize;
        let bytes = &self.bytes[start..start + 16];
        core::array::from_fn(|i| f32::from_le_bytes([0, 1, 2, 3].map(|j| bytes[i * 4 + j])))
    }

    /// The colour of a pixel, sRGB.
    ///
    /// # Panics
    /// If the picture is one of floats, or the pixel is outside.
    pub fn rgb(&self, x: u32, y: u32) -> [u8; 3] {
        assert_eq!(self.format, TextureFormat::Rgba8UnormSrgb);
        let start = ((y * self.size.x + x) * 4) as usize;
        core::array::from_fn(|i| self.bytes[start + i])
    }

    /// All colours, row by row.
    pub fn rgb_bytes(&self) -> Vec<u8> {
        assert_eq!(self.format, TextureFormat::Rgba8UnormSrgb);
        let pixels = self.bytes.chunks_exact(4);
        pixels
            .flat_map(|pixel| [pixel[0], pixel[1], pixel[2]])
            .collect()
    }

    /// Writes a picture of colours as PNG.
    pub fn save_png(&self, path: &Path) -> Result<(), String> {
        let rgb = self.rgb_bytes();
        let file =
            std::fs::File::create(path).map_err(|error| format!("{}: {error}", path.display()))?;
        let encoder = image::codecs::png::PngEncoder::new_with_quality(
            std::io::BufWriter::new(file),
            image::codecs::png::CompressionType::Best,
            image::codecs::png::FilterType::Adaptive,
        );
        image::ImageEncoder::write_image(
            encoder,
            &rgb,
            self.size.x,
            self.size.y,
            image::ExtendedColorType::Rgb8,
        )
        .map_err(|error| format!("{}: {error}", path.display()))
    }
}

/// Reads a PNG: its size, and its colours of 8 bits, row by row.
pub fn load_png(path: &Path) -> Result<(UVec2, Vec<u8>), String> {
    let image = image::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let image = image.to_rgb8();
    Ok((UVec2::new(image.width(), image.height()), image.into_raw()))
}

//! Textures made by code.

use bevy::image::{ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

/// A texture that repeats, with all its mip levels, from the linear values of its pixels. `srgb` tells colours from
/// other data; normals are renormalised by the shader. Sides are powers of two.
pub fn texture(size: UVec2, srgb: bool, pixel: impl Fn(u32, u32) -> [f32; 4]) -> Image {
    let mut level: Vec<[f32; 4]> = (0..size.x * size.y)
        .map(|i| pixel(i % size.x, i / size.x))
        .collect();
    let encode = |value: &[f32; 4]| -> [u8; 4] {
        let [r, g, b, a] = *value;
        if srgb {
            Srgba::from(LinearRgba::new(r, g, b, a)).to_u8_array()
        } else {
            [r, g, b, a].map(|x| (x.clamp(0.0, 1.0) * 255.0).round() as u8)
        }
    };
    let mut data = Vec::new();
    let mut side = size;
    loop {
        data.extend(level.iter().flat_map(encode));
        if side == UVec2::ONE {
            break;
        }
        let below = (side / 2).max(UVec2::ONE);
        let at = |x: u32, y: u32| level[(y.min(side.y - 1) * side.x + x.min(side.x - 1)) as usize];
        let next = (0..below.x * below.y).map(|i| {
            let (x, y) = (i % below.x * 2, i / below.x * 2);
            let four = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            core::array::from_fn(|c| 0.25 * four.iter().map(|pixel| pixel[c]).sum::<f32>())
        });
        (level, side) = (next.collect(), below);
    }
    let format = if srgb {
        TextureFormat::Rgba8UnormSrgb
    } else {
        TextureFormat::Rgba8Unorm
    };
    let extent = Extent3d {
        width: size.x,
        height: size.y,
        depth_or_array_layers: 1,
    };
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, default());
    image.texture_descriptor.mip_level_count = extent.max_mips(TextureDimension::D2);
    image.data = Some(data);
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        mag_filter: ImageFilterMode::Linear,
        min_filter: ImageFilterMode::Linear,
        mipmap_filter: ImageFilterMode::Linear,
        ..default()
    });
    image
}

/// The same, square, from a function of u and v in 0..1.
pub fn painted(size: u32, srgb: bool, pixel: impl Fn(f32, f32) -> [f32; 4]) -> Image {
    texture(UVec2::splat(size), srgb, |x, y| {
        pixel(
            (x as f32 + 0.5) / size as f32,
            (y as f32 + 0.5) / size as f32,
        )
    })
}

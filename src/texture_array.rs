//! Layers of pictures as one texture: what slicings and texels are drawn from.

use bevy::asset::RenderAssetUsages;
use bevy::image::{Image, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::default;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureUsages, TextureViewDescriptor,
    TextureViewDimension,
};

/// A texture array of `data`: layer after layer, each with all its mip levels, the finest first.
pub(crate) fn texture_array(
    size: Extent3d,
    mip_levels: u32,
    format: TextureFormat,
    data: Vec<u8>,
    sampler: ImageSamplerDescriptor,
) -> Image {
    let usage = RenderAssetUsages::RENDER_WORLD;
    let mut image = Image::new_uninit(size, TextureDimension::D2, format, usage);
    image.texture_descriptor.mip_level_count = mip_levels;
    // Into a texture of the same shape that may be written to, Bevy 0.19 writes an edited image as if it had no mip levels.
    image.texture_descriptor.usage = TextureUsages::TEXTURE_BINDING;
    image.texture_view_descriptor = Some(TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2Array),
        ..default()
    });
    image.data = Some(data);
    image.sampler = ImageSampler::Descriptor(sampler);
    image
}

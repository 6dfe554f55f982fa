//! A slicing as the GPU has it: two texture arrays and a buffer of outlines.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::image::{Image, ImageAddressMode, ImageFilterMode, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{
    Extent3d, TextureDimension, TextureFormat, TextureViewDescriptor, TextureViewDimension,
};
use bevy::render::storage::ShaderBuffer;

use super::slicing::Slicing;

/// The box round a crown, with room to sway.
pub(crate) fn bounds(slicing: &Slicing) -> Aabb {
    let shape = slicing.shape();
    let reach = Vec3::splat(1.1 * shape.radius);
    Aabb::from_min_max(shape.centroid - reach, shape.centroid + reach)
}

/// The trimmed outlines of all layers.
pub(crate) fn octagons(slicing: &Slicing) -> ShaderBuffer {
    let corners = slicing.octagons().iter().flatten();
    let numbers: Vec<f32> = corners.flat_map(|corner| corner.to_array()).collect();
    ShaderBuffer::new(bytemuck::cast_slice(&numbers), RenderAssetUsages::default())
}

/// The texture arrays of colours and of normals.
pub(crate) fn images(slicing: &Slicing) -> [Image; 2] {
    let shape = slicing.shape();
    let formats = [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm];
    let [color, normal] = slicing.texture_bytes();
    let image = |data: Vec<u8>, format| {
        let size = Extent3d {
            width: shape.pixels,
            height: shape.pixels,
            depth_or_array_layers: shape.layers() as u32,
        };
        let mut image = Image::new_uninit(
            size,
            TextureDimension::D2,
            format,
            RenderAssetUsages::RENDER_WORLD,
        );
        image.texture_descriptor.mip_level_count = shape.pixels.ilog2() + 1;
        image.texture_view_descriptor = Some(TextureViewDescriptor {
            dimension: Some(TextureViewDimension::D2Array),
            ..default()
        });
        image.data = Some(data);
        // Slices of weight are seen at 30° or less from their normal, where a pixel is 1.15 times as long as wide:
        // anisotropic filtering would cost more than it shows.
        image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
            address_mode_u: ImageAddressMode::ClampToEdge,
            address_mode_v: ImageAddressMode::ClampToEdge,
            mag_filter: ImageFilterMode::Linear,
            min_filter: ImageFilterMode::Linear,
            mipmap_filter: ImageFilterMode::Linear,
            ..default()
        });
        image
    };
    [image(color, formats[0]), image(normal, formats[1])]
}

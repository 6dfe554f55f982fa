//! A slicing as the GPU has it: two texture arrays and a buffer of outlines.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::image::{Image, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureFormat};
use bevy::render::storage::ShaderBuffer;

use super::slicing::Slicing;
use crate::texture_array::texture_array;

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
    let size = Extent3d {
        width: shape.pixels,
        height: shape.pixels,
        depth_or_array_layers: shape.layers() as u32,
    };
    let mip_levels = shape.pixels.ilog2() + 1;
    // Slices of weight are seen at 30° or less from their normal, where a pixel is 1.15 times as long as wide: anisotropic
    // filtering would cost more than it shows.
    let sampler = ImageSamplerDescriptor::linear;
    let image = |data, format| texture_array(size, mip_levels, format, data, sampler());
    [image(color, formats[0]), image(normal, formats[1])]
}

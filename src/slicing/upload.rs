//! A slicing as the GPU has it: two texture arrays and a buffer of outlines.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::image::{Image, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureFormat};
use bevy::render::storage::ShaderBuffer;
use bevy::tasks::{ComputeTaskPool, TaskPool};

use super::octahedral::folded_pixel;
use super::slicing::Slicing;
use crate::texture_array::texture_array;
use crate::texture_compression::{Channels, compress};

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

/// The texture arrays of colours and of normals, `compressed` (BC3) or not.
pub(crate) fn images(slicing: &Slicing, compressed: bool) -> [Image; 2] {
    let shape = slicing.shape();
    let formats = if compressed {
        [TextureFormat::Bc3RgbaUnormSrgb, TextureFormat::Bc3RgbaUnorm]
    } else {
        [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm]
    };
    let size = Extent3d {
        width: shape.pixels,
        height: shape.pixels,
        depth_or_array_layers: shape.layers() as u32,
    };
    let mip_levels = shape.pixels.ilog2() + 1;
    let [color, normal] = data(slicing, compressed);
    // Slices of weight are seen at 30° or less from their normal, where a pixel is 1.15 times as long as wide: anisotropic
    // filtering would cost more than it shows.
    let sampler = ImageSamplerDescriptor::linear;
    let image = |data, format| texture_array(size, mip_levels, format, data, sampler());
    [image(color, formats[0]), image(normal, formats[1])]
}

/// Layers with their mip levels, worked out side by side.
fn data(slicing: &Slicing, compressed: bool) -> [Vec<u8>; 2] {
    let side = slicing.shape().pixels;
    let pool = ComputeTaskPool::get_or_init(TaskPool::new);
    let layers = pool.scope(|scope| {
        for layer in 0..slicing.shape().layers() {
            scope.spawn(async move {
                let [color, normal] = slicing.levels(layer);
                if compressed {
                    let normal: Vec<_> = normal.into_iter().map(folded_pixel).collect();
                    [
                        compress(&color, side, Channels::Colors),
                        compress(&normal, side, Channels::Numbers),
                    ]
                } else {
                    [color, normal].map(|levels| levels.as_flattened().to_vec())
                }
            });
        }
    });
    let (colors, normals): (Vec<_>, Vec<_>) = layers.into_iter().map(<(_, _)>::from).unzip();
    [colors.concat(), normals.concat()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slicing::tests::leaves;
    use crate::texture_compression::decompress;

    #[test]
    fn images_take_the_bytes_that_are_told_and_compressed_ones_a_quarter() {
        let slicing = leaves(64);
        let bytes = |compressed| -> u64 {
            let images = images(&slicing, compressed);
            images
                .iter()
                .map(|image| image.data.as_ref().map_or(0, Vec::len) as u64)
                .sum()
        };
        for compressed in [false, true] {
            assert_eq!(bytes(compressed), slicing.gpu_bytes(compressed));
        }
        // A quarter, and whole blocks for the levels of 2 and 1 pixels.
        assert!(bytes(true) as f64 <= 0.26 * bytes(false) as f64);
    }

    #[test]
    fn compressed_slices_cover_what_they_covered_in_every_level() {
        let slicing = leaves(64);
        let layers = 0..slicing.shape().layers();
        let pairs: Vec<[Vec<[u8; 4]>; 2]> = layers
            .map(|layer| {
                let [color, _] = slicing.levels(layer);
                let back = decompress(&compress(&color, 64, Channels::Colors), 64);
                [color, back]
            })
            .collect();
        let (mut start, mut side) = (0, 64);
        while side >= 1 {
            let level = start..start + side * side;
            let alphas = |which: usize| {
                let pixels = pairs
                    .iter()
                    .flat_map(move |pair| &pair[which][level.clone()]);
                pixels.map(|pixel| pixel[3])
            };
            let [before, after] = [0, 1].map(|which| alphas.clone()(which).collect::<Vec<u8>>());
            let count = before.len() as f32;
            let mean = |alphas: &[u8]| alphas.iter().map(|a| f32::from(*a)).sum::<f32>() / count;
            let off = (mean(&after) - mean(&before)).abs();
            // Rounded to steps of a seventh of all at most, up as often as down: four standard deviations of their mean.
            let step = 255.0 / 7.0;
            assert!(off <= 4.0 * step / (12.0 * count).sqrt(), "{side}: {off}");
            let opaque = |alphas: &[u8]| alphas.iter().filter(|a| **a >= 128).count();
            let near = |a: &&u8| f32::from(a.abs_diff(128)) <= 0.5 * step + 1.0;
            let doubtful = before.iter().filter(near).count();
            let changed = opaque(&after).abs_diff(opaque(&before));
            println!(
                "{side}: mean {off:.3} off, {changed} of {} change sides",
                opaque(&before)
            );
            assert!(changed <= doubtful, "{side}: {changed} {doubtful}");
            start += side * side;
            side /= 2;
        }
    }
}

//! Slicings as the GPU has them: two texture arrays, a buffer of outlines and one of shapes.

use bevy::asset::RenderAssetUsages;
use bevy::camera::primitives::Aabb;
use bevy::image::{Image, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureFormat};
use bevy::render::storage::ShaderBuffer;
use bevy::tasks::{ComputeTaskPool, TaskPool};

use super::material::CrownRecord;
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

/// The trimmed outlines of all layers of slicings.
pub(crate) fn octagons(slicings: &[&Slicing]) -> ShaderBuffer {
    let octagons = slicings.iter().flat_map(|slicing| slicing.octagons());
    let numbers: Vec<f32> = octagons
        .flatten()
        .flat_map(|corner| corner.to_array())
        .collect();
    ShaderBuffer::new(bytemuck::cast_slice(&numbers), RenderAssetUsages::default())
}

/// The shapes of slicings of which the layers follow one another.
pub(crate) fn records(slicings: &[&Slicing]) -> ShaderBuffer {
    let mut layers_before = 0;
    let records: Vec<CrownRecord> = slicings
        .iter()
        .map(|slicing| {
            let record = CrownRecord::new(slicing.shape(), layers_before);
            layers_before += slicing.shape().layers() as u32;
            record
        })
        .collect();
    ShaderBuffer::from(records)
}

/// The texture arrays of colours and of normals, `compressed` (BC3) or not, of so many pixels along a side; `data` are their
/// bytes.
pub(crate) fn images(
    [color, normal]: [Vec<u8>; 2],
    pixels: u32,
    layers: u32,
    compressed: bool,
) -> [Image; 2] {
    let formats = if compressed {
        [TextureFormat::Bc3RgbaUnormSrgb, TextureFormat::Bc3RgbaUnorm]
    } else {
        [TextureFormat::Rgba8UnormSrgb, TextureFormat::Rgba8Unorm]
    };
    let size = Extent3d {
        width: pixels,
        height: pixels,
        depth_or_array_layers: layers,
    };
    let mip_levels = pixels.ilog2() + 1;
    // Slices of weight are seen at 30° or less from their normal, where a pixel is 1.15 times as long as wide: anisotropic
    // filtering would cost more than it shows.
    let sampler = ImageSamplerDescriptor::linear;
    let image = |data, format| texture_array(size, mip_levels, format, data, sampler());
    [image(color, formats[0]), image(normal, formats[1])]
}

/// The bytes of both texture arrays of a slicing: layers with their mip levels, worked out side by side.
pub(crate) fn data(slicing: &Slicing, compressed: bool) -> [Vec<u8>; 2] {
    let pool = ComputeTaskPool::get_or_init(TaskPool::new);
    let layers = pool.scope(|scope| {
        for layer in 0..slicing.shape().layers() {
            scope.spawn(async move { layer_data(slicing, layer, compressed) });
        }
    });
    let (colors, normals): (Vec<_>, Vec<_>) = layers.into_iter().map(<(_, _)>::from).unzip();
    [colors.concat(), normals.concat()]
}

/// The same of slicings that follow one another, worked out layer by layer, behind the frames.
pub(crate) async fn data_behind(slicings: Vec<Slicing>, compressed: bool) -> [Vec<u8>; 2] {
    let bytes = slicings.iter().map(|slicing| slicing.gpu_bytes(compressed));
    let half = bytes.sum::<u64>() as usize / 2;
    let mut data = [(); 2].map(|()| Vec::with_capacity(half));
    for slicing in &slicings {
        for layer in 0..slicing.shape().layers() {
            let layer = layer_data(slicing, layer, compressed);
            for (all, bytes) in data.iter_mut().zip(&layer) {
                all.extend_from_slice(bytes);
            }
            // Pipelines are compiled, and pictures read back, by the same few threads.
            bevy::tasks::futures_lite::future::yield_now().await;
        }
    }
    data
}

/// The bytes of a layer's colours and normals.
fn layer_data(slicing: &Slicing, layer: usize, compressed: bool) -> [Vec<u8>; 2] {
    let side = slicing.shape().pixels;
    let [color, normal] = slicing.levels(layer);
    if !compressed {
        return [color, normal].map(|levels| levels.as_flattened().to_vec());
    }
    let normal: Vec<_> = normal.into_iter().map(folded_pixel).collect();
    [
        compress(&color, side, Channels::Colors),
        compress(&normal, side, Channels::Numbers),
    ]
}

#[cfg(test)]
mod tests {
    use bevy::tasks::block_on;

    use super::*;
    use crate::slicing::tests::leaves;
    use crate::texture_compression::decompress;

    #[test]
    fn images_take_the_bytes_that_are_told_and_compressed_ones_a_quarter() {
        let slicing = leaves(64);
        let bytes = |compressed| -> u64 {
            let data = data(&slicing, compressed);
            data.iter().map(|bytes| bytes.len() as u64).sum()
        };
        for compressed in [false, true] {
            assert_eq!(bytes(compressed), slicing.gpu_bytes(compressed));
        }
        // A quarter, and whole blocks for the levels of 2 and 1 pixels.
        assert!(bytes(true) as f64 <= 0.26 * bytes(false) as f64);
    }

    #[test]
    fn slicings_that_follow_one_another_are_the_bytes_of_each() {
        let slicings = [leaves(16), leaves(16)];
        for compressed in [false, true] {
            let together = block_on(data_behind(slicings.to_vec(), compressed));
            let alone = data(&slicings[0], compressed);
            assert_eq!(together, alone.map(|bytes| bytes.repeat(2)), "{compressed}");
        }
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

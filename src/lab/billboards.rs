//! A rival of slicing: a crossed pair of billboards, baked from the same crown and made well: trimmed, with normals of the
//! leaves, and with mip levels whose masks cover as much as the finest. They are lit by the whole of Bevy's
//! `StandardMaterial`.

use bevy::asset::RenderAssetUsages;
use bevy::image::{Image, ImageSampler};
use bevy::math::Vec3;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};
use bevy::pbr::StandardMaterial;
use bevy::prelude::{AlphaMode, Assets, Handle, World};
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

use crate::slicing::bake::color::{decode, encode, unorm};
use crate::slicing::{
    BakeError, BakeSettings, CrownMesh, MAX_PIXELS, Orientations, Slicing, SlicingShape,
    bake_unchecked,
};

/// Alpha from which on a pixel of a billboard is there.
const MASK: f32 = 0.5;

/// A flat picture of a crown: its mesh and its material.
pub type Billboard = (Handle<Mesh>, Handle<StandardMaterial>);

/// Bakes and adds a crossed pair of billboards of so many pixels a side, 16 to 2048. What is below or above is taken for the
/// nearest.
///
/// # Errors
/// When the crown cannot be baked, as [`bake()`](crate::slicing::bake()) says.
pub fn add_billboards(
    world: &mut World,
    crown: &CrownMesh,
    pixels: u32,
) -> Result<Vec<Billboard>, BakeError> {
    let pixels = pixels.clamp(16, 2048);
    let finer = pixels.next_power_of_two();
    let settings = BakeSettings {
        vertical: false,
        // More pixels a side than slices may have are samples enough.
        samples: if finer > MAX_PIXELS { 2 } else { 4 },
        ..BakeSettings::default()
            .with_slices(1)
            .with_pixels(finer)
            .with_orientations(Orientations::Arc {
                count: 2,
                from: 0.0,
                to: core::f32::consts::FRAC_PI_2,
            })
    };
    let slicing = resized(bake_unchecked(crown, &settings)?, pixels);
    let [colors, normals] = slicing.texture_bytes();
    let length = colors.len() / slicing.shape().layers();
    let mut pair = Vec::new();
    for layer in 0..slicing.shape().layers() {
        let bytes = |all: &[u8]| all[layer * length..(layer + 1) * length].to_vec();
        let mut color = bytes(&colors);
        keep_coverage(&mut color, pixels);
        let mut normal = bytes(&normals);
        to_tangents(&mut normal, slicing.shape(), layer);
        let mut images = world.resource_mut::<Assets<Image>>();
        let color = images.add(image(color, pixels, TextureFormat::Rgba8UnormSrgb));
        let normal = images.add(image(normal, pixels, TextureFormat::Rgba8Unorm));
        let material = world
            .resource_mut::<Assets<StandardMaterial>>()
            .add(StandardMaterial {
                base_color_texture: Some(color),
                normal_map_texture: Some(normal),
                alpha_mode: AlphaMode::Mask(MASK),
                perceptual_roughness: 0.75,
                reflectance: 0.3,
                double_sided: true,
                cull_mode: None,
                ..Default::default()
            });
        let mesh = world
            .resource_mut::<Assets<Mesh>>()
            .add(billboard(&slicing, layer));
        pair.push((mesh, material));
    }
    Ok(pair)
}

/// A slicing with pictures of another size, no larger: each pixel is the mean of those that it covers, by how much of them
/// it does; of colours and normals by alpha too.
fn resized(slicing: Slicing, side: u32) -> Slicing {
    let from = slicing.shape().pixels;
    if side == from {
        return slicing;
    }
    let shares: Vec<_> = (0..side).map(|i| covered(i, side, from)).collect();
    let (mut colors, mut normals) = (Vec::new(), Vec::new());
    for layer in 0..slicing.shape().layers() {
        let (color, normal) = (slicing.color(layer), slicing.normal(layer));
        for (rows, columns) in shares
            .iter()
            .flat_map(|y| shares.iter().map(move |x| (y, x)))
        {
            let places = rows.iter().flat_map(|(y, tall)| {
                let row = *y * from as usize;
                columns.iter().map(move |(x, wide)| (row + *x, tall * wide))
            });
            let (of_color, of_normal) = mean(places.map(|(i, area)| (color[i], normal[i], area)));
            colors.push(of_color);
            normals.push(of_normal);
        }
    }
    let shape = SlicingShape {
        pixels: side,
        ..slicing.shape().clone()
    };
    Slicing::trimmed(shape, colors, normals)
}

/// The pixels of `from` that pixel `index` of `side` covers, along a side, and how much of it is theirs.
fn covered(index: u32, side: u32, from: u32) -> Vec<(usize, f32)> {
    let step = from as f32 / side as f32;
    let (low, high) = (index as f32 * step, (index + 1) as f32 * step);
    let last = (high.ceil() as u32).min(from);
    (low as u32..last)
        .map(|i| {
            let share = (high.min(i as f32 + 1.0) - low.max(i as f32)) / step;
            (i as usize, share.max(0.0))
        })
        .collect()
}

/// The mean of pixels' colours and normals, each with its area; the areas add up to 1.
fn mean(pixels: impl Iterator<Item = ([u8; 4], [u8; 4], f32)>) -> ([u8; 4], [u8; 4]) {
    let (mut light, mut normal) = ([0.0; 3], [0.0; 4]);
    let (mut alpha, mut all) = (0.0, 0.0);
    for ([r, g, b, a], n, area) in pixels {
        let a = f32::from(a) / 255.0;
        // Next to nothing where all is transparent: the colour under it is kept for filtering.
        let weight = area * (a + 1e-3);
        for (sum, byte) in light.iter_mut().zip([r, g, b]) {
            *sum += weight * decode(byte);
        }
        for (sum, byte) in normal.iter_mut().zip(n) {
            *sum += weight * f32::from(byte) / 255.0;
        }
        alpha += area * a;
        all += weight;
    }
    let [r, g, b] = light.map(|sum| encode(sum / all));
    ([r, g, b, unorm(alpha)], normal.map(|sum| unorm(sum / all)))
}

/// The trimmed outline of a layer through the crown's middle.
fn billboard(slicing: &Slicing, layer: usize) -> Mesh {
    let shape = slicing.shape();
    let o = shape.orientations[layer];
    let size = o.high - o.low;
    let outline = slicing.octagons()[layer];
    let positions: Vec<Vec3> = outline
        .iter()
        .map(|uv| {
            shape.centroid + o.right * (o.low.x + uv.x * size.x) + o.up * (o.high.y - uv.y * size.y)
        })
        .collect();
    let corners = positions.len();
    let indices = (1..corners as u32 - 1).flat_map(|i| [0, i, i + 1]);
    let uvs: Vec<[f32; 2]> = outline.iter().map(|uv| uv.to_array()).collect();
    let tangent = o.right.extend(1.0).to_array();
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(
        Mesh::ATTRIBUTE_NORMAL,
        vec![o.direction.to_array(); corners],
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, vec![tangent; corners])
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
    .with_inserted_indices(Indices::U32(indices.collect()))
}

/// Turns local normals into the billboard's tangent space.
fn to_tangents(normals: &mut [u8], shape: &SlicingShape, layer: usize) {
    let o = shape.orientations[layer];
    for pixel in normals.chunks_exact_mut(4) {
        let n =
            Vec3::from([pixel[0], pixel[1], pixel[2]].map(|byte| f32::from(byte) / 127.5 - 1.0));
        let n = o.axes(n).normalize_or(Vec3::Z);
        for (byte, along) in pixel.iter_mut().zip(n.to_array()) {
            *byte = ((along + 1.0) * 127.5).round() as u8;
        }
    }
}

/// Scales alpha in each mip level so that the mask lets as many pixels be as in the finest.
fn keep_coverage(levels: &mut [u8], size: u32) {
    let pixels = |level: u32| (size >> level).pow(2) as usize;
    let covered = |bytes: &[u8], scale: f32| {
        let there = bytes
            .chunks_exact(4)
            .filter(|pixel| f32::from(pixel[3]) * scale >= 255.0 * MASK);
        there.count() as f32 / (bytes.len() / 4) as f32
    };
    let wanted = covered(&levels[..pixels(0) * 4], 1.0);
    let mut start = pixels(0) * 4;
    for level in 1..=size.ilog2() {
        let bytes = &mut levels[start..start + pixels(level) * 4];
        // Between nothing and eight times, by halves.
        let (mut low, mut high) = (0.0, 8.0);
        for _ in 0..16 {
            let middle = 0.5 * (low + high);
            if covered(bytes, middle) < wanted {
                low = middle;
            } else {
                high = middle;
            }
        }
        for pixel in bytes.chunks_exact_mut(4) {
            // Up, so that what just passes the mask does so in eight bits.
            pixel[3] = (f32::from(pixel[3]) * high).ceil().min(255.0) as u8;
        }
        start += pixels(level) * 4;
    }
}

/// A texture with all its mip levels.
fn image(data: Vec<u8>, size: u32, format: TextureFormat) -> Image {
    let extent = Extent3d {
        width: size,
        height: size,
        depth_or_array_layers: 1,
    };
    let usage = RenderAssetUsages::RENDER_WORLD;
    let mut image = Image::new_uninit(extent, TextureDimension::D2, format, usage);
    image.texture_descriptor.mip_level_count = size.ilog2() + 1;
    image.data = Some(data);
    image.sampler = ImageSampler::linear();
    image
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::slicing::Orientation;

    #[test]
    fn a_picture_of_another_size_covers_as_much_in_the_same_colours() {
        let mut orientation = Orientation::facing(Vec3::X);
        (orientation.low, orientation.high) = (Vec3::NEG_ONE, Vec3::ONE);
        let shape = SlicingShape {
            centroid: Vec3::ZERO,
            radius: 1.0,
            pixels: 64,
            levels: vec![1],
            switches: Vec::new(),
            correction: 0.5,
            diffuse_transmission: 0.0,
            sphere: false,
            vertical: false,
            orientations: vec![orientation],
        };
        // Opaque green in a transparent red that nothing may come in of.
        let is_there = |i: u32| i / 64 % 7 < 3 && i % 5 < 2;
        let color = (0..64 * 64).map(|i| {
            if is_there(i) {
                [20, 200, 40, 255]
            } else {
                [255, 0, 0, 0]
            }
        });
        let normal = vec![[255, 128, 128, 200]; 64 * 64];
        let fine = Slicing::trimmed(shape, color.collect(), normal);
        let alpha = |slicing: &Slicing| {
            let pixels = slicing.color(0);
            let sum: f32 = pixels.iter().map(|p| f32::from(p[3])).sum();
            sum / pixels.len() as f32
        };
        for side in [64, 45, 40, 33] {
            let small = resized(fine.clone(), side);
            assert_eq!(small.color(0).len() as u32, side * side);
            // Half a step of eight bits.
            assert!((alpha(&small) - alpha(&fine)).abs() <= 0.5, "{side}");
            for ([r, _, _, a], normal) in small.color(0).iter().zip(small.normal(0)) {
                // What is there a quarter has three thousandths of its light from the red.
                assert!(*a < 64 || *r < 40, "{side}: {r} {a}");
                assert_eq!(*normal, [255, 128, 128, 200], "{side}");
            }
        }
    }

    #[test]
    fn a_mask_covers_as_much_in_every_level() {
        // A disc of opaque pixels in a finest level of 64², with plain means below.
        let alpha = |x: u32, y: u32| {
            let (x, y) = (x as f32 - 31.5, y as f32 - 31.5);
            if x * x + y * y < 400.0 && (x as i32 + y as i32) % 3 != 0 {
                255.0
            } else {
                0.0
            }
        };
        let mut level: Vec<f32> = (0..64 * 64).map(|i: u32| alpha(i % 64, i / 64)).collect();
        let mut bytes = Vec::new();
        let mut side = 64_usize;
        loop {
            bytes.extend(level.iter().flat_map(|a| [0, 0, 0, *a as u8]));
            if side == 1 {
                break;
            }
            let half = side / 2;
            level = (0..half * half)
                .map(|i| {
                    let at = |dx: usize, dy: usize| {
                        level[(i / half * 2 + dy) * side + i % half * 2 + dx]
                    };
                    0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1))
                })
                .collect();
            side = half;
        }
        keep_coverage(&mut bytes, 64);
        let share = |bytes: &[u8]| {
            bytes.chunks_exact(4).filter(|p| p[3] >= 128).count() as f32 * 4.0 / bytes.len() as f32
        };
        let finest = share(&bytes[..64 * 64 * 4]);
        let next = share(&bytes[64 * 64 * 4..(64 + 16) * 64 * 4]);
        // Many pixels of a checkered disc have the same alpha and come in at once: those with two of four.
        assert!(next >= finest && next < 1.6 * finest, "{finest} {next}");
    }
}

//! A volume's slices as texture arrays: one of colours and one of normals for each direction, in which the sets of 1, 2, 4
//! and so on slices follow one another, so that slice k of N is layer N − 1 + k.

use bevy::image::{Image, ImageAddressMode, ImageFilterMode, ImageSamplerDescriptor};
use bevy::render::render_resource::{Extent3d, TextureFormat};

use super::super::axis::SliceAxis;
use super::super::slice_sets::{SliceLevel, SliceSet, SliceSets};
use crate::texture_array::texture_array;

/// The images of colours and of normals for u, v and w.
pub(crate) fn slice_images(sets: &SliceSets) -> [[Image; 2]; 3] {
    SliceAxis::ALL.map(|axis| {
        let sets: Vec<&SliceSet> = sets.iter().filter(|set| set.axis == axis).collect();
        [
            image(
                &sets,
                TextureFormat::Rgba8UnormSrgb,
                ImageFilterMode::Linear,
                |level| &level.colors,
            ),
            // Where slices are there is looked up most of all: in one mip level, for half the cost of two.
            image(
                &sets,
                TextureFormat::Rgba8Unorm,
                ImageFilterMode::Nearest,
                |level| &level.normals,
            ),
        ]
    })
}

fn image(
    sets: &[&SliceSet],
    format: TextureFormat,
    between_levels: ImageFilterMode,
    pixels: impl Fn(&SliceLevel) -> &[[u8; 4]],
) -> Image {
    let [width, height] = sets[0].levels[0].size;
    let layers: u32 = sets.iter().map(|set| set.count).sum();
    let mut data = Vec::new();
    for set in sets {
        for slice in 0..set.count as usize {
            for level in &set.levels {
                let count = (level.size[0] * level.size[1]) as usize;
                let slice = &pixels(level)[slice * count..(slice + 1) * count];
                data.extend_from_slice(bytemuck::cast_slice(slice));
            }
        }
    }
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: layers,
    };
    let sampler = ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        // Rows of upright slices are heights, which end.
        address_mode_v: match sets[0].axis {
            SliceAxis::W => ImageAddressMode::Repeat,
            SliceAxis::U | SliceAxis::V => ImageAddressMode::ClampToEdge,
        },
        mipmap_filter: between_levels,
        ..ImageSamplerDescriptor::linear()
    };
    let mip_levels = sets[0].levels.len() as u32;
    texture_array(size, mip_levels, format, data, sampler)
}

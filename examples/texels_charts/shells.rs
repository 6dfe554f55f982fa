//! Plain shells, as shaders of fur have them: textured copies of the ground, one over the other, always as many.

use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::texel::{SliceAxis, SliceSet};

use super::field::Field;

impl Field {
    /// Covers the field with so many shells, lit by the normals of the volume.
    pub fn add_shells(&mut self, count: u32) -> Vec<Entity> {
        let set = SliceSet::new(&self.volume, SliceAxis::W, count);
        // u is to the right, and v away from the eye.
        let ground = self.ground();
        let tangents = vec![[1.0, 0.0, 0.0, 1.0]; ground.count_vertices()];
        let mesh = ground.with_inserted_attribute(Mesh::ATTRIBUTE_TANGENT, tangents);
        let thickness = self.texel.y;
        let world = self.studio.world();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        (0..set.count)
            .map(|slice| {
                let mut images = world.resource_mut::<Assets<Image>>();
                let color = images.add(image(&set, slice, TextureFormat::Rgba8UnormSrgb));
                let normal = images.add(image(&set, slice, TextureFormat::Rgba8Unorm));
                let look = StandardMaterial {
                    base_color_texture: Some(color),
                    normal_map_texture: Some(normal),
                    alpha_mode: AlphaMode::Mask(0.5),
                    perceptual_roughness: 0.8,
                    reflectance: 0.3,
                    cull_mode: None,
                    ..default()
                };
                let look = world.resource_mut::<Assets<StandardMaterial>>().add(look);
                let height = thickness * (slice as f32 + 0.5) / set.count as f32;
                let place = Transform::from_xyz(0.0, height, 0.0);
                world
                    .spawn((Mesh3d(mesh.clone()), MeshMaterial3d(look), place))
                    .id()
            })
            .collect()
    }
}

/// The colours or the normals of one slice, with mip levels.
fn image(set: &SliceSet, slice: u32, format: TextureFormat) -> Image {
    let mut data = Vec::new();
    for level in &set.levels {
        let count = (level.size[0] * level.size[1]) as usize;
        let pixels = if format == TextureFormat::Rgba8Unorm {
            &level.normals
        } else {
            &level.colors
        };
        data.extend_from_slice(pixels[slice as usize * count..][..count].as_flattened());
    }
    let [width, height] = set.levels[0].size;
    let size = Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    };
    let mut image = Image::new_uninit(
        size,
        TextureDimension::D2,
        format,
        RenderAssetUsages::RENDER_WORLD,
    );
    image.data = Some(data);
    image.texture_descriptor.mip_level_count = set.levels.len() as u32;
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}

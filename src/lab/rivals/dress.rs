//! What surfaces look like, to frusta and polygons alike.

use bevy::asset::RenderAssetUsages;
use bevy::image::{ImageAddressMode, ImageSampler, ImageSamplerDescriptor};
use bevy::math::Affine2;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

use crate::frusta::{Relief, ReliefThickness};
use crate::lab::reference::relief::HeightImage;
use crate::lab::texture::texture;
use crate::plants::Surface;
use crate::plants::maps::{Finish, Maps};

/// The look of one kind of surface.
pub struct Dress {
    /// Colour, roughness, and the scale of the maps.
    pub material: StandardMaterial,
    /// Relief, where there is some, as the defaults march it.
    pub relief: Option<Relief>,
    heights: Option<HeightImage>,
    size: UVec2,
    repeats: f64,
}

impl Dress {
    /// Paints the look of a surface.
    pub fn paint(kind: Surface, images: &mut Assets<Image>) -> Self {
        let (finish, maps) = (Finish::of(kind), Maps::paint(kind));
        let size = UVec2::from(maps.size);
        let color = texture(size, true, |x, y| {
            let [r, g, b, _] = maps.color[(y * size.x + x) as usize];
            let color = Color::srgb_u8(r, g, b).to_linear();
            [color.red, color.green, color.blue, 1.0]
        });
        let relief = finish.thickness.zip(maps.height.as_ref());
        let relief = relief.map(|(thickness, heights)| {
            let map = images.add(height_image(size, heights.clone()));
            // The joint's radius is the outer frustum's.
            Relief::new(map, ReliefThickness::Relative(thickness)).with_level(1.0)
        });
        Self {
            material: StandardMaterial {
                base_color_texture: Some(images.add(color)),
                perceptual_roughness: finish.roughness,
                reflectance: finish.reflectance,
                uv_transform: Affine2::from_scale(Vec2::new(1.0, finish.repeats)),
                ..default()
            },
            relief,
            heights: (maps.height)
                .map(|heights| HeightImage::new(size.x as usize, size.y as usize, heights)),
            size,
            repeats: f64::from(finish.repeats),
        }
    }

    /// Relief height at (u, v) of the skeleton's texture coordinates: the map's pixels, interpolated as a sampler does.
    pub fn height(&self, u: f64, v: f64) -> f64 {
        let heights = self.heights.as_ref();
        heights.map_or(1.0, |heights| heights.sample(u, v * self.repeats))
    }

    /// Bytes of the relief map with its mip levels, as the device holds it; 0 without relief.
    pub fn relief_bytes(&self) -> usize {
        if self.relief.is_none() {
            return 0;
        }
        let [mut width, mut length] = self.size.to_array();
        let mut bytes = width * length;
        while [width, length] != [1, 1] {
            (width, length) = ((width / 2).max(1), (length / 2).max(1));
            bytes += width * length;
        }
        bytes as usize
    }
}

fn height_image(size: UVec2, heights: Vec<u8>) -> Image {
    let extent = Extent3d {
        width: size.x,
        height: size.y,
        depth_or_array_layers: 1,
    };
    let mut image = Image::new(
        extent,
        TextureDimension::D2,
        heights,
        TextureFormat::R8Unorm,
        RenderAssetUsages::default(),
    );
    image.sampler = ImageSampler::Descriptor(ImageSamplerDescriptor {
        address_mode_u: ImageAddressMode::Repeat,
        address_mode_v: ImageAddressMode::Repeat,
        ..ImageSamplerDescriptor::linear()
    });
    image
}

/// Looks that have been painted, each once.
#[derive(Default)]
pub struct Wardrobe {
    dresses: HashMap<Surface, Dress>,
}

impl Wardrobe {
    /// The look of a surface.
    pub fn get(&mut self, kind: Surface, world: &mut World) -> &Dress {
        self.dresses
            .entry(kind)
            .or_insert_with(|| Dress::paint(kind, &mut world.resource_mut::<Assets<Image>>()))
    }
}

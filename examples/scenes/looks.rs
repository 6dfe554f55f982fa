//! What each kind of surface looks like: the stored maps of `assets/plants`, with relief or with normal maps of it.

use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

use bevy::asset::RenderAssetUsages;
use bevy::math::Affine2;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::plants::Surface;
use bevy_verdure::plants::maps::{Finish, SURFACES};
use bevy_verdure::prelude::*;

use super::common::texture::texture;

/// The material of a kind of surface. Its relief is a normal map.
pub fn look(surface: Surface, images: &mut Assets<Image>) -> StandardMaterial {
    let finish = Finish::of(surface);
    let mut material = StandardMaterial {
        perceptual_roughness: finish.roughness,
        reflectance: finish.reflectance,
        uv_transform: Affine2::from_scale(Vec2::new(1.0, finish.repeats)),
        ..default()
    };
    match color(surface) {
        Ok(image) => material.base_color_texture = Some(images.add(image)),
        Err(error) => error!("{error}"),
    }
    if let Some(thickness) = finish.thickness {
        match normals(surface, thickness, finish.length) {
            Ok(image) => material.normal_map_texture = Some(images.add(image)),
            Err(error) => error!("{error}"),
        }
    }
    material
}

/// The material of a kind of surface with relief, if it has any, from what [`look`] made.
pub fn relief(
    surface: Surface,
    look: &StandardMaterial,
    images: &mut Assets<Image>,
) -> Option<FrustaMaterial> {
    let thickness = Finish::of(surface).thickness?;
    let map = open(surface, "height").map_err(|error| error!("{error}"));
    let map = map.ok()?.into_luma8();
    let extent = Extent3d {
        width: map.width(),
        height: map.height(),
        depth_or_array_layers: 1,
    };
    let map = images.add(Image::new(
        extent,
        TextureDimension::D2,
        map.into_raw(),
        TextureFormat::R8Unorm,
        RenderAssetUsages::MAIN_WORLD,
    ));
    let base = StandardMaterial {
        normal_map_texture: None,
        ..look.clone()
    };
    // A joint's radius is that of the outer frustum.
    let relief = Relief::new(map, ReliefThickness::Relative(thickness)).with_level(1.0);
    Some(relief_material(base, relief))
}

fn file(surface: Surface, map: &str) -> PathBuf {
    let known = SURFACES.iter().find(|(kind, _)| *kind == surface);
    let name = known.map_or("unknown", |(_, name)| name);
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("assets/plants/{name}_{map}.png"))
}

fn open(surface: Surface, map: &str) -> Result<image::DynamicImage, String> {
    let file = file(surface, map);
    image::open(&file).map_err(|error| format!("{}: {error}", file.display()))
}

fn color(surface: Surface) -> Result<Image, String> {
    let map = open(surface, "color")?.into_rgb8();
    let size = UVec2::new(map.width(), map.height());
    Ok(texture(size, true, |x, y| {
        let [r, g, b] = map.get_pixel(x, y).0;
        let color = Color::srgb_u8(r, g, b).to_linear();
        [color.red, color.green, color.blue, 1.0]
    }))
}

/// The slopes of a height map whose shell has a thickness of so many radii, and which is so many circumferences long.
fn normals(surface: Surface, thickness: f32, length: f32) -> Result<Image, String> {
    let map = open(surface, "height")?.into_luma8();
    let size = UVec2::new(map.width(), map.height());
    let height = |x: u32, y: u32| f32::from(map.get_pixel(x % size.x, y % size.y).0[0]) / 255.0;
    let scale = thickness / TAU * size.as_vec2() / Vec2::new(1.0, length);
    Ok(texture(size, false, |x, y| {
        let across = height(x + 1, y) - height(x + size.x - 1, y);
        let along = height(x, y + 1) - height(x, y + size.y - 1);
        let slope = 0.5 * Vec2::new(across, along) * scale;
        // Green points to falling v, as everywhere in Bevy.
        let normal = Vec3::new(-slope.x, slope.y, 1.0).normalize() * 0.5 + 0.5;
        [normal.x, normal.y, normal.z, 1.0]
    }))
}

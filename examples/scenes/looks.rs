//! What each kind of surface looks like, by the stored maps of `assets/plants`: with relief, or with normal maps of it.

use std::f32::consts::TAU;
use std::path::PathBuf;
use std::sync::Arc;

use bevy::asset::RenderAssetUsages;
use bevy::math::Affine2;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::frusta::double::shell::ShellShape;
use bevy_verdure::lab::reference::relief::HeightImage;
use bevy_verdure::plants::Surface;
use bevy_verdure::plants::maps::{Finish, SURFACES};
use bevy_verdure::prelude::*;
use image::GrayImage;

use super::common::texture::texture;

/// The looks of one kind of surface, for each way to draw it.
#[derive(Component, Clone)]
pub struct Looks {
    /// Smooth frusta, on which relief is a normal map.
    pub rays: Handle<FrustaMaterial>,
    /// Frusta with relief, where there is some.
    pub relief: Handle<FrustaMaterial>,
    /// Polygons, which relief displaces.
    pub polygons: Handle<StandardMaterial>,
    /// The relief as polygons take it.
    pub carved: Option<Arc<Carved>>,
}

/// Relief that displaces polygons.
pub struct Carved {
    heights: HeightImage,
    repeats: f64,
    relief: Relief,
}

impl Carved {
    /// H of u and the skeleton's v.
    pub fn height(&self, u: f64, v: f64) -> f64 {
        self.heights.sample(u, v * self.repeats)
    }

    /// The shell that it stands in.
    pub fn shell(&self) -> Option<ShellShape> {
        self.relief.mesh_shell()
    }
}

impl Looks {
    /// The looks of a kind of surface, from its stored maps. What cannot be opened is told of and left out.
    pub fn of(surface: Surface, world: &mut World) -> Self {
        let finish = Finish::of(surface);
        let mut bare = StandardMaterial {
            perceptual_roughness: finish.roughness,
            reflectance: finish.reflectance,
            uv_transform: Affine2::from_scale(Vec2::new(1.0, finish.repeats)),
            ..default()
        };
        let mut images = world.resource_mut::<Assets<Image>>();
        let told = |error: String| error!("{error}");
        bare.base_color_texture = color(surface).map_err(told).ok().map(|i| images.add(i));
        let mut smooth = bare.clone();
        let mut carved = None;
        let relief = finish.thickness.and_then(|t| Some((t, heights(surface)?)));
        if let Some((thickness, heights)) = relief {
            smooth.normal_map_texture =
                Some(images.add(normals(&heights, thickness, finish.length)));
            let map = images.add(height_image(&heights));
            // A joint's radius is that of the outer frustum.
            let relief = Relief::new(map, ReliefThickness::Relative(thickness)).with_level(1.0);
            let [width, length] = [heights.width(), heights.height()].map(|side| side as usize);
            carved = Some(Arc::new(Carved {
                heights: HeightImage::new(width, length, heights.into_raw()),
                repeats: f64::from(finish.repeats),
                relief,
            }));
        }
        let polygons = (world.resource_mut::<Assets<StandardMaterial>>()).add(bare.clone());
        let mut materials = world.resource_mut::<Assets<FrustaMaterial>>();
        let rays = materials.add(frusta_material(smooth));
        let relief = carved.as_ref().map(|carved| {
            let relief = carved.relief.clone();
            materials.add(relief_material(bare, relief))
        });
        Self {
            relief: relief.unwrap_or_else(|| rays.clone()),
            rays,
            polygons,
            carved,
        }
    }
}

fn file(surface: Surface, map: &str) -> PathBuf {
    let known = SURFACES.iter().find(|(kind, _)| *kind == surface);
    let name = known.map_or("unknown", |(_, name)| name);
    bevy_verdure::lab::checkout().join(format!("assets/plants/{name}_{map}.png"))
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

fn heights(surface: Surface) -> Option<GrayImage> {
    let map = open(surface, "height").map_err(|error| error!("{error}"));
    Some(map.ok()?.into_luma8())
}

fn height_image(heights: &GrayImage) -> Image {
    let extent = Extent3d {
        width: heights.width(),
        height: heights.height(),
        depth_or_array_layers: 1,
    };
    Image::new(
        extent,
        TextureDimension::D2,
        heights.as_raw().clone(),
        TextureFormat::R8Unorm,
        RenderAssetUsages::MAIN_WORLD,
    )
}

/// The slopes of a height map whose shell has a thickness of so many radii, and which is so many circumferences long.
fn normals(map: &GrayImage, thickness: f32, length: f32) -> Image {
    let size = UVec2::new(map.width(), map.height());
    let height = |x: u32, y: u32| f32::from(map.get_pixel(x % size.x, y % size.y).0[0]) / 255.0;
    let scale = thickness / TAU * size.as_vec2() / Vec2::new(1.0, length);
    texture(size, false, |x, y| {
        let across = height(x + 1, y) - height(x + size.x - 1, y);
        let along = height(x, y + 1) - height(x, y + size.y - 1);
        let slope = 0.5 * Vec2::new(across, along) * scale;
        // Green points to falling v, as everywhere in Bevy.
        let normal = Vec3::new(-slope.x, slope.y, 1.0).normalize() * 0.5 + 0.5;
        [normal.x, normal.y, normal.z, 1.0]
    })
}

//! Relief as it is drawn, against a march of 4,096 steps in double precision.

mod agreement;
mod bad_input;
mod leaping;
mod passes;
mod self_shadow;

use core::f32::consts::TAU;

use bevy::asset::RenderAssetUsages;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use bevy_verdure::lab::reference::ReferenceSettings;
use bevy_verdure::lab::reference::relief::{
    HeightImage, ReliefOptions, ReliefScene, ShellThickness,
};
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::reference_joints;

/// Thickness of the shell, in metres.
const THICKNESS: f32 = 0.08;

/// Pixels of the test's maps, along u and along v.
const MAP: UVec2 = UVec2::new(24, 16);

/// Bumps. In the pictures below a pixel of the map covers more than one of the screen, so that no mip level blurs them.
fn bumps() -> HeightImage {
    HeightImage::from_fn(MAP.x as usize, MAP.y as usize, |u, v| {
        let (u, v) = (u as f32, v as f32);
        f64::from(0.5 + 0.3 * (3.0 * TAU * u).sin() + 0.2 * (2.0 * TAU * v + TAU * u).cos())
    })
}

/// The same map as an image of the crate's users.
fn image(map: &HeightImage, size: UVec2) -> Image {
    let heights = (0..size.x * size.y).map(|i| {
        let at = |n: u32, side: u32| (f64::from(n) + 0.5) / f64::from(side);
        (map.sample(at(i % size.x, size.x), at(i / size.x, size.y)) * 255.0).round() as u8
    });
    Image::new(
        Extent3d {
            width: size.x,
            height: size.y,
            depth_or_array_layers: 1,
        },
        TextureDimension::D2,
        heights.collect(),
        TextureFormat::R8Unorm,
        RenderAssetUsages::default(),
    )
}

/// Adds a map to a studio.
fn add_map(studio: &mut Studio, map: &HeightImage) -> Handle<Image> {
    let image = image(map, MAP);
    studio.world().resource_mut::<Assets<Image>>().add(image)
}

/// The relief of [`bumps`], in a shell of [`THICKNESS`].
pub fn bumpy_relief(studio: &mut Studio) -> Relief {
    let map = add_map(studio, &bumps());
    Relief::new(map, ReliefThickness::Metres(THICKNESS))
}

/// A studio with a limb in it whose relief is [`bumps`], and the map taken up.
fn studio_with(
    skeleton: &Skeleton,
    base: StandardMaterial,
    relief: impl Fn(Relief) -> Relief,
) -> Studio {
    let mut studio = Studio::default();
    let relief = relief(bumpy_relief(&mut studio));
    let material = relief_material(base, relief);
    studio.plant_in(
        skeleton.clone(),
        Frusta::default(),
        Transform::IDENTITY,
        material,
    );
    // The map is taken up in the frame after the material.
    for _ in 0..3 {
        studio.headless.step();
    }
    studio
}

/// What the pictures below are taken from.
const SHOT: Shot = Shot {
    eye: Vec3::new(3.0, 2.5, 6.0),
    at: Vec3::new(0.3, 1.8, 0.0),
    lens: Lens::Perspective(0.7),
    size: UVec2::new(160, 120),
};

/// From afar, from close by, from above, and without perspective.
fn views() -> [Shot; 4] {
    [
        (Vec3::new(3.0, 2.5, 6.0), Lens::Perspective(0.7)),
        (Vec3::new(0.6, 1.5, 0.9), Lens::Perspective(1.2)),
        (Vec3::new(1.0, 9.0, 1.0), Lens::Perspective(0.5)),
        (Vec3::new(-4.0, 3.0, 4.0), Lens::Orthographic(5.0)),
    ]
    .map(|(eye, lens)| Shot {
        eye,
        at: Vec3::Y * 1.8,
        lens,
        size: UVec2::new(160, 120),
    })
}

/// The limb of most pictures in the reference, with a relief of [`THICKNESS`].
fn with_reference<T>(map: &HeightImage, look: impl FnOnce(&ReliefScene) -> T) -> T {
    let height = |u: f64, v: f64| map.sample(u, v);
    let options = ReliefOptions {
        continuous_u: true,
        steps: 512,
        ..default()
    };
    let joints = reference_joints(&limb(0.75, 0.5));
    let thickness = ShellThickness::Metres(f64::from(THICKNESS));
    let settings = ReferenceSettings::default();
    look(&ReliefScene::with_options(
        &joints, settings, &height, thickness, &options,
    ))
}

/// A limb of four segments that bends, with or without taper.
fn limb(taper: f32, bend: f32) -> Skeleton {
    let mut plant = Skeleton::builder();
    let mut last = plant.root(Vec3::ZERO, 0.3);
    plant.texture_length(last, 1.0);
    let (mut at, mut angle, mut radius) = (Vec3::ZERO, 0.0f32, 0.3);
    for i in 0..4 {
        at += Vec3::new(angle.sin(), angle.cos(), 0.0);
        radius *= taper;
        last = plant.joint(last, at, radius);
        angle += if i % 2 == 0 { bend } else { -0.6 * bend };
    }
    plant.build().expect("the limb is finite")
}

//! A hundred cacti, each with its own dance (Figure 8 of the paper): 2,158 segments, unfolded into entities that a
//! system turns. Orbit and fly round them, or render PNGs with `--headless`.
//!
//! ```text
//! cargo run --example dancing_cacti
//! cargo run --example dancing_cacti -- --headless --frames 8 --out out
//! ```

mod cactus;
#[path = "../common/mod.rs"]
mod common;
mod dance;

use bevy::light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::prelude::*;
use bevy_verdure::lab::CommonArgs;
use bevy_verdure::prelude::*;
use clap::Parser;

use cactus::{Dice, PETALS, body, flower, skin_color, skin_normals};
use dance::{Dancer, dance};

/// A hundred dancing cacti.
#[derive(Parser)]
struct Args {
    #[command(flatten)]
    common: CommonArgs,
}

/// Cacti along each side of the crowd.
const SIDE: usize = 10;
/// Segments of all bodies and flowers together, as in the paper's Table 1.
const SEGMENTS: usize = 2158;
/// Colour of the sky, and of what fades into it.
const SKY: Color = Color::srgb(0.53, 0.71, 0.87);

fn main() -> std::process::ExitCode {
    let args = Args::parse();
    let run = common::run("dancing_cacti", &args.common, |app| {
        app.insert_resource(ClearColor(SKY))
            .insert_resource(DirectionalLightShadowMap { size: 2048 })
            .insert_resource(GlobalAmbientLight {
                color: Color::srgb(0.72, 0.82, 1.0),
                brightness: 750.0,
                ..default()
            })
            .insert_resource(common::Orbit {
                centre: Vec3::Y * 0.8,
                speed: 1.0,
            })
            .add_systems(Startup, (stage, plant_crowd, grow_flowers))
            .add_systems(Update, (put_flowers_on, dance).chain());
    });
    match run {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// Ground, sun and eye.
fn stage(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Mesh3d(meshes.add(Plane3d::default().mesh().size(400.0, 400.0))),
        MeshMaterial3d(materials.add(StandardMaterial {
            base_color: Color::srgb(0.80, 0.66, 0.46),
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        })),
    ));
    commands.spawn((
        DirectionalLight {
            illuminance: 10_500.0,
            color: Color::srgb(1.0, 0.95, 0.86),
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            maximum_distance: 45.0,
            first_cascade_far_bound: 9.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(Vec3::new(-0.7, -0.85, -0.35), Vec3::Y),
    ));
    commands.spawn((
        common::camera(Vec3::new(-5.5, 3.4, 14.0), Vec3::new(0.0, 0.75, 1.5)),
        DistanceFog {
            // The ground fades into the sky.
            color: SKY,
            falloff: FogFalloff::Linear {
                start: 30.0,
                end: 160.0,
            },
            ..default()
        },
    ));
}

/// Bodies: all of one material, and so one draw.
fn plant_crowd(
    mut commands: Commands,
    mut skeletons: ResMut<Assets<Skeleton>>,
    mut materials: ResMut<Assets<FrustaMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let skin = materials.add(frusta_material(StandardMaterial {
        base_color_texture: Some(images.add(skin_color())),
        normal_map_texture: Some(images.add(skin_normals())),
        perceptual_roughness: 0.75,
        reflectance: 0.3,
        ..default()
    }));
    let mut dice = Dice(8);
    let cacti = SIDE * SIDE;
    let body_segments = SEGMENTS - cacti * PETALS;
    for i in 0..cacti {
        // The total is shared out evenly: the first few have one more.
        let segments = body_segments / cacti + usize::from(i < body_segments % cacti);
        let cactus = body(segments, &mut dice);
        let place = Vec2::new((i % SIDE) as f32, (i / SIDE) as f32) - (SIDE - 1) as f32 / 2.0;
        let place = place * 1.75 + Vec2::new(dice.between(-0.35, 0.35), dice.between(-0.35, 0.35));
        commands.spawn((
            Skeleton3d(skeletons.add(cactus.skeleton)),
            MeshMaterial3d(skin.clone()),
            UnfoldSkeleton,
            Dancer::new(cactus.trunk, cactus.arms, &mut dice),
            WearsFlower(cactus.crown),
            Transform::from_xyz(place.x, 0.0, place.y)
                .with_rotation(Quat::from_rotation_y(dice.between(0.0, 6.3))),
        ));
    }
}

/// A cactus that wants a flower, and the radius of its crown.
#[derive(Component)]
struct WearsFlower(f32);

/// The flower's skeleton, and its colours.
#[derive(Resource)]
struct Flowers {
    skeleton: Handle<Skeleton>,
    materials: [Handle<FrustaMaterial>; 3],
}

fn grow_flowers(
    mut commands: Commands,
    mut skeletons: ResMut<Assets<Skeleton>>,
    mut materials: ResMut<Assets<FrustaMaterial>>,
) {
    commands.insert_resource(Flowers {
        skeleton: skeletons.add(flower(0.1)),
        materials: [
            Color::srgb(0.93, 0.25, 0.50),
            Color::srgb(0.98, 0.80, 0.24),
            Color::srgb(0.96, 0.93, 0.90),
        ]
        .map(|color| materials.add(frusta_material(color))),
    });
}

/// A flower is a plant of its own, a child of the topmost segment.
fn put_flowers_on(
    mut commands: Commands,
    flowers: Res<Flowers>,
    skeletons: Res<Assets<Skeleton>>,
    bare: Query<(Entity, &Dancer, &WearsFlower, &SegmentEntities, &Skeleton3d)>,
) {
    for (cactus, dancer, WearsFlower(crown), segments, skeleton) in &bare {
        let Some(skeleton) = skeletons.get(&skeleton.0) else {
            continue;
        };
        let joints = skeleton.joints();
        let Some(&[.., below, top]) = dancer.trunk.get(..) else {
            continue;
        };
        let Some(segment) = segments.get(top as usize) else {
            continue;
        };
        let along = joints[top as usize].position - joints[below as usize].position;
        commands.entity(cactus).remove::<WearsFlower>();
        commands.spawn((
            Skeleton3d(flowers.skeleton.clone()),
            MeshMaterial3d(flowers.materials[cactus.index_u32() as usize % 3].clone()),
            Transform::from_translation(along + Vec3::Y * (crown * 0.9)),
            ChildOf(segment),
        ));
    }
}

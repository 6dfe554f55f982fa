//! Pictures, compared with those kept in `tests/golden`.
//!
//! `VERDURE_BLESS=1` writes them anew; look at them before they are committed. They are the software driver's; others
//! may differ along edges.

use std::path::PathBuf;

use bevy::light::CascadeShadowConfigBuilder;
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio, adapter_name, load_png, mean_flip};
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;

#[allow(dead_code)]
#[path = "../../examples/dancing_cacti/cactus.rs"]
mod cactus;
#[path = "../../examples/common/mod.rs"]
mod common;

const SIZE: UVec2 = UVec2::new(256, 192);
/// Mean FLIP on the driver that drew the golden pictures: roundings of the same programme, compiled again.
const SAME: f32 = 0.002;
/// On any other driver.
const ALIKE: f32 = 0.03;

fn golden(name: &str) -> PathBuf {
    bevy_verdure::lab::checkout()
        .join("tests/golden")
        .join(format!("{name}.png"))
}

fn check(name: &str, shot: &Shot, plant: impl FnOnce(&mut Studio)) {
    let mut studio = Studio::default();
    studio.world().spawn((
        DirectionalLight {
            illuminance: 9_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        CascadeShadowConfigBuilder {
            maximum_distance: 16.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(Vec3::new(-0.6, -0.8, -0.5), Vec3::Y),
    ));
    studio.world().insert_resource(GlobalAmbientLight {
        brightness: 600.0,
        ..default()
    });
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let world = studio.world();
    let ground = world
        .resource_mut::<Assets<Mesh>>()
        .add(Plane3d::default().mesh().size(30.0, 30.0));
    let sand = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(Color::srgb(0.8, 0.7, 0.5));
    world.spawn((Mesh3d(ground), MeshMaterial3d(sand)));
    plant(&mut studio);
    studio.headless.step();
    let picture = studio.photograph(shot, Color::srgb(0.5, 0.7, 0.9));
    let file = golden(name);
    if std::env::var_os("VERDURE_BLESS").is_some() {
        std::fs::create_dir_all(file.parent().unwrap()).unwrap();
        picture.save_png(&file).unwrap();
    }
    let (size, expected) =
        load_png(&file).unwrap_or_else(|error| panic!("{error}. VERDURE_BLESS=1 writes it"));
    assert_eq!(size, SIZE, "{}", file.display());
    let flip = mean_flip((SIZE.x, SIZE.y), &expected, &picture.rgb_bytes());
    let adapter = adapter_name(studio.world());
    println!("{name}: mean FLIP {flip:.5} on {adapter}");
    let limit = if adapter.contains("llvmpipe") {
        SAME
    } else {
        ALIKE
    };
    if flip >= limit {
        let drawn = std::env::temp_dir().join(format!("{name}.drawn.png"));
        picture.save_png(&drawn).unwrap();
        panic!(
            "mean FLIP {flip} ≥ {limit}: compare {} with {}",
            file.display(),
            drawn.display()
        );
    }
}

fn shot(eye: Vec3, at: Vec3) -> Shot {
    Shot {
        eye,
        at,
        lens: Lens::Perspective(0.75),
        size: SIZE,
    }
}

#[test]
fn a_bare_tree() {
    check(
        "tree",
        &shot(Vec3::new(1.0, 2.2, 5.0), Vec3::Y * 1.7),
        |studio| {
            let mut tree = Skeleton::builder();
            let base = tree.root(Vec3::ZERO, 0.30);
            let fork = tree.joint(base, Vec3::Y * 1.4, 0.20);
            let bough = tree.chain(
                fork,
                &[
                    (Vec3::new(0.5, 2.2, 0.0), 0.13),
                    (Vec3::new(0.6, 3.0, 0.3), 0.06),
                ],
            );
            tree.chain(bough, &[(Vec3::new(0.9, 3.4, 0.2), 0.03)]);
            tree.chain(
                fork,
                &[
                    (Vec3::new(-0.7, 2.1, 0.2), 0.10),
                    (Vec3::new(-0.8, 2.9, 0.0), 0.05),
                ],
            );
            tree.chain(
                fork,
                &[
                    (Vec3::new(-0.1, 2.0, -0.6), 0.08),
                    (Vec3::new(0.0, 2.6, -0.9), 0.04),
                ],
            );
            studio.plant(
                tree.build().unwrap(),
                Frusta::default(),
                Transform::IDENTITY,
            );
        },
    );
}

#[test]
fn every_join_and_end() {
    check(
        "joins",
        &shot(Vec3::new(0.0, 2.0, 6.0), Vec3::Y * 0.9),
        |studio| {
            let zigzag = || {
                let mut zigzag = Skeleton::builder();
                let base = zigzag.root(Vec3::ZERO, 0.25);
                zigzag.chain(
                    base,
                    &[
                        (Vec3::new(0.0, 0.9, 0.0), 0.22),
                        (Vec3::new(0.6, 1.2, 0.0), 0.18),
                        (Vec3::new(0.1, 1.7, 0.1), 0.12),
                        (Vec3::new(0.5, 2.1, 0.0), 0.06),
                    ],
                );
                zigzag.build().unwrap()
            };
            for (i, (join, ends)) in [
                (Join::Mitre, Ends::Round),
                (Join::Round, Ends::Round),
                (Join::Paper, Ends::Flat),
                (Join::Mitre, Ends::Flat),
            ]
            .into_iter()
            .enumerate()
            {
                let place = Transform::from_xyz(i as f32 * 1.25 - 2.1, 0.0, 0.0);
                studio.plant(zigzag(), Frusta { join, ends }, place);
            }
        },
    );
}

#[test]
fn a_ribbed_cactus() {
    check(
        "cactus",
        &shot(Vec3::new(0.8, 1.7, 3.4), Vec3::Y * 0.95),
        |studio| {
            let world = studio.world();
            let mut images = world.resource_mut::<Assets<Image>>();
            let skin = frusta_material(StandardMaterial {
                base_color_texture: Some(images.add(cactus::skin_color())),
                normal_map_texture: Some(images.add(cactus::skin_normals())),
                perceptual_roughness: 0.75,
                ..default()
            });
            let skin = world.resource_mut::<Assets<FrustaMaterial>>().add(skin);
            let cactus = cactus::body(18, &mut Dice::new(3));
            let skeleton = world
                .resource_mut::<Assets<Skeleton>>()
                .add(cactus.skeleton);
            world.spawn((Skeleton3d(skeleton), MeshMaterial3d(skin)));
        },
    );
}

//! What the criteria save, and what texels stand for: the quick form of `texels_charts`.

use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::{TexelScene, TexelStand, all_slices};
use bevy_verdure::lab::{Lens, Shot, mean_flip};
use bevy_verdure::prelude::*;

const SIZE: UVec2 = UVec2::new(160, 120);

fn shot(scene: TexelScene) -> Shot {
    let (eye, at) = scene.view();
    Shot {
        eye,
        at,
        lens: Lens::Perspective(core::f32::consts::FRAC_PI_4),
        size: SIZE,
    }
}

fn flip(reference: &[u8], picture: &[u8]) -> f32 {
    mean_flip((SIZE.x, SIZE.y), reference, picture)
}

#[test]
fn wider_gaps_between_slices_save_slices_and_cost_error() {
    let scene = TexelScene::Sphere;
    let mut stand = TexelStand::open(scene).expect("the scene is built");
    let shot = shot(scene);
    let mut look = |settings: TexelSettings| {
        stand.set(settings);
        let slices = stand.count(&shot, &settings).slices;
        (slices, stand.photograph(&shot).rgb_bytes())
    };
    let (all, reference) = look(all_slices(PlantLighting::Unlit));
    let mut before = (all, 0.0);
    for pixels in [0.5, 2.0, 8.0] {
        let quality = TexelQuality {
            pixels,
            ..default()
        };
        let (slices, picture) = look(TexelSettings {
            quality,
            ..all_slices(PlantLighting::Unlit)
        });
        let error = flip(&reference, &picture);
        println!("p {pixels}: {slices} of {all} slices, FLIP {error:.4}");
        assert!(slices < before.0 && error > before.1, "{pixels} {before:?}");
        before = (slices, error);
    }
}

#[test]
fn the_criteria_draw_a_fifth_of_the_slices_of_the_sphere_and_look_alike() {
    let scene = TexelScene::Sphere;
    let mut stand = TexelStand::open(scene).expect("the scene is built");
    // As Bevy has cameras by default: with one sample a pixel, outlines that move by a part of one change whole pixels.
    stand.multisample();
    // Large enough that the criteria ask for something.
    let size = UVec2::new(512, 384);
    let shot = Shot {
        size,
        ..shot(scene)
    };
    let mut look = |settings: TexelSettings| {
        stand.set(settings);
        let slices = stand.count(&shot, &settings).slices;
        (slices, stand.photograph(&shot).rgb_bytes())
    };
    // As the paper lights them, and by the scene.
    for lighting in [PlantLighting::Unlit, PlantLighting::Simple] {
        let (all, reference) = look(all_slices(lighting));
        let (slices, picture) = look(TexelSettings {
            lighting,
            ..default()
        });
        let error = mean_flip((size.x, size.y), &reference, &picture);
        println!("{lighting:?}: {slices} of {all} slices, FLIP {error:.4}");
        assert!(
            5 * slices <= all && error < 0.01,
            "{slices} of {all}, {error}"
        );
    }
}

#[test]
fn what_is_seen_in_the_layer_of_a_slice_makes_light_as_exact_as_more_slices() {
    let scene = TexelScene::Sphere;
    let mut stand = TexelStand::open(scene).expect("the scene is built");
    let shot = shot(scene);
    let mut look = |settings: TexelSettings| {
        stand.set(settings);
        stand.photograph(&shot).rgb_bytes()
    };
    let lighting = PlantLighting::Simple;
    let reference = look(all_slices(lighting));
    let quality = TexelQuality {
        pixels: 2.0,
        ..default()
    };
    let mut error = |inner_slices| {
        let picture = look(TexelSettings {
            quality,
            inner_slices,
            lighting,
            ..default()
        });
        flip(&reference, &picture)
    };
    let (plain, inner, none) = (
        error(1),
        error(TexelSettings::default().inner_slices),
        error(0),
    );
    println!("slices alone {plain:.4}, looked into {inner:.4}");
    // Outlines stay; what is within them is known eight times as finely. At 512 x 384 the error is halved.
    assert!(inner < 0.75 * plain, "{inner} {plain}");
    assert_eq!(none, plain, "a slice shows itself at least");
}

#[test]
fn what_shows_nothing_of_slices_is_left_out_and_not_missed() {
    // Bushes stand on flat facets: their slices are the same planes, but corners of what is left of them are rounded anew.
    // On the ball of pears height vectors twist, and smaller quads follow them more closely.
    for (scene, most) in [(TexelScene::Bushes, 0.001), (TexelScene::Pears, 0.01)] {
        let mut stand = TexelStand::open(scene).expect("the scene is built");
        let shot = shot(scene);
        let mut look = |empty_slices| {
            let settings = TexelSettings {
                empty_slices,
                ..default()
            };
            stand.set(settings);
            let slices = stand.count(&shot, &settings).slices;
            (slices, stand.photograph(&shot).rgb_bytes())
        };
        let ((all, whole), (fewer, picture)) = (look(true), look(false));
        let error = flip(&whole, &picture);
        println!(
            "{}: {fewer} of {all} slices show anything, FLIP {error:.5}",
            scene.name()
        );
        assert!(fewer < all, "{fewer} of {all}");
        assert!(error < most, "{}: {error}", scene.name());
    }
}

#[test]
fn texels_look_like_the_triangles_that_they_stand_for() {
    let scene = TexelScene::Pears;
    let mut stand = TexelStand::open(scene).expect("the scene is built");
    let shot = shot(scene);
    let full = stand.put_up_full_meshes().expect("pears have triangles");
    assert_eq!(full.triangles, 96 * 992);
    let mut look = |texels: bool, triangles: bool| {
        let groups = [(&stand.surfaces, texels), (&full.entities, triangles)];
        for (entities, shown) in groups {
            let visibility = if shown {
                Visibility::Inherited
            } else {
                Visibility::Hidden
            };
            for entity in entities {
                stand.studio.world().entity_mut(*entity).insert(visibility);
            }
        }
        stand.studio.headless.step();
        stand
            .studio
            .photograph(&shot, bevy_verdure::lab::SKY)
            .rgb_bytes()
    };
    let (triangles, texels, neither) = (look(false, true), look(true, false), look(false, false));
    let (error, emptiness) = (flip(&triangles, &texels), flip(&triangles, &neither));
    println!("texels {error:.4}, nothing {emptiness:.4}");
    // Instances are turned and stretched, where texels bend with the surface; outlines differ by a pixel or two.
    assert!(error < 0.5 * emptiness, "{error} {emptiness}");
}

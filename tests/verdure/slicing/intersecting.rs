//! Where slicing fails: crowns that intersect. Each is drawn whole, after what is further (§2.3), or in bands.

use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio, mean_flip};
use bevy_verdure::prelude::*;

use super::{CROWN, SIZE, UNLIT, plant, plant_mesh, shot};

/// Half the way, in degrees, between two eyes.
const STEP: f32 = 0.01;

/// Two crowns along x, so many metres apart.
fn places(apart: f32) -> [Transform; 2] {
    let centroid = CROWN.shape().centroid;
    [(-0.5, 0.0), (0.5, 1.7)].map(|(side, turn)| {
        let turn = Quat::from_rotation_y(turn);
        // Turned about their centroids.
        Transform::from_translation(centroid - turn * centroid + Vec3::X * side * apart)
            .with_rotation(turn)
    })
}

/// Both crowns, so many degrees off the line on which they are equally far.
fn look(angle: f32) -> Shot {
    let (sin, cos) = angle.to_radians().sin_cos();
    Shot {
        lens: Lens::Perspective(0.7),
        ..shot(CROWN.shape().centroid + Vec3::new(sin, 0.0, cos) * 16.0)
    }
}

fn photograph(studio: &mut Studio, angle: f32) -> Vec<u8> {
    studio.photograph(&look(angle), Color::WHITE).rgb_bytes()
}

fn flip(a: &[u8], b: &[u8]) -> f32 {
    mean_flip((SIZE.x, SIZE.y), a, b)
}

#[test]
fn crowns_pop_as_they_change_their_order_only_where_they_intersect() {
    let ratio = |apart| {
        let mut studio = Studio::default();
        for place in places(apart) {
            plant(&mut studio, UNLIT, place);
        }
        studio.headless.step();
        let [a, b, c] = [-3.0, -1.0, 1.0].map(|i| photograph(&mut studio, i * STEP));
        // Between b and c they swap, between a and b they only move.
        let (swap, motion) = (flip(&b, &c), flip(&a, &b));
        println!("{apart} m apart: {swap:.5} as they swap, {motion:.5} else");
        swap / motion
    };
    assert!(ratio(7.2) < 1.5);
    // What this is about, or there would be nothing to see.
    assert!(ratio(2.0) > 2.0);
}

#[test]
fn crowns_in_bands_that_intersect_change_little_on_their_whole_way() {
    // The greatest change between neighbours over the usual one, for eyes that pass one crown before the other: bands change
    // their order here and there.
    let pop = |in_bands: bool| {
        let mut studio = Studio::default();
        let world = studio.world();
        let slicing = world.resource_mut::<Assets<Slicing>>().add(CROWN.clone());
        for place in places(2.0) {
            let mut crown = world.spawn((SlicedCrown(slicing.clone()), UNLIT, place));
            if in_bands {
                crown.insert(IntersectingCrown);
            }
        }
        studio.headless.step();
        let eyes = (-100..100).map(|i| 8.0 * STEP * (i as f32 + 0.5));
        let pictures: Vec<_> = eyes.map(|angle| photograph(&mut studio, angle)).collect();
        let pairs = pictures.windows(2);
        let mut changes: Vec<_> = pairs.map(|pair| flip(&pair[0], &pair[1])).collect();
        changes.sort_by(f32::total_cmp);
        changes[changes.len() - 1] / changes[changes.len() / 2]
    };
    let (whole, in_bands) = (pop(false), pop(true));
    println!("greatest over usual change: whole {whole:.3}, in bands {in_bands:.3}");
    // Of what is more than usual bands leave less than half.
    assert!(in_bands - 1.0 < 0.5 * (whole - 1.0), "{whole} {in_bands}");
}

#[test]
fn crowns_that_intersect_are_better_than_none_in_either_order() {
    let mut studio = Studio::default();
    let places = places(2.0);
    let meshes = places.map(|place| plant_mesh(&mut studio, place, true));
    studio.headless.step();
    let mesh = photograph(&mut studio, STEP);
    for mesh in meshes.into_iter().flatten() {
        studio.world().despawn(mesh);
    }
    studio.headless.step();
    let without = flip(&mesh, &photograph(&mut studio, STEP));
    for place in places {
        plant(&mut studio, UNLIT, place);
    }
    studio.headless.step();
    for angle in [-STEP, STEP] {
        let error = flip(&mesh, &photograph(&mut studio, angle));
        println!("{angle}°: {error:.4} of {without:.4}");
        // A crown alone has some 0.4 of what leaving it out has, at this size.
        assert!(error < 0.7 * without, "{error} of {without}");
    }
}

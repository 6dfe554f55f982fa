//! Where slicing fails: eyes so close that one discrepancy angle for the whole crown is wrong, and eyes within it.

use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio, mean_flip};

use super::{CROWN, SIZE, UNLIT, plant, plant_mesh};

const SKY: [u8; 3] = [153, 204, 255];

fn photograph(studio: &mut Studio, shot: &Shot) -> Vec<u8> {
    let [r, g, b] = SKY;
    studio.photograph(shot, Color::srgb_u8(r, g, b)).rgb_bytes()
}

/// Least and greatest value of each channel of all slices and of the sky. Filtering and blending lie between.
fn range() -> [(u8, u8); 3] {
    let layers = CROWN.shape().layers();
    let colors = (0..layers).flat_map(|layer| CROWN.color(layer));
    let mut range = SKY.map(|value| (value, value));
    for color in colors {
        for (range, value) in range.iter_mut().zip(color) {
            *range = (range.0.min(*value), range.1.max(*value));
        }
    }
    range
}

/// Whatever the eye, all that is drawn is a mixture of what was baked and of the sky, and nearer to the mesh than the sky
/// alone.
fn check(shots: &[(String, Shot)]) {
    let mut studio = Studio::default();
    let mesh = plant_mesh(&mut studio, Transform::IDENTITY, true);
    studio.headless.step();
    let references: Vec<_> = shots
        .iter()
        .map(|(_, shot)| photograph(&mut studio, shot))
        .collect();
    for part in mesh {
        studio.world().despawn(part);
    }
    let crown = plant(&mut studio, UNLIT, Transform::IDENTITY);
    studio.headless.step();
    let range = range();
    assert!(range[1].0 > 2, "black would not be told: {range:?}");
    let empty = SKY.repeat((SIZE.x * SIZE.y) as usize);
    for ((name, shot), reference) in shots.iter().zip(&references) {
        let seen = photograph(&mut studio, shot);
        for pixel in seen.as_chunks::<3>().0 {
            for (value, (low, high)) in pixel.iter().zip(range) {
                // Of up to fifteen slices each is rounded to 8 bits.
                let is_mixed = (low.saturating_sub(8)..=high.saturating_add(8)).contains(value);
                assert!(is_mixed, "{name}: {pixel:?} out of {range:?}");
            }
        }
        let flip = |test: &[u8]| mean_flip((SIZE.x, SIZE.y), reference, test);
        let (error, without) = (flip(&seen), flip(&empty));
        println!("{name}: {error:.3} of {without:.3}");
        assert!(error < without, "{name}: {error} of {without}");
    }
    studio.world().despawn(crown);
}

/// An eye that looks at the centroid from an azimuth in degrees and a distance in metres.
fn look(azimuth: f32, distance: f32, field: f32) -> Shot {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let outwards = Vec3::new(cos, 0.0, sin);
    let eye = CROWN.shape().centroid + outwards * distance;
    Shot {
        eye,
        // At the centroid itself there is a way to look all the same.
        at: eye - outwards,
        lens: Lens::Perspective(field),
        size: SIZE,
    }
}

#[test]
fn through_a_crown_to_its_centre_nothing_is_black_and_a_crown_is_better_than_none() {
    let radius = CROWN.shape().radius;
    let radii = [2.0, 1.0, 0.75, 0.5, 0.25, 0.1, 1e-3, 0.0];
    let shots: Vec<_> = radii
        .into_iter()
        .flat_map(|r| [0.0, 30.0].map(|azimuth| (r, azimuth)))
        .map(|(r, azimuth)| {
            let name = format!("{r} radii away, {azimuth}°");
            (name, look(azimuth, r * radius, 0.9))
        })
        .collect();
    check(&shots);
}

#[test]
fn a_crown_that_fills_a_wide_field_of_view_is_better_than_none() {
    // The crown is 6.5 m wide.
    let shots: Vec<_> = [30.0_f32, 60.0, 90.0, 120.0]
        .into_iter()
        .flat_map(|field| [0.0, 30.0].map(|azimuth| (field, azimuth)))
        .map(|(field, azimuth)| {
            let distance = 3.25 / (0.5 * field.to_radians()).sin();
            let name = format!("a field of {field}°, {azimuth}°");
            (name, look(azimuth, distance, field.to_radians()))
        })
        .collect();
    check(&shots);
}

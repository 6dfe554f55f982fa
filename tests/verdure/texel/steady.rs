//! What changes between neighbouring frames of a slow flight.

use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use crate::jumps::jumps;

use super::{BACKGROUND, cover_default, shot, unlit};

/// The jumps of an eye that rises from aslant to above, half a degree a frame: past all changes of count and direction.
fn rise(fade: bool) -> (f64, f64) {
    let mut studio = Studio::default();
    let settings = TexelSettings { fade, ..unlit() };
    cover_default(&mut studio, settings);
    jumps((45..125).map(|i| {
        let (sin, cos) = (10.0 + 0.5 * i as f32).to_radians().sin_cos();
        let eye = Vec3::new(0.5, 0.5, -0.5) + Vec3::new(0.4 * cos, sin, 0.9 * cos) * 3.0;
        studio.photograph(&shot(eye), BACKGROUND)
    }))
}

#[test]
fn nothing_pops_where_changes_fade() {
    let ratio = |fade| {
        let (largest, median) = rise(fade);
        println!(
            "fade {fade}: largest {largest:.4}, median {median:.4}, {:.2}",
            largest / median
        );
        largest / median
    };
    let (fading, popping) = (ratio(true), ratio(false));
    // Without a pop there would be nothing to compare with. It is of outlines: what is seen in the layers of slices hardly
    // changes with their count.
    assert!(popping > 1.5 * fading, "{popping} {fading}");
    // Motion itself differs by half as much again over the flight, and dither adds to it while it goes on.
    assert!(fading < 3.0, "{fading}");
}

/// The largest change between neighbouring pictures of an eye that stands still, while it is content with ever fewer slices,
/// down to half as many: where nothing moves only what pops, or moves apart, changes.
fn coarsen(fade: bool) -> f64 {
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, unlit());
    let eye = Vec3::new(0.5, 0.5, -0.5) + Vec3::new(0.9, 1.4, 1.6);
    let pictures: Vec<Vec<u8>> = (0..=70)
        .map(|i| {
            // However deep one would see.
            let quality = TexelQuality {
                depth: 0.01,
                pixels: 6.0 * 1.01f32.powi(i),
                ..default()
            };
            let settings = TexelSettings {
                quality,
                fade,
                ..unlit()
            };
            studio.world().entity_mut(surface).insert(settings);
            studio.headless.step();
            studio.photograph(&shot(eye), BACKGROUND).rgb_bytes()
        })
        .collect();
    let changes = pictures.windows(2).map(|pair| {
        let both = pair[0].iter().zip(&pair[1]);
        both.map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / pair[0].len() as f64
    });
    changes.fold(0.0, f64::max)
}

#[test]
fn where_counts_double_slices_move_apart_and_do_not_pop() {
    let (moving, popping) = (coarsen(true), coarsen(false));
    println!("slices that move {moving:.4}, that pop {popping:.4}");
    // A step is a ninth of the way that they move, and outlines go pixel by pixel.
    assert!(popping > 3.0 * moving && moving > 0.0, "{popping} {moving}");
}

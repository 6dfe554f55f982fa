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
    // Without a pop there would be nothing to compare with. It is of outlines: what is seen in the layers of slices hardly changes
    // with their count.
    assert!(popping > 1.5 * fading, "{popping} {fading}");
    // Motion itself differs by half as much again over the flight, and dither adds to it while it goes on.
    assert!(fading < 3.0, "{fading}");
}

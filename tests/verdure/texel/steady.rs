//! What changes between neighbouring frames of a slow flight.

use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use super::{BACKGROUND, Square, cover, shot, unlit};

/// Largest and median mean difference, in steps of 8 bits, of neighbouring frames of an eye that rises from aslant to
/// above, half a degree a frame: past all changes of count and direction.
fn jumps(fade: bool) -> (f64, f64) {
    let mut studio = Studio::default();
    let settings = TexelSettings { fade, ..unlit() };
    cover(
        &mut studio,
        &Square::default(),
        Transform::IDENTITY,
        settings,
    );
    let mut before: Option<Vec<u8>> = None;
    let mut jumps = Vec::new();
    for i in 45..125 {
        let (sin, cos) = (10.0 + 0.5 * i as f32).to_radians().sin_cos();
        let eye = Vec3::new(0.5, 0.5, -0.5) + Vec3::new(0.4 * cos, sin, 0.9 * cos) * 3.0;
        let bytes = studio.photograph(&shot(eye), BACKGROUND).rgb_bytes();
        if let Some(before) = before.replace(bytes.clone()) {
            let pairs = before.iter().zip(&bytes);
            let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
            jumps.push(sum / bytes.len() as f64);
        }
    }
    let largest = jumps.iter().copied().fold(0.0, f64::max);
    jumps.sort_by(f64::total_cmp);
    (largest, jumps[jumps.len() / 2])
}

#[test]
fn nothing_pops_where_changes_fade() {
    let ratio = |fade| {
        let (largest, median) = jumps(fade);
        println!(
            "fade {fade}: largest {largest:.4}, median {median:.4}, {:.2}",
            largest / median
        );
        largest / median
    };
    let (fading, popping) = (ratio(true), ratio(false));
    // Without a pop there would be nothing to compare with.
    assert!(popping > 2.0 * fading, "{popping} {fading}");
    // Motion itself differs by half as much again over the flight, and dither adds to it while it goes on.
    assert!(fading < 3.0, "{fading}");
}

//! What changes between neighbouring frames of a slow orbit.

use bevy::prelude::*;
use bevy_verdure::prelude::*;

use crate::jumps::jumps;

use super::{UNLIT, eye, shot, studio, sun};

/// The jumps on an orbit past the angle of 30° at
/// which primary and secondary are swapped, `step` degrees a frame.
fn orbit(order: SliceOrder, step: f32) -> (f64, f64) {
    let (mut studio, _) = studio(CrownSettings { order, ..UNLIT });
    jumps((-16..=16).map(|i| {
        // Off by half a step, so that no frame is at the very angle.
        let azimuth = 30.0 + (i as f32 + 0.5) * step;
        studio.photograph(&shot(eye(azimuth, 4.0, 16.0)), Color::srgb(0.6, 0.8, 1.0))
    }))
}

#[test]
fn the_swap_of_primary_and_secondary_pops_in_the_papers_order_alone() {
    let ratio = |order, step| {
        let (largest, median) = orbit(order, step);
        println!(
            "{order:?}, {step}°: largest {largest:.4}, median {median:.4}, {:.2}",
            largest / median
        );
        largest / median
    };
    // The target of a slow orbit, for the default; and of one so slow that motion hides nothing.
    assert!(ratio(SliceOrder::Steady, 0.25) <= 1.5);
    assert!(ratio(SliceOrder::Steady, 0.02) <= 1.5);
    // Without a pop in the paper's order there would be nothing to compare with.
    assert!(ratio(SliceOrder::Paper, 0.02) > 2.0);
}

#[test]
fn a_lit_crown_does_not_shimmer_on_a_slow_walk() {
    let (mut studio, _) = studio(CrownSettings::default());
    sun(&mut studio);
    // Past sizes at which one mip level gives over to the next: the slices' 64 pixels are 100 on screen at first, 25 at last.
    for (from, step) in [(10.0, 0.02), (20.0, 0.05), (40.0, 0.1)] {
        let (largest, median) = jumps((0..48).map(|i| {
            let distance = from - step * i as f32;
            studio.photograph(&shot(eye(15.0, 4.0, distance)), Color::srgb(0.6, 0.8, 1.0))
        }));
        println!(
            "{from} m: largest {largest:.4}, median {median:.4}, {:.2}",
            largest / median
        );
        // As for the swap.
        assert!(largest <= 1.5 * median, "{from} m: {largest} {median}");
    }
}

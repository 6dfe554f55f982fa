//! What changes between neighbouring frames of a slow orbit.

use bevy::prelude::*;
use bevy_verdure::prelude::*;

use super::{UNLIT, eye, shot, studio};

/// Largest and median mean difference, in steps of 8 bits, of neighbouring frames on an orbit past the angle of 30° at
/// which primary and secondary are swapped, `step` degrees a frame.
fn jumps(order: SliceOrder, step: f32) -> (f64, f64) {
    let (mut studio, _) = studio(CrownSettings { order, ..UNLIT });
    let mut before: Option<Vec<u8>> = None;
    let mut jumps = Vec::new();
    for i in -16..=16 {
        // Off by half a step, so that no frame is at the very angle.
        let azimuth = 30.0 + (i as f32 + 0.5) * step;
        let picture = studio.photograph(&shot(eye(azimuth, 4.0, 16.0)), Color::srgb(0.6, 0.8, 1.0));
        let bytes = picture.rgb_bytes();
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
fn the_swap_of_primary_and_secondary_pops_in_the_papers_order_alone() {
    let ratio = |order, step| {
        let (largest, median) = jumps(order, step);
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

//! What changes between neighbouring frames of a slow orbit.

use bevy::prelude::*;
use bevy_verdure::prelude::*;

use super::{UNLIT, eye, shot, studio};

/// Largest and median mean difference, in steps of 8 bits, of neighbouring frames on an orbit of 0.25° a frame past the
/// angle of 30° at which primary and secondary are swapped.
fn jumps(order: SliceOrder) -> (f64, f64) {
    let (mut studio, _) = studio(CrownSettings { order, ..UNLIT });
    let mut before: Option<Vec<u8>> = None;
    let mut jumps = Vec::new();
    for step in 0..=32 {
        let azimuth = 26.1 + 0.25 * step as f32;
        let picture = studio.photograph(&shot(eye(azimuth, 4.0, 16.0)), Color::srgb(0.6, 0.8, 1.0));
        let bytes = picture.rgb_bytes();
        if let Some(before) = before.replace(bytes.clone()) {
            let sum: f64 = before
                .iter()
                .zip(&bytes)
                .map(|(a, b)| f64::from(a.abs_diff(*b)))
                .sum();
            jumps.push(sum / bytes.len() as f64);
        }
    }
    let largest = jumps.iter().copied().fold(0.0, f64::max);
    jumps.sort_by(f64::total_cmp);
    (largest, jumps[jumps.len() / 2])
}

#[test]
fn the_swap_of_primary_and_secondary_pops_in_the_papers_order_alone() {
    let (largest, median) = jumps(SliceOrder::Paper);
    println!(
        "paper: largest {largest:.3}, median {median:.3}, ratio {:.2}",
        largest / median
    );
    let paper = largest / median;
    let (largest, median) = jumps(SliceOrder::Steady);
    println!(
        "steady: largest {largest:.3}, median {median:.3}, ratio {:.2}",
        largest / median
    );
    // The target for the default; frames of an orbit differ by what moves.
    assert!(largest <= 1.5 * median, "{largest} {median}");
    assert!(
        paper > 1.5,
        "without a pop there would be nothing to compare with: {paper}"
    );
}

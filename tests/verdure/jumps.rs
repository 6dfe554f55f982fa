//! What pops: how much neighbouring frames differ.

use bevy_verdure::lab::Pixels;

/// Largest and median mean difference, in steps of 8 bits, of neighbouring pictures.
pub fn jumps(pictures: impl Iterator<Item = Pixels>) -> (f64, f64) {
    let frames: Vec<_> = pictures.map(|picture| picture.rgb_bytes()).collect();
    let mut jumps: Vec<f64> = frames
        .windows(2)
        .map(|pair| {
            let pairs = pair[0].iter().zip(&pair[1]);
            let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
            sum / pair[0].len() as f64
        })
        .collect();
    jumps.sort_by(f64::total_cmp);
    (jumps[jumps.len() - 1], jumps[jumps.len() / 2])
}

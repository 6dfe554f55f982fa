//! What pops: how much neighbouring frames of a slow orbit differ, in the default order of slices and in the paper's.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::prelude::*;

use super::accuracy::{SKY, planted, shot, uproot};
use super::lab::{Drawn, Lab};

/// Metres from the crown's centroid to the eye, as high as it.
const DISTANCE: f32 = 25.0;
/// Degrees of azimuth from frame to frame.
const STEP: f32 = 0.25;
/// Azimuth at which primary and secondary slicing of six are swapped, in degrees. No frame is at the very angle.
const SWAP: f32 = 30.0;

/// Mean differences, in steps of 8 bits, of neighbouring pictures on the orbit.
fn changes(lab: &mut Lab, drawn: &Drawn, azimuths: &[f32]) -> Vec<f64> {
    let tree = planted(lab, drawn, &[Transform::IDENTITY]);
    let mut pictures = Vec::new();
    for azimuth in azimuths {
        let look = shot(lab, DISTANCE, *azimuth, 0.0);
        pictures.push(lab.studio.photograph(&look, SKY).rgb_bytes());
    }
    uproot(lab, &tree);
    let change = |pair: &[Vec<u8>]| {
        let pairs = pair[0].iter().zip(&pair[1]);
        let sum: f64 = pairs.map(|(a, b)| f64::from(a.abs_diff(*b))).sum();
        sum / pair[0].len() as f64
    };
    pictures.windows(2).map(change).collect()
}

/// The change of each pair of frames over the median one.
pub fn on_an_orbit(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let steps = if lab.quick { 30 } else { 120 };
    let azimuths: Vec<f32> = (-steps..=steps)
        .map(|i| SWAP + (i as f32 + 0.5) * STEP)
        .collect();
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let mut series = Vec::new();
    for (name, order) in [
        ("default", SliceOrder::Steady),
        ("paper", SliceOrder::Paper),
    ] {
        let settings = CrownSettings { order, ..default() };
        let drawn = Drawn::Slicing(slicing.clone(), settings);
        let changes = changes(lab, &drawn, &azimuths);
        let mut sorted = changes.clone();
        sorted.sort_by(f64::total_cmp);
        let (largest, median) = (sorted[sorted.len() - 1], sorted[sorted.len() / 2]);
        println!(
            "{name}: largest {largest:.4}, median {median:.4}, {:.2}",
            largest / median
        );
        let between = azimuths.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        let points = between
            .zip(changes)
            .map(|(azimuth, change)| (f64::from(azimuth), change / median));
        series.push(Series::line(name, points));
    }
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    Ok(Chart {
        title: "Change of neighbouring frames on an orbit, 25 m away, over the median".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("azimuth, 0.25 degrees a frame; slicings are swapped at 30 (degrees)"),
        y: Axis::linear("mean difference of two frames over the median of all"),
        series,
    })
}

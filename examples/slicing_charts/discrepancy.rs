//! Error against the discrepancy angle (§2.3), from in line with an orientation to half-way between two.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::prelude::*;

use super::accuracy::{errors_by_shots, shot};
use super::lab::{Drawn, Lab};

/// Metres from the crown's centroid to the eye.
const DISTANCES: [f32; 3] = [10.0, 25.0, 50.0];

pub fn against_angle(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let paper = CrownSettings {
        order: SliceOrder::Paper,
        ..default()
    };
    let ways = [("default", default()), ("paper", paper)]
        .map(|(name, settings)| (name.to_string(), Drawn::Slicing(slicing.clone(), settings)));
    let (angles, around) = if lab.quick { (4, 3) } else { (11, 6) };
    let angle = |i: usize| 30.0 * i as f32 / (angles - 1) as f32;
    let distances = &DISTANCES[..if lab.quick { 2 } else { 3 }];
    let mut groups = Vec::new();
    for distance in distances {
        for i in 0..angles {
            let azimuths = (0..around).map(|k| 360.0 / around as f32 * k as f32 + angle(i));
            groups.push(azimuths.map(|a| shot(lab, *distance, a, 0.0)).collect());
        }
    }
    let mut series = Vec::new();
    for ((name, _), errors) in ways.iter().zip(errors_by_shots(lab, &groups, &ways)) {
        for (distance, errors) in distances.iter().zip(errors.chunks(angles)) {
            let points = errors.iter().enumerate();
            let points = points.map(|(i, error)| (f64::from(angle(i)), *error));
            series.push(Series::line(format!("{name}, {distance} m"), points));
        }
    }
    Ok(Chart {
        title: "Error against the discrepancy angle of the primary slicing".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("discrepancy angle (degrees)"),
        y: Axis::linear("mean FLIP against the supersampled mesh"),
        series,
    })
}

//! Error of each way to draw one and the same slicing.

use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::prelude::*;

use super::accuracy::{DISTANCES, errors_by_shots, five};
use super::lab::{Drawn, Lab};

/// Error against distance: the default, and what differs from it by one setting.
pub fn against_distance(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let default = CrownSettings::default();
    let ways = [
        ("default", default),
        (
            "the paper's order",
            CrownSettings {
                order: SliceOrder::Paper,
                ..default
            },
        ),
        (
            "hashed",
            CrownSettings {
                composition: Composition::Hashed,
                ..default
            },
        ),
        (
            "furthest slice left out",
            CrownSettings {
                left_out: 1,
                ..default
            },
        ),
        (
            "full light",
            CrownSettings {
                lighting: PlantLighting::Full,
                ..default
            },
        ),
        (
            "no light",
            CrownSettings {
                lighting: PlantLighting::Unlit,
                ..default
            },
        ),
    ]
    .map(|(name, settings)| (name.to_string(), Drawn::Slicing(slicing.clone(), settings)));
    let groups: Vec<_> = DISTANCES.iter().map(|at| five(lab, *at)).collect();
    let errors = errors_by_shots(lab, &groups, &ways);
    let series = ways.iter().zip(errors).map(|((name, _), errors)| {
        let points = DISTANCES.iter().map(|at| f64::from(*at)).zip(errors);
        Series::line(name.as_str(), points)
    });
    Ok(Chart {
        title: "Error against distance, mode by mode".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("distance (m)"),
        y: Axis::linear("mean FLIP against the supersampled mesh"),
        series: series.collect(),
    })
}

//! Error against cost for the distances at which levels of detail give over: what `Default` has is marked.

use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::prelude::*;

use super::accuracy::{circle, flips};
use super::cost::{Way, costs};
use super::lab::{Drawn, Lab};

/// Trees that cost is measured with.
const TREES: u32 = 128;

pub fn error_against_cost(lab: &mut Lab) -> Result<Chart, String> {
    let switches = [
        [3.0, 8.0],
        [5.0, 12.0],
        [7.0, 18.0],
        [10.0, 25.0],
        [15.0, 40.0],
    ];
    let mut bakes: Vec<(String, BakeSettings)> = switches
        .iter()
        .map(|at| {
            let bake = BakeSettings {
                switches: at.to_vec(),
                ..BakeSettings::default()
            };
            (format!("{} and {}", at[0], at[1]), bake)
        })
        .collect();
    for slices in [5, 3] {
        let bake = BakeSettings::default().with_slices(slices);
        bakes.push((format!("{slices} slices"), bake));
    }
    let mut ways = Vec::new();
    for (name, bake) in &bakes {
        let slicing = lab.bake(bake)?;
        let drawn = Drawn::Slicing(slicing, CrownSettings::default());
        ways.push((name.clone(), drawn));
    }
    let mut all = vec![0.0; ways.len()];
    let distances = [10.0, 25.0, 50.0];
    for distance in distances {
        println!("{distance} m:");
        let shots = circle(lab, distance);
        for (sum, error) in all.iter_mut().zip(flips(lab, &shots, &ways)) {
            *sum += error / distances.len() as f64;
        }
    }
    let ways: Vec<Way> = ways
        .into_iter()
        .map(|(name, drawn)| (name, drawn, true))
        .collect();
    let priced = costs(lab, "", &[TREES], &ways)?;
    let points = bakes.iter().zip(&priced.series).zip(&all);
    let points = points.filter_map(|(((name, bake), cost), error)| {
        let point = Point::from((cost.points.first()?.y, *error));
        Some(Point {
            label: Some(name.clone()),
            ..point.marked(bake.switches == BakeSettings::default().switches)
        })
    });
    let points: Vec<Point> = points.collect();
    Ok(Chart {
        title: "Where levels of 5, 3 and 1 slices give over, in radii".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear(priced.y.label),
        y: Axis::linear("mean FLIP at 10, 25 and 50 m"),
        series: vec![Series::scatter("switches", points)],
    })
}

//! What a user would take instead: a crossed pair of billboards, and pictures from many sides; by error and by cost.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{add_billboards, add_impostor};
use bevy_verdure::prelude::*;

use super::accuracy::{circle, flips};
use super::cost::{Way, costs};
use super::lab::{Drawn, Lab};

/// Views along a side of the impostor's square: 64 pictures of the same pixels as the 63 slices of the slicing.
const VIEWS: u32 = 8;

/// Pixels along a side of each of two billboards: 2 × 1440² are 1.004 of 63 × 256².
const BILLBOARD: u32 = 1440;

/// The slicing of the defaults, its rivals, and slicings of one level of so many slices each.
///
/// Two rivals have pictures from 31 directions round it or all over, of which the nearest two or three are blended. They
/// stand where their directions look from, as slices do, so that they are slicings of one slice. The octahedral impostor's
/// turn to the eye.
fn ways(lab: &mut Lab, levels: &[u32]) -> Result<Vec<(String, Drawn)>, String> {
    let slices = |count| BakeSettings::default().with_slices(count);
    let views = |orientations| BakeSettings {
        vertical: false,
        ..slices(1).with_orientations(orientations)
    };
    let bakes = [
        ("slicing", BakeSettings::default()),
        ("31 views of the circle", views(Orientations::Circle(31))),
        ("31 views of the sphere", views(Orientations::Sphere(31))),
    ]
    .map(|(name, bake)| (name.to_string(), bake));
    let levels = levels.iter().map(|n| (format!("slices: {n}"), slices(*n)));
    let mut ways = Vec::new();
    for (name, bake) in bakes.into_iter().chain(levels) {
        let slicing = lab.bake(&bake)?;
        let drawn = Drawn::Slicing(slicing, CrownSettings::default());
        ways.push((name, drawn));
    }
    let crown = lab.crown.clone();
    let impostor =
        add_impostor(lab.studio.world(), &crown, VIEWS, 256).map_err(|error| error.to_string())?;
    ways.push(("octahedral impostor".to_string(), Drawn::Impostor(impostor)));
    let pair =
        add_billboards(lab.studio.world(), &crown, BILLBOARD).map_err(|error| error.to_string())?;
    ways.push(("billboards".to_string(), Drawn::Billboards(pair)));
    Ok(ways)
}

/// Error against distance.
pub fn errors(lab: &mut Lab) -> Result<Chart, String> {
    let ways = ways(lab, &[5, 3, 1])?;
    let mut series: Vec<_> = ways
        .iter()
        .map(|(name, _)| Series::line(name.as_str(), Vec::<(f64, f64)>::new()))
        .collect();
    for distance in [5.0, 10.0, 25.0, 50.0] {
        println!("{distance} m:");
        let shots = circle(lab, distance);
        for (error, series) in flips(lab, &shots, &ways).into_iter().zip(&mut series) {
            series.points.push((f64::from(distance), error).into());
        }
    }
    Ok(Chart {
        title: "Error of slicings and of their rivals".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("distance (m), on a screen of 480 lines"),
        y: Axis::linear("mean FLIP against the supersampled mesh"),
        series,
    })
}

/// Cost against trees.
pub fn cost(lab: &mut Lab) -> Result<Chart, String> {
    let ways: Vec<Way> = ways(lab, &[])?
        .into_iter()
        .map(|(name, drawn)| (name, drawn, true))
        .chain([("mesh".to_string(), Drawn::Mesh, true)])
        .collect();
    costs(
        lab,
        "Cost of slicings and of their rivals, 640 x 480",
        &[1, 16, 128],
        &ways,
    )
}

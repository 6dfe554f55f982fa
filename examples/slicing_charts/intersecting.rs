//! Where it fails: crowns that intersect. Each is drawn whole, after what is further (§2.3), or in bands, sorted each by
//! itself.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Lens, Shot, mean_flip};
use bevy_verdure::prelude::*;

use super::accuracy::{SKY, errors_of_trees, planted, shot, uproot};
use super::cost::{Way, costs};
use super::lab::{Drawn, Lab};

/// Metres from the middle of both crowns to the eye.
const DISTANCE: f32 = 25.0;
/// From where two crowns are seen: the angle, in degrees, between the way to the eye and what is across their line.
const SIDES: [(&str, f32); 3] = [
    ("side by side", 0.0),
    ("oblique", 45.0),
    ("one behind the other", 90.0),
];
/// Half the angle, in degrees, between two eyes before and after the crowns change their order.
const STEP: f32 = 0.02;
/// How far, in degrees, an eye goes to either side by such steps: bands do not change their order all at once.
const WAY: f32 = 12.0;

/// Two trees whose crowns overlap by a share of their width.
pub fn pair(lab: &Lab, overlap: f32) -> [Transform; 2] {
    let (low, high) = lab.crown.bounds().unwrap_or_default();
    let centroid = lab.centroid();
    let apart = 0.5 * (1.0 - overlap) * (high.x - low.x);
    [(-1.0, 0.0), (1.0, 100.0_f32)].map(|(side, turn)| {
        // Turned about the middle of the crown, which is off the trunk.
        let turn = Quat::from_rotation_y(turn.to_radians());
        let foot = centroid - turn * centroid;
        Transform::from_translation(foot.with_y(0.0) + Vec3::X * side * apart).with_rotation(turn)
    })
}

/// Both crowns from an angle off the z axis.
fn both(lab: &Lab, angle: f32) -> Shot {
    let wide = 2.0 * (2.0 * lab.radius() / DISTANCE).atan();
    Shot {
        lens: Lens::Perspective(wide),
        size: UVec2::splat(256),
        ..shot(lab, DISTANCE, 90.0 - angle, 0.0)
    }
}

/// Error by the share of the crowns' width that overlaps, and what changes as they change their order, as shares of the
/// error of leaving both crowns out: what overlaps covers less of the picture.
pub fn against_overlap(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default().with_slices(5))?;
    let ways = [
        (
            "slicing".to_string(),
            Drawn::Slicing(slicing.clone(), default()),
        ),
        ("no crown".to_string(), Drawn::Bare),
    ];
    let in_bands = Drawn::InBands(slicing, default());
    let overlaps: &[f32] = if lab.quick {
        &[0.0, 0.25, 0.5, 0.75, 0.9, 1.0]
    } else {
        &[0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 1.0]
    };
    let mut series: Vec<_> = SIDES
        .iter()
        .map(|(name, _)| format!("error, {name}"))
        .chain(["change where they swap", "greatest change, in bands"].map(Into::into))
        .map(|name| Series::line(name, Vec::<(f64, f64)>::new()))
        .collect();
    for &overlap in overlaps {
        let places = pair(lab, overlap);
        let groups = SIDES.map(|(_, angle)| vec![both(lab, angle)]);
        let errors = errors_of_trees(lab, &places, &groups, &ways);
        let changes = [
            greatest_change(lab, &places, &ways[0].1, STEP),
            greatest_change(lab, &places, &in_bands, WAY),
        ];
        let [drawn, without] = &errors[..] else {
            continue;
        };
        let shares = drawn.iter().zip(without).map(|(e, w)| e / w);
        let changes = changes.map(|change| change / without[0]);
        let shares: Vec<f64> = shares.chain(changes).collect();
        println!("overlap {overlap}: {shares:.4?}");
        for (series, share) in series.iter_mut().zip(shares) {
            series.points.push((f64::from(overlap), share).into());
        }
    }
    Ok(Chart {
        title: "Two crowns that intersect, 25 m away".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("overlap (share of a crown's width)"),
        y: Axis::linear("mean FLIP, as a share of that without crowns"),
        series,
    })
}

/// The greatest change between two eyes so near to one another that hardly anything changes but which crown, or band, is
/// drawn first, on a way so many degrees to either side of the line on which both crowns are equally far.
fn greatest_change(lab: &mut Lab, places: &[Transform], drawn: &Drawn, way: f32) -> f64 {
    let trees = planted(lab, drawn, places);
    let steps = (way / STEP).round() as i32;
    let mut before: Option<Vec<u8>> = None;
    let mut greatest = 0.0f32;
    for step in (-steps..=steps).step_by(2) {
        let shot = both(lab, step as f32 * STEP);
        let seen = lab.studio.photograph(&shot, SKY).rgb_bytes();
        if let Some(before) = &before {
            greatest = greatest.max(mean_flip((256, 256), before, &seen));
        }
        before = Some(seen);
    }
    uproot(lab, &trees);
    f64::from(greatest)
}

/// What bands cost: a grove, whose crowns do not intersect, drawn in them all the same.
pub fn cost_of_bands(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let ways: [Way; 2] = [
        (
            "whole".into(),
            Drawn::Slicing(slicing.clone(), default()),
            true,
        ),
        ("in bands".into(), Drawn::InBands(slicing, default()), true),
    ];
    costs(
        lab,
        "Crowns whole and in bands, 640 x 480",
        &[1, 16, 128, 512],
        &ways,
    )
}

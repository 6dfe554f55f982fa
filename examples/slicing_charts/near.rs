//! Where it fails: eyes so close that one discrepancy angle for the whole crown is wrong (§4), and eyes within it.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Lens, Shot};
use bevy_verdure::prelude::*;

use super::accuracy::{errors_by_shots, shot};
use super::lab::{Drawn, Lab};

/// Discrepancy angles, in degrees: in line with an orientation, and half-way to the next.
const ANGLES: [f32; 2] = [0.0, 30.0];

/// Azimuths of eyes round a crown, so many degrees off an orientation.
fn azimuths(lab: &Lab, angle: f32) -> impl Iterator<Item = f32> + use<> {
    let step = if lab.quick { 3 } else { 2 };
    (0..6).step_by(step).map(move |i| angle + 60.0 * i as f32)
}

fn sliced(lab: &mut Lab, slices: u32) -> Result<Drawn, String> {
    let slicing = lab.bake(&BakeSettings::default().with_slices(slices))?;
    Ok(Drawn::Slicing(slicing, default()))
}

/// With one discrepancy angle for the whole crown.
fn one_angle(lab: &mut Lab, slices: u32) -> Result<Drawn, String> {
    let slicing = lab.bake(&BakeSettings::default().with_slices(slices))?;
    let settings = CrownSettings {
        discrepancy: DiscrepancyAngle::PerCrown,
        ..default()
    };
    Ok(Drawn::Slicing(slicing, settings))
}

/// Error by distance in radii, from outside through the crown to its centre.
pub fn inside(lab: &mut Lab) -> Result<Chart, String> {
    let ways = [
        ("slicing".to_string(), sliced(lab, 5)?),
        ("no crown".to_string(), Drawn::Bare),
    ];
    let radii: &[f32] = if lab.quick {
        &[0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0]
    } else {
        &[
            0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0,
        ]
    };
    let (centroid, radius) = (lab.centroid(), lab.radius());
    println!("a radius is {radius:.2} m");
    let look = |azimuth: f32, distance: f32| {
        let (sin, cos) = azimuth.to_radians().sin_cos();
        let outwards = Vec3::new(cos, 0.0, sin);
        let eye = centroid + outwards * distance * radius;
        Shot {
            eye,
            at: eye - outwards,
            lens: Lens::Perspective(0.9),
            size: UVec2::new(256, 192),
        }
    };
    let mut groups = Vec::new();
    for angle in ANGLES {
        for r in radii {
            groups.push(
                azimuths(lab, angle)
                    .map(|azimuth| look(azimuth, *r))
                    .collect(),
            );
        }
    }
    let errors = errors_by_shots(lab, &groups, &ways);
    let all = ways.iter().zip(&errors);
    let series = all.flat_map(|((name, _), errors)| by_angle(name, radii, errors));
    Ok(Chart {
        title: "Error from outside a crown to its centre, by discrepancy angle".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("distance from the centroid (radii)"),
        y: Axis::linear("mean FLIP against the supersampled mesh"),
        series: series.collect(),
    })
}

/// A curve over `places` for each discrepancy angle; `values` are those of one angle after the other.
fn by_angle(name: &str, places: &[f32], values: &[f64]) -> impl Iterator<Item = Series> {
    let curves = ANGLES.iter().zip(values.chunks(places.len()));
    curves.map(move |(angle, values)| {
        let points = places.iter().map(|at| f64::from(*at)).zip(values.to_vec());
        Series::line(format!("{name}, {angle} degrees"), points)
    })
}

/// Error by the field of view that a crown fills, in pictures of one size, as a share of the error of leaving it out: a
/// wide field sees less of it in the middle.
pub fn perspective(lab: &mut Lab) -> Result<Chart, String> {
    let ways = [
        ("5 slices".to_string(), sliced(lab, 5)?),
        ("5 slices, one angle".to_string(), one_angle(lab, 5)?),
        ("15 slices".to_string(), sliced(lab, 15)?),
        ("15 slices, one angle".to_string(), one_angle(lab, 15)?),
        ("no crown".to_string(), Drawn::Bare),
    ];
    let fields: &[f32] = if lab.quick {
        &[10.0, 30.0, 60.0, 90.0, 120.0]
    } else {
        &[
            5.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0, 105.0, 120.0, 135.0,
        ]
    };
    let (low, high) = lab.crown.bounds().unwrap_or_default();
    let radius = 0.5 * (high - low).max_element();
    println!("the crown is {:.2} m wide", 2.0 * radius);
    let mut groups = Vec::new();
    for angle in ANGLES {
        for field in fields {
            // The edge of a ball is seen where its radius meets the ray at a right angle.
            let distance = radius / (0.5 * field.to_radians()).sin();
            let shots = azimuths(lab, angle).map(|azimuth| Shot {
                lens: Lens::Perspective(field.to_radians()),
                size: UVec2::splat(256),
                ..shot(lab, distance, azimuth, 0.0)
            });
            groups.push(shots.collect());
        }
    }
    let mut errors = errors_by_shots(lab, &groups, &ways);
    let without = errors.pop().unwrap_or_default();
    let mut series = Vec::new();
    for ((name, _), errors) in ways.iter().zip(&errors) {
        let shares: Vec<_> = errors.iter().zip(&without).map(|(e, w)| e / w).collect();
        println!("{name}, share: {shares:.3?}");
        series.extend(by_angle(name, fields, &shares));
    }
    Ok(Chart {
        title: "Error by the field of view that a crown fills, and discrepancy angle".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("field of view (degrees)"),
        y: Axis::linear("mean FLIP, as a share of that without a crown"),
        series,
    })
}

//! What the criteria save: slices drawn, and how far the picture is from that of all slices (§4.3, §6).

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::{TexelScene, all_slices};
use bevy_verdure::prelude::*;

use super::lab::Lab;
use super::whole::{Whole, aside, with};

/// Whether the scene lights the texels, or they have the colours of the volume, as the paper's have.
const LIGHTS: [(&str, PlantLighting); 2] = [
    ("lit by the scene", PlantLighting::Simple),
    ("colours of the volume", PlantLighting::Unlit),
];

/// Slices of `sphere` for d and p over a range, beside all of them, and the difference between the pictures.
pub fn against_settings(lab: &Lab) -> Result<Chart, String> {
    let scene = TexelScene::Sphere;
    let mut stand = lab.open(scene)?;
    stand.multisample();
    let mut series = Vec::new();
    let default_quality = TexelQuality::default();
    let usual = default_quality.pixels;
    let (depths, pixels): (&[f32], &[f32]) = if lab.quick {
        (&[], &[0.5, 0.75, usual, 2.0])
    } else {
        (&[0.25, 1.0, 2.0], &[0.25, 0.5, 0.75, usual, 2.0, 4.0])
    };
    for (name, lighting) in LIGHTS {
        let shot = lab.shot(scene, 1.0);
        let whole = Whole::of(&mut stand, shot, lighting);
        let mut point = |depth: f32, pixels: f32, label: String| {
            let settings = with(depth, pixels, lighting);
            let figures = whole.against(&mut stand, settings);
            let is_default = settings.quality == default_quality;
            Point::from(figures).labelled(label).marked(is_default)
        };
        let by_pixels = pixels
            .iter()
            .map(|&p| point(default_quality.depth, p, format!("p {p}")));
        series.push(Series::line(
            format!("{name}, p"),
            by_pixels.collect::<Vec<_>>(),
        ));
        let by_depth = depths
            .iter()
            .map(|&d| point(d, default_quality.pixels, format!("d {d}")));
        let by_depth: Vec<_> = by_depth.collect();
        if !by_depth.is_empty() {
            series.push(Series::scatter(format!("{name}, d"), by_depth));
        }
        // What half a pixel does to the picture of all slices, to tell how much a figure is.
        stand.set(all_slices(lighting));
        let moved = stand.photograph(&aside(&shot, 0.5)).rgb_bytes();
        println!(
            "{lighting:?}: all slices half a pixel aside, FLIP {:.4}",
            whole.flip(&moved)
        );
    }
    Ok(Chart {
        title: "What the criteria save of all slices, sphere".into(),
        subtitle: stand.adapter(),
        x: Axis::log("times fewer slices than all"),
        y: Axis::linear("mean FLIP against all slices"),
        series,
    })
}

/// The same for the default settings, from near to far.
pub fn against_distance(lab: &Lab) -> Result<Chart, String> {
    let scene = TexelScene::Sphere;
    let mut stand = lab.open(scene)?;
    stand.multisample();
    let distances: &[f32] = if lab.quick {
        &[1.0, 4.0]
    } else {
        &[0.7, 1.0, 2.0, 4.0, 8.0]
    };
    let mut series = Vec::new();
    for (name, lighting) in LIGHTS {
        let points = distances.iter().map(|&distance| {
            let whole = Whole::of(&mut stand, lab.shot(scene, distance), lighting);
            let settings = TexelSettings {
                lighting,
                ..default()
            };
            let (fewer, flip) = whole.against(&mut stand, settings);
            let (eye, at) = scene.view();
            let metres = f64::from(distance * eye.distance(at));
            Point::from((metres, flip)).labelled(format!("{fewer:.1} times fewer"))
        });
        let points: Vec<_> = points.collect();
        series.push(Series::line(name, points));
    }
    Ok(Chart {
        title: "Error of the default criteria, and what they save of all slices, sphere".into(),
        subtitle: stand.adapter(),
        x: Axis::log("distance (m)"),
        y: Axis::log("mean FLIP against all slices"),
        series,
    })
}

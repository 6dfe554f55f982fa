//! What the criteria save: slices drawn, and how far the picture is from that of all slices (§4.3, §6).

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::mean_flip;
use bevy_verdure::lab::texel_scenes::TexelScene;
use bevy_verdure::prelude::*;

use super::lab::Lab;

/// Every slice there is.
fn all() -> TexelSettings {
    with(0.0, 0.0)
}

/// The criteria with some d, in e, and p, in pixels.
fn with(depth: f32, pixels: f32) -> TexelSettings {
    TexelSettings {
        quality: TexelQuality {
            depth,
            pixels,
            ..default()
        },
        ..default()
    }
}

/// Slices of `sphere` for d and p over a range, beside all of them, and the difference between the pictures.
pub fn against_settings(lab: &Lab) -> Result<Chart, String> {
    let scene = TexelScene::Sphere;
    let mut stand = lab.open(scene)?;
    let shot = lab.shot(scene, 1.0);
    stand.set(all());
    let whole = stand.count(&shot, &all());
    let reference = stand.photograph(&shot).rgb_bytes();
    let mut series = Vec::new();
    let (depths, pixels): (&[f32], &[f32]) = if lab.quick {
        (&[0.5], &[0.5, 1.0, 2.0])
    } else {
        (&[0.25, 0.5, 1.0, 2.0], &[0.5, 1.0, 2.0, 4.0, 8.0])
    };
    for &depth in depths {
        let mut points = Vec::new();
        for &pixels in pixels {
            let settings = with(depth, pixels);
            stand.set(settings);
            let counts = stand.count(&shot, &settings);
            let picture = stand.photograph(&shot).rgb_bytes();
            let flip = mean_flip((lab.size.x, lab.size.y), &reference, &picture);
            let fewer = whole.slices as f64 / counts.slices as f64;
            println!(
                "d {depth} e, p {pixels}: {counts:?} of {whole:?}, {fewer:.2} times fewer, FLIP {flip:.4}"
            );
            let point = Point::from((fewer, f64::from(flip)));
            let is_default = settings == TexelSettings::default();
            points.push(point.labelled(format!("p {pixels}")).marked(is_default));
        }
        series.push(Series::line(format!("d = {depth} e"), points));
    }
    Ok(Chart {
        title: "What the criteria save of all slices, sphere".into(),
        subtitle: stand.adapter(),
        x: Axis::log("times fewer slices than all"),
        y: Axis::linear("mean FLIP against all slices"),
        series,
    })
}

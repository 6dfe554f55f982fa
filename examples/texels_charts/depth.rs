//! How deep one may see: d against error and slices, where contours are wide and meet (§4.1).

use bevy::prelude::*;
use bevy_verdure::lab::Shot;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::TexelScene;
use bevy_verdure::prelude::*;

use super::lab::Lab;
use super::whole::{Whole, with};

/// Pears, from the side and from above.
pub fn against_depth(lab: &Lab) -> Result<Chart, String> {
    let scene = TexelScene::Pears;
    let mut stand = lab.open(scene)?;
    stand.multisample();
    let side = lab.shot(scene, 1.0);
    let above = Shot {
        eye: side.at + Vec3::new(0.0, 4.0, 1.2),
        ..side
    };
    let depths: &[f32] = if lab.quick {
        &[0.25, 0.5, 1.0]
    } else {
        &[0.125, 0.25, 0.375, 0.5, 0.75, 1.0, 2.0]
    };
    let mut series = Vec::new();
    for (name, shot) in [("from the side", side), ("from above", above)] {
        let whole = Whole::of(&mut stand, shot, PlantLighting::Simple);
        for pixels in [TexelQuality::default().pixels, 2.0] {
            let points = depths.iter().map(|&depth| {
                let settings = with(depth, pixels, PlantLighting::Simple);
                let is_default = settings == TexelSettings::default();
                let figures = whole.against(&mut stand, settings);
                let label = format!("d {depth}");
                Point::from(figures).labelled(label).marked(is_default)
            });
            let points: Vec<_> = points.collect();
            series.push(Series::line(format!("{name}, p {pixels}"), points));
        }
    }
    Ok(Chart {
        title: "How deep one may see into pears".into(),
        subtitle: stand.adapter(),
        x: Axis::log("times fewer slices than all"),
        y: Axis::linear("mean FLIP against all slices"),
        series,
    })
}

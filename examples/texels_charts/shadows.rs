//! How finely shadows need slices: error and time against p for the views of lights.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::TexelScene;
use bevy_verdure::lab::{Clock, Race, Variant, mean_flip};
use bevy_verdure::prelude::*;

use super::lab::Lab;

/// The default with some p for shadows.
fn with(pixels: f32) -> TexelSettings {
    let mut settings = TexelSettings::default();
    settings.shadows.pixels = pixels;
    settings
}

/// Frame time, and how far the picture is from that of the finest shadows.
pub fn against_pixels(lab: &Lab) -> Result<Chart, String> {
    let finest = 0.5;
    let (scenes, pixels): (&[TexelScene], &[f32]) = if lab.quick {
        (&[TexelScene::Sphere], &[1.0, 2.0, 4.0, 8.0])
    } else {
        (
            &[TexelScene::Sphere, TexelScene::Bushes, TexelScene::Plane],
            &[1.0, 2.0, 4.0, 8.0, 16.0],
        )
    };
    let mut series = Vec::new();
    let (mut adapter, mut clock) = (String::new(), Clock::Frames);
    for &scene in scenes {
        let mut stand = lab.open(scene)?;
        stand.multisample();
        (adapter, clock) = (stand.adapter(), Clock::of(stand.studio.world()));
        let shot = lab.shot(scene, 1.0);
        stand.set(with(finest));
        let reference = stand.photograph(&shot).rgb_bytes();
        let mut flips = Vec::new();
        for &p in pixels {
            stand.set(with(p));
            let picture = stand.photograph(&shot).rgb_bytes();
            flips.push(f64::from(mean_flip(
                (lab.size.x, lab.size.y),
                &reference,
                &picture,
            )));
        }
        let surfaces = stand.surfaces.clone();
        let mut variants: Vec<_> = pixels
            .iter()
            .map(|&p| {
                let surfaces = &surfaces;
                Variant::new(format!("p {p}"), move |headless| {
                    for surface in surfaces {
                        headless.world().entity_mut(*surface).insert(with(p));
                    }
                })
            })
            .collect();
        let race = Race {
            // A frame takes seconds on a software driver.
            rounds: if lab.quick { 3 } else { 5 },
            ..default()
        };
        let timings = race.run(&mut stand.studio.headless, &mut variants);
        let points = timings
            .iter()
            .zip(flips)
            .zip(pixels)
            .map(|((timing, flip), &p)| {
                let ms = timing.ms(clock);
                println!(
                    "{}, shadows at p {p}: FLIP {flip:.4}, {ms:.1} ms a frame",
                    scene.name()
                );
                let is_default = with(p) == TexelSettings::default();
                let point = Point::from((ms, flip)).labelled(timing.name.as_str());
                point.marked(is_default)
            });
        let points: Vec<_> = points.collect();
        series.push(Series::line(scene.name(), points));
    }
    Ok(Chart {
        title: "Slices in shadow maps: error against time".into(),
        subtitle: adapter,
        x: Axis::log(format!("{} (ms)", clock.label())),
        y: Axis::linear(format!("mean FLIP against shadows at p {finest}")),
        series,
    })
}

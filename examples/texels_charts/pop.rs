//! What pops: how neighbouring frames of a flight differ, with changes that fade and without, beyond what moves, which is
//! how the same frames differ as rays see them.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::texel_scenes::Pattern;
use bevy_verdure::lab::{Lens, Shot, adapter_name};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::Spreading;
use bevy_verdure::texel::silent;

use super::field::{BACKGROUND, Field};
use super::lab::Lab;
use super::march::Marched;

/// Rays along each side of a pixel of the reference.
const SAMPLES: u32 = 2;
/// Degrees that the eye rises by from frame to frame; it turns by as many.
const STEP: f32 = 0.5;
/// Where the flight begins, in degrees.
const LOWEST: f32 = 12.0;

/// The eye, at an elevation in degrees, going round as it rises.
fn shot(size: UVec2, degrees: f32) -> Shot {
    let (rise, level) = degrees.to_radians().sin_cos();
    let (aside, ahead) = degrees.to_radians().sin_cos();
    Shot {
        eye: Vec3::new(level * aside, rise, level * ahead) * 2.6 + Vec3::Y * 0.5,
        at: Vec3::Y * 0.5,
        lens: Lens::Perspective(0.55),
        size,
    }
}

/// The chart.
pub fn along_a_flight(lab: &Lab) -> Result<Chart, String> {
    let built = Pattern::Pear.build(UVec3::splat(64), Spreading::default(), &silent);
    let volume = built.map_err(|error| error.to_string())?.volume;
    let mut field = Field::new(volume, Vec2::new(0.8, 1.0), 1)?;
    let camera = field.studio.camera();
    let world = field.studio.world();
    world.entity_mut(camera).insert(Msaa::Sample4);
    let size = lab.size / 4;
    let frames = if lab.quick { 20 } else { 140 };
    let shots: Vec<Shot> = (0..frames)
        .map(|i| shot(size, LOWEST + STEP * i as f32))
        .collect();
    let marched: Vec<_> = shots
        .iter()
        .map(|shot| Marched::new(&field.volume, &field.facets, shot, SAMPLES).unlit(BACKGROUND))
        .collect();
    let still = vec![vec![0; marched[0].len()]; marched.len()];
    let mut series = vec![line("what moves, as rays see it", &still, &marched)];
    let handle = field.add_volume(field.volume.clone());
    for (name, fade) in [
        ("what else changes, if it pops", false),
        ("what else changes, if it fades", true),
    ] {
        let settings = TexelSettings {
            fade,
            lighting: PlantLighting::Unlit,
            ..default()
        };
        let texels = field.cover(&handle, settings);
        for _ in 0..3 {
            field.studio.headless.step();
        }
        let pictures: Vec<_> = shots
            .iter()
            .map(|shot| field.studio.photograph(shot, BACKGROUND).rgb_bytes())
            .collect();
        series.push(line(name, &marched, &pictures));
        field.studio.world().despawn(texels[0]);
    }
    Ok(Chart {
        title: "Neighbouring frames of a flight round a pear, half a degree apart".into(),
        subtitle: adapter_name(field.studio.world()),
        x: Axis::linear("elevation of the eye (degrees)"),
        y: Axis::linear("mean change from frame to frame (8-bit steps)"),
        series,
    })
}

/// How much pictures change from frame to frame otherwise than those that they are held against.
fn line(name: &str, against: &[Vec<u8>], pictures: &[Vec<u8>]) -> Series {
    let change = |pair: &[Vec<u8>], i: usize| f64::from(pair[1][i]) - f64::from(pair[0][i]);
    let changes: Vec<f64> = against
        .windows(2)
        .zip(pictures.windows(2))
        .map(|(moved, drawn)| {
            let count = drawn[0].len();
            let sum: f64 = (0..count)
                .map(|i| (change(drawn, i) - change(moved, i)).abs())
                .sum();
            sum / count as f64
        })
        .collect();
    let mut sorted = changes.clone();
    sorted.sort_by(f64::total_cmp);
    println!(
        "{name}: largest {:.3}, median {:.3}",
        sorted[sorted.len() - 1],
        sorted[sorted.len() / 2]
    );
    let elevation = |i: usize| f64::from(LOWEST) + f64::from(STEP) * (i as f64 + 0.5);
    let points = changes.into_iter().enumerate();
    Series::line(name, points.map(|(i, change)| (elevation(i), change)))
}

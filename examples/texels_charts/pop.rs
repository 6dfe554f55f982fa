//! What pops: the difference between neighbouring frames of a flight, with changes that fade and without, beside that of
//! the same frames as rays see them, which is what moves.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::texel_scenes::Pattern;
use bevy_verdure::lab::{Lens, Shot, adapter_name, mean_flip};
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

/// The eye, at an elevation in degrees, going round as it rises.
fn shot(size: UVec2, degrees: f32) -> Shot {
    let (rise, level) = degrees.to_radians().sin_cos();
    let (aside, ahead) = degrees.to_radians().sin_cos();
    Shot {
        eye: Vec3::new(level * aside, rise, level * ahead) * 3.2,
        at: Vec3::Y * 0.4,
        lens: Lens::Perspective(0.7),
        size,
    }
}

/// The chart.
pub fn along_a_flight(lab: &Lab) -> Result<Chart, String> {
    let built = Pattern::Pear.build(UVec3::splat(64), Spreading::default(), &silent);
    let volume = built.map_err(|error| error.to_string())?.volume;
    let mut field = Field::new(volume, Vec2::new(0.8, 1.0))?;
    let camera = field.studio.camera();
    field
        .studio
        .world()
        .entity_mut(camera)
        .insert(Msaa::Sample4);
    let size = lab.size / 4;
    let frames = if lab.quick { 20 } else { 140 };
    let shots: Vec<Shot> = (0..frames)
        .map(|i| shot(size, 12.0 + STEP * i as f32))
        .collect();
    let handle = field.add_volume(field.volume.clone());
    let mut series = Vec::new();
    for (name, fade) in [("changes pop", false), ("changes fade", true)] {
        let settings = TexelSettings {
            fade,
            lit: false,
            ..default()
        };
        let texels = field.cover(&handle, settings);
        for _ in 0..3 {
            field.studio.headless.step();
        }
        let pictures = shots
            .iter()
            .map(|shot| field.studio.photograph(shot, BACKGROUND).rgb_bytes());
        series.push(jumps(name, size, &pictures.collect::<Vec<_>>()));
        field.studio.world().despawn(texels[0]);
    }
    let marched = shots
        .iter()
        .map(|shot| Marched::new(&field.volume, &field.facets, shot, SAMPLES).unlit(BACKGROUND));
    series.push(jumps("as rays see it", size, &marched.collect::<Vec<_>>()));
    Ok(Chart {
        title: "Neighbouring frames of a flight over pears, half a degree apart".into(),
        subtitle: adapter_name(field.studio.world()),
        x: Axis::linear("elevation of the eye (degrees)"),
        y: Axis::linear("mean FLIP between neighbouring frames"),
        series,
    })
}

/// Differences of neighbouring pictures.
fn jumps(name: &str, size: UVec2, pictures: &[Vec<u8>]) -> Series {
    let jumps: Vec<f64> = pictures
        .windows(2)
        .map(|pair| f64::from(mean_flip((size.x, size.y), &pair[0], &pair[1])))
        .collect();
    let mut sorted = jumps.clone();
    sorted.sort_by(f64::total_cmp);
    println!(
        "{name}: largest {:.4}, median {:.4}",
        sorted[sorted.len() - 1],
        sorted[sorted.len() / 2]
    );
    let points = jumps.into_iter().enumerate();
    Series::line(
        name,
        points.map(|(i, jump)| (12.0 + f64::from(STEP) * (i as f64 + 0.5), jump)),
    )
}

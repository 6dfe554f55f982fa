//! Speed against accuracy: mean FLIP against the f64 march under the same light, and the time of a frame, of texels and of
//! what a user would take instead.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::texel_scenes::{Pattern, all_slices};
use bevy_verdure::lab::{Clock, Headless, Race, Shot, Variant, adapter_name, mean_flip};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::Spreading;
use bevy_verdure::texel::{BakedLight, silent};

use super::field::{BACKGROUND, Field, TO_SUN, shot};
use super::lab::Lab;
use super::march::Marched;
use super::whole;

/// Texels along each side.
const SQUARES: u32 = 4;
/// Rays along each side of a pixel of the reference.
const SAMPLES: u32 = 3;

/// A way to draw the field.
struct Way {
    series: &'static str,
    /// What of it is varied.
    label: String,
    is_default: bool,
    entities: Vec<Entity>,
}

/// Pears, whose sides are solid and smooth.
pub fn of_pears(lab: &Lab) -> Result<Chart, String> {
    of(lab, Pattern::Pear, "pears", Vec2::new(0.8, 1.0))
}

/// A height field.
pub fn of_noise(lab: &Lab) -> Result<Chart, String> {
    of(lab, Pattern::Noise, "noise", Vec2::new(1.0, 0.3))
}

fn of(lab: &Lab, pattern: Pattern, name: &str, texel: Vec2) -> Result<Chart, String> {
    let built = pattern.build(pattern.size(), Spreading::default(), &silent);
    let volume = built.map_err(|error| error.to_string())?.volume;
    let mut field = Field::new(volume, texel, SQUARES)?;
    let shot = shot(lab.size / 4, texel.x * SQUARES as f32);
    let marched = Marched::new(&field.volume, &field.facets, &shot, SAMPLES);
    let reference = marched.lit(&mut field.studio, BACKGROUND);
    let ways = ways(lab, &mut field);
    let errors = errors(lab, &mut field, &shot, &reference, &ways, name)?;
    let times = times(lab, &mut field, &ways);
    let clock = Clock::of(field.studio.world());
    let mut series: Vec<Series> = Vec::new();
    for ((way, error), ms) in ways.iter().zip(errors).zip(times) {
        println!("{name}: {} {}: {ms:.1} ms", way.series, way.label);
        let point = Point::from((ms, error))
            .labelled(way.label.clone())
            .marked(way.is_default);
        match series.last_mut().filter(|last| last.name == way.series) {
            Some(last) => last.points.push(point),
            None => series.push(Series::line(way.series, [point])),
        }
    }
    Ok(Chart {
        title: format!(
            "Texels and what else {} {name} may be drawn with, {} x {}",
            SQUARES * SQUARES,
            shot.size.x,
            shot.size.y
        ),
        subtitle: adapter_name(field.studio.world()),
        x: Axis::log(format!("{} above the empty scene's (ms)", clock.label())),
        y: Axis::linear("mean FLIP against rays marched in f64"),
        series,
    })
}

fn ways(lab: &Lab, field: &mut Field) -> Vec<Way> {
    let mut ways = Vec::new();
    let mut add = |series, label: String, is_default, entities| {
        ways.push(Way {
            series,
            label,
            is_default,
            entities,
        });
    };
    let size = field.volume.size();
    let volume = field.add_volume(field.volume.clone());
    let every = if lab.quick { 2 } else { 1 };
    // From four on.
    let powers = |most: u32| (2..=most.ilog2()).step_by(every).map(|i| 1 << i);
    for count in powers(size.z) {
        let shells = field.add_shells(count);
        add(
            "plain shells, one direction",
            count.to_string(),
            false,
            shells,
        );
    }
    // Lit as the reference is, so that slices alone err.
    let with = |depth, pixels| whole::with(depth, pixels, PlantLighting::Full);
    for most_slices in powers(size.x) {
        let settings = TexelSettings {
            most_slices,
            ..all_slices(PlantLighting::Full)
        };
        let texels = field.cover(&volume, settings);
        add(
            "three directions, all slices",
            most_slices.to_string(),
            false,
            texels,
        );
    }
    let usual = TexelQuality::default();
    for depth in [2.0, 1.0, 0.5, 0.25, 0.125].into_iter().step_by(every) {
        let texels = field.cover(&volume, with(depth, usual.pixels));
        add("texels, by d/e", depth.to_string(), false, texels);
    }
    for pixels in [8.0, 4.0, 2.0, usual.pixels, 0.5]
        .into_iter()
        .step_by(every)
    {
        let texels = field.cover(&volume, with(0.125, pixels));
        add("texels, by p at d = e/8", pixels.to_string(), false, texels);
    }
    for pixels in [4.0, 2.0, usual.pixels, 0.5].into_iter().step_by(every) {
        let mut settings = TexelSettings::default();
        settings.quality.pixels = pixels;
        let is_default = settings == TexelSettings::default();
        let texels = field.cover(&volume, settings);
        add(
            "texels in simple light, by p",
            pixels.to_string(),
            is_default,
            texels,
        );
    }
    for (label, turn) in [("same sun", 0.0f32), ("sun 60 degrees on", 60.0)] {
        let from = Quat::from_rotation_z(turn.to_radians()) * TO_SUN;
        let light = BakedLight {
            // u is x, v is −z, w is y.
            from: Vec3::new(from.x, -from.z, from.y),
            // As bright as the scene's.
            ambient: 0.12,
            diffuse: 0.8,
            ..default()
        };
        let settings = TexelSettings {
            lighting: PlantLighting::Unlit,
            ..default()
        };
        let baked = field.add_volume(field.volume.baked(&light));
        let texels = field.cover(&baked, settings);
        add("texels, light baked", label.into(), false, texels);
    }
    for cells in [4, 8, 12, 16, 24, 32].into_iter().step_by(every) {
        let (meshes, triangles) = field.add_low_poly(cells);
        add(
            "instanced meshes, by triangles",
            triangles.to_string(),
            false,
            meshes,
        );
    }
    ways
}

/// Shows one of the ways, or none.
fn show(world: &mut World, ways: &[Way], shown: Option<usize>) {
    for (i, way) in ways.iter().enumerate() {
        let visibility = if shown == Some(i) {
            Visibility::Visible
        } else {
            Visibility::Hidden
        };
        for entity in &way.entities {
            world.entity_mut(*entity).insert(visibility);
        }
    }
}

fn errors(
    lab: &Lab,
    field: &mut Field,
    shot: &Shot,
    reference: &[u8],
    ways: &[Way],
    name: &str,
) -> Result<Vec<f64>, String> {
    let camera = field.studio.camera();
    field
        .studio
        .world()
        .entity_mut(camera)
        .insert(Msaa::Sample4);
    let mut errors = Vec::new();
    lab.keep(&format!("{name}_reference"), shot.size, reference)?;
    for i in 0..ways.len() {
        show(field.studio.world(), ways, Some(i));
        for _ in 0..2 {
            field.studio.headless.step();
        }
        let picture = field.studio.photograph(shot, BACKGROUND);
        let rgb = picture.rgb_bytes();
        let error = mean_flip((shot.size.x, shot.size.y), reference, &rgb);
        println!("{name}: {} {}: {error:.4}", ways[i].series, ways[i].label);
        errors.push(f64::from(error));
        lab.keep(&format!("{name}_{i}"), shot.size, &rgb)?;
    }
    Ok(errors)
}

/// Times above the empty scene's, in milliseconds.
fn times(lab: &Lab, field: &mut Field, ways: &[Way]) -> Vec<f64> {
    let clock = Clock::of(field.studio.world());
    let mut variants: Vec<Variant> = core::iter::once(None)
        .chain((0..ways.len()).map(Some))
        .map(|shown| {
            let apply = move |headless: &mut Headless| show(headless.world(), ways, shown);
            Variant::new(shown.map_or("empty", |i| ways[i].series), apply)
        })
        .collect();
    let race = Race {
        rounds: if lab.quick { 2 } else { 5 },
        // Pipelines were compiled for the pictures.
        warm_up: 0,
        settle: 1,
    };
    let timings = race.run(&mut field.studio.headless, &mut variants);
    timings[1..]
        .iter()
        .map(|timing| timing.less(&timings[0]).ms(clock))
        .collect()
}

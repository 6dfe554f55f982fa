//! Error of slicings against the supersampled mesh, at the size on screen that a distance gives.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::{Lens, Shot, box_downsample, mean_flip};
use bevy_verdure::prelude::*;

use super::lab::{Drawn, Lab};

/// Samples along each side of a pixel of the reference.
const SAMPLES: u32 = 4;
/// Vertical field of view, in radians, and lines of the screen that pictures are cut from.
const SCREEN: (f32, f32) = (0.9, 480.0);
/// Distances of the eyes, in metres.
pub const DISTANCES: [f32; 4] = [5.0, 10.0, 25.0, 50.0];
/// What is behind.
pub const SKY: Color = Color::srgb(0.6, 0.8, 1.0);

/// A shot that the crown fills, from a distance, an azimuth and an elevation in degrees, with the pixels of the screen.
pub fn shot(lab: &Lab, distance: f32, azimuth: f32, elevation: f32) -> Shot {
    let centroid = lab.centroid();
    let half = 1.1 * lab.radius();
    let angle = 2.0 * (half / distance).atan();
    let lines = SCREEN.1 * (0.5 * angle).tan() / (0.5 * SCREEN.0).tan();
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let (rise, level) = elevation.to_radians().sin_cos();
    Shot {
        eye: centroid + Vec3::new(level * cos, rise, level * sin) * distance,
        at: centroid,
        lens: Lens::Perspective(angle),
        size: UVec2::splat((lines as u32).clamp(16, 640)),
    }
}

/// The mesh, supersampled.
pub fn reference(lab: &mut Lab, shot: &Shot) -> Vec<u8> {
    let fine = Shot {
        size: shot.size * SAMPLES,
        ..*shot
    };
    let picture = lab.studio.photograph(&fine, SKY);
    box_downsample(shot.size, SAMPLES, &picture.rgb_bytes())
}

/// Mean FLIP of ways to draw the crown against the mesh, over some shots.
pub fn flips(lab: &mut Lab, shots: &[Shot], ways: &[(String, Drawn)]) -> Vec<f64> {
    let errors = errors_by_shots(lab, &[shots.to_vec()], ways);
    errors.into_iter().flatten().collect()
}

/// Mean FLIP of ways to draw the crown against the mesh, over each of some groups of shots: those of the first way first.
pub fn errors_by_shots(
    lab: &mut Lab,
    groups: &[Vec<Shot>],
    ways: &[(String, Drawn)],
) -> Vec<Vec<f64>> {
    errors_of_trees(lab, &[Transform::IDENTITY], groups, ways)
}

/// The same for trees at some places.
pub fn errors_of_trees(
    lab: &mut Lab,
    places: &[Transform],
    groups: &[Vec<Shot>],
    ways: &[(String, Drawn)],
) -> Vec<Vec<f64>> {
    let camera = lab.studio.camera();
    let meshes = planted(lab, &Drawn::Mesh, places);
    let references: Vec<Vec<Vec<u8>>> = groups
        .iter()
        .map(|shots| shots.iter().map(|shot| reference(lab, shot)).collect())
        .collect();
    uproot(lab, &meshes);
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let mut errors = Vec::new();
    for (name, drawn) in ways {
        let trees = planted(lab, drawn, places);
        let mut of_groups = Vec::new();
        for (shots, references) in groups.iter().zip(&references) {
            let mut sum = 0.0;
            for (shot, reference) in shots.iter().zip(references) {
                let picture = lab.studio.photograph(shot, SKY).rgb_bytes();
                sum += f64::from(mean_flip((shot.size.x, shot.size.y), reference, &picture));
            }
            of_groups.push(sum / shots.len() as f64);
        }
        println!("{name}: {of_groups:.4?}");
        errors.push(of_groups);
        uproot(lab, &trees);
    }
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    errors
}

/// Plants trees, and waits until they are drawn.
pub fn planted(lab: &mut Lab, drawn: &Drawn, places: &[Transform]) -> Vec<Entity> {
    let plant = |place: &Transform| lab.plant(drawn, *place);
    let trees = places.iter().map(plant).collect();
    for _ in 0..3 {
        lab.studio.headless.step();
    }
    trees
}

pub fn uproot(lab: &mut Lab, trees: &[Entity]) {
    for tree in trees {
        lab.studio.world().despawn(*tree);
    }
    lab.studio.headless.step();
}

/// Slicings of some settings, by name.
fn baked(lab: &mut Lab, bakes: &[BakeSettings]) -> Result<Vec<(String, Drawn)>, String> {
    let slicing = |bake: &BakeSettings| {
        let name = format!("{:?} {:?} {}", bake.orientations, bake.levels, bake.pixels);
        let drawn = Drawn::Slicing(lab.bake(bake)?, CrownSettings::default());
        Ok((name, drawn))
    };
    bakes.iter().map(slicing).collect()
}

/// Eyes on a circle, off the orientations: nine, or five of a quick run.
pub fn circle(lab: &Lab, distance: f32) -> Vec<Shot> {
    eyes(lab, distance, if lab.quick { 5 } else { 9 })
}

/// Five eyes on a circle, of which six orientations are 3, 9, 15, 21 and 27 degrees off.
pub fn five(lab: &Lab, distance: f32) -> Vec<Shot> {
    eyes(lab, distance, 5)
}

fn eyes(lab: &Lab, distance: f32, count: u32) -> Vec<Shot> {
    (0..count)
        .map(|i| shot(lab, distance, 3.0 + 360.0 / count as f32 * i as f32, 4.0))
        .collect()
}

/// One line a distance, a point a setting; `make` gives the bake of a number.
fn chart(
    lab: &mut Lab,
    title: &str,
    axis: Axis,
    numbers: &[u32],
    default: u32,
    make: impl Fn(u32) -> BakeSettings,
) -> Result<Chart, String> {
    let bakes: Vec<_> = numbers.iter().map(|n| make(*n)).collect();
    let slicings = baked(lab, &bakes)?;
    let mut series = Vec::new();
    let distances: &[f32] = if lab.quick { &[25.0] } else { &DISTANCES };
    for distance in distances {
        let shots = five(lab, *distance);
        let errors = flips(lab, &shots, &slicings);
        let points = numbers
            .iter()
            .zip(errors)
            .map(|(n, error)| Point::from((f64::from(*n), error)).marked(*n == default));
        series.push(Series::line(format!("{distance} m"), points));
    }
    Ok(Chart {
        title: title.into(),
        subtitle: lab.adapter.clone(),
        x: axis,
        y: Axis::linear("mean FLIP against the supersampled mesh"),
        series,
    })
}

pub fn against_slices(lab: &mut Lab) -> Result<Chart, String> {
    let make = |slices| BakeSettings::default().with_slices(slices);
    let numbers = [1, 2, 3, 5, 7, 10, 15];
    chart(
        lab,
        "Error against slices, 6 orientations of 256 pixels",
        Axis::linear("slices"),
        &numbers,
        5,
        make,
    )
}

pub fn against_orientations(lab: &mut Lab) -> Result<Chart, String> {
    let make = |count| {
        BakeSettings::default()
            .with_slices(5)
            .with_orientations(Orientations::Circle(count))
    };
    let numbers = [3, 4, 6, 8, 12, 24];
    chart(
        lab,
        "Error against orientations of 5 slices, 256 pixels",
        Axis::linear("orientations"),
        &numbers,
        6,
        make,
    )
}

pub fn against_pixels(lab: &mut Lab) -> Result<Chart, String> {
    let make = |pixels| BakeSettings::default().with_slices(5).with_pixels(pixels);
    let numbers = [32, 64, 128, 256, 512];
    chart(
        lab,
        "Error against pixels, 6 orientations of 5 slices",
        Axis::log("pixels a side"),
        &numbers,
        256,
        make,
    )
}

/// Where it fails: eyes far above and below, with and without the vertical slicing.
pub fn against_elevation(lab: &mut Lab) -> Result<Chart, String> {
    let ways = [("with a vertical slicing", true), ("without", false)];
    let mut series: Vec<_> = ways
        .iter()
        .map(|(name, _)| Series::line(*name, Vec::<Point>::new()))
        .collect();
    let bakes = ways.map(|(_, vertical)| BakeSettings {
        vertical,
        ..BakeSettings::default().with_slices(5)
    });
    let slicings = baked(lab, &bakes)?;
    let step = if lab.quick { 40 } else { 20 };
    for elevation in (-30..=90).step_by(step) {
        let shots: Vec<_> = [33.0, 167.0, 272.0]
            .map(|azimuth| shot(lab, 25.0, azimuth, elevation as f32))
            .into();
        let errors = flips(lab, &shots, &slicings);
        for (series, error) in series.iter_mut().zip(errors) {
            series.points.push((f64::from(elevation), error).into());
        }
    }
    Ok(Chart {
        title: "Error against the eye's elevation, 25 m away".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("elevation (degrees)"),
        y: Axis::linear("mean FLIP against the supersampled mesh"),
        series,
    })
}

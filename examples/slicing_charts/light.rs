//! Whether a crown near by differs from its mesh by how much it covers or by how it is lit, and by which light.

use bevy::prelude::*;
use bevy_verdure::lab::SUNLIGHT;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::prelude::*;

use super::accuracy::{planted, shot, uproot};
use super::brightness::{brightness, eyes};
use super::lab::{Drawn, Lab};

/// What is lit by what: a name, luminous exitance of light from around, whether the sun shines, and casts shadows.
const LIGHTS: [(&str, f32, bool, bool); 3] = [
    ("light from around", 750.0, false, false),
    ("sun without shadows", 0.0, true, false),
    ("sun with shadows", 0.0, true, true),
];

fn set(lab: &mut Lab, around: f32, shines: bool, casts: bool) {
    let world = lab.studio.world();
    world.insert_resource(GlobalAmbientLight {
        brightness: around,
        ..default()
    });
    let mut suns = world.query::<&mut DirectionalLight>();
    for mut sun in suns.iter_mut(world) {
        sun.illuminance = if shines { 10_500.0 } else { 0.0 };
        sun.shadow_maps_enabled = casts;
    }
}

/// The share of what is behind that a crown covers, and the mean light of what covers it by each of the lights, in
/// line with an orientation and half-way to the next, by distance.
fn measure(lab: &mut Lab, drawn: &Drawn, distances: &[f32]) -> Vec<[f64; 4]> {
    let crown = planted(lab, drawn, &[Transform::IDENTITY]);
    let mut all = Vec::new();
    for distance in distances {
        let shots: Vec<_> = [0.0, 30.0]
            .into_iter()
            .flat_map(|angle| eyes(lab, *distance, angle))
            .collect();
        let own = LIGHTS.map(|(_, around, shines, casts)| {
            set(lab, around, shines, casts);
            for _ in 0..3 {
                lab.studio.headless.step();
            }
            brightness(lab, &shots, Color::BLACK)
        });
        let cover = 1.0 - (brightness(lab, &shots, Color::WHITE) - own[2]);
        all.push([cover, own[0] / cover, own[1] / cover, own[2] / cover]);
    }
    uproot(lab, &crown);
    all
}

/// Elevations of the eye, in degrees.
const ELEVATIONS: [f32; 7] = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0, 90.0];
/// Metres from the crown's centroid to the eyes above.
const DISTANCES: [f32; 3] = [8.0, 15.0, 25.0];

/// The share of what is behind that a crown covers, and the mean light of what covers it, distance by distance and by
/// elevation of the eye.
fn from_above(lab: &mut Lab, drawn: &Drawn, distances: &[f32]) -> Vec<[f64; 2]> {
    let crown = planted(lab, drawn, &[Transform::IDENTITY]);
    let places = distances.iter().flat_map(|d| ELEVATIONS.map(|e| (*d, e)));
    let all = places
        .map(|(distance, elevation)| {
            let azimuths = [3.0, 123.0, 270.0];
            let shots = azimuths.map(|azimuth| shot(lab, distance, azimuth, elevation));
            let black = brightness(lab, &shots, Color::BLACK);
            let cover = 1.0 - (brightness(lab, &shots, Color::WHITE) - black);
            [cover, black / cover]
        })
        .collect();
    uproot(lab, &crown);
    all
}

/// A chart of ratios to the mesh by `places` along `x`, one line a name.
fn ratio_chart(
    lab: &Lab,
    title: &str,
    x: &str,
    places: &[f32],
    lines: impl IntoIterator<Item = (String, Vec<f64>)>,
) -> Chart {
    let series = lines.into_iter().map(|(name, ratios)| {
        println!("{name}: {ratios:.3?}");
        Series::line(name, places.iter().map(|at| f64::from(*at)).zip(ratios))
    });
    Chart {
        title: title.into(),
        series: series.collect(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear(x),
        y: Axis::linear("ratio to the mesh"),
    }
}

/// The same by elevation of the eye.
fn elevation_chart(lab: &Lab, title: &str, lines: Vec<(String, Vec<f64>)>) -> Chart {
    ratio_chart(lab, title, "elevation (degrees)", &ELEVATIONS, lines)
}

/// Lets the sun shine in a direction.
fn turn_sun(lab: &mut Lab, sunlight: Vec3) {
    let world = lab.studio.world();
    let mut suns = world.query_filtered::<&mut Transform, With<DirectionalLight>>();
    for mut sun in suns.iter_mut(world) {
        // It may shine straight down.
        sun.look_to(sunlight, Vec3::Z);
    }
}

/// The share of what is behind that a crown covers, over the mesh's, by elevation of the eye.
pub fn cover_by_elevation(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let [mesh, sliced] = [Drawn::Mesh, Drawn::Slicing(slicing, default())]
        .map(|drawn| from_above(lab, &drawn, &DISTANCES));
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    let ratios: Vec<f64> = mesh.iter().zip(&sliced).map(|(m, s)| s[0] / m[0]).collect();
    let lines = DISTANCES.iter().zip(ratios.chunks(ELEVATIONS.len()));
    let lines = lines.map(|(distance, ratios)| (format!("{distance} m"), ratios.to_vec()));
    let title = "Cover of a crown of slices, over the mesh's";
    Ok(elevation_chart(lab, title, lines.collect()))
}

/// The light of a crown, over the mesh's, by elevation of the eye, in the light of the grove and with its sun overhead.
pub fn light_by_elevation(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let distances = if lab.quick {
        &DISTANCES[1..2]
    } else {
        &DISTANCES
    };
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let mut lines = Vec::new();
    for (name, towards) in [
        ("sun of the grove", SUNLIGHT),
        ("sun overhead", Vec3::NEG_Y),
    ] {
        turn_sun(lab, towards);
        let [mesh, sliced] = [Drawn::Mesh, Drawn::Slicing(slicing.clone(), default())]
            .map(|drawn| from_above(lab, &drawn, distances));
        let ratios: Vec<f64> = mesh.iter().zip(&sliced).map(|(m, s)| s[1] / m[1]).collect();
        let of_sun = distances.iter().zip(ratios.chunks(ELEVATIONS.len()));
        lines.extend(of_sun.map(|(at, ratios)| (format!("{name}, {at} m"), ratios.to_vec())));
    }
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    let title = "Light of a crown of slices, over the mesh's";
    Ok(elevation_chart(lab, title, lines))
}

/// How far eyes are turned from the sun, in degrees of azimuth.
const TURNS: [f32; 7] = [0.0, 20.0, 40.0, 60.0, 90.0, 135.0, 180.0];

/// The mean light of what covers what is behind, for eyes as high as the sun, turn by turn. The sun goes round, so that no
/// direction of the tree counts for more.
fn round_the_sun(lab: &mut Lab, drawn: &Drawn, distance: f32, elevation: f32) -> [f64; 7] {
    let crown = planted(lab, drawn, &[Transform::IDENTITY]);
    let all = TURNS.map(|turn| {
        let (mut light, mut cover) = (0.0, 0.0);
        for sun in [10.0, 85.0, 160.0, 250.0] {
            let from_sun = shot(lab, distance, sun, elevation);
            turn_sun(lab, from_sun.at - from_sun.eye);
            for _ in 0..2 {
                lab.studio.headless.step();
            }
            let shots = [shot(lab, distance, sun + turn, elevation)];
            let black = brightness(lab, &shots, Color::BLACK);
            cover += 1.0 - (brightness(lab, &shots, Color::WHITE) - black);
            light += black;
        }
        light / cover
    });
    uproot(lab, &crown);
    all
}

/// The light of a crown, over the mesh's, for eyes as high as the sun, low and high, by how far they are turned from it.
pub fn light_by_azimuth(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let places = [10.0, 47.0].map(|elevation| [15.0, 40.0].map(|distance| (elevation, distance)));
    let lines = places.as_flattened().iter().map(|&(elevation, distance)| {
        let [mesh, sliced] = [Drawn::Mesh, Drawn::Slicing(slicing.clone(), default())]
            .map(|drawn| round_the_sun(lab, &drawn, distance, elevation));
        let ratios = mesh.iter().zip(&sliced).map(|(mesh, sliced)| sliced / mesh);
        let name = format!("sun {elevation} degrees high, {distance} m");
        (name, ratios.collect())
    });
    let lines: Vec<_> = lines.collect();
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    let title = "Light of a crown of slices, over the mesh's, by azimuth from the sun's";
    let x = "azimuth of the eye from the sun (degrees)";
    Ok(ratio_chart(lab, title, x, &TURNS, lines))
}

pub fn against_distance(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let distances: &[f32] = if lab.quick {
        &[8.0, 15.0, 25.0]
    } else {
        &[6.0, 8.0, 11.0, 15.0, 20.0, 25.0, 35.0, 50.0]
    };
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let [mesh, sliced] = [Drawn::Mesh, Drawn::Slicing(slicing, default())]
        .map(|drawn| measure(lab, &drawn, distances));
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    let names = ["cover"]
        .into_iter()
        .chain(LIGHTS.iter().map(|(name, ..)| *name));
    let lines = names.enumerate().map(|(k, name)| {
        let ratios = mesh.iter().zip(&sliced).map(|(mesh, s)| s[k] / mesh[k]);
        (name.into(), ratios.collect())
    });
    let title = "Cover and light of a crown of slices, over the mesh's";
    Ok(ratio_chart(lab, title, "distance (m)", distances, lines))
}

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

/// A chart of ratios to the mesh by elevation, one line a name.
fn elevation_chart(lab: &Lab, title: &str, lines: Vec<(String, Vec<f64>)>) -> Chart {
    let series = lines.into_iter().map(|(name, ratios)| {
        println!("{name}: {ratios:.3?}");
        let elevations = ELEVATIONS.iter().map(|e| f64::from(*e));
        Series::line(name, elevations.zip(ratios))
    });
    Chart {
        title: title.into(),
        series: series.collect(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("elevation (degrees)"),
        y: Axis::linear("ratio to the mesh"),
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
        let world = lab.studio.world();
        let mut suns = world.query_filtered::<&mut Transform, With<DirectionalLight>>();
        for mut sun in suns.iter_mut(world) {
            sun.look_to(towards, Vec3::Z);
        }
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

/// The light of a crown, over the mesh's, for eyes as high as the sun, by how far they are turned from it, low and high.
pub fn light_by_azimuth(lab: &mut Lab) -> Result<Chart, String> {
    const TURNS: [f32; 7] = [0.0, 20.0, 40.0, 60.0, 90.0, 135.0, 180.0];
    let slicing = lab.bake(&BakeSettings::default())?;
    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let mut lines = Vec::new();
    for elevation in [10.0, 47.0] {
        for distance in [15.0, 40.0] {
            // The sun goes round, so that no direction of the tree counts for more.
            let mut light = |drawn: &Drawn| {
                let crown = planted(lab, drawn, &[Transform::IDENTITY]);
                let all = TURNS.map(|turn| {
                    let suns = [10.0, 85.0, 160.0, 250.0];
                    let mut sum = 0.0;
                    let mut cover = 0.0;
                    for sun in suns {
                        let at = |azimuth: f32| shot(lab, distance, azimuth, elevation);
                        let to_sun = at(sun).eye - at(sun).at;
                        let shots = [at(sun + turn)];
                        let world = lab.studio.world();
                        let mut query =
                            world.query_filtered::<&mut Transform, With<DirectionalLight>>();
                        for mut sun in query.iter_mut(world) {
                            sun.look_to(-to_sun, Vec3::Y);
                        }
                        for _ in 0..2 {
                            lab.studio.headless.step();
                        }
                        let black = brightness(lab, &shots, Color::BLACK);
                        cover += 1.0 - (brightness(lab, &shots, Color::WHITE) - black);
                        sum += black;
                    }
                    sum / cover
                });
                uproot(lab, &crown);
                all
            };
            let mesh = light(&Drawn::Mesh);
            let sliced = light(&Drawn::Slicing(slicing.clone(), default()));
            println!("{elevation} {distance}: mesh {mesh:.3?}");
            let ratios = TURNS
                .iter()
                .enumerate()
                .map(|(i, turn)| (f64::from(*turn), sliced[i] / mesh[i]));
            lines.push((
                format!("sun {elevation} degrees high, {distance} m"),
                ratios.collect::<Vec<_>>(),
            ));
        }
    }
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);
    let series = lines.into_iter().map(|(name, points)| {
        println!(
            "{name}: {:.3?}",
            points.iter().map(|p| p.1).collect::<Vec<_>>()
        );
        Series::line(name, points)
    });
    Ok(Chart {
        title: "Light of a crown of slices, over the mesh's, by azimuth from the sun's".into(),
        series: series.collect(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("azimuth of the eye from the sun (degrees)"),
        y: Axis::linear("ratio to the mesh"),
    })
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
    let series = names.enumerate().map(|(k, name)| {
        let ratios = mesh.iter().zip(&sliced).map(|(mesh, s)| s[k] / mesh[k]);
        let ratios: Vec<f64> = ratios.collect();
        println!("{name}: {ratios:.3?}");
        Series::line(name, distances.iter().map(|d| f64::from(*d)).zip(ratios))
    });
    Ok(Chart {
        title: "Cover and light of a crown of slices, over the mesh's".into(),
        series: series.collect(),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("distance (m)"),
        y: Axis::linear("ratio to the mesh"),
    })
}

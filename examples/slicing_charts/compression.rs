//! What compression on the GPU takes from a slicing's looks, what it saves, and how long it takes.

use std::time::Instant;

use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Shot, mean_flip};
use bevy_verdure::prelude::*;

use super::accuracy::{SKY, circle, planted, reference, uproot};
use super::lab::{Drawn, Lab};

const CHOICES: [SlicingCompression; 2] = [
    SlicingCompression::Never,
    SlicingCompression::WhereSupported,
];

/// Error against distance.
pub fn against_distance(lab: &mut Lab) -> Result<Chart, String> {
    let handle = lab.bake(&BakeSettings::default())?;
    let world = lab.studio.world();
    let pixels = BakeSettings::default().pixels;
    let features = world.resource::<RenderDevice>().features();
    if !SlicingCompression::WhereSupported.applies(pixels, features) {
        return Err("this device reads no BC textures".into());
    }
    if let Some(slicing) = world.resource::<Assets<Slicing>>().get(&handle) {
        let mebibytes = |compressed| slicing.gpu_bytes(compressed) as f64 / f64::from(1 << 20);
        println!(
            "{:.1} MiB, {:.1} compressed",
            mebibytes(false),
            mebibytes(true)
        );
    }
    let distances = [5.0, 10.0, 25.0, 50.0];
    let shots: Vec<Shot> = distances.iter().flat_map(|m| circle(lab, *m)).collect();
    let meshes = planted(lab, &Drawn::Mesh, &[Transform::IDENTITY]);
    let references: Vec<_> = shots.iter().map(|shot| reference(lab, shot)).collect();
    uproot(lab, &meshes);

    let camera = lab.studio.camera();
    lab.studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let drawn = Drawn::Slicing(handle, CrownSettings::default());
    let trees = planted(lab, &drawn, &[Transform::IDENTITY]);
    let [baked, compressed] = CHOICES.map(|choice| {
        println!("{choice:?}: made in {:.2} s", time(lab, choice));
        let photograph = |shot: &Shot| lab.studio.photograph(shot, SKY).rgb_bytes();
        shots.iter().map(photograph).collect::<Vec<_>>()
    });
    for choice in CHOICES {
        println!("{choice:?}, once more: made in {:.2} s", time(lab, choice));
    }
    uproot(lab, &trees);
    lab.studio.world().entity_mut(camera).insert(Msaa::Off);

    let each = shots.len() / distances.len();
    let series = [
        ("as baked, against the mesh", &baked, &references),
        ("compressed, against the mesh", &compressed, &references),
        ("compressed, against as baked", &compressed, &baked),
    ]
    .map(|(name, pictures, references)| {
        let points: Vec<(f64, f64)> = distances
            .iter()
            .enumerate()
            .map(|(i, distance)| {
                let flips = (i * each..(i + 1) * each).map(|k| {
                    let size = shots[k].size;
                    f64::from(mean_flip((size.x, size.y), &references[k], &pictures[k]))
                });
                (f64::from(*distance), flips.sum::<f64>() / each as f64)
            })
            .collect();
        println!("{name}: {points:.4?}");
        Series::line(name, points)
    });
    Ok(Chart {
        title: "Error of slicings compressed on the GPU".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("distance (m), on a screen of 480 lines"),
        y: Axis::linear("mean FLIP"),
        series: series.into(),
    })
}

/// Seconds of the frame in which a choice is followed over those of the next.
fn time(lab: &mut Lab, choice: SlicingCompression) -> f64 {
    lab.studio.world().insert_resource(choice);
    let [with, without] = [(); 2].map(|()| {
        let start = Instant::now();
        lab.studio.headless.step();
        start.elapsed().as_secs_f64()
    });
    with - without
}

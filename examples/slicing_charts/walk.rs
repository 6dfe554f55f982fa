//! The paper's experiment (§3.1, Figure 4): frame times along a recorded walk through a grove, worst case and average.

use std::time::Instant;

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Lens, Shot, wait_for_gpu};
use bevy_verdure::prelude::*;

use super::accuracy::SKY;
use super::grove;
use super::lab::{Drawn, Lab};
use super::rosette::{self, FRAMES};

/// Most trees that are drawn as meshes.
const MESHES: u32 = 128;
/// Share of the times, the longest ones, that the paper leaves out for what else the machine does.
const LEFT_OUT: f64 = 0.05;

/// Frames of the walk from one stretch that is looked at to the next.
const STRIDE: usize = 130;

/// Steps to a frame of the walk.
fn step(lab: &mut Lab, trees: u32, frame: usize) {
    let (eye, at) = rosette::view(grove::radius(trees), frame);
    let shot = Shot {
        eye,
        at,
        lens: Lens::Perspective(0.9),
        size: UVec2::new(640, 480),
    };
    let camera = lab.studio.camera();
    let mut camera = lab.studio.world().entity_mut(camera);
    camera.insert(shot.transform());
    lab.studio.headless.step();
    wait_for_gpu(lab.studio.world());
}

/// What the frame of a group takes above the empty scene's, in milliseconds, on each stretch of the walk that is looked at:
/// the mean of as many frames that follow one another as the paper takes, or of a few if it is to be quick.
fn times(lab: &mut Lab, trees: u32, groups: &[Vec<Entity>]) -> Vec<Vec<f64>> {
    let frames = if lab.quick { 4 } else { 20 };
    let mut times = vec![Vec::new(); groups.len()];
    for first in (0..FRAMES).step_by(STRIDE) {
        let mut empty = 0.0;
        for shown in core::iter::once(None).chain((0..groups.len()).map(Some)) {
            grove::show(lab.studio.world(), groups, shown);
            // What changes a scene costs the frame that it changes in.
            step(lab, trees, first);
            let started = Instant::now();
            for frame in first..first + frames {
                step(lab, trees, frame);
            }
            let took = started.elapsed().as_secs_f64() * 1e3 / frames as f64;
            match shown {
                None => empty = took,
                Some(group) => times[group].push((took - empty).max(0.0)),
            }
        }
    }
    times
}

/// The longest of some times, the longest few left out, and their mean.
fn worst_and_mean(times: &mut [f64]) -> (f64, f64) {
    times.sort_by(f64::total_cmp);
    let left_out = (times.len() as f64 * LEFT_OUT).ceil() as usize;
    let worst = times[times.len() - 1 - left_out];
    (worst, times.iter().sum::<f64>() / times.len() as f64)
}

pub fn against_trees(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let ways = [
        ("slicing", Drawn::Slicing(slicing, CrownSettings::default())),
        ("mesh", Drawn::Mesh),
    ];
    let mut series: Vec<_> = ways
        .iter()
        .flat_map(|(name, _)| ["worst", "mean"].map(|what| format!("{name}, {what}")))
        .map(|name| Series::line(name, Vec::<(f64, f64)>::new()))
        .collect();
    let usual: &[u32] = if lab.quick {
        &[1, 16, 128, 1000]
    } else {
        &[1, 2, 4, 8, 16, 32, 64, 128, 1000]
    };
    for trees in lab.trees(usual) {
        let shown = if trees <= MESHES { 2 } else { 1 };
        let groups: Vec<_> = ways[..shown]
            .iter()
            .map(|(_, drawn)| grove::plant(lab, drawn, trees, true))
            .collect();
        lab.studio.photograph(&grove::SHOT, SKY);
        for (i, mut times) in times(lab, trees, &groups).into_iter().enumerate() {
            let (worst, mean) = worst_and_mean(&mut times);
            println!(
                "{trees} trees, {}: worst {worst:.1} ms, mean {mean:.1} ms",
                ways[i].0
            );
            for (k, ms) in [worst, mean].into_iter().enumerate() {
                series[2 * i + k].points.push((f64::from(trees), ms).into());
            }
        }
        for tree in groups.iter().flatten() {
            lab.studio.world().despawn(*tree);
        }
        lab.studio.headless.step();
    }
    Ok(Chart {
        title: "A walk through a grove, 640 x 480".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("trees"),
        y: Axis::log("frame time above the empty scene's (ms)"),
        series,
    })
}

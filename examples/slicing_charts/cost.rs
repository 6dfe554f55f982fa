//! The paper's Figure 4: time of a frame against the number of trees, slicings against meshes.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Clock, Headless, Race, Variant};
use bevy_verdure::prelude::*;

use super::grove;
use super::lab::{Drawn, Lab};

/// Most trees that are drawn as meshes.
const MESHES: u32 = 128;

pub fn against_trees(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let (mut sliced, mut meshed) = (Vec::new(), Vec::new());
    let clock = Clock::of(lab.studio.world());
    let usual: &[u32] = if lab.quick {
        &[1, 16, 128]
    } else {
        &[1, 4, 16, 64, 128, 256, 1000]
    };
    for count in lab.trees(usual) {
        let ways = [
            Some(Drawn::Slicing(slicing.clone(), CrownSettings::default())),
            (count <= MESHES).then_some(Drawn::Mesh),
        ];
        let groups: Vec<_> = ways
            .into_iter()
            .flatten()
            .map(|way| grove::plant(lab, &way, count, true))
            .collect();
        let groups = &groups;
        let mut variants: Vec<Variant> = [None]
            .into_iter()
            .chain((0..groups.len()).map(Some))
            .map(|shown| {
                Variant::new(format!("{shown:?}"), move |headless: &mut Headless| {
                    grove::show(headless.world(), groups, shown)
                })
            })
            .collect();
        lab.studio
            .photograph(&grove::SHOT, Color::srgb(0.6, 0.8, 1.0));
        let race = Race {
            rounds: if lab.quick { 5 } else { 9 },
            warm_up: 1,
            settle: 2,
        };
        let timings = race.run(&mut lab.studio.headless, &mut variants);
        drop(variants);
        let above: Vec<f64> = timings[1..]
            .iter()
            .map(|timing| timing.less(&timings[0]).ms(clock))
            .collect();
        println!(
            "{count} trees: {above:.2?} ms above {:.2} ms",
            timings[0].ms(clock)
        );
        sliced.push((f64::from(count), above[0]));
        if let Some(ms) = above.get(1) {
            meshed.push((f64::from(count), *ms));
        }
        for tree in groups.iter().flatten() {
            lab.studio.world().despawn(*tree);
        }
        lab.studio.headless.step();
    }
    Ok(Chart {
        title: "Cost of a grove, 640 x 480, shadow maps on".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("trees"),
        y: Axis::log(format!("{} above the empty scene's (ms)", clock.label())),
        series: vec![
            Series::line("slicing", sliced),
            Series::line("mesh", meshed),
        ],
    })
}

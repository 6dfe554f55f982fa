//! Time of a frame against the number of trees: the paper's Figure 4, and the same for other ways to draw crowns.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Clock, Headless, Race, Variant};
use bevy_verdure::prelude::*;

use super::accuracy::SKY;
use super::grove;
use super::lab::{Drawn, Lab};

/// Most trees that are drawn as meshes.
const MESHES: u32 = 128;

/// A way to draw trees: its name, how, and whether crowns cast shadows.
pub type Way = (String, Drawn, bool);

pub fn against_trees(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let ways = [
        (
            "slicing".into(),
            Drawn::Slicing(slicing, CrownSettings::default()),
            true,
        ),
        ("mesh".into(), Drawn::Mesh, true),
    ];
    let usual: &[u32] = if lab.quick {
        &[1, 16, 128]
    } else {
        &[1, 4, 16, 64, 128, 256, 1000]
    };
    costs(
        lab,
        "Cost of a grove, 640 x 480, shadow maps on",
        usual,
        &ways,
    )
}

/// What each of some ways costs above the empty scene, all in one race for each number of trees.
pub fn costs(lab: &mut Lab, title: &str, usual: &[u32], ways: &[Way]) -> Result<Chart, String> {
    let clock = Clock::of(lab.studio.world());
    let mut series: Vec<_> = ways
        .iter()
        .map(|(name, ..)| Series::line(name.as_str(), Vec::<(f64, f64)>::new()))
        .collect();
    for trees in lab.trees(usual) {
        let is_drawn = |drawn: &Drawn| trees <= MESHES || !matches!(drawn, Drawn::Mesh);
        let drawn: Vec<usize> = (0..ways.len()).filter(|i| is_drawn(&ways[*i].1)).collect();
        let groups: Vec<_> = drawn
            .iter()
            .map(|i| grove::plant(lab, &ways[*i].1, trees, ways[*i].2))
            .collect();
        lab.studio.photograph(&grove::SHOT, SKY);
        let groups = &groups;
        let mut variants: Vec<Variant> = [None]
            .into_iter()
            .chain((0..drawn.len()).map(Some))
            .map(|shown| {
                let name = shown.map_or("empty", |i| ways[drawn[i]].0.as_str());
                Variant::new(name, move |headless: &mut Headless| {
                    grove::show(headless.world(), groups, shown);
                })
            })
            .collect();
        let race = Race {
            rounds: if lab.quick { 5 } else { 21 },
            warm_up: 1,
            settle: 2,
        };
        let timings = race.run(&mut lab.studio.headless, &mut variants);
        for (timing, i) in timings[1..].iter().zip(&drawn) {
            let above = timing.less(&timings[0]).ms(clock);
            println!("{trees} trees, {}: {above:.1} ms", timing.name);
            series[*i].points.push((f64::from(trees), above).into());
        }
        for tree in groups.iter().flatten() {
            lab.studio.world().despawn(*tree);
        }
        lab.studio.headless.step();
    }
    Ok(Chart {
        title: title.into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("trees"),
        y: Axis::log(format!("{} above the empty scene's (ms)", clock.label())),
        series,
    })
}

//! Where the time goes: a grove with one thing after the other left out.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Clock, Headless, Race, Variant};
use bevy_verdure::prelude::*;

use super::grove;
use super::lab::{Drawn, Lab};

pub fn against_trees(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let lit = |lighting| {
        let settings = CrownSettings {
            lighting,
            ..default()
        };
        Drawn::Slicing(slicing.clone(), settings)
    };
    let ways = [
        ("mesh", Drawn::Mesh, true),
        ("mesh, no shadows cast", Drawn::Mesh, false),
        ("full light", lit(CrownLighting::Full), true),
        ("simple light", lit(CrownLighting::Simple), true),
        ("unlit", lit(CrownLighting::Unlit), true),
        (
            "simple light, no shadows cast",
            lit(CrownLighting::Simple),
            false,
        ),
        ("unlit, no shadows cast", lit(CrownLighting::Unlit), false),
    ];
    let clock = Clock::of(lab.studio.world());
    let mut series: Vec<_> = ways
        .iter()
        .map(|(name, ..)| Series::line(*name, Vec::<(f64, f64)>::new()))
        .collect();
    for trees in lab.trees(&[1, 16, 128]) {
        let groups: Vec<_> = ways
            .iter()
            .map(|(_, drawn, casts)| grove::plant(lab, drawn, trees, *casts))
            .collect();
        lab.studio
            .photograph(&grove::SHOT, Color::srgb(0.6, 0.8, 1.0));
        let groups = &groups;
        let mut variants: Vec<Variant> = [None]
            .into_iter()
            .chain((0..ways.len()).map(Some))
            .map(|shown| {
                let name = shown.map_or("empty", |i| ways[i].0);
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
        for (timing, series) in timings[1..].iter().zip(&mut series) {
            let above = timing.less(&timings[0]).ms(clock);
            println!("{trees} trees, {}: {above:.1} ms", timing.name);
            series.points.push((f64::from(trees), above).into());
        }
        for tree in groups.iter().flatten() {
            lab.studio.world().despawn(*tree);
        }
        lab.studio.headless.step();
    }
    Ok(Chart {
        title: "Where the time of a grove goes, 640 x 480".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log("trees"),
        y: Axis::log(format!("{} above the empty scene's (ms)", clock.label())),
        series,
    })
}

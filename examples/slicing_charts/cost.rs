//! The paper's Figure 4: time of a frame against the number of trees, slicings against meshes.

use bevy::prelude::*;
use bevy_verdure::lab::charts::{Axis, Chart, Series};
use bevy_verdure::lab::{Clock, Headless, Lens, Race, Shot, Variant};
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;

use super::lab::{Drawn, Lab};

/// Metres between trees.
const SPACING: f32 = 9.0;
/// Most trees that are drawn as meshes.
const MESHES: u32 = 128;

pub fn against_trees(lab: &mut Lab) -> Result<Chart, String> {
    let slicing = lab.bake(&BakeSettings::default())?;
    let shot = Shot {
        eye: Vec3::new(-18.0, 1.7, 12.0),
        at: Vec3::new(0.0, 4.0, 0.0),
        lens: Lens::Perspective(0.9),
        size: UVec2::new(640, 480),
    };
    let (mut sliced, mut meshed) = (Vec::new(), Vec::new());
    let clock = Clock::of(lab.studio.world());
    let counts: &[u32] = if lab.quick {
        &[1, 16, 128]
    } else {
        &[1, 4, 16, 64, 128, 256, 1000]
    };
    for &count in counts {
        let mut groups = Vec::new();
        let ways = [
            Some(Drawn::Slicing(slicing.clone(), CrownSettings::default())),
            (count <= MESHES).then_some(Drawn::Mesh),
        ];
        for way in ways.into_iter().flatten() {
            let mut dice = Dice::new(7);
            let group: Vec<Entity> = (0..count)
                .map(|i| {
                    let reach = SPACING * (i as f32 / core::f32::consts::PI).sqrt();
                    let (sin, cos) = (2.399_963 * i as f32).sin_cos();
                    let place = Transform::from_xyz(reach * cos, 0.0, reach * sin)
                        .with_rotation(Quat::from_rotation_y(dice.angle()))
                        .with_scale(Vec3::splat(dice.between(0.75, 1.2)));
                    lab.plant(&way, place)
                })
                .collect();
            groups.push(group);
        }
        let show = |headless: &mut Headless, shown: Option<usize>| {
            for (i, group) in groups.iter().enumerate() {
                let visibility = if shown == Some(i) {
                    Visibility::Inherited
                } else {
                    Visibility::Hidden
                };
                for tree in group {
                    headless.world().entity_mut(*tree).insert(visibility);
                }
            }
        };
        let show = &show;
        let mut variants: Vec<Variant> = [None]
            .into_iter()
            .chain((0..groups.len()).map(Some))
            .map(|shown| {
                Variant::new(format!("{shown:?}"), move |headless: &mut Headless| {
                    show(headless, shown)
                })
            })
            .collect();
        lab.studio.photograph(&shot, Color::srgb(0.6, 0.8, 1.0));
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
        for tree in groups.into_iter().flatten() {
            lab.studio.world().despawn(tree);
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

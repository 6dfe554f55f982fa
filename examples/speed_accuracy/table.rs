//! The paper's Table 1 again.

use std::path::Path;

use bevy_verdure::lab::Timing;
use bevy_verdure::lab::rivals::{Exhibit, Flips, Judge, Match, Rival, Weight};

use super::lab::Lab;
use super::plan::Plan;
use super::scenes::Scene;

/// One scene.
pub struct Row {
    pub scene: Scene,
    pub segments: usize,
    /// Without relief, and with it.
    pub pairs: [Pair; 2],
}

/// Frusta, and polygons that are as good.
pub struct Pair {
    pub frusta: Entry,
    pub polygons: Entry,
    /// How the polygons were found.
    pub found: Match,
}

/// What is said of one rival.
#[derive(Clone)]
pub struct Entry {
    pub flip: f32,
    pub weight: Weight,
    pub timing: Timing,
}

/// Measures a scene, and tells of it. Pictures of what is compared are written to a folder, if one is given.
pub fn measure(
    lab: &mut Lab,
    plan: &Plan,
    scene: Scene,
    pictures: Option<&Path>,
) -> Result<Row, String> {
    let row = measure_scene(lab, plan, scene, pictures)?;
    for pair in &row.pairs {
        println!(
            "{}: frusta {:.2} ms, FLIP {:.4}; polygons at m = {}{} {:.2} ms, FLIP{}",
            scene.name(),
            pair.frusta.timing.ms(lab.clock),
            pair.frusta.flip,
            pair.found.subdivisions,
            if pair.found.reached {
                ""
            } else {
                " (not as good)"
            },
            pair.polygons.timing.ms(lab.clock),
            tried(pair),
        );
    }
    Ok(row)
}

/// The errors of each subdivision, against frusta and against the finest polygons.
fn tried(pair: &Pair) -> String {
    let own = |own: Option<f32>| own.map_or(String::new(), |own| format!("/{own:.4}"));
    let one = |flips: &Flips| format!(" {:.4}{}", flips.to_frusta, own(flips.to_own_limit));
    pair.found.tried.iter().map(one).collect()
}

fn measure_scene(
    lab: &mut Lab,
    plan: &Plan,
    scene: Scene,
    pictures: Option<&Path>,
) -> Result<Row, String> {
    let planting = scene.grow();
    let segments = planting.segment_count();
    let shot = scene.shot(&planting, plan.size);
    let mut exhibit = Exhibit::open(&mut lab.studio.headless, planting, scene.shadows(&shot));
    let mut found = Vec::new();
    for relief in [false, true] {
        let (frusta, finest) = (Rival::frusta(relief), Rival::reference(relief));
        lab.put_up(&mut exhibit, &[frusta, finest])?;
        let judge = Judge::new(&mut lab.studio, &exhibit, finest, shot);
        let flip = judge.flip(&mut lab.studio, &exhibit, frusta);
        let polygons = judge
            .match_polygons(
                &mut lab.studio,
                &mut exhibit,
                &mut lab.wardrobe,
                relief,
                flip,
                (plan.subdivisions, plan.limit),
            )
            .ok_or_else(|| format!("{}: polygons take too much memory", scene.name()))?;
        if finest != frusta {
            exhibit.take_down(&mut lab.studio.headless, finest);
        }
        for (name, rival) in [("frusta", frusta), ("polygons", polygons.rival)] {
            let Some(dir) = pictures else { break };
            let relief = if relief { "_relief" } else { "" };
            let file = dir.join(format!("{}_{name}{relief}.png", scene.name()));
            let picture = judge.picture(&mut lab.studio, &exhibit, rival);
            picture.save_png(&file)?;
        }
        found.push((frusta, flip, polygons));
    }
    let rivals: Vec<_> = found
        .iter()
        .flat_map(|(frusta, _, polygons)| [*frusta, polygons.rival])
        .collect();
    let timings = lab.race(&exhibit, &shot, plan.race, &rivals);
    let weight = |rival| exhibit.weight(rival).unwrap_or_default();
    let pair = |i: usize| {
        let (frusta, flip, found) = &found[i];
        Pair {
            frusta: Entry {
                flip: *flip,
                weight: weight(*frusta),
                timing: timings[2 * i].clone(),
            },
            polygons: Entry {
                flip: found.flip,
                weight: found.weight,
                timing: timings[2 * i + 1].clone(),
            },
            found: found.clone(),
        }
    };
    let pairs = [pair(0), pair(1)];
    exhibit.close(&mut lab.studio.headless);
    Ok(Row {
        scene,
        segments,
        pairs,
    })
}

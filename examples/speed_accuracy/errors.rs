//! Mean FLIP of the default settings, scene by scene.

use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::rivals::{Exhibit, Judge, Rival};

use super::lab::Lab;
use super::plan::Plan;
use super::scenes::Scene;

/// The most that the default settings may err.
const LIMIT: f64 = 0.04;

/// A point for each of the plan's scenes, without relief and with it.
pub fn of_defaults(lab: &mut Lab, plan: &Plan) -> Result<Chart, String> {
    let mut series =
        ["without relief", "with relief"].map(|name| Series::scatter(name, [] as [Point; 0]));
    for &scene in &plan.scenes {
        let planting = scene.grow();
        let shot = scene.shot(&planting, plan.size);
        let mut exhibit = Exhibit::open(&mut lab.studio.headless, planting, scene.shadows(&shot));
        for (relief, series) in [false, true].into_iter().zip(&mut series) {
            let (frusta, finest) = (Rival::frusta(relief), Rival::reference(relief));
            lab.put_up(&mut exhibit, &[frusta, finest])?;
            let judge = Judge::new(&mut lab.studio, &exhibit, finest, shot);
            let flip = f64::from(judge.flip(&mut lab.studio, &exhibit, frusta));
            println!("{}: {}, FLIP {flip:.4}", scene.name(), series.name);
            let place = Scene::ALL.iter().position(|other| *other == scene);
            let point = Point::from((place.map_or(0, |i| i + 1) as f64, flip));
            let name = scene.name().replace('_', " ");
            series.points.push(point.labelled(name));
        }
        exhibit.close(&mut lab.studio.headless);
    }
    let ends = [1.0, Scene::ALL.len() as f64].map(|x| (x, LIMIT));
    let mut all = vec![Series::line("limit", ends)];
    all.extend(series);
    Ok(Chart {
        title: format!(
            "Mean FLIP of the default settings, {} x {}",
            plan.size.x, plan.size.y
        ),
        subtitle: lab.adapter.clone(),
        x: Axis::linear("scene, in the order of Table 1"),
        y: Axis::linear("mean FLIP"),
        series: all,
    })
}

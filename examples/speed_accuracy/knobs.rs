//! Error against time for every setting of one scene.

use std::path::Path;

use bevy::prelude::*;
use bevy_verdure::frusta::{ReliefMarch, ReliefSteps, ReliefV};
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::rivals::{Exhibit, Judge, March, Rival};
use bevy_verdure::lab::{GeometryError, Timing};

use super::lab::Lab;
use super::plan::Plan;

/// Finer polygons are smaller than pixels.
const SUBDIVISIONS: u32 = 5;

/// A setting that is turned through its values.
struct Knob {
    name: &'static str,
    values: Vec<(String, Rival)>,
}

/// What is said of one value.
struct Figure {
    rival: Rival,
    flip: f64,
    geometry: Option<GeometryError>,
    timing: Timing,
}

/// The charts of one scene.
pub struct Knobs {
    scene: String,
    charts: [Chart; 3],
}

impl Knobs {
    /// Writes them.
    pub fn save(&self, dir: &Path) -> Result<(), String> {
        let names = ["error", "depth", "segments_wrong"];
        for (chart, name) in self.charts.iter().zip(names) {
            chart.save(dir, &format!("{name}_{}", self.scene))?;
        }
        Ok(())
    }
}

fn knobs(plan: &Plan) -> Vec<Knob> {
    let default = March::default();
    let march = |march| Rival::Frusta(Some(march));
    let steps = |steps| march(March { steps, ..default });
    let knob = |name, values| Knob { name, values };
    vec![
        knob(
            "relief steps",
            (plan.steps.iter())
                .map(|&n| (n.to_string(), steps(ReliefSteps::Fixed(n))))
                .collect(),
        ),
        knob(
            "relief steps, leaping",
            (plan.steps.iter())
                .map(|&n| {
                    let value = march(March {
                        steps: ReliefSteps::Fixed(n),
                        march: ReliefMarch::Leaping,
                        ..default
                    });
                    (n.to_string(), value)
                })
                .collect(),
        ),
        // Apart from the others, for it has no place in their order.
        knob(
            "automatic steps",
            vec![("auto".into(), steps(ReliefSteps::Auto))],
        ),
        knob(
            "bisections",
            (plan.bisections.iter())
                .map(|&bisections| {
                    let value = march(March {
                        bisections,
                        ..default
                    });
                    (format!("{bisections} halvings"), value)
                })
                .collect(),
        ),
        knob(
            "v",
            [
                ("exact", ReliefV::Exact),
                ("interpolated", ReliefV::Interpolated),
            ]
            .map(|(name, v)| (name.into(), march(March { v, ..default })))
            .into(),
        ),
        knob(
            "polygons",
            (0..=plan.subdivisions.min(SUBDIVISIONS))
                .map(|subdivisions| {
                    let relief = true;
                    let value = Rival::Polygons {
                        subdivisions,
                        relief,
                    };
                    (format!("m = {subdivisions}"), value)
                })
                .collect(),
        ),
    ]
}

/// Measures all settings on the plan's first scene.
pub fn measure(lab: &mut Lab, plan: &Plan) -> Result<Knobs, String> {
    let scene = *plan.scenes.first().ok_or("no scene is named")?;
    let planting = scene.grow();
    let shot = scene.shot(&planting, plan.size);
    let mut exhibit = Exhibit::open(&mut lab.studio.headless, planting, scene.shadows(&shot));
    let finest = Rival::reference(true);
    lab.put_up(&mut exhibit, &[finest])?;
    let judge = Judge::new(&mut lab.studio, &exhibit, finest, shot);
    let exact = judge.figures(&mut lab.studio, &exhibit, finest);

    let mut knobs = knobs(plan);
    let mut figures: Vec<Figure> = Vec::new();
    for knob in &mut knobs {
        knob.values.retain(|(_, rival)| {
            let put_up = exhibit.put_up(
                &mut lab.studio.headless,
                &mut lab.wardrobe,
                *rival,
                plan.limit,
            );
            if put_up.is_ok() && !figures.iter().any(|known| known.rival == *rival) {
                let is_frusta = matches!(rival, Rival::Frusta(_));
                let geometry = is_frusta.then(|| {
                    let own = judge.figures(&mut lab.studio, &exhibit, *rival);
                    GeometryError::between(&exact, &own)
                });
                figures.push(Figure {
                    rival: *rival,
                    flip: judge.flip(&mut lab.studio, &exhibit, *rival).into(),
                    geometry,
                    timing: Timing::default(),
                });
            }
            put_up.is_ok()
        });
    }
    let rivals: Vec<_> = figures.iter().map(|figure| figure.rival).collect();
    let timings = lab.race(&exhibit, &shot, plan.race, &rivals);
    for (figure, timing) in figures.iter_mut().zip(timings) {
        figure.timing = timing;
    }
    exhibit.close(&mut lab.studio.headless);

    let chart = |title: &str, y: Axis, value: &dyn Fn(&Figure) -> Option<f64>| Chart {
        title: format!(
            "{title}: {}, {} x {}",
            scene.name(),
            plan.size.x,
            plan.size.y
        ),
        subtitle: lab.adapter.clone(),
        x: Axis::log(lab.time_label()),
        y,
        series: series(&knobs, &figures, &|figure| {
            Some((figure.timing.ms(lab.clock), value(figure)?))
        }),
    };
    let depth = Axis::log("depth error that 99 % of pixels stay below, relative").with_floor(1e-8);
    let wrong = Axis::log("share of pixels with a wrong segment").with_floor(1e-6);
    Ok(Knobs {
        scene: scene.name(),
        charts: [
            chart("Error against time", Axis::log("mean FLIP"), &|figure| {
                Some(figure.flip)
            }),
            chart("Depth error against time", depth, &|figure| {
                figure.geometry.map(|error| error.worst_depth)
            }),
            chart("Wrong segments against time", wrong, &|figure| {
                figure.geometry.map(|error| error.wrong_segments)
            }),
        ],
    })
}

/// One series a knob, of those of its values that have such a figure.
fn series(
    knobs: &[Knob],
    figures: &[Figure],
    place: &dyn Fn(&Figure) -> Option<(f64, f64)>,
) -> Vec<Series> {
    let series = knobs.iter().map(|knob| {
        let points = knob.values.iter().filter_map(|(label, rival)| {
            let figure = figures.iter().find(|figure| figure.rival == *rival)?;
            let is_default = *rival == Rival::frusta(true);
            Some(
                Point::from(place(figure)?)
                    .labelled(label.clone())
                    .marked(is_default),
            )
        });
        Series::line(knob.name, points.collect::<Vec<_>>())
    });
    series.filter(|series| !series.points.is_empty()).collect()
}

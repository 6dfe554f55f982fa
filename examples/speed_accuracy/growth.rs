//! Cost against the number of segments, and against that of pixels.

use bevy::prelude::*;
use bevy_verdure::lab::Shot;
use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::rivals::{Exhibit, Rival, fitting};
use bevy_verdure::plants::{Planting, Saguaro};

use super::lab::Lab;
use super::plan::Plan;

/// Metres between two plants of a field.
const SPACING: f32 = 3.0;

/// Frusta, and polygons as the table of the nine scenes needs them.
fn rivals() -> [(&'static str, Rival); 4] {
    let polygons = |subdivisions, relief| Rival::Polygons {
        subdivisions,
        relief,
    };
    [
        ("frusta", Rival::frusta(false)),
        ("polygons, m = 1", polygons(1, false)),
        ("frusta with relief", Rival::frusta(true)),
        ("polygons with relief, m = 3", polygons(3, true)),
    ]
}

/// Costs of the rivals, one line each; those left out are too slow.
struct Lines {
    rivals: [(&'static str, Rival); 4],
    points: Vec<Vec<Point>>,
    running: Vec<usize>,
}

impl Lines {
    fn new() -> Self {
        let rivals = rivals();
        Self {
            rivals,
            points: vec![Vec::new(); rivals.len()],
            running: (0..rivals.len()).collect(),
        }
    }

    /// Times those still running at one place of the horizontal axis.
    fn measure(
        &mut self,
        lab: &mut Lab,
        plan: &Plan,
        exhibit: &mut Exhibit,
        shot: &Shot,
        x: f64,
    ) -> Result<(), String> {
        let rivals: Vec<_> = self.running.iter().map(|&i| self.rivals[i].1).collect();
        lab.put_up(exhibit, &rivals)?;
        let timings = lab.race(exhibit, shot, plan.race, &rivals);
        for (&i, timing) in self.running.iter().zip(&timings) {
            self.points[i].push((x, timing.ms(lab.clock)).into());
            println!("{x} {}: {:.2} ms", self.rivals[i].0, timing.ms(lab.clock));
        }
        let fast = timings.iter().map(|timing| timing.frame_ms < plan.patience);
        let mut fast: Vec<bool> = fast.collect();
        fast.reverse();
        self.running.retain(|_| fast.pop().unwrap_or(false));
        Ok(())
    }

    fn chart(self, lab: &Lab, title: String, x: Axis) -> Chart {
        let names = self.rivals.iter().map(|(name, _)| *name);
        let series = names.zip(self.points);
        Chart {
            title,
            subtitle: lab.adapter.clone(),
            x,
            y: Axis::log(lab.time_label()),
            series: series
                .map(|(name, points)| Series::line(name, points))
                .collect(),
        }
    }
}

/// A field of ever more saguaros of ever smaller size, in a picture that stays as large.
pub fn against_segments(lab: &mut Lab, plan: &Plan) -> Result<Chart, String> {
    let saguaro = Saguaro::default().grow(1);
    let mut lines = Lines::new();
    for &segments in plan.segments {
        if lines.running.is_empty() {
            break;
        }
        let copies = segments.div_ceil(saguaro.segment_count());
        let side = (copies as f32).sqrt().ceil() as usize;
        let mut field = Planting::default();
        let plant = field.add(saguaro.clone());
        for i in 0..copies {
            let place = Vec3::new((i % side) as f32, 0.0, (i / side) as f32) * SPACING;
            field.place(plant, place, i as f32, 1.0);
        }
        let drawn = field.segment_count();
        let shot = fitting(&field, Vec3::new(0.3, 0.6, 1.0), plan.size);
        let mut exhibit = Exhibit::open(&mut lab.studio.headless, field, None);
        lines.measure(lab, plan, &mut exhibit, &shot, drawn as f64)?;
        exhibit.close(&mut lab.studio.headless);
    }
    let title = format!(
        "Cost against segments: saguaros of 30 segments, {} x {}",
        plan.size.x, plan.size.y
    );
    Ok(lines.chart(lab, title, Axis::log("segments")))
}

/// The plan's first scene in pictures of several sizes.
pub fn against_pixels(lab: &mut Lab, plan: &Plan) -> Result<Chart, String> {
    let scene = *plan.scenes.first().ok_or("no scene is named")?;
    let planting = scene.grow();
    let sized = |(x, y): (u32, u32)| scene.shot(&planting, UVec2::new(x, y));
    let shots: Vec<_> = plan.sizes.iter().copied().map(sized).collect();
    let shadows = shots.first().and_then(|shot| scene.shadows(shot));
    let mut exhibit = Exhibit::open(&mut lab.studio.headless, planting.clone(), shadows);
    let mut lines = Lines::new();
    for shot in shots {
        let pixels = f64::from(shot.size.x) * f64::from(shot.size.y);
        lines.measure(lab, plan, &mut exhibit, &shot, pixels)?;
    }
    exhibit.close(&mut lab.studio.headless);
    let title = format!("Cost against pixels: {}", scene.name());
    Ok(lines.chart(lab, title, Axis::log("pixels")))
}

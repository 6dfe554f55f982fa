//! The table as Markdown, CSV and a chart.

use std::fmt::Write;
use std::path::Path;

use bevy_verdure::lab::charts::{Axis, Chart, Point, Series};
use bevy_verdure::lab::rivals::AS_GOOD;

use super::lab::Lab;
use super::plan::Plan;
use super::table::{Entry, Pair, Row};

/// Writes `table1.md`, `table1.csv`, and the chart `table1` of the times.
pub fn save(lab: &Lab, plan: &Plan, rows: &[Row], dir: &Path) -> Result<(), String> {
    // The chart writes a CSV of its own points under this name, so that the full table comes after it.
    chart(lab, rows).save(dir, "table1")?;
    let write = |name: &str, text: String| {
        let path = dir.join(name);
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    };
    write("table1.csv", csv(lab, rows))?;
    write("table1.md", markdown(lab, plan, rows))
}

fn markdown(lab: &Lab, plan: &Plan, rows: &[Row]) -> String {
    let mut text = format!(
        "# Table 1 of the frusta paper, again\n\n\
         {}, {} x {}; {} in milliseconds above the empty scene's, medians of {} frames.\n\n\
         RC: frusta, ray cast; GS: polygons by geometric subdivision, m times; +R: with relief. Polygons are subdivided \
         until their mean FLIP, against the finest frusta or the finest polygons, whichever is nearer, is at most that of \
         frusta and {AS_GOOD}; where that is not reached, the best that were tried are listed, marked by >. KiB are those \
         of what describes the shape.\n\n",
        lab.adapter,
        plan.size.x,
        plan.size.y,
        lab.clock.label(),
        plan.race.rounds,
    );
    text += "| scene | segments | RC | GS / m | GS : RC | RC+R | GS+R / m | GS+R : RC+R | KiB RC | GS | RC+R | GS+R | \
             FLIP RC | GS | RC+R | GS+R |\n";
    text += "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n";
    for row in rows {
        let mut cells = vec![row.scene.name().replace('_', " "), row.segments.to_string()];
        for pair in &row.pairs {
            let (frusta, polygons) = (
                pair.frusta.timing.ms(lab.clock),
                pair.polygons.timing.ms(lab.clock),
            );
            let open = if pair.found.reached { "" } else { ">" };
            cells.push(format!("{frusta:.2}"));
            cells.push(format!("{polygons:.2} / {open}{}", pair.found.subdivisions));
            cells.push(format!("{:.2}", polygons / frusta.max(1e-6)));
        }
        let entries = || {
            let pairs = row.pairs.iter();
            pairs.flat_map(|pair| [&pair.frusta, &pair.polygons])
        };
        cells.extend(entries().map(|e| format!("{:.1}", e.weight.shape() as f64 / 1024.0)));
        cells.extend(entries().map(|e| format!("{:.4}", e.flip)));
        text += &format!("| {} |\n", cells.join(" | "));
    }
    text
}

fn csv(lab: &Lab, rows: &[Row]) -> String {
    let mut text = String::from(
        "scene,segments,relief,rival,subdivisions,as_good,mean_flip,frame_ms,gpu_ms,frames,geometry_bytes,\
         relief_map_bytes,bounds_bytes,triangles,adapter\n",
    );
    let adapter = lab.adapter.replace('"', "'");
    for row in rows {
        for (relief, pair) in [false, true].into_iter().zip(&row.pairs) {
            let Pair {
                frusta,
                polygons,
                found,
            } = pair;
            let mut line = |rival: &str, m: String, entry: &Entry| {
                let gpu = entry.timing.gpu_ms;
                let weight = entry.weight;
                let _ = writeln!(
                    text,
                    "{},{},{relief},{rival},{m},{},{:.5},{:.4},{},{},{},{},{},{},\"{adapter}\"",
                    row.scene.name(),
                    row.segments,
                    found.reached,
                    entry.flip,
                    entry.timing.frame_ms,
                    gpu.map_or(String::new(), |ms| format!("{ms:.4}")),
                    entry.timing.frames,
                    weight.geometry,
                    weight.relief_maps,
                    weight.bounds,
                    weight.triangles,
                );
            };
            line("frusta", String::new(), frusta);
            line("polygons", found.subdivisions.to_string(), polygons);
        }
    }
    text
}

/// Times of polygons over those of frusta: above the diagonal frusta win.
fn chart(lab: &Lab, rows: &[Row]) -> Chart {
    let series = |name: &str, relief: usize| {
        let points = rows.iter().map(|row| {
            let pair = &row.pairs[relief];
            let times = (
                pair.frusta.timing.ms(lab.clock),
                pair.polygons.timing.ms(lab.clock),
            );
            Point::from(times).labelled(row.scene.name().replace('_', " "))
        });
        Series::scatter(name, points.collect::<Vec<_>>())
    };
    let own = [series("without relief", 0), series("with relief", 1)];
    let times = || own.iter().flat_map(|series| &series.points);
    let ends = |of: fn(f64, f64) -> f64, start: f64| {
        let positive = times().flat_map(|p| [p.x, p.y]).filter(|&ms| ms > 0.0);
        positive.fold(start, of)
    };
    let (low, high) = (ends(f64::min, f64::INFINITY), ends(f64::max, 0.0));
    let mut all = vec![Series {
        points: vec![(low, low).into(), (high, high).into()],
        ..Series::line("equal cost", [(0.0, 0.0)])
    }];
    all.extend(own);
    let label = lab.time_label();
    Chart {
        title: "Table 1 again: polygons that are as good as frusta, above the line where they cost more".into(),
        subtitle: lab.adapter.clone(),
        x: Axis::log(format!("frusta: {label}")),
        y: Axis::log(format!("polygons: {label}")),
        series: all,
    }
}

//! Rows of a table that was measured before, so that scenes may be measured one by one.

use std::path::Path;

use bevy_verdure::lab::Timing;
use bevy_verdure::lab::rivals::{Match, Rival, Weight};
use clap::ValueEnum;

use super::scenes::Scene;
use super::table::{Entry, Pair, Row};

/// The rows of `table1.csv` in a folder that were measured on this adapter; none if there is no such file.
///
/// # Errors
/// When a line is not as it was written.
pub fn read(dir: &Path, adapter: &str) -> Result<Vec<Row>, String> {
    let path = dir.join("table1.csv");
    let Ok(text) = std::fs::read_to_string(&path) else {
        return Ok(Vec::new());
    };
    let lines: Vec<(usize, &str)> = (1..).zip(text.lines()).skip(1).collect();
    let own = |line: &&(usize, &str)| line.1.contains(adapter);
    let own: Vec<_> = lines.iter().filter(own).copied().collect();
    // Frusta and polygons, without relief and with it.
    let rows = own.chunks(4).map(|lines| {
        row(lines).ok_or_else(|| {
            let number = lines.first().map_or(0, |line| line.0);
            format!(
                "{}: line {number} is no row of the table: delete the file, or correct the line",
                path.display()
            )
        })
    });
    rows.collect()
}

fn row(lines: &[(usize, &str)]) -> Option<Row> {
    let [a, b, c, d] = lines else { return None };
    let cells = |line: &(usize, &'_ str)| line.1.split(',').map(String::from).collect::<Vec<_>>();
    let [a, b, c, d] = [a, b, c, d].map(cells);
    Some(Row {
        scene: Scene::from_str(a.first()?, false).ok()?,
        segments: a.get(1)?.parse().ok()?,
        pairs: [pair(&a, &b, false)?, pair(&c, &d, true)?],
    })
}

fn pair(frusta: &[String], polygons: &[String], relief: bool) -> Option<Pair> {
    let subdivisions = polygons.get(4)?.parse().ok()?;
    let own = entry(polygons)?;
    Some(Pair {
        frusta: entry(frusta)?,
        found: Match {
            rival: Rival::Polygons {
                subdivisions,
                relief,
            },
            subdivisions,
            flip: own.flip,
            weight: own.weight,
            reached: polygons.get(5)?.parse().ok()?,
            tried: Vec::new(),
        },
        polygons: own,
    })
}

fn entry(cells: &[String]) -> Option<Entry> {
    let count = |i: usize| cells.get(i)?.parse::<usize>().ok();
    Some(Entry {
        flip: cells.get(6)?.parse().ok()?,
        timing: Timing {
            name: cells.get(3)?.clone(),
            frame_ms: cells.get(7)?.parse().ok()?,
            gpu_ms: cells.get(8)?.parse().ok(),
            frames: count(9)?,
        },
        weight: Weight {
            geometry: count(10)?,
            relief_maps: count(11)?,
            bounds: count(12)?,
            triangles: count(13)?,
        },
    })
}

//! Speed against accuracy: the frusta paper's Table 1 again, error against time for every setting, and cost against
//! segments and pixels. Frusta run against polygons of the same surface, in one app, frame by frame in turns.
//!
//! ```text
//! cargo run --example speed_accuracy -- --quick --out out
//! cargo run --example speed_accuracy -- --size 1024x768 --scene saguaro --scene elm
//! cargo run --example speed_accuracy -- --figures
//! ```
//!
//! Needs no file but its own: the binary can be copied to another machine.

#[path = "../dancing_cacti/cactus.rs"]
mod cactus;
#[path = "../common/mod.rs"]
mod common;
#[path = "../dancing_cacti/crowd.rs"]
mod crowd;
#[path = "../dancing_cacti/dance.rs"]
mod dance;
mod errors;
mod figures;
mod growth;
mod knobs;
mod lab;
mod moment;
mod plan;
mod scenes;
mod table;
mod table_file;
mod table_text;

use std::path::{Path, PathBuf};

use bevy_verdure::lab::{Size, parse_size};
use clap::{Parser, ValueEnum};

use lab::Lab;
use plan::Plan;
use scenes::Scene;

/// Charts speed against accuracy.
#[derive(Parser)]
struct Args {
    /// Small pictures, few frames, three scenes.
    #[arg(long)]
    quick: bool,
    /// Folder for charts and tables.
    #[arg(long, default_value = "docs/charts")]
    out: PathBuf,
    /// Size of the pictures, in pixels.
    #[arg(long, value_parser = parse_size)]
    size: Option<Size>,
    /// Scenes of the table; the first is that of the settings and of the sizes. Those that are not named keep the rows that
    /// a table in the folder has for this device.
    #[arg(long = "scene", value_enum)]
    scenes: Vec<Scene>,
    /// Parts of the measurement, all if none is named.
    #[arg(long = "part", value_enum)]
    parts: Vec<Part>,
    /// Writes the pictures that the table's errors are of, too.
    #[arg(long)]
    pictures: bool,
    /// Draws the paper's Figures 4 to 6 into this folder instead.
    #[arg(long, num_args = 0..=1, default_missing_value = "docs/figures", value_name = "DIR")]
    figures: Option<PathBuf>,
}

/// A part of the measurement.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// Table 1.
    Table,
    /// Error of the default settings, scene by scene.
    Errors,
    /// Error against time.
    Knobs,
    /// Cost against segments.
    Segments,
    /// Cost against pixels.
    Pixels,
}

fn main() -> std::process::ExitCode {
    common::exit(run(&Args::parse()))
}

fn run(args: &Args) -> Result<(), String> {
    if let Some(dir) = &args.figures {
        make(dir)?;
        return figures::draw(dir);
    }
    let plan = Plan::new(args.quick, args.size, &args.scenes);
    let wants = |part| args.parts.is_empty() || args.parts.contains(&part);
    make(&args.out)?;
    let mut lab = Lab::open();
    println!("{}", lab.adapter);
    if wants(Part::Errors) {
        let chart = errors::of_defaults(&mut lab, &plan)?;
        chart.save(&args.out, "errors")?;
    }
    if wants(Part::Knobs) {
        knobs::measure(&mut lab, &plan)?.save(&args.out)?;
    }
    if wants(Part::Segments) {
        let chart = growth::against_segments(&mut lab, &plan)?;
        chart.save(&args.out, "segments")?;
    }
    if wants(Part::Pixels) {
        let chart = growth::against_pixels(&mut lab, &plan)?;
        chart.save(&args.out, "pixels")?;
    }
    if wants(Part::Table) {
        let mut rows = Vec::new();
        if !args.scenes.is_empty() {
            rows = table_file::read(&args.out, &lab.adapter)?;
            rows.retain(|row| !plan.scenes.contains(&row.scene));
        }
        for scene in &plan.scenes {
            let pictures = args.pictures.then_some(&*args.out);
            rows.push(table::measure(&mut lab, &plan, *scene, pictures)?);
            // After each scene, for the larger ones take their time.
            rows.sort_by_key(|row| Scene::ALL.iter().position(|scene| *scene == row.scene));
            table_text::save(&lab, &plan, &rows, &args.out)?;
        }
    }
    println!("{}", args.out.display());
    Ok(())
}

fn make(dir: &Path) -> Result<(), String> {
    std::fs::create_dir_all(dir).map_err(|error| format!("{}: {error}", dir.display()))
}

//! Texels measured: what they cost, how wrong they are, and where they fail. See `docs/texels.md`.
//!
//! ```text
//! cargo run --example texels_charts -- --out docs/charts
//! cargo run --example texels_charts -- --only texels_selection --quick --out out
//! ```

mod bend;
mod depth;
mod error;
mod field;
mod gains;
mod lab;
mod low_poly;
mod march;
mod parts;
mod pop;
mod selection;
mod shadows;
mod shells;
mod whole;

use std::path::PathBuf;

use bevy_verdure::lab::charts::Chart;
use bevy_verdure::lab::texel_scenes::TexelScene;
use bevy_verdure::lab::{ChartArgs, Size, parse_size};
use clap::Parser;

use lab::Lab;

/// Measures texels, and draws the charts.
#[derive(Parser)]
struct Args {
    #[command(flatten)]
    charts: ChartArgs,
    /// Fewer settings, views and frames.
    #[arg(long)]
    quick: bool,
    /// Size of the pictures.
    #[arg(long, default_value = "512x384", value_parser = parse_size)]
    size: Size,
    /// Of the charts of several scenes, this one alone.
    #[arg(long, value_enum)]
    scene: Option<TexelScene>,
    /// Folder for the pictures that are measured, to look at.
    #[arg(long)]
    pictures: Option<PathBuf>,
}

/// A chart of its name.
type Experiment = (&'static str, fn(&Lab) -> Result<Chart, String>);

const EXPERIMENTS: [Experiment; 11] = [
    ("texels_selection", selection::against_settings),
    ("texels_distance", selection::against_distance),
    ("texels_depth", depth::against_depth),
    ("texels_gains", gains::time),
    ("texels_memory", gains::memory),
    ("texels_parts", parts::time),
    ("texels_shadows", shadows::against_pixels),
    ("texels_error_pears", error::of_pears),
    ("texels_error_noise", error::of_noise),
    ("texels_bend", bend::against_angle),
    ("texels_pop", pop::along_a_flight),
];

fn main() -> Result<(), String> {
    let args = Args::parse();
    let lab = Lab {
        quick: args.quick,
        size: args.size,
        scene: args.scene,
        pictures: args.pictures,
    };
    for (name, chart) in EXPERIMENTS {
        args.charts.draw(name, || chart(&lab))?;
    }
    Ok(())
}

//! Slicing measured: cost against the number of trees, and error against the mesh. See `docs/slicing.md`.
//!
//! ```text
//! cargo run --example slicing_charts -- --out docs/charts
//! ```

mod accuracy;
mod cost;
mod grove;
mod lab;
mod parts;
mod rivals;
#[path = "../common/rosette.rs"]
mod rosette;
mod switches;
mod walk;

use bevy_verdure::lab::ChartArgs;
use bevy_verdure::lab::charts::Chart;
use clap::Parser;

use lab::Lab;

/// Measures slicing, and draws the charts.
#[derive(Parser)]
struct Args {
    #[command(flatten)]
    charts: ChartArgs,
    /// Fewer trees, eyes and settings.
    #[arg(long)]
    quick: bool,
    /// How many trees, for charts of cost.
    #[arg(long, value_delimiter = ',', value_parser = clap::value_parser!(u32).range(1..=10_000))]
    trees: Vec<u32>,
}

/// A chart of its name.
type Experiment = (&'static str, fn(&mut Lab) -> Result<Chart, String>);

const EXPERIMENTS: [Experiment; 10] = [
    ("slicing_cost", cost::against_trees),
    ("slicing_parts", parts::against_trees),
    ("slicing_switches", switches::error_against_cost),
    ("slicing_walk", walk::against_trees),
    ("slicing_rivals_error", rivals::errors),
    ("slicing_rivals_cost", rivals::cost),
    ("slicing_slices", accuracy::against_slices),
    ("slicing_orientations", accuracy::against_orientations),
    ("slicing_pixels", accuracy::against_pixels),
    ("slicing_elevation", accuracy::against_elevation),
];

fn main() -> Result<(), String> {
    let args = Args::parse();
    for (name, chart) in EXPERIMENTS {
        args.charts.draw(name, || {
            chart(&mut Lab::open(args.quick, args.trees.clone()))
        })?;
    }
    Ok(())
}

//! Slicing measured: cost against the number of trees, and error against the mesh. See `docs/slicing.md`.
//!
//! ```text
//! cargo run --example slicing_charts -- --out docs/charts
//! cargo run --example slicing_charts -- --figures
//! ```

mod accuracy;
mod brightness;
mod compression;
mod cost;
mod discrepancy;
mod figures;
mod grove;
mod intersecting;
mod lab;
mod light;
mod modes;
mod near;
mod parts;
mod pop;
mod rivals;
#[path = "../common/rosette.rs"]
mod rosette;
mod switches;
mod walk;

use std::path::PathBuf;

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
    /// Draws the paper's Figures 3, 5 and 6, and crowns that intersect, into this folder instead.
    #[arg(long, num_args = 0..=1, default_missing_value = "docs/figures", value_name = "DIR")]
    figures: Option<PathBuf>,
}

/// A chart of its name.
type Experiment = (&'static str, fn(&mut Lab) -> Result<Chart, String>);

const EXPERIMENTS: [Experiment; 23] = [
    ("slicing_cost", cost::against_trees),
    ("slicing_parts", parts::against_trees),
    ("slicing_switches", switches::error_against_cost),
    ("slicing_walk", walk::against_trees),
    ("slicing_rivals_error", rivals::errors),
    ("slicing_rivals_cost", rivals::cost),
    ("slicing_slices", accuracy::against_slices),
    ("slicing_orientations", accuracy::against_orientations),
    ("slicing_pixels", accuracy::against_pixels),
    ("slicing_modes", modes::against_distance),
    ("slicing_compression", compression::against_distance),
    ("slicing_elevation", accuracy::against_elevation),
    ("slicing_discrepancy", discrepancy::against_angle),
    ("slicing_pop", pop::on_an_orbit),
    ("slicing_brightness", brightness::against_background),
    ("slicing_light", light::against_distance),
    ("slicing_cover", light::cover_by_elevation),
    ("slicing_light_above", light::light_by_elevation),
    ("slicing_light_around", light::light_by_azimuth),
    ("slicing_inside", near::inside),
    ("slicing_perspective", near::perspective),
    ("slicing_intersecting", intersecting::against_overlap),
    ("slicing_bands", intersecting::cost_of_bands),
];

fn main() -> Result<(), String> {
    let args = Args::parse();
    if let Some(dir) = &args.figures {
        return figures::draw(&mut Lab::open(args.quick, args.trees.clone()), dir);
    }
    for (name, chart) in EXPERIMENTS {
        args.charts.draw(name, || {
            chart(&mut Lab::open(args.quick, args.trees.clone()))
        })?;
    }
    Ok(())
}

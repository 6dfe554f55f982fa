//! Where the methods fail, as charts: see `docs/limits.md`. Arithmetic alone; no GPU is needed.
//!
//! ```text
//! cargo run --example limits -- --out docs/charts
//! ```

use bevy_verdure::lab::ChartArgs;
use bevy_verdure::lab::limits::EXPERIMENTS;
use clap::Parser;

/// Draws the charts of where the methods fail.
#[derive(Parser)]
struct Args {
    #[command(flatten)]
    charts: ChartArgs,
}

fn main() -> Result<(), String> {
    let args = Args::parse();
    for (name, chart) in EXPERIMENTS {
        args.charts.draw(name, || Ok(chart()))?;
    }
    Ok(())
}

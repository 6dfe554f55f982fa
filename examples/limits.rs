//! Where the methods fail, as charts: see `docs/limits.md`. Arithmetic alone; no GPU is needed.
//!
//! ```text
//! cargo run --example limits -- --out docs/charts
//! ```

use std::path::PathBuf;

use bevy_verdure::lab::limits::EXPERIMENTS;
use clap::Parser;

/// Draws the charts of where the methods fail.
#[derive(Parser)]
struct Args {
    /// Folder for the charts: SVG, PNG and CSV of each.
    #[arg(long, default_value = "docs/charts")]
    out: PathBuf,
    /// Only those whose name contains this.
    #[arg(long, default_value = "")]
    only: String,
}

fn main() -> Result<(), String> {
    let args = Args::parse();
    for (name, chart) in EXPERIMENTS {
        if name.contains(&args.only) {
            chart().save(&args.out, name)?;
            println!("{}", args.out.join(name).with_extension("png").display());
        }
    }
    Ok(())
}

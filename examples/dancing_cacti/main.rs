//! A hundred cacti, each with its own dance (Figure 8 of the paper): 2,158 segments, unfolded into entities that a
//! system turns. Orbit and fly round them, or render PNGs with `--headless`.
//!
//! ```text
//! cargo run --example dancing_cacti
//! cargo run --example dancing_cacti -- --headless --frames 8 --out out
//! ```

mod cactus;
#[path = "../common/mod.rs"]
mod common;
mod crowd;
mod dance;

use bevy::prelude::*;
use bevy_verdure::lab::CommonArgs;
use clap::Parser;

/// A hundred dancing cacti.
#[derive(Parser)]
struct Args {
    #[command(flatten)]
    common: CommonArgs,
}

fn main() -> std::process::ExitCode {
    let args = Args::parse();
    let run = common::run("dancing_cacti", &args.common, |app| {
        app.add_plugins((
            common::stage::Stage {
                eye: Vec3::new(-5.5, 3.4, 14.0),
                at: Vec3::new(0.0, 0.75, 1.5),
                centre: Vec3::Y * 0.8,
                ..default()
            },
            crowd::crowd,
        ));
    });
    common::exit(run)
}

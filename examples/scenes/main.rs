//! The nine scenes of the frusta paper's Table 1, grown from a seed.
//!
//! ```text
//! cargo run --example scenes -- oasis
//! cargo run --example scenes -- elm --seed 3 --headless --frames 1 --out out
//! ```
//!
//! M goes from relief to polygons of the same surface, to smooth frusta, and back; `--draw` names the first.

#[path = "../dancing_cacti/cactus.rs"]
mod cactus;
#[path = "../common/mod.rs"]
mod common;
#[path = "../dancing_cacti/crowd.rs"]
mod crowd;
#[path = "../dancing_cacti/dance.rs"]
mod dance;
mod looks;
mod planting;
mod scene;
mod twins;
mod wardrobe;

use bevy_verdure::lab::CommonArgs;
use clap::Parser;

use planting::Drawn;
use scene::Scene;

/// Shows one of the paper's scenes.
#[derive(Parser)]
struct Args {
    /// The scene.
    #[arg(value_enum)]
    scene: Scene,
    /// What the plants grow from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// What is drawn at first.
    #[arg(long, value_enum, default_value = "relief")]
    draw: Drawn,
    /// How often polygons are subdivided: 16 triangles a segment, and each time four for one.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(0..=5))]
    subdivisions: u32,
    #[command(flatten)]
    common: CommonArgs,
}

fn main() -> std::process::ExitCode {
    let args = Args::parse();
    let run = common::run(&args.scene.name(), &args.common, |app| {
        args.scene
            .stage(args.seed, args.draw, args.subdivisions, app);
    });
    common::exit(run)
}

//! A grove of trees in leaf, as meshes or as slicings: the experiment of the slicing paper (§3).
//!
//! ```text
//! cargo run --example grove -- --trees 128
//! cargo run --example grove -- --headless --size 640x480 --frames 4 --stride 650 --out out
//! ```

#[path = "../common/mod.rs"]
mod common;
mod keys;
#[path = "../common/rosette.rs"]
mod rosette;
mod trees;
mod walk;

use bevy::prelude::*;
use bevy_verdure::lab::CommonArgs;
use bevy_verdure::prelude::*;
use clap::{Parser, ValueEnum};

use common::light::Light;
use common::stage::Stage;
use trees::{Drawn, Grove};
use walk::Walk;

/// Walks through a grove. Keys: M meshes or slicings, F frames round slices, H hashed or blended, B the paper's order,
/// L lighting, X leaves back slices out, N triangles right up close, G wind, P the recorded walk.
#[derive(Parser)]
struct Args {
    /// Number of trees.
    #[arg(long, default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    trees: u32,
    /// What the trees grow from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// How crowns are drawn.
    #[arg(long, value_enum, default_value_t = Drawn::Slicing)]
    drawn: Drawn,
    /// A slicing to use, baked by `bake_slicing` from this example's tree. Left out, one is baked at the start.
    #[arg(long, value_name = "FILE.slicing.ron")]
    slicing: Option<std::path::PathBuf>,
    /// Pixels along each side of a slice that is baked.
    #[arg(long, default_value_t = 256)]
    pixels: u32,
    /// How slices cover what is behind them.
    #[arg(long, value_enum, default_value_t = Cover::Blended)]
    cover: Cover,
    /// What lights crowns of slices.
    #[arg(long, value_enum, default_value_t = Light::Simple)]
    light: Light,
    /// The share of light that comes through leaves from behind, 0 to 1. A slicing that is given has its own.
    #[arg(long, default_value_t = 0.4, value_parser = bevy_verdure::lab::parse_share)]
    transmission: f32,
    /// The paper's order of slices.
    #[arg(long)]
    paper: bool,
    /// Slices right up close too, where crowns give over to their triangles otherwise.
    #[arg(long)]
    slices_alone: bool,
    /// Frames round slices.
    #[arg(long)]
    edges: bool,
    /// Wind along x, in metres a second.
    #[arg(long, default_value_t = 0.0, allow_hyphen_values = true)]
    wind: f32,
    /// First frame of the walk that is shown, of 2,600.
    #[arg(long, default_value_t = 0)]
    from: usize,
    /// Frames of the walk that each shown frame goes ahead.
    #[arg(long, default_value_t = 1)]
    stride: usize,
    /// Where the eye stands, instead of on the walk.
    #[arg(long, value_parser = bevy_verdure::lab::parse_vec3, allow_hyphen_values = true, value_name = "X,Y,Z")]
    eye: Option<Vec3>,
    /// What a standing eye looks at.
    #[arg(long, value_parser = bevy_verdure::lab::parse_vec3, allow_hyphen_values = true, value_name = "X,Y,Z",
        default_value = "0,5,0")]
    at: Vec3,
    #[command(flatten)]
    common: CommonArgs,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Cover {
    Blended,
    Hashed,
}

fn main() -> std::process::ExitCode {
    let args = Args::parse();
    common::exit(run(&args))
}

fn run(args: &Args) -> Result<(), String> {
    let settings = CrownSettings {
        composition: match args.cover {
            Cover::Blended => Composition::Blended,
            Cover::Hashed => Composition::Hashed,
        },
        order: if args.paper {
            SliceOrder::Paper
        } else {
            SliceOrder::Steady
        },
        lighting: args.light.into(),
        frames: args.edges,
        ..default()
    };
    let grove = Grove::grow(
        args.seed,
        args.pixels,
        args.transmission,
        args.slicing.as_deref(),
    )?;
    let walk = Walk::new(args.trees, args.from, args.stride, args.eye.is_some());
    let (eye, at) = args.eye.map_or_else(|| walk.view(), |eye| (eye, args.at));
    let close_up = !args.slices_alone;
    let (trees, seed, drawn) = (args.trees, args.seed, args.drawn);
    let wind = Wind::new(Vec3::X * args.wind);
    let stage = Stage {
        eye,
        at,
        centre: Vec3::Y * 4.0,
        shadows: 70.0,
        haze: (120.0, 400.0),
    };
    common::run("grove", &args.common, move |app| {
        app.add_plugins(stage)
            .insert_resource(common::Orbit {
                centre: stage.centre,
                speed: 0.0,
            })
            .insert_resource(wind)
            .insert_resource(walk)
            .insert_resource(keys::Shown {
                drawn,
                settings,
                close_up,
            })
            .insert_resource(grove)
            .add_systems(
                Startup,
                move |commands: Commands, grove: Res<Grove>, assets: trees::TreeAssets| {
                    grove.plant(trees, seed, drawn, settings, commands, assets);
                },
            )
            .add_systems(Update, (keys::press, keys::show, walk::go).chain());
    })
}

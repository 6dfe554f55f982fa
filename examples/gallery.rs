//! A contact sheet of the nine scenes.
//!
//! ```text
//! cargo run --example gallery -- --size 320x240 --out out
//! ```

#[path = "dancing_cacti/cactus.rs"]
mod cactus;
mod common;
#[path = "dancing_cacti/crowd.rs"]
mod crowd;
#[path = "dancing_cacti/dance.rs"]
mod dance;
#[path = "scenes/looks.rs"]
mod looks;
#[path = "scenes/planting.rs"]
mod planting;
#[path = "scenes/scene.rs"]
mod scene;
#[path = "scenes/twins.rs"]
mod twins;
#[path = "scenes/wardrobe.rs"]
mod wardrobe;

use std::path::PathBuf;

use bevy::math::UVec2;
use bevy_verdure::lab::{Size, parse_size};
use clap::{Parser, ValueEnum};
use image::{RgbImage, imageops};

use planting::Drawn;
use scene::Scene;

/// Pictures a row.
const COLUMNS: u32 = 3;

/// Draws the nine scenes on one sheet.
#[derive(Parser)]
struct Args {
    /// Size of each picture, in pixels.
    #[arg(long, default_value = "320x240", value_parser = parse_size)]
    size: Size,
    /// What the plants grow from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Folder for the sheet, `gallery.png`.
    #[arg(long, default_value = "out")]
    out: PathBuf,
}

fn main() -> std::process::ExitCode {
    common::exit(draw(&Args::parse()))
}

fn draw(args: &Args) -> Result<(), String> {
    let scenes = Scene::value_variants();
    let UVec2 { x, y } = args.size;
    let mut sheet = RgbImage::new(x * COLUMNS, y * (scenes.len() as u32).div_ceil(COLUMNS));
    for (i, scene) in (0..).zip(scenes) {
        let picture = common::picture(args.size, |app| {
            scene.stage(args.seed, Drawn::Relief, 0, app)
        })?;
        let picture = RgbImage::from_raw(x, y, picture.rgb_bytes())
            .ok_or("a picture of another size came back")?;
        let (column, row) = (i % COLUMNS, i / COLUMNS);
        imageops::replace(
            &mut sheet,
            &picture,
            i64::from(column * x),
            i64::from(row * y),
        );
        println!("{}", scene.name());
    }
    std::fs::create_dir_all(&args.out)
        .map_err(|error| format!("{}: {error}", args.out.display()))?;
    let file = args.out.join("gallery.png");
    sheet
        .save(&file)
        .map_err(|error| format!("{}: {error}", file.display()))?;
    println!("{}", file.display());
    Ok(())
}

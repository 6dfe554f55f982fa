//! Bakes the crown of a model into a slicing.
//!
//! ```text
//! cargo run --example bake_slicing -- MODEL.glb --sparse leaves,twigs --out DIR
//! cargo run --example bake_slicing -- --out DIR
//! ```

use std::path::PathBuf;
use std::time::Instant;

use bevy_verdure::lab::{ModelPart, broadleaf_crown, load_model, parse_share, save_slicing};
use bevy_verdure::plants::Broadleaf;
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::{bake_with_progress, separate};
use clap::Parser;

/// Bakes the crown of a *.glb or *.gltf, or of a generated broadleaf where none is given.
#[derive(Parser)]
struct Args {
    /// The model. Left out, a broadleaf is grown.
    model: Option<PathBuf>,
    /// Folder for the slicing.
    #[arg(long, default_value = "out")]
    out: PathBuf,
    /// Name of the slicing: NAME.slicing.ron.
    #[arg(long, value_parser = parse_name)]
    name: Option<String>,
    /// What is baked: parts whose mesh or material has one of these in its name. Left out, all connected parts smaller
    /// than `--share` of the model.
    #[arg(long, value_delimiter = ',')]
    sparse: Vec<String>,
    /// How large a connected part of the model must be to count as solid, as a share of the model.
    #[arg(long, default_value_t = 0.25, value_parser = parse_share)]
    share: f32,
    /// Orientations over the circle.
    #[arg(long, default_value_t = 6, conflicts_with = "sphere")]
    circle: u32,
    /// Orientations over the sphere, instead of over the circle.
    #[arg(long)]
    sphere: Option<u32>,
    /// Slices in each level of detail.
    #[arg(long, value_delimiter = ',', default_value = "5,3,1")]
    levels: Vec<u32>,
    /// Pixels along each side of a slice.
    #[arg(long, default_value_t = 256)]
    pixels: u32,
    /// Samples along each side of a pixel.
    #[arg(long, default_value_t = 4)]
    samples: u32,
    /// Share of the light that comes through leaves from behind, 0 to 1: 0.5 looks alike from both sides.
    #[arg(long, default_value_t = 0.0, value_parser = parse_share)]
    transmission: f32,
    /// What a broadleaf grows from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Reads the name of files in a folder.
fn parse_name(text: &str) -> Result<String, String> {
    if text.is_empty() || text.contains(['/', '\\']) {
        return Err(format!(
            "'{text}' is no name of a file: name the folder with --out"
        ));
    }
    Ok(text.into())
}

fn main() -> std::process::ExitCode {
    match run(&Args::parse()) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    let (crown, solid) = crown(args)?;
    println!(
        "{} triangles to bake, {solid} solid ones left out",
        crown.triangles.len()
    );
    let defaults = BakeSettings::default();
    let settings = BakeSettings {
        orientations: match args.sphere {
            Some(count) => Orientations::Sphere(count),
            None => Orientations::Circle(args.circle),
        },
        switches: defaults
            .switches
            .iter()
            .copied()
            .take(args.levels.len().saturating_sub(1))
            .collect(),
        levels: args.levels.clone(),
        pixels: args.pixels,
        samples: args.samples,
        ..defaults
    };
    let start = Instant::now();
    let slicing = bake_with_progress(&crown, &settings, |done, all| {
        if done * 10 / all != (done - 1) * 10 / all {
            println!("{done} of {all} slices");
        }
    })
    .map_err(|error| match &args.model {
        Some(path) => format!("{}: {error}", path.display()),
        None => error.to_string(),
    })?;
    println!("baked in {:.2} s", start.elapsed().as_secs_f64());
    let mebibytes = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    let stem = args
        .model
        .as_deref()
        .and_then(|path| path.file_stem()?.to_str())
        .unwrap_or("broadleaf");
    let saved = save_slicing(&slicing, &args.out, args.name.as_deref().unwrap_or(stem))?;
    println!(
        "{}\n{} files, {:.2} MiB on disk, {:.2} MiB on the GPU, {:.2} MiB compressed",
        saved.files[0].display(),
        saved.files.len(),
        mebibytes(saved.bytes),
        mebibytes(slicing.gpu_bytes(false)),
        mebibytes(slicing.gpu_bytes(true)),
    );
    Ok(())
}

/// What is baked, and how many triangles are not.
fn crown(args: &Args) -> Result<(CrownMesh, usize), String> {
    let Some(path) = &args.model else {
        let tree = Broadleaf::default().grow(args.seed);
        let crown = broadleaf_crown(&tree, args.transmission).map_err(|error| error.to_string())?;
        return Ok((crown, Broadleaf::default().solid_triangles as usize));
    };
    let model = load_model(path)?;
    let is_named = |part: &ModelPart| {
        let holds = |name: &String| {
            part.mesh.contains(name.as_str()) || part.material.contains(name.as_str())
        };
        args.sparse.is_empty() || args.sparse.iter().any(holds)
    };
    let mut crown = model
        .crown(is_named)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    // Files do not say.
    for material in &mut crown.materials {
        material.diffuse_transmission = args.transmission;
    }
    if args.sparse.is_empty() {
        crown = separate(&crown, args.share).sparse;
    }
    if crown.triangles.is_empty() {
        let names: Vec<_> = model
            .parts
            .iter()
            .map(|part| format!("`{}`/`{}`", part.mesh, part.material))
            .collect();
        return Err(format!(
            "{}: no part is sparse. Name some with --sparse, or raise --share; there are {}",
            path.display(),
            names.join(", ")
        ));
    }
    let all: usize = model.parts.iter().map(ModelPart::triangle_count).sum();
    let solid = all - crown.triangles.len();
    Ok((crown, solid))
}

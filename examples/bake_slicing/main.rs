//! Bakes the crown of a model into a slicing.
//!
//! ```text
//! cargo run --example bake_slicing -- MODEL.glb --sparse leaves,twigs --out DIR
//! cargo run --example bake_slicing -- --out DIR
//! cargo run --example bake_slicing -- --distance 25 --error 2 --out DIR
//! ```

use std::path::PathBuf;
use std::time::Instant;

use bevy_verdure::lab::{ModelPart, broadleaf_crown, load_model, parse_share, save_slicing};
use bevy_verdure::plants::Broadleaf;
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::{CrownTriangle, bake_with_progress, separate};
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
    /// Derive orientations, slices and pixels for eyes no nearer than this, in metres.
    #[arg(long, value_name = "METRES", value_parser = parse_positive)]
    distance: Option<f32>,
    /// How far leaves may be displaced from there on, in pixels of a screen of 480 lines. Left out, 4.
    #[arg(long, value_name = "PIXELS", value_parser = parse_positive, requires = "distance")]
    error: Option<f32>,
    /// Orientations over the circle. Left out, 6, or as many as are derived.
    #[arg(long, conflicts_with = "sphere")]
    circle: Option<u32>,
    /// Orientations over the sphere, instead of over the circle.
    #[arg(long)]
    sphere: Option<u32>,
    /// Orientations for eyes from these azimuths alone, in degrees from x towards z, as dense as over the circle.
    #[arg(long, value_name = "FROM,TO", value_parser = parse_arc, allow_hyphen_values = true, conflicts_with = "sphere")]
    arc: Option<[f32; 2]>,
    /// No orientation that looks down.
    #[arg(long)]
    no_vertical: bool,
    /// Slices in each level of detail. Left out, 5,3,1, or those that are derived.
    #[arg(long, value_delimiter = ',')]
    levels: Vec<u32>,
    /// Pixels along each side of a slice. Left out, 256, or as many as are derived.
    #[arg(long)]
    pixels: Option<u32>,
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

/// Reads a length or a number of pixels.
fn parse_positive(text: &str) -> Result<f32, String> {
    let number = text.parse().ok();
    let number = number.filter(|x: &f32| x.is_finite() && *x > 0.0);
    number.ok_or_else(|| format!("'{text}' is not above 0: give a number like 25 or 1.5"))
}

/// Reads two azimuths, in degrees.
fn parse_arc(text: &str) -> Result<[f32; 2], String> {
    let azimuths = text
        .split_once(',')
        .and_then(|(from, to)| Some([from.trim().parse().ok()?, to.trim().parse().ok()?]));
    let azimuths = azimuths.filter(|&[from, to]: &[f32; 2]| to > from && to - from < 360.0);
    azimuths.ok_or_else(|| {
        format!("'{text}' is no arc: write it like -60,60, the second greater by less than 360")
    })
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
    let settings = settings(args, &crown);
    if args.distance.is_some() {
        println!(
            "{:?}, levels of {:?} slices that give over at {:.1?} radii, {} pixels",
            settings.orientations, settings.levels, settings.switches, settings.pixels
        );
    }
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

/// The defaults, or what follows from a distance and an error, but for what was asked for.
fn settings(args: &Args, crown: &CrownMesh) -> BakeSettings {
    let mut settings = match args.distance {
        Some(distance) => {
            // What is no number above 0 stands for the usual error.
            let error = args.error.unwrap_or_default();
            BakeSettings::for_view(radius(crown), distance, error)
        }
        None => BakeSettings::default(),
    };
    if let Some(circle) = args.circle {
        settings.orientations = Orientations::Circle(circle);
    }
    if let (Orientations::Circle(circle), Some(azimuths)) = (&settings.orientations, args.arc) {
        settings.orientations = over_arc(*circle, azimuths);
    }
    if let Some(sphere) = args.sphere {
        settings.orientations = Orientations::Sphere(sphere);
    }
    if !args.levels.is_empty() {
        settings.levels.clone_from(&args.levels);
        settings.switches = BakeSettings::default().switches;
        settings
            .switches
            .truncate(args.levels.len().saturating_sub(1));
    }
    settings.vertical = !args.no_vertical;
    settings.pixels = args.pixels.unwrap_or(settings.pixels);
    settings.samples = args.samples;
    settings
}

/// Orientations over an arc of azimuths in degrees, no further from one another than so many over the circle.
fn over_arc(circle: u32, [from, to]: [f32; 2]) -> Orientations {
    let steps = (circle as f32 * (to - from) / 360.0).ceil() as u32;
    Orientations::Arc {
        count: steps.saturating_add(1),
        from: from.to_radians(),
        to: to.to_radians(),
    }
}

/// Furthest that the crown reaches from the middle of its bounds, in metres.
fn radius(crown: &CrownMesh) -> f32 {
    let (low, high) = crown.bounds().unwrap_or_default();
    let middle = 0.5 * (low + high);
    let positions = crown.triangles.iter().flat_map(CrownTriangle::positions);
    positions.map(|p| p.distance(middle)).fold(0.0, f32::max)
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

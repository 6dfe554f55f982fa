//! Bakes reference volumes into `*.texel.ron` files, and shows what is in them.
//!
//! ```text
//! cargo run --example bake_texel -- pear --size 64x64x64 --out out/pear.texel.ron --preview out/pear.png
//! cargo run --example bake_texel -- height hills.png --colors grass.png --size 256x256x64 --out out/hills.texel.ron
//! cargo run --example bake_texel -- images slice_00.png slice_01.png --out out/stack.texel.ron
//! cargo run --example bake_texel -- show out/pear.texel.ron --preview out/pear.png
//! ```

mod preview;
mod sources;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use bevy::math::{UVec3, Vec3};
use bevy_verdure::lab::parse_vec3;
use bevy_verdure::lab::texel_scenes::Pattern;
use bevy_verdure::texel::build::{Built, Spreading};
use bevy_verdure::texel::file::{load, save};
use bevy_verdure::texel::{
    BuildStep, Progress, ReferenceVolume, SliceAxis, SliceSets, Topology, silent,
};
use clap::{Args, Parser, Subcommand};

/// Bakes a reference volume.
#[derive(Parser)]
struct Cli {
    #[command(subcommand)]
    source: Source,
    #[command(flatten)]
    output: Output,
}

/// What a volume is made of.
#[derive(Subcommand)]
enum Source {
    #[command(flatten)]
    Pattern(Pattern),
    /// A grey image of heights.
    Height {
        /// The image: black is the bottom, white the top.
        file: PathBuf,
        /// An image of colours of the same size.
        #[arg(long)]
        colors: Option<PathBuf>,
    },
    /// A stack of images, the lowest first.
    Images {
        /// PNGs; alpha of 128 and more is opaque. One without alpha is opaque everywhere, but one of them at least has it.
        #[arg(required = true)]
        files: Vec<PathBuf>,
    },
    /// A volume that was baked before.
    Show {
        /// The `*.texel.ron` file.
        file: PathBuf,
    },
}

/// How a volume is built, and where it goes.
#[derive(Args)]
struct Output {
    /// Voxels along u, v and w: powers of two.
    #[arg(long, value_parser = parse_voxels, global = true)]
    size: Option<UVec3>,
    /// Lengths of the box along u, v and w in metres; those of a pattern are its own.
    #[arg(long, value_parser = parse_vec3, global = true)]
    lengths: Option<Vec3>,
    /// The shape keeps away from the sides; images and heights tile otherwise. Patterns have sides of their own.
    #[arg(long, global = true)]
    isolated: bool,
    /// Colours spread within slices along w only, as in the paper.
    #[arg(long, global = true)]
    within_slices: bool,
    /// The `*.texel.ron` file to write.
    #[arg(long, value_name = "FILE", value_parser = parse_out, global = true)]
    out: Option<PathBuf>,
    /// Draw four copies of the volume, and its slices, to this PNG.
    #[arg(long, value_name = "FILE.png", global = true)]
    preview: Option<PathBuf>,
}

impl Output {
    fn topology(&self) -> Topology {
        if self.isolated {
            Topology::Isolated
        } else {
            Topology::Tiling
        }
    }

    fn spreading(&self) -> Spreading {
        if self.within_slices {
            Spreading::Slice
        } else {
            Spreading::Volume
        }
    }
}

/// Reads a size like `256x256x64`.
fn parse_voxels(text: &str) -> Result<UVec3, String> {
    let sides: Vec<u32> = text
        .split(['x', 'X', '×'])
        .filter_map(|side| side.trim().parse().ok())
        .collect();
    match (sides.as_slice(), text.split(['x', 'X', '×']).count()) {
        (&[x, y, z], 3) => Ok(UVec3::new(x, y, z)),
        _ => Err(format!("'{text}' is no size: write it like 256x256x64")),
    }
}

/// Reads the name of a volume, so that none is built for nothing.
fn parse_out(text: &str) -> Result<PathBuf, String> {
    if text.ends_with(".texel.ron") {
        return Ok(text.into());
    }
    Err(format!(
        "'{text}' is no name of a volume: let it end in `.texel.ron`"
    ))
}

fn main() -> std::process::ExitCode {
    match bake(&Cli::parse()) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// Refuses options that would not be heeded.
fn check(Cli { source, output }: &Cli) -> Result<(), String> {
    let (what, unheeded) = match source {
        Source::Pattern(_) => (
            String::from("a pattern has lengths and sides of its own"),
            vec![
                ("--lengths", output.lengths.is_some()),
                ("--isolated", output.isolated),
            ],
        ),
        Source::Height { .. } => return Ok(()),
        Source::Images { files } => (
            format!("{}: images are opaque where they are", files[0].display()),
            vec![("--within-slices", output.within_slices)],
        ),
        Source::Show { file } => (
            format!("{}: a volume is shown as it was baked", file.display()),
            vec![
                ("--size", output.size.is_some()),
                ("--lengths", output.lengths.is_some()),
                ("--isolated", output.isolated),
                ("--within-slices", output.within_slices),
            ],
        ),
    };
    let given = unheeded.into_iter().filter(|(_, is_given)| *is_given);
    let given: Vec<&str> = given.map(|(name, _)| name).collect();
    if given.is_empty() {
        return Ok(());
    }
    Err(format!("{what}: leave out {}", given.join(" and ")))
}

fn bake(cli: &Cli) -> Result<(), String> {
    check(cli)?;
    let Cli { source, output } = cli;
    let start = Instant::now();
    let volume = match source {
        Source::Show { file } => load(file, &silent).map_err(|error| error.to_string())?,
        _ => {
            let built = build(source, output)?;
            report(&built);
            built.volume
        }
    };
    println!("{:.2} s", start.elapsed().as_secs_f64());
    describe(&volume);
    if let Some(path) = &output.out {
        make_folder(path)?;
        let images = save(&volume, path).map_err(|error| error.to_string())?;
        println!("{}, with {} and {}", path.display(), images[0], images[1]);
    }
    if let Some(path) = &output.preview {
        make_folder(path)?;
        let picture = preview::sheet(&volume);
        picture
            .save(path)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{}", path.display());
    }
    Ok(())
}

fn make_folder(path: &Path) -> Result<(), String> {
    match path.parent() {
        Some(folder) => std::fs::create_dir_all(folder)
            .map_err(|error| format!("{}: {error}", folder.display())),
        None => Ok(()),
    }
}

fn build(source: &Source, output: &Output) -> Result<Built, String> {
    // The line is written anew at each tenth of a step.
    let told = AtomicUsize::new(0);
    let built = built(source, output, &|step: BuildStep, share: f32| {
        let now = step as usize * 10 + (share * 10.0) as usize;
        if told.fetch_max(now, Ordering::Relaxed) < now {
            eprint!("\r{:<20}{:>4.0} %", step.name(), share * 100.0);
        }
    });
    if told.into_inner() > 0 {
        eprintln!();
    }
    built
}

fn built(source: &Source, output: &Output, progress: Progress) -> Result<Built, String> {
    let pattern = match source {
        Source::Pattern(pattern) => pattern,
        Source::Height { file, colors } => {
            return sources::height(file, colors.as_deref(), output, progress);
        }
        Source::Images { files } => return sources::images(files, output, progress),
        Source::Show { .. } => return Err("there is nothing to build".into()),
    };
    let size = output.size.unwrap_or(pattern.size());
    pattern
        .build(size, output.spreading(), progress)
        .map_err(|error| error.to_string())
}

fn report(Built { report, .. }: &Built) {
    println!(
        "{} voxels of the surface, {} to close contours, {} inside",
        report.surface_voxels, report.closing_voxels, report.inside_voxels,
    );
    if report.failed_columns > 0 {
        println!(
            "warning: parity failed in {} columns",
            report.failed_columns
        );
    }
    if report.zero_area_triangles > 0 {
        println!(
            "{} triangles without area were left out",
            report.zero_area_triangles
        );
    }
}

fn describe(volume: &ReferenceVolume) {
    let size = volume.size();
    println!(
        "{}x{}x{} voxels, {} opaque, {:?}",
        size.x,
        size.y,
        size.z,
        volume.opaque_voxels(),
        volume.topology()
    );
    let topology = volume.topology_report();
    if volume.topology() == Topology::Tiling && !topology.tiles() {
        println!(
            "warning: its sides do not fit, {:.1} % of the seam changes where {:.1} % do inside",
            topology.seam * 100.0,
            topology.inside * 100.0,
        );
    }
    for axis in SliceAxis::ALL {
        let e = volume.thickness().along(axis);
        println!(
            "narrowest thickness in slices along {}: {:.4} m",
            axis.name(),
            e
        );
    }
    let sets = SliceSets::new(volume, 256);
    println!(
        "{:.1} MiB in {} sets of slices",
        sets.bytes() as f64 / 1_048_576.0,
        sets.iter().count()
    );
}

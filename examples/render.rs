//! Renders any plant file without a window: colour as PNG, what else is asked for as EXR.
//!
//! ```text
//! cargo run --example render -- PLANT.swc --size 800x600 --out out --aov depth,normal
//! ```

use std::path::{Path, PathBuf};

use bevy::math::{UVec2, Vec3};
use bevy::prelude::*;
use bevy_verdure::lab::{
    CommonArgs, Figures, FrameStats, Headless, Lens, Shot, Studio, parse_vec3, save_exr,
};
use bevy_verdure::prelude::*;
use bevy_verdure::skeleton::{SkeletonLoaderSettings, skeleton_from_bytes};
use clap::{Parser, ValueEnum};

/// Renders a plant file: *.skeleton.ron, *.swc or *.csv.
#[derive(Parser)]
struct Args {
    /// The plant: a *.skeleton.ron, *.swc or *.csv file.
    plant: PathBuf,
    /// Where the eye is, in metres. Left out, the plant is framed.
    #[arg(long, value_parser = parse_vec3, allow_hyphen_values = true, value_name = "X,Y,Z")]
    eye: Option<Vec3>,
    /// What the eye looks at. Left out, the plant's middle.
    #[arg(long, value_parser = parse_vec3, allow_hyphen_values = true, value_name = "X,Y,Z")]
    at: Option<Vec3>,
    /// Vertical field of view, in degrees.
    #[arg(long, default_value_t = 45.0, value_name = "DEG")]
    fov: f32,
    /// Orthographic, with this height in metres.
    #[arg(long, value_name = "HEIGHT")]
    ortho: Option<f32>,
    /// How frusta meet.
    #[arg(long, value_enum, default_value_t = JoinArg::Mitre)]
    join: JoinArg,
    /// What closes free ends.
    #[arg(long, value_enum, default_value_t = EndsArg::Round)]
    ends: EndsArg,
    /// Figures to write besides the colour, each an EXR of 32-bit floats.
    #[arg(long, value_enum, value_delimiter = ',')]
    aov: Vec<Aov>,
    #[command(flatten)]
    common: CommonArgs,
}

#[derive(Clone, Copy, ValueEnum)]
enum JoinArg {
    Mitre,
    Round,
    Paper,
    PaperIterated,
}

#[derive(Clone, Copy, ValueEnum)]
enum EndsArg {
    Round,
    Flat,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Aov {
    /// Metres along the view axis; infinite on a miss.
    Depth,
    /// Shading normal in world space; 0 on a miss.
    Normal,
    /// Texture coordinates; 0 on a miss.
    Uv,
    /// Index of the joint that ends the segment; −1 on a miss.
    Segment,
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
    let path = args.plant.display().to_string();
    let bytes = std::fs::read(&args.plant)
        .map_err(|error| format!("{path}: {error}. Give the path of a plant file"))?;
    let skeleton = skeleton_from_bytes(&path, &bytes, &SkeletonLoaderSettings::default())
        .map_err(|error| error.to_string())?;
    if !(args.fov > 0.0 && args.fov < 180.0) {
        return Err(format!(
            "--fov {}: give an angle between 0 and 180 degrees",
            args.fov
        ));
    }
    let lens = match args.ortho {
        Some(height) if !(height > 0.0 && height.is_finite()) => {
            return Err(format!("--ortho {height}: give a height in metres above 0"));
        }
        Some(height) => Lens::Orthographic(height),
        None => Lens::Perspective(args.fov.to_radians()),
    };
    let settings = Frusta {
        join: match args.join {
            JoinArg::Mitre => Join::Mitre,
            JoinArg::Round => Join::Round,
            JoinArg::Paper => Join::Paper,
            JoinArg::PaperIterated => Join::PaperIterated,
        },
        ends: match args.ends {
            EndsArg::Round => Ends::Round,
            EndsArg::Flat => Ends::Flat,
        },
    };
    let out = &args.common.out;
    std::fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
    let shot = frame(args, &skeleton, lens);

    let mut studio = Studio::default();
    light(&mut studio, &skeleton);
    let plant = studio.plant(skeleton, settings, Transform::IDENTITY);
    let stem = args.plant.file_name().unwrap_or_default().to_string_lossy();
    let stem = stem.split('.').next().unwrap_or("plant").to_owned();

    let picture = studio.photograph(&shot, Color::srgb(0.55, 0.68, 0.82));
    let file = out.join(format!("{stem}.png"));
    picture.save_png(&file)?;
    println!("{}", file.display());
    if !args.aov.is_empty() {
        let figures = studio.measure(&shot);
        for aov in &args.aov {
            let file = write_aov(*aov, &figures, out, &stem)?;
            println!("{}", file.display());
        }
    }
    if let Some(stats) = &args.common.stats {
        let frames = args.common.frames;
        let show = |headless: &mut Headless, shown| {
            let visibility = if shown {
                Visibility::Visible
            } else {
                Visibility::Hidden
            };
            headless.world().entity_mut(plant).insert(visibility);
        };
        FrameStats::measure(&mut studio.headless, shot.size, frames, show).save(stats)?;
        println!("{}", stats.display());
    }
    Ok(())
}

/// The shot that was asked for, or one that frames the plant.
fn frame(args: &Args, skeleton: &Skeleton, lens: Lens) -> Shot {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for joint in skeleton.joints() {
        low = low.min(joint.position - joint.radius);
        high = high.max(joint.position + joint.radius);
    }
    let mut shot = Shot::framing(low, high, lens, args.common.size);
    if let Some(at) = args.at {
        shot.eye += at - shot.at;
        shot.at = at;
    }
    if let Some(eye) = args.eye {
        shot.eye = eye;
    }
    shot
}

/// A sun with shadows that cover the plant, and some sky.
fn light(studio: &mut Studio, skeleton: &Skeleton) {
    let reach = skeleton
        .joints()
        .iter()
        .map(|joint| joint.position.length())
        .fold(1.0, f32::max);
    let world = studio.world();
    world.insert_resource(GlobalAmbientLight {
        color: Color::srgb(0.7, 0.8, 1.0),
        brightness: 900.0,
        ..default()
    });
    world.spawn((
        DirectionalLight {
            illuminance: 9_000.0,
            shadow_maps_enabled: true,
            ..default()
        },
        bevy::light::CascadeShadowConfigBuilder {
            maximum_distance: reach * 8.0,
            first_cascade_far_bound: reach * 2.0,
            ..default()
        }
        .build(),
        Transform::default().looking_to(Vec3::new(-0.6, -1.0, -0.5), Vec3::Y),
    ));
}

fn write_aov(aov: Aov, figures: &Figures, out: &Path, stem: &str) -> Result<PathBuf, String> {
    let UVec2 {
        x: width,
        y: height,
    } = figures.size();
    let channel = |value: &dyn Fn(Option<bevy_verdure::lab::SeenPixel>) -> f32| -> Vec<f32> {
        (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .map(|(x, y)| value(figures.get(x, y)))
            .collect()
    };
    let (name, channels): (_, Vec<(&str, Vec<f32>)>) = match aov {
        Aov::Depth => (
            "depth",
            vec![(
                "Z",
                channel(&|seen| seen.map_or(f32::INFINITY, |seen| seen.depth)),
            )],
        ),
        Aov::Normal => (
            "normal",
            ["X", "Y", "Z"]
                .into_iter()
                .enumerate()
                .map(|(i, name)| {
                    (
                        name,
                        channel(&|seen| seen.map_or(0.0, |seen| seen.normal[i])),
                    )
                })
                .collect(),
        ),
        Aov::Uv => (
            "uv",
            ["U", "V"]
                .into_iter()
                .enumerate()
                .map(|(i, name)| (name, channel(&|seen| seen.map_or(0.0, |seen| seen.uv[i]))))
                .collect(),
        ),
        Aov::Segment => (
            "segment",
            vec![(
                "id",
                channel(&|seen| seen.map_or(-1.0, |seen| seen.segment as f32)),
            )],
        ),
    };
    let file = out.join(format!("{stem}.{name}.exr"));
    save_exr(&file, (width, height), &channels)?;
    Ok(file)
}

//! Surfaces covered with volumes: the paper's scenes (§6), and those that move, by their mesh, their height vectors or
//! volumes by turns.
//!
//! ```text
//! cargo run --example texels -- meadow
//! cargo run --example texels -- stroke
//! cargo run --example texels -- reeds
//! cargo run --example texels -- pear --headless --size 512x384 --frames 1 --out out
//! ```

#[path = "../common/mod.rs"]
mod common;

use bevy::core_pipeline::prepass::DepthPrepass;
use bevy::light::NotShadowCaster;
use bevy::mesh::skinning::SkinnedMeshInverseBindposes;
use bevy::prelude::*;
use bevy_verdure::lab::CommonArgs;
use bevy_verdure::lab::texel_scenes::{
    CYCLE_RATE, RECOVERY, TexelScene, bend_knees, bring_hand, joints, move_hands, surfaces,
};
use bevy_verdure::prelude::*;
use clap::Parser;

use common::light::Light;
use common::stage::Stage;

/// Shows texels.
#[derive(Parser)]
struct Args {
    /// What to show.
    #[arg(value_enum)]
    scene: TexelScene,
    /// Where the eye stands, instead of where the scene is best seen from.
    #[arg(long, value_parser = bevy_verdure::lab::parse_vec3, allow_hyphen_values = true, value_name = "X,Y,Z")]
    eye: Option<Vec3>,
    /// What the eye looks at.
    #[arg(long, value_parser = bevy_verdure::lab::parse_vec3, allow_hyphen_values = true, value_name = "X,Y,Z")]
    at: Option<Vec3>,
    /// d: how deep one may see into slices, as a share of the narrowest thickness.
    #[arg(long, default_value_t = TexelQuality::default().depth)]
    depth: f32,
    /// p: pixels between slices that are close enough for any depth.
    #[arg(long, default_value_t = TexelQuality::default().pixels)]
    pixels: f32,
    /// The least angle, in radians, that slices are chosen for, instead of the scene's.
    #[arg(long)]
    least_angle: Option<f32>,
    /// The most slices a texel.
    #[arg(long, default_value_t = TexelSettings::default().most_slices)]
    most: u32,
    /// Wind along x, in metres a second.
    #[arg(long, default_value_t = 4.0, allow_hyphen_values = true)]
    wind: f32,
    /// Let texels cast no shadows.
    #[arg(long)]
    unshadowed: bool,
    /// What lights the texels.
    #[arg(long, value_enum, default_value_t = Light::Simple)]
    light: Light,
    /// The share of light that comes through from behind, 0 to 1, instead of the scene's.
    #[arg(long, value_parser = bevy_verdure::lab::parse_share)]
    transmission: Option<f32>,
    /// Draw a depth prepass first, so that no pixel is lit twice.
    #[arg(long)]
    prepass: bool,
    /// Turn multisampling off.
    #[arg(long)]
    plain: bool,
    /// Turns of the camera a minute.
    #[arg(long, default_value_t = 1.0, allow_hyphen_values = true)]
    turns: f32,
    #[command(flatten)]
    common: CommonArgs,
}

fn main() -> std::process::ExitCode {
    let args = Args::parse();
    common::exit(run(&args))
}

fn run(args: &Args) -> Result<(), String> {
    let scene = args.scene;
    let own = scene.settings();
    let settings = TexelSettings {
        quality: TexelQuality {
            depth: args.depth,
            pixels: args.pixels,
            least_angle: args.least_angle.unwrap_or(own.quality.least_angle),
            ..own.quality
        },
        most_slices: args.most,
        lighting: args.light.into(),
        diffuse_transmission: args.transmission.unwrap_or(own.diffuse_transmission),
        ..own
    };
    let built = scene.volumes()?;
    let (eye, at) = scene.view();
    let stage = Stage {
        eye: args.eye.unwrap_or(eye),
        at: args.at.unwrap_or(at),
        centre: at.with_x(0.0).with_z(0.0),
        shadows: 20.0,
        haze: (30.0, 120.0),
    };
    let (turns, unshadowed) = (args.turns, args.unshadowed);
    let wind = Wind::new(Vec3::X * args.wind);
    let (prepass, plain) = (args.prepass, args.plain);
    let title = format!("texels_{}", scene.name());
    common::run(&title, &args.common, move |app| {
        app.add_plugins(stage)
            .insert_resource(wind)
            .add_systems(Update, (wave, bend_knees, move_hands))
            .insert_resource(common::Orbit {
                centre: stage.centre,
                speed: turns,
            })
            .add_systems(
                Startup,
                move |mut commands: Commands,
                      mut meshes: ResMut<Assets<Mesh>>,
                      mut volumes: ResMut<Assets<TexelVolume>>,
                      mut bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
                      mut materials: ResMut<Assets<StandardMaterial>>| {
                    let built = built.iter().cloned();
                    let handles: Vec<_> = built.map(|volume| volumes.add(volume)).collect();
                    for surface in scene.surfaces() {
                        let skin = (scene == TexelScene::Limb)
                            .then(|| joints(&mut commands, &mut bindposes));
                        let mut entity = commands.spawn((
                            Mesh3d(meshes.add(surface.mesh)),
                            TexelSurface {
                                volume: handles[0].clone(),
                                thickness: surface.thickness,
                            },
                            settings,
                            surface.place,
                        ));
                        if let Some(skin) = skin {
                            entity.insert(skin);
                        }
                        if handles.len() > 1 {
                            entity.insert(TexelCycle {
                                volumes: handles.clone(),
                                rate: CYCLE_RATE,
                            });
                        }
                        if unshadowed {
                            entity.insert(NotShadowCaster);
                        }
                        if let Some(color) = surface.color {
                            entity.insert(MeshMaterial3d(materials.add(StandardMaterial {
                                base_color: color,
                                perceptual_roughness: 1.0,
                                // Of a flag the cloth is seen behind.
                                double_sided: true,
                                cull_mode: None,
                                ..default()
                            })));
                        }
                        if scene == TexelScene::Flag {
                            entity.insert(LiveTexels);
                            let pole = Cylinder::new(0.025, 2.0);
                            let at = surface.place * Vec3::new(-0.83, 0.0, 0.0);
                            commands.spawn((
                                Mesh3d(meshes.add(pole)),
                                MeshMaterial3d(materials.add(Color::srgb(0.55, 0.42, 0.28))),
                                Transform::from_translation(at.with_y(1.0)),
                            ));
                        } else if scene == TexelScene::Stroke {
                            entity.insert(StrokedTexels { recovery: RECOVERY });
                            bring_hand(&mut commands, &mut meshes, &mut materials);
                        }
                    }
                },
            )
            .add_systems(
                PostStartup,
                move |mut commands: Commands, camera: Single<Entity, With<common::MainCamera>>| {
                    let mut camera = commands.entity(*camera);
                    if prepass {
                        camera.insert(DepthPrepass);
                    }
                    if plain {
                        camera.insert(Msaa::Off);
                    }
                },
            );
    })
}

/// Lets live surfaces wave.
fn wave(
    time: Res<Time>,
    flags: Query<&Mesh3d, With<LiveTexels>>,
    mut meshes: ResMut<Assets<Mesh>>,
) {
    for flag in &flags {
        if let Some(mut mesh) = meshes.get_mut(flag) {
            *mesh = surfaces::flag(time.elapsed_secs());
        }
    }
}

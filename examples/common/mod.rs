//! What keeps windows, cameras and pictures out of the examples: an app that runs in a window, or headless.

#![allow(dead_code, reason = "each example uses its part of it")]

pub mod light;
pub mod stage;
pub mod texture;

use std::time::Duration;

use bevy::camera::{Hdr, RenderTarget};
use bevy::camera_controller::free_camera::{FreeCamera, FreeCameraPlugin};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy_verdure::lab::{CommonArgs, FrameStats, Headless, Pixels};
use bevy_verdure::prelude::*;

/// Frames that are drawn before any is kept: assets load, textures reach the GPU.
const WARM_UP: usize = 3;
/// Time between two headless frames.
const STEP: Duration = Duration::from_millis(40);

/// Marks the camera that the user moves.
#[derive(Component)]
pub struct MainCamera;

/// Marks the root of a plant that has no skeleton, to be hidden where an empty scene is timed.
#[derive(Component)]
pub struct Plant;

/// What the eye circles while it orbits.
#[derive(Resource, Clone, Copy)]
pub struct Orbit {
    /// Centre, in metres.
    pub centre: Vec3,
    /// Turns a minute; 0 while the user flies.
    pub speed: f32,
}

/// Runs an example in a window, or without one, as its arguments say.
pub fn run(title: &str, args: &CommonArgs, configure: impl FnOnce(&mut App)) -> Result<(), String> {
    if args.headless {
        return run_headless(title, args, configure);
    }
    let mut app = App::new();
    app.add_plugins(DefaultPlugins.set(WindowPlugin {
        primary_window: Some(Window {
            title: title.into(),
            resolution: args.size.into(),
            ..default()
        }),
        ..default()
    }))
    .add_plugins((VerdurePlugin, FreeCameraPlugin))
    .add_systems(Startup, overlay)
    .add_systems(Update, (orbit, write_overlay, let_fly));
    configure(&mut app);
    app.run();
    Ok(())
}

/// What `main` returns.
pub fn exit(run: Result<(), String>) -> std::process::ExitCode {
    match run {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// An app without a window, with all it loads in place, and what its camera renders to.
fn open(size: UVec2, configure: impl FnOnce(&mut App)) -> Result<(Headless, RenderTarget), String> {
    let mut headless = Headless::new(STEP, |app| {
        app.add_plugins((VerdurePlugin, FreeCameraPlugin))
            .add_systems(Update, orbit);
        configure(app);
    });
    headless.step();
    let target = headless.target(size, TextureFormat::Rgba8UnormSrgb);
    let world = headless.world();
    let mut cameras = world.query_filtered::<Entity, With<MainCamera>>();
    let camera = cameras.single(world).map_err(|error| error.to_string())?;
    world.entity_mut(camera).insert(target.clone());
    for _ in 0..WARM_UP {
        headless.step();
    }
    Ok((headless, target))
}

/// One picture of an app.
pub fn picture(size: UVec2, configure: impl FnOnce(&mut App)) -> Result<Pixels, String> {
    let (mut headless, target) = open(size, configure)?;
    Ok(headless.capture(&target))
}

fn run_headless(
    title: &str,
    args: &CommonArgs,
    configure: impl FnOnce(&mut App),
) -> Result<(), String> {
    let out = &args.out;
    std::fs::create_dir_all(out).map_err(|error| format!("{}: {error}", out.display()))?;
    let (mut headless, target) = open(args.size, configure)?;
    if let Some(file) = &args.stats {
        let stats = FrameStats::measure(&mut headless, args.size, args.frames, show_plants);
        stats.save(file)?;
        println!("{}", file.display());
    }
    for frame in 0..args.frames {
        let picture = headless.capture(&target);
        let file = out.join(format!("{title}_{frame:03}.png"));
        picture.save_png(&file)?;
    }
    println!(
        "{} pictures in {}/{title}_*.png",
        args.frames,
        out.display()
    );
    Ok(())
}

/// Shows or hides all plants.
fn show_plants(headless: &mut Headless, shown: bool) {
    let world = headless.world();
    let mut plants = world.query_filtered::<&mut Visibility, Or<(With<Skeleton3d>, With<Plant>)>>();
    for mut visibility in plants.iter_mut(world) {
        *visibility = if shown {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
    }
}

/// A camera that circles, until a key of flight or the left mouse button takes it over; O gives it back. It flies with
/// WASD, E, Q and the mouse.
pub fn camera(eye: Vec3, at: Vec3) -> impl Bundle {
    (
        MainCamera,
        Camera3d::default(),
        // Tone mapping comes last, so that fog and sky of one colour look alike.
        Hdr,
        Transform::from_translation(eye).looking_at(at, Vec3::Y),
        FreeCamera::default(),
    )
}

fn orbit(
    time: Res<Time>,
    orbit: Option<Res<Orbit>>,
    mut cameras: Query<&mut Transform, With<MainCamera>>,
) {
    let Some(orbit) = orbit else { return };
    if orbit.speed == 0.0 {
        return;
    }
    let turn =
        Quat::from_rotation_y(orbit.speed / 60.0 * core::f32::consts::TAU * time.delta_secs());
    for mut camera in &mut cameras {
        camera.rotate_around(orbit.centre, turn);
    }
}

/// The user takes the camera over with any key of flight; O gives it back to the orbit.
fn let_fly(
    keys: Res<ButtonInput<KeyCode>>,
    buttons: Res<ButtonInput<MouseButton>>,
    orbit: Option<ResMut<Orbit>>,
) {
    use KeyCode::{KeyA, KeyD, KeyE, KeyO, KeyQ, KeyS, KeyW};
    let Some(mut orbit) = orbit else { return };
    if keys.any_just_pressed([KeyW, KeyA, KeyS, KeyD, KeyE, KeyQ])
        || buttons.just_pressed(MouseButton::Left)
    {
        orbit.speed = 0.0;
    }
    if keys.just_pressed(KeyO) {
        orbit.speed = if orbit.speed == 0.0 { 1.0 } else { 0.0 };
    }
}

/// The overlay's text.
#[derive(Component)]
struct Overlay;

fn overlay(mut commands: Commands) {
    commands.spawn((
        Overlay,
        Text::default(),
        TextFont::from_font_size(15.0),
        Node {
            position_type: PositionType::Absolute,
            top: px(10),
            left: px(12),
            ..default()
        },
    ));
}

fn write_overlay(
    time: Res<Time<Real>>,
    stats: Res<FrustaStats>,
    mut smooth: Local<f32>,
    mut overlay: Query<&mut Text, With<Overlay>>,
) {
    *smooth += (time.delta_secs() * 1e3 - *smooth) * 0.05;
    for mut text in &mut overlay {
        text.0 = format!(
            "{:.1} ms a frame\n{} plants, {} segments\n{:.2} ms on cutting planes, {} KiB uploaded\n\
             O: orbit   WASD EQ, mouse: fly",
            *smooth,
            stats.plants,
            stats.segments,
            stats.cutting_planes.as_secs_f64() * 1e3,
            stats.uploaded_bytes / 1024,
        );
    }
}

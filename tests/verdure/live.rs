//! Plants while a game runs: motion, animation clips, files that change, devices that cannot.

use core::time::Duration;
use std::time::Instant;

use bevy::animation::{AnimatedBy, AnimationTargetId, animated_field};
use bevy::asset::{AssetPlugin, uuid_handle};
use bevy::camera::visibility::NoFrustumCulling;
use bevy::core_pipeline::prepass::MotionVectorPrepass;
use bevy::pbr::{Material, MaterialPlugin};
use bevy::prelude::*;
use bevy::render::render_resource::{AsBindGroup, TextureFormat, WgpuLimits};
use bevy::render::settings::WgpuSettings;
use bevy::shader::{Shader, ShaderRef};
use bevy_verdure::lab::{Headless, Lens, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::skeleton::{PlantPlugin, SkeletonPlugin};

use crate::relief::bumpy_relief;

const SIZE: UVec2 = UVec2::new(256, 192);

/// Shows what the prepass wrote, all over the picture.
#[derive(Asset, AsBindGroup, TypePath, Clone, Default)]
struct Probe {}

const PROBE_SHADER: Handle<Shader> = uuid_handle!("5d3f7a52-7f5c-4d6e-9d0b-6f2a3c1e8b47");

impl Material for Probe {
    fn vertex_shader() -> ShaderRef {
        PROBE_SHADER.into()
    }

    fn fragment_shader() -> ShaderRef {
        PROBE_SHADER.into()
    }

    fn enable_prepass() -> bool {
        false
    }

    fn enable_shadows() -> bool {
        false
    }
}

const PROBE: &str = "
#import bevy_pbr::prepass_utils::prepass_motion_vector

struct Corner { @location(0) position: vec3<f32> }

@vertex
fn vertex(in: Corner) -> @builtin(position) vec4<f32> {
    return vec4(in.position.xy, 1.0, 1.0);
}

@fragment
fn fragment(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    return vec4(prepass_motion_vector(at, 0u), 0.0, 1.0);
}
";

#[test]
fn motion_vectors_match_the_pose() {
    check_motion_vectors(false);
}

#[test]
fn motion_vectors_of_relief_match_the_pose() {
    check_motion_vectors(true);
}

fn check_motion_vectors(with_relief: bool) {
    let mut studio = Studio::new(|app| {
        app.add_plugins(MaterialPlugin::<Probe>::default());
    });
    let camera = studio.camera();
    studio
        .world()
        .entity_mut(camera)
        .insert(MotionVectorPrepass);
    let world = studio.world();
    let shader = Shader::from_wgsl(PROBE, "probe.wgsl");
    world
        .resource_mut::<Assets<Shader>>()
        .insert(&PROBE_SHADER, shader)
        .unwrap();
    // A limb in the plane across the view, bent in that plane: its segments move as rigid bodies.
    let mut limb = Skeleton::builder();
    let base = limb.root(Vec3::ZERO, 0.25);
    limb.chain(
        base,
        &[
            (Vec3::new(0.0, 0.8, 0.0), 0.22),
            (Vec3::new(0.1, 1.5, 0.0), 0.18),
            (Vec3::new(0.4, 2.1, 0.0), 0.12),
        ],
    );
    let skeleton = limb.build().unwrap();
    let transform = Transform::from_xyz(0.2, -0.1, 0.3).with_rotation(Quat::from_rotation_y(0.4));
    let material = if with_relief {
        relief_material(Color::WHITE, bumpy_relief(&mut studio))
    } else {
        frusta_material(Color::WHITE)
    };
    let plant = studio.plant_in(skeleton, Frusta::default(), transform, material);
    let bend = |angle: f32| SkeletonPose {
        rotations: vec![Quat::from_rotation_z(angle); 4],
    };
    studio.world().entity_mut(plant).insert(bend(0.0));
    let shot = Shot {
        eye: Vec3::new(0.0, 1.0, 5.0),
        at: Vec3::Y,
        lens: Lens::Perspective(0.7),
        size: SIZE,
    };
    for _ in 0..3 {
        studio.measure_output(&shot, FrustaOutput::Geometry);
    }
    let before = studio.world().get::<PosedJoints>(plant).unwrap().clone();
    let quad = Rectangle::new(2.0, 2.0);
    let quad = studio.world().resource_mut::<Assets<Mesh>>().add(quad);
    let probe = studio.world().resource_mut::<Assets<Probe>>().add(Probe {});
    let probe = studio
        .world()
        .spawn((Mesh3d(quad), MeshMaterial3d(probe), NoFrustumCulling))
        .id();
    studio.headless.step();
    studio.headless.step();
    // The pose changes in the very frame that is captured.
    studio.world().entity_mut(plant).insert(bend(0.08));
    let moved = transform.with_translation(transform.translation + Vec3::new(0.05, 0.0, 0.0));
    studio.world().entity_mut(plant).insert(moved);
    let motion = studio.measure_output(&shot, FrustaOutput::Geometry);
    studio.world().despawn(probe);
    let after = studio.world().get::<PosedJoints>(plant).unwrap().clone();
    let figures = studio.measure(&shot);
    let projection = shot.projection();
    let clip_from_view = projection.get_clip_from_view();
    let clip_from_world = clip_from_view * shot.transform().to_matrix().inverse();
    let uv = |point: Vec3| clip_from_world.project_point3(point).truncate() * Vec2::new(0.5, -0.5);
    let (mut seen_pixels, mut fastest) = (0, 0.0f32);
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let Some(seen) = figures.get(x, y) else {
                continue;
            };
            let (origin, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
            let point = (origin + direction * f64::from(seen.depth)).as_vec3();
            let segment = seen.segment as usize;
            let local = moved.to_matrix().inverse().transform_point3(point);
            let in_segment = after
                .frame(segment)
                .unwrap()
                .inverse()
                .transform_point3(local);
            let local_before = before.frame(segment).unwrap().transform_point3(in_segment);
            let expected = uv(point) - uv(transform.transform_point(local_before));
            let [dx, dy, ..] = motion.floats(x, y);
            let error = (Vec2::new(dx, dy) - expected) * SIZE.as_vec2();
            // The mitre's planes turn with the bend, so points keep their place to second order; and 16-bit floats.
            assert!(
                error.length() < 0.25,
                "{x},{y} of segment {segment}: off by {error} pixels"
            );
            fastest = fastest.max((expected * SIZE.as_vec2()).length());
            seen_pixels += 1;
        }
    }
    println!("{seen_pixels} pixels, up to {fastest} pixels a frame");
    assert!(seen_pixels > 1500 && fastest > 5.0);
}

#[test]
fn an_animation_clip_bends_a_plant() {
    let mut studio = Studio::default();
    let mut limb = Skeleton::builder();
    let base = limb.root(Vec3::ZERO, 0.2);
    limb.chain(base, &[(Vec3::Y, 0.2), (Vec3::Y * 2.0, 0.2)]);
    let plant = studio.plant(
        limb.build().unwrap(),
        Frusta::default(),
        Transform::IDENTITY,
    );
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    studio.headless.step();
    let segments = studio
        .world()
        .get::<SegmentEntities>(plant)
        .expect("unfolded")
        .clone();
    let segment = segments.get(2).unwrap();
    let world = studio.world();
    let target = AnimationTargetId::from_name(world.get::<Name>(segment).unwrap());
    let mut clip = AnimationClip::default();
    let quarter = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    let curve = UnevenSampleAutoCurve::new([(0.0, Quat::IDENTITY), (0.1, quarter)]).unwrap();
    clip.add_curve_to_target(
        target,
        AnimatableCurve::new(animated_field!(Transform::rotation), curve),
    );
    let clip = world.resource_mut::<Assets<AnimationClip>>().add(clip);
    let (graph, index) = AnimationGraph::from_clip(clip);
    let graph = world.resource_mut::<Assets<AnimationGraph>>().add(graph);
    let mut player = AnimationPlayer::default();
    player.play(index);
    world
        .entity_mut(plant)
        .insert((player, AnimationGraphHandle(graph)));
    world
        .entity_mut(segment)
        .insert((target, AnimatedBy(plant)));
    for _ in 0..12 {
        studio.headless.step();
    }
    let posed = studio.world().get::<PosedJoints>(plant).unwrap();
    assert!(posed.positions()[2].distance(Vec3::new(-1.0, 1.0, 0.0)) < 1e-5);
}

#[test]
fn settings_and_skeletons_may_change_while_a_plant_is_bent() {
    let mut studio = Studio::default();
    let limb = |length: f32| {
        let joints = vec![
            Joint::root(Vec3::ZERO, 0.2),
            Joint::new(Vec3::Y, 0.2, 0),
            Joint::new(Vec3::Y * (1.0 + length), 0.2, 1),
        ];
        Skeleton::new(joints).unwrap()
    };
    let plant = studio.plant(limb(1.0), Frusta::default(), Transform::IDENTITY);
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    studio.headless.step();
    let segments = studio
        .world()
        .get::<SegmentEntities>(plant)
        .unwrap()
        .clone();
    let upper = segments.get(2).unwrap();
    let quarter = Quat::from_rotation_z(-core::f32::consts::FRAC_PI_2);
    studio.world().get_mut::<Transform>(upper).unwrap().rotation = quarter;
    let shot = Shot {
        eye: Vec3::new(0.5, 1.0, 6.0),
        at: Vec3::new(0.5, 1.0, 0.0),
        lens: Lens::Perspective(0.7),
        size: SIZE,
    };
    let width = |studio: &mut Studio| {
        let figures = studio.measure(&shot);
        let seen = |x: &u32| figures.get(*x, SIZE.y / 2).is_some();
        (0..SIZE.x).filter(seen).count()
    };
    // The joint at (0, 1), the tip at (1, 1) or (2, 1), both with spheres of 0.2.
    let pixels = SIZE.y as f32 / (2.0 * 6.0 * 0.35f32.tan());
    let expected = |length: f32| ((length + 0.4) * pixels) as usize;
    let found = width(&mut studio);
    assert!(
        found.abs_diff(expected(1.0)) <= 3,
        "{found} pixels instead of {}",
        expected(1.0)
    );
    studio
        .world()
        .entity_mut(plant)
        .insert(Frusta::default().with_join(Join::Round));
    studio.headless.step();
    assert!(
        width(&mut studio).abs_diff(expected(1.0)) <= 3,
        "bent after a change of joins"
    );
    let handle = studio.world().get::<Skeleton3d>(plant).unwrap().0.clone();
    let mut skeletons = studio.world().resource_mut::<Assets<Skeleton>>();
    *skeletons.get_mut(&handle).unwrap() = limb(2.0);
    studio.headless.step();
    studio.headless.step();
    assert!(
        width(&mut studio).abs_diff(expected(2.0)) <= 3,
        "bent after a reload"
    );
    assert!(
        studio.world().get_entity(upper).is_ok(),
        "segments outlive a reload of the same hierarchy"
    );
    studio.world().entity_mut(plant).remove::<UnfoldSkeleton>();
    studio.headless.step();
    studio.headless.step();
    assert!(studio.world().get_entity(upper).is_err(), "folded up");
    assert!(
        width(&mut studio).abs_diff(expected(0.0)) <= 3,
        "at rest again"
    );
    studio.world().entity_mut(plant).remove::<Skeleton3d>();
    studio.headless.step();
    assert_eq!(width(&mut studio), 0, "a plant no more");
}

#[test]
fn a_plant_follows_its_file_and_keeps_its_shape_when_an_edit_breaks_it() {
    let folder = std::env::temp_dir().join(format!("verdure_reload_{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("limb.swc");
    std::fs::write(&file, "1 1 0 0 0 0.2 -1\n2 1 0 1 0 0.1 1\n").unwrap();
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        TransformPlugin,
        AssetPlugin {
            file_path: folder.to_string_lossy().into_owned(),
            watch_for_changes_override: Some(true),
            ..default()
        },
        SkeletonPlugin,
        PlantPlugin,
    ));
    let handle: Handle<Skeleton> = app.world().resource::<AssetServer>().load("limb.swc");
    app.world_mut()
        .spawn((Skeleton3d(handle.clone()), UnfoldSkeleton));
    let joints = |app: &App| {
        let skeletons = app.world().resource::<Assets<Skeleton>>();
        skeletons.get(&handle).map(Skeleton::len)
    };
    // Watchers take their time; what is waited for is a change, not a speed.
    let patience = Duration::from_secs(30);
    let wait_for = |app: &mut App, count: Option<usize>| {
        let started = Instant::now();
        while joints(app) != count && started.elapsed() < patience {
            app.update();
            std::thread::sleep(Duration::from_millis(10));
        }
        assert_eq!(joints(app), count);
    };
    wait_for(&mut app, Some(2));
    std::fs::write(
        &file,
        "1 1 0 0 0 0.2 -1\n2 1 0 1 0 0.1 1\n3 1 0 2 0 0.1 2\n",
    )
    .unwrap();
    wait_for(&mut app, Some(3));
    std::fs::write(&file, "1 1 0 0 0 0.2 -1\n2 1 0 1 0 nan 1\n").unwrap();
    for _ in 0..150 {
        app.update();
        std::thread::sleep(Duration::from_millis(10));
        assert_eq!(joints(&app), Some(3), "the last good shape");
    }
    std::fs::write(&file, "1 1 0 0 0 0.2 -1\n2 1 0 1 0 0.3 1\n").unwrap();
    wait_for(&mut app, Some(2));
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_device_without_storage_buffers_gets_one_error_and_the_app_runs_on() {
    // In a process of its own: Bevy asks only the first device of a process what it can do.
    let child = std::process::Command::new(std::env::current_exe().unwrap())
        .args([
            "--exact",
            "live::without_storage_buffers",
            "--ignored",
            "--nocapture",
        ])
        .output()
        .unwrap();
    let log = String::from_utf8_lossy(&child.stdout) + String::from_utf8_lossy(&child.stderr);
    assert!(child.status.success(), "{log}");
    assert!(log.contains("1 passed"), "{log}");
    assert_eq!(log.matches("plants are not drawn").count(), 1, "{log}");
}

#[test]
#[ignore = "a process of its own, started by the test above"]
fn without_storage_buffers() {
    let settings = WgpuSettings {
        constrained_limits: Some(WgpuLimits {
            max_storage_buffers_per_shader_stage: 0,
            ..WgpuLimits::downlevel_webgl2_defaults()
        }),
        ..default()
    };
    let mut headless = Headless::with_settings(Duration::from_millis(16), settings, |app| {
        app.add_plugins(VerdurePlugin);
    });
    let target = headless.target(SIZE, TextureFormat::Rgba8UnormSrgb);
    let world = headless.world();
    let joints = vec![Joint::root(Vec3::ZERO, 0.5), Joint::new(Vec3::Y, 0.5, 0)];
    let skeleton = Skeleton::new(joints).unwrap();
    let skeleton = world.resource_mut::<Assets<Skeleton>>().add(skeleton);
    let bark = frusta_material(Color::WHITE);
    let bark = world.resource_mut::<Assets<FrustaMaterial>>().add(bark);
    world.spawn((Skeleton3d(skeleton), MeshMaterial3d(bark)));
    world.spawn((
        Camera3d::default(),
        Camera {
            clear_color: ClearColorConfig::Custom(Color::srgb(0.0, 0.0, 1.0)),
            ..default()
        },
        Msaa::Off,
        target.clone(),
        Transform::from_xyz(0.0, 0.0, 5.0),
    ));
    for _ in 0..10 {
        headless.step();
        assert!(headless.app().should_exit().is_none());
    }
    let picture = headless.capture(&target);
    assert_eq!(
        picture.rgb(SIZE.x / 2, SIZE.y / 2),
        [0, 0, 255],
        "the sky without the plant"
    );
}

//! What frusta cost the CPU: cutting planes a joint, the whole plugin a frame, and both against size.
//!
//! ```text
//! cargo bench --profile dev
//! ```

use std::hint::black_box;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy::time::TimeUpdateStrategy;
use bevy_verdure::frusta::single::cone::{EndKind, Frustum};
use bevy_verdure::frusta::single::join::{JoinKind, Link, PosedJoint, Skin, skin};
use bevy_verdure::frusta::single::links::{joints_at_rest, links};
use bevy_verdure::frusta::single::surface::align;
use bevy_verdure::lab::Headless;
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

#[path = "../examples/dancing_cacti/cactus.rs"]
#[allow(dead_code)]
mod cactus;
#[path = "../examples/common/mod.rs"]
mod common;
#[path = "../examples/dancing_cacti/dance.rs"]
mod dance;

/// Time between two frames.
const FRAME: Duration = Duration::from_millis(16);

/// A tree of `count` joints that forks at every eighth.
fn tree(count: usize) -> (Vec<Link>, Vec<PosedJoint>) {
    let mut dice = Dice::new(1);
    let mut joints: Vec<Joint> = vec![Joint::root(Vec3::ZERO, 0.3)];
    for i in 1..count {
        let parent = if i % 8 == 0 { i / 2 } else { i - 1 };
        let from = &joints[parent];
        let step = Vec3::new(dice.between(-0.5, 0.5), 1.0, dice.between(-0.5, 0.5)) * 0.4;
        let radius = (from.radius * dice.between(0.85, 1.1)).clamp(0.01, 0.5);
        joints.push(Joint::new(from.position + step, radius, parent as u32));
    }
    let skeleton = Skeleton::new(joints).expect("the tree above is valid");
    (links(&skeleton), joints_at_rest(&skeleton))
}

/// Cones and cutting planes of one plant, on one core. The time divided by the joints is the figure.
fn cutting_planes(c: &mut Criterion) {
    let mut group = c.benchmark_group("cutting_planes");
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        let (links, joints) = tree(count);
        let mut frusta = vec![Frustum::default(); count];
        group.throughput(Throughput::Elements(count as u64));
        if count >= 100_000 {
            group.sample_size(10);
        }
        for (name, join) in [("mitre", JoinKind::Mitre), ("round", JoinKind::Round)] {
            let style = Skin {
                join,
                ends: EndKind::Round,
            };
            group.bench_function(BenchmarkId::new(name, count), |b| {
                b.iter(|| skin(black_box(&links), black_box(&joints), style, &mut frusta));
            });
        }
        group.bench_function(BenchmarkId::new("align", count), |b| {
            b.iter(|| align(black_box(&links), black_box(&mut frusta), |_| Vec3::Z));
        });
    }
    group.finish();
}

/// Times at the borders of the plugin's system sets.
#[derive(Resource, Default)]
struct Borders([Option<Instant>; 6]);

fn border<const I: usize>(mut borders: ResMut<Borders>) {
    borders.0[I] = Some(Instant::now());
}

/// Plants a hundred cacti as in the example, with longer bodies instead of flowers: 2,158 segments, all of which move.
fn plant(world: &mut World) {
    let skin = world
        .resource_mut::<Assets<FrustaMaterial>>()
        .add(frusta_material(Color::WHITE));
    let mut dice = Dice::new(8);
    for i in 0..100 {
        let cactus = cactus::body(21 + usize::from(i < 58), &mut dice);
        let skeleton = world
            .resource_mut::<Assets<Skeleton>>()
            .add(cactus.skeleton);
        world.spawn((
            Skeleton3d(skeleton),
            MeshMaterial3d(skin.clone()),
            UnfoldSkeleton,
            dance::Dancer::new(cactus.trunk, cactus.arms, &mut dice),
        ));
    }
}

/// The dancing cacti in an app whose `PostUpdate` holds the plugin's systems and hardly another: what it takes is the
/// plugin's part of a frame, short of the copy to the device.
fn crowd() -> App {
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        bevy::asset::AssetPlugin::default(),
        bevy::image::ImagePlugin::default(),
        bevy::mesh::MeshPlugin,
    ))
    .init_asset::<bevy::shader::Shader>()
    .add_plugins(VerdurePlugin)
    .init_resource::<Borders>()
    .insert_resource(TimeUpdateStrategy::ManualDuration(FRAME))
    .add_systems(Update, dance::dance)
    .add_systems(
        PostUpdate,
        (
            border::<0>.before(VerdureSystems::Attach),
            border::<1>
                .after(VerdureSystems::Attach)
                .before(VerdureSystems::Pose),
            border::<2>
                .after(VerdureSystems::Pose)
                .before(VerdureSystems::CuttingPlanes),
            border::<3>
                .after(VerdureSystems::CuttingPlanes)
                .before(VerdureSystems::Bounds),
            border::<4>
                .after(VerdureSystems::Bounds)
                .before(VerdureSystems::Upload),
            border::<5>.after(VerdureSystems::Upload),
        ),
    );
    app.finish();
    app.cleanup();
    plant(app.world_mut());
    for _ in 0..4 {
        app.update();
    }
    let stats = app.world().resource::<FrustaStats>();
    assert_eq!((stats.plants, stats.segments), (100, 2158));
    assert!(stats.moved_joints > 2000, "they dance: {stats:?}");
    app
}

/// The whole plugin, a frame of the dancing cacti, and its parts.
fn frame(c: &mut Criterion) {
    let mut group = c.benchmark_group("dancing_cacti_frame");
    let mut crowd = crowd();
    group.bench_function("whole", |b| {
        b.iter_custom(|frames| {
            let mut sum = Duration::ZERO;
            for _ in 0..frames {
                crowd.world_mut().run_schedule(First);
                crowd.world_mut().run_schedule(Update);
                let started = Instant::now();
                crowd.world_mut().run_schedule(PostUpdate);
                sum += started.elapsed();
                crowd.world_mut().run_schedule(Last);
                crowd.world_mut().clear_trackers();
            }
            sum
        });
    });
    let parts = ["attach", "pose", "cutting_planes", "bounds", "upload"];
    for (part, name) in parts.into_iter().enumerate() {
        group.bench_function(name, |b| {
            b.iter_custom(|frames| {
                let mut sum = Duration::ZERO;
                for _ in 0..frames {
                    crowd.update();
                    let borders = crowd.world().resource::<Borders>().0.map(Option::unwrap);
                    sum += borders[part + 1] - borders[part];
                }
                sum
            });
        });
    }
    group.finish();
}

/// The copy of a frame's changes to the device.
fn copy(c: &mut Criterion) {
    let mut group = c.benchmark_group("dancing_cacti_copy");
    let mut crowd = Headless::new(FRAME, |app| {
        app.add_plugins(VerdurePlugin)
            .add_systems(Update, dance::dance);
        let render_app = app.sub_app_mut(bevy::render::RenderApp);
        render_app.init_resource::<Borders>().add_systems(
            bevy::render::ExtractSchedule,
            (
                border::<0>.before(VerdureSystems::Upload),
                border::<1>.after(VerdureSystems::Upload),
            ),
        );
    });
    plant(crowd.world());
    for _ in 0..4 {
        crowd.step();
    }
    assert!(crowd.world().resource::<FrustaStats>().uploaded_bytes > 100_000);
    group.bench_function("copy", |b| {
        b.iter_custom(|frames| {
            let mut sum = Duration::ZERO;
            for _ in 0..frames {
                crowd.step();
                let render_app = crowd.app().sub_app(bevy::render::RenderApp);
                let borders = render_app.world().resource::<Borders>().0;
                sum += borders[1].unwrap() - borders[0].unwrap();
            }
            sum
        });
    });
    group.finish();
}

criterion_group!(benches, cutting_planes, frame, copy);
criterion_main!(benches);

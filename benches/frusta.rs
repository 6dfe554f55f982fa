//! What frusta cost the CPU: cutting planes a joint, the whole plugin a frame, and both against size.
//!
//! ```text
//! cargo bench --profile dev
//! ```

use std::hint::black_box;
use std::time::{Duration, Instant};

use bevy::prelude::*;
use bevy_verdure::frusta::single::cone::{EndKind, Frustum};
use bevy_verdure::frusta::single::join::{JoinKind, Link, PosedJoint, Skin, skin};
use bevy_verdure::frusta::single::links::{joints_at_rest, links};
use bevy_verdure::frusta::single::surface::align;
use bevy_verdure::lab::Headless;
use bevy_verdure::prelude::*;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};

#[path = "../examples/dancing_cacti/cactus.rs"]
#[allow(dead_code)]
mod cactus;
#[path = "../examples/common/mod.rs"]
#[allow(dead_code)]
mod common;
#[path = "../examples/dancing_cacti/dance.rs"]
mod dance;

/// A tree of `count` joints that forks at every eighth.
fn tree(count: usize) -> (Vec<Link>, Vec<PosedJoint>) {
    let mut dice = cactus::Dice(1);
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

/// The dancing cacti with borders between the plugin's system sets, on no device at all: what is timed is the main
/// world's part, which is all of the plugin but the copy to the GPU.
fn crowd() -> Headless {
    let settings = bevy::render::settings::WgpuSettings {
        backends: None,
        ..default()
    };
    let mut crowd = Headless::with_settings(Duration::from_millis(16), settings, |app| {
        app.add_plugins(VerdurePlugin)
            .init_resource::<Borders>()
            .add_systems(Update, dance::dance)
            .add_systems(
                PostUpdate,
                (
                    border::<0>
                        .after(bevy::app::AnimationSystems)
                        .before(VerdureSystems::Attach),
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
    });
    let world = crowd.world();
    let skin = world
        .resource_mut::<Assets<FrustaMaterial>>()
        .add(frusta_material(Color::WHITE));
    let mut dice = cactus::Dice(8);
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
    for _ in 0..4 {
        crowd.step();
    }
    let stats = crowd.world().resource::<FrustaStats>();
    assert_eq!((stats.plants, stats.segments), (100, 2158));
    crowd
}

/// The whole plugin, a frame of the dancing cacti, and its parts.
fn frame(c: &mut Criterion) {
    let mut group = c.benchmark_group("dancing_cacti_frame");
    let mut crowd = crowd();
    let parts = [
        "whole",
        "attach",
        "pose",
        "cutting_planes",
        "bounds",
        "upload",
    ];
    for (part, name) in parts.into_iter().enumerate() {
        group.bench_function(name, |b| {
            b.iter_custom(|frames| {
                let mut sum = Duration::ZERO;
                for _ in 0..frames {
                    crowd.step();
                    let borders = crowd.world().resource::<Borders>().0.map(Option::unwrap);
                    sum += match part {
                        0 => borders[5] - borders[0],
                        part => borders[part] - borders[part - 1],
                    };
                }
                sum
            });
        });
    }
    group.finish();
}

criterion_group!(benches, cutting_planes, frame);
criterion_main!(benches);

//! Trees of any shape: folds, stumps shorter than they are thick, segments without cone or length.

use glam::DVec3;

use super::super::super::random::SplitMix64;
use super::super::super::{ReferenceJoin, ReferenceJoint, ReferenceScene};
use super::super::{ReliefOptions, ReliefPart, ReliefScene, ShellThickness};
use super::{ALL, bark, chain, grown, ray, settings};

fn tree(random: &mut SplitMix64) -> Vec<ReferenceJoint> {
    let mut joints = vec![ReferenceJoint {
        position: DVec3::ZERO,
        radius: random.range(0.1, 0.3),
        parent: None,
    }];
    let mut axes = vec![random.direction()];
    for _ in 0..3 + random.below(8) {
        let parent = random.below(joints.len());
        let bend = random.range(0.0, std::f64::consts::PI);
        let axis = random.direction_at(axes[parent], bend);
        let length = [0.0, 0.1, 0.5, 1.0, 1.0, 1.0][random.below(6)];
        joints.push(ReferenceJoint {
            position: joints[parent].position + length * axis,
            radius: random.range(0.03, 0.3),
            parent: Some(parent),
        });
        axes.push(axis);
    }
    joints
}

#[test]
fn any_tree_with_a_relief_of_one_height_is_its_plain_frusta() {
    let mut random = SplitMix64::new(7);
    for case in 0..200 {
        let joints = tree(&mut random);
        let (join, ends) = ALL[case % 4];
        let thickness = ShellThickness::Metres(0.05);
        let skin = settings(join, ends);
        let compare = |level: f64, skeleton: &[ReferenceJoint], random: &mut SplitMix64| {
            let plain = ReferenceScene::new(skeleton, skin);
            let relief = |_: f64, _: f64| level;
            let options = ReliefOptions {
                plane_level: level,
                ..ReliefOptions::default()
            };
            let scene = ReliefScene::with_options(&joints, skin, &relief, thickness, &options);
            for _ in 0..30 {
                let (origin, dir) = ray(random, &joints, 0.1);
                let (a, b) = (plain.cast(origin, dir, 0.0), scene.cast(origin, dir, 0.0));
                let t = |t: Option<f64>| t.unwrap_or(1e9);
                let (a, b) = (t(a.map(|a| a.t)), t(b.map(|b| b.t)));
                assert!((a - b).abs() < 1e-9, "case {case}, height {level}: {a} {b}");
            }
        };
        // The outer frusta decide what is a mitre or flat; round joins and ends are alike at all heights.
        compare(1.0, &grown(&joints, thickness), &mut random);
        if case % 4 == 2 {
            compare(0.0, &joints, &mut random);
        }
    }
}

#[test]
fn no_ray_slips_through_a_tree_with_round_joins() {
    let mut random = SplitMix64::new(8);
    let relief = bark;
    for case in 0..100 {
        let joints = tree(&mut random);
        let skin = settings(ReferenceJoin::Round, ALL[2 + case % 2].1);
        let plain = ReferenceScene::new(&joints, skin);
        let scene = ReliefScene::new(&joints, skin, &relief, ShellThickness::Metres(0.02));
        for _ in 0..30 {
            let (origin, dir) = ray(&mut random, &joints, 0.1);
            if let Some(inner) = plain.cast(origin, dir, 0.0) {
                let hit = scene.cast(origin, dir, 0.0);
                assert!(
                    hit.is_some_and(|hit| hit.t <= inner.t + 1e-9),
                    "case {case}: {inner:?} {hit:?}"
                );
            }
        }
    }
}

#[test]
fn at_a_round_join_the_ball_ends_where_the_next_cone_begins() {
    let mut random = SplitMix64::new(9);
    let relief = |u: f64, _: f64| bark(u, 0.0);
    let mut balls = 0;
    for _ in 0..20 {
        let joints = chain(&mut random, &[0.2; 4], 1.5);
        let skin = settings(ReferenceJoin::Round, ALL[0].1);
        let scene = ReliefScene::new(&joints, skin, &relief, ShellThickness::Metres(0.1));
        for _ in 0..100 {
            let (origin, dir) = ray(&mut random, &joints, 0.3);
            let Some(hit) = scene.cast(origin, dir, 0.0) else {
                continue;
            };
            if hit.part == ReliefPart::EndCap && hit.segment + 1 < joints.len() {
                // Cylinders touch the joint's sphere on the plane through the joint.
                let joint = joints[hit.segment].position;
                let next = joints[hit.segment + 1].position - joint;
                assert!((hit.position - joint).dot(next) < 1e-9);
                balls += 1;
            }
        }
    }
    assert!(balls > 50, "{balls}");
}

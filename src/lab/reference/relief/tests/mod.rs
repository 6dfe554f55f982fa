//! Relief against plain cones, against another way to march, and against itself.

mod trees;

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::super::random::SplitMix64;
use super::super::{
    ReferenceEnds, ReferenceJoin, ReferenceJoint, ReferenceScene, ReferenceSettings,
};
use super::{HeightImage, ReliefOptions, ReliefPart, ReliefScene, ShellThickness};

/// A chain of segments of length 1, each bent by `bend` from the one before, with these radii.
fn chain(random: &mut SplitMix64, radii: &[f64], bend: f64) -> Vec<ReferenceJoint> {
    let mut axis = random.direction();
    let mut position = DVec3::ZERO;
    let mut joints = Vec::new();
    for (i, &radius) in radii.iter().enumerate() {
        if i > 0 {
            axis = if i > 1 {
                random.direction_at(axis, bend)
            } else {
                axis
            };
            position += axis;
        }
        joints.push(ReferenceJoint {
            position,
            radius,
            parent: i.checked_sub(1),
        });
    }
    joints
}

/// The same joints with spheres grown by a shell.
fn grown(joints: &[ReferenceJoint], thickness: ShellThickness) -> Vec<ReferenceJoint> {
    let grow = |joint: &ReferenceJoint| ReferenceJoint {
        radius: joint.radius + thickness.at(joint.radius),
        ..*joint
    };
    joints.iter().map(grow).collect()
}

/// A ray from outside towards a point near a random place of the skeleton's axis.
fn ray(random: &mut SplitMix64, joints: &[ReferenceJoint], spread: f64) -> (DVec3, DVec3) {
    let i = 1 + random.below(joints.len() - 1);
    let (a, b) = (joints[i - 1].position, joints[i].position);
    let aim = a.lerp(b, random.range(-0.3, 1.3)) + spread * random.direction();
    let dir = random.direction();
    (aim - 12.0 * dir, dir * random.range(0.5, 2.0))
}

fn settings(join: ReferenceJoin, ends: ReferenceEnds) -> ReferenceSettings {
    ReferenceSettings { join, ends }
}

const ALL: [(ReferenceJoin, ReferenceEnds); 4] = [
    (ReferenceJoin::Mitre, ReferenceEnds::Round),
    (ReferenceJoin::Mitre, ReferenceEnds::Flat),
    (ReferenceJoin::Round, ReferenceEnds::Round),
    (ReferenceJoin::Round, ReferenceEnds::Flat),
];

/// Bark: long ridges that part and meet.
fn bark(u: f64, v: f64) -> f64 {
    let ridges = (TAU * (6.0 * u + 0.15 * (TAU * 2.0 * v).sin())).sin();
    let plates = (TAU * (3.0 * v + 0.2 * (TAU * 4.0 * u).sin())).cos();
    0.5 + 0.35 * ridges + 0.15 * plates
}

#[test]
fn a_relief_of_one_height_is_the_plain_frusta_of_that_height() {
    let mut random = SplitMix64::new(1);
    for case in 0..24 {
        let (join, ends) = ALL[case % 4];
        // Radii that leave every mitre its room, so that inner and outer frusta join alike.
        let radii: Vec<_> = (0..5).map(|_| random.range(0.08, 0.16)).collect();
        let bend = random.range(0.0, 60f64.to_radians());
        let joints = chain(&mut random, &radii, bend);
        let thickness = if case % 3 == 0 {
            ShellThickness::Relative(0.4)
        } else {
            ShellThickness::Metres(0.04)
        };
        let skin = settings(join, ends);
        for (level, skeleton) in [(0.0, joints.clone()), (1.0, grown(&joints, thickness))] {
            let plain = ReferenceScene::new(&skeleton, skin);
            let relief = |_: f64, _: f64| level;
            let options = ReliefOptions {
                plane_level: level,
                ..ReliefOptions::default()
            };
            let scene = ReliefScene::with_options(&joints, skin, &relief, thickness, &options);
            for _ in 0..200 {
                let (origin, dir) = ray(&mut random, &joints, 0.15);
                let (a, b) = (plain.cast(origin, dir, 0.0), scene.cast(origin, dir, 0.0));
                let (Some(a), Some(b)) = (a, b) else {
                    assert_eq!(a.is_some(), b.is_some(), "case {case}, height {level}");
                    continue;
                };
                assert!(
                    (a.t - b.t).abs() < 1e-9,
                    "case {case}, height {level}: {} {}",
                    a.t,
                    b.t
                );
                assert!(a.surface_normal.dot(b.normal) > 1.0 - 1e-9);
            }
        }
    }
}

#[test]
fn without_taper_one_plane_serves_all_heights() {
    let mut random = SplitMix64::new(2);
    let joints = chain(&mut random, &[0.15; 5], 50f64.to_radians());
    let thickness = ShellThickness::Metres(0.05);
    let skin = ReferenceSettings::default();
    for (level, skeleton) in [(0.0, joints.clone()), (1.0, grown(&joints, thickness))] {
        let plain = ReferenceScene::new(&skeleton, skin);
        let relief = |_: f64, _: f64| level;
        let scene = ReliefScene::new(&joints, skin, &relief, thickness);
        for _ in 0..300 {
            let (origin, dir) = ray(&mut random, &joints, 0.15);
            let (a, b) = (plain.cast(origin, dir, 0.0), scene.cast(origin, dir, 0.0));
            assert_eq!(a.is_some(), b.is_some());
            if let (Some(a), Some(b)) = (a, b) {
                assert!((a.t - b.t).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn a_wavy_cylinder_is_met_where_leaps_no_longer_than_the_distance_meet_it() {
    let (radius, h, length) = (1.0, 0.25, 3.0);
    let relief = |u: f64, v: f64| 0.5 + 0.5 * (5.0 * TAU * u).sin() * (2.0 * TAU * v).cos();
    let joints = [
        ReferenceJoint {
            position: DVec3::ZERO,
            radius,
            parent: None,
        },
        ReferenceJoint {
            position: DVec3::Y * length,
            radius,
            parent: Some(0),
        },
    ];
    let skin = settings(ReferenceJoin::Mitre, ReferenceEnds::Flat);
    let scene = ReliefScene::new(&joints, skin, &relief, ShellThickness::Metres(h));
    // u grows by the right hand about +y from +z, v by one a metre.
    let surface = |p: DVec3| {
        let u = p.x.atan2(p.z) / TAU;
        p.x.hypot(p.z) - radius - h * relief(u, p.y)
    };
    // |∇| ≤ 1 + h |∂H|: in u at most 5π on a circle of at least the radius, in v 2π.
    let steepest = 1.0 + h * (5.0 * PI * TAU / (TAU * radius) + 2.0 * PI);
    let mut random = SplitMix64::new(3);
    let mut hits = 0;
    for _ in 0..2000 {
        let aim = DVec3::new(
            random.range(-1.3, 1.3),
            random.range(0.6, 2.4),
            random.range(-1.3, 1.3),
        );
        let mut dir = random.direction();
        dir.y *= 0.2;
        let dir = dir.normalize();
        let origin = aim - 6.0 * dir;
        let mut t = 0.0;
        while t < 12.0 && surface(origin + t * dir) > 1e-13 {
            t += surface(origin + t * dir) / steepest;
        }
        let Some(hit) = scene.cast(origin, dir, 0.0) else {
            let y = (origin + t * dir).y;
            assert!(t >= 12.0 || !(0.0..=length).contains(&y));
            continue;
        };
        if hit.part == ReliefPart::Cone && t < 12.0 {
            // A leap ends 1e-13 before the surface; a graze stretches that.
            let slope = dir.dot(hit.normal).abs().max(1e-3);
            assert!((hit.t - t).abs() < 1e-9 / slope, "{} {t}", hit.t);
            hits += 1;
        }
    }
    assert!(hits > 800, "{hits}");
}

#[test]
fn a_hit_lies_on_the_relief_or_on_a_wall_below_it() {
    let mut random = SplitMix64::new(4);
    let image = HeightImage::from_fn(64, 32, bark);
    let relief = |u: f64, v: f64| image.sample(u, v);
    for case in 0..16 {
        let (join, ends) = ALL[case % 4];
        let radii: Vec<_> = (0..5).map(|_| random.range(0.1, 0.2)).collect();
        let joints = chain(&mut random, &radii, 40f64.to_radians());
        let thickness = ShellThickness::Metres(0.04);
        let scene = ReliefScene::new(&joints, settings(join, ends), &relief, thickness);
        for _ in 0..60 {
            let (origin, dir) = ray(&mut random, &joints, 0.2);
            let Some(hit) = scene.cast(origin, dir, 0.0) else {
                continue;
            };
            assert!((origin + hit.t * dir).distance(hit.position) < 1e-12);
            assert!(
                dir.dot(hit.normal) < 1e-6,
                "{hit:?} seen from behind {}",
                dir.dot(hit.normal)
            );
            if hit.part == ReliefPart::Wall {
                assert!(hit.w <= hit.height + 1e-9, "{hit:?}");
            } else {
                assert!((hit.w - hit.height).abs() < 1e-9, "{hit:?}");
            }
            assert!((0.0..1.0).contains(&hit.u) && (0.0..=1.0).contains(&hit.v));
        }
    }
}

#[test]
fn no_ray_inside_the_inner_outline_slips_through() {
    let image = HeightImage::from_fn(64, 32, bark);
    let relief = |u: f64, v: f64| image.sample(u, v);
    let mut random = SplitMix64::new(5);
    for view in 0..64 {
        let radii = [0.2, 0.17, 0.15, 0.12, 0.09];
        let bend = random.range(0.0, 60f64.to_radians());
        let joints = chain(&mut random, &radii, bend);
        let (join, ends) = ALL[view % 4];
        let skin = settings(join, ends);
        let thickness = ShellThickness::Relative(0.25);
        let plain = ReferenceScene::new(&joints, skin);
        let scene = ReliefScene::new(&joints, skin, &relief, thickness);
        let mut rays = 0;
        while rays < 40 {
            let (origin, dir) = ray(&mut random, &joints, 0.1);
            let Some(inner) = plain.cast(origin, dir, 0.0) else {
                continue;
            };
            let hit = scene.cast(origin, dir, 0.0);
            assert!(
                hit.is_some_and(|hit| hit.t <= inner.t + 1e-9),
                "view {view}: {inner:?} {hit:?}"
            );
            rays += 1;
        }
    }
}

#[test]
fn a_branch_with_relief_starts_inside_its_parent() {
    let joint = |x: f64, y: f64, radius: f64, parent| ReferenceJoint {
        position: DVec3::new(x, y, 0.0),
        radius,
        parent,
    };
    let joints = [
        joint(0.0, 0.0, 0.3, None),
        joint(0.0, 1.0, 0.3, Some(0)),
        joint(0.0, 2.0, 0.25, Some(1)),
        joint(1.0, 1.6, 0.1, Some(1)),
    ];
    let relief = bark;
    let scene = ReliefScene::new(
        &joints,
        ReferenceSettings::default(),
        &relief,
        ShellThickness::Relative(0.2),
    );
    let mut random = SplitMix64::new(6);
    let mut seen = [0; 4];
    for _ in 0..2000 {
        let (origin, dir) = ray(&mut random, &joints, 0.3);
        if let Some(hit) = scene.cast(origin, dir, 0.0) {
            seen[hit.segment] += 1;
            // The branch's start is a wall that the parent hides.
            assert!(hit.segment != 3 || hit.part != ReliefPart::Wall, "{hit:?}");
        }
    }
    assert!(seen[1] > 100 && seen[2] > 100 && seen[3] > 50, "{seen:?}");
}

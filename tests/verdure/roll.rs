//! A segment that is turned about its own axis takes its texture along, and that of what hangs on it.

use core::f32::consts::{PI, TAU};

use bevy::prelude::*;
use bevy_verdure::lab::{Figures, Lens, Shot, Studio};
use bevy_verdure::prelude::*;

const SIZE: UVec2 = UVec2::new(128, 128);

/// Where the second segment points at rest, and the third, which goes on in line.
const ALONG: Vec3 = Vec3::new(0.3, 0.7, 0.1);

fn skeleton() -> Skeleton {
    let mut limb = Skeleton::builder();
    let base = limb.root(Vec3::ZERO, 0.25);
    let bend = Vec3::new(0.0, 0.8, 0.0);
    let joints = [
        (bend, 0.22),
        (bend + ALONG, 0.2),
        (bend + 2.0 * ALONG, 0.18),
    ];
    limb.chain(base, &joints);
    limb.build().unwrap()
}

/// The turn of the second segment: it swings aside, and rolls.
fn turn(roll: f32) -> Quat {
    let axis = ALONG.normalize();
    let swing = Quat::from_axis_angle(axis.any_orthonormal_vector(), 0.3);
    swing * Quat::from_axis_angle(axis, roll)
}

fn measure(studio: &mut Studio) -> Figures {
    studio.measure(&Shot {
        eye: Vec3::new(0.2, 1.2, 5.0),
        at: Vec3::new(0.2, 1.2, 0.0),
        lens: Lens::Perspective(0.6),
        size: SIZE,
    })
}

/// Checks that by a roll of the second segment u falls by as much there and on the third, and nowhere else.
fn check(before: &Figures, after: &Figures, roll: f32) {
    let mut seen = [0; 4];
    for (x, y) in (0..SIZE.y).flat_map(|y| (0..SIZE.x).map(move |x| (x, y))) {
        let (Some(before), Some(after)) = (before.get(x, y), after.get(x, y)) else {
            continue;
        };
        if before.segment != after.segment {
            continue;
        }
        seen[after.segment as usize] += 1;
        let expected = if after.segment >= 2 { -roll / TAU } else { 0.0 };
        let off = after.uv.x - before.uv.x - expected;
        // Where u begins is kept to 5e-5 radians, before and after; the rest is roundings.
        assert!(
            (off - off.round()).abs() < 1e-4,
            "{x},{y} of segment {}: u goes from {} to {}",
            after.segment,
            before.uv.x,
            after.uv.x
        );
    }
    assert!(seen[1..].iter().all(|seen| *seen > 100), "{seen:?}");
}

#[test]
fn a_rotation_about_a_segments_own_axis_turns_its_texture() {
    let mut studio = Studio::default();
    let plant = studio.plant(skeleton(), Frusta::default(), Transform::IDENTITY);
    let mut pose = |roll: f32| {
        let rotations = vec![Quat::IDENTITY, Quat::IDENTITY, turn(roll)];
        let mut plant = studio.world().entity_mut(plant);
        plant.insert(SkeletonPose { rotations });
        measure(&mut studio)
    };
    let before = pose(0.0);
    for roll in [0.5, -1.7, PI] {
        check(&before, &pose(roll), roll);
    }
    // And back again.
    check(&before, &pose(0.0), 0.0);
}

#[test]
fn a_segment_entity_turned_about_its_own_axis_turns_its_texture() {
    let mut studio = Studio::default();
    let plant = studio.plant(skeleton(), Frusta::default(), Transform::IDENTITY);
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    studio.headless.step();
    let segments = studio.world().get::<SegmentEntities>(plant).unwrap();
    let segment = segments.get(2).unwrap();
    let mut pose = |roll: f32| {
        let mut transform = studio.world().get_mut::<Transform>(segment).unwrap();
        transform.rotation = turn(roll);
        measure(&mut studio)
    };
    let before = pose(0.0);
    check(&before, &pose(0.9), 0.9);
}

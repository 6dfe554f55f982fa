//! The criteria of §4.1 against what rays see: they predict where gaps begin, and how deep one sees.

use bevy::math::Vec3;
use glam::{DVec3, UVec3};

use super::volume;
use crate::texel::build::{VolumeSettings, from_implicit};
use crate::texel::criteria::{choose_direction, gap_ratio, tan_view_angle};
use crate::texel::{ReferenceVolume, SliceAxis, SliceSet, silent};

use super::super::{march_slices, march_voxels};

/// Rays of each kind.
const SAMPLES: u32 = 1000;

/// Upright walls across u, as thick as `e` voxels of 32, from the bottom to the top.
fn walls(e: u32) -> ReferenceVolume {
    volume(UVec3::new(32, 4, 32), |at| (4..4 + e).contains(&at.x))
}

/// Rays that go down at an angle from w towards u and enter the wall from its side, at heights all over the distance of
/// two slices: the share that no slice stops before they leave it. None if the wall is passed in no such place.
fn gaps(set: &SliceSet, thickness: f64, a: f64) -> Option<f64> {
    let dir = DVec3::new(a.tan(), 0.0, -1.0);
    let h = 1.0 / f64::from(set.count);
    // How far down a ray goes within the wall; between the first slice and the last.
    let drop = thickness / a.tan();
    let lowest = drop + 0.5 * h;
    if lowest + h > 1.0 - 0.5 * h {
        return None;
    }
    let missed = (0..SAMPLES).filter(|&i| {
        let z = lowest + h * (f64::from(i) + 0.5) / f64::from(SAMPLES);
        let enters = DVec3::new(4.0 / 32.0, 0.3, z);
        march_slices(set, enters, dir, [0.0, drop]).is_none()
    });
    Some(missed.count() as f64 / f64::from(SAMPLES))
}

#[test]
fn gaps_begin_where_the_criterion_says() {
    let mut counted = 0;
    for e in [3, 5, 8, 12] {
        let volume = walls(e);
        let thickness = e as f32 / 32.0;
        // What is measured is no more, so that it does not promise too much.
        let measured = volume.thickness().along(SliceAxis::W);
        assert!(
            measured <= thickness && measured >= 0.6 * thickness,
            "{measured}"
        );
        for count in [4, 8, 16, 32] {
            let h = volume.slice_distance(SliceAxis::W, count);
            let set = SliceSet::new(&volume, SliceAxis::W, count);
            for ratio in [0.3, 0.5, 0.7, 0.9, 0.999, 1.05, 1.2, 1.5, 2.0, 3.0, 10.0] {
                let tan_a = ratio * thickness / h;
                let Some(found) = gaps(&set, thickness.into(), f64::from(tan_a).atan()) else {
                    continue;
                };
                assert!((gap_ratio(h, tan_a, thickness) - ratio).abs() < 1e-5);
                // Of a step aside of h·tan(a) the wall covers e. One sample more or less at the ends of both.
                let expected = (1.0 - 1.0 / f64::from(ratio)).max(0.0);
                let bound = if ratio < 1.0 {
                    0.0
                } else {
                    2.0 / f64::from(SAMPLES)
                };
                assert!(
                    (found - expected).abs() <= bound,
                    "{e} {count} {ratio}: {found}"
                );
                counted += 1;
            }
        }
    }
    assert!(counted > 100, "{counted}");
}

#[test]
fn one_sees_no_deeper_than_a_step_aside() {
    let volume = walls(12);
    for (count, degrees) in [(32, 40.0f64), (16, 30.0), (8, 20.0)] {
        let a = degrees.to_radians();
        let set = SliceSet::new(&volume, SliceAxis::W, count);
        let step = f64::from(volume.slice_distance(SliceAxis::W, count)) * a.tan();
        let dir = DVec3::new(a.tan(), 0.0, -1.0);
        let mut deepest: f64 = 0.0;
        for i in 0..2000 {
            let origin = DVec3::new(f64::from(i) / 2000.0, 0.3, 0.5) - dir;
            let hit = march_voxels(&volume, origin, dir, [0.0, 2.0]);
            let seen = march_slices(&set, origin, dir, [0.0, 2.0]);
            let (Some(hit), Some(seen)) = (hit, seen) else {
                continue;
            };
            // Both in the same wall, entered from its side.
            let within =
                (0.5 / f64::from(count)..1.0 - 1.0 / f64::from(count)).contains(&hit.uvw.z);
            if within && seen.uvw.z > 0.0 && (seen.uvw.x - hit.uvw.x) < 12.0 / 32.0 {
                deepest = deepest.max(seen.uvw.x - hit.uvw.x);
            }
        }
        assert!(deepest <= step + 1e-9, "{count}: {deepest} {step}");
        // And nearly as deep somewhere.
        assert!(deepest > 0.9 * step, "{count}: {deepest} {step}");
    }
}

#[test]
fn three_directions_leave_fewer_holes_in_a_ball_than_one() {
    let settings = VolumeSettings::new(UVec3::splat(32));
    let ball = |at: Vec3| 0.4 / at.distance(Vec3::splat(0.5)).max(1e-3);
    let volume = from_implicit(ball, |at| at, &settings, &silent)
        .unwrap()
        .volume;
    let sets = SliceAxis::ALL.map(|axis| SliceSet::new(&volume, axis, 16));
    let centre = DVec3::splat(0.5);
    let holes = |set: &SliceSet, dir: DVec3| {
        // Rays that pass well within the ball.
        let (right, up) = dir.any_orthonormal_pair();
        let rays = (0..900).map(|i| {
            (
                f64::from(i % 30) / 29.0 - 0.5,
                f64::from(i / 30) / 29.0 - 0.5,
            )
        });
        let within = rays.filter(|&(x, y)| x.hypot(y) < 0.33);
        within
            .filter(|&(x, y)| {
                let origin = centre + right * x + up * y - dir * 0.6;
                march_slices(set, origin, dir, [0.0, 1.2]).is_none()
            })
            .count()
    };
    let mut grazing = 0;
    for i in 0..60 {
        let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / 60.0;
        let turn = f64::from(i) * 2.4;
        let dir = DVec3::new(
            turn.cos() * (1.0 - z * z).sqrt(),
            turn.sin() * (1.0 - z * z).sqrt(),
            z,
        );
        let c = dir.as_vec3();
        let best = choose_direction([c.x, c.y, c.z], [1.0 / 16.0; 3]);
        // At most √2 from the normal of the best direction, at a sixteenth: far less than the ball is thick.
        assert!(tan_view_angle(c[best]) <= 2f32.sqrt() + 1e-5);
        assert_eq!(holes(&sets[best], dir), 0, "{dir}");
        grazing += holes(&sets[2], dir);
    }
    assert!(grazing > 0, "slices along w alone gape at grazing views");
}

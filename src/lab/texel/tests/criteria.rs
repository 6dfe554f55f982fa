//! The choice of a direction (§4.2) against what rays see. What the criteria predict is tested where it is charted, in
//! `lab::limits::texels`.

use bevy::math::Vec3;
use glam::{DVec3, UVec3};

use crate::texel::build::{VolumeSettings, from_implicit};
use crate::texel::criteria::{choose_direction, tan_view_angle};
use crate::texel::{SliceAxis, SliceSet, silent};

use super::super::march_slices;

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

//! Roll: what a rotation turns a segment about its own axis.

use bevy::math::{Affine3A, Vec3};

/// Greatest tangent of half a roll that counts as none: 2e-5 radians are less than the GPU's records hold of where a
/// texture begins.
const LEAST: f32 = 1e-5;

/// The turn of `local` about `along`, by the right hand, in radians: the twist of its rotation, once the swing, which
/// takes the axis the shortest way to where it goes, is taken off.
#[inline]
pub(crate) fn about(along: Vec3, local: &Affine3A) -> f32 {
    let [x, y, z] = local.matrix3.to_cols_array_2d();
    // A rotation's quaternion, times 4w.
    let vector = Vec3::new(y[2] - z[1], z[0] - x[2], x[1] - y[0]);
    let scalar = 1.0 + x[0] + y[1] + z[2];
    let turned = vector.dot(along);
    let scale = local.matrix3.x_axis.length_squared();
    let is_none = turned * turned <= LEAST * LEAST * scalar * scalar * along.length_squared();
    // Of a segment that is scaled, or turned by half a circle, those are not good enough.
    if is_none && scalar > 0.01 && (scale - 1.0).abs() < 0.01 {
        return 0.0;
    }
    let (_, rotation, _) = local.to_scale_rotation_translation();
    let along = along.normalize_or_zero();
    let sine = rotation.xyz().dot(along) * rotation.w.signum();
    let roll = 2.0 * sine.atan2(rotation.w.abs());
    // A segment that is scaled to nothing has no rotation.
    if roll.is_finite() { roll } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Quat;
    use core::f32::consts::{PI, TAU};

    #[test]
    fn roll_is_what_is_left_of_a_rotation_without_its_swing() {
        let along = Vec3::new(0.3, -0.5, 0.2);
        for scale in [1.0, 0.4, 3.0] {
            for to in [along, Vec3::X, Vec3::new(-0.2, 0.4, 0.3), Vec3::NEG_Z] {
                let swing = Quat::from_rotation_arc(along.normalize(), to.normalize());
                for roll in [0.0, 1e-3, 0.8, -2.5, PI, 4.0] {
                    let rotation = swing * Quat::from_axis_angle(along.normalize(), roll);
                    let local = Affine3A::from_scale_rotation_translation(
                        Vec3::splat(scale),
                        rotation,
                        Vec3::ONE,
                    );
                    let off = (about(along, &local) - roll).rem_euclid(TAU);
                    // Some tens of roundings of numbers up to 4, over the cosine of half the swing, at least 0.3.
                    assert!(
                        off.min(TAU - off) < 1e-4,
                        "{roll} about {along} on the way to {to}: {off} off"
                    );
                }
            }
        }
    }

    #[test]
    fn a_swing_alone_has_none_and_neither_has_what_is_no_rotation() {
        for angle in [0.0, 0.1, 1.0, 2.5] {
            let swing = Affine3A::from_rotation_x(angle);
            assert_eq!(about(Vec3::Y, &swing), 0.0);
        }
        assert_eq!(about(Vec3::Y, &Affine3A::from_scale(Vec3::ZERO)), 0.0);
        assert_eq!(about(Vec3::ZERO, &Affine3A::from_rotation_x(PI)), 0.0);
    }
}

//! Roll: what a rotation turns a segment about its own axis.

use bevy::math::{Affine3A, Vec2, Vec3};

/// Greatest tangent of half a roll that counts as none: 2e-5 radians are less than the GPU's records hold of where a
/// texture begins.
const LEAST: f32 = 1e-5;

/// The turn of `local` about `along`, by the right hand, as cosine and sine: the twist of its rotation, once the swing,
/// which takes the axis the shortest way to where it goes, is taken off. `None` where there is none to speak of.
#[inline]
pub(crate) fn about(along: Vec3, local: &Affine3A) -> Option<Vec2> {
    let m = &local.matrix3;
    // Times 4w, the vector part of the rotation's quaternion along the axis, and w itself.
    let vector = Vec3::new(
        m.y_axis.z - m.z_axis.y,
        m.z_axis.x - m.x_axis.z,
        m.x_axis.y - m.y_axis.x,
    )
    .dot(along);
    let scalar = 1.0 + m.x_axis.x + m.y_axis.y + m.z_axis.z;
    // Near half a turn w says nothing, and what is scaled is more than a rotation.
    if scalar < 0.01 || (m.x_axis.length_squared() - 1.0).abs() > 1e-4 {
        return about_with_care(along, local);
    }
    let length_squared = along.length_squared();
    if vector * vector <= LEAST * LEAST * scalar * scalar * length_squared {
        return None;
    }
    Some(doubled(scalar, vector / length_squared.sqrt()))
}

#[cold]
fn about_with_care(along: Vec3, local: &Affine3A) -> Option<Vec2> {
    let (_, rotation, _) = local.to_scale_rotation_translation();
    let roll = doubled(rotation.w, rotation.xyz().dot(along.normalize_or_zero()));
    // A segment that is scaled to nothing has no rotation.
    roll.is_finite().then_some(roll)
}

/// Cosine and sine of twice the angle whose cosine and sine are as these.
#[inline]
fn doubled(cosine: f32, sine: f32) -> Vec2 {
    let (c, s) = (cosine * cosine, sine * sine);
    Vec2::new(c - s, 2.0 * cosine * sine) / (c + s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::math::Quat;
    use core::f32::consts::PI;

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
                    let found = about(along, &local).unwrap_or(Vec2::X);
                    // Some tens of roundings, over the cosine of half the swing, at least 0.3, squared.
                    assert!(
                        found.distance(Vec2::from_angle(roll)) < 1e-4,
                        "{roll} about {along} on the way to {to}: {found}"
                    );
                }
            }
        }
    }

    #[test]
    fn a_swing_alone_has_none_and_neither_has_what_is_no_rotation() {
        for angle in [0.0, 0.1, 1.0, 2.5] {
            let swing = Affine3A::from_rotation_x(angle);
            assert_eq!(about(Vec3::Y, &swing), None);
        }
        assert_eq!(about(Vec3::Y, &Affine3A::from_scale(Vec3::ZERO)), None);
        assert_eq!(about(Vec3::ZERO, &Affine3A::from_rotation_x(1.0)), None);
    }
}

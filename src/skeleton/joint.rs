//! Joints: the points of a skeleton, each with a radius.

use bevy::math::Vec3;
use bevy::prelude::{Reflect, ReflectDeserialize, ReflectSerialize};
use serde::{Deserialize, Serialize};

use super::error::SkeletonError;

/// Largest size of a joint's coordinate, in metres: 1000 km.
///
/// At this distance neighbouring `f32` numbers are already 6 cm apart; it bounds arithmetic, not taste.
pub const MAX_COORDINATE: f32 = 1.0e6;

/// Largest radius of a joint, in metres: 100 km.
pub const MAX_RADIUS: f32 = 1.0e5;

/// A point of a [`Skeleton`](super::Skeleton) with a radius, and the joint that it grows from.
///
/// The line from the parent to the joint is a segment; a joint without parent is a root, ends no
/// segment, and there may be any number of roots. A segment may have no length.
///
/// The fields are free to edit; [`Skeleton::new`](super::Skeleton::new) checks the ranges given here and
/// refuses what is outside them.
#[derive(Clone, Debug, PartialEq, Reflect, Serialize, Deserialize)]
#[reflect(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Joint {
    /// Where the joint is, in metres, in the plant's local space (y up). Each coordinate is finite and
    /// at most [`MAX_COORDINATE`] in size.
    pub position: Vec3,
    /// Radius, in metres, of the sphere round the joint that the cones of all its segments touch. Greater
    /// than 0, at most [`MAX_RADIUS`].
    pub radius: f32,
    /// Index of the joint that this one grows from; `None` for a root.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub parent: Option<u32>,
    /// Angle, in radians, added to the texture coordinate u along the segment that ends here. Finite;
    /// without effect on a root.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub twist: f32,
    /// Metres covered by one repeat of the texture along v, on the segment that ends here. Finite and
    /// greater than 0. `None` takes the parent's; a root's is then 1 m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub texture_length: Option<f32>,
}

impl Joint {
    /// A joint without parent, at `position` (metres, the plant's local space) with `radius` (metres).
    pub const fn root(position: Vec3, radius: f32) -> Self {
        Self {
            position,
            radius,
            parent: None,
            twist: 0.0,
            texture_length: None,
        }
    }

    /// A joint that grows from the joint of index `parent`, at `position` (metres, the plant's local
    /// space) with `radius` (metres).
    pub const fn new(position: Vec3, radius: f32, parent: u32) -> Self {
        Self {
            position,
            radius,
            parent: Some(parent),
            twist: 0.0,
            texture_length: None,
        }
    }

    /// The same joint with another [`twist`](Self::twist), in radians.
    #[must_use]
    pub const fn with_twist(mut self, twist: f32) -> Self {
        self.twist = twist;
        self
    }

    /// The same joint with another [`texture_length`](Self::texture_length), in metres.
    #[must_use]
    pub const fn with_texture_length(mut self, metres: f32) -> Self {
        self.texture_length = Some(metres);
        self
    }

    /// Checks every number of the joint of this `index` against its range.
    pub(super) fn validate(&self, index: u32) -> Result<(), SkeletonError> {
        // Written so that NaN, which compares false with everything, fails.
        let position = self.position;
        if !(position.abs().max_element() <= MAX_COORDINATE && position.is_finite()) {
            return Err(SkeletonError::Position {
                joint: index,
                position,
            });
        }
        if !(self.radius > 0.0 && self.radius <= MAX_RADIUS) {
            return Err(SkeletonError::Radius {
                joint: index,
                radius: self.radius,
            });
        }
        if !self.twist.is_finite() {
            return Err(SkeletonError::Twist {
                joint: index,
                twist: self.twist,
            });
        }
        match self.texture_length {
            Some(metres) if !(metres > 0.0 && metres.is_finite()) => {
                Err(SkeletonError::TextureLength {
                    joint: index,
                    metres,
                })
            }
            _ => Ok(()),
        }
    }
}

fn is_zero(number: &f32) -> bool {
    *number == 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_at_the_limits_of_its_ranges_is_valid() {
        let joint = Joint::new(Vec3::splat(-MAX_COORDINATE), MAX_RADIUS, 0)
            .with_twist(-40.0)
            .with_texture_length(f32::MIN_POSITIVE);
        assert_eq!(joint.validate(1), Ok(()));
    }

    #[test]
    fn positions_outside_the_range_are_refused_in_each_coordinate() {
        for bad in [
            f32::NAN,
            f32::INFINITY,
            f32::NEG_INFINITY,
            1.000_001e6,
            -2.0e6,
        ] {
            for axis in 0..3 {
                let mut position = Vec3::ONE;
                position[axis] = bad;
                assert!(
                    matches!(
                        Joint::root(position, 1.0).validate(7),
                        Err(SkeletonError::Position { joint: 7, .. })
                    ),
                    "{bad} as coordinate {axis}"
                );
            }
        }
    }

    #[test]
    fn radii_that_are_not_positive_and_bounded_are_refused() {
        for bad in [0.0, -0.0, -1.0, f32::NAN, f32::INFINITY, 1.000_001e5] {
            assert!(
                matches!(
                    Joint::root(Vec3::ZERO, bad).validate(3),
                    Err(SkeletonError::Radius { joint: 3, .. })
                ),
                "radius {bad}"
            );
        }
    }

    #[test]
    fn twist_is_finite_and_texture_length_is_finite_and_positive() {
        let joint = Joint::root(Vec3::ZERO, 1.0);
        for bad in [f32::NAN, f32::INFINITY] {
            let twisted = joint.clone().with_twist(bad);
            assert!(matches!(
                twisted.validate(0),
                Err(SkeletonError::Twist { .. })
            ));
        }
        for bad in [f32::NAN, f32::INFINITY, 0.0, -1.0] {
            let textured = joint.clone().with_texture_length(bad);
            assert!(matches!(
                textured.validate(0),
                Err(SkeletonError::TextureLength { .. })
            ));
        }
    }
}

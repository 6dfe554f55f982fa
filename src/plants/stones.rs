//! Stones: a few boulders and pebbles.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::dice::Dice;
use super::shape::{GOLDEN_ANGLE, heading, mix, within};
use super::{Plant, Surface};
use crate::skeleton::Skeleton;

/// Stones that lie together: one segment each ([`Surface::Stone`]), a short frustum between two spheres, sunk into
/// the ground by up to two thirds of its radius. 5 by default, 500 at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Stones {
    /// Stones; 1 to 500.
    pub count: u32,
    /// Radius of the largest, in metres; 0.005 to 10. The last is a fifth of it.
    pub size: f32,
    /// Radius of the place that they lie in, in metres; 0 to 100.
    pub radius: f32,
}

impl Default for Stones {
    fn default() -> Self {
        Self {
            count: 5,
            size: 0.22,
            radius: 0.6,
        }
    }
}

impl Stones {
    /// Lays stones. Values outside their ranges are brought into them, and those that are not finite replaced by the
    /// default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let size = within(self.size, 0.005, 10.0, normal.size);
        let radius = within(self.radius, 0.0, 100.0, normal.radius);
        let count = self.count.clamp(1, 500);
        let mut dice = Dice::new(seed);
        let mut plant = Skeleton::builder();
        let first = dice.angle();
        for i in 0..count {
            // The largest lies in the middle.
            let out = (i as f32 / count as f32).sqrt();
            let big = size * mix(1.0, 0.2, out) * dice.between(0.8, 1.0);
            let small = big * dice.between(0.5, 0.85);
            let place =
                heading(first + GOLDEN_ANGLE * i as f32) * (radius * out * dice.between(0.8, 1.0));
            let along = heading(dice.angle()) * (big * dice.between(0.55, 1.0));
            let root = plant.root(place + Vec3::Y * (big * dice.between(0.35, 0.55)), big);
            plant.texture_length(root, TAU * big);
            plant.joint(root, place + along + Vec3::Y * (small * 0.4), small);
        }
        Plant::default().with(Surface::Stone, plant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{ODD, ODD_COUNTS, is_sound};

    #[test]
    fn there_are_as_many_stones_as_asked_for() {
        assert_eq!(Stones::default().grow(3).segment_count(), 5);
        assert_eq!(Stones::default().grow(3), Stones::default().grow(3));
        assert_ne!(Stones::default().grow(3), Stones::default().grow(4));
        for count in ODD_COUNTS {
            let stones = Stones {
                count,
                ..Stones::default()
            };
            assert_eq!(stones.grow(2).segment_count(), count.clamp(1, 500) as usize);
        }
    }

    #[test]
    fn they_are_sunk_by_two_thirds_of_their_radius_at_most() {
        for seed in 0..9 {
            for part in Stones::default().grow(seed).parts {
                for stone in part.skeleton.joints() {
                    assert!(stone.position.y - stone.radius >= -0.66 * stone.radius);
                }
            }
        }
    }

    #[test]
    fn any_parameters_lay_stones() {
        for size in ODD {
            for radius in ODD {
                is_sound(
                    &Stones {
                        count: 7,
                        size,
                        radius,
                    }
                    .grow(1),
                    7,
                );
            }
        }
    }
}

//! Barrel cactus: a squat, ribbed cylinder (*Ferocactus*).

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::dice::Dice;
use super::shape::{heading, within};
use super::{Plant, Surface};
use crate::skeleton::Skeleton;

/// Joints: height, from 0 at the ground to 1 where the dome begins, and radius.
const PROFILE: [(f32, f32); 5] = [
    (0.0, 0.86),
    (0.25, 0.97),
    (0.6, 1.0),
    (0.85, 0.985),
    (1.0, 0.93),
];

/// A barrel cactus: four segments, [`Surface::BarrelCactusSkin`]. It leans a little to one side, as they do towards
/// the sun.
#[derive(Clone, Debug, PartialEq)]
pub struct BarrelCactus {
    /// Height, in metres; 0.03 to 4, and at least 2.2 times the radius.
    pub height: f32,
    /// Radius at its widest, in metres; 0.01 to 1.
    pub radius: f32,
}

impl Default for BarrelCactus {
    fn default() -> Self {
        Self {
            height: 0.62,
            radius: 0.22,
        }
    }
}

impl BarrelCactus {
    /// Grows a barrel cactus. Values outside their ranges are brought into them, and those that are not finite
    /// replaced by the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let radius = within(self.radius, 0.01, 1.0, normal.radius);
        let height = within(self.height, 0.03, 4.0, normal.height).max(2.2 * radius);
        let mut dice = Dice::new(seed);
        let lean = heading(dice.angle()) * dice.between(0.02, 0.1);
        let dome = height - radius * PROFILE[4].1;
        let mut plant = Skeleton::builder();
        let joints = PROFILE.map(|(h, r)| ((Vec3::Y + lean * h) * (h * dome), radius * r));
        let root = plant.root(joints[0].0, joints[0].1);
        plant.texture_length(root, TAU * radius);
        plant.chain(root, &joints[1..]);
        Plant::default().with(Surface::BarrelCactusSkin, plant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{ODD, is_sound, keeps_promises, top};

    #[test]
    fn a_barrel_cactus_has_4_segments() {
        keeps_promises(4, |seed| BarrelCactus::default().grow(seed));
    }

    #[test]
    fn any_parameters_grow_a_barrel_cactus() {
        for height in ODD {
            for radius in ODD {
                is_sound(&BarrelCactus { height, radius }.grow(1), 4);
            }
        }
        assert!((top(&BarrelCactus::default().grow(4)) - 0.62).abs() < 0.03);
    }
}

//! Ocotillo: a spray of long thorny canes (*Fouquieria splendens*).

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::dice::Dice;
use super::shape::{GOLDEN_ANGLE, Tip, heading, mix, raised, turned, within};
use super::{Plant, Surface};
use crate::skeleton::Skeleton;

/// Segments of a cane.
const CANE: u32 = 7;

/// An ocotillo: canes that rise from one foot like an inverted cone and end in red flowers.
///
/// Each cane has seven segments ([`Surface::OcotilloCane`], a tree each) and one of flower
/// ([`Surface::OcotilloFlower`]): 96 by default, 800 at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Ocotillo {
    /// Length of the longest canes, in metres; 0.1 to 10.
    pub height: f32,
    /// Canes; 1 to 100.
    pub canes: u32,
    /// How far the outer canes lean from the vertical, in radians; 0 to 1.2.
    pub spread: f32,
}

impl Default for Ocotillo {
    fn default() -> Self {
        Self {
            height: 3.0,
            canes: 12,
            spread: 0.5,
        }
    }
}

impl Ocotillo {
    /// Grows an ocotillo. Values outside their ranges are brought into them, and those that are not finite replaced
    /// by the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let height = within(self.height, 0.1, 10.0, normal.height);
        let spread = within(self.spread, 0.0, 1.2, normal.spread);
        let canes = self.canes.clamp(1, 100);
        let mut dice = Dice::new(seed);
        let (mut wood, mut flowers) = (Skeleton::builder(), Skeleton::builder());
        let first = dice.angle();
        for i in 0..canes {
            // Even over the disc that the canes' tips make, seen from above.
            let out = ((i as f32 + 0.5) / canes as f32).sqrt();
            let outward = heading(first + GOLDEN_ANGLE * i as f32 + dice.jitter(0.2));
            let thick = height * dice.between(0.0075, 0.0105);
            let length = height * dice.between(0.72, 0.98);
            let aim = raised(outward, 1.57 - spread * out);
            let foot = outward * (height * 0.02 * out);
            let mut tip = Tip::root(&mut wood, foot, thick * 1.5, aim);
            wood.texture_length(tip.joint, TAU * thick * 4.0);
            // Canes go out, up again, and waver.
            for j in 1..=CANE {
                let t = j as f32 / CANE as f32;
                let to = if t < 0.5 { outward } else { Vec3::Y };
                tip.direction = turned(tip.direction, to, dice.between(0.0, 0.11));
                let waver = outward.cross(Vec3::Y) * dice.jitter(1.0).signum();
                tip.direction = turned(tip.direction, waver, dice.between(0.0, 0.05));
                tip.step(&mut wood, length / CANE as f32, thick * mix(1.25, 0.5, t));
            }
            let size = height * dice.between(0.008, 0.012);
            let flower = flowers.root(tip.position, size);
            flowers.texture_length(flower, TAU * size);
            flowers.joint(
                flower,
                tip.position + tip.direction * (size * 7.0),
                size * 0.3,
            );
        }
        Plant::default()
            .with(Surface::OcotilloCane, wood)
            .with(Surface::OcotilloFlower, flowers)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{
        ODD, ODD_COUNTS, is_sound, keeps_promises, stands_on_the_ground, top,
    };

    #[test]
    fn an_ocotillo_has_96_segments() {
        keeps_promises(96, |seed| Ocotillo::default().grow(seed));
    }

    #[test]
    fn any_parameters_grow_an_ocotillo() {
        for x in ODD {
            for canes in ODD_COUNTS {
                for ocotillo in [
                    Ocotillo {
                        height: x,
                        canes,
                        spread: x,
                    },
                    Ocotillo {
                        height: x,
                        ..Ocotillo::default()
                    },
                    Ocotillo {
                        spread: x,
                        ..Ocotillo::default()
                    },
                ] {
                    let plant = ocotillo.grow(1);
                    is_sound(&plant, 800);
                    stands_on_the_ground(&plant, 0.0);
                }
            }
        }
        assert!(top(&Ocotillo::default().grow(4)) < 3.2);
    }
}

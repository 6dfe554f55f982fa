//! Grass: a tussock of blades that arch outwards.

use core::f32::consts::TAU;

use super::dice::Dice;
use super::shape::{GOLDEN_ANGLE, Tip, heading, raised, turned, within};
use super::{Plant, Surface};
use crate::skeleton::Skeleton;

/// Segments of a blade.
const BLADE: u32 = 4;

/// A tussock of grass, or with other numbers reeds: four segments a blade, [`Surface::GrassBlade`], a tree each; 96
/// by default, 8,000 at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Grass {
    /// Length of the longest blades, in metres; 0.02 to 5.
    pub height: f32,
    /// Blades; 1 to 2,000.
    pub blades: u32,
    /// Radius of the tussock at the ground, in metres; 0 to 5.
    pub radius: f32,
    /// How far a blade bends over from foot to tip, in radians; 0 to 1.5.
    pub arch: f32,
}

impl Default for Grass {
    fn default() -> Self {
        Self {
            height: 0.55,
            blades: 24,
            radius: 0.12,
            arch: 0.9,
        }
    }
}

impl Grass {
    /// Grows a tussock. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let height = within(self.height, 0.02, 5.0, normal.height);
        let radius = within(self.radius, 0.0, 5.0, normal.radius);
        let arch = within(self.arch, 0.0, 1.5, normal.arch);
        let blades = self.blades.clamp(1, 2_000);
        let mut dice = Dice::new(seed);
        let mut plant = Skeleton::builder();
        for i in 0..blades {
            let out = ((i as f32 + 0.5) / blades as f32).sqrt();
            let outward = heading(GOLDEN_ANGLE * i as f32 + dice.jitter(0.5));
            let aim = raised(outward, 1.5 - 0.45 * out * dice.between(0.3, 1.0));
            let thick = height * dice.between(0.0065, 0.0105);
            let length = height * dice.between(0.55, 1.0);
            let mut tip = Tip::root(&mut plant, outward * (radius * out), thick, aim);
            plant.texture_length(tip.joint, TAU * thick);
            let bend = arch * dice.between(0.4, 1.0) / (BLADE - 1) as f32;
            for j in 1..=BLADE {
                if j > 1 {
                    // A tip that hangs is one that has bent beyond the horizontal.
                    let over = raised(outward, -0.9);
                    tip.direction = turned(tip.direction, over, bend.min(0.5));
                }
                let thin = [0.95, 0.8, 0.55, 0.1][j as usize - 1];
                tip.step(&mut plant, length / BLADE as f32, thick * thin);
            }
        }
        Plant::default().with(Surface::GrassBlade, plant)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{
        ODD, ODD_COUNTS, is_sound, keeps_promises, stands_on_the_ground, top,
    };

    #[test]
    fn a_tussock_has_96_segments() {
        keeps_promises(96, |seed| Grass::default().grow(seed));
    }

    #[test]
    fn any_parameters_grow_grass() {
        for x in ODD {
            for blades in ODD_COUNTS {
                for grass in [
                    Grass {
                        height: x,
                        blades,
                        radius: x,
                        arch: x,
                    },
                    Grass {
                        height: x,
                        ..Grass::default()
                    },
                    Grass {
                        radius: x,
                        arch: x,
                        ..Grass::default()
                    },
                ] {
                    let plant = grass.grow(1);
                    is_sound(&plant, 8_000);
                    stands_on_the_ground(&plant, 0.0);
                }
            }
        }
        assert!(top(&Grass::default().grow(4)) <= 0.56);
    }
}

//! Elm: a vase of rising limbs that arch over (*Ulmus americana*), bare as in winter.

mod wood;

use core::f32::consts::TAU;

use bevy::math::Vec3;

use self::wood::{Shoot, Wood};
use crate::plants::dice::Dice;
use crate::plants::shape::{Tip, heading, raised, spread, within};
use crate::plants::{Plant, Surface};
use crate::skeleton::Joint;

/// Segments of the trunk below the fork.
const TRUNK: u32 = 6;
/// Trunk joints at which limbs fork off, the topmost of them.
const FORKS: usize = 3;

/// A bare elm: a short trunk that forks into limbs which rise steeply, arch outwards and end in fine, hanging twigs,
/// the outline of a vase.
///
/// Every shoot is given a number of segments; it spends some on itself and leaves the rest to its side shoots. So the
/// tree has as many segments as asked for: 1,833 by default, 200,000 at most. Radii follow the pipe model (K.
/// Shinozaki et al., *A quantitative analysis of plant form*, 1964): at a fork the powers of the radii add up. All
/// are [`Surface::ElmBark`], one tree of joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Elm {
    /// Height, in metres; 1 to 60.
    pub height: f32,
    /// Main limbs; 2 to 9.
    pub limbs: u32,
    /// Segments; 60 to 200,000.
    pub segments: u32,
    /// Radius of the trunk above its foot, in metres; 0.01 to 3, and at most a tenth of the height.
    pub trunk_radius: f32,
    /// Exponent of the pipe model; 1.8 to 3.5. Two keeps cross-sections (Leonardo), three is Murray's law; larger
    /// ones make limbs thicker.
    pub exponent: f32,
}

impl Default for Elm {
    fn default() -> Self {
        Self {
            height: 17.0,
            limbs: 5,
            segments: 1833,
            trunk_radius: 0.42,
            exponent: 2.3,
        }
    }
}

impl Elm {
    /// Grows an elm. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let height = within(self.height, 1.0, 60.0, normal.height);
        let limbs = self.limbs.clamp(2, 9);
        let segments = self.segments.clamp(60, 200_000);
        let radius = within(self.trunk_radius, 0.01, 3.0, normal.trunk_radius).min(height / 10.0);
        let exponent = within(self.exponent, 1.8, 3.5, normal.exponent);

        let mut dice = Dice::new(seed);
        let mut wood = Wood {
            joints: vec![Joint::root(Vec3::ZERO, 1.0)],
            shoots: Vec::new(),
        };
        let mut tip = Tip {
            joint: 0,
            position: Vec3::ZERO,
            direction: spread(Vec3::Y, dice.between(0.02, 0.07), dice.angle()),
        };
        let mut trunk = vec![tip];
        for j in 0..TRUNK {
            tip.direction = spread(tip.direction, dice.between(0.0, 0.07), dice.angle());
            let short = if j == 0 { 0.8 } else { 1.0 };
            wood.step(&mut tip, height * short * dice.between(0.034, 0.044));
            trunk.push(tip);
        }
        let first = dice.angle();
        let mut left = segments - TRUNK;
        for i in 0..limbs {
            let even = left / (limbs - i);
            let budget = match i + 1 == limbs {
                true => left,
                false => (even as f32 * dice.between(0.85, 1.15)) as u32,
            };
            left -= budget;
            let outward = heading(first + TAU * i as f32 / limbs as f32 + dice.jitter(0.3));
            // One limb keeps to the middle.
            let elevation = if i == 0 {
                1.45
            } else {
                dice.between(1.18, 1.34)
            };
            let fork = trunk[trunk.len() - 1 - i as usize % FORKS];
            wood.shoots.push(Shoot {
                tip: Tip {
                    direction: raised(outward, elevation),
                    ..fork
                },
                outward,
                budget,
                length: height * dice.between(0.72, 0.82),
                order: 0,
            });
        }
        while let Some(shoot) = wood.shoots.pop() {
            wood.grow(&shoot, &mut dice.split());
        }
        Plant::default().with(Surface::ElmBark, wood.finished(height, radius, exponent))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{
        ODD, ODD_COUNTS, is_sound, keeps_promises, stands_on_the_ground, top,
    };

    #[test]
    fn an_elm_has_1833_segments() {
        keeps_promises(1833, |seed| Elm::default().grow(seed));
    }

    #[test]
    fn it_has_as_many_segments_as_asked_for() {
        for segments in [60, 61, 200, 4_999, 30_000] {
            for limbs in [2, 5, 9] {
                let elm = Elm {
                    segments,
                    limbs,
                    ..Elm::default()
                };
                assert_eq!(elm.grow(8).segment_count(), segments as usize);
            }
        }
    }

    #[test]
    fn it_is_as_high_as_asked() {
        for seed in 0..20 {
            let share = top(&Elm::default().grow(seed)) / Elm::default().height;
            assert!((0.999..1.01).contains(&share), "{share}");
        }
    }

    #[test]
    fn any_parameters_grow_an_elm() {
        for x in ODD {
            for n in ODD_COUNTS {
                let normal = Elm::default();
                for elm in [
                    Elm {
                        height: x,
                        limbs: n,
                        segments: 500,
                        trunk_radius: x,
                        exponent: x,
                    },
                    Elm {
                        height: x,
                        segments: n.min(9_999),
                        ..normal.clone()
                    },
                    Elm {
                        trunk_radius: x,
                        ..normal.clone()
                    },
                    Elm {
                        exponent: x,
                        limbs: n,
                        ..normal
                    },
                ] {
                    let plant = elm.grow(9);
                    is_sound(&plant, 10_000);
                    stands_on_the_ground(&plant, 0.0);
                }
            }
        }
        let huge = Elm {
            segments: u32::MAX,
            ..Elm::default()
        };
        assert_eq!(huge.grow(1).segment_count(), 200_000);
    }
}

//! Pine: a straight trunk with whorls of branches, and needles in tufts at the ends of twigs (*Pinus*).

mod branch;
mod needles;

use core::f32::consts::TAU;

use bevy::math::Vec3;

use self::branch::Branch;
use self::needles::{Shoot, needles};
use crate::plants::dice::Dice;
use crate::plants::shape::{GOLDEN_ANGLE, Tip, heading, mix, raised, smooth, within};
use crate::plants::{Plant, Surface};
use crate::skeleton::{Skeleton, SkeletonBuilder};

/// Segments of the trunk below the first whorl.
const FOOT: u32 = 4;
/// Segments of the trunk from a whorl to the next; those above the last are the leader.
const INTERNODE: u32 = 2;

/// A pine: a straight trunk with a whorl of branches for each year, the lower ones longer and drooping with upturned
/// ends, twigs on both sides of them, and needles in bundles of three, thickest towards the ends.
///
/// It has 4 segments of trunk and 2 for each whorl; a branch has 6, and 2 for each of its twigs, of which there are 8
/// at the lowest whorl and fewer higher up; a needle has one: 16,997 by default, 196,000 at most. The parts are
/// [`Surface::PineBark`] (one tree) and [`Surface::PineNeedles`] (a root for each needle).
#[derive(Clone, Debug, PartialEq)]
pub struct Pine {
    /// Height, in metres; 0.5 to 50.
    pub height: f32,
    /// Radius of the trunk above its foot, in metres; 0.01 to 1, and at most a thirtieth of the height.
    pub trunk_radius: f32,
    /// Length of the longest branches, as a share of the height; 0.05 to 0.5.
    pub reach: f32,
    /// Height of the lowest whorl, as a share of the whole; 0.02 to 0.8.
    pub bare: f32,
    /// Whorls of branches; 1 to 60.
    pub whorls: u32,
    /// Branches in a whorl; 1 to 12.
    pub branches: u32,
    /// Needles of the whole tree; 0 to 180,000.
    pub needles: u32,
    /// Length of a needle, in metres; 0.01 to 0.5.
    pub needle_length: f32,
}

impl Default for Pine {
    fn default() -> Self {
        Self {
            height: 7.0,
            trunk_radius: 0.115,
            reach: 0.31,
            bare: 0.13,
            whorls: 16,
            branches: 5,
            needles: 15_651,
            needle_length: 0.205,
        }
    }
}

impl Pine {
    /// Grows a pine. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let height = within(self.height, 0.5, 50.0, normal.height);
        let radius = within(self.trunk_radius, 0.01, 1.0, normal.trunk_radius).min(height / 30.0);
        let reach = within(self.reach, 0.05, 0.5, normal.reach) * height;
        let bare = within(self.bare, 0.02, 0.8, normal.bare) * height;
        let whorls = self.whorls.clamp(1, 60);
        let branches = self.branches.clamp(1, 12);

        let mut dice = Dice::new(seed);
        let mut wood = Skeleton::builder();
        let mut shoots = Vec::new();
        let girth = |y: f32| {
            let h = y / height;
            let foot = 0.45 * (-y / (radius * 2.5)).exp();
            radius * (mix(1.0, 0.06, h.powf(0.85)) + foot)
        };
        let mut tip = Tip::root(&mut wood, Vec3::ZERO, girth(0.0), Vec3::Y);
        wood.texture_length(tip.joint, TAU * radius);
        for _ in 0..FOOT {
            climb(&mut wood, &mut tip, bare / FOOT as f32, &girth, &mut dice);
        }
        // Years get shorter towards the top; the leader counts as one more.
        let year = |i: u32| mix(1.25, 0.75, i as f32 / whorls as f32);
        let years: f32 = (0..=whorls).map(year).sum();
        let mut turn = dice.angle();
        for i in 0..whorls {
            // 0 at the lowest whorl, 1 at the top.
            let age = ((tip.position.y - bare) / (height - bare)).clamp(0.0, 1.0);
            turn += GOLDEN_ANGLE;
            for k in 0..branches {
                let around = turn + TAU * k as f32 / branches as f32 + dice.jitter(0.25);
                let outline = (1.0 - age).powf(0.68) * mix(0.82, 1.0, smooth(0.0, 0.2, age));
                let branch = Branch {
                    outward: heading(around),
                    elevation: mix(-0.14, 0.95, age.powf(1.3)) + dice.jitter(0.1),
                    length: reach * outline.max(0.14) * dice.between(0.82, 1.08),
                    radius: girth(tip.position.y) * mix(0.3, 0.55, age),
                    twigs: 2 + (6.99 * (1.0 - i as f32 / whorls as f32)) as u32,
                    age,
                };
                branch.grow(&mut wood, tip, &mut shoots, &mut dice.split());
            }
            let length = (height - bare) * year(i + 1) / (years - year(0));
            for _ in 0..INTERNODE {
                let foot = tip.position;
                climb(
                    &mut wood,
                    &mut tip,
                    length / INTERNODE as f32,
                    &girth,
                    &mut dice,
                );
                if i + 1 == whorls {
                    shoots.push(Shoot {
                        path: vec![foot, tip.position],
                        radius: girth(tip.position.y),
                    });
                }
            }
        }
        let normal = normal.needle_length;
        let length = within(self.needle_length, 0.01, 0.5, normal);
        let needles = needles(&shoots, self.needles.min(180_000), length, &mut dice);
        Plant::default()
            .with(Surface::PineBark, wood)
            .with(Surface::PineNeedles, needles)
    }
}

/// The trunk grows by a segment of this `length` in metres, straight but for a hand's breadth.
fn climb(
    wood: &mut SkeletonBuilder,
    tip: &mut Tip,
    length: f32,
    girth: &dyn Fn(f32) -> f32,
    dice: &mut Dice,
) {
    let sway = raised(heading(dice.angle()), 1.5);
    tip.direction = (sway - Vec3::new(tip.position.x, 0.0, tip.position.z) * 0.1).normalize();
    // Sway does not cost height.
    let length = length / tip.direction.y;
    tip.step(wood, length, girth(tip.position.y + length));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{
        ODD, ODD_COUNTS, is_sound, keeps_promises, stands_on_the_ground, top,
    };

    #[test]
    fn a_pine_has_16997_segments() {
        keeps_promises(16_997, |seed| Pine::default().grow(seed));
    }

    #[test]
    fn its_top_is_at_the_height_asked_for_but_for_the_last_needles() {
        for (seed, height) in [(1, 3.0), (2, 7.0), (3, 30.0)] {
            let pine = Pine {
                height,
                ..Pine::default()
            };
            let top = top(&pine.grow(seed));
            assert!(top > 0.98 * height && top < 1.06 * height + 0.3, "{top}");
        }
    }

    #[test]
    fn it_has_as_many_needles_as_asked_for() {
        for needles in [1, 2, 100, 20_011] {
            let pine = Pine {
                needles,
                ..Pine::default()
            }
            .grow(4);
            let part = pine.part(Surface::PineNeedles).unwrap();
            assert_eq!(part.segment_count(), needles as usize);
        }
        let bare = Pine {
            needles: 0,
            ..Pine::default()
        }
        .grow(4);
        assert!(bare.part(Surface::PineNeedles).is_none());
    }

    #[test]
    fn any_parameters_grow_a_pine() {
        for x in ODD {
            for n in ODD_COUNTS {
                let normal = Pine {
                    needles: 500,
                    ..Pine::default()
                };
                for pine in [
                    Pine {
                        height: x,
                        trunk_radius: x,
                        reach: x,
                        bare: x,
                        whorls: n,
                        branches: n,
                        needles: n.min(1_000),
                        needle_length: x,
                    },
                    Pine {
                        height: x,
                        ..normal.clone()
                    },
                    Pine {
                        trunk_radius: x,
                        whorls: n,
                        ..normal.clone()
                    },
                    Pine {
                        reach: x,
                        bare: x,
                        branches: n,
                        ..normal.clone()
                    },
                    Pine {
                        needle_length: x,
                        ..normal
                    },
                ] {
                    let plant = pine.grow(9);
                    is_sound(&plant, 196_000);
                    stands_on_the_ground(&plant, 0.0);
                }
            }
        }
    }
}

//! Coconut palm: a leaning, ringed trunk under a crown of feathered fronds (*Cocos nucifera*).

mod frond;

use core::f32::consts::TAU;

use bevy::math::Vec3;

use self::frond::Frond;
use crate::plants::dice::Dice;
use crate::plants::shape::{GOLDEN_ANGLE, Tip, heading, mix, raised, smooth, turned, within};
use crate::plants::{Plant, Surface};
use crate::skeleton::{Skeleton, SkeletonBuilder};

/// Segments of the trunk.
const TRUNK: u32 = 52;
/// Segments of the spear, the frond that has not opened yet.
const SPEAR: u32 = 9;

/// A coconut palm: a slender trunk with a swollen foot that leans and straightens up again, fronds in a spiral from
/// upright to hanging, each a midrib with leaflets on both sides, and a cluster of nuts below them.
///
/// It has 52 segments of trunk and 9 of spear; a frond has 3 of stalk and, for each pair of leaflets, one of midrib
/// and four of leaflets; a nut has two: 3,713 by default, 45,321 at most. The parts are [`Surface::PalmTrunk`] (one
/// tree), [`Surface::PalmLeaf`] (a tree for each frond and each nut's stalk) and [`Surface::Coconut`] (a root for
/// each nut).
#[derive(Clone, Debug, PartialEq)]
pub struct CoconutTree {
    /// Height of the trunk, in metres; 0.5 to 40.
    pub height: f32,
    /// Radius of the trunk halfway up, in metres; 0.02 to 0.5, and at most a twelfth of the height.
    pub trunk_radius: f32,
    /// How far the top of the trunk stands to the side of its foot, as a share of the height; 0 to 0.8.
    pub lean: f32,
    /// Opened fronds; 1 to 60.
    pub fronds: u32,
    /// Length of the longest fronds, in metres; 0.3 to 10.
    pub frond_length: f32,
    /// Pairs of leaflets on a frond; 4 to 150.
    pub leaflets: u32,
    /// Coconuts; 0 to 40.
    pub nuts: u32,
}

impl Default for CoconutTree {
    fn default() -> Self {
        Self {
            height: 9.0,
            trunk_radius: 0.15,
            lean: 0.22,
            fronds: 23,
            frond_length: 4.6,
            leaflets: 31,
            nuts: 9,
        }
    }
}

impl CoconutTree {
    /// Grows a palm. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let height = within(self.height, 0.5, 40.0, normal.height);
        let radius = within(self.trunk_radius, 0.02, 0.5, normal.trunk_radius).min(height / 12.0);
        let lean = within(self.lean, 0.0, 0.8, normal.lean);
        let frond_length = within(self.frond_length, 0.3, 10.0, normal.frond_length);
        let fronds = self.fronds.clamp(1, 60);

        let mut dice = Dice::new(seed);
        let mut wood = Skeleton::builder();
        let crown = trunk(&mut wood, height, radius, lean, &mut dice);

        let mut leaves = Skeleton::builder();
        let first = dice.angle();
        for i in 0..fronds {
            // 0 at the youngest frond, which stands upright, 1 at the oldest.
            let age = (i as f32 + 0.5) / fronds as f32;
            let frond = Frond {
                root: crown.position - crown.direction * (radius * 2.2 * age),
                outward: heading(first + GOLDEN_ANGLE * i as f32 + dice.jitter(0.15)),
                elevation: mix(1.38, -0.35, age.powf(0.9)) + dice.jitter(0.08),
                droop: mix(1.05, 0.95, age) * dice.between(0.85, 1.15),
                length: frond_length
                    * mix(0.72, 1.0, smooth(0.0, 0.3, age))
                    * dice.between(0.9, 1.0),
                thick: radius * 0.3,
                pairs: self.leaflets.clamp(4, 150),
            };
            frond.grow(&mut leaves, &mut dice.split());
        }
        spear(&mut leaves, crown, frond_length * 0.5, radius * 0.22);
        let mut husks = Skeleton::builder();
        for i in 0..self.nuts.min(40) {
            nut(&mut leaves, &mut husks, crown, i, radius, &mut dice);
        }
        Plant::default()
            .with(Surface::PalmTrunk, wood)
            .with(Surface::PalmLeaf, leaves)
            .with(Surface::Coconut, husks)
    }
}

/// Returns the trunk's top.
fn trunk(plant: &mut SkeletonBuilder, height: f32, radius: f32, lean: f32, dice: &mut Dice) -> Tip {
    let aside = heading(dice.angle());
    let across = aside.cross(Vec3::Y) * (height * dice.jitter(0.03));
    // A palm leans from the foot and grows upright at the top: x goes like an S that starts steep.
    let at = |h: f32| {
        let out = lean * (1.55 * h - 0.2 * h * h - 0.35 * h * h * h);
        aside * (out * height) + across * (h * TAU * 0.6).sin() + Vec3::Y * (h * height)
    };
    let girth = |h: f32| {
        // A bole at the foot, thinning over the first tenth; a slight swelling under the crown.
        let foot = 0.95 * (-h * height / (radius * 4.5)).exp();
        1.12 - 0.22 * h + foot + 0.16 * smooth(0.965, 1.0, h)
    };
    let mut tip = Tip::root(plant, Vec3::ZERO, radius * girth(0.0), Vec3::Y);
    plant.texture_length(tip.joint, TAU * radius);
    for j in 1..=TRUNK {
        let h = j as f32 / TRUNK as f32;
        // Scars of fallen fronds ring the trunk.
        let ring = if j % 2 == 0 && j + 2 < TRUNK {
            1.035
        } else {
            1.0
        };
        let position = at(h);
        tip.direction = (position - tip.position).normalize();
        tip.position = position;
        tip.joint = plant.joint(tip.joint, position, radius * girth(h) * ring);
    }
    tip
}

/// The youngest frond, still folded: it stands in the middle of the crown like a spear.
fn spear(plant: &mut SkeletonBuilder, crown: Tip, length: f32, thick: f32) {
    let mut tip = Tip::root(plant, crown.position, thick, crown.direction);
    plant.texture_length(tip.joint, TAU * thick);
    for j in 1..=SPEAR {
        let t = j as f32 / SPEAR as f32;
        tip.step(plant, length / SPEAR as f32, thick * (1.0 - 0.9 * t));
    }
}

/// A nut on its stalk: one segment each.
fn nut(
    stalks: &mut SkeletonBuilder,
    husks: &mut SkeletonBuilder,
    crown: Tip,
    i: u32,
    radius: f32,
    dice: &mut Dice,
) {
    let size = radius * dice.between(0.68, 0.8);
    // Two tiers, the lower one further in.
    let tier = (i % 2) as f32;
    let outward = heading(GOLDEN_ANGLE * i as f32 + dice.jitter(0.2));
    let root = crown.position - crown.direction * (radius * mix(1.2, 2.6, tier));
    let hang = raised(outward, -mix(0.35, 0.75, tier) + dice.jitter(0.15));
    let mut tip = Tip::root(stalks, root, radius * 0.16, hang);
    tip.step(stalks, radius * mix(2.1, 1.9, tier), radius * 0.12);
    let down = turned(hang, Vec3::NEG_Y, 0.5);
    // An egg: two spheres, the blunt one at the stalk.
    let husk = husks.root(tip.position, size);
    husks.texture_length(husk, TAU * size);
    husks.joint(husk, tip.position + down * (size * 0.62), size * 0.76);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{ODD, ODD_COUNTS, is_sound, keeps_promises, stands_on_the_ground};

    #[test]
    fn a_coconut_tree_has_3713_segments() {
        keeps_promises(3713, |seed| CoconutTree::default().grow(seed));
    }

    #[test]
    fn the_trunk_is_as_high_and_leans_as_far_as_asked() {
        for (height, lean) in [(2.0, 0.0), (9.0, 0.22), (30.0, 0.8)] {
            let palm = CoconutTree {
                height,
                lean,
                ..CoconutTree::default()
            }
            .grow(5);
            let trunk = palm.part(Surface::PalmTrunk).unwrap();
            let top = trunk.joints().last().unwrap().position;
            assert!((top.y / height - 1.0).abs() < 1e-4, "{top}");
            // The sway adds three hundredths at most.
            assert!(
                (top.with_y(0.0).length() / height - lean).abs() < 0.031,
                "{top}"
            );
        }
    }

    #[test]
    fn any_parameters_grow_a_palm() {
        for x in ODD {
            for n in ODD_COUNTS {
                let normal = CoconutTree::default();
                for palm in [
                    CoconutTree {
                        height: x,
                        trunk_radius: x,
                        lean: x,
                        fronds: n.min(5),
                        frond_length: x,
                        leaflets: n,
                        nuts: n,
                    },
                    CoconutTree {
                        height: x,
                        fronds: n,
                        leaflets: 4,
                        ..normal.clone()
                    },
                    CoconutTree {
                        trunk_radius: x,
                        lean: x,
                        fronds: 3,
                        ..normal.clone()
                    },
                    CoconutTree {
                        frond_length: x,
                        fronds: 3,
                        nuts: n,
                        ..normal
                    },
                ] {
                    let plant = palm.grow(9);
                    is_sound(&plant, 45_321);
                    stands_on_the_ground(&plant, 0.0);
                }
            }
        }
    }
}

//! Aloe vera: a rosette of fleshy leaves with toothed margins.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::dice::Dice;
use super::shape::{GOLDEN_ANGLE, Tip, heading, mix, raised, turned, within};
use super::{Plant, Surface};
use crate::skeleton::{Skeleton, SkeletonBuilder};

/// Segments of a leaf.
const LEAF: u32 = 6;

/// A stemless aloe, or with other numbers an agave: leaves spiral upwards at the golden angle, the oldest outermost,
/// longest and nearest the ground, and taper to a point; small teeth stand along both margins.
///
/// Two leaf radii of it are below the ground. It has one segment of stem, 6 for each leaf and one for each tooth: 229
/// by default, 897 at most. All are [`Surface::AloeLeaf`].
#[derive(Clone, Debug, PartialEq)]
pub struct Aloe {
    /// Length of the longest leaves, in metres; 0.05 to 2.
    pub leaf_length: f32,
    /// Radius of those leaves at their thickest, in metres; 0.002 to 0.2, and at most a seventh of their length.
    pub leaf_radius: f32,
    /// Leaves; 3 to 64.
    pub leaves: u32,
    /// Teeth on all leaves together, in pairs (an odd one is left out); at most 8 a leaf on average, more on the
    /// outer leaves than on the inner.
    pub teeth: u32,
    /// Elevation of the outermost leaves, in radians above the horizontal; 0 to 1.2.
    pub spread: f32,
}

impl Default for Aloe {
    fn default() -> Self {
        Self {
            leaf_length: 0.52,
            leaf_radius: 0.05,
            leaves: 20,
            teeth: 108,
            spread: 0.5,
        }
    }
}

impl Aloe {
    /// Grows an aloe. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let length = within(self.leaf_length, 0.05, 2.0, normal.leaf_length);
        let radius = within(self.leaf_radius, 0.002, 0.2, normal.leaf_radius).min(length / 7.0);
        let leaves = self.leaves.clamp(3, 64);
        let pairs = (self.teeth / 2).min(4 * leaves);
        let spread = within(self.spread, 0.0, 1.2, normal.spread);

        let mut dice = Dice::new(seed);
        let mut plant = Skeleton::builder();
        let (foot, stem) = (Vec3::Y * (radius * -0.7), Vec3::Y * (radius * 1.1));
        let base = plant.root(foot, radius * 1.15);
        plant.texture_length(base, TAU * radius);
        plant.joint(base, stem, radius * 0.9);

        let first = dice.angle();
        for i in 0..leaves {
            // 0 at the outermost leaf, 1 at the innermost.
            let age = i as f32 / (leaves - 1) as f32;
            let outward = heading(first + GOLDEN_ANGLE * i as f32 + dice.jitter(0.12));
            let leaf = Leaf {
                root: foot.lerp(stem, mix(0.2, 1.0, age)),
                outward,
                elevation: mix(spread, 1.45, age.powf(0.85)) + dice.jitter(0.07),
                length: length * mix(1.0, 0.55, age * age) * dice.between(0.88, 1.0),
                radius: radius * mix(1.0, 0.62, age),
                pairs: pairs_up_to(i + 1, leaves, pairs) - pairs_up_to(i, leaves, pairs),
            };
            leaf.grow(&mut plant, &mut dice);
        }
        Plant::default().with(Surface::AloeLeaf, plant)
    }
}

/// How many of `total` pairs of teeth the first `leaves` of `all` leaves bear: the outer ones more than the inner.
fn pairs_up_to(leaves: u32, all: u32, total: u32) -> u32 {
    let x = leaves as f32 / all as f32;
    (total as f32 * x * (1.6 - 0.6 * x)).round() as u32
}

struct Leaf {
    root: Vec3,
    outward: Vec3,
    elevation: f32,
    length: f32,
    radius: f32,
    pairs: u32,
}

impl Leaf {
    fn grow(&self, plant: &mut SkeletonBuilder, dice: &mut Dice) {
        let curl = dice.between(0.03, 0.1);
        let start = raised(self.outward, self.elevation - 0.06);
        let mut tip = Tip::root(plant, self.root, self.radius * 0.92, start);
        plant.texture_length(tip.joint, TAU * self.radius);
        let mut path = vec![(tip.position, self.radius)];
        for j in 1..=LEAF {
            let t = j as f32 / LEAF as f32;
            // Thickest at a sixth of its length, then almost straight to the tip, with a slight belly.
            let thick = (1.0 - t).powf(0.9) * 1.14;
            let radius = (self.radius * thick.min(1.0)).max(self.radius * 0.03);
            // Leaves sag at the foot and curve up towards the tip.
            tip.direction = turned(tip.direction, Vec3::Y, curl * t * 2.0);
            let length = self.length / LEAF as f32;
            tip.keep_above(0.0, length);
            tip.step(plant, length, radius);
            path.push((tip.position, radius));
        }
        for pair in 0..self.pairs {
            let t = 0.14 + 0.74 * (pair as f32 + 0.5) / self.pairs as f32;
            self.teeth(plant, &path, t * LEAF as f32);
        }
    }

    /// A tooth on each margin, `along` the path in units of its segments.
    fn teeth(&self, plant: &mut SkeletonBuilder, path: &[(Vec3, f32)], along: f32) {
        let j = (along as usize).min(path.len() - 2);
        let ((from, thick), (to, thin)) = (path[j], path[j + 1]);
        let position = from.lerp(to, along.fract());
        let radius = mix(thick, thin, along.fract());
        let direction = (to - from).normalize();
        let side = self.outward.cross(Vec3::Y);
        let upper = side.cross(direction);
        let size = self.radius * 0.05 + radius * 0.13;
        for sign in [-1.0, 1.0] {
            // Margins lie a little above the middle, since the upper side is the flatter.
            let out = (side * sign + upper * 0.35).normalize();
            let foot = plant.root(position + out * (radius - size * 0.4), size * 0.75);
            let point = position + out * (radius + size * 1.7) + direction * size;
            plant.joint(foot, point, size * 0.08);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{
        ODD, ODD_COUNTS, is_sound, keeps_promises, stands_on_the_ground, top,
    };

    #[test]
    fn an_aloe_has_229_segments() {
        keeps_promises(229, |seed| Aloe::default().grow(seed));
    }

    #[test]
    fn it_is_no_higher_than_its_leaves_are_long() {
        for seed in 0..9 {
            let top = top(&Aloe::default().grow(seed));
            assert!((0.3..0.56).contains(&top), "{top}");
        }
    }

    #[test]
    fn teeth_are_shared_out_to_the_last() {
        for (leaves, teeth) in [(3, 0), (3, 24), (7, 19), (64, 512)] {
            let aloe = Aloe {
                leaves,
                teeth,
                ..Aloe::default()
            };
            let expected = 1 + 6 * leaves + teeth / 2 * 2;
            assert_eq!(aloe.grow(1).segment_count(), expected as usize);
        }
    }

    #[test]
    fn any_parameters_grow_an_aloe() {
        for x in ODD {
            for n in ODD_COUNTS {
                let normal = Aloe::default();
                for aloe in [
                    Aloe {
                        leaf_length: x,
                        leaf_radius: x,
                        leaves: n,
                        teeth: n,
                        spread: x,
                    },
                    Aloe {
                        leaf_length: x,
                        ..normal.clone()
                    },
                    Aloe {
                        leaf_radius: x,
                        leaves: n,
                        ..normal.clone()
                    },
                    Aloe {
                        spread: x,
                        teeth: n,
                        ..normal
                    },
                ] {
                    let plant = aloe.grow(9);
                    is_sound(&plant, 897);
                    stands_on_the_ground(&plant, 0.4);
                }
            }
        }
    }
}

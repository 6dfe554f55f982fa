//! A pine's branch, with its twigs.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::needles::Shoot;
use crate::plants::dice::Dice;
use crate::plants::shape::{Tip, mix, raised, smooth, turned};
use crate::skeleton::SkeletonBuilder;

/// Segments of a branch.
const BRANCH: u32 = 6;
/// Segments of a twig.
const TWIG: u32 = 2;

/// A branch that is to grow from the trunk.
pub(super) struct Branch {
    /// Away from the trunk, horizontal.
    pub outward: Vec3,
    /// Where it leaves the trunk, in radians.
    pub elevation: f32,
    /// Metres.
    pub length: f32,
    /// At its foot, in metres.
    pub radius: f32,
    pub twigs: u32,
    /// 0 for the oldest, at the lowest whorl, 1 at the top.
    pub age: f32,
}

impl Branch {
    pub fn grow(
        &self,
        wood: &mut SkeletonBuilder,
        trunk: Tip,
        shoots: &mut Vec<Shoot>,
        dice: &mut Dice,
    ) {
        let mut tip = Tip {
            direction: raised(self.outward, self.elevation),
            ..trunk
        };
        let mut path = vec![tip.position];
        // Old branches sag under their weight, and all turn up at the end.
        let sag = mix(0.30, 0.0, self.age);
        for j in 1..=BRANCH {
            let t = j as f32 / BRANCH as f32;
            let bend = mix(-sag, 0.35, smooth(0.15, 0.95, t)) + dice.jitter(0.06);
            let upright = if bend < 0.0 { Vec3::NEG_Y } else { Vec3::Y };
            if j > 1 {
                tip.direction = turned(tip.direction, upright, bend.abs().min(0.4));
            }
            let veer = dice.jitter(0.12);
            tip.direction = turned(
                tip.direction,
                self.outward.cross(Vec3::Y) * veer.signum(),
                veer.abs(),
            );
            let radius = self.radius * mix(1.0, 0.28, t);
            let length = self.length / BRANCH as f32;
            tip.keep_above(self.radius, length);
            tip.step(wood, length, radius);
            if j == 1 {
                wood.texture_length(tip.joint, TAU * self.radius);
            }
            path.push(tip.position);
            // Twigs in pairs from the third joint to the last but one.
            let pairs = self.twigs.div_ceil(2);
            let Some(pair) = (BRANCH - 1).checked_sub(j).filter(|pair| *pair < pairs) else {
                continue;
            };
            let two = self.twigs - 2 * pair.min(self.twigs / 2);
            for side in 0..two.min(2) {
                let sign = if side == 0 { 1.0 } else { -1.0 };
                self.twig(wood, tip, sign, t, shoots, dice);
            }
        }
        // The end of the branch bears needles as a twig does.
        shoots.push(Shoot {
            path: path.split_off(BRANCH as usize - 2),
            radius: self.radius * 0.3,
        });
    }

    fn twig(
        &self,
        wood: &mut SkeletonBuilder,
        branch: Tip,
        sign: f32,
        t: f32,
        shoots: &mut Vec<Shoot>,
        dice: &mut Dice,
    ) {
        let side = branch
            .direction
            .cross(Vec3::Y)
            .normalize_or(self.outward.cross(Vec3::Y));
        let aside = turned(branch.direction, side * sign, dice.between(0.75, 1.0));
        let mut tip = Tip {
            direction: turned(aside, Vec3::Y, dice.between(-0.1, 0.25).max(0.0)),
            ..branch
        };
        let length = self.length * mix(0.5, 0.3, t) * dice.between(0.8, 1.15);
        let radius = (self.radius * 0.26).max(self.radius * mix(0.4, 0.2, t));
        let mut path = vec![tip.position];
        for j in 1..=TWIG {
            let thin = mix(1.0, 0.5, j as f32 / TWIG as f32);
            tip.keep_above(self.radius, length / TWIG as f32);
            tip.step(wood, length / TWIG as f32, radius * thin);
            if j == 1 {
                wood.texture_length(tip.joint, TAU * radius);
            }
            path.push(tip.position);
            tip.direction = turned(tip.direction, Vec3::Y, dice.between(0.2, 0.4));
        }
        shoots.push(Shoot {
            path,
            radius: radius * 0.5,
        });
    }
}

//! A palm's frond: a midrib that arches, with leaflets on both sides.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use crate::plants::dice::Dice;
use crate::plants::shape::{Tip, mix, raised, smooth, spread, turned};
use crate::skeleton::SkeletonBuilder;

/// Segments of a frond's midrib below its first leaflets.
const STALK: u32 = 3;

/// A frond that is to grow from the crown.
pub(super) struct Frond {
    pub root: Vec3,
    pub outward: Vec3,
    /// Of the stalk, in radians.
    pub elevation: f32,
    /// How far the midrib bends down, in radians from foot to tip.
    pub droop: f32,
    pub length: f32,
    /// Radius of the stalk's foot, in metres.
    pub thick: f32,
    pub pairs: u32,
}

impl Frond {
    pub fn grow(&self, plant: &mut SkeletonBuilder, dice: &mut Dice) {
        let joints = STALK + self.pairs;
        let mut tip = Tip::root(
            plant,
            self.root,
            self.thick,
            raised(self.outward, self.elevation),
        );
        plant.texture_length(tip.joint, TAU * self.thick);
        // A frond is seldom straight seen from above.
        let veer = dice.jitter(0.35) / joints as f32;
        let twist = dice.jitter(0.5);
        for j in 1..=joints {
            let t = j as f32 / joints as f32;
            let swerve = self.outward.cross(Vec3::Y);
            tip.direction = turned(
                tip.direction,
                Vec3::NEG_Y,
                1.6 * self.droop * t.powf(0.6) / joints as f32,
            );
            tip.direction = turned(tip.direction, swerve, veer);
            let length = match j <= STALK {
                true => self.length * 0.18 / STALK as f32,
                false => self.length * 0.82 / self.pairs as f32,
            };
            let radius =
                self.thick * (1.0 - t).powf(1.1).max(0.06) * mix(1.0, 0.62, smooth(0.0, 0.2, t));
            tip.keep_above(self.thick, length);
            tip.step(plant, length, radius);
            if j > STALK {
                self.pair(
                    plant,
                    tip,
                    (j - STALK) as f32 / self.pairs as f32,
                    twist * t,
                    dice,
                );
            }
        }
    }

    /// The leaflets on both sides of the midrib, `t` along the feathered part.
    fn pair(&self, plant: &mut SkeletonBuilder, rib: Tip, t: f32, twist: f32, dice: &mut Dice) {
        let side = rib.direction.cross(Vec3::Y).try_normalize();
        let side = side.unwrap_or_else(|| self.outward.cross(Vec3::Y));
        let upper = side.cross(rib.direction);
        // The longest leaflets stand a third up the frond.
        let length = self.length
            * 0.22
            * (0.42 + 0.58 * smooth(-0.1, 0.3, t))
            * mix(1.0, 0.42, smooth(0.4, 1.0, t));
        let radius = self.length * mix(0.0042, 0.0028, t);
        let forward = mix(0.55, 1.15, t);
        for sign in [-1.0, 1.0] {
            let out = side * sign * twist.cos() + upper * (twist.sin() * sign + 0.28);
            let aim = out.normalize() * forward.cos() + rib.direction * forward.sin();
            let mut leaflet = Tip {
                direction: spread(aim.normalize(), dice.between(0.0, 0.12), dice.angle()),
                ..rib
            };
            let length = length * dice.between(0.9, 1.08);
            leaflet.keep_above(0.0, length * 0.45);
            leaflet.step(plant, length * 0.45, radius);
            leaflet.direction = turned(leaflet.direction, Vec3::NEG_Y, dice.between(0.32, 0.5));
            leaflet.keep_above(0.0, length * 0.55);
            leaflet.step(plant, length * 0.55, radius * 0.2);
        }
    }
}

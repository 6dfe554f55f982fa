//! How an elm's shoots spend their segments, and the pipe model that gives joints their radii.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::TRUNK;
use crate::plants::dice::Dice;
use crate::plants::shape::{GOLDEN_ANGLE, Tip, mix, raised, spread, turned};
use crate::skeleton::{Joint, Skeleton, SkeletonBuilder};

/// Segments of a shoot's own axis, by how many forks lie between it and the trunk; fewer where fewer are left.
const AXIS: [u32; 4] = [15, 8, 5, 4];
/// Fewest segments of a side shoot.
const SHOOT: u32 = 3;

/// An axis that is still to grow.
pub(super) struct Shoot {
    pub tip: Tip,
    /// Away from the trunk, horizontal.
    pub outward: Vec3,
    /// Segments for itself and all its side shoots, at least one.
    pub budget: u32,
    /// Metres.
    pub length: f32,
    /// How many forks lie between it and the trunk.
    pub order: usize,
}

/// The joints so far, without their radii, and what is still to grow from them.
pub(super) struct Wood {
    pub joints: Vec<Joint>,
    pub shoots: Vec<Shoot>,
}

impl Wood {
    pub fn step(&mut self, tip: &mut Tip, length: f32) {
        tip.position += tip.direction * length;
        self.joints.push(Joint::new(tip.position, 1.0, tip.joint));
        tip.joint = self.joints.len() as u32 - 1;
    }

    /// Grows a shoot's own axis, and queues its side shoots.
    pub fn grow(&mut self, shoot: &Shoot, dice: &mut Dice) {
        let order = shoot.order.min(AXIS.len() - 1);
        let own = shoot.budget.min(AXIS[order]);
        // What is left goes to side shoots, one a joint at most; a remainder too small for one lengthens the axis.
        let mut rest = shoot.budget - own;
        let bare = if order == 0 { own / 4 } else { own / 5 };
        let sides = (rest / SHOOT).min(own - bare - 1);
        let own = if sides == 0 { own + rest } else { own };
        rest = if sides == 0 { 0 } else { rest };
        let mut tip = shoot.tip;
        let side_of = dice.angle();
        for j in 1..=own {
            let t = j as f32 / own as f32;
            tip.direction = self.bend(shoot, tip.direction, t, own, dice);
            let length = shoot.length / own as f32 * mix(1.12, 0.88, t);
            tip.keep_above(0.0, length);
            self.step(&mut tip, length);
            // Side shoots stand on the joints below the last.
            let Some(turn) = (own - 1).checked_sub(j).filter(|turn| *turn < sides) else {
                continue;
            };
            // Lower shoots had more years: their shares go down to a half towards the tip.
            let weight = |k: u32| 0.5 + 0.5 * (k + 1) as f32 / sides as f32;
            let below: f32 = (0..=turn).map(weight).sum();
            let share = (rest as f32 * weight(turn) / below * dice.between(0.8, 1.2)) as u32;
            let budget = match turn {
                0 => rest,
                _ => share.clamp(SHOOT, rest - turn * SHOOT),
            };
            rest -= budget;
            let azimuth = side_of + GOLDEN_ANGLE * j as f32 + dice.jitter(0.4);
            let angle = if order == 0 {
                dice.between(0.55, 0.8)
            } else {
                dice.between(0.6, 0.95)
            };
            let direction = spread(tip.direction, angle, azimuth);
            let lift = if order == 0 { Vec3::Y } else { shoot.outward };
            self.shoots.push(Shoot {
                tip: Tip {
                    direction: turned(direction, lift, 0.18),
                    ..tip
                },
                outward: shoot.outward,
                budget,
                length: shoot.length * mix(0.52, 0.34, t) * dice.between(0.8, 1.15),
                order: shoot.order + 1,
            });
        }
    }

    /// The direction of the next segment: limbs rise and arch outwards, fine twigs hang.
    fn bend(&self, shoot: &Shoot, from: Vec3, t: f32, own: u32, dice: &mut Dice) -> Vec3 {
        let wander = spread(from, dice.between(0.0, 0.14), dice.angle());
        let steps = own as f32;
        let (to, angle) = match shoot.order {
            0 => (raised(shoot.outward, -0.1), 2.1 * t * t * t / steps),
            1 => (raised(shoot.outward, -0.5), 1.6 * t / steps),
            _ => (Vec3::NEG_Y, 1.8 * t / steps),
        };
        turned(wander, to, angle.min(0.3))
    }

    /// Gives every joint its radius by the pipe model, that of the trunk being `radius` above its foot, and the tree
    /// its `height`.
    pub fn finished(mut self, height: f32, radius: f32, exponent: f32) -> SkeletonBuilder {
        // Each segment adds a pipe for what it bore itself; the last ones are thin.
        let mut pipes = vec![0.0_f32; self.joints.len()];
        for j in (1..self.joints.len()).rev() {
            pipes[j] = if pipes[j] == 0.0 {
                0.12
            } else {
                pipes[j] + 0.5
            };
            if let Some(parent) = self.joints[j].parent {
                pipes[parent as usize] += pipes[j];
            }
        }
        let unit = radius / pipes[1].powf(1.0 / exponent);
        for (joint, pipes) in self.joints.iter_mut().zip(&pipes) {
            joint.radius = (unit * pipes.powf(1.0 / exponent)).max(radius * 1e-3);
        }
        // Limbs aim for the height; how far their shoots rise beyond is known only now.
        let top = self
            .joints
            .iter()
            .fold(0.0, |top: f32, joint| top.max(joint.position.y));
        for joint in &mut self.joints {
            joint.position *= height / top;
        }
        // A limb leaves the trunk with a collar, and the foot swells into the roots.
        for j in TRUNK as usize + 1..self.joints.len() {
            if let Some(fork) = self.joints[j].parent.filter(|fork| *fork <= TRUNK) {
                self.joints[j].radius = mix(
                    self.joints[j].radius,
                    self.joints[fork as usize].radius,
                    0.5,
                );
            }
        }
        for (j, swell) in [1.34, 1.12, 1.03].into_iter().enumerate() {
            self.joints[j].radius = radius * swell;
        }
        let mut plant = Skeleton::builder();
        for joint in &self.joints {
            let index = match joint.parent {
                None => plant.root(joint.position, joint.radius),
                Some(parent) => plant.joint(parent, joint.position, joint.radius),
            };
            // Square pixels, but for twigs.
            plant.texture_length(index, TAU * joint.radius.clamp(0.05 * radius, radius));
        }
        plant
    }
}

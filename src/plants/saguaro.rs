//! Saguaro: a column with arms (*Carnegiea gigantea*).

use core::f32::consts::{PI, TAU};

use bevy::math::Vec3;

use super::dice::Dice;
use super::shape::{Tip, heading, mix, raised, smooth, within};
use super::{Plant, Surface};
use crate::skeleton::{Skeleton, SkeletonBuilder};

/// Segments of the trunk, its dome included.
const TRUNK: usize = 9;
/// Segments of an arm: one through the trunk's flesh, four round the elbow, one up, one for the dome.
const ARM: usize = 7;
/// Heights of the trunk's joints, from 0 at the ground to 1 where the dome begins; close together where arms grow.
const HEIGHTS: [f32; 7] = [0.0, 0.18, 0.31, 0.41, 0.51, 0.66, 0.83];
/// Joints of the trunk that bear arms, in the order of the arms.
const SHOULDERS: [usize; 4] = [3, 4, 2, 3];

/// A saguaro: a column that is widest a little below the middle, with arms that leave it level, turn upwards and end,
/// like the column, in a dome.
///
/// It has 9 segments and 7 more for each arm: 30 by default, 65 at most. All are
/// [`Surface::SaguaroSkin`], one tree of joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Saguaro {
    /// Height, in metres; 0.5 to 16.
    pub height: f32,
    /// Radius of the trunk at its widest, in metres; 0.03 to 0.5, and at most a ninth of the height.
    pub radius: f32,
    /// Arms; 8 at most.
    pub arms: u32,
}

impl Default for Saguaro {
    fn default() -> Self {
        Self {
            height: 5.2,
            radius: 0.27,
            arms: 3,
        }
    }
}

impl Saguaro {
    /// Grows a saguaro. Values outside their ranges are brought into them, and those that are not finite replaced
    /// by the default's.
    pub fn grow(&self, seed: u64) -> Plant {
        let normal = Self::default();
        let height = within(self.height, 0.5, 16.0, normal.height);
        let radius = within(self.radius, 0.03, 0.5, normal.radius).min(height / 9.0);
        let arms = self.arms.min(8) as usize;
        let mut dice = Dice::new(seed);
        let mut plant = Skeleton::builder();
        let trunk = trunk(&mut plant, height, radius, &mut dice);
        let first = dice.angle();
        for i in 0..arms {
            let turn = TAU * i as f32 / arms as f32;
            let outward = heading(first + turn + dice.jitter(0.9 / arms as f32));
            let shoulder = trunk[SHOULDERS[i % SHOULDERS.len()]];
            arm(&mut plant, shoulder, outward, height, radius, &mut dice);
        }
        Plant::default().with(Surface::SaguaroSkin, plant)
    }
}

/// The trunk's joints, as index and position, from the ground up.
fn trunk(
    plant: &mut SkeletonBuilder,
    height: f32,
    radius: f32,
    dice: &mut Dice,
) -> Vec<(u32, Vec3)> {
    let lean = heading(dice.angle()) * (height * dice.between(0.005, 0.018));
    let sway = dice.angle();
    let at = |y: f32| {
        let h = y / height;
        lean * (h * h + 0.25 * ((h * 2.2 * PI + sway).sin() - sway.sin()) * h) + Vec3::Y * y
    };
    let base = plant.root(Vec3::ZERO, radius * 0.74);
    plant.texture_length(base, TAU * radius);
    let mut joints = vec![(base, Vec3::ZERO)];
    // The dome is the last joint's sphere; those below lead up to its radius without an edge.
    let dome = [(2.5, 0.885), (1.55, 0.845), (0.76, 0.76)];
    let straight = HEIGHTS.len();
    for i in 1..TRUNK + 1 {
        let (y, thick) = match i.checked_sub(straight) {
            Some(k) => (height - radius * dome[k].0, dome[k].1),
            None => {
                let t = HEIGHTS[i];
                let swell = 0.74 + 0.26 * smooth(0.0, 0.4, t) - 0.13 * smooth(0.45, 1.0, t);
                (t * (height - radius * 2.5), swell)
            }
        };
        let (parent, position) = (joints[i - 1].0, at(y));
        joints.push((plant.joint(parent, position, radius * thick), position));
    }
    joints
}

fn arm(
    plant: &mut SkeletonBuilder,
    shoulder: (u32, Vec3),
    outward: Vec3,
    height: f32,
    trunk_radius: f32,
    dice: &mut Dice,
) {
    let (joint, position) = shoulder;
    let r = trunk_radius * dice.between(0.62, 0.76);
    let bend = r * dice.between(0.75, 0.95);
    let out = trunk_radius + r * dice.between(0.5, 1.0);
    // Up to a share of what the trunk has above the shoulder.
    let elbow = position.y + out * 0.1 + bend * 2.95;
    let top = mix(elbow, height, dice.between(0.4, 0.82)).max(elbow + 3.2 * r);
    let rise = top - elbow - r * 1.95;
    let start = dice.between(0.02, 0.16);
    // An arm is constricted where it leaves the trunk. (elevation, length, radius)
    let path: [(f32, f32, f32); ARM] = [
        (start, out, 0.80),
        (start + 0.32, bend, 0.90),
        (start + 0.66, bend, 0.97),
        (start + 1.0, bend, 1.0),
        (1.36, bend, 1.02),
        (1.55, rise, 0.96),
        (1.57, r * 1.15, 0.82),
    ];
    let mut tip = Tip {
        joint,
        position,
        direction: outward,
    };
    for (i, (elevation, length, thick)) in path.into_iter().enumerate() {
        tip.direction = raised(outward, elevation);
        tip.step(plant, length, r * thick);
        if i == 0 {
            plant.texture_length(tip.joint, TAU * r);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::{ODD, ODD_COUNTS, is_sound, keeps_promises, top};

    #[test]
    fn a_saguaro_has_30_segments() {
        keeps_promises(30, |seed| Saguaro::default().grow(seed));
    }

    #[test]
    fn it_is_as_high_as_asked_and_its_arms_are_lower() {
        for (seed, arms) in [(3, 0), (4, 3), (5, 8)] {
            let saguaro = Saguaro {
                arms,
                ..Saguaro::default()
            };
            let top = top(&saguaro.grow(seed));
            assert!((top / saguaro.height - 1.0).abs() < 0.01, "{top}");
        }
    }

    #[test]
    fn any_parameters_grow_a_saguaro() {
        for x in ODD {
            for arms in ODD_COUNTS {
                let normal = Saguaro::default();
                for saguaro in [
                    Saguaro {
                        height: x,
                        radius: x,
                        arms,
                    },
                    Saguaro {
                        height: x,
                        ..normal.clone()
                    },
                    Saguaro {
                        radius: x,
                        ..normal
                    },
                ] {
                    is_sound(&saguaro.grow(9), 65);
                }
            }
        }
    }
}

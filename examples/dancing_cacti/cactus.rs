//! A saguaro: a ribbed trunk, two arms, and a flower on its crown.

use core::f32::consts::TAU;

use bevy::prelude::*;
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;

use super::common::texture::painted;

/// Ribs round a cactus: even, since tufts change from rib to rib.
const RIBS: f32 = 12.0;
/// Petals of a flower; each is a segment.
pub const PETALS: usize = 5;

/// The body of a cactus, and what the dance needs to know of it.
pub struct Cactus {
    pub skeleton: Skeleton,
    /// The joints of the trunk, from the ground up.
    pub trunk: Vec<u32>,
    /// The joints of each arm, from the shoulder.
    pub arms: [Vec<u32>; 2],
    /// Radius of the crown, where the flower sits.
    pub crown: f32,
}

/// A body of `segments` segments, 16 at least: arms of five and four, the rest trunk.
pub fn body(segments: usize, dice: &mut Dice) -> Cactus {
    let trunk_segments = segments - 9;
    let height = dice.between(1.5, 2.3);
    let radius = dice.between(0.15, 0.2);
    let mut plant = Skeleton::builder();
    let base = plant.root(Vec3::ZERO, radius * 0.8);
    // Maps are as long as they are wide.
    plant.texture_length(base, TAU * radius);
    // A saguaro is widest at two fifths of its height and rounded at the top.
    let swell =
        |h: f32| radius * (0.8 + 0.35 * (h * 2.6).min(1.0) - 0.22 * ((h - 0.4) / 0.6).max(0.0));
    let mut trunk = Vec::new();
    let mut last = base;
    for i in 1..=trunk_segments {
        let h = i as f32 / trunk_segments as f32;
        last = plant.joint(last, Vec3::Y * (h * height), swell(h));
        trunk.push(last);
    }
    let heading = dice.between(0.0, TAU);
    let arms = [0, 1].map(|side| {
        let heading = heading + (side as f32 + dice.between(-0.12, 0.12)) * TAU / 2.0;
        let out = Vec3::new(heading.cos(), 0.0, heading.sin());
        // Shoulders are joints, at about 40 and 55 % of the height.
        let shoulder = trunk[(trunk_segments as f32 * (0.32 + 0.2 * side as f32)) as usize];
        let from = Vec3::Y * (height * (shoulder - base) as f32 / trunk_segments as f32);
        let r = radius * dice.between(0.55, 0.68);
        let reach = radius + dice.between(0.16, 0.26);
        let rise = height * dice.between(0.22, 0.34);
        // Out, round a quarter circle, and up.
        let turn = reach * 0.5;
        let (out_to, sin) = (reach - turn, core::f32::consts::FRAC_1_SQRT_2);
        let path = [
            (out_to, 0.0, 0.9),
            (out_to + turn * sin, turn * (1.0 - sin), 0.98),
            (reach, turn, 1.03),
            (reach * 1.02, 0.55 * (turn + rise), 1.02),
            (reach * 1.02, rise, 0.8),
        ];
        let mut joints = Vec::new();
        let mut last = shoulder;
        // The upper arm does without the fourth.
        for (i, (along, up, thick)) in path.into_iter().enumerate() {
            if side == 1 && i == 3 {
                continue;
            }
            last = plant.joint(last, from + out * along + Vec3::Y * up, r * thick);
            joints.push(last);
        }
        joints
    });
    Cactus {
        skeleton: plant.build().expect("the path above is finite"),
        trunk,
        arms,
        crown: swell(1.0),
    }
}

/// A flower of [`PETALS`] petals, opening upwards from its origin.
pub fn flower(size: f32) -> Skeleton {
    let mut plant = Skeleton::builder();
    let base = plant.root(Vec3::ZERO, size * 0.28);
    for i in 0..PETALS {
        let (sin, cos) = (i as f32 / PETALS as f32 * TAU).sin_cos();
        let tip = Vec3::new(cos, 1.05, sin) * size;
        plant.joint(base, tip, size * 0.3);
    }
    plant.build().expect("petals are finite")
}

/// How far a point of the skin stands out, 0 in a groove, 1 on a ridge.
fn ridge(u: f32) -> f32 {
    (0.5 + 0.5 * (u * RIBS * TAU).cos()).sqrt()
}

/// Green skin with pale ridges, dark grooves and tufts of spines.
pub fn skin_color() -> Image {
    painted(256, true, |u, v| {
        let ridge = ridge(u);
        let green = Vec3::new(0.032, 0.085, 0.030).lerp(Vec3::new(0.19, 0.36, 0.125), ridge);
        // Tufts sit on the ridges, fourteen to a repeat, in turn on every second rib.
        let rib = (u * RIBS).round();
        let along = (v * 14.0 + 0.5 * (rib % 2.0)).fract() - 0.5;
        let across = u * RIBS - rib;
        let tuft = 1.0 - ((across * across * 90.0 + along * along * 60.0).sqrt()).min(1.0);
        let color = green.lerp(Vec3::new(0.83, 0.76, 0.52), (tuft * 1.8).min(1.0));
        [color.x, color.y, color.z, 1.0]
    })
}

/// The ribs as a normal map.
pub fn skin_normals() -> Image {
    painted(256, false, |u, _| {
        let slope = (ridge(u + 0.002) - ridge(u - 0.002)) / 0.004 / RIBS;
        let normal = Vec3::new(-slope * 0.42, 0.0, 1.0).normalize() * 0.5 + 0.5;
        [normal.x, normal.y, normal.z, 1.0]
    })
}

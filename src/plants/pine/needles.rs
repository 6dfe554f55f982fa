//! A pine's needles: tufts along young wood.

use core::f32::consts::TAU;

use bevy::math::Vec3;

use crate::plants::dice::Dice;
use crate::plants::shape::{GOLDEN_ANGLE, Tip, mix, spread, turned};
use crate::skeleton::{Skeleton, SkeletonBuilder};

/// Needles that share a sheath.
const BUNDLE: u32 = 3;

/// A stretch of young wood that bears needles.
pub(super) struct Shoot {
    /// Its joints from foot to tip, two at least.
    pub path: Vec<Vec3>,
    /// Its radius, in metres.
    pub radius: f32,
}

impl Shoot {
    fn length(&self) -> f32 {
        let pieces = self.path.windows(2);
        pieces.map(|ends| ends[0].distance(ends[1])).sum()
    }
}

/// `total` needles, `length` metres long, shared out over the shoots by their length.
pub(super) fn needles(
    shoots: &[Shoot],
    total: u32,
    length: f32,
    dice: &mut Dice,
) -> SkeletonBuilder {
    // Needles stand out beyond a shoot's tip, so that the shortest ones bear some too.
    let reach = |shoot: &Shoot| shoot.length() + length;
    let all: f32 = shoots.iter().map(reach).sum();
    let mut plant = Skeleton::builder();
    let (mut sum, mut done) = (0.0, 0);
    for (i, shoot) in shoots.iter().enumerate() {
        sum += reach(shoot);
        let upto = match i + 1 == shoots.len() {
            true => total,
            false => total.min((total as f32 * (sum / all)) as u32),
        };
        let count = upto.saturating_sub(done);
        done += count;
        tuft(&mut plant, shoot, count, length, dice);
    }
    plant
}

/// The needles of a shoot: in bundles, thickest towards its tip, those at the tip pointing ahead.
fn tuft(plant: &mut SkeletonBuilder, shoot: &Shoot, count: u32, length: f32, dice: &mut Dice) {
    let Shoot { path, radius } = shoot;
    let pieces = path.len() - 1;
    let turn = dice.angle();
    for n in 0..count {
        let bundle = n / BUNDLE;
        let along = (bundle as f32 + 0.5) / count.div_ceil(BUNDLE) as f32;
        let along = mix(0.22, 1.0, along.powf(0.6)) * pieces as f32;
        let piece = (along as usize).min(pieces - 1);
        let (from, to) = (path[piece], path[piece + 1]);
        let axis = (to - from).normalize_or(Vec3::Y);
        let azimuth = turn + GOLDEN_ANGLE * bundle as f32;
        let open = mix(1.05, 0.45, along / pieces as f32) + dice.jitter(0.12);
        let bundle = spread(axis, open, azimuth);
        let direction = spread(
            bundle,
            dice.between(0.08, 0.2),
            TAU * n as f32 / BUNDLE as f32,
        );
        let direction = turned(direction, Vec3::Y, 0.12);
        // Rooted on the axis, where it cannot come off.
        let position = from.lerp(to, (along - piece as f32).min(1.0));
        let thick = length * 0.027;
        let mut tip = Tip::root(plant, position, thick.min(radius * 0.9), direction);
        plant.texture_length(tip.joint, length);
        let length = length * dice.between(0.8, 1.1);
        tip.keep_above(0.0, length);
        tip.step(plant, length, thick * 0.3);
    }
}

//! Twigs and leaves of a broadleaf.
//!
//! Boughs run from the limbs out to places spread over the crown, each a chain of spikes; side twigs stand on them, and
//! leaves on both.

use core::f32::consts::TAU;

use bevy::math::{Quat, Vec3};
use bevy::mesh::Mesh;

use super::Broadleaf;
use super::wood::{Limb, Triangles};
use crate::plants::dice::Dice;
use crate::plants::shape::{GOLDEN_ANGLE, mix, spread, turned};

/// Triangles of a twig and of a leaf.
const TWIG: u32 = 3;
const LEAF: u32 = 2;
/// Twigs on a bough, its own spikes and those on its sides.
const BOUGH: u32 = 18;
/// Spikes along a bough.
const SPIKES: u32 = 6;

/// A twig: a spike from its foot to its tip.
#[derive(Clone, Copy)]
struct Twig {
    foot: Vec3,
    tip: Vec3,
    thick: f32,
}

pub(super) fn grow(tree: &Broadleaf, limbs: &[Limb], dice: &mut Dice) -> (Mesh, Mesh) {
    let count = tree.twig_triangles.div_ceil(TWIG);
    let mut twigs = Vec::with_capacity(count as usize);
    let boughs = count.div_ceil(BOUGH);
    for i in 0..boughs {
        let own = BOUGH.min(count - i * BOUGH);
        bough(tree, limbs, (i, boughs), own, &mut twigs, dice);
    }
    let mut wood = Triangles::default();
    for twig in &twigs {
        let sides = TWIG.min(tree.twig_triangles - wood.count());
        spike(&mut wood, twig, sides);
    }
    let mut green = Triangles::default();
    let leaves = tree.leaf_triangles.div_ceil(LEAF);
    for i in 0..leaves {
        // Twigs share the leaves evenly.
        let twig = &twigs[(u64::from(i) * twigs.len() as u64 / u64::from(leaves)) as usize];
        let halves = LEAF.min(tree.leaf_triangles - green.count());
        leaf(&mut green, tree, twig, i, halves, dice);
    }
    (wood.mesh(), green.mesh())
}

/// A bough of `own` twigs, towards the `i`th of all places in the crown.
fn bough(
    tree: &Broadleaf,
    limbs: &[Limb],
    (i, all): (u32, u32),
    own: u32,
    twigs: &mut Vec<Twig>,
    dice: &mut Dice,
) {
    // A spiral over the crown's ellipsoid, in shells: most boughs end near its surface, where light is.
    let y = 1.0 - (2.0 * i as f32 + 1.0) / all as f32;
    let azimuth = GOLDEN_ANGLE * i as f32;
    let level = (1.0 - y * y).max(0.0).sqrt();
    let outward = Vec3::new(level * azimuth.cos(), y, level * azimuth.sin());
    let shell = mix(0.55, 1.0, dice.roll().sqrt());
    let half = Vec3::new(0.5 * tree.width, 0.36 * tree.height, 0.5 * tree.width);
    let centre = Vec3::Y * (0.61 * tree.height);
    // Clumps: the outline bulges and recedes.
    let bulge = 0.9 + 0.1 * (3.0 * azimuth + 4.0 * y).sin() * (1.0 - y.abs());
    let end = centre + outward * half * (shell * bulge * 0.94);
    let (start, thick) = nearest(limbs, end);
    let way = end - start;
    let length = way.length();
    let spikes = SPIKES.min(own);
    let mut place = start;
    let mut direction = turned(way.normalize_or(Vec3::Y), Vec3::Y, 0.5);
    let thick = (thick * 0.5).clamp(0.004 * length, 0.018 * length);
    for j in 0..spikes {
        let left = (spikes - j) as f32;
        direction = turned(direction, (end - place).normalize_or(direction), 1.2 / left);
        let tip = place + direction * (place.distance(end) / left);
        let thick = thick * mix(1.0, 0.3, j as f32 / spikes as f32);
        // A spike reaches a little into the next one, so that the bough is no row of separate thorns.
        twigs.push(Twig {
            foot: place,
            tip: tip + direction * (0.35 * place.distance(tip)),
            thick,
        });
        place = tip;
    }
    let own_spikes = twigs.len() - spikes as usize;
    for j in spikes..own {
        let t = (j - spikes) as f32 / (own - spikes) as f32;
        let at = mix(0.3, 1.0, t) * spikes as f32;
        let on = twigs[own_spikes + (at as usize).min(spikes as usize - 1)];
        let foot = on.foot.lerp(on.tip, (at.fract() * 0.75).min(0.75));
        let axis = (on.tip - on.foot).normalize_or(Vec3::Y);
        let direction = spread(
            axis,
            dice.between(0.6, 1.1),
            GOLDEN_ANGLE * j as f32 + dice.jitter(0.4),
        );
        let reach = (0.075 * tree.width * mix(1.2, 0.7, t)).min(0.6) * dice.between(0.7, 1.2);
        twigs.push(Twig {
            foot,
            tip: foot + direction * reach,
            thick: 0.35 * on.thick,
        });
    }
}

/// The place on a limb that a bough to `end` grows from: the nearest, but one nearer to the trunk for choice.
fn nearest(limbs: &[Limb], end: Vec3) -> (Vec3, f32) {
    const STEPS: u32 = 8;
    let places = limbs
        .iter()
        .flat_map(|limb| (2..=STEPS).map(|j| limb.at(j as f32 / STEPS as f32)));
    let cost = |place: &(Vec3, f32)| {
        // Twigs rise: what is above the end is a way down.
        place.0.distance(end) + 0.8 * (place.0.y - end.y).max(0.0)
    };
    places
        .min_by(|a, b| cost(a).total_cmp(&cost(b)))
        .unwrap_or((Vec3::ZERO, 0.1))
}

/// A three-sided pyramid without its base, of `sides` sides.
fn spike(wood: &mut Triangles, twig: &Twig, sides: u32) {
    let axis = (twig.tip - twig.foot).normalize_or(Vec3::Y);
    let corner = |side: u32| {
        spread(
            axis,
            core::f32::consts::FRAC_PI_2,
            TAU * (side % 3) as f32 / 3.0,
        )
    };
    let color = Vec3::new(0.13, 0.095, 0.06);
    for side in 0..sides {
        let (a, b) = (corner(side), corner(side + 1));
        let positions = [
            twig.foot + a * twig.thick,
            twig.foot + b * twig.thick,
            twig.tip,
        ];
        wood.push(positions, [a, b, (a + b).normalize_or(a)], color);
    }
}

/// A leaf folded along its midrib, of `halves` halves, on a twig.
fn leaf(
    green: &mut Triangles,
    tree: &Broadleaf,
    twig: &Twig,
    i: u32,
    halves: u32,
    dice: &mut Dice,
) {
    let axis = (twig.tip - twig.foot).normalize_or(Vec3::Y);
    let foot = twig.foot.lerp(twig.tip, dice.between(0.35, 1.0));
    // Leaves turn to the light: out of the crown and up, with their faces.
    let centre = Vec3::Y * (0.5 * tree.height);
    let light = ((foot - centre).normalize_or(Vec3::Y) + Vec3::Y * 0.9).normalize_or(Vec3::Y);
    let along = spread(axis, dice.between(0.5, 1.1), GOLDEN_ANGLE * i as f32);
    // The tip hangs a little.
    let along = turned(along, Vec3::NEG_Y, 0.25);
    let face = spread(light, dice.between(0.0, 0.7), dice.angle());
    let side = along
        .cross(face)
        .normalize_or(along.any_orthonormal_vector());
    let face = side.cross(along);
    let length = tree.leaf_length * dice.between(0.75, 1.2);
    let (tip, middle) = (foot + along * length, foot + along * (0.45 * length));
    let shade = dice.between(0.75, 1.25);
    let hue = dice.roll();
    let color = Vec3::new(
        mix(0.075, 0.15, hue),
        mix(0.2, 0.24, hue),
        mix(0.025, 0.03, hue),
    ) * shade;
    for half in 0..halves {
        let sign = if half == 0 { 1.0 } else { -1.0 };
        let edge = middle + (side * sign + face * 0.25) * (0.3 * length);
        let normal = Quat::from_axis_angle(along, -0.25 * sign) * face;
        let mut positions = [foot, edge, tip];
        if half == 1 {
            positions.swap(1, 2);
        }
        green.push(positions, [normal; 3], color);
    }
}

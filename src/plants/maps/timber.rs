//! Sawn timber and rope.

use bevy::math::{Vec2, Vec3};

use super::noise::{Noise, again, slit, unit};
use super::{Paint, ripple};
use crate::plants::shape::smooth;

/// A weathered post: grain that bends round knots, and a few long checks.
pub(super) fn post(uv: Vec2) -> Paint {
    let knots = Noise::new(2, 2, 131).cell(uv, 0.7, Vec2::new(1.0, 2.0));
    let from = knots.offset;
    let distance = from.length();
    let knot = 1.0 - smooth(0.05, 0.13, distance);
    // Grain parts round a knot.
    let part = (-distance * distance * 22.0).exp() * smooth(0.0, 0.1, knots.edge);
    let bent = uv + Vec2::new(-from.x * part * 0.3, 0.0);
    let sway = Vec2::new(Noise::new(3, 2, 132).fractal(uv, 2) * 0.025, 0.0);
    let grain = Noise::new(28, 3, 133).fractal(bent + sway, 2);
    let split = |from: Vec2, id: u32| {
        let open = f32::from(unit(again(id, 5)) < 0.6);
        open * slit(from, id, Vec2::new(0.17, 1.0))
    };
    let check = Noise::new(6, 3, 134).marks(bent + sway, split) * (1.0 - knot);
    let worn = Noise::new(4, 3, 136).fractal(uv, 2);
    let height = 0.74 + 0.14 * grain + 0.12 * worn + 0.1 * knot - 0.62 * check;
    let silver = smooth(-0.4, 0.7, worn + 0.4 * grain);
    let wood = Vec3::new(0.15, 0.093, 0.05).lerp(Vec3::new(0.225, 0.178, 0.125), silver);
    let ring = 0.5 + 0.5 * ripple(distance * 16.0);
    let heart = Vec3::new(0.085, 0.05, 0.028) * (0.8 + 0.4 * ring);
    let color = (wood * (1.0 + 0.35 * grain)).lerp(heart, knot) * (1.0 - 0.75 * check);
    Paint::new(color, height)
}

/// Three strands, laid once round in a map.
pub(super) fn rope(uv: Vec2) -> Paint {
    let strand = (uv.x - uv.y) * 3.0;
    let side = (strand - strand.round()) * 2.0;
    let round = (1.0 - 0.985 * side * side).max(0.0).sqrt();
    // Yarns lie the other way round in a strand: they run along the rope.
    let yarn = ripple(uv.x * 15.0 - uv.y * 3.0);
    let fuzz = Noise::new(12, 12, 141).gradient(uv);
    let height = 0.04 + 0.88 * round + 0.05 * yarn * round + 0.04 * fuzz;
    let hemp = Vec3::new(0.1, 0.068, 0.034).lerp(Vec3::new(0.36, 0.27, 0.155), round);
    Paint::new(hemp * (1.0 + 0.16 * yarn + 0.12 * fuzz), height)
}

//! The barks of pine and elm.

use bevy::math::{Vec2, Vec3};

use super::Paint;
use super::noise::{Noise, again, slit, unit};
use crate::plants::shape::{mix, smooth};

/// Reddish plates that flake off like pieces of a jigsaw puzzle, in deep dark fissures.
pub(super) fn pine(uv: Vec2) -> Paint {
    let warp = Vec2::new(
        Noise::new(10, 7, 31).fractal(uv, 3) * 0.03,
        Noise::new(7, 6, 32).fractal(uv, 3) * 0.04,
    );
    // Plates are more than twice as long as wide, and part more along the trunk than across it.
    let plate = Noise::new(7, 3, 33).cell(uv + warp, 0.9, Vec2::new(1.0, 3.2));
    let crust = smooth(0.04, 0.2, plate.edge);
    let inside = smooth(0.12, 0.4, plate.edge);
    // Flakes lie on one another like contour lines on a map.
    let flaking = 1.4 * Noise::new(8, 6, 34).fractal(uv + warp, 3) + 1.2 * inside;
    let layer = flaking.floor();
    let rim = flaking - layer;
    let step = smooth(0.0, 0.22, rim);
    let level = (layer + step).clamp(-1.0, 3.0);
    let rough = Noise::new(26, 20, 35).fractal(uv, 2);
    let floor = 0.1 + 0.07 * rough;
    let top = 0.64 + 0.1 * unit(plate.id) * inside + 0.1 * level + 0.04 * rough;
    let height = mix(floor, top, crust);

    let fresh = Vec3::new(0.235, 0.1, 0.052);
    let weathered = Vec3::new(0.225, 0.172, 0.138);
    let own = mix(0.5, unit(again(plate.id, 1)), inside);
    let scale = fresh.lerp(weathered, smooth(-0.6, 2.6, level + 1.3 * (own - 0.5)));
    // Thin dark shadows lie along the rims.
    let line = smooth(0.0, 0.1, rim).min(smooth(0.0, 0.05, 1.0 - rim));
    let fissure = Vec3::new(0.042, 0.025, 0.017);
    let color = fissure.lerp(scale * mix(0.55, 1.0, line), smooth(0.03, 0.22, plate.edge));
    Paint::new(color * (1.0 + 0.28 * rough), height)
}

/// Pairs of ridges round an elm.
const RIDGES: f32 = 11.0;

/// Long grey ridges that part and meet again round lens-shaped furrows.
pub(super) fn elm(uv: Vec2) -> Paint {
    // Two families of ridges sway across each other; the higher of the two counts. They sway less than a pitch over a
    // pitch's width, else they would fold.
    let bend = Noise::new(24, 12, 41).gradient(uv) * 0.09;
    let ridge = |seed: u32| {
        let sway = Noise::new(3, 3, seed).fractal(uv, 2) * 0.9 + bend;
        let across = ((uv.x * RIDGES + sway).rem_euclid(1.0) - 0.5).abs() * 2.0;
        // Ridges are narrow here and broad there.
        let broad = 0.14 * Noise::new(9, 6, seed + 50).gradient(uv);
        1.0 - smooth(0.14 + broad, 0.68 + broad, across)
    };
    let (a, b) = (ridge(42), ridge(43));
    // A maximum without a crease.
    let body = 1.0 - (1.0 - a) * (1.0 - b);
    let across = |from: Vec2, id| slit(Vec2::new(from.y, from.x), id, Vec2::new(0.26, 0.95));
    let crack = Noise::new(24, 30, 44).marks(uv + Vec2::Y * (bend * 0.06), across)
        * smooth(0.5, 0.75, Noise::new(7, 7, 45).value(uv))
        * body;
    let fibre = Noise::new(44, 12, 46).gradient(uv);
    let rough = Noise::new(20, 14, 47).fractal(uv, 3);
    let height = 0.05 + 0.82 * body + 0.1 * fibre * body + 0.12 * rough - 0.16 * crack;

    let furrow = Vec3::new(0.048, 0.034, 0.024);
    let ash = Vec3::new(0.205, 0.18, 0.15);
    let flank = Vec3::new(0.12, 0.09, 0.065);
    let shade = smooth(0.05, 0.5, body);
    let color = furrow.lerp(flank.lerp(ash, smooth(0.5, 1.0, body)), shade);
    let moss = smooth(0.2, 0.8, Noise::new(3, 3, 48).fractal(uv, 4));
    let color = color.lerp(Vec3::new(0.1, 0.11, 0.06), 0.35 * moss)
        * (1.0 + 0.3 * fibre + 0.3 * rough)
        * (1.0 - 0.5 * crack);
    Paint::new(color, height)
}

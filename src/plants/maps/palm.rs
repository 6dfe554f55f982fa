//! The coconut palm: trunk and husk.

use bevy::math::{Vec2, Vec3};

use super::noise::{Noise, slit};
use super::{Paint, ripple};
use crate::plants::shape::{mix, smooth};

/// Leaf scars in a map of the trunk: one every 8 cm of a palm 30 cm thick.
const SCARS: f32 = 12.0;

/// Grey bark: each fallen frond left a lip round the trunk, steeper above than below; vertical cracks between.
pub(super) fn trunk(uv: Vec2) -> Paint {
    // Scars are neither level nor evenly spaced, and fade out here and there.
    let wander = Noise::new(2, 6, 11).fractal(uv, 3) * 0.3;
    let spacing = Noise::new(1, 7, 12).value(Vec2::new(0.0, uv.y)) * 0.9;
    // Torn fibres fray the lips.
    let bend = Vec2::new(Noise::new(8, 12, 14).gradient(uv) * 0.012, 0.0);
    let fibre = Noise::new(56, 12, 17).gradient(uv + bend);
    let s = (uv.y * SCARS + wander + spacing + 0.05 * fibre).rem_euclid(1.0);
    let strength = mix(0.5, 1.0, smooth(0.15, 0.6, Noise::new(4, 12, 13).value(uv)));
    let lip = strength * (smooth(0.15, 0.78, s) - smooth(0.8, 0.94, s));
    let groove = strength * (1.0 - smooth(0.0, 0.13, s.min(1.0 - s)));

    let split = |from, id| slit(from, id, Vec2::new(0.2, 0.95));
    let cracked = smooth(0.3, 0.6, Noise::new(5, 6, 16).value(uv));
    let crack = Noise::new(17, 8, 15).marks(uv + bend, split) * cracked * (1.0 - 0.6 * lip);
    let rough = Noise::new(16, 16, 18).fractal(uv, 3);

    let height = 0.62 + 0.36 * lip - 0.26 * groove - 0.42 * crack + 0.05 * fibre + 0.05 * rough;
    let lichen = smooth(0.1, 0.7, Noise::new(5, 5, 19).fractal(uv, 4));
    let bark = Vec3::new(0.165, 0.142, 0.116).lerp(Vec3::new(0.25, 0.23, 0.2), lip);
    let color = bark.lerp(Vec3::new(0.26, 0.255, 0.235), 0.55 * lichen)
        * (1.0 + 0.22 * fibre + 0.2 * rough)
        * (1.0 - 0.6 * groove)
        * (1.0 - 0.75 * crack);
    Paint::new(color, height)
}

/// A husk: smooth, three broad ribs, green going brown in streaks.
pub(super) fn husk(uv: Vec2) -> Paint {
    let streak = Noise::new(12, 2, 21).fractal(uv, 2);
    let patch = Noise::new(3, 3, 22).fractal(uv, 3);
    let fibre = Noise::new(28, 4, 23).gradient(uv);
    let height = 0.58 + 0.34 * ripple(3.0 * uv.x) + 0.08 * streak + 0.06 * fibre;
    let dry = smooth(-0.1, 0.75, 0.6 * patch + 0.5 * streak);
    let color = Vec3::new(0.14, 0.16, 0.042).lerp(Vec3::new(0.2, 0.115, 0.045), dry);
    Paint::new(color * (1.0 + 0.12 * fibre), height)
}

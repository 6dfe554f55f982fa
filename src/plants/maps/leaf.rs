//! Leaves that are too thin for a relief: colour alone.

use bevy::math::{Vec2, Vec3};

use super::noise::Noise;
use super::{Paint, ripple};
use crate::plants::shape::smooth;

/// A palm's leaflet, or stalk: leathery green with fine veins, a yellowish midrib on either side.
pub(super) fn palm(uv: Vec2) -> Paint {
    let rib = smooth(0.86, 0.97, ripple(2.0 * uv.x));
    let vein = Noise::new(24, 1, 161).gradient(uv);
    let patch = Noise::new(3, 2, 162).fractal(uv, 3);
    let green = Vec3::new(0.062, 0.112, 0.022)
        .lerp(Vec3::new(0.125, 0.155, 0.034), smooth(-0.3, 0.8, patch));
    let color = (green * (1.0 + 0.2 * vein)).lerp(Vec3::new(0.22, 0.215, 0.075), 0.6 * rib);
    Paint::flat(color)
}

/// A blade of grass: parallel veins, straw here and there.
pub(super) fn grass(uv: Vec2) -> Paint {
    let vein = ripple(6.0 * uv.x);
    let patch = Noise::new(2, 3, 163).fractal(uv, 2);
    let green =
        Vec3::new(0.075, 0.125, 0.028).lerp(Vec3::new(0.2, 0.19, 0.075), smooth(-0.6, 1.4, patch));
    Paint::flat(green * (1.0 + 0.13 * vein))
}

/// A pine needle, from its sheath to its tip in one map: dark, with pale lines of pores.
pub(super) fn needle(uv: Vec2) -> Paint {
    let pores = smooth(0.3, 1.0, ripple(3.0 * uv.x));
    let green = Vec3::new(0.03, 0.066, 0.022).lerp(Vec3::new(0.055, 0.092, 0.04), pores);
    // The sheath; a tip that grew a little longer than the map is scorched.
    let from_end = (uv.y - uv.y.round()).abs();
    let sheath = 1.0 - smooth(0.02, 0.09, from_end);
    let pale = 0.5 + 0.5 * ripple(uv.y - 0.65);
    let color = green.lerp(Vec3::new(0.085, 0.12, 0.035), 0.5 * pale);
    Paint::flat(color.lerp(Vec3::new(0.11, 0.068, 0.035), sheath))
}

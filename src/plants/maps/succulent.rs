//! Aloe leaves; the canes and flowers of the ocotillo.

use bevy::math::{Vec2, Vec3};

use super::noise::{Noise, again, unit};
use super::{Paint, ripple};
use crate::plants::shape::{mix, smooth};

/// A fleshy leaf: bloomed grey-green, faintly ribbed lengthwise, with pale flecks.
pub(super) fn aloe(uv: Vec2) -> Paint {
    // Flecks are three times as long as wide and stand in loose bands.
    let band = smooth(0.3, 0.6, Noise::new(4, 5, 72).value(uv));
    let fleck = Noise::new(16, 6, 71).marks(uv, |from, id| {
        let size = mix(0.13, 0.27, unit(again(id, 5)));
        let shown = f32::from(unit(again(id, 6)) < 0.8);
        shown * (1.0 - smooth(0.5, 1.0, from.length() / size))
    }) * band;
    let flesh = Noise::new(3, 2, 73).fractal(uv, 3);
    let stripe = Noise::new(20, 2, 74).gradient(uv);
    let height = 0.56 + 0.26 * flesh + 0.26 * stripe + 0.16 * fleck;
    let green =
        Vec3::new(0.098, 0.158, 0.075).lerp(Vec3::new(0.128, 0.182, 0.1), smooth(-0.5, 0.6, flesh));
    let color = (green * (1.0 + 0.1 * stripe)).lerp(Vec3::new(0.3, 0.36, 0.23), 0.75 * fleck);
    Paint::new(color, height)
}

/// Furrows round an ocotillo's cane.
const FURROWS: f32 = 6.0;

/// A cane: green between ridges of grey bark that wind round it, a thorn every few centimetres along each.
pub(super) fn cane(uv: Vec2) -> Paint {
    let sway = Noise::new(2, 3, 81).fractal(uv, 2) * 0.5;
    // Half a turn in a map.
    let across = (uv.x + 0.5 * uv.y) * FURROWS + sway;
    let ridge = across.round();
    let side = (across - ridge).abs() * 2.0;
    let uneven = 0.12 * Noise::new(6, 7, 84).gradient(uv);
    let bark = 1.0 - smooth(0.4 + uneven, 0.9 + uneven, side);

    // Thorns in rows, each a third of a row further on: after half a turn the ridges are in step again.
    let along = uv.y * 8.0 + ridge.rem_euclid(3.0) / 3.0;
    let t = along.rem_euclid(1.0) - 0.5;
    let stout = Vec2::new(side / 0.5, t / 0.22).length();
    let thorn = (1.0 - smooth(0.0, 1.0, stout)).powi(2);
    // A thorn leaves a ridge below itself, the midrib of the leaf that it was.
    let keel = (1.0 - smooth(0.0, 0.35, side)) * smooth(-0.5, 0.0, t) * smooth(0.5, 0.3, t);

    let rough = Noise::new(12, 20, 82).fractal(uv, 2);
    let peel = Noise::new(16, 8, 83).gradient(uv);
    let height = 0.1 + 0.48 * bark + 0.1 * rough * bark + 0.12 * keel + 0.3 * thorn;
    let green = Vec3::new(0.07, 0.088, 0.034);
    let grey = Vec3::new(0.19, 0.172, 0.142) * (1.0 + 0.25 * peel + 0.2 * rough);
    let dark = Vec3::new(0.05, 0.046, 0.034);
    let color = green.lerp(dark, 1.0 - smooth(0.0, 0.25, (side - 0.72).abs()));
    let color = color.lerp(grey, smooth(0.1, 0.7, bark));
    Paint::new(
        color.lerp(Vec3::new(0.27, 0.235, 0.18), 0.85 * thorn),
        height,
    )
}

/// Scarlet tubes, close together, each with a yellowish mouth.
pub(super) fn flower(uv: Vec2) -> Paint {
    let tube = Noise::new(6, 4, 91).cell(uv, 0.6, Vec2::new(1.0, 1.5));
    let body = smooth(0.0, 0.38, tube.edge);
    let mouth = 1.0 - smooth(0.08, 0.26, tube.offset.length());
    let mouth = mouth * smooth(0.0, 0.1, tube.edge);
    let height = 0.1 + 0.84 * body - 0.14 * mouth;
    let shade = mix(0.8, 1.15, unit(tube.id));
    let shade = mix(1.0, shade, smooth(0.0, 0.1, tube.edge));
    let red = Vec3::new(0.16, 0.012, 0.012).lerp(Vec3::new(0.56, 0.045, 0.02), body) * shade;
    let streak = 0.5 + 0.5 * ripple(uv.y * 10.0 + uv.x * 7.0);
    let color = red.lerp(Vec3::new(0.6, 0.24, 0.05), 0.7 * mouth) * (0.92 + 0.08 * streak);
    Paint::new(color, height)
}

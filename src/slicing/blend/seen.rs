//! How the leaves of a slice are lit for an eye above or below, or with the sun behind it: it sees others of them than the
//! eye that they were baked for. `shaders/seen.wgsl` has the same functions by the same names.

use core::f32::consts::FRAC_PI_2;

use bevy::math::{Vec3, Vec3Swizzles};

use crate::slicing::slicing::SlicingShape;

/// By how much of the eye's elevation leaves of upright slices are turned up. 1 would suit leaves that look everywhere, for
/// of them an eye sees the same share at each angle to itself. Most lie flatter, so that an eye above sees more of their
/// tops.
pub const LEAN: f32 = 1.5;

/// By how much of the eye's way down from straight above leaves of the vertical slicing are turned down to it: for the same
/// reason by less than all of it.
pub const LEAN_DOWN: f32 = 0.5;

/// How far nearer to the sun than its slice a leaf is, that an eye sees which looks along the light: this share of the
/// distance between slices, and no more than that of the slicing box.
pub const HOT_SPOT: [f32; 2] = [0.65, 0.13];

/// By how many of those an eye that rises from level to straight above would find the leaves of upright slices nearer to the
/// sun.
pub const TOP_LIGHT: f32 = 2.1;

/// Heights of an eye, as sines of its elevation, between which that goes on: above, the vertical slicing joins in.
pub const HEIGHTS: [f32; 2] = [-0.2, 0.5];

/// The height at which upright slices are as light as their leaves. From lower eyes they are darker.
pub const EVEN_HEIGHT: f32 = 0.19;

/// Where the leaves of a slice look in the mean, that look to its `front` (unit) for an eye there, for an eye in a
/// `direction` (unit): from upright slices up or down, from vertical ones aside to it, from those over a sphere as they were
/// baked.
pub fn leaning(shape: &SlicingShape, front: Vec3, direction: Vec3) -> Vec3 {
    if shape.sphere {
        return front;
    }
    let elevation = direction.y.clamp(-1.0, 1.0).asin();
    if shape.is_upright(front) {
        let rise = (LEAN * elevation).clamp(-FRAC_PI_2, FRAC_PI_2);
        return front * rise.cos() + Vec3::new(0.0, rise.sin(), 0.0);
    }
    let fall = LEAN_DOWN * (FRAC_PI_2 - elevation.abs());
    let level = Vec3::new(direction.x, 0.0, direction.z) / direction.xz().length().max(1e-6);
    front * fall.cos() + level * fall.sin()
}

/// A `normal`, turned as the direction `before` has to be to become the one `after` (both unit, and not opposite).
pub fn turned(normal: Vec3, before: Vec3, after: Vec3) -> Vec3 {
    let half = before + after;
    normal - half * (half.dot(normal) / (1.0 + before.dot(after)))
        + after * (2.0 * before.dot(normal))
}

/// How much nearer to the sun than its slice a leaf is in the mean, in metres, that is seen by an eye in a `direction`
/// (unit, in the crown's space): for slices with a `front` (unit), so far apart (`spacing`), in a box so `deep`; `near` is
/// the cosine between eye and sun.
///
/// Slices hold the leaves of their layers half-way. An eye that looks along the light sees those that the light meets first,
/// the hot spot of canopies (A. Kuusk, *The Hot Spot Effect of a Uniform Vegetative Cover*, 1985); it goes as the square of
/// the cosine. And of upright layers an eye above sees the sunlit leaves on top, but of their slices the same leaves as a
/// level eye. Both are fitted to the light of meshes, for eyes from 30 degrees below to straight above, all round suns 10,
/// 47 and 90 degrees high.
pub fn towards_sun(
    shape: &SlicingShape,
    front: Vec3,
    direction: Vec3,
    near: f32,
    spacing: f32,
    deep: f32,
) -> f32 {
    let mut shift = near.max(0.0) * near.max(0.0);
    if shape.is_upright(front) {
        shift += TOP_LIGHT * (direction.y.clamp(HEIGHTS[0], HEIGHTS[1]) - EVEN_HEIGHT);
    }
    (HOT_SPOT[0] * spacing).min(HOT_SPOT[1] * deep) * shift
}

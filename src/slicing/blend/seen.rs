//! How the leaves of a slice are lit for an eye above or below: it sees others of them than the eye that they were baked for.
//! `shaders/seen.wgsl` has the same functions by the same names.

use core::f32::consts::FRAC_PI_2;

use bevy::math::Vec3;

use crate::slicing::slicing::SlicingShape;

/// By how much of the eye's elevation leaves of upright slices are turned up. 1 would suit leaves that look everywhere, for of
/// them an eye sees the same share at each angle to itself. Most lie flatter, so that an eye above sees more of their tops.
pub const LEAN: f32 = 1.25;

/// How far before a slice the leaves are that an eye straight above sees: this share of the distance between slices, and no more
/// than that of the slicing box.
pub const AHEAD: [f32; 2] = [0.35, 0.12];

/// Where the leaves of a slice look in the mean, that look to its `front` (unit) for an eye there, for an eye in a `direction` (unit):
/// from upright slices up or down, from others as they were baked.
pub fn leaning(shape: &SlicingShape, front: Vec3, direction: Vec3) -> Vec3 {
    if !shape.is_upright(front) {
        return front;
    }
    let rise = (LEAN * direction.y.clamp(-1.0, 1.0).asin()).clamp(-FRAC_PI_2, FRAC_PI_2);
    front * rise.cos() + Vec3::new(0.0, rise.sin(), 0.0)
}

/// A `normal`, turned as the direction `before` has to be to become the one `after` (both unit, and not opposite).
pub fn turned(normal: Vec3, before: Vec3, after: Vec3) -> Vec3 {
    let half = before + after;
    normal - half * (half.dot(normal) / (1.0 + before.dot(after)))
        + after * (2.0 * before.dot(normal))
}

/// How far towards an eye in a `direction` (unit) a slice receives shadows, in metres: slices are so far apart (`spacing`), and their box is
/// so `deep`. An eye above looks from where the sun does, and sees the leaves that the sun reaches first; a level one sees
/// sun and shade. Along its way, which is longer the flatter it meets the slice that looks to a `front` (unit), up to twice.
pub fn ahead(spacing: f32, deep: f32, front: Vec3, direction: Vec3) -> f32 {
    let most = (AHEAD[0] * spacing).min(AHEAD[1] * deep);
    most * direction.y.abs() / front.dot(direction).abs().max(0.5)
}

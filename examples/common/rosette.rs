//! The walk through a grove that pictures and times are taken on: past and through it at eye height.

use core::f32::consts::TAU;

use bevy::math::Vec3;

/// Frames of the walk, as many as the slicing paper's.
pub const FRAMES: usize = 2600;
/// Height of the eye, in metres.
const EYE: f32 = 1.7;

/// The eye of a frame, and what it looks at: a rosette that leads round a grove of so many metres' radius and three times
/// through it.
pub fn view(grove: f32, frame: usize) -> (Vec3, Vec3) {
    let radius = grove + 8.0;
    let place = |t: f32| {
        let reach = radius * (0.62 + 0.38 * (3.0 * t).cos());
        Vec3::new(reach * t.cos(), EYE, reach * t.sin())
    };
    let t = TAU * frame as f32 / FRAMES as f32;
    let eye = place(t);
    // Ahead, and a little towards the middle of the grove, where the trees are.
    let ahead = (place(t + 0.05) - eye).normalize_or(Vec3::NEG_X);
    let inwards = (Vec3::Y * EYE - eye).normalize_or(Vec3::NEG_X);
    let level = (ahead + 0.9 * inwards).normalize_or(inwards);
    (eye, eye + level + Vec3::Y * 0.12)
}

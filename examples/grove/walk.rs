//! The recorded walk of 2,600 frames, past and through the grove at eye height.

use core::f32::consts::TAU;

use bevy::prelude::*;

use super::common::MainCamera;
use super::trees::radius;

/// Frames of the walk, as many as the paper's.
pub const FRAMES: usize = 2600;
/// Height of the eye, in metres.
const EYE: f32 = 1.7;

/// Where the walk is.
#[derive(Resource, Clone, Copy)]
pub struct Walk {
    /// Which frame.
    pub frame: usize,
    stride: usize,
    /// Radius of the grove, in metres.
    radius: f32,
    /// Whether the eye stands still.
    pub stands: bool,
}

impl Walk {
    pub fn new(trees: u32, frame: usize, stride: usize, stands: bool) -> Self {
        Self {
            frame: frame % FRAMES,
            stride,
            radius: radius(trees) + 8.0,
            stands,
        }
    }

    /// The eye, and what it looks at: a rosette that leads round the grove and three times through it.
    pub fn view(&self) -> (Vec3, Vec3) {
        let place = |t: f32| {
            let reach = self.radius * (0.62 + 0.38 * (3.0 * t).cos());
            Vec3::new(reach * t.cos(), EYE, reach * t.sin())
        };
        let t = TAU * self.frame as f32 / FRAMES as f32;
        let eye = place(t);
        // Ahead, and a little towards the middle of the grove, where the trees are.
        let ahead = (place(t + 0.05) - eye).normalize_or(Vec3::NEG_X);
        let inwards = (Vec3::Y * EYE - eye).normalize_or(Vec3::NEG_X);
        let level = (ahead + 0.9 * inwards).normalize_or(inwards);
        (eye, eye + level + Vec3::Y * 0.12)
    }
}

pub fn go(mut walk: ResMut<Walk>, mut cameras: Query<&mut Transform, With<MainCamera>>) {
    if walk.stands {
        return;
    }
    let (eye, at) = walk.view();
    for mut camera in &mut cameras {
        *camera = Transform::from_translation(eye).looking_at(at, Vec3::Y);
    }
    walk.frame = (walk.frame + walk.stride) % FRAMES;
}

//! Where on the recorded walk the eye is.

use bevy::prelude::*;

use super::common::MainCamera;
use super::rosette::{self, FRAMES};
use super::trees::radius;

/// Where the walk is.
#[derive(Resource, Clone, Copy)]
pub struct Walk {
    /// Which frame.
    pub frame: usize,
    stride: usize,
    /// Radius of the grove, in metres.
    grove: f32,
    /// Whether the eye stands still.
    pub stands: bool,
}

impl Walk {
    pub fn new(trees: u32, frame: usize, stride: usize, stands: bool) -> Self {
        Self {
            frame: frame % FRAMES,
            stride: stride % FRAMES,
            grove: radius(trees),
            stands,
        }
    }

    /// The eye, and what it looks at.
    pub fn view(&self) -> (Vec3, Vec3) {
        rosette::view(self.grove, self.frame)
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

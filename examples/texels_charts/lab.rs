//! What all experiments are told, and how they see a scene.

use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::{TexelScene, TexelStand};
use bevy_verdure::lab::{Lens, Shot};

/// What was asked for.
#[derive(Clone, Copy, Debug)]
pub struct Lab {
    /// Whether to measure less.
    pub quick: bool,
    /// Size of the pictures.
    pub size: UVec2,
}

impl Lab {
    /// A scene, covered.
    pub fn open(&self, scene: TexelScene) -> Result<TexelStand, String> {
        TexelStand::open(scene)
    }

    /// Where the examples see a scene from, so many times as far away.
    pub fn shot(&self, scene: TexelScene, distance: f32) -> Shot {
        let (eye, at) = scene.view();
        Shot {
            eye: at + (eye - at) * distance,
            at,
            // That of Bevy's cameras.
            lens: Lens::Perspective(core::f32::consts::FRAC_PI_4),
            size: self.size,
        }
    }
}

//! Pictures of all slices there are, which others are held against.

use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::{TexelStand, all_slices};
use bevy_verdure::lab::{Lens, Shot, mean_flip};
use bevy_verdure::prelude::*;

/// The criteria with some d, in e, and p, in pixels.
pub fn with(depth: f32, pixels: f32, lighting: PlantLighting) -> TexelSettings {
    TexelSettings {
        quality: TexelQuality {
            depth,
            pixels,
            ..default()
        },
        lighting,
        ..default()
    }
}

/// A picture of all slices, which others are held against.
pub struct Whole {
    shot: Shot,
    slices: usize,
    picture: Vec<u8>,
}

impl Whole {
    /// Of a stand, lit by the scene or in the colours of the volume.
    pub fn of(stand: &mut TexelStand, shot: Shot, lighting: PlantLighting) -> Self {
        let settings = all_slices(lighting);
        stand.set(settings);
        Self {
            slices: stand.count(&shot, &settings).slices,
            picture: stand.photograph(&shot).rgb_bytes(),
            shot,
        }
    }

    /// Mean FLIP of another picture.
    pub fn flip(&self, picture: &[u8]) -> f64 {
        let size = (self.shot.size.x, self.shot.size.y);
        f64::from(mean_flip(size, &self.picture, picture))
    }

    /// How many times fewer slices some settings show, and the mean FLIP of the picture.
    pub fn against(&self, stand: &mut TexelStand, settings: TexelSettings) -> (f64, f64) {
        stand.set(settings);
        let slices = stand.count(&self.shot, &settings).slices;
        let fewer = self.slices as f64 / slices.max(1) as f64;
        let flip = self.flip(&stand.photograph(&self.shot).rgb_bytes());
        let (quality, lighting) = (settings.quality, settings.lighting);
        println!(
            "{lighting:?}, d {} e, p {}: {slices} of {} slices, {fewer:.2} times fewer, FLIP {flip:.4}",
            quality.depth, quality.pixels, self.slices
        );
        (fewer, flip)
    }
}

/// A shot turned aside by so many pixels.
pub fn aside(shot: &Shot, pixels: f32) -> Shot {
    let Lens::Perspective(fov) = shot.lens else {
        return *shot;
    };
    let pixel = 2.0 * (0.5 * fov).tan() / shot.size.y as f32;
    let reach = shot.eye.distance(shot.at);
    Shot {
        at: shot.at + *shot.transform().right() * pixel * pixels * reach,
        ..*shot
    }
}

//! What all experiments are told, and how they see a scene.

use std::path::PathBuf;

use bevy::prelude::*;
use bevy_verdure::lab::texel_scenes::{TexelScene, TexelStand};
use bevy_verdure::lab::{Lens, Shot};

/// What was asked for.
#[derive(Clone, Debug)]
pub struct Lab {
    /// Whether to measure less.
    pub quick: bool,
    /// Size of the pictures.
    pub size: UVec2,
    /// The only scene that is asked for, if one is.
    pub scene: Option<TexelScene>,
    /// Folder for the pictures that are measured, if they are kept.
    pub pictures: Option<PathBuf>,
}

impl Lab {
    /// Keeps a picture of 8-bit sRGB colours, if that was asked for.
    pub fn keep(&self, name: &str, size: UVec2, rgb: &[u8]) -> Result<(), String> {
        let Some(folder) = &self.pictures else {
            return Ok(());
        };
        let path = folder.join(name).with_extension("png");
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("{}: {error}", folder.display()))?;
        image::save_buffer(&path, rgb, size.x, size.y, image::ColorType::Rgb8)
            .map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Whether a scene is asked for.
    pub fn shows(&self, scene: TexelScene) -> bool {
        self.scene.is_none_or(|only| only == scene)
    }

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

//! What each kind of surface looks like.

use bevy::prelude::*;
use bevy_verdure::plants::Surface;

/// The material of a kind of surface.
pub fn look(surface: Surface, _assets: &AssetServer) -> StandardMaterial {
    let color = match surface {
        Surface::PalmTrunk => Color::linear_rgb(0.36, 0.30, 0.23),
        _ => Color::linear_rgb(0.2, 0.33, 0.07),
    };
    StandardMaterial {
        base_color: color,
        perceptual_roughness: 0.9,
        reflectance: 0.2,
        ..default()
    }
}

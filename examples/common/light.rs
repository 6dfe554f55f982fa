//! What lights plants, as an argument.

use bevy_verdure::prelude::PlantLighting;
use clap::ValueEnum;

/// [`PlantLighting`] on the command line.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Light {
    /// By all of the scene's lights, as Bevy lights all else.
    Full,
    /// By directional and ambient light, at less cost.
    Simple,
    /// By nothing.
    Unlit,
}

impl From<Light> for PlantLighting {
    fn from(light: Light) -> Self {
        match light {
            Light::Full => Self::Full,
            Light::Simple => Self::Simple,
            Light::Unlit => Self::Unlit,
        }
    }
}

//! What lights the sparse and the repeated parts of plants, crowns and texels, and the solid ones beside them: as Bevy
//! lights all else, or at less cost.
//!
//! [`PlantLighting::Simple`] (`simple.wgsl`) is right only under directional lights and ambient light. So plants that ask for
//! it are lit in full while the scene has any other light (`scene.rs`). Their wood can be lit alike (`material.rs`). Where a
//! pixel shows many normals, it takes the mean over all of them (`spread.rs`).

mod material;
mod scene;
mod spread;

use bevy::asset::embedded_asset;
use bevy::pbr::MaterialPlugin;
use bevy::prelude::*;
use bevy::shader::load_shader_library;

pub use material::{LitAsPlant, PlantMaterial};
pub(crate) use scene::{SceneLighting, SceneLights};
pub use spread::mean_cosine;

/// What lights a plant. Light is what costs most where many layers are lit, one behind the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum PlantLighting {
    /// As Bevy lights a `StandardMaterial`: every kind of light, environment maps, gloss, filtered shadows.
    Full,
    /// Directional lights with their shadow maps, ambient light and fog. Leaves scatter light evenly, gloss included, as
    /// those of perceptual roughness 0.75 and reflectance 0.3 do in the mean, and shadows are looked up by the shadow map's
    /// own filter of two by two pixels alone.
    ///
    /// While the world has a point, spot or rectangular light, an environment map, an irradiance volume, a light with a
    /// texture or an atmosphere, even a hidden one, such plants are lit as by `Full`.
    #[default]
    Simple,
    /// By nothing: the plant has the colours of its pictures, in fog.
    Unlit,
}

/// A share of light that comes through from behind, in its range: what is below 0 or above 1 is taken for the nearest, and
/// no number for 0.
pub(crate) fn limited_transmission(asked: f32) -> f32 {
    asked.clamp(0.0, 1.0).max(0.0)
}

/// Loads what shaders of all methods light by. Added by each method's plugin that needs it.
pub(crate) struct LightingPlugin;

impl LightingPlugin {
    /// Adds it, unless it is there.
    pub(crate) fn add_to(app: &mut App) {
        if !app.is_plugin_added::<Self>() {
            app.add_plugins(Self);
        }
    }
}

impl Plugin for LightingPlugin {
    fn build(&self, app: &mut App) {
        load_shader_library!(app, "spread.wgsl");
        load_shader_library!(app, "simple.wgsl");
        embedded_asset!(app, "material.wgsl");
        app.add_plugins(MaterialPlugin::<PlantMaterial>::default())
            .register_type::<PlantLighting>()
            .add_systems(PostUpdate, material::follow_lights);
    }
}

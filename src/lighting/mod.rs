//! What lights the sparse and the repeated parts of plants, crowns and texels, and the solid ones beside them: as Bevy lights
//! all else, or at less cost.
//!
//! [`PlantLighting::Simple`] (`simple.wgsl`) is right only under directional lights and ambient light. So plants that ask for
//! it are lit in full while the scene has any other light (`scene.rs`). Their wood can be lit alike (`material.rs`).

mod material;
mod scene;

use bevy::asset::embedded_asset;
use bevy::pbr::MaterialPlugin;
use bevy::prelude::*;
use bevy::shader::load_shader_library;

pub use material::{LitAsPlant, PlantMaterial};
pub(crate) use scene::{SceneLighting, SceneLights};

/// What lights a plant. Light is what costs most where many layers are lit, one behind the other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum PlantLighting {
    /// As Bevy lights a `StandardMaterial`: every kind of light, environment maps, gloss, filtered shadows.
    Full,
    /// Directional lights with their shadow maps, ambient light and fog. Leaves scatter light evenly, gloss included, as those
    /// of perceptual roughness 0.75 and reflectance 0.3 do in the mean, and shadows are looked up by the shadow map's own
    /// filter of two by two pixels alone.
    ///
    /// While the world has a point, spot or rectangular light, an environment map, an irradiance volume, a light with a
    /// texture or an atmosphere, even a hidden one, such plants are lit as by `Full`.
    #[default]
    Simple,
    /// By nothing: the plant has the colours of its pictures, in fog.
    Unlit,
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
        load_shader_library!(app, "simple.wgsl");
        embedded_asset!(app, "material.wgsl");
        app.add_plugins(MaterialPlugin::<PlantMaterial>::default())
            .register_type::<PlantLighting>()
            .add_systems(PostUpdate, material::follow_lights);
    }
}

#[cfg(test)]
mod tests {
    use core::f32::consts::{FRAC_PI_2, PI, TAU};

    /// As the shader has it.
    fn mean_cosine(cosine: f32, spread: f32) -> f32 {
        0.5 * (cosine + (cosine * cosine + 0.25 * spread).sqrt())
    }

    #[test]
    fn one_normal_is_lit_by_its_cosine() {
        for i in -10..=10 {
            let cosine = i as f32 / 10.0;
            assert!((mean_cosine(cosine, 0.0) - cosine.max(0.0)).abs() < 1e-6);
        }
    }

    #[test]
    fn many_normals_are_lit_as_each_of_them_in_the_mean() {
        // Normals spread evenly over caps, up to a whole sphere.
        for half_angle in [0.2, 0.8, FRAC_PI_2, 2.2, PI] {
            let least = f32::cos(half_angle);
            let mean = 0.5 * (1.0 + least);
            for tilt in 0..=12 {
                let (sin, cos) = (tilt as f32 / 12.0 * PI).sin_cos();
                let (mut sum, mut plain) = (0.0, 0.0);
                const STEPS: u32 = 100;
                for i in 0..STEPS * STEPS {
                    // Areas on a sphere go by heights.
                    let z = least + (1.0 - least) * ((i % STEPS) as f32 + 0.5) / STEPS as f32;
                    let turn = ((i / STEPS) as f32 + 0.5) / STEPS as f32 * TAU;
                    let to_light = z * cos + (1.0 - z * z).sqrt() * turn.cos() * sin;
                    sum += to_light.max(0.0);
                    plain += to_light;
                }
                let exact = sum / (STEPS * STEPS) as f32;
                let found = mean_cosine(mean * cos, 1.0 - mean * mean);
                // The mean of |n·l| is at most that far from the root for a half sphere, seen from its top: (√0.4375 − 0.5)/2.
                assert!(
                    (found - exact).abs() < 0.085,
                    "{half_angle} {tilt}: {found} {exact}"
                );
                assert!((plain / (STEPS * STEPS) as f32 - mean * cos).abs() < 0.01);
            }
        }
    }
}

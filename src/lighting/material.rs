//! Wood and other solid parts, lit as crowns and texels are.

use bevy::asset::Asset;
use bevy::mesh::{MeshVertexBufferLayoutRef, UvChannel};
use bevy::pbr::{
    ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline,
    StandardMaterial,
};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, SpecializedMeshPipelineError,
};
use bevy::shader::ShaderRef;

use super::{PlantLighting, SceneLighting, SceneLights};
use crate::pipeline::{define, embedded_shader, names};

/// A `StandardMaterial` whose light is a [`PlantLighting`]: for trunks and other solid parts of a plant, which then are lit
/// as its crown is, at the crown's cost.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// fn bark(mut materials: ResMut<Assets<PlantMaterial>>) -> Handle<PlantMaterial> {
///     materials.add(LitAsPlant::default().over(Color::srgb(0.3, 0.2, 0.1)))
/// }
/// ```
pub type PlantMaterial = ExtendedMaterial<StandardMaterial, LitAsPlant>;

/// What lights a [`PlantMaterial`]. Works where a plugin of this crate is that draws crowns or texels.
///
/// * [`PlantLighting::Full`]: as the `StandardMaterial` alone would be.
/// * [`PlantLighting::Simple`], the default: of the material count the base colour with its texture, vertex colours, the
///   alpha mode, `double_sided` and `diffuse_transmission`; normal maps, gloss and emission do not. Lit in full where the
///   scene has lights that it leaves out, as [`PlantLighting`] has it.
/// * [`PlantLighting::Unlit`]: the same, without light.
///
/// Shadows and prepasses are the `StandardMaterial`'s own. In the deferred pass, light is Bevy's.
#[derive(Asset, AsBindGroup, Clone, Debug, Default, Reflect)]
#[bind_group_data(LitKey)]
pub struct LitAsPlant {
    /// What is asked for.
    pub lighting: PlantLighting,
    #[reflect(ignore)]
    key: LitKey,
}

impl LitAsPlant {
    /// Lit by `lighting`.
    pub fn by(lighting: PlantLighting) -> Self {
        Self {
            lighting,
            key: LitKey::default(),
        }
    }

    /// The material that lights `base` so.
    pub fn over(self, base: impl Into<StandardMaterial>) -> PlantMaterial {
        PlantMaterial {
            base: base.into(),
            extension: self,
        }
    }
}

/// What tells pipelines apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct LitKey {
    scene: SceneLighting,
    /// Whether the base colour has a texture, and whether that is laid out by the second UVs.
    textured: bool,
    second_uvs: bool,
}

impl From<&LitAsPlant> for LitKey {
    fn from(light: &LitAsPlant) -> Self {
        light.key
    }
}

impl LitKey {
    fn new(material: &PlantMaterial, lights: &SceneLights) -> Self {
        let base = &material.base;
        Self {
            scene: if base.unlit {
                PlantLighting::Unlit.into()
            } else {
                lights.lighting(material.extension.lighting)
            },
            textured: base.base_color_texture.is_some(),
            second_uvs: base.base_color_channel == UvChannel::Uv1,
        }
    }
}

impl MaterialExtension for LitAsPlant {
    fn fragment_shader() -> ShaderRef {
        embedded_shader("lighting/material.wgsl")
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let LitKey {
            scene,
            textured,
            second_uvs,
        } = key.bind_group_data;
        let uvs = if second_uvs {
            Mesh::ATTRIBUTE_UV_1
        } else {
            Mesh::ATTRIBUTE_UV_0
        };
        let textured = textured && layout.0.contains(uvs);
        let defs = names([
            (scene.lighting == PlantLighting::Full, "PLANT_FULL_LIGHT"),
            (
                scene.lighting == PlantLighting::Simple,
                "PLANT_SIMPLE_LIGHT",
            ),
            (scene.more_suns, "MORE_SUNS"),
            (textured, "PLANT_TEXTURED"),
            (second_uvs, "PLANT_SECOND_UVS"),
        ]);
        define(descriptor, defs);
        Ok(())
    }
}

/// Follows the scene's lights, and what was changed of materials.
pub(super) fn follow_lights(mut materials: ResMut<Assets<PlantMaterial>>, lights: SceneLights) {
    let stale: Vec<_> = materials
        .iter()
        .map(|(id, material)| (id, LitKey::new(material, &lights), material.extension.key))
        .filter(|(_, new, old)| new != old)
        .collect();
    for (id, new, _) in stale {
        if let Some(mut material) = materials.get_mut(id) {
            material.extension.key = new;
        }
    }
}

//! The material that draws slices, in Bevy's own phases: opaque but for what is discarded.

use bevy::asset::Asset;
use bevy::image::Image;
use bevy::material::OpaqueRendererMethod;
use bevy::math::{Vec3, Vec4};
use bevy::mesh::{MeshVertexBufferLayoutRef, PrimitiveTopology};
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey, MeshPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, BlendState, ColorWrites, CompareFunction, RenderPipelineDescriptor, ShaderType,
    SpecializedMeshPipelineError,
};
use bevy::shader::{ShaderDefVal, ShaderRef};

use super::super::axis::SliceAxis;
use super::super::choose::VolumeMeasure;
use super::bindings::{TEXEL_GROUP, bind_group_layout};
use super::component::TexelSettings;
use super::records::vertex_buffer;
use crate::lighting::{PlantLighting, SceneLighting, limited_transmission};
use crate::pipeline::{define, embedded_shader, names};

/// What the shaders have of a volume and the settings of surfaces.
#[derive(Clone, Copy, Debug, PartialEq, ShaderType)]
pub(crate) struct TexelsUniform {
    lengths: Vec3,
    roughness: f32,
    /// Velocity of the wind, and flexibility.
    pub(crate) wind: Vec4,
    reflectance: f32,
    inner_slices: u32,
    diffuse_transmission: f32,
}

impl TexelsUniform {
    pub(crate) fn new(measure: &VolumeMeasure, settings: &TexelSettings, wind: Vec3) -> Self {
        // What is no number is none.
        let share = |asked: f32| asked.clamp(0.0, 1.0).max(0.0);
        Self {
            lengths: measure.lengths,
            roughness: share(settings.roughness),
            wind: wind.extend(settings.limited_flexibility()),
            reflectance: share(settings.reflectance),
            inner_slices: settings.inner_slices(1, u32::MAX),
            diffuse_transmission: limited_transmission(settings.diffuse_transmission),
        }
    }
}

/// The material of the slices of a volume across one axis, on all surfaces of the same looks. Made by the plugin.
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
#[bind_group_data(TexelKey)]
pub struct TexelMaterial {
    #[uniform(0)]
    pub(crate) texels: TexelsUniform,
    #[texture(1, dimension = "2d_array")]
    #[sampler(3)]
    pub(crate) color: Handle<Image>,
    #[texture(2, dimension = "2d_array")]
    #[sampler(4)]
    pub(crate) normal: Handle<Image>,
    pub(crate) axis: SliceAxis,
    /// What lights them in this scene.
    pub(crate) lighting: SceneLighting,
    /// Whether it is the depth of slices that is drawn, or the colour of those that are seen.
    pub(crate) depth: bool,
}

/// What tells the pipelines of one material from another's.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
pub struct TexelKey {
    axis: u8,
    lighting: SceneLighting,
    depth: bool,
    /// Whether light comes through from behind.
    transmits: bool,
}

impl From<&TexelMaterial> for TexelKey {
    fn from(material: &TexelMaterial) -> Self {
        Self {
            axis: material.axis as u8,
            lighting: material.lighting,
            depth: material.depth,
            transmits: material.texels.diffuse_transmission > 0.0,
        }
    }
}

/// A shader of this folder.
fn shader(name: &str) -> ShaderRef {
    embedded_shader(&format!("texel/draw/shaders/{name}"))
}

impl Material for TexelMaterial {
    fn vertex_shader() -> ShaderRef {
        shader("forward.wgsl")
    }

    fn fragment_shader() -> ShaderRef {
        shader("forward.wgsl")
    }

    fn prepass_vertex_shader() -> ShaderRef {
        shader("prepass.wgsl")
    }

    fn prepass_fragment_shader() -> ShaderRef {
        shader("prepass.wgsl")
    }

    fn alpha_mode(&self) -> AlphaMode {
        // They name the phases: depth among what is opaque, and colour after it. The shader discards.
        if self.depth {
            AlphaMode::Opaque
        } else {
            AlphaMode::Mask(0.5)
        }
    }

    fn opaque_render_method(&self) -> OpaqueRendererMethod {
        // Deferred passes have no shaders here.
        OpaqueRendererMethod::Forward
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        _: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.vertex.buffers = vec![vertex_buffer()];
        // In place of Bevy's meshes, of which the shaders read none.
        descriptor.layout[TEXEL_GROUP] = bind_group_layout();
        descriptor.primitive.topology = PrimitiveTopology::TriangleStrip;
        descriptor.primitive.cull_mode = None;
        let own = key.bind_group_data;
        let lighting = own.lighting.lighting;
        let axis = ShaderDefVal::UInt("TEXEL_AXIS".into(), own.axis.into());
        // The shaders know where four samples lie; with more or fewer, texels have plain outlines.
        let four = descriptor.multisample.count == 4;
        let sun = MeshPipelineKey::UNCLIPPED_DEPTH_ORTHO;
        let is_defined = |name: &str| {
            let mut defs = descriptor.vertex.shader_defs.iter();
            defs.any(|def| *def == ShaderDefVal::from(name))
        };
        let is_main = !is_defined("PREPASS_PIPELINE");
        let has_normals = !own.depth && is_main || is_defined("NORMAL_PREPASS");
        if is_main
            && own.depth
            && let Some(fragment) = &mut descriptor.fragment
        {
            for target in fragment.targets.iter_mut().flatten() {
                target.write_mask = ColorWrites::empty();
            }
        }
        if is_main
            && !own.depth
            && let Some(fragment) = &mut descriptor.fragment
        {
            // What is not there has no alpha.
            for target in fragment.targets.iter_mut().flatten() {
                target.blend = Some(BlendState::ALPHA_BLENDING);
            }
        }
        if is_main
            && !own.depth
            && let Some(depth) = &mut descriptor.depth_stencil
        {
            depth.depth_compare = Some(CompareFunction::Equal);
            depth.depth_write_enabled = Some(false);
        }
        let defs = names([
            (lighting == PlantLighting::Full, "TEXEL_FULL_LIGHT"),
            (lighting == PlantLighting::Simple, "TEXEL_SIMPLE_LIGHT"),
            (own.lighting.more_suns, "MORE_SUNS"),
            (has_normals, "TEXEL_NORMALS"),
            (own.depth, "TEXEL_DEPTH"),
            (is_main && !own.depth, "TEXEL_INNER"),
            (key.mesh_key.contains(sun), "TEXEL_DIRECTIONAL_LIGHT"),
            (four, "TEXEL_FOUR_SAMPLES"),
            // Bevy's full light and the simple one ask for it.
            (own.transmits, "STANDARD_MATERIAL_DIFFUSE_TRANSMISSION"),
        ]);
        define(descriptor, defs.chain([axis]));
        Ok(())
    }
}

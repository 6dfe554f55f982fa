//! The material that draws slices, in Bevy's own phases: opaque but for what is discarded.

use bevy::asset::Asset;
use bevy::image::Image;
use bevy::material::OpaqueRendererMethod;
use bevy::math::{UVec3, Vec3, Vec4};
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey, MeshPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::{ShaderDefVal, ShaderRef};

use super::super::axis::SliceAxis;
use super::super::choose::{DirectionRule, VolumeMeasure};
use super::component::TexelSettings;
use super::slots::ATTRIBUTE_SLOT;
use crate::pipeline::{define, embedded_shader, names};

/// A volume's measures and a surface's settings, as the shaders have them.
#[derive(Clone, Copy, Debug, PartialEq, ShaderType)]
pub(crate) struct TexelsUniform {
    most: UVec3,
    /// 1 by h·tan(a)/e, 2 where changes fade.
    flags: u32,
    lengths: Vec3,
    depth: f32,
    thickness: Vec3,
    pixels: f32,
    roughness: f32,
    reflectance: f32,
    shadow_depth: f32,
    shadow_pixels: f32,
    /// Velocity of the wind, and flexibility.
    pub(crate) wind: Vec4,
}

impl TexelsUniform {
    pub(crate) fn new(measure: &VolumeMeasure, settings: &TexelSettings, wind: Vec3) -> Self {
        let quality = &settings.quality;
        Self {
            most: measure.most,
            flags: u32::from(quality.direction == DirectionRule::Quality)
                | u32::from(settings.fade) << 1,
            lengths: measure.lengths,
            depth: quality.depth,
            thickness: measure.thickness.narrowest,
            pixels: quality.pixels,
            roughness: settings.roughness,
            reflectance: settings.reflectance,
            shadow_depth: settings.shadows.depth,
            shadow_pixels: settings.shadows.pixels,
            wind: wind.extend(settings.flexibility),
        }
    }
}

/// The material of the slices of a surface across one axis. Made by the plugin.
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
#[bind_group_data(TexelKey)]
pub struct TexelMaterial {
    #[uniform(0)]
    pub(crate) texels: TexelsUniform,
    #[storage(1, read_only)]
    pub(crate) facets: Handle<ShaderBuffer>,
    #[texture(2, dimension = "2d_array")]
    #[sampler(4)]
    pub(crate) color: Handle<Image>,
    #[texture(3, dimension = "2d_array")]
    pub(crate) normal: Handle<Image>,
    pub(crate) axis: SliceAxis,
    pub(crate) lit: bool,
}

/// What tells the pipelines of one material from another's.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
pub struct TexelKey {
    axis: u8,
    lit: bool,
}

impl From<&TexelMaterial> for TexelKey {
    fn from(material: &TexelMaterial) -> Self {
        Self {
            axis: material.axis as u8,
            lit: material.lit,
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
        // Any mask will do: it names the phase, the shader discards.
        AlphaMode::Mask(0.5)
    }

    fn opaque_render_method(&self) -> OpaqueRendererMethod {
        // Deferred passes have no shaders here.
        OpaqueRendererMethod::Forward
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let corners = layout
            .0
            .get_layout(&[ATTRIBUTE_SLOT.at_shader_location(0)])?;
        descriptor.vertex.buffers = vec![corners];
        descriptor.primitive.cull_mode = None;
        let own = key.bind_group_data;
        let axis = ShaderDefVal::UInt("TEXEL_AXIS".into(), own.axis.into());
        // The shaders know where four samples lie; with more or fewer, texels have plain outlines.
        let four = descriptor.multisample.count == 4;
        let sun = MeshPipelineKey::UNCLIPPED_DEPTH_ORTHO;
        let defs = names([
            (own.lit, "TEXEL_LIT"),
            (key.mesh_key.contains(sun), "TEXEL_DIRECTIONAL_LIGHT"),
            (four, "TEXEL_FOUR_SAMPLES"),
        ]);
        define(descriptor, defs.chain([axis]));
        Ok(())
    }
}

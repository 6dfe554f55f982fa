//! What an impostor is drawn with.

use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;

use crate::pipeline::embedded_shader;
use crate::slicing::Orientation;

/// The crown that is shown, as the shader has it.
#[derive(Clone, Debug, ShaderType)]
pub(super) struct ShapeUniform {
    pub(super) centroid: Vec3,
    pub(super) radius: f32,
    /// Views along a side of the square.
    pub(super) side: u32,
}

/// A view, as the shader has it.
#[derive(Clone, Debug, ShaderType)]
pub(super) struct ViewUniform {
    right: Vec4,
    up: Vec4,
    direction: Vec4,
    size: Vec4,
}

impl ViewUniform {
    pub(super) fn new(o: &Orientation) -> Self {
        let size = o.high - o.low;
        Self {
            right: o.right.extend(o.low.x),
            up: o.up.extend(o.high.y),
            direction: o.direction.extend(0.0),
            size: Vec4::new(size.x, size.y, 0.0, 0.0),
        }
    }
}

/// The material of an impostor. Made by [`add_impostor`](super::add_impostor).
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
pub struct ImpostorMaterial {
    #[uniform(0)]
    pub(super) shape: ShapeUniform,
    #[storage(1, read_only)]
    pub(super) views: Handle<ShaderBuffer>,
    #[texture(2, dimension = "2d_array")]
    #[sampler(3)]
    pub(super) color: Handle<Image>,
    #[texture(4, dimension = "2d_array")]
    pub(super) normal: Handle<Image>,
}

fn shader() -> ShaderRef {
    embedded_shader("lab/octahedral/impostor.wgsl")
}

impl Material for ImpostorMaterial {
    fn vertex_shader() -> ShaderRef {
        shader()
    }

    fn fragment_shader() -> ShaderRef {
        shader()
    }

    fn prepass_vertex_shader() -> ShaderRef {
        shader()
    }

    fn prepass_fragment_shader() -> ShaderRef {
        shader()
    }

    fn alpha_mode(&self) -> AlphaMode {
        AlphaMode::Blend
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        _: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let places = layout
            .0
            .get_layout(&[Mesh::ATTRIBUTE_UV_0.at_shader_location(0)])?;
        descriptor.vertex.buffers = vec![places];
        descriptor.primitive.cull_mode = None;
        Ok(())
    }
}

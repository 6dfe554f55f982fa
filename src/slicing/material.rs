//! The material that draws crowns, in Bevy's own phases.
//!
//! Blended crowns are items of the transparent phase: sorted far to near among all that is transparent, and drawn at once
//! where neighbours in that order are of one set of slicings. Hashed ones are items of the alpha-mask phases.

use bevy::asset::Asset;
use bevy::image::Image;
use bevy::math::{UVec4, Vec2, Vec3, Vec4};
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{Material, MaterialPipeline, MaterialPipelineKey, MeshPipelineKey};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, RenderPipelineDescriptor, ShaderType, SpecializedMeshPipelineError, TextureFormat,
};
use bevy::render::storage::ShaderBuffer;
use bevy::shader::ShaderRef;

use super::blend::{SliceOrder, widest};
use super::component::{Composition, CrownSettings};
use super::limits::MAX_ORIENTATIONS;
use super::mesh::ATTRIBUTE_CORNER;
use super::slicing::SlicingShape;
use crate::lighting::{PlantLighting, SceneLighting};
use crate::pipeline::{define, embedded_shader, names};

/// Metres that a crown's top gives for each metre a second of wind, for each metre of its radius.
const FLEXIBILITY: f32 = 0.006;

/// An orientation, as the shaders have it.
#[derive(Clone, Copy, Debug, Default, ShaderType)]
pub(crate) struct OrientationUniform {
    direction: Vec3,
    right: Vec3,
    up: Vec3,
    low: Vec3,
    high: Vec3,
}

/// What is the same for all slicings of a set, as the shaders have it.
#[derive(Clone, Copy, Debug, ShaderType)]
pub(crate) struct SetUniform {
    /// Velocity of the wind.
    pub(crate) wind: Vec4,
    /// Direction to the brightest sun that casts shadows, or 0.
    pub(crate) sun: Vec4,
    pixels: u32,
    left_out: u32,
    /// Which cameras gather frames: a [`Gathering`].
    pub(crate) gathering: u32,
}

/// Which cameras gather frames, as temporal anti-aliasing does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Gathering {
    None = 0,
    /// Those whose view is jittered, where each frame tells.
    Some = 1,
    /// Even in frames for which the jitter is zero.
    All = 2,
}

impl SetUniform {
    pub(crate) fn new(pixels: u32, settings: &CrownSettings, wind: Vec3) -> Self {
        Self {
            wind: wind.extend(0.0),
            // Until `follow_sun` says otherwise, in this very frame.
            sun: Vec4::ZERO,
            pixels,
            left_out: settings.left_out,
            // Until `follow_cameras` says otherwise.
            gathering: Gathering::None as u32,
        }
    }
}

/// A slicing's shape, as the shaders have it.
#[derive(Clone, Debug, ShaderType)]
pub(crate) struct CrownRecord {
    centroid: Vec3,
    radius: f32,
    /// Slices of each level, and the number of levels.
    levels: UVec4,
    switches: Vec2,
    correction: f32,
    /// Layers of the set before its own.
    layers_before: u32,
    orientation_count: u32,
    sphere: u32,
    vertical: u32,
    flexibility: f32,
    widest: f32,
    diffuse_transmission: f32,
    orientations: [OrientationUniform; MAX_ORIENTATIONS],
}

impl CrownRecord {
    pub(crate) fn new(shape: &SlicingShape, layers_before: u32) -> Self {
        let level = |i: usize| shape.levels.get(i).copied().unwrap_or(0);
        let switch = |i: usize| shape.switches.get(i).copied().unwrap_or(f32::MAX);
        let mut orientations = [OrientationUniform::default(); MAX_ORIENTATIONS];
        for (uniform, o) in orientations.iter_mut().zip(&shape.orientations) {
            *uniform = OrientationUniform {
                direction: o.direction,
                right: o.right,
                up: o.up,
                low: o.low,
                high: o.high,
            };
        }
        Self {
            centroid: shape.centroid,
            radius: shape.radius,
            levels: UVec4::new(level(0), level(1), level(2), shape.levels.len() as u32),
            switches: Vec2::new(switch(0), switch(1)),
            correction: shape.correction,
            layers_before,
            orientation_count: shape.orientations.len() as u32,
            sphere: shape.sphere.into(),
            vertical: shape.vertical.into(),
            flexibility: FLEXIBILITY * shape.radius,
            widest: widest(shape),
            diffuse_transmission: shape.diffuse_transmission,
            orientations,
        }
    }
}

/// The material of all crowns of a set of slicings that have the same settings. Made by the plugin.
#[derive(Asset, AsBindGroup, Clone, Debug, TypePath)]
#[bind_group_data(CrownKey)]
pub struct SlicedCrownMaterial {
    #[uniform(0)]
    pub(crate) set: SetUniform,
    /// A [`CrownRecord`] for each slicing.
    #[storage(1, read_only, visibility(vertex))]
    pub(crate) crowns: Handle<ShaderBuffer>,
    #[storage(2, read_only, visibility(vertex))]
    pub(crate) octagons: Handle<ShaderBuffer>,
    #[texture(3, dimension = "2d_array")]
    #[sampler(4)]
    pub(crate) color: Handle<Image>,
    #[texture(5, dimension = "2d_array")]
    pub(crate) normal: Handle<Image>,
    pub(crate) settings: CrownSettings,
    /// Whether light comes through leaves from behind.
    pub(crate) transmits: bool,
    /// What lights the crowns in this scene.
    pub(crate) lighting: SceneLighting,
    /// Whether cameras map tones.
    pub(crate) tone_mapped: bool,
    /// Whether the textures are compressed, so that normals are folded to an octahedron's square.
    pub(crate) compressed: bool,
    /// Whether the discrepancy angle is taken part by part, up close.
    pub(crate) parts: bool,
}

/// What tells pipelines apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CrownKey {
    composition: Composition,
    order: SliceOrder,
    lighting: SceneLighting,
    frames: bool,
    parts: bool,
    compressed: bool,
    tone_mapped: bool,
    transmits: bool,
}

impl From<&SlicedCrownMaterial> for CrownKey {
    fn from(material: &SlicedCrownMaterial) -> Self {
        let settings = material.settings;
        Self {
            composition: settings.composition,
            order: settings.order,
            lighting: material.lighting,
            frames: settings.frames,
            parts: material.parts,
            compressed: material.compressed,
            tone_mapped: material.tone_mapped,
            transmits: material.transmits,
        }
    }
}

/// A shader of this folder.
fn shader(name: &str) -> ShaderRef {
    embedded_shader(&format!("slicing/shaders/{name}"))
}

impl Material for SlicedCrownMaterial {
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
        match self.settings.composition {
            Composition::Blended => AlphaMode::Blend,
            // Any mask will do: it names the phase, the shader tests by chance.
            Composition::Hashed => AlphaMode::Mask(0.5),
        }
    }

    fn specialize(
        _: &MaterialPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialPipelineKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        let corners = layout
            .0
            .get_layout(&[ATTRIBUTE_CORNER.at_shader_location(0)])?;
        descriptor.vertex.buffers = vec![corners];
        descriptor.primitive.cull_mode = None;
        let crown = key.bind_group_data;
        let lighting = crown.lighting.lighting;
        let light = MeshPipelineKey::UNCLIPPED_DEPTH_ORTHO;
        // In HDR, blended colours are mapped to the screen after they are blended.
        let is_tone_mapped_later = crown.tone_mapped
            && crown.composition == Composition::Blended
            && crown.order == SliceOrder::Steady
            && matches!(
                key.mesh_key.target_format(),
                TextureFormat::Rgba16Float | TextureFormat::Rg11b10Ufloat
            );
        let defs = names([
            (crown.composition == Composition::Hashed, "CROWN_HASHED"),
            (crown.order == SliceOrder::Paper, "CROWN_PAPER_ORDER"),
            (lighting == PlantLighting::Full, "CROWN_FULL_LIGHT"),
            (lighting == PlantLighting::Simple, "CROWN_SIMPLE_LIGHT"),
            (crown.lighting.more_suns, "MORE_SUNS"),
            (crown.frames, "CROWN_FRAMES"),
            (crown.parts, "CROWN_PARTS"),
            (crown.compressed, "CROWN_COMPRESSED"),
            (key.mesh_key.contains(light), "CROWN_LIGHT_VIEW"),
            (is_tone_mapped_later, "CROWN_TONE_MAPPED_LATER"),
            // Bevy's full light and the simple one ask for it.
            (crown.transmits, "STANDARD_MATERIAL_DIFFUSE_TRANSMISSION"),
        ]);
        define(descriptor, defs);
        Ok(())
    }
}

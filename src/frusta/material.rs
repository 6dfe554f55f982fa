//! The material: Bevy's standard one, on a surface that is ray cast.

use bevy::asset::Asset;
use bevy::ecs::system::SystemParamItem;
use bevy::ecs::system::lifetimeless::SRes;
use bevy::mesh::MeshVertexBufferLayoutRef;
use bevy::pbr::{
    ExtendedMaterial, MaterialExtension, MaterialExtensionKey, MaterialExtensionPipeline,
    MeshPipelineKey, StandardMaterial,
};
use bevy::prelude::*;
use bevy::render::render_resource::{
    AsBindGroup, AsBindGroupError, BindGroupLayout, BindGroupLayoutEntry, BindingResources,
    BindingType, BufferBindingType, Face, OwnedBindingResource, RenderPipelineDescriptor,
    ShaderStages, SpecializedMeshPipelineError, UnpreparedBindGroup,
};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::shader::{ShaderDefVal, ShaderRef};

use super::buffers::FrustaBuffers;
use super::mesh::ATTRIBUTE_CORNER;
use super::relief::{Relief, ReliefBindings, ReliefMarch, ReliefTextures, ReliefV};
use crate::pipeline::{define, embedded_shader, names};

/// The material of plants that are drawn by frusta: all of [`StandardMaterial`] that a surface with one pair of
/// texture coordinates can have, on a ray-cast surface.
///
/// Base colour, emissive, metallic-roughness, normal and occlusion maps are sampled with gradients of the ray, so that
/// the seam at u = 0 cannot be seen; other maps of [`StandardMaterial`], parallax and lightmaps are ignored.
/// `alpha_mode` may be `Opaque` or `Mask`; all others are drawn opaque. `cull_mode` and `double_sided` have no
/// meaning here.
pub type FrustaMaterial = ExtendedMaterial<StandardMaterial, FrustaExtension>;

/// Which of the paper's two normals (§2.4) a surface is shaded with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum ShadingNormals {
    /// Interpolated between a segment's ends (Equation 8): continuous from segment to segment.
    #[default]
    Continuous,
    /// The surface's own: every joint shows as a crease.
    Geometric,
}

/// What the main pass writes: for looking into the geometry, and for measuring it.
///
/// All but `Shaded` need a camera that renders to an image of 32-bit floats (`Rgba32Float`), without MSAA.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum FrustaOutput {
    /// The lit surface.
    #[default]
    Shaded,
    /// Depth in metres along the view axis, index of the joint that ends the segment, u, v.
    Geometry,
    /// The shading normal in world space, and depth in metres along the view axis.
    Normals,
}

/// What [`FrustaMaterial`] adds to [`StandardMaterial`].
#[derive(Asset, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct FrustaExtension {
    /// The normals to shade with.
    pub normals: ShadingNormals,
    /// What the main pass writes.
    pub output: FrustaOutput,
    /// Detail that stands out of the surface.
    pub relief: Option<Relief>,
}

/// What tells the pipelines of one material from another's.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
#[repr(C)]
pub struct FrustaKey {
    geometric_normals: u8,
    output: u8,
    relief: u8,
}

/// Bits of a key's relief.
const RELIEF: u8 = 1;
const RELIEF_INTERPOLATED_V: u8 = 2;
const RELIEF_LEAPING: u8 = 4;
const RELIEF_SELF_SHADOW: u8 = 8;

fn relief_bits(relief: &Relief) -> u8 {
    let bit = |bit, set| if set { bit } else { 0 };
    if relief.shell().is_none() {
        return 0;
    }
    RELIEF
        | bit(RELIEF_INTERPOLATED_V, relief.v == ReliefV::Interpolated)
        | bit(RELIEF_LEAPING, relief.march == ReliefMarch::Leaping)
        | bit(RELIEF_SELF_SHADOW, relief.self_shadow > 0)
}

/// Bindings of the extension; [`StandardMaterial`] uses those below.
const FIRST_BINDING: u32 = 100;
/// How many of them are storage buffers.
const BUFFERS: u32 = 3;

/// Whether a device can run the shaders: they read storage buffers in the vertex stage.
pub(crate) fn is_supported(device: &RenderDevice) -> bool {
    let limits = device.limits();
    limits.max_storage_buffers_per_shader_stage >= STORAGE_BUFFERS
        && limits.max_storage_buffer_binding_size >= 1 << 20
}

/// Storage buffers that a shader stage needs: the extension's three, and those of Bevy's views and meshes.
pub(crate) const STORAGE_BUFFERS: u32 = BUFFERS + 4;

impl AsBindGroup for FrustaExtension {
    type Data = FrustaKey;
    type Param = (SRes<FrustaBuffers>, SRes<ReliefTextures>, SRes<RenderQueue>);

    fn label() -> &'static str {
        "frusta_material"
    }

    fn bind_group_data(&self) -> FrustaKey {
        FrustaKey {
            geometric_normals: (self.normals == ShadingNormals::Geometric) as u8,
            output: self.output as u8,
            relief: self.relief.as_ref().map_or(0, relief_bits),
        }
    }

    fn unprepared_bind_group(
        &self,
        _: &BindGroupLayout,
        device: &RenderDevice,
        (buffers, textures, queue): &mut SystemParamItem<'_, '_, Self::Param>,
        _: bool,
    ) -> Result<UnpreparedBindGroup, AsBindGroupError> {
        let (true, Some(joints), Some(shapes), Some(plants)) = (
            is_supported(device),
            &buffers.joints,
            &buffers.shapes,
            &buffers.plants,
        ) else {
            return Err(AsBindGroupError::RetryNextUpdate);
        };
        // While its map is on the way, a plant is not drawn, as with any other texture.
        let relief = self
            .relief
            .as_ref()
            .filter(|relief| relief.shell().is_some());
        let Some(relief) = ReliefBindings::resources(relief, textures, device, queue) else {
            return Err(AsBindGroupError::RetryNextUpdate);
        };
        let buffers =
            [joints, shapes, plants].map(|buffer| OwnedBindingResource::Buffer(buffer.clone()));
        let resources = buffers.into_iter().chain(relief);
        Ok(UnpreparedBindGroup {
            bindings: BindingResources((FIRST_BINDING..).zip(resources).collect()),
        })
    }

    fn bind_group_layout_entries(device: &RenderDevice, _: bool) -> Vec<BindGroupLayoutEntry> {
        if !is_supported(device) {
            return Vec::new();
        }
        let entry = |binding| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: BindingType::Buffer {
                ty: BufferBindingType::Storage { read_only: true },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        };
        let buffers = (FIRST_BINDING..FIRST_BINDING + BUFFERS).map(entry);
        let relief = ReliefBindings::entries(FIRST_BINDING + BUFFERS);
        buffers.chain(relief).collect()
    }
}

/// A shader of this folder.
fn shader(name: &str) -> ShaderRef {
    embedded_shader(&format!("frusta/shaders/{name}"))
}

impl MaterialExtension for FrustaExtension {
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

    fn deferred_vertex_shader() -> ShaderRef {
        shader("deferred.wgsl")
    }

    fn deferred_fragment_shader() -> ShaderRef {
        shader("deferred.wgsl")
    }

    fn alpha_mode() -> Option<AlphaMode> {
        // Rays miss: fragments are discarded in every pass.
        Some(AlphaMode::Mask(0.5))
    }

    fn specialize(
        _: &MaterialExtensionPipeline,
        descriptor: &mut RenderPipelineDescriptor,
        layout: &MeshVertexBufferLayoutRef,
        key: MaterialExtensionKey<Self>,
    ) -> Result<(), SpecializedMeshPipelineError> {
        descriptor.vertex.buffers = vec![
            layout
                .0
                .get_layout(&[ATTRIBUTE_CORNER.at_shader_location(0)])?,
        ];
        // The far sides of the bounds are drawn, once a pixel, wherever the eye is.
        let mirrored_view = key.mesh_key.contains(MeshPipelineKey::INVERT_CULLING);
        descriptor.primitive.cull_mode = Some(if mirrored_view {
            Face::Back
        } else {
            Face::Front
        });
        let (samples, own) = (descriptor.multisample.count, key.bind_group_data);
        let count = ShaderDefVal::UInt("FRUSTA_SAMPLES".into(), samples);
        let unclipped = MeshPipelineKey::UNCLIPPED_DEPTH_ORTHO;
        let relief = |bit| own.relief & bit != 0;
        let output = |output: FrustaOutput| own.output == output as u8;
        let defs = names([
            (samples > 1, "FRUSTA_MULTISAMPLED"),
            (own.geometric_normals != 0, "FRUSTA_GEOMETRIC_NORMALS"),
            (relief(RELIEF), "FRUSTA_RELIEF"),
            (relief(RELIEF_INTERPOLATED_V), "FRUSTA_INTERPOLATED_V"),
            (relief(RELIEF_LEAPING), "FRUSTA_LEAPING"),
            (relief(RELIEF_SELF_SHADOW), "FRUSTA_SELF_SHADOW"),
            (output(FrustaOutput::Geometry), "FRUSTA_OUTPUT_GEOMETRY"),
            (output(FrustaOutput::Normals), "FRUSTA_OUTPUT_NORMALS"),
            (key.mesh_key.contains(unclipped), "FRUSTA_UNCLIPPED_DEPTH"),
        ]);
        define(descriptor, defs.chain([count]));
        Ok(())
    }
}

/// A [`FrustaMaterial`] of a [`StandardMaterial`], or of what becomes one: a colour, or an image.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// let bark = frusta_material(Color::srgb(0.35, 0.25, 0.18));
/// let glazed = frusta_material(StandardMaterial { perceptual_roughness: 0.1, ..default() });
/// ```
pub fn frusta_material(base: impl Into<StandardMaterial>) -> FrustaMaterial {
    FrustaMaterial {
        base: base.into(),
        extension: FrustaExtension::default(),
    }
}

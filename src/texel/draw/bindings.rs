//! What shaders have of facets and surfaces: a bind group in place of that of Bevy's meshes, one for each buffer of facets.

use bevy::prelude::*;
use bevy::render::render_resource::binding_types::storage_buffer_read_only_sized;
use bevy::render::render_resource::{
    BindGroup, BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, BufferId,
    PipelineCache, ShaderStages,
};
use bevy::render::renderer::RenderDevice;

use super::lists::SliceLists;
use super::upload::FacetBuffers;

/// The number of the group, in all passes.
pub(crate) const TEXEL_GROUP: usize = 2;

/// How it is laid out: facets, then surfaces.
pub(crate) fn bind_group_layout() -> BindGroupLayoutDescriptor {
    let records = || storage_buffer_read_only_sized(false, None);
    BindGroupLayoutDescriptor::new(
        "texel_facets_and_surfaces",
        &BindGroupLayoutEntries::sequential(ShaderStages::VERTEX, (records(), records())),
    )
}

/// The bind groups, in the order of the buffers of facets.
#[derive(Resource, Default)]
pub(crate) struct TexelBindGroups {
    groups: Vec<BindGroup>,
    /// Of which buffers they are.
    buffers: Vec<[BufferId; 2]>,
}

impl TexelBindGroups {
    /// That of a buffer of facets.
    pub(crate) fn get(&self, pool: usize) -> Option<&BindGroup> {
        self.groups.get(pool)
    }
}

/// Makes the bind groups anew when buffers have been.
pub(crate) fn prepare_bind_groups(
    mut bound: ResMut<TexelBindGroups>,
    facets: Res<FacetBuffers>,
    lists: Res<SliceLists>,
    device: Res<RenderDevice>,
    pipelines: Res<PipelineCache>,
) {
    let Some(surfaces) = lists.surfaces() else {
        // On a device that has just taken a lost one's place.
        *bound = TexelBindGroups::default();
        return;
    };
    let ids = facets.iter().map(|facets| [facets.id(), surfaces.id()]);
    if ids.eq(bound.buffers.iter().copied()) {
        return;
    }
    let layout = pipelines.get_bind_group_layout(&bind_group_layout());
    bound.groups.clear();
    bound.buffers.clear();
    for facets in facets.iter() {
        bound.groups.push(device.create_bind_group(
            "texel_facets_and_surfaces",
            &layout,
            &BindGroupEntries::sequential((
                facets.as_entire_binding(),
                surfaces.as_entire_binding(),
            )),
        ));
        bound.buffers.push([facets.id(), surfaces.id()]);
    }
}

//! How slices are drawn in Bevy's phases: as a material's mesh is, but from the lists of the view.

use bevy::core_pipeline::core_3d::{AlphaMask3d, Opaque3d};
use bevy::core_pipeline::prepass::{AlphaMask3dPrepass, DepthPrepass};
use bevy::ecs::query::ROQueryItem;
use bevy::ecs::system::SystemParamItem;
use bevy::ecs::system::lifetimeless::SRes;
use bevy::material::RenderPhaseType;
use bevy::material::labels::DrawFunctionLabel;
use bevy::pbr::{
    MainPassAlphaMaskDrawFunction, MainPassOpaqueDrawFunction, PreparedMaterial,
    PrepassAlphaMaskDrawFunction, SetMaterialBindGroup, SetMeshViewBindGroup,
    SetMeshViewBindingArrayBindGroup, SetPrepassViewBindGroup, SetPrepassViewEmptyBindGroup,
    Shadow, ShadowsDrawFunction,
};
use bevy::prelude::*;
use bevy::render::erased_render_asset::ErasedRenderAssets;
use bevy::render::render_phase::{
    DrawFunctions, RenderCommand, RenderCommandResult, SetItemPipeline, TrackedRenderPass,
};

use super::bindings::{TEXEL_GROUP, TexelBindGroups};
use super::leader::TexelPhase;
use super::lists::SliceLists;
use super::material::TexelMaterial;
use crate::draw_functions::{UnlessView, edit_prepared, replace_draw_functions};

/// Draws the slices that a view has across an axis of all surfaces of a group, for the first of them that comes.
pub(crate) struct DrawSlices;

impl<P: TexelPhase> RenderCommand<P> for DrawSlices {
    type Param = (SRes<SliceLists>, SRes<TexelBindGroups>);
    type ViewQuery = Entity;
    type ItemQuery = ();

    fn render<'w>(
        item: &P,
        view: ROQueryItem<'w, '_, Self::ViewQuery>,
        _: Option<()>,
        (lists, groups): SystemParamItem<'w, '_, Self::Param>,
        pass: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        let slices = item.main_entity();
        let Some((records, run)) = lists.into_inner().run(view, slices) else {
            return RenderCommandResult::Skip;
        };
        let Some(group) = groups.into_inner().get(run.pool) else {
            return RenderCommandResult::Skip;
        };
        // Only what is drawn may lead: all that another one needs is there.
        if !run.leaders.leads::<P>(slices.id()) {
            return RenderCommandResult::Skip;
        }
        pass.set_bind_group(TEXEL_GROUP, group, &[]);
        pass.set_vertex_buffer(0, records.slice(..));
        pass.draw(0..4, run.records.clone());
        RenderCommandResult::Success
    }
}

/// Depth in the main pass, where no prepass has drawn it.
pub(crate) type DrawTexelDepth = (UnlessView<DepthPrepass>, DrawTexels);

/// In the main pass.
pub(crate) type DrawTexels = (
    SetItemPipeline,
    SetMeshViewBindGroup<0>,
    SetMeshViewBindingArrayBindGroup<1>,
    SetMaterialBindGroup<3>,
    DrawSlices,
);

/// In prepasses and shadow maps.
pub(crate) type DrawTexelsBefore = (
    SetItemPipeline,
    SetPrepassViewBindGroup<0>,
    SetPrepassViewEmptyBindGroup<1>,
    SetMaterialBindGroup<3>,
    DrawSlices,
);

/// Lets materials of texels be drawn so, which Bevy has prepared to draw meshes.
pub(crate) fn take_over_materials(
    materials: ResMut<ErasedRenderAssets<PreparedMaterial>>,
    opaque: Res<DrawFunctions<Opaque3d>>,
    main: Res<DrawFunctions<AlphaMask3d>>,
    prepass: Res<DrawFunctions<AlphaMask3dPrepass>>,
    shadow: Res<DrawFunctions<Shadow>>,
) {
    let own = [
        (
            MainPassOpaqueDrawFunction.intern(),
            opaque.read().id::<DrawTexelDepth>(),
        ),
        (
            MainPassAlphaMaskDrawFunction.intern(),
            main.read().id::<DrawTexels>(),
        ),
        (
            PrepassAlphaMaskDrawFunction.intern(),
            prepass.read().id::<DrawTexelsBefore>(),
        ),
        (
            ShadowsDrawFunction.intern(),
            shadow.read().id::<DrawTexelsBefore>(),
        ),
    ];
    edit_prepared::<TexelMaterial>(
        materials,
        |_| true,
        |properties| {
            // Of what draws depth in the main pass alone, prepasses and shadow maps have nothing.
            let is_mask = matches!(properties.render_phase_type, RenderPhaseType::AlphaMask);
            (properties.prepass_enabled, properties.shadows_enabled) = (is_mask, is_mask);
            replace_draw_functions(properties, &own);
        },
    );
}

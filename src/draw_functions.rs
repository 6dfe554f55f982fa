//! Materials that are drawn by commands of the crate's own, in Bevy's phases.
//!
//! Bevy gives each material that it prepares its own draw functions. They are replaced right after that, before anything is
//! queued; Bevy prepares a material anew whenever it changes.

use core::any::TypeId;
use core::marker::PhantomData;
use std::sync::Arc;

use bevy::asset::Asset;
use bevy::ecs::query::ROQueryItem;
use bevy::ecs::system::SystemParamItem;
use bevy::material::MaterialProperties;
use bevy::material::labels::InternedDrawFunctionLabel;
use bevy::pbr::PreparedMaterial;
use bevy::prelude::*;
use bevy::render::erased_render_asset::ErasedRenderAssets;
use bevy::render::render_phase::{
    DrawFunctionId, PhaseItem, RenderCommand, RenderCommandResult, TrackedRenderPass,
};

/// Goes on only in views without a component.
pub(crate) struct UnlessView<C>(PhantomData<C>);

impl<P: PhaseItem, C: Component> RenderCommand<P> for UnlessView<C> {
    type Param = ();
    type ViewQuery = Has<C>;
    type ItemQuery = ();

    fn render<'w>(
        _: &P,
        is_left_out: ROQueryItem<'w, '_, Self::ViewQuery>,
        _: Option<()>,
        _: SystemParamItem<'w, '_, Self::Param>,
        _: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        if is_left_out {
            RenderCommandResult::Skip
        } else {
            RenderCommandResult::Success
        }
    }
}

/// Edits the properties of all prepared materials of one kind that `is_meant`, when some were prepared.
pub(crate) fn edit_prepared<M: Asset>(
    mut materials: ResMut<ErasedRenderAssets<PreparedMaterial>>,
    is_meant: impl Fn(&MaterialProperties) -> bool,
    edit: impl Fn(&mut MaterialProperties),
) {
    if !materials.is_changed() {
        return;
    }
    // What is done here counts as no change: it would be seen as one in the next frame.
    for (id, material) in materials.bypass_change_detection().iter_mut() {
        if id.type_id() != TypeId::of::<M>() || !is_meant(&material.properties) {
            continue;
        }
        // Bevy shares them only while it makes pipelines, later in the frame.
        match Arc::get_mut(&mut material.properties) {
            Some(properties) => edit(properties),
            None => {
                error_once!("plants are drawn wrongly: another plugin holds on to their materials")
            }
        }
    }
}

/// Draws by these functions what is drawn by Bevy's of the same labels.
pub(crate) fn replace_draw_functions(
    properties: &mut MaterialProperties,
    own: &[(InternedDrawFunctionLabel, DrawFunctionId)],
) {
    for (label, function) in &mut properties.draw_functions {
        if let Some((_, own)) = own.iter().find(|(known, _)| known == label) {
            *function = *own;
        }
    }
}

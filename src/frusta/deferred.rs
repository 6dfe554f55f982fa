//! Deferred plants stay out of the forward pass of views that deferred lighting has lit.
//!
//! Frusta discard fragments, so Bevy sorts them with masked materials, and it queues those for the forward pass whether
//! they are deferred or not (only its opaque ones are left out). Each plant would be ray cast and lit a second time, over
//! what deferred lighting has made of it. So a deferred frusta material draws by commands that skip such views.

use core::any::TypeId;
use std::sync::Arc;

use bevy::core_pipeline::core_3d::AlphaMask3d;
use bevy::core_pipeline::prepass::DeferredPrepass;
use bevy::ecs::query::ROQueryItem;
use bevy::ecs::system::SystemParamItem;
use bevy::material::labels::DrawFunctionLabel;
use bevy::material::{MaterialProperties, OpaqueRendererMethod};
use bevy::pbr::{DrawMaterial, MainPassAlphaMaskDrawFunction, PreparedMaterial};
use bevy::prelude::*;
use bevy::render::erased_render_asset::ErasedRenderAssets;
use bevy::render::render_phase::{
    AddRenderCommand, DrawFunctionId, DrawFunctions, PhaseItem, RenderCommand, RenderCommandResult,
    TrackedRenderPass,
};
use bevy::render::{Render, RenderSystems};

use super::material::FrustaMaterial;

/// Draws a material, but not in views with a deferred prepass.
type DrawUnlessDeferred = (SkipDeferredViews, DrawMaterial);

struct SkipDeferredViews;

impl<P: PhaseItem> RenderCommand<P> for SkipDeferredViews {
    type Param = ();
    type ViewQuery = Has<DeferredPrepass>;
    type ItemQuery = ();

    fn render<'w>(
        _: &P,
        is_deferred: ROQueryItem<'w, '_, Self::ViewQuery>,
        _: Option<()>,
        _: SystemParamItem<'w, '_, Self::Param>,
        _: &mut TrackedRenderPass<'w>,
    ) -> RenderCommandResult {
        if is_deferred {
            RenderCommandResult::Skip
        } else {
            RenderCommandResult::Success
        }
    }
}

pub(super) fn build(render_app: &mut SubApp) {
    render_app
        .add_render_command::<AlphaMask3d, DrawUnlessDeferred>()
        .add_systems(
            Render,
            replace_draw_functions
                .after(RenderSystems::PrepareAssets)
                .before(RenderSystems::QueueMeshes),
        );
}

/// Gives deferred frusta materials the draw function of this file, when some were prepared: Bevy prepares a material anew,
/// with its own function, whenever it changes.
fn replace_draw_functions(
    mut materials: ResMut<ErasedRenderAssets<PreparedMaterial>>,
    functions: Res<DrawFunctions<AlphaMask3d>>,
) {
    if !materials.is_changed() {
        return;
    }
    let ours = functions.read().id::<DrawUnlessDeferred>();
    let frusta = TypeId::of::<FrustaMaterial>();
    // What is done here counts as no change: it would be seen as one in the next frame.
    for (id, material) in materials.bypass_change_detection().iter_mut() {
        if id.type_id() == frusta
            && material.properties.render_method == OpaqueRendererMethod::Deferred
            && let Some(properties) = Arc::get_mut(&mut material.properties)
        {
            replace(properties, ours);
        }
    }
}

fn replace(properties: &mut MaterialProperties, ours: DrawFunctionId) {
    let forward = MainPassAlphaMaskDrawFunction.intern();
    for (label, function) in &mut properties.draw_functions {
        if *label == forward {
            *function = ours;
        }
    }
}

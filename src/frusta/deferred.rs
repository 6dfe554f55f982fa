//! Deferred plants stay out of the forward pass of views that deferred lighting has lit.
//!
//! Frusta discard fragments, so Bevy sorts them with masked materials, and it queues those for the forward pass whether
//! they are deferred or not (only its opaque ones are left out). Each plant would be ray cast and lit a second time, over
//! what deferred lighting has made of it. So a deferred frusta material draws by commands that skip such views.

use bevy::core_pipeline::core_3d::AlphaMask3d;
use bevy::core_pipeline::prepass::DeferredPrepass;
use bevy::material::OpaqueRendererMethod;
use bevy::material::labels::DrawFunctionLabel;
use bevy::pbr::{DrawMaterial, MainPassAlphaMaskDrawFunction, PreparedMaterial};
use bevy::prelude::*;
use bevy::render::erased_render_asset::ErasedRenderAssets;
use bevy::render::render_phase::{AddRenderCommand, DrawFunctions};
use bevy::render::{Render, RenderSystems};

use super::material::FrustaMaterial;
use crate::draw_functions::{UnlessView, edit_prepared, replace_draw_functions};

/// Draws a material, but not in views with a deferred prepass.
type DrawUnlessDeferred = (UnlessView<DeferredPrepass>, DrawMaterial);

pub(super) fn build(render_app: &mut SubApp) {
    render_app
        .add_render_command::<AlphaMask3d, DrawUnlessDeferred>()
        .add_systems(
            Render,
            skip_deferred_views
                .after(RenderSystems::PrepareAssets)
                .before(RenderSystems::QueueMeshes),
        );
}

/// Gives deferred frusta materials the draw function of this file.
fn skip_deferred_views(
    materials: ResMut<ErasedRenderAssets<PreparedMaterial>>,
    functions: Res<DrawFunctions<AlphaMask3d>>,
) {
    let label = MainPassAlphaMaskDrawFunction.intern();
    let own = [(label, functions.read().id::<DrawUnlessDeferred>())];
    edit_prepared::<FrustaMaterial>(
        materials,
        |properties| properties.render_method == OpaqueRendererMethod::Deferred,
        |properties| replace_draw_functions(properties, &own),
    );
}

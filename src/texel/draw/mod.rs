//! Drawing texels (§2.2, §4): slices of the volume on every facet, in the direction and the number that each view
//! needs.
//!
//! 1. A [`TexelSurface`] on an entity names a volume (`component.rs`). Its mesh becomes facets (`surface_mesh.rs`), which
//!    the GPU has in one storage buffer with those of all surfaces (`records.rs`, `room.rs`, `upload.rs`), and the volume
//!    three pairs of texture arrays (`images.rs`). What is alike is shared (`geometry.rs`, `library.rs`). Children of the
//!    surface have the materials (`systems.rs`).
//! 2. In each frame (`extract.rs`), and for each view, those of lights too, slices are [chosen](super::choose_fading) for
//!    every facet, and listed, near ones first among at most 8,192 facets: by the CPU, in parallel, without allocating
//!    (`view.rs`, `source.rs`, `jobs.rs`). So shadow maps have the slices that their light needs, at a quality of their own
//!    ([`TexelSettings::shadows`]). Of each slice only the box that shows anything is drawn. Lists that would come out as
//!    they are already are kept.
//! 3. Surfaces of one volume and the same looks are a group (`groups.rs`). Their lists are joined, near surfaces first
//!    (`lists.rs`), and drawn at once in Bevy's phases in place of meshes (`commands.rs`, `bindings.rs`), when the first of
//!    their children comes (`leader.rs`): each slice is a strip of four corners that the vertex shader cuts out of the
//!    facet's prism (`shaders/place.wgsl`, `shaders/facet.wgsl`).
//! 4. Fragments are those of one slice: opaque, or discarded (`shaders/look.wgsl`). So they need no sorting, and texels
//!    that overlap interpenetrate. Depth is drawn first, in the phase of opaque objects; then, in that of masked ones, the
//!    colours of what is at that depth (`material.rs`), lit by the scene by the volume's normals (`shaders/forward.wgsl`).
//!    They cast shadows (`shaders/prepass.wgsl`).
//!
//! Facets of skinned meshes follow their joints on the CPU, once these are where they are in a frame (`skin.rs`). Of facets
//! that moved those that changed are written to the GPU (`upload.rs`). Brushes stroke surfaces by their height vectors
//! (`brush.rs`, `combed.rs`).
//!
//! # What does not pop
//! Where twice as many slices will soon be needed, two take the place of each, which show together nearly what it does, and
//! move apart from there to where they belong. The second best direction fades in where it is nearly as good as the best:
//! each pixel of the screen draws a lot, and shows the slices whose it is. Either direction alone would do.
//!
//! # Light on slices
//! Slices show the inside of things, by up to d (§4.1), and shadow maps have slices too, which stand out towards the light.
//! So what is seen is lit and shadowed a little above it, or solids would shade themselves in specks
//! (`TexelSettings::stand_off`). Facets of a bent surface are shaded by the mesh's normals, so that they do not show.
//!
//! # What it costs
//! A group of surfaces is three draws for depth and three for colours, one for each axis, where that axis has slices; three
//! in a shadow map. Settings that split groups are those of light and material, `flexibility`, `inner_slices` and
//! `most_slices`; meshes, transforms, thickness and quality do not. Where neither the view nor a surface moves, and no wind
//! bends it, nothing is chosen, listed or written; else all lists of the frame are joined, and what differs of them is
//! written (`mirror.rs`), 32 bytes a slice ([`TexelStats`] counts them). Light costs what is seen; most of the rest is
//! looking up, slice by slice, what is there, in shadow maps as well: fewer pixels of these save slices. On a camera with a
//! [`DepthPrepass`](bevy::core_pipeline::prepass::DepthPrepass) that draws the depth. On the GPU a volume has all its sets
//! of slices, some 64 bytes a voxel.
//!
//! # What it does not do
//! Meshes with morph targets carry texels where they are at rest, with a warning. Motion vectors leave skins and wind out.
//! Cutting a volume into slices takes a second or more for 256×256×64 voxels, in the frame in which it is first shown. A
//! slice across u or v is a quad, so that texels with height vectors that twist are bent in steps. Deferred cameras draw
//! texels forward: they are in the depth, normal and motion-vector prepasses, and not in the G-buffer. Where a facet needs
//! more slices than there are, or height vectors differ much over it, gaps may show: subdivide the mesh. Storage buffers in
//! the vertex stage are required, so WebGL 2 is out.

#[cfg(test)]
mod allocations;
mod bindings;
mod brush;
mod combed;
mod commands;
mod component;
mod extract;
mod geometry;
mod groups;
mod images;
mod jobs;
mod leader;
mod library;
mod limit;
mod lists;
mod material;
mod mirror;
mod records;
mod room;
mod skin;
mod source;
mod stats;
mod surface_mesh;
mod systems;
mod upload;
mod view;

use bevy::asset::AssetEventSystems;
use bevy::camera::visibility::VisibilitySystems;
use bevy::core_pipeline::core_3d::{AlphaMask3d, Opaque3d};
use bevy::core_pipeline::prepass::AlphaMask3dPrepass;
use bevy::pbr::{MaterialPlugin, Shadow};
use bevy::prelude::*;
use bevy::render::erased_render_asset::prepare_erased_assets;
use bevy::render::render_phase::AddRenderCommand;
use bevy::render::storage::ShaderBuffer;
use bevy::render::{ExtractSchedule, Render, RenderApp, RenderSystems};
use bevy::shader::load_shader_library;

pub use brush::{StrokedTexels, TexelBrush};
pub use component::{
    ATTRIBUTE_HEIGHT_VECTOR, LiveTexels, TexelCycle, TexelHeights, TexelSettings, TexelSurface,
};
pub use limit::MAX_SLICES;
pub use material::TexelMaterial;
pub use stats::TexelStats;
pub use surface_mesh::TexelSurfaceError;
pub use systems::TexelSlices;

use crate::VerdureSystems;
use crate::lighting::LightingPlugin;
use crate::wind::Wind;

/// Draws [`TexelSurface`]s.
///
/// Needs Bevy's rendering plugins, [`TexelVolumePlugin`](super::TexelVolumePlugin), and
/// [`WindPlugin`](crate::wind::WindPlugin).
pub struct TexelPlugin;

impl Plugin for TexelPlugin {
    fn build(&self, app: &mut App) {
        LightingPlugin::add_to(app);
        load_shader_library!(app, "shaders/types.wgsl");
        load_shader_library!(app, "shaders/facet.wgsl");
        load_shader_library!(app, "shaders/place.wgsl");
        load_shader_library!(app, "shaders/look.wgsl");
        load_shader_library!(app, "shaders/inner.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/forward.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/prepass.wgsl");

        app.add_plugins(MaterialPlugin::<TexelMaterial>::default())
            .register_type::<TexelSurface>()
            .register_type::<TexelSettings>()
            .register_type::<TexelHeights>()
            .register_type::<LiveTexels>()
            .register_type::<TexelCycle>()
            .register_type::<TexelBrush>()
            .register_type::<StrokedTexels>()
            .register_type::<TexelSlices>()
            .init_resource::<library::TexelLibrary>()
            .add_observer(systems::uproot)
            .add_systems(
                PostUpdate,
                (
                    systems::forget,
                    systems::cycle,
                    systems::follow_assets,
                    combed::stroke,
                    systems::attach,
                    systems::follow_lights,
                    systems::follow_surfaces,
                    systems::follow_wind.run_if(resource_changed::<Wind>),
                )
                    .chain()
                    // An app without a renderer has none; it draws no texels either.
                    .run_if(resource_exists::<Assets<ShaderBuffer>>)
                    .in_set(VerdureSystems::Attach)
                    .before(AssetEventSystems),
            )
            .add_systems(
                PostUpdate,
                skin::follow_skins
                    .run_if(resource_exists::<Assets<ShaderBuffer>>)
                    .after(VerdureSystems::Attach)
                    .after(TransformSystems::Propagate)
                    .before(VisibilitySystems::CheckVisibility)
                    .before(AssetEventSystems),
            );

        let Some(render_app) = app.get_sub_app_mut(RenderApp) else {
            return;
        };
        render_app
            .init_resource::<bindings::TexelBindGroups>()
            .init_resource::<extract::ExtractedTexels>()
            .init_resource::<lists::SliceLists>()
            .init_resource::<stats::TexelStats>()
            .init_resource::<upload::FacetBuffers>()
            .init_resource::<upload::FacetWrites>()
            .add_render_command::<Opaque3d, commands::DrawTexelDepth>()
            .add_render_command::<AlphaMask3d, commands::DrawTexels>()
            .add_render_command::<AlphaMask3dPrepass, commands::DrawTexelsBefore>()
            .add_render_command::<Shadow, commands::DrawTexelsBefore>()
            .add_systems(ExtractSchedule, (extract::extract, upload::note))
            .add_systems(
                Render,
                (
                    commands::take_over_materials
                        .in_set(RenderSystems::PrepareAssets)
                        .after(prepare_erased_assets::<MeshMaterial3d<TexelMaterial>>),
                    (upload::upload, lists::list_slices).in_set(RenderSystems::PrepareResources),
                    bindings::prepare_bind_groups.in_set(RenderSystems::PrepareBindGroups),
                ),
            );
    }
}

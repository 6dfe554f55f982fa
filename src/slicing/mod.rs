//! Slicing: the sparse parts of a plant, its twigs and leaves, as blended slices.
//!
//! The method is that of Jakulin, *Interactive Vegetation Rendering with Slicing and Blending* (Eurographics 2000). From
//! 10 to 50 metres away the eye makes out no single leaf of a crown, and of its depth no more than a few layers that move
//! against one another. So the triangles of a crown are baked into a few parallel pictures, its slices, once for each of
//! some directions, and a crown costs a few quads.
//!
//! 1. [`bake()`] turns a [`CrownMesh`] into a [`Slicing`] on the CPU (`bake/`): for each orientation a box
//!    (`orientation.rs`), for each slice a picture of colour, alpha and normals, trimmed to what is opaque
//!    (`octagon.rs`), with mip levels that keep coverage (`pyramid.rs`). It is kept as a `*.slicing.ron` and its pictures
//!    (`document/`), which the asset server loads (`loader.rs`).
//! 2. [`SlicedCrown`] on an entity draws it (`component.rs`). `library.rs` keeps what is on the GPU
//!    (`upload.rs`) for the slicings in use, compressed if that is asked for ([`SlicingCompression`]); `material.rs` draws
//!    them in Bevy's own phases, with a mesh that holds nothing but numbers of slices (`mesh.rs`).
//! 3. For each view, the vertex shader picks the slicings of least discrepancy angle from the eye's position, their
//!    opacities and the order of their slices (`blend/`, `shaders/blend.wgsl`), and places the slices
//!    (`shaders/place.wgsl`). The fragment shaders light them by their baked normals, with the scene's lights, shadow maps
//!    and fog (`shaders/forward.wgsl`), in a way that suits what is there
//!    ([`PlantLighting`](crate::lighting::PlantLighting)), or let them cast shadows (`shaders/prepass.wgsl`).
//!
//! # How crowns are sorted
//! Blended crowns are items of Bevy's transparent phase rather than of a pass of their own: so they are in right order with
//! all else that is transparent, in every view. Neighbours in that order that are of one set of slicings and the same
//! settings are one draw. A set is made of slicings in use of as many pixels a slice, all compressed or none, with light
//! from behind in all or in none, a moment after the last of them has come (`gather.rs`), so that a grove of several kinds
//! of trees is one draw; until then each slicing is a set of its own (`set.rs`). Where a device draws nothing indirectly,
//! several are drawn in turns.
//! Bevy sorts by where an item was when it came into view; crowns that move are told it anew, and bands of crowns that may
//! intersect where they are (`bands.rs`, `sorting.rs`).
//!
//! # Where this departs from the paper
//! * Slices of a rank are drawn in the order of their orientations instead of the secondary before the primary one.
//!   Orientations only come and go at opacity 0, so nothing pops where primary and secondary are swapped. The paper's
//!   order is kept as [`SliceOrder::Paper`].
//! * A slicing is drawn alone on half the way to the swap ([`blend::ALONE`]), so that crowns have a quarter fewer slices.
//! * Blended slicings cover together what one of them covers alone, place by place ([`blend::covered`]), instead of by one
//!   correction f_c for the whole crown.
//! * A vertical slicing joins in as the eye rises (§4 proposes it), for eyes above and below.
//! * Slices are lit by the scene, not by the bake, and cast shadows; light from around is darker inside the crown.
//! * For eyes above and below, leaves of slices are turned to the eye ([`blend::leaning`]); for them, and with the sun
//!   behind the eye, shadows are received nearer to the sun ([`blend::towards_sun`]): such eyes see others of a crown's
//!   leaves than level ones beside it.
//! * In HDR blended slices count for more, since tone mapping comes after blending.
//! * Light comes through leaves from behind, as their material says.
//! * Up close the discrepancy angle is taken part by part ([`DiscrepancyAngle`]), which §4 proposes.
//! * Levels of fewer slices take over with distance, faded into one another.
//! * Directional lights see one slice that faces them, whose leaves lie at depths by chance ([`blend::first_leaf`]).
//! * Right up close a crown can give over to its mesh ([`close_up()`]), which §4 asks for.
//! * Crowns that intersect can be drawn in bands that are sorted each by itself ([`IntersectingCrown`]).
//! * Wind moves near slices more than far ones; see [`wind`](crate::wind).
//!
//! # What it does not do
//! Crowns that intersect are sorted whole, or band by band, not slice by slice. Within a few metres slices show where no
//! mesh takes over. Storage buffers in the vertex stage are required, so WebGL 2 is out.

pub mod bake;
mod bands;
pub mod blend;
mod close_up;
mod component;
mod compression;
mod document;
mod error;
mod eye;
mod gather;
mod library;
mod limits;
mod loader;
mod material;
mod mesh;
mod near;
pub mod octagon;
mod octahedral;
mod orientation;
mod pyramid;
mod set;
#[expect(
    clippy::module_inception,
    reason = "the file of the type that the folder is named after"
)]
mod slicing;
mod sorting;
#[cfg(test)]
mod tests;
mod upload;

use bevy::asset::AssetEventSystems;
use bevy::camera::CameraUpdateSystems;
use bevy::camera::visibility::VisibilitySystems;
use bevy::core_pipeline::core_3d::Transparent3d;
use bevy::pbr::MaterialPlugin;
use bevy::prelude::*;
use bevy::render::render_phase::sort_phase_system;
use bevy::render::storage::ShaderBuffer;
use bevy::render::{ExtractSchedule, Render, RenderApp, RenderSystems};
use bevy::shader::load_shader_library;

pub use bake::{
    BakeError, BakeSettings, CrownMaterial, CrownMesh, CrownTexture, CrownTriangle, CrownVertex,
    Separation, bake, bake_with_progress, separate,
};
#[cfg(feature = "lab")]
pub(crate) use bake::{bake_towards, bake_unchecked};
pub use blend::{DrawnSlice, SliceOrder};
pub use close_up::close_up;
pub use component::{
    Composition, CrownSettings, CrownTint, DiscrepancyAngle, IntersectingCrown, SlicedCrown,
};
pub use compression::SlicingCompression;
pub use document::{Picture, SlicingDocument, read_picture};
pub use error::{SlicingError, SlicingFileError, SlicingFileErrorKind};
pub use limits::{
    MAX_LAYERS, MAX_LEVELS, MAX_ORIENTATIONS, MAX_PIXELS, MAX_PIXELS_TOTAL, MAX_SLICES,
};
pub use loader::SlicingLoader;
pub use material::SlicedCrownMaterial;
pub use octagon::Octagon;
pub use orientation::{Orientation, Orientations};
pub use slicing::{Slicing, SlicingShape};

use crate::VerdureSystems;
use crate::lighting::LightingPlugin;
use crate::wind::Wind;

/// Loads [`Slicing`]s and draws [`SlicedCrown`]s.
///
/// Needs Bevy's rendering plugins, and [`WindPlugin`](crate::wind::WindPlugin).
pub struct SlicingPlugin;

impl Plugin for SlicingPlugin {
    fn build(&self, app: &mut App) {
        LightingPlugin::add_to(app);
        load_shader_library!(app, "shaders/types.wgsl");
        load_shader_library!(app, "shaders/blend.wgsl");
        load_shader_library!(app, "shaders/parts.wgsl");
        load_shader_library!(app, "shaders/seen.wgsl");
        load_shader_library!(app, "shaders/drawn.wgsl");
        load_shader_library!(app, "shaders/cast.wgsl");
        load_shader_library!(app, "shaders/lots.wgsl");
        load_shader_library!(app, "shaders/place.wgsl");
        load_shader_library!(app, "shaders/look.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/forward.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/prepass.wgsl");

        app.init_asset::<Slicing>()
            .register_asset_reflect::<Slicing>()
            .register_asset_loader(SlicingLoader)
            .add_plugins(MaterialPlugin::<SlicedCrownMaterial>::default())
            .register_type::<SlicedCrown>()
            .register_type::<CrownSettings>()
            .register_type::<CrownTint>()
            .register_type::<IntersectingCrown>()
            .register_type::<SlicingCompression>()
            .init_resource::<SlicingCompression>()
            .init_resource::<library::CrownLibrary>()
            .add_observer(library::uproot)
            .add_systems(
                PostUpdate,
                (
                    library::forget,
                    library::follow_slicings,
                    gather::gather,
                    library::attach,
                    library::follow_scene,
                    library::follow_wind.run_if(resource_changed::<Wind>),
                    library::tint,
                )
                    .chain()
                    // An app without a renderer has none; it draws no crowns either.
                    .run_if(resource_exists::<Assets<ShaderBuffer>>)
                    .in_set(VerdureSystems::Attach)
                    .before(AssetEventSystems),
            )
            .add_systems(
                PostUpdate,
                (
                    (near::draw_near, bands::follow_crowns, bands::sweep).chain(),
                    library::follow_sun,
                    library::follow_cameras,
                )
                    .run_if(resource_exists::<Assets<ShaderBuffer>>)
                    .after(VerdureSystems::Attach)
                    // Where crowns, cameras and suns are in this frame.
                    .after(TransformSystems::Propagate)
                    .after(CameraUpdateSystems)
                    .after(VisibilitySystems::VisibilityPropagate)
                    .before(VisibilitySystems::CheckVisibility)
                    .before(AssetEventSystems),
            );
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            render_app
                .init_resource::<sorting::SortedCrowns>()
                .add_systems(ExtractSchedule, sorting::extract)
                .add_systems(
                    Render,
                    sorting::place_items
                        .in_set(RenderSystems::PhaseSort)
                        .before(sort_phase_system::<Transparent3d>),
                );
        }
    }
}

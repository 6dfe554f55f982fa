//! Frusta: the solid parts of a plant, ray cast from its skeleton.
//!
//! The method is that of Bhagvat, Jeschke, Cline and Wonka, *GPU Rendering of Relief Mapped Conical Frusta* (2009).
//! Round each segment of a skeleton lies a cone, cut by planes where it meets its neighbours. No triangle of
//! that surface is ever made: twelve triangles bound each frustum, and the fragment shader intersects the ray
//! through its pixel with the cone.
//!
//! A frame goes like this:
//!
//! 1. Each plant's pose gives its joints' places ([`skeleton`](crate::skeleton)).
//! 2. For plants that moved, cones and cutting planes are recomputed (`math/cone.rs`, `math/join.rs`, `math/mitre.rs`),
//!    textures are lined up from segment to segment (`math/surface.rs`), and all of it is packed into 60 bytes a joint
//!    (`records.rs`).
//! 3. Their bounds are recomputed for culling (`extent.rs`), and what changed is written to the GPU (`table.rs`,
//!    `buffers.rs`). Plants that stand as their skeleton does share one copy: nothing is recomputed or written for them.
//! 4. Bevy draws plants as instances of a mesh without positions (`mesh.rs`), with a material that extends the standard
//!    one (`material.rs`). The vertex shader places the bounds (`math/bounds.rs`), the fragment shaders cast the ray
//!    (`math/cast.rs`) and shade the hit: one file each for the main pass, the prepasses and shadow maps, and deferred
//!    rendering, in `shaders/`.
//!
//! `shaders/place.wgsl` is the vertex stage of all passes and `shaders/trace.wgsl` the fragment stage;
//! `shaders/view.wgsl` leads from pixels to rays and back. `bounds`, `cast` and `surface` are there term for term what
//! they are in `math/`, whose files are compiled for `f32` as [`single`] and for `f64` as [`double`].
//!
//! The same surface in triangles, for collision, export and comparison, is
//! [`Skeleton::to_mesh`](crate::skeleton::Skeleton::to_mesh) (`polygons/`); of a plant that bends,
//! [`Skeleton::to_skinned_mesh`](crate::skeleton::Skeleton::to_skinned_mesh). Detail in true relief is told in [`relief`].
//!
//! # Where this departs from the paper
//! * Cones carry a signed slope instead of a height, so cylinders are no special case (Equations 1, 2).
//! * A joint's radius is that of a sphere which all its cones touch, so that neighbours meet exactly; the paper's
//!   planes and its iteration (Equations 3 to 5) are kept as [`Join::Paper`] and [`Join::PaperIterated`].
//! * Sharp bends fall back from a mitre to a sphere; branches start inside their parent; ends are closed.
//! * Of the quadratic's roots the first that lies on the frustum counts, not the nearest alone (Equation 10).
//! * One plane divides the whole shell of a relief where two segments meet, and u is in line all round it.
//! * Silhouettes are smooth with MSAA: along outlines every sample casts its own ray, each pixel is shaded once.
//!
//! # What it does not do
//! Bevy's own mesh picking and CPU ray casts see no triangles here; physics needs colliders of its own. Storage
//! buffers in the vertex stage are required, so WebGL 2 is out; see [`FrustaPlugin`].

#![allow(
    clippy::duplicate_mod,
    reason = "the files in math/ are compiled once for each precision"
)]

mod buffers;
mod component;
mod deferred;
pub mod double;
mod extent;
mod links;
mod material;
mod mesh;
mod plant;
pub mod polygons;
mod records;
pub mod relief;
mod shaping;
mod share;
pub mod single;
mod stats;
mod systems;
mod table;
#[cfg(test)]
mod tests;
mod to_mesh;
mod to_skinned_mesh;

use bevy::asset::AssetEventSystems;
use bevy::camera::visibility::NoAutoAabb;
use bevy::mesh::MeshTag;
use bevy::pbr::MaterialPlugin;
use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::render::{ExtractSchedule, GpuResourceAppExt, RenderApp};
use bevy::shader::load_shader_library;

pub use buffers::FrustaBuffers;
pub use component::{Ends, Frusta, Join};
pub use material::{
    FrustaExtension, FrustaKey, FrustaMaterial, FrustaOutput, ShadingNormals, frusta_material,
};
pub use polygons::{MeshError, MeshParts, MeshRelief, MeshSettings};
pub use relief::{Relief, ReliefMarch, ReliefSteps, ReliefThickness, ReliefV, relief_material};
pub use stats::FrustaStats;
pub use to_skinned_mesh::MAX_SKINNED_SEGMENTS;

use crate::VerdureSystems;
use crate::skeleton::Skeleton3d;

/// Draws plants that have a [`FrustaMaterial`].
///
/// Needs Bevy's rendering plugins. On a device that has no storage buffers for the vertex stage, such as WebGL 2, it
/// says so once in the log; plants stay invisible and the app runs on.
pub struct FrustaPlugin;

impl Plugin for FrustaPlugin {
    fn build(&self, app: &mut App) {
        load_shader_library!(app, "shaders/types.wgsl");
        load_shader_library!(app, "shaders/cast.wgsl");
        load_shader_library!(app, "shaders/bounds.wgsl");
        load_shader_library!(app, "shaders/surface.wgsl");
        load_shader_library!(app, "shaders/view.wgsl");
        load_shader_library!(app, "shaders/shell_radii.wgsl");
        load_shader_library!(app, "shaders/shell.wgsl");
        load_shader_library!(app, "shaders/place.wgsl");
        load_shader_library!(app, "shaders/relief.wgsl");
        load_shader_library!(app, "shaders/leap.wgsl");
        load_shader_library!(app, "shaders/march.wgsl");
        load_shader_library!(app, "shaders/self_shadow.wgsl");
        load_shader_library!(app, "shaders/trace.wgsl");
        load_shader_library!(app, "shaders/material.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/forward.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/prepass.wgsl");
        bevy::asset::embedded_asset!(app, "shaders/deferred.wgsl");

        app.add_plugins(MaterialPlugin::<FrustaMaterial>::default())
            .register_type::<Frusta>()
            .register_type::<FrustaStats>()
            .register_required_components::<Skeleton3d, Frusta>()
            .register_required_components::<Skeleton3d, Mesh3d>()
            .register_required_components::<Skeleton3d, MeshTag>()
            .register_required_components::<Skeleton3d, NoAutoAabb>()
            .init_resource::<share::FrustaData>()
            .init_resource::<mesh::FrustaMeshes>()
            .init_resource::<FrustaStats>()
            .init_resource::<relief::ReliefMaps>()
            .add_observer(systems::detach)
            .add_observer(systems::uproot)
            .add_systems(
                PostUpdate,
                (
                    (
                        systems::begin_frame,
                        mesh::refill.run_if(resource_exists_and_changed::<RenderDevice>),
                        systems::follow_skeletons,
                        systems::attach,
                    )
                        .chain()
                        .in_set(VerdureSystems::Attach),
                    systems::cut_planes.in_set(VerdureSystems::CuttingPlanes),
                    systems::update_bounds.in_set(VerdureSystems::Bounds),
                    (systems::collect, relief::follow_maps)
                        .in_set(VerdureSystems::Upload)
                        .before(AssetEventSystems),
                ),
            );
        if let Some(render_app) = app.get_sub_app_mut(RenderApp) {
            deferred::build(render_app);
            render_app
                .init_gpu_resource::<buffers::FrustaBuffers>()
                .init_gpu_resource::<relief::ReliefTextures>()
                .add_systems(
                    ExtractSchedule,
                    (buffers::upload, relief::upload).in_set(VerdureSystems::Upload),
                );
        }
    }

    fn finish(&self, app: &mut App) {
        let Some(device) = app.world().get_resource::<RenderDevice>() else {
            return;
        };
        if !material::is_supported(device) {
            error!(
                "plants are not drawn: this device offers {} storage buffers to a shader stage, and frusta \
                 need {}. Use a backend other than WebGL 2 (Vulkan, Metal, DirectX 12 or WebGPU)",
                device.limits().max_storage_buffers_per_shader_stage,
                material::STORAGE_BUFFERS,
            );
        }
    }
}

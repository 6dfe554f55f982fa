#![doc = include_str!("../README.md")]
//!
//! # Map of the crate
//!
//! | folder | what it is | reads |
//! |---|---|---|
//! | [`skeleton`] | joints, segments, poses; files; what a plant is before it has a surface | |
//! | [`frusta`] | solid parts: a cone round each segment, ray cast per pixel | `skeleton` |
//! | [`slicing`] | sparse parts: crowns of twigs and leaves, baked into blended slices | `wind`, `lighting` |
//! | [`texel`] | repeated cover: a volume in slices, mapped on a surface | `wind`, `lighting` |
//! | [`wind`] | the wind of a scene, in which crowns and texels sway | |
//! | [`lighting`] | what lights crowns, texels and wood: as Bevy does, or at less cost | |
//! | [`plants`] | skeletons grown from a seed: palms, pines, cacti, and scenes of them | `skeleton` |
//! | `lab` (a feature) | measuring: headless app, reference ray caster, image error | all |
//!
//! Arrows run one way: methods know `skeleton` at most and never each other, and nothing knows `lab`. Each folder's
//! module page tells its algorithm, with its sources; read it from top to bottom, then the files it names.
//!
//! A frame's work is ordered by [`VerdureSystems`], whose sets are public.
#![warn(missing_docs)]

mod draw_functions;
mod edited_assets;
pub mod frusta;
mod give_or_take;
#[cfg(feature = "lab")]
pub mod lab;
pub mod lighting;
mod pipeline;
pub mod plants;
mod ron_text;
pub mod skeleton;
pub mod slicing;
pub mod texel;
mod texture_array;
mod texture_compression;
pub mod wind;

use bevy::app::PluginGroupBuilder;
use bevy::camera::visibility::VisibilitySystems;
use bevy::prelude::*;

/// What most games import.
pub mod prelude {
    pub use crate::frusta::{
        Ends, Frusta, FrustaExtension, FrustaMaterial, FrustaOutput, FrustaStats, Join,
        MeshSettings, Relief, ReliefMarch, ReliefSteps, ReliefThickness, ShadingNormals,
        frusta_material, relief_material,
    };
    pub use crate::lighting::{LitAsPlant, PlantLighting, PlantMaterial};
    pub use crate::skeleton::{
        Joint, PosedJoints, SegmentEntities, Skeleton, Skeleton3d, SkeletonPose, SkeletonSegment,
        UnfoldSkeleton,
    };
    pub use crate::slicing::{
        BakeSettings, Composition, CrownMaterial, CrownMesh, CrownSettings, CrownTint,
        DiscrepancyAngle, IntersectingCrown, Orientations, SliceOrder, SlicedCrown, Slicing,
        SlicingCompression, bake,
    };
    pub use crate::texel::{
        ATTRIBUTE_HEIGHT_VECTOR, LiveTexels, StrokedTexels, TexelBrush, TexelCycle, TexelHeights,
        TexelQuality, TexelSettings, TexelSurface, TexelVolume,
    };
    pub use crate::wind::Wind;
    pub use crate::{VerdurePlugin, VerdureSystems};
}

/// All of bevy_verdure: one plugin a method, and the skeletons they grow on.
///
/// ```no_run
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// App::new().add_plugins((DefaultPlugins, VerdurePlugin)).run();
/// ```
pub struct VerdurePlugin;

impl PluginGroup for VerdurePlugin {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(SchedulePlugin)
            .add(skeleton::SkeletonPlugin)
            .add(skeleton::PlantPlugin)
            .add(frusta::FrustaPlugin)
            .add(wind::WindPlugin)
            .add(slicing::SlicingPlugin)
            .add(texel::TexelVolumePlugin)
            .add(texel::TexelPlugin)
    }
}

/// The stages of a frame in which plants are brought up to date, in this order, in [`PostUpdate`]: after
/// animation, before visibility is found. Put systems of your own before or after them.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum VerdureSystems {
    /// Plants are unfolded, and given a place on the GPU once their skeleton is loaded.
    Attach,
    /// Poses become joint positions. Systems that pose plants run before this.
    Pose,
    /// Cones and cutting planes are recomputed for what moved.
    CuttingPlanes,
    /// [`Aabb`](bevy::camera::primitives::Aabb)s are recomputed for what moved.
    Bounds,
    /// What changed is gathered, and, in the render world's `ExtractSchedule`, copied to the GPU.
    Upload,
}

/// Orders [`VerdureSystems`] in the frame.
struct SchedulePlugin;

impl Plugin for SchedulePlugin {
    fn build(&self, app: &mut App) {
        app.configure_sets(
            PostUpdate,
            (
                VerdureSystems::Attach,
                VerdureSystems::Pose,
                VerdureSystems::CuttingPlanes,
                VerdureSystems::Bounds,
                VerdureSystems::Upload,
            )
                .chain()
                .after(bevy::app::AnimationSystems)
                // Segments that were spawned or moved on reload are in place in the same frame.
                .before(TransformSystems::Propagate)
                .before(VisibilitySystems::CalculateBounds)
                .before(VisibilitySystems::CheckVisibility),
        );
    }
}

//! The component that makes an entity a plant.

use bevy::asset::{AsAssetId, AssetId};
use bevy::prelude::*;

use super::{Skeleton, pose, unfold};
use crate::VerdureSystems;

/// A plant: an entity with the shape of a [`Skeleton`].
///
/// Spawn it with a material of the method that draws it; transform and visibility are filled in. Any invertible
/// [`Transform`] is fine, mirrored and non-uniformly scaled ones included. Plants that stand as their skeleton
/// does share all of its data; add [`SkeletonPose`](super::SkeletonPose) or
/// [`UnfoldSkeleton`](super::UnfoldSkeleton) to bend one.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// fn plant_an_oak(
///     mut commands: Commands,
///     assets: Res<AssetServer>,
///     mut materials: ResMut<Assets<FrustaMaterial>>,
/// ) {
///     commands.spawn((
///         Skeleton3d(assets.load("oak.skeleton.ron")),
///         MeshMaterial3d(materials.add(frusta_material(Color::srgb(0.4, 0.3, 0.2)))),
///         Transform::from_xyz(4.0, 0.0, -2.0),
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, Default, Deref, DerefMut, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(Transform, Visibility)]
pub struct Skeleton3d(pub Handle<Skeleton>);

impl AsAssetId for Skeleton3d {
    type Asset = Skeleton;

    fn as_asset_id(&self) -> AssetId<Skeleton> {
        self.0.id()
    }
}

impl From<Handle<Skeleton>> for Skeleton3d {
    fn from(handle: Handle<Skeleton>) -> Self {
        Self(handle)
    }
}

/// Makes entities with a [`Skeleton3d`] plants that can be bent.
pub struct PlantPlugin;

impl Plugin for PlantPlugin {
    fn build(&self, app: &mut App) {
        app.register_type::<Skeleton3d>()
            .register_type::<super::SkeletonPose>()
            .register_type::<super::PosedJoints>()
            .register_type::<super::UnfoldSkeleton>()
            .register_type::<super::SkeletonSegment>()
            .register_type::<super::SegmentEntities>()
            .add_observer(unfold::fold)
            .add_observer(unfold::forget_segment)
            .add_observer(pose::let_go)
            .add_systems(
                PostUpdate,
                (
                    unfold::unfold.in_set(VerdureSystems::Attach),
                    (pose::pose_from_rotations, unfold::pose_from_segments)
                        .in_set(VerdureSystems::Pose),
                ),
            );
    }
}

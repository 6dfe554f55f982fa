//! Unfolding a plant into one entity a segment, so that anything that moves entities bends it.

use bevy::asset::prelude::AssetChanged;
use bevy::math::Affine3A;
use bevy::prelude::*;

use super::pose::rest_translation;
use super::{Joint, PosedJoints, Skeleton, Skeleton3d, SkeletonPose};

/// Unfolds a plant into one child entity a segment ([`SkeletonSegment`]), once its skeleton is loaded.
///
/// Segments are children along the hierarchy: each is a child of the segment that its own starts from, those at a
/// root children of the plant. A segment's origin is its start, its axes are the plant's at rest, so its rest
/// [`Transform`] is a translation alone. Rotate it and all that hangs on it bends along; what a rotation turns about
/// the segment's own axis turns its texture. Move it, and all that hangs on it moves along; a root moves with the
/// first segment that begins there. Each has a [`Name`], `Segment 7`, so that animation clips can address it.
///
/// When the skeleton is reloaded, segments move to their new places and keep their rotations and all that hangs on
/// them; only if joints have come, gone or found other parents is the plant unfolded anew, and then what hangs on its
/// segments is despawned with them. Removing this component folds the plant up again: its segments are despawned and
/// it stands at rest.
///
/// Skeletons with more than 2,048 segments in a row are not unfolded; an error in the log says so.
///
/// An animation clip finds a segment by its [`Name`] once the segment has an `AnimationTargetId::from_name` of it and an
/// `AnimatedBy` of the player's entity.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(PosedJoints)]
pub struct UnfoldSkeleton;

/// One segment of an unfolded plant. Its [`Transform`] bends the plant.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq, Reflect)]
#[reflect(Component, Clone, Debug, PartialEq)]
#[require(Transform, Visibility)]
pub struct SkeletonSegment {
    /// The plant's entity.
    #[entities]
    pub plant: Entity,
    /// Index of the joint that ends this segment.
    pub joint: u32,
}

/// The segments of an unfolded plant, by joint; roots, which end no segment, have none. A clone of a plant unfolds
/// segments of its own.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[component(clone_behavior = Ignore)]
pub struct SegmentEntities {
    #[entities]
    entities: Vec<Option<Entity>>,
    /// The parents of the joints, by which a reload is told from another hierarchy.
    parents: Vec<Option<u32>>,
    /// Where the segments sit in their parent segments' frames at rest, by which a reload is told from none: that an
    /// asset was added is told as a change as well, a frame later.
    rests: Vec<Vec3>,
}

impl SegmentEntities {
    /// The entity of the segment that ends at `joint`.
    pub fn get(&self, joint: usize) -> Option<Entity> {
        self.entities.get(joint).copied().flatten()
    }

    /// All segments with their joints' indices, parents first.
    pub fn iter(&self) -> impl Iterator<Item = (usize, Entity)> + '_ {
        let with_index = self.entities.iter().enumerate();
        with_index.filter_map(|(joint, entity)| Some((joint, (*entity)?)))
    }
}

/// Longest row of segments, each the child of the one before, that is unfolded.
const MAX_LEVELS: usize = 2048;

/// Segments in the longest row.
fn levels(joints: &[Joint]) -> usize {
    let mut levels: Vec<usize> = Vec::with_capacity(joints.len());
    for joint in joints {
        levels.push(joint.parent.map_or(0, |parent| levels[parent as usize] + 1));
    }
    levels.into_iter().max().unwrap_or(0)
}

/// What tells that a plant is to be unfolded, perhaps anew.
type Folded = (
    With<UnfoldSkeleton>,
    Or<(
        Without<SegmentEntities>,
        Changed<Skeleton3d>,
        AssetChanged<Skeleton3d>,
    )>,
);

/// Spawns the segments of plants that are to be unfolded and whose skeleton is loaded.
pub(crate) fn unfold(
    mut commands: Commands,
    skeletons: Res<Assets<Skeleton>>,
    mut plants: Query<(&Skeleton3d, Option<&mut SegmentEntities>), With<UnfoldSkeleton>>,
    changed: Query<Entity, Folded>,
    mut segments: Query<&mut Transform, With<SkeletonSegment>>,
    owners: Query<&SkeletonSegment>,
) {
    for plant in &changed {
        let Ok((skeleton3d, unfolded)) = plants.get_mut(plant) else {
            continue;
        };
        let Some(skeleton) = skeletons.get(skeleton3d.id()) else {
            continue;
        };
        let joints = skeleton.joints();
        let levels = levels(joints);
        if levels > MAX_LEVELS {
            error_once!(
                "a skeleton of {levels} segments in a row cannot be unfolded: Bevy follows a hierarchy by recursion, and \
                 {MAX_LEVELS} is the limit. Bend it with `SkeletonPose`"
            );
            continue;
        }
        let parents: Vec<_> = joints.iter().map(|joint| joint.parent).collect();
        let rest = |i| rest_translation(joints, i);
        let rests: Vec<_> = (0..joints.len()).map(rest).collect();
        if let Some(mut unfolded) = unfolded {
            if unfolded.parents == parents {
                unfolded.set_changed();
                for (i, entity) in unfolded.iter() {
                    if rests[i] != unfolded.rests[i]
                        && let Ok(mut segment) = segments.get_mut(entity)
                    {
                        segment.translation = rests[i];
                    }
                }
                unfolded.rests = rests;
                continue;
            }
            despawn_segments(&mut commands, plant, &unfolded, &owners);
        }
        let mut entities: Vec<Option<Entity>> = Vec::with_capacity(joints.len());
        for (i, joint) in joints.iter().enumerate() {
            let entity = joint.parent.map(|parent| {
                let above = entities[parent as usize].unwrap_or(plant);
                commands
                    .spawn((
                        Name::new(format!("Segment {i}")),
                        SkeletonSegment {
                            plant,
                            joint: i as u32,
                        },
                        Transform::from_translation(rests[i]),
                        ChildOf(above),
                    ))
                    .id()
            });
            entities.push(entity);
        }
        commands.entity(plant).insert(SegmentEntities {
            entities,
            parents,
            rests,
        });
    }
}

/// Folds a plant up when [`UnfoldSkeleton`] is removed from it.
pub(crate) fn fold(
    removed: On<Remove, UnfoldSkeleton>,
    mut commands: Commands,
    plants: Query<&SegmentEntities>,
    segments: Query<&SkeletonSegment>,
    posed: Query<(), With<SkeletonPose>>,
) {
    if let Ok(unfolded) = plants.get(removed.entity) {
        despawn_segments(&mut commands, removed.entity, unfolded, &segments);
    }
    if let Ok(mut plant) = commands.get_entity(removed.entity) {
        plant.try_remove::<SegmentEntities>();
        // A pose by rotations takes over, if there is one.
        match posed.contains(removed.entity) {
            true => plant.try_insert(PosedJoints::default()),
            false => plant.try_remove::<PosedJoints>(),
        };
    }
}

fn despawn_segments(
    commands: &mut Commands,
    plant: Entity,
    unfolded: &SegmentEntities,
    segments: &Query<&SkeletonSegment>,
) {
    let own = |entity| {
        segments
            .get(entity)
            .is_ok_and(|segment| segment.plant == plant)
    };
    for (_, entity) in unfolded.iter().filter(|(_, entity)| own(*entity)) {
        // Despawning one despawns those that hang on it; later ones may be gone.
        if let Ok(mut segment) = commands.get_entity(entity) {
            segment.try_despawn();
        }
    }
}

/// Lets the rest of a plant know that one of its segments is gone: it stands there as it does at rest.
pub(crate) fn forget_segment(
    removed: On<Remove, SkeletonSegment>,
    segments: Query<&SkeletonSegment>,
    mut plants: Query<&mut SegmentEntities>,
) {
    if let Ok(segment) = segments.get(removed.entity)
        && let Ok(mut unfolded) = plants.get_mut(segment.plant)
        && unfolded.get(segment.joint as usize) == Some(removed.entity)
    {
        unfolded.entities[segment.joint as usize] = None;
    }
}

/// Poses unfolded plants of which any segment's [`Transform`] has changed.
pub(crate) fn pose_from_segments(
    skeletons: Res<Assets<Skeleton>>,
    segments: Query<Ref<Transform>, With<SkeletonSegment>>,
    mut plants: Query<(&Skeleton3d, Ref<SegmentEntities>, &mut PosedJoints), With<UnfoldSkeleton>>,
) {
    plants
        .par_iter_mut()
        .for_each(|(skeleton, unfolded, mut posed)| {
            let Some(skeleton) = skeletons.get(&skeleton.0) else {
                return;
            };
            if unfolded.entities.len() != skeleton.len() {
                return;
            }
            let moved = unfolded.is_changed()
                || unfolded.iter().any(|(_, entity)| {
                    segments
                        .get(entity)
                        .is_ok_and(|transform| transform.is_changed())
                });
            if !moved {
                return;
            }
            let joints = skeleton.joints();
            posed.set(joints, |i| {
                let transform = unfolded.entities[i].and_then(|entity| segments.get(entity).ok());
                match transform {
                    Some(transform) if transform.is_finite() => transform.compute_affine(),
                    // A segment that is gone, or nowhere, stands as it does at rest.
                    _ => Affine3A::from_translation(rest_translation(joints, i)),
                }
            });
        });
}

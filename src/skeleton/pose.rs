//! Poses: where the joints of a bent plant are.

use bevy::asset::prelude::AssetChanged;
use bevy::math::Affine3A;
use bevy::prelude::*;

use super::{Joint, Skeleton, Skeleton3d, UnfoldSkeleton, roll};

/// Bends a plant by a rotation a joint: the cheap way, for crowds.
///
/// What a rotation turns about the segment's own axis bends nothing; it turns the segment's texture, and that of what
/// continues it or grows on it.
///
/// Write the rotations from any system before [`VerdureSystems::Pose`](crate::VerdureSystems::Pose); nothing is
/// recomputed while this component is unchanged. Without effect on a plant that is unfolded
/// ([`UnfoldSkeleton`]); removing it lets the plant stand at rest.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(PosedJoints)]
pub struct SkeletonPose {
    /// For each joint, by index, the rotation of the segment that ends there, about its parent's joint, on top
    /// of its parent's segment. In the plant's local axes as the skeleton stands at rest. Joints
    /// without an entry, and those whose entry is not finite, stay as they are at rest; entries of roots turn
    /// nothing.
    pub rotations: Vec<Quat>,
}

/// The pose of a plant that does not stand as its skeleton does, computed in
/// [`VerdureSystems::Pose`](crate::VerdureSystems::Pose). Empty until then.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
pub struct PosedJoints {
    /// Position of each joint, in metres, in the plant's local space.
    pub(crate) positions: Vec<Vec3>,
    /// Frame of each segment: maps its rest frame, with the origin at the segment's start, to local space.
    pub(crate) frames: Vec<Affine3A>,
    /// Turn of each segment about its own axis, within its parent segment's frame, as cosine and sine; empty where none
    /// is turned.
    rolls: Vec<Vec2>,
}

impl PosedJoints {
    /// Position of each joint, by index, in metres, in the plant's local space.
    pub fn positions(&self) -> &[Vec3] {
        &self.positions
    }

    /// The frame of the segment that ends at `joint`: maps the rest frame, with its origin at the segment's start
    /// and the plant's local axes, to where the segment is now. `None` before the first pose.
    pub fn frame(&self, joint: usize) -> Option<Affine3A> {
        self.frames.get(joint).copied()
    }

    /// The turn of the segment that ends at `joint` about its own axis, within its parent segment's frame, by the right
    /// hand: cosine and sine.
    pub(crate) fn roll(&self, joint: usize) -> Option<[f32; 2]> {
        self.rolls.get(joint).map(Vec2::to_array)
    }

    /// Poses all joints. `local(i)` is the transform of segment `i` within its parent segment's frame.
    pub(crate) fn set(&mut self, joints: &[Joint], local: impl Fn(usize) -> Affine3A) {
        self.positions.resize(joints.len(), Vec3::ZERO);
        self.frames.resize(joints.len(), Affine3A::IDENTITY);
        self.rolls.clear();
        let mut is_root_moved = false;
        for (i, joint) in joints.iter().enumerate() {
            let Some(parent) = joint.parent else {
                self.positions[i] = joint.position;
                self.frames[i] = Affine3A::IDENTITY;
                continue;
            };
            let parent = parent as usize;
            let along = joint.position - joints[parent].position;
            let local = local(i);
            if let Some(roll) = roll::about(along, &local) {
                self.rolls.resize(joints.len(), Vec2::X);
                self.rolls[i] = roll;
            }
            let frame = self.frames[parent] * local;
            self.frames[i] = frame;
            self.positions[i] = frame.transform_point3(along);
            is_root_moved |= joints[parent].parent.is_none()
                && Vec3::from(frame.translation) != joints[parent].position;
        }
        if is_root_moved {
            self.move_roots(joints);
        }
    }

    /// Moves each root to where the first segment that begins there starts.
    fn move_roots(&mut self, joints: &[Joint]) {
        for (joint, frame) in joints.iter().zip(&self.frames).rev() {
            if let Some(parent) = joint.parent
                && joints[parent as usize].parent.is_none()
            {
                self.positions[parent as usize] = frame.translation.into();
            }
        }
    }
}

/// Where a segment's frame sits in its parent segment's frame at rest.
pub(crate) fn rest_translation(joints: &[Joint], i: usize) -> Vec3 {
    let Some(parent) = joints[i].parent else {
        return joints[i].position;
    };
    let parent = &joints[parent as usize];
    match parent.parent {
        Some(grandparent) => parent.position - joints[grandparent as usize].position,
        None => parent.position,
    }
}

/// What is looked at to bend a plant by rotations.
type Bendable<'w> = (
    Entity,
    Ref<'w, Skeleton3d>,
    Ref<'w, SkeletonPose>,
    &'w mut PosedJoints,
);

/// Poses the plants whose [`SkeletonPose`], or whose skeleton, has changed.
pub(crate) fn pose_from_rotations(
    skeletons: Res<Assets<Skeleton>>,
    changed: Query<(), AssetChanged<Skeleton3d>>,
    mut plants: Query<Bendable, Without<UnfoldSkeleton>>,
) {
    plants
        .par_iter_mut()
        .for_each(|(entity, skeleton3d, pose, mut posed)| {
            let Some(skeleton) = skeletons.get(&skeleton3d.0) else {
                return;
            };
            let joints = skeleton.joints();
            // An asset's change is told a frame late: a plant whose skeleton has only now come is known by its joints.
            let turned = pose.is_changed()
                || skeleton3d.is_changed()
                || posed.positions.len() != joints.len()
                || changed.contains(entity);
            if !turned {
                return;
            }
            posed.set(joints, |i| {
                let rotation = pose.rotations.get(i).copied().unwrap_or_default();
                let rotation = if rotation.is_finite() {
                    rotation
                } else {
                    Quat::IDENTITY
                };
                Affine3A::from_rotation_translation(rotation, rest_translation(joints, i))
            });
        });
}

/// Lets a plant stand at rest when its [`SkeletonPose`] is removed.
pub(crate) fn let_go(
    removed: On<Remove, SkeletonPose>,
    mut commands: Commands,
    unfolded: Query<(), With<UnfoldSkeleton>>,
) {
    if !unfolded.contains(removed.entity)
        && let Ok(mut plant) = commands.get_entity(removed.entity)
    {
        plant.try_remove::<PosedJoints>();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f32::consts::FRAC_PI_2;

    #[test]
    fn a_rotation_carries_all_that_hangs_on_its_segment() {
        let joints = [
            Joint::root(Vec3::X, 0.1),
            Joint::new(Vec3::new(1.0, 1.0, 0.0), 0.1, 0),
            Joint::new(Vec3::new(1.0, 2.0, 0.0), 0.1, 1),
        ];
        let mut posed = PosedJoints::default();
        posed.set(&joints, |i| {
            let turn = if i == 1 { FRAC_PI_2 } else { 0.0 };
            Affine3A::from_rotation_translation(
                Quat::from_rotation_z(turn),
                rest_translation(&joints, i),
            )
        });
        // A quarter turn to the left about (1, 0, 0); 4 roundings of numbers below 2.
        for (position, expected) in
            posed
                .positions
                .iter()
                .zip([Vec3::X, Vec3::ZERO, Vec3::new(-1.0, 0.0, 0.0)])
        {
            assert!(position.distance(expected) < 4.0 * 2.0 * f32::EPSILON);
        }
    }
}

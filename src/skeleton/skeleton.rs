//! Skeletons: what a plant is before it has a surface.

use bevy::asset::Asset;
use bevy::math::DVec3;
use bevy::prelude::{Reflect, ReflectDefault, ReflectDeserialize, ReflectSerialize};
use serde::Deserialize;

use super::builder::SkeletonBuilder;
use super::document::SkeletonDocument;
use super::error::SkeletonError;
use super::joint::Joint;
use super::order::parents_first;

/// Most joints that a [`Skeleton`] may have: as many as fit one storage buffer of the size that every device offers.
pub const MAX_JOINTS: usize = 2_000_000;

/// The joints of a plant, each naming its parent: a forest of any number of trees.
///
/// What [`Skeleton::new`] has let through keeps these promises, and code that is given a skeleton may rely
/// on them:
///
/// * there are between 1 and [`MAX_JOINTS`] joints;
/// * every joint comes after its parent, so that one pass from the first to the last meets each parent
///   before its children;
/// * every number is finite and in the range that [`Joint`] gives for it.
///
/// Only [`Skeleton::default`], which has no joints, is outside the first.
///
/// As serde data a skeleton is its joints and, where it has one, its offset; reading goes through the
/// checks of [`Skeleton::new`]. [`to_ron`](Self::to_ron) writes the `*.skeleton.ron` format.
#[derive(Asset, Reflect, Clone, Debug, Default, PartialEq, Deserialize)]
#[reflect(opaque)]
#[reflect(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "SkeletonDocument")]
pub struct Skeleton {
    joints: Vec<Joint>,
    offset: DVec3,
}

impl Skeleton {
    /// Checks `joints` and makes a skeleton of them, with no [`offset`](Self::offset).
    ///
    /// The order of the joints is kept when every parent comes before its children. Else each joint stays
    /// at its turn, right after those of its ancestors that have not come yet, and parent indices are
    /// renumbered.
    ///
    /// # Errors
    /// When there are no joints or more than [`MAX_JOINTS`]; a number is outside the range that [`Joint`]
    /// gives; a parent is no joint; or joints are each other's ancestors. Joints are named by their index
    /// in `joints`.
    pub fn new(mut joints: Vec<Joint>) -> Result<Self, SkeletonError> {
        if joints.is_empty() {
            return Err(SkeletonError::Empty);
        }
        if joints.len() > MAX_JOINTS {
            return Err(SkeletonError::TooManyJoints);
        }
        let count = joints.len() as u32;
        for (joint, index) in joints.iter().zip(0..) {
            joint.validate(index)?;
            if let Some(parent) = joint.parent.filter(|&parent| parent >= count) {
                return Err(SkeletonError::MissingParent {
                    joint: index,
                    parent,
                    count,
                });
            }
        }
        let parents: Vec<_> = joints.iter().map(|joint| joint.parent).collect();
        match parents_first(&parents) {
            Ok(None) => {}
            Ok(Some(order)) => joints = reorder(&joints, &order),
            Err(joint) => return Err(SkeletonError::Cycle { joint }),
        }
        Ok(Self {
            joints,
            offset: DVec3::ZERO,
        })
    }

    /// Starts a skeleton that is written down joint by joint.
    pub fn builder() -> SkeletonBuilder {
        SkeletonBuilder::default()
    }

    /// The joints, parents first. Positions are in metres, in the plant's local space.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// How many joints there are.
    pub fn len(&self) -> usize {
        self.joints.len()
    }

    /// Whether there are no joints, as in [`Skeleton::default`] and in no other.
    pub fn is_empty(&self) -> bool {
        self.joints.is_empty()
    }

    /// How many segments there are: joints that have a parent.
    pub fn segment_count(&self) -> usize {
        let has_parent = |joint: &&Joint| joint.parent.is_some();
        self.joints.iter().filter(has_parent).count()
    }

    /// Where the local origin of this skeleton was in the file that it came from: in the file's own axes
    /// and units, before its `up` axis and `scale` were applied.
    ///
    /// Zero unless the file was recentred (see [`Recentre`](super::Recentre)). Two plants of one survey
    /// stand the difference of their offsets apart. Drawing a skeleton does not use it.
    pub fn offset(&self) -> DVec3 {
        self.offset
    }

    /// The same skeleton with another [`offset`](Self::offset).
    ///
    /// # Errors
    /// When a coordinate of `offset` is not finite.
    pub fn with_offset(mut self, offset: DVec3) -> Result<Self, SkeletonError> {
        if !offset.is_finite() {
            return Err(SkeletonError::Offset { offset });
        }
        self.offset = offset;
        Ok(self)
    }
}

/// The joints in the `order` of their old indices, their parents renumbered.
fn reorder(joints: &[Joint], order: &[u32]) -> Vec<Joint> {
    let mut new_index = vec![0; joints.len()];
    for (&old, new) in order.iter().zip(0_u32..) {
        new_index[old as usize] = new;
    }
    let moved = order.iter().map(|&old| {
        let mut joint = joints[old as usize].clone();
        joint.parent = joint.parent.map(|parent| new_index[parent as usize]);
        joint
    });
    moved.collect()
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    fn at(height: f32) -> Vec3 {
        Vec3::Y * height
    }

    #[test]
    fn joints_that_come_after_their_parents_keep_their_order() {
        let joints = vec![
            Joint::root(at(0.0), 0.3),
            Joint::new(at(1.0), 0.2, 0),
            Joint::root(at(5.0), 0.3),
            Joint::new(at(2.0), 0.1, 1),
        ];
        let skeleton = Skeleton::new(joints.clone()).unwrap();
        assert_eq!(skeleton.joints(), joints);
        assert_eq!((skeleton.len(), skeleton.segment_count()), (4, 2));
        assert_eq!(skeleton.offset(), DVec3::ZERO);
    }

    #[test]
    fn parents_are_moved_before_their_children_and_renumbered() {
        let skeleton = Skeleton::new(vec![
            Joint::new(at(2.0), 0.1, 2).with_twist(1.0),
            Joint::root(at(5.0), 0.3),
            Joint::new(at(1.0), 0.2, 3),
            Joint::root(at(0.0), 0.3),
        ]);
        let expected = [
            Joint::root(at(0.0), 0.3),
            Joint::new(at(1.0), 0.2, 0),
            Joint::new(at(2.0), 0.1, 1).with_twist(1.0),
            Joint::root(at(5.0), 0.3),
        ];
        assert_eq!(skeleton.unwrap().joints(), expected);
    }

    #[test]
    fn joints_are_named_by_their_index_before_reordering() {
        let joints = vec![Joint::new(at(1.0), -0.5, 1), Joint::root(at(0.0), 0.3)];
        assert_eq!(
            Skeleton::new(joints),
            Err(SkeletonError::Radius {
                joint: 0,
                radius: -0.5
            })
        );
    }

    #[test]
    fn a_parent_must_be_a_joint() {
        let joints = vec![Joint::root(at(0.0), 0.3), Joint::new(at(1.0), 0.2, 2)];
        assert_eq!(
            Skeleton::new(joints),
            Err(SkeletonError::MissingParent {
                joint: 1,
                parent: 2,
                count: 2
            })
        );
    }

    #[test]
    fn joints_cannot_be_their_own_ancestors() {
        let own_parent = vec![Joint::root(at(0.0), 0.3), Joint::new(at(1.0), 0.2, 1)];
        assert_eq!(
            Skeleton::new(own_parent),
            Err(SkeletonError::Cycle { joint: 1 })
        );
        let ring = vec![Joint::new(at(0.0), 0.3, 1), Joint::new(at(1.0), 0.2, 0)];
        assert_eq!(Skeleton::new(ring), Err(SkeletonError::Cycle { joint: 0 }));
    }

    #[test]
    fn joints_are_counted_before_they_are_looked_at() {
        assert_eq!(Skeleton::new(Vec::new()), Err(SkeletonError::Empty));
        let joint = Joint::root(Vec3::NAN, 0.3);
        assert_eq!(
            Skeleton::new(vec![joint; MAX_JOINTS + 1]),
            Err(SkeletonError::TooManyJoints)
        );
    }

    #[test]
    fn an_offset_is_finite() {
        let skeleton = Skeleton::new(vec![Joint::root(at(0.0), 0.3)]).unwrap();
        let utm = DVec3::new(384_512.25, 6_671_034.5, 112.0);
        let moved = skeleton.clone().with_offset(utm).unwrap();
        assert_eq!(moved.offset(), utm);
        let error = skeleton.with_offset(DVec3::new(0.0, f64::NAN, 0.0));
        assert!(matches!(error, Err(SkeletonError::Offset { .. })));
    }

    #[test]
    fn the_default_is_empty() {
        assert!(Skeleton::default().is_empty());
    }
}

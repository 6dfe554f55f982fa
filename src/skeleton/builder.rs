//! Writing a skeleton down in code.

use bevy::math::Vec3;

use super::error::SkeletonError;
use super::joint::Joint;
use super::skeleton::Skeleton;

/// Makes a [`Skeleton`] joint by joint, each by the index of the joint that it grows from.
///
/// Indices count joints in the order in which they are added, from 0, and are those of
/// [`Skeleton::joints`]. Mistakes are kept until [`build`](Self::build), which returns the first.
///
/// ```
/// use bevy::math::Vec3;
/// use bevy_verdure::skeleton::Skeleton;
///
/// let mut plant = Skeleton::builder();
/// let base = plant.root(Vec3::ZERO, 0.20);
/// let fork = plant.joint(base, Vec3::Y * 2.0, 0.15);
/// plant.chain(fork, &[(Vec3::new(0.5, 2.8, 0.0), 0.08), (Vec3::new(0.7, 3.6, 0.0), 0.03)]);
/// let side = plant.joint(fork, Vec3::new(-0.6, 2.7, 0.1), 0.06);
/// plant.twist(side, 0.5).texture_length(side, 0.4);
/// let plant = plant.build()?;
/// assert_eq!(plant.segment_count(), 4);
/// # Ok::<(), bevy_verdure::skeleton::SkeletonError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct SkeletonBuilder {
    joints: Vec<Joint>,
    mistake: Option<SkeletonError>,
}

impl SkeletonBuilder {
    /// Adds a joint without parent and returns its index. `position` is in metres, in the plant's local
    /// space; `radius` in metres.
    pub fn root(&mut self, position: Vec3, radius: f32) -> u32 {
        self.add(Joint::root(position, radius))
    }

    /// Adds a joint that grows from the joint `parent` and returns its index. `position` is in metres, in
    /// the plant's local space; `radius` in metres.
    pub fn joint(&mut self, parent: u32, position: Vec3, radius: f32) -> u32 {
        self.add(Joint::new(position, radius, parent))
    }

    /// Adds joints one after the other, each growing from the one before and the first from the joint
    /// `from`, as positions and radii. Returns the index of the last, or `from` when there are none.
    pub fn chain(&mut self, from: u32, joints: &[(Vec3, f32)]) -> u32 {
        joints.iter().fold(from, |parent, &(position, radius)| {
            self.joint(parent, position, radius)
        })
    }

    /// Sets the [`twist`](Joint::twist) of a joint that was added before, in radians.
    pub fn twist(&mut self, joint: u32, radians: f32) -> &mut Self {
        self.change(joint, |joint| joint.twist = radians)
    }

    /// Sets the [`texture_length`](Joint::texture_length) of a joint that was added before, in metres.
    pub fn texture_length(&mut self, joint: u32, metres: f32) -> &mut Self {
        self.change(joint, |joint| joint.texture_length = Some(metres))
    }

    /// Checks all joints and makes the skeleton.
    ///
    /// # Errors
    /// The first mistake: a parent or joint that had not been added when it was named, else whatever
    /// [`Skeleton::new`] refuses.
    pub fn build(self) -> Result<Skeleton, SkeletonError> {
        match self.mistake {
            Some(mistake) => Err(mistake),
            None => Skeleton::new(self.joints),
        }
    }

    fn add(&mut self, joint: Joint) -> u32 {
        let index = u32::try_from(self.joints.len()).unwrap_or(u32::MAX);
        // `Skeleton::new` would let a parent follow its child, and then reorder; here indices are fixed.
        if let Some(parent) = joint.parent.filter(|&parent| parent >= index) {
            self.mistake.get_or_insert(SkeletonError::MissingParent {
                joint: index,
                parent,
                count: index,
            });
        }
        self.joints.push(joint);
        index
    }

    fn change(&mut self, joint: u32, edit: impl FnOnce(&mut Joint)) -> &mut Self {
        match self.joints.get_mut(joint as usize) {
            Some(joint) => edit(joint),
            None => {
                let count = u32::try_from(self.joints.len()).unwrap_or(u32::MAX);
                self.mistake
                    .get_or_insert(SkeletonError::MissingJoint { joint, count });
            }
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_count_joints_as_they_are_added() {
        let mut plant = Skeleton::builder();
        let base = plant.root(Vec3::ZERO, 0.2);
        let top = plant.chain(base, &[(Vec3::Y, 0.1), (Vec3::Y * 2.0, 0.05)]);
        let side = plant.joint(1, Vec3::X, 0.02);
        assert_eq!((base, top, side), (0, 2, 3));
        assert_eq!(plant.chain(side, &[]), side);

        plant.twist(top, 1.5).texture_length(side, 0.25);
        let plant = plant.build().unwrap();
        let expected = [
            Joint::root(Vec3::ZERO, 0.2),
            Joint::new(Vec3::Y, 0.1, 0),
            Joint::new(Vec3::Y * 2.0, 0.05, 1).with_twist(1.5),
            Joint::new(Vec3::X, 0.02, 1).with_texture_length(0.25),
        ];
        assert_eq!(plant.joints(), expected);
    }

    #[test]
    fn a_parent_that_is_not_there_yet_is_an_error_at_build() {
        let mut plant = Skeleton::builder();
        plant.root(Vec3::ZERO, 0.2);
        plant.joint(2, Vec3::Y, 0.1);
        plant.joint(0, Vec3::X, 0.1);
        assert_eq!(
            plant.build(),
            Err(SkeletonError::MissingParent {
                joint: 1,
                parent: 2,
                count: 1
            })
        );
    }

    #[test]
    fn the_first_mistake_is_the_one_reported() {
        let mut plant = Skeleton::builder();
        plant.twist(4, 0.1);
        plant.joint(9, Vec3::ZERO, -1.0);
        assert_eq!(
            plant.build(),
            Err(SkeletonError::MissingJoint { joint: 4, count: 0 })
        );
    }

    #[test]
    fn a_builder_without_joints_makes_no_skeleton() {
        assert_eq!(Skeleton::builder().build(), Err(SkeletonError::Empty));
    }
}

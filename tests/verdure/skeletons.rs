//! Random skeletons, the same on every machine.

use bevy::math::{DVec3, Quat, Vec3};
use bevy_verdure::lab::reference::{
    ReferenceEnds, ReferenceJoin, ReferenceJoint, ReferenceScene, ReferenceSettings,
};
use bevy_verdure::prelude::*;

pub use bevy_verdure::plants::Dice;

/// More ways to roll.
pub trait Roll {
    /// Evenly in the logarithm.
    fn log_between(&mut self, low: f32, high: f32) -> f32;

    /// A direction, evenly on the sphere.
    fn direction(&mut self) -> Vec3;
}

impl Roll for Dice {
    fn log_between(&mut self, low: f32, high: f32) -> f32 {
        self.between(low.ln(), high.ln()).exp()
    }

    fn direction(&mut self) -> Vec3 {
        let z = self.between(-1.0, 1.0);
        let (sin, cos) = self.angle().sin_cos();
        let across = (1.0 - z * z).sqrt();
        Vec3::new(across * cos, across * sin, z)
    }
}

/// What a random skeleton is like.
#[derive(Clone, Copy)]
pub struct Growth {
    pub joints: usize,
    /// Greatest bend in degrees.
    pub bend: f32,
    /// Greatest ratio of neighbouring radii.
    pub taper: f32,
    /// Radius to length.
    pub aspect: (f32, f32),
    /// Chance that a segment starts anywhere but at the last joint.
    pub branching: f32,
}

impl Growth {
    pub fn grow(&self, dice: &mut Dice) -> Skeleton {
        let mut joints = vec![Joint::root(Vec3::ZERO, dice.log_between(0.1, 0.4))];
        let mut directions = vec![Vec3::Y];
        while joints.len() < self.joints {
            let last = joints.len() - 1;
            let parent = if dice.roll() < self.branching {
                (dice.roll() * joints.len() as f32) as usize
            } else {
                last
            };
            let from = &joints[parent];
            let radius =
                (from.radius * dice.log_between(1.0 / self.taper, self.taper)).clamp(0.02, 1.5);
            let length = from.radius.max(radius) / dice.log_between(self.aspect.0, self.aspect.1);
            let axis = directions[parent];
            let tilt = dice.between(0.0, self.bend).to_radians();
            let across = axis
                .cross(dice.direction())
                .normalize_or(axis.any_orthonormal_vector());
            let direction = Quat::from_axis_angle(across, tilt) * axis;
            let position = from.position + direction * length.min(3.0);
            joints.push(Joint::new(position, radius, parent as u32));
            directions.push(direction);
        }
        Skeleton::new(joints).expect("random skeletons are valid")
    }
}

/// A small tree: mild bends, a branch or two.
pub const TREE: Growth = Growth {
    joints: 12,
    bend: 50.0,
    taper: 1.4,
    aspect: (0.1, 0.4),
    branching: 0.3,
};

/// An upright limb of `segments` segments of half a metre.
pub fn limb(segments: usize) -> Skeleton {
    let mut limb = Skeleton::builder();
    let mut last = limb.root(Vec3::ZERO, 0.2);
    for i in 1..=segments {
        last = limb.joint(last, Vec3::Y * (i as f32 * 0.5), 0.2);
    }
    limb.build().expect("a straight limb is valid")
}

/// The same joints for the reference.
pub fn reference_joints(skeleton: &Skeleton) -> Vec<ReferenceJoint> {
    let joints = skeleton.joints().iter();
    joints
        .map(|joint| ReferenceJoint {
            position: joint.position.as_dvec3(),
            radius: f64::from(joint.radius),
            parent: joint.parent.map(|parent| parent as usize),
        })
        .collect()
}

/// What a plant with default settings looks like to the reference.
pub fn reference(skeleton: &Skeleton) -> ReferenceScene {
    let settings = ReferenceSettings {
        join: ReferenceJoin::Mitre,
        ends: ReferenceEnds::Round,
    };
    ReferenceScene::new(&reference_joints(skeleton), settings)
}

/// Middle and radius of a ball round a skeleton.
pub fn ball(skeleton: &Skeleton) -> (Vec3, f32) {
    let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    for joint in skeleton.joints() {
        low = low.min(joint.position - joint.radius);
        high = high.max(joint.position + joint.radius);
    }
    (0.5 * (low + high), 0.5 * (high - low).length())
}

/// Single to double precision.
pub fn double(v: Vec3) -> DVec3 {
    v.as_dvec3()
}

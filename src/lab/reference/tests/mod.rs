//! Statements about the reference itself, and the skeletons that they are tried on.

mod closed;
mod cones;
mod hits;
mod joins;
mod seams;
mod shapes;
mod swept;

use glam::DVec3;

use super::random::SplitMix64;
use super::{ReferenceEnds, ReferenceJoin, ReferenceJoint, ReferenceScene, ReferenceSettings};

fn joint(position: DVec3, radius: f64, parent: Option<usize>) -> ReferenceJoint {
    ReferenceJoint {
        position,
        radius,
        parent,
    }
}

fn settings(join: ReferenceJoin, ends: ReferenceEnds) -> ReferenceSettings {
    ReferenceSettings { join, ends }
}

/// A chain along the x axis: (x, radius) of each joint.
fn straight(joints: &[(f64, f64)], settings: ReferenceSettings) -> ReferenceScene {
    let joints: Vec<_> = joints
        .iter()
        .enumerate()
        .map(|(i, &(x, radius))| joint(x * DVec3::X, radius, i.checked_sub(1)))
        .collect();
    ReferenceScene::new(&joints, settings)
}

/// What random skeletons are made of.
#[derive(Clone, Copy)]
struct Growth {
    /// Joints in the first chain.
    joints: usize,
    /// Largest bend in degrees.
    bend: f64,
    /// Largest ratio of neighbouring radii.
    taper: f64,
    /// Least and largest ratio of a segment's length to the radius at its start.
    aspect: (f64, f64),
    /// Branches of one segment, from any joint.
    branches: usize,
    /// Chance of a segment without length.
    folded: f64,
}

impl Growth {
    fn grow(&self, rng: &mut SplitMix64) -> Vec<ReferenceJoint> {
        let mut axis = rng.direction();
        let mut tip = joint(DVec3::ZERO, rng.log_range(0.3, 3.0), None);
        let mut joints = vec![tip];
        while joints.len() < self.joints {
            let angle = rng.range(0.0, self.bend.to_radians());
            axis = rng.direction_at(axis, angle);
            tip = self.next(rng, axis, tip, joints.len() - 1);
            joints.push(tip);
        }
        for _ in 0..self.branches {
            let from = rng.below(joints.len());
            let direction = rng.direction();
            joints.push(self.next(rng, direction, joints[from], from));
        }
        joints
    }

    fn next(
        &self,
        rng: &mut SplitMix64,
        axis: DVec3,
        from: ReferenceJoint,
        parent: usize,
    ) -> ReferenceJoint {
        let length = if rng.unit() < self.folded {
            0.0
        } else {
            from.radius * rng.log_range(self.aspect.0, self.aspect.1)
        };
        let taper = rng.log_range(1.0 / self.taper, self.taper);
        let radius = (from.radius * taper).clamp(0.05, 20.0);
        joint(from.position + length * axis, radius, Some(parent))
    }
}

/// A ray from well outside a skeleton towards a point of a random segment's axis, or near it.
fn ray_at(rng: &mut SplitMix64, joints: &[ReferenceJoint], miss: f64) -> (DVec3, DVec3, DVec3) {
    let to = &joints[1 + rng.below(joints.len() - 1)];
    let from = &joints[to.parent.unwrap()];
    let at = rng.unit();
    let radius = from.radius + at * (to.radius - from.radius);
    let target =
        from.position.lerp(to.position, at) + rng.direction() * radius * rng.range(0.0, miss);
    // Far enough to be outside of all that `Growth` makes.
    let reach = joints
        .iter()
        .map(|j| j.position.distance(target) + j.radius)
        .fold(0.0, f64::max);
    let dir = rng.direction();
    (target - 30.0 * reach * dir, dir, target)
}

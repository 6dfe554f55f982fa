//! From a skeleton to what its geometry needs to know of it.

use super::join::{Link, NONE, PosedJoint};
use super::scalar::{Real, Vec3};
use crate::skeleton::{Skeleton, continuations};

/// How the segments of a skeleton hang together, by joint.
pub fn links(skeleton: &Skeleton) -> Vec<Link> {
    let joints = skeleton.joints();
    let next = continuations(joints);
    let mut links: Vec<Link> = Vec::with_capacity(joints.len());
    for (i, joint) in joints.iter().enumerate() {
        let continues = match joint.parent {
            Some(parent) => next[parent as usize] == Some(i as u32),
            None => true,
        };
        if let Some(parent) = joint.parent
            && !continues
        {
            links[parent as usize].branches = true;
        }
        links.push(Link {
            parent: joint.parent.unwrap_or(NONE),
            next: next[i].unwrap_or(NONE),
            continues,
            branches: false,
            twist: Real::from(joint.twist),
        });
    }
    links
}

/// The joints of a skeleton as it stands at rest.
pub fn joints_at_rest(skeleton: &Skeleton) -> Vec<PosedJoint> {
    let joints = skeleton.joints().iter().map(|joint| PosedJoint {
        position: Vec3::new(
            Real::from(joint.position.x),
            Real::from(joint.position.y),
            Real::from(joint.position.z),
        ),
        radius: Real::from(joint.radius),
    });
    joints.collect()
}

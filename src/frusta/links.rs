//! From a skeleton to what its frusta need to know of it, whatever its pose.

use bevy::math::Vec3;

use super::records::ShapeRecord;
use super::single::join::{Link, NONE, PosedJoint};
use crate::skeleton::{Skeleton, continuations};

/// Length covered by one repeat of the texture where neither a joint nor its ancestors say otherwise, in metres.
const TEXTURE_LENGTH: f32 = 1.0;

/// A skeleton as the frusta see it: links, textures, and the joints at rest.
#[derive(Debug, Default)]
pub(crate) struct LinkedSkeleton {
    pub links: Vec<Link>,
    pub shapes: Vec<ShapeRecord>,
    pub rest: Vec<PosedJoint>,
    /// How many segments there are.
    pub segments: usize,
    /// Direction of u = 0 of each limb that begins at a root.
    pub references: Vec<Vec3>,
}

impl LinkedSkeleton {
    pub(crate) fn new(skeleton: &Skeleton) -> Self {
        let joints = skeleton.joints();
        let continuations = continuations(joints);
        let mut linked = Self::default();
        let mut texture_lengths = Vec::with_capacity(joints.len());
        for (i, joint) in joints.iter().enumerate() {
            let next = continuations[i].unwrap_or(NONE);
            let (parent, continues) = match joint.parent {
                Some(parent) => (parent, continuations[parent as usize] == Some(i as u32)),
                None => (NONE, true),
            };
            linked.segments += usize::from(joint.parent.is_some());
            linked.links.push(Link {
                parent,
                next,
                continues,
                branches: false,
                twist: joint.twist,
            });
            if parent != NONE && !continues {
                linked.links[parent as usize].branches = true;
            }
            linked.rest.push(PosedJoint {
                position: joint.position,
                radius: joint.radius,
            });
            let inherited = match joint.parent {
                Some(parent) => texture_lengths[parent as usize],
                None => TEXTURE_LENGTH,
            };
            let texture_length = joint.texture_length.unwrap_or(inherited);
            texture_lengths.push(texture_length);
            // v runs on from the parent's segment; a limb's starts at 0.
            let (length, v_start, reference) = match joint.parent {
                Some(parent) => {
                    let along = joint.position - joints[parent as usize].position;
                    let v: f32 = linked.shapes[parent as usize].v_end;
                    (along.length(), v, across(along))
                }
                None => (0.0, 0.0, Vec3::ZERO),
            };
            linked.references.push(reference);
            linked.shapes.push(ShapeRecord {
                parent,
                next,
                v_start,
                v_end: v_start + length / texture_length,
                twist: joint.twist,
            });
        }
        linked
    }
}

/// Where u = 0 is on a limb that begins at a root: towards +z, where the limb leaves that open.
fn across(along: Vec3) -> Vec3 {
    let axis = along.normalize_or(Vec3::Y);
    if axis.z.abs() < 0.9 { Vec3::Z } else { Vec3::X }
}

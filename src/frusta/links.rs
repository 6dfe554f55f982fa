//! From a skeleton to what its frusta need to know of it, whatever its pose.

use bevy::math::Vec3;

use super::records::ShapeRecord;
use super::single::join::{Link, PosedJoint};
use super::single::links::{joints_at_rest, links};
use crate::skeleton::Skeleton;

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
        let links = links(skeleton);
        let mut shapes: Vec<ShapeRecord> = Vec::with_capacity(joints.len());
        let mut references = Vec::with_capacity(joints.len());
        let mut texture_lengths = Vec::with_capacity(joints.len());
        for (joint, link) in joints.iter().zip(&links) {
            let parent = joint.parent.map(|parent| parent as usize);
            let inherited = parent.map_or(TEXTURE_LENGTH, |parent| texture_lengths[parent]);
            let texture_length = joint.texture_length.unwrap_or(inherited);
            texture_lengths.push(texture_length);
            // v runs on from the parent's segment; at a root it starts at 0.
            let along = parent.map_or(Vec3::ZERO, |parent| {
                joint.position - joints[parent].position
            });
            let v_start = parent.map_or(0.0, |parent| shapes[parent].v_end);
            references.push(across(along));
            shapes.push(ShapeRecord {
                parent: link.parent,
                next: link.next,
                v_start,
                v_end: v_start + along.length() / texture_length,
                twist: joint.twist,
                radius: joint.radius,
            });
        }
        Self {
            rest: joints_at_rest(skeleton),
            segments: skeleton.segment_count(),
            links,
            shapes,
            references,
        }
    }
}

/// Where u = 0 is on a limb that begins at a root: towards +z, where the limb leaves that open.
fn across(along: Vec3) -> Vec3 {
    let axis = along.normalize_or(Vec3::Y);
    if axis.z.abs() < 0.9 { Vec3::Z } else { Vec3::X }
}

//! What the shaders read: one record a joint that moves, one a joint of a skeleton, one a plant.
//!
//! The layouts are those of `types.wgsl`. A segment has the index of the joint that ends it.

use bevy::math::{Vec2, Vec3};
use bytemuck::{Pod, Zeroable};

use super::single::cone::{EndKind, Frustum, WHOLE};
use super::single::join::JoinKind;

/// A joint in its pose, with the frustum of the segment that it ends: all that is uploaded when it moves. The plane
/// at the segment's end is its successor's, and its base is its parent's position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct JointRecord {
    position: [f32; 3],
    /// The plane at the segment's start: unit normal, and offset from the parent's joint.
    plane_normal: [f32; 3],
    plane_offset: f32,
    /// Position in the frame before, for motion vectors.
    previous_position: [f32; 3],
    /// Direction of u = 0, octahedral, 2 × 16 bit.
    reference: u32,
    base_radius: f32,
    slope: f32,
    bits: u32,
    previous_reference: u32,
}

/// Bits of [`JointRecord`], as in `types.wgsl`: two for each end's kind, then flags.
const START_SHIFT: u32 = 0;
const END_SHIFT: u32 = 2;
/// The end is closed by a whole sphere.
const WHOLE_SPHERE: u32 = 1 << 4;
/// Round ends meet at the joint's plane, not at the contact circle (the paper's joins).
const PAPER: u32 = 1 << 5;

impl JointRecord {
    /// The record of a joint at `position` that ends the segment of `frustum`. `previous` is its record of the frame
    /// before, or `None` for one that stood still.
    #[inline]
    pub(crate) fn new(
        position: Vec3,
        frustum: &Frustum,
        join: JoinKind,
        previous: Option<&JointRecord>,
    ) -> Self {
        let whole = frustum.end.offset <= -WHOLE || frustum.start.offset >= WHOLE;
        let paper = matches!(join, JoinKind::Paper | JoinKind::PaperIterated);
        let bits = (frustum.start.kind as u32) << START_SHIFT
            | (frustum.end.kind as u32) << END_SHIFT
            | if whole { WHOLE_SPHERE } else { 0 }
            | if paper { PAPER } else { 0 };
        let position = position.to_array();
        let reference = octahedral(frustum.reference);
        Self {
            position,
            plane_normal: frustum.start.normal.to_array(),
            plane_offset: frustum.start.offset,
            previous_position: previous.map_or(position, |record| record.position),
            reference,
            base_radius: frustum.radius,
            slope: frustum.slope,
            bits,
            previous_reference: previous.map_or(reference, |record| record.reference),
        }
    }

    /// The same joint, standing still.
    pub(crate) fn settled(&self) -> Self {
        Self {
            previous_position: self.position,
            previous_reference: self.reference,
            ..*self
        }
    }
}

/// What never changes of a joint, shared by all plants of a skeleton.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct ShapeRecord {
    /// Index within the skeleton of the parent, or [`NONE`](super::single::join::NONE).
    pub parent: u32,
    /// Index of the joint that continues the limb, or `NONE`.
    pub next: u32,
    /// Texture coordinate at both ends of the segment.
    pub v_start: f32,
    pub v_end: f32,
    /// Twist along the segment, in radians.
    pub twist: f32,
    /// Radius of the joint's sphere.
    pub radius: f32,
}

/// Where a plant's records are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct PlantRecord {
    pub first_joint: u32,
    pub first_shape: u32,
    pub joint_count: u32,
    pub unused: u32,
}

/// A unit vector in 2 × 16 bit, octahedral (Cigolle et al. 2014, "A survey of efficient representations for
/// independent unit vectors"). Its error is below 5e-5 radians.
fn octahedral(n: Vec3) -> u32 {
    let n = n / (n.x.abs() + n.y.abs() + n.z.abs()).max(f32::MIN_POSITIVE);
    let mut p = Vec2::new(n.x, n.y);
    if n.z < 0.0 {
        let signs = Vec2::new(1f32.copysign(n.x), 1f32.copysign(n.y));
        p = (Vec2::ONE - Vec2::new(n.y, n.x).abs()) * signs;
    }
    let pack = |x: f32| ((x.clamp(-1.0, 1.0) * 32767.0).round() as i32 as u32) & 0xffff;
    pack(p.x) | pack(p.y) << 16
}

// `EndKind` goes to the shader as it is.
const _: () =
    assert!(EndKind::Cut as u32 == 0 && EndKind::Round as u32 == 1 && EndKind::Flat as u32 == 2);
const _: () = assert!(size_of::<JointRecord>() == 60);

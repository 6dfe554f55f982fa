//! What the frusta keep of a plant that is drawn.

use core::ops::Range;
use std::sync::Arc;

use bevy::camera::primitives::Aabb;
use bevy::ecs::component::Component;
use bevy::math::Vec3;

use super::extent::aabb;
use super::links::LinkedSkeleton;
use super::records::JointRecord;
use super::shaping::Shaping;
use super::share::SkeletonKey;
use super::single::cone::Frustum;
use super::single::join::{NONE, PosedJoint, skin};
use super::single::shell::{at_height, skin_level, start_radius};
use super::single::surface::{align_rolled, align_turned};
use super::table::Rows;
use crate::skeleton::PosedJoints;

/// A plant that is drawn by frusta.
#[derive(Component)]
pub(crate) struct FrustaPlant {
    pub skeleton: SkeletonKey,
    pub shaping: Shaping,
    pub linked: Arc<LinkedSkeleton>,
    /// The plant's row, which its `MeshTag` names.
    pub slot: Rows,
    pub joints: Rows,
    /// The bounds with which it was attached.
    pub bounds: Aabb,
    /// The plant's own pose; `None` while it stands as its skeleton does and shares its joints.
    pub own: Option<OwnPose>,
}

/// The frusta of one pose. Buffers are kept from frame to frame.
pub(crate) struct OwnPose {
    posed: Vec<PosedJoint>,
    frusta: Vec<Frustum>,
    pub records: Vec<JointRecord>,
    pub bounds: Aabb,
    /// Ranges of records that differ from those on the GPU.
    pub changed: Vec<Range<usize>>,
    /// Some joint was elsewhere in the frame before.
    moving: bool,
}

impl OwnPose {
    /// The pose in which a skeleton stands at rest.
    pub(crate) fn at_rest(linked: &LinkedSkeleton, shaping: Shaping) -> Self {
        let mut pose = Self {
            posed: linked.rest.clone(),
            frusta: vec![Frustum::default(); linked.links.len()],
            records: Vec::with_capacity(linked.links.len()),
            bounds: Aabb::default(),
            changed: Vec::new(),
            moving: false,
        };
        pose.skin(linked, shaping, |i| linked.references[i], |_| None);
        let joints = pose.posed.iter().zip(&pose.frusta);
        pose.records.extend(joints.map(|(joint, frustum)| {
            let join = shaping.frusta.skin().join;
            JointRecord::new(joint.position, frustum, join, None)
        }));
        pose.changed.push(0..pose.records.len());
        pose.measure(linked, shaping);
        pose
    }

    /// Recomputes cones, cutting planes and records for the joints' new places. Allocates nothing.
    pub(crate) fn follow(&mut self, linked: &LinkedSkeleton, shaping: Shaping, pose: &PosedJoints) {
        for (joint, position) in self.posed.iter_mut().zip(pose.positions()) {
            // A joint that an animation has thrown out of the world stays where it was.
            if position.is_finite() {
                joint.position = *position;
            }
        }
        let first = |i| {
            let turned = pose
                .frame(i)
                .map(|frame| frame.transform_vector3(linked.references[i]));
            turned.unwrap_or(linked.references[i])
        };
        self.skin(linked, shaping, first, |i| pose.roll(i));
        let join = shaping.frusta.skin().join;
        for (i, record) in self.records.iter_mut().enumerate() {
            let position = self.posed[i].position;
            let new = JointRecord::new(position, &self.frusta[i], join, Some(record));
            note_change(&mut self.changed, i, record, new);
        }
        self.moving = true;
    }

    /// Ends the motion of a plant whose pose has not changed since the last frame.
    pub(crate) fn settle(&mut self) {
        if !self.moving {
            return;
        }
        self.moving = false;
        for (i, record) in self.records.iter_mut().enumerate() {
            let new = record.settled();
            note_change(&mut self.changed, i, record, new);
        }
    }

    /// Recomputes the bounds.
    pub(crate) fn measure(&mut self, linked: &LinkedSkeleton, shaping: Shaping) {
        self.bounds = match shaping.shell() {
            None => aabb(self.frusta.iter().copied()),
            Some(shell) => {
                let rest = |i: u32| linked.rest[i as usize].radius;
                let outer = self.frusta.iter().enumerate().map(|(i, frustum)| {
                    let link = &linked.links[i];
                    if link.parent == NONE {
                        return *frustum;
                    }
                    let to = rest(i as u32);
                    let from = start_radius(link, rest(link.parent), to);
                    at_height(frustum, shell.radii(from).1, shell.radii(to).1)
                });
                aabb(outer)
            }
        };
    }

    fn skin(
        &mut self,
        linked: &LinkedSkeleton,
        shaping: Shaping,
        first: impl Fn(usize) -> Vec3,
        roll: impl Fn(usize) -> Option<[f32; 2]>,
    ) {
        let links = &linked.links;
        let settings = shaping.frusta.skin();
        let Some(shell) = shaping.shell() else {
            skin(links, &self.posed, settings, &mut self.frusta);
            align_rolled(links, &mut self.frusta, first, roll);
            return;
        };
        let radius = |i: usize| linked.rest[i].radius;
        skin_level(
            links,
            &mut self.posed,
            radius,
            settings,
            shell,
            &mut self.frusta,
        );
        align_turned(links, &mut self.frusta, first, roll);
    }
}

/// Replaces a record, noting it if that changes anything.
fn note_change(
    changed: &mut Vec<Range<usize>>,
    i: usize,
    record: &mut JointRecord,
    new: JointRecord,
) {
    if *record == new {
        return;
    }
    *record = new;
    match changed.last_mut() {
        Some(last) if last.end == i => last.end = i + 1,
        _ => changed.push(i..i + 1),
    }
}

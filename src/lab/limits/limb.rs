//! The limbs that the experiments are made on: single chains without branches.

use glam::DVec3;

use crate::frusta::double::cone::{End, EndKind, Frustum};
use crate::frusta::double::join::{JoinKind, Link, NONE, PosedJoint, Skin, skin};
use crate::lab::reference::ReferenceJoint;

/// How a limb goes on after its first bend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Course {
    /// Always to the same side.
    Arc,
    /// To either side in turn.
    Zigzag,
}

/// A limb in the plane z = 0 of segments of one length, with one joint a radius, bent by `bend` degrees at each joint
/// between two segments. Its second segment runs along +x.
pub(super) fn limb(bend: f64, length: f64, radii: &[f64], course: Course) -> Vec<PosedJoint> {
    let mut position = DVec3::ZERO;
    let mut angle = -bend.to_radians();
    let mut turn = bend.to_radians();
    let mut joints = Vec::with_capacity(radii.len());
    for (i, &radius) in radii.iter().enumerate() {
        if i > 0 {
            let (sin, cos) = angle.sin_cos();
            position += length * DVec3::new(cos, sin, 0.0);
            angle += turn;
            if course == Course::Zigzag {
                turn = -turn;
            }
        }
        joints.push(PosedJoint { position, radius });
    }
    joints
}

/// The links of a chain of joints.
pub(super) fn links(joints: usize) -> Vec<Link> {
    (0..joints as u32)
        .map(|i| Link {
            parent: i.checked_sub(1).unwrap_or(NONE),
            next: if i + 1 < joints as u32 { i + 1 } else { NONE },
            continues: true,
            branches: false,
            twist: 0.0,
        })
        .collect()
}

/// The frusta of a chain.
pub(super) fn frusta(joints: &[PosedJoint], join: JoinKind) -> Vec<Frustum> {
    let mut frusta = vec![Frustum::default(); joints.len()];
    skin(&links(joints.len()), joints, settings(join), &mut frusta);
    frusta
}

/// Frusta that meet in one way, with round ends.
pub(super) fn settings(join: JoinKind) -> Skin {
    Skin {
        join,
        ends: EndKind::Round,
    }
}

/// The same joints for the reference.
pub(super) fn for_reference(joints: &[PosedJoint]) -> Vec<ReferenceJoint> {
    let joints = joints.iter().enumerate();
    joints
        .map(|(i, joint)| ReferenceJoint {
            position: joint.position,
            radius: joint.radius,
            parent: i.checked_sub(1),
        })
        .collect()
}

/// The distance of a point from an end's plane along its normal: positive beyond it along the limb.
pub(super) fn beyond(end: &End, point_from_joint: DVec3) -> f64 {
    end.normal.dot(point_from_joint) - end.offset
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limbs_bend_by_what_is_asked_for_and_their_second_segment_runs_along_x() {
        for (course, last) in [(Course::Arc, 40.0), (Course::Zigzag, -40.0)] {
            let joints = limb(40.0, 2.0, &[1.0; 4], course);
            let axis = |i: usize| (joints[i].position - joints[i - 1].position) / 2.0;
            assert!(axis(2).distance(DVec3::X) < 1e-12);
            assert!((axis(1).angle_between(axis(2)).to_degrees() - 40.0).abs() < 1e-9);
            let turned = axis(3).y.atan2(axis(3).x).to_degrees();
            assert!((turned - last).abs() < 1e-9, "{course:?} {turned}");
        }
    }
}

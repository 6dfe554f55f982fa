//! The skeleton of one height: joints' spheres of radius ρ + w·h, and the cones that touch them.

use super::super::ReferenceJoint;
use super::super::cone::{Cone, CutPlane};
use super::super::limbs::{Limb, Limbs};
use super::ShellThickness;

/// The segments of one height's skeleton.
pub(super) struct Level {
    pub limbs: Limbs,
}

impl Level {
    pub fn new(joints: &[ReferenceJoint], thickness: ShellThickness, w: f64) -> Self {
        let joints: Vec<_> = joints
            .iter()
            .map(|joint| ReferenceJoint {
                radius: joint.radius + w * thickness.at(joint.radius),
                ..*joint
            })
            .collect();
        Self {
            limbs: Limbs::new(&joints),
        }
    }

    pub fn limb(&self, joint: usize) -> &Limb {
        self.limbs.by_joint[joint].as_ref().expect("a segment")
    }

    pub fn cone(&self, joint: usize) -> Cone {
        let limb = self.limb(joint);
        Cone::tangent(
            limb.from,
            limb.axis,
            limb.length,
            limb.start_radius,
            limb.end_radius,
        )
    }

    /// The plane in which the cones of two segments meet that touch one sphere (see `tangent`).
    pub fn mitre(&self, first: usize, second: usize) -> CutPlane {
        let (one, two) = (self.cone(first), self.cone(second));
        let n = one.axis / one.cosine() + two.axis / two.cosine();
        let sum = one.sine() / one.cosine() + two.sine() / two.cosine();
        let limb = self.limb(first);
        CutPlane {
            point: limb.to,
            normal: n / n.length(),
            offset: limb.end_radius * sum / n.length(),
        }
    }

    pub fn contact_at_start(&self, joint: usize) -> CutPlane {
        let limb = self.limb(joint);
        CutPlane {
            point: limb.from,
            normal: -limb.axis,
            offset: -limb.start_radius * limb.sine(),
        }
    }

    pub fn contact_at_end(&self, joint: usize) -> CutPlane {
        let limb = self.limb(joint);
        CutPlane {
            point: limb.to,
            normal: limb.axis,
            offset: limb.end_radius * limb.sine(),
        }
    }
}

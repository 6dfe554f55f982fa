//! The ray caster that judges the others: the frusta of a skeleton in f64, written for plainness.
//!
//! It shares no code with what is drawn. Where the drawn surface is found with a quadratic about
//! the ray's nearest point and the root is tested afterwards, this one goes the way of solid
//! modelling: the ray is turned into the segment's own frame, the stretch of it inside the solid
//! cone is an interval, cutting planes shorten the interval, and an end of what is left is a hit
//! if the cone, and not a plane, put it there ([`Cone::ray_span`]).
//!
//! From top to bottom:
//!
//! | file | question |
//! |---|---|
//! | `limbs` | which child continues a limb, and with what radius does a segment start? |
//! | `cone` | where is a ray inside a cone, and where does a plane cut one? |
//! | `tangent` | `Mitre` and `Round`: cones that touch the joints' spheres, and how they meet |
//! | `paper` | `Paper` and `PaperIterated`: Equations 1 to 5 of §2.1 and §2.2 as they stand |
//! | `segment` | what is a segment once its joins are decided? |
//! | `scene` | what does a ray meet first? `bvh` finds the segments near it |
//! | `swept_sphere` | the same `Round` shape a second time, as a distance, with no cone in it |
//! | [`relief`] | the same with a relief map on it, marched in thousands of steps |
//! | `seam` | how far apart are two cut curves that should be one? |
//!
//! Source: D. Bhagvat, S. Jeschke, D. Cline, P. Wonka, "GPU Rendering of Relief Mapped Conical
//! Frusta", Computer Graphics Forum 28 (2009). The tangent cones are those of N. Max,
//! "Cone-Spheres", SIGGRAPH 1990; the shape of `Round` is a union of linear swept spheres.

mod bvh;
mod cone;
mod limbs;
mod paper;
#[cfg(test)]
mod random;
pub mod relief;
mod scene;
mod seam;
mod segment;
mod swept_sphere;
mod tangent;
#[cfg(test)]
mod tests;

use glam::DVec3;

pub use cone::{Cone, CutPlane};
pub use scene::ReferenceScene;
pub use seam::{cut_curve, seam_gap};
pub use segment::{Cap, EndKind, Segment, SegmentBody, SegmentEnd};
pub use swept_sphere::{sphere_trace, swept_sphere_distance};

/// A joint of a skeleton, in any one coordinate space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceJoint {
    /// Where the joint is.
    pub position: DVec3,
    /// Its radius ρ, at least zero, in the units of `position`. For [`ReferenceJoin::Mitre`] and
    /// [`ReferenceJoin::Round`] that of the sphere which the cones of all its segments touch, for
    /// the paper's own variants that of the cone's circle at the joint.
    pub radius: f64,
    /// Index of the joint at the other end of this joint's segment; `None` for a root.
    /// Parents come before their children.
    pub parent: Option<usize>,
}

/// How the two frusta that meet at a joint are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ReferenceJoin {
    /// On the plane in which two cones that touch one sphere meet; `Round` where that plane
    /// reaches too far.
    #[default]
    Mitre,
    /// Each cone ends on the circle where it touches the joint's sphere, which closes the gap.
    Round,
    /// The paper's cutting plane, Equations 3 to 5 of §2.2, with no limit on its reach.
    Paper,
    /// The same with the paper's iteration on the base radius of the child's cone.
    PaperIterated,
}

/// How the free ends of a skeleton are closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ReferenceEnds {
    /// With a part of the joint's sphere.
    #[default]
    Round,
    /// With a disc at the joint, perpendicular to the segment.
    Flat,
}

/// What a [`ReferenceScene`] is built with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct ReferenceSettings {
    /// How frusta meet.
    pub join: ReferenceJoin,
    /// How free ends are closed.
    pub ends: ReferenceEnds,
}

/// What [`ReferenceJoin::Mitre`] and [`ReferenceEnds::Flat`] are refused for, beyond the mitre limit
/// itself. The default refuses all that leaves a hole or a spike, as the crate does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceGuards {
    /// A mitre that is proposed at one end of a segment counts, in the decision on the other end,
    /// with the further of two reaches: its plane's and that of the contact circle which it falls
    /// back to. Without this guard a segment agrees to two mitres that fit, one of them is refused
    /// by the neighbour beyond, and its contact circle then lies across the other's plane: a hole.
    pub fallback: bool,
    /// How far a mitre may reach past its joint on the outside of the bend, in units of the joint's
    /// radius. The mitre limit bounds the inside only; where cones widen towards the joint the
    /// outside grows without bound as the bend nears the last one with an ellipse.
    pub spike: f64,
    /// A flat end is closed round instead where the disc cannot close it: at a root with several
    /// children (their starts show below the disc), where the cut at the segment's other end does
    /// not lie above the disc, and where the other joint's sphere reaches through the disc.
    pub flat: bool,
}

impl Default for ReferenceGuards {
    fn default() -> Self {
        Self {
            fallback: true,
            spike: 4.0,
            flat: true,
        }
    }
}

/// Which surface of a segment was hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ReferencePart {
    /// The conical frustum.
    Cone,
    /// What closes the start of a root's segment.
    StartCap,
    /// What closes the segment's end: at a free end, or the sphere of a round join.
    EndCap,
}

/// The nearest hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceHit {
    /// Distance along the ray in units of its direction's length.
    pub t: f64,
    /// The point hit; more accurate than `origin + t * dir` for a far origin.
    pub position: DVec3,
    /// The segment hit, as the index of the joint that it ends at.
    pub segment: usize,
    /// Unit normal of the surface itself, out of the segment's solid (whichever side was hit).
    pub surface_normal: DVec3,
    /// Which surface of the segment.
    pub part: ReferencePart,
}

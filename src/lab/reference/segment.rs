//! What a segment is once its joins are decided: a cone between two planes, and its caps.

use glam::DVec3;

use super::ReferencePart;
use super::bvh::Bounds;
use super::cone::{Cone, CutPlane};

/// What a segment meets at one of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EndKind {
    /// Its neighbour, on a cutting plane (the paper's plane for the paper's variants).
    Mitre,
    /// Its neighbour, through the joint's sphere.
    Round,
    /// The inside of the limb that it branches off (only at a start).
    Branch,
    /// Nothing: a free end.
    Free,
}

/// What a segment draws at one of its ends, besides its cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cap {
    /// Nothing.
    Open,
    /// The part beyond the cutting plane of the sphere with this radius about the joint.
    Sphere(f64),
    /// The disc with this radius about the joint, in the cutting plane.
    Disc(f64),
}

/// One end of a segment that has a cone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentEnd {
    /// What the segment meets here.
    pub kind: EndKind,
    /// Where its cone stops.
    pub plane: CutPlane,
    /// What it draws here besides.
    pub cap: Cap,
}

/// The surface of one segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SegmentBody {
    /// A cone between two planes, with what closes its ends.
    Frustum {
        /// The cone.
        cone: Cone,
        /// Its end at the parent.
        start: SegmentEnd,
        /// Its end at the joint.
        end: SegmentEnd,
    },
    /// One joint's sphere contains the other's: the larger sphere, whole.
    Sphere {
        /// The joint's position.
        center: DVec3,
        /// The joint's radius.
        radius: f64,
        /// `EndCap` for the joint's own sphere, `StartCap` for its parent's.
        part: ReferencePart,
    },
    /// The same where the larger sphere is one that another segment draws.
    Hidden,
}

/// A segment of a [`ReferenceScene`](super::ReferenceScene).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The joint that it ends at.
    pub joint: usize,
    /// The joint that it starts from.
    pub parent: usize,
    /// Its surface.
    pub body: SegmentBody,
}

impl Segment {
    /// A point near all of the segment.
    pub(super) fn middle(&self) -> DVec3 {
        match self.body {
            SegmentBody::Frustum { cone, .. } => cone.base + 0.5 * cone.length * cone.axis,
            SegmentBody::Sphere { center, .. } => center,
            SegmentBody::Hidden => DVec3::ZERO,
        }
    }

    /// A box around all that a segment draws; unbounded where a plane does not close its cone.
    pub(super) fn bounds(&self) -> Bounds {
        match self.body {
            SegmentBody::Frustum { cone, start, end } => {
                let mut bounds = Bounds::EMPTY;
                // The cone's stretch is between two discs if each plane closes it, facing outwards.
                let closes = start.plane.normal.dot(cone.axis) < 0.0
                    && end.plane.normal.dot(cone.axis) > 0.0;
                match (cone.cut_range(&start.plane), cone.cut_range(&end.plane)) {
                    (Some((low, _)), Some((_, high))) if closes => {
                        for y in [low, high] {
                            let center = cone.base + y * cone.axis;
                            bounds.add_disc(center, cone.axis, cone.radius_at(y).max(0.0));
                        }
                    }
                    _ => return Bounds::ALL,
                }
                for end in [start, end] {
                    match end.cap {
                        Cap::Open => {}
                        Cap::Sphere(radius) => bounds.add_sphere(end.plane.point, radius),
                        Cap::Disc(radius) => {
                            bounds.add_disc(end.plane.point, end.plane.normal, radius)
                        }
                    }
                }
                bounds
            }
            SegmentBody::Sphere { center, radius, .. } => {
                let mut bounds = Bounds::EMPTY;
                bounds.add_sphere(center, radius);
                bounds
            }
            SegmentBody::Hidden => Bounds::EMPTY,
        }
    }
}

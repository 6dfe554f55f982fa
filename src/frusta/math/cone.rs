//! Cones with signed slope (§2.1) and the frustum cut from one.
//!
//! The paper writes a cone by its height h' (Equations 1 and 2), which is infinite for a cylinder and has
//! no sign. Here the surface is |P⊥| = r(y), with r linear in the axial distance y and its slope signed:
//! every formula stays finite, and a cylinder is a slope of zero.

use super::scalar::{Real, Vec3};

/// An infinite cone (or cylinder), |P⊥| = radius + slope·y, about an axis.
///
/// Positions are relative to the cone's base, a point on the axis; `y` is the axial distance from it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cone {
    /// Unit direction of the axis, M in the paper.
    pub axis: Vec3,
    /// Cross-section radius at y = 0, in metres.
    pub radius: Real,
    /// Change of radius with y; 0 for a cylinder, negative where the cone narrows along its axis.
    pub slope: Real,
    /// 1/c = √(1 + slope²), the secant of the half-angle.
    pub secant: Real,
}

impl Cone {
    /// The cone that touches a sphere of `radius_from` about the base and one of `radius_to` at `length`
    /// along the axis. With s the sine of the half-angle and c its cosine, its cross-section radius is
    /// (ρ − s·y)/c.
    ///
    /// The caller makes sure that neither sphere contains the other ([`touches_both`]).
    #[inline]
    pub fn touching(axis: Vec3, length: Real, radius_from: Real, radius_to: Real) -> Self {
        Self::opening(axis, radius_from, (radius_from - radius_to) / length)
    }

    /// The cone that touches a sphere of `radius_from` about the base and whose half-angle has the signed sine `s`,
    /// positive where it narrows along its axis.
    #[inline]
    pub fn opening(axis: Vec3, radius_from: Real, s: Real) -> Self {
        let secant = 1.0 / ((1.0 - s) * (1.0 + s)).sqrt();
        Self {
            axis,
            radius: radius_from * secant,
            slope: -s * secant,
            secant,
        }
    }

    /// The cone with a cross-section of `radius` at its base.
    #[inline]
    pub fn through(axis: Vec3, radius: Real, slope: Real) -> Self {
        Self {
            axis,
            radius,
            slope,
            secant: (1.0 + slope * slope).sqrt(),
        }
    }

    /// Cross-section radius at axial distance `y`; negative on the mirrored nappe.
    #[inline]
    pub fn radius_at(&self, y: Real) -> Real {
        self.radius + self.slope * y
    }

    /// s, the signed sine of the half-angle: positive where the cone narrows along its axis.
    #[inline]
    pub fn sine(&self) -> Real {
        -self.slope / self.secant
    }

    /// |P⊥| − r(y): zero on the surface, negative inside.
    pub fn residual(&self, point: Vec3) -> Real {
        let y = point.dot(self.axis);
        (point - self.axis * y).length() - self.radius_at(y)
    }
}

/// Smallest distance from |s| = 1 at which a segment still has a cone: below it the segment is a sphere.
pub const SMALLEST_COSINE_SQUARED: Real = 1e-6;

/// True when a cone can touch both spheres: neither contains the other. False for a segment of zero length.
#[inline]
pub fn touches_both(length: Real, radius_from: Real, radius_to: Real) -> bool {
    (radius_from - radius_to).abs() < length * (1.0 - SMALLEST_COSINE_SQUARED)
}

/// What a segment's frustum ends in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum EndKind {
    /// Open: another frustum, or another segment's sphere, goes on beyond the plane.
    #[default]
    Cut = 0,
    /// Closed by the part of the joint's sphere beyond the plane.
    Round = 1,
    /// Closed by a disc in the plane.
    Flat = 2,
}

/// One end of a frustum: a plane normal·X = offset, with X measured from the end's own joint, and what
/// closes it. The normal points along the limb, so that a frustum lies on the side ≥ of its start and on the
/// side ≤ of its end.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct End {
    /// Unit normal of the plane.
    pub normal: Vec3,
    /// Signed distance of the plane from the joint, in metres.
    pub offset: Real,
    /// Radius of the joint's sphere, in metres.
    pub radius: Real,
    /// How far the cut may reach into the segment, measured from the joint along the axis, in metres; not
    /// negative.
    pub reach: Real,
    /// What closes the end.
    pub kind: EndKind,
}

/// Offset of an end plane that lets a whole sphere through, in metres: beyond any skeleton.
pub const WHOLE: Real = 1e30;

/// The surface round one segment, in the plant's local space.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Frustum {
    /// Where the segment starts: its parent's joint.
    pub base: Vec3,
    /// Unit direction from the base to the joint.
    pub axis: Vec3,
    /// Distance from the base to the joint, in metres.
    pub length: Real,
    /// Cross-section radius at the base; negative when the segment has no cone (a lone sphere, or nothing).
    pub radius: Real,
    /// Change of radius with axial distance.
    pub slope: Real,
    /// Secant of the cone's half-angle.
    pub secant: Real,
    /// The end at the base.
    pub start: End,
    /// The end at the joint.
    pub end: End,
    /// Unit vector across the axis where u = 0, at the start.
    pub reference: Vec3,
}

impl Frustum {
    /// The cone that this frustum is cut from, relative to [`base`](Self::base).
    #[inline]
    pub fn cone(&self) -> Cone {
        Cone {
            axis: self.axis,
            radius: self.radius,
            slope: self.slope,
            secant: self.secant,
        }
    }

    /// False for a segment that is only a sphere, or nothing.
    #[inline]
    pub fn has_cone(&self) -> bool {
        self.radius > 0.0
    }

    /// The joint at the end of the segment.
    #[inline]
    pub fn tip(&self) -> Vec3 {
        self.base + self.axis * self.length
    }
}

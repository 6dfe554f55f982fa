//! The exact mitre: the plane in which two cones meet that touch one sphere.
//!
//! With X measured from the joint, of radius ρ, and k = −s/c the signed slopes, the plane is
//!
//! ```text
//! (M1/c1 + M2/c2) · X = ρ (s1/c1 + s2/c2) = −ρ (k1 + k2)
//! ```
//!
//! Collinear axes are no special case. At a fold, M1 = −M2, there is no plane.

use super::cone::Cone;
use super::scalar::{Real, Vec3};

/// A cutting plane, normal·X = offset with X measured from the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuttingPlane {
    /// Unit normal, pointing along the limb.
    pub normal: Vec3,
    /// Signed distance from the joint, in metres.
    pub offset: Real,
}

/// Least and greatest axial distance, from the joint along the limb, of a curve on a cone, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The least.
    pub low: Real,
    /// The greatest.
    pub high: Real,
}

/// Where two cones meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mitre {
    /// The plane between them.
    pub plane: CuttingPlane,
    /// The ellipse along the first cone's axis.
    pub first: Extent,
    /// The ellipse along the second cone's axis.
    pub second: Extent,
}

/// Below this share of its greatest length the sum of both axes is taken for a fold, which has no mitre.
const FOLD: Real = 1e-4;
/// How far a plane's tilt stays from one that cuts a parabola: cosine of the tilt above |s|.
const ELLIPSE: Real = 1e-4;

/// The mitre of two cones that touch a sphere of `radius` about the joint; `None` at a fold, and where the plane does
/// not cut an ellipse from both.
///
/// Every animated joint goes through here: the plane is normalised last, and its four extents share one division.
#[inline(always)]
pub fn mitre(first: &Cone, second: &Cone, radius: Real) -> Option<Mitre> {
    let (w1, w2) = (first.secant, second.secant);
    let (k1, k2) = (first.slope, second.slope);
    let normal = first.axis * w1 + second.axis * w2;
    let length = normal.length();
    if length <= FOLD * (w1 + w2) {
        return None;
    }
    let offset = -radius * (k1 + k2);
    // With the bend between the axes: normal·M1 = w1 + w2 cos, |normal × M1| = w2 sin. The sine comes from the cross
    // product: it keeps its digits where the limb runs straight.
    let cosine = first.axis.dot(second.axis);
    let sine = first.axis.cross(second.axis).length();
    let (m1, q1) = (w1 + w2 * cosine, w2 * sine);
    let (m2, q2) = (w1 * cosine + w2, w1 * sine);
    // Tilt and opening leave an ellipse while m > |s|, that is m/c > |k|.
    if (m1 - ELLIPSE * length) * w1 <= k1.abs() * length
        || (m2 - ELLIPSE * length) * w2 <= k2.abs() * length
    {
        return None;
    }
    // The generators nearest to and farthest from the plane's tilt end at (offset ∓ ρ/c q) / (m ± k q).
    let (r1, r2) = (radius * w1, radius * w2);
    let (d1, e1) = (m1 + k1 * q1, m1 - k1 * q1);
    let (d2, e2) = (m2 + k2 * q2, m2 - k2 * q2);
    let (p1, p2) = (d1 * e1, d2 * e2);
    let inverse = 1.0 / (p1 * p2);
    let (i1, i2) = (inverse * p2, inverse * p1);
    let scale = 1.0 / length;
    Some(Mitre {
        plane: CuttingPlane {
            normal: normal * scale,
            offset: offset * scale,
        },
        first: extent((offset - r1 * q1) * e1 * i1, (offset + r1 * q1) * d1 * i1),
        second: extent((offset - r2 * q2) * e2 * i2, (offset + r2 * q2) * d2 * i2),
    })
}

#[inline(always)]
fn extent(a: Real, b: Real) -> Extent {
    if a < b {
        Extent { low: a, high: b }
    } else {
        Extent { low: b, high: a }
    }
}

/// The ellipse that any plane cuts from a cone of cross-section `radius` at the joint; `None` if the curve is none.
#[inline]
pub fn cut_extent(
    plane: &CuttingPlane,
    axis: Vec3,
    radius: Real,
    slope: Real,
    secant: Real,
) -> Option<Extent> {
    let m = plane.normal.dot(axis);
    let q = plane.normal.cross(axis).length();
    if (m - ELLIPSE) * secant <= slope.abs() {
        return None;
    }
    let y1 = (plane.offset - radius * q) / (m + slope * q);
    let y2 = (plane.offset + radius * q) / (m - slope * q);
    Some(extent(y1, y2))
}

//! The paper's own joins (§2.2, Equations 3 to 5), kept to be compared with the exact ones.
//!
//! A joint's radius is here the cross-section radius of the cones at the joint. The plane goes through the two
//! points in which the cones' outlines meet in the plane of both axes; the ellipses then share their major
//! axes. Their minor axes differ unless both cones have one slope; the iteration adjusts the base radius r1 of
//! the second cone until they match.

use super::cone::{EndKind, Frustum};
use super::join::PosedJoint;
use super::mitre::{CuttingPlane, cut_extent};
use super::scalar::{Real, Vec3};

/// Iterations on r1 at most; each gains about two digits.
const ITERATIONS: usize = 32;
/// Relative difference of minor axes at which the iteration ends.
const MATCH: Real = 4.0 * Real::EPSILON;
/// Smallest sine between two outlines that are taken to meet in a point.
const PARALLEL: Real = 1e-6;

/// Cuts two frusta at the plane of Equations 3 to 5.
pub(super) fn join(
    first: usize,
    second: usize,
    joints: &[PosedJoint],
    iterate: bool,
    frusta: &mut [Frustum],
) {
    let (f1, mut f2) = (frusta[first], frusta[second]);
    if !(f1.has_cone() && f2.has_cone()) {
        return;
    }
    let radius = joints[first].radius;
    let mut plane = cutting_plane(&f1, radius, &f2);
    if iterate {
        for _ in 0..ITERATIONS {
            let (Some(minor1), Some(minor2)) = (
                minor_axis(&f1, radius, &plane),
                minor_axis(&f2, f2.radius, &plane),
            ) else {
                break;
            };
            let ratio = minor1 / minor2;
            if (ratio - 1.0).abs() <= MATCH {
                break;
            }
            f2.radius *= ratio;
            f2.slope = (joints[second].radius - f2.radius) / f2.length;
            f2.secant = (1.0 + f2.slope * f2.slope).sqrt();
            plane = cutting_plane(&f1, radius, &f2);
        }
        frusta[second].radius = f2.radius;
        frusta[second].slope = f2.slope;
        frusta[second].secant = f2.secant;
    }
    let end = &mut frusta[first].end;
    end.normal = plane.normal;
    end.offset = plane.offset;
    end.kind = EndKind::Cut;
    let start = &mut frusta[second].start;
    start.normal = plane.normal;
    start.offset = plane.offset;
    start.kind = EndKind::Cut;
}

/// The plane across the medial plane through A and B (Equation 5); `radius` is the first cone's at the joint.
fn cutting_plane(first: &Frustum, radius: Real, second: &Frustum) -> CuttingPlane {
    let (m1, m2) = (first.axis, second.axis);
    let across = |normal: Vec3| CuttingPlane {
        normal,
        offset: 0.0,
    };
    // Equation 3; for collinear axes any plane through the axis gives one across it.
    let Some(medial) = m1.cross(m2).try_normalize() else {
        return across((m1 + m2).try_normalize().unwrap_or(m1));
    };
    let corner = |side: Real| -> Option<Vec3> {
        // Equation 4: outlines as offsets from the axes, in the medial plane.
        let (t1, t2) = (m1.cross(medial) * side, m2.cross(medial) * side);
        let (p1, p2) = (t1 * radius, t2 * second.radius);
        let (d1, d2) = (m1 + t1 * first.slope, m2 + t2 * second.slope);
        let sine = medial.dot(d1.cross(d2));
        (sine.abs() > PARALLEL).then(|| p1 + d1 * (medial.dot((p2 - p1).cross(d2)) / sine))
    };
    let (Some(a), Some(b)) = (corner(-1.0), corner(1.0)) else {
        return across((m1 + m2).try_normalize().unwrap_or(m1));
    };
    let Some(mut normal) = (a - b).cross(medial).try_normalize() else {
        return across((m1 + m2).try_normalize().unwrap_or(m1));
    };
    if normal.dot(m1 + m2) < 0.0 {
        normal = -normal;
    }
    CuttingPlane {
        normal,
        offset: normal.dot(a),
    }
}

/// Semi-minor axis of the ellipse that a plane cuts from a cone: the geometric mean of the cone's radii at
/// the two ends of the major axis.
fn minor_axis(frustum: &Frustum, radius: Real, plane: &CuttingPlane) -> Option<Real> {
    let (slope, secant) = (frustum.slope, frustum.secant);
    let cut = cut_extent(plane, frustum.axis, radius, slope, secant)?;
    let product = (radius + slope * cut.low) * (radius + slope * cut.high);
    (product > 0.0).then(|| product.sqrt())
}

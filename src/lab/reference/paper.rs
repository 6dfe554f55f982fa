//! `Paper` and `PaperIterated`: cutting planes as §2.2 has them.
//!
//! A joint's radius is that of both cones' circles at the joint. The plane through the two points
//! in which the cones' outlines meet, in the plane of both axes, fits the major axes of the two
//! ellipses and, in general, not the minor ones.

use std::f64::consts::LN_2;

use glam::DVec3;

use super::cone::{Cone, CutPlane};
use super::limbs::{Limb, Limbs, Start};
use super::segment::{Cap, EndKind, Segment, SegmentBody, SegmentEnd};
use super::tangent::sphere;
use super::{ReferenceEnds, ReferenceJoin, ReferenceSettings};

/// Two outlines, or two axes, are parallel below this sine of the angle between them.
const PARALLEL: f64 = 1e-12;
/// The iteration stops when the minor axes agree to this, relatively ...
const TOLERANCE: f64 = 1e-9;
/// ... or after this many rounds.
const ROUNDS: usize = 32;

/// The outlines' meeting points A and B, and the normal N_m of the plane of both axes.
#[derive(Clone, Copy)]
struct Outline {
    a: DVec3,
    b: DVec3,
    medial: DVec3,
}

/// Equations 3 and 4: where the outlines of two cones meet, left and right of the axes.
fn outline(joint: DVec3, first: &Cone, second: &Cone) -> Option<Outline> {
    let medial = first.axis.cross(second.axis);
    if medial.length() <= PARALLEL {
        return None;
    }
    let medial = medial.normalize();
    let meet = |side: f64| {
        // A point of each outline, at the height of the joint, and its direction.
        let line = |cone: &Cone| {
            let across = -side * cone.axis.cross(medial);
            let y = cone.axis.dot(joint - cone.base);
            (
                cone.base + y * cone.axis + cone.radius_at(y) * across,
                cone.axis + cone.slope * across,
            )
        };
        let ((p, u), (q, v)) = (line(first), line(second));
        let sine = u.cross(v).dot(medial);
        let point = p + u * ((q - p).cross(v).dot(medial) / sine);
        (sine.abs() > PARALLEL && point.is_finite()).then_some(point)
    };
    Some(Outline {
        a: meet(1.0)?,
        b: meet(-1.0)?,
        medial,
    })
}

/// Equation 5, turned so that the normal points along the axes; through the joint, across the
/// bisector of the axes, where the outlines do not meet.
fn cut(joint: DVec3, first: &Cone, second: &Cone) -> CutPlane {
    let along = (first.axis + second.axis).normalize_or(first.axis);
    let paper = outline(joint, first, second).and_then(|Outline { a, b, medial }| {
        let normal = (a - b).cross(medial).try_normalize()?;
        let normal = if normal.dot(along) < 0.0 {
            -normal
        } else {
            normal
        };
        Some(CutPlane {
            point: joint,
            normal,
            offset: normal.dot(0.5 * (a + b) - joint),
        })
    });
    paper.unwrap_or(CutPlane {
        point: joint,
        normal: along,
        offset: 0.0,
    })
}

/// The minor half-axis of the ellipse that a cone and the plane through A, B have in common: above
/// the middle of AB, at the distance x from the axis, |P⊥|² = x² + b² = r(y)².
fn minor_axis(cone: &Cone, outline: &Outline) -> f64 {
    let from_base = 0.5 * (outline.a + outline.b) - cone.base;
    let y = from_base.dot(cone.axis);
    let x = from_base.reject_from_normalized(cone.axis).length();
    let r = cone.radius_at(y);
    ((r - x) * (r + x)).sqrt()
}

/// §2.2's last paragraph: the base radius r1 of the new cone is adjusted until the minor axes match.
///
/// How, the paper leaves open. Scaling r1 by the ratio of the axes alone overshoots at shallow
/// bends (at 10° and a taper of 2 by more each round), so that is the first step only; the others
/// are secant steps on the logarithms. Where the axes do not come to match, the cone is the one of
/// the best match.
fn fit(joint: DVec3, first: &Cone, second: Cone) -> Cone {
    let end_radius = second.radius_at(second.length);
    let mismatch = |cone: &Cone| {
        let outline = outline(joint, first, cone)?;
        let ratio = minor_axis(first, &outline) / minor_axis(cone, &outline);
        Some(ratio.ln()).filter(|m| m.is_finite())
    };
    let mut cone = second;
    let mut best = (f64::INFINITY, second);
    let mut last: Option<(f64, f64)> = None;
    for _ in 0..ROUNDS {
        let Some(m) = mismatch(&cone) else {
            break;
        };
        if m.abs() < best.0 {
            best = (m.abs(), cone);
        }
        if best.0 <= TOLERANCE {
            break;
        }
        let x = cone.radius.ln();
        let step = last.map_or(m, |(last_x, last_m)| -m * (x - last_x) / (m - last_m));
        last = Some((x, m));
        // No more than a factor of 2 a round, lest the plane tips over.
        let r1 = (x + step.clamp(-LN_2, LN_2)).exp();
        if !r1.is_finite() || r1 <= 0.0 {
            break;
        }
        cone = Cone::through_circles(cone.base, cone.axis, cone.length, r1, end_radius);
    }
    best.1
}

/// The cones of a limb and its continuation as a variant has them, and their cutting plane.
pub(super) fn join(
    joint: DVec3,
    first: &Cone,
    second: Cone,
    variant: ReferenceJoin,
) -> (Cone, CutPlane) {
    let second = match variant {
        ReferenceJoin::PaperIterated => fit(joint, first, second),
        _ => second,
    };
    (second, cut(joint, first, &second))
}

/// The cone of a segment, before any iteration.
fn cone(limb: &Limb) -> Option<Cone> {
    (limb.length > 0.0).then(|| {
        Cone::through_circles(
            limb.from,
            limb.axis,
            limb.length,
            limb.start_radius,
            limb.end_radius,
        )
    })
}

/// All segments of a skeleton. A segment of no length has no cone and is the larger of its
/// spheres; its neighbours end at right angles to their axes.
pub(super) fn segments(limbs: &Limbs, settings: ReferenceSettings) -> Vec<Segment> {
    let mut cones: Vec<Option<Cone>> = vec![None; limbs.by_joint.len()];
    let mut planes: Vec<Option<CutPlane>> = vec![None; limbs.by_joint.len()];
    // Parents come first, and with them the cone that a child's is fitted to.
    for limb in limbs.iter() {
        let mut own = cone(limb);
        if let (Start::Continuation, Some(first), Some(second)) =
            (limb.start, cones[limb.parent], own)
        {
            let (second, plane) = join(limb.from, &first, second, settings.join);
            own = Some(second);
            planes[limb.parent] = Some(plane);
        }
        cones[limb.joint] = own;
    }
    let square = |point: DVec3, normal: DVec3| CutPlane {
        point,
        normal,
        offset: 0.0,
    };
    let free = |plane: CutPlane, radius: f64| SegmentEnd {
        kind: EndKind::Free,
        plane,
        cap: match settings.ends {
            ReferenceEnds::Round => Cap::Sphere(radius),
            ReferenceEnds::Flat => Cap::Disc(radius),
        },
    };
    let open = |kind: EndKind, plane: CutPlane| SegmentEnd {
        kind,
        plane,
        cap: Cap::Open,
    };
    let body = |limb: &Limb| {
        let Some(cone) = cones[limb.joint] else {
            return sphere(limb);
        };
        let from = square(limb.from, -limb.axis);
        let to = square(limb.to, limb.axis);
        SegmentBody::Frustum {
            cone,
            start: match limb.start {
                Start::Root => free(from, limb.start_radius),
                Start::Continuation => open(
                    EndKind::Mitre,
                    planes[limb.parent].map_or(from, CutPlane::flipped),
                ),
                Start::Branch => open(EndKind::Branch, from),
            },
            end: match limbs.continuation[limb.joint] {
                None => free(to, limb.end_radius),
                Some(_) => open(EndKind::Mitre, planes[limb.joint].unwrap_or(to)),
            },
        }
    };
    limbs
        .iter()
        .map(|limb| Segment {
            joint: limb.joint,
            parent: limb.parent,
            body: body(limb),
        })
        .collect()
}

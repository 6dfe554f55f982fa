//! Ray casting a frustum (§2.5, in a stable form).
//!
//! Inserting the ray in |P⊥|² = r(y)² gives a quadratic in t. Its coefficients lose their digits when the eye is
//! far away, and its discriminant when the frustum is thin, so the origin is first moved along the ray to the
//! point nearest the segment's middle, then to the vertex of the parabola. Of the roots the first counts
//! that is ahead, on the proper nappe and between the planes. `shaders/cast.wgsl` is this file term for term.
//!
//! In 32 bits the depth is right to 10⁻⁷ of itself, from 1 to 10⁷ lengths away (`docs/limits.md`, Precision).

use super::cone::{EndKind, Frustum};
use super::scalar::{Real, Vec3};

/// Which part of a frustum's surface was hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The cone.
    Cone,
    /// The cap at the base.
    Start,
    /// The cap, or the joint's sphere, at the tip.
    End,
}

/// Where a ray meets a frustum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance along the ray, in lengths of its direction.
    pub t: Real,
    /// The point, relative to the frustum's base.
    pub point: Vec3,
    /// The part of the surface it lies on.
    pub part: Part,
}

/// A ray in the plant's local space, relative to the frustum's base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin, E in the paper, minus the frustum's base.
    pub origin: Vec3,
    /// Direction, D in the paper; of any length but zero.
    pub direction: Vec3,
}

/// Sizes of the segment at which the parabola's vertex is far off.
const FAR: Real = 4.0;
/// Below this share of |D|² the quadratic's first coefficient is taken for zero: its second root is far off.
const ALONG: Real = 1e-12;
/// Stands for a root that does not exist; no test accepts it.
const NO_ROOT: Real = 1e30;

/// The first point ahead of `t_min` at which the ray meets the frustum's surface.
///
/// `slack` widens both planes, in metres, so that neighbours overlap by a sliver instead of leaving one open; a
/// hundredth of a pixel is plenty.
pub fn cast_ray(ray: &Ray, frustum: &Frustum, t_min: Real, slack: Real) -> Option<Hit> {
    let (d, axis) = (ray.direction, frustum.axis);
    let dd = d.dot(d);
    // Move the origin to the point of the ray nearest the middle of the segment.
    let t_c = (axis * (0.5 * frustum.length) - ray.origin).dot(d) / dd;
    let p = ray.origin + d * t_c;
    let t_min = t_min - t_c;
    let mut best = NO_ROOT;
    let mut part = Part::Cone;
    if frustum.has_cone() {
        let (t1, t2) = cone_roots(p, d, dd, frustum);
        if t1 > t_min && on_frustum(p + d * t1, slack, frustum) {
            best = t1;
        } else if t2 > t_min && on_frustum(p + d * t2, slack, frustum) {
            best = t2;
        }
    }
    let start = cap_root(
        p,
        d,
        dd,
        t_min,
        slack,
        frustum.start.kind,
        -frustum.start.normal,
        -frustum.start.offset,
        frustum.start.radius,
        frustum.radius,
    );
    if start < best {
        best = start;
        part = Part::Start;
    }
    let end = cap_root(
        p - axis * frustum.length,
        d,
        dd,
        t_min,
        slack,
        frustum.end.kind,
        frustum.end.normal,
        frustum.end.offset,
        frustum.end.radius,
        frustum.radius + frustum.slope * frustum.length,
    );
    if end < best {
        best = end;
        part = Part::End;
    }
    (best < NO_ROOT).then(|| Hit {
        t: best + t_c,
        point: p + d * best,
        part,
    })
}

/// Both roots of the ray with the infinite cone, in order, with t measured from `p`.
fn cone_roots(p: Vec3, d: Vec3, dd: Real, frustum: &Frustum) -> (Real, Real) {
    let (axis, k) = (frustum.axis, frustum.slope);
    let dy = d.dot(axis);
    let d_perp = d - axis * dy;
    let dr = k * dy;
    let a = d_perp.dot(d_perp) - dr * dr;
    let mut y = p.dot(axis);
    let mut p_perp = p - axis * y;
    let mut r = frustum.radius + k * y;
    let mut b = p_perp.dot(d_perp) - r * dr;
    // Move the origin once more, to the vertex of the parabola: there c carries the discriminant whole.
    // Not where it is far off, as for a ray along the cone: the point at hand is the better origin then.
    let size = frustum.length + frustum.start.radius.max(frustum.end.radius);
    let mut t_v = 0.0;
    if b * b * dd <= a * a * (FAR * size) * (FAR * size) && a != 0.0 {
        t_v = -b / a;
        let v = p + d * t_v;
        y = v.dot(axis);
        p_perp = v - axis * y;
        r = frustum.radius + k * y;
        b = p_perp.dot(d_perp) - r * dr;
    }
    let distance = p_perp.length();
    let c = (distance - r) * (distance + r);
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return (NO_ROOT, NO_ROOT);
    }
    let root = discriminant.sqrt();
    let q = if b < 0.0 { root - b } else { -(b + root) };
    let t1 = if a.abs() > ALONG * dd { q / a } else { NO_ROOT };
    let t2 = if q != 0.0 { c / q } else { t1 };
    (t1.min(t2) + t_v, t1.max(t2) + t_v)
}

/// True if a point of the infinite cone, relative to the base, lies on the proper nappe and between both planes
/// of a frustum, widened by `slack` metres.
fn on_frustum(point: Vec3, slack: Real, frustum: &Frustum) -> bool {
    let tip = point - frustum.axis * frustum.length;
    frustum.radius + frustum.slope * point.dot(frustum.axis) > 0.0
        && frustum.start.normal.dot(point) - frustum.start.offset
            >= -slack_at(frustum.start.kind, slack)
        && frustum.end.normal.dot(tip) - frustum.end.offset <= slack_at(frustum.end.kind, slack)
}

/// What a plane is widened by: where the surface goes on beyond it, all of `slack`; at a disc's rim, where it turns
/// off, just enough for roundings.
fn slack_at(kind: EndKind, slack: Real) -> Real {
    if kind == EndKind::Flat {
        0.1 * slack
    } else {
        slack
    }
}

/// The first root with a cap, with t measured from `x`, which is relative to the cap's joint. The cap lies on the
/// side ≥ of its plane.
#[allow(
    clippy::too_many_arguments,
    reason = "term for term like the shader, which has no slices of structs"
)]
fn cap_root(
    x: Vec3,
    d: Vec3,
    dd: Real,
    t_min: Real,
    slack: Real,
    kind: EndKind,
    normal: Vec3,
    offset: Real,
    radius: Real,
    disc: Real,
) -> Real {
    if kind == EndKind::Round {
        // The point of the ray nearest the sphere's centre, then half the chord.
        let t_n = -x.dot(d) / dd;
        let distance = (x + d * t_n).length();
        let h2 = (radius - distance) * (radius + distance);
        if h2 >= 0.0 {
            let half = (h2 / dd).sqrt();
            let t1 = t_n - half;
            let t2 = t_n + half;
            if t1 > t_min && normal.dot(x + d * t1) - offset >= -slack {
                return t1;
            }
            if t2 > t_min && normal.dot(x + d * t2) - offset >= -slack {
                return t2;
            }
        }
    } else if kind == EndKind::Flat {
        let speed = normal.dot(d);
        if speed != 0.0 {
            let t = (offset - normal.dot(x)) / speed;
            let point = x + d * t;
            if t > t_min && (point - normal * normal.dot(point)).length() <= disc {
                return t;
            }
        }
    }
    NO_ROOT
}

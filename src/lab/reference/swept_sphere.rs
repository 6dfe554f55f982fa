//! `Round` a second time, with no cone and no plane in it: the union of all spheres that a
//! segment's sphere passes through on its way from joint to joint.

use glam::DVec3;

use super::ReferenceJoint;
use super::limbs::{Limb, Limbs};

/// Signed distance from `p` to the surface of [`Round`](super::ReferenceJoin::Round) with round
/// ends: exact outside; inside negative, and no further from zero than the distance.
/// `f64::INFINITY` for a skeleton without segments.
///
/// # Panics
///
/// When a joint's parent does not come before it.
pub fn swept_sphere_distance(joints: &[ReferenceJoint], p: DVec3) -> f64 {
    distance(&Limbs::new(joints), p)
}

fn distance(limbs: &Limbs, p: DVec3) -> f64 {
    limbs
        .iter()
        .map(|limb| segment_distance(limb, p))
        .fold(f64::INFINITY, f64::min)
}

/// The least of φ(y) = |p − A − yM| − (ρA − s·y) for 0 ≤ y ≤ L.
///
/// With x = (p − A)·M and q the distance to the axis, φ' = −(x − y)/√((x − y)² + q²) + s. It
/// vanishes where the direction from sphere to p has the sine s along the axis:
/// y = x − q·s/√(1 − s²). φ is convex, so the least is there or at the nearer end; with |s| ≥ 1 it
/// is at the larger sphere.
fn segment_distance(limb: &Limb, p: DVec3) -> f64 {
    if limb.length == 0.0 {
        return p.distance(limb.to) - limb.start_radius.max(limb.end_radius);
    }
    let s = limb.sine();
    let y = if s >= 1.0 {
        0.0
    } else if s <= -1.0 {
        limb.length
    } else {
        let from = p - limb.from;
        let x = from.dot(limb.axis);
        let q = from.reject_from_normalized(limb.axis).length();
        (x - q * s / ((1.0 - s) * (1.0 + s)).sqrt()).clamp(0.0, limb.length)
    };
    p.distance(limb.from + y * limb.axis) - (limb.start_radius - s * y)
}

/// The first point with t > `t_min` where the ray `origin` + t·`dir` enters the union of swept
/// spheres, found by steps of the distance itself. `origin` + `t_min`·`dir` has to be outside. A
/// ray that comes within 1e-13 of the skeleton's size counts as a hit.
///
/// # Panics
///
/// When a joint's parent does not come before it.
pub fn sphere_trace(
    joints: &[ReferenceJoint],
    origin: DVec3,
    dir: DVec3,
    t_min: f64,
) -> Option<f64> {
    let limbs = Limbs::new(joints);
    let unit = dir.try_normalize()?;
    // Beyond this t the ray only leaves, and below this distance it has arrived.
    let reach = |limb: &Limb| {
        let radius = limb.start_radius.max(limb.end_radius);
        (limb.from - origin)
            .length()
            .max((limb.to - origin).length())
            + radius
    };
    let far = limbs.iter().map(reach).fold(0.0, f64::max);
    let size = limbs
        .iter()
        .map(|limb| limb.length + limb.start_radius.max(limb.end_radius))
        .fold(0.0, f64::max);
    let mut t = t_min * dir.length();
    while t <= far {
        let step = distance(&limbs, origin + t * unit);
        if step <= 1e-13 * size {
            return Some(t / dir.length());
        }
        t += step;
    }
    None
}

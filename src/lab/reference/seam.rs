//! How well do two cut curves match that should be one?

use std::f64::consts::TAU;

use glam::DVec3;

use super::cone::{Cone, CutPlane};
use super::{ReferenceJoin, paper};

/// Points of a cut curve are taken at so many azimuths.
const AZIMUTHS: usize = 256;

/// Points of the curve in which a plane cuts a cone, at equal steps of azimuth about the axis.
pub fn cut_curve(cone: &Cone, plane: &CutPlane, points: usize) -> impl Iterator<Item = DVec3> {
    let (cone, plane) = (*cone, *plane);
    let (u, v) = cone.axis.any_orthonormal_pair();
    (0..points).map(move |i| {
        let (sin, cos) = (TAU * i as f64 / points as f64).sin_cos();
        let e = u * cos + v * sin;
        let y = cone.cut(&plane, e);
        cone.base + y * cone.axis + cone.radius_at(y) * e
    })
}

/// The gap at the joint of two segments, in units of the joint's radius: the largest distance
/// between the two curves in which the cutting plane cuts the two cones, measured along 256
/// directions from the middle of the first curve, in the plane.
///
/// `axes` are the unit axes of the two segments, `lengths` their lengths, `radii` those of the
/// three joints. `f64::INFINITY` where a curve is no ellipse about that middle. The mitre's plane
/// is taken without its limit; [`ReferenceJoin::Round`] has no curves and no gap.
pub fn seam_gap(axes: [DVec3; 2], lengths: [f64; 2], radii: [f64; 3], join: ReferenceJoin) -> f64 {
    let base = -lengths[0] * axes[0];
    let cones = |cone: fn(DVec3, DVec3, f64, f64, f64) -> Cone| {
        (
            cone(base, axes[0], lengths[0], radii[0], radii[1]),
            cone(DVec3::ZERO, axes[1], lengths[1], radii[1], radii[2]),
        )
    };
    let (first, second, plane) = match join {
        ReferenceJoin::Round => return 0.0,
        ReferenceJoin::Mitre => {
            let (first, second) = cones(Cone::tangent);
            let (c1, c2) = (first.cosine(), second.cosine());
            let n = axes[0] / c1 + axes[1] / c2;
            let offset = radii[1] * (first.sine() / c1 + second.sine() / c2);
            let plane = CutPlane {
                point: DVec3::ZERO,
                normal: n.normalize(),
                offset: offset / n.length(),
            };
            (first, second, plane)
        }
        ReferenceJoin::Paper | ReferenceJoin::PaperIterated => {
            let (first, second) = cones(Cone::through_circles);
            let (second, plane) = paper::join(DVec3::ZERO, &first, second, join);
            (first, second, plane)
        }
    };
    gap(&first, &second, &plane).unwrap_or(f64::INFINITY) / radii[1]
}

fn gap(first: &Cone, second: &Cone, plane: &CutPlane) -> Option<f64> {
    first.cut_range(plane)?;
    second.cut_range(plane)?;
    let middle = cut_curve(first, plane, AZIMUTHS).sum::<DVec3>() / AZIMUTHS as f64;
    let (u, v) = plane.normal.any_orthonormal_pair();
    (0..AZIMUTHS)
        .map(|i| {
            let (sin, cos) = (TAU * i as f64 / AZIMUTHS as f64).sin_cos();
            let dir = u * cos + v * sin;
            let leave = |cone: &Cone| {
                let (from, to) = cone.ray_span(middle, dir)?;
                (from < 0.0 && 0.0 < to).then_some(to)
            };
            Some((leave(first)? - leave(second)?).abs())
        })
        .try_fold(0.0, |largest: f64, gap| Some(largest.max(gap?)))
}

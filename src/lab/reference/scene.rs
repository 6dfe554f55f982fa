//! A skeleton's segments, built once, and the nearest of them on a ray.

use glam::DVec3;

#[cfg(test)]
use super::bvh::Bounds;
use super::bvh::Bvh;
use super::cone::{Cone, CutPlane};
use super::limbs::Limbs;
use super::segment::{Cap, Segment, SegmentBody};
use super::{
    ReferenceGuards, ReferenceHit, ReferenceJoin, ReferenceJoint, ReferencePart, ReferenceSettings,
    paper, tangent,
};

/// A skeleton with all its cutting planes, ready to be hit.
#[derive(Clone, Debug)]
pub struct ReferenceScene {
    segments: Vec<Segment>,
    bvh: Bvh,
}

impl ReferenceScene {
    /// Builds every segment of a skeleton. A root without children draws nothing.
    ///
    /// # Panics
    ///
    /// When a joint's parent does not come before it.
    pub fn new(joints: &[ReferenceJoint], settings: ReferenceSettings) -> Self {
        Self::guarded(joints, settings, ReferenceGuards::default())
    }

    /// The same with guards; the paper's variants have no use for them.
    ///
    /// # Panics
    ///
    /// When a joint's parent does not come before it.
    pub fn guarded(
        joints: &[ReferenceJoint],
        settings: ReferenceSettings,
        guards: ReferenceGuards,
    ) -> Self {
        let limbs = Limbs::new(joints);
        let segments: Vec<_> = match settings.join {
            ReferenceJoin::Mitre | ReferenceJoin::Round => {
                tangent::segments(&limbs, settings, guards)
            }
            ReferenceJoin::Paper | ReferenceJoin::PaperIterated => {
                paper::segments(&limbs, settings)
            }
        };
        let bounds = segments.iter().map(Segment::bounds).collect();
        Self {
            segments,
            bvh: Bvh::new(bounds),
        }
    }

    /// The segments, in the order of the joints that they end at.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The same scene with one box around everything.
    #[cfg(test)]
    pub(super) fn without_tree(&self) -> Self {
        Self {
            segments: self.segments.clone(),
            bvh: Bvh::new(vec![Bounds::ALL; self.segments.len()]),
        }
    }

    /// The first point with t > `t_min` at which the ray `origin` + t·`dir` meets a surface, from
    /// either side. `dir` need not be unit; a zero `dir` hits nothing.
    pub fn cast(&self, origin: DVec3, dir: DVec3, t_min: f64) -> Option<ReferenceHit> {
        let length = dir.length();
        let unit = dir.try_normalize()?;
        let mut nearest = Nearest {
            t_min: t_min * length,
            t: f64::INFINITY,
            hit: None,
        };
        self.bvh.visit(origin, unit, t_min * length, |index| {
            let segment = &self.segments[index];
            // Work from the ray's point nearest the segment, so that a far eye costs no digits.
            let shift = (segment.middle() - origin).dot(unit);
            nearest.segment(segment, origin + shift * unit, unit, shift);
            nearest.t
        });
        nearest.hit.map(|hit| ReferenceHit {
            t: hit.t / length,
            ..hit
        })
    }
}

/// The nearest hit so far; its t in units of length from the ray's origin.
struct Nearest {
    t_min: f64,
    t: f64,
    hit: Option<ReferenceHit>,
}

impl Nearest {
    /// All surfaces of a segment, for the ray `origin` + (t − `shift`)·`dir`, `dir` unit.
    fn segment(&mut self, segment: &Segment, origin: DVec3, dir: DVec3, shift: f64) {
        let mut consider = |t: f64, part: ReferencePart, normal: &dyn Fn(DVec3) -> DVec3| {
            if t + shift > self.t_min && t + shift < self.t {
                self.t = t + shift;
                let position = origin + t * dir;
                self.hit = Some(ReferenceHit {
                    t: self.t,
                    position,
                    segment: segment.joint,
                    surface_normal: normal(position),
                    part,
                });
            }
        };
        match segment.body {
            SegmentBody::Frustum { cone, start, end } => {
                for t in cone_hits(&cone, &[start.plane, end.plane], origin, dir) {
                    consider(t, ReferencePart::Cone, &|p| cone.normal(p));
                }
                for (end, part) in [
                    (start, ReferencePart::StartCap),
                    (end, ReferencePart::EndCap),
                ] {
                    let center = end.plane.point;
                    match end.cap {
                        Cap::Open => {}
                        Cap::Sphere(radius) => {
                            for t in sphere_span(center, radius, origin, dir)
                                .into_iter()
                                .flatten()
                            {
                                if end.plane.distance(origin + t * dir) >= 0.0 {
                                    consider(t, part, &|p| (p - center) / radius);
                                }
                            }
                        }
                        Cap::Disc(radius) => {
                            let t = -end.plane.distance(origin) / end.plane.normal.dot(dir);
                            if t.is_finite() && (origin + t * dir).distance(center) <= radius {
                                consider(t, part, &|_| end.plane.normal);
                            }
                        }
                    }
                }
            }
            SegmentBody::Sphere {
                center,
                radius,
                part,
            } => {
                for t in sphere_span(center, radius, origin, dir)
                    .into_iter()
                    .flatten()
                {
                    consider(t, part, &|p| (p - center) / radius);
                }
            }
            SegmentBody::Hidden => {}
        }
    }
}

/// Where the ray passes through a cone between planes: the ends of the stretch inside all of them,
/// unless it was a plane that put the end there.
fn cone_hits(
    cone: &Cone,
    planes: &[CutPlane; 2],
    origin: DVec3,
    dir: DVec3,
) -> impl Iterator<Item = f64> {
    let (enter, leave) = cone
        .ray_span(origin, dir)
        .unwrap_or((f64::INFINITY, f64::NEG_INFINITY));
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for plane in planes {
        let (distance, rate) = (plane.distance(origin), plane.normal.dot(dir));
        if rate > 0.0 {
            to = to.min(-distance / rate);
        } else if rate < 0.0 {
            from = from.max(-distance / rate);
        } else if distance > 0.0 {
            from = f64::INFINITY;
        }
    }
    [enter, leave]
        .into_iter()
        .filter(move |&t| t.is_finite() && enter <= leave && from <= t && t <= to)
}

/// Where the ray passes through a sphere: nearest point to the centre, then half the chord.
fn sphere_span(center: DVec3, radius: f64, origin: DVec3, dir: DVec3) -> Option<[f64; 2]> {
    let nearest = (center - origin).dot(dir);
    let delta = (origin + nearest * dir).distance(center);
    let half_squared = (radius - delta) * (radius + delta);
    (half_squared > 0.0).then(|| {
        let half = half_squared.sqrt();
        [nearest - half, nearest + half]
    })
}

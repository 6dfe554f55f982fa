//! From a stretch of a ray to the point where it enters the solid.

use glam::DVec3;

use super::super::cone::CutPlane;

/// A stretch of a ray in a convex region, and the plane through which it came in, if it did.
pub(super) struct Stretch {
    pub from: f64,
    pub to: f64,
    /// Its normal.
    pub wall: Option<DVec3>,
}

impl Stretch {
    /// What is left of it on the negative sides of planes, for the ray o + t·d.
    pub fn cut<'a>(
        mut self,
        planes: impl Iterator<Item = &'a CutPlane>,
        o: DVec3,
        d: DVec3,
    ) -> Self {
        for plane in planes {
            let (distance, rate) = (plane.distance(o), plane.normal.dot(d));
            let t = -distance / rate;
            if rate > 0.0 {
                self.to = self.to.min(t);
            } else if rate < 0.0 && t > self.from {
                self.from = t;
                self.wall = Some(plane.normal);
            } else if rate == 0.0 && distance > 0.0 {
                self.from = f64::INFINITY;
            }
        }
        self
    }
}

/// The first t after `t_min` at which `excess` is no longer above zero, and the normal of the plane
/// through which the ray came in if that is where.
pub(super) fn march(
    stretch: Stretch,
    t_min: f64,
    steps: usize,
    excess: &dyn Fn(f64) -> f64,
) -> Option<(f64, Option<DVec3>)> {
    let Stretch { from, to, wall } = stretch;
    let start = from.max(t_min);
    if !(start < to && to.is_finite() && start.is_finite()) {
        return None;
    }
    let mut above = excess(start) > 0.0;
    if !above && from > t_min {
        return Some((from, wall));
    }
    let mut t = start;
    for i in 1..=steps {
        let next = start + (to - start) * (i as f64 / steps as f64);
        let next_above = excess(next) > 0.0;
        if above && !next_above {
            return Some((bisect(t, next, excess), None));
        }
        (t, above) = (next, next_above);
    }
    None
}

/// Halves a step that leads from above zero to below until its ends are neighbouring numbers, or
/// nearly: 1e-15 of the step is far less than 1e-12 of the segment.
fn bisect(mut above: f64, mut below: f64, excess: &dyn Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (above + below);
        if excess(middle) > 0.0 {
            above = middle;
        } else {
            below = middle;
        }
    }
    below
}

/// Direction of the gradient, by central differences over `step`.
pub(super) fn gradient(value: &dyn Fn(DVec3) -> f64, point: DVec3, step: f64) -> DVec3 {
    let along = |e: DVec3| value(point + step * e) - value(point - step * e);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z)).normalize_or_zero()
}

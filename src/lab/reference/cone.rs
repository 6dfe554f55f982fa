//! One cone of revolution: where a ray is inside it, and where a plane cuts it.

use glam::DVec3;

/// The half space n·(P − `point`) ≤ `offset`, whose border is a cutting plane of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPlane {
    /// The joint that the plane belongs to (not, in general, a point of the plane).
    pub point: DVec3,
    /// Unit normal, out of the segment.
    pub normal: DVec3,
    /// Signed distance of the plane from `point` along `normal`.
    pub offset: f64,
}

impl CutPlane {
    /// Signed distance of `p` from the plane: negative on the segment's side.
    pub fn distance(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.point) - self.offset
    }

    /// The same plane, seen from the other side.
    pub fn flipped(self) -> Self {
        Self {
            point: self.point,
            normal: -self.normal,
            offset: -self.offset,
        }
    }
}

/// A cone about a segment's axis: |P⊥| = r(y), where y is the distance from the segment's start A
/// along its unit axis M, and r(y) = `radius` + `slope`·y. Its proper nappe has r ≥ 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// A, the segment's start.
    pub base: DVec3,
    /// M, unit.
    pub axis: DVec3,
    /// L, the segment's length.
    pub length: f64,
    /// r(0), the radius of the cross-section at A.
    pub radius: f64,
    /// dr/dy, negative for a cone that thins out.
    pub slope: f64,
}

impl Cone {
    /// The cone that touches the spheres (A, `start_radius`) and (A + LM, `end_radius`) from
    /// outside.
    ///
    /// In a plane through the axis it is the line at distance ρA from A and ρB from B. With α the
    /// angle between line and axis, walking L along the axis brings the line L sin α nearer, so
    /// sin α = s = (ρA − ρB)/L; a distance ρ to the line is ρ/cos α when measured across the axis.
    /// Hence r(y) = (ρA − s·y)/c with c = √(1 − s²).
    pub fn tangent(
        base: DVec3,
        axis: DVec3,
        length: f64,
        start_radius: f64,
        end_radius: f64,
    ) -> Self {
        let s = (start_radius - end_radius) / length;
        let c = ((1.0 - s) * (1.0 + s)).sqrt();
        Self {
            base,
            axis,
            length,
            radius: start_radius / c,
            slope: -s / c,
        }
    }

    /// The cone through circles of these radii across the axis at both ends of a segment
    /// (Equations 1 and 2 of §2.1 with a signed slope).
    pub fn through_circles(base: DVec3, axis: DVec3, length: f64, r1: f64, r2: f64) -> Self {
        Self {
            base,
            axis,
            length,
            radius: r1,
            slope: (r2 - r1) / length,
        }
    }

    /// c, the cosine of the half-angle: slope = −tan α.
    pub fn cosine(&self) -> f64 {
        1.0 / self.slope.hypot(1.0)
    }

    /// s, the sine of the half-angle, positive for a cone that thins out.
    pub fn sine(&self) -> f64 {
        -self.slope * self.cosine()
    }

    /// r(y), negative on the mirrored nappe.
    pub fn radius_at(&self, y: f64) -> f64 {
        self.radius + self.slope * y
    }

    /// B, the segment's end.
    pub fn tip(&self) -> DVec3 {
        self.base + self.length * self.axis
    }

    /// Signed distance to the cone's nearest generating line in the plane through `p` and the
    /// axis: (|P⊥| − r(y))·c, negative inside, zero on the proper nappe.
    pub fn residual(&self, p: DVec3) -> f64 {
        let y = self.axis.dot(p - self.base);
        let across = p - self.base - y * self.axis;
        (across.length() - self.radius_at(y)) * self.cosine()
    }

    /// Unit normal out of the cone at a point of it: e·c + M·s, e being the direction of P⊥.
    pub fn normal(&self, p: DVec3) -> DVec3 {
        let across = (p - self.base).reject_from_normalized(self.axis);
        let e = across.normalize_or(self.axis.any_orthonormal_vector());
        e * self.cosine() + self.axis * self.sine()
    }

    /// Where the plane meets the generating line in direction `e` (unit, across the axis): y.
    ///
    /// The line is A + yM + r(y)e, so n·M y + n·e (r(0) + slope·y) = d, d measured from A.
    pub fn cut(&self, plane: &CutPlane, e: DVec3) -> f64 {
        let ne = plane.normal.dot(e);
        let nm = plane.normal.dot(self.axis);
        (-plane.distance(self.base) - ne * self.radius) / (nm + ne * self.slope)
    }

    /// The range of y on the curve in which the plane cuts the cone, or `None` where that curve is
    /// no ellipse and some generating line never meets the plane.
    ///
    /// Along the curve y depends on n·e alone, as a quotient of linear functions; without a pole
    /// in n·e = ±|n⊥| that is monotonic, and the extremes lie at those two ends.
    pub fn cut_range(&self, plane: &CutPlane) -> Option<(f64, f64)> {
        let side = plane.normal.dot(self.axis).signum();
        let nm = side * plane.normal.dot(self.axis);
        let np = plane.normal.reject_from_normalized(self.axis).length();
        let d = -side * plane.distance(self.base);
        let ends = [np, -np].map(|ne| {
            let pole = nm + ne * self.slope;
            (pole > 0.0).then(|| (d - ne * self.radius) / pole)
        });
        Some((ends[0]?.min(ends[1]?), ends[0]?.max(ends[1]?)))
    }

    /// The stretch [t0, t1] of the ray `origin` + t·`dir` inside the solid proper nappe; an end may
    /// be infinite. `dir` is unit, and `origin` near the segment, for accuracy's sake.
    ///
    /// f(t) = r(y(t)) − |P⊥(t)| is a linear function less a norm, hence concave: the ray is inside
    /// on one stretch. Measure τ from the ray's point nearest the axis, at distance δ from it: with
    /// w = |D⊥|, m = slope·D·M and r* the cone's radius there,
    ///
    /// |P⊥|² = δ² + w²τ², r = r* + mτ, so (w² − m²)τ² − 2r*mτ + δ² − r*² = 0.
    ///
    /// The discriminant is w²(r*² − δ²) + m²δ². If w > |m| both roots lie on one nappe, which is
    /// the proper one if r* is positive. Otherwise the ray stays inside at one of its ends and each
    /// nappe has one root; on the proper one r*w² − |m|√disc is what remains ≤ 0 over w² − m².
    pub fn ray_span(&self, origin: DVec3, dir: DVec3) -> Option<(f64, f64)> {
        let from_base = origin - self.base;
        let (oy, dy) = (from_base.dot(self.axis), dir.dot(self.axis));
        let (across, spread) = (from_base - oy * self.axis, dir - dy * self.axis);
        let w2 = spread.length_squared();
        let parallel = w2 < 1e-28;
        let nearest = if parallel {
            0.0
        } else {
            -across.dot(spread) / w2
        };
        let w2 = if parallel { 0.0 } else { w2 };
        let delta = (across + nearest * spread).length();
        let r = self.radius_at(oy + nearest * dy);
        let m = self.slope * dy;
        let a = w2 - m * m;
        let c = (delta - r) * (delta + r);
        let discriminant = (m * delta).powi(2) - w2 * c;
        let polish = |tau: f64| self.polish(origin, dir, nearest + tau);
        if a > 0.0 {
            // The ray crosses the cone from side to side.
            if discriminant < 0.0 || r <= 0.0 {
                return None;
            }
            let q = r * m + discriminant.sqrt().copysign(m);
            if q == 0.0 {
                return None;
            }
            let (t0, t1) = (polish(q / a), polish(c / q));
            return Some((t0.min(t1), t0.max(t1)));
        }
        if m == 0.0 {
            // Parallel to the axis of a cylinder: inside everywhere or nowhere.
            return (c < 0.0 && r > 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY));
        }
        let root = discriminant.max(0.0).sqrt().copysign(m);
        let tau = if r > 0.0 {
            c / (r * m + root)
        } else if a < 0.0 {
            (r * m - root) / a
        } else {
            return None;
        };
        let t = polish(tau);
        Some(if m > 0.0 {
            (t, f64::INFINITY)
        } else {
            (f64::NEG_INFINITY, t)
        })
    }

    /// Newton's steps on f(t) = r − |P⊥|, as long as they bring it nearer zero.
    fn polish(&self, origin: DVec3, dir: DVec3, mut t: f64) -> f64 {
        let evaluate = |t: f64| {
            let p = origin - self.base + t * dir;
            let y = p.dot(self.axis);
            let across = p - y * self.axis;
            let f = self.radius_at(y) - across.length();
            let slope = self.slope * dir.dot(self.axis) - across.normalize_or_zero().dot(dir);
            (f, slope)
        };
        let (mut f, mut slope) = evaluate(t);
        for _ in 0..3 {
            let next = t - f / slope;
            if !next.is_finite() {
                break;
            }
            let (next_f, next_slope) = evaluate(next);
            if next_f.abs() >= f.abs() {
                break;
            }
            (t, f, slope) = (next, next_f, next_slope);
        }
        t
    }
}

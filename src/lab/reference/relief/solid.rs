//! The solid of one segment: where a ray is in it, and which (u, v, w) has a point.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::super::bvh::Bounds;
use super::super::cone::{Cone, CutPlane};
use super::march::{Stretch, gradient, march};
use super::{ReliefHit, ReliefPart, SegmentTexture};

/// The shell about a cone, between two planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct ConeShell {
    pub inner: Cone,
    pub outer: Cone,
    pub start: CutPlane,
    pub end: CutPlane,
}

/// The shell about a sphere, on the near side of up to two planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct BallShell {
    pub center: DVec3,
    pub radius: f64,
    pub thickness: f64,
    /// The ball is on the negative side of each.
    pub planes: [Option<CutPlane>; 2],
    /// Axis of the segment beyond a round join, where u is to be turned towards it.
    pub turned_to: Option<DVec3>,
    pub part: ReliefPart,
}

/// A segment with relief.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub joint: usize,
    /// A point near all of it.
    pub middle: DVec3,
    /// M.
    pub axis: DVec3,
    pub base: DVec3,
    /// Where u = 0 at v = 0, unit and across the axis.
    pub reference: DVec3,
    /// Direction across the axis towards which u leans at the start, and by how much.
    pub lean: Option<(DVec3, f64)>,
    pub texture: SegmentTexture,
    pub cone: Option<ConeShell>,
    pub balls: Vec<BallShell>,
}

/// u, v of the segment, and w.
type Coordinates = (f64, f64, f64);

impl ConeShell {
    /// The cone of height w: radii between those of the inner and the outer one in the same
    /// proportion at every y (Equations 11 and 12), so that it passes through every point of w.
    pub fn level(&self, w: f64) -> Cone {
        let (inner, outer) = (&self.inner, &self.outer);
        Cone {
            radius: inner.radius + w * (outer.radius - inner.radius),
            slope: inner.slope + w * (outer.slope - inner.slope),
            ..*inner
        }
    }

    fn stretch(&self, o: DVec3, d: DVec3) -> Option<Stretch> {
        let (from, to) = self.outer.ray_span(o, d)?;
        let inside = Stretch {
            from,
            to,
            wall: None,
        };
        Some(inside.cut([self.start, self.end].iter(), o, d))
    }
}

impl BallShell {
    fn stretch(&self, o: DVec3, d: DVec3) -> Option<Stretch> {
        let nearest = (self.center - o).dot(d);
        let delta = (o + nearest * d).distance(self.center);
        let radius = self.radius + self.thickness;
        let half = ((radius - delta) * (radius + delta)).sqrt();
        let inside = Stretch {
            from: nearest - half,
            to: nearest + half,
            wall: None,
        };
        (half > 0.0).then(|| inside.cut(self.planes.iter().flatten(), o, d))
    }
}

impl Solid {
    /// A box around the outer shell; unbounded where a plane does not close its cone.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        if let Some(ConeShell {
            outer, start, end, ..
        }) = self.cone
        {
            let closes = start.normal.dot(outer.axis) < 0.0 && end.normal.dot(outer.axis) > 0.0;
            match (outer.cut_range(&start), outer.cut_range(&end)) {
                (Some((low, _)), Some((_, high))) if closes => {
                    for y in [low, high] {
                        let center = outer.base + y * outer.axis;
                        bounds.add_disc(center, outer.axis, outer.radius_at(y).max(0.0));
                    }
                }
                _ => return Bounds::ALL,
            }
        }
        for ball in &self.balls {
            bounds.add_sphere(ball.center, ball.radius + ball.thickness);
        }
        bounds
    }

    /// u at a point, for the v that the twist is taken at (Equation 6).
    fn u(&self, point: DVec3, v: f64) -> f64 {
        let mut e = (point - self.base).reject_from_normalized(self.axis);
        if let Some((b, kappa)) = self.lean {
            // cos φ was made (cos φ + κ)/(1 + κ cos φ); here from its value back to cos φ.
            let kappa = kappa * (1.0 - v.clamp(0.0, 1.0));
            let side = self.axis.cross(b);
            let (cos, sin) = (e.dot(b), e.dot(side));
            let root = ((1.0 - kappa) * (1.0 + kappa)).sqrt();
            e = b * (cos - kappa * e.length()) + side * (root * sin);
        }
        let (x, z) = (
            e.dot(self.reference),
            e.dot(self.axis.cross(self.reference)),
        );
        ((z.atan2(x) + v * self.texture.twist) / TAU).rem_euclid(1.0)
    }

    /// The relief map's v.
    pub fn map_v(&self, v: f64) -> f64 {
        let SegmentTexture { v_start, v_end, .. } = self.texture;
        v_start + (v_end - v_start) * v.clamp(0.0, 1.0)
    }

    /// (u, v, w) in the shell about the cone.
    pub fn on_cone(&self, shell: &ConeShell, point: DVec3) -> Coordinates {
        let y = self.axis.dot(point - self.base);
        let across = point - self.base - y * self.axis;
        let (r0, r1) = (shell.inner.radius_at(y), shell.outer.radius_at(y));
        let w = (across.length() - r0) / (r1 - r0);
        // Equation 7 on the cone of that height; below the shell no height is asked for.
        let cone = shell.level(w.max(0.0));
        let e = across.normalize_or(self.reference);
        let (y_l, y_u) = (cone.cut(&shell.start, e), cone.cut(&shell.end, e));
        let v = (y - y_l) / (y_u - y_l);
        (self.u(point, v), v, w)
    }

    /// (u, v, w) in the shell about a ball: radial, with v that of the cone's end.
    pub fn on_ball(&self, ball: &BallShell, point: DVec3) -> Coordinates {
        let w = (point.distance(ball.center) - ball.radius) / ball.thickness;
        let v = if ball.part == ReliefPart::StartCap {
            0.0
        } else {
            1.0
        };
        let seen = self.turned_back(ball, point).unwrap_or(point);
        (self.u(seen, v), v, w)
    }

    /// A point of a round join's ball, turned to where it is about this segment's axis what it was
    /// about an axis between both: at distances a from one plane and b from the other that of
    /// b·M1 + a·M2. Between cylinders that axis is the one whose plane across holds the point.
    fn turned_back(&self, ball: &BallShell, point: DVec3) -> Option<DVec3> {
        let [Some(plane), Some(beyond)] = ball.planes else {
            return None;
        };
        let a = -plane.distance(point).min(0.0);
        let b = -beyond.distance(point).min(0.0);
        let axis = (b * self.axis + a * ball.turned_to?).try_normalize()?;
        let turn = DQuat::from_rotation_arc(axis, self.axis);
        Some(ball.center + turn * (point - ball.center))
    }

    /// The first point after `t_min` at which the ray enters what is below the relief.
    pub fn first_hit(
        &self,
        origin: DVec3,
        dir: DVec3,
        t_min: f64,
        steps: usize,
        relief: &dyn Fn(f64, f64) -> f64,
    ) -> Option<ReliefHit> {
        let map = |(u, v, _): Coordinates| relief(u, self.map_v(v));
        let mut best: Option<ReliefHit> = None;
        let mut consider = |stretch: Option<Stretch>,
                            part: ReliefPart,
                            coordinates: &dyn Fn(DVec3) -> Coordinates,
                            size: f64| {
            let excess = |point: DVec3| {
                let at = coordinates(point);
                if at.2 < 0.0 { at.2 } else { at.2 - map(at) }
            };
            let Some((t, wall)) = stretch
                .and_then(|stretch| march(stretch, t_min, steps, &|t| excess(origin + t * dir)))
            else {
                return;
            };
            if best.is_some_and(|best| best.t <= t) {
                return;
            }
            let position = origin + t * dir;
            let at = coordinates(position);
            best = Some(ReliefHit {
                t,
                position,
                segment: self.joint,
                u: at.0,
                v: at.1.clamp(0.0, 1.0),
                w: at.2,
                height: map(at),
                normal: wall.unwrap_or_else(|| gradient(&excess, position, 1e-6 * size)),
                part: if wall.is_some() {
                    ReliefPart::Wall
                } else {
                    part
                },
            });
        };
        if let Some(shell) = &self.cone {
            let size = shell.outer.radius_at(0.5 * shell.outer.length);
            let stretch = shell.stretch(origin, dir);
            consider(
                stretch,
                ReliefPart::Cone,
                &|point| self.on_cone(shell, point),
                size,
            );
        }
        for ball in &self.balls {
            let stretch = ball.stretch(origin, dir);
            consider(
                stretch,
                ball.part,
                &|point| self.on_ball(ball, point),
                ball.radius,
            );
        }
        best
    }
}

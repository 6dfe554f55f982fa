//! The rings of each segment: its grid, and what closes or joins its ends.

use std::f64::consts::{FRAC_PI_2, TAU};

use bevy::math::{DQuat, DVec3};

use super::sheet::{Owner, Ring, Sheet};
use crate::frusta::double::cone::{EndKind, Frustum};
use crate::frusta::double::join::{Link, NONE};
use crate::frusta::double::shell::Shell;
use crate::frusta::double::surface::generator_span;

/// Below this bend, in radians, and this share of the radius between the contact circles, a round join is none.
const STRAIGHT: f64 = 1e-6;

/// A skeleton that is drawn, segment by segment.
pub(super) struct Limbs<'a> {
    pub links: &'a [Link],
    pub shells: &'a [Shell],
    /// The map's v at both ends of each segment.
    pub v_ranges: &'a [[f64; 2]],
    pub height: Option<&'a dyn Fn(f64, f64) -> f64>,
    /// Quads along a segment.
    pub along: u32,
    pub close_branches: bool,
}

/// Which end of a segment.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Start,
    End,
}

impl Limbs<'_> {
    pub fn draw(&self, sheet: &mut Sheet) {
        // Parents come first: their last rings are there for those that go on from them.
        let mut last: Vec<Option<Ring>> = vec![None; self.links.len()];
        for i in 0..self.links.len() {
            if self.links[i].parent == NONE {
                continue;
            }
            last[i] = if self.shells[i].frustum.has_cone() {
                Some(self.draw_cone(sheet, i, &last))
            } else {
                self.draw_sphere(sheet, i);
                None
            };
        }
    }

    /// H, made sure to be a height.
    fn height(&self, u: f64, v: f64) -> f64 {
        let height = self.height.map_or(0.0, |height| height(u, v));
        if height.is_nan() {
            0.0
        } else {
            height.clamp(0.0, 1.0)
        }
    }

    fn map_v(&self, i: usize, v: f64) -> f64 {
        let [start, end] = self.v_ranges[i];
        // Exact at both ends, where segments meet.
        start * (1.0 - v) + end * v
    }

    /// The frustum of the relief's height at (u, v) of a segment, and the direction of u across its axis.
    fn frustum_at(&self, i: usize, u: f64, v: f64) -> (Frustum, DVec3) {
        let frustum = self.shells[i].at(self.height(u, self.map_v(i, v)));
        let across = self.shells[i].across(u, v, self.links[i].twist);
        (frustum, across)
    }

    /// The point (u, v) of a segment with relief.
    fn point(&self, i: usize, u: f64, v: f64) -> DVec3 {
        let (frustum, across) = self.frustum_at(i, u, v);
        let (y_l, y_u) = generator_span(&frustum, across);
        let y = y_l * (1.0 - v) + y_u * v;
        frustum.base + frustum.axis * y + across * (frustum.radius + frustum.slope * y)
    }

    fn ring(&self, sheet: &mut Sheet, i: usize, v: f64) -> Ring {
        let us: Vec<_> = (0..sheet.around()).map(|k| sheet.u(k)).collect();
        sheet.ring(Owner::alone(i), self.map_v(i, v), |k| {
            self.point(i, us[k as usize], v)
        })
    }

    /// Draws a segment with a cone; returns its last ring.
    fn draw_cone(&self, sheet: &mut Sheet, i: usize, last: &[Option<Ring>]) -> Ring {
        let link = &self.links[i];
        let frustum = &self.shells[i].frustum;
        let parent = link.parent as usize;
        let before = last[parent].filter(|_| link.continues);
        let mitred = self.shells[parent].frustum.end.kind == EndKind::Cut;
        let mut ring = match before {
            Some(ring) if mitred || self.runs_straight(parent, i) => {
                sheet.share(ring, i);
                ring
            }
            before => {
                let ring = self.ring(sheet, i, 0.0);
                if let Some(before) = before {
                    self.bridge(sheet, parent, i, before, ring);
                }
                ring
            }
        };
        if before.is_none() {
            match frustum.start.kind {
                EndKind::Round => self.cap(sheet, i, Side::Start, ring),
                EndKind::Flat => self.disc(sheet, i, Side::Start, ring),
                EndKind::Cut if self.close_branches => self.disc(sheet, i, Side::Start, ring),
                EndKind::Cut => {}
            }
        }
        for j in 1..=self.along {
            let next = self.ring(sheet, i, f64::from(j) / f64::from(self.along));
            sheet.strip(ring, next);
            ring = next;
        }
        let goes_on = link.next != NONE && self.shells[link.next as usize].frustum.has_cone();
        match frustum.end.kind {
            EndKind::Round if !goes_on => self.cap(sheet, i, Side::End, ring),
            EndKind::Flat => self.disc(sheet, i, Side::End, ring),
            _ => {}
        }
        ring
    }

    /// Whether the contact circles of a round join are one.
    fn runs_straight(&self, first: usize, second: usize) -> bool {
        let (one, two) = (&self.shells[first].frustum, &self.shells[second].frustum);
        one.axis.distance(two.axis) < STRAIGHT
            && (one.end.offset - two.start.offset).abs() < STRAIGHT * one.end.radius
    }

    /// A strip of the joint's sphere from the last ring of one segment to the first of the next: the first's ring is
    /// turned with the axis, as u is, while it moves from one contact circle to the other.
    fn bridge(&self, sheet: &mut Sheet, first: usize, second: usize, from: Ring, to: Ring) {
        let (one, two) = (&self.shells[first].frustum, &self.shells[second].frustum);
        let center = two.base;
        let bend = one
            .axis
            .cross(two.axis)
            .length()
            .atan2(one.axis.dot(two.axis));
        // At a fold any turn will do that leaves u = 0 where it is.
        let about = one
            .axis
            .cross(two.axis)
            .try_normalize()
            .unwrap_or(two.reference);
        let steps = (bend / FRAC_PI_2 * f64::from(2 * self.along))
            .ceil()
            .max(1.0) as u32;
        let mut rings = vec![from];
        for step in 1..steps {
            let t = f64::from(step) / f64::from(steps);
            // Back from the second's frame, where u = 0 is known.
            let turn = DQuat::from_axis_angle(about, (t - 1.0) * bend);
            let (axis, reference) = (turn * two.axis, turn * two.reference);
            let side = axis.cross(reference);
            let places: Vec<_> = (0..sheet.around())
                .map(|k| {
                    let (x1, x2) = (sheet.place(from, k) - center, sheet.place(to, k) - center);
                    let latitude = |x: DVec3, axis: DVec3| (x.dot(axis) / x.length()).asin();
                    let a = latitude(x1, one.axis) * (1.0 - t) + latitude(x2, two.axis) * t;
                    let (sin, cos) = (sheet.u(k) * TAU).sin_cos();
                    let across = reference * cos + side * sin;
                    let distance = x1.length() * (1.0 - t) + x2.length() * t;
                    center + distance * (across * a.cos() + axis * a.sin())
                })
                .collect();
            let owner = Owner {
                segment: first as u32,
                neighbour: second as u32,
            };
            let v = self.map_v(first, 1.0);
            rings.push(sheet.ring(owner, v, |k| places[k as usize]));
        }
        rings.push(to);
        sheet.bridge(&rings, center);
    }

    /// Rings from a segment's first or last one over the joint's sphere to its pole.
    fn cap(&self, sheet: &mut Sheet, i: usize, side: Side, ring: Ring) {
        let frustum = &self.shells[i].frustum;
        let (center, out, v) = match side {
            Side::Start => (frustum.base, -frustum.axis, 0.0),
            Side::End => (frustum.tip(), frustum.axis, 1.0),
        };
        let steps = 2 * self.along;
        let mut low = ring;
        for step in 1..steps {
            let t = f64::from(step) / f64::from(steps);
            let places: Vec<_> = (0..sheet.around())
                .map(|k| {
                    let x = sheet.place(ring, k) - center;
                    let (_, across) = self.frustum_at(i, sheet.u(k), v);
                    let from = x.dot(out).atan2(x.dot(across));
                    let (sin, cos) = (from * (1.0 - t) + FRAC_PI_2 * t).sin_cos();
                    center + self.sphere_radius(i, side, sheet.u(k)) * (across * cos + out * sin)
                })
                .collect();
            let high = sheet.ring(Owner::alone(i), self.map_v(i, v), |k| places[k as usize]);
            match side {
                Side::Start => sheet.strip(high, low),
                Side::End => sheet.strip(low, high),
            }
            low = high;
        }
        let pole = center + out * self.pole_radius(sheet, i, side);
        sheet.fan(low, pole, side == Side::End);
    }

    /// Radius of the joint's sphere at one end of a segment, with the relief at u.
    fn sphere_radius(&self, i: usize, side: Side, u: f64) -> f64 {
        let v = if side == Side::Start { 0.0 } else { 1.0 };
        let frustum = self.shells[i].at(self.height(u, self.map_v(i, v)));
        match side {
            Side::Start => frustum.start.radius,
            Side::End => frustum.end.radius,
        }
    }

    /// All u meet at a pole: it has their mean height.
    fn pole_radius(&self, sheet: &Sheet, i: usize, side: Side) -> f64 {
        let around = sheet.around();
        let sum: f64 = (0..around)
            .map(|k| self.sphere_radius(i, side, sheet.u(k)))
            .sum();
        sum / f64::from(around)
    }

    /// A flat end.
    fn disc(&self, sheet: &mut Sheet, i: usize, side: Side, ring: Ring) {
        let frustum = &self.shells[i].frustum;
        let (joint, end) = match side {
            Side::Start => (frustum.base, &frustum.start),
            Side::End => (frustum.tip(), &frustum.end),
        };
        let edge = sheet.edge(ring);
        let middle = joint + frustum.axis * (end.offset / end.normal.dot(frustum.axis));
        sheet.fan(edge, middle, side == Side::End);
    }

    /// A segment without cone: the larger of its spheres, if it is the one to draw it.
    fn draw_sphere(&self, sheet: &mut Sheet, i: usize) {
        let frustum = &self.shells[i].frustum;
        let (center, side, v) = if frustum.end.kind == EndKind::Round {
            (frustum.tip(), Side::End, 1.0)
        } else if frustum.start.kind == EndKind::Round {
            (frustum.base, Side::Start, 0.0)
        } else {
            return;
        };
        let steps = 4 * self.along;
        let mut low: Option<Ring> = None;
        let pole = frustum.axis * self.pole_radius(sheet, i, side);
        for step in 1..steps {
            let latitude = FRAC_PI_2 * (2.0 * f64::from(step) / f64::from(steps) - 1.0);
            let places: Vec<_> = (0..sheet.around())
                .map(|k| {
                    let (_, across) = self.frustum_at(i, sheet.u(k), v);
                    let (sin, cos) = latitude.sin_cos();
                    let radius = self.sphere_radius(i, side, sheet.u(k));
                    center + radius * (across * cos + frustum.axis * sin)
                })
                .collect();
            let high = sheet.ring(Owner::alone(i), self.map_v(i, v), |k| places[k as usize]);
            match low {
                Some(low) => sheet.strip(low, high),
                None => sheet.fan(high, center - pole, false),
            }
            low = Some(high);
        }
        if let Some(low) = low {
            sheet.fan(low, center + pole, true);
        }
    }
}

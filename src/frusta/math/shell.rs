//! The shell (§3): inner and outer frustum of each segment, divided from its neighbours by one plane for all heights.
//!
//! A joint has two spheres, of radius ρ and ρ + h. The cones that touch them are the inner and the outer cone; the
//! relief height w runs from 0 on one to 1 on the other. The cones of each height meet in a plane of their own. With
//! a shell of constant thickness these planes are parallel, offset by ρ + wh times (t1 + t2)/|M1/c1 + M2/c2|, t the
//! tangents of the half-angles: on the plane of height p the cones of height w miss each other by about
//! |w − p| h (t1 + t2) tan(bend/2), twice that where h is relative to ρ. So the middle height halves the largest misfit.

use super::cone::{Cone, End, EndKind, Frustum};
use super::join::{Link, NONE, PosedJoint, Skin, skin};
use super::mitre::mitre;
use super::scalar::{Real, Vec3, consts};
use super::surface::align;

/// Height of the cones whose cutting planes divide the shell. While the outer frusta have room for their mitres each
/// point has one owner; in a thicker shell the join is round, and neighbours overlap (`docs/limits.md`, Thick shells).
pub const PLANE_LEVEL: Real = 0.5;

/// How thick the shell is at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Thickness {
    /// The same everywhere, in metres.
    Metres(Real),
    /// This share of the joint's radius.
    Relative(Real),
}

impl Thickness {
    /// h at a joint of this radius, in metres; 0 where that is no positive number.
    pub fn at(self, radius: Real) -> Real {
        let h = match self {
            Self::Metres(h) => h,
            Self::Relative(share) => share * radius,
        };
        if h > 0.0 && h.is_finite() { h } else { 0.0 }
    }
}

/// The shell of one segment.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Shell {
    /// The frustum of height [`PLANE_LEVEL`]: its planes and the kinds of its ends are those of all heights.
    pub frustum: Frustum,
    /// Cross-section radius at the base and slope of the inner cone.
    inner: (Real, Real),
    /// The same of the outer cone.
    outer: (Real, Real),
    /// By how much and whither u leans at the start, to be in line with the segment before; see [`align_shells`].
    skew: Vec3,
    /// Radius of the inner and of the outer sphere at the base.
    start: (Real, Real),
    /// The same at the tip.
    end: (Real, Real),
}

fn between((inner, outer): (Real, Real), w: Real) -> Real {
    inner + (outer - inner) * w
}

impl Shell {
    /// The frustum of height `w`: radii between the inner and the outer ones in the same proportion at every
    /// axial distance (Equations 11 and 12), so that the cone passes through every point of that height.
    pub fn at(&self, w: Real) -> Frustum {
        let mut frustum = self.frustum;
        if frustum.has_cone() {
            frustum.radius = between((self.inner.0, self.outer.0), w);
            frustum.slope = between((self.inner.1, self.outer.1), w);
            frustum.secant = (1.0 + frustum.slope * frustum.slope).sqrt();
        }
        frustum.start.radius = between(self.start, w);
        frustum.end.radius = between(self.end, w);
        frustum
    }

    /// The direction across the axis of (u, v), for a texture twisted by `twist` radians.
    pub fn across(&self, u: Real, v: Real, twist: Real) -> Vec3 {
        let Frustum {
            axis, reference, ..
        } = self.frustum;
        let (sin, cos) = (u * consts::TAU - v * twist).sin_cos();
        let across = reference * cos + axis.cross(reference) * sin;
        leant(across, self.skew * (1.0 - v))
    }

    /// (u, v, w) of a point between the planes, relative to the base, for a texture twisted by `twist` radians.
    ///
    /// Equation 7 needs neither P_l nor P_u: from the point, the generator g = M + k e runs a/(n_l·g) back to the
    /// start's plane and b/(n_u·g) on to the end's, a and b being the distances from both planes. So v is exact at the
    /// cost of one division, and where the shell has one thickness, so that all its cones have one slope, whatever w.
    pub fn coordinates(&self, point: Vec3, twist: Real) -> (Real, Real, Real) {
        let Frustum {
            axis,
            length,
            start,
            end,
            reference,
            ..
        } = self.frustum;
        let y = point.dot(axis);
        let radial = point - axis * y;
        let distance = radial.length();
        let across = if distance > 0.0 {
            radial / distance
        } else {
            reference
        };
        let r_0 = self.inner.0 + self.inner.1 * y;
        let r_1 = self.outer.0 + self.outer.1 * y;
        let w = (distance - r_0) / (r_1 - r_0);
        let g = axis + across * between((self.inner.1, self.outer.1), w.max(0.0));
        let a = (start.normal.dot(point) - start.offset) * end.normal.dot(g);
        let b = (end.offset - end.normal.dot(point - axis * length)) * start.normal.dot(g);
        let v = a / (a + b);
        let across = leant(across, self.skew * (v - 1.0));
        let side = axis.cross(reference);
        let turn = across.dot(side).atan2(across.dot(reference)) + v * twist;
        ((turn / consts::TAU).rem_euclid(1.0), v, w)
    }
}

/// Computes the shells of a posed skeleton; like [`skin`], which it follows, not their references.
///
/// Which joins are mitres and which ends are flat is decided by the outer frusta: what has room for them has room for
/// all below. `frusta` is left with those of height [`PLANE_LEVEL`], cut by the shell's planes.
///
/// # Panics
/// If the slices differ in length or a link names a joint outside them.
pub fn skin_shell(
    links: &[Link],
    joints: &[PosedJoint],
    settings: Skin,
    thickness: Thickness,
    frusta: &mut [Frustum],
) -> Vec<Shell> {
    let outer: Vec<_> = joints
        .iter()
        .map(|joint| PosedJoint {
            radius: joint.radius + thickness.at(joint.radius),
            ..*joint
        })
        .collect();
    skin(links, &outer, settings, frusta);
    let mut shells: Vec<Shell> = Vec::with_capacity(links.len());
    for (i, link) in links.iter().enumerate() {
        let mut shell = Shell {
            frustum: frusta[i],
            ..Shell::default()
        };
        if link.parent != NONE {
            let (from, to) = (joints[link.parent as usize].radius, joints[i].radius);
            let from = if link.continues { from } else { from.min(to) };
            shell.start = (from, from + thickness.at(from));
            shell.end = (to, to + thickness.at(to));
        }
        if frusta[i].has_cone() {
            let cone = |w: Real| {
                let (from, to) = (between(shell.start, w), between(shell.end, w));
                Cone::touching(frusta[i].axis, frusta[i].length, from, to)
            };
            let (inner, level, outer) = (cone(0.0), cone(PLANE_LEVEL), cone(1.0));
            shell.inner = (inner.radius, inner.slope);
            shell.outer = (outer.radius, outer.slope);
            let frustum = &mut shell.frustum;
            (frustum.radius, frustum.slope, frustum.secant) =
                (level.radius, level.slope, level.secant);
            frustum.start.radius = between(shell.start, PLANE_LEVEL);
            frustum.end.radius = between(shell.end, PLANE_LEVEL);
            let sine = level.sine();
            lower(&mut frustum.start, sine);
            lower(&mut frustum.end, sine);
        }
        frusta[i] = shell.frustum;
        shells.push(shell);
    }
    for (second, link) in links.iter().enumerate() {
        let first = link.parent as usize;
        let joined = link.continues && link.parent != NONE && links[first].parent != NONE;
        let cones = joined && frusta[first].has_cone() && frusta[second].has_cone();
        if !cones || frusta[first].end.kind != EndKind::Cut {
            continue;
        }
        let radius = frusta[first].end.radius;
        let (one, two) = (frusta[first].cone(), frusta[second].cone());
        if let Some(mitre) = mitre(&one, &two, radius) {
            for end in [&mut frusta[first].end, &mut frusta[second].start] {
                end.normal = mitre.plane.normal;
                end.offset = mitre.plane.offset;
            }
        }
        shells[first].frustum.end = frusta[first].end;
        shells[second].frustum.start = frusta[second].start;
    }
    shells
}

/// Moves an end's plane from the outer cone's contact circle to this cone's. Mitres are replaced later.
fn lower(end: &mut End, sine: Real) {
    if end.kind != EndKind::Flat {
        end.offset = end.radius * sine;
    }
}

/// Lines up the u of all shells, as [`align`] does; then, if `continuous`, all round each cut.
///
/// Equation 6 is in line with the segment before at u = 0 alone: with taper t and at a bend, cones see the points of
/// their common cut at azimuths that differ by up to about (t1 + t2) tan(bend/2), and ridges of the relief break there,
/// by up to twice that where u = 0 lies across the plane of the bend (`docs/limits.md`, u at a mitre).
/// In polar form the cut is r = C/(1 + η cos φ) on either cone, φ measured from the outside of the bend, with
/// η = k (n·b)/(n·M). That makes one azimuth a projective function of the other,
///
/// ```text
/// cos φ2 = (cos φ1 + κ)/(1 + κ cos φ1),  κ = (η1 − η2)/(1 − η1 η2),
/// ```
///
/// which is to lean a unit vector across the axis by κ towards the outside. The second segment takes its u from vectors
/// leant back by κ (1 − v), and its reference from the first's by the shortest turn: u is then the same on both sides of
/// the cut, exactly at the height of the planes and within a tenth of the misfit at others.
///
/// # Panics
/// If the slices differ in length.
pub fn align_shells(
    links: &[Link],
    shells: &mut [Shell],
    continuous: bool,
    first: impl Fn(usize) -> Vec3,
) {
    let mut frusta: Vec<_> = shells.iter().map(|shell| shell.frustum).collect();
    if continuous {
        // Where an end is no cut, `align` turns the reference with the axis.
        for frustum in &mut frusta {
            frustum.end.kind = EndKind::Round;
        }
    }
    align(links, &mut frusta, first);
    for (i, link) in links.iter().enumerate() {
        shells[i].frustum.reference = frusta[i].reference;
        shells[i].skew = Vec3::ZERO;
        let before = link.parent as usize;
        if continuous && link.parent != NONE && link.continues && links[before].parent != NONE {
            shells[i].skew = skew(&shells[before].frustum, &shells[i].frustum);
        }
    }
}

/// κ times the direction of the outside of the bend, across the second axis; zero where there is no mitre.
fn skew(first: &Frustum, second: &Frustum) -> Vec3 {
    let (m1, m2) = (first.axis, second.axis);
    let mitred = first.end.kind == EndKind::Cut && first.has_cone() && second.has_cone();
    let cosine = m1.dot(m2);
    let outside = (
        (m1 * cosine - m2).try_normalize(),
        (m1 - m2 * cosine).try_normalize(),
    );
    let (true, (Some(b1), Some(b2))) = (mitred, outside) else {
        return Vec3::ZERO;
    };
    let n = second.start.normal;
    let eta1 = first.slope * n.dot(b1) / n.dot(m1);
    let eta2 = second.slope * n.dot(b2) / n.dot(m2);
    b2 * ((eta1 - eta2) / (1.0 - eta1 * eta2))
}

/// A unit vector leant towards `skew` by its length: cos φ becomes (cos φ + κ)/(1 + κ cos φ).
fn leant(across: Vec3, skew: Vec3) -> Vec3 {
    let cosine = across.dot(skew);
    let root = (1.0 - skew.dot(skew)).max(0.0).sqrt();
    (across * root + skew * (1.0 + cosine / (1.0 + root))) / (1.0 + cosine)
}

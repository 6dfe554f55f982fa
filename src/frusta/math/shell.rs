//! The shell (§3): inner and outer frustum of each segment, divided from its neighbours by one plane for all heights.
//!
//! A joint has two spheres, of radius ρ and ρ + h. The cones that touch them are the inner and the outer cone; the
//! relief height w runs from 0 on one to 1 on the other. The cones of each height meet in a plane of their own. With
//! a shell of constant thickness these planes are parallel, offset by ρ + wh times (t1 + t2)/|M1/c1 + M2/c2|, t the
//! tangents of the half-angles: on the plane of height p the cones of height w miss each other by about
//! |w − p| h (t1 + t2) tan(bend/2), twice that where h is relative to ρ. So the middle height halves the largest misfit.

use super::cone::{Cone, End, EndKind, Frustum, SMALLEST_COSINE_SQUARED};
use super::join::{Link, NONE, PosedJoint, Skin, skin};
use super::mitre::mitre;
use super::scalar::{Real, Vec3, consts};
use super::surface::{align, align_turned};

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

/// Greatest thickness of a shell, in radii of the joint; more is taken for this.
pub const THICKEST: Real = 8.0;
/// Least radius of the inner sphere, in radii of the joint: a shell is no thicker below the joint's radius than that
/// leaves.
pub const THINNEST: Real = 0.05;

/// Where the shell lies about the joints' spheres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellShape {
    /// How thick it is.
    pub thickness: Thickness,
    /// The relief height, 0 to 1, that lies at the joints' radii: at 0 the relief stands on them, as in the paper; at
    /// 1 it is carved into them.
    pub level: Real,
}

impl ShellShape {
    /// Radii of the inner and the outer sphere of a joint.
    #[inline]
    pub fn radii(&self, radius: Real) -> (Real, Real) {
        let level = if self.level > 0.0 {
            self.level.min(1.0)
        } else {
            0.0
        };
        let thickest = if level * THICKEST > 1.0 - THINNEST {
            (1.0 - THINNEST) / level
        } else {
            THICKEST
        };
        let h = self.thickness.at(radius).min(thickest * radius);
        let inner = radius - level * h;
        (inner, inner + h)
    }

    /// Radius of the sphere of height `w` of a joint.
    #[inline]
    pub fn radius_at(&self, radius: Real, w: Real) -> Real {
        between(self.radii(radius), w)
    }
}

impl From<Thickness> for ShellShape {
    /// The shell stands on the joints' spheres.
    fn from(thickness: Thickness) -> Self {
        Self {
            thickness,
            level: 0.0,
        }
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

/// Computes the frusta of height [`PLANE_LEVEL`] of a posed skeleton with relief, cut by the planes that divide the
/// shell; like [`skin`], which it follows, not their references. Allocates nothing.
///
/// Which joins are mitres and which ends are flat is decided by the outer frusta: what has room for them has room for
/// all below. `joints` are those of the outer spheres while this runs, and what they were when it is done.
///
/// # Panics
/// If the slices differ in length or a link names a joint outside them.
pub fn skin_level(
    links: &[Link],
    joints: &mut [PosedJoint],
    radii: impl Fn(usize) -> Real,
    settings: Skin,
    shape: ShellShape,
    frusta: &mut [Frustum],
) {
    for (i, joint) in joints.iter_mut().enumerate() {
        joint.radius = shape.radii(radii(i)).1;
    }
    skin(links, joints, settings, frusta);
    for (i, joint) in joints.iter_mut().enumerate() {
        joint.radius = radii(i);
    }
    for (i, link) in links.iter().enumerate() {
        if link.parent == NONE {
            continue;
        }
        let to = joints[i].radius;
        let from = start_radius(link, joints[link.parent as usize].radius, to);
        let (from, to) = (
            shape.radius_at(from, PLANE_LEVEL),
            shape.radius_at(to, PLANE_LEVEL),
        );
        let frustum = &mut frusta[i];
        *frustum = at_height(frustum, from, to);
        if frustum.has_cone() {
            let sine = frustum.cone().sine();
            lower(&mut frustum.start, sine);
            lower(&mut frustum.end, sine);
        }
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
    }
}

/// A frustum of height [`PLANE_LEVEL`] at another height, that of the spheres of radius `from` at its start and `to` at
/// its end.
pub fn at_height(level: &Frustum, from: Real, to: Real) -> Frustum {
    let mut frustum = *level;
    frustum.start.radius = from;
    frustum.end.radius = to;
    if level.has_cone() {
        let cone = shell_cone(level.axis, level.length, from, to);
        (frustum.radius, frustum.slope, frustum.secant) = (cone.radius, cone.slope, cone.secant);
    }
    frustum
}

/// Radius of the sphere at a segment's start. A branch starts with its own.
#[inline]
pub fn start_radius(link: &Link, from: Real, to: Real) -> Real {
    if link.continues { from } else { from.min(to) }
}

/// The cone of one height. Where a clamped thickness leaves one sphere inside the other, the steepest there is.
#[inline]
pub fn shell_cone(axis: Vec3, length: Real, from: Real, to: Real) -> Cone {
    let steepest = 1.0 - SMALLEST_COSINE_SQUARED;
    let sine = ((from - to) / length).clamp(-steepest, steepest);
    Cone::opening(axis, from, sine)
}

/// Computes the shells of a posed skeleton as [`skin_level`] does. `frusta` is left with those of height
/// [`PLANE_LEVEL`].
///
/// # Panics
/// If the slices differ in length or a link names a joint outside them.
pub fn skin_shell(
    links: &[Link],
    joints: &[PosedJoint],
    settings: Skin,
    shape: impl Into<ShellShape>,
    frusta: &mut [Frustum],
) -> Vec<Shell> {
    let shape = shape.into();
    let radius = |i: usize| joints[i].radius;
    skin_level(links, &mut joints.to_vec(), radius, settings, shape, frusta);
    let shells = links.iter().zip(frusta.iter()).enumerate();
    shells
        .map(|(i, (link, frustum))| {
            let mut shell = Shell {
                frustum: *frustum,
                ..Shell::default()
            };
            if link.parent != NONE {
                let (from, to) = (radius(link.parent as usize), radius(i));
                shell.start = shape.radii(start_radius(link, from, to));
                shell.end = shape.radii(to);
            }
            if frustum.has_cone() {
                let cone = |w: Real| {
                    let (from, to) = (between(shell.start, w), between(shell.end, w));
                    shell_cone(frustum.axis, frustum.length, from, to)
                };
                let (inner, outer) = (cone(0.0), cone(1.0));
                shell.inner = (inner.radius, inner.slope);
                shell.outer = (outer.radius, outer.slope);
            }
            shell
        })
        .collect()
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
        align_turned(links, &mut frusta, first, |_| None);
    } else {
        align(links, &mut frusta, first);
    }
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
pub fn skew(first: &Frustum, second: &Frustum) -> Vec3 {
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

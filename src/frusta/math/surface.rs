//! The parametrization of a frustum and its normals (§2.3, §2.4).
//!
//! u runs round the axis, from the segment's reference, by the right hand about the axis; v runs along the
//! limb from the start's plane to the end's. Points are relative to the frustum's base.

use super::cast::Part;
use super::cone::{EndKind, Frustum};
use super::join::{Link, NONE};
use super::scalar::{Real, Vec3, consts};

/// Which of the two normals of §2.4 a surface is shaded with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Normals {
    /// Interpolated between the ends (Equation 8): continuous from segment to segment.
    #[default]
    Continuous,
    /// The surface's own: shows every joint as a crease.
    Geometric,
}

/// Smallest cosine between a generator and a plane's normal that v is computed with.
const GRAZING: Real = 1e-6;

/// The parametrization at a point of a frustum's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Equation 6: the turn about the axis, from 0 to 1, twist included.
    pub u: Real,
    /// Equation 7: 0 on the start's plane, 1 on the end's.
    pub v: Real,
    /// Unit normal.
    pub normal: Vec3,
}

/// Axial distances at which the generator through `across`, a unit vector across the axis, meets the planes
/// of both ends: P_l and P_u of Equation 7.
#[inline]
pub fn generator_span(frustum: &Frustum, across: Vec3) -> (Real, Real) {
    let start = &frustum.start;
    let end = &frustum.end;
    let m_l = start.normal.dot(frustum.axis);
    let q_l = start.normal.dot(across);
    let y_l = (start.offset - frustum.radius * q_l) / (m_l + frustum.slope * q_l).max(GRAZING);
    let m_u = end.normal.dot(frustum.axis);
    let q_u = end.normal.dot(across);
    let y_u = (end.offset + m_u * frustum.length - frustum.radius * q_u)
        / (m_u + frustum.slope * q_u).max(GRAZING);
    (y_l, y_u)
}

/// u, v and normal at `point` on part `part` of a frustum whose texture is twisted by `twist` radians.
pub fn surface_point(
    frustum: &Frustum,
    twist: Real,
    point: Vec3,
    part: Part,
    normals: Normals,
) -> SurfacePoint {
    let axis = frustum.axis;
    let y = point.dot(axis);
    let radial = point - axis * y;
    let distance = radial.length();
    let across = if distance > 0.0 {
        radial / distance
    } else {
        frustum.reference
    };
    let (v, normal) = match part {
        Part::Cone => {
            let (y_l, y_u) = generator_span(frustum, across);
            let v = ((y - y_l) / (y_u - y_l)).clamp(0.0, 1.0);
            let normal = match normals {
                Normals::Continuous => {
                    let n_l = axis * y_l + across * (frustum.radius + frustum.slope * y_l);
                    let n_u = axis * (y_u - frustum.length)
                        + across * (frustum.radius + frustum.slope * y_u);
                    n_l.normalize_or(across) * (1.0 - v) + n_u.normalize_or(across) * v
                }
                Normals::Geometric => across - axis * frustum.slope,
            };
            (v, normal)
        }
        Part::Start if frustum.start.kind == EndKind::Flat => (0.0, -axis),
        Part::End if frustum.end.kind == EndKind::Flat => (1.0, axis),
        Part::Start => (0.0, point),
        Part::End => (1.0, point - axis * frustum.length),
    };
    let side = axis.cross(frustum.reference);
    let turn = across.dot(side).atan2(across.dot(frustum.reference)) + v * twist;
    SurfacePoint {
        u: (turn / consts::TAU).rem_euclid(1.0),
        v,
        normal: normal.normalize_or(across),
    }
}

/// Lines up the u of all segments (§2.3): where a limb goes on, its reference is carried over the cutting plane;
/// where a limb begins, `first(i)` gives a direction that need not be exactly across the axis.
///
/// # Panics
/// If the slices differ in length.
pub fn align(links: &[Link], frusta: &mut [Frustum], first: impl Fn(usize) -> Vec3) {
    align_rolled(links, frusta, first, |_| None);
}

/// The same for segments that are turned about their own axes: `roll(i)`, cosine and sine by the right hand, is added to
/// what is carried over to segment `i`.
///
/// # Panics
/// If the slices differ in length.
pub fn align_rolled(
    links: &[Link],
    frusta: &mut [Frustum],
    first: impl Fn(usize) -> Vec3,
    roll: impl Fn(usize) -> Option<[Real; 2]>,
) {
    align_by(links, frusta, first, roll, carry_over);
}

/// As [`align_rolled`], but references are turned with the axis at all joins, as relief wants them: its u is in line
/// all round a cut ([`skew`](super::shell::skew)).
///
/// # Panics
/// If the slices differ in length.
pub fn align_turned(
    links: &[Link],
    frusta: &mut [Frustum],
    first: impl Fn(usize) -> Vec3,
    roll: impl Fn(usize) -> Option<[Real; 2]>,
) {
    align_by(links, frusta, first, roll, |first, twist, second| {
        turn_over(at_end(first, twist), first, second)
    });
}

#[inline(always)]
fn align_by(
    links: &[Link],
    frusta: &mut [Frustum],
    first: impl Fn(usize) -> Vec3,
    roll: impl Fn(usize) -> Option<[Real; 2]>,
    carry: impl Fn(&Frustum, Real, &Frustum) -> Vec3,
) {
    assert_eq!(links.len(), frusta.len());
    for i in 0..links.len() {
        let parent = links[i].parent;
        if parent == NONE {
            continue;
        }
        let parent = parent as usize;
        let begins = links[parent].parent == NONE;
        let wish = if begins {
            first(i)
        } else {
            carry(&frusta[parent], links[parent].twist, &frusta[i])
        };
        let axis = frusta[i].axis;
        let mut reference = (wish - axis * wish.dot(axis))
            .try_normalize()
            .unwrap_or_else(|| axis.any_orthonormal_vector());
        if !begins && let Some([cos, sin]) = roll(i) {
            reference = reference * cos + axis.cross(reference) * sin;
        }
        frusta[i].reference = reference;
    }
}

/// The direction of u = 0 at a frustum's end.
#[inline(always)]
fn at_end(frustum: &Frustum, twist: Real) -> Vec3 {
    if twist == 0.0 {
        return frustum.reference;
    }
    // u = φ/2π + v θ/2π is 0 at v = 1 where φ = −θ.
    frustum.reference * twist.cos() - frustum.axis.cross(frustum.reference) * twist.sin()
}

/// The first frustum's point u = 0 at its end, seen from the second.
#[inline]
fn carry_over(first: &Frustum, twist: Real, second: &Frustum) -> Vec3 {
    let across = at_end(first, twist);
    if first.end.kind == EndKind::Cut && first.has_cone() {
        // Bring u in line on the cutting plane: this point lies on both cones.
        let at_joint = first.radius + first.slope * first.length;
        let m = first.end.normal.dot(first.axis);
        let q = first.end.normal.dot(across);
        let y = (first.end.offset - at_joint * q) / (m + first.slope * q).max(GRAZING);
        return first.axis * y + across * (at_joint + first.slope * y);
    }
    turn_over(across, first, second)
}

/// The shortest turn from one axis to the other; at a fold there is none, and the direction is across both.
#[inline(always)]
fn turn_over(across: Vec3, first: &Frustum, second: &Frustum) -> Vec3 {
    let sum = first.axis + second.axis;
    let cosine = 1.0 + first.axis.dot(second.axis);
    if cosine > GRAZING {
        across - sum * (across.dot(second.axis) / cosine)
    } else {
        across
    }
}

//! Joins: how the frusta of a limb meet (§2.2, made exact).
//!
//! A joint's radius ρ is that of a sphere which the cones of all its segments touch. Two cones that touch one
//! sphere meet in plane curves; with X measured from the joint the cutting plane is
//!
//! ```text
//! (M1/c1 + M2/c2) · X = ρ (s1/c1 + s2/c2)
//! ```
//!
//! The first cone keeps the side ≤, the second ≥. In terms of slopes, k = −s/c, the right side is −ρ (k1 + k2).
//! Where such a mitre would reach past its segment, or the plane no longer cuts an ellipse, the join is round:
//! both cones end on the circles where they touch the sphere, and the sphere fills the gap.

use super::cone::{Cone, End, EndKind, Frustum, WHOLE, touches_both};
use super::paper;
use super::scalar::{Real, Vec3};

/// How the frusta of a limb meet at a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum JoinKind {
    /// A plane through the curve in which both cones meet, exact for any bend and taper, with a fall back to
    /// `Round` where the mitre would reach past a segment.
    #[default]
    Mitre,
    /// The joint's sphere. Watertight for every bend up to and including a fold.
    Round,
    /// The paper's construction (Equations 3 to 5): planes through the major axes. For comparison.
    Paper,
    /// The paper's construction with its iteration on the base radius r1. For comparison.
    PaperIterated,
}

/// No joint.
pub const NONE: u32 = u32::MAX;

/// Where a segment hangs in its skeleton. A segment has the index of the joint that ends it; parents stand
/// before their children.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// The joint that the segment starts from, or [`NONE`] for a root joint, which ends no segment.
    pub parent: u32,
    /// The joint whose segment continues this one's limb, or [`NONE`] at a free end.
    pub next: u32,
    /// True when this segment continues its parent's limb (or begins a root's); false when it branches off.
    pub continues: bool,
    /// True when further segments branch off at the joint.
    pub branches: bool,
    /// Twist of the texture along the segment, θ in §2.3, in radians.
    pub twist: Real,
}

/// A joint of a skeleton in the pose that is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PosedJoint {
    /// Position in the plant's local space, in metres.
    pub position: Vec3,
    /// Radius of the joint's sphere, in metres.
    pub radius: Real,
}

/// How a whole skeleton is skinned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Skin {
    /// How frusta meet.
    pub join: JoinKind,
    /// How free ends are closed: `Round` or `Flat`.
    pub ends: EndKind,
}

/// A cutting plane, normal·X = offset with X measured from the joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuttingPlane {
    /// Unit normal, pointing along the limb.
    pub normal: Vec3,
    /// Signed distance from the joint, in metres.
    pub offset: Real,
}

/// Below this share of its greatest length the sum of both axes is taken for a fold, which has no mitre.
const FOLD: Real = 1e-4;
/// How far a plane's tilt stays from one that cuts a parabola: cosine of the tilt above |s|.
const ELLIPSE: Real = 1e-4;
/// Share of a segment that must be left between its two ends.
const SPACING: Real = 1e-4;
/// How far a mitre may reach past its joint on the outside of a bend, in radii of the joint. Where cones widen
/// towards a joint the outside grows without bound as the bend nears the last one that has an ellipse.
const SPIKE: Real = 4.0;

/// A cutting plane's tilt against a cone's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// Cosine of the angle between the plane's normal and the axis.
    pub cosine: Real,
    /// Sine of that angle, not negative.
    pub sine: Real,
}

impl Tilt {
    /// The tilt of a plane with unit `normal` against a unit `axis`. The sine comes from the cross product: it keeps its
    /// digits where the limb runs straight.
    #[inline]
    pub fn of(normal: Vec3, axis: Vec3) -> Self {
        Self {
            cosine: normal.dot(axis),
            sine: normal.cross(axis).length(),
        }
    }
}

/// The plane in which two cones meet that touch a sphere of `radius` about the joint, with its tilt against both;
/// `None` at a fold.
#[inline]
pub fn mitre_plane(first: &Cone, second: &Cone, radius: Real) -> Option<(CuttingPlane, [Tilt; 2])> {
    let (w1, w2) = (first.secant, second.secant);
    let normal = first.axis * w1 + second.axis * w2;
    let length = normal.length();
    if length <= FOLD * (w1 + w2) {
        return None;
    }
    let scale = 1.0 / length;
    let plane = CuttingPlane {
        normal: normal * scale,
        offset: -radius * (first.slope + second.slope) * scale,
    };
    // With the bend between the axes: normal·M1 = w1 + w2 cos, |normal × M1| = w2 sin.
    let cosine = first.axis.dot(second.axis);
    let sine = first.axis.cross(second.axis).length();
    let tilt1 = Tilt {
        cosine: (w1 + w2 * cosine) * scale,
        sine: w2 * sine * scale,
    };
    let tilt2 = Tilt {
        cosine: (w1 * cosine + w2) * scale,
        sine: w1 * sine * scale,
    };
    Some((plane, [tilt1, tilt2]))
}

/// Least and greatest axial distance, from the joint, of the ellipse that a plane of this `tilt` and `offset` cuts from
/// a cone of radius `radius` at the joint; `None` if the curve is no ellipse.
#[inline]
pub fn cut_extent(
    radius: Real,
    slope: Real,
    secant: Real,
    tilt: Tilt,
    offset: Real,
) -> Option<(Real, Real)> {
    let Tilt { cosine: m, sine: q } = tilt;
    // Tilt and opening leave an ellipse while m > |s|, that is m/c > |k|.
    if (m - ELLIPSE) * secant <= slope.abs() {
        return None;
    }
    let y1 = (offset - radius * q) / (m + slope * q);
    let y2 = (offset + radius * q) / (m - slope * q);
    Some((y1.min(y2), y1.max(y2)))
}

/// Recomputes the frusta of a posed skeleton: cones, cutting planes and ends, but not their references
/// ([`align`](super::surface::align) does). The slices have one entry a joint; the entry of a root joint, which ends no segment,
/// draws nothing. Allocates nothing.
///
/// # Panics
/// If the slices differ in length or a link names a joint outside them.
pub fn skin(links: &[Link], joints: &[PosedJoint], skin: Skin, frusta: &mut [Frustum]) {
    assert!(links.len() == joints.len() && joints.len() == frusta.len());
    for (i, frustum) in frusta.iter_mut().enumerate() {
        *frustum = round_frustum(i, links, joints, skin.join);
    }
    match skin.join {
        JoinKind::Round => {}
        JoinKind::Mitre => {
            for (first, second) in joins(links) {
                mitre(first, second, joints[first].radius, frusta);
            }
            // A mitre stays where both its segments have room for it. `reach` is left as it is when a join is
            // made round, so that every join is judged by the same figures, whatever the order.
            for (first, second) in joins(links) {
                if frusta[first].end.kind == EndKind::Cut
                    && !(has_room(&frusta[first]) && has_room(&frusta[second]))
                {
                    make_round(first, second, frusta);
                }
            }
        }
        JoinKind::Paper | JoinKind::PaperIterated => {
            let iterate = skin.join == JoinKind::PaperIterated;
            for (first, second) in joins(links) {
                paper::join(first, second, joints, iterate, frusta);
            }
        }
    }
    if skin.ends == EndKind::Flat {
        for i in 0..links.len() {
            flatten_ends(i, links, skin.join, frusta);
        }
    }
}

/// Closes the free ends of a segment with discs, where a disc can close them: not where a sibling starts, half
/// below the disc, nor where the sphere of the segment's other joint, or its contact circle, reaches through it.
fn flatten_ends(i: usize, links: &[Link], join: JoinKind, frusta: &mut [Frustum]) {
    let link = links[i];
    if link.parent == NONE || !frusta[i].has_cone() {
        return;
    }
    let parent = &links[link.parent as usize];
    let begins_root = parent.parent == NONE && link.continues;
    let after_mitre = parent.parent != NONE
        && link.continues
        && frusta[link.parent as usize].end.kind == EndKind::Cut;
    let any = matches!(join, JoinKind::Paper | JoinKind::PaperIterated);
    let frustum = &mut frusta[i];
    let room = frustum.length * (1.0 - SPACING);
    let alone = !link.branches && (link.next == NONE || frustum.end.kind == EndKind::Cut);
    if begins_root && (any || !parent.branches && (alone || frustum.end.radius <= room)) {
        flatten(&mut frustum.start);
    }
    if link.next == NONE {
        let clear = if link.continues {
            !parent.branches && (begins_root || after_mitre) || frustum.start.radius <= room
        } else {
            frustum.start.radius * frustum.cone().sine() <= room
        };
        if any || clear {
            flatten(&mut frustum.end);
        }
    }
}

/// Closes an end with a disc through its joint.
fn flatten(end: &mut End) {
    end.kind = EndKind::Flat;
    end.offset = 0.0;
    end.reach = 0.0;
}

/// The joins of a skeleton: pairs of a segment and the one that continues its limb.
fn joins(links: &[Link]) -> impl Iterator<Item = (usize, usize)> + '_ {
    links.iter().enumerate().filter_map(|(i, link)| {
        let first = link.parent as usize;
        (link.continues && link.parent != NONE && links[first].parent != NONE).then_some((first, i))
    })
}

/// The frustum of segment `i` as if every join were round.
#[inline]
fn round_frustum(i: usize, links: &[Link], joints: &[PosedJoint], join: JoinKind) -> Frustum {
    let link = links[i];
    if link.parent == NONE {
        return Frustum {
            base: joints[i].position,
            radius: -1.0,
            axis: Vec3::Y,
            ..Frustum::default()
        };
    }
    let (from, to) = (joints[link.parent as usize], joints[i]);
    let begins_root = link.continues && links[link.parent as usize].parent == NONE;
    // A branch starts on its parent's axis with its own radius and runs out through the surface. Its start
    // lies inside the joint's sphere, so it needs no cap.
    let radius_from = if link.continues {
        from.radius
    } else {
        to.radius.min(from.radius)
    };
    let across = to.position - from.position;
    let length = across.length();
    let paper = matches!(join, JoinKind::Paper | JoinKind::PaperIterated);
    let mut frustum = Frustum {
        base: from.position,
        length,
        ..Frustum::default()
    };
    frustum.start.radius = radius_from;
    frustum.end.radius = to.radius;
    if paper && length > 0.0 {
        frustum.axis = across / length;
        frustum.radius = radius_from;
        frustum.slope = (to.radius - radius_from) / length;
        frustum.secant = (1.0 + frustum.slope * frustum.slope).sqrt();
        paper::set_ends(&mut frustum);
    } else if touches_both(length, radius_from, to.radius) {
        let cone = Cone::touching(across / length, length, radius_from, to.radius);
        frustum.axis = cone.axis;
        frustum.radius = cone.radius;
        frustum.slope = cone.slope;
        frustum.secant = cone.secant;
        let sine = cone.sine();
        set_contact(&mut frustum.start, cone.axis, sine, 1.0);
        set_contact(&mut frustum.end, cone.axis, sine, -1.0);
    } else {
        return lone_sphere(frustum, across, begins_root);
    }
    if begins_root {
        frustum.start.kind = EndKind::Round;
    }
    frustum.end.kind = EndKind::Round;
    frustum
}

/// Puts an end's plane through the circle where the cone touches the joint's sphere.
#[inline]
fn set_contact(end: &mut End, axis: Vec3, sine: Real, inward: Real) {
    end.normal = axis;
    end.offset = end.radius * sine;
    end.reach = (end.offset * inward).max(0.0);
}

/// A segment of which one sphere contains the other is the larger sphere. Where that is the sphere at its
/// base it belongs to the segment that ends there, unless none does.
fn lone_sphere(mut frustum: Frustum, across: Vec3, begins_root: bool) -> Frustum {
    frustum.radius = -1.0;
    frustum.slope = 0.0;
    frustum.axis = across.try_normalize().unwrap_or(Vec3::Y);
    frustum.start.normal = frustum.axis;
    frustum.end.normal = frustum.axis;
    if frustum.end.radius >= frustum.start.radius {
        frustum.end.kind = EndKind::Round;
        frustum.end.offset = -WHOLE;
    } else if begins_root {
        frustum.start.kind = EndKind::Round;
        frustum.start.offset = WHOLE;
    }
    frustum
}

/// Cuts two frusta along the plane in which they meet, if there is one.
#[inline]
fn mitre(first: usize, second: usize, radius: Real, frusta: &mut [Frustum]) {
    let (f1, f2) = (&frusta[first], &frusta[second]);
    if !(f1.has_cone() && f2.has_cone()) {
        return;
    }
    let Some((plane, [tilt1, tilt2])) = mitre_plane(&f1.cone(), &f2.cone(), radius) else {
        return;
    };
    // Both cones touch the sphere: at the joint their radii are ρ/c.
    let (r1, r2) = (radius * f1.secant, radius * f2.secant);
    let Some((near1, far1)) = cut_extent(r1, f1.slope, f1.secant, tilt1, plane.offset) else {
        return;
    };
    let Some((far2, near2)) = cut_extent(r2, f2.slope, f2.secant, tilt2, plane.offset) else {
        return;
    };
    if far1.max(-far2) > SPIKE * radius {
        return;
    }
    set_cut(&mut frusta[first].end, &plane, -near1);
    set_cut(&mut frusta[second].start, &plane, near2);
}

/// Opens an end at a cutting plane. Its reach is the further of the plane's and that of the contact circle, which
/// it falls back to should the other segment have no room for the mitre.
#[inline]
fn set_cut(end: &mut End, plane: &CuttingPlane, reach: Real) {
    end.normal = plane.normal;
    end.offset = plane.offset;
    end.reach = end.reach.max(reach);
    end.kind = EndKind::Cut;
}

/// True if neither end's cut reaches past the other's.
#[inline]
fn has_room(frustum: &Frustum) -> bool {
    frustum.start.reach + frustum.end.reach <= frustum.length * (1.0 - SPACING)
}

/// Ends two frusta on their contact circles; the joint's sphere belongs to the first.
fn make_round(first: usize, second: usize, frusta: &mut [Frustum]) {
    let f1 = &mut frusta[first];
    f1.end.normal = f1.axis;
    f1.end.offset = f1.end.radius * f1.cone().sine();
    f1.end.kind = EndKind::Round;
    let f2 = &mut frusta[second];
    f2.start.normal = f2.axis;
    f2.start.offset = f2.start.radius * f2.cone().sine();
}

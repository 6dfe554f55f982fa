//! Joins: how the frusta of a limb meet (§2.2, made exact).
//!
//! A joint's radius is that of a sphere which the cones of all its segments touch, so that neighbours meet in a plane
//! ([`mitre`](super::mitre)). The first cone keeps the side ≤ of it, the second ≥. Where such a mitre would reach past
//! its segment, or the plane no longer cuts an ellipse, the join is round: both cones end on the circles where they
//! touch the sphere, and the sphere fills the gap.

use super::cone::{Cone, End, EndKind, Frustum, WHOLE, touches_both};
use super::mitre::{CuttingPlane, mitre};
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

/// Share of a segment that must be left between its two ends.
const SPACING: Real = 1e-4;
/// How far a mitre may reach past its joint on the outside of a bend, in radii of the joint. Where cones widen
/// towards a joint the outside grows without bound as the bend nears the last one that has an ellipse.
const SPIKE: Real = 4.0;

/// Recomputes the frusta of a posed skeleton: cones, cutting planes and ends, but not their references
/// ([`align`](super::surface::align) does). The slices have one entry a joint; the entry of a root joint, which ends
/// no segment, draws nothing. Allocates nothing.
///
/// # Panics
/// If the slices differ in length or a link names a joint outside them.
pub fn skin(links: &[Link], joints: &[PosedJoint], skin: Skin, frusta: &mut [Frustum]) {
    assert!(links.len() == joints.len() && joints.len() == frusta.len());
    match skin.join {
        JoinKind::Mitre => mitre_joins(links, joints, frusta),
        JoinKind::Round => {
            for (i, frustum) in frusta.iter_mut().enumerate() {
                round_frustum(i, links, joints, skin.join, frustum);
            }
        }
        JoinKind::Paper | JoinKind::PaperIterated => {
            for (i, frustum) in frusta.iter_mut().enumerate() {
                round_frustum(i, links, joints, skin.join, frustum);
            }
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

/// Skins with mitres where their segments have room for them. In one pass: a parent's frustum is there before its
/// child's.
fn mitre_joins(links: &[Link], joints: &[PosedJoint], frusta: &mut [Frustum]) {
    // The last cone stays in registers: it is most often the next one's first.
    let mut last = (usize::MAX, Cone::default());
    for i in 0..frusta.len() {
        let (before, from_here) = frusta.split_at_mut(i);
        let second = &mut from_here[0];
        let cone = round_frustum(i, links, joints, JoinKind::Mitre, second);
        if let Some(first) = predecessor(links, i) {
            let first_cone = if first == last.0 {
                last.1
            } else {
                before[first].cone()
            };
            let radius = joints[first].radius;
            cut(&mut before[first], &first_cone, second, &cone, radius);
            // Now that both ends of the first are known, so is what becomes of the join before it.
            if let Some(zeroth) = predecessor(links, first) {
                settle(zeroth, first, frusta);
            }
            if links[i].next == NONE {
                settle(first, i, frusta);
            }
        }
        last = (i, cone);
    }
}

/// A mitre stays where both its segments have room for it. `reach` is left as it is when a join is made round, so
/// that every join is judged by the same figures, whatever the order.
#[inline(always)]
fn settle(first: usize, second: usize, frusta: &mut [Frustum]) {
    if frusta[first].end.kind == EndKind::Cut
        && !(has_room(&frusta[first]) && has_room(&frusta[second]))
    {
        make_round(first, second, frusta);
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

/// The segment whose limb segment `i` continues.
#[inline]
fn predecessor(links: &[Link], i: usize) -> Option<usize> {
    let link = &links[i];
    let first = link.parent as usize;
    (link.continues && link.parent != NONE && links[first].parent != NONE).then_some(first)
}

/// The joins of a skeleton: pairs of a segment and the one that continues its limb.
fn joins(links: &[Link]) -> impl Iterator<Item = (usize, usize)> + '_ {
    (0..links.len()).filter_map(|i| Some((predecessor(links, i)?, i)))
}

/// Makes the frustum of segment `i` as if every join were round, and returns its cone. In place, since a copy would
/// wait for what was only just written.
#[inline(always)]
fn round_frustum(
    i: usize,
    links: &[Link],
    joints: &[PosedJoint],
    join: JoinKind,
    frustum: &mut Frustum,
) -> Cone {
    let link = &links[i];
    if link.parent == NONE {
        *frustum = Frustum {
            base: joints[i].position,
            radius: -1.0,
            axis: Vec3::Y,
            ..Frustum::default()
        };
        return Cone::default();
    }
    let (from, to) = (&joints[link.parent as usize], &joints[i]);
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
    frustum.base = from.position;
    frustum.length = length;
    let paper = matches!(join, JoinKind::Paper | JoinKind::PaperIterated);
    if !paper && !touches_both(length, radius_from, to.radius) || length == 0.0 {
        lone_sphere(frustum, across, [radius_from, to.radius], begins_root);
        return Cone::default();
    }
    let start_kind = if begins_root {
        EndKind::Round
    } else {
        EndKind::Cut
    };
    let inverse = 1.0 / length;
    let axis = across * inverse;
    let cone = if paper {
        Cone::through(axis, radius_from, (to.radius - radius_from) * inverse)
    } else {
        Cone::opening(axis, radius_from, (radius_from - to.radius) * inverse)
    };
    frustum.axis = axis;
    frustum.radius = cone.radius;
    frustum.slope = cone.slope;
    frustum.secant = cone.secant;
    // The paper's ends lie across the axis through the joints, others on the circle where the cone touches the sphere.
    let sine = if paper {
        0.0
    } else {
        (radius_from - to.radius) * inverse
    };
    frustum.start = contact(axis, radius_from, sine, 1.0, start_kind);
    frustum.end = contact(axis, to.radius, sine, -1.0, EndKind::Round);
    cone
}

/// An end with its plane through the circle where the cone touches the joint's sphere.
#[inline(always)]
fn contact(axis: Vec3, radius: Real, sine: Real, inward: Real, kind: EndKind) -> End {
    let offset = radius * sine;
    End {
        normal: axis,
        offset,
        radius,
        reach: (offset * inward).max(0.0),
        kind,
    }
}

/// A segment of which one sphere contains the other is the larger sphere. Where that is the sphere at its
/// base it belongs to the segment that ends there, unless none does.
fn lone_sphere(frustum: &mut Frustum, across: Vec3, radii: [Real; 2], begins_root: bool) {
    let axis = across.try_normalize().unwrap_or(Vec3::Y);
    let [mut start, mut end] = radii.map(|radius| End {
        normal: axis,
        radius,
        ..End::default()
    });
    if end.radius >= start.radius {
        end.kind = EndKind::Round;
        end.offset = -WHOLE;
    } else if begins_root {
        start.kind = EndKind::Round;
        start.offset = WHOLE;
    }
    *frustum = Frustum {
        base: frustum.base,
        length: frustum.length,
        axis,
        radius: -1.0,
        start,
        end,
        ..Frustum::default()
    };
}

/// Cuts two frusta along the plane in which their cones meet, if there is one.
#[inline(always)]
fn cut(
    first: &mut Frustum,
    first_cone: &Cone,
    second: &mut Frustum,
    second_cone: &Cone,
    radius: Real,
) {
    if !(first_cone.radius > 0.0 && second_cone.radius > 0.0) {
        return;
    }
    let Some(mitre) = mitre(first_cone, second_cone, radius) else {
        return;
    };
    if mitre.first.high > SPIKE * radius || -mitre.second.low > SPIKE * radius {
        return;
    }
    set_cut(&mut first.end, &mitre.plane, -mitre.first.low);
    set_cut(&mut second.start, &mitre.plane, mitre.second.high);
}

/// Opens an end at a cutting plane. Its reach is the further of the plane's and that of the contact circle, which
/// it falls back to should the other segment have no room for the mitre.
#[inline]
fn set_cut(end: &mut End, plane: &CuttingPlane, reach: Real) {
    end.normal = plane.normal;
    end.offset = plane.offset;
    if reach > end.reach {
        end.reach = reach;
    }
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

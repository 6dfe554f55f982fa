//! `Mitre` and `Round`: cones that touch the spheres of the joints, and how they meet.
//!
//! With X measured from a joint of radius ρ, a cone with axis M that touches the joint's sphere is
//! Q(X) = |X|² − ρ² − g(X)² = 0, g(X) = (X·M − ρs)/c: squared, c²|P⊥|² = (ρ − s·y)², and
//! (ρ − s·y)² = ρ² − y² + (y − ρs)² + s²(y² − ρ²) term by term. Two such cones therefore agree
//! where g₁² = g₂², which is two planes. On g₁ + g₂ = 0 the first cone ends where the second begins:
//!
//! (M₁/c₁ + M₂/c₂)·X = ρ(s₁/c₁ + s₂/c₂).
//!
//! g = 0 is the plane of the circle on which a cone touches the sphere.
//!
//! A joint's sphere lies inside what its limb draws, though it may reach back past the limb's own
//! segment; so a branch, or a cone after a round join, may start open inside it. Let p be in the
//! sphere at B, on a segment A→B of length L. With g measured at A, the cone touches B's sphere
//! where g = Lc, so Q(p) ≤ −(g − Lc)². If p is behind a mitre at A, g₀ + g < 0, where the segment
//! before has Q₀ = Q + g² − g₀². For g < 0 that is less than −(|g| + Lc)² + g² < 0, for g ≥ 0 it is
//! at most g² − g₀² < 0: p is inside the cone before. Behind a contact circle at A, g < 0, the same
//! sum without g₀ says that p is inside A's sphere. And so on to the root. A flat end breaks the
//! chain, for it has no sphere behind it: hence [`ReferenceGuards::flat`].

use super::cone::{Cone, CutPlane};
use super::limbs::{Limb, Limbs, Start};
use super::segment::{Cap, EndKind, Segment, SegmentBody, SegmentEnd};
use super::{ReferenceEnds, ReferenceGuards, ReferenceJoin, ReferencePart, ReferenceSettings};

/// One sphere contains the other, as far as a cone between them is concerned, from this |s| on.
const REGULAR: f64 = 1.0 - 1e-6;
/// Relative room that the mitre limit leaves.
const SLACK: f64 = 1e-4;

/// The plane of a possible mitre and how far it reaches along both segments.
#[derive(Clone, Copy)]
struct Mitre {
    /// Normal along both axes; the first segment's side is the negative one.
    plane: CutPlane,
    /// How far the first segment is cut back from its end, at most; negative where it is extended.
    end_reach: f64,
    /// How far the second is cut back from its start, at most.
    start_reach: f64,
}

/// What the decisions on joins and ends are made from.
struct Joins<'a> {
    limbs: &'a Limbs,
    settings: ReferenceSettings,
    guards: ReferenceGuards,
    /// By joint, the mitre that its two cones would meet in.
    proposed: Vec<Option<Mitre>>,
}

/// All segments of a skeleton.
pub(super) fn segments(
    limbs: &Limbs,
    settings: ReferenceSettings,
    guards: ReferenceGuards,
) -> Vec<Segment> {
    let joins = Joins::new(limbs, settings, guards);
    let mitres = joins.agreed();
    limbs
        .iter()
        .map(|limb| Segment {
            joint: limb.joint,
            parent: limb.parent,
            body: cone(limb).map_or_else(
                || sphere(limb),
                |cone| SegmentBody::Frustum {
                    cone,
                    start: joins.start(limb, &cone, &mitres),
                    end: joins.end(limb, &cone, &mitres),
                },
            ),
        })
        .collect()
}

/// A segment of which one sphere contains the other: the sphere at its end is its own; the one at
/// its start is drawn by the segment that ends there, unless there is none.
pub(super) fn sphere(limb: &Limb) -> SegmentBody {
    if limb.end_radius >= limb.start_radius {
        SegmentBody::Sphere {
            center: limb.to,
            radius: limb.end_radius,
            part: ReferencePart::EndCap,
        }
    } else if limb.start == Start::Root {
        SegmentBody::Sphere {
            center: limb.from,
            radius: limb.start_radius,
            part: ReferencePart::StartCap,
        }
    } else {
        SegmentBody::Hidden
    }
}

/// The cone of a segment, or `None` where one of its spheres contains the other.
fn cone(limb: &Limb) -> Option<Cone> {
    (limb.length > 0.0 && limb.sine().abs() < REGULAR).then(|| {
        Cone::tangent(
            limb.from,
            limb.axis,
            limb.length,
            limb.start_radius,
            limb.end_radius,
        )
    })
}

/// The plane of the circle on which a cone touches the sphere at its end, out of the segment.
fn contact_at_end(limb: &Limb) -> CutPlane {
    CutPlane {
        point: limb.to,
        normal: limb.axis,
        offset: limb.end_radius * limb.sine(),
    }
}

/// The same at its start.
fn contact_at_start(limb: &Limb) -> CutPlane {
    CutPlane {
        point: limb.from,
        normal: -limb.axis,
        offset: -limb.start_radius * limb.sine(),
    }
}

/// The mitre of a limb and its continuation, if their cones meet in one ellipse whose far side is
/// no further than `spike` radii past the joint.
fn mitre(first: &Limb, second: &Limb, spike: f64) -> Option<Mitre> {
    let (cone1, cone2) = (cone(first)?, cone(second)?);
    let (c1, c2) = (cone1.cosine(), cone2.cosine());
    let n = first.axis / c1 + second.axis / c2;
    let length = n.length();
    if length <= SLACK * (1.0 / c1 + 1.0 / c2) {
        return None;
    }
    let plane = CutPlane {
        point: first.to,
        normal: n / length,
        offset: first.end_radius * (cone1.sine() / c1 + cone2.sine() / c2) / length,
    };
    // An ellipse, and not a branch of a hyperbola: the plane is less steep than the cone.
    let is_ellipse = |cone: &Cone| {
        let nm = plane.normal.dot(cone.axis);
        nm > 0.0 && nm > cone.sine().abs() * (1.0 + SLACK)
    };
    if !is_ellipse(&cone1) || !is_ellipse(&cone2) {
        return None;
    }
    let (near1, far1) = cone1.cut_range(&plane)?;
    let (far2, near2) = cone2.cut_range(&plane)?;
    let past_joint = (far1 - first.length).max(-far2);
    (past_joint <= spike * first.end_radius || spike.is_infinite()).then_some(Mitre {
        plane,
        end_reach: first.length - near1,
        start_reach: near2,
    })
}

impl<'a> Joins<'a> {
    fn new(limbs: &'a Limbs, settings: ReferenceSettings, guards: ReferenceGuards) -> Self {
        let propose = |j: usize| {
            let first = limbs.by_joint[j].as_ref()?;
            let second = limbs.by_joint[limbs.continuation[j]?].as_ref()?;
            mitre(first, second, guards.spike).filter(|_| settings.join == ReferenceJoin::Mitre)
        };
        let proposed = (0..limbs.by_joint.len()).map(propose).collect();
        Self {
            limbs,
            settings,
            guards,
            proposed,
        }
    }

    /// The mitres that stand: those that both their segments approve.
    fn agreed(&self) -> Vec<Option<Mitre>> {
        let agree = |j: usize| {
            let mitre = self.proposed[j]?;
            let first = self.limbs.by_joint[j].as_ref()?;
            let second = self.limbs.by_joint[self.limbs.continuation[j]?].as_ref()?;
            (self.approves(first) && self.approves(second)).then_some(mitre)
        };
        (0..self.proposed.len()).map(agree).collect()
    }

    /// Do the planes proposed at both ends of a segment leave a whole ring of its cone?
    fn approves(&self, limb: &Limb) -> bool {
        let flat = self.settings.ends == ReferenceEnds::Flat && !self.guards.flat;
        let reach = |is_free: bool, mitre: Option<f64>, contact: CutPlane| {
            let contact = -contact.offset;
            let reach = match mitre {
                _ if is_free && flat => 0.0,
                Some(mitre) if self.guards.fallback => mitre.max(contact),
                Some(mitre) => mitre,
                None => contact,
            };
            reach.max(0.0)
        };
        let continues = limb.start == Start::Continuation;
        let start = self.proposed[limb.parent].filter(|_| continues);
        let start = reach(
            limb.start == Start::Root,
            start.map(|mitre| mitre.start_reach),
            contact_at_start(limb),
        );
        let end = reach(
            self.limbs.continuation[limb.joint].is_none(),
            self.proposed[limb.joint].map(|mitre| mitre.end_reach),
            contact_at_end(limb),
        );
        start + end <= limb.length * (1.0 - SLACK)
    }

    /// Is the root's end of a segment closed with a disc? With the guard: if it is the only
    /// segment there and nothing at its other end needs the joint's sphere below the disc.
    fn is_flat_start(&self, limb: &Limb, end_mitre: Option<&Mitre>) -> bool {
        self.settings.ends == ReferenceEnds::Flat
            && (!self.guards.flat
                || self.limbs.children[limb.parent] == 1
                    && match self.limbs.children[limb.joint] {
                        0 => true,
                        1 if end_mitre.is_some() => true,
                        _ => limb.end_radius <= limb.length * (1.0 - SLACK),
                    })
    }

    /// The same for a leaf's end.
    fn is_flat_end(&self, limb: &Limb, start_mitre: Option<&Mitre>) -> bool {
        self.settings.ends == ReferenceEnds::Flat
            && (!self.guards.flat
                || match (limb.start, self.limbs.children[limb.parent]) {
                    (Start::Root, 1) => true,
                    (Start::Continuation, 1) if start_mitre.is_some() => true,
                    (Start::Branch, _) => {
                        -contact_at_start(limb).offset <= limb.length * (1.0 - SLACK)
                    }
                    _ => limb.start_radius <= limb.length * (1.0 - SLACK),
                })
    }

    fn start(&self, limb: &Limb, cone: &Cone, mitres: &[Option<Mitre>]) -> SegmentEnd {
        let contact = contact_at_start(limb);
        let (mitre, other) = (&mitres[limb.parent], &mitres[limb.joint]);
        let open = |kind: EndKind, plane: CutPlane| SegmentEnd {
            kind,
            plane,
            cap: Cap::Open,
        };
        match (limb.start, mitre) {
            (Start::Root, _) if self.is_flat_start(limb, other.as_ref()) => {
                flat(contact, cone.radius_at(0.0))
            }
            (Start::Root, _) => SegmentEnd {
                kind: EndKind::Free,
                plane: contact,
                cap: Cap::Sphere(limb.start_radius),
            },
            (Start::Continuation, Some(mitre)) => open(EndKind::Mitre, mitre.plane.flipped()),
            (Start::Continuation, None) => open(EndKind::Round, contact),
            (Start::Branch, _) => open(EndKind::Branch, contact),
        }
    }

    fn end(&self, limb: &Limb, cone: &Cone, mitres: &[Option<Mitre>]) -> SegmentEnd {
        let contact = contact_at_end(limb);
        let (mitre, other) = (&mitres[limb.joint], &mitres[limb.parent]);
        let sphere = |kind: EndKind| SegmentEnd {
            kind,
            plane: contact,
            cap: Cap::Sphere(limb.end_radius),
        };
        match (self.limbs.continuation[limb.joint], mitre) {
            (Some(_), Some(mitre)) => SegmentEnd {
                kind: EndKind::Mitre,
                plane: mitre.plane,
                cap: Cap::Open,
            },
            (Some(_), None) => sphere(EndKind::Round),
            (None, _) if self.is_flat_end(limb, other.as_ref()) => {
                flat(contact, cone.radius_at(limb.length))
            }
            (None, _) => sphere(EndKind::Free),
        }
    }
}

/// A free end cut straight through the joint.
fn flat(plane: CutPlane, radius: f64) -> SegmentEnd {
    SegmentEnd {
        kind: EndKind::Free,
        plane: CutPlane {
            offset: 0.0,
            ..plane
        },
        cap: Cap::Disc(radius),
    }
}

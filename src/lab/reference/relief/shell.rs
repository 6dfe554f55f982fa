//! The shell of each segment: inner and outer cone, the planes that divide it from its neighbours,
//! and the balls that close it.
//!
//! Which joins are mitres and which ends are flat is decided by the outer frusta: what has room for
//! them has room for all below. The planes are then those of the cones of one height.

use glam::{DQuat, DVec3};

use super::super::cone::CutPlane;
use super::super::limbs::Limb;
use super::super::segment::{Cap, EndKind, Segment, SegmentBody, SegmentEnd};
use super::super::tangent;
use super::super::{
    ReferenceGuards, ReferenceJoin, ReferenceJoint, ReferencePart, ReferenceSettings,
};
use super::level::Level;
use super::solid::{BallShell, ConeShell, Solid};
use super::{ReliefOptions, ReliefPart, SegmentTexture, ShellThickness};

/// A limb is carried over a fold as it is: below this sum of one and the cosine between the axes.
const FOLD: f64 = 1e-6;

/// The segments of a skeleton with relief, in the order of the joints that they end at.
pub(super) fn solids(
    joints: &[ReferenceJoint],
    settings: ReferenceSettings,
    thickness: ShellThickness,
    options: &ReliefOptions,
    textures: &[SegmentTexture],
) -> Vec<Solid> {
    for joint in joints {
        assert!(thickness.at(joint.radius) > 0.0, "a shell has a thickness");
    }
    let [inner, level, outer] =
        [0.0, options.plane_level, 1.0].map(|w| Level::new(joints, thickness, w));
    let settings = ReferenceSettings {
        join: match settings.join {
            ReferenceJoin::Round => ReferenceJoin::Round,
            _ => ReferenceJoin::Mitre,
        },
        ..settings
    };
    let segments = tangent::segments(&outer.limbs, settings, ReferenceGuards::default());
    let shells = Shells {
        inner,
        level,
        outer,
        segments: &segments,
    };
    let mut solids: Vec<Solid> = Vec::with_capacity(segments.len());
    // By joint, the solid of the segment that it ends.
    let mut by_joint: Vec<Option<usize>> = vec![None; joints.len()];
    for segment in &segments {
        let mut solid = shells.solid(segment, textures[segment.joint], options.continuous_u);
        let wish = match by_joint[segment.parent] {
            Some(parent) => shells.carried(&solids[parent], &solid, options.continuous_u),
            None => toward_z(shells.inner.limb(segment.joint)),
        };
        solid.reference = wish
            .reject_from_normalized(solid.axis)
            .try_normalize()
            .unwrap_or_else(|| solid.axis.any_orthonormal_vector());
        if options.continuous_u
            && let Some(before) = by_joint[segment.parent]
        {
            solid.lean = shells.lean(&solids[before], &solid);
        }
        by_joint[segment.joint] = Some(solids.len());
        solids.push(solid);
    }
    solids
}

/// Where u = 0 is on a limb that begins at a root: towards +z, where the limb leaves that open.
fn toward_z(limb: &Limb) -> DVec3 {
    if limb.axis.z.abs() < 0.9 {
        DVec3::Z
    } else {
        DVec3::X
    }
}

struct Shells<'a> {
    inner: Level,
    level: Level,
    outer: Level,
    /// The outer frusta.
    segments: &'a [Segment],
}

impl Shells<'_> {
    /// The cone's ends of a segment, if it has a cone.
    fn ends(&self, joint: usize) -> Option<(SegmentEnd, SegmentEnd)> {
        let found = self
            .segments
            .binary_search_by_key(&joint, |s| s.joint)
            .ok()?;
        match self.segments[found].body {
            SegmentBody::Frustum { start, end, .. } => Some((start, end)),
            _ => None,
        }
    }

    /// A segment, with its reference left open.
    fn solid(&self, segment: &Segment, texture: SegmentTexture, continuous_u: bool) -> Solid {
        let joint = segment.joint;
        let limb = self.inner.limb(joint);
        let mut solid = Solid {
            joint,
            middle: segment.middle(),
            axis: limb.axis.try_normalize().unwrap_or(DVec3::Y),
            base: limb.from,
            reference: DVec3::ZERO,
            lean: None,
            texture,
            cone: None,
            balls: Vec::new(),
        };
        match segment.body {
            SegmentBody::Frustum { start, end, .. } => {
                let shell = ConeShell {
                    inner: self.inner.cone(joint),
                    outer: self.outer.cone(joint),
                    start: self.start_plane(joint, &start),
                    end: self.end_plane(joint, &end),
                };
                if let Cap::Sphere(_) = start.cap {
                    let planes = [Some(shell.start.flipped()), None];
                    solid.balls.push(self.ball_at_start(joint, planes));
                }
                if let Cap::Sphere(_) = end.cap {
                    // At a round join the ball ends where the next cone begins.
                    let next = self.outer.limbs.continuation[joint];
                    let next = next.filter(|&next| self.ends(next).is_some());
                    let beyond = next.map(|next| self.level.contact_at_start(next).flipped());
                    let planes = [Some(shell.end.flipped()), beyond];
                    let turned_to = next.map(|next| self.inner.limb(next).axis);
                    solid.balls.push(BallShell {
                        turned_to: turned_to.filter(|_| continuous_u),
                        ..self.ball_at_end(joint, planes)
                    });
                }
                solid.cone = Some(shell);
            }
            SegmentBody::Sphere { part, .. } => {
                let ball = match part {
                    ReferencePart::StartCap => self.ball_at_start(joint, [None, None]),
                    _ => self.ball_at_end(joint, [None, None]),
                };
                solid.balls.push(ball);
            }
            SegmentBody::Hidden => {}
        }
        solid
    }

    fn start_plane(&self, joint: usize, start: &SegmentEnd) -> CutPlane {
        match (start.kind, start.cap) {
            (EndKind::Mitre, _) => self
                .level
                .mitre(self.inner.limb(joint).parent, joint)
                .flipped(),
            (_, Cap::Disc(_)) => start.plane,
            _ => self.level.contact_at_start(joint),
        }
    }

    fn end_plane(&self, joint: usize, end: &SegmentEnd) -> CutPlane {
        match (end.kind, end.cap, self.outer.limbs.continuation[joint]) {
            (EndKind::Mitre, _, Some(next)) => self.level.mitre(joint, next),
            (_, Cap::Disc(_), _) => end.plane,
            _ => self.level.contact_at_end(joint),
        }
    }

    fn ball_at_start(&self, joint: usize, planes: [Option<CutPlane>; 2]) -> BallShell {
        let radius = self.inner.limb(joint).start_radius;
        BallShell {
            center: self.inner.limb(joint).from,
            radius,
            thickness: self.outer.limb(joint).start_radius - radius,
            planes,
            turned_to: None,
            part: ReliefPart::StartCap,
        }
    }

    fn ball_at_end(&self, joint: usize, planes: [Option<CutPlane>; 2]) -> BallShell {
        let radius = self.inner.limb(joint).end_radius;
        BallShell {
            center: self.inner.limb(joint).to,
            radius,
            thickness: self.outer.limb(joint).end_radius - radius,
            planes,
            turned_to: None,
            part: ReliefPart::EndCap,
        }
    }

    /// The point u = 0 at the end of `first`, seen from the joint (§2.3): through a mitre as a point
    /// of both cones of the planes' height, else turned with the axis.
    fn carried(&self, first: &Solid, second: &Solid, continuous_u: bool) -> DVec3 {
        let twist = first.texture.twist;
        // u = φ/2π + v θ/2π is 0 at v = 1 where φ = −θ.
        let side = first.axis.cross(first.reference);
        let e = first.reference * twist.cos() - side * twist.sin();
        let mitred = self
            .ends(first.joint)
            .is_some_and(|(_, end)| end.kind == EndKind::Mitre);
        if let (Some(shell), true) = (&first.cone, mitred && !continuous_u) {
            let cone = self.level.cone(first.joint);
            let y = cone.cut(&shell.end, e);
            return (y - cone.length) * cone.axis + cone.radius_at(y) * e;
        }
        if 1.0 + first.axis.dot(second.axis) <= FOLD {
            return e;
        }
        DQuat::from_rotation_arc(first.axis, second.axis) * e
    }

    /// How the azimuths of a mitre differ on its two cones: measured from the outside of the bend, the
    /// map from the first's to the second's keeps cross-ratios and leaves 0 and π where they are, so
    /// that one more pair determines it. That of π/2 is as good as any: its cosine becomes κ.
    fn lean(&self, first: &Solid, second: &Solid) -> Option<(DVec3, f64)> {
        let (_, end) = self.ends(first.joint)?;
        let goes_on = self.outer.limbs.continuation[first.joint] == Some(second.joint);
        if end.kind != EndKind::Mitre || !goes_on {
            return None;
        }
        let b = first
            .axis
            .reject_from_normalized(second.axis)
            .try_normalize()?;
        let e = first.axis.cross(second.axis).normalize();
        let cone = self.level.cone(first.joint);
        let y = cone.cut(&first.cone?.end, e);
        let x = (y - cone.length) * cone.axis + cone.radius_at(y) * e;
        let seen = x.reject_from_normalized(second.axis).normalize();
        Some((b, seen.dot(b)))
    }
}

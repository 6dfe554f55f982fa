//! Relief (§3) in f64 and without haste: what judges the relief that is drawn.
//!
//! Every joint has two spheres, of radius ρ and ρ + h; the cones that touch the first are the inner
//! frusta, those that touch the second the outer ones, and between them lies the shell. A point of
//! it has a height w, 0 on the inner and 1 on the outer cone (Equation 12), and (u, v) on the cone
//! of its own height (§3). With a relief map H the solid is w ≤ H(u, v).
//!
//! Each ray is marched through the shell of each segment that it meets, in thousands of equal steps
//! from where it enters the outer frustum to where it leaves it; the first step that ends inside
//! the solid is halved until nothing is left of it.
//!
//! # Who owns a point
//!
//! Where two frusta meet, one plane divides the whole shell: what is before it belongs to the first
//! segment, what is behind it to the second. A ray that comes through the plane into a segment below
//! its relief hits there: a *wall*, which closes what differs between the heights on both sides.
//! The plane is that in which the two cones of one height meet, by default half way up the shell,
//! where the largest misfit over all heights is least ([`PLANE_LEVEL`]). A mitre stands if the
//! outer frusta have room for it; else the join is round at all heights.
//!
//! Most of a step between two neighbours' heights comes from u, which Equation 6 has in line at
//! u = 0 alone: [`ReliefOptions::continuous_u`] brings it in line all round.
//!
//! | file | question |
//! |---|---|
//! | `level` | which cones and planes belong to one height? |
//! | `shell` | which cones, planes and balls bound the shell of a segment? |
//! | `solid` | where is a ray in it, and which (u, v, w) has a point? |
//! | `march` | where does the ray enter what is below the relief? |
//! | `height` | how high is the relief map? |

mod height;
mod level;
mod march;
mod shell;
mod solid;
#[cfg(test)]
mod tests;

use glam::DVec3;

use super::bvh::Bvh;
use super::{ReferenceJoint, ReferenceSettings};

pub use height::HeightImage;

use solid::Solid;

/// Height of the cones whose cutting planes divide the shell.
///
/// Cones of another height miss each other on that plane, by a distance that grows with the
/// difference of heights: from the middle it is at most half of what it is from either side.
pub const PLANE_LEVEL: f64 = 0.5;

/// Equal steps in which a ray is marched through each shell.
pub const STEPS: usize = 4096;

/// How thick the shell is at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShellThickness {
    /// The same everywhere, in the units of the joints' positions.
    Metres(f64),
    /// This share of the joint's radius.
    Relative(f64),
}

impl ShellThickness {
    /// h at a joint of radius ρ.
    pub fn at(self, radius: f64) -> f64 {
        match self {
            Self::Metres(h) => h,
            Self::Relative(share) => share * radius,
        }
    }
}

/// How the relief lies along the segment that ends at a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentTexture {
    /// θ of §2.3, in radians: u gains v·θ/2π along the segment.
    pub twist: f64,
    /// The map's v at the segment's start.
    pub v_start: f64,
    /// The map's v at the segment's end.
    pub v_end: f64,
}

/// What a [`ReliefScene`] may be built with besides.
#[derive(Clone, Debug)]
pub struct ReliefOptions {
    /// Height of the cones whose cutting planes divide the shell, from 0 to 1.
    pub plane_level: f64,
    /// Equal steps in which a ray is marched through each shell.
    pub steps: usize,
    /// Whether u is in line all round each cut, and not at u = 0 alone: after a mitre a segment's u
    /// leans, at its start in full and less towards its end, as the cut's azimuths on both cones
    /// differ; on the ball of a round join it is turned from one axis to the other.
    pub continuous_u: bool,
    /// By joint. `None` repeats the map once a unit of length along each limb, without twist.
    pub textures: Option<Vec<SegmentTexture>>,
}

impl Default for ReliefOptions {
    fn default() -> Self {
        Self {
            plane_level: PLANE_LEVEL,
            steps: STEPS,
            continuous_u: false,
            textures: None,
        }
    }
}

/// Which surface a ray met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ReliefPart {
    /// The relief round the segment.
    Cone,
    /// The relief on the ball at the segment's start.
    StartCap,
    /// The relief on the ball at the segment's end.
    EndCap,
    /// The solid where a plane cuts it: a flat end, or a step between two neighbours' heights.
    Wall,
}

/// The first hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefHit {
    /// Distance along the ray in units of its direction's length.
    pub t: f64,
    /// The point hit.
    pub position: DVec3,
    /// The segment hit, as the index of the joint that it ends at.
    pub segment: usize,
    /// Equation 6 with twist, from 0 to 1.
    pub u: f64,
    /// Equation 7 on the cone of height `w`: 0 at the segment's start, 1 at its end.
    pub v: f64,
    /// Equation 12.
    pub w: f64,
    /// H(u, v): equal to `w` except on a wall, where it is at least `w`.
    pub height: f64,
    /// Unit normal out of the solid: the gradient of w − H, or the normal of the wall.
    pub normal: DVec3,
    /// Which surface.
    pub part: ReliefPart,
}

/// Where a point lies in a segment's shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReliefPoint {
    /// Equation 6 with twist, from 0 to 1.
    pub u: f64,
    /// Equation 7 on the cone of height `w`; outside 0..=1 beyond the segment's planes.
    pub v: f64,
    /// The relief map's v.
    pub map_v: f64,
    /// Equation 12; outside 0..=1 beyond the shell.
    pub w: f64,
    /// H there: the point is in the solid if it is at least `w`.
    pub height: f64,
}

/// A skeleton with relief, ready to be hit.
pub struct ReliefScene<'a> {
    solids: Vec<Solid>,
    bvh: Bvh,
    relief: &'a dyn Fn(f64, f64) -> f64,
    steps: usize,
}

impl<'a> ReliefScene<'a> {
    /// Builds the shells of a skeleton. `relief` is H, of u and the map's v, both of which repeat
    /// with 1; what it gives is clamped to 0..=1. The paper's own joins are not for relief: `Paper`
    /// and `PaperIterated` stand for `Mitre`.
    ///
    /// # Panics
    ///
    /// When a joint's parent does not come before it, or the shell has no thickness.
    pub fn new(
        joints: &[ReferenceJoint],
        settings: ReferenceSettings,
        relief: &'a dyn Fn(f64, f64) -> f64,
        thickness: ShellThickness,
    ) -> Self {
        Self::with_options(
            joints,
            settings,
            relief,
            thickness,
            &ReliefOptions::default(),
        )
    }

    /// The same with options.
    ///
    /// # Panics
    ///
    /// As [`new`](Self::new), and when `options.textures` has not one entry a joint.
    pub fn with_options(
        joints: &[ReferenceJoint],
        settings: ReferenceSettings,
        relief: &'a dyn Fn(f64, f64) -> f64,
        thickness: ShellThickness,
        options: &ReliefOptions,
    ) -> Self {
        let along_limbs;
        let textures = match &options.textures {
            Some(textures) => textures,
            None => {
                along_limbs = textures_along_limbs(joints);
                &along_limbs
            }
        };
        assert_eq!(joints.len(), textures.len(), "one texture a joint");
        let solids = shell::solids(joints, settings, thickness, options, textures);
        let bounds = solids.iter().map(Solid::bounds).collect();
        Self {
            solids,
            bvh: Bvh::new(bounds),
            relief,
            steps: options.steps.max(1),
        }
    }

    /// The first point with t > `t_min` at which the ray `origin` + t·`dir` enters the solid of any
    /// segment. `dir` need not be unit; a zero `dir` hits nothing. A ray that starts inside a
    /// segment's solid meets that segment again only after it has left it.
    pub fn cast(&self, origin: DVec3, dir: DVec3, t_min: f64) -> Option<ReliefHit> {
        let length = dir.length();
        let unit = dir.try_normalize()?;
        let mut nearest = f64::INFINITY;
        let mut hit = None;
        self.bvh.visit(origin, unit, t_min * length, |index| {
            let solid = &self.solids[index];
            // Work from the ray's point nearest the segment, so that a far eye costs no digits.
            let shift = (solid.middle - origin).dot(unit);
            let from = t_min * length - shift;
            let near = origin + shift * unit;
            let height = |u: f64, v: f64| (self.relief)(u, v).clamp(0.0, 1.0);
            if let Some(found) = solid.first_hit(near, unit, from, self.steps, &height)
                && found.t + shift < nearest
            {
                nearest = found.t + shift;
                hit = Some(ReliefHit {
                    t: nearest / length,
                    ..found
                });
            }
            nearest
        });
        hit
    }
}

impl ReliefScene<'_> {
    /// Where a point lies in a segment's shell: on its cone, or on the ball at one of its ends.
    /// `None` where the segment has no such part.
    pub fn locate(&self, segment: usize, part: ReliefPart, point: DVec3) -> Option<ReliefPoint> {
        let solid = self.solids.iter().find(|solid| solid.joint == segment)?;
        let (u, v, w) = match part {
            ReliefPart::Cone => solid.on_cone(solid.cone.as_ref()?, point),
            _ => {
                let ball = solid.balls.iter().find(|ball| ball.part == part)?;
                solid.on_ball(ball, point)
            }
        };
        let map_v = solid.map_v(v);
        let height = (self.relief)(u, map_v).clamp(0.0, 1.0);
        Some(ReliefPoint {
            u,
            v,
            map_v,
            w,
            height,
        })
    }
}

/// v runs on from segment to segment, once a unit of length; branches take up their parent's.
fn textures_along_limbs(joints: &[ReferenceJoint]) -> Vec<SegmentTexture> {
    let mut textures: Vec<SegmentTexture> = Vec::with_capacity(joints.len());
    for joint in joints {
        let (v_start, length) = joint.parent.map_or((0.0, 0.0), |parent| {
            let length = joint.position.distance(joints[parent].position);
            (textures[parent].v_end, length)
        });
        textures.push(SegmentTexture {
            twist: 0.0,
            v_start,
            v_end: v_start + length,
        });
    }
    textures
}

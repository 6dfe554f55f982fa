//! A march through the shell of one segment as §3 has it: from where the ray comes in to the inner frustum, or out
//! again, in uniform steps, then bisection.

use glam::DVec3;

use super::limb::{beyond, links, settings};
use crate::frusta::double::cast::{Hit, Part, Ray, cast_ray};
use crate::frusta::double::join::{JoinKind, PosedJoint};
use crate::frusta::double::shell::{Shell, Thickness, align_shells, skin_shell};

/// Halvings of the step that led below the relief: to the last digit.
const BISECTIONS: usize = 50;

/// The shells of a chain, with u lined up all round the cuts if `continuous`.
pub(super) fn shells(
    joints: &[PosedJoint],
    join: JoinKind,
    thickness: Thickness,
    continuous: bool,
) -> Vec<Shell> {
    let links = links(joints.len());
    let mut frusta = vec![Default::default(); joints.len()];
    let mut shells = skin_shell(&links, joints, settings(join), thickness, &mut frusta);
    align_shells(&links, &mut shells, continuous, |_| DVec3::Z);
    shells
}

/// A stretch of a ray inside a shell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stretch {
    pub from: f64,
    pub to: f64,
}

/// The ray's stretch through the shell about the cone, from where it comes in from outside.
///
/// `None` where it does not, or not through the outer cone: then it comes from a neighbour's shell.
pub(super) fn stretch(shell: &Shell, ray: &Ray, t_min: f64) -> Option<Stretch> {
    let on_cone = |hit: &Hit| hit.part == Part::Cone;
    let from = cast_ray(ray, &shell.at(1.0), t_min, 0.0).filter(on_cone)?.t;
    let to = end(shell, ray, from);
    (from < to && to.is_finite()).then_some(Stretch { from, to })
}

/// Where a ray that is in the shell at `from` leaves it: to what is below, to what is outside, or through a plane.
pub(super) fn end(shell: &Shell, ray: &Ray, from: f64) -> f64 {
    // What lies behind the place at hand by no more than a rounding is where the ray came in.
    let after = from + 1e-9;
    let hit = |w: f64| cast_ray(ray, &shell.at(w), after, 0.0).map_or(f64::INFINITY, |hit| hit.t);
    let frustum = &shell.frustum;
    let tip = ray.origin - frustum.axis * frustum.length;
    let through = |distance: f64, rate: f64| {
        let t = -distance / rate;
        if rate > 0.0 && t > after {
            t
        } else {
            f64::INFINITY
        }
    };
    let start = through(
        -beyond(&frustum.start, ray.origin),
        -frustum.start.normal.dot(ray.direction),
    );
    let end = through(
        beyond(&frustum.end, tip),
        frustum.end.normal.dot(ray.direction),
    );
    hit(0.0).min(hit(1.0)).min(start).min(end)
}

/// The first place of a stretch at which the relief is no longer below the ray.
pub(super) fn march(
    shell: &Shell,
    ray: &Ray,
    stretch: Stretch,
    steps: usize,
    relief: &dyn Fn(f64, f64) -> f64,
) -> Option<f64> {
    let is_above = |t: f64| {
        let (u, v, w) = shell.coordinates(ray.origin + ray.direction * t, 0.0);
        w > relief(u, v)
    };
    let Stretch { from, to } = stretch;
    let at = |step: usize| from + (to - from) * (step as f64 / steps as f64);
    let step = (0..=steps).find(|&step| !is_above(at(step)))?;
    if step == 0 {
        return Some(from);
    }
    let (mut above, mut below) = (at(step - 1), at(step));
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (above + below);
        if is_above(middle) {
            above = middle;
        } else {
            below = middle;
        }
    }
    Some(below)
}

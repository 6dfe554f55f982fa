//! A shell thicker than the bend has room for.
//!
//! On the inside of a bend both cutting planes of a segment near each other. Where they cross inside the outer frustum
//! the mitre falls back to round, for all heights; then neighbours' shells overlap there, and points have two owners.

use glam::DVec3;

use super::limb::{Course, beyond, limb};
use super::random::Random;
use super::shell::shells;
use crate::frusta::double::cone::EndKind;
use crate::frusta::double::join::JoinKind;
use crate::frusta::double::shell::{Shell, Thickness};
use crate::lab::charts::{Axis, Chart, Point, Series};

/// Length of the segments, in radii.
const LENGTH: f64 = 4.0;
/// Points that are tried.
const POINTS: usize = 20_000;
/// Room for rounding between neighbours, in radii.
const ROUNDING: f64 = 1e-9;

/// What a shell's thickness leads to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overlap {
    /// Share of the shells' volume about the middle segment that belongs to two segments or more.
    pub shared: f64,
    /// Whether the middle segment still ends in mitres.
    pub is_mitred: bool,
}

/// The thickness, in radii, at which the cutting planes at both ends of a segment of a cylinder cross inside its outer
/// frustum: (1 + h) tan(bend/2) on either side have no more room.
pub fn limit(bend: f64) -> f64 {
    0.5 * LENGTH / (0.5 * bend).to_radians().tan() - 1.0
}

/// Whether a point is in a segment's shell, about the cone or about the ball at its end.
fn owns(shells: &[Shell], i: usize, point: DVec3) -> bool {
    let shell = &shells[i];
    let frustum = &shell.frustum;
    let from_base = point - frustum.base;
    let from_tip = point - frustum.tip();
    let past_start = beyond(&frustum.start, from_base);
    let past_end = beyond(&frustum.end, from_tip);
    if past_start > ROUNDING && past_end < -ROUNDING {
        let (_, _, w) = shell.coordinates(from_base, 0.0);
        return (0.0..=1.0).contains(&w);
    }
    // A round join's ball ends where the next cone begins.
    let before_next = shells
        .get(i + 1)
        .is_none_or(|next| beyond(&next.frustum.start, from_tip) < -ROUNDING);
    let radii = shell.at(0.0).end.radius..=shell.at(1.0).end.radius;
    frustum.end.kind == EndKind::Round
        && past_end > ROUNDING
        && before_next
        && radii.contains(&from_tip.length())
}

/// Measures a limb of three segments bent to one side, with a shell of `thickness` radii.
pub fn measure(bend: f64, thickness: f64) -> Overlap {
    let joints = limb(bend, LENGTH, &[1.0; 4], Course::Arc);
    let shells = shells(
        &joints,
        JoinKind::Mitre,
        Thickness::Relative(thickness),
        false,
    );
    let mut random = Random::new(5);
    let outer = 1.0 + thickness;
    let (mut owned, mut shared) = (0, 0);
    for _ in 0..POINTS {
        let point = shells[2].frustum.base
            + DVec3::new(
                random.between(0.0, LENGTH),
                random.between(-outer, outer),
                random.between(-outer, outer),
            );
        let owners = (1..shells.len())
            .filter(|&i| owns(&shells, i, point))
            .count();
        owned += usize::from(owners > 0);
        shared += usize::from(owners > 1);
    }
    Overlap {
        shared: f64::from(shared as u32) / f64::from(owned as u32),
        is_mitred: shells[2].frustum.end.kind == EndKind::Cut,
    }
}

/// The chart.
pub fn chart() -> Chart {
    let series = [30.0, 60.0, 90.0, 120.0].map(|bend| {
        let mut was_mitred = true;
        let points = (1..=40).map(|i| {
            let thickness = 0.1 * f64::from(i);
            let found = measure(bend, thickness);
            let point = Point::from((thickness, found.shared));
            let falls_back = std::mem::replace(&mut was_mitred, found.is_mitred);
            if falls_back && !found.is_mitred {
                point.labelled("round")
            } else {
                point
            }
        });
        Series::line(format!("{bend} degrees"), points.collect::<Vec<_>>())
    });
    super::chart(
        "Shell with two owners, at bends of segments four radii long",
        Axis::linear("thickness of the shell (radii)"),
        Axis::linear("share of the shell's volume"),
        series.into(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_has_one_owner_until_the_planes_cross_inside_the_shell() {
        for bend in [60.0, 90.0, 120.0] {
            let limit = limit(bend);
            let (below, above) = (measure(bend, 0.98 * limit), measure(bend, 1.02 * limit));
            assert!(below.is_mitred && below.shared == 0.0, "{bend} {below:?}");
            assert!(!above.is_mitred && above.shared > 0.0, "{bend} {above:?}");
        }
    }
}

//! u on both sides of a mitre, against bend and taper.
//!
//! Equation 6 is in line with the segment before at u = 0 alone; elsewhere round the cut the two cones see its points
//! at different azimuths, and ridges break there by as much.

use core::f64::consts::TAU;

use glam::DVec3;

use super::limb::{Course, limb};
use super::shell::shells;
use crate::frusta::double::cone::EndKind;
use crate::frusta::double::join::JoinKind;
use crate::frusta::double::shell::{PLANE_LEVEL, Thickness};
use crate::frusta::double::surface::generator_span;
use crate::lab::charts::{Axis, Chart, Series};

/// Length of the segments, in radii of their common joint.
const LENGTH: f64 = 8.0;
/// Thickness of the shell of the chart: a share of each joint's radius.
const THICKNESS: Thickness = Thickness::Relative(0.2);
/// Points that are compared round the cut.
const AZIMUTHS: usize = 360;

/// The largest difference of u between both sides of the cut, in turns, for points of height `w`, at the joint of two
/// segments that thin by `taper` each; `None` where the join is round. `continuous` is that of
/// [`align_shells`](crate::frusta::double::shell::align_shells).
pub fn measure(
    bend: f64,
    taper: f64,
    thickness: Thickness,
    w: f64,
    continuous: bool,
) -> Option<f64> {
    let joints = limb(bend, LENGTH, &[taper, 1.0, 1.0 / taper], Course::Arc);
    let shells = shells(&joints, JoinKind::Mitre, thickness, continuous);
    let (first, second) = (&shells[1], &shells[2]);
    if first.frustum.end.kind != EndKind::Cut {
        return None;
    }
    let level = first.at(w);
    let from_second = first.frustum.base - second.frustum.base;
    let (across, side) = level.axis.any_orthonormal_pair();
    let difference = |i: usize| {
        let (sin, cos) = (TAU * i as f64 / AZIMUTHS as f64).sin_cos();
        let e: DVec3 = across * cos + side * sin;
        let (_, y) = generator_span(&level, e);
        let radius = level.cone().radius_at(y);
        if radius <= 0.0 {
            // The cone ends in its apex before the cut.
            return 0.0;
        }
        let point = level.axis * y + e * radius;
        let (u1, _, _) = first.coordinates(point, 0.0);
        let (u2, _, _) = second.coordinates(point + from_second, 0.0);
        let apart = (u1 - u2).rem_euclid(1.0);
        apart.min(1.0 - apart)
    };
    Some((0..AZIMUTHS).map(difference).fold(0.0, f64::max))
}

/// The largest over the heights of the shell.
fn over_heights(bend: f64, taper: f64, continuous: bool) -> f64 {
    [0.0, PLANE_LEVEL, 1.0]
        .into_iter()
        .filter_map(|w| measure(bend, taper, THICKNESS, w, continuous))
        .reduce(f64::max)
        .unwrap_or(f64::NAN)
}

/// The chart.
pub fn chart() -> Chart {
    let mut series = Vec::new();
    for continuous in [false, true] {
        for taper in [1.0, 2.0, 4.0] {
            let points = (0..=36)
                .map(|i| f64::from(i) * 5.0)
                .map(|bend| (bend, over_heights(bend, taper, continuous)));
            let how = if continuous {
                "continuous"
            } else {
                "Equation 6"
            };
            series.push(Series::line(format!("{how} {taper}:1"), points));
        }
    }
    super::chart(
        "Misfit of u at a mitre, until it falls back to round, by taper of each segment",
        Axis::linear("bend (degrees)"),
        Axis::log("misfit of u (turns; 1e-6 stands for less)").with_floor(1e-6),
        series,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of an angle found from points a few radii off, in turns.
    const ROUNDING: f64 = 1e-13;

    /// Of one thickness, so that the cones of all heights have one slope.
    const EVEN: Thickness = Thickness::Metres(0.2);

    #[test]
    fn cylinders_fit_at_any_bend() {
        for bend in [30.0, 60.0, 90.0, 120.0] {
            let misfit = measure(bend, 1.0, EVEN, 1.0, false).expect("a mitre");
            assert!(misfit < ROUNDING, "{bend} {misfit}");
        }
    }

    #[test]
    fn cones_misfit_by_their_taper_and_bend() {
        for taper in [2.0, 4.0] {
            for bend in [20.0, 40.0, 60.0] {
                let misfit = measure(bend, taper, EVEN, PLANE_LEVEL, false).expect("a mitre");
                // cos φ2 = (cos φ1 + κ)/(1 + κ cos φ1), or tan(φ2/2) = g tan(φ1/2) with g² = (1 − κ)/(1 + κ), puts the
                // azimuths apart by arcsin κ at φ1 = 90°, where u = 0 is here, and by at most 2 arctan((1 − g)/2√g).
                // That most is on the other side too, so that both add up.
                // κ as at `align_shells`: of its factors (n·b)/(n·M), n is w1 M1 + w2 M2 with the secants w.
                let sines = [(taper - 1.0) / LENGTH, (1.0 - 1.0 / taper) / LENGTH];
                let [w1, w2] = sines.map(|s: f64| 1.0 / (1.0 - s * s).sqrt());
                let (sin, cos) = f64::to_radians(bend).sin_cos();
                let eta1 = sines[0] * w1 * w2 * sin / (w1 + w2 * cos);
                let eta2 = -sines[1] * w2 * w1 * sin / (w2 + w1 * cos);
                let kappa = (eta1 - eta2) / (1.0 - eta1 * eta2);
                let g = ((1.0 - kappa) / (1.0 + kappa)).sqrt();
                let most = 2.0 * ((1.0 - g) / (2.0 * g.sqrt())).atan();
                let exact = (kappa.asin() + most) / TAU;
                // At most half a degree beside the worst azimuth, where the misfit is even: less by half its square.
                assert!(
                    (misfit / exact - 1.0).abs() < 1e-4,
                    "{taper} {bend} {misfit} {exact}"
                );
            }
        }
    }

    #[test]
    fn leaning_u_fits_exactly_at_the_planes_height_and_nearly_elsewhere() {
        for bend in [20.0, 40.0, 60.0] {
            let at = |w, continuous| measure(bend, 2.0, EVEN, w, continuous).expect("a mitre");
            let misfit = at(PLANE_LEVEL, true);
            assert!(misfit < ROUNDING, "{bend} {misfit}");
            for w in [0.0, 1.0] {
                // A tenth, as `align_shells` has it, and half as much again for what it leaves out.
                let (with, without) = (at(w, true), at(w, false));
                assert!(with < 0.15 * without, "{bend} {w} {with} {without}");
            }
        }
    }

    #[test]
    fn cones_of_several_slopes_no_longer_meet_at_the_planes_height_but_nearly() {
        // `Shell::at` takes r(y) between those of the inner and the outer cone; where these differ in slope, the cone of
        // height 1/2 touches the joint's sphere of that height but to second order.
        for bend in [20.0, 60.0, 120.0] {
            let misfit = measure(bend, 2.0, THICKNESS, PLANE_LEVEL, true).expect("a mitre");
            assert!(misfit > ROUNDING && misfit < 1e-4, "{bend} {misfit}");
        }
    }
}

//! The gap at a joint against bend and taper, for all four joins.

use glam::DVec3;

use super::limb::{Course, frusta, limb};
use crate::frusta::double::cone::EndKind;
use crate::frusta::double::join::JoinKind;
use crate::lab::charts::{Axis, Chart, Point, Series};
use crate::lab::reference::{ReferenceJoin, seam_gap};

/// Length of the segments, in radii of their common joint.
pub const LENGTH: f64 = 4.0;
/// Ratios of the radii at both ends of each segment.
pub const TAPERS: [f64; 3] = [1.0, 2.0, 4.0];
/// A gap too small for any rounding: where no gap at all is drawn.
const NOTHING: f64 = 1e-18;

/// The gap at the middle joint of two segments that thin by `taper` each, bent by `bend` degrees, in radii of the
/// joint; infinite where the plane no longer cuts both cones in an ellipse. The mitre is taken without its limit.
pub fn gap(bend: f64, taper: f64, join: ReferenceJoin) -> f64 {
    let (sin, cos) = bend.to_radians().sin_cos();
    let axes = [DVec3::X, DVec3::new(cos, sin, 0.0)];
    seam_gap(axes, [LENGTH; 2], [taper, 1.0, 1.0 / taper], join)
}

/// Whether [`JoinKind::Mitre`] draws that joint as a mitre, or round.
pub fn is_mitred(bend: f64, taper: f64) -> bool {
    let joints = limb(bend, LENGTH, &[taper, 1.0, 1.0 / taper], Course::Arc);
    frusta(&joints, JoinKind::Mitre)[1].end.kind == EndKind::Cut
}

/// The chart: the paper's joins as they are, the crate's default with its fall back.
pub fn chart() -> Chart {
    let bends = || (0..=36).map(|i| f64::from(i) * 5.0);
    let paper = |name: &str, join: ReferenceJoin, taper: f64| {
        let points = bends().map(|bend| (bend, gap(bend, taper, join)));
        Series::line(format!("{name} {taper}:1"), points)
    };
    let mut series = Vec::new();
    for taper in TAPERS {
        series.push(paper("paper", ReferenceJoin::Paper, taper));
    }
    for taper in TAPERS {
        series.push(paper("iterated", ReferenceJoin::PaperIterated, taper));
    }
    for taper in TAPERS {
        let mut is_last = true;
        let points = bends().map(|bend| {
            if is_mitred(bend, taper) {
                return Point::from((bend, gap(bend, taper, ReferenceJoin::Mitre)));
            }
            let point = Point::from((bend, 0.0));
            let label = format!("{taper}:1: round");
            if std::mem::take(&mut is_last) {
                point.labelled(label)
            } else {
                point
            }
        });
        series.push(Series::line(format!("mitre {taper}:1"), points));
    }
    let round = bends().map(|bend| (bend, gap(bend, 1.0, ReferenceJoin::Round)));
    series.push(Series::line("round", round));
    super::chart(
        "Gap between two bent frusta, by join and by taper of each segment",
        Axis::linear("bend (degrees)"),
        Axis::log("gap (radii of the joint; 1e-18 stands for none)").with_floor(NOTHING),
        series,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_default_draws_never_gapes() {
        for taper in TAPERS {
            for bend in 0..=180 {
                let bend = f64::from(bend);
                if is_mitred(bend, taper) {
                    // Both curves are found to a few roundings of numbers up to 16 radii, stretched by the slant of the
                    // plane: at most the secant of half the last mitre's bend, below 10.
                    let gap = gap(bend, taper, ReferenceJoin::Mitre);
                    assert!(
                        gap < 100.0 * 16.0 * f64::EPSILON * 10.0,
                        "{bend} {taper} {gap}"
                    );
                }
            }
            assert!(is_mitred(90.0, taper) && !is_mitred(180.0, taper));
        }
    }

    #[test]
    fn the_mitre_of_cylinders_lasts_until_it_uses_up_a_segment() {
        // With the free ends' contact circles at the joints, it has all of the segment: tan(bend/2) = length/radius.
        let limit = 2.0 * LENGTH.atan().to_degrees();
        assert!(is_mitred(limit - 0.1, 1.0) && !is_mitred(limit + 0.1, 1.0));
    }

    #[test]
    fn the_papers_gap_grows_with_taper_and_its_iteration_closes_it() {
        for bend in [20.0, 40.0, 60.0, 80.0, 100.0] {
            let paper = |taper| gap(bend, taper, ReferenceJoin::Paper);
            assert!(paper(1.0) < 1e-12 && paper(1.0) < paper(2.0) && paper(2.0) < paper(4.0));
            for taper in [2.0, 4.0] {
                // It ends when the minor axes agree to 1e-9; the gap is that, times the radius, stretched by the slant.
                assert!(gap(bend, taper, ReferenceJoin::PaperIterated) < 1e-8);
            }
        }
        assert_eq!(gap(170.0, 4.0, ReferenceJoin::Paper), f64::INFINITY);
    }
}

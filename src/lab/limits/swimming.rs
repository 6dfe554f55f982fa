//! v interpolated along the ray, against bend.
//!
//! §3 computes v (Equation 7) where the ray comes into the shell and where it leaves it, and interpolates in between.
//! Where the ends of a segment are cut at a slant, v is no linear function along the ray, and what is wrong with it
//! depends on the eye: as the eye moves, the relief swims.

use super::limb::{Course, limb};
use super::random::{Random, quantile};
use super::shell::{shells, stretch};
use super::steps::ray;
use crate::frusta::double::cone::EndKind;
use crate::frusta::double::join::JoinKind;
use crate::frusta::double::shell::{Shell, Thickness};
use crate::lab::charts::{Axis, Chart, Point, Series};

/// Rays of each bend.
const RAYS: usize = 4000;
/// Places at which each ray is looked at.
const PLACES: usize = 16;

/// The largest errors of v along the ray, in shares of the segment's texture length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swimming {
    /// Of the median ray.
    pub median: f64,
    /// What 99 of 100 rays do not exceed.
    pub most: f64,
    /// Whether the segment still ends in mitres.
    pub is_mitred: bool,
}

/// The middle one of three segments, `length` radii long, with a shell of `thickness` radii.
fn middle(bend: f64, length: f64, thickness: f64) -> Shell {
    let joints = limb(bend, length, &[1.0; 4], Course::Arc);
    let mut shell = shells(
        &joints,
        JoinKind::Mitre,
        Thickness::Metres(thickness),
        false,
    )[2];
    // Rays are made for a segment at the origin.
    shell.frustum.base = Default::default();
    shell
}

/// Measures a segment between two bends to the same side.
pub fn measure(bend: f64, length: f64, thickness: f64) -> Swimming {
    let shell = middle(bend, length, thickness);
    let mut random = Random::new(4);
    let mut worst = Vec::with_capacity(RAYS);
    // Where both cuts leave little of a segment, few rays meet it; the random stream ends some time all the same.
    for _ in 0..20 * RAYS {
        let ray = ray(&mut random, length, 1.0 + thickness);
        let Some(stretch) = stretch(&shell, &ray, 0.0) else {
            continue;
        };
        let v = |share: f64| {
            let t = stretch.from + (stretch.to - stretch.from) * share;
            shell.coordinates(ray.origin + ray.direction * t, 0.0).1
        };
        let (first, last) = (v(0.0), v(1.0));
        let error = (1..PLACES)
            .map(|i| i as f64 / PLACES as f64)
            .map(|share| (first + (last - first) * share - v(share)).abs())
            .fold(0.0, f64::max);
        worst.push(error);
        if worst.len() == RAYS {
            break;
        }
    }
    Swimming {
        median: quantile(&mut worst, 0.5),
        most: quantile(&mut worst, 0.99),
        is_mitred: shell.frustum.end.kind == EndKind::Cut,
    }
}

/// The chart.
pub fn chart() -> Chart {
    let mut series = Vec::new();
    for (length, thickness) in [(4.0, 0.1), (4.0, 0.5), (10.0, 0.1), (10.0, 0.5)] {
        let mut was_mitred = true;
        let points = (0..=30).map(|i| {
            let bend = f64::from(i) * 5.0;
            let found = measure(bend, length, thickness);
            let point = Point::from((bend, found.most));
            let falls_back = std::mem::replace(&mut was_mitred, found.is_mitred);
            if falls_back && !found.is_mitred {
                point.labelled("round")
            } else {
                point
            }
        });
        let name = format!("length {length} radii, shell {thickness}");
        series.push(Series::line(name, points));
    }
    super::chart(
        "Error of v interpolated along the ray, 99 of 100 rays, both ends bent to one side",
        Axis::linear("bend at each end (degrees)"),
        Axis::linear("error of v (share of the segment's texture)"),
        series,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_cylinder_does_not_swim_and_a_bent_one_does_the_more_it_bends() {
        let at = |bend| measure(bend, 10.0, 0.1).most;
        // v of a straight cylinder is linear; what remains are roundings of distances up to 50.
        assert!(at(0.0) < 50.0 * 10.0 * f64::EPSILON, "{}", at(0.0));
        for bend in [30.0, 60.0, 90.0] {
            assert!(at(bend - 30.0) < at(bend), "{bend}");
        }
    }

    #[test]
    fn up_to_45_degrees_thin_shells_hardly_swim_and_thick_ones_on_short_segments_do() {
        // §3 calls swimming hardly noticeable up to this bend; a pixel of a map 64 high is 1.6 % of it.
        let pixel = 1.0 / 64.0;
        assert!(measure(45.0, 4.0, 0.1).most < pixel);
        assert!(measure(45.0, 10.0, 0.5).most < pixel);
        assert!(measure(45.0, 4.0, 0.5).most > 2.0 * pixel);
    }

    #[test]
    fn a_round_join_does_not_swim() {
        let found = measure(140.0, 4.0, 0.1);
        assert!(!found.is_mitred && found.most < 1e-12, "{found:?}");
    }
}

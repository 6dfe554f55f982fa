//! What each criterion forbids, against its value: gaps (§4.1, h·tan(a)/e), the sight of what is deeper than d (§4.1,
//! h·tan(a)/d), and places that are shown more than p pixels off (§4.3, h·sin(a)/(z/f)/p). All begin at 1.

use super::wall::{Seen, Wall, expected, share};
use crate::lab::charts::{Axis, Chart, Series};
use crate::lab::limits;
use crate::texel::SliceAxis;
use crate::texel::criteria::{depth_limit, gap_ratio, slices_for_depth, slices_for_pixels};

/// Thickness of the wall, in voxels of 64, and the number of slices: half as far apart as the wall is thick.
const VOXELS: u32 = 8;
const COUNT: u32 = 16;

/// A criterion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// No gap shows.
    Gap,
    /// Nothing shows from deeper than d = e/2.
    Depth,
    /// Nothing shows further than p = 1 pixel from where it is.
    Pixels,
}

impl Criterion {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Gap, Self::Depth, Self::Pixels];

    const fn name(self) -> &'static str {
        match self {
            Self::Gap => "seen through: h tan(a)/e",
            Self::Depth => "deeper than d = e/2: h tan(a)/d",
            Self::Pixels => "more than p pixels off: h sin(a)/(z/f)/p",
        }
    }
}

/// The share of a wall's side that shows what a criterion of a value forbids.
pub fn measure(criterion: Criterion, ratio: f64) -> f64 {
    let wall = Wall::new(VOXELS);
    let set = wall.slices(SliceAxis::W, COUNT);
    let (h, e) = (1.0 / COUNT as f32, wall.e as f32);
    let d = depth_limit(e);
    let look = |a| wall.look(&set, a, COUNT);
    // The angle whose tangent is so many times that at which a criterion is 1.
    let angle = |at_45_degrees: f32| (ratio / f64::from(at_45_degrees)).atan();
    match criterion {
        Criterion::Gap => share(&look(angle(gap_ratio(h, 1.0, e))), Option::is_none),
        Criterion::Depth => {
            let needed = slices_for_depth(1.0, 1.0, d);
            // Beyond gaps one sees deeper still.
            let is_deep = |seen: &Option<Seen>| seen.is_none_or(|seen| seen.deep > f64::from(d));
            share(&look(angle(needed / COUNT as f32)), is_deep)
        }
        Criterion::Pixels => {
            // Aslant, and so that no gap shows; the eye comes nearer.
            let a = f64::to_radians(60.0);
            let needed = slices_for_pixels(1.0, a.sin() as f32, 1.0, 1.0, 1.0);
            let pixels_a_metre = ratio * f64::from(COUNT) / f64::from(needed);
            let is_off = |seen: &Option<Seen>| {
                seen.is_none_or(|seen| seen.below * a.sin() * pixels_a_metre > 1.0)
            };
            share(&look(a), is_off)
        }
    }
}

/// The chart.
pub fn chart() -> Chart {
    // Each criterion at values of its own, for the curve is the same.
    let ratios = |offset: usize| {
        (0..14).map(move |i| f64::exp2(f64::from(i) * 0.375 - 2.0 + 0.125 * offset as f64))
    };
    let curve = (-16..=26).map(|i| {
        let ratio = f64::exp2(0.125 * f64::from(i));
        (ratio, expected(ratio))
    });
    let mut series = vec![Series::line("1 - 1/value", curve)];
    for (i, criterion) in Criterion::ALL.into_iter().enumerate() {
        let points = ratios(i).map(|ratio| (ratio, measure(criterion, ratio)));
        series.push(Series::scatter(criterion.name(), points));
    }
    limits::chart(
        "What the criteria forbid, against their values",
        Axis::log("value of the criterion (1: its limit)"),
        Axis::linear("share of a wall's side that shows it"),
        series,
    )
}

#[cfg(test)]
mod tests {
    use super::super::wall::RAYS;
    use super::*;

    #[test]
    fn each_criterion_says_where_what_it_forbids_begins() {
        for criterion in Criterion::ALL {
            for ratio in [0.3, 0.9, 0.999] {
                assert_eq!(measure(criterion, ratio), 0.0, "{criterion:?} {ratio}");
            }
            // Steps aside are spread evenly, to a ray more or less.
            let bound = 1.0 / f64::from(RAYS) + 1e-9;
            for ratio in [1.01, 1.5, 2.0, 4.0, 20.0] {
                let found = measure(criterion, ratio);
                let off = (found - expected(ratio)).abs();
                assert!(found > 0.0 && off <= bound, "{criterion:?} {ratio} {found}");
            }
        }
    }
}

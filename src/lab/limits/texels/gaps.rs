//! Gaps between slices against the view angle (§4.1, Figure 4 right), with slices along w alone, and along all three
//! axes (§4.2).

use super::wall::{Wall, share};
use crate::lab::charts::{Axis, Chart, Point, Series};
use crate::lab::limits;
use crate::texel::criteria::{choose_direction, gap_ratio};
use crate::texel::{SliceAxis, SliceSet};

/// Thickness of the wall of the chart, in voxels of 64.
const VOXELS: u32 = 4;
/// Numbers of slices, along each axis that there are slices along.
const COUNTS: [u32; 4] = [8, 16, 32, 64];

/// Which slices there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Directions {
    /// Along w alone, as plain shells have it.
    One,
    /// Along all axes, of which the view chooses one.
    Three,
}

/// A wall as thick as some voxels of 64, in so many slices along each axis.
pub struct Slices {
    wall: Wall,
    count: u32,
    /// Along u and w; with those along v its slices are seen edge on.
    sets: [SliceSet; 2],
}

impl Slices {
    /// Cuts it.
    pub fn new(voxels: u32, count: u32) -> Self {
        let wall = Wall::new(voxels);
        let sets = [SliceAxis::U, SliceAxis::W].map(|axis| wall.slices(axis, count));
        Self { wall, count, sets }
    }

    /// The share of its side that is seen through, at an angle from w, in radians.
    pub fn gaps(&self, directions: Directions, a: f64) -> f64 {
        let h = 1.0 / self.count as f32;
        let c = [a.sin() as f32, 0.0, a.cos() as f32];
        let set = match directions {
            Directions::Three if choose_direction(c, [h; 3]) == SliceAxis::U.index() => {
                &self.sets[0]
            }
            _ => &self.sets[1],
        };
        let seen = self.wall.look(set, a, self.count);
        share(&seen, Option::is_none)
    }

    /// The angle up to which the criterion sees no gaps.
    pub fn onset(&self) -> f64 {
        // h·tan(a)/e = 1.
        let at_45_degrees = gap_ratio(1.0 / self.count as f32, 1.0, self.wall.e as f32);
        f64::from(at_45_degrees).recip().atan()
    }
}

/// The chart.
pub fn chart() -> Chart {
    let walls = COUNTS.map(|count| Slices::new(VOXELS, count));
    let line = |slices: &Slices, directions, name: &str| {
        let points = (1..90).map(|degrees| {
            let degrees = f64::from(degrees);
            (degrees, slices.gaps(directions, degrees.to_radians()))
        });
        Series::line(format!("{name}, {} slices", slices.count), points)
    };
    let one = walls
        .iter()
        .map(|slices| line(slices, Directions::One, "one direction"));
    // With more slices there is nothing to see of them.
    let three = walls[..2]
        .iter()
        .map(|slices| line(slices, Directions::Three, "three directions"));
    let onsets = walls.iter().map(|slices| {
        let degrees = slices.onset().to_degrees();
        Point::from((degrees, 0.0)).labelled(format!("{degrees:.0}"))
    });
    let onsets = Series::scatter("the criterion's limit", onsets);
    limits::chart(
        "Gaps in a wall a sixteenth of the texel thick",
        Axis::linear("view angle from the surface's normal (degrees)"),
        Axis::linear("share of the wall's side that is seen through"),
        one.chain(three).chain([onsets]).collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::super::wall::{RAYS, expected};
    use super::*;

    /// A ray more or less.
    const BOUND: f64 = 1.0 / RAYS as f64 + 1e-9;

    #[test]
    fn gaps_begin_where_the_criterion_says() {
        for voxels in [3, 5, 8, 12] {
            for count in [8, 16, 32, 64] {
                let slices = Slices::new(voxels, count);
                let onset = slices.onset();
                for ratio in [0.3, 0.5, 0.7, 0.9, 0.999, 1.05, 1.2, 1.5, 2.0, 3.0, 10.0] {
                    let found = slices.gaps(Directions::One, (onset.tan() * ratio).atan());
                    if ratio < 1.0 {
                        assert_eq!(found, 0.0, "{voxels} {count} {ratio}");
                    } else {
                        // Of a step aside of h·tan(a) the wall covers e.
                        let off = (found - expected(ratio)).abs();
                        assert!(off <= BOUND, "{voxels} {count} {ratio}: {found}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_thickness_that_is_measured_does_not_promise_too_much() {
        for voxels in [3, 5, 8, 12] {
            let wall = Wall::new(voxels);
            let measured = f64::from(wall.volume.thickness().along(SliceAxis::W));
            let limit = 8.0 / 64.0;
            assert!(measured <= wall.e, "{measured}");
            assert!(measured >= 0.6 * wall.e.min(limit), "{measured}");
        }
    }

    #[test]
    fn three_directions_leave_gaps_at_no_angle_where_one_does_at_most() {
        // As far apart as the wall is thick: from one direction to the other at 45 degrees.
        let slices = Slices::new(VOXELS, 16);
        for degrees in 1..90 {
            let a = f64::from(degrees).to_radians();
            assert_eq!(slices.gaps(Directions::Three, a), 0.0, "{degrees}");
            let one = slices.gaps(Directions::One, a);
            assert_eq!(one > 0.0, degrees > 45, "{degrees} {one}");
        }
        // Twice as far, three directions gape too, but never by more than half.
        let coarse = Slices::new(VOXELS, 8);
        let most = |directions| {
            (1..90)
                .map(|degrees| coarse.gaps(directions, f64::from(degrees).to_radians()))
                .fold(0.0, f64::max)
        };
        assert!((most(Directions::Three) - 0.5).abs() <= BOUND);
        assert!(most(Directions::One) > 0.95);
    }
}

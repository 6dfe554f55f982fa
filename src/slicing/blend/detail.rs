//! Levels of detail: fewer slices where a crown is small on screen.

use super::{SliceOrder, smooth};
use crate::slicing::slicing::SlicingShape;

/// The share of a switch's distance by which levels of detail fade into one another before and after it.
const FADE: f32 = 0.1;

/// The screen that levels of detail are made for: pixels that a metre takes one metre away. 480 lines of 52° have so many.
pub const FOCAL: f32 = 500.0;

/// Two levels of detail and their shares for a crown that is, apparently, so many radii away: that of the first level,
/// and 1 minus it of the next coarser one.
pub fn levels(shape: &SlicingShape, distance: f32, order: SliceOrder) -> (usize, f32) {
    if order == SliceOrder::Paper {
        return (0, 1.0);
    }
    let mut level = 0;
    for switch in &shape.switches {
        if distance >= switch * (1.0 + FADE) {
            level += 1;
        }
    }
    let share = shape.switches.get(level).map_or(1.0, |switch| {
        1.0 - smooth(switch * (1.0 - FADE), switch * (1.0 + FADE), distance)
    });
    (level, share)
}

/// The slices of each orientation, ranks, that are drawn of a crown, far to near: those of the coarser level first, where
/// two fade into one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranks {
    coarse: u32,
    fine: u32,
    /// Of the finer level.
    share: f32,
}

impl Ranks {
    /// Those of a crown that is, apparently, so many radii away.
    pub fn new(shape: &SlicingShape, distance: f32, order: SliceOrder) -> Self {
        let (level, share) = levels(shape, distance, order);
        let coarse = if share < 1.0 {
            shape.levels[level + 1]
        } else {
            0
        };
        Self {
            coarse,
            fine: shape.levels[level],
            share,
        }
    }

    /// How many there are.
    pub fn count(self) -> u32 {
        self.coarse + self.fine
    }

    /// Where the first so many end in their order: 0 at the far end of it, 1 at the near one, and beyond for more than there
    /// are. Each of two levels has its share of the way, so that none jumps as the other comes or goes.
    pub fn end(self, first: u32) -> f32 {
        let before = if self.coarse > 0 {
            // Not so little that ranks come to be in one place.
            (1.0 - self.share).clamp(0.01, 0.99)
        } else {
            0.0
        };
        if first < self.coarse {
            before * first as f32 / self.coarse as f32
        } else {
            before + (1.0 - before) * (first - self.coarse) as f32 / self.fine as f32
        }
    }

    /// Which one of its level a rank is.
    pub fn in_level(self, rank: u32) -> u32 {
        if rank < self.coarse {
            rank
        } else {
            rank - self.coarse
        }
    }
}

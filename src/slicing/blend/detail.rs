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

/// How many slices of each orientation are drawn of a crown that is, apparently, so many radii away: those of both levels where
/// two fade into one another.
pub fn ranks(shape: &SlicingShape, distance: f32, order: SliceOrder) -> u32 {
    let (level, share) = levels(shape, distance, order);
    let count = |level: usize| shape.levels.get(level).copied().unwrap_or(0);
    if share < 1.0 {
        count(level) + count(level + 1)
    } else {
        count(level)
    }
}

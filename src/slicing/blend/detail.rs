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

/// How many slices of each orientation, ranks, are drawn of a crown that is, apparently, so many radii away: those of both
/// levels where two fade into one another.
pub fn ranks(shape: &SlicingShape, distance: f32, order: SliceOrder) -> u32 {
    let [coarse, fine] = ranks_of_levels(shape, distance, order).1;
    coarse + fine
}

/// Where the first so many ranks end in a crown that is, apparently, so many radii away: 0 at its far end, 1 at the near
/// one. Where two levels fade into one another, they come one after the other, each with its share of the way, so that none
/// jumps as it comes or goes.
pub fn ranks_end(shape: &SlicingShape, distance: f32, order: SliceOrder, ranks: u32) -> f32 {
    let (share, [coarse, fine]) = ranks_of_levels(shape, distance, order);
    // Not so little that ranks come to be in one place.
    let before = if coarse > 0 {
        (1.0 - share).clamp(0.01, 0.99)
    } else {
        0.0
    };
    if ranks < coarse {
        before * ranks as f32 / coarse as f32
    } else {
        before + (1.0 - before) * (ranks - coarse) as f32 / fine as f32
    }
}

/// The share of the finer level, and the ranks of the coarser and of the finer one, in the order in which they are drawn.
fn ranks_of_levels(shape: &SlicingShape, distance: f32, order: SliceOrder) -> (f32, [u32; 2]) {
    let (level, share) = levels(shape, distance, order);
    let coarse = if share < 1.0 {
        shape.levels[level + 1]
    } else {
        0
    };
    (share, [coarse, shape.levels[level]])
}

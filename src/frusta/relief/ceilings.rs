//! What leaps go by: above which height there is only air about a point.

use super::map::{ReliefMap, half};

/// The first mip level that ceilings are kept of: a finer one says less than a look at the heights. They all find room
/// in a channel of the map's finest level.
const FIRST_LEVEL: usize = 2;

/// For each mip level from [`FIRST_LEVEL`] on, and each of its pixels, the greatest of the map's own heights in that
/// pixel and its eight neighbours, across the map's edges where it repeats.
pub(super) fn ceilings(map: &ReliefMap) -> Vec<Vec<u8>> {
    let mut size = map.size;
    let mut greatest = map.levels[0].clone();
    let mut ceilings = Vec::new();
    for level in 1..map.levels.len() {
        let finer = size;
        size = half(finer);
        greatest = reduced(&greatest, finer, size);
        if level >= FIRST_LEVEL {
            ceilings.push(widened(&greatest, size));
        }
    }
    ceilings
}

/// Where the ceilings of each mip level begin, with all of them one after the other.
pub(super) fn first_ceilings(mut size: [u32; 2]) -> [u32; 16] {
    let mut begin = 0;
    core::array::from_fn(|level| {
        let first = begin;
        if level >= FIRST_LEVEL {
            begin += size[0] * size[1];
        }
        size = half(size);
        first
    })
}

/// The greatest of all pixels that each of a level's lies over, if only in part.
fn reduced(finer: &[u8], from: [u32; 2], to: [u32; 2]) -> Vec<u8> {
    let covered =
        |i: u32, axis: usize| i * from[axis] / to[axis]..((i + 1) * from[axis]).div_ceil(to[axis]);
    let at = |x, y| {
        let rows = covered(y, 1);
        let pixels = rows.flat_map(|row| covered(x, 0).map(move |column| row * from[0] + column));
        pixels.map(|i| finer[i as usize]).max().unwrap_or(0)
    };
    (0..to[1])
        .flat_map(|y| (0..to[0]).map(move |x| (x, y)))
        .map(|(x, y)| at(x, y))
        .collect()
}

/// The greatest of each pixel and its neighbours: along rows, then along columns.
fn widened(level: &[u8], [width, height]: [u32; 2]) -> Vec<u8> {
    let (width, height) = (width as usize, height as usize);
    let along = |level: &[u8], i: usize, step: usize, count: usize| {
        let place = i / step % count;
        let row = i - place * step;
        [(place + count - 1) % count, place, (place + 1) % count]
            .map(|place| level[row + place * step])
            .into_iter()
            .fold(0, u8::max)
    };
    let rows: Vec<u8> = (0..level.len())
        .map(|i| along(level, i, 1, width))
        .collect();
    (0..level.len())
        .map(|i| along(&rows, i, width, height))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever is tapped about a point of a cell, as far away as a leap goes, lies below the cell's ceiling.
    #[test]
    fn no_height_near_a_cell_is_above_its_ceiling() {
        for size in [[64u32, 16u32], [23, 37], [5, 1], [1, 1], [3, 100], [1, 64]] {
            let heights: Vec<u8> = (0..size[0] * size[1])
                .map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8 & 0x7f)
                .collect();
            let map = ReliefMap::new(size, heights);
            let ceilings = ceilings(&map);
            let firsts = first_ceilings(size);
            assert!(ceilings.concat().len() <= map.levels[0].len());
            let mut side = half(half(size));
            let mut first = 0;
            for (level, ceilings) in (FIRST_LEVEL..).zip(&ceilings) {
                assert_eq!(firsts[level], first);
                first += ceilings.len() as u32;
                assert_eq!(ceilings.len() as u32, side[0] * side[1]);
                for (i, &ceiling) in ceilings.iter().enumerate() {
                    let cell = [i as u32 % side[0], i as u32 / side[0]];
                    // The finest pixels within the cell and its neighbours, by their middles.
                    let within = |pixel: u32, axis: usize| {
                        let place = (pixel * 2 + 1) * side[axis] / (size[axis] * 2);
                        let apart = place.abs_diff(cell[axis]);
                        apart.min(side[axis] - apart) <= 1
                    };
                    let greatest = (0..size[1])
                        .filter(|&y| within(y, 1))
                        .flat_map(|y| (0..size[0]).map(move |x| (x, y)))
                        .filter(|&(x, _)| within(x, 0))
                        .map(|(x, y)| map.levels[0][(y * size[0] + x) as usize])
                        .max();
                    assert!(
                        greatest <= Some(ceiling),
                        "{size:?}, level {level}, {cell:?}"
                    );
                }
                side = half(side);
            }
            // They are no higher than the map.
            assert!(ceilings.concat().into_iter().all(|c| c <= map.range[1]));
        }
    }

    #[test]
    fn a_lone_peak_is_the_ceiling_of_its_cell_and_the_eight_about_it() {
        let mut heights = vec![3; 1024];
        heights[0] = 200;
        let ceilings = ceilings(&ReliefMap::new([32, 32], heights));
        let high: Vec<usize> = (0..64).filter(|&i| ceilings[0][i] == 200).collect();
        assert_eq!(high, [0, 1, 7, 8, 9, 15, 56, 57, 63]);
        assert_eq!(ceilings[1].iter().filter(|&&c| c == 200).count(), 9);
        assert!(ceilings[0].iter().all(|&c| c == 3 || c == 200));
    }
}

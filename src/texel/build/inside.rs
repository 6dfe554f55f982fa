//! Marking the inside of a shape (appendix).

use super::super::topology::Topology;
use super::draft::{Draft, Mark};

/// The appendix's way: in each column, from the top, every run of coloured voxels is a crossing of the surface, and
/// what lies after an odd number of them is inside.
///
/// Surfaces that run along a column or touch it, and two surfaces in one run, are counted wrongly; the silhouette of
/// any round shape has such columns. A column that ends inside has certainly been counted wrongly, and what is below
/// its last run is left empty. Returns the number of such columns: others may be wrong without a sign of it.
pub(super) fn mark_by_parity(draft: &mut Draft) -> usize {
    let layer = draft.layer();
    let mut failed = 0;
    for column in 0..layer {
        let (mut inside, mut in_run) = (false, false);
        let mut last_run = 0;
        for z in (0..draft.size.z as usize).rev() {
            let cell = &mut draft.cells[z * layer + column];
            let coloured = cell.mark == Mark::Coloured;
            inside ^= coloured && !in_run;
            in_run = coloured;
            if coloured {
                last_run = z;
            } else if inside {
                cell.mark = Mark::Inside;
            }
        }
        if inside && last_run > 0 {
            failed += 1;
            for z in 0..last_run {
                draft.cells[z * layer + column].mark = Mark::Empty;
            }
        }
    }
    failed
}

/// Floods the outside from the top, and from the sides of an isolated shape, through faces of voxels that are not
/// coloured; what it does not reach is inside.
///
/// The bottom lets nothing in, so that a shape may stand open on the surface, and the sides of a tiling volume lead
/// to its other side. If the contours were cut along all three axes, no step from a voxel's centre to the next
/// crosses a closed surface without a coloured voxel at one of its ends, so that the flood keeps out of every closed
/// surface. A hollow that is not reached through a gap of at least one voxel is filled.
pub(super) fn mark_by_flood(draft: &mut Draft) {
    let (size, layer) = (draft.size, draft.layer());
    let mut outside = vec![false; draft.cells.len()];
    let mut stack: Vec<usize> = Vec::new();
    let mut reach = |index: usize, draft: &Draft, stack: &mut Vec<usize>| {
        if !outside[index] && draft.cells[index].mark == Mark::Empty {
            outside[index] = true;
            stack.push(index);
        }
    };
    let top = (size.z as usize - 1) * layer;
    for index in top..top + layer {
        reach(index, draft, &mut stack);
    }
    if draft.topology == Topology::Isolated {
        for z in 0..size.z {
            for x in 0..size.x {
                reach(draft.index(x, 0, z), draft, &mut stack);
                reach(draft.index(x, size.y - 1, z), draft, &mut stack);
            }
            for y in 0..size.y {
                reach(draft.index(0, y, z), draft, &mut stack);
                reach(draft.index(size.x - 1, y, z), draft, &mut stack);
            }
        }
    }
    while let Some(index) = stack.pop() {
        let x = (index % size.x as usize) as u32;
        let y = (index / size.x as usize % size.y as usize) as u32;
        let z = (index / layer) as u32;
        for step in FACES {
            if let Some(next) = draft.beside([x, y, z], step) {
                reach(next, draft, &mut stack);
            }
        }
    }
    for (cell, outside) in draft.cells.iter_mut().zip(outside) {
        if !outside && cell.mark == Mark::Empty {
            cell.mark = Mark::Inside;
        }
    }
}

/// The six neighbours through faces.
pub(super) const FACES: [[i32; 3]; 6] = [
    [-1, 0, 0],
    [1, 0, 0],
    [0, -1, 0],
    [0, 1, 0],
    [0, 0, -1],
    [0, 0, 1],
];

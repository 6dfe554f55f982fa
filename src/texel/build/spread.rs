//! Spreading colour inward (§3.2).
//!
//! Round by round, every uncoloured voxel inside that has coloured neighbours is given their average. A round reads
//! what was coloured before it and writes to a buffer, so that the order of scanning leaves no bias.

use super::super::parallel;
use super::super::progress::{BuildStep, Progress};
use super::draft::{Cell, Draft, Mark};

/// Which neighbours give a voxel its colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Spreading {
    /// All 26, so that slices along all three axes show below the surface the colour of its nearest part.
    #[default]
    Volume,
    /// The 8 of its own slice along w, as in the paper. A flat top is then as thin as one voxel where slices along u
    /// or v show it from the side.
    Slice,
}

/// Voxels that one thread takes at a time.
const CHUNK: usize = 1 << 14;

/// Colours all of the inside.
pub(super) fn spread(draft: &mut Draft, spreading: Spreading, progress: Progress) {
    let neighbours = neighbours(spreading);
    let total = draft.count(Mark::Inside).max(1);
    let mut left = total;
    // What borders on colour, each voxel once.
    let mut queued = vec![false; draft.cells.len()];
    let mut front: Vec<u32> = Vec::new();
    for index in 0..draft.cells.len() {
        if draft.cells[index].mark == Mark::Coloured {
            enqueue(draft, index, &neighbours, &mut queued, &mut front);
        }
    }
    while !front.is_empty() {
        let averages = parallel::map(front.len().div_ceil(CHUNK), |chunk| {
            let range = chunk * CHUNK..front.len().min((chunk + 1) * CHUNK);
            let cells = front[range].iter();
            cells
                .map(|&index| average(draft, index as usize, &neighbours))
                .collect::<Vec<_>>()
        });
        for (&index, cell) in front.iter().zip(averages.into_iter().flatten()) {
            draft.cells[index as usize] = cell;
        }
        left -= front.len();
        progress(BuildStep::Spreading, 1.0 - left as f32 / total as f32);
        let mut next = Vec::with_capacity(front.len());
        for &index in &front {
            enqueue(draft, index as usize, &neighbours, &mut queued, &mut next);
        }
        front = next;
    }
    if left > 0 {
        color_by_column(draft);
    }
}

fn neighbours(spreading: Spreading) -> Vec<[i32; 3]> {
    let layers = match spreading {
        Spreading::Volume => -1..=1,
        Spreading::Slice => 0..=0,
    };
    let mut neighbours = Vec::with_capacity(26);
    for z in layers {
        for y in -1..=1 {
            for x in -1..=1 {
                if [x, y, z] != [0, 0, 0] {
                    neighbours.push([x, y, z]);
                }
            }
        }
    }
    neighbours
}

/// Calls `visit` with the index of each neighbour there is.
fn for_each_neighbour(
    draft: &Draft,
    index: usize,
    neighbours: &[[i32; 3]],
    mut visit: impl FnMut(usize),
) {
    let (width, layer) = (draft.size.x as usize, draft.layer());
    let x = index % width;
    let y = index / width % draft.size.y as usize;
    let z = index / layer;
    let inner = |at: usize, side: u32| 0 < at && at + 1 < side as usize;
    if inner(x, draft.size.x) && inner(y, draft.size.y) && inner(z, draft.size.z) {
        for [dx, dy, dz] in neighbours {
            let step = *dx as isize + *dy as isize * width as isize + *dz as isize * layer as isize;
            visit(index.wrapping_add_signed(step));
        }
    } else {
        for &step in neighbours {
            if let Some(next) = draft.beside([x as u32, y as u32, z as u32], step) {
                visit(next);
            }
        }
    }
}

/// Adds the neighbours of a coloured voxel that lie inside and wait for a colour.
fn enqueue(
    draft: &Draft,
    index: usize,
    neighbours: &[[i32; 3]],
    queued: &mut [bool],
    front: &mut Vec<u32>,
) {
    for_each_neighbour(draft, index, neighbours, |next| {
        if draft.cells[next].mark == Mark::Inside && !queued[next] {
            queued[next] = true;
            front.push(next as u32);
        }
    });
}

/// The average of the coloured neighbours.
fn average(draft: &Draft, index: usize, neighbours: &[[i32; 3]]) -> Cell {
    let mut sum = Cell::default();
    let mut count = 0.0;
    for_each_neighbour(draft, index, neighbours, |next| {
        let cell = &draft.cells[next];
        if cell.mark == Mark::Coloured {
            sum.color += cell.color;
            sum.normal += cell.normal;
            count += 1.0;
        }
    });
    // Opposite sides may cancel half way between them; any direction will do there.
    Cell::coloured(sum.color / count, sum.normal / count)
}

/// What no colour reached within its slice, such as a slice without contour, takes that of its column: the nearest
/// above, or else the nearest below.
fn color_by_column(draft: &mut Draft) {
    let layer = draft.layer();
    let height = draft.size.z as usize;
    for column in 0..layer {
        let mut last: Option<Cell> = None;
        for z in (0..height).rev().chain(0..height) {
            let cell = &mut draft.cells[z * layer + column];
            match cell.mark {
                Mark::Coloured => last = Some(*cell),
                Mark::Inside => {
                    if let Some(last) = last {
                        *cell = last;
                    }
                }
                Mark::Empty => {}
            }
        }
    }
}

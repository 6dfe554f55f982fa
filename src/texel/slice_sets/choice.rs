//! Which pixels of mip levels are opaque.
//!
//! A pixel of level m is opaque in part. The paper allows no half-transparent pixels, and rounding each would lose
//! what is thin and swell what is thick. So the slices of a level have as many opaque pixels as their coverage of level
//! 0 asks for, and they are those that are opaque for the most part (the idea of I. Castaño, *Computing Alpha
//! Mipmaps*, 2010, with a rank in place of a threshold, so that the number is exact). What rounding takes from one
//! slice the next one gets, so that thin volumes do not vanish. Ties go round by a lattice of low discrepancy.
//!
//! Sets are nested as at level 0: what is opaque in a slice is so in one of the two that it is merged of, or in both. Else
//! each count would show other pixels, and what is looked for in the layer of a slice would not be there.

use super::super::parallel;
use super::half::{half, halved};

/// How many pixels of level 0 are opaque, of those that each pixel of a mip level stands for.
pub(super) struct Coverage {
    size: [u32; 2],
    /// How many pixels of level 0 there are to one.
    pixels_each: u64,
    slices: Vec<Vec<u32>>,
}

/// Pixels that are opaque, slice by slice.
pub(super) type Chosen = Vec<Vec<bool>>;

/// All levels of slices that have `size` pixels at level 0, of which these are opaque.
pub(super) fn coverage(opaque: Vec<Vec<u32>>, size: [u32; 2]) -> Vec<Coverage> {
    let mut levels = vec![Coverage {
        size,
        pixels_each: 1,
        slices: opaque,
    }];
    while levels[levels.len() - 1].size != [1, 1] {
        let fine = &levels[levels.len() - 1];
        let size = halved(fine.size);
        let ratio = fine.size[0] * fine.size[1] / (size[0] * size[1]);
        levels.push(Coverage {
            size,
            pixels_each: fine.pixels_each * u64::from(ratio),
            slices: parallel::map(fine.slices.len(), |slice| {
                half(&fine.slices[slice], fine.size, |sum, opaque| *sum += opaque)
            }),
        });
    }
    levels
}

/// Opaque pixels of the levels of all sets, of 1, 2, 4 and so on slices. Those of a set depend on none of more slices.
pub(super) fn choose(sets: &[Vec<Coverage>]) -> Vec<Vec<Chosen>> {
    let mut all: Vec<Vec<Chosen>> = Vec::new();
    for (index, levels) in sets.iter().enumerate() {
        let chosen = levels.iter().enumerate().map(|(level, own)| {
            if level == 0 {
                let slices = own.slices.iter();
                return slices
                    .map(|slice| slice.iter().map(|&opaque| opaque > 0).collect())
                    .collect();
            }
            let counts = rounded(own);
            let Some(fewer) = index.checked_sub(1) else {
                return vec![most_opaque(own, counts[0])];
            };
            let whole = &sets[fewer][level];
            let pairs = parallel::map(whole.slices.len(), |slice| {
                let halves = [&own.slices[2 * slice], &own.slices[2 * slice + 1]];
                let merged = Merged {
                    chosen: &all[fewer][level][slice],
                    opaque: &whole.slices[slice],
                    halves: halves.map(Vec::as_slice),
                    width: own.size[0],
                    slice: slice as u32,
                };
                merged.split([counts[2 * slice], counts[2 * slice + 1]])
            });
            pairs.into_iter().flatten().collect()
        });
        let chosen = chosen.collect();
        all.push(chosen);
    }
    all
}

/// How many pixels of each slice are opaque: sums are rounded, and not the numbers themselves.
fn rounded(coverage: &Coverage) -> Vec<usize> {
    let (mut sum, mut before) = (0, 0);
    let counts = coverage.slices.iter().map(|slice| {
        sum += slice.iter().map(|&opaque| u64::from(opaque)).sum::<u64>();
        let until = (sum + coverage.pixels_each / 2) / coverage.pixels_each;
        let count = until - before;
        before = until;
        count as usize
    });
    counts.collect()
}

/// Of one slice alone, the `count` pixels that are opaque for the most part.
fn most_opaque(coverage: &Coverage, count: usize) -> Vec<bool> {
    let opaque = &coverage.slices[0];
    let mut chosen = vec![false; opaque.len()];
    let some = (0..opaque.len()).filter(|&i| opaque[i] > 0);
    let ranked = some.map(|i| (rank(opaque[i], lattice(i, coverage.size[0], 0)), i));
    for i in first(ranked.collect(), count).0 {
        chosen[i] = true;
    }
    chosen
}

/// A slice that is one of two merged.
struct Merged<'a> {
    /// What is opaque of it.
    chosen: &'a [bool],
    /// Its coverage, and those of the two.
    opaque: &'a [u32],
    halves: [&'a [u32]; 2],
    width: u32,
    slice: u32,
}

impl Merged<'_> {
    /// What is opaque of the two, so many pixels together as `counts` say, of each as many as is possible.
    fn split(&self, counts: [usize; 2]) -> [Vec<bool>; 2] {
        let [near, far] = self.halves;
        let tie = |i: usize| lattice(i, self.width, self.slice);
        let all = (0..self.chosen.len()).filter(|&i| self.chosen[i]);
        let total = counts[0] + counts[1];
        // Rounding may have given the merged one a pixel more than both.
        let ranked = all.map(|i| (rank(self.opaque[i], tie(i)), i));
        let (members, _) = first(ranked.collect(), total);
        // Both show the pixels in which most of what is opaque lies behind one another.
        let (shared, single): (Vec<usize>, Vec<usize>) =
            members.iter().partition(|&&i| near[i] > 0 && far[i] > 0);
        let in_both = (total - members.len()).min(counts[0]).min(counts[1]);
        let overlap = |i: usize| near[i] + far[i] - self.opaque[i];
        let ranked = shared.iter().map(|&i| (rank(overlap(i), tie(i)), i));
        let (both, either) = first(ranked.collect(), in_both);
        let mut halves = [vec![false; near.len()], vec![false; far.len()]];
        for &i in &both {
            halves[0][i] = true;
            halves[1][i] = true;
        }
        // Others the one that has them, or more of them.
        let (only_near, only_far): (Vec<usize>, Vec<usize>) =
            single.iter().partition(|&&i| near[i] > 0);
        for (half, indices) in [only_near, only_far].iter().enumerate() {
            for &i in indices {
                halves[half][i] = true;
            }
        }
        let wanted = counts[0].saturating_sub(halves[0].iter().filter(|&&is| is).count());
        let share = |i: usize| u32::MAX / 2 + near[i] - far[i];
        let ranked = either.iter().map(|&i| (rank(share(i), tie(i)), i));
        let (nearer, farther) = first(ranked.collect(), wanted);
        for (half, indices) in [nearer, farther].into_iter().enumerate() {
            for i in indices {
                halves[half][i] = true;
            }
        }
        self.fill(&mut halves, total);
        halves
    }

    /// Adds what is opaque for the most part until there are `total` pixels, where the merged one has too few.
    fn fill(&self, halves: &mut [Vec<bool>; 2], total: usize) {
        let found: usize = halves.iter().flatten().filter(|opaque| **opaque).count();
        let Some(missing) = total.checked_sub(found).filter(|missing| *missing > 0) else {
            return;
        };
        let mut ranked = Vec::new();
        for (half, chosen) in halves.iter().enumerate() {
            for (i, &opaque) in self.halves[half].iter().enumerate() {
                if opaque > 0 && !chosen[i] {
                    let tie = lattice(i, self.width, 2 * self.slice + half as u32);
                    ranked.push((rank(opaque, tie), 2 * i + half));
                }
            }
        }
        for i in first(ranked, missing).0 {
            halves[i % 2][i / 2] = true;
        }
    }
}

/// What comes first is less: of more pixels, then by lot.
fn rank(opaque: u32, tie: u32) -> u64 {
    u64::from(!opaque) << 32 | u64::from(tie)
}

/// The `count` first by rank, and the others.
fn first(mut ranked: Vec<(u64, usize)>, count: usize) -> (Vec<usize>, Vec<usize>) {
    let count = count.min(ranked.len());
    if count > 0 && count < ranked.len() {
        ranked.select_nth_unstable(count - 1);
    }
    let others = ranked.split_off(count);
    let indices = |ranked: Vec<(u64, usize)>| ranked.into_iter().map(|(_, i)| i).collect();
    (indices(ranked), indices(others))
}

/// A number for each pixel, spread evenly over neighbours in a slice and in the next: multiples of the powers of the
/// plastic number (M. Roberts, *The Unreasonable Effectiveness of Quasirandom Sequences*, 2018), and of the golden
/// ratio. Odd factors keep the numbers of a row apart.
fn lattice(index: usize, width: u32, slice: u32) -> u32 {
    let (x, y) = (index as u32 % width, index as u32 / width);
    x.wrapping_mul(3_242_174_889)
        .wrapping_add(y.wrapping_mul(2_447_445_413))
        .wrapping_add(slice.wrapping_mul(2_654_435_769))
}

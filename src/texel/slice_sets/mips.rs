//! Mip levels of slices: what their pixels show, of which `choice.rs` tells whether they are opaque.
//!
//! Colours and normals are means over as much in depth, across slices, as pixels are wide: else what is seen aslant would be
//! filtered along the slices and not across them, and shimmer. Means of normals are the shorter the more these differ, which
//! is what light is worked out from (`lighting/simple.wgsl`).

use super::super::color::SrgbTable;
use super::super::parallel;
use super::choice::Chosen;
use super::half::{half, halved};
use super::{PixelSum, SliceLevel};

/// What pixels of level 0 are in depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Depth {
    /// How many slices lie on the width of one.
    pub pixel: f32,
    /// Whether the first slice follows the last.
    pub repeats: bool,
}

/// All levels of slices that have `size` pixels at level 0, of which those `chosen` are opaque.
pub(super) fn levels(
    slices: Vec<Vec<PixelSum>>,
    chosen: &[Chosen],
    size: [u32; 2],
    depth: Depth,
    table: &SrgbTable,
) -> Vec<SliceLevel> {
    let mut levels = Vec::new();
    let pixels_of = |[width, height]: [u32; 2]| (width * height) as f32;
    let all = pixels_of(size);
    let mut size = size;
    let mut current = slices;
    for chosen in chosen {
        let encoded = parallel::map(current.len(), |slice| {
            let pixels = &current[slice];
            let chosen = &chosen[slice];
            // Pixels grow by as much along as across.
            let reach = (0.5 * depth.pixel * (all / pixels_of(size)).sqrt()) as usize;
            if reach == 0 {
                encode(pixels, chosen, size, table)
            } else {
                let thick = thickened(&current, slice, reach, depth.repeats);
                encode(&thick, chosen, size, table)
            }
        });
        let (colors, normals) = encoded.into_iter().flatten().unzip();
        levels.push(SliceLevel {
            size,
            colors,
            normals,
        });
        current = parallel::map(current.len(), |slice| {
            half(&current[slice], size, |sum, pixel| sum.add(pixel, 1))
        });
        size = halved(size);
    }
    levels
}

/// Twice the sums of a slice's pixels with those of `reach` slices on either side, of which the outermost count half.
fn thickened(slices: &[Vec<PixelSum>], slice: usize, reach: usize, repeats: bool) -> Vec<PixelSum> {
    let count = slices.len();
    // No slice counts twice.
    let reach = reach.min(count / 2) as isize;
    let mut sums = vec![PixelSum::default(); slices[slice].len()];
    for offset in -reach..=reach {
        let at = slice as isize + offset;
        let near = if repeats {
            at.rem_euclid(count as isize) as usize
        } else if (0..count as isize).contains(&at) {
            at as usize
        } else {
            continue;
        };
        let times = if offset.abs() == reach { 1 } else { 2 };
        for (sum, pixel) in sums.iter_mut().zip(&slices[near]) {
            sum.add(pixel, times);
        }
    }
    sums
}

/// Bytes of a slice. Empty pixels have alpha 0, and the colour of what is in them or beside them.
fn encode(
    pixels: &[PixelSum],
    chosen: &[bool],
    size: [u32; 2],
    table: &SrgbTable,
) -> Vec<([u8; 4], [u8; 4])> {
    let [width, height] = size;
    let mut encoded = Vec::with_capacity(pixels.len());
    for (index, pixel) in pixels.iter().enumerate() {
        let alpha = if chosen[index] { 255 } else { 0 };
        let mut sum = *pixel;
        if sum.opaque == 0 {
            let (x, y) = (index as u32 % width, index as u32 / width);
            for row in y.saturating_sub(1)..(y + 2).min(height) {
                for column in x.saturating_sub(1)..(x + 2).min(width) {
                    let near = &pixels[(row * width + column) as usize];
                    sum.add(near, 1);
                }
            }
        }
        encoded.push(if sum.opaque == 0 {
            ([0; 4], [0; 4])
        } else {
            let ([r, g, b], [x, y, z]) = sum.encode(table);
            ([r, g, b, alpha], [x, y, z, alpha])
        });
    }
    encoded
}

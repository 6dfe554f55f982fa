//! Slices along the two directions in the surface (§4.2, Figure 8): on a facet each is a line, extruded along the
//! height vectors.
//!
//! The lines of slice k stand where u (or v) is (k + ½)/N, for all whole k: beyond 0 to N − 1 they are those of the
//! next copies of the texture, which show slice k mod N. Mirrored and rotated textures need nothing more, for all is
//! done in texture coordinates.
//!
//! Where the number doubles nothing jumps: the two slices that take the place of one begin where that was, and move apart to
//! where they belong (as the vertices of H. Hoppe, *Progressive Meshes*, 1996, §3.2, move in a geomorph).

use std::ops::Range;

use bevy::math::{Vec2, Vec3};

use super::super::axis::SliceAxis;

/// The component of texture coordinates along an axis in the surface.
fn along(axis: SliceAxis, uv: Vec2) -> f32 {
    match axis {
        SliceAxis::U => uv.x,
        SliceAxis::V | SliceAxis::W => uv.y,
    }
}

/// The numbers k of all slices that cut a facet, for N slices a texel, which are where [`slice_position`] has them: along u
/// or v those of which [`slice_line`] finds a line, along w all N. Numbers beyond those of an `i32` are left out.
pub fn slice_range(uvs: [Vec2; 3], axis: SliceAxis, count: u32, apart: f32) -> Range<i32> {
    if axis == SliceAxis::W {
        return 0..count as i32;
    }
    let [a, b, c] = uvs.map(|uv| along(axis, uv));
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    // As slice_line decides: the first position above the least, up to the greatest.
    let n = count as f32;
    let first_above = |value: f32| {
        // Pair by pair.
        let even = (0.5 * value * n).floor() * 2.0;
        let is_above = |odd: f32| even + 1.0 + (odd - 0.5) * apart > value * n;
        let below = [0.0, 1.0].into_iter().take_while(|&odd| !is_above(odd));
        (even as i32).saturating_add(below.count() as i32)
    };
    first_above(low)..first_above(high).max(first_above(low))
}

/// Where u, v or w of slice k of N is, if two that lie in one of half as many slices are moved so far `apart` from the
/// middle of that one: 0 to 1, at which they are all evenly spaced.
pub fn slice_position(slice: i32, count: u32, apart: f32) -> f32 {
    let (even, odd) = (slice & !1, slice & 1);
    (even as f32 + 1.0 + (odd as f32 - 0.5) * apart) / count as f32
}

/// The line in which u (or v) has the value `position` on a facet: the weights of its two ends, none if it does not
/// meet it.
///
/// Both facets of an edge find the same end on it, to the last bit, so that slices do not crack. A vertex on the line
/// counts as beyond it.
pub fn slice_line(uvs: [Vec2; 3], axis: SliceAxis, position: f32) -> Option<[Vec3; 2]> {
    let values = uvs.map(|uv| along(axis, uv));
    let mut ends = [Vec3::ZERO; 2];
    let mut found = 0;
    for i in 0..3 {
        let j = (i + 1) % 3;
        if (values[i] >= position) != (values[j] >= position) {
            // From the lower end, whichever facet asks.
            let (low, high) = if values[i] < values[j] {
                (i, j)
            } else {
                (j, i)
            };
            let t = (position - values[low]) / (values[high] - values[low]);
            ends[found][low] = 1.0 - t;
            ends[found][high] = t;
            found += 1;
        }
    }
    (found == 2).then_some(ends)
}

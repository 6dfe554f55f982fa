//! The slices that are drawn instead of the volume, met by a ray: what a perfect rasteriser would show of them.
//!
//! Slice k of N stands at (k + ½)/N of its axis and is as thin as paper; a ray sees the first whose pixel is opaque
//! where it passes through. Held against [`march_voxels`](super::march_voxels), it tells the method's own error from
//! that of drawing.

use glam::DVec3;

use crate::texel::color::decode_normal;
use crate::texel::{SliceAxis, SliceSet};

/// The first slice that a ray sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceHit {
    /// Where it passes through it.
    pub t: f64,
    /// The place in texture space.
    pub uvw: DVec3,
    /// The pixel's sRGB colour and alpha.
    pub color: [u8; 4],
    /// The pixel's unit normal in metres of the volume's box.
    pub normal: DVec3,
}

/// The first opaque pixel of the slices of a set on the line `origin` + t·`dir` in texture space, for t from
/// `range[0]` to `range[1]`, both finite.
///
/// Slices repeat with the texture along u and v, and extend from 0 to 1 along w. Pixels are those of level 0, nearest.
pub fn march_slices(
    set: &SliceSet,
    origin: DVec3,
    dir: DVec3,
    range: [f64; 2],
) -> Option<SliceHit> {
    let axis = set.axis.index();
    let count = f64::from(set.count);
    // In slices, of which number k is met at k.
    let (o, d) = (origin[axis] * count - 0.5, dir[axis] * count);
    if d == 0.0 {
        return None;
    }
    let [from, to] = range.map(|t| o + t * d);
    let (mut low, mut high) = (from.min(to).ceil(), from.max(to).floor());
    if set.axis == SliceAxis::W {
        (low, high) = (low.max(0.0), high.min(count - 1.0));
    }
    let numbers = (high - low).max(-1.0) as i64 + 1;
    (0..numbers).find_map(|i| {
        let slice = if d > 0.0 {
            low as i64 + i
        } else {
            high as i64 - i
        };
        let t = (slice as f64 - o) / d;
        look(set, slice, origin + t * dir, t)
    })
}

/// A slice's pixel at a place, if it is opaque.
fn look(set: &SliceSet, slice: i64, uvw: DVec3, t: f64) -> Option<SliceHit> {
    if !(0.0..1.0).contains(&uvw.z) {
        return None;
    }
    let level = &set.levels[0];
    let [column, row] = [0, 1].map(|i| {
        let place = uvw[set.axis.in_plane()[i].index()].rem_euclid(1.0);
        // What rounds up to the next copy is its first pixel.
        (place * f64::from(level.size[i])) as u32 % level.size[i]
    });
    let slice = slice.rem_euclid(i64::from(set.count)) as u32;
    let index = level.index(slice, column, row);
    let [nx, ny, nz, _] = level.normals[index];
    (level.colors[index][3] != 0).then(|| SliceHit {
        t,
        uvw,
        color: level.colors[index],
        normal: decode_normal([nx, ny, nz]).as_dvec3(),
    })
}

//! Where slices show anything: the rest of them need not be drawn.

use bevy::math::{Vec2, Vec3};

use super::super::axis::SliceAxis;
use super::super::choose::DrawnSlices;
use super::super::facet::{slice_line, slice_position};
use super::SliceSets;

/// Pixels of its level by which a box is larger than what is opaque: filtering shows half a pixel more, and samples beside
/// the middle of a pixel of the screen, of which one covers at most 1.5 of them, as much again.
const MARGIN: f32 = 2.0;

/// Columns and rows of a slice, from 0 to 1 for one texel, between which all that is opaque lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SliceBox {
    low: Vec2,
    high: Vec2,
}

/// A part of a slice on a facet, in shares of 65,535: from where to where along its line, and up its height vectors.
pub(crate) type Trim = [u16; 4];

/// All of it.
pub(crate) const WHOLE: Trim = [0, u16::MAX, 0, u16::MAX];

/// For each slice of all sets, where it shows anything.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SliceBoxes {
    /// Along u, v and w.
    axes: [AxisBoxes; 3],
}

#[derive(Clone, Debug, PartialEq)]
struct AxisBoxes {
    /// Pixels of the finest level.
    size: Vec2,
    /// What shows in a mip level or a finer one. Slice k of N is at N − 1 + k, as in the texture arrays.
    levels: Vec<Vec<Option<SliceBox>>>,
}

impl SliceBoxes {
    pub(crate) fn of(sets: &SliceSets) -> Self {
        let axes = SliceAxis::ALL.map(|axis| {
            let sets: Vec<_> = sets.iter().filter(|set| set.axis == axis).collect();
            let mut levels: Vec<Vec<Option<SliceBox>>> = Vec::new();
            for index in 0..sets[0].levels.len() {
                let slices = sets.iter().flat_map(|set| {
                    let level = &set.levels[index];
                    (0..set.count).map(move |slice| {
                        let pixels = (level.size[0] * level.size[1]) as usize;
                        opaque_box(
                            level.size,
                            &level.normals[slice as usize * pixels..][..pixels],
                        )
                    })
                });
                let mut slices: Vec<_> = slices.collect();
                if let Some(finer) = levels.last() {
                    for (own, finer) in slices.iter_mut().zip(finer) {
                        *own = union(*own, *finer);
                    }
                }
                levels.push(slices);
            }
            let [columns, rows] = sets[0].levels[0].size.map(|side| side as f32);
            AxisBoxes {
                size: Vec2::new(columns, rows),
                levels,
            }
        });
        Self { axes }
    }

    /// What of a slice may show on a facet, of which a pixel of the screen covers at most so much of a texel, along columns
    /// and rows; none if nothing does. Slices beyond a texel are those of its copies.
    pub(crate) fn trim(
        &self,
        uvs: [Vec2; 3],
        axis: SliceAxis,
        slice: i32,
        drawn: &DrawnSlices,
        footprint: Vec2,
    ) -> Option<Trim> {
        let DrawnSlices { count, apart, .. } = *drawn;
        let boxes = &self.axes[axis.index()];
        let covered = (footprint * boxes.size).length();
        // Samplers round the level; half a level more is for what corners tell too little of the facet.
        let level = (covered.max(1.0).log2() + 0.5).ceil() as usize;
        let slices = &boxes.levels[level.min(boxes.levels.len() - 1)];
        let layer = count - 1 + (slice as u32 & (count - 1));
        let shown = slices[layer as usize]?;
        if axis == SliceAxis::W {
            let low = uvs[0].min(uvs[1]).min(uvs[2]);
            let high = uvs[0].max(uvs[1]).max(uvs[2]);
            repeated(low.x, high.x, shown.low.x, shown.high.x)?;
            repeated(low.y, high.y, shown.low.y, shown.high.y)?;
            return Some(WHOLE);
        }
        let ends = slice_line(uvs, axis, slice_position(slice, count, apart))?;
        let column = |b: Vec3| {
            let uv = uvs[0] * b.x + uvs[1] * b.y + uvs[2] * b.z;
            if axis == SliceAxis::U { uv.y } else { uv.x }
        };
        let [first, last] = ends.map(column);
        let (low, high) = (first.min(last), first.max(last));
        let (from, to) = repeated(low, high, shown.low.x, shown.high.x)?;
        let [mut from, mut to] = [from, to].map(|at| (at - first) / (last - first));
        if last < first {
            (from, to) = (to, from);
        }
        let (from, to) = if last == first {
            (0.0, 1.0)
        } else {
            (from, to)
        };
        let share = |at: f32| at * f32::from(u16::MAX);
        // Rows end; what is beyond repeats none.
        Some([
            share(from).floor() as u16,
            share(to).ceil() as u16,
            share(shown.low.y).floor() as u16,
            share(shown.high.y).ceil() as u16,
        ])
    }
}

/// The box of a slice's opaque pixels, with its margin.
fn opaque_box([width, height]: [u32; 2], pixels: &[[u8; 4]]) -> Option<SliceBox> {
    let (mut low, mut high) = ([u32::MAX; 2], [0; 2]);
    for (row, pixels) in (0..height).zip(pixels.chunks_exact(width as usize)) {
        let is_opaque = |pixel: &[u8; 4]| pixel[3] != 0;
        let Some(first) = pixels.iter().position(is_opaque) else {
            continue;
        };
        let last = pixels.iter().rposition(is_opaque).unwrap_or(first);
        low = [low[0].min(first as u32), low[1].min(row)];
        high = [high[0].max(last as u32), high[1].max(row)];
    }
    let place = |at: [u32; 2], margin: f32| {
        Vec2::new(
            (at[0] as f32 + margin) / width as f32,
            (at[1] as f32 + margin) / height as f32,
        )
    };
    (low[0] != u32::MAX).then(|| SliceBox {
        low: place(low, -MARGIN),
        high: place(high, 1.0 + MARGIN),
    })
}

fn union(a: Option<SliceBox>, b: Option<SliceBox>) -> Option<SliceBox> {
    match (a, b) {
        (Some(a), Some(b)) => Some(SliceBox {
            low: a.low.min(b.low),
            high: a.high.max(b.high),
        }),
        _ => a.or(b),
    }
}

/// What of the values from `low` to `high` lies between the first and the last that is from `from` to `to`, or a whole
/// number more or less; none if nothing is.
fn repeated(low: f32, high: f32, from: f32, to: f32) -> Option<(f32, f32)> {
    // The last copy that begins before.
    let copy = |value: f32| (value - from).floor();
    let first = if low <= copy(low) + to {
        low
    } else {
        copy(low) + 1.0 + from
    };
    let last = high.min(copy(high) + to);
    (first <= last).then_some((first, last))
}

#[cfg(test)]
mod tests {
    use bevy::math::UVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::texel::build::{VolumeSettings, from_hypertexture};
    use crate::texel::silent;

    /// A leaning rod, and a speck at the border.
    fn sets() -> SliceSets {
        let density = |at: Vec3| {
            let rod = 0.6 - 8.0 * (at - Vec3::new(0.4, 0.3, at.z)).length();
            let speck = 0.53 - at.distance(Vec3::new(0.95, 0.75, 0.2));
            (rod.max(speck), Vec3::ONE)
        };
        let settings = VolumeSettings::new(UVec3::new(32, 64, 16));
        let volume = from_hypertexture(density, &settings, &silent);
        SliceSets::new(&volume.expect("it is in range").volume, 256)
    }

    fn drawn(count: u32) -> DrawnSlices {
        DrawnSlices {
            count,
            apart: 1.0,
            lots: [0.0, 1.0],
        }
    }

    #[test]
    fn values_are_those_between_the_first_and_the_last_copy() {
        let cases = [
            ((0.0, 1.0), Some((0.25, 0.5))),
            ((0.3, 0.4), Some((0.3, 0.4))),
            ((0.0, 0.2), None),
            ((0.6, 1.1), None),
            ((0.6, 1.3), Some((1.25, 1.3))),
            ((-0.7, 2.0), Some((-0.7, 1.5))),
        ];
        for ((low, high), expected) in cases {
            assert_eq!(repeated(low, high, 0.25, 0.5), expected, "{low} {high}");
        }
        assert_eq!(repeated(0.1, 0.9, -0.2, 1.2), Some((0.1, 0.9)));
        assert_eq!(repeated(0.9, 0.95, -0.2, 0.5), Some((0.9, 0.95)));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

        /// At any level that may be looked up no opaque pixel is outside of what is drawn.
        #[test]
        fn nothing_opaque_is_cut_off(
            uvs in prop::array::uniform3(prop::array::uniform2(-1.5..1.5f32)),
            exponent in 0..7u32,
            upright in 0..3usize,
            level in 0..5usize,
            seed in 0..1000u32,
            apart in 0.0..=1.0f32,
        ) {
            thread_local!(static SETS: (SliceSets, SliceBoxes) = {
                let sets = sets();
                let boxes = SliceBoxes::of(&sets);
                (sets, boxes)
            });
            SETS.with(|(sets, boxes)| {
                let axis = SliceAxis::ALL[upright];
                let set = sets.get(axis, 1 << exponent);
                let uvs = uvs.map(Vec2::from);
                let apart = if set.count > 1 { apart } else { 1.0 };
                let drawn = DrawnSlices {
                    apart,
                    ..drawn(set.count)
                };
                let range = crate::texel::facet::slice_range(uvs, axis, set.count, apart);
                if range.is_empty() {
                    return Ok(());
                }
                let slice = range.start + (seed % range.len() as u32) as i32;
                let size = boxes.axes[upright].size;
                let footprint = Vec2::new((1u32 << level) as f32 / size.x, 0.0);
                let trim = boxes.trim(uvs, axis, slice, &drawn, footprint);
                let shown = &set.levels[level.min(set.levels.len() - 1)];
                let number = slice as u32 & (set.count - 1);
                // Places of the slice on the facet.
                for i in 0..=40 {
                    for j in 0..=40 {
                        let (s, t) = (i as f32 / 40.0, j as f32 / 40.0);
                        let (at, inside) = if axis == SliceAxis::W {
                            let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
                            (uvs[0] + (uvs[1] - uvs[0]) * s + (uvs[2] - uvs[0]) * t, trim.is_some())
                        } else {
                            let Some(ends) = slice_line(uvs, axis, slice_position(slice, set.count, apart)) else {
                                return Ok(());
                            };
                            let b = ends[0] * (1.0 - s) + ends[1] * s;
                            let uv = uvs[0] * b.x + uvs[1] * b.y + uvs[2] * b.z;
                            let column = if axis == SliceAxis::U { uv.y } else { uv.x };
                            let inside = trim.is_some_and(|trim| {
                                let [from, to, low, high] = trim.map(|at| f32::from(at) / 65_535.0);
                                from <= s && s <= to && low <= t && t <= high
                            });
                            (Vec2::new(column, t), inside)
                        };
                        let [width, height] = shown.size;
                        let column = (at.x.rem_euclid(1.0) * width as f32) as u32;
                        let row = (at.y.rem_euclid(1.0) * height as f32) as u32;
                        if axis != SliceAxis::W && t == 1.0 {
                            continue;
                        }
                        let index = shown.index(number, column.min(width - 1), row.min(height - 1));
                        prop_assert!(inside || shown.normals[index][3] == 0, "{axis:?} {slice} {at}");
                    }
                }
                Ok(())
            })?;
        }
    }

    #[test]
    fn much_of_a_sparse_volume_is_cut_off_from_near_by_and_little_from_afar() {
        let boxes = SliceBoxes::of(&sets());
        let uvs = [Vec2::ZERO, Vec2::X, Vec2::Y];
        let area = |footprint: f32| -> f32 {
            let trims = (0..32).filter_map(|slice| {
                boxes.trim(uvs, SliceAxis::U, slice, &drawn(32), Vec2::splat(footprint))
            });
            trims
                .map(|[from, to, ..]| f32::from(to - from) / 65_535.0)
                .sum()
        };
        let (near, far) = (area(0.0), area(1.0));
        // Both ends of each slice are rounded outwards, by up to one of 65,535.
        assert!(
            near <= 0.5 * far + 64.0 / 65_535.0 && far <= 32.0,
            "{near} {far}"
        );
    }
}

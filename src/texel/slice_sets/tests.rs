//! Sets show what the volume shows, in any count and level.

use bevy::math::{UVec3, Vec3};
use proptest::prelude::*;

use super::super::build::{VolumeSettings, from_hypertexture};
use super::super::progress::silent;
use super::super::topology::Topology;
use super::*;

/// A volume of what is solid at voxels' centres, whose colours tell where they are.
fn volume(size: UVec3, solid: impl Fn(Vec3) -> bool + Sync) -> ReferenceVolume {
    let settings = VolumeSettings {
        lengths: size.as_vec3(),
        topology: Topology::Tiling,
        ..VolumeSettings::new(size)
    };
    let density = |at: Vec3| (if solid(at * size.as_vec3()) { 1.0 } else { 0.0 }, at);
    from_hypertexture(density, &settings, &silent)
        .unwrap()
        .volume
}

/// Whether some slice is opaque at each pixel of a level.
fn shadow(set: &SliceSet, level: usize) -> Vec<bool> {
    let level = &set.levels[level];
    let [width, height] = level.size;
    let pixels = (0..width * height).map(|i| (i % width, i / width));
    pixels
        .map(|(column, row)| {
            (0..set.count).any(|slice| level.colors[level.index(slice, column, row)][3] != 0)
        })
        .collect()
}

fn opaque(level: &SliceLevel) -> usize {
    level.colors.iter().filter(|color| color[3] != 0).count()
}

#[test]
fn the_fullest_sets_are_the_volume_itself() {
    let size = UVec3::new(8, 16, 4);
    let volume = volume(size, |at| {
        (at.x * 3.0 + at.y * 5.0 + at.z * 7.0) % 4.0 < 2.0
    });
    for axis in SliceAxis::ALL {
        let set = SliceSet::new(&volume, axis, u32::MAX);
        assert_eq!(set.count, size[axis.index()]);
        let [across, up] = axis.in_plane();
        for (x, y, z) in (0..512).map(|i| (i % 8, i / 8 % 16, i / 128)) {
            let at = [x, y, z];
            let index = set.levels[0].index(at[axis.index()], at[across.index()], at[up.index()]);
            let color = volume.color(x, y, z);
            let found = set.levels[0].colors[index];
            assert_eq!(found[3], color[3]);
            if color[3] != 0 {
                assert_eq!(found, color);
            }
        }
    }
}

#[test]
fn every_count_covers_the_same_pixels_seen_along_its_axis() {
    let size = UVec3::new(16, 8, 32);
    let volume = volume(size, |at| {
        at.distance(Vec3::new(8.0, 4.0, 12.0)) < 4.2
            || (at.x as u32 + at.z as u32).is_multiple_of(13)
    });
    let sets = SliceSets::new(&volume, 16);
    for axis in SliceAxis::ALL {
        let expected = shadow(&SliceSet::new(&volume, axis, size[axis.index()]), 0);
        for count in [1, 2, 4, 8, 16] {
            let set = sets.get(axis, count);
            assert_eq!(set.count, count.min(size[axis.index()]));
            assert_eq!(shadow(set, 0), expected, "{axis:?} {count}");
            assert_eq!(
                set,
                &SliceSet::new(&volume, axis, count.min(size[axis.index()]))
            );
        }
        for count in [1000, u32::MAX] {
            assert_eq!(sets.get(axis, count).count, size[axis.index()].min(16));
        }
    }
}

#[test]
fn from_above_one_slice_shows_the_topmost_voxel() {
    let size = UVec3::new(4, 4, 8);
    let volume = volume(size, |at| at.z < 1.0 + at.x);
    let set = SliceSet::new(&volume, SliceAxis::W, 1);
    for x in 0..4 {
        let top = volume.color(x, 2, x);
        let level = &set.levels[0];
        assert_eq!(level.colors[level.index(0, x, 2)], top);
    }
}

#[test]
fn mip_levels_keep_the_share_of_opaque_pixels() {
    let size = UVec3::new(64, 64, 16);
    // Sparse needles and a ball.
    let volume = volume(size, |at| {
        let needle = (at.x as u32 * 7 + at.y as u32 * 3).is_multiple_of(23);
        needle || at.distance(Vec3::new(40.0, 30.0, 8.0)) < 7.0
    });
    for axis in SliceAxis::ALL {
        for count in [size[axis.index()], 4] {
            let set = SliceSet::new(&volume, axis, count);
            let pixels = |level: &SliceLevel| level.colors.len() as f64;
            let share = opaque(&set.levels[0]) as f64 / pixels(&set.levels[0]);
            for level in &set.levels {
                // Sums over slices are rounded once: half a pixel of all.
                let found = opaque(level) as f64;
                assert!(
                    (found - share * pixels(level)).abs() <= 0.5,
                    "{axis:?} {:?}",
                    level.size
                );
            }
        }
    }
}

#[test]
fn in_mip_levels_too_a_slice_shows_what_the_two_show_that_it_is_merged_of() {
    let size = UVec3::new(64, 64, 16);
    // A ball, and ground with grass.
    let volume = volume(size, |at| {
        let blade = (at.x as u32 * 7 + at.y as u32 * 3).is_multiple_of(11);
        let ball = at.distance(Vec3::new(40.0, 30.0, 8.0)) < 6.0;
        at.z < 2.0 || ball || (blade && at.z < 5.0 + (at.x * at.y) % 7.0)
    });
    let sets = SliceSets::new(&volume, 64);
    for axis in SliceAxis::ALL {
        for count in [1, 2, 4, 8].map(|halves| size[axis.index()] / halves) {
            let [fine, merged] = [sets.get(axis, count), sets.get(axis, count / 2)];
            for (level, (fine, merged)) in fine.levels.iter().zip(&merged.levels).enumerate() {
                let [width, height] = fine.size;
                let is = |level: &SliceLevel, slice, i| {
                    level.colors[level.index(slice, i % width, i / width)][3] != 0
                };
                let mut other = 0;
                for slice in 0..count / 2 {
                    let all = 0..width * height;
                    other += all
                        .filter(|&i| {
                            let both = is(fine, 2 * slice, i) || is(fine, 2 * slice + 1, i);
                            both != is(merged, slice, i)
                        })
                        .count() as u32;
                }
                // Rounding moves a pixel here and there. Slices of few pixels have less than one each, and take turns.
                if width * height >= 64 {
                    let all = opaque(merged);
                    assert!(
                        other * 50 <= all as u32,
                        "{axis:?} {count}, level {level}: {other} of {all}"
                    );
                }
            }
        }
    }
}

#[test]
fn levels_shrink_to_one_pixel_and_keep_their_colour() {
    let volume = volume(UVec3::new(32, 8, 4), |_| true);
    let set = SliceSet::new(&volume, SliceAxis::W, 4);
    let sizes: Vec<_> = set.levels.iter().map(|level| level.size).collect();
    assert_eq!(sizes, [[32, 8], [16, 4], [8, 2], [4, 1], [2, 1], [1, 1]]);
    // Colours are places, so that the last is the middle; u is red, linear. Of the four slices, the first is mixed with the
    // second, and with half of the third.
    let table = SrgbTable::new();
    let [r, g, b, a] = set.levels[5].colors[0];
    let middle = table.decode([r, g, b]);
    assert!(
        (middle - Vec3::new(0.5, 0.5, 0.325)).abs().max_element() < 0.01,
        "{middle}"
    );
    assert_eq!(a, 255);
    assert_eq!(set.bytes(), 4 * (256 + 64 + 16 + 4 + 2 + 1) * 8);
}

#[test]
fn pixels_of_a_level_are_means_of_as_much_across_slices_as_along_them() {
    // Stripes across the slices, of one voxel each, black and white.
    let size = UVec3::splat(16);
    let settings = VolumeSettings {
        lengths: size.as_vec3(),
        topology: Topology::Tiling,
        ..VolumeSettings::new(size)
    };
    let stripes = |at: Vec3| (1.0, Vec3::splat((at.x * 16.0) as u32 as f32 % 2.0));
    let volume = from_hypertexture(stripes, &settings, &silent)
        .unwrap()
        .volume;
    let set = SliceSet::new(&volume, SliceAxis::U, 16);
    let table = SrgbTable::new();
    for (level, expected) in set.levels.iter().zip([[0.0, 1.0], [0.5, 0.5], [0.5, 0.5]]) {
        for slice in 0..16 {
            let [r, g, b, _] = level.colors[level.index(slice, 0, 0)];
            let shown = table.decode([r, g, b]).x;
            // Bytes of sRGB are at most 0.01 apart.
            assert!(
                (shown - expected[slice as usize % 2]).abs() < 0.01,
                "{:?} {slice}: {shown}",
                level.size
            );
        }
    }
}

#[test]
fn normals_are_the_shorter_the_more_they_differ() {
    // The upper half of a ball, seen in the smallest level from above and from a side.
    let size = UVec3::splat(16);
    let volume = volume(size, |at| at.distance(Vec3::new(8.0, 8.0, 0.0)) < 6.0);
    let length = |set: &SliceSet, level: usize, index: usize| {
        let [x, y, z, _] = set.levels[level].normals[index];
        let value = |byte: u8| f32::from(byte) / 127.5 - 1.0;
        Vec3::new(value(x), value(y), value(z)).length()
    };
    let above = SliceSet::new(&volume, SliceAxis::W, 1);
    let top = above.levels[0].index(0, 8, 8);
    // A byte's step on each of three axes.
    assert!((length(&above, 0, top) - 1.0).abs() < 3f32.sqrt() / 255.0);
    // Over a hemisphere, by what one sees from above, the mean is 2/3 long: cos³ over cos². Voxels, and their differences,
    // make it a tenth more or less.
    let last = above.levels.len() - 1;
    let mean = length(&above, last, 0);
    assert!((mean - 2.0 / 3.0).abs() < 0.07, "{mean}");
}

#[test]
fn empty_pixels_beside_opaque_ones_have_their_colour() {
    let volume = volume(UVec3::new(8, 8, 1), |at| at.x < 4.0);
    let level = &SliceSet::new(&volume, SliceAxis::W, 1).levels[0];
    let [beside, edge] = [4, 3].map(|x| level.colors[level.index(0, x, 4)]);
    assert_eq!(beside[3], 0);
    assert!(beside[0].abs_diff(edge[0]) <= 1 && edge[3] == 255);
    assert_eq!(level.colors[level.index(0, 6, 4)], [0; 4]);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    #[test]
    fn a_level_has_an_opaque_pixel_only_where_the_volume_has_one(bits in prop::collection::vec(0..6u8, 512)) {
        let size = UVec3::splat(8);
        prop_assume!(bits.contains(&0));
        // Normals are differences that reach to the far sides.
        let voxel = |at: Vec3| at.as_uvec3().min(UVec3::splat(7)).as_usizevec3();
        let volume = volume(size, |at| bits[(voxel(at).x * 8 + voxel(at).y) * 8 + voxel(at).z] == 0);
        for axis in SliceAxis::ALL {
            let set = SliceSet::new(&volume, axis, 8);
            for (m, level) in set.levels.iter().enumerate() {
                for slice in 0..8 {
                    for (column, row) in (0..64 >> (2 * m)).map(|i| (i % (8 >> m), i / (8 >> m))) {
                        let all = (0..1u32 << (2 * m)).map(|i| (i % (1 << m), i >> m));
                        let below = all.map(|(x, y)| set.levels[0].index(slice, (column << m) + x, (row << m) + y));
                        let any = below.into_iter().any(|index| set.levels[0].colors[index][3] != 0);
                        let opaque = level.colors[level.index(slice, column, row)][3] != 0;
                        prop_assert!(any || !opaque);
                    }
                }
            }
        }
    }
}

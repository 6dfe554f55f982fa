//! What holds for all maps.

use std::sync::LazyLock;

use bevy::math::Vec2;

use super::noise::{again, unit};
use super::*;

/// Painted once for all tests.
static PAINTED: LazyLock<Vec<Maps>> =
    LazyLock::new(|| SURFACES.map(|(kind, _)| Maps::paint(kind)).into());

fn points(count: u32) -> impl Iterator<Item = Vec2> {
    (0..count).map(|i| Vec2::new(unit(again(i, 1)), unit(again(i, 2))))
}

#[test]
fn every_surface_repeats() {
    for (kind, name) in SURFACES {
        let mut off = Vec::new();
        for uv in points(300) {
            // Places a 256th of a map apart, for the slope.
            let step = Vec2::new(0.6, 0.8) / 256.0;
            for turn in [Vec2::X, Vec2::Y, Vec2::new(-2.0, -1.0)] {
                let slope = |uv| Paint::at(kind, uv + step).height - Paint::at(kind, uv).height;
                let (here, there) = (Paint::at(kind, uv), Paint::at(kind, uv + turn));
                let change = (here.height - there.height).abs();
                let color = (here.color - there.color).abs().max_element();
                off.push(change.max(color).max((slope(uv) - slope(uv + turn)).abs()));
            }
        }
        // Places are rounded to 2^-22 of a map by the turns; nothing rises by more than 200 in a map.
        let worst = off.iter().copied().fold(0.0, f32::max);
        assert!(worst < 2e-4, "{name}: {worst}");
    }
}

#[test]
fn colours_are_those_of_daylight() {
    for (kind, name) in SURFACES {
        for uv in points(300) {
            let paint = Paint::at(kind, uv);
            assert!(
                paint.color.min_element() > 0.0 && paint.color.max_element() < 0.75,
                "{name}"
            );
            assert!((0.0..=1.0).contains(&paint.height), "{name}");
        }
    }
}

#[test]
fn finishes_make_sense() {
    for (kind, name) in SURFACES {
        let finish = Finish::of(kind);
        let [width, length] = finish.size;
        assert!(
            width.is_power_of_two() && length.is_power_of_two(),
            "{name}"
        );
        assert!(width * length <= 256 * 512, "{name}");
        assert!(finish.length > 0.0 && finish.repeats > 0.0, "{name}");
        assert!(
            finish
                .thickness
                .is_none_or(|thickness| (0.01..0.5).contains(&thickness)),
            "{name}"
        );
        assert!((0.0..=1.0).contains(&finish.roughness), "{name}");
        assert!((0.0..=1.0).contains(&finish.reflectance), "{name}");
    }
}

#[test]
fn maps_make_good_shells() {
    for ((_, name), maps) in SURFACES.iter().zip(&*PAINTED) {
        let [width, length] = maps.size.map(|n| n as usize);
        assert_eq!(maps.color.len(), width * length, "{name}");
        let Some(height) = &maps.height else { continue };
        assert_eq!(height.len(), width * length, "{name}");
        // Most of the range is used, and the surface is not much below the middle of the shell on average.
        let (low, high) = (height.iter().min().unwrap(), height.iter().max().unwrap());
        assert!(high - low > 153 && *high > 215, "{name}: {low} to {high}");
        let mean = height.iter().map(|h| f32::from(*h)).sum::<f32>() / height.len() as f32;
        assert!(mean > 105.0, "{name}: {mean}");
        // No cliff is steeper than a shell in two pixels, the map's edges included: a seam would be one.
        let at = |x: usize, y: usize| height[y % length * width + x % width];
        for (x, y) in (0..width).flat_map(|x| (0..length).map(move |y| (x, y))) {
            let step = at(x, y)
                .abs_diff(at(x + 1, y))
                .max(at(x, y).abs_diff(at(x, y + 1)));
            assert!(step < 128, "{name}: {step} at ({x}, {y})");
        }
    }
}

#[test]
fn maps_are_the_same_every_time() {
    let small = [Surface::Rope, Surface::OcotilloFlower, Surface::PalmLeaf];
    for kind in small {
        assert_eq!(Maps::paint(kind), Maps::paint(kind));
    }
}

#[test]
fn the_stored_files_are_what_is_painted() {
    let dir = crate::lab::checkout().join("assets/plants");
    for ((_, name), maps) in SURFACES.iter().zip(&*PAINTED) {
        compare(&dir, name, maps, 2).unwrap();
    }
    let folder = std::fs::read_dir(&dir).unwrap();
    let sizes = folder.map(|file| file.unwrap().metadata().unwrap().len());
    assert!(sizes.sum::<u64>() < 1_000_000);
}

#[test]
fn a_file_that_is_not_what_is_painted_is_named() {
    let dir = crate::lab::checkout().join("assets/plants");
    let mut rope = Maps::paint(Surface::Rope);
    rope.color[64 * 3 + 5][1] ^= 0x80;
    let error = compare(&dir, "rope", &rope, 2).unwrap_err().to_string();
    assert!(error.contains("rope_color.png: pixel (5, 3)"), "{error}");
    let error = compare(&dir, "hemp", &rope, 2).unwrap_err().to_string();
    assert!(error.contains("hemp_color.png"), "{error}");
}

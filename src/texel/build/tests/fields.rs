//! Height fields, functions and images become volumes.

use bevy::math::{UVec2, UVec3, Vec3};

use super::super::super::parallel::tests::with_threads;
use super::*;

fn cubes(size: UVec3, topology: Topology) -> VolumeSettings {
    VolumeSettings {
        lengths: size.as_vec3(),
        topology,
        ..VolumeSettings::new(size)
    }
}

/// One smooth hill that tiles.
fn hill(side: u32) -> HeightField {
    let wave = |i: u32| 0.5 - 0.5 * ((i as f32 + 0.5) / side as f32 * core::f32::consts::TAU).cos();
    let pixels = (0..side * side).map(|i| (i % side, i / side));
    HeightField {
        colors: pixels
            .clone()
            .map(|(x, y)| [x as u8 * 4, y as u8 * 4, 128])
            .collect(),
        ..HeightField::new(
            UVec2::splat(side),
            pixels.map(|(x, y)| 0.1 + 0.8 * wave(x) * wave(y)).collect(),
            [0; 3],
        )
    }
}

#[test]
fn columns_of_a_height_field_are_as_high_as_it_says() {
    let field = hill(32);
    let settings = cubes(UVec3::new(32, 32, 64), Topology::Tiling);
    let Built { volume, report } = from_height_field(&field, &settings, &silent).unwrap();
    for (i, &height) in field.heights.iter().enumerate() {
        let (x, y) = (i as u32 % 32, i as u32 / 32);
        let count = (0..64).filter(|&z| volume.is_opaque(x, y, z)).count();
        assert!(
            (count as f32 - height * 64.0).abs() <= 0.5 + 1e-4,
            "({x}, {y})"
        );
        assert!((0..count as u32).all(|z| volume.is_opaque(x, y, z)));
        // The top has the colour of its pixel.
        assert_eq!(volume.color(x, y, count as u32 - 1)[..3], field.colors[i]);
    }
    assert_eq!(report.surface_voxels, 32 * 32);
    assert!(report.closing_voxels > 0 && report.topology.tiles());
}

#[test]
fn normals_of_a_height_field_are_those_of_its_slope() {
    let slope = 0.4;
    // A roof along u, of 32 voxels up to 6.4 high.
    let height = |x: u32| slope * (16.0 - (x as f32 + 0.5 - 16.0).abs()) / 16.0 + 0.1;
    let heights = (0..32 * 8).map(|i| height(i % 32)).collect();
    let field = HeightField::new(UVec2::new(32, 8), heights, [9; 3]);
    let settings = cubes(UVec3::new(32, 8, 16), Topology::Tiling);
    let volume = from_height_field(&field, &settings, &silent)
        .unwrap()
        .volume;
    let expected = Vec3::new(-slope, 0.0, 1.0).normalize();
    for x in (2..14).chain(18..30) {
        let top = (0..16).rev().find(|&z| volume.is_opaque(x, 4, z)).unwrap();
        let expected = if x < 16 {
            expected
        } else {
            expected * Vec3::new(-1.0, 1.0, 1.0)
        };
        // Half a byte in each component.
        assert!(volume.normal(x, 4, top).distance(expected) < 0.01, "{x}");
    }
}

#[test]
fn steps_of_a_height_field_are_closed_by_colours_between() {
    // One pillar, white on top, on black ground.
    let mut field = HeightField::new(UVec2::splat(8), vec![1.0 / 16.0; 64], [0; 3]);
    field.heights[3 * 8 + 3] = 11.0 / 16.0;
    field.colors[3 * 8 + 3] = [255; 3];
    let settings = cubes(UVec3::new(8, 8, 16), Topology::Tiling);
    let Built { volume, report } = from_height_field(&field, &settings, &silent).unwrap();
    assert_eq!(report.closing_voxels, 9);
    let grey: Vec<_> = (1..11).map(|z| volume.color(3, 3, z)[0]).collect();
    assert!(
        grey.is_sorted() && grey[0] < 100 && grey[9] == 255,
        "{grey:?}"
    );
}

#[test]
fn every_thread_count_gives_the_same_bytes() {
    let settings = cubes(UVec3::new(32, 32, 16), Topology::Tiling);
    let build = |threads| {
        with_threads(threads, || {
            let field = from_height_field(&hill(32), &settings, &silent);
            let function = from_implicit(|at| 1.5 - at.z, |at| at, &settings, &silent);
            let solid = ball(Vec3::new(15.0, 16.0, 8.0), 6.5, 9);
            let size = ShapeSettings::new(UVec3::splat(32));
            let shape = from_shape(&solid, &size, &silent);
            [field, function, shape].map(Result::unwrap)
        })
    };
    let alone = build(1);
    for threads in [2, 3, 8, 40] {
        assert_eq!(build(threads), alone, "{threads} threads");
    }
}

#[test]
fn an_implicit_ball_is_solid_with_its_own_normals() {
    let centre = Vec3::splat(0.5);
    let settings = cubes(UVec3::splat(32), Topology::Isolated);
    let function = |at: Vec3| 0.4 / at.distance(centre).max(1e-6);
    let volume = from_implicit(function, |at| at, &settings, &silent)
        .unwrap()
        .volume;
    for (x, y, z) in (0..32768).map(|i| (i % 32, i / 32 % 32, i / 1024)) {
        let out = (UVec3::new(x, y, z).as_vec3() + 0.5) / 32.0 - centre;
        assert_eq!(volume.is_opaque(x, y, z), out.length() < 0.4);
        if (0.3..0.4).contains(&out.length()) {
            // Differences over a voxel are off by its square over that of the radius, 1/24; half a byte.
            assert!(volume.normal(x, y, z).distance(out.normalize()) < 0.02);
        }
    }
}

#[test]
fn a_hypertexture_is_opaque_from_half_its_density_on() {
    let settings = cubes(UVec3::new(4, 4, 2), Topology::Tiling);
    let density = |at: Vec3| {
        (
            if at.x < 0.5 { 0.5 } else { 0.499 },
            Vec3::new(1.0, 0.0, at.z),
        )
    };
    let volume = from_hypertexture(density, &settings, &silent)
        .unwrap()
        .volume;
    for (x, y, z) in (0..32).map(|i| (i % 4, i / 4 % 4, i / 16)) {
        assert_eq!(volume.is_opaque(x, y, z), x < 2);
    }
    assert_eq!(volume.color(0, 0, 0)[0], 255);
    assert!(volume.color(0, 0, 0)[2] < volume.color(0, 0, 1)[2]);
}

#[test]
fn a_stack_of_images_is_taken_as_it_is() {
    let image = |z: u8| StackImage {
        size: [4, 4],
        pixels: (0..16)
            .map(|i| [i, z, 0, if i % 4 == 1 || i % 4 == 2 { 255 } else { 100 }])
            .collect(),
    };
    let settings = cubes(UVec3::splat(4), Topology::Tiling);
    let volume = from_images(&[0, 1, 2, 3].map(image), &settings, &silent)
        .unwrap()
        .volume;
    assert_eq!(volume.color(1, 2, 3), [9, 3, 0, 255]);
    assert_eq!(volume.color(3, 2, 3), [0; 4]);
    // A wall across u: its two sides look away from each other.
    assert_eq!(volume.normal(1, 1, 1).round(), Vec3::NEG_X);
    assert_eq!(volume.normal(2, 1, 1).round(), Vec3::X);
}

#[test]
fn progress_is_told_and_reaches_its_end() {
    use std::sync::Mutex;
    let told = Mutex::new(Vec::new());
    let settings = cubes(UVec3::new(32, 32, 16), Topology::Tiling);
    let tell = |step, share: f32| told.lock().unwrap().push((step, share));
    from_height_field(&hill(32), &settings, &tell).unwrap();
    let told = told.into_inner().unwrap();
    for step in super::super::super::progress::BuildStep::ALL {
        let last = told.iter().rev().find(|(at, _)| *at == step);
        assert_eq!(last, Some(&(step, 1.0)));
    }
    assert!(told.iter().all(|(_, share)| (0.0..=1.0).contains(share)));
}

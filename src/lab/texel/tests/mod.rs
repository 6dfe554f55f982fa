//! The march against searches and against itself.

mod criteria;

use bevy::math::Vec3;
use glam::{DVec2, DVec3, UVec3};
use proptest::prelude::*;

use super::*;
use crate::texel::build::{VolumeSettings, from_hypertexture};
use crate::texel::silent;

/// Cubes of voxels, of which those are opaque that `solid` says.
fn volume(size: UVec3, solid: impl Fn(UVec3) -> bool + Sync) -> ReferenceVolume {
    let settings = VolumeSettings {
        lengths: size.as_vec3() / size.x as f32,
        ..VolumeSettings::new(size)
    };
    let voxel = |at: Vec3| (at * size.as_vec3()).as_uvec3().min(size - 1);
    let density = |at: Vec3| (if solid(voxel(at)) { 1.0 } else { 0.0 }, at);
    from_hypertexture(density, &settings, &silent)
        .unwrap()
        .volume
}

/// Sparse, without order.
fn gravel() -> ReferenceVolume {
    volume(UVec3::new(16, 16, 8), |at| {
        (at.x * 73 + at.y * 151 + at.z * 283) % 19 == 3
    })
}

fn facet() -> ReferenceFacet {
    ReferenceFacet {
        positions: [
            DVec3::ZERO,
            DVec3::new(2.0, 0.2, 0.0),
            DVec3::new(0.3, 1.5, 0.2),
        ],
        heights: [DVec3::new(0.1, 0.0, 0.5); 3],
        uvs: [
            DVec2::new(0.2, 0.1),
            DVec2::new(2.1, 0.3),
            DVec2::new(0.4, 1.7),
        ],
    }
}

fn bent() -> ReferenceFacet {
    ReferenceFacet {
        heights: [
            DVec3::new(0.2, 0.0, 0.5),
            DVec3::new(-0.1, 0.1, 0.4),
            DVec3::new(0.0, -0.2, 0.6),
        ],
        ..facet()
    }
}

/// A ray to a point of a prism, from outside or inside.
fn rays() -> impl Strategy<Value = (DVec3, DVec3)> {
    let place = (0.02..0.98f64, 0.02..0.98f64, 0.02..0.98f64);
    let towards = prop::array::uniform3(-1.0..1.0f64)
        .prop_filter("length", |d| DVec3::from(*d).length() > 0.1);
    (place, towards, 0.0..3.0f64).prop_map(|((x, y, w), dir, back)| {
        let (b1, b2) = if x + y > 1.0 {
            (1.0 - x, 1.0 - y)
        } else {
            (x, y)
        };
        let f = facet();
        let at = |i: usize| f.positions[i] + w * f.heights[i];
        let target = at(0) * (1.0 - b1 - b2) + at(1) * b1 + at(2) * b2;
        let dir = DVec3::from(dir);
        (target - back * dir, dir)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn the_first_voxel_is_that_of_a_search_in_tiny_steps(
        origin in prop::array::uniform3(-1.0..2.0f64),
        dir in prop::array::uniform3(-1.0..1.0f64),
    ) {
        let volume = gravel();
        let (origin, dir) = (DVec3::from(origin), DVec3::from(dir));
        let hit = march_voxels(&volume, origin, dir, [0.0, 2.0]);
        let size = volume.size().as_dvec3();
        let opaque = |t: f64| voxels::look(&volume, ((origin + t * dir) * size).floor().as_i64vec3());
        let steps = 4000;
        let found = (0..=steps).map(|i| 2.0 * f64::from(i) / f64::from(steps)).find(|&t| opaque(t).is_some());
        match (hit, found) {
            // The search steps over corners of voxels, and finds the border a step late.
            (Some(hit), found) => {
                prop_assert!(found.is_none_or(|t| hit.t <= t + 1e-12), "{} {:?}", hit.t, found);
                let inside = opaque(hit.t + 1e-9).or(opaque(hit.t - 1e-9)).or(opaque(hit.t));
                prop_assert!(inside.is_some(), "{}", hit.t);
            }
            (None, found) => prop_assert!(found.is_none(), "{found:?}"),
        }
    }

    #[test]
    fn points_are_found_where_they_were_put(b1 in 0.0..1.0f64, b2 in 0.0..1.0f64, w in 0.0..1.0f64) {
        let (b1, b2) = if b1 + b2 > 1.0 { (1.0 - b1, 1.0 - b2) } else { (b1, b2) };
        for facet in [facet(), bent()] {
            let at = |i: usize| facet.positions[i] + w * facet.heights[i];
            let point = at(0) * (1.0 - b1 - b2) + at(1) * b1 + at(2) * b2;
            let found = ReferencePrism::new(facet).locate(point);
            let place = DVec3::new(b1, b2, w);
            prop_assert!(found.is_some_and(|found| found.distance(place) < 1e-9), "{found:?} {place}");
        }
    }

    #[test]
    fn steps_find_what_the_exact_march_finds((origin, dir) in rays()) {
        // Blocks of at least two voxels, so that a step finds each but at its edges.
        let volume = volume(UVec3::new(16, 16, 8), |at| (at.x / 4 * 5 + at.y / 4 * 3 + at.z / 2) % 7 == 2);
        let prism = ReferencePrism::new(facet());
        prop_assert!(prism.is_affine());
        let exact = prism.cast(&volume, origin, dir, [0.0, f64::INFINITY], ReferenceSteps::default());
        let range = prism.clip(origin, dir, [0.0, f64::INFINITY]).expect("it is aimed at the prism");
        let stepped = prism.cast_curved(&volume, origin, dir, range, ReferenceSteps { per_voxel: 64.0 });
        match (exact, stepped) {
            (Some(exact), Some(stepped)) => {
                // Steps may only miss the edge of a block, and be late by what lies behind it.
                prop_assert!(stepped.t >= exact.t - 1e-9);
                if stepped.voxel == exact.voxel {
                    prop_assert!((stepped.t - exact.t) * dir.length() < 1e-9 , "{} {}", stepped.t, exact.t);
                }
            }
            (None, stepped) => prop_assert!(stepped.is_none(), "{stepped:?}"),
            (Some(exact), None) => {
                // A corner cut by less than a step.
                let step = prism.least_voxel(&volume) / 64.0 / dir.length();
                let later = prism.to_texture(origin + (exact.t + 2.0 * step) * dir);
                let cell = later.map(|uvw| (uvw * volume.size().as_dvec3()).floor().as_i64vec3());
                prop_assert!(cell.and_then(|cell| voxels::look(&volume, cell)).is_none());
            }
        }
    }
}

#[test]
fn neighbouring_facets_leave_no_crack() {
    // A full volume on a square of two facets: every ray from above hits.
    let volume = volume(UVec3::new(4, 4, 2), |_| true);
    let corner = |x: f64, y: f64| {
        (
            DVec3::new(x, y, 0.0),
            DVec3::new(0.1 * x - 0.05, 0.1 * y, 0.5),
            DVec2::new(x, y),
        )
    };
    let facet = |corners: [(f64, f64); 3]| {
        let corners = corners.map(|(x, y)| corner(x, y));
        ReferenceFacet {
            positions: corners.map(|corner| corner.0),
            heights: corners.map(|corner| corner.1),
            uvs: corners.map(|corner| corner.2),
        }
    };
    let facets = [
        facet([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]),
        facet([(0.0, 0.0), (1.0, 1.0), (0.0, 1.0)]),
    ];
    let texels = ReferenceTexels::new(&volume, &facets, ReferenceSteps::default());
    for i in 0..400 {
        let (x, y) = (
            0.1 + 0.8 * f64::from(i % 20) / 19.0,
            0.1 + 0.8 * f64::from(i / 20) / 19.0,
        );
        let origin = DVec3::new(x, y, 2.0);
        let hit = texels.cast(origin, DVec3::new(0.05, 0.02, -1.0), 0.0);
        assert!(
            hit.is_some_and(|hit| (hit.t - 1.5).abs() < 1e-9),
            "{origin}: {hit:?}"
        );
    }
}

#[test]
fn normals_are_those_of_the_mapped_shape() {
    // The upper half of the volume is empty; its normals look up along w, whatever the shear along the surface.
    let mut flat = facet();
    flat.positions[2].z = 0.0;
    let volume = volume(UVec3::new(16, 16, 8), |at| at.z < 4);
    let texels = ReferenceTexels::new(&volume, &[flat], ReferenceSteps::default());
    let hit = texels
        .cast(DVec3::new(0.7, 0.6, 3.0), DVec3::NEG_Z, 0.0)
        .unwrap();
    assert_eq!(hit.voxel.z, 3);
    assert!((hit.t - 2.75).abs() < 1e-12, "{}", hit.t);
    // Bytes of normals: half a step of 2/255.
    assert!(hit.normal.distance(DVec3::Z) < 0.01, "{}", hit.normal);
}

#[test]
fn rays_that_start_inside_or_miss_say_so() {
    let volume = volume(UVec3::new(4, 4, 4), |_| true);
    let texels = ReferenceTexels::new(&volume, &[facet()], ReferenceSteps::default());
    let inside = facet().positions[0] + DVec3::new(0.6, 0.5, 0.2);
    assert_eq!(
        texels.cast(inside, DVec3::X, 0.0).map(|hit| hit.t),
        Some(0.0)
    );
    assert!(texels.cast(inside, DVec3::ZERO, 0.0).is_none());
    assert!(
        texels
            .cast(DVec3::new(5.0, 5.0, 5.0), DVec3::X, 0.0)
            .is_none()
    );
    let behind = texels.cast(inside + DVec3::X * 9.0, DVec3::X, 0.0);
    assert!(behind.is_none());
}

#[test]
fn a_ray_through_a_prism_that_has_no_height_at_a_corner_comes_to_an_end() {
    let volume = volume(UVec3::new(4, 4, 4), |_| true);
    let mut facet = facet();
    facet.heights[0] = DVec3::ZERO;
    let prism = ReferencePrism::new(facet);
    let (origin, dir) = (DVec3::new(0.4, 0.3, 5.0), DVec3::NEG_Z);
    let range = [0.0, f64::INFINITY];
    assert!(
        prism
            .cast(&volume, origin, dir, range, ReferenceSteps::default())
            .is_none()
    );
}

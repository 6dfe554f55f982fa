//! Shapes of which the inside is known, and volumes built from them.

mod fields;
mod filling;
mod refused;

use bevy::math::{UVec3, Vec3};

use super::super::progress::silent;
use super::super::volume::ReferenceVolume;
use super::*;

/// A box of 12 triangles, counterclockwise seen from outside.
fn cuboid(min: Vec3, max: Vec3) -> Shape {
    let corner = |i: u32| {
        let take = |bit: u32, low, high| if i & bit == 0 { low } else { high };
        Vec3::new(
            take(1, min.x, max.x),
            take(2, min.y, max.y),
            take(4, min.z, max.z),
        )
    };
    Shape {
        positions: (0..8).map(corner).collect(),
        triangles: vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ],
        ..Shape::default()
    }
}

/// A ball of `2·n²` quads, each in two triangles, with normals.
fn ball(centre: Vec3, radius: f32, n: u32) -> Shape {
    let mut shape = Shape::default();
    let vertex = |ring: u32, sector: u32| {
        let polar = ring as f32 / n as f32 * core::f32::consts::PI;
        let turn = (sector % (2 * n)) as f32 / n as f32 * core::f32::consts::PI;
        // Poles are one place for all sectors.
        let across = if ring == 0 || ring == n {
            0.0
        } else {
            polar.sin()
        };
        Vec3::new(across * turn.cos(), across * turn.sin(), polar.cos())
    };
    for ring in 0..=n {
        for sector in 0..2 * n {
            shape.positions.push(centre + radius * vertex(ring, sector));
            shape.normals.push(vertex(ring, sector));
        }
    }
    let index = |ring: u32, sector: u32| ring * 2 * n + sector % (2 * n);
    for ring in 0..n {
        for sector in 0..2 * n {
            let [a, b] = [index(ring, sector), index(ring, sector + 1)];
            let [c, d] = [index(ring + 1, sector), index(ring + 1, sector + 1)];
            shape.triangles.extend([[a, c, b], [b, c, d]]);
        }
    }
    shape
}

/// Whether the centre of every voxel for which `is_inside` is more than half a voxel's diagonal sure is as it says.
/// `distance` is that to the surface, negative inside, in voxels.
fn agrees(volume: &ReferenceVolume, distance: impl Fn(Vec3) -> f32) -> Result<(), String> {
    // A surface voxel holds a point of the surface, half a diagonal from its centre at most.
    let half_diagonal = 3f32.sqrt() / 2.0 + 1e-3;
    let size = volume.size();
    for z in 0..size.z {
        for y in 0..size.y {
            for x in 0..size.x {
                let distance = distance(UVec3::new(x, y, z).as_vec3() + 0.5);
                let opaque = volume.is_opaque(x, y, z);
                if opaque && distance > half_diagonal || !opaque && distance < -1e-3 {
                    return Err(format!("({x}, {y}, {z}): {opaque} at {distance}"));
                }
            }
        }
    }
    Ok(())
}

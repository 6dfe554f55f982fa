//! The surfaces that are covered.

use core::f32::consts::{PI, TAU};

use crate::plants::Dice;
use crate::texel::ATTRIBUTE_HEIGHT_VECTOR;
use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology, VertexAttributeValues};
use bevy::prelude::*;

/// A mesh of vertices in rows and columns, of which each square carries a texel.
pub(super) fn lattice(columns: u32, rows: u32, vertex: impl Fn(u32, u32) -> (Vec3, Vec3)) -> Mesh {
    let (mut positions, mut normals, mut uvs) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..=rows {
        for column in 0..=columns {
            let (position, normal) = vertex(column, row);
            positions.push(position);
            normals.push(normal);
            uvs.push(Vec2::new(column as f32, row as f32));
        }
    }
    let mut indices = Vec::new();
    for row in 0..rows {
        for column in 0..columns {
            let a = row * (columns + 1) + column;
            let b = a + columns + 1;
            indices.extend([a, a + 1, b + 1, a, b + 1, b]);
        }
    }
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, uvs)
    .with_inserted_indices(Indices::U32(indices))
}

/// A place on the ground: columns go to the right, rows away.
fn ground(columns: u32, rows: u32, size: Vec2, column: u32, row: u32) -> Vec3 {
    Vec3::new(
        (column as f32 / columns as f32 - 0.5) * size.x,
        0.0,
        (0.5 - row as f32 / rows as f32) * size.y,
    )
}

/// A flat rectangle on the ground.
pub fn grid(columns: u32, rows: u32, size: Vec2) -> Mesh {
    lattice(columns, rows, |column, row| {
        (ground(columns, rows, size, column, row), Vec3::Y)
    })
}

/// The same with vertices that are moved at random, but for its border, which stays on the ground.
pub fn jittered(columns: u32, rows: u32, size: Vec2) -> Mesh {
    let mut dice = Dice::new(7);
    let jitter: Vec<Vec3> = (0..(columns + 1) * (rows + 1))
        .map(|_| {
            Vec3::new(
                dice.jitter(0.12),
                dice.between(0.0, 0.45),
                dice.jitter(0.12),
            )
        })
        .collect();
    lattice(columns, rows, |column, row| {
        let mut moved = jitter[(row * (columns + 1) + column) as usize];
        if column % columns == 0 || row % rows == 0 {
            moved.y = 0.0;
        }
        (ground(columns, rows, size, column, row) + moved, Vec3::Y)
    })
}

/// A sphere of 192 triangles: 12 by 8 squares of two, at the poles too.
pub fn sphere(radius: f32) -> Mesh {
    lattice(12, 8, |column, row| {
        let turn = column as f32 / 12.0 * TAU;
        // The poles are as good as points, and yet triangles.
        let rise = (row as f32 / 8.0).clamp(0.01, 0.99) * PI;
        let out = Vec3::new(
            rise.sin() * turn.sin(),
            -rise.cos(),
            rise.sin() * turn.cos(),
        );
        (out * radius, out)
    })
}

/// A hill in a meadow, a texel a metre.
pub fn hill(squares: u32, size: f32) -> Mesh {
    let height = |at: Vec2| {
        let waves = 0.12 * (at.x * 0.9).sin() * (at.y * 0.7).cos();
        // Nowhere below the ground that it lies on.
        0.02 + (1.1 * (-at.length_squared() / 8.0).exp() + waves).max(0.0)
    };
    lattice(squares, squares, |column, row| {
        let at = ground(squares, squares, Vec2::splat(size), column, row);
        let rise = |x: f32, z: f32| height(Vec2::new(at.x + x, at.z + z));
        let slope = Vec2::new(
            rise(0.01, 0.0) - rise(-0.01, 0.0),
            rise(0.0, 0.01) - rise(0.0, -0.01),
        ) / 0.02;
        (
            at.with_y(rise(0.0, 0.0)),
            Vec3::new(-slope.x, 1.0, -slope.y).normalize(),
        )
    })
}

/// A mesh with height vectors of its own.
pub fn with_heights(mut mesh: Mesh, height: impl Fn(Vec3) -> Vec3) -> Mesh {
    if let Some(VertexAttributeValues::Float32x3(positions)) =
        mesh.attribute(Mesh::ATTRIBUTE_POSITION)
    {
        let heights: Vec<Vec3> = positions.iter().map(|&at| height(at.into())).collect();
        mesh.insert_attribute(ATTRIBUTE_HEIGHT_VECTOR, heights);
    }
    mesh
}

/// A flag in the wind at a time, in seconds: 8 by 5 texels of eight triangles each, held at its left side.
pub fn flag(time: f32) -> Mesh {
    const SHARE: u32 = 2;
    let place = |x: f32, y: f32| {
        let wave = (5.0 * x - 6.0 * time + 0.8 * y).sin() * 0.16 * x;
        Vec3::new(x - 0.8, y - 0.5, wave)
    };
    let mesh = lattice(8 * SHARE, 5 * SHARE, |column, row| {
        let [x, y] = [column, row].map(|count| (count as f32 / SHARE as f32) * 0.2);
        let along = place(x + 0.01, y) - place(x - 0.01, y);
        let up = place(x, y + 0.01) - place(x, y - 0.01);
        (place(x, y), along.cross(up).normalize())
    });
    smaller(mesh, SHARE)
}

/// Where the back of an animal is: so far along it, in metres, and turned so far from its top to the front.
pub(super) fn on_back(along: f32, turn: f32) -> Vec3 {
    let radius = 0.7 * (1.0 - (along / 1.35).powi(4)).max(0.0).sqrt();
    Vec3::new(along, radius * turn.cos(), radius * turn.sin())
}

/// The back of an animal that lies on the ground: 6 by 5 texels of 32 triangles each.
pub fn back() -> Mesh {
    const SHARE: u32 = 4;
    const COLUMNS: u32 = 6 * SHARE;
    const ROWS: u32 = 5 * SHARE;
    let mesh = lattice(COLUMNS, ROWS, |column, row| {
        let x = (column as f32 / COLUMNS as f32 - 0.5) * 2.68;
        let turn = (0.5 - row as f32 / ROWS as f32) * PI;
        let along = on_back(x + 0.01, turn) - on_back(x - 0.01, turn);
        let over = on_back(x, turn - 0.01) - on_back(x, turn + 0.01);
        (on_back(x, turn), along.cross(over).normalize())
    });
    smaller(mesh, SHARE)
}

/// A mesh of which so many squares in a row share a texel.
fn smaller(mut mesh: Mesh, squares: u32) -> Mesh {
    if let Some(VertexAttributeValues::Float32x2(uvs)) = mesh.attribute_mut(Mesh::ATTRIBUTE_UV_0) {
        for uv in uvs.as_flattened_mut() {
            *uv /= squares as f32;
        }
    }
    mesh
}

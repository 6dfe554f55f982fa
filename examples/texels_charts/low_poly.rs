//! Meshes of few triangles, instanced by Bevy: the surface of the volume's voxels, its vertices merged in the cells of a
//! coarser lattice (J. Rossignac and P. Borrel, *Multi-resolution 3D approximations for rendering complex scenes*, 1993).

use std::collections::HashMap;

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy_verdure::texel::color::srgb_to_linear;
use bevy_verdure::texel::{ReferenceVolume, Topology};

use super::field::Field;

/// What is merged in a cell: sums.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// From the middle of the cell, in cells.
    offset: Vec3,
    normal: Vec3,
    color: Vec3,
    count: f32,
}

/// A vertex in (u, v, w).
struct Vertex {
    place: Vec3,
    normal: Vec3,
    color: Vec3,
}

/// A mesh in (u, v, w).
struct Merged {
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
}

/// Merges the surface of a volume in `cells` cells along u and v, and cubes as far as may be along w.
fn merge(volume: &ReferenceVolume, cells: u32) -> Merged {
    let size = volume.size();
    let lengths = volume.lengths();
    let upward = (cells as f32 * lengths.z / lengths.x).ceil().max(1.0);
    let lattice = Vec3::new(cells as f32, cells as f32, upward) / size.as_vec3();
    // Cells on a border of a tiling volume are those of the next copy, so that copies meet.
    let is_tiling = volume.topology() == Topology::Tiling;
    let shared = |cell: IVec3| {
        let round = cells as i32;
        if is_tiling {
            IVec3::new(cell.x % round, cell.y % round, cell.z)
        } else {
            cell
        }
    };
    let mut sums: HashMap<IVec3, Sums> = HashMap::new();
    let (mut indices, mut vertices) = (HashMap::new(), Vec::new());
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let signed = size.as_ivec3();
    let is_opaque = |mut at: IVec3| {
        if is_tiling {
            let round = at.rem_euclid(signed);
            at = round.with_z(at.z);
        }
        at.cmpge(IVec3::ZERO).all()
            && at.cmplt(signed).all()
            && volume.is_opaque(at.x as u32, at.y as u32, at.z as u32)
    };
    for index in 0..size.element_product() as i32 {
        let at = IVec3::new(
            index % signed.x,
            index / signed.x % signed.y,
            index / (signed.x * signed.y),
        );
        if !is_opaque(at) {
            continue;
        }
        let voxel = at.as_uvec3();
        let [r, g, b, _] = volume.color(voxel.x, voxel.y, voxel.z);
        let color = Vec3::from([r, g, b].map(|byte| srgb_to_linear(f32::from(byte) / 255.0)));
        let normal = volume.normal(voxel.x, voxel.y, voxel.z);
        for (axis, sign) in (0..3).flat_map(|axis| [(axis, -1), (axis, 1)]) {
            let mut out = IVec3::ZERO;
            out[axis] = sign;
            // The bottom stands on the ground.
            if is_opaque(at + out) || (at + out).z < 0 {
                continue;
            }
            let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| {
                let mut corner = at;
                corner[axis] += i32::from(sign > 0);
                corner[first] += i;
                corner[second] += j;
                let place = corner.as_vec3() * lattice;
                let cell = place.round().as_ivec3();
                let sums = sums.entry(shared(cell)).or_default();
                sums.offset += place - cell.as_vec3();
                sums.normal += normal;
                sums.color += color;
                sums.count += 1.0;
                *indices.entry(cell).or_insert_with(|| {
                    vertices.push(cell);
                    vertices.len() as u32 - 1
                })
            });
            let [a, b, c, d] = corners;
            let quads = if sign > 0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, c, b], [a, d, c]]
            };
            triangles.extend(quads);
        }
    }
    // Each once, however its corners are counted, and none without area.
    let mut seen = std::collections::HashSet::new();
    triangles.retain(|triangle| {
        let [a, b, c] = *triangle;
        let mut sorted = *triangle;
        sorted.sort_unstable();
        a != b && b != c && a != c && seen.insert(sorted)
    });
    let vertices = vertices.into_iter().map(|cell| {
        let sums = &sums[&shared(cell)];
        Vertex {
            place: (cell.as_vec3() + sums.offset / sums.count) / (lattice * size.as_vec3()),
            normal: sums.normal,
            color: sums.color / sums.count,
        }
    });
    Merged {
        vertices: vertices.collect(),
        triangles,
    }
}

impl Field {
    /// Covers the field with meshes of `cells` cells along each side; the number of triangles of each.
    pub fn add_low_poly(&mut self, cells: u32) -> (Vec<Entity>, usize) {
        let merged = merge(&self.volume, cells);
        let [side, height] = self.texel.to_array();
        let lengths = self.volume.lengths();
        let place = |at: Vec3| Vec3::new(at.x * side, at.z * height, -at.y * side);
        let (mut positions, mut normals, mut colors) = (Vec::new(), Vec::new(), Vec::new());
        for vertex in &merged.vertices {
            positions.push(place(vertex.place));
            // By metres of the volume's box, as gradients are.
            let n = vertex.normal * lengths;
            let normal = Vec3::new(n.x / side, n.z / height, -n.y / side);
            normals.push(normal.normalize_or(Vec3::Y));
            colors.push(vertex.color.extend(1.0));
        }
        let triangles = merged.triangles.len();
        let mesh = Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::RENDER_WORLD,
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U32(merged.triangles.into_flattened()));
        let world = self.studio.world();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let look = StandardMaterial {
            perceptual_roughness: 0.8,
            reflectance: 0.3,
            cull_mode: None,
            ..default()
        };
        let look = world.resource_mut::<Assets<StandardMaterial>>().add(look);
        let (count, half) = (self.squares, 0.5 * self.squares as f32);
        let squares = (0..count).flat_map(|row| (0..count).map(move |column| (row, column)));
        let instances = squares
            .map(|(row, column)| {
                let (x, z) = (column as f32 - half, half - row as f32);
                let place = Transform::from_xyz(x * side, 0.0, z * side);
                world
                    .spawn((Mesh3d(mesh.clone()), MeshMaterial3d(look.clone()), place))
                    .id()
            })
            .collect();
        (instances, triangles)
    }
}

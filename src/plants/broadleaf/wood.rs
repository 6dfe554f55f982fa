//! Trunk and limbs of a broadleaf, and how triangles become a mesh.

use core::f32::consts::TAU;

use bevy::asset::RenderAssetUsages;
use bevy::math::Vec3;
use bevy::mesh::{Indices, Mesh, PrimitiveTopology};
use bevy::platform::collections::HashMap;

use super::Broadleaf;
use crate::plants::dice::Dice;
use crate::plants::shape::{GOLDEN_ANGLE, heading, mix, raised, turned};

/// Sides of trunk and limbs.
const SIDES: u32 = 5;
/// Triangles of a piece of them.
const PIECE: u32 = 2 * SIDES;

/// Triangles in the making.
#[derive(Default)]
pub(super) struct Triangles {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    colors: Vec<[f32; 4]>,
}

impl Triangles {
    pub fn push(&mut self, positions: [Vec3; 3], normals: [Vec3; 3], color: Vec3) {
        self.positions.extend(positions);
        self.normals.extend(normals);
        self.colors.extend([color.extend(1.0).to_array(); 3]);
    }

    pub fn count(&self) -> u32 {
        self.positions.len() as u32 / 3
    }

    /// Vertices that triangles share are there once.
    pub fn mesh(self) -> Mesh {
        let mut known = HashMap::new();
        let (mut positions, mut normals, mut colors) = (Vec::new(), Vec::new(), Vec::new());
        let vertices = self.positions.iter().zip(&self.normals).zip(&self.colors);
        let indices = vertices.map(|((position, normal), color)| {
            let bits = |v: &Vec3| v.to_array().map(f32::to_bits);
            let vertex = (bits(position), bits(normal), color.map(f32::to_bits));
            *known.entry(vertex).or_insert_with(|| {
                positions.push(*position);
                normals.push(*normal);
                colors.push(*color);
                positions.len() as u32 - 1
            })
        });
        let indices: Vec<u32> = indices.collect();
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U32(indices))
    }
}

/// A limb: where it passes, from the trunk outwards, and how thick it is there.
pub(super) struct Limb {
    pub path: Vec<(Vec3, f32)>,
}

impl Limb {
    /// Place and thickness, in metres, at `t` of 0..1 along the limb.
    pub fn at(&self, t: f32) -> (Vec3, f32) {
        let last = self.path.len() - 1;
        let along = t.clamp(0.0, 1.0) * last as f32;
        let piece = (along as usize).min(last.saturating_sub(1));
        let ((from, thick), (to, thin)) = (self.path[piece], self.path[(piece + 1).min(last)]);
        let t = along - piece as f32;
        (from.lerp(to, t), mix(thick, thin, t))
    }
}

/// Trunk and limbs, as a mesh and as paths that the crown grows from.
pub(super) fn solid(tree: &Broadleaf, dice: &mut Dice) -> (Mesh, Vec<Limb>) {
    let pieces = tree.solid_triangles / PIECE;
    // A fifth of the pieces is trunk; limbs have three or more each.
    let trunk_pieces = (pieces / 5).clamp(2, 40);
    let limb_count = ((pieces - trunk_pieces) / 3).clamp(2, 9);
    let mut left = pieces - trunk_pieces;
    let radius = 0.022 * tree.height;
    let mut tip = Vec3::ZERO;
    let mut direction = raised(heading(dice.angle()), 1.5);
    let mut trunk = vec![(tip, radius * 1.35)];
    for j in 1..=trunk_pieces {
        let t = j as f32 / trunk_pieces as f32;
        direction = turned(direction, raised(heading(dice.angle()), 1.3), 0.08);
        tip += direction * (0.62 * tree.height / trunk_pieces as f32);
        trunk.push((tip, radius * mix(1.0, 0.35, t)));
    }
    let trunk = Limb { path: trunk };
    let mut limbs = Vec::new();
    let first = dice.angle();
    for i in 0..limb_count {
        let own = left / (limb_count - i);
        left -= own;
        let t = mix(0.42, 0.98, i as f32 / limb_count as f32) + dice.jitter(0.02);
        let (mut place, thick) = trunk.at(t);
        let outward = heading(first + GOLDEN_ANGLE * i as f32 + dice.jitter(0.2));
        let mut direction = raised(outward, mix(0.45, 1.1, t) + dice.jitter(0.1));
        let length = 0.36 * tree.width * mix(1.15, 0.75, t) * dice.between(0.9, 1.1);
        let start = thick * 0.62;
        let mut path = vec![(place, start)];
        for j in 1..=own {
            direction = turned(direction, Vec3::Y, dice.between(0.0, 0.2));
            place += direction * (length / own as f32);
            path.push((place, start * mix(1.0, 0.25, j as f32 / own as f32)));
        }
        limbs.push(Limb { path });
    }
    let mut triangles = Triangles::default();
    for limb in [&trunk].into_iter().chain(&limbs) {
        tube(&mut triangles, limb, u32::MAX);
    }
    // What is left over, or is more than pieces make up for, goes to a stub inside the foot.
    while triangles.count() < tree.solid_triangles {
        let missing = tree.solid_triangles - triangles.count();
        let foot = Limb {
            path: vec![(Vec3::ZERO, radius), (Vec3::Y * radius, radius * 0.5)],
        };
        tube(&mut triangles, &foot, missing);
    }
    limbs.push(trunk);
    (triangles.mesh(), limbs)
}

/// A limb as a tube with smooth normals, of `most` triangles at most.
fn tube(triangles: &mut Triangles, limb: &Limb, most: u32) {
    let bark = Vec3::new(0.16, 0.11, 0.075);
    let mut made = 0;
    for (j, pair) in limb.path.windows(2).enumerate() {
        let [(from, thick), (to, thin)] = [pair[0], pair[1]];
        // Rings turn with the limb, in its own axes of the mean direction, so that pieces meet.
        let mean = |k: usize| {
            let before = limb.path[k.saturating_sub(1)].0;
            let after = limb.path[(k + 1).min(limb.path.len() - 1)].0;
            (after - before).normalize_or(Vec3::Y)
        };
        let ring = |axis: Vec3, side: u32| {
            let right = axis.cross(Vec3::Z).normalize_or(Vec3::X);
            let (sin, cos) = (TAU * (side % SIDES) as f32 / SIDES as f32).sin_cos();
            right * cos + axis.cross(right) * sin
        };
        let (lower, upper) = (mean(j), mean(j + 1));
        for side in 0..SIDES {
            let n = [
                ring(lower, side),
                ring(lower, side + 1),
                ring(upper, side + 1),
                ring(upper, side),
            ];
            let p = [
                from + n[0] * thick,
                from + n[1] * thick,
                to + n[2] * thin,
                to + n[3] * thin,
            ];
            for corners in [[0, 2, 1], [0, 3, 2]] {
                if made < most {
                    triangles.push(corners.map(|i| p[i]), corners.map(|i| n[i]), bark);
                    made += 1;
                }
            }
        }
    }
}

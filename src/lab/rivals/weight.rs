//! What geometry weighs.

use core::ops::AddAssign;

use crate::frusta::MeshParts;
use crate::skeleton::Skeleton;

/// Bytes of a joint that moves (`JointRecord`), and of a joint of a skeleton (`ShapeRecord`).
const JOINT: usize = 60 + 24;
/// Bytes of the eight corners of a segment's bounds, a number each, and indices of its twelve triangles.
const BOUNDS: usize = 8 * 4;
const BOUNDS_INDICES: usize = 36;
/// Bytes of a vertex: position, normal and texture coordinates.
const VERTEX: usize = 12 + 12 + 8;
/// Bytes of an index.
const INDEX: usize = 4;

/// Bytes that a planting's geometry takes on the device. What stands several times counts once, as it is stored once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Weight {
    /// Frusta: joints and shapes. Polygons: vertices and indices.
    pub geometry: usize,
    /// Frusta with relief: the maps, with mip levels. Polygons have it in their vertices.
    pub relief_maps: usize,
    /// Frusta: the numbers and indices that bounds are drawn by, the same for all plants of as many joints and apart
    /// from their shape.
    pub bounds: usize,
    /// Triangles that are drawn, of all places.
    pub triangles: usize,
}

impl Weight {
    /// What describes the shape: geometry and relief maps.
    pub fn shape(&self) -> usize {
        self.geometry + self.relief_maps
    }

    /// That of a skeleton's frusta, drawn at so many places.
    pub(super) fn of_frusta(skeleton: &Skeleton, places: usize) -> Self {
        let joints = skeleton.len();
        let index = if joints * 8 <= usize::from(u16::MAX) {
            2
        } else {
            4
        };
        Self {
            geometry: joints * JOINT,
            relief_maps: 0,
            bounds: joints * (BOUNDS + BOUNDS_INDICES * index),
            triangles: 12 * skeleton.segment_count() * places,
        }
    }

    /// That of a mesh, drawn at so many places.
    pub(super) fn of_mesh(mesh: &MeshParts, places: usize) -> Self {
        Self {
            geometry: mesh.positions.len() * VERTEX + mesh.indices.len() * INDEX,
            triangles: mesh.indices.len() / 3 * places,
            ..Self::default()
        }
    }

    /// Roughly that of polygons, before they are made: half a vertex a triangle.
    pub(super) fn expected_of_mesh(segments: usize, subdivisions: u32) -> usize {
        16usize
            .saturating_mul(segments)
            .saturating_mul(1usize.checked_shl(2 * subdivisions).unwrap_or(usize::MAX))
            .saturating_mul(VERTEX / 2 + 3 * INDEX)
    }
}

impl AddAssign for Weight {
    fn add_assign(&mut self, other: Self) {
        self.geometry += other.geometry;
        self.relief_maps += other.relief_maps;
        self.bounds += other.bounds;
        self.triangles += other.triangles;
    }
}

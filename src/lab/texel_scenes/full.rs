//! What texels stand for: the triangles of a pattern, and where each instance of them goes.

use std::collections::BTreeMap;

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;

use super::Pattern;
use crate::texel::build::Shape;
use crate::texel::facet::Facet;

/// The triangles of a pattern in texture space, coloured at their vertices; none of one that has no triangles.
pub fn full_mesh(pattern: Pattern) -> Option<Mesh> {
    let (shape, bounds) = pattern.shape(pattern.size())?;
    let [min, max] = bounds.unwrap_or_else(|| around(&shape, pattern));
    let positions: Vec<Vec3> = shape
        .positions
        .iter()
        .map(|&at| (at - min) / (max - min))
        .collect();
    let colors: Vec<[f32; 4]> = shape.colors.iter().map(|color| color.to_array()).collect();
    let indices = shape.triangles.as_flattened().to_vec();
    let mesh = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
    .with_inserted_indices(Indices::U32(indices));
    Some(mesh.with_computed_normals())
}

/// The box that [`ShapeSettings`](crate::texel::build::ShapeSettings) take where none is given: that of the shape, with a
/// voxel to spare along u and v.
fn around(shape: &Shape, pattern: Pattern) -> [Vec3; 2] {
    let (min, max) = shape
        .positions
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(min, max), &at| {
            (min.min(at), max.max(at))
        });
    let spare = ((max - min) / (pattern.size().as_vec3() - 2.0)).with_z(0.0);
    [min - spare, max + spare]
}

/// Where texture space goes on each square of a surface, as nearly as turning and stretching can: from facets in any one
/// space.
pub fn instances(facets: &[Facet]) -> Vec<Transform> {
    let mut squares: BTreeMap<[i32; 2], Vec<Corner>> = BTreeMap::new();
    for facet in facets {
        let middle = (facet.uvs[0] + facet.uvs[1] + facet.uvs[2]) / 3.0;
        let square = middle.floor();
        let corners = squares.entry(square.as_ivec2().to_array()).or_default();
        for i in 0..3 {
            let side = facet.uvs[i] - square - 0.5;
            // The two facets of a square share corners.
            if corners.iter().all(|corner| corner.side != side) {
                corners.push(Corner {
                    side,
                    position: facet.positions[i],
                    height: facet.heights[i],
                });
            }
        }
    }
    squares.values().map(|corners| place(corners)).collect()
}

/// A corner of a square.
struct Corner {
    /// Where it is on the square: half a side from its centre along u and v.
    side: Vec2,
    position: Vec3,
    height: Vec3,
}

/// The least squares of an affine map, straightened.
fn place(corners: &[Corner]) -> Transform {
    let share = 1.0 / corners.len() as f32;
    let sum = |what: &dyn Fn(&Corner) -> Vec3| corners.iter().map(what).sum::<Vec3>() * share;
    let centre = sum(&|corner| corner.position);
    let height = sum(&|corner| corner.height);
    // Of one square the corners are a quarter from its centre squared, along each axis.
    let u = sum(&|corner| (corner.position - centre) * corner.side.x) * 4.0;
    let v = sum(&|corner| (corner.position - centre) * corner.side.y) * 4.0;
    let across = u.normalize_or(Vec3::X);
    let up = (height - across * across.dot(height)).normalize_or(Vec3::Z);
    let turn = Mat3::from_cols(across, up.cross(across), up);
    let scale = Vec3::new(u.length(), v.length(), height.length());
    let rotation = Quat::from_mat3(&turn);
    Transform {
        translation: centre - rotation * (scale * Vec3::new(0.5, 0.5, 0.0)),
        rotation,
        scale,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_s_instance_fills_its_prism() {
        let [a, b, c, d] = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        let at = |uv: Vec2| Vec3::new(3.0 + 2.0 * uv.x, 1.0, -0.5 * uv.y);
        let facets = [[a, b, c], [a, c, d]].map(|uvs| Facet {
            positions: uvs.map(at),
            heights: [Vec3::Y * 0.25; 3],
            uvs: uvs.map(|uv| uv + Vec2::new(-2.0, 5.0)),
        });
        let places = instances(&facets);
        assert_eq!(places.len(), 1);
        for uvw in [
            Vec3::ZERO,
            Vec3::X,
            Vec3::Y,
            Vec3::Z,
            Vec3::new(0.3, 0.8, 0.4),
        ] {
            let expected = at(uvw.truncate()) + Vec3::Y * 0.25 * uvw.z;
            let found = places[0].transform_point(uvw);
            assert!(found.distance(expected) < 1e-5, "{found} {expected}");
        }
    }

    #[test]
    fn full_meshes_fill_texture_space_and_have_the_paper_s_triangles() {
        for (pattern, triangles) in [
            (Pattern::Pear, 992),
            (Pattern::Bush, 3500),
            (Pattern::Noise, 2 * 255 * 255),
        ] {
            let mesh = full_mesh(pattern).expect("it has triangles");
            assert_eq!(
                mesh.indices().map(|indices| indices.len() / 3),
                Some(triangles)
            );
            let positions = mesh
                .attribute(Mesh::ATTRIBUTE_POSITION)
                .and_then(|at| at.as_float3());
            let positions = positions.expect("meshes have positions");
            let all = positions.as_flattened();
            assert!(
                all.iter().all(|x| (-1e-5..1.00001).contains(x)),
                "{pattern:?}"
            );
        }
        assert!(full_mesh(Pattern::Fur).is_none());
    }
}

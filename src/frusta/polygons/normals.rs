//! Smooth normals: of the triangles round a point, weighted by the angle that each has there (Thürmer and Wüthrich,
//! "Computing Vertex Normals from Polygonal Facets", 1998). Weights by area would lean towards where a quad's diagonal
//! ends.

use core::ops::Range;

use bevy::math::DVec3;

/// Triangles of a round join's strip.
pub(super) struct Bulge {
    pub triangles: Range<usize>,
    /// The joint: outside is away from it.
    pub center: DVec3,
}

/// A unit normal for each group of vertices.
pub(super) fn smooth_normals(
    positions: &[DVec3],
    groups: &[u32],
    group_count: usize,
    triangles: &[[u32; 3]],
    bulges: &[Bulge],
) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; group_count];
    // Where nothing else is known, a bulge's points face away from its centre.
    let mut fall_back = vec![DVec3::ZERO; group_count];
    let mut bulges = bulges.iter().peekable();
    for (i, triangle) in triangles.iter().enumerate() {
        while bulges.next_if(|bulge| bulge.triangles.end <= i).is_some() {}
        let corners = triangle.map(|vertex| positions[vertex as usize]);
        let [a, b, c] = corners;
        let Some(normal) = (b - a).cross(c - a).try_normalize() else {
            continue;
        };
        if let Some(bulge) = bulges.peek()
            && bulge.triangles.contains(&i)
        {
            for (vertex, corner) in triangle.iter().zip(corners) {
                fall_back[groups[*vertex as usize] as usize] = corner - bulge.center;
            }
            if normal.dot(a + b + c - 3.0 * bulge.center) < 0.0 {
                continue;
            }
        }
        for k in 0..3 {
            let (to_next, to_last) = (
                corners[(k + 1) % 3] - corners[k],
                corners[(k + 2) % 3] - corners[k],
            );
            let angle = to_next.cross(to_last).length().atan2(to_next.dot(to_last));
            normals[groups[triangle[k] as usize] as usize] += angle * normal;
        }
    }
    for (normal, fall_back) in normals.iter_mut().zip(fall_back) {
        *normal = normal
            .try_normalize()
            .unwrap_or(fall_back.normalize_or(DVec3::Y));
    }
    normals
}

//! From samples to pixels: colour, alpha and normal; and colour under what is transparent.

use bevy::math::{Vec2, Vec3};

use super::color::{encode, unorm};
use super::raster::{Face, NOTHING, Projection};
use super::source::{CrownMesh, CrownTriangle};

/// What a sample sees.
struct Look {
    color: Vec3,
    alpha: f32,
    normal: Vec3,
    occlusion: f32,
}

/// Pixels of a slice: colours with alpha, and normals with occlusion.
pub(super) type Pictures = (Vec<[u8; 4]>, Vec<[u8; 4]>);

/// The pixels of a slice from its samples, `samples` × `samples` a pixel; `light` is each triangle's light from around.
pub(super) fn resolve(
    mesh: &CrownMesh,
    light: &[f32],
    projection: &Projection,
    seen: &[u32],
    samples: u32,
) -> Pictures {
    let side = projection.side as usize;
    let (samples, pixels) = (samples as usize, side / samples as usize);
    // Sums of colour times alpha, of normals and occlusion likewise, and of alpha.
    let mut sums = vec![[0.0_f32; 8]; pixels * pixels];
    // Neighbouring samples mostly see one triangle.
    let mut last: Option<(u32, Face)> = None;
    for y in 0..side {
        for x in 0..side {
            let index = seen[y * side + x];
            if index == NOTHING {
                continue;
            }
            let triangle = &mesh.triangles[index as usize];
            if last.as_ref().is_none_or(|(known, _)| *known != index) {
                last = Face::new(triangle.positions(), projection).map(|face| (index, face));
            }
            let Some((_, face)) = &last else { continue };
            let weights = face.weights(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
            let direction = projection.orientation.direction;
            let look = look(mesh, triangle, weights, direction, light[index as usize]);
            let a = look.alpha;
            let (c, n) = (look.color * a, look.normal * a);
            let sum = &mut sums[y / samples * pixels + x / samples];
            for (sum, part) in
                sum.iter_mut()
                    .zip([c.x, c.y, c.z, n.x, n.y, n.z, look.occlusion * a, a])
            {
                *sum += part;
            }
        }
    }
    let per_pixel = (samples * samples) as f32;
    bleed(&mut sums, pixels);
    let color = sums.iter().map(|sum| {
        let [r, g, b] = [sum[0], sum[1], sum[2]].map(|x| encode(x / sum[7].abs()));
        [r, g, b, unorm(sum[7] / per_pixel)]
    });
    let normal = sums.iter().map(|sum| {
        let n = Vec3::new(sum[3], sum[4], sum[5]);
        let n = n.normalize_or(projection.orientation.direction) * 0.5 + 0.5;
        [
            unorm(n.x),
            unorm(n.y),
            unorm(n.z),
            unorm(sum[6] / sum[7].abs()),
        ]
    });
    (color.collect(), normal.collect())
}

/// What is seen of a triangle from `direction`.
fn look(
    mesh: &CrownMesh,
    triangle: &CrownTriangle,
    weights: Vec3,
    direction: Vec3,
    occlusion: f32,
) -> Look {
    let material = &mesh.materials[triangle.material as usize];
    let [a, b, c] = triangle.vertices;
    let vertex = triangle.color(weights);
    let texture = material.sample(triangle.uv(weights));
    let color: [f32; 3] = core::array::from_fn(|i| vertex[i] * material.color[i] * texture[i]);
    let normal = a.normal * weights.x + b.normal * weights.y + c.normal * weights.z;
    let normal = normal.normalize_or(direction);
    Look {
        color: Vec3::from(color).clamp(Vec3::ZERO, Vec3::ONE),
        alpha: material.alpha(triangle, weights),
        // Both sides are seen; each is lit from where it is seen.
        normal: if normal.dot(direction) < 0.0 {
            -normal
        } else {
            normal
        },
        occlusion,
    }
}

/// Fills pixels that see nothing with what is around them, so that filtering finds no foreign colour there. Their
/// alpha, the last number, becomes the negative of what the rest is to be divided by.
///
/// Pull and push: S. J. Gortler et al., The Lumigraph (SIGGRAPH 1996), §3.4.
fn bleed(sums: &mut [[f32; 8]], side: usize) {
    let mut levels = vec![sums.to_vec()];
    let mut width = side;
    while width > 1 {
        let fine = &levels[levels.len() - 1];
        let half = width / 2;
        let coarse = (0..half * half).map(|i| {
            let (x, y) = (i % half * 2, i / half * 2);
            core::array::from_fn(|c| {
                let at = |dx: usize, dy: usize| fine[(y + dy) * width + x + dx][c];
                at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1)
            })
        });
        levels.push(coarse.collect());
        width = half;
    }
    for level in (0..levels.len()).rev() {
        let width = side >> level;
        for i in 0..width * width {
            if levels[level][i][7] > 0.0 {
                continue;
            }
            let filled = match levels.get(level + 1) {
                Some(coarse) => coarse[i / width / 2 * (width / 2) + i % width / 2],
                // Nothing at all is seen: any colour will do.
                None => [0.5, 0.5, 0.5, 0.0, 0.0, 0.0, 1.0, 1.0],
            };
            levels[level][i] = filled;
            // Marked as filled; coarser marks are negative already.
            levels[level][i][7] = -filled[7].abs();
        }
    }
    sums.copy_from_slice(&levels[0]);
}

//! Cutting triangles into slices (§3.1, Figure 5).
//!
//! The paper draws the shape from above, between two clip planes for each slice. The same is done here for all slices
//! at once: a triangle is sampled at the centres of columns, and colours the voxel that the sample lies in. Faces
//! seen edge-on from above are missed by that, so that shapes are also sampled along u and v, unless the paper's own
//! closing is asked for.
//!
//! A sample belongs to one of two triangles that share an edge, whatever rounding does: the edge function is
//! evaluated in one direction for both, and its zero counts to one side (as if the sample lay an infinitesimal step
//! off). A line through the centres therefore crosses a closed surface an even number of times, and every crossing
//! colours the voxel that it lies in.

use std::sync::atomic::{AtomicUsize, Ordering};

use bevy::math::{DVec2, DVec3, Vec2, Vec3, Vec4};

use super::super::parallel::for_each_chunk;
use super::super::progress::{BuildStep, Progress};
use super::super::topology::Topology;
use super::draft::{Cell, Draft};
use super::shape::{Filling, Shape};

/// Slices that one thread takes at a time.
const SLAB: usize = 8;

/// Sum of what falls into a voxel.
#[derive(Clone, Copy, Default)]
struct Sum {
    color: Vec3,
    normal: Vec3,
    count: f32,
}

impl Sum {
    fn add(&mut self, color: Vec3, normal: Vec3) {
        self.color += color;
        // Both sides of a leaf in one voxel would cancel: the first decides.
        let against = self.normal.dot(normal) < -0.3 * self.normal.length();
        self.normal += if against { -normal } else { normal };
        self.count += 1.0;
    }
}

/// Cuts a shape, whose box begins at `min`. Returns how many triangles have no area and were left out.
pub(super) fn rasterise(
    draft: &mut Draft,
    shape: &Shape,
    filling: Filling,
    min: Vec3,
    progress: Progress,
) -> usize {
    let scale = draft.size.as_dvec3() / draft.lengths.as_dvec3();
    // Up to rounding all corners lie in the box along w.
    let height = f64::from(draft.size.z);
    let place = |vertex: u32| {
        let mut place = (shape.positions[vertex as usize].as_dvec3() - min.as_dvec3()) * scale;
        place.z = place.z.clamp(0.0, height);
        place
    };
    let facets: Vec<Facet> = (0..shape.triangles.len())
        .map(|triangle| Facet::new(shape, triangle, shape.triangles[triangle].map(place), scale))
        .collect();
    let layer = draft.layer();
    let mut sums = vec![Sum::default(); draft.cells.len()];
    let slabs = (draft.size.z as usize).div_ceil(SLAB);
    let done = AtomicUsize::new(0);
    for_each_chunk(&mut sums, layer * SLAB, |slab, sums| {
        let mut target = Target {
            size: draft.size.to_array(),
            wraps: draft.topology == Topology::Tiling,
            from: (slab * SLAB) as i64,
            to: ((slab + 1) * SLAB).min(draft.size.z as usize) as i64,
            sums,
        };
        for facet in &facets {
            if facet.reaches(target.from, target.to) {
                let axes: &[usize] = if filling == Filling::Parity {
                    &[2]
                } else {
                    &[0, 1, 2]
                };
                for &axis in axes {
                    target.draw(shape, facet, axis, filling);
                }
            }
        }
        // Slabs are not done in order.
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        progress(BuildStep::Slicing, done as f32 / slabs as f32);
    });
    for (cell, sum) in draft.cells.iter_mut().zip(sums) {
        if sum.count > 0.0 {
            *cell = Cell::coloured(sum.color / sum.count, sum.normal / sum.count);
        }
    }
    facets.iter().filter(|facet| facet.area == 0.0).count()
}

/// A triangle in voxels.
struct Facet {
    triangle: usize,
    corners: [DVec3; 3],
    /// Its own unit normal, in metres.
    normal: Vec3,
    /// In voxels.
    area: f64,
    /// How much of the texture lies on a voxel's face.
    texture_area: f32,
}

impl Facet {
    fn new(shape: &Shape, triangle: usize, corners: [DVec3; 3], scale: DVec3) -> Self {
        let [a, b, c] = corners;
        let area = (b - a).cross(c - a).length() / 2.0;
        let metres = ((b - a) / scale).cross((c - a) / scale);
        let uv_area = if shape.uvs.is_empty() {
            0.0
        } else {
            let [p, q, r] = shape.triangles[triangle].map(|vertex| shape.uvs[vertex as usize]);
            (q - p).perp_dot(r - p).abs() / 2.0
        };
        Self {
            triangle,
            corners,
            normal: metres.normalize_or_zero().as_vec3(),
            area,
            texture_area: if area > 0.0 {
                uv_area / area as f32
            } else {
                0.0
            },
        }
    }

    /// Whether it may reach slices `from` to `to`.
    fn reaches(&self, from: i64, to: i64) -> bool {
        let heights = self.corners.map(|corner| corner.z);
        let low = heights.into_iter().fold(f64::INFINITY, f64::min);
        let high = heights.into_iter().fold(f64::NEG_INFINITY, f64::max);
        // The top of the box is part of the last slice.
        self.area > 0.0 && low <= to as f64 && high >= from as f64
    }

    /// The linear colour, and the unit normal, at a point given by its weights; none where alpha cuts a hole.
    fn shade(&self, shape: &Shape, weights: [f64; 3], filling: Filling) -> Option<(Vec3, Vec3)> {
        let vertices = shape.triangles[self.triangle].map(|vertex| vertex as usize);
        let [u, v, w] = weights.map(|weight| weight as f32);
        let mut color = Vec4::ONE;
        if !shape.colors.is_empty() {
            let [a, b, c] = vertices.map(|vertex| shape.colors[vertex]);
            color = a * u + b * v + c * w;
        }
        let mut cutoff = 0.5;
        if let Some(paint) = shape.paint(self.triangle) {
            color *= paint.color;
            cutoff = paint.alpha_cutoff;
            if let Some(texture) = &paint.texture {
                let [a, b, c]: [Vec2; 3] = vertices.map(|vertex| shape.uvs[vertex]);
                color *= texture.sample(a * u + b * v + c * w, self.texture_area);
            }
        }
        if filling == Filling::None && color.w < cutoff {
            return None;
        }
        let mut normal = self.normal;
        if !shape.normals.is_empty() {
            let [a, b, c] = vertices.map(|vertex| shape.normals[vertex]);
            normal = (a * u + b * v + c * w).try_normalize().unwrap_or(normal);
        }
        Some((color.truncate(), normal))
    }
}

/// The slices that a thread draws to.
struct Target<'a> {
    size: [u32; 3],
    wraps: bool,
    /// The first slice, and the one after the last.
    from: i64,
    to: i64,
    sums: &'a mut [Sum],
}

impl Target<'_> {
    /// Samples a triangle along an axis.
    fn draw(&mut self, shape: &Shape, facet: &Facet, axis: usize, filling: Filling) {
        let (p, q) = ((axis + 1) % 3, (axis + 2) % 3);
        let flat = facet.corners.map(|corner| DVec2::new(corner[p], corner[q]));
        let [a, b, c] = flat;
        let doubled_area = (b - a).perp_dot(c - a);
        if doubled_area == 0.0 {
            return;
        }
        let depths = facet.corners.map(|corner| corner[axis]);
        let lowest = depths.into_iter().fold(f64::INFINITY, f64::min);
        let highest = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        let range = |i: usize, along: usize| {
            let values = flat.map(|corner| corner[i]);
            let low = values.into_iter().fold(f64::INFINITY, f64::min);
            let high = values.into_iter().fold(f64::NEG_INFINITY, f64::max);
            // Centres between both; samples outside the slices are left to their own thread.
            let (mut low, mut high) = ((low - 0.5).ceil() as i64, (high - 0.5).floor() as i64);
            if along == 2 {
                (low, high) = (low.max(self.from), high.min(self.to - 1));
            }
            low..=high
        };
        for at_q in range(1, q) {
            for at_p in range(0, p) {
                let sample = DVec2::new(at_p as f64 + 0.5, at_q as f64 + 0.5);
                if !covers(&flat, doubled_area > 0.0, sample) {
                    continue;
                }
                let weight = |i: usize| {
                    let (from, to) = (flat[(i + 1) % 3], flat[(i + 2) % 3]);
                    ((to - from).perp_dot(sample - from) / doubled_area).clamp(0.0, 1.0)
                };
                let mut weights = [weight(0), weight(1), 0.0];
                weights[2] = (1.0 - weights[0] - weights[1]).max(0.0);
                let depth: f64 = (0..3).map(|i| weights[i] * facet.corners[i][axis]).sum();
                // Rounding must not lead out of a face that lies between two layers.
                let depth = depth.clamp(lowest, highest);
                let mut voxel = [0; 3];
                voxel[axis] = depth.floor() as i64;
                voxel[p] = at_p;
                voxel[q] = at_q;
                let Some(index) = self.index(voxel) else {
                    continue;
                };
                if let Some((color, normal)) = facet.shade(shape, weights, filling) {
                    self.sums[index].add(color, normal);
                }
            }
        }
    }

    /// Index of a voxel in these slices, if it lies in them.
    fn index(&self, voxel: [i64; 3]) -> Option<usize> {
        let mut place = [0; 3];
        for i in 0..3 {
            let side = i64::from(self.size[i]);
            place[i] = match voxel[i] {
                at if i == 2 => at.min(side - 1),
                at if self.wraps => at.rem_euclid(side),
                at if (0..side).contains(&at) => at,
                _ => return None,
            };
        }
        let [x, y, z] = place;
        (self.from..self.to).contains(&z).then(|| {
            let (width, height) = (i64::from(self.size[0]), i64::from(self.size[1]));
            (((z - self.from) * height + y) * width + x) as usize
        })
    }
}

/// Whether a sample lies in a triangle that winds counterclockwise or not.
fn covers(corners: &[DVec2; 3], counterclockwise: bool, sample: DVec2) -> bool {
    (0..3).all(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        is_left(from, to, sample) == counterclockwise
    })
}

/// Whether a sample lies to the left of the line from one point to another. It is exactly one of this and the same for
/// the line back.
fn is_left(from: DVec2, to: DVec2, sample: DVec2) -> bool {
    let forward = (from.x, from.y) < (to.x, to.y);
    let (low, high) = if forward { (from, to) } else { (to, from) };
    ((high - low).perp_dot(sample - low) >= 0.0) == forward
}

//! The prism of a facet: from space to texture space and back.
//!
//! A point P in it is Σ bᵢ·(Aᵢ + w·Hᵢ). It lies in the triangle at height w, so that
//!
//! > det(E₁ + w·K₁, E₂ + w·K₂, P − A₀ − w·H₀) = 0, with Eᵢ = Aᵢ − A₀ and Kᵢ = Hᵢ − H₀,
//!
//! which is a cubic in w; with w known the weights follow from the triangle's edges.

use glam::{DMat3, DVec2, DVec3};

use super::voxels::{VoxelHit, look, march_voxels};
use super::{ReferenceFacet, ReferenceSteps};
use crate::texel::ReferenceVolume;

/// Halvings of a step in which a ray enters a voxel.
const BISECTIONS: usize = 48;

/// A facet, ready to be hit.
#[derive(Clone, Debug)]
pub struct ReferencePrism {
    facet: ReferenceFacet,
    /// E₁, E₂.
    e: [DVec3; 2],
    /// K₁, K₂.
    k: [DVec3; 2],
    /// Lower and upper corner of a box round it.
    bounds: [DVec3; 2],
}

impl ReferencePrism {
    /// Of a facet.
    pub fn new(facet: ReferenceFacet) -> Self {
        let [a, h] = [facet.positions, facet.heights];
        let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for i in 0..3 {
            min = min.min(a[i]).min(a[i] + h[i]);
            max = max.max(a[i]).max(a[i] + h[i]);
        }
        Self {
            e: [a[1] - a[0], a[2] - a[0]],
            k: [h[1] - h[0], h[2] - h[0]],
            facet,
            bounds: [min, max],
        }
    }

    /// Whether texture space is an affine image of space here.
    pub fn is_affine(&self) -> bool {
        self.k == [DVec3::ZERO; 2]
    }

    /// The weights b₁ and b₂ of a point, and its w, if it lies in the prism. Of several places, where height vectors
    /// are folded, the lowest.
    pub fn locate(&self, point: DVec3) -> Option<DVec3> {
        let q = point - self.facet.positions[0];
        let h = self.facet.heights[0];
        let ([e1, e2], [k1, k2]) = (self.e, self.k);
        // det of columns (e1 + w k1, e2 + w k2, q − w h), by powers of w.
        let det = |a: DVec3, b: DVec3, c: DVec3| a.cross(b).dot(c);
        let cubic = [
            det(e1, e2, q),
            det(k1, e2, q) + det(e1, k2, q) - det(e1, e2, h),
            det(k1, k2, q) - det(k1, e2, h) - det(e1, k2, h),
            -det(k1, k2, h),
        ];
        roots_in_unit(cubic).into_iter().find_map(|w| {
            let [u, v] = [e1 + w * k1, e2 + w * k2];
            let rest = q - w * h;
            let normal = u.cross(v);
            let area = normal.length_squared();
            let b1 = rest.cross(v).dot(normal) / area;
            let b2 = u.cross(rest).dot(normal) / area;
            // What rounding may take from a point on a border.
            let slack = -1e-12;
            (b1 >= slack && b2 >= slack && b1 + b2 <= 1.0 - slack).then_some(DVec3::new(b1, b2, w))
        })
    }

    /// Texture coordinates of weights b₁ and b₂.
    fn uv(&self, b: DVec2) -> DVec2 {
        let [p, q, r] = self.facet.uvs;
        p + (q - p) * b.x + (r - p) * b.y
    }

    /// The place in texture space of a point in the prism.
    pub fn to_texture(&self, point: DVec3) -> Option<DVec3> {
        let place = self.locate(point)?;
        Some(self.uv(place.truncate()).extend(place.z))
    }

    /// A normal in metres of the volume's box, at a place of the prism, in the space of the facet.
    pub(super) fn world_normal(&self, uvw: DVec3, normal: DVec3, lengths: DVec3) -> DVec3 {
        let [p, q, r] = self.facet.uvs;
        let jacobian = DMat3::from_cols((q - p).extend(0.0), (r - p).extend(0.0), DVec3::Z);
        let b = jacobian.inverse() * (uvw - p.extend(0.0));
        // Columns: how the point moves with b₁, b₂ and w.
        let moved = DMat3::from_cols(
            self.e[0] + uvw.z * self.k[0],
            self.e[1] + uvw.z * self.k[1],
            self.facet.heights[0] + b.x * self.k[0] + b.y * self.k[1],
        );
        let by_metre = DMat3::from_diagonal(DVec3::ONE / lengths);
        let to_space = moved * jacobian.inverse() * by_metre;
        (to_space.inverse().transpose() * normal).normalize_or_zero()
    }

    /// The first opaque voxel on a ray in the prism, for t in a range, of which the end may be infinite.
    pub fn cast(
        &self,
        volume: &ReferenceVolume,
        origin: DVec3,
        dir: DVec3,
        range: [f64; 2],
        steps: ReferenceSteps,
    ) -> Option<VoxelHit> {
        let range = self.clip(origin, dir, range)?;
        if self.is_affine() {
            self.cast_straight(volume, origin, dir, range)
        } else {
            self.cast_curved(volume, origin, dir, range, steps)
        }
    }

    /// The part of a ray in the box round the prism.
    pub(super) fn clip(
        &self,
        origin: DVec3,
        dir: DVec3,
        [mut from, mut to]: [f64; 2],
    ) -> Option<[f64; 2]> {
        if dir == DVec3::ZERO {
            return None;
        }
        for i in 0..3 {
            if dir[i] == 0.0 {
                if origin[i] < self.bounds[0][i] || origin[i] > self.bounds[1][i] {
                    return None;
                }
            } else {
                let [a, b] = [0, 1].map(|side: usize| (self.bounds[side][i] - origin[i]) / dir[i]);
                from = from.max(a.min(b));
                to = to.min(a.max(b));
            }
        }
        (from <= to).then_some([from, to])
    }

    /// Exactly, where the ray is straight in texture space.
    fn cast_straight(
        &self,
        volume: &ReferenceVolume,
        origin: DVec3,
        dir: DVec3,
        [mut from, mut to]: [f64; 2],
    ) -> Option<VoxelHit> {
        let space = DMat3::from_cols(self.e[0], self.e[1], self.facet.heights[0]);
        if space.determinant() == 0.0 {
            return None;
        }
        let inverse = space.inverse();
        let o = inverse * (origin - self.facet.positions[0]);
        let d = inverse * dir;
        // b₁ ≥ 0, b₂ ≥ 0, b₁ + b₂ ≤ 1; heights are the march's own.
        for (value, rate) in [(o.x, d.x), (o.y, d.y), (1.0 - o.x - o.y, -d.x - d.y)] {
            if rate > 0.0 {
                from = from.max(-value / rate);
            } else if rate < 0.0 {
                to = to.min(-value / rate);
            } else if value < 0.0 {
                return None;
            }
        }
        let [p, q, r] = self.facet.uvs;
        let along = |b: DVec3| (q - p) * b.x + (r - p) * b.y;
        let start = (p + along(o)).extend(o.z);
        march_voxels(volume, start, along(d).extend(d.z), [from, to])
    }

    /// In steps.
    pub(super) fn cast_curved(
        &self,
        volume: &ReferenceVolume,
        origin: DVec3,
        dir: DVec3,
        [from, to]: [f64; 2],
        steps: ReferenceSteps,
    ) -> Option<VoxelHit> {
        let step = self.least_voxel(volume) / steps.per_voxel / dir.length();
        let size = volume.size().as_dvec3();
        let look_at = |t: f64| {
            let uvw = self.to_texture(origin + t * dir)?;
            let mut cell = (uvw * size).floor().as_i64vec3();
            // The top belongs to the last slice.
            cell.z = cell.z.min(size.z as i64 - 1);
            look(volume, cell).map(|hit| VoxelHit { t, uvw, ..hit })
        };
        let count = ((to - from) / step).ceil().max(1.0);
        // Height vectors of no length leave no step.
        if !count.is_finite() {
            return None;
        }
        let mut before = from;
        for i in 0..=count as usize {
            let t = (from + i as f64 * step).min(to);
            if let Some(mut hit) = look_at(t) {
                let mut empty = before;
                for _ in 0..BISECTIONS {
                    match look_at(0.5 * (empty + hit.t)) {
                        Some(nearer) => hit = nearer,
                        None => empty = 0.5 * (empty + hit.t),
                    }
                }
                return Some(hit);
            }
            before = t;
        }
        None
    }

    /// The shortest side of a voxel at any corner.
    pub(super) fn least_voxel(&self, volume: &ReferenceVolume) -> f64 {
        let size = volume.size().as_dvec3();
        let [p, q, r] = self.facet.uvs;
        let (s, t) = (q - p, r - p);
        let area = s.perp_dot(t);
        let mut least = f64::INFINITY;
        for w in [0.0, 1.0] {
            let [e1, e2] = [0, 1].map(|i| self.e[i] + w * self.k[i]);
            let along_u = (e1 * t.y - e2 * s.y) / area;
            let along_v = (e2 * s.x - e1 * t.x) / area;
            least = least
                .min(along_u.length() / size.x)
                .min(along_v.length() / size.y);
        }
        for height in self.facet.heights {
            least = least.min(height.length() / size.z);
        }
        least
    }
}

/// The roots of c₀ + c₁x + c₂x² + c₃x³ from 0 to 1, in order: between the roots of the derivative, each by bisection.
fn roots_in_unit(c: [f64; 4]) -> Vec<f64> {
    let value = |x: f64| ((c[3] * x + c[2]) * x + c[1]) * x + c[0];
    let mut stops = vec![0.0];
    // Of 3c₃x² + 2c₂x + c₁.
    let (a, half_b, d) = (3.0 * c[3], c[2], c[1]);
    let discriminant = half_b * half_b - a * d;
    if discriminant > 0.0 {
        let q = -(half_b + half_b.signum() * discriminant.sqrt());
        let mut turns = [q / a, d / q];
        turns.sort_by(f64::total_cmp);
        stops.extend(turns.into_iter().filter(|x| (0.0..1.0).contains(x)));
    }
    stops.push(1.0);
    let scale = c.iter().fold(0.0, |scale: f64, c| scale.max(c.abs()));
    let mut roots: Vec<f64> = Vec::new();
    for pair in stops.windows(2) {
        let [mut low, mut high] = [pair[0], pair[1]];
        let (at_low, at_high) = (value(low), value(high));
        // A root at an end may miss its sign by rounding.
        let end = [(low, at_low), (high, at_high)]
            .into_iter()
            .find(|(_, value)| value.abs() <= 1e-14 * scale)
            .map(|(x, _)| x);
        if let Some(x) = end {
            roots.push(x);
        } else if (at_low < 0.0) != (at_high < 0.0) {
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if (value(middle) < 0.0) == (at_low < 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            roots.push(0.5 * (low + high));
        }
    }
    roots
}

//! One triangle of the surface and the texels on it (§2.1, Figure 2): a prism between the triangle and the ends of
//! its height vectors.
//!
//! A place in it is given by the triangle's weights (b₀, b₁, b₂), which sum to one, and the height w from 0 to 1: P =
//! Σ bᵢ·(Aᵢ + w·Hᵢ). Texture coordinates are Σ bᵢ·(uᵢ, vᵢ), and repeat with 1, so that a facet may carry a part of a
//! texel or many.
//!
//! `bend` has height vectors in the wind, and `comb` those that are stroked; `frame` has the directions in which u, v and w
//! grow there; `slicing` cuts the prism into slices; `surface` makes facets of a mesh.

mod bend;
mod comb;
mod frame;
mod slicing;
mod surface;
#[cfg(test)]
mod tests;

use bevy::math::{Vec2, Vec3};
use thiserror::Error;

pub use bend::bend;
pub use comb::comb;
pub use frame::TexelFrame;
pub use slicing::{slice_line, slice_position, slice_range};
pub use surface::{Surface, SurfaceError, SurfaceFacets};

/// A triangle with what its texels need, in any one space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// A: where the vertices are.
    pub positions: [Vec3; 3],
    /// H: height vectors at the vertices, from the surface to the top of the texels.
    pub heights: [Vec3; 3],
    /// Texture coordinates of the vertices.
    pub uvs: [Vec2; 3],
}

/// Why a facet carries no texels. Such facets are left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FacetFault {
    /// A number is not finite.
    #[error(
        "a position, height vector or texture coordinate is not finite: correct or remove the triangle"
    )]
    NotFinite,
    /// The triangle has no area.
    #[error("the triangle has no area: remove it, or move a vertex")]
    NoArea,
    /// The triangle has no area on the texture.
    #[error("the triangle's texture coordinates lie on a line: unwrap it anew")]
    NoUvArea,
    /// A height vector is zero.
    #[error("a height vector is zero: give it a length, or leave out the triangle")]
    NoHeight,
    /// A height vector leads through the surface.
    #[error(
        "a height vector lies in the triangle or leads to its back: bend it to the side of the normal"
    )]
    Folded,
    /// The height vectors cross, so that the triangle at some height has no area, or is turned over.
    #[error("height vectors cross, so that texels are turned over: shorten or straighten them")]
    Crossed,
}

impl Facet {
    /// The point of weights `b` at height `w`.
    pub fn point(&self, b: Vec3, w: f32) -> Vec3 {
        let [p, q, r] = self.corners(w);
        p * b.x + q * b.y + r * b.z
    }

    /// The triangle at height `w`.
    pub fn corners(&self, w: f32) -> [Vec3; 3] {
        [0, 1, 2].map(|i| self.positions[i] + self.heights[i] * w)
    }

    /// The texture coordinates of weights `b`.
    pub fn uv(&self, b: Vec3) -> Vec2 {
        self.uvs[0] * b.x + self.uvs[1] * b.y + self.uvs[2] * b.z
    }

    /// A sphere round the prism: centre and radius.
    pub fn bounds(&self) -> (Vec3, f32) {
        let corners = [self.corners(0.0), self.corners(1.0)];
        let all = corners.as_flattened();
        let (mut min, mut max) = (all[0], all[0]);
        for &corner in all {
            (min, max) = (min.min(corner), max.max(corner));
        }
        let centre = (min + max) * 0.5;
        let radius = all
            .iter()
            .map(|corner| corner.distance(centre))
            .fold(0.0, f32::max);
        (centre, radius)
    }

    /// Whether it can carry texels.
    ///
    /// # Errors
    /// When it cannot.
    pub fn check(&self) -> Result<(), FacetFault> {
        let vectors = self.positions.iter().chain(&self.heights);
        if !vectors.copied().all(Vec3::is_finite) || !self.uvs.iter().all(|uv| uv.is_finite()) {
            return Err(FacetFault::NotFinite);
        }
        let normal = doubled_area(self.corners(0.0));
        let longest = longest_side(
            self.positions
                .map(|position| (position - self.positions[0]).to_array()),
        );
        // Below what f32 tells from zero at this size.
        if normal.length() <= longest * longest * f32::EPSILON {
            return Err(FacetFault::NoArea);
        }
        let [p, q, r] = self.uvs;
        let uv_area = (q - p).perp_dot(r - p).abs();
        let longest = longest_side(self.uvs.map(|uv| (uv - p).extend(0.0).to_array()));
        if uv_area <= longest * longest * f32::EPSILON {
            return Err(FacetFault::NoUvArea);
        }
        if self.heights.contains(&Vec3::ZERO) {
            return Err(FacetFault::NoHeight);
        }
        if self.heights.iter().any(|height| height.dot(normal) <= 0.0) {
            return Err(FacetFault::Folded);
        }
        if self.least_area(normal) <= 0.0 {
            return Err(FacetFault::Crossed);
        }
        Ok(())
    }

    /// Whether it carries texels with other height vectors too, as in the wind, if it does with its own: none leads through
    /// the surface, and none cross. In a mirrored space as well, where texels are on the back.
    pub(crate) fn may_bend_to(&self, heights: [Vec3; 3]) -> bool {
        let normal = doubled_area(self.corners(0.0));
        let side = self.heights[0].dot(normal).signum();
        let stays = heights.iter().all(|h| h.dot(normal) * side > 0.0);
        stays && Self { heights, ..*self }.least_area(normal) > 0.0
    }

    /// The least area that the triangle has at any height, seen along the normal, times twice the length of that. At the
    /// top alone vectors that meet half way would go unseen: beyond, all three corners have changed sides, and the area
    /// is positive again.
    fn least_area(&self, normal: Vec3) -> f32 {
        let [e1, e2] = [1, 2].map(|i| self.positions[i] - self.positions[0]);
        let [k1, k2] = [1, 2].map(|i| self.heights[i] - self.heights[0]);
        // (e₁ + w·k₁) × (e₂ + w·k₂), by powers of w.
        let [c0, c1, c2] =
            [e1.cross(e2), k1.cross(e2) + e1.cross(k2), k1.cross(k2)].map(|area| area.dot(normal));
        // Least where the parabola turns, if it opens upward, or else at an end; at w = 0 it is not.
        let w = if c2 > 0.0 {
            (-0.5 * c1 / c2).clamp(0.0, 1.0)
        } else {
            1.0
        };
        c0 + w * (c1 + w * c2)
    }
}

/// The normal of a triangle, as long as twice its area.
fn doubled_area([p, q, r]: [Vec3; 3]) -> Vec3 {
    (q - p).cross(r - p)
}

fn longest_side(from_first: [[f32; 3]; 3]) -> f32 {
    from_first
        .as_flattened()
        .iter()
        .fold(0.0, |longest, side| side.abs().max(longest))
}

//! What alpha of material, texture and vertices makes of a place: as Bevy's alpha modes have it.

use bevy::math::Vec3;

use super::source::{CrownMaterial, CrownTriangle};

/// Alpha below which a place is not there: what 8 bits would have as 0.
pub(super) const LEAST_ALPHA: f32 = 0.5 / 255.0;

impl CrownMaterial {
    /// Whether some place of a triangle may be less than opaque.
    pub(super) fn may_have_holes(&self, triangle: &CrownTriangle) -> bool {
        let is_thin = |alpha: f32| alpha * self.color[3] < 1.0;
        let vertices = &triangle.vertices;
        !self.opaque
            && (self.texture.is_some() || vertices.iter().any(|vertex| is_thin(vertex.color[3])))
    }

    /// Alpha at a place of a triangle, 0 to 1: 1 of what is opaque, and 0 or 1 of what is masked.
    pub(super) fn alpha(&self, triangle: &CrownTriangle, weights: Vec3) -> f32 {
        if self.opaque {
            return 1.0;
        }
        let texture = self.sample(triangle.uv(weights))[3];
        let alpha = triangle.color(weights)[3] * self.color[3] * texture;
        if self.cutoff > 0.0 {
            return f32::from(u8::from(alpha >= self.cutoff));
        }
        alpha.clamp(0.0, 1.0)
    }
}

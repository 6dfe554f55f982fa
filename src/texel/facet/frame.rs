//! The directions in which u, v and w grow on a facet, and what follows for its slices (§4.2).

use bevy::math::{Mat3, Vec3};

use super::super::axis::SliceAxis;
use super::Facet;

/// Derivatives of the place by u, v and w: the edges of one texel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelFrame {
    /// ∂P/∂u, ∂P/∂v and ∂P/∂w.
    pub edges: [Vec3; 3],
}

impl TexelFrame {
    /// The frame at the weights `b` and the height `w` of a facet. Along u and v it is the same at one height.
    pub fn new(facet: &Facet, b: Vec3, w: f32) -> Self {
        let [p, q, r] = facet.corners(w);
        let [s, t] = [facet.uvs[1] - facet.uvs[0], facet.uvs[2] - facet.uvs[0]];
        let (e1, e2) = (q - p, r - p);
        // Solve e1 = s.x·Pu + s.y·Pv, e2 = t.x·Pu + t.y·Pv.
        let det = s.perp_dot(t);
        let [h0, h1, h2] = facet.heights;
        Self {
            edges: [
                (e1 * t.y - e2 * s.y) / det,
                (e2 * s.x - e1 * t.x) / det,
                h0 * b.x + h1 * b.y + h2 * b.z,
            ],
        }
    }

    /// The unit normal of the slices of a direction, and L, the length of one texel along it. The normal looks to
    /// where the coordinate grows.
    pub fn normal_and_length(&self, axis: SliceAxis) -> (Vec3, f32) {
        let i = axis.index();
        let [a, b] = axis.in_plane().map(|axis| self.edges[axis.index()]);
        let cross = a.cross(b);
        let normal = cross / cross.length();
        let length = self.edges[i].dot(normal);
        if length < 0.0 {
            (-normal, -length)
        } else {
            (normal, length)
        }
    }

    /// A direction as changes of u, v and w.
    pub fn in_frame(&self, direction: Vec3) -> Vec3 {
        let [u, v, w] = self.edges;
        let cofactors = Mat3::from_cols(v.cross(w), w.cross(u), u.cross(v));
        cofactors.transpose() * direction / u.dot(v.cross(w))
    }

    /// A normal of the volume, which is in metres of a box of some `lengths`, in the space of the facet; not unit.
    pub fn transform_normal(&self, normal: Vec3, lengths: Vec3) -> Vec3 {
        let [u, v, w] = self.edges;
        // Gradients go by the inverse transpose, which up to its length is the cofactors, signed for mirrored textures.
        let cofactors = Mat3::from_cols(v.cross(w), w.cross(u), u.cross(v));
        let sign = u.dot(v.cross(w)).signum();
        // n has components by metres: ∂/∂u is L·∂/∂metre.
        cofactors * (normal * lengths) * sign
    }

    /// By how much the box of some `lengths` is stretched in the slices of a direction, at least.
    pub fn least_stretch(&self, axis: SliceAxis, lengths: Vec3) -> f32 {
        let [a, b] = axis.in_plane().map(SliceAxis::index);
        let stretch = |i: usize| self.edges[i].length() / lengths[i];
        stretch(a).min(stretch(b))
    }
}

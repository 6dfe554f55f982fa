//! The ray march that judges drawn texels: what a ray meets first in the reference volume mapped on facets, in f64.
//!
//! It shares no code with what draws: a ray is followed through the voxels themselves, where drawing shows slices of
//! them.
//!
//! | file | question |
//! |---|---|
//! | `voxels` | which voxel does a straight line through texture space meet first? Exact, voxel by voxel |
//! | `slices` | what does the line meet of the slices that are drawn instead? |
//! | `prism` | where is a point in the prism of a facet, and what does a ray meet in it? |
//!
//! Where the height vectors of a facet are equal, its texture space is an affine image of space: rays are straight
//! there, and hits are exact. Else they are curved, and are followed in small steps that a bisection refines: what is
//! thinner than a step ([`ReferenceSteps`]) may be missed.
//!
//! Source: A. Meyer and F. Neyret, *Interactive Volumetric Textures*, 1998, §2; J. Amanatides and A. Woo, *A Fast Voxel
//! Traversal Algorithm for Ray Tracing*, 1987.

mod prism;
mod slices;
#[cfg(test)]
mod tests;
mod voxels;

use glam::{DVec2, DVec3, IVec2, UVec3};

use crate::texel::ReferenceVolume;

pub use prism::ReferencePrism;
pub use slices::{SliceHit, march_slices};
pub use voxels::{VoxelHit, march_voxels};

/// A triangle with what its texels need, in any one space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceFacet {
    /// Where the vertices are.
    pub positions: [DVec3; 3],
    /// Height vectors at the vertices.
    pub heights: [DVec3; 3],
    /// Texture coordinates of the vertices.
    pub uvs: [DVec2; 3],
}

/// How finely rays are followed where they are curved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferenceSteps {
    /// Steps across a voxel.
    pub per_voxel: f64,
}

impl Default for ReferenceSteps {
    fn default() -> Self {
        Self { per_voxel: 8.0 }
    }
}

/// The nearest hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelHit {
    /// Distance along the ray in units of its direction's length.
    pub t: f64,
    /// Index of the facet.
    pub facet: usize,
    /// The place in texture space: u and v of the surface, w from 0 to 1.
    pub uvw: DVec3,
    /// The voxel.
    pub voxel: UVec3,
    /// Which copy of the texture.
    pub copy: IVec2,
    /// The voxel's colour in sRGB, with alpha.
    pub color: [u8; 4],
    /// The voxel's unit normal in the space of the facets.
    pub normal: DVec3,
}

/// A surface of facets that carry one volume.
#[derive(Clone, Debug)]
pub struct ReferenceTexels<'a> {
    volume: &'a ReferenceVolume,
    prisms: Vec<ReferencePrism>,
    steps: ReferenceSteps,
}

impl<'a> ReferenceTexels<'a> {
    /// Maps a volume on facets.
    pub fn new(
        volume: &'a ReferenceVolume,
        facets: &[ReferenceFacet],
        steps: ReferenceSteps,
    ) -> Self {
        let prisms = facets
            .iter()
            .map(|facet| ReferencePrism::new(*facet))
            .collect();
        Self {
            volume,
            prisms,
            steps,
        }
    }

    /// The first opaque voxel with t ≥ `t_min` on the ray `origin` + t·`dir`. `dir` need not be unit; a zero `dir`
    /// hits nothing.
    pub fn cast(&self, origin: DVec3, dir: DVec3, t_min: f64) -> Option<TexelHit> {
        let mut nearest: Option<TexelHit> = None;
        for (facet, prism) in self.prisms.iter().enumerate() {
            let t_max = nearest.map_or(f64::INFINITY, |hit| hit.t);
            let Some(hit) = prism.cast(self.volume, origin, dir, [t_min, t_max], self.steps) else {
                continue;
            };
            let UVec3 { x, y, z } = hit.voxel;
            let normal = self.volume.normal(x, y, z).as_dvec3();
            nearest = Some(TexelHit {
                t: hit.t,
                facet,
                uvw: hit.uvw,
                voxel: hit.voxel,
                copy: hit.copy,
                color: self.volume.color(x, y, z),
                normal: prism.world_normal(hit.uvw, normal, self.volume.lengths().as_dvec3()),
            });
        }
        nearest
    }
}

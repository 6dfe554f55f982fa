//! Pictures of the f64 march (`lab::texel`): in the colours of the volume, or lit by the scene.

use bevy::asset::RenderAssetUsages;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy_verdure::lab::texel::{ReferenceFacet, ReferenceSteps, ReferenceTexels, TexelHit};
use bevy_verdure::lab::{Shot, Studio, box_downsample};
use bevy_verdure::texel::color::srgb_to_linear;
use bevy_verdure::texel::facet::Facet;
use bevy_verdure::texel::{ReferenceVolume, TexelSettings};

/// Where rays are curved: nothing that is drawn is as thin as this.
const STEPS: ReferenceSteps = ReferenceSteps { per_voxel: 1.5 };
/// Quads of a mesh, so that no buffer becomes too large for a device.
const QUADS: usize = 1 << 15;

/// What rays of a picture meet, some a pixel along each side.
pub struct Marched {
    /// The picture that the rays are those of: larger than that which is asked for.
    fine: Shot,
    samples: u32,
    hits: Vec<Option<TexelHit>>,
}

impl Marched {
    /// Marches through a volume on facets in world space.
    pub fn new(volume: &ReferenceVolume, facets: &[Facet], shot: &Shot, samples: u32) -> Self {
        let facets: Vec<_> = facets
            .iter()
            .map(|facet| ReferenceFacet {
                positions: facet.positions.map(|at| at.as_dvec3()),
                heights: facet.heights.map(|height| height.as_dvec3()),
                uvs: facet.uvs.map(|uv| uv.as_dvec2()),
            })
            .collect();
        let texels = ReferenceTexels::new(volume, &facets, STEPS);
        let fine = Shot {
            size: shot.size * samples,
            ..*shot
        };
        let mut hits = vec![None; fine.size.element_product() as usize];
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let rows = (fine.size.y as usize).div_ceil(cores);
        let width = fine.size.x as usize;
        std::thread::scope(|scope| {
            for (part, hits) in hits.chunks_mut(rows * width).enumerate() {
                let texels = &texels;
                scope.spawn(move || {
                    for (i, hit) in hits.iter_mut().enumerate() {
                        let (x, y) = (i % width, part * rows + i / width);
                        let (origin, dir) = fine.ray(x as f32 + 0.5, y as f32 + 0.5);
                        *hit = texels.cast(origin, dir, 0.0);
                    }
                });
            }
        });
        Self {
            fine,
            samples,
            hits,
        }
    }

    /// In the volume's colours.
    pub fn unlit(&self, background: Color) -> Vec<u8> {
        let behind = background.to_srgba().to_u8_array_no_alpha();
        let colors = self.hits.iter().flat_map(|hit| match hit {
            Some(TexelHit {
                color: [r, g, b, _],
                ..
            }) => [*r, *g, *b],
            None => behind,
        });
        self.downsampled(&colors.collect::<Vec<u8>>())
    }

    /// Lit by what lights the studio, which must be empty else: what each ray meets is drawn as a patch that fills its
    /// pixel, with the normal and the colour that it has.
    pub fn lit(&self, studio: &mut Studio, background: Color) -> Vec<u8> {
        let world = studio.world();
        let look = TexelSettings::default();
        let material = world
            .resource_mut::<Assets<StandardMaterial>>()
            .add(StandardMaterial {
                perceptual_roughness: look.roughness,
                reflectance: look.reflectance,
                cull_mode: None,
                ..default()
            });
        let seen: Vec<usize> = (0..self.hits.len())
            .filter(|&i| self.hits[i].is_some())
            .collect();
        let patches: Vec<Entity> = seen
            .chunks(QUADS)
            .map(|seen| {
                let mesh = world.resource_mut::<Assets<Mesh>>().add(self.patches(seen));
                world
                    .spawn((Mesh3d(mesh), MeshMaterial3d(material.clone())))
                    .id()
            })
            .collect();
        for _ in 0..3 {
            studio.headless.step();
        }
        let picture = studio.photograph(&self.fine, background).rgb_bytes();
        for patch in patches {
            studio.world().despawn(patch);
        }
        studio.headless.step();
        self.downsampled(&picture)
    }

    fn downsampled(&self, fine: &[u8]) -> Vec<u8> {
        box_downsample(self.fine.size / self.samples, self.samples, fine)
    }

    fn patches(&self, seen: &[usize]) -> Mesh {
        let (mut positions, mut normals, mut colors) = (Vec::new(), Vec::new(), Vec::new());
        let mut indices = Vec::new();
        for &i in seen {
            let Some(hit) = &self.hits[i] else { continue };
            let (x, y) = (i as u32 % self.fine.size.x, i as u32 / self.fine.size.x);
            let first = positions.len() as u32;
            for (dx, dy) in [(0, 0), (0, 1), (1, 1), (1, 0)] {
                let (origin, dir) = self.fine.ray((x + dx) as f32, (y + dy) as f32);
                positions.push((origin + dir * hit.t).as_vec3());
                normals.push(hit.normal.as_vec3());
                let [r, g, b] = [0, 1, 2].map(|i| srgb_to_linear(f32::from(hit.color[i]) / 255.0));
                colors.push([r, g, b, 1.0]);
            }
            indices.extend([0, 1, 2, 0, 2, 3].map(|corner| first + corner));
        }
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::RENDER_WORLD,
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, normals)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
        .with_inserted_indices(Indices::U32(indices))
    }
}

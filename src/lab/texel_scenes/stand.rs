//! A scene of texels in a studio, drawn with one setting after the other.

use std::sync::Arc;

use bevy::prelude::*;

use super::TexelScene;
use super::counts::{SliceCounts, count};
use crate::lab::capture::Pixels;
use crate::lab::daylight::{Daylight, SKY};
use crate::lab::headless::adapter_name;
use crate::lab::studio::{Shot, Studio};
use crate::lab::timing::GpuClockPlugin;
use crate::texel::facet::Facet;
use crate::texel::{ReferenceVolume, TexelSettings, TexelSurface, TexelVolume};

/// Distance, in metres, to which shadows are cast.
const SHADOWS: f32 = 20.0;

/// Frames in which what was changed reaches the device.
const SETTLING: usize = 3;

/// A scene, covered.
pub struct TexelStand {
    /// Where it stands.
    pub studio: Studio,
    /// The surfaces.
    pub surfaces: Vec<Entity>,
    /// What they are covered with.
    pub volume: Arc<ReferenceVolume>,
    /// Their facets, in world space.
    pub facets: Vec<Facet>,
}

impl TexelStand {
    /// Builds a scene's volume, and covers its surfaces.
    ///
    /// # Errors
    /// When the volume cannot be built, or a surface cannot be covered.
    pub fn open(scene: TexelScene) -> Result<Self, String> {
        let volume = scene.volume()?;
        let mut studio = Studio::new(|app| {
            app.add_plugins((GpuClockPlugin, Daylight { shadows: SHADOWS }));
        });
        studio.headless.step();
        let world = studio.world();
        let handle = world
            .resource_mut::<Assets<TexelVolume>>()
            .add(volume.clone());
        let (mut surfaces, mut facets) = (Vec::new(), Vec::new());
        for covered in scene.surfaces() {
            let surface = TexelSurface {
                volume: handle.clone(),
                thickness: covered.thickness,
            };
            let found = surface.facets(&covered.mesh);
            let place = covered.place.to_matrix();
            facets.extend(
                found
                    .map_err(|error| error.to_string())?
                    .facets
                    .iter()
                    .map(|facet| Facet {
                        positions: facet.positions.map(|at| place.transform_point3(at)),
                        heights: facet.heights.map(|height| place.transform_vector3(height)),
                        uvs: facet.uvs,
                    }),
            );
            let mesh = world.resource_mut::<Assets<Mesh>>().add(covered.mesh);
            let mut entity = world.spawn((Mesh3d(mesh), surface, covered.place));
            if let Some(color) = covered.color {
                let look = StandardMaterial {
                    base_color: color,
                    perceptual_roughness: 1.0,
                    ..default()
                };
                let look = entity.world_scope(|world| {
                    world.resource_mut::<Assets<StandardMaterial>>().add(look)
                });
                entity.insert(MeshMaterial3d(look));
            }
            surfaces.push(entity.id());
        }
        Ok(Self {
            studio,
            surfaces,
            volume: volume.0,
            facets,
        })
    }

    /// The device's name.
    pub fn adapter(&mut self) -> String {
        adapter_name(self.studio.world())
    }

    /// Draws all surfaces with other settings.
    pub fn set(&mut self, settings: TexelSettings) {
        for &surface in &self.surfaces {
            self.studio.world().entity_mut(surface).insert(settings);
        }
        for _ in 0..SETTLING {
            self.studio.headless.step();
        }
    }

    /// A picture, in 8-bit sRGB.
    pub fn photograph(&mut self, shot: &Shot) -> Pixels {
        self.studio.photograph(shot, SKY)
    }

    /// The slices that a view shows with some settings.
    pub fn count(&self, shot: &Shot, settings: &TexelSettings) -> SliceCounts {
        count(&self.facets, &self.volume, shot, settings)
    }
}

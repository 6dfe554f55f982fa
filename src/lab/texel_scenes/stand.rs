//! A scene of texels in a studio, drawn with one setting after the other.

use std::sync::{Arc, OnceLock};

use bevy::prelude::*;
use bevy::render::render_resource::Face;

use super::TexelScene;
use super::counts::{SliceCounts, count, texel_bytes};
use super::full::{full_mesh, instances};
use crate::lab::capture::Pixels;
use crate::lab::daylight::{Daylight, SKY};
use crate::lab::headless::adapter_name;
use crate::lab::studio::{Shot, Studio};
use crate::lab::timing::GpuClockPlugin;
use crate::lighting::PlantLighting;
use crate::texel::facet::Facet;
use crate::texel::{
    ReferenceVolume, SliceBoxes, SliceSets, TexelQuality, TexelSettings, TexelSurface, TexelVolume,
};

/// Distance, in metres, to which shadows are cast.
const SHADOWS: f32 = 20.0;

/// Frames, beside that before a picture, in which what was changed reaches the device.
const SETTLING: usize = 1;

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
    /// Where each instance of the volume is, as nearly as turning and stretching can.
    pub instances: Vec<Transform>,
    scene: TexelScene,
    /// Where slices show anything, found when it is asked for.
    boxes: OnceLock<SliceBoxes>,
}

/// Settings that show every slice there is.
pub fn all_slices(lighting: PlantLighting) -> TexelSettings {
    TexelSettings {
        quality: TexelQuality {
            // Not 0, by which nothing can be divided.
            depth: 1e-3,
            pixels: 1e-3,
            ..default()
        },
        // All of the best direction, and of no other besides.
        fade: false,
        lighting,
        ..default()
    }
}

/// The triangles that texels stand for, instanced, in their place.
pub struct FullMeshes {
    /// All that is to be seen instead of the surfaces.
    pub entities: Vec<Entity>,
    /// Triangles of all instances.
    pub triangles: usize,
    /// Bytes of vertices and indices, which all instances share.
    pub bytes: usize,
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
        let (mut surfaces, mut facets, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for covered in scene.surfaces() {
            let surface = TexelSurface {
                volume: handle.clone(),
                thickness: covered.thickness,
            };
            let found = surface.facets(&covered.mesh);
            let found = found.map_err(|error| error.to_string())?.facets;
            let place = covered.place.to_matrix();
            let own = found.iter().map(|facet| Facet {
                positions: facet.positions.map(|at| place.transform_point3(at)),
                heights: facet.heights.map(|height| place.transform_vector3(height)),
                uvs: facet.uvs,
            });
            let own: Vec<Facet> = own.collect();
            places.extend(instances(&own));
            facets.extend(own);
            let mesh = world.resource_mut::<Assets<Mesh>>().add(covered.mesh);
            let mut entity = world.spawn((Mesh3d(mesh), surface, covered.place));
            if let Some(color) = covered.color {
                let look = soil(color);
                let look = entity.world_scope(|world| materials(world).add(look));
                entity.insert(MeshMaterial3d(look));
            }
            surfaces.push(entity.id());
        }
        Ok(Self {
            studio,
            surfaces,
            volume: volume.0,
            facets,
            instances: places,
            scene,
            boxes: OnceLock::new(),
        })
    }

    /// The device's name.
    pub fn adapter(&mut self) -> String {
        adapter_name(self.studio.world())
    }

    /// Takes pictures with four samples a pixel, as Bevy's cameras do.
    pub fn multisample(&mut self) {
        let camera = self.studio.camera();
        let mut camera = self.studio.world().entity_mut(camera);
        camera.insert(Msaa::Sample4);
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

    /// Puts up the triangles that the texels stand for, and what is under them. None if there are no such triangles.
    pub fn put_up_full_meshes(&mut self) -> Option<FullMeshes> {
        let mesh = full_mesh(self.scene.pattern())?;
        let triangles = mesh.indices().map_or(0, |indices| indices.len() / 3);
        let bytes = mesh.get_vertex_buffer_size() + 12 * triangles;
        let world = self.studio.world();
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
        let (settings, leaves) = (TexelSettings::default(), self.scene.pattern().is_open());
        let look = materials(world).add(StandardMaterial {
            perceptual_roughness: settings.roughness,
            reflectance: settings.reflectance,
            double_sided: leaves,
            cull_mode: if leaves { None } else { Some(Face::Back) },
            ..default()
        });
        let place =
            |place: &Transform| (Mesh3d(mesh.clone()), MeshMaterial3d(look.clone()), *place);
        let instances: Vec<_> = self.instances.iter().map(place).collect();
        let mut entities: Vec<Entity> = world.spawn_batch(instances).collect();
        for covered in self.scene.surfaces() {
            if let Some(color) = covered.color {
                let mesh = world.resource_mut::<Assets<Mesh>>().add(covered.mesh);
                let look = materials(world).add(soil(color));
                let under = (Mesh3d(mesh), MeshMaterial3d(look), covered.place);
                entities.push(world.spawn(under).id());
            }
        }
        Some(FullMeshes {
            entities,
            triangles: triangles * self.instances.len(),
            bytes,
        })
    }

    /// Bytes on the device of all that the surfaces are drawn by.
    pub fn bytes(&self, settings: &TexelSettings) -> usize {
        texel_bytes(&self.facets, &self.volume, settings.most_slices)
    }

    /// The slices that a view shows with some settings.
    pub fn count(&self, shot: &Shot, settings: &TexelSettings) -> SliceCounts {
        let sets = || SliceSets::new(&self.volume, u32::MAX);
        let boxes = self.boxes.get_or_init(|| SliceBoxes::of(&sets()));
        count(&self.facets, &self.volume, boxes, shot, settings)
    }
}

fn materials(world: &mut World) -> Mut<'_, Assets<StandardMaterial>> {
    world.resource_mut()
}

/// What a surface looks like under its texels.
fn soil(color: Color) -> StandardMaterial {
    StandardMaterial {
        base_color: color,
        perceptual_roughness: 1.0,
        ..default()
    }
}

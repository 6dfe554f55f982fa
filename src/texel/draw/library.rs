//! What is on the GPU for the surfaces and volumes in use.

use bevy::asset::{AssetId, RenderAssetUsages};
use bevy::image::Image;
use bevy::mesh::PrimitiveTopology;
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;
use bevy::render::storage::ShaderBuffer;

use super::super::asset::TexelVolume;
use super::super::axis::SliceAxis;
use super::super::choose::VolumeMeasure;
use super::super::facet::SurfaceFacets;
use super::super::slice_sets::SliceSets;
use super::component::{TexelHeights, TexelSettings, TexelSurface};
use super::geometry::{Geometry, facets};
use super::images::slice_images;
use super::material::{TexelMaterial, TexelsUniform};
use crate::lighting::{PlantLighting, SceneLights};

/// A volume of which so many slices are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct VolumeKey {
    id: AssetId<TexelVolume>,
    most: u32,
}

/// A mesh that carries so thick texels of a volume; `own` is the surface that shares it with none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct GeometryKey {
    mesh: AssetId<Mesh>,
    thickness: u32,
    volume: VolumeKey,
    own: Option<Entity>,
}

/// Surfaces that share materials: one mesh, one volume, the same looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct TexelKeys {
    pub geometry: GeometryKey,
    lighting: PlantLighting,
    /// Other settings that materials have.
    settings: [u32; 3],
}

impl TexelKeys {
    pub(crate) fn new(
        surface: &TexelSurface,
        mesh: AssetId<Mesh>,
        settings: &TexelSettings,
        own: Option<Entity>,
    ) -> Self {
        Self {
            geometry: GeometryKey {
                mesh,
                thickness: surface.thickness.to_bits(),
                volume: VolumeKey {
                    id: surface.volume.id(),
                    most: settings.most_slices,
                },
                own,
            },
            lighting: settings.lighting,
            settings: [
                settings.roughness.to_bits(),
                settings.reflectance.to_bits(),
                settings.flexibility.to_bits(),
            ],
        }
    }
}

/// A volume's slices.
struct SharedVolume {
    measure: VolumeMeasure,
    /// Colours and normals across u, v and w.
    images: [[Handle<Image>; 2]; 3],
}

/// What is on the GPU, as long as a surface uses it.
#[derive(Resource, Default)]
pub(crate) struct TexelLibrary {
    volumes: HashMap<VolumeKey, SharedVolume>,
    /// None for a mesh that carries no texels, which has been told.
    geometries: HashMap<GeometryKey, Option<Geometry>>,
    materials: HashMap<TexelKeys, [Handle<TexelMaterial>; 6]>,
    /// What Bevy's phases have in place of slices.
    quad: Option<Handle<Mesh>>,
}

/// The assets that surfaces are turned into.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct TexelAssets<'w> {
    pub meshes: ResMut<'w, Assets<Mesh>>,
    images: ResMut<'w, Assets<Image>>,
    buffers: ResMut<'w, Assets<ShaderBuffer>>,
    materials: ResMut<'w, Assets<TexelMaterial>>,
    pub volumes: Res<'w, Assets<TexelVolume>>,
}

/// What there is to draw of a surface.
pub(crate) enum Drawn<'a> {
    /// Its mesh or volume is not there yet.
    NotYet,
    /// Its mesh carries no texels.
    Nothing,
    /// Facets, what there is of the volume, and materials for colours across u, v and w, and for depth.
    Slices(&'a Geometry, VolumeMeasure, [Handle<TexelMaterial>; 6]),
}

impl TexelKeys {
    /// The same for another volume.
    pub(crate) fn with_volume(mut self, id: AssetId<TexelVolume>) -> Self {
        self.geometry.volume.id = id;
        self
    }
}

impl TexelLibrary {
    /// The mesh that stands for slices in Bevy's phases, and is never drawn: what is drawn are lists of slices.
    pub(crate) fn quad(&mut self, meshes: &mut Assets<Mesh>) -> Handle<Mesh> {
        let add = || {
            // Kept, so that it is there again on a device that takes the place of a lost one.
            let usage = RenderAssetUsages::default();
            let mesh = Mesh::new(PrimitiveTopology::TriangleStrip, usage)
                .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, vec![Vec3::ZERO; 4])
                // Bevy warns of meshes without, in a normal prepass.
                .with_inserted_attribute(Mesh::ATTRIBUTE_NORMAL, vec![Vec3::Z; 4]);
            meshes.add(mesh)
        };
        self.quad.get_or_insert_with(add).clone()
    }

    /// What a surface is drawn with. `heights` are its own, if it has any.
    #[expect(
        clippy::too_many_arguments,
        reason = "all that a surface's looks depend on"
    )]
    pub(crate) fn drawn(
        &mut self,
        keys: TexelKeys,
        surface: &TexelSurface,
        settings: &TexelSettings,
        heights: Option<&TexelHeights>,
        most_layers: u32,
        wind: Vec3,
        assets: &mut TexelAssets,
    ) -> Drawn<'_> {
        // A volume is cut into slices for what there is to draw.
        match self.geometries.get(&keys.geometry) {
            Some(None) => return Drawn::Nothing,
            None if !assets.meshes.contains(keys.geometry.mesh) => return Drawn::NotYet,
            _ => {}
        }
        let Some(volume) = self.volume(keys.geometry.volume, most_layers, assets) else {
            return Drawn::NotYet;
        };
        let measure = volume.measure;
        if !self.geometries.contains_key(&keys.geometry) {
            let Some(mesh) = assets.meshes.get(keys.geometry.mesh) else {
                return Drawn::NotYet;
            };
            let found = told_facets(keys.geometry.mesh, mesh, surface.thickness, heights);
            let geometry =
                found.and_then(|facets| Geometry::new(&facets, measure.most, &mut assets.buffers));
            self.geometries.insert(keys.geometry, geometry);
        }
        let Some(Some(geometry)) = self.geometries.get(&keys.geometry) else {
            return Drawn::Nothing;
        };
        let volumes = &self.volumes;
        let measure = VolumeMeasure {
            most: geometry.most,
            ..measure
        };
        let materials = self.materials.entry(keys).or_insert_with(|| {
            let images = &volumes[&keys.geometry.volume].images;
            let sets = [0, 1, 2, 3, 4, 5].map(|i| (SliceAxis::ALL[i % 3], i >= 3));
            sets.map(|(axis, depth)| {
                let [color, normal] = images[axis.index()].clone();
                assets.materials.add(TexelMaterial {
                    texels: TexelsUniform::new(&measure, settings, wind),
                    facets: geometry.buffer.clone(),
                    color,
                    normal,
                    axis,
                    // Until `follow_lights` says otherwise, in this very frame.
                    lighting: settings.lighting.into(),
                    depth,
                })
            })
        });
        Drawn::Slices(geometry, measure, materials.clone())
    }

    fn volume(
        &mut self,
        key: VolumeKey,
        most_layers: u32,
        assets: &mut TexelAssets,
    ) -> Option<&SharedVolume> {
        if !self.volumes.contains_key(&key) {
            let volume = &assets.volumes.get(key.id)?.0;
            // Sets of 1, 2, 4 and so on slices are 2N − 1 layers.
            let most = key.most.clamp(1, most_layers.div_ceil(2));
            let sets = SliceSets::new(volume, most);
            let images = slice_images(&sets).map(|both| both.map(|image| assets.images.add(image)));
            let measure = VolumeMeasure::of(volume, most);
            self.volumes.insert(key, SharedVolume { measure, images });
        }
        self.volumes.get(&key)
    }

    /// Forgets what was made of volumes that were edited, so that it is made anew.
    pub(crate) fn forget_volume(&mut self, id: AssetId<TexelVolume>) {
        self.volumes.retain(|key, _| key.id != id);
        self.geometries.retain(|key, _| key.volume.id != id);
        self.materials
            .retain(|keys, _| keys.geometry.volume.id != id);
    }

    /// Tells all materials of a change of wind.
    pub(crate) fn follow_wind(&self, wind: Vec3, materials: &mut Assets<TexelMaterial>) {
        for handle in self.materials.values().flatten() {
            // Stiff ones are not written to, and so not uploaded.
            if let Some(mut material) = materials.get_mut(handle)
                && material.texels.wind.w != 0.0
                && material.texels.wind.truncate() != wind
            {
                let flexibility = material.texels.wind.w;
                material.texels.wind = wind.extend(flexibility);
            }
        }
    }

    /// Tells all materials which lighting the scene's lights call for.
    pub(crate) fn follow_lights(
        &self,
        lights: &SceneLights,
        materials: &mut Assets<TexelMaterial>,
    ) {
        for (keys, handles) in &self.materials {
            let lighting = lights.lighting(keys.lighting);
            for handle in handles {
                // Only what is written to counts as changed.
                if let Some(mut material) = materials.get_mut(handle)
                    && material.lighting != lighting
                {
                    material.lighting = lighting;
                }
            }
        }
    }

    /// Follows a mesh that was edited, on all surfaces but those that are live.
    pub(crate) fn follow_mesh(
        &mut self,
        id: AssetId<Mesh>,
        is_live: impl Fn(Entity) -> bool,
        assets: &mut TexelAssets,
    ) {
        let of_mesh = |key: &&GeometryKey| key.mesh == id && !key.own.is_some_and(&is_live);
        let keys: Vec<GeometryKey> = self.geometries.keys().filter(of_mesh).copied().collect();
        for key in keys {
            if key.own.is_none() {
                self.renew(key, None, assets);
            } else {
                // Its surface makes it anew, with height vectors of its own.
                self.geometries.remove(&key);
                self.materials.retain(|keys, _| keys.geometry != key);
            }
        }
    }

    /// Follows the mesh and the height vectors of a surface that shares its geometry with none.
    pub(crate) fn renew(
        &mut self,
        key: GeometryKey,
        heights: Option<&TexelHeights>,
        assets: &mut TexelAssets,
    ) {
        let Some(geometry) = self.geometries.get_mut(&key) else {
            return;
        };
        let thickness = f32::from_bits(key.thickness);
        let mesh = assets.meshes.get(key.mesh);
        let found = mesh.and_then(|mesh| facets(mesh, thickness, heights).ok());
        let volume = self.volumes.get(&key.volume);
        let is_stale = match (geometry, volume, found) {
            (Some(geometry), Some(volume), Some(found)) if !found.facets.is_empty() => {
                geometry.renew(&found, volume.measure.most, &mut assets.buffers)
            }
            // What is still wrong was told when it went wrong.
            (None, _, None) => return,
            (None, _, Some(found)) if found.facets.is_empty() => return,
            _ => {
                // It is looked at anew, and told if it is wrong.
                self.geometries.remove(&key);
                true
            }
        };
        if is_stale {
            self.materials.retain(|keys, _| keys.geometry != key);
        }
    }

    /// Forgets what else was made for a surface of its own, as for the other volumes of a cycle.
    pub(crate) fn forget_others(&mut self, key: GeometryKey) {
        let is_other = |k: &GeometryKey| k.own.is_some() && k.own == key.own && *k != key;
        self.geometries.retain(|k, _| !is_other(k));
        self.materials.retain(|k, _| !is_other(&k.geometry));
    }

    /// Forgets everything, on a device that has taken a lost one's place and has nothing of what was there.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }

    /// Forgets what no surface uses any more.
    pub(crate) fn keep(&mut self, used: &HashSet<TexelKeys>) {
        self.materials.retain(|keys, _| used.contains(keys));
        let geometries: HashSet<_> = used.iter().map(|keys| keys.geometry).collect();
        // What was told once need not be told again.
        self.geometries
            .retain(|key, geometry| geometries.contains(key) || geometry.is_none());
        let volumes: HashSet<_> = geometries.iter().map(|key| key.volume).collect();
        self.volumes.retain(|key, _| volumes.contains(key));
    }
}

/// The facets of a mesh; none, and a message, if it has none.
fn told_facets(
    id: AssetId<Mesh>,
    mesh: &Mesh,
    thickness: f32,
    heights: Option<&TexelHeights>,
) -> Option<SurfaceFacets> {
    let found = match facets(mesh, thickness, heights) {
        Ok(found) => found,
        Err(error) => {
            error!("mesh {id:?} carries no texels: {error}");
            return None;
        }
    };
    if let Some((triangle, fault)) = found.left_out.first() {
        warn!(
            "mesh {id:?}: {} of its triangles carry no texels, the first is {triangle}: {fault}",
            found.left_out.len()
        );
    }
    (!found.facets.is_empty()).then_some(found)
}

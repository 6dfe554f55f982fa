//! What is on the GPU for the surfaces and volumes in use.

use bevy::asset::AssetId;
use bevy::image::Image;
use bevy::math::UVec3;
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;
use bevy::render::storage::ShaderBuffer;

use super::super::asset::TexelVolume;
use super::super::axis::SliceAxis;
use super::super::choose::VolumeMeasure;
use super::super::slice_sets::SliceSets;
use super::component::{TexelSettings, TexelSurface};
use super::geometry::{Geometry, facets};
use super::images::slice_images;
use super::material::{TexelMaterial, TexelsUniform};

/// A volume of which so many slices are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct VolumeKey {
    id: AssetId<TexelVolume>,
    most: u32,
}

/// A mesh that carries so thick texels of a volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct GeometryKey {
    mesh: AssetId<Mesh>,
    thickness: u32,
    volume: VolumeKey,
}

/// Surfaces that are drawn together: one mesh, one volume, the same settings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct TexelKeys {
    pub geometry: GeometryKey,
    settings: [u32; 9],
}

impl TexelKeys {
    pub(crate) fn new(
        surface: &TexelSurface,
        mesh: AssetId<Mesh>,
        settings: &TexelSettings,
    ) -> Self {
        let quality = &settings.quality;
        Self {
            geometry: GeometryKey {
                mesh,
                thickness: surface.thickness.to_bits(),
                volume: VolumeKey {
                    id: surface.volume.id(),
                    most: settings.most_slices,
                },
            },
            settings: [
                quality.direction as u32,
                quality.depth.to_bits(),
                quality.pixels.to_bits(),
                settings.shadows.depth.to_bits(),
                settings.shadows.pixels.to_bits(),
                settings.lit.into(),
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
    materials: HashMap<TexelKeys, [Handle<TexelMaterial>; 3]>,
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

impl TexelLibrary {
    /// What a surface is drawn with: slots, bounds, and materials across u, v and w. None while its mesh or volume is not there, or
    /// if the mesh carries no texels.
    pub(crate) fn drawn(
        &mut self,
        keys: TexelKeys,
        surface: &TexelSurface,
        settings: &TexelSettings,
        most_layers: u32,
        wind: Vec3,
        assets: &mut TexelAssets,
    ) -> Option<(&Geometry, [Handle<TexelMaterial>; 3])> {
        let volume = self.volume(keys.geometry.volume, most_layers, assets)?;
        let measure = volume.measure;
        let images = volume.images.clone();
        let geometry = match self.geometries.get(&keys.geometry) {
            Some(Some(_)) => self.geometries.get(&keys.geometry)?.as_ref()?,
            Some(None) => return None,
            None => {
                let geometry =
                    new_geometry(keys.geometry, surface.thickness, measure.most, assets)?;
                self.geometries
                    .entry(keys.geometry)
                    .insert(geometry)
                    .into_mut()
                    .as_ref()?
            }
        };
        let materials = self.materials.entry(keys).or_insert_with(|| {
            let measure = VolumeMeasure {
                most: geometry.most,
                ..measure
            };
            SliceAxis::ALL.map(|axis| {
                let [color, normal] = images[axis.index()].clone();
                assets.materials.add(TexelMaterial {
                    texels: TexelsUniform::new(&measure, settings, wind),
                    facets: geometry.facets.clone(),
                    color,
                    normal,
                    axis,
                    lit: settings.lit,
                })
            })
        });
        Some((geometry, materials.clone()))
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
            let is_stiff = materials
                .get(handle)
                .is_none_or(|known| known.texels.wind.w == 0.0);
            if !is_stiff && let Some(mut material) = materials.get_mut(handle) {
                let flexibility = material.texels.wind.w;
                material.texels.wind = wind.extend(flexibility);
            }
        }
    }

    /// Follows a mesh that was edited.
    pub(crate) fn follow_mesh(&mut self, id: AssetId<Mesh>, assets: &mut TexelAssets) {
        let mut replaced = HashSet::new();
        for (key, geometry) in &mut self.geometries {
            if key.mesh != id {
                continue;
            }
            let thickness = f32::from_bits(key.thickness);
            let found = assets.meshes.get(id).map(|mesh| facets(mesh, thickness));
            let (Some(Ok(found)), Some(geometry), Some(volume)) =
                (found, geometry.as_mut(), self.volumes.get(&key.volume))
            else {
                replaced.insert(*key);
                continue;
            };
            let before = (geometry.facets.clone(), geometry.most);
            geometry.renew(
                &found.facets,
                volume.measure.most,
                &mut assets.meshes,
                &mut assets.buffers,
            );
            if before != (geometry.facets.clone(), geometry.most) {
                self.materials.retain(|keys, _| keys.geometry != *key);
            }
        }
        self.geometries.retain(|key, _| !replaced.contains(key));
        self.materials
            .retain(|keys, _| !replaced.contains(&keys.geometry));
    }

    /// Forgets what no surface uses any more.
    pub(crate) fn keep(&mut self, used: &HashSet<TexelKeys>) {
        self.materials.retain(|keys, _| used.contains(keys));
        let geometries: HashSet<_> = used.iter().map(|keys| keys.geometry).collect();
        self.geometries.retain(|key, _| geometries.contains(key));
        let volumes: HashSet<_> = geometries.iter().map(|key| key.volume).collect();
        self.volumes.retain(|key, _| volumes.contains(key));
    }
}

/// The geometry of a mesh; none if there is none to be had, and nothing if the mesh is not there yet.
#[expect(clippy::option_option, reason = "not yet, and never")]
fn new_geometry(
    key: GeometryKey,
    thickness: f32,
    most: UVec3,
    assets: &mut TexelAssets,
) -> Option<Option<Geometry>> {
    let mesh = assets.meshes.get(key.mesh)?;
    let found = match facets(mesh, thickness) {
        Ok(found) => found,
        Err(error) => {
            error!("mesh {:?} carries no texels: {error}", key.mesh);
            return Some(None);
        }
    };
    if let Some((triangle, fault)) = found.left_out.first() {
        warn!(
            "mesh {:?}: {} of its triangles carry no texels, the first is {triangle}: {fault}",
            key.mesh,
            found.left_out.len()
        );
    }
    if found.facets.is_empty() {
        return Some(None);
    }
    let geometry = Geometry::new(&found.facets, most, &mut assets.meshes, &mut assets.buffers);
    Some(Some(geometry))
}

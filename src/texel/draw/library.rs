//! What is on the GPU for the surfaces and volumes in use.

use std::sync::Arc;

use bevy::asset::{AssetId, RenderAssetUsages};
use bevy::ecs::name::NameOrEntityItem;
use bevy::image::Image;
use bevy::mesh::PrimitiveTopology;
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;

use super::super::asset::TexelVolume;
use super::super::axis::SliceAxis;
use super::super::choose::VolumeMeasure;
use super::super::facet::SurfaceFacets;
use super::super::slice_sets::{SliceBoxes, SliceSets};
use super::component::{TexelHeights, TexelSettings, TexelSurface};
use super::geometry::{Geometry, completed, facets, facets_within};
use super::images::slice_images;
use super::limit::DeviceLimits;
use super::material::{TexelMaterial, TexelsUniform};
use super::room::FacetSpace;
use super::skin::Skin;
use super::source::DrawnVolume;
use super::surface_mesh::TexelSurfaceError;
use crate::lighting::{PlantLighting, SceneLights, limited_transmission};

/// A volume of which so many slices are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct VolumeKey {
    id: AssetId<TexelVolume>,
    most: u32,
}

/// A mesh that carries so thick texels; `own` is the surface that shares it with none.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct GeometryKey {
    mesh: AssetId<Mesh>,
    thickness: u32,
    own: Option<Entity>,
}

/// Surfaces that share materials: one volume, the same looks, whatever their meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct MaterialKey {
    volume: VolumeKey,
    lighting: PlantLighting,
    /// Other settings that materials have.
    settings: [u32; 5],
}

/// What a surface shares with others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct TexelKeys {
    pub geometry: GeometryKey,
    material: MaterialKey,
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
                own,
            },
            material: MaterialKey {
                volume: VolumeKey {
                    id: surface.volume.id(),
                    most: settings.most_slices,
                },
                lighting: settings.lighting,
                settings: [
                    settings.roughness.to_bits(),
                    settings.reflectance.to_bits(),
                    settings.flexibility.to_bits(),
                    settings.inner_slices,
                    limited_transmission(settings.diffuse_transmission).to_bits(),
                ],
            },
        }
    }
}

/// A volume's slices.
struct SharedVolume {
    measure: VolumeMeasure,
    boxes: Arc<SliceBoxes>,
    /// Colours and normals across u, v and w.
    images: [[Handle<Image>; 2]; 3],
}

/// What is on the GPU, as long as a surface uses it.
#[derive(Resource, Default)]
pub(crate) struct TexelLibrary {
    volumes: HashMap<VolumeKey, SharedVolume>,
    /// None for a mesh that carries no texels, which has been told.
    geometries: HashMap<GeometryKey, Option<Geometry>>,
    /// Where facets are on the GPU.
    pub space: FacetSpace,
    /// Counts frames.
    pub frame: u64,
    materials: HashMap<MaterialKey, [Handle<TexelMaterial>; 6]>,
    /// What Bevy's phases have in place of slices.
    quad: Option<Handle<Mesh>>,
    /// Whether surfaces may have to be drawn with other things than they are.
    pub is_stale: bool,
}

/// The assets that surfaces are turned into.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct TexelAssets<'w> {
    pub meshes: ResMut<'w, Assets<Mesh>>,
    images: ResMut<'w, Assets<Image>>,
    materials: ResMut<'w, Assets<TexelMaterial>>,
    pub volumes: Res<'w, Assets<TexelVolume>>,
    server: Option<Res<'w, AssetServer>>,
    /// None without a renderer.
    pub device: Option<Res<'w, RenderDevice>>,
}

impl TexelAssets<'_> {
    fn limits(&self) -> DeviceLimits {
        DeviceLimits::of(self.device.as_deref())
    }

    /// What messages call a volume by.
    fn volume_name(&self, volume: AssetId<TexelVolume>) -> String {
        let path = self
            .server
            .as_ref()
            .and_then(|server| server.get_path(volume));
        match path {
            Some(path) => format!("volume {path}"),
            None => format!("volume {volume}"),
        }
    }

    /// What messages call a mesh by: where it was loaded from, or a surface that has it.
    fn mesh_name(&self, mesh: AssetId<Mesh>, owner: &NameOrEntityItem) -> String {
        let path = self
            .server
            .as_ref()
            .and_then(|server| server.get_path(mesh));
        match (path, owner.name) {
            (Some(path), _) => format!("mesh {path}"),
            (None, Some(name)) => format!("the mesh of {name} ({})", owner.entity),
            (None, None) => format!("the mesh of {}", owner.entity),
        }
    }
}

/// What there is to draw of a surface.
pub(crate) enum Drawn<'a> {
    /// Its mesh or volume is not there yet.
    NotYet,
    /// Its mesh carries no texels.
    Nothing,
    /// Facets, slices of the volume, and materials for colours across u, v and w, and for depth.
    Slices(&'a Geometry, DrawnVolume, [Handle<TexelMaterial>; 6]),
}

impl TexelKeys {
    /// The same for another volume.
    pub(crate) fn with_volume(mut self, id: AssetId<TexelVolume>) -> Self {
        self.material.volume.id = id;
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

    /// What a surface is drawn with. `heights` are its own, if it has any; messages name its `owner`.
    pub(crate) fn drawn(
        &mut self,
        keys: TexelKeys,
        owner: &NameOrEntityItem,
        settings: &TexelSettings,
        heights: Option<&TexelHeights>,
        wind: Vec3,
        assets: &mut TexelAssets,
    ) -> Drawn<'_> {
        // A volume is cut into slices for what there is to draw.
        match self.geometries.get(&keys.geometry) {
            Some(None) => return Drawn::Nothing,
            None if !assets.meshes.contains(keys.geometry.mesh) => return Drawn::NotYet,
            _ => {}
        }
        let Some(volume) = self.volume(keys.material.volume, assets) else {
            return Drawn::NotYet;
        };
        let measure = volume.measure;
        if !self.geometries.contains_key(&keys.geometry) {
            let Some(mesh) = assets.meshes.get(keys.geometry.mesh) else {
                return Drawn::NotYet;
            };
            let name = assets.mesh_name(keys.geometry.mesh, owner);
            let thickness = f32::from_bits(keys.geometry.thickness);
            let most = assets.limits().facets;
            let found = told_facets(&name, mesh, thickness, heights, most);
            let geometry = found.map(|facets| Geometry::new(&facets, &self.space, most));
            self.geometries.insert(keys.geometry, geometry);
        }
        let Some(Some(geometry)) = self.geometries.get_mut(&keys.geometry) else {
            return Drawn::Nothing;
        };
        let Some(most) = geometry.most(measure.most) else {
            return Drawn::Nothing;
        };
        let volumes = &self.volumes;
        let measure = VolumeMeasure { most, ..measure };
        let materials = self.materials.entry(keys.material).or_insert_with(|| {
            let images = &volumes[&keys.material.volume].images;
            let sets = [0, 1, 2, 3, 4, 5].map(|i| (SliceAxis::ALL[i % 3], i >= 3));
            sets.map(|(axis, depth)| {
                let [color, normal] = images[axis.index()].clone();
                assets.materials.add(TexelMaterial {
                    texels: TexelsUniform::new(&measure, settings, wind),
                    color,
                    normal,
                    axis,
                    // Until `follow_lights` says otherwise, in this very frame.
                    lighting: settings.lighting.into(),
                    depth,
                })
            })
        });
        let volume = DrawnVolume {
            measure,
            boxes: volumes[&keys.material.volume].boxes.clone(),
        };
        Drawn::Slices(geometry, volume, materials.clone())
    }

    fn volume(&mut self, key: VolumeKey, assets: &mut TexelAssets) -> Option<&SharedVolume> {
        if !self.volumes.contains_key(&key) {
            let volume = &assets.volumes.get(key.id)?.0;
            let limits = assets.limits();
            if let Some(fewer) = fewer_slices(volume.size(), key.most, limits) {
                warn!("{}: {fewer}", assets.volume_name(key.id));
            }
            let most = key.most.clamp(1, limits.slices());
            let sets = SliceSets::new(volume, most);
            let images = slice_images(&sets).map(|both| both.map(|image| assets.images.add(image)));
            let measure = VolumeMeasure::of(volume, most);
            let shared = SharedVolume {
                measure,
                boxes: Arc::new(SliceBoxes::of(&sets)),
                images,
            };
            self.volumes.insert(key, shared);
        }
        self.volumes.get(&key)
    }

    /// Forgets what was made of volumes that were edited, so that it is made anew.
    pub(crate) fn forget_volume(&mut self, id: AssetId<TexelVolume>) {
        self.volumes.retain(|key, _| key.id != id);
        self.materials.retain(|key, _| key.volume.id != id);
        self.is_stale = true;
    }

    /// Whether anything was made of a volume.
    pub(crate) fn uses_volume(&self, id: AssetId<TexelVolume>) -> bool {
        self.volumes.keys().any(|key| key.id == id)
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
        for (key, handles) in &self.materials {
            let lighting = lights.lighting(key.lighting);
            // Depth has no light.
            for handle in &handles[..3] {
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
        assets: &TexelAssets,
    ) {
        let of_mesh = |key: &&GeometryKey| key.mesh == id && !key.own.is_some_and(&is_live);
        let keys: Vec<GeometryKey> = self.geometries.keys().filter(of_mesh).copied().collect();
        for key in keys {
            if key.own.is_none() {
                self.renew(key, None, assets);
            } else {
                // Its surface makes it anew, with height vectors of its own.
                self.geometries.remove(&key);
            }
            self.is_stale = true;
        }
    }

    /// Follows the mesh and the height vectors of a surface that shares its geometry with none.
    pub(crate) fn renew(
        &mut self,
        key: GeometryKey,
        heights: Option<&TexelHeights>,
        assets: &TexelAssets,
    ) {
        let Some(geometry) = self.geometries.get_mut(&key) else {
            return;
        };
        let thickness = f32::from_bits(key.thickness);
        let most = assets.limits().facets;
        let mesh = assets.meshes.get(key.mesh);
        let found = mesh.and_then(|mesh| facets(mesh, thickness, heights, most).ok());
        match (geometry, found) {
            (Some(geometry), Some(found)) if !found.facets.is_empty() => {
                geometry.renew(&found, &self.space, most);
            }
            // What is still wrong was told when it went wrong.
            (None, None) => {}
            (None, Some(found)) if found.facets.is_empty() => {}
            _ => {
                // It is looked at anew, and told if it is wrong.
                self.geometries.remove(&key);
            }
        }
    }

    /// Poses the mesh of a surface that shares its geometry with none, and tells how it is then; none if nothing of it is
    /// drawn, or nothing of it could be as it is posed.
    ///
    /// # Errors
    /// When it cannot be posed. It stays as it was.
    pub(crate) fn pose(
        &mut self,
        key: GeometryKey,
        heights: Option<&TexelHeights>,
        matrices: &[Mat4],
        assets: &TexelAssets,
    ) -> Result<Option<&Geometry>, TexelSurfaceError> {
        let (Some(Some(geometry)), Some(mesh)) =
            (self.geometries.get_mut(&key), assets.meshes.get(key.mesh))
        else {
            return Ok(None);
        };
        let mut surface = completed(mesh, f32::from_bits(key.thickness), heights)?;
        Skin::of(mesh, surface.positions.len())?.pose(&mut surface, matrices)?;
        let most = assets.limits().facets;
        let found = facets_within(&surface, most)?;
        if found.facets.is_empty() {
            return Ok(None);
        }
        geometry.renew(&found, &self.space, most);
        Ok(Some(geometry))
    }

    /// The facets of all surfaces.
    pub(crate) fn geometries(&self) -> impl Iterator<Item = &Geometry> {
        self.geometries.values().flatten()
    }

    /// Begins a frame in which no facet has changed yet.
    pub(crate) fn settle(&mut self) {
        self.frame += 1;
        for geometry in self.geometries.values_mut().flatten() {
            geometry.settle();
        }
    }

    /// Forgets what was told of a surface that is gone.
    pub(crate) fn forget_owner(&mut self, owner: Entity) {
        self.geometries
            .retain(|key, geometry| geometry.is_some() || key.own != Some(owner));
    }

    /// Whether a mesh was looked at.
    pub(crate) fn uses_mesh(&self, id: AssetId<Mesh>) -> bool {
        self.geometries.keys().any(|key| key.mesh == id)
    }

    /// Forgets what was told of a mesh that is gone.
    pub(crate) fn forget_mesh(&mut self, id: AssetId<Mesh>) {
        self.geometries
            .retain(|key, geometry| geometry.is_some() || key.mesh != id);
    }

    /// Forgets everything, on a device that has taken a lost one's place and has nothing of what was there.
    pub(crate) fn clear(&mut self) {
        *self = Self {
            is_stale: true,
            frame: self.frame,
            ..Self::default()
        };
    }

    /// Forgets what no surface uses any more.
    pub(crate) fn keep(&mut self, used: &HashSet<TexelKeys>) {
        let materials: HashSet<_> = used.iter().map(|keys| keys.material).collect();
        self.materials.retain(|key, _| materials.contains(key));
        let geometries: HashSet<_> = used.iter().map(|keys| keys.geometry).collect();
        // What was told once need not be told again.
        self.geometries
            .retain(|key, geometry| geometries.contains(key) || geometry.is_none());
        let volumes: HashSet<_> = materials.iter().map(|key| key.volume).collect();
        self.volumes.retain(|key, _| volumes.contains(key));
    }
}

/// What to tell of a volume that has fewer slices on a device than are asked for.
fn fewer_slices(size: UVec3, asked: u32, limits: DeviceLimits) -> Option<String> {
    let even = |most: u32| size.max_element().min(1 << most.max(1).ilog2());
    let (wanted, most) = (even(asked), even(limits.slices()));
    (wanted > most).then(|| {
        format!(
            "a texel gets {most} slices instead of {wanted}, for texture arrays have {} layers on this device. Set \
             TexelSettings::most_slices to {most}, or ask for more max_texture_array_layers in the renderer's WgpuSettings",
            limits.layers
        )
    })
}

/// The facets of a mesh; none, and a message, if it has none, or more than `most`.
fn told_facets(
    name: &str,
    mesh: &Mesh,
    thickness: f32,
    heights: Option<&TexelHeights>,
    most: usize,
) -> Option<SurfaceFacets> {
    let found = match facets(mesh, thickness, heights, most) {
        Ok(found) => found,
        Err(error) => {
            error!("{name} carries no texels: {error}");
            return None;
        }
    };
    for warning in warnings(name, mesh, &found) {
        warn!("{warning}");
    }
    (!found.facets.is_empty()).then_some(found)
}

/// What a mesh that carries texels, at least in part, does not show.
fn warnings(name: &str, mesh: &Mesh, found: &SurfaceFacets) -> Vec<String> {
    let left_out = found.left_out.first().map(|(triangle, fault)| {
        format!(
            "{name}: {} of its triangles carry no texels, the first is {triangle}: {fault}",
            found.left_out.len()
        )
    });
    let is_morphed = mesh.try_has_morph_targets().unwrap_or(false);
    let morphed = is_morphed.then(|| {
        format!(
            "{name} has morph targets, which texels do not follow: they stay where it is at rest. Change its vertices instead, \
             on an entity with LiveTexels, or pose it by joints (SkinnedMesh)"
        )
    });
    left_out.into_iter().chain(morphed).collect()
}

#[cfg(test)]
mod tests {
    use bevy::mesh::morph::MorphAttributes;

    use super::*;

    #[test]
    fn meshes_of_more_triangles_than_the_device_holds_are_refused() {
        let mesh = Plane3d::default().mesh().build();
        let within = |most| facets(&mesh, 0.1, None, most);
        assert_eq!(within(2).expect("two triangles").facets.len(), 2);
        let error = within(1).unwrap_err().to_string();
        for part in ["2 triangles", "holds 1", "144 bytes", "split the mesh"] {
            assert!(error.contains(part), "{error}");
        }
        assert_eq!(told_facets("mesh lawn.glb", &mesh, 0.1, None, 1), None);
    }

    #[test]
    fn slices_that_a_device_has_no_layers_for_are_told_with_what_to_do() {
        let limits = DeviceLimits {
            layers: 256,
            facets: 1,
            surfaces: 1,
        };
        let size = UVec3::new(256, 64, 32);
        let told = fewer_slices(size, 300, limits).expect("256 are wanted");
        for part in [
            "128 slices instead of 256",
            "256 layers",
            "most_slices to 128",
        ] {
            assert!(told.contains(part), "{told}");
        }
        assert_eq!(fewer_slices(size, 128, limits), None);
        assert_eq!(fewer_slices(size / 2, 256, limits), None);
        assert_eq!(fewer_slices(size, 0, limits), None);
    }

    #[test]
    fn morph_targets_are_warned_of_by_name_and_with_what_to_do() {
        let mut mesh = Plane3d::default().mesh().build();
        let told = |mesh: &Mesh| {
            let found = facets(mesh, 0.1, None, 2).expect("it has texture coordinates");
            warnings("mesh lawn.glb", mesh, &found)
        };
        assert!(told(&mesh).is_empty());
        let vertices = mesh.count_vertices();
        mesh.set_morph_targets(vec![MorphAttributes::default(); vertices]);
        let [warning] = told(&mesh).try_into().expect("one warning");
        for part in ["mesh lawn.glb", "morph targets", "LiveTexels"] {
            assert!(warning.contains(part), "{warning}");
        }
    }
}

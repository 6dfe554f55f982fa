//! What is on the GPU for the slicings in use, and the systems that keep it up to date.

use bevy::asset::prelude::AssetChanged;
use bevy::asset::{AssetEvent, AssetId};
use bevy::camera::Hdr;
use bevy::camera::primitives::Aabb;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::image::Image;
use bevy::mesh::MeshTag;
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;
use bevy::render::renderer::RenderDevice;
use bevy::render::storage::ShaderBuffer;

use super::blend::{PART_SLOTS, SLOTS, widest};
use super::component::{CrownSettings, CrownTint, SlicedCrown};
use super::compression::SlicingCompression;
use super::material::{CrownUniform, SlicedCrownMaterial};
use super::mesh::crown_mesh;
use super::near::Nearness;
use super::slicing::Slicing;
use super::upload::{bounds, images, octagons};
use crate::lighting::SceneLights;
use crate::wind::Wind;

/// Slicings that are drawn at once of a crown far away, and near by.
const SLOTS_BY_NEARNESS: [usize; 2] = [SLOTS, PART_SLOTS];

/// What a crown is drawn with.
pub(crate) type Look = (Mesh3d, MeshMaterial3d<SlicedCrownMaterial>);

/// What crowns of one slicing share.
pub(crate) struct Shared {
    /// For crowns far away, and near by.
    meshes: [Handle<Mesh>; 2],
    color: Handle<Image>,
    normal: Handle<Image>,
    octagons: Handle<ShaderBuffer>,
    bounds: Aabb,
    /// The centroid, local, and the radius.
    pub(crate) ball: (Vec3, f32),
    /// Whether parts may be seen from directions of their own.
    pub(crate) has_parts: bool,
    compressed: bool,
    /// For crowns far away, and near by.
    materials: HashMap<CrownSettings, [Handle<SlicedCrownMaterial>; 2]>,
}

/// What is on the GPU, by slicing, as long as a crown uses it.
#[derive(Resource, Default)]
pub(crate) struct CrownLibrary {
    pub(crate) shared: HashMap<AssetId<Slicing>, Shared>,
}

/// The assets that slicings are turned into, and what they are turned into them for.
#[derive(bevy::ecs::system::SystemParam)]
pub(crate) struct CrownAssets<'w> {
    meshes: ResMut<'w, Assets<Mesh>>,
    images: ResMut<'w, Assets<Image>>,
    buffers: ResMut<'w, Assets<ShaderBuffer>>,
    materials: ResMut<'w, Assets<SlicedCrownMaterial>>,
    compression: Res<'w, SlicingCompression>,
    device: Option<Res<'w, RenderDevice>>,
}

impl CrownAssets<'_> {
    /// Whether all images are to be made anew: another device has nothing of what was there.
    fn are_outdated(&self) -> bool {
        let is_new_device = self
            .device
            .as_ref()
            .is_some_and(|device| device.is_changed());
        is_new_device || self.compression.is_changed()
    }

    fn compresses(&self, slicing: &Slicing) -> bool {
        let pixels = slicing.shape().pixels;
        let device = self.device.as_ref();
        device.is_some_and(|device| self.compression.applies(pixels, device.features()))
    }
}

impl Shared {
    fn new(slicing: &Slicing, assets: &mut CrownAssets) -> Self {
        let compressed = assets.compresses(slicing);
        let [color, normal] = images(slicing, compressed);
        Self {
            meshes: SLOTS_BY_NEARNESS
                .map(|slots| assets.meshes.add(crown_mesh(slicing.shape(), slots))),
            color: assets.images.add(color),
            normal: assets.images.add(normal),
            octagons: assets.buffers.add(octagons(slicing)),
            bounds: bounds(slicing),
            ball: (slicing.shape().centroid, slicing.shape().radius),
            has_parts: widest(slicing.shape()) > 0.0,
            compressed,
            materials: HashMap::default(),
        }
    }

    /// Follows a slicing that was edited.
    fn renew(&mut self, slicing: &Slicing, wind: Vec3, assets: &mut CrownAssets) {
        self.compressed = assets.compresses(slicing);
        let [color, normal] = images(slicing, self.compressed);
        let is_kept = [
            assets.images.insert(self.color.id(), color).is_ok(),
            assets.images.insert(self.normal.id(), normal).is_ok(),
            assets
                .buffers
                .insert(self.octagons.id(), octagons(slicing))
                .is_ok(),
        ];
        for (mesh, slots) in self.meshes.iter().zip(SLOTS_BY_NEARNESS) {
            let mesh = assets
                .meshes
                .insert(mesh.id(), crown_mesh(slicing.shape(), slots));
            debug_assert!(mesh.is_ok(), "handles keep their assets");
        }
        debug_assert!(
            is_kept.into_iter().all(|kept| kept),
            "handles keep their assets"
        );
        self.bounds = bounds(slicing);
        self.ball = (slicing.shape().centroid, slicing.shape().radius);
        self.has_parts = widest(slicing.shape()) > 0.0;
        for (settings, material) in self.each_material() {
            if let Some(mut material) = assets.materials.get_mut(material) {
                material.crown = CrownUniform::new(slicing.shape(), settings, wind);
                material.compressed = self.compressed;
            }
        }
    }

    fn each_material(
        &self,
    ) -> impl Iterator<Item = (&CrownSettings, &Handle<SlicedCrownMaterial>)> {
        let all = self.materials.iter();
        all.flat_map(|(settings, pair)| pair.iter().map(move |material| (settings, material)))
    }

    /// What a crown is drawn with, far away or near by; nothing before it was given anything.
    pub(crate) fn look(&self, settings: &CrownSettings, is_near: bool) -> Option<Look> {
        let i = usize::from(is_near);
        let material = self.materials.get(settings)?[i].clone();
        Some((Mesh3d(self.meshes[i].clone()), MeshMaterial3d(material)))
    }

    /// Makes what crowns of some settings need, if it is not there.
    fn ensure(
        &mut self,
        slicing: &Slicing,
        settings: CrownSettings,
        wind: Vec3,
        assets: &mut CrownAssets,
    ) {
        let make = |parts| {
            assets.materials.add(SlicedCrownMaterial {
                crown: CrownUniform::new(slicing.shape(), &settings, wind),
                octagons: self.octagons.clone(),
                color: self.color.clone(),
                normal: self.normal.clone(),
                settings,
                // Until `follow_scene` says otherwise, in this very frame.
                lighting: settings.lighting.into(),
                tone_mapped: false,
                compressed: self.compressed,
                parts,
            })
        };
        self.materials
            .entry(settings)
            .or_insert_with(|| [false, true].map(make));
    }
}

/// What tells that a crown needs a (new) material.
type Unattached = Or<(
    Without<MeshMaterial3d<SlicedCrownMaterial>>,
    Changed<SlicedCrown>,
    AssetChanged<SlicedCrown>,
    Changed<CrownSettings>,
)>;

/// Gives crowns whose slicing is there what they are drawn with. One whose slicing is not there yet keeps what it has.
pub(crate) fn attach(
    mut commands: Commands,
    mut library: ResMut<CrownLibrary>,
    mut assets: CrownAssets,
    slicings: Res<Assets<Slicing>>,
    wind: Res<Wind>,
    crowns: Query<(Entity, &SlicedCrown, &CrownSettings), Unattached>,
) {
    if crowns.is_empty() {
        return;
    }
    let wind = wind.limited();
    for (entity, SlicedCrown(handle), settings) in &crowns {
        let Some(slicing) = slicings.get(handle) else {
            continue;
        };
        let shared = library.shared.entry(handle.id());
        let shared = shared.or_insert_with(|| Shared::new(slicing, &mut assets));
        shared.ensure(slicing, *settings, wind, &mut assets);
        let look = shared.look(settings, false);
        let crown = (
            look.expect("it is made"),
            shared.bounds,
            Nearness::default(),
        );
        commands.entity(entity).try_insert(crown);
    }
}

/// Follows slicings that were edited or reloaded, a device that has taken a lost one's place, and the choice of
/// compression.
pub(crate) fn follow_slicings(
    mut events: MessageReader<AssetEvent<Slicing>>,
    mut library: ResMut<CrownLibrary>,
    mut assets: CrownAssets,
    slicings: Res<Assets<Slicing>>,
    wind: Res<Wind>,
) {
    let mut edited: HashSet<AssetId<Slicing>> = HashSet::default();
    for event in events.read() {
        if let AssetEvent::Modified { id } = event {
            edited.insert(*id);
        }
    }
    if assets.are_outdated() {
        edited.extend(library.shared.keys());
    }
    for id in &edited {
        if let (Some(shared), Some(slicing)) = (library.shared.get_mut(id), slicings.get(*id)) {
            shared.renew(slicing, wind.limited(), &mut assets);
        }
    }
}

/// Tells the materials of a change of wind.
pub(crate) fn follow_wind(
    library: Res<CrownLibrary>,
    mut materials: ResMut<Assets<SlicedCrownMaterial>>,
    wind: Res<Wind>,
) {
    let wind = wind.limited().extend(0.0);
    let all = library.shared.values();
    for (_, material) in all.flat_map(Shared::each_material) {
        if let Some(mut material) = materials.get_mut(material) {
            material.crown.wind = wind;
        }
    }
}

/// Tells the materials which lighting the scene's lights call for, and whether its HDR cameras map tones: a camera that does speaks
/// for all.
pub(crate) fn follow_scene(
    library: Res<CrownLibrary>,
    mut materials: ResMut<Assets<SlicedCrownMaterial>>,
    lights: SceneLights,
    cameras: Query<(&Camera, &Tonemapping), With<Hdr>>,
) {
    let is_mapped = |(camera, mapping): (&Camera, &Tonemapping)| {
        camera.is_active && *mapping != Tonemapping::None
    };
    let tone_mapped = cameras.iter().any(is_mapped);
    let all = library.shared.values();
    for (settings, material) in all.flat_map(Shared::each_material) {
        let lighting = lights.lighting(settings.lighting);
        // Only what is written to counts as changed.
        if let Some(mut material) = materials.get_mut(material)
            && (material.lighting, material.tone_mapped) != (lighting, tone_mapped)
        {
            material.lighting = lighting;
            material.tone_mapped = tone_mapped;
        }
    }
}

/// Tells the materials of the brightest sun that casts shadows.
pub(crate) fn follow_sun(
    library: Res<CrownLibrary>,
    mut materials: ResMut<Assets<SlicedCrownMaterial>>,
    suns: Query<(&DirectionalLight, &GlobalTransform, &InheritedVisibility)>,
) {
    let brightest = suns
        .iter()
        .filter(|(sun, _, visible)| sun.shadow_maps_enabled && visible.get())
        .max_by(|(a, ..), (b, ..)| a.illuminance.total_cmp(&b.illuminance));
    let to_sun = brightest.map_or(Vec3::ZERO, |(_, place, _)| place.back().as_vec3());
    let all = library.shared.values();
    for (_, material) in all.flat_map(Shared::each_material) {
        // A day goes by without a new upload in each frame: half a degree is not seen.
        if let Some(mut material) = materials.get_mut(material)
            && material.crown.sun.truncate().distance(to_sun) > 0.01
        {
            material.crown.sun = to_sun.extend(0.0);
        }
    }
}

/// Tells the meshes' tags of changed tints.
pub(crate) fn tint(mut crowns: Query<(Entity, &CrownTint, &mut MeshTag), Changed<CrownTint>>) {
    for (entity, tint, mut tag) in &mut crowns {
        // The places of instances on the GPU change from frame to frame and from pass to pass; an entity stays.
        let [seed, ..] = entity.to_bits().to_le_bytes();
        tag.set_if_neq(MeshTag(tint.tag(seed)));
    }
}

/// Stops drawing an entity that is a crown no more.
pub(crate) fn uproot(removed: On<Remove, SlicedCrown>, mut commands: Commands) {
    if let Ok(mut entity) = commands.get_entity(removed.entity) {
        entity.try_remove::<(Look, Aabb, Nearness)>();
    }
}

/// What tells that a crown may have left something behind.
type Resettled = Or<(Changed<SlicedCrown>, Changed<CrownSettings>)>;

/// Forgets what no crown uses any more.
pub(crate) fn forget(
    mut removed: RemovedComponents<SlicedCrown>,
    mut library: ResMut<CrownLibrary>,
    changed: Query<(), Resettled>,
    crowns: Query<(&SlicedCrown, &CrownSettings)>,
) {
    if removed.read().count() == 0 && changed.is_empty() {
        return;
    }
    let used: HashSet<_> = crowns
        .iter()
        .map(|(crown, settings)| (crown.0.id(), *settings))
        .collect();
    for (id, shared) in &mut library.shared {
        shared
            .materials
            .retain(|settings, _| used.contains(&(*id, *settings)));
    }
    library
        .shared
        .retain(|_, shared| !shared.materials.is_empty());
}

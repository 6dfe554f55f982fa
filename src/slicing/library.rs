//! What is on the GPU for the slicings in use, and the systems that keep it up to date.

use std::sync::Arc;

use bevy::asset::AssetId;
use bevy::asset::prelude::AssetChanged;
use bevy::camera::Hdr;
use bevy::camera::primitives::Aabb;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::image::Image;
use bevy::mesh::MeshTag;
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;
use bevy::render::camera::TemporalJitter;
use bevy::render::renderer::RenderDevice;
use bevy::render::storage::ShaderBuffer;

use super::bands::CrownBands;
use super::blend::{PART_SLOTS, SLOTS, widest};
use super::component::{CrownSettings, CrownTint, SlicedCrown};
use super::compression::SlicingCompression;
use super::gather::Placed;
use super::limits::MAX_LAYERS;
use super::material::{Gathering, SlicedCrownMaterial};
use super::mesh::{bands, crown_mesh, most_slices};
use super::near::DrawnAs;
use super::set::{CrownSet, SetKind, SetSource};
use super::slicing::{Slicing, SlicingShape};
use super::upload::{bounds, data};
use crate::edited_assets::EditedAssets;
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
    /// The same in bands, far to near, if any crown was drawn in them.
    bands: HashMap<DrawnAs, Vec<Handle<Mesh>>>,
    pub(crate) shape: Arc<SlicingShape>,
    /// Its place in the set.
    place: u32,
    bounds: Aabb,
    /// Whether parts may be seen from directions of their own.
    pub(crate) has_parts: bool,
    layers: u32,
    age: u32,
    /// What it is drawn from.
    set: u32,
}

impl Shared {
    /// The meshes of bands that have been drawn, far to near.
    pub(crate) fn known_bands(&self, drawn_as: DrawnAs) -> &[Handle<Mesh>] {
        self.bands.get(&drawn_as).map_or(&[], |bands| bands)
    }

    /// The meshes of bands, far to near.
    fn bands(&mut self, drawn_as: DrawnAs, meshes: &mut Assets<Mesh>) -> &[Handle<Mesh>] {
        let shape = &self.shape;
        let place = self.place;
        self.bands.entry(drawn_as).or_insert_with(|| {
            let slots = SLOTS_BY_NEARNESS[usize::from(drawn_as.is_near)];
            let bands = bands(shape, slots, drawn_as.ranks);
            let mut mesh = |slices| meshes.add(crown_mesh(shape, slices, place));
            bands.map(&mut mesh).collect()
        })
    }
}

/// A set on its way to the GPU, from which nothing is drawn yet.
pub(crate) struct Prepared {
    id: u32,
    set: CrownSet,
    shared: Vec<(AssetId<Slicing>, Shared)>,
}

/// What is on the GPU, by slicing, as long as a crown uses it.
#[derive(Resource, Default)]
pub(crate) struct CrownLibrary {
    pub(crate) shared: HashMap<AssetId<Slicing>, Shared>,
    sets: HashMap<u32, CrownSet>,
    /// How many sets there have been.
    count: u32,
    /// How often slicings came, went or changed.
    pub(crate) changes: u32,
    /// Slicings of which crowns are drawn with what is out of date.
    stale: HashSet<AssetId<Slicing>>,
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

    /// With what a slicing may be drawn together.
    fn kind(&self, slicing: &Slicing) -> SetKind {
        let pixels = slicing.shape().pixels;
        let device = self.device.as_ref();
        SetKind {
            pixels,
            compressed: device
                .is_some_and(|device| self.compression.applies(pixels, device.features())),
            transmits: slicing.shape().diffuse_transmission > 0.0,
        }
    }

    /// Layers that a texture array may have.
    pub(crate) fn most_layers(&self) -> u32 {
        let device = self.device.as_ref();
        device.map_or(MAX_LAYERS as u32, |device| {
            device.limits().max_texture_array_layers
        })
    }
}

impl CrownLibrary {
    /// Makes a set of slicings, with the materials of all settings that crowns of theirs have.
    pub(crate) fn prepare(
        &mut self,
        source: SetSource,
        wind: Vec3,
        assets: &mut CrownAssets,
    ) -> Prepared {
        let id = self.count;
        self.count += 1;
        let slicings = source.slicings;
        let mut set = CrownSet::new(source, &mut assets.images, &mut assets.buffers);
        let mut shared = Vec::new();
        for (place, (slicing_id, slicing)) in slicings.iter().enumerate() {
            let before = self.shared.get(slicing_id);
            let old = before.and_then(|before| self.sets.get(&before.set));
            for settings in old.into_iter().flat_map(CrownSet::settings) {
                set.ensure(*settings, wind, &mut assets.materials);
            }
            let shape = slicing.shape();
            let place = place as u32;
            let mesh = |slots| {
                let slices = 0..most_slices(shape, slots);
                assets.meshes.add(crown_mesh(shape, slices, place))
            };
            let own = Shared {
                meshes: SLOTS_BY_NEARNESS.map(mesh),
                bands: default(),
                shape: Arc::new(shape.clone()),
                place,
                bounds: bounds(slicing),
                has_parts: widest(shape) > 0.0,
                layers: shape.layers() as u32,
                age: before.map_or(id, |before| before.age),
                set: id,
            };
            shared.push((*slicing_id, own));
        }
        Prepared { id, set, shared }
    }

    /// Draws slicings from a set, wherever they were drawn from.
    pub(crate) fn draw_from(&mut self, prepared: Prepared) {
        self.changes += 1;
        for (id, shared) in prepared.shared {
            if let Some(before) = self.shared.insert(id, shared) {
                self.leave(&before);
            }
            self.stale.insert(id);
        }
        self.sets.insert(prepared.id, prepared.set);
    }

    /// Draws a slicing that is new, or was edited, from a set of its own.
    fn settle_alone(
        &mut self,
        id: AssetId<Slicing>,
        slicing: &Slicing,
        wind: Vec3,
        assets: &mut CrownAssets,
    ) {
        let kind = assets.kind(slicing);
        let source = SetSource {
            kind,
            slicings: &[(id, slicing)],
            data: data(slicing, kind.compressed),
        };
        let prepared = self.prepare(source, wind, assets);
        self.draw_from(prepared);
    }

    /// Takes a slicing out of its set, which goes with the last.
    fn leave(&mut self, shared: &Shared) {
        let Some(set) = self.sets.get_mut(&shared.set) else {
            return;
        };
        set.live -= 1;
        if set.live == 0 {
            self.sets.remove(&shared.set);
        }
    }

    /// Makes what crowns of some settings need, if it is not there.
    fn ensure(
        &mut self,
        id: AssetId<Slicing>,
        settings: CrownSettings,
        wind: Vec3,
        assets: &mut CrownAssets,
    ) {
        let shared = self.shared.get(&id);
        if let Some(set) = shared.and_then(|shared| self.sets.get_mut(&shared.set)) {
            set.ensure(settings, wind, &mut assets.materials);
        }
    }

    /// What a crown is drawn with, far away or near by, whole or its furthest band; nothing before it was given anything.
    pub(crate) fn look(
        &mut self,
        id: AssetId<Slicing>,
        settings: &CrownSettings,
        drawn_as: DrawnAs,
        meshes: &mut Assets<Mesh>,
    ) -> Option<Look> {
        let shared = self.shared.get_mut(&id)?;
        let materials = self.sets.get(&shared.set)?.materials(settings)?;
        let i = usize::from(drawn_as.is_near);
        let mesh = if drawn_as.is_in_bands() {
            &shared.bands(drawn_as, meshes)[0]
        } else {
            &shared.meshes[i]
        };
        Some((Mesh3d(mesh.clone()), MeshMaterial3d(materials[i].clone())))
    }

    /// Slicings, and what they are drawn from.
    pub(crate) fn placed(&self) -> impl Iterator<Item = Placed> {
        self.shared.iter().filter_map(|(id, shared)| {
            let set = self.sets.get(&shared.set)?;
            Some(Placed {
                id: *id,
                kind: set.kind,
                layers: shared.layers,
                age: shared.age,
                set: shared.set,
                set_layers: set.layers,
            })
        })
    }

    /// Forgets what no crown uses any more.
    fn keep(&mut self, used: &HashSet<(AssetId<Slicing>, CrownSettings)>) {
        let mut is_used: HashSet<(u32, CrownSettings)> = HashSet::default();
        let mut slicings: HashSet<AssetId<Slicing>> = HashSet::default();
        for (id, settings) in used {
            slicings.insert(*id);
            is_used.extend(self.shared.get(id).map(|shared| (shared.set, *settings)));
        }
        let gone: Vec<_> = (self.shared)
            .extract_if(|id, _| !slicings.contains(id))
            .collect();
        self.changes += gone.len() as u32;
        for (_, shared) in &gone {
            self.leave(shared);
        }
        for (id, set) in &mut self.sets {
            set.keep(|settings| is_used.contains(&(*id, *settings)));
        }
    }

    fn each_material(
        &self,
    ) -> impl Iterator<Item = (&CrownSettings, &Handle<SlicedCrownMaterial>)> {
        self.sets.values().flat_map(CrownSet::each_material)
    }
}

/// What tells that a crown needs a (new) material.
type Unattached = Or<(
    Without<MeshMaterial3d<SlicedCrownMaterial>>,
    Changed<SlicedCrown>,
    AssetChanged<SlicedCrown>,
    Changed<CrownSettings>,
)>;

/// Gives crowns whose slicing is there what they are drawn with.
pub(crate) fn attach(
    mut commands: Commands,
    mut library: ResMut<CrownLibrary>,
    mut assets: CrownAssets,
    slicings: Res<Assets<Slicing>>,
    wind: Res<Wind>,
    crowns: Query<(Entity, &SlicedCrown, &CrownSettings)>,
    unattached: Query<Entity, (Unattached, With<SlicedCrown>)>,
) {
    let wind = wind.limited();
    let stale = core::mem::take(&mut library.stale);
    let mut attach = |(entity, crown, settings): (Entity, &SlicedCrown, &CrownSettings)| {
        let id = crown.0.id();
        if !library.shared.contains_key(&id) {
            // One whose slicing is not there yet keeps what it has.
            let Some(slicing) = slicings.get(id) else {
                return;
            };
            library.settle_alone(id, slicing, wind, &mut assets);
        }
        library.ensure(id, *settings, wind, &mut assets);
        let drawn_as = DrawnAs::default();
        if let Some(look) = library.look(id, settings, drawn_as, &mut assets.meshes) {
            let bounds = library.shared[&id].bounds;
            let drawn = (look, bounds, drawn_as);
            commands.entity(entity).try_insert(drawn);
        }
    };
    if stale.is_empty() {
        crowns.iter_many(&unattached).for_each(&mut attach);
    } else {
        let is_meant = |(entity, crown, _): &(Entity, &SlicedCrown, &CrownSettings)| {
            stale.contains(&crown.0.id()) || unattached.contains(*entity)
        };
        crowns.iter().filter(is_meant).for_each(&mut attach);
    }
    // What has come just now is attached.
    library.stale.clear();
}

/// Follows slicings that were edited or reloaded, a device that has taken a lost one's place, and the choice of
/// compression.
pub(crate) fn follow_slicings(
    mut changes: EditedAssets<Slicing>,
    mut library: ResMut<CrownLibrary>,
    mut assets: CrownAssets,
    slicings: Res<Assets<Slicing>>,
    wind: Res<Wind>,
) {
    changes.look(|id| library.shared.contains_key(&id));
    let edited = &mut changes.edited;
    if assets.are_outdated() {
        edited.extend(library.shared.keys());
    }
    for id in edited.iter() {
        if let Some(slicing) = slicings.get(*id) {
            library.settle_alone(*id, slicing, wind.limited(), &mut assets);
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
    for (_, material) in library.each_material() {
        if let Some(mut material) = materials.get_mut(material) {
            material.set.wind = wind;
        }
    }
}

/// Tells the materials which lighting the scene's lights call for, and whether its HDR cameras map tones: a camera that does
/// speaks for all.
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
    for (settings, material) in library.each_material() {
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
    for (_, material) in library.each_material() {
        // A day goes by without a new upload in each frame: half a degree is not seen.
        if let Some(mut material) = materials.get_mut(material)
            && material.set.sun.truncate().distance(to_sun) > 0.01
        {
            material.set.sun = to_sun.extend(0.0);
        }
    }
}

/// Tells the materials which cameras gather frames.
pub(crate) fn follow_cameras(
    library: Res<CrownLibrary>,
    mut materials: ResMut<Assets<SlicedCrownMaterial>>,
    cameras: Query<(&Camera, Has<TemporalJitter>), With<Camera3d>>,
) {
    let active = cameras.iter().filter(|(camera, _)| camera.is_active);
    let mut are_jittered = active.map(|(_, is_jittered)| is_jittered);
    let gathering = if are_jittered.clone().all(|is_jittered| !is_jittered) {
        Gathering::None
    } else if are_jittered.all(|is_jittered| is_jittered) {
        Gathering::All
    } else {
        Gathering::Some
    };
    for (_, material) in library.each_material() {
        if let Some(mut material) = materials.get_mut(material)
            && material.set.gathering != gathering as u32
        {
            material.set.gathering = gathering as u32;
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
        entity.try_remove::<(Look, Aabb, DrawnAs, CrownBands)>();
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
    library.keep(&used);
}

//! Slicings that are drawn together: what is on the GPU for them, and the materials of their crowns.

use bevy::asset::AssetId;
use bevy::image::Image;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::storage::ShaderBuffer;

use super::component::CrownSettings;
use super::material::{SetUniform, SlicedCrownMaterial};
use super::slicing::Slicing;
use super::upload::{images, octagons, records};

/// What slicings must have in common to be drawn together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct SetKind {
    pub pixels: u32,
    pub compressed: bool,
    /// Whether light comes through leaves from behind, which is a pipeline of its own.
    pub transmits: bool,
}

/// Slicings of which the layers follow one another in one pair of texture arrays.
pub(crate) struct CrownSet {
    pub kind: SetKind,
    /// How many slicings are drawn from here.
    pub live: usize,
    /// Layers, of those that have left too.
    pub layers: u32,
    color: Handle<Image>,
    normal: Handle<Image>,
    octagons: Handle<ShaderBuffer>,
    crowns: Handle<ShaderBuffer>,
    /// For crowns far away, and near by.
    materials: HashMap<CrownSettings, [Handle<SlicedCrownMaterial>; 2]>,
}

/// The slicings of a new set, and the bytes of their pictures.
pub(crate) struct SetSource<'a> {
    pub kind: SetKind,
    pub slicings: &'a [(AssetId<Slicing>, &'a Slicing)],
    pub data: [Vec<u8>; 2],
}

impl CrownSet {
    pub(crate) fn new(
        source: SetSource,
        image_assets: &mut Assets<Image>,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Self {
        let SetSource {
            kind,
            slicings,
            data,
        } = source;
        let slicings: Vec<&Slicing> = slicings.iter().map(|(_, slicing)| *slicing).collect();
        let layers = slicings.iter().map(|slicing| slicing.shape().layers());
        let layers = layers.sum::<usize>() as u32;
        let [color, normal] = images(data, kind.pixels, layers, kind.compressed);
        Self {
            kind,
            live: slicings.len(),
            layers,
            color: image_assets.add(color),
            normal: image_assets.add(normal),
            octagons: buffers.add(octagons(&slicings)),
            crowns: buffers.add(records(&slicings)),
            materials: HashMap::default(),
        }
    }

    /// The materials of crowns of some settings, far away and near by.
    pub(crate) fn materials(
        &self,
        settings: &CrownSettings,
    ) -> Option<&[Handle<SlicedCrownMaterial>; 2]> {
        self.materials.get(settings)
    }

    /// The settings that there are materials for.
    pub(crate) fn settings(&self) -> impl Iterator<Item = &CrownSettings> {
        self.materials.keys()
    }

    pub(crate) fn each_material(
        &self,
    ) -> impl Iterator<Item = (&CrownSettings, &Handle<SlicedCrownMaterial>)> {
        let all = self.materials.iter();
        all.flat_map(|(settings, pair)| pair.iter().map(move |material| (settings, material)))
    }

    /// Makes the materials of crowns of some settings, if they are not there.
    pub(crate) fn ensure(
        &mut self,
        settings: CrownSettings,
        wind: Vec3,
        materials: &mut Assets<SlicedCrownMaterial>,
    ) {
        let kind = self.kind;
        let make = |parts| {
            materials.add(SlicedCrownMaterial {
                set: SetUniform::new(kind.pixels, &settings, wind),
                crowns: self.crowns.clone(),
                octagons: self.octagons.clone(),
                color: self.color.clone(),
                normal: self.normal.clone(),
                settings,
                transmits: kind.transmits,
                // Until `follow_scene` says otherwise, in this very frame.
                lighting: settings.lighting.into(),
                tone_mapped: false,
                compressed: kind.compressed,
                parts,
            })
        };
        self.materials
            .entry(settings)
            .or_insert_with(|| [false, true].map(make));
    }

    /// Forgets the materials of settings that no crown has any more.
    pub(crate) fn keep(&mut self, is_used: impl Fn(&CrownSettings) -> bool) {
        self.materials.retain(|settings, _| is_used(settings));
    }
}

//! The relief maps in use, by the image that they are made of.

use std::sync::Arc;

use bevy::asset::{AssetEvent, AssetId, AssetMut, AssetServer, LoadState};
use bevy::image::Image;
use bevy::platform::collections::{HashMap, HashSet};
use bevy::prelude::*;

use super::map::ReliefMap;
use crate::frusta::material::FrustaMaterial;

/// A map, or what stands for it, and how often it was made.
#[derive(Clone, Debug)]
pub(crate) struct LibraryEntry {
    pub map: Arc<ReliefMap>,
    pub version: u32,
}

/// Relief maps made of images that materials use. An image that cannot be used has a level map, once that is known.
#[derive(Resource, Default)]
pub(crate) struct ReliefMaps {
    maps: HashMap<AssetId<Image>, LibraryEntry>,
}

impl ReliefMaps {
    /// All maps, by image.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&AssetId<Image>, &LibraryEntry)> {
        self.maps.iter()
    }

    fn put(&mut self, id: AssetId<Image>, map: ReliefMap) {
        let version = self.maps.get(&id).map_or(0, |entry| entry.version + 1);
        let map = Arc::new(map);
        self.maps.insert(id, LibraryEntry { map, version });
    }
}

/// Makes maps of images that materials have come to use, or that have changed, and forgets those no longer in use.
/// Materials of a map that is new are touched, so that they take it up in this very frame.
pub(crate) fn follow_maps(
    mut image_events: MessageReader<AssetEvent<Image>>,
    mut material_events: MessageReader<AssetEvent<FrustaMaterial>>,
    mut waiting: Local<HashSet<AssetId<Image>>>,
    mut maps: ResMut<ReliefMaps>,
    mut materials: ResMut<Assets<FrustaMaterial>>,
    images: Res<Assets<Image>>,
    server: Option<Res<AssetServer>>,
) {
    let mut changed: HashSet<AssetId<Image>> = HashSet::default();
    for event in image_events.read() {
        if let AssetEvent::Added { id } | AssetEvent::Modified { id } = event {
            changed.insert(*id);
        }
    }
    let materials_changed = material_events.read().count() > 0;
    if !materials_changed && waiting.is_empty() && changed.is_empty() {
        return;
    }
    let used: HashSet<AssetId<Image>> = materials
        .iter()
        .filter_map(|(_, material)| Some(material.extension.relief.as_ref()?.map.id()))
        .collect();
    maps.maps.retain(|id, _| used.contains(id));
    waiting.clear();
    let mut fresh = HashSet::<AssetId<Image>>::default();
    for id in used {
        if maps.maps.contains_key(&id) && !changed.contains(&id) {
            continue;
        }
        let named = || {
            let path = server.as_ref().and_then(|server| server.get_path(id));
            path.map_or_else(|| format!("{id}"), |path| format!("{path}"))
        };
        match images.get(id).map(ReliefMap::from_image) {
            Some(Ok(map)) => {
                if let Some(warning) = map.warning {
                    warn!("the relief map {} {warning}", named());
                }
                maps.put(id, map);
            }
            Some(Err(error)) => {
                error!(
                    "the relief map {} {error}. It is drawn without relief",
                    named()
                );
                maps.put(id, ReliefMap::flat());
            }
            None => {
                let state = server.as_ref().and_then(|server| server.get_load_state(id));
                if let Some(LoadState::Failed(error)) = state {
                    error!(
                        "the relief map {} cannot be loaded: {error}. It is drawn without relief",
                        named()
                    );
                    maps.put(id, ReliefMap::flat());
                } else {
                    waiting.insert(id);
                    continue;
                }
            }
        }
        fresh.insert(id);
    }
    if fresh.is_empty() {
        return;
    }
    let touched: Vec<_> = materials
        .iter()
        .filter(|(_, material)| {
            let relief = material.extension.relief.as_ref();
            relief.is_some_and(|relief| fresh.contains(&relief.map.id()))
        })
        .map(|(id, _)| id)
        .collect();
    for id in touched {
        // What is taken out of its guard counts as changed.
        materials.get_mut(id).map(AssetMut::into_inner);
    }
}

//! A planting under its sun, as entities of each rival.

use bevy::light::{CascadeShadowConfigBuilder, DirectionalLightShadowMap};
use bevy::prelude::*;
use thiserror::Error;

use super::dress::Wardrobe;
use super::weight::Weight;
use super::{March, Rival};
use crate::frusta::{MeshError, MeshRelief};
use crate::lab::daylight::SUNLIGHT;
use crate::lab::headless::Headless;
use crate::plants::{Place, PlantPart, Planting};
use crate::prelude::*;

/// A planting, and those of the rivals that were asked for.
///
/// All of them stand in the same world, and all but one are hidden, so that what a hidden plant costs falls on all.
pub struct Exhibit {
    planting: Planting,
    stage: Vec<Entity>,
    shown_as: Vec<(Rival, Shown)>,
}

struct Shown {
    entities: Vec<Entity>,
    weight: Weight,
}

/// Why a rival is not shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum NotShown {
    /// Its polygons would take more memory than they may.
    #[error("{bytes} bytes of polygons, more than the {limit} that they may take")]
    TooHeavy {
        /// What they would take, about.
        bytes: usize,
        /// The limit.
        limit: usize,
    },
    /// There is no such mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

impl Exhibit {
    /// Sets the stage for a planting: ground and sun, and a distance in metres to which shadows are cast, if any.
    pub fn open(headless: &mut Headless, planting: Planting, shadows: Option<f32>) -> Self {
        let world = headless.world();
        world.insert_resource(GlobalAmbientLight {
            color: Color::srgb(0.72, 0.82, 1.0),
            brightness: 900.0,
            ..default()
        });
        world.insert_resource(DirectionalLightShadowMap { size: 1024 });
        let ground = Plane3d::default().mesh().size(400.0, 400.0);
        let ground = world.resource_mut::<Assets<Mesh>>().add(ground);
        let soil = StandardMaterial {
            base_color: Color::srgb(0.52, 0.44, 0.33),
            perceptual_roughness: 1.0,
            reflectance: 0.1,
            ..default()
        };
        let soil = world.resource_mut::<Assets<StandardMaterial>>().add(soil);
        let ground = world.spawn((Mesh3d(ground), MeshMaterial3d(soil))).id();
        let distance = shadows.unwrap_or(1.0);
        let sun = world.spawn((
            DirectionalLight {
                illuminance: 9_000.0,
                color: Color::srgb(1.0, 0.95, 0.86),
                shadow_maps_enabled: shadows.is_some(),
                ..default()
            },
            CascadeShadowConfigBuilder {
                num_cascades: 2,
                maximum_distance: distance,
                first_cascade_far_bound: 0.5 * distance,
                ..default()
            }
            .build(),
            Transform::default().looking_to(SUNLIGHT, Vec3::Y),
        ));
        let stage = vec![ground, sun.id()];
        Self {
            planting,
            stage,
            shown_as: Vec::new(),
        }
    }

    /// What stands where.
    pub fn planting(&self) -> &Planting {
        &self.planting
    }

    /// Puts up a rival, hidden, unless it stands already. Polygons may take `limit` bytes.
    ///
    /// # Errors
    /// When its polygons would take more, or more vertices than indices reach.
    pub fn put_up(
        &mut self,
        headless: &mut Headless,
        wardrobe: &mut Wardrobe,
        rival: Rival,
        limit: usize,
    ) -> Result<Weight, NotShown> {
        if let Some(weight) = self.weight(rival) {
            return Ok(weight);
        }
        if let Rival::Polygons { subdivisions, .. } = rival {
            let parts = self.planting.plants.iter().flat_map(|plant| &plant.parts);
            let segments = parts.map(|part| part.skeleton.segment_count()).sum();
            let bytes = Weight::expected_of_mesh(segments, subdivisions);
            if bytes > limit {
                return Err(NotShown::TooHeavy { bytes, limit });
            }
        }
        let world = headless.world();
        let mut shown = Shown {
            entities: Vec::new(),
            weight: Weight::default(),
        };
        let mut dressed = Vec::new();
        for (i, plant) in self.planting.plants.iter().enumerate() {
            let places = self.planting.places.iter().filter(|place| place.plant == i);
            let places: Vec<&Place> = places.collect();
            for part in &plant.parts {
                let first = !dressed.contains(&part.kind);
                if first {
                    dressed.push(part.kind);
                }
                spawn(world, wardrobe, rival, part, &places, first, &mut shown)?;
            }
        }
        let weight = shown.weight;
        self.shown_as.push((rival, shown));
        Ok(weight)
    }

    /// Shows a rival that stands, or none: the empty scene.
    pub fn show(&self, headless: &mut Headless, rival: Option<Rival>) {
        let world = headless.world();
        for (own, shown) in &self.shown_as {
            let visibility = if Some(*own) == rival {
                Visibility::Inherited
            } else {
                Visibility::Hidden
            };
            for entity in &shown.entities {
                if let Some(mut own) = world.get_mut::<Visibility>(*entity) {
                    own.set_if_neq(visibility);
                }
            }
        }
    }

    /// Shows or hides the ground.
    pub fn show_stage(&self, headless: &mut Headless, shown: bool) {
        for entity in &self.stage {
            if let Some(mut own) = headless.world().get_mut::<Visibility>(*entity) {
                *own = if shown {
                    Visibility::Inherited
                } else {
                    Visibility::Hidden
                };
            }
        }
    }

    /// Takes a rival down.
    pub fn take_down(&mut self, headless: &mut Headless, rival: Rival) {
        let (gone, kept) = core::mem::take(&mut self.shown_as)
            .into_iter()
            .partition(|(own, _)| *own == rival);
        self.shown_as = kept;
        let gone: Vec<(Rival, Shown)> = gone;
        for entity in gone.iter().flat_map(|(_, shown)| &shown.entities) {
            headless.world().despawn(*entity);
        }
    }

    /// Takes everything down.
    pub fn close(self, headless: &mut Headless) {
        let entities = self.shown_as.iter().flat_map(|(_, shown)| &shown.entities);
        for entity in entities.chain(&self.stage) {
            headless.world().despawn(*entity);
        }
        headless.step();
    }

    /// What a rival that stands weighs.
    pub fn weight(&self, rival: Rival) -> Option<Weight> {
        let mut known = self.shown_as.iter();
        let (_, shown) = known.find(|(own, _)| *own == rival)?;
        Some(shown.weight)
    }
}

/// One part of a plant at all its places. `first` tells whether the surface has not been met before.
fn spawn(
    world: &mut World,
    wardrobe: &mut Wardrobe,
    rival: Rival,
    part: &PlantPart,
    places: &[&Place],
    first: bool,
    shown: &mut Shown,
) -> Result<(), NotShown> {
    let ends = if part.kind.has_flat_ends() {
        Ends::Flat
    } else {
        Ends::Round
    };
    let dress = wardrobe.get(part.kind, world);
    match rival {
        Rival::Frusta(march) => {
            let mut material = frusta_material(dress.material.clone());
            material.extension.relief = relief(dress.relief.as_ref(), march);
            shown.weight += Weight::of_frusta(&part.skeleton, places.len());
            if first && march.is_some() {
                shown.weight.relief_maps += dress.relief_bytes();
            }
            let material = world.resource_mut::<Assets<FrustaMaterial>>().add(material);
            let mut skeletons = world.resource_mut::<Assets<Skeleton>>();
            let skeleton = skeletons.add(part.skeleton.clone());
            for place in places {
                let plant = (
                    Skeleton3d(skeleton.clone()),
                    Frusta::default().with_ends(ends),
                    MeshMaterial3d(material.clone()),
                    place.transform(),
                    Visibility::Hidden,
                );
                shown.entities.push(world.spawn(plant).id());
            }
        }
        Rival::Polygons {
            subdivisions,
            relief,
        } => {
            let height = |u: f64, v: f64| dress.height(u, v);
            let shell = dress.relief.as_ref().filter(|_| relief);
            let shell = shell.and_then(Relief::mesh_shell);
            let mesh = part.skeleton.to_mesh_parts(&MeshSettings {
                subdivisions,
                ends,
                relief: shell.map(|shell| MeshRelief {
                    height: &height,
                    shell,
                }),
                continuous_u: shell.is_some(),
                ..default()
            })?;
            shown.weight += Weight::of_mesh(&mesh, places.len());
            let material = dress.material.clone();
            let mut mesh = Mesh::from(mesh);
            // Once on the device, it need not be kept here too.
            mesh.asset_usage = bevy::asset::RenderAssetUsages::RENDER_WORLD;
            let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
            let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
            let material = materials.add(material);
            for place in places {
                let plant = (
                    Mesh3d(mesh.clone()),
                    MeshMaterial3d(material.clone()),
                    place.transform(),
                    Visibility::Hidden,
                );
                shown.entities.push(world.spawn(plant).id());
            }
        }
    }
    Ok(())
}

fn relief(relief: Option<&Relief>, march: Option<March>) -> Option<Relief> {
    let (mut relief, march) = (relief?.clone(), march?);
    march.apply(&mut relief);
    Some(relief)
}

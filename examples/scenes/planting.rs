//! A planting as entities, one a part and place, and what is drawn of them: smooth frusta, frusta with relief, or
//! polygons.

use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy_verdure::plants::{Planting, Surface};
use bevy_verdure::prelude::*;
use clap::ValueEnum;

use super::looks::Looks;
use super::twins::Twin;

/// What is drawn.
#[derive(Resource, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Drawn {
    /// Smooth frusta with normal maps.
    Rays,
    /// Frusta with relief.
    Relief,
    /// Polygons of the same surface, with displaced vertices.
    Polygons,
}

/// Draws what [`Drawn`] says, and lets M change it.
pub fn drawing(app: &mut App) {
    app.add_systems(
        Update,
        (switch, draw.run_if(resource_changed::<Drawn>)).chain(),
    );
}

/// Plants a planting. Skeletons and looks are shared among all places of a plant.
pub fn plant(world: &mut World, planting: &Planting) {
    let mut looks = HashMap::<Surface, Looks>::default();
    for (index, plant) in planting.plants.iter().enumerate() {
        for part in &plant.parts {
            let ends = if part.kind.has_flat_ends() {
                Ends::Flat
            } else {
                Ends::Round
            };
            let looks = looks
                .entry(part.kind)
                .or_insert_with(|| Looks::of(part.kind, world));
            let skeleton = world
                .resource_mut::<Assets<Skeleton>>()
                .add(part.skeleton.clone());
            for place in planting.places.iter().filter(|place| place.plant == index) {
                world.spawn((
                    Skeleton3d(skeleton.clone()),
                    Frusta::default().with_ends(ends),
                    MeshMaterial3d(looks.relief.clone()),
                    looks.clone(),
                    place.transform(),
                ));
            }
        }
    }
}

fn switch(keys: Res<ButtonInput<KeyCode>>, mut drawn: ResMut<Drawn>) {
    if keys.just_pressed(KeyCode::KeyM) {
        *drawn = match *drawn {
            Drawn::Rays => Drawn::Relief,
            Drawn::Relief => Drawn::Polygons,
            Drawn::Polygons => Drawn::Rays,
        };
    }
}

/// Twins stand below the plants that they replace: they are visible whether or not those are.
fn draw(
    drawn: Res<Drawn>,
    mut plants: Query<(&Looks, &mut MeshMaterial3d<FrustaMaterial>, &mut Visibility)>,
    mut twins: Query<&mut Visibility, (With<Twin>, Without<Looks>)>,
) {
    for (looks, mut material, mut visibility) in &mut plants {
        let frusta = match *drawn {
            Drawn::Rays => Some(&looks.rays),
            Drawn::Relief => Some(&looks.relief),
            Drawn::Polygons => None,
        };
        *visibility = if frusta.is_some() {
            Visibility::Visible
        } else {
            Visibility::Hidden
        };
        if let Some(frusta) = frusta {
            material.0 = frusta.clone();
        }
    }
    for mut visibility in &mut twins {
        *visibility = if *drawn == Drawn::Polygons {
            Visibility::Visible
        } else {
            Visibility::Hidden
        };
    }
}

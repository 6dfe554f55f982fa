//! A planting as entities: one a part and place, each as smooth frusta, as frusta with relief, and as polygons.

use bevy::prelude::*;
use bevy_verdure::plants::Planting;
use bevy_verdure::prelude::*;
use clap::ValueEnum;

use super::looks::{look, relief};

/// Subdivisions of the polygons.
const SUBDIVISIONS: u32 = 1;

/// Plants a planting.
pub struct Planted {
    /// What stands where.
    pub planting: Planting,
    /// What is drawn at first.
    pub drawn: Drawn,
}

/// What is drawn.
#[derive(Resource, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Drawn {
    /// Smooth frusta with normal maps.
    Rays,
    /// Frusta with relief.
    Relief,
    /// Smooth polygons with normal maps.
    Polygons,
}

impl Plugin for Planted {
    fn build(&self, app: &mut App) {
        let planting = self.planting.clone();
        app.insert_resource(self.drawn)
            .add_systems(Startup, move |world: &mut World| plant(world, &planting))
            .add_systems(
                Update,
                (switch, draw.run_if(resource_changed::<Drawn>)).chain(),
            );
    }
}

/// Shares skeletons, meshes and materials among all places of a plant.
fn plant(world: &mut World, planting: &Planting) {
    for (index, plant) in planting.plants.iter().enumerate() {
        for part in &plant.parts {
            let ends = if part.kind.has_flat_ends() {
                Ends::Flat
            } else {
                Ends::Round
            };
            let look = look(part.kind, &mut world.resource_mut::<Assets<Image>>());
            let carved = relief(part.kind, &look, &mut world.resource_mut::<Assets<Image>>());
            let mut materials = world.resource_mut::<Assets<FrustaMaterial>>();
            let rays = materials.add(frusta_material(look.clone()));
            // What has no relief is one plant for both.
            let frusta = match carved {
                Some(carved) => vec![
                    (DrawnAs(vec![Drawn::Rays]), rays),
                    (DrawnAs(vec![Drawn::Relief]), materials.add(carved)),
                ],
                None => vec![(DrawnAs(vec![Drawn::Rays, Drawn::Relief]), rays)],
            };
            let standard = world.resource_mut::<Assets<StandardMaterial>>().add(look);
            let settings = MeshSettings {
                subdivisions: SUBDIVISIONS,
                ends,
                ..default()
            };
            let mesh = match polygons(&part.skeleton, &settings) {
                Ok(mesh) => world.resource_mut::<Assets<Mesh>>().add(mesh),
                Err(error) => {
                    error!("{:?}: {error}", part.kind);
                    continue;
                }
            };
            let skeleton = world
                .resource_mut::<Assets<Skeleton>>()
                .add(part.skeleton.clone());
            for place in planting.places.iter().filter(|place| place.plant == index) {
                let transform = Transform {
                    translation: place.position,
                    rotation: Quat::from_rotation_y(place.yaw),
                    scale: Vec3::splat(place.scale),
                };
                for (drawn_as, material) in &frusta {
                    world.spawn((
                        drawn_as.clone(),
                        Skeleton3d(skeleton.clone()),
                        Frusta::default().with_ends(ends),
                        MeshMaterial3d(material.clone()),
                        transform,
                    ));
                }
                world.spawn((
                    DrawnAs(vec![Drawn::Polygons]),
                    Mesh3d(mesh.clone()),
                    MeshMaterial3d(standard.clone()),
                    transform,
                ));
            }
        }
    }
}

/// A mesh with what a normal map needs.
fn polygons(skeleton: &Skeleton, settings: &MeshSettings) -> Result<Mesh> {
    Ok(skeleton.to_mesh(settings)?.with_generated_tangents()?)
}

/// When an entity is shown.
#[derive(Component, Clone)]
struct DrawnAs(Vec<Drawn>);

fn switch(keys: Res<ButtonInput<KeyCode>>, mut drawn: ResMut<Drawn>) {
    if keys.just_pressed(KeyCode::KeyM) {
        *drawn = match *drawn {
            Drawn::Rays => Drawn::Relief,
            Drawn::Relief => Drawn::Polygons,
            Drawn::Polygons => Drawn::Rays,
        };
    }
}

fn draw(drawn: Res<Drawn>, mut all: Query<(&DrawnAs, &mut Visibility)>) {
    for (DrawnAs(own), mut visibility) in &mut all {
        *visibility = if own.contains(&drawn) {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
    }
}

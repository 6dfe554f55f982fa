//! A planting as entities: one a part and place, twice over, as frusta and as polygons.

use bevy::prelude::*;
use bevy_verdure::plants::Planting;
use bevy_verdure::prelude::*;

use super::looks::look;

/// Subdivisions of the polygons.
const SUBDIVISIONS: u32 = 1;

/// Plants a planting.
pub struct Planted {
    /// What stands where.
    pub planting: Planting,
    /// Starts with polygons.
    pub polygons: bool,
}

/// What is drawn.
#[derive(Resource, Clone, Copy, PartialEq)]
enum Drawn {
    Frusta,
    Polygons,
}

impl Plugin for Planted {
    fn build(&self, app: &mut App) {
        let planting = self.planting.clone();
        app.insert_resource(if self.polygons {
            Drawn::Polygons
        } else {
            Drawn::Frusta
        })
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
            let frusta = world
                .resource_mut::<Assets<FrustaMaterial>>()
                .add(frusta_material(look.clone()));
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
                world.spawn((
                    Drawn::Frusta.mark(),
                    Skeleton3d(skeleton.clone()),
                    Frusta::default().with_ends(ends),
                    MeshMaterial3d(frusta.clone()),
                    transform,
                ));
                world.spawn((
                    Drawn::Polygons.mark(),
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

/// Which of both an entity is.
#[derive(Component)]
struct DrawnAs(Drawn);

impl Drawn {
    fn mark(self) -> DrawnAs {
        DrawnAs(self)
    }
}

fn switch(keys: Res<ButtonInput<KeyCode>>, mut drawn: ResMut<Drawn>) {
    if keys.just_pressed(KeyCode::KeyM) {
        *drawn = match *drawn {
            Drawn::Frusta => Drawn::Polygons,
            Drawn::Polygons => Drawn::Frusta,
        };
    }
}

fn draw(drawn: Res<Drawn>, mut all: Query<(&DrawnAs, &mut Visibility)>) {
    for (DrawnAs(own), mut visibility) in &mut all {
        *visibility = if *own == *drawn {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
    }
}

//! Polygons in place of frusta, made when they are first asked for.

use bevy::camera::visibility::DynamicSkinnedMeshBounds;
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy_verdure::frusta::MeshRelief;
use bevy_verdure::prelude::*;

use super::looks::Looks;
use super::planting::Drawn;

/// How often polygons are subdivided.
#[derive(Resource, Clone, Copy)]
pub struct Subdivisions(pub u32);

/// A plant's polygons, its child.
#[derive(Component)]
pub struct Twin;

/// A plant that has its twin, or cannot have one.
#[derive(Component)]
struct HasTwin;

/// Makes twins while polygons are drawn.
pub fn twins(app: &mut App) {
    let wanted = |drawn: Res<Drawn>| *drawn == Drawn::Polygons;
    app.add_systems(PostUpdate, make.run_if(wanted));
}

type Unpaired<'a> = (
    Entity,
    &'a Looks,
    &'a Skeleton3d,
    &'a Frusta,
    Option<&'a SegmentEntities>,
    Has<UnfoldSkeleton>,
);

fn make(
    mut commands: Commands,
    plants: Query<Unpaired, Without<HasTwin>>,
    subdivisions: Res<Subdivisions>,
    skeletons: Res<Assets<Skeleton>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut bindposes: ResMut<Assets<SkinnedMeshInverseBindposes>>,
) {
    let mut made = HashMap::<AssetId<Skeleton>, Handle<Mesh>>::default();
    for (plant, looks, skeleton, frusta, segments, moves) in &plants {
        let id = skeleton.0.id();
        let Some(skeleton) = skeletons.get(id) else {
            continue;
        };
        if moves && segments.is_none() {
            continue;
        }
        commands.entity(plant).insert(HasTwin);
        let carved = looks.carved.as_deref();
        let height = |u: f64, v: f64| carved.map_or(1.0, |carved| carved.height(u, v));
        let shell = carved.and_then(|carved| carved.shell());
        let settings = MeshSettings {
            subdivisions: subdivisions.0,
            join: frusta.join,
            ends: frusta.ends,
            relief: shell.map(|shell| MeshRelief {
                height: &height,
                shell,
            }),
            continuous_u: shell.is_some(),
            ..default()
        };
        let material = MeshMaterial3d(looks.polygons.clone());
        let twin = (Twin, ChildOf(plant), Visibility::Visible, material);
        if let Some(segments) = segments {
            match skeleton.to_skinned_mesh(&settings) {
                Ok((mesh, inverse)) => {
                    commands.spawn((
                        twin,
                        Mesh3d(meshes.add(mesh)),
                        SkinnedMesh {
                            inverse_bindposes: bindposes.add(inverse),
                            joints: segments.iter().map(|(_, segment)| segment).collect(),
                        },
                        DynamicSkinnedMeshBounds,
                    ));
                }
                Err(error) => error!("no polygons of a plant: {error}"),
            }
            continue;
        }
        let mesh = match made.get(&id) {
            Some(mesh) => mesh.clone(),
            None => match skeleton.to_mesh(&settings) {
                Ok(mesh) => {
                    let mesh = meshes.add(mesh);
                    made.insert(id, mesh.clone());
                    mesh
                }
                Err(error) => {
                    error!("no polygons of a plant: {error}");
                    continue;
                }
            },
        };
        commands.spawn((twin, Mesh3d(mesh)));
    }
}

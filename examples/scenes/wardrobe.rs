//! The dancing cacti in the looks of the other scenes: with relief, and with polygons that their segments move.

use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy_verdure::plants::Surface;
use bevy_verdure::prelude::*;

use super::dance::Dancer;
use super::looks::Looks;
use super::planting::Drawn;

/// Dresses whoever comes to dance, and their flowers.
pub fn wardrobe(app: &mut App) {
    app.init_resource::<Skin>().add_systems(Update, dress);
}

/// What all cacti wear.
#[derive(Resource)]
struct Skin(Looks);

impl FromWorld for Skin {
    fn from_world(world: &mut World) -> Self {
        Self(Looks::of(Surface::SaguaroSkin, world))
    }
}

type Undressed<'a> = (Entity, Has<Dancer>, &'a MeshMaterial3d<FrustaMaterial>);

fn dress(
    mut commands: Commands,
    skin: Res<Skin>,
    mut flowers: Local<HashMap<AssetId<FrustaMaterial>, Looks>>,
    mut drawn: ResMut<Drawn>,
    materials: Res<Assets<FrustaMaterial>>,
    mut standard: ResMut<Assets<StandardMaterial>>,
    bare: Query<Undressed, (With<Skeleton3d>, Without<Looks>)>,
) {
    for (plant, dances, material) in &bare {
        let looks = if dances {
            skin.0.clone()
        } else {
            let Some(colour) = materials.get(&material.0) else {
                continue;
            };
            let looks = || Looks {
                rays: material.0.clone(),
                relief: material.0.clone(),
                polygons: standard.add(colour.base.clone()),
                carved: None,
            };
            let known = flowers.entry(material.0.id());
            known.or_insert_with(looks).clone()
        };
        commands.entity(plant).insert(looks);
        // Draws anew.
        drawn.set_changed();
    }
}

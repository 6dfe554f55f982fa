//! The crowd: a hundred cacti and their flowers.

use bevy::prelude::*;
use bevy_verdure::plants::Dice;
use bevy_verdure::prelude::*;

use super::cactus::{PETALS, body, flower, skin_color, skin_normals};
use super::dance::{Dancer, dance};

/// Cacti a side.
const SIDE: usize = 10;
/// Segments in all, as in the paper's Table 1.
const SEGMENTS: usize = 2158;

/// Plants the crowd and lets it dance.
pub fn crowd(app: &mut App) {
    app.add_systems(Startup, (plant_crowd, grow_flowers))
        .add_systems(Update, (put_flowers_on, dance).chain());
}

/// Bodies: all of one material, and so one draw.
fn plant_crowd(
    mut commands: Commands,
    mut skeletons: ResMut<Assets<Skeleton>>,
    mut materials: ResMut<Assets<FrustaMaterial>>,
    mut images: ResMut<Assets<Image>>,
) {
    let skin = materials.add(frusta_material(StandardMaterial {
        base_color_texture: Some(images.add(skin_color())),
        normal_map_texture: Some(images.add(skin_normals())),
        perceptual_roughness: 0.75,
        reflectance: 0.3,
        ..default()
    }));
    let mut dice = Dice::new(8);
    let cacti = SIDE * SIDE;
    let body_segments = SEGMENTS - cacti * PETALS;
    for i in 0..cacti {
        // The total is shared out evenly: the first few have one more.
        let segments = body_segments / cacti + usize::from(i < body_segments % cacti);
        let cactus = body(segments, &mut dice);
        let place = Vec2::new((i % SIDE) as f32, (i / SIDE) as f32) - (SIDE - 1) as f32 / 2.0;
        let place = place * 1.75 + Vec2::new(dice.between(-0.35, 0.35), dice.between(-0.35, 0.35));
        commands.spawn((
            Skeleton3d(skeletons.add(cactus.skeleton)),
            MeshMaterial3d(skin.clone()),
            UnfoldSkeleton,
            Dancer::new(cactus.trunk, cactus.arms, &mut dice),
            WearsFlower(cactus.crown),
            Transform::from_xyz(place.x, 0.0, place.y)
                .with_rotation(Quat::from_rotation_y(dice.between(0.0, 6.3))),
        ));
    }
}

/// A cactus that wants a flower, and the radius of its crown.
#[derive(Component)]
struct WearsFlower(f32);

/// The flower's skeleton, and its colours.
#[derive(Resource)]
struct Flowers {
    skeleton: Handle<Skeleton>,
    materials: [Handle<FrustaMaterial>; 3],
}

fn grow_flowers(
    mut commands: Commands,
    mut skeletons: ResMut<Assets<Skeleton>>,
    mut materials: ResMut<Assets<FrustaMaterial>>,
) {
    commands.insert_resource(Flowers {
        skeleton: skeletons.add(flower(0.1)),
        materials: [
            Color::srgb(0.93, 0.25, 0.50),
            Color::srgb(0.98, 0.80, 0.24),
            Color::srgb(0.96, 0.93, 0.90),
        ]
        .map(|color| materials.add(frusta_material(color))),
    });
}

/// A flower is a plant of its own, a child of the topmost segment.
fn put_flowers_on(
    mut commands: Commands,
    flowers: Res<Flowers>,
    skeletons: Res<Assets<Skeleton>>,
    bare: Query<(Entity, &Dancer, &WearsFlower, &SegmentEntities, &Skeleton3d)>,
) {
    for (cactus, dancer, WearsFlower(crown), segments, skeleton) in &bare {
        let Some(skeleton) = skeletons.get(&skeleton.0) else {
            continue;
        };
        let joints = skeleton.joints();
        let Some(&[.., below, top]) = dancer.trunk.get(..) else {
            continue;
        };
        let Some(segment) = segments.get(top as usize) else {
            continue;
        };
        let along = joints[top as usize].position - joints[below as usize].position;
        commands.entity(cactus).remove::<WearsFlower>();
        commands.spawn((
            Skeleton3d(flowers.skeleton.clone()),
            MeshMaterial3d(flowers.materials[cactus.index_u32() as usize % 3].clone()),
            Transform::from_translation(along + Vec3::Y * (crown * 0.9)),
            ChildOf(segment),
        ));
    }
}

//! Crowns in bands: alone they are what they are whole.

use bevy::camera::RenderTarget;
use bevy::camera::visibility::RenderLayers;
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use super::{CROWN, covered, eye, plant, plant_mesh, shot, studio, sun};

const SKY: Color = Color::WHITE;

/// Bands that a crown of five slices is drawn in, but for the furthest.
const CHILDREN: usize = 4;

fn children(studio: &mut Studio, crown: Entity) -> Vec<Entity> {
    let children = studio.world().get::<Children>(crown);
    children.map_or_else(Vec::new, |children| children.to_vec())
}

/// From where parts differ, from the middle distance, from above, where levels fade into one another, and from far away.
fn shots() -> Vec<Shot> {
    let radius = CROWN.shape().radius;
    // Pictures are low, so that crowns look 2.6 times as far away.
    let distances = [2.0, 3.0, 3.9, 6.0, 9.8, 20.0];
    let mut shots: Vec<_> = distances
        .map(|radii| shot(eye(25.0, 10.0, radii * radius)))
        .into();
    shots.push(shot(eye(100.0, 60.0, 5.0 * radius)));
    shots.push(Shot {
        lens: Lens::Orthographic(3.0 * radius),
        ..shot(eye(200.0, 20.0, 5.0 * radius))
    });
    shots
}

fn pictures(studio: &mut Studio) -> Vec<Vec<u8>> {
    let shots = shots();
    let photograph = |shot| studio.photograph(shot, SKY).rgb_bytes();
    shots.iter().map(photograph).collect()
}

#[test]
fn a_crown_in_bands_is_the_crown_to_the_bit() {
    for order in [SliceOrder::Steady, SliceOrder::Paper] {
        let (mut studio, crown) = studio(CrownSettings { order, ..default() });
        sun(&mut studio);
        // What its shadow falls on.
        let aside = Transform::from_xyz(0.0, -4.0, -1.0);
        plant_mesh(&mut studio, aside, false);
        studio
            .world()
            .entity_mut(crown)
            .insert(CrownTint(Color::srgb(0.9, 0.7, 0.5)));
        // An eye that is near all along: bands are drawn for those that are far away too.
        studio.world().spawn((
            Camera3d::default(),
            RenderTarget::None {
                size: UVec2::splat(480),
            },
            Transform::from_translation(eye(0.0, 0.0, 15.0)),
        ));
        studio.headless.step();
        let whole = pictures(&mut studio);
        assert_eq!(children(&mut studio, crown), []);
        studio.world().entity_mut(crown).insert(IntersectingCrown);
        studio.headless.step();
        assert_eq!(children(&mut studio, crown).len(), CHILDREN);
        let in_bands = pictures(&mut studio);
        for (i, (whole, in_bands)) in whole.iter().zip(&in_bands).enumerate() {
            assert!(whole == in_bands, "{order:?}, {:?}", shots()[i]);
        }
        studio
            .world()
            .entity_mut(crown)
            .remove::<IntersectingCrown>();
        studio.headless.step();
        assert_eq!(children(&mut studio, crown), []);
        assert!(pictures(&mut studio) == whole);
    }
}

#[test]
fn not_a_frame_is_without_a_band_where_crowns_come_to_be_drawn_in_them() {
    let (mut studio, crown) = studio(CrownSettings::default());
    let look = shot(eye(25.0, 10.0, 3.0 * CROWN.shape().radius));
    let whole = studio.photograph(&look, SKY).rgb_bytes();
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    // Not a step between.
    assert!(studio.photograph(&look, SKY).rgb_bytes() == whole);
    assert_eq!(children(&mut studio, crown).len(), CHILDREN);
    // What somebody else takes away comes back.
    let second = children(&mut studio, crown)[1];
    studio.world().despawn(second);
    assert!(studio.photograph(&look, SKY).rgb_bytes() == whole);
    studio
        .world()
        .entity_mut(crown)
        .remove::<IntersectingCrown>();
    assert!(studio.photograph(&look, SKY).rgb_bytes() == whole);
}

#[test]
fn only_blended_crowns_that_are_near_are_drawn_in_bands() {
    let (mut studio, crown) = studio(CrownSettings::default());
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    let radius = CROWN.shape().radius;
    let count = |studio: &mut Studio, radii: f32| {
        studio.photograph(&shot(eye(25.0, 10.0, radii * radius)), SKY);
        children(studio, crown).len()
    };
    assert_eq!(count(&mut studio, 3.0), CHILDREN);
    // Three slices of an orientation, five fading into three, three into one, and that one.
    let counts = [6.0, 3.9, 9.8, 20.0].map(|radii| count(&mut studio, radii));
    assert_eq!(counts, [2, 7, 3, 0]);
    assert_eq!(count(&mut studio, 3.0), CHILDREN);
    let mut settings = studio.world().get_mut::<CrownSettings>(crown).unwrap();
    settings.composition = Composition::Hashed;
    assert_eq!(count(&mut studio, 3.0), 0);
}

#[test]
fn bands_follow_their_crown() {
    let (mut studio, crown) = studio(CrownSettings::default());
    let beside = {
        let place = Transform::from_xyz(9.0, 0.0, 0.0);
        plant(&mut studio, CrownSettings::default(), place)
    };
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    let look = shot(eye(25.0, 10.0, 3.0 * CROWN.shape().radius));
    let photograph = |studio: &mut Studio| studio.photograph(&look, SKY).rgb_bytes();
    // Each change, of both alike but one of them in bands, and in turns.
    let change = |studio: &mut Studio, crown: Entity, i: usize| {
        let mut crown = studio.world().entity_mut(crown);
        match i {
            0 => crown.insert(CrownTint(Color::srgb(1.0, 0.5, 0.2))),
            1 => crown.insert(CrownSettings {
                lighting: PlantLighting::Unlit,
                ..default()
            }),
            2 => crown.insert(RenderLayers::layer(3)),
            3 => crown.insert(RenderLayers::layer(0)),
            4 => crown.insert(Visibility::Hidden),
            5 => crown.insert(Visibility::Inherited),
            6 => crown
                .insert(Transform::from_xyz(0.0, 1.0, 0.0).with_scale(Vec3::new(1.2, 0.8, 1.0))),
            _ => crown.insert(Transform::IDENTITY),
        };
    };
    for i in 0..8 {
        change(&mut studio, crown, i);
        let in_bands = photograph(&mut studio);
        studio
            .world()
            .entity_mut(crown)
            .remove::<IntersectingCrown>();
        let whole = photograph(&mut studio);
        studio.world().entity_mut(crown).insert(IntersectingCrown);
        assert!(in_bands == whole, "change {i}");
    }
    studio.world().despawn(beside);
    studio.world().entity_mut(crown).remove::<SlicedCrown>();
    let empty = studio.photograph(&look, SKY);
    assert_eq!(covered(&empty, [255; 3]), 0);
    assert_eq!(children(&mut studio, crown), []);
}

//! Crowns in bands: alone they are what they are whole.

use bevy::camera::RenderTarget;
use bevy::camera::visibility::{RenderLayers, VisibilityRange};
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;

use super::{CROWN, SMALL, UNLIT, eye, plant_mesh, shot, studio, sun};

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

/// A sun, a spot light and a point light, all with shadows, and what these fall on.
fn light(studio: &mut Studio) {
    sun(studio);
    let over = CROWN.shape().centroid + Vec3::new(2.0, 6.0, 3.0);
    let spot = SpotLight {
        intensity: 4e6,
        range: 40.0,
        shadow_maps_enabled: true,
        ..default()
    };
    let at = Transform::from_translation(over).looking_at(CROWN.shape().centroid, Vec3::Y);
    studio.world().spawn((spot, at));
    let point = PointLight {
        intensity: 4e6,
        range: 40.0,
        shadow_maps_enabled: true,
        ..default()
    };
    let aside = over * Vec3::new(-1.0, 1.0, -1.0);
    studio
        .world()
        .spawn((point, Transform::from_translation(aside)));
    plant_mesh(studio, Transform::from_xyz(0.0, -4.0, -1.0), false);
}

#[test]
fn a_crown_in_bands_is_the_crown_to_the_bit() {
    for order in [SliceOrder::Steady, SliceOrder::Paper] {
        let (mut studio, crown) = studio(CrownSettings { order, ..default() });
        light(&mut studio);
        let tint = CrownTint(Color::srgb(0.9, 0.7, 0.5));
        studio.world().entity_mut(crown).insert(tint);
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
        let mut crown_entity = studio.world().entity_mut(crown);
        crown_entity.remove::<IntersectingCrown>();
        studio.headless.step();
        assert_eq!(children(&mut studio, crown), []);
        assert!(pictures(&mut studio) == whole);
    }
}

/// What a studio shows near by.
fn near(studio: &mut Studio) -> Vec<u8> {
    let look = shot(eye(25.0, 10.0, 3.0 * CROWN.shape().radius));
    studio.photograph(&look, SKY).rgb_bytes()
}

#[test]
fn not_a_frame_is_without_a_band_where_crowns_come_to_be_drawn_in_them() {
    let (mut studio, crown) = studio(CrownSettings::default());
    let whole = near(&mut studio);
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    // Not a step between.
    assert!(near(&mut studio) == whole);
    assert_eq!(children(&mut studio, crown).len(), CHILDREN);
    // One that comes in this frame.
    let slicing = studio.world().get::<SlicedCrown>(crown).unwrap().clone();
    studio.world().despawn(crown);
    let crown = studio.world().spawn((slicing, IntersectingCrown)).id();
    assert!(near(&mut studio) == whole);
    assert_eq!(children(&mut studio, crown).len(), CHILDREN);
    studio
        .world()
        .entity_mut(crown)
        .remove::<IntersectingCrown>();
    assert!(near(&mut studio) == whole);
}

#[test]
fn bands_that_somebody_else_takes_come_back_and_none_is_left_over() {
    let (mut studio, crown) = studio(CrownSettings::default());
    let whole = near(&mut studio);
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    near(&mut studio);
    let entities = |studio: &mut Studio| {
        let mut all = studio.world().query_filtered::<Entity, With<Mesh3d>>();
        all.iter(studio.world()).count()
    };
    assert_eq!(entities(&mut studio), 1 + CHILDREN);
    let second = children(&mut studio, crown)[1];
    studio.world().despawn(second);
    assert!(near(&mut studio) == whole);
    // Taken from its crown, it would stand at the world's origin.
    let third = children(&mut studio, crown)[2];
    studio.world().entity_mut(third).remove::<ChildOf>();
    assert!(near(&mut studio) == whole);
    assert_eq!(entities(&mut studio), 1 + CHILDREN);
    // A clone, behind the eye, has bands of its own.
    let mut original = studio.world().entity_mut(crown);
    let clone = original.clone_and_spawn_with_opt_out(|clone| {
        clone.linked_cloning(true);
    });
    let behind = eye(25.0, 10.0, 6.0 * CROWN.shape().radius) - CROWN.shape().centroid;
    let mut place = studio.world().get_mut::<Transform>(clone).unwrap();
    place.translation += behind;
    for _ in 0..2 {
        assert!(near(&mut studio) == whole);
    }
    assert_eq!(entities(&mut studio), 2 * (1 + CHILDREN));
    studio.world().despawn(clone);
    studio.world().despawn(crown);
    near(&mut studio);
    assert_eq!(entities(&mut studio), 0);
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
    light(&mut studio);
    let changes: [fn(&mut EntityWorldMut); 12] = [
        |crown| {
            crown.insert(CrownTint(Color::srgb(1.0, 0.5, 0.2)));
        },
        |crown| {
            crown.insert(UNLIT);
        },
        |crown| {
            crown.insert(CrownSettings::default());
        },
        |crown| {
            crown.insert(RenderLayers::layer(3));
        },
        |crown| {
            crown.remove::<RenderLayers>();
        },
        |crown| {
            crown.insert(Visibility::Hidden);
        },
        |crown| {
            crown.insert(Visibility::Inherited);
        },
        |crown| {
            crown.insert(NotShadowCaster);
        },
        |crown| {
            crown.insert(NotShadowReceiver);
        },
        |crown| {
            let tall = Vec3::new(1.2, 0.8, 1.0);
            crown.insert(Transform::from_xyz(0.0, 1.0, 0.0).with_scale(tall));
        },
        |crown| {
            // Half gone where it is.
            let radius = CROWN.shape().radius;
            crown.insert(VisibilityRange {
                start_margin: 0.0..0.0,
                end_margin: 2.0 * radius..4.0 * radius,
                use_aabb: false,
            });
        },
        |crown| {
            crown.remove::<(VisibilityRange, NotShadowCaster, NotShadowReceiver)>();
        },
    ];
    let mut before = near(&mut studio);
    for (i, change) in changes.into_iter().enumerate() {
        studio.world().entity_mut(crown).insert(IntersectingCrown);
        near(&mut studio);
        change(&mut studio.world().entity_mut(crown));
        let in_bands = near(&mut studio);
        let mut whole = studio.world().entity_mut(crown);
        whole.remove::<IntersectingCrown>();
        assert!(in_bands == near(&mut studio), "change {i}");
        assert!(in_bands != before, "change {i} is not seen");
        before = in_bands;
    }
    // Edited while it is in bands.
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    near(&mut studio);
    let id = studio.world().get::<SlicedCrown>(crown).unwrap().0.id();
    let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
    *slicings.get_mut(id).unwrap() = SMALL.clone();
    let in_bands = near(&mut studio);
    studio
        .world()
        .entity_mut(crown)
        .remove::<IntersectingCrown>();
    assert!(in_bands == near(&mut studio) && in_bands != before);
    // What is no crown any more has no bands.
    studio.world().entity_mut(crown).insert(IntersectingCrown);
    near(&mut studio);
    studio.world().entity_mut(crown).remove::<SlicedCrown>();
    near(&mut studio);
    assert_eq!(children(&mut studio, crown), []);
}

#[test]
fn crowns_that_move_in_view_are_sorted_by_where_they_are() {
    let places = [-6.0, 0.0].map(|z| Transform::from_xyz(0.0, 0.0, z));
    let plant = |places: [Transform; 2]| {
        let mut studio = Studio::default();
        let world = studio.world();
        let slicing = world.resource_mut::<Assets<Slicing>>().add(CROWN.clone());
        let tints = [Color::WHITE, Color::srgb(1.0, 0.3, 0.3)];
        let crowns = [0, 1].map(|i| {
            let crown = (SlicedCrown(slicing.clone()), UNLIT, CrownTint(tints[i]));
            world.spawn((crown, places[i])).id()
        });
        (studio, crowns)
    };
    let look = shot(CROWN.shape().centroid + Vec3::Z * 30.0);
    let photograph = |studio: &mut Studio| studio.photograph(&look, SKY).rgb_bytes();
    let (mut studio, [first, second]) = plant(places);
    let before = photograph(&mut studio);
    // Each is now where the other one was.
    for (crown, place) in [(first, places[1]), (second, places[0])] {
        studio.world().entity_mut(crown).insert(place);
    }
    let swapped = photograph(&mut studio);
    let (mut fresh, _) = plant([places[1], places[0]]);
    assert!(swapped == photograph(&mut fresh));
    assert!(swapped != before);
}

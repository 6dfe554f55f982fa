//! Slicings that are drawn together: one draw for crowns of several, and what leaves, or joins, on the way.

use bevy::core_pipeline::core_3d::Transparent3d;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::render_phase::{PhaseItem, ViewSortedRenderPhases};
use bevy::render::storage::ShaderBuffer;
use bevy_verdure::lab::{Pixels, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::{SlicedCrownMaterial, SlicingCompression, SlicingShape};

use crate::recovery::{lose_device, recovering_studio};

use super::{CROWN, UNLIT, eye, shot};

/// The crown without its finest level and its vertical slicing, so that little of its shape is that of the other.
fn plainer() -> Slicing {
    let shape = CROWN.shape();
    let count = shape.orientations.len() - 1;
    let levels = &shape.levels[1..];
    let kept = (1..shape.levels.len()).flat_map(|level| {
        let first = shape.first_layer(level, 0);
        first..first + count * shape.levels[level] as usize
    });
    let pictures = |of: fn(&Slicing, usize) -> &[[u8; 4]]| -> Vec<[u8; 4]> {
        kept.clone()
            .flat_map(|layer| of(&CROWN, layer).to_vec())
            .collect()
    };
    let (color, normal) = (pictures(Slicing::color), pictures(Slicing::normal));
    let shape = SlicingShape {
        levels: levels.to_vec(),
        switches: shape.switches[1..].to_vec(),
        vertical: false,
        orientations: shape.orientations[..count].to_vec(),
        ..shape.clone()
    };
    Slicing::new(shape, color, normal).expect("a part of the crown is a slicing")
}

/// Crowns by turns of as many slicings, in a row that is seen along, so that they are sorted by turns too.
fn row(slicings: &[Slicing]) -> (Studio, Vec<Entity>, Vec<Handle<Slicing>>) {
    let mut studio = Studio::default();
    let (crowns, handles) = plant_row(&mut studio, slicings, UNLIT);
    (studio, crowns, handles)
}

/// The same in a studio, with some settings.
fn plant_row(
    studio: &mut Studio,
    slicings: &[Slicing],
    settings: CrownSettings,
) -> (Vec<Entity>, Vec<Handle<Slicing>>) {
    let mut assets = studio.world().resource_mut::<Assets<Slicing>>();
    let handles: Vec<_> = slicings
        .iter()
        .map(|slicing| assets.add(slicing.clone()))
        .collect();
    let crowns = (0..6).map(|i| {
        let place = Transform::from_xyz(3.0 * (i % 2) as f32, 0.0, -9.0 * i as f32);
        let crown = SlicedCrown(handles[i % handles.len()].clone());
        studio.world().spawn((crown, settings, place)).id()
    });
    (crowns.collect(), handles)
}

fn picture(studio: &mut Studio) -> Pixels {
    studio.photograph(&shot(eye(90.0, 12.0, 30.0)), Color::BLACK)
}

/// Draws and crowns of the last picture.
fn draws(studio: &mut Studio) -> (usize, usize) {
    let render = studio.headless.app().sub_app(RenderApp).world();
    let phases = render.resource::<ViewSortedRenderPhases<Transparent3d>>();
    let (mut draws, mut crowns, mut batched) = (0, 0, 0);
    for item in phases.values().flat_map(|phase| phase.items.values()) {
        if batched == 0 {
            draws += 1;
            batched = item.batch_range().len();
        }
        batched = batched.saturating_sub(1);
        crowns += 1;
    }
    (draws, crowns)
}

fn material(studio: &mut Studio, crown: Entity) -> AssetId<SlicedCrownMaterial> {
    let material = studio
        .world()
        .get::<MeshMaterial3d<SlicedCrownMaterial>>(crown);
    material.expect("the crown is drawn").id()
}

/// Steps until crowns, none of them near, are drawn together, which is done behind the frames.
fn gather(studio: &mut Studio, crowns: [Entity; 2]) {
    for _ in 0..2000 {
        let [a, b] = crowns.map(|crown| material(studio, crown));
        if a == b {
            return;
        }
        studio.headless.step();
        std::thread::sleep(core::time::Duration::from_millis(1));
    }
    panic!("slicings are not drawn together");
}

#[test]
fn crowns_of_several_slicings_come_to_be_one_draw_and_look_as_before() {
    let (mut studio, crowns, _) = row(&[CROWN.clone(), plainer()]);
    studio.headless.step();
    let apart = picture(&mut studio);
    assert_eq!(
        draws(&mut studio),
        (6, 6),
        "each is between two of the other"
    );
    gather(&mut studio, [crowns[0], crowns[1]]);
    let together = picture(&mut studio);
    assert_eq!(draws(&mut studio), (1, 6));
    assert_eq!(apart.rgb_bytes(), together.rgb_bytes());
    // Nothing is left to do.
    let before = material(&mut studio, crowns[0]);
    for _ in 0..100 {
        studio.headless.step();
    }
    assert_eq!(material(&mut studio, crowns[0]), before);
}

#[test]
fn no_frame_is_without_its_crowns_while_sets_are_made() {
    let (mut studio, crowns, _) = row(&[CROWN.clone(), plainer()]);
    studio.headless.step();
    let apart = picture(&mut studio);
    let is_gathered =
        |studio: &mut Studio| material(studio, crowns[0]) == material(studio, crowns[1]);
    for _ in 0..2000 {
        let was_gathered = is_gathered(&mut studio);
        studio.headless.step();
        assert_eq!(draws(&mut studio).1, 6, "each frame has all crowns");
        if was_gathered {
            assert_eq!(picture(&mut studio).rgb_bytes(), apart.rgb_bytes());
            return;
        }
        std::thread::sleep(core::time::Duration::from_millis(1));
    }
    panic!("slicings are not drawn together");
}

#[test]
fn crowns_are_lit_and_shadowed_as_before_when_they_are_gathered() {
    let mut studio = Studio::default();
    let slicings = [CROWN.clone(), plainer()];
    let (crowns, _) = plant_row(&mut studio, &slicings, CrownSettings::default());
    // Bevy's own cascades, which overlap.
    studio.world().spawn((
        DirectionalLight {
            shadow_maps_enabled: true,
            ..default()
        },
        Transform::default().looking_to(Vec3::new(0.3, -1.0, -0.6), Vec3::Y),
    ));
    studio.headless.step();
    let apart = picture(&mut studio);
    gather(&mut studio, [crowns[0], crowns[1]]);
    assert_eq!(picture(&mut studio).rgb_bytes(), apart.rgb_bytes());
}

#[test]
fn gathered_crowns_come_back_after_their_device_is_lost_and_when_they_are_compressed() {
    let mut studio = recovering_studio();
    let (crowns, _) = plant_row(&mut studio, &[CROWN.clone(), plainer()], UNLIT);
    let pair = [crowns[0], crowns[1]];
    studio.headless.step();
    let before = picture(&mut studio);
    gather(&mut studio, pair);
    lose_device(&mut studio);
    assert_eq!(picture(&mut studio).rgb_bytes(), before.rgb_bytes());
    gather(&mut studio, pair);
    for compression in [
        SlicingCompression::WhereSupported,
        SlicingCompression::Never,
    ] {
        studio.world().insert_resource(compression);
        studio.headless.step();
        let apart = picture(&mut studio);
        gather(&mut studio, pair);
        assert_eq!(
            picture(&mut studio).rgb_bytes(),
            apart.rgb_bytes(),
            "{compression:?}"
        );
    }
    assert_eq!(picture(&mut studio).rgb_bytes(), before.rgb_bytes());
}

#[test]
fn what_crowns_were_drawn_with_is_let_go_of_when_they_are_gathered() {
    let (mut studio, crowns, _) = row(&[CROWN.clone(), plainer()]);
    let counts = |studio: &mut Studio| {
        let world = studio.world();
        [
            world.resource::<Assets<Image>>().len(),
            world.resource::<Assets<ShaderBuffer>>().len(),
            world.resource::<Assets<SlicedCrownMaterial>>().len(),
        ]
    };
    studio.headless.step();
    picture(&mut studio);
    let apart = counts(&mut studio);
    gather(&mut studio, [crowns[0], crowns[1]]);
    picture(&mut studio);
    let together = counts(&mut studio);
    // Two images, two buffers and two materials, for near and for far, that each of two had.
    assert_eq!(together, apart.map(|count| count - 2));
    for crown in crowns {
        studio.world().despawn(crown);
    }
    picture(&mut studio);
    assert_eq!(counts(&mut studio), together.map(|count| count - 2));
}

#[test]
fn a_slicing_that_changes_leaves_its_set_and_comes_back() {
    let (mut studio, crowns, slicings) = row(&[CROWN.clone(), plainer()]);
    studio.headless.step();
    picture(&mut studio);
    gather(&mut studio, [crowns[0], crowns[1]]);
    let mut assets = studio.world().resource_mut::<Assets<Slicing>>();
    assets
        .insert(slicings[1].id(), CROWN.clone())
        .expect("the handle is alive");
    for _ in 0..3 {
        studio.headless.step();
    }
    assert_ne!(
        material(&mut studio, crowns[0]),
        material(&mut studio, crowns[1])
    );
    let changed = picture(&mut studio);
    gather(&mut studio, [crowns[0], crowns[1]]);
    assert_eq!(picture(&mut studio).rgb_bytes(), changed.rgb_bytes());
    let (mut fresh, ..) = row(core::slice::from_ref(&*CROWN));
    fresh.headless.step();
    assert_eq!(picture(&mut fresh).rgb_bytes(), changed.rgb_bytes());
}

#[test]
fn crowns_whose_slicing_is_removed_stay_while_others_are_gathered() {
    let (mut studio, crowns, slicings) = row(&[CROWN.clone(), plainer(), CROWN.clone()]);
    studio.headless.step();
    let before = picture(&mut studio);
    let mut assets = studio.world().resource_mut::<Assets<Slicing>>();
    assert!(assets.remove(slicings[1].id()).is_some());
    gather(&mut studio, [crowns[0], crowns[2]]);
    assert_ne!(
        material(&mut studio, crowns[0]),
        material(&mut studio, crowns[1])
    );
    assert_eq!(picture(&mut studio).rgb_bytes(), before.rgb_bytes());
}

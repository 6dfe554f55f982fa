//! How many draws and quads a grove takes in a frame.

use core::f32::consts::PI;

use bevy::core_pipeline::core_3d::Transparent3d;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::render_phase::{PhaseItem, ViewSortedRenderPhases};
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::blend::{PARTS, drawn_slices};

use super::{CROWN, UNLIT};

/// The grove's eye, in a picture of the same shape. It sees a part of the trees.
const LOOK: Shot = Shot {
    eye: Vec3::new(-18.0, 1.7, 12.0),
    at: Vec3::new(0.0, 4.0, 0.0),
    lens: Lens::Perspective(0.9),
    size: UVec2::new(64, 48),
};

/// What a frame takes.
#[derive(Debug)]
struct Frame {
    /// Crowns in view.
    crowns: usize,
    draws: usize,
    /// Slices that are not empty, on a screen of 480 lines.
    quads: usize,
    /// Whether a crown is so near that its parts have discrepancy angles of their own.
    is_any_near: bool,
    /// Neighbours in their order, far to near, that are of different assets, or of which one is near.
    changes: usize,
}

/// What is sorted, in its order, and how many draws that is.
fn items_and_draws(studio: &mut Studio) -> (Vec<Entity>, usize) {
    let render = studio.headless.app().sub_app(RenderApp).world();
    let phases = render.resource::<ViewSortedRenderPhases<Transparent3d>>();
    let items = phases.values().flat_map(|phase| phase.items.values());
    // As Bevy walks through them: the first item of a batch stands for all of it.
    let (mut draws, mut batched, mut seen) = (0, 0, Vec::new());
    for item in items {
        seen.push(item.main_entity().id());
        if batched == 0 {
            draws += 1;
            batched = item.batch_range().len();
        }
        batched = batched.saturating_sub(1);
    }
    (seen, draws)
}

/// A grove on a spiral, of so many assets by turns.
fn grove(crowns: u32, assets: usize) -> Frame {
    let mut studio = Studio::default();
    let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
    let slicings: Vec<_> = (0..assets).map(|_| slicings.add(CROWN.clone())).collect();
    for i in 0..crowns {
        let reach = 9.0 * (i as f32 / PI).sqrt();
        let (sin, cos) = (2.399_963 * i as f32).sin_cos();
        let place = Transform::from_xyz(reach * cos, 0.0, reach * sin);
        let slicing = slicings[i as usize % assets].clone();
        studio.world().spawn((SlicedCrown(slicing), UNLIT, place));
    }
    studio.headless.step();
    studio.photograph(&LOOK, Color::BLACK);
    let (seen, draws) = items_and_draws(&mut studio);
    let world = studio.world();
    let (mut quads, mut order, mut is_any_near) = (0, Vec::new(), false);
    for crown in &seen {
        let place = world.get::<Transform>(*crown).unwrap().translation;
        let eye = LOOK.eye - place - CROWN.shape().centroid;
        let is_near = eye.length() < PARTS[1] * CROWN.shape().radius;
        is_any_near |= is_near;
        quads += drawn_slices(CROWN.shape(), eye, UNLIT.order, 0).len();
        order.push((world.get::<SlicedCrown>(*crown).unwrap().0.id(), is_near));
    }
    Frame {
        crowns: seen.len(),
        draws,
        quads,
        is_any_near,
        changes: order.windows(2).filter(|pair| pair[0] != pair[1]).count(),
    }
}

#[test]
fn crowns_of_one_asset_are_one_draw_and_of_two_at_first_one_for_each_turn_in_their_order() {
    for crowns in [128, 1000] {
        let (one, two) = (grove(crowns, 1), grove(crowns, 2));
        println!("{crowns} crowns: of one asset {one:?}, of two {two:?}");
        assert!(one.crowns > crowns as usize / 8);
        // Near crowns are a draw of their own.
        assert_eq!(one.changes, usize::from(one.is_any_near));
        assert_eq!(one.draws, one.changes + 1);
        // The paper has ten quads a tree.
        assert!(one.quads < 10 * one.crowns);
        assert_eq!(two.draws, two.changes + 1);
        assert!(two.draws > 1 && two.draws <= two.crowns);
    }
}

#[test]
fn crowns_in_bands_are_one_draw_too_and_their_bands_are_sorted_among_one_another() {
    let mut studio = Studio::default();
    // One asset, or it would take a moment until all are drawn at once.
    let slicing = studio
        .world()
        .resource_mut::<Assets<Slicing>>()
        .add(CROWN.clone());
    let crowns: Vec<_> = [-1.0, 1.0, 3.0]
        .map(|x| {
            let place = Transform::from_xyz(x, 0.0, 0.3 * x);
            let crown = (
                SlicedCrown(slicing.clone()),
                UNLIT,
                place,
                IntersectingCrown,
            );
            studio.world().spawn(crown).id()
        })
        .into();
    let look = Shot {
        // Five slices of an orientation.
        size: UVec2::new(640, 480),
        ..LOOK
    };
    studio.photograph(&look, Color::BLACK);
    let (seen, draws) = items_and_draws(&mut studio);
    assert_eq!((seen.len(), draws), (15, 1));
    let world = studio.world();
    let crown_of = |entity: &Entity| {
        world
            .get::<ChildOf>(*entity)
            .map_or(*entity, ChildOf::parent)
    };
    let order: Vec<_> = seen.iter().map(crown_of).collect();
    for crown in &crowns {
        assert_eq!(order.iter().filter(|other| *other == crown).count(), 5);
        // Its own bands are in order: it draws the furthest, and has the others as children, far to near.
        let own = seen.iter().filter(|entity| crown_of(entity) == *crown);
        let children = world.get::<Children>(*crown).expect("it has some").iter();
        assert!(own.copied().eq([*crown].into_iter().chain(children)));
    }
    // Three crowns, one after the other, would be two changes.
    let changes = order.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert!(changes > 6, "{changes}");
}

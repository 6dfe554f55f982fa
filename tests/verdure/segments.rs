//! Segment entities that are moved, not only turned, against the reference of what they make of the plant.

use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use crate::skeletons::reference;
use crate::view::{Scenery, View};

/// Two limbs from one root, the first of two segments.
fn fork(root: Vec3, first: [Vec3; 2], second: Vec3) -> Skeleton {
    let mut fork = Skeleton::builder();
    let root = fork.root(root, 0.25);
    fork.chain(root, &[(first[0], 0.2), (first[1], 0.15)]);
    fork.joint(root, second, 0.15);
    fork.build().unwrap()
}

const ROOT: Vec3 = Vec3::new(0.0, -0.8, 0.0);
const FIRST: [Vec3; 2] = [Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.2, 0.8, 0.2)];
const SECOND: Vec3 = Vec3::new(-0.8, 0.1, 0.1);

/// Moves the segment that ends at a joint, and checks that the plant looks like the skeleton that this should make.
fn check(joint: usize, by: Vec3, expected: &Skeleton) {
    let mut studio = Studio::default();
    let skeleton = fork(ROOT, FIRST, SECOND);
    let plant = studio.plant(skeleton, Frusta::default(), Transform::IDENTITY);
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    studio.headless.step();
    let segments = studio.world().get::<SegmentEntities>(plant).unwrap();
    let segment = segments.get(joint).unwrap();
    studio
        .world()
        .get_mut::<Transform>(segment)
        .unwrap()
        .translation += by;
    let view = View {
        eye: Transform::from_xyz(0.4, 0.5, 4.0).looking_at(Vec3::ZERO, Vec3::Y),
        projection: Projection::default(),
        jitter: None,
        size: UVec2::new(128, 96),
    };
    let picture = view.look(&mut studio);
    let scenery = Scenery {
        plant: reference(expected),
        wall: None,
    };
    let (plant, _) = view.check(&picture, &scenery);
    assert!(plant > 500);
}

#[test]
fn a_root_moves_with_the_first_segment_that_begins_there() {
    let by = Vec3::new(0.3, 0.2, -0.1);
    check(1, by, &fork(ROOT + by, FIRST.map(|at| at + by), SECOND));
}

#[test]
fn a_segment_that_is_moved_stays_attached_where_it_begins() {
    let by = Vec3::new(0.3, 0.2, -0.1);
    check(2, by, &fork(ROOT, [FIRST[0], FIRST[1] + by], SECOND));
    check(3, by, &fork(ROOT, FIRST, SECOND + by));
}

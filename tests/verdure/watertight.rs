//! No ray slips through: not at joins, not in motion, not far from the origin.

use bevy::prelude::*;
use bevy_verdure::lab::reference::{
    ReferenceEnds, ReferenceJoin, ReferenceJoint, ReferenceScene, ReferenceSettings,
};
use bevy_verdure::lab::{Lens, NEAR, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, Growth, Roll, ball, double};

const SIZE: UVec2 = UVec2::new(256, 192);
const VIEWS: usize = 64;

/// Directions spread evenly over the sphere (a Fibonacci lattice).
fn view(i: usize) -> Vec3 {
    let z = 1.0 - (2 * i + 1) as f32 / VIEWS as f32;
    let turn = i as f32 * 2.399_963_2;
    let across = (1.0 - z * z).sqrt();
    Vec3::new(turn.cos() * across, z, turn.sin() * across)
}

/// What stands still or moves under the views.
#[derive(Clone, Copy, PartialEq)]
enum Motion {
    Rest,
    Posed,
    Moving,
}

/// Pixels that show the background although the reference hits the plant there and all round.
fn holes(
    join: Join,
    reference: ReferenceJoin,
    motion: Motion,
    place: Vec3,
    growth: Growth,
    seed: u64,
) -> usize {
    let mut studio = Studio::default();
    let mut dice = Dice::new(seed);
    let skeleton = growth.grow(&mut dice);
    let (centre, radius) = ball(&skeleton);
    let plant = studio.plant(
        skeleton.clone(),
        Frusta {
            join,
            ends: Ends::Round,
        },
        Transform::from_translation(place),
    );
    let settings = ReferenceSettings {
        join: reference,
        ends: ReferenceEnds::Round,
    };
    let mut holes = 0;
    let mut inside = 0;
    for i in 0..VIEWS {
        if motion == Motion::Moving || motion == Motion::Posed && i == 0 {
            let rotations = (0..skeleton.len())
                .map(|_| Quat::from_axis_angle(dice.direction(), dice.between(-0.6, 0.6)))
                .collect();
            studio
                .world()
                .entity_mut(plant)
                .insert(SkeletonPose { rotations });
        }
        let eye = place + centre + view(i) * (radius * 2.2);
        let shot = Shot {
            eye,
            at: place + centre,
            lens: Lens::Perspective(0.9),
            size: SIZE,
        };
        let picture = studio.measure_output(&shot, FrustaOutput::Geometry);
        // The pose that was drawn.
        let posed = studio
            .world()
            .get::<PosedJoints>(plant)
            .map(|posed| posed.positions().to_vec());
        let joints: Vec<ReferenceJoint> = skeleton
            .joints()
            .iter()
            .enumerate()
            .map(|(i, joint)| ReferenceJoint {
                position: double(posed.as_ref().map_or(joint.position, |posed| posed[i])),
                radius: f64::from(joint.radius),
                parent: joint.parent.map(|parent| parent as usize),
            })
            .collect();
        let scene = ReferenceScene::new(&joints, settings);
        // The eye in local space, as exactly as the engine's own numbers put it.
        let local_eye = double(shot.eye) - double(place);
        let is_hit = |x: f32, y: f32| {
            let (_, direction) = shot.ray(x, y);
            scene.cast(local_eye, direction, f64::from(NEAR)).is_some()
        };
        for y in 1..SIZE.y - 1 {
            for x in 1..SIZE.x - 1 {
                if picture.floats(x, y)[1] >= 0.0 {
                    inside += 1;
                    continue;
                }
                // A hole begins beside the plant.
                let beside = [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
                if beside.iter().all(|(x, y)| picture.floats(*x, *y)[1] < 0.0) {
                    continue;
                }
                let (cx, cy) = (x as f32 + 0.5, y as f32 + 0.5);
                if is_hit(cx, cy)
                    && [-1.0, 1.0]
                        .iter()
                        .all(|d| is_hit(cx + d, cy) && is_hit(cx, cy + d))
                {
                    println!("hole at {x},{y} in view {i} of {join:?}");
                    holes += 1;
                }
            }
        }
    }
    assert!(inside > VIEWS * 500, "the plant fills the views: {inside}");
    holes
}

const CHAIN: Growth = Growth {
    joints: 8,
    bend: 110.0,
    taper: 3.0,
    aspect: (0.15, 1.5),
    branching: 0.0,
};
const TREE: Growth = Growth {
    joints: 20,
    bend: 80.0,
    taper: 1.6,
    aspect: (0.1, 0.6),
    branching: 0.35,
};

/// One radius throughout: there the paper's planes are exact too.
const HOSE: Growth = Growth {
    joints: 8,
    bend: 60.0,
    taper: 1.0,
    aspect: (0.1, 0.25),
    branching: 0.0,
};

const JOINS: [(Join, ReferenceJoin); 2] = [
    (Join::Mitre, ReferenceJoin::Mitre),
    (Join::Round, ReferenceJoin::Round),
];

#[test]
fn closed_skeletons_have_no_hole() {
    for (join, reference) in JOINS {
        for (growth, seed) in [(CHAIN, 1), (TREE, 2)] {
            assert_eq!(
                holes(join, reference, Motion::Rest, Vec3::ZERO, growth, seed),
                0
            );
        }
    }
}

#[test]
fn the_papers_joins_have_no_hole_where_radii_are_equal() {
    for (join, reference) in [
        (Join::Paper, ReferenceJoin::Paper),
        (Join::PaperIterated, ReferenceJoin::PaperIterated),
    ] {
        let found = holes(join, reference, Motion::Rest, Vec3::ZERO, HOSE, 7);
        assert_eq!(found, 0);
    }
}

#[test]
fn bent_and_moving_plants_have_no_hole() {
    for (join, reference) in JOINS {
        assert_eq!(
            holes(join, reference, Motion::Posed, Vec3::ZERO, CHAIN, 3),
            0
        );
        assert_eq!(
            holes(join, reference, Motion::Moving, Vec3::ZERO, CHAIN, 4),
            0
        );
    }
}

#[test]
fn ten_kilometres_from_the_origin_there_is_no_hole() {
    let far = Vec3::new(7_071.3, 12.7, -7_071.9);
    for (join, reference) in JOINS {
        assert_eq!(holes(join, reference, Motion::Rest, far, TREE, 5), 0);
        assert_eq!(holes(join, reference, Motion::Moving, far, CHAIN, 6), 0);
    }
}

//! The shaders against the reference ray caster, pixel by pixel.

use bevy::prelude::*;
use bevy_verdure::lab::reference::{
    ReferenceEnds, ReferenceJoin, ReferenceScene, ReferenceSettings,
};
use bevy_verdure::lab::{Lens, NEAR, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, Growth, Roll, ball, reference_joints};

const SIZE: UVec2 = UVec2::new(256, 192);
/// Greatest error of depth, as a share of the distance.
const DEPTH: f64 = 1e-4;
/// Greatest share of pixels with a wrong hit, miss or segment.
const WRONG: f64 = 5e-4;

/// What was found over many pictures.
#[derive(Default, Debug)]
struct Tally {
    pixels: usize,
    hits: usize,
    wrong: usize,
    /// Wrong pixels that are not within a pixel of an edge.
    wrong_inside: usize,
    worst_depth: f64,
}

/// What a ray sees in the reference: the segment and the depth.
fn reference_pixel(scene: &ReferenceScene, shot: &Shot, x: f32, y: f32) -> Option<(u32, f64)> {
    let (origin, direction) = shot.ray(x, y);
    let hit = scene.cast(origin, direction, f64::from(NEAR))?;
    Some((hit.segment as u32, hit.t))
}

fn compare(studio: &mut Studio, scene: &ReferenceScene, shot: &Shot, tally: &mut Tally) -> bool {
    let figures = studio.measure(shot);
    let mut agrees = true;
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let (cx, cy) = (x as f32 + 0.5, y as f32 + 0.5);
            let expected = reference_pixel(scene, shot, cx, cy);
            let seen = figures.get(x, y);
            tally.pixels += 1;
            tally.hits += usize::from(expected.is_some());
            match (expected, seen) {
                (Some((segment, depth)), Some(seen)) if segment == seen.segment => {
                    let distance = shot.ray(cx, cy).1.length() * depth;
                    let error = (f64::from(seen.depth) - depth).abs() / distance;
                    tally.worst_depth = tally.worst_depth.max(error);
                    if error > DEPTH {
                        let (origin, direction) = shot.ray(cx, cy);
                        let hit = scene.cast(origin, direction, f64::from(NEAR));
                        println!("deep {x},{y}: {hit:?} but {}", seen.depth);
                        agrees = false;
                    }
                }
                (None, None) => {}
                (_, seen) => {
                    tally.wrong += 1;
                    // Within a pixel there is an edge: some ray sees another segment, or another hit or miss.
                    let offsets = [-1.0, -0.5, 0.0, 0.5, 1.0];
                    let near_edge = offsets.iter().any(|dx| {
                        offsets.iter().any(|dy| {
                            let other = reference_pixel(scene, shot, cx + dx, cy + dy);
                            other.map(|o| o.0) != expected.map(|e| e.0)
                        })
                    });
                    if !near_edge {
                        println!("wrong {x},{y}: {expected:?} but {seen:?}");
                        agrees = false;
                    }
                    tally.wrong_inside += usize::from(!near_edge);
                }
            }
        }
    }
    agrees
}

fn agree(
    join: Join,
    reference: ReferenceJoin,
    ends: Ends,
    growths: &[Growth],
    rounds: usize,
) -> Tally {
    let mut studio = Studio::default();
    let mut dice = Dice::new(2009);
    let mut tally = Tally::default();
    for round in 0..rounds {
        let skeleton = growths[round % growths.len()].grow(&mut dice);
        let settings = ReferenceSettings {
            join: reference,
            ends: match ends {
                Ends::Round => ReferenceEnds::Round,
                Ends::Flat => ReferenceEnds::Flat,
            },
        };
        let scene = ReferenceScene::new(&reference_joints(&skeleton), settings);
        let (centre, radius) = ball(&skeleton);
        let text = skeleton.to_ron();
        let plant = studio.plant(skeleton.clone(), Frusta { join, ends }, Transform::IDENTITY);
        // Far away, near, grazing along a segment, and without perspective.
        let direction = dice.direction();
        let i = 1 + (dice.roll() * (skeleton.len() - 1) as f32) as usize;
        let joint = &skeleton.joints()[i];
        let parent = &skeleton.joints()[joint.parent.unwrap() as usize];
        let along = (joint.position - parent.position).normalize_or(Vec3::Y);
        let side = along.any_orthonormal_vector();
        let shots = [
            (
                centre + direction * radius * 60.0,
                centre,
                Lens::Perspective(0.04),
            ),
            (
                centre + direction * radius * 1.6,
                centre,
                Lens::Perspective(1.0),
            ),
            (
                joint.position + along * (radius * 1.5) + side * (joint.radius * 1.02),
                parent.position + side * (parent.radius * 1.02),
                Lens::Perspective(0.7),
            ),
            (
                centre + direction * radius * 3.0,
                centre,
                Lens::Orthographic(radius * 2.2),
            ),
        ];
        for (eye, at, lens) in shots {
            let shot = Shot {
                eye,
                at,
                lens,
                size: SIZE,
            };
            if !compare(&mut studio, &scene, &shot, &mut tally) {
                println!("round {round}, {shot:?} of\n{text}\n{tally:?}");
            }
        }
        studio.uproot(plant);
    }
    println!("{join:?}, {ends:?}: {tally:?}");
    tally
}

impl Tally {
    fn check(&self) {
        assert!(
            self.hits * 100 > self.pixels,
            "the plants are in the pictures: {self:?}"
        );
        assert!(
            self.worst_depth <= DEPTH,
            "depth within {DEPTH} of the distance: {self:?}"
        );
        assert!(self.wrong as f64 <= WRONG * self.pixels as f64, "{self:?}");
        assert_eq!(self.wrong_inside, 0, "wrong pixels are at edges: {self:?}");
    }
}

const PLANT: Growth = Growth {
    joints: 14,
    bend: 60.0,
    taper: 1.5,
    aspect: (0.02, 0.5),
    branching: 0.3,
};
const HARSH: Growth = Growth {
    joints: 6,
    bend: 180.0,
    taper: 8.0,
    aspect: (0.05, 5.0),
    branching: 0.2,
};
const THIN: Growth = Growth {
    joints: 10,
    bend: 120.0,
    taper: 2.0,
    aspect: (0.02, 0.1),
    branching: 0.1,
};

#[test]
fn mitred_frusta_are_where_the_reference_says() {
    agree(
        Join::Mitre,
        ReferenceJoin::Mitre,
        Ends::Round,
        &[PLANT, HARSH, THIN],
        12,
    )
    .check();
}

#[test]
fn round_frusta_are_where_the_reference_says() {
    agree(
        Join::Round,
        ReferenceJoin::Round,
        Ends::Round,
        &[PLANT, HARSH, THIN],
        6,
    )
    .check();
}

#[test]
fn flat_ends_are_where_the_reference_says() {
    agree(
        Join::Mitre,
        ReferenceJoin::Mitre,
        Ends::Flat,
        &[PLANT, HARSH],
        6,
    )
    .check();
}

#[test]
fn the_papers_joins_are_where_the_reference_says() {
    // Only where the construction has a plane at all: the reference drops segments it cannot bound.
    let gentle = Growth {
        taper: 1.2,
        bend: 40.0,
        branching: 0.0,
        ..PLANT
    };
    agree(Join::Paper, ReferenceJoin::Paper, Ends::Round, &[gentle], 3).check();
}

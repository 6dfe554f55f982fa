//! Depth, segment and texture coordinates, pixel by pixel.

use bevy::prelude::*;
use bevy_verdure::lab::reference::relief::{
    HeightImage, ReliefOptions, ReliefScene, ShellThickness,
};
use bevy_verdure::lab::reference::{ReferenceEnds, ReferenceJoin, ReferenceSettings};
use bevy_verdure::lab::{NEAR, Shot, Studio};
use bevy_verdure::prelude::*;

use super::{THICKNESS, add_map, bumps, limb, views};
use crate::skeletons::reference_joints;

/// What was found in one picture.
#[derive(Default, Debug)]
struct Tally {
    hits: usize,
    /// A wrong hit, miss or segment.
    wrong: usize,
    /// Off, across the surface, by more than a hundredth of the shell.
    deep: usize,
    worst: f64,
    error: f64,
}

fn compare(studio: &mut Studio, scene: &ReliefScene, shot: &Shot) -> Tally {
    let figures = studio.measure(shot);
    let mut tally = Tally::default();
    for y in 0..shot.size.y {
        for x in 0..shot.size.x {
            let (origin, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
            let expected = scene.cast(origin, direction, f64::from(NEAR));
            let seen = figures.get(x, y);
            tally.hits += usize::from(expected.is_some());
            match (expected, seen) {
                (Some(hit), Some(seen)) if hit.segment as u32 == seen.segment => {
                    // Along a grazing ray, what is off across the surface is off by far more.
                    let off =
                        (f64::from(seen.depth) - hit.t).abs() * direction.dot(hit.normal).abs();
                    tally.worst = tally.worst.max(off);
                    tally.error += off;
                    tally.deep += usize::from(off > 0.01 * f64::from(THICKNESS));
                }
                (None, None) => {}
                _ => tally.wrong += 1,
            }
        }
    }
    tally
}

fn agree(
    skeleton: &Skeleton,
    join: Join,
    map: &HeightImage,
    relief: impl Fn(Relief) -> Relief,
) -> Tally {
    let mut studio = Studio::default();
    let handle = add_map(&mut studio, map);
    let relief = relief(Relief::new(handle, ReliefThickness::Metres(THICKNESS)));
    let settings = ReferenceSettings {
        join: match join {
            Join::Round => ReferenceJoin::Round,
            _ => ReferenceJoin::Mitre,
        },
        ends: ReferenceEnds::Round,
    };
    let options = ReliefOptions {
        continuous_u: true,
        ..default()
    };
    let height = |u: f64, v: f64| map.sample(u, v);
    let thickness = ShellThickness::Metres(f64::from(THICKNESS));
    let joints = reference_joints(skeleton);
    let scene = ReliefScene::with_options(&joints, settings, &height, thickness, &options);
    studio.plant_in(
        skeleton.clone(),
        Frusta::default().with_join(join),
        Transform::IDENTITY,
        relief_material(Color::WHITE, relief),
    );
    // The map is taken up in the frame after the material.
    for _ in 0..3 {
        studio.headless.step();
    }
    let mut sum = Tally::default();
    for shot in views() {
        let tally = compare(&mut studio, &scene, &shot);
        println!(
            "{}: {tally:?}, mean {}",
            shot.eye,
            tally.error / tally.hits as f64
        );
        sum.hits += tally.hits;
        sum.wrong += tally.wrong;
        sum.deep += tally.deep;
        sum.worst = sum.worst.max(tally.worst);
        sum.error += tally.error;
    }
    sum
}

#[test]
fn relief_is_where_the_reference_marches_to() {
    let finest = |relief: Relief| Relief {
        bisections: 12,
        ..relief.with_steps(ReliefSteps::Fixed(256))
    };
    for join in [Join::Mitre, Join::Round] {
        for (taper, bend) in [(1.0, 0.0), (1.0, 0.5), (0.75, 0.5)] {
            let tally = agree(&limb(taper, bend), join, &bumps(), finest);
            println!("{join:?} {taper} {bend}: {tally:?}");
            assert!(tally.hits > 4_000, "the limb is in the pictures");
            // Rays that graze a bump are decided by the last bit of the map's filter, and 256 steps may pass between
            // what 4,096 find: along outlines, which a limb of these pictures has about 1,000 pixels of.
            assert!(tally.wrong * 200 <= tally.hits, "{tally:?}");
            assert!(tally.deep * 200 <= tally.hits, "{tally:?}");
        }
    }
}

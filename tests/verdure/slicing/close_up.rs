//! Crowns that give over to their meshes right up close.

use bevy::camera::visibility::VisibilityRange;
use bevy::prelude::*;
use bevy_verdure::lab::{Pixels, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::close_up;

use crate::jumps::jumps;

use super::{eye, plant_mesh, shot, studio, sun};

/// What is seen from so many metres from the foot of the tree, where the ranges are measured from.
fn look(studio: &mut Studio, metres: f32) -> Pixels {
    let level = (metres.powi(2) - eye(0.0, 0.0, 0.0).y.powi(2)).sqrt();
    studio.photograph(&shot(eye(75.0, 0.0, level)), Color::srgb(0.6, 0.8, 1.0))
}

/// A crown and its mesh that give over to one another in a margin.
fn tree(settings: CrownSettings, [near, far]: [VisibilityRange; 2]) -> Studio {
    let (mut studio, crown) = studio(settings);
    sun(&mut studio);
    studio.world().entity_mut(crown).insert(far);
    for part in plant_mesh(&mut studio, Transform::IDENTITY, false) {
        studio.world().entity_mut(part).insert(near.clone());
    }
    studio.headless.step();
    studio
}

#[test]
fn a_crown_is_its_mesh_up_close_and_slices_further_away() {
    for composition in [Composition::Blended, Composition::Hashed] {
        let settings = CrownSettings {
            composition,
            ..default()
        };
        let mut both = tree(settings, close_up(10.0..12.0));
        let (mut slices, _) = studio(settings);
        sun(&mut slices);
        let (mut mesh, crown) = studio(settings);
        sun(&mut mesh);
        mesh.world().despawn(crown);
        plant_mesh(&mut mesh, Transform::IDENTITY, false);
        mesh.headless.step();
        let same = |a: &mut Studio, b: &mut Studio, metres: f32| {
            look(a, metres).rgb_bytes() == look(b, metres).rgb_bytes()
        };
        assert!(same(&mut both, &mut mesh, 9.5), "{composition:?}");
        assert!(!same(&mut both, &mut slices, 9.5), "{composition:?}");
        assert!(same(&mut both, &mut slices, 12.5), "{composition:?}");
        assert!(!same(&mut both, &mut mesh, 12.5), "{composition:?}");
    }
}

#[test]
fn walking_up_to_a_tree_changes_it_to_its_mesh_without_a_pop() {
    let walk = |margin| {
        let mut studio = tree(CrownSettings::default(), close_up(margin));
        jumps((0..64).map(|i| look(&mut studio, 12.6 - 0.05 * i as f32)))
    };
    let (pop, _) = walk(11.0..11.0);
    let (fade, _) = walk(10.0..12.0);
    // What motion alone changes of the one and of the other.
    let motion = walk(0.0..0.0).0.max(walk(100.0..100.0).0);
    println!("at once {pop:.3}, faded {fade:.3}, motion {motion:.3}");
    // A sixteenth of the pixels change hands at once.
    assert!(fade <= motion + pop / 8.0, "{fade} {motion} {pop}");
    // Without a pop there would be nothing to compare with.
    assert!(pop > 2.0 * motion, "{pop} {motion}");
}

//! The grove that costs are measured in.

use bevy::light::NotShadowCaster;
use bevy::prelude::*;
use bevy_verdure::lab::{Lens, Shot};
use bevy_verdure::plants::Dice;

use super::lab::{Drawn, Lab};

/// Metres between trees.
const SPACING: f32 = 9.0;

/// From where the grove is seen.
pub const SHOT: Shot = Shot {
    eye: Vec3::new(-18.0, 1.7, 12.0),
    at: Vec3::new(0.0, 4.0, 0.0),
    lens: Lens::Perspective(0.9),
    size: UVec2::new(640, 480),
};

/// Radius of a grove of so many trees, in metres.
pub fn radius(trees: u32) -> f32 {
    SPACING * (trees as f32 / core::f32::consts::PI).sqrt()
}

/// Plants so many trees on a spiral of equal areas, with the same places, turns and scales each time.
pub fn plant(lab: &mut Lab, drawn: &Drawn, trees: u32, casts_shadows: bool) -> Vec<Entity> {
    let mut dice = Dice::new(7);
    let group: Vec<Entity> = (0..trees)
        .map(|i| {
            let reach = radius(i);
            let (sin, cos) = (2.399_963 * i as f32).sin_cos();
            let place = Transform::from_xyz(reach * cos, 0.0, reach * sin)
                .with_rotation(Quat::from_rotation_y(dice.angle()))
                .with_scale(Vec3::splat(dice.between(0.75, 1.2)));
            lab.plant(drawn, place)
        })
        .collect();
    if !casts_shadows {
        for tree in &group {
            let mut tree = lab.studio.world().entity_mut(*tree);
            tree.insert_recursive::<Children>(NotShadowCaster);
        }
    }
    group
}

/// Shows one group of trees and hides the others.
pub fn show(world: &mut World, groups: &[Vec<Entity>], shown: Option<usize>) {
    for (i, group) in groups.iter().enumerate() {
        let visibility = if shown == Some(i) {
            Visibility::Inherited
        } else {
            Visibility::Hidden
        };
        for tree in group {
            if let Some(mut is) = world.get_mut::<Visibility>(*tree) {
                is.set_if_neq(visibility);
            }
        }
    }
}

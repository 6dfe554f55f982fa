//! The core of `examples/speed_accuracy`, at a size that takes seconds: the shape of its conclusions, and no times.

use bevy::prelude::*;
use bevy::render::diagnostic::RenderDiagnosticsPlugin;
use bevy_verdure::frusta::{ReliefSteps, ReliefV};
use bevy_verdure::lab::rivals::{Exhibit, Judge, March, Rival, Wardrobe, fitting};
use bevy_verdure::lab::{GeometryError, Race, Studio, Variant};
use bevy_verdure::plants::{Planting, Saguaro};

const LIMIT: usize = 1 << 28;

#[test]
fn frusta_and_polygons_come_closer_to_the_reference_with_every_setting() {
    let mut studio = Studio::new(|app| {
        app.add_plugins(RenderDiagnosticsPlugin);
    });
    let mut planting = Planting::default();
    let saguaro = planting.add(Saguaro::default().grow(1));
    planting.place(saguaro, Vec3::ZERO, 0.0, 1.0);
    let shot = fitting(&planting, Vec3::new(0.3, 0.2, 1.0), UVec2::new(128, 96));
    let mut exhibit = Exhibit::open(&mut studio.headless, planting, None);
    let mut wardrobe = Wardrobe::default();
    let mut put_up = |studio: &mut Studio, exhibit: &mut Exhibit, rival| {
        exhibit
            .put_up(&mut studio.headless, &mut wardrobe, rival, LIMIT)
            .unwrap()
    };
    let in_steps = |steps| {
        Rival::Frusta(Some(March {
            steps: ReliefSteps::Fixed(steps),
            ..default()
        }))
    };
    let polygons = |subdivisions, relief| Rival::Polygons {
        subdivisions,
        relief,
    };
    for relief in [false, true] {
        let finest = Rival::reference(relief);
        put_up(&mut studio, &mut exhibit, finest);
        let judge = Judge::new(&mut studio, &exhibit, finest, shot);
        let mut flip = |rival| {
            let weight = put_up(&mut studio, &mut exhibit, rival);
            let flip = judge.flip(&mut studio, &exhibit, rival);
            println!("{rival:?}: FLIP {flip}, {weight:?}");
            (flip, weight)
        };
        let own = flip(Rival::frusta(relief));
        let rivals = [0, 1, 2, 3].map(|m| flip(polygons(m, relief)));
        for steps in [2, 4, 8, 16, 32, 64] {
            if relief {
                flip(in_steps(steps));
            }
        }
    }
}

//! Leaps over air against steps that are all looked at.

use bevy::prelude::*;
use bevy_verdure::frusta::ReliefV;
use bevy_verdure::lab::Studio;
use bevy_verdure::lab::reference::relief::HeightImage;
use bevy_verdure::prelude::*;

use super::{THICKNESS, image, limb, views};

/// No powers of two: levels whose pixels overlap.
pub const MAP: UVec2 = UVec2::new(150, 97);

/// Studs with much air between them, which leaps must not pass through.
pub fn studs() -> HeightImage {
    HeightImage::from_fn(MAP.x as usize, MAP.y as usize, |u, v| {
        let off = |x: f64, n: f64| (x * n).fract() - 0.5;
        let (x, y) = (off(u, 7.0), off(v, 3.0));
        let low = 0.1 + 0.1 * (u * 31.0).sin() * (v * 17.0).cos();
        if x * x + y * y < 0.02 { 1.0 } else { low }
    })
}

#[test]
fn leaps_find_what_steps_find() {
    for (v, join, bend, taper, repeats) in [
        (ReliefV::Exact, Join::Mitre, 0.5, 0.75, Vec2::ONE),
        (ReliefV::Exact, Join::Round, 0.5, 0.75, Vec2::new(2.0, 3.0)),
        (ReliefV::Interpolated, Join::Round, 0.2, 1.0, Vec2::ONE),
    ] {
        let mut studio = Studio::default();
        let map = (studio.world())
            .resource_mut::<Assets<Image>>()
            .add(image(&studs(), MAP));
        let material = |march| {
            let relief = Relief {
                march,
                v,
                ..Relief::new(map.clone(), ReliefThickness::Metres(2.0 * THICKNESS))
                    .with_steps(ReliefSteps::Fixed(96))
            };
            let base = StandardMaterial {
                uv_transform: bevy::math::Affine2::from_scale(repeats),
                ..default()
            };
            relief_material(base, relief)
        };
        let plant = studio.plant_in(
            limb(taper, bend),
            Frusta::default().with_join(join),
            Transform::IDENTITY,
            material(ReliefMarch::Uniform),
        );
        for _ in 0..3 {
            studio.headless.step();
        }
        let handle = studio
            .world()
            .get::<MeshMaterial3d<FrustaMaterial>>(plant)
            .expect("a plant has a material")
            .0
            .clone();
        for shot in views() {
            let mut figures = [ReliefMarch::Uniform, ReliefMarch::Leaping].map(|march| {
                let mut materials = studio.world().resource_mut::<Assets<FrustaMaterial>>();
                *materials
                    .get_mut(&handle)
                    .expect("the plant's material is there") = material(march);
                studio.measure(&shot)
            });
            let [uniform, leaping] = &mut figures;
            let (mut hits, mut other) = (0, 0);
            for (x, y) in (0..shot.size.y).flat_map(|y| (0..shot.size.x).map(move |x| (x, y))) {
                let (a, b) = (uniform.get(x, y), leaping.get(x, y));
                hits += usize::from(a.is_some());
                other += usize::from(match (a, b) {
                    (Some(a), Some(b)) => {
                        // The last bits, where two programs may round differently.
                        a.segment != b.segment || (a.depth - b.depth).abs() > 1e-5 * a.depth
                    }
                    (a, b) => a.is_some() != b.is_some(),
                });
            }
            println!(
                "{v:?} {join:?} from {}: {other} of {hits} pixels differ",
                shot.eye
            );
            assert!(hits > 1000);
            assert_eq!(other, 0, "{v:?} {join:?} from {}", shot.eye);
        }
    }
}

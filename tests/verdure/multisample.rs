//! Outlines with MSAA: how much of a pixel they cover, and what must not show through them.

use bevy::math::{DMat4, DVec3};
use bevy::prelude::*;
use bevy_verdure::lab::reference::ReferenceScene;
use bevy_verdure::lab::{Lens, NEAR, Pixels, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, TREE, ball, reference};

/// The standard places of four samples, in sixteenths of a pixel from its centre.
const SAMPLES: [(f32, f32); 4] = [(-2.0, -6.0), (6.0, -2.0), (-6.0, 2.0), (2.0, 6.0)];

/// The picture holds 8 bits: half a step is at most 0.005 of linear light.
const STEP: f32 = 0.005;

/// A plant on its own, white and unlit before black, so that the light of a pixel is how much of it is covered.
struct Silhouette {
    shot: Shot,
    scene: ReferenceScene,
    local_from_world: DMat4,
    picture: Pixels,
}

impl Silhouette {
    /// Of a tree, from a direction in which `away` ball radii lie between it and the eye.
    fn of(seed: u64, transform: Transform, away: Vec3, size: UVec2) -> Self {
        let skeleton = TREE.grow(&mut Dice::new(seed));
        let scene = reference(&skeleton);
        let (centre, radius) = ball(&skeleton);
        let at = transform.transform_point(centre);
        let shot = Shot {
            eye: at + away * radius * transform.scale.abs().max_element(),
            at,
            lens: Lens::Perspective(0.8),
            size,
        };
        let mut studio = Studio::default();
        let camera = studio.camera();
        studio.world().entity_mut(camera).insert(Msaa::Sample4);
        let plant = studio.plant(skeleton, Frusta::default(), transform);
        let world = studio.world();
        let white = frusta_material(StandardMaterial {
            base_color: Color::WHITE,
            unlit: true,
            ..default()
        });
        let white = world.resource_mut::<Assets<FrustaMaterial>>().add(white);
        world.entity_mut(plant).insert(MeshMaterial3d(white));
        Self {
            shot,
            scene,
            local_from_world: transform.to_matrix().as_dmat4().inverse(),
            picture: studio.photograph(&shot, Color::BLACK),
        }
    }

    fn is_hit(&self, x: f32, y: f32) -> bool {
        let (origin, direction): (DVec3, DVec3) = self.shot.ray(x, y);
        let origin = self.local_from_world.transform_point3(origin);
        let direction = self.local_from_world.transform_vector3(direction);
        self.scene
            .cast(origin, direction, f64::from(NEAR))
            .is_some()
    }

    /// The share of a pixel's samples that the plant covers in the picture.
    fn coverage(&self, x: u32, y: u32) -> f32 {
        let srgb = f32::from(self.picture.rgb(x, y)[0]) / 255.0;
        Color::srgb(srgb, 0.0, 0.0).to_linear().red
    }

    /// And in the reference.
    fn expected(&self, x: u32, y: u32) -> f32 {
        let middle = (x as f32 + 0.5, y as f32 + 0.5);
        let hits = SAMPLES
            .iter()
            .filter(|(dx, dy)| self.is_hit(middle.0 + dx / 16.0, middle.1 + dy / 16.0));
        hits.count() as f32 / SAMPLES.len() as f32
    }

    fn pixels(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let size = self.shot.size;
        (0..size.y).flat_map(move |y| (0..size.x).map(move |x| (x, y)))
    }

    /// Checks every pixel against its samples in the reference, and gives back how many lie on the outline.
    fn check(&self) -> usize {
        let (mut outline, mut other) = (0, 0);
        for (x, y) in self.pixels() {
            let (seen, expected) = (self.coverage(x, y), self.expected(x, y));
            let off = (seen - expected).abs();
            assert!(off <= 0.25 + STEP, "{x},{y}: {seen} instead of {expected}");
            outline += usize::from(expected > 0.0 && expected < 1.0);
            other += usize::from(off > STEP);
        }
        println!("{outline} pixels on the outline, {other} a sample off");
        // A sample off is one whose place the outline crosses within roundings.
        assert!(other * 100 <= outline, "{other} of {outline}");
        outline
    }
}

#[test]
fn multisampled_edges_have_their_coverage() {
    let size = UVec2::new(256, 192);
    let away = Vec3::new(0.7, 0.3, 2.0);
    let silhouette = Silhouette::of(9, Transform::IDENTITY, away, size);
    assert!(silhouette.check() > 200);
    // And so they are close to what they stand for, the area that is covered.
    let (mut edges, mut error) = (0, 0.0);
    for (x, y) in silhouette.pixels() {
        let grid = (0..64).filter(|i| {
            let (dx, dy) = ((i % 8) as f32, (i / 8) as f32);
            silhouette.is_hit(x as f32 + (dx + 0.5) / 8.0, y as f32 + (dy + 0.5) / 8.0)
        });
        let area = grid.count() as f32 / 64.0;
        if area > 0.0 && area < 1.0 {
            edges += 1;
            error += (silhouette.coverage(x, y) - area).abs();
        }
    }
    assert!(edges > 500);
    let mean = error / edges as f32;
    assert!(mean < 0.125, "on average within half a sample: {mean}");
}

#[test]
fn multisampled_edges_of_stretched_and_mirrored_plants_have_their_coverage() {
    let turned = Quat::from_euler(EulerRot::XYZ, 0.5, 0.9, -0.6);
    for transform in [
        Transform::from_scale(Vec3::new(1.0, 4.0, 1.0)),
        Transform::from_scale(Vec3::new(-1.0, 4.0, 1.0)),
        // Turned, no axis of the world is one along which it is stretched.
        Transform::from_rotation(turned).with_scale(Vec3::new(1.0, 4.0, -1.0)),
        Transform::from_rotation(turned).with_scale(Vec3::new(0.25, 4.0, 4.0)),
    ] {
        let away = Vec3::new(0.5, 0.2, 1.2);
        let silhouette = Silhouette::of(9, transform, away, UVec2::new(192, 144));
        assert!(silhouette.check() > 200, "{transform:?}");
    }
}

#[test]
fn no_far_wall_shows_through_the_cuts_of_multisampled_frusta() {
    // Many cuts across a limb lit from the eye: only the inside of its far wall is dark.
    let mut limb = Skeleton::builder();
    let mut last = limb.root(Vec3::new(0.0, -1.0, 0.0), 0.12);
    for i in 1..=60 {
        let h = i as f32 / 30.0 - 1.0;
        last = limb.joint(last, Vec3::new(0.15 * (h * 9.0).sin(), h, 0.0), 0.12);
    }
    let mut studio = Studio::default();
    let shot = Shot {
        eye: Vec3::new(0.3, 0.7, 3.0),
        at: Vec3::ZERO,
        lens: Lens::Perspective(0.8),
        size: UVec2::new(256, 192),
    };
    studio.world().spawn((
        DirectionalLight {
            illuminance: 8_000.0,
            ..default()
        },
        shot.transform(),
    ));
    let skeleton = limb.build().unwrap();
    studio.plant(skeleton, Frusta::default(), Transform::IDENTITY);
    let figures = studio.measure(&shot);
    let camera = studio.camera();
    let plain = studio.photograph(&shot, Color::BLACK);
    studio.world().entity_mut(camera).insert(Msaa::Sample4);
    let smooth = studio.photograph(&shot, Color::BLACK);
    let forward = *shot.transform().forward();
    let mut inside = 0;
    for y in 1..shot.size.y - 1 {
        for x in 1..shot.size.x - 1 {
            // Faces the eye, and so do its neighbours.
            let faces = (0..9).all(|i| {
                let seen = figures.get(x + i % 3 - 1, y + i / 3 - 1);
                seen.is_some_and(|seen| seen.normal.dot(forward) < -0.6)
            });
            if faces {
                inside += 1;
                // Across a cut samples are shaded apart, but all from the front. One of four that shows the far wall
                // takes a quarter of the light off, and so an eighth of what its encoding in 8 bits holds.
                let (plain, smooth) = (plain.rgb(x, y)[1], smooth.rgb(x, y)[1]);
                assert!(
                    plain.abs_diff(smooth) <= plain / 16,
                    "{x},{y}: {smooth} instead of {plain}"
                );
            }
        }
    }
    assert!(inside > 1000, "{inside}");
}

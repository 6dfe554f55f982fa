//! Views out of the ordinary, each pixel against the reference: jittered, oblique, cut off, at a lower resolution.
//!
//! A wall through the plant tells whether what the plant writes into the depth buffer is what a mesh there would.

use bevy::camera::{MainPassResolutionOverride, ScalingMode};
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::camera::ExtractedCamera;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, Growth, TREE, ball, reference};
use crate::view::{Scenery, Sight, View, put_up_wall, sight};

const SIZE: UVec2 = UVec2::new(192, 144);

/// A tree with a wall through its middle, and the ball round it.
struct Stage {
    studio: Studio,
    scenery: Scenery,
    centre: Vec3,
    radius: f32,
}

fn stage() -> Stage {
    // Stout, so that both it and the wall are seen by many pixels.
    let growth = Growth {
        aspect: (0.3, 0.8),
        ..TREE
    };
    let skeleton = growth.grow(&mut Dice::new(14));
    let (centre, radius) = ball(&skeleton);
    let mut studio = Studio::default();
    let wall = put_up_wall(&mut studio, centre, Vec3::new(0.5, 0.2, 0.8).normalize());
    let scenery = Scenery {
        plant: reference(&skeleton),
        wall: Some(wall),
    };
    studio.plant(skeleton, Frusta::default(), Transform::IDENTITY);
    Stage {
        studio,
        scenery,
        centre,
        radius,
    }
}

impl Stage {
    /// Looks at the tree's middle from a distance of so many radii.
    fn view(&self, away: f32, projection: Projection) -> View {
        let direction = Vec3::new(0.4, 0.3, 1.0).normalize();
        let eye = self.centre + direction * (away * self.radius);
        View {
            eye: Transform::from_translation(eye).looking_at(self.centre, Vec3::Y),
            projection,
            jitter: None,
            size: SIZE,
        }
    }

    fn check(&mut self, view: &View) {
        let picture = view.look(&mut self.studio);
        let (plant, wall) = view.check(&picture, &self.scenery);
        assert!(plant > 1000 && wall > 1000, "both are in the picture");
    }

    fn orthographic(&self) -> OrthographicProjection {
        OrthographicProjection {
            near: 0.1,
            far: 100.0,
            scaling_mode: ScalingMode::FixedVertical {
                viewport_height: 2.4 * self.radius,
            },
            ..OrthographicProjection::default_3d()
        }
    }
}

#[test]
fn a_jittered_view_is_jittered() {
    let mut stage = stage();
    for projection in [
        Projection::Orthographic(stage.orthographic()),
        Projection::Perspective(PerspectiveProjection::default()),
    ] {
        let jitter = Some(Vec2::new(0.4, -0.3));
        let view = View {
            jitter,
            ..stage.view(3.0, projection)
        };
        stage.check(&view);
    }
}

#[test]
fn an_orthographic_view_may_have_its_origin_anywhere() {
    let mut stage = stage();
    let projection = OrthographicProjection {
        viewport_origin: Vec2::new(0.35, 0.6),
        ..stage.orthographic()
    };
    let view = stage.view(3.0, Projection::Orthographic(projection));
    stage.check(&view);
}

#[test]
fn an_oblique_near_plane_cuts_as_it_leans() {
    let mut stage = stage();
    for normal in [
        Vec3::new(0.5, 0.3, -0.8),
        Vec3::new(-0.7, 0.1, -0.5),
        Vec3::new(0.1, -0.9, -0.3),
    ] {
        let mut view = stage.view(2.5, Projection::default());
        let normal = normal.normalize();
        // In view space, a little before the tree's middle.
        let through = Vec3::NEG_Z * (2.4 * stage.radius);
        view.projection = Projection::Perspective(PerspectiveProjection {
            near_clip_plane: normal.extend(-normal.dot(through)),
            ..default()
        });
        stage.check(&view);
    }
}

#[test]
fn the_far_plane_cuts_off_what_lies_beyond() {
    let mut stage = stage();
    // Between the tree's front and its middle.
    let near = OrthographicProjection {
        far: 2.9 * stage.radius,
        ..stage.orthographic()
    };
    let view = stage.view(3.0, Projection::Orthographic(near));
    stage.check(&view);
}

#[test]
fn a_lower_resolution_of_the_main_pass_draws_the_same_view() {
    let mut stage = stage();
    // The picture's corner is drawn; Bevy's upscalers would stretch it over the rest.
    let size = UVec2::new(128, 96);
    let view = View {
        size,
        ..stage.view(3.0, Projection::default())
    };
    let target = view.aim(&mut stage.studio, SIZE);
    let render = stage
        .studio
        .headless
        .app()
        .sub_app_mut(RenderApp)
        .world_mut();
    let camera = render
        .query_filtered::<Entity, With<ExtractedCamera>>()
        .single(render)
        .unwrap();
    render
        .entity_mut(camera)
        .insert(MainPassResolutionOverride(size));
    let picture = stage.studio.headless.capture(&target);
    let (plant, wall) = view.check(&picture, &stage.scenery);
    assert!(plant > 500 && wall > 500, "both are in the picture");
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            if x >= size.x || y >= size.y {
                assert_eq!(sight(&picture, x, y), Sight::Nothing, "{x},{y}");
            }
        }
    }
}

#[test]
fn a_limb_that_reaches_behind_the_eye_is_whole_beyond_an_oblique_near_plane() {
    let mut studio = Studio::default();
    let joints = vec![
        Joint::root(Vec3::new(0.5, 0.0, 10.0), 0.3),
        Joint::new(Vec3::new(0.5, 0.0, -10.0), 0.3, 0),
    ];
    let limb = Skeleton::new(joints).unwrap();
    let scenery = Scenery {
        plant: reference(&limb),
        wall: None,
    };
    studio.plant(limb, Frusta::default(), Transform::IDENTITY);
    let normal = Vec3::new(0.6, 0.0, -0.8);
    let view = View {
        eye: Transform::IDENTITY,
        projection: Projection::Perspective(PerspectiveProjection {
            fov: core::f32::consts::FRAC_PI_2,
            near_clip_plane: normal.extend(-1.0),
            ..default()
        }),
        jitter: None,
        size: SIZE,
    };
    let picture = view.look(&mut studio);
    let (plant, _) = view.check(&picture, &scenery);
    assert!(plant > 1000);
}

#[test]
fn an_eye_within_the_bounds_sees_the_surface_round_it_mirrored_or_not() {
    // Inside a limb, which is its own mirror image.
    let joints = vec![
        Joint::root(Vec3::NEG_Y * 2.0, 0.6),
        Joint::new(Vec3::Y * 2.0, 0.4, 0),
    ];
    let limb = Skeleton::new(joints).unwrap();
    let view = View {
        eye: Transform::from_xyz(0.1, 0.2, 0.1).looking_to(Vec3::new(0.3, 0.4, -1.0), Vec3::Y),
        projection: Projection::default(),
        jitter: None,
        size: SIZE,
    };
    for scale in [Vec3::ONE, Vec3::new(-1.0, 1.0, 1.0)] {
        let mut studio = Studio::default();
        let scenery = Scenery {
            plant: reference(&limb),
            wall: None,
        };
        studio.plant(
            limb.clone(),
            Frusta::default(),
            Transform::from_scale(scale),
        );
        let picture = view.look(&mut studio);
        let (plant, _) = view.check(&picture, &scenery);
        assert_eq!(plant, (SIZE.x * SIZE.y) as usize);
    }
}

//! Where crowns are seen from, as the shaders take it (`shaders/place.wgsl`).

use bevy::math::{Affine3A, Mat4};
use bevy::prelude::*;

use super::blend::FOCAL;
use super::slicing::SlicingShape;

/// What a crown is seen from.
pub(crate) struct Eye {
    /// Where it is.
    pub at: Vec3,
    /// What Bevy sorts by: how much nearer to the view's plane a step is, along each axis of the world.
    pub back: Vec3,
    pub is_orthographic: bool,
    /// Pixels of the view for a metre: one metre away, or anywhere in an orthographic view.
    pixels_per_metre: f32,
}

/// How an eye sees a crown.
pub(crate) struct Seen {
    /// From the centroid to the eye, or against the rays of an orthographic view; local, unit.
    pub direction: Vec3,
    /// How many radii away a crown would be as small as it is here, on the screen that levels of detail are made for.
    pub distance: f32,
}

impl Eye {
    /// One of a view so many pixels high.
    pub(crate) fn new(place: Affine3A, clip_from_view: &Mat4, height: u32) -> Self {
        Self {
            at: place.translation.into(),
            back: place.matrix3.inverse().transpose().z_axis.into(),
            is_orthographic: clip_from_view.w_axis.w == 1.0,
            pixels_per_metre: 0.5 * height as f32 * clip_from_view.y_axis.y.abs(),
        }
    }

    pub(crate) fn of_camera((camera, place): (&Camera, &GlobalTransform)) -> Self {
        let height = camera.physical_viewport_size().map_or(0, |size| size.y);
        Self::new(place.affine(), &camera.clip_from_view(), height)
    }

    /// How it sees a crown that is placed so.
    pub(crate) fn sees(&self, shape: &SlicingShape, world_from_local: &Affine3A) -> Seen {
        let local_from_world = world_from_local.inverse();
        if self.is_orthographic {
            let back = local_from_world.transform_vector3(self.back);
            let metre = world_from_local.matrix3.y_axis.length();
            return Seen {
                direction: back.normalize_or(Vec3::Z),
                distance: FOCAL / (shape.radius * metre * self.pixels_per_metre),
            };
        }
        let eye = local_from_world.transform_point3(self.at) - shape.centroid;
        Seen {
            direction: eye.normalize_or(Vec3::Z),
            distance: eye.length() / shape.radius * FOCAL / self.pixels_per_metre,
        }
    }
}

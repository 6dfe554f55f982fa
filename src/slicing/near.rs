//! Which crowns are so near to an eye that their discrepancy angle is taken part by part (`blend/parts.rs`).
//!
//! It takes a pipeline of its own, so that crowns further away pay nothing for it; where one takes over from the other, both
//! draw the same.

use bevy::camera::Projection;
use bevy::prelude::*;

use super::blend::{PARTS, SliceOrder};
use super::component::{CrownSettings, DiscrepancyAngle, SlicedCrown};
use super::library::CrownLibrary;
use super::material::SlicedCrownMaterial;

/// Whether a crown is near to any eye.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Nearness(bool);

/// What tells how a crown is drawn, and what it is drawn with.
type Crown<'a> = (
    &'a SlicedCrown,
    &'a CrownSettings,
    &'a GlobalTransform,
    &'a mut Nearness,
    &'a mut Mesh3d,
    &'a mut MeshMaterial3d<SlicedCrownMaterial>,
);

/// Gives crowns that have come near to an eye, or have left all, what they are drawn with there.
pub(crate) fn part_by_part(
    library: Res<CrownLibrary>,
    cameras: Query<(&Camera, &Projection, &GlobalTransform), With<Camera3d>>,
    mut crowns: Query<Crown>,
) {
    let eyes: Vec<Vec3> = cameras
        .iter()
        .filter(|(camera, projection, _)| {
            camera.is_active && !matches!(projection, Projection::Orthographic(_))
        })
        .map(|(_, _, at)| at.translation())
        .collect();
    for (crown, settings, at, mut nearness, mut mesh, mut material) in &mut crowns {
        let Some(shared) = library.shared.get(&crown.0.id()) else {
            continue;
        };
        let (centroid, radius) = shared.ball;
        let affine = at.affine();
        let centroid = affine.transform_point3(centroid);
        let m = affine.matrix3;
        let longest = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length());
        let reach = PARTS[1] * radius * longest.into_iter().fold(0.0, f32::max);
        let is_near = shared.has_parts
            && settings.discrepancy == DiscrepancyAngle::PerPart
            && settings.order == SliceOrder::Steady
            && eyes.iter().any(|eye| eye.distance(centroid) < reach);
        if nearness.0 != is_near
            && let Some(look) = library.look(crown.0.id(), settings, is_near)
        {
            nearness.0 = is_near;
            (*mesh, *material) = look;
        }
    }
}

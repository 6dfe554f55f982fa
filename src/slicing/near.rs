//! How crowns are drawn that are near to an eye: with a discrepancy angle taken part by part (`blend/parts.rs`), and in
//! bands (`bands.rs`) if they may intersect others.
//!
//! It takes pipelines and meshes of their own, so that crowns further away pay nothing for it; where one takes over from the
//! other, both draw the same.

use bevy::prelude::*;

use super::blend::{PARTS, Ranks, SliceOrder};
use super::component::{
    Composition, CrownSettings, DiscrepancyAngle, IntersectingCrown, SlicedCrown,
};
use super::eye::Eye;
use super::library::CrownLibrary;
use super::material::SlicedCrownMaterial;

/// How a crown is drawn.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct DrawnAs {
    /// Whether the discrepancy angle is taken part by part.
    pub is_near: bool,
    /// How many ranks of slices are drawn at most, if they are drawn in bands; else 0.
    pub ranks: u32,
}

impl DrawnAs {
    pub(crate) fn is_in_bands(self) -> bool {
        self.ranks > 0
    }
}

/// What tells how a crown is drawn, and what it is drawn with.
type Crown<'a> = (
    &'a SlicedCrown,
    &'a CrownSettings,
    &'a GlobalTransform,
    Has<IntersectingCrown>,
    &'a mut DrawnAs,
    &'a mut Mesh3d,
    &'a mut MeshMaterial3d<SlicedCrownMaterial>,
);

/// Gives crowns that have come near to an eye, or have left all, what they are drawn with there.
pub(crate) fn draw_near(
    mut library: ResMut<CrownLibrary>,
    mut meshes: ResMut<Assets<Mesh>>,
    cameras: Query<(&Camera, &GlobalTransform), With<Camera3d>>,
    mut crowns: Query<Crown>,
) {
    let active = cameras.iter().filter(|(camera, _)| camera.is_active);
    let eyes: Vec<Eye> = active.map(Eye::of_camera).collect();
    for (crown, settings, at, intersects, mut drawn_as, mut mesh, mut material) in &mut crowns {
        let id = crown.0.id();
        let Some(shared) = library.shared.get(&id) else {
            continue;
        };
        let shape = &shared.shape;
        let affine = at.affine();
        let centroid = affine.transform_point3(shape.centroid);
        let m = affine.matrix3;
        let longest = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.length());
        let radius = shape.radius * longest.into_iter().fold(0.0, f32::max);
        let reach = PARTS[1] * radius;
        let sees_parts = |eye: &Eye| !eye.is_orthographic && eye.at.distance(centroid) < reach;
        // A single one is whole.
        let ranks = if intersects && settings.composition == Composition::Blended {
            let shown = |eye: &Eye| {
                let distance = eye.sees(shape, &affine).distance;
                Ranks::new(shape, distance, settings.order).count()
            };
            let ranks = eyes.iter().map(shown);
            ranks.max().filter(|ranks| *ranks > 1).unwrap_or(0)
        } else {
            0
        };
        let now = DrawnAs {
            is_near: shared.has_parts
                && settings.discrepancy == DiscrepancyAngle::PerPart
                && settings.order == SliceOrder::Steady
                && eyes.iter().any(sees_parts),
            ranks,
        };
        if *drawn_as != now
            && let Some(look) = library.look(id, settings, now, &mut meshes)
        {
            *drawn_as = now;
            (*mesh, *material) = look;
        }
    }
}

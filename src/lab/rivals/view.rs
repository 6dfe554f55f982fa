//! An eye that a planting fills the picture of.

use bevy::prelude::*;

use crate::lab::studio::{Lens, Shot};
use crate::plants::Planting;

/// Share of the picture's width or height that is left empty on either side.
const MARGIN: f32 = 0.03;
/// Vertical field of view, in radians.
const FOV: f32 = 0.7;

/// The shot from a direction that all of a planting fits into, as near as that allows.
pub fn fitting(planting: &Planting, direction: Vec3, size: UVec2) -> Shot {
    let back = direction.normalize_or(Vec3::Z);
    let right = Vec3::Y.cross(back).normalize_or(Vec3::X);
    let up = back.cross(right);
    let balls: Vec<(Vec3, f32)> = balls(planting).collect();
    let tan = Vec2::new(
        (0.5 * FOV).tan() * size.x as f32 / size.y as f32,
        (0.5 * FOV).tan(),
    ) * (1.0 - 2.0 * MARGIN);
    // On each axis a ball touches the side of the picture where x/(d − z) = ±tan. Lines of that slope through all balls
    // enclose a wedge; its apex is the eye.
    let wedge = |across: Vec3, tan: f32| {
        let secant = tan.hypot(1.0);
        let (mut high, mut low) = (f32::NEG_INFINITY, f32::NEG_INFINITY);
        for (centre, radius) in &balls {
            let (x, z) = (centre.dot(across), centre.dot(back));
            high = high.max(x + tan * z + radius * secant);
            low = low.max(-x + tan * z + radius * secant);
        }
        ((high - low) * 0.5, (high + low) * 0.5 / tan)
    };
    let (x, across) = wedge(right, tan.x);
    let (y, along) = wedge(up, tan.y);
    let eye = right * x + up * y + back * across.max(along);
    let eye = if eye.is_finite() { eye } else { Vec3::Z };
    Shot {
        eye,
        at: eye - back,
        lens: Lens::Perspective(FOV),
        size,
    }
}

/// Joints and their radii, in world space.
fn balls(planting: &Planting) -> impl Iterator<Item = (Vec3, f32)> {
    planting.places.iter().flat_map(|place| {
        let turn = Quat::from_rotation_y(place.yaw);
        let parts = planting.plants.get(place.plant).map(|plant| &plant.parts);
        let skeletons = parts.into_iter().flatten().map(|part| &part.skeleton);
        let joints = skeletons.flat_map(|skeleton| skeleton.joints());
        joints.map(move |joint| {
            let centre = place.position + turn * (joint.position * place.scale);
            (centre, joint.radius * place.scale)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::Desert;

    #[test]
    fn every_joint_is_in_the_picture_and_some_are_near_its_edge() {
        let planting = Desert::default().grow(1);
        for direction in [Vec3::Z, Vec3::new(0.4, 0.3, 1.0), Vec3::new(-1.0, 0.9, 0.2)] {
            let shot = fitting(&planting, direction, UVec2::new(320, 240));
            let mut projection = shot.projection();
            projection.update(320.0, 240.0);
            let clip = projection.get_clip_from_view() * shot.transform().to_matrix().inverse();
            let furthest = balls(&planting)
                .map(|(centre, _)| clip.project_point3(centre).truncate().abs().max_element())
                .fold(0.0, f32::max);
            // The ball round the outermost joint touches the margin: the joint itself is within a tenth of it.
            assert!((0.8..0.95).contains(&furthest), "{furthest}");
        }
    }
}

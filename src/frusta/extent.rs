//! The box round a whole plant, for culling.

use bevy::camera::primitives::Aabb;
use bevy::math::Vec3;

use super::single::cone::{End, EndKind, Frustum};
use super::single::mitre::{CuttingPlane, Extent, cut_extent};

/// The axis-aligned box, in local space, round all that some frusta draw. Each segment lies in the hull of a ball
/// round each of its ends: the joint's sphere, or as far as the cut's ellipse reaches.
pub(crate) fn aabb(frusta: impl Iterator<Item = Frustum>) -> Aabb {
    let mut low = Vec3::INFINITY;
    let mut high = Vec3::NEG_INFINITY;
    let mut include = |centre: Vec3, radius: f32| {
        low = low.min(centre - radius);
        high = high.max(centre + radius);
    };
    let mut first = Vec3::ZERO;
    for (i, frustum) in frusta.enumerate() {
        if i == 0 {
            first = frustum.base;
        }
        if frustum.has_cone() {
            let at_end = frustum.radius + frustum.slope * frustum.length;
            include(
                frustum.base,
                reach(&frustum, &frustum.start, frustum.radius),
            );
            include(frustum.tip(), reach(&frustum, &frustum.end, at_end));
        } else if frustum.end.kind == EndKind::Round {
            include(frustum.tip(), frustum.end.radius);
        } else if frustum.start.kind == EndKind::Round {
            include(frustum.base, frustum.start.radius);
        }
    }
    if low.x > high.x {
        // Nothing to draw: a point, where the first joint is.
        return Aabb::from_min_max(first, first);
    }
    Aabb::from_min_max(low, high)
}

/// Greatest distance from the joint of the frustum's end.
fn reach(frustum: &Frustum, end: &End, at_joint: f32) -> f32 {
    let plane = CuttingPlane {
        normal: end.normal,
        offset: end.offset,
    };
    let cut = cut_extent(
        &plane,
        frustum.axis,
        at_joint,
        frustum.slope,
        frustum.secant,
    );
    let Extent { low, high } = cut.unwrap_or(Extent {
        low: -at_joint,
        high: at_joint,
    });
    let distance = |y: f32| y.hypot(at_joint + frustum.slope * y);
    let edge = distance(low).max(distance(high));
    match end.kind {
        EndKind::Round => end.radius.max(edge),
        EndKind::Cut | EndKind::Flat => edge,
    }
}

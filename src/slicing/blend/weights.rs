//! How much each slicing counts for an eye: the discrepancy angle (§2.3), and what several slicings cover together.

use bevy::math::{Vec2, Vec3};

use super::{SliceOrder, smooth};
use crate::slicing::slicing::SlicingShape;

/// Slicings that blend at once.
pub const SLOTS: usize = 3;

/// Sines of the eye's elevation from where to where the vertical slicing takes over: 30° to 60°.
pub(super) const RISE: [f32; 2] = [0.5, 0.866];

/// A slicing that is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slot {
    /// Which orientation.
    pub orientation: u32,
    /// α, before the correction f_c; 0 where nothing is drawn.
    pub weight: f32,
}

/// The share of the way from a slicing's direction to the swap on which it is drawn alone, in the steady order: on half of
/// an orbit, crowns have half the slices. In the paper's order the secondary slicing is there from the start.
pub const ALONE: f32 = 0.5;

/// Primary opacity α_p: 1 for an eye in line with the `primary` orientation and on the share `alone` of the way from there
/// to the swap, which is half-way to the `secondary` one; from there to 0.5 at the swap linear in the angle, the direction
/// to the eye being projected to the plane of both. `alone` is 0 in the paper, and less than 1.
pub fn primary_opacity(primary: Vec3, secondary: Vec3, eye: Vec3, alone: f32) -> f32 {
    let cosine = primary.dot(secondary).clamp(-1.0, 1.0);
    let across = secondary - primary * cosine;
    let width = across.length();
    if width < 1e-4 {
        return 1.0;
    }
    let discrepancy = (eye.dot(across) / width).atan2(eye.dot(primary));
    let half = 0.5 * cosine.acos();
    1.0 - 0.5 * ((discrepancy / half - alone) / (1.0 - alone)).clamp(0.0, 1.0)
}

/// The four orientations of least discrepancy angle for an eye in direction `eye` (unit), the nearest first, and the cosines
/// of these angles. Of fewer, the first is named again, with a cosine of −2.
pub fn nearest(shape: &SlicingShape, eye: Vec3) -> ([u32; 4], [f32; 4]) {
    let (mut nearest, mut cosines) = ([0; 4], [-2.0; 4]);
    for (i, o) in shape.orientations[..shape.upright_count()]
        .iter()
        .enumerate()
    {
        let cosine = o.direction.dot(eye);
        if let Some(k) = cosines.iter().position(|other| cosine > *other) {
            nearest[k..].rotate_right(1);
            cosines[k..].rotate_right(1);
            (nearest[k], cosines[k]) = (i as u32, cosine);
        }
    }
    (nearest, cosines)
}

/// The slicings for an eye in direction `eye` (unit) from the centroid, in the order in which the slices of a rank are
/// drawn. Weights add up to 1.
pub fn slots(shape: &SlicingShape, eye: Vec3, order: SliceOrder) -> [Slot; SLOTS] {
    let vertical = shape.vertical && order == SliceOrder::Steady;
    let alone = match order {
        SliceOrder::Steady => ALONE,
        SliceOrder::Paper => 0.0,
    };
    let (nearest, cosines) = nearest(shape, eye);
    let mut slots = [Slot::default(); SLOTS];
    for (slot, orientation) in slots.iter_mut().zip(nearest) {
        slot.orientation = orientation;
    }
    if shape.sphere {
        // Three slicings, each fading out where a fourth comes as near: A weight falls to 0 before its slicing is left.
        let angles = cosines.map(|cosine| cosine.clamp(-1.0, 1.0).acos());
        let gains = [0, 1, 2].map(|k| (angles[3] - angles[k]).max(1e-6));
        let sum: f32 = gains.iter().sum();
        for (slot, gain) in slots.iter_mut().zip(gains) {
            slot.weight = gain / sum;
        }
    } else {
        let direction = |k: usize| shape.orientations[nearest[k] as usize].direction;
        let primary = match shape.upright_count() {
            1 => 1.0,
            _ => primary_opacity(direction(0), direction(1), eye, alone),
        };
        let rise = if vertical {
            smooth(RISE[0], RISE[1], eye.y.abs())
        } else {
            0.0
        };
        slots[0].weight = primary * (1.0 - rise);
        slots[1].weight = (1.0 - primary) * (1.0 - rise);
        slots[2] = Slot {
            orientation: shape.orientations.len() as u32 - 1,
            weight: rise,
        };
    }
    match order {
        // Secondary, primary.
        SliceOrder::Paper => slots.swap(0, 1),
        SliceOrder::Steady => {
            // Three compares sort three.
            for (a, b) in [(0, 1), (1, 2), (0, 1)] {
                if slots[a].orientation > slots[b].orientation {
                    slots.swap(a, b);
                }
            }
        }
    }
    slots
}

/// The corrected opacity of a slicing of weight α: f_c α, where f_c = 1 + m_s (1 − α_p), α_p being the greatest weight.
pub fn corrected(weight: f32, greatest: f32, correction: f32) -> f32 {
    (weight * (1.0 + correction * (1.0 - greatest))).min(1.0)
}

/// The weight of a slicing whose slices look `towards` a direction, for an eye in `direction` (both unit). From above and
/// below, light meets on its way through a crown as many leaves as ever, but of upright slices as many fewer as the cosine
/// of the elevation says. So each counts for that many more (Beer and Lambert), up to twice; further up the vertical slicing
/// is alone.
pub fn slanted(shape: &SlicingShape, weight: f32, towards: Vec3, direction: Vec3) -> f32 {
    if !shape.is_upright(towards) {
        return weight;
    }
    weight / Vec2::new(direction.x, direction.z).length().max(0.5)
}

/// The greatest opacity of a place, in a picture in which it is 1: of more, a slicing that fades in would be there at once.
pub const SUREST: f32 = 0.96;

/// The opacity of a place of opacity `alpha` in one of several slicings that blend, whose weight α is `weight`:
/// 1 − (1 − alpha)^α, so that slicings whose weights add up to 1 cover together what one of them covers alone, where
/// α alpha would let more and more through. The correction f_c makes up for that on the average of a crown, this for
/// each place. With [`SUREST`] for 1, a slicing never gains more than 3.3 times as fast as its weight.
pub fn covered(alpha: f32, weight: f32) -> f32 {
    1.0 - (1.0 - SUREST * alpha).powf(weight)
}

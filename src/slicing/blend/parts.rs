//! Up close, the discrepancy angle is taken part by part (§4): along each ray from the eye, the slicings count as they do
//! for an eye that is far away on that ray. `shaders/parts.wgsl` has the same functions by the same names.

use bevy::math::{Vec2, Vec3};

use super::weights::RISE;
use super::{SLOTS, SliceOrder, Slot, nearest, slots, smooth};
use crate::slicing::slicing::SlicingShape;

/// Slicings that are drawn at once where the discrepancy angle is taken part by part.
pub const PART_SLOTS: usize = SLOTS + 1;

/// Distances in radii from where to where the discrepancy angle goes over from that of each part to that of the whole crown.
/// Three radii away a ball that fills its slicing box is seen under 20° to either side of its middle, most crowns under half
/// of it.
pub const PARTS: [f32; 2] = [2.0, 3.0];

/// The greatest angle, in radians, by which a part's direction may differ from the whole crown's: 30°. So a slicing that is
/// drawn has its front to the eye, and the vertical one that which it shows to the middle of the crown.
const WIDEST: f32 = core::f32::consts::FRAC_PI_6;

/// The greatest angle, in radians, by which a part's direction may differ from the whole crown's, for some orientations: a
/// slicing that is not among the three nearest to the eye counts for no part of it. 0 over the sphere, where the angle stays
/// the whole crown's.
pub fn widest(shape: &SlicingShape) -> f32 {
    let count = shape.upright_count();
    if shape.sphere {
        return 0.0;
    }
    let mut widest = WIDEST;
    for (i, a) in shape.orientations[..count].iter().enumerate() {
        for b in &shape.orientations[..i] {
            // The fourth slicing is 1½ of their distances away at least, and counts from ¾ on.
            widest = widest.min(0.75 * a.direction.angle_between(b.direction));
        }
    }
    widest
}

/// Cosine and sine of the angle by which directions to the eye may differ from that from the centroid, for an eye so many
/// radii away: all that a crown is seen under from near by, and none from far. `level` is the cosine of the eye's elevation:
/// as it rises, a cone round its direction turns by more and more of azimuth, and is kept to what orientations round the
/// circle allow for.
pub fn deviation(distance: f32, widest: f32, level: f32) -> Vec2 {
    let seen = (1.0 / distance.max(1.0)).asin();
    let angle =
        seen.min((widest.sin() * level).asin()) * (1.0 - smooth(PARTS[0], PARTS[1], distance));
    Vec2::new(angle.cos(), angle.sin())
}

/// The direction to the eye that counts for what is seen along `ray` (unit, towards the eye), for an eye in a `direction`
/// (unit) from the centroid, and a [`deviation`].
pub fn part_direction(direction: Vec3, ray: Vec3, deviation: Vec2) -> Vec3 {
    let cosine = direction.dot(ray);
    if cosine >= deviation.x {
        return ray;
    }
    let across = ray - direction * cosine;
    direction * deviation.x + across * (deviation.y / across.length().max(1e-6))
}

/// The weight of an orientation for an eye in a `direction` (unit); those of all add up to 1.
pub fn part_weight(shape: &SlicingShape, orientation: u32, direction: Vec3) -> f32 {
    let slots = slots(shape, direction, SliceOrder::Steady);
    let own = slots.iter().filter(|slot| slot.orientation == orientation);
    own.map(|slot| slot.weight).sum()
}

/// Cosine of the angle between two orientations beyond which neither is beside the other.
const OPPOSITE: f32 = -0.9999;

/// Where a direction (unit) to the eye is among the orientations, for one of them: the discrepancy angle over half of the
/// angle to the next orientation on that side, and the share that the vertical slicing takes of it, or leaves it. Over a
/// slice these go nearly evenly, so that they are worked out at its corners; [`turned_weight`] makes [`part_weight`] of them
/// at each place.
pub fn part_turn(shape: &SlicingShape, orientation: u32, direction: Vec3) -> Vec2 {
    let rise = if shape.vertical {
        smooth(RISE[0], RISE[1], direction.y.abs())
    } else {
        0.0
    };
    let towards = shape.orientations[orientation as usize].direction;
    if towards.y.abs() > 0.999 {
        return Vec2::new(0.0, 1.0 - rise);
    }
    let count = shape.upright_count();
    let right = Vec3::new(towards.z, 0.0, -towards.x);
    let discrepancy = direction.dot(right).atan2(direction.dot(towards));
    let (mut next, mut greatest) = (0.0_f32, -2.0_f32);
    for other in &shape.orientations[..count] {
        greatest = greatest.max(other.direction.dot(direction));
        let cosine = other.direction.dot(towards);
        let angle = other.direction.dot(right).atan2(cosine);
        let is_on_that_side = angle * discrepancy > 0.0 && cosine > OPPOSITE;
        if is_on_that_side && (next == 0.0 || angle.abs() < next) {
            next = angle.abs();
        }
    }
    if next == 0.0 {
        // The last of an arc, or alone.
        let is_nearest = direction.dot(towards) >= greatest;
        return Vec2::new(if is_nearest { 0.0 } else { 2.0 }, rise);
    }
    Vec2::new(discrepancy / (0.5 * next), rise)
}

/// The weight that a [`part_turn`] tells of: from the swap, where half is left, as far to either side as to where a slicing
/// is alone.
pub fn turned_weight(turn: Vec2) -> f32 {
    (1.5 - turn.x.abs()).clamp(0.0, 1.0) * (1.0 - turn.y)
}

/// Whether an orientation counts for any part.
fn counts(shape: &SlicingShape, orientation: u32, direction: Vec3, deviation: Vec2) -> bool {
    let towards = shape.orientations[orientation as usize].direction;
    if towards.y.abs() > 0.999 {
        // The vertical one shows either side.
        let side = if direction.y < 0.0 { -towards } else { towards };
        let part = part_direction(direction, side, deviation);
        return part_weight(shape, orientation, part) > 0.0;
    }
    let level = Vec3::new(direction.x, 0.0, direction.z);
    let cosine = level.length().max(1e-6);
    let lowest = part_direction(direction, level / cosine, deviation);
    if shape.vertical && lowest.y.abs() >= RISE[1] {
        return false;
    }
    // The sine of the widest turn of azimuth in a cone round the direction.
    let sine = deviation.y / cosine;
    if sine >= 1.0 || towards.y.abs() > 0.01 || towards.dot(level) < 0.0 {
        return true;
    }
    let turn = Vec2::new((1.0 - sine * sine).sqrt(), sine);
    let turned = part_direction(level / cosine, towards, turn);
    part_weight(shape, orientation, turned) > 0.0
}

/// The slicings that are drawn for an eye in a `direction` (unit) from the centroid, in the order of their orientations: of
/// weight 1 those that count for any part, whose own weight [`part_weight`] tells, of weight 0 others.
pub fn part_slots(shape: &SlicingShape, direction: Vec3, deviation: Vec2) -> [Slot; PART_SLOTS] {
    let ([mut sorted @ .., _], _) = nearest(shape, direction);
    sorted.sort_unstable();
    let [a, b, c] = sorted;
    let last = shape.orientations.len() as u32 - 1;
    let mut before = u32::MAX;
    [a, b, c, last].map(|orientation| {
        // Of few orientations some are named twice.
        let is_new = orientation != before;
        before = orientation;
        Slot {
            orientation,
            weight: if is_new && counts(shape, orientation, direction, deviation) {
                1.0
            } else {
                0.0
            },
        }
    })
}

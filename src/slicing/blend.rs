//! View blending (§2.3): which slicings are drawn for an eye, how opaque, and in what order.
//!
//! `shaders/blend.wgsl` has the same functions by the same names.

use bevy::math::{FloatExt, Vec3};

use super::slicing::SlicingShape;

/// Slicings that blend at once.
pub const SLOTS: usize = 3;

/// Sines of the eye's elevation from where to where the vertical slicing takes over: 30° to 60°.
const RISE: [f32; 2] = [0.5, 0.866];
/// The share of a switch's distance by which levels of detail fade into one another before and after it.
const FADE: f32 = 0.1;

/// In what order the slices of blended slicings are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, bevy::reflect::Reflect)]
pub enum SliceOrder {
    /// Interleaved by rank from the furthest; within a rank, always by number of orientation. Nothing pops where primary
    /// and secondary are swapped.
    #[default]
    Steady,
    /// As the paper does: interleaved, within a rank the secondary slice before the primary one, two slicings of the
    /// finest level only. Swaps pop.
    Paper,
}

/// A slicing that is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slot {
    /// Which orientation.
    pub orientation: u32,
    /// α, before the correction f_c; 0 where nothing is drawn.
    pub weight: f32,
}

/// Primary opacity α_p: 1 for an eye in line with the `primary` orientation, 0.5 half-way to the `secondary` one, linear
/// in the angle between, the direction to the eye being projected to the plane of both.
pub fn primary_opacity(primary: Vec3, secondary: Vec3, eye: Vec3) -> f32 {
    let cosine = primary.dot(secondary).clamp(-1.0, 1.0);
    let across = secondary - primary * cosine;
    let width = across.length();
    if width < 1e-4 {
        return 1.0;
    }
    let discrepancy = (eye.dot(across) / width).atan2(eye.dot(primary));
    let half = 0.5 * cosine.acos();
    1.0 - 0.5 * (discrepancy / half).clamp(0.0, 1.0)
}

/// The slicings for an eye in direction `eye` (unit) from the centroid, in the order in which the slices of a rank are
/// drawn. Weights add up to 1.
pub fn slots(shape: &SlicingShape, eye: Vec3, order: SliceOrder) -> [Slot; SLOTS] {
    let vertical = shape.vertical && order == SliceOrder::Steady;
    let count =
        shape.orientations.len() - usize::from(shape.vertical && shape.orientations.len() > 1);
    // The four orientations of least discrepancy angle, the nearest first.
    let mut nearest = [0_usize; 4];
    let mut cosines = [-2.0_f32; 4];
    for (i, o) in shape.orientations[..count].iter().enumerate() {
        let cosine = o.direction.dot(eye);
        for k in 0..4 {
            if cosine > cosines[k] {
                for j in (k + 1..4).rev() {
                    (nearest[j], cosines[j]) = (nearest[j - 1], cosines[j - 1]);
                }
                (nearest[k], cosines[k]) = (i, cosine);
                break;
            }
        }
    }
    let mut slots = [Slot::default(); SLOTS];
    for (slot, nearest) in slots.iter_mut().zip(nearest) {
        slot.orientation = nearest as u32;
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
        let direction = |k: usize| shape.orientations[nearest[k]].direction;
        let primary = match count {
            1 => 1.0,
            _ => primary_opacity(direction(0), direction(1), eye),
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

/// The screen that levels of detail are made for: pixels that a metre takes one metre away. 480 lines of 52° have so many.
pub const FOCAL: f32 = 500.0;

/// How many radii away a crown would be as small on the screen of [`FOCAL`] as it is so many radii away on one of `focal`.
pub fn apparent_distance(distance: f32, focal: f32) -> f32 {
    distance * FOCAL / focal
}

/// Two levels of detail and their shares for a crown that is, apparently, so many radii away: that of the first level,
/// and 1 minus it of the next coarser one.
pub fn levels(shape: &SlicingShape, distance: f32, order: SliceOrder) -> (usize, f32) {
    if order == SliceOrder::Paper {
        return (0, 1.0);
    }
    let mut level = 0;
    for switch in &shape.switches {
        if distance >= switch * (1.0 + FADE) {
            level += 1;
        }
    }
    let share = shape.switches.get(level).map_or(1.0, |switch| {
        1.0 - smooth(switch * (1.0 - FADE), switch * (1.0 + FADE), distance)
    });
    (level, share)
}

/// The corrected opacity of a slicing of weight α: f_c α, where f_c = 1 + m_s (1 − α_p), α_p being the greatest weight.
pub fn corrected(weight: f32, greatest: f32, correction: f32) -> f32 {
    (weight * (1.0 + correction * (1.0 - greatest))).min(1.0)
}

/// The greatest opacity that [`covered`] takes for what it is: more of it and a slicing that fades in would be there at once.
const SUREST: f32 = 0.96;

/// The opacity of a place of opacity `alpha` in one of several slicings that blend, whose weight α is `weight`:
/// 1 − (1 − alpha)^α, so that slicings whose weights add up to 1 cover together what one of them covers alone, where
/// α alpha would let more and more through. The correction f_c makes up for that on the average of a crown, this for
/// each place. Nearly opaque places are eased by [`SUREST`], so that no slicing gains more than 3.4 times its weight.
pub fn covered(alpha: f32, weight: f32) -> f32 {
    (1.0 - (1.0 - SUREST * alpha).powf(weight)) / SUREST
}

/// 0 up to `low`, 1 from `high`, and an S between.
fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = x.inverse_lerp_clamped(low, high);
    t * t * (3.0 - 2.0 * t)
}

trait InverseLerp {
    fn inverse_lerp_clamped(self, low: f32, high: f32) -> f32;
}

impl InverseLerp for f32 {
    fn inverse_lerp_clamped(self, low: f32, high: f32) -> f32 {
        f32::inverse_lerp(low, high, self).clamp(0.0, 1.0)
    }
}

/// A slice that is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnSlice {
    /// Which orientation.
    pub orientation: u32,
    /// Which level of detail.
    pub level: u32,
    /// Which slice of it, the first being furthest along the direction.
    pub index: u32,
    /// What becomes of its pixels' opacities: in the paper's order they are multiplied with this, α f_c; else this is α,
    /// and they are what [`covered`] says.
    pub opacity: f32,
}

/// All slices for an eye at `eye`, from the centroid in local space, on the screen of [`FOCAL`], in the order in which they
/// are drawn: far to near.
/// `left_out` of the furthest ones of each slicing are not.
pub fn drawn_slices(
    shape: &SlicingShape,
    eye: Vec3,
    order: SliceOrder,
    left_out: u32,
) -> Vec<DrawnSlice> {
    let direction = eye.normalize_or(Vec3::Z);
    let slots = slots(shape, direction, order);
    let (level, share) = levels(shape, eye.length() / shape.radius, order);
    let greatest = slots.iter().map(|slot| slot.weight).fold(0.0, f32::max);
    let mut drawn = Vec::new();
    for (level, share) in [(level + 1, 1.0 - share), (level, share)] {
        let count = shape.levels.get(level).copied().unwrap_or(0);
        for rank in 0..count {
            for slot in slots {
                let weight = slot.weight * share;
                let opacity = match order {
                    SliceOrder::Steady => weight,
                    SliceOrder::Paper => corrected(weight, greatest, shape.correction),
                };
                if opacity <= 0.0 || rank < left_out {
                    continue;
                }
                let faces = shape.orientations[slot.orientation as usize]
                    .direction
                    .dot(direction)
                    >= 0.0;
                drawn.push(DrawnSlice {
                    orientation: slot.orientation,
                    level: level as u32,
                    index: if faces { rank } else { count - 1 - rank },
                    opacity,
                });
            }
        }
    }
    drawn
}

/// The slices that cast shadows for light from `direction` (unit), that of a directional light, into a shadow map in which
/// the crown is as small as it apparently is so many radii away: those of the nearest orientation, in the level of
/// detail next to that for such a size, which no picture shows but frame times do (in the paper's order, the finest). What
/// is next to the light comes first, and hides the rest from the depth test on.
pub fn cast_slices(
    shape: &SlicingShape,
    direction: Vec3,
    distance: f32,
    order: SliceOrder,
) -> Vec<DrawnSlice> {
    let (level, share) = levels(shape, distance, order);
    let level = match order {
        SliceOrder::Paper => 0,
        SliceOrder::Steady => {
            let next = level + 1 + usize::from(share < 0.5);
            next.min(shape.levels.len() - 1)
        }
    };
    let count = shape.levels[level];
    let (mut nearest, mut greatest) = (0, -2.0);
    for (i, o) in shape.orientations.iter().enumerate() {
        let cosine = o.direction.dot(direction);
        if cosine > greatest {
            (nearest, greatest) = (i as u32, cosine);
        }
    }
    let slice = |number| DrawnSlice {
        orientation: nearest,
        level: level as u32,
        index: if greatest >= 0.0 {
            count - 1 - number
        } else {
            number
        },
        opacity: 1.0,
    };
    (0..count).map(slice).collect()
}

#[cfg(test)]
mod tests {
    use core::f32::consts::TAU;

    use super::*;
    use crate::slicing::orientation::{Orientation, Orientations};

    fn shape(orientations: Orientations, vertical: bool) -> SlicingShape {
        let mut directions = orientations.directions();
        directions.extend(vertical.then_some(Vec3::Y));
        SlicingShape {
            centroid: Vec3::Y,
            radius: 2.0,
            pixels: 16,
            levels: vec![5, 3, 1],
            switches: vec![10.0, 25.0],
            correction: 0.5,
            sphere: matches!(orientations, Orientations::Sphere(_)),
            vertical,
            orientations: directions.into_iter().map(Orientation::facing).collect(),
        }
    }

    fn horizontal(degrees: f32) -> Vec3 {
        let (sin, cos) = degrees.to_radians().sin_cos();
        Vec3::new(cos, 0.0, sin)
    }

    #[test]
    fn opacities_go_from_1_to_a_half_as_the_discrepancy_angle_grows_to_30_degrees() {
        let shape = shape(Orientations::Circle(6), false);
        for (angle, primary) in [(0.0, 1.0), (15.0, 0.75), (29.99, 0.5)] {
            let [secondary, first, _] = slots(&shape, horizontal(60.0 + angle), SliceOrder::Paper);
            assert_eq!(
                (first.orientation, secondary.orientation),
                (
                    1,
                    if angle > 0.0 {
                        2
                    } else {
                        secondary.orientation
                    }
                )
            );
            // Angles of single precision near 1 radian: a few 2⁻²³, over 30°.
            assert!(
                (first.weight - primary).abs() < 2e-3,
                "{angle}: {}",
                first.weight
            );
            assert!((first.weight + secondary.weight - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn an_eye_above_counts_by_its_projection_to_the_plane_of_both() {
        let shape = shape(Orientations::Circle(6), false);
        for elevation in [0.0_f32, 20.0, 44.0] {
            let (sin, cos) = elevation.to_radians().sin_cos();
            let eye = horizontal(75.0) * cos + Vec3::Y * sin;
            let [_, first, _] = slots(&shape, eye, SliceOrder::Paper);
            assert!(
                (first.weight - 0.75).abs() < 1e-5,
                "{elevation}: {}",
                first.weight
            );
        }
    }

    /// The opacity of every slice, and the order of those that matter.
    fn draw(shape: &SlicingShape, eye: Vec3) -> Vec<DrawnSlice> {
        drawn_slices(shape, eye, SliceOrder::Steady, 0)
    }

    #[test]
    fn nothing_pops_on_any_way_of_the_eye() {
        // Along each way, no slice changes its opacity by more than the step allows, and no two slices of weight
        // change places.
        let circle = shape(Orientations::Circle(6), true);
        let sphere = shape(Orientations::Sphere(20), false);
        let orbit = |t: f32| horizontal(360.0 * t) * 8.0 + Vec3::Y * 2.0;
        let rise = |t: f32| Vec3::new((TAU * t).cos(), (TAU * t).sin(), 0.13) * 9.0;
        let away = |t: f32| Vec3::new(0.3, 0.2, 1.0).normalize() * (1.0 + 80.0 * t);
        let ways: [&dyn Fn(f32) -> Vec3; 3] = [&orbit, &rise, &away];
        for shape in [&circle, &sphere] {
            for way in ways {
                let steps = 20_000;
                let mut before = draw(shape, way(0.0));
                for step in 1..=steps {
                    let after = draw(shape, way(step as f32 / steps as f32));
                    let key = |s: &DrawnSlice| (s.level, s.orientation, s.index);
                    let opacity = |all: &[DrawnSlice], k| {
                        all.iter().find(|s| key(s) == k).map_or(0.0, |s| s.opacity)
                    };
                    for s in before.iter().chain(&after) {
                        let change = (opacity(&before, key(s)) - opacity(&after, key(s))).abs();
                        // A turn takes 20,000 steps; opacities fall by ½ in 30° at most, and gain by the correction.
                        assert!(change < 0.01, "{s:?} at {step}: {change}");
                    }
                    let matter = |all: &[DrawnSlice]| -> Vec<_> {
                        all.iter().filter(|s| s.opacity > 0.02).map(key).collect()
                    };
                    let (a, b) = (matter(&before), matter(&after));
                    let common = |x: &[(u32, u32, u32)], y: &[(u32, u32, u32)]| -> Vec<_> {
                        x.iter().filter(|k| y.contains(k)).copied().collect()
                    };
                    assert_eq!(common(&a, &b), common(&b, &a), "order at {step}");
                    before = after;
                }
            }
        }
    }

    #[test]
    fn blended_slicings_cover_together_what_one_covers_alone() {
        for alpha in [0.0, 0.1, 0.5, 0.9, 1.0_f32] {
            // One slicing alone is what it is, in single precision.
            assert!((covered(alpha, 1.0) - alpha).abs() < 1e-6);
            let mut before = 0.0;
            for step in 1..=100 {
                let weight = step as f32 / 100.0;
                let (a, b) = (covered(alpha, weight), covered(alpha, 1.0 - weight));
                let both = 1.0 - (1.0 - a) * (1.0 - b);
                // Easing takes a part of what both cover: a b (1/SUREST - 1) at most, a quarter in the middle.
                let eased = 1.0 / SUREST - 1.0;
                assert!((both - alpha).abs() <= eased, "{alpha} {weight}: {both}");
                assert!(a >= before && a - before < 0.034, "{alpha} {weight}");
                before = a;
            }
        }
    }

    #[test]
    fn slices_are_drawn_interleaved_from_the_furthest() {
        let shape = shape(Orientations::Circle(6), false);
        let drawn = drawn_slices(&shape, horizontal(75.0) * 9.0, SliceOrder::Paper, 0);
        let expected: Vec<_> = (0..5).flat_map(|rank| [(2, rank), (1, rank)]).collect();
        let order: Vec<_> = drawn.iter().map(|s| (s.orientation, s.index)).collect();
        assert_eq!(order, expected);
        // f_c = 1 + ½ · ¼.
        assert!((drawn[0].opacity - 0.25 * 1.125).abs() < 1e-5);
        assert!((drawn[1].opacity - 0.75 * 1.125).abs() < 1e-5);
        let fewer = drawn_slices(&shape, horizontal(75.0) * 9.0, SliceOrder::Paper, 2);
        assert_eq!(fewer, drawn[4..]);
    }

    #[test]
    fn levels_of_detail_take_over_with_distance_and_the_vertical_slicing_from_above_and_below() {
        let shape = shape(Orientations::Circle(6), true);
        let slices = |radii: f32| draw(&shape, horizontal(0.0) * radii * shape.radius).len();
        assert_eq!(
            [slices(5.0), slices(10.0), slices(15.0), slices(40.0)],
            [5, 8, 3, 1]
        );
        for y in [1.0, -1.0] {
            let drawn = draw(&shape, Vec3::new(0.01, y, 0.01) * 9.0);
            assert_eq!(drawn.len(), 5);
            assert!(drawn.iter().all(|s| s.orientation == 6 && s.opacity == 1.0));
            // From below, what is above is further.
            assert_eq!(drawn[0].index, if y > 0.0 { 0 } else { 4 });
        }
    }

    #[test]
    fn shadows_are_cast_by_the_slicing_that_faces_the_light() {
        let shape = shape(Orientations::Circle(6), true);
        for (light, orientation) in [(Vec3::Y, 6), (horizontal(100.0), 2), (horizontal(-5.0), 0)] {
            for (distance, count) in [(1.0, 3), (9.9, 3), (10.1, 1), (24.0, 1), (26.0, 1)] {
                let cast = cast_slices(&shape, light, distance, SliceOrder::Steady);
                // The slice next to the light has the greatest number, and comes first.
                let numbers: Vec<u32> = cast.iter().map(|s| s.index).collect();
                assert_eq!(numbers, (0..count).rev().collect::<Vec<u32>>());
                assert!(
                    cast.iter()
                        .all(|s| s.orientation == orientation && s.opacity == 1.0),
                    "{light}"
                );
            }
            let paper = cast_slices(&shape, light, 26.0, SliceOrder::Paper);
            assert_eq!(paper.len(), 5);
        }
    }

    #[test]
    fn weights_add_up_to_1_for_any_eye() {
        for shape in [
            shape(Orientations::Circle(6), true),
            shape(Orientations::Circle(3), false),
            shape(Orientations::Sphere(9), false),
            shape(
                Orientations::Arc {
                    count: 2,
                    from: 0.0,
                    to: 0.5,
                },
                true,
            ),
        ] {
            for eye in Orientations::Sphere(499).directions() {
                for order in [SliceOrder::Steady, SliceOrder::Paper] {
                    let sum: f32 = slots(&shape, eye, order).iter().map(|s| s.weight).sum();
                    assert!((sum - 1.0).abs() < 1e-5, "{eye}: {sum}");
                }
            }
        }
    }
}

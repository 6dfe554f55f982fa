//! What is promised of view blending.

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
        diffuse_transmission: 0.0,
        sphere: matches!(orientations, Orientations::Sphere(_)),
        vertical,
        orientations: directions.into_iter().map(Orientation::facing).collect(),
    }
}

/// So many orientations over an arc, and a vertical one.
fn arc(count: u32, to: f32) -> SlicingShape {
    let from = 0.0;
    shape(Orientations::Arc { count, from, to }, true)
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
fn in_the_steady_order_a_slicing_is_alone_on_half_the_way_to_the_swap() {
    let shape = shape(Orientations::Circle(6), true);
    let slices = shape.levels[0] as usize;
    for (angle, primary, drawn) in [
        (0.0, 1.0, 1),
        (14.9, 1.0, 1),
        (22.5, 0.75, 2),
        (29.99, 0.5, 2),
    ] {
        let eye = horizontal(60.0 + angle);
        let slots = slots(&shape, eye, SliceOrder::Steady);
        let of = |slot: &&super::Slot| slot.orientation == 1;
        let weight = slots.iter().find(of).map_or(0.0, |slot| slot.weight);
        // As above, over 15°.
        assert!((weight - primary).abs() < 2e-3, "{angle}: {weight}");
        assert_eq!(draw(&shape, eye * 4.0).len(), drawn * slices, "{angle}");
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

/// All slices for an eye, in the steady order.
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
                    // A turn takes 20,000 steps; opacities fall by ½ in 15° at most.
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
        let whole = SUREST * alpha;
        let mut before = 0.0;
        for step in 1..=100 {
            let weight = step as f32 / 100.0;
            let (a, b) = (covered(alpha, weight), covered(alpha, 1.0 - weight));
            let both = 1.0 - (1.0 - a) * (1.0 - b);
            // In single precision.
            assert!((both - whole).abs() < 1e-6, "{alpha} {weight}: {both}");
            // ln(1/(1 - SUREST)) = 3.22 times a step of the weight.
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
fn upright_slices_count_for_the_leaves_between_them_from_above() {
    let shape = shape(Orientations::Circle(6), true);
    let eye = Vec3::new(0.0, 0.49, 0.49_f32.acos().sin()).normalize();
    let eye = Vec3::new(eye.z, eye.y, 0.0) * 5.0 * shape.radius;
    // Just below where the vertical slicing joins in: the same slices as from the side, of as much more weight.
    let (above, beside) = (draw(&shape, eye), draw(&shape, eye.with_y(0.0)));
    assert_eq!(above.len(), beside.len());
    for (above, beside) in above.iter().zip(&beside) {
        assert_eq!(
            (above.orientation, above.index),
            (beside.orientation, beside.index)
        );
        let level = eye.with_y(0.0).length() / eye.length();
        assert!((above.opacity * level - beside.opacity).abs() < 1e-5);
    }
}

#[test]
fn leaves_look_up_to_an_eye_above_and_down_to_one_below() {
    let shape = shape(Orientations::Circle(6), true);
    let front = horizontal(60.0);
    // Roundings of unit vectors.
    assert!(leaning(&shape, front, horizontal(80.0)).distance(front) < 1e-6);
    for sign in [1.0, -1.0] {
        let eye = (front + Vec3::Y * sign * f32::tan(0.4)).normalize();
        let leans = leaning(&shape, front, eye);
        assert!((leans.angle_between(front) - 0.4 * LEAN).abs() < 1e-3 && leans.y * sign > 0.0);
        assert!(turned(front, front, leans).distance(leans) < 1e-6);
        let normal = Vec3::new(0.3, -0.7, 0.2).normalize();
        let found = turned(normal, front, leans);
        // A rotation: lengths and angles stay.
        assert!((found.length() - 1.0).abs() < 1e-6);
        assert!((found.dot(leans) - normal.dot(front)).abs() < 1e-6);
    }
    // Those of the vertical slicing look to the eye that comes down, and as they were baked for one straight below.
    for front in [Vec3::Y, Vec3::NEG_Y] {
        assert!(leaning(&shape, front, front).distance(front) < 1e-6);
        let eye = front * f32::cos(0.6) + horizontal(60.0) * f32::sin(0.6);
        let leans = leaning(&shape, front, eye);
        // Arc sines next to a right angle are good to four digits.
        assert!((leans.angle_between(front) - 0.6 * LEAN_DOWN).abs() < 1e-3);
        assert!(leans.angle_between(eye) < 0.6);
    }
}

#[test]
fn leaves_are_nearer_to_the_sun_where_the_eye_looks_along_the_light_or_stands_higher() {
    let shape = shape(Orientations::Circle(6), true);
    let shift = |front, height: f32, near, spacing| {
        let direction = Vec3::new((1.0 - height * height).sqrt(), height, 0.0);
        towards_sun(&shape, front, direction, near, spacing, 1.0)
    };
    // The nearer of both bounds, here by the distance between slices.
    let most = HOT_SPOT[0] * 0.1;
    for (near, share) in [(1.0, 1.0), (0.8, 0.64), (0.0, 0.0), (-1.0, 0.0)] {
        // Of vertical slices the hot spot alone, which is none where the light comes from before the eye; of upright ones as
        // well at the height at which they are as light as their leaves.
        assert!((shift(Vec3::Y, 0.9, near, 0.1) - share * most).abs() < 1e-6);
        assert!((shift(Vec3::X, EVEN_HEIGHT, near, 0.1) - share * most).abs() < 1e-6);
    }
    assert!((shift(Vec3::Y, 1.0, 1.0, 1.0) - HOT_SPOT[1]).abs() < 1e-6);
    // Further with height, and no further than to where they are no longer drawn alone.
    let heights = [-0.9, HEIGHTS[0], 0.0, EVEN_HEIGHT, HEIGHTS[1], 0.9];
    let shifts = heights.map(|height| shift(Vec3::X, height, 0.0, 0.1) / most);
    assert!((shifts[2] + TOP_LIGHT * EVEN_HEIGHT).abs() < 1e-6);
    assert!(shifts[1..5].is_sorted_by(|a, b| a < b));
    assert!((shifts[0], shifts[4]) == (shifts[1], shifts[5]));
}

#[test]
fn shadows_are_cast_by_the_slicing_that_faces_the_light() {
    let shape = shape(Orientations::Circle(6), true);
    for (light, orientation) in [(Vec3::Y, 6), (horizontal(100.0), 2), (horizontal(-5.0), 0)] {
        for (order, count) in [(SliceOrder::Steady, 1), (SliceOrder::Paper, 5)] {
            let cast = cast_slices(&shape, light, order);
            // The slice next to the light has the greatest number, and comes first.
            let numbers: Vec<u32> = cast.iter().map(|s| s.index).collect();
            assert_eq!(numbers, (0..count).rev().collect::<Vec<u32>>());
            assert!(
                cast.iter()
                    .all(|s| s.orientation == orientation && s.opacity == 1.0),
                "{light}"
            );
        }
    }
}

#[test]
fn light_thins_out_on_its_way_through_leaves_that_are_spread_evenly() {
    for alpha in [0.05, 0.3, 0.7] {
        // Lots that are drawn at even distances are drawn as often as any; those of `alpha` or more meet no leaf.
        let lots = (0..20_000).map(|i| (i as f32 + 0.5) / 20_000.0);
        let depths: Vec<f32> = lots
            .map(|lot| {
                if lot < alpha {
                    first_leaf(lot, alpha)
                } else {
                    2.0
                }
            })
            .collect();
        for t in [0.25, 0.5, 0.75] {
            let left = depths.iter().filter(|depth| **depth > t).count() as f32 / 20_000.0;
            // One lot more or less.
            assert!(
                (left - (1.0 - alpha).powf(t)).abs() < 2e-4,
                "{alpha} {t}: {left}"
            );
        }
        assert!(depths.iter().all(|t| (0.0..=1.0).contains(t) || *t == 2.0));
    }
    assert_eq!(first_leaf(0.99, 1.0), 1.0);
}

#[test]
fn a_slice_that_faces_the_light_casts_the_shadow_of_an_ellipsoid() {
    let o = Orientation {
        direction: Vec3::Z,
        right: Vec3::X,
        up: Vec3::Y,
        low: Vec3::new(-2.0, -3.0, -1.5),
        high: Vec3::new(2.0, 3.0, 1.5),
    };
    let half = 0.5 * (o.high - o.low);
    for light in [
        Vec3::Z,
        Vec3::NEG_Z,
        Vec3::new(0.6, 0.0, 0.8),
        Vec3::new(0.0, -0.7, -0.714),
    ] {
        let light = light.normalize();
        for i in 0..16 {
            let (sin, cos) = (i as f32 * core::f32::consts::FRAC_PI_8).sin_cos();
            let edge = Vec3::new(half.x * cos, half.y * sin, 0.0);
            let cast = facing(&o, light, edge);
            assert!(cast.dot(light).abs() < 1e-5, "it faces the light");
            // A ray on the ellipsoid's outline touches it: the quadratic for where they meet has one root.
            let (p, d) = (cast / half, light / half);
            let discriminant = p.dot(d).powi(2) - d.dot(d) * (p.dot(p) - 1.0);
            assert!(
                discriminant.abs() < 1e-4 * d.dot(d),
                "{light} {i}: {discriminant}"
            );
        }
    }
}

#[test]
fn weights_add_up_to_1_for_any_eye() {
    for shape in [
        shape(Orientations::Circle(6), true),
        shape(Orientations::Circle(3), false),
        shape(Orientations::Sphere(9), false),
        arc(2, 0.5),
    ] {
        for eye in Orientations::Sphere(499).directions() {
            for order in [SliceOrder::Steady, SliceOrder::Paper] {
                let sum: f32 = slots(&shape, eye, order).iter().map(|s| s.weight).sum();
                assert!((sum - 1.0).abs() < 1e-5, "{eye}: {sum}");
            }
        }
    }
}

/// Directions in a cone of an angle round a direction, its edge among them.
fn cone(direction: Vec3, angle: f32) -> impl Iterator<Item = Vec3> {
    let (x, y) = direction.any_orthonormal_pair();
    [0.0, 0.3, 0.7, 1.0].into_iter().flat_map(move |share| {
        let (sin, cos) = (share * angle).sin_cos();
        (0..16).map(move |i| {
            let (s, c) = (i as f32 * core::f32::consts::FRAC_PI_8).sin_cos();
            direction * cos + (x * c + y * s) * sin
        })
    })
}

#[test]
fn of_what_any_part_shows_nothing_is_left_out_or_seen_from_behind() {
    for shape in [
        shape(Orientations::Circle(6), true),
        shape(Orientations::Circle(3), false),
        shape(Orientations::Circle(24), true),
        arc(2, 0.5),
    ] {
        for distance in [0.5, 1.5, 2.5] {
            for eye in Orientations::Sphere(499).directions() {
                let deviation = deviation(distance, widest(&shape), eye.with_y(0.0).length());
                let drawn = part_slots(&shape, eye, deviation);
                assert!(drawn.is_sorted_by_key(|slot| slot.orientation));
                let is_circle = shape.orientations.len() > 3;
                for ray in cone(eye, deviation.y.atan2(deviation.x)) {
                    let part = part_direction(eye, ray, deviation);
                    let mut sum = 0.0;
                    for slot in drawn.iter().filter(|slot| slot.weight > 0.0) {
                        let weight = part_weight(&shape, slot.orientation, part);
                        sum += weight;
                        let o = shape.orientations[slot.orientation as usize];
                        // Slices change their order where they are seen from the side.
                        let facing = o.direction.dot(eye) * o.direction.dot(part);
                        assert!(
                            !is_circle || facing > 0.0 || weight < 0.02,
                            "{eye} {part}: {slot:?} {weight}"
                        );
                    }
                    // In single precision, of angles over 7° at least.
                    assert!((sum - 1.0).abs() < 1e-3, "{eye} {ray}: {sum}");
                }
            }
        }
    }
}

#[test]
fn weights_told_by_turns_are_those_of_directions() {
    for shape in [
        shape(Orientations::Circle(1), true),
        shape(Orientations::Circle(2), true),
        shape(Orientations::Circle(3), false),
        shape(Orientations::Circle(24), true),
        arc(3, 0.9),
    ] {
        for direction in Orientations::Sphere(999).directions() {
            for orientation in 0..shape.orientations.len() as u32 {
                let turned = turned_weight(part_turn(&shape, orientation, direction));
                let weight = part_weight(&shape, orientation, direction);
                // In single precision, of angles over 7° at least.
                assert!(
                    (turned - weight).abs() < 1e-3,
                    "{shape:?} {orientation} {direction}: {turned} {weight}"
                );
            }
        }
    }
}

#[test]
fn over_the_sphere_the_discrepancy_angle_is_the_whole_crowns() {
    assert_eq!(widest(&shape(Orientations::Sphere(9), false)), 0.0);
}

#[test]
fn parts_differ_by_no_more_than_they_are_seen_under_and_from_far_by_nothing() {
    let shape = shape(Orientations::Circle(6), true);
    let angle = |distance: f32| {
        let deviation = deviation(distance, widest(&shape), 1.0);
        deviation.y.atan2(deviation.x)
    };
    assert!((angle(0.0) - 30.0_f32.to_radians()).abs() < 1e-6);
    // Half-way, half of what is seen of a ball, which is wider than slicings reach.
    let middle = 0.5 * (PARTS[0] + PARTS[1]);
    let half = 0.5 * middle.recip().asin().min(30.0_f32.to_radians());
    assert!((angle(middle) - half).abs() < 1e-5, "{}", angle(middle));
    assert_eq!(angle(PARTS[1]), 0.0);
    for eye in Orientations::Sphere(99).directions() {
        for ray in Orientations::Sphere(99).directions() {
            let part = part_direction(eye, ray, deviation(1.2, widest(&shape), 1.0));
            assert!((part.length() - 1.0).abs() < 1e-5);
            let most = angle(1.2).min(eye.angle_between(ray));
            assert!(ray == -eye || (part.angle_between(eye) - most).abs() < 2e-3);
        }
    }
}

//! Directions and counts for views of one facet.

use bevy::math::Vec2;

use super::super::criteria::gap_ratio;
use super::super::facet::slice_position;
use super::*;

/// A metre of surface with one texel of 64³, a quarter high.
fn facet() -> Facet {
    Facet {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
        heights: [Vec3::Z * 0.25; 3],
        uvs: [Vec2::ZERO, Vec2::X, Vec2::Y],
    }
}

fn measure() -> VolumeMeasure {
    VolumeMeasure {
        most: UVec3::splat(64),
        lengths: Vec3::new(1.0, 1.0, 0.25),
        thickness: Thickness {
            narrowest: Vec3::new(0.02, 0.02, 0.05),
        },
    }
}

fn looking(direction: Vec3, distance: f32) -> TexelView {
    let place = Vec3::new(1.0 / 3.0, 1.0 / 3.0, 0.125);
    TexelView {
        eye: place - direction.normalize() * distance,
        direction: None,
        pixels: 900.0,
        half_spaces: [Vec4::ZERO; 6],
    }
}

/// As many slices as they are seen to need.
fn as_seen() -> TexelQuality {
    TexelQuality {
        least_angle: 0.0,
        ..Default::default()
    }
}

fn chosen(direction: Vec3, distance: f32) -> (SliceAxis, u32) {
    let view = looking(direction, distance);
    match choose(&facet(), &measure(), &view, &as_seen()) {
        Choice::Slices { axis, exponent, .. } => (axis, 1 << exponent),
        Choice::LeftOut => panic!("it is in view"),
    }
}

#[test]
fn from_above_one_slice_will_do_and_aslant_there_are_more() {
    assert_eq!(chosen(Vec3::NEG_Z, 60.0), (SliceAxis::W, 1));
    // A corner 0.745 aside, 2.875 away, needs 0.25 · 0.259/0.025 = 2.6.
    assert_eq!(chosen(Vec3::NEG_Z, 3.0), (SliceAxis::W, 4));
    let mut last = 0;
    for degrees in [10.0, 30.0, 50.0, 63.0f32] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let (axis, count) = chosen(Vec3::new(sin, 0.0, -cos), 3.0);
        assert_eq!(axis, SliceAxis::W);
        assert!(count >= last, "{degrees}");
        last = count;
    }
    assert!(last > 8);
}

#[test]
fn grazing_views_take_upright_slices_across_the_view() {
    // Upright slices are four times further apart, so that they win where tan > 4/tan, from tan = 2 on.
    assert_eq!(chosen(Vec3::new(1.0, 0.05, -0.1), 3.0).0, SliceAxis::U);
    assert_eq!(chosen(Vec3::new(0.05, -1.0, -0.1), 3.0).0, SliceAxis::V);
    assert_eq!(chosen(Vec3::new(1.0, 0.0, -0.49), 3.0).0, SliceAxis::U);
    assert_eq!(chosen(Vec3::new(1.0, 0.0, -0.51), 3.0).0, SliceAxis::W);
}

#[test]
fn by_quality_a_thick_direction_wins_over_a_fine_one() {
    // Upright slices are four times further apart, but contours are ten times as thick there.
    let mut measure = measure();
    measure.thickness.narrowest = Vec3::new(0.2, 0.2, 0.02);
    // So far away that angles hardly differ over the facet, through a strong lens.
    let view = TexelView {
        pixels: 90_000.0,
        ..looking(Vec3::new(1.0, 0.0, -1.0), 30.0)
    };
    let chosen = |direction| {
        let quality = TexelQuality {
            direction,
            ..as_seen()
        };
        choose(&facet(), &measure, &view, &quality)
    };
    let axis_and_exponent = |choice| match choice {
        Choice::Slices { axis, exponent, .. } => (axis, exponent),
        Choice::LeftOut => panic!("it is in view"),
    };
    // N ≥ L·tan(45°)/(e/2): 0.25/0.01 and 1/0.1, and a twentieth more for corners.
    assert_eq!(
        axis_and_exponent(chosen(DirectionRule::StepAside)),
        (SliceAxis::W, 5)
    );
    assert_eq!(
        axis_and_exponent(chosen(DirectionRule::Quality)),
        (SliceAxis::U, 4)
    );
}

#[test]
fn counts_fall_with_distance_to_one() {
    let direction = Vec3::new(1.0, 0.2, -1.0);
    let counts: Vec<_> = (0..14).map(|i| chosen(direction, 2f32.powi(i)).1).collect();
    assert!(counts.is_sorted_by(|near, far| near >= far), "{counts:?}");
    assert!(counts[0] > 8 && counts[13] == 1, "{counts:?}");
}

#[test]
fn near_counts_are_dense_enough_that_no_gap_can_show() {
    for i in 0..500 {
        let turn = i as f32 * 2.4;
        let z = -(i as f32 + 0.5) / 500.0;
        let r = (1.0 - z * z).sqrt();
        let direction = Vec3::new(r * turn.cos(), r * turn.sin(), z);
        let (axis, count) = chosen(direction, 1.5);
        let (c, l) = (
            [direction.x, direction.y, direction.z][axis.index()],
            [1.0, 1.0, 0.25][axis.index()],
        );
        let ratio = gap_ratio(
            l / count as f32,
            tan_view_angle(c),
            measure().thickness.along(axis),
        );
        // Or all slices are drawn that there are, or they are closer than a pixel.
        let pixels = l / count as f32 * sin_view_angle(c) * 900.0 / (1.5 - 1.0);
        assert!(
            ratio <= 0.5001 || count == 64 || pixels <= 1.0,
            "{direction}: {ratio}"
        );
    }
}

#[test]
fn what_is_out_of_view_or_broken_is_left_out() {
    let mut view = looking(Vec3::NEG_Z, 3.0);
    let choice = |facet: &Facet, view: &TexelView| choose(facet, &measure(), view, &as_seen());
    view.half_spaces[2] = Vec4::new(1.0, 0.0, 0.0, -0.9);
    assert_ne!(
        choice(&facet(), &view),
        Choice::LeftOut,
        "its corner reaches in"
    );
    view.half_spaces[2].w = -3.0;
    assert_eq!(choice(&facet(), &view), Choice::LeftOut);
    let broken = Facet {
        uvs: [Vec2::ONE; 3],
        ..facet()
    };
    assert_eq!(choice(&broken, &looking(Vec3::NEG_Z, 3.0)), Choice::LeftOut);
}

#[test]
fn an_eye_within_the_texel_gets_all_there_is() {
    // Corners lie on both sides of the slice through the eye.
    assert_eq!(chosen(Vec3::new(1.0, 0.3, -0.5), 1e-3), (SliceAxis::W, 64));
    let view = TexelView {
        eye: facet().point(Vec3::splat(1.0 / 3.0), 0.5),
        ..looking(Vec3::X, 1.0)
    };
    let choice = choose(&facet(), &measure(), &view, &as_seen());
    assert!(
        matches!(choice, Choice::Slices { exponent: 6, .. }),
        "{choice:?}"
    );
}

#[test]
fn an_orthographic_view_is_alike_at_any_distance() {
    let along = |eye: Vec3| TexelView {
        eye,
        direction: Some(Vec3::new(1.0, 0.0, -1.0)),
        pixels: 40.0,
        half_spaces: [Vec4::ZERO; 6],
    };
    let choices = [Vec3::ZERO, Vec3::splat(1e4)]
        .map(|eye| choose(&facet(), &measure(), &along(eye), &as_seen()));
    assert_eq!(choices[0], choices[1]);
    // 0.25 m · sin 45° · 40 pixels a metre is 7.07 pixels: as many slices, rounded up.
    assert_eq!(
        choices[0],
        Choice::Slices {
            axis: SliceAxis::W,
            exponent: 3,
            along: false
        }
    );
}

#[test]
fn at_the_least_angle_there_are_as_many_slices_as_seen_from_it() {
    let count = |degrees: f32, least_angle: f32| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let view = TexelView {
            direction: Some(Vec3::new(sin, 0.0, -cos)),
            ..looking(Vec3::NEG_Z, 1.0)
        };
        let quality = TexelQuality {
            least_angle,
            ..Default::default()
        };
        let all = choose_fading(&facet(), &measure(), &view, &quality);
        let [_, _, w] = all;
        let w = w.expect("slices along w are seen best");
        (w.exponent, w.step_aside)
    };
    let (aslant, _) = count(25.0, 0.0);
    assert_eq!(count(0.0, 0.0), (0, 0.0));
    // More of them, but one sees no deeper.
    assert_eq!(count(0.0, 25f32.to_radians()), (aslant, 0.0));
    assert_eq!(count(25.0, 0.1).0, aslant);
    assert!(aslant > 1);
    // Along the slices, or beyond, all there are.
    for least_angle in [FRAC_PI_2, 2.0, f32::INFINITY] {
        assert_eq!(count(0.0, least_angle), (6, 0.0), "{least_angle}");
    }
    assert_eq!(count(0.0, -1.0), count(0.0, 0.0));
}

#[test]
fn bounds_that_are_no_numbers_above_zero_draw_all_slices() {
    let view = looking(Vec3::new(0.5, 0.0, -1.0), 3.0);
    let fewer = choose(&facet(), &measure(), &view, &TexelQuality::default());
    for bound in [0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        let quality = TexelQuality {
            depth: bound,
            pixels: bound,
            least_angle: bound,
            ..TexelQuality::default()
        };
        let Choice::Slices { exponent, .. } = choose(&facet(), &measure(), &view, &quality) else {
            panic!("in view");
        };
        assert_eq!(exponent, 6, "{bound}");
        let all = choose_fading(&facet(), &measure(), &view, &quality);
        for slices in all.into_iter().flatten() {
            assert_eq!(slices.exponent, 6, "{bound}");
            assert!(
                slices.step_aside.is_finite() && slices.thickness > 0.0,
                "{bound}"
            );
        }
    }
    assert!(matches!(fewer, Choice::Slices { exponent, .. } if exponent < 6));
}

/// What is drawn across the axis that a view in a direction sees best, from 120 m to less than one.
fn drawn_from_afar(axis: SliceAxis, direction: Vec3) -> impl Iterator<Item = DrawnSlices> {
    // So slowly that the way on which slices move apart, the last three thirty-seconds, is many steps long.
    (0..5000).map(move |i| {
        let view = looking(direction, 120.0 * 0.999f32.powi(i));
        let all = choose_fading(&facet(), &measure(), &view, &TexelQuality::default());
        let slices = all[axis.index()].expect("it has all lots");
        slices.drawn(true).expect("it has all lots")
    })
}

#[test]
fn what_is_drawn_goes_on_where_counts_double() {
    for (axis, direction) in [
        (SliceAxis::U, Vec3::new(1.0, 0.05, -0.1)),
        (SliceAxis::V, Vec3::new(0.05, -1.0, -0.1)),
        (SliceAxis::W, Vec3::new(0.5, 0.0, -1.0)),
    ] {
        let mut counts = Vec::new();
        let mut before: Option<DrawnSlices> = None;
        for drawn in drawn_from_afar(axis, direction) {
            counts.push(drawn.count);
            // Those that take the place of others begin where these are.
            if let Some(before) = before {
                let doubled = drawn.count / before.count;
                for slice in 0..drawn.count as i32 {
                    let place = slice_position(slice / doubled as i32, before.count, before.apart);
                    let moved = slice_position(slice, drawn.count, drawn.apart) - place;
                    // A step nearer changes what is needed by 1 to 2 in 1,000, and the way apart, half a layer, by 11 times
                    // as much.
                    let layers = moved.abs() * drawn.count as f32;
                    assert!(layers <= 0.02, "{axis:?} {before:?} {drawn:?}");
                }
            }
            before = Some(drawn);
        }
        counts.dedup();
        assert!(counts.len() > 3, "{axis:?} {counts:?}");
        let doubles = |pair: &[u32]| pair[1] == 2 * pair[0];
        assert!(counts.windows(2).all(doubles), "{axis:?} {counts:?}");
    }
}

#[test]
fn one_sees_half_as_deep_between_twice_as_many_slices_until_there_are_gaps() {
    let slices = AxisSlices {
        axis: SliceAxis::W,
        exponent: 2,
        along: true,
        finer: 0.0,
        lots: [0.0, 1.0],
        step_aside: 0.3,
        thickness: 0.1,
        footprint: Vec2::ZERO,
    };
    let inside = [0, 1, 2, 3].map(|doublings| slices.inside(doublings));
    assert_eq!(inside, [0.1, 0.1, 0.075, 0.0375]);
}

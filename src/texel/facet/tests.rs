//! Slices of facets: whole, without cracks, in any mapping.

use bevy::math::{Quat, Vec2, Vec3};
use proptest::prelude::*;

use super::super::axis::SliceAxis;
use super::*;

/// A facet one metre wide that carries one texel and a bit, slightly bent.
fn facet() -> Facet {
    Facet {
        positions: [
            Vec3::ZERO,
            Vec3::new(1.0, 0.1, 0.0),
            Vec3::new(0.2, 0.9, 0.1),
        ],
        heights: [
            Vec3::new(0.0, 0.0, 0.5),
            Vec3::new(0.1, 0.0, 0.4),
            Vec3::new(0.0, 0.1, 0.6),
        ],
        uvs: [
            Vec2::new(0.3, 0.2),
            Vec2::new(1.6, 0.4),
            Vec2::new(0.4, 1.1),
        ],
    }
}

fn uv_area(uvs: [Vec2; 3]) -> f32 {
    (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]).abs() / 2.0
}

fn mapping() -> impl Strategy<Value = [Vec2; 3]> {
    let uv = || prop::array::uniform2(-2.5..2.5f32).prop_map(Vec2::from);
    [uv(), uv(), uv()].prop_filter("area", |uvs| uv_area(*uvs) > 0.02)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..Default::default() })]

    #[test]
    fn lines_of_all_slices_add_up_to_the_area(uvs in mapping(), exponent in 3..7u32) {
        let count = 1 << exponent;
        for (axis, other) in [(SliceAxis::U, Vec2::Y), (SliceAxis::V, Vec2::X)] {
            let facet = Facet { uvs, ..facet() };
            let mut area = 0.0;
            for slice in slice_range(uvs, axis, count, 1.0) {
                let [a, b] = slice_line(uvs, axis, slice_position(slice, count, 1.0)).expect("in range");
                area += (facet.uv(b) - facet.uv(a)).dot(other).abs() / count as f32;
            }
            // The midpoint rule on a length that is linear between corners: exact but for the three slices with
            // corners, off by at most a slice of the change of slope there; bounded by one slice of the longest line.
            let longest = 5.0;
            prop_assert!((area - uv_area(uvs)).abs() <= 1.5 * longest / count as f32, "{area}");
        }
    }

    #[test]
    fn the_range_has_all_slices_that_cut_and_no_other(uvs in mapping(), exponent in 0..7u32, apart in 0.0..=1.0f32) {
        let count = 1 << exponent;
        for axis in [SliceAxis::U, SliceAxis::V] {
            let range = slice_range(uvs, axis, count, apart);
            let most = 3 * count as i32 + 2;
            for slice in -most..most {
                let position = slice_position(slice, count, apart);
                let meets = slice_line(uvs, axis, position).is_some();
                prop_assert_eq!(meets, range.contains(&slice), "{}", slice);
            }
        }
    }

    #[test]
    fn pairs_begin_where_the_slice_of_half_as_many_is_and_end_evenly_spaced(slice in -300..300i32, exponent in 1..8u32) {
        let count = 1 << exponent;
        let whole = slice_position(slice.div_euclid(2), count / 2, 1.0);
        prop_assert_eq!(slice_position(slice, count, 0.0), whole);
        // The layer of the slice, of which it is in the middle.
        let even = (slice as f32 + 0.5) / count as f32;
        prop_assert_eq!(slice_position(slice, count, 1.0), even);
        let between = slice_position(slice, count, 0.25);
        prop_assert!((between - (0.75 * whole + 0.25 * even)).abs() <= f32::EPSILON * whole.abs().max(1.0));
    }

    #[test]
    fn ends_lie_on_the_line_and_on_edges(uvs in mapping(), position in -2.5..2.5f32) {
        for axis in [SliceAxis::U, SliceAxis::V] {
            for end in slice_line(uvs, axis, position).into_iter().flatten() {
                let facet = Facet { uvs, ..facet() };
                let uv = facet.uv(end)[axis.index()];
                // Rounding of coordinates up to 2.5.
                prop_assert!((uv - position).abs() < 2e-6, "{uv}");
                prop_assert!(end.min_element() == 0.0 && (end.element_sum() - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn neighbours_share_the_ends_on_their_edge(
        uvs in mapping(),
        fourth in prop::array::uniform2(-2.5..2.5f32),
        position in -2.5..2.5f32,
    ) {
        // The same edge, first to second vertex, run through the other way and starting elsewhere.
        let one = Facet { uvs, ..facet() };
        let other = Facet {
            positions: [Vec3::new(0.5, -0.7, 0.3), one.positions[1], one.positions[0]],
            heights: [Vec3::Z, one.heights[1], one.heights[0]],
            uvs: [Vec2::from(fourth), uvs[1], uvs[0]],
        };
        for axis in [SliceAxis::U, SliceAxis::V] {
            let on_edge = |facet: &Facet, opposite: usize| {
                let ends = slice_line(facet.uvs, axis, position).into_iter().flatten();
                ends.filter(|end| end[opposite] == 0.0).map(|end| [0.0, 1.0].map(|w| facet.point(end, w))).next()
            };
            let (a, b) = (on_edge(&one, 2), on_edge(&other, 0));
            if let (Some(a), Some(b)) = (a, b) {
                prop_assert_eq!(a, b);
            }
        }
    }

    #[test]
    fn mirrored_and_turned_textures_are_cut_at_the_same_places(uvs in mapping(), position in -2.5..2.5f32) {
        let line = slice_line(uvs, SliceAxis::U, position);
        // Turned by a right angle, u is v.
        let turned = uvs.map(|uv| Vec2::new(-uv.y, uv.x));
        prop_assert_eq!(slice_line(turned, SliceAxis::V, position), line);
        let mirrored = uvs.map(|uv| Vec2::new(-uv.x, uv.y));
        let other = slice_line(mirrored, SliceAxis::U, -position);
        prop_assert_eq!(other.is_some(), line.is_some());
        for (a, b) in line.into_iter().flatten().zip(other.into_iter().flatten()) {
            prop_assert!(a.distance(b) < 1e-4 / uv_area(uvs));
        }
    }
}

#[test]
fn the_frame_is_the_derivative_of_the_place() {
    let facet = facet();
    let (b, w) = (Vec3::new(0.2, 0.5, 0.3), 0.4);
    let frame = TexelFrame::new(&facet, b, w);
    // Directions in the triangle, which change u and v.
    for step in [Vec3::new(-0.1, 0.1, 0.0), Vec3::new(-0.1, 0.0, 0.1)] {
        let uv = facet.uv(b + step) - facet.uv(b);
        let moved = facet.point(b + step, w) - facet.point(b, w);
        assert!(moved.distance(frame.edges[0] * uv.x + frame.edges[1] * uv.y) < 1e-6);
    }
    let up = facet.point(b, w + 0.1) - facet.point(b, w);
    assert!(up.distance(frame.edges[2] * 0.1) < 1e-6);
}

#[test]
fn slices_lie_across_their_normal_a_length_apart() {
    let frame = TexelFrame {
        edges: [
            Vec3::new(2.0, 0.0, 0.0),
            Vec3::new(1.0, 3.0, 0.0),
            Vec3::new(0.5, 0.0, -0.4),
        ],
    };
    for axis in SliceAxis::ALL {
        let (normal, length) = frame.normal_and_length(axis);
        for other in axis.in_plane() {
            assert!(normal.dot(frame.edges[other.index()]).abs() < 1e-6);
        }
        assert!((normal.dot(frame.edges[axis.index()]) - length).abs() < 1e-6 && length > 0.0);
    }
}

#[test]
fn normals_stay_across_surfaces_in_sheared_and_mirrored_frames() {
    let lengths = Vec3::new(1.0, 2.0, 0.5);
    // A plane through the volume, by two directions in metres of the box.
    let (s, t) = (Vec3::new(0.3, 0.1, 0.2), Vec3::new(-0.2, 0.4, 0.3));
    let normal = s.cross(t).normalize();
    for mirror in [1.0, -1.0] {
        let frame = TexelFrame {
            edges: [
                Vec3::new(mirror, 0.1, 0.0),
                Vec3::new(0.2, 1.5, 0.0),
                Vec3::new(0.3, -0.2, 0.7),
            ],
        };
        let place = |metres: Vec3| {
            let [u, v, w] = (metres / lengths).to_array();
            frame.edges[0] * u + frame.edges[1] * v + frame.edges[2] * w
        };
        let moved = frame.transform_normal(normal, lengths);
        assert!(moved.dot(place(s)).abs() < 1e-6 && moved.dot(place(t)).abs() < 1e-6);
        // What is outside stays outside.
        assert!(moved.dot(place(normal)) > 0.0);
    }
}

#[test]
fn facets_that_carry_no_texels_are_told_apart() {
    let with = |change: &dyn Fn(&mut Facet)| {
        let mut facet = facet();
        change(&mut facet);
        facet.check()
    };
    assert_eq!(with(&|_| ()), Ok(()));
    assert_eq!(
        with(&|f| f.positions[1].x = f32::NAN),
        Err(FacetFault::NotFinite)
    );
    assert_eq!(
        with(&|f| f.heights[0].z = f32::INFINITY),
        Err(FacetFault::NotFinite)
    );
    assert_eq!(
        with(&|f| f.positions[2] = f.positions[1] * 0.5),
        Err(FacetFault::NoArea)
    );
    assert_eq!(with(&|f| f.uvs[2] = f.uvs[1]), Err(FacetFault::NoUvArea));
    assert_eq!(
        with(&|f| f.heights[1] = Vec3::ZERO),
        Err(FacetFault::NoHeight)
    );
    assert_eq!(with(&|f| f.heights[1].z = -0.4), Err(FacetFault::Folded));
    // The tops of two vertices change places.
    let crossed = with(&|f| {
        f.heights = [
            Vec3::new(1.2, 0.0, 0.5),
            Vec3::new(-1.0, 0.0, 0.5),
            Vec3::new(0.0, 0.0, 0.5),
        ];
    });
    assert_eq!(crossed, Err(FacetFault::Crossed));
    // All meet in a point below the top, or pass each other there: the triangle at the top is a triangle again.
    let place =
        |f: &Facet, w: f32, top: [Vec3; 3]| [0, 1, 2].map(|i| (top[i] - f.positions[i]) / w);
    let apex = Vec3::new(0.4, 0.3, 0.5);
    for (w, expected) in [(0.9, Err(FacetFault::Crossed)), (1.1, Ok(()))] {
        let found = with(&|f| f.heights = place(f, w, [apex; 3]));
        assert_eq!(found, expected, "{w}");
    }
    let lifted = |f: &Facet, turns: f32| {
        let turn = Quat::from_rotation_z(turns * core::f32::consts::PI);
        f.positions.map(|at| apex + turn * (at - apex.with_z(0.0)))
    };
    for (turns, expected) in [(0.8, Ok(())), (1.0, Err(FacetFault::Crossed))] {
        let found = with(&|f| {
            f.positions = f.positions.map(|at| at.with_z(0.0));
            f.heights = place(f, 1.0, lifted(f, turns));
        });
        assert_eq!(found, expected, "{turns}");
    }
}

#[test]
fn wind_that_leads_a_height_vector_through_its_facet_is_found_in_mirrored_spaces_too() {
    let leaning = Facet {
        positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
        heights: [Vec3::new(0.6, 0.0, 0.3); 3],
        ..facet()
    };
    assert_eq!(leaning.check(), Ok(()));
    let bent = |facet: &Facet, wind: Vec3| {
        [0, 1, 2].map(|i| bend(facet.positions[i], facet.heights[i], wind, 0.1, 0.0))
    };
    // Blown from above, it goes through the surface.
    for (wind, expected) in [
        (Vec3::X, true),
        (Vec3::Z * 20.0, true),
        (Vec3::Z * -20.0, false),
    ] {
        assert_eq!(
            leaning.may_bend_to(bent(&leaning, wind)),
            expected,
            "{wind}"
        );
        let mirror = |at: Vec3| at * Vec3::new(1.0, 1.0, -1.0);
        let mirrored = Facet {
            positions: leaning.positions.map(mirror),
            heights: leaning.heights.map(mirror),
            ..leaning
        };
        assert_eq!(
            mirrored.may_bend_to(bent(&mirrored, mirror(wind))),
            expected,
            "{wind}"
        );
    }
    let crossed = leaning
        .positions
        .map(|at| Vec3::new(0.3 - 2.0 * at.x, 0.0, 1.0));
    assert!(!leaning.may_bend_to(crossed));
    assert!(!leaning.may_bend_to([Vec3::NAN; 3]));
}

#[test]
fn the_sphere_holds_the_whole_prism() {
    let facet = facet();
    let (centre, radius) = facet.bounds();
    for i in 0..200 {
        let (x, y, w) = (
            (i * 7 % 11) as f32 / 11.0,
            (i * 5 % 13) as f32 / 13.0,
            i as f32 / 199.0,
        );
        let (b1, b2) = if x + y > 1.0 {
            (1.0 - x, 1.0 - y)
        } else {
            (x, y)
        };
        let point = facet.point(Vec3::new(1.0 - b1 - b2, b1, b2), w);
        assert!(point.distance(centre) <= radius * (1.0 + 1e-6));
    }
}

#[test]
fn the_numbers_of_slices_stop_where_an_integer_does() {
    let uvs = [1e12, 2e12, -1e12].map(Vec2::splat);
    let range = slice_range(uvs, SliceAxis::U, 64, 1.0);
    assert_eq!(range, i32::MIN + 2..i32::MAX);
}

//! Triangles become solids.

use bevy::math::{DVec3, UVec3, Vec3};
use proptest::prelude::*;

use super::super::super::error::TexelError;
use super::super::close::{SIDES, close};
use super::super::draft::{Draft, Mark};
use super::super::inside::{mark_by_flood, mark_by_parity};
use super::super::rasterise::rasterise;
use super::super::spread::spread;
use super::*;

/// Slices cubes a unit long, from the origin on.
fn settings(size: UVec3, filling: Filling) -> ShapeSettings {
    ShapeSettings {
        bounds: Some([Vec3::ZERO, size.as_vec3()]),
        filling,
        ..ShapeSettings::new(size)
    }
}

fn built(shape: &Shape, settings: &ShapeSettings) -> Built {
    from_shape(shape, settings, &silent).unwrap()
}

#[test]
fn a_ball_is_filled_to_its_surface_and_no_further() {
    let (centre, radius, n) = (Vec3::new(15.7, 16.3, 16.1), 13.2, 24);
    let shape = ball(centre, radius, n);
    // The polygons lie inside the ball, by the sagitta of two steps of π/n.
    let sagitta = radius * (1.0 - (core::f32::consts::PI / n as f32).cos());
    for filling in [Filling::Flood, Filling::Parity] {
        let Built { volume, report } = built(&shape, &settings(UVec3::splat(32), filling));
        let within = |at: Vec3| at.distance(centre) - radius;
        let outer = agrees(&volume, |at| within(at).max(0.0));
        assert_eq!(outer, Ok(()), "{filling:?}");
        let inner = agrees(&volume, |at| (within(at) + sagitta).min(0.0));
        assert_eq!(inner, Ok(()), "{filling:?}");
        let silhouette = core::f32::consts::TAU * radius;
        // Where the top runs into the bottom, parity sees one surface: at most a column or two a voxel of the outline.
        let failed = if filling == Filling::Parity {
            silhouette * 2.0
        } else {
            0.0
        };
        assert!(report.failed_columns as f32 <= failed, "{filling:?}");
    }
}

#[test]
fn a_box_open_on_the_bottom_stands_on_the_surface() {
    let mut shape = cuboid(Vec3::new(4.3, 4.3, 0.0), Vec3::new(11.7, 11.7, 9.7));
    shape.triangles.drain(0..2);
    let Built { volume, .. } = built(&shape, &settings(UVec3::splat(16), Filling::Flood));
    assert!(volume.is_opaque(8, 8, 0) && volume.is_opaque(8, 8, 5));
    // 8 voxels a side, of which the outermost have the walls, and 10 high.
    assert_eq!(volume.opaque_voxels(), 8 * 8 * 10);
}

#[test]
fn a_tiling_sheet_of_ground_is_filled_downwards_and_meets_itself() {
    let height = |x: u32| if x % 16 == 8 { 6.0 } else { 3.0 };
    let mut shape = Shape::default();
    for y in [0, 16] {
        for x in [0, 8, 16] {
            shape
                .positions
                .push(Vec3::new(x as f32, y as f32, height(x)));
        }
    }
    shape.triangles = vec![[0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4]];
    let settings = ShapeSettings {
        topology: Topology::Tiling,
        ..settings(UVec3::new(16, 16, 8), Filling::Flood)
    };
    let Built { volume, report } = built(&shape, &settings);
    let below = agrees(&volume, |at| at.z - (6.0 - (at.x - 8.0).abs() * 3.0 / 8.0));
    assert_eq!(below, Ok(()));
    assert!(report.topology.tiles(), "{:?}", report.topology);
}

#[test]
fn what_reaches_over_a_side_comes_in_on_the_other() {
    let size = UVec3::splat(16);
    let settings = ShapeSettings {
        topology: Topology::Tiling,
        ..settings(size, Filling::Flood)
    };
    let over = built(
        &cuboid(Vec3::new(12.2, 3.2, 3.2), Vec3::new(18.7, 7.7, 7.7)),
        &settings,
    );
    let within = built(
        &cuboid(Vec3::new(2.2, 3.2, 3.2), Vec3::new(8.7, 7.7, 7.7)),
        &settings,
    );
    for (x, y, z) in (0..4096).map(|i| (i % 16, i / 16 % 16, i / 256)) {
        let moved = within.volume.is_opaque((x + 6) % 16, y, z);
        assert_eq!(over.volume.is_opaque(x, y, z), moved, "({x}, {y}, {z})");
    }
}

#[test]
fn parity_fails_where_flooding_does_not() {
    // A slab thinner than a slice hangs over a box: from above its two faces are one crossing.
    let mut shape = cuboid(Vec3::new(4.5, 4.5, 2.5), Vec3::new(11.5, 11.5, 6.5));
    let slab = cuboid(Vec3::new(2.5, 2.5, 10.2), Vec3::new(13.5, 13.5, 10.8));
    shape.triangles.extend(
        slab.triangles
            .iter()
            .map(|triangle| triangle.map(|i| i + 8)),
    );
    shape.positions.extend(slab.positions);
    let parity = built(&shape, &settings(UVec3::splat(16), Filling::Parity));
    assert!(parity.report.failed_columns > 0);
    assert!(
        parity.volume.is_opaque(8, 8, 8) && !parity.volume.is_opaque(8, 8, 4),
        "inside out"
    );
    let flood = built(&shape, &settings(UVec3::splat(16), Filling::Flood));
    assert!(!flood.volume.is_opaque(8, 8, 8) && flood.volume.is_opaque(8, 8, 4));
}

#[test]
fn foliage_is_left_unfilled_and_seen_edge_on() {
    // One upright leaf, which no ray from above meets.
    let shape = Shape {
        positions: vec![
            Vec3::new(3.0, 8.5, 1.0),
            Vec3::new(13.0, 8.5, 1.0),
            Vec3::new(8.0, 8.5, 15.0),
        ],
        triangles: vec![[0, 1, 2]],
        ..Shape::default()
    };
    let Built { volume, report } = built(&shape, &settings(UVec3::splat(16), Filling::None));
    assert_eq!(report.inside_voxels, 0);
    // Half of 10 by 14, and along the edges up to a voxel each row.
    let opaque = volume.opaque_voxels();
    assert!((70..=70 + 14).contains(&opaque), "{opaque}");
    assert!(
        (0..16).all(|x| (0..16).all(|z| !volume.is_opaque(x, 7, z) && !volume.is_opaque(x, 9, z)))
    );
}

#[test]
fn paint_colours_the_surface_and_spreads_inward() {
    let mut shape = cuboid(Vec3::splat(2.5), Vec3::splat(13.5));
    let paint = |r: f32, g: f32| Paint {
        color: bevy::math::Vec4::new(r, g, 0.0, 1.0),
        ..Paint::default()
    };
    shape.paints = vec![paint(1.0, 0.0), paint(0.0, 1.0)];
    // The top is red, all else is green.
    shape.paint_of = vec![1, 1, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1];
    let colours = |spreading| {
        let settings = ShapeSettings {
            spreading,
            ..settings(UVec3::splat(16), Filling::Flood)
        };
        let volume = built(&shape, &settings).volume;
        assert_eq!(volume.color(8, 8, 13), [255, 0, 0, 255]);
        assert_eq!(volume.normal(8, 8, 13).round(), Vec3::Z);
        assert_eq!(volume.color(2, 8, 8), [0, 255, 0, 255]);
        volume.color(8, 8, 12)
    };
    // One voxel below the top its red shows, unless colours keep to their slice.
    assert_eq!(colours(Spreading::Volume), [255, 0, 0, 255]);
    assert_eq!(colours(Spreading::Slice), [0, 255, 0, 255]);
}

/// A closed shape: some boxes and balls, which may overlap and lie anyhow to the voxels.
fn solids() -> impl Strategy<Value = Shape> {
    let solid = (
        any::<bool>(),
        prop::array::uniform3(3.0..10.0f32),
        prop::array::uniform3(0.3..4.9f32),
        3..7u32,
    );
    prop::collection::vec(solid, 1..4).prop_map(|solids| {
        let mut shape = Shape::default();
        for (is_ball, min, lengths, n) in solids {
            let (min, lengths) = (Vec3::from(min), Vec3::from(lengths));
            let solid = if is_ball {
                let radius = lengths.x.min(5.0) / 2.0;
                ball(min + radius, radius, n)
            } else {
                cuboid(min, min + lengths)
            };
            let first = shape.positions.len() as u32;
            shape.positions.extend(solid.positions);
            shape
                .triangles
                .extend(solid.triangles.iter().map(|t| t.map(|i| i + first)));
        }
        shape
    })
}

/// A draft of marks, 16³, isolated.
fn sliced(shape: &Shape, filling: Filling) -> Draft {
    let mut draft = Draft::new(UVec3::splat(16), Vec3::splat(16.0), Topology::Isolated).unwrap();
    rasterise(&mut draft, shape, filling, Vec3::ZERO, &silent);
    draft
}

/// Voxels next to another through a face, on the four sides or all six.
fn touches_empty(draft: &Draft, at: [u32; 3], steps: &[[i32; 3]]) -> bool {
    steps.iter().any(|&step| {
        let next = draft.beside(at, step).map(|index| draft.cells[index].mark);
        next.is_none_or(|mark| mark == Mark::Empty)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(48) })]

    #[test]
    fn contours_of_closed_shapes_are_closed(shape in solids()) {
        let mut draft = sliced(&shape, Filling::Flood);
        mark_by_flood(&mut draft);
        let layer = draft.layer();
        for (index, cell) in draft.cells.iter().enumerate() {
            let at = [index % 16, index / 16 % 16, index / layer].map(|at| at as u32);
            if cell.mark == Mark::Inside {
                prop_assert!(!touches_empty(&draft, at, &super::super::inside::FACES), "{at:?}");
            }
        }
        prop_assert_eq!(close(&mut draft), 0, "nothing is left to close");
    }

    #[test]
    fn closing_leaves_no_exposed_voxel_and_colours_no_empty_one(shape in solids()) {
        let mut draft = sliced(&shape, Filling::Parity);
        mark_by_parity(&mut draft);
        let before = draft.clone();
        close(&mut draft);
        let layer = draft.layer();
        for (index, (cell, before)) in draft.cells.iter().zip(&before.cells).enumerate() {
            let at = [index % 16, index / 16 % 16, index / layer].map(|at| at as u32);
            let is_exposed = cell.mark == Mark::Inside && touches_empty(&draft, at, &SIDES);
            prop_assert!(!is_exposed, "{at:?}");
            prop_assert_eq!(cell.mark == Mark::Empty, before.mark == Mark::Empty, "{:?}", at);
        }
        spread(&mut draft, Spreading::Volume, &silent);
        for (index, (cell, before)) in draft.cells.iter().zip(&before.cells).enumerate() {
            prop_assert_eq!(cell.mark == Mark::Empty, before.mark == Mark::Empty, "{}", index);
            prop_assert!(cell.mark != Mark::Inside, "{} has no colour", index);
        }
    }

    #[test]
    fn nothing_outside_a_shape_is_coloured(shape in solids()) {
        let size = UVec3::splat(16);
        let built = from_shape(&shape, &settings(size, Filling::Flood), &silent);
        // Specks may lie between all lines through centres.
        let Ok(Built { volume, .. }) = built else {
            prop_assert_eq!(built, Err(TexelError::Empty));
            return Ok(());
        };
        // Gaps that no voxel fits through are filled: what is as far as its diagonal from all solids is not in one.
        let diagonal = 3f64.sqrt();
        for (x, y, z) in (0..4096).map(|i| (i % 16, i / 16 % 16, i / 256)) {
            if volume.is_opaque(x, y, z) {
                let centre = UVec3::new(x, y, z).as_dvec3() + 0.5;
                let is_inside = winding_number(&shape, centre).abs() > 0.5;
                let distance = distance(&shape, centre);
                prop_assert!(is_inside || distance < diagonal, "{}: {} away", centre, distance);
            }
        }
    }

    #[test]
    fn flooding_finds_what_crossings_of_the_surface_say(shape in solids()) {
        let mut draft = sliced(&shape, Filling::Flood);
        mark_by_flood(&mut draft);
        for (x, y, z) in (0..4096u32).map(|i| (i % 16, i / 16 % 16, i / 256)) {
            let centre = UVec3::new(x, y, z).as_dvec3() + 0.5;
            let winding = winding_number(&shape, centre);
            let mark = draft.cells[draft.index(x, y, z)].mark;
            // Hollows between solids that touch may be filled, but no inside is ever outside.
            prop_assert!(mark != Mark::Empty || winding.abs() < 0.5, "({x}, {y}, {z}): {winding}");
        }
    }
}

/// How often the surface winds round a point: the sum of the solid angles of its triangles over 4π (A. van Oosterom and
/// J. Strackee, *The Solid Angle of a Plane Triangle*, 1983).
fn winding_number(shape: &Shape, at: DVec3) -> f64 {
    let solid_angle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| shape.positions[i as usize].as_dvec3() - at);
        let (x, y, z) = (a.length(), b.length(), c.length());
        let volume = a.dot(b.cross(c));
        2.0 * volume.atan2(x * y * z + a.dot(b) * z + a.dot(c) * y + b.dot(c) * x)
    };
    shape.triangles.iter().map(solid_angle).sum::<f64>() / (4.0 * core::f64::consts::PI)
}

/// How far a place is from the surface.
fn distance(shape: &Shape, at: DVec3) -> f64 {
    let to_triangle = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| shape.positions[i as usize].as_dvec3());
        let normal = (b - a).cross(c - a);
        let sides = [(a, b), (b, c), (c, a)];
        let is_over =
            |&(from, to): &(DVec3, DVec3)| (to - from).cross(at - from).dot(normal) >= 0.0;
        if normal != DVec3::ZERO && sides.iter().all(is_over) {
            return (at - a).dot(normal.normalize()).abs();
        }
        let to_side = |(from, to): (DVec3, DVec3)| {
            let along = to - from;
            let share = (at - from).dot(along) / along.length_squared().max(1e-30);
            at.distance(from + along * share.clamp(0.0, 1.0))
        };
        sides.map(to_side).into_iter().fold(f64::INFINITY, f64::min)
    };
    let distances = shape.triangles.iter().map(to_triangle);
    distances.fold(f64::INFINITY, f64::min)
}

use glam::DVec3;

use super::super::{ReferencePart, SegmentBody};
use super::*;

const ROUND: ReferenceSettings = ReferenceSettings {
    join: ReferenceJoin::Mitre,
    ends: ReferenceEnds::Round,
};
const FLAT: ReferenceSettings = ReferenceSettings {
    join: ReferenceJoin::Mitre,
    ends: ReferenceEnds::Flat,
};

/// Distance at which a ray from (x, y, 0) along `dir` hits, and the part.
fn hit(scene: &ReferenceScene, x: f64, y: f64, dir: DVec3) -> Option<(f64, ReferencePart)> {
    let hit = scene.cast(DVec3::new(x, y, 0.0), dir, 0.0)?;
    Some(((hit.t * 1e12).round() / 1e12, hit.part))
}

#[test]
fn a_capsule_and_a_cylinder() {
    for (settings, along) in [(ROUND, 4.0), (FLAT, 5.0)] {
        let scene = straight(&[(0.0, 1.0), (3.0, 1.0)], settings);
        assert_eq!(
            hit(&scene, -5.0, 0.0, DVec3::X),
            Some((along, ReferencePart::StartCap))
        );
        assert_eq!(
            hit(&scene, 8.0, 0.0, -DVec3::X),
            Some((along, ReferencePart::EndCap))
        );
        assert_eq!(
            hit(&scene, 1.0, 5.0, -DVec3::Y),
            Some((4.0, ReferencePart::Cone))
        );
        assert_eq!(hit(&scene, 1.0, 1.001, DVec3::X), None);
        assert_eq!(hit(&scene, 1.0, 5.0, DVec3::Y), None);
        // From inside, the surface ahead.
        assert_eq!(
            hit(&scene, 1.0, 0.0, DVec3::Y),
            Some((1.0, ReferencePart::Cone))
        );
    }
}

#[test]
fn t_is_in_units_of_the_direction_and_counts_from_t_min() {
    let scene = straight(&[(0.0, 1.0), (3.0, 1.0)], ROUND);
    let origin = DVec3::new(1.0, 5.0, 0.0);
    let first = scene.cast(origin, -2.0 * DVec3::Y, 0.0).unwrap();
    assert!((first.t - 2.0).abs() < 1e-14);
    assert!(first.surface_normal.distance(DVec3::Y) < 1e-14);
    let second = scene.cast(origin, -2.0 * DVec3::Y, 2.5).unwrap();
    assert!((second.t - 3.0).abs() < 1e-14);
    // The normal stays the outer one when hit from inside.
    assert!(second.surface_normal.distance(-DVec3::Y) < 1e-14);
    assert_eq!(scene.cast(origin, -2.0 * DVec3::Y, 3.5), None);
    assert_eq!(scene.cast(origin, DVec3::ZERO, 0.0), None);
}

#[test]
fn a_flat_end_is_as_wide_as_the_cone_there() {
    // s = 1/2: the cone's radius at the start is 2/c, at the end 1/c.
    let scene = straight(&[(0.0, 2.0), (2.0, 1.0)], FLAT);
    let c = 0.75f64.sqrt();
    for (x, dir, radius) in [(-9.0, DVec3::X, 2.0 / c), (9.0, -DVec3::X, 1.0 / c)] {
        let inside = hit(&scene, x, radius * 0.999_999, dir);
        assert_ne!(inside.unwrap().1, ReferencePart::Cone);
    }
    assert_eq!(hit(&scene, -9.0, 2.0 / c * 1.000_001, DVec3::X), None);
    // Seen from the thin end, the cone itself lies round the disc.
    let beside = hit(&scene, 9.0, 1.0 / c * 1.000_001, -DVec3::X);
    assert_eq!(beside.unwrap().1, ReferencePart::Cone);
}

#[test]
fn the_mirrored_nappe_is_never_hit() {
    // A tip: beyond it the same quadric goes on.
    let scene = straight(&[(0.0, 1.0), (4.0, 0.0)], ROUND);
    assert_eq!(hit(&scene, 5.0, 3.0, -DVec3::Y), None);
    assert_eq!(hit(&scene, 9.0, 0.0, DVec3::Y), None);
    // And through it to the proper one.
    let far = scene
        .cast(DVec3::new(8.0, 0.5, 0.0), -DVec3::X, 0.0)
        .unwrap();
    assert_eq!(far.part, ReferencePart::Cone);
}

#[test]
fn a_sphere_that_contains_the_other_is_drawn_once() {
    // The root's sphere is larger, then a leaf's.
    let shrinking = straight(&[(0.0, 2.0), (1.0, 0.5)], FLAT);
    assert_eq!(
        hit(&shrinking, 9.0, 0.0, -DVec3::X),
        Some((7.0, ReferencePart::StartCap))
    );
    let growing = straight(&[(0.0, 0.5), (1.0, 2.0)], FLAT);
    assert_eq!(
        hit(&growing, -9.0, 0.0, DVec3::X),
        Some((8.0, ReferencePart::EndCap))
    );
    let no_length = straight(&[(0.0, 1.0), (0.0, 1.0)], FLAT);
    assert_eq!(
        hit(&no_length, -9.0, 0.0, DVec3::X),
        Some((8.0, ReferencePart::EndCap))
    );
    // Inside a chain the segment that ends at the larger sphere draws it.
    let chain = straight(&[(0.0, 1.0), (5.0, 2.0), (6.0, 0.5), (12.0, 0.4)], ROUND);
    assert_eq!(chain.segments()[1].body, SegmentBody::Hidden);
    assert_eq!(
        hit(&chain, 5.5, 9.0, -DVec3::Y).map(|(_, part)| part),
        Some(ReferencePart::EndCap)
    );
    assert_eq!(
        hit(&chain, 10.0, 9.0, -DVec3::Y).map(|(_, part)| part),
        Some(ReferencePart::Cone)
    );
}

#[test]
fn the_papers_circles_are_where_the_joints_are() {
    for join in [ReferenceJoin::Paper, ReferenceJoin::PaperIterated] {
        let round = straight(
            &[(0.0, 2.0), (4.0, 1.0), (6.0, 1.0)],
            settings(join, ReferenceEnds::Round),
        );
        assert_eq!(
            hit(&round, 1e-9, 9.0, -DVec3::Y).map(|(t, _)| (t - 7.0).abs() < 1e-8),
            Some(true)
        );
        assert_eq!(
            hit(&round, 5.0, 9.0, -DVec3::Y),
            Some((8.0, ReferencePart::Cone))
        );
        assert_eq!(
            hit(&round, 9.0, 0.0, -DVec3::X),
            Some((2.0, ReferencePart::EndCap))
        );
        assert_eq!(
            hit(&round, -9.0, 0.0, DVec3::X),
            Some((7.0, ReferencePart::StartCap))
        );
    }
}

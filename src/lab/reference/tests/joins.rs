use glam::DVec3;

use super::super::{Cap, EndKind, ReferenceHit, Segment, SegmentBody};
use super::*;

fn ends(segment: &Segment) -> Option<(EndKind, EndKind)> {
    match segment.body {
        SegmentBody::Frustum { start, end, .. } => Some((start.kind, end.kind)),
        _ => None,
    }
}

#[test]
fn a_chain_joins_alike_from_either_end() {
    let mut rng = SplitMix64::new(20);
    let growth = Growth {
        joints: 5,
        bend: 175.0,
        taper: 4.0,
        aspect: (0.3, 10.0),
        branches: 0,
        folded: 0.05,
    };
    let (mut mitres, mut rounds) = (0, 0);
    for _ in 0..5000 {
        let forward = growth.grow(&mut rng);
        let backward: Vec<_> = forward
            .iter()
            .rev()
            .enumerate()
            .map(|(i, j)| joint(j.position, j.radius, i.checked_sub(1)))
            .collect();
        for flat in [ReferenceEnds::Round, ReferenceEnds::Flat] {
            let [there, back] = [&forward, &backward]
                .map(|joints| ReferenceScene::new(joints, settings(ReferenceJoin::Mitre, flat)));
            for j in 1..4 {
                // Joint j of the one is joint 4 − j of the other.
                let first = ends(&there.segments()[j - 1]);
                let reversed = ends(&back.segments()[4 - j]);
                let kinds = [first.map(|(_, end)| end), reversed.map(|(start, _)| start)];
                if let [Some(end), Some(start)] = kinds {
                    assert_eq!(end, start);
                    match end {
                        EndKind::Mitre => mitres += 1,
                        _ => rounds += 1,
                    }
                }
            }
        }
    }
    assert!(mitres > 5000 && rounds > 5000, "{mitres} {rounds}");
}

#[test]
fn both_segments_of_a_joint_agree_on_how_they_meet() {
    let mut rng = SplitMix64::new(21);
    let growth = Growth {
        joints: 8,
        bend: 150.0,
        taper: 3.0,
        aspect: (0.5, 8.0),
        branches: 3,
        folded: 0.05,
    };
    for _ in 0..1000 {
        let joints = growth.grow(&mut rng);
        let scene = ReferenceScene::new(&joints, ReferenceSettings::default());
        for segment in scene.segments() {
            let SegmentBody::Frustum { start, .. } = segment.body else {
                continue;
            };
            let before = scene.segments().iter().find(|s| s.joint == segment.parent);
            let end = before.and_then(|s| match s.body {
                SegmentBody::Frustum { end, .. } => Some(end),
                _ => None,
            });
            match (start.kind, end) {
                (EndKind::Mitre, end) => assert_eq!(end.unwrap().plane, start.plane.flipped()),
                (EndKind::Round, Some(end)) => assert_eq!(end.kind, EndKind::Round),
                _ => {}
            }
        }
    }
}

/// A fan of children round the end of a limb along x.
fn fan(children: &[(DVec3, f64)]) -> ReferenceScene {
    let mut joints = vec![
        joint(DVec3::ZERO, 1.0, None),
        joint(10.0 * DVec3::X, 1.0, Some(0)),
    ];
    for &(axis, radius) in children {
        joints.push(joint(10.0 * DVec3::X + 8.0 * axis, radius, Some(1)));
    }
    ReferenceScene::new(&joints, ReferenceSettings::default())
}

fn continues(scene: &ReferenceScene) -> usize {
    let is_branch = |s: &&Segment| s.parent == 1 && ends(s).unwrap().0 != EndKind::Branch;
    scene.segments().iter().find(is_branch).unwrap().joint
}

#[test]
fn the_best_aligned_child_continues_then_the_thickest_then_the_first() {
    let (ahead, aside) = (DVec3::X, DVec3::Y);
    let nearly = DVec3::new(1.0, 1e-4, 0.0).normalize();
    let slightly = DVec3::new(1.0, 0.1, 0.0).normalize();
    assert_eq!(continues(&fan(&[(aside, 1.0), (ahead, 0.2)])), 3);
    assert_eq!(continues(&fan(&[(ahead, 0.2), (slightly, 1.0)])), 2);
    // cos 1e-4 is within 1e-6 of 1.
    assert_eq!(continues(&fan(&[(ahead, 0.2), (nearly, 0.5)])), 3);
    assert_eq!(continues(&fan(&[(nearly, 0.5), (ahead, 0.5)])), 2);
}

#[test]
fn a_thick_branch_starts_no_thicker_than_its_limb() {
    let scene = fan(&[(DVec3::X, 1.0), (DVec3::Y, 3.0)]);
    let SegmentBody::Frustum { cone, start, .. } = scene.segments()[2].body else {
        panic!("no cone")
    };
    // The contact circle of a sphere of radius 1.
    assert!((cone.radius * cone.cosine() - 1.0).abs() < 1e-14);
    assert_eq!(start.kind, EndKind::Branch);
    assert_eq!(start.cap, Cap::Open);
}

#[test]
fn a_mitre_that_reaches_past_its_segment_is_round() {
    // Two cylinders of radius 1 at a right angle reach back tan 45° = 1.
    for (length, kind) in [(1.001, EndKind::Mitre), (0.999, EndKind::Round)] {
        let joints = [
            joint(DVec3::ZERO, 1.0, None),
            joint(length * DVec3::X, 1.0, Some(0)),
            joint(length * DVec3::X + 5.0 * DVec3::Y, 1.0, Some(1)),
        ];
        let scene = ReferenceScene::new(&joints, ReferenceSettings::default());
        assert_eq!(ends(&scene.segments()[0]).unwrap().1, kind);
        assert_eq!(ends(&scene.segments()[1]).unwrap().0, kind);
    }
}

#[test]
fn a_fold_is_round() {
    let joints = [
        joint(DVec3::ZERO, 1.0, None),
        joint(9.0 * DVec3::X, 1.0, Some(0)),
        joint(DVec3::ZERO, 1.0, Some(1)),
    ];
    let scene = ReferenceScene::new(&joints, ReferenceSettings::default());
    assert_eq!(ends(&scene.segments()[0]).unwrap().1, EndKind::Round);
    let hit: Option<ReferenceHit> = scene.cast(20.0 * DVec3::X, -DVec3::X, 0.0);
    assert!((hit.unwrap().t - 10.0).abs() < 1e-14);
}

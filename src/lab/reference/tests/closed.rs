//! Is the surface closed? From outside, every ray has to meet an outer side first.

use super::super::{EndKind, ReferenceGuards, SegmentBody};
use super::*;

const GUARDED: ReferenceGuards = ReferenceGuards {
    fallback: true,
    spike: 4.0,
    flat: true,
};

const CHAIN: Growth = Growth {
    joints: 6,
    bend: 170.0,
    taper: 3.0,
    aspect: (0.3, 10.0),
    branches: 0,
    folded: 0.02,
};

/// Refuses nothing beyond the mitre limit itself.
const LITERAL: ReferenceGuards = ReferenceGuards {
    fallback: false,
    spike: f64::INFINITY,
    flat: false,
};

/// How many of `rays` from outside see an inner side first, by more than grazing.
fn leaks(
    rng: &mut SplitMix64,
    joints: &[ReferenceJoint],
    scene: &ReferenceScene,
    rays: usize,
) -> usize {
    let sees_inside = |_: &usize| {
        let (origin, dir, _) = ray_at(rng, joints, 1.3);
        let hit = scene.cast(origin, dir, 0.0);
        hit.is_some_and(|hit| hit.surface_normal.dot(dir) > 1e-2)
    };
    (0..rays).filter(sees_inside).count()
}

/// Leaking skeletons out of `count`.
fn leaking(
    seed: u64,
    growth: Growth,
    settings: ReferenceSettings,
    guards: ReferenceGuards,
    count: usize,
) -> usize {
    let mut rng = SplitMix64::new(seed);
    let leaks_somewhere = |_: &usize| {
        let joints = growth.grow(&mut rng);
        let scene = ReferenceScene::guarded(&joints, settings, guards);
        leaks(&mut rng, &joints, &scene, 60) > 0
    };
    (0..count).filter(leaks_somewhere).count()
}

#[test]
fn rays_at_the_axis_hit_before_they_reach_it() {
    let mut rng = SplitMix64::new(40);
    for join in [ReferenceJoin::Mitre, ReferenceJoin::Round] {
        for ends in [ReferenceEnds::Round, ReferenceEnds::Flat] {
            for _ in 0..1000 {
                let joints = CHAIN.grow(&mut rng);
                let scene = ReferenceScene::guarded(&joints, settings(join, ends), GUARDED);
                for _ in 0..20 {
                    let (origin, dir, target) = ray_at(&mut rng, &joints, 0.0);
                    let hit = scene.cast(origin, dir, 0.0).expect("a hole");
                    // A target on a flat end's disc is itself the hit.
                    let limit = (target - origin).length() * (1.0 + 1e-12);
                    assert!(hit.t <= limit, "{join:?} {ends:?} {hit:?} {joints:#?}");
                }
            }
        }
    }
}

#[test]
fn limbs_and_branches_with_round_ends_are_closed() {
    for (branches, seed) in [(0, 41), (4, 42)] {
        let growth = Growth { branches, ..CHAIN };
        for join in [ReferenceJoin::Mitre, ReferenceJoin::Round] {
            let settings = settings(join, ReferenceEnds::Round);
            assert_eq!(leaking(seed, growth, settings, GUARDED, 1500), 0);
        }
    }
}

#[test]
fn flat_ends_are_closed_where_the_guard_allows_them() {
    for (branches, seed) in [(0, 43), (4, 44)] {
        let growth = Growth { branches, ..CHAIN };
        for join in [ReferenceJoin::Mitre, ReferenceJoin::Round] {
            let settings = settings(join, ReferenceEnds::Flat);
            assert_eq!(leaking(seed, growth, settings, GUARDED, 1500), 0);
            let open = leaking(seed, growth, settings, LITERAL, 1500);
            assert!(open > 0, "the guard has nothing to do");
        }
    }
}

/// Ranges of y of the cuts at both ends of every cone: how far does the start's reach past the
/// end's?
fn overlaps(scene: &ReferenceScene) -> bool {
    scene.segments().iter().any(|segment| match segment.body {
        SegmentBody::Frustum { cone, start, end } => {
            let range = |plane| cone.cut_range(plane).expect("an ellipse");
            range(&start.plane).1 > range(&end.plane).0
        }
        _ => false,
    })
}

#[test]
fn a_refused_mitre_must_not_cut_the_one_that_stands() {
    // The second segment widens (s ≈ −0.8) and agrees to a mitre at both of its ends. The third
    // refuses; the contact circle at joint 2 then lies 0.085 from joint 1, across its mitre.
    let joints = [
        joint(DVec3::ZERO, 1.0, None),
        joint(DVec3::new(-0.610662, -0.292462, -1.025688), 0.4098, Some(0)),
        joint(DVec3::new(-0.191887, -0.694316, -2.055772), 1.3623, Some(1)),
        joint(DVec3::new(0.141136, -1.112201, -2.303480), 0.8507, Some(2)),
    ];
    let settings = ReferenceSettings::default();
    let literal = ReferenceScene::guarded(&joints, settings, LITERAL);
    assert!(overlaps(&literal));
    let mut rng = SplitMix64::new(45);
    let holes = leaks(&mut rng, &joints, &literal, 100_000);
    assert!(holes > 0);
    let guarded = ReferenceScene::guarded(&joints, settings, GUARDED);
    assert!(!overlaps(&guarded));
    assert_eq!(leaks(&mut rng, &joints, &guarded, 100_000), 0);
}

#[test]
fn guarded_cuts_leave_a_whole_ring_of_every_cone() {
    let mut rng = SplitMix64::new(46);
    let growth = Growth { joints: 4, ..CHAIN };
    let (mut literal, mut guarded) = (0, 0);
    for _ in 0..200_000 {
        let joints = growth.grow(&mut rng);
        let settings = ReferenceSettings::default();
        literal += usize::from(overlaps(&ReferenceScene::guarded(
            &joints, settings, LITERAL,
        )));
        let scene = ReferenceScene::guarded(&joints, settings, GUARDED);
        guarded += usize::from(overlaps(&scene));
    }
    assert_eq!(guarded, 0);
    assert!(literal > 0, "the guard has nothing to do");
}

#[test]
fn without_a_guard_a_mitre_may_reach_far_past_its_joint() {
    // Both cones widen towards the joint by 30°; with an ellipse up to a bend of 120°.
    let half = 119f64.to_radians() / 2.0;
    let arm = |sign: f64| 6.0 * DVec3::new(sign * half.cos(), half.sin(), 0.0);
    let joints = [
        joint(arm(-1.0), 1.0, None),
        joint(DVec3::ZERO, 4.0, Some(0)),
        joint(arm(1.0), 1.0, Some(1)),
    ];
    let past_joint = |guards: ReferenceGuards| {
        let scene = ReferenceScene::guarded(&joints, ReferenceSettings::default(), guards);
        match scene.segments()[0].body {
            SegmentBody::Frustum { cone, end, .. } => {
                let reach = cone.cut_range(&end.plane).unwrap().1 - cone.length;
                (end.kind, reach / 4.0)
            }
            _ => panic!("no cone"),
        }
    };
    let (kind, radii) = past_joint(LITERAL);
    assert!(kind == EndKind::Mitre && radii > 50.0, "{kind:?} {radii}");
    assert_eq!(past_joint(GUARDED).0, EndKind::Round);
}

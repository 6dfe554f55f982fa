use glam::DVec3;

use super::super::{Cap, ReferencePart, Segment, SegmentBody};
use super::*;

/// Anything that a plant, or a broken file, may hold.
const WILD: Growth = Growth {
    joints: 7,
    bend: 180.0,
    taper: 8.0,
    aspect: (0.2, 50.0),
    branches: 5,
    folded: 0.05,
};

const VARIANTS: [ReferenceJoin; 4] = [
    ReferenceJoin::Mitre,
    ReferenceJoin::Round,
    ReferenceJoin::Paper,
    ReferenceJoin::PaperIterated,
];

/// How far `p` is from being where its hit says: (off the surface, beyond a plane).
fn residuals(segment: &Segment, part: ReferencePart, p: DVec3) -> (f64, f64) {
    match segment.body {
        SegmentBody::Frustum { cone, start, end } => match part {
            ReferencePart::Cone => (
                cone.residual(p).abs(),
                start.plane.distance(p).max(end.plane.distance(p)),
            ),
            part => {
                let end = if part == ReferencePart::StartCap {
                    start
                } else {
                    end
                };
                let from_center = p.distance(end.plane.point);
                match end.cap {
                    Cap::Sphere(radius) => ((from_center - radius).abs(), -end.plane.distance(p)),
                    Cap::Disc(radius) => (end.plane.distance(p).abs(), from_center - radius),
                    Cap::Open => panic!("hit a cap where there is none"),
                }
            }
        },
        SegmentBody::Sphere { center, radius, .. } => ((p.distance(center) - radius).abs(), 0.0),
        SegmentBody::Hidden => panic!("hit a hidden segment"),
    }
}

#[test]
fn every_hit_is_on_its_surface_and_between_its_planes() {
    let mut rng = SplitMix64::new(10);
    for join in VARIANTS {
        for ends in [ReferenceEnds::Round, ReferenceEnds::Flat] {
            let mut hits = 0;
            for _ in 0..300 {
                let joints = WILD.grow(&mut rng);
                let scene = ReferenceScene::new(&joints, settings(join, ends));
                for _ in 0..50 {
                    let (origin, dir, _) = ray_at(&mut rng, &joints, 1.2);
                    let Some(hit) = scene.cast(origin, dir, 0.0) else {
                        continue;
                    };
                    hits += 1;
                    let segment = scene
                        .segments()
                        .iter()
                        .find(|s| s.joint == hit.segment)
                        .unwrap();
                    let (off, beyond) = residuals(segment, hit.part, hit.position);
                    // A few roundings at the distances involved, which are the eye's at most.
                    let scale = origin.distance(hit.position) + hit.position.length();
                    assert!(off < 1e-12 * scale, "{join:?} {ends:?} {off} {hit:?}");
                    assert!(beyond < 1e-12 * scale, "{join:?} {ends:?} {beyond} {hit:?}");
                    assert!((hit.surface_normal.length() - 1.0).abs() < 1e-9);
                    assert!((origin + hit.t * dir).distance(hit.position) < 1e-12 * scale);
                }
            }
            assert!(hits > 5000, "{hits}");
        }
    }
}

#[test]
fn the_tree_of_boxes_loses_no_hit() {
    let mut rng = SplitMix64::new(11);
    for join in VARIANTS {
        for _ in 0..20 {
            let joints = Growth {
                joints: 40,
                branches: 20,
                ..WILD
            }
            .grow(&mut rng);
            let scene = ReferenceScene::new(&joints, settings(join, ReferenceEnds::Round));
            let all = scene.without_tree();
            for _ in 0..200 {
                let (origin, dir, _) = ray_at(&mut rng, &joints, 2.0);
                let (fast, slow) = (scene.cast(origin, dir, 0.0), all.cast(origin, dir, 0.0));
                assert_eq!(fast.map(|hit| hit.t), slow.map(|hit| hit.t));
            }
        }
    }
}

#[test]
fn a_far_eye_sees_the_same_point() {
    let mut rng = SplitMix64::new(12);
    let growth = Growth {
        taper: 2.0,
        aspect: (2.0, 20.0),
        ..WILD
    };
    let mut compared = 0;
    for _ in 0..200 {
        let joints = growth.grow(&mut rng);
        let scene = ReferenceScene::new(&joints, ReferenceSettings::default());
        for _ in 0..20 {
            let (origin, dir, target) = ray_at(&mut rng, &joints, 0.5);
            let near = scene.cast(origin, dir, 0.0);
            let far = scene.cast(target - 1e6 * dir, 1e3 * dir, 0.0);
            if let (Some(near), Some(far)) = (near, far) {
                let facing = near.surface_normal.dot(dir).abs();
                // The far origin is rounded by 1e6 · 2⁻⁵³ ≈ 1e-10, and t by as much; a slope of
                // `facing` stretches that.
                let apart = near.position.distance(far.position);
                if facing > 0.01 && near.segment == far.segment {
                    assert!(apart < 1e-9 / facing, "{apart} {facing}");
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 3000);
}

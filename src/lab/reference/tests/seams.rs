use super::super::{EndKind, SegmentBody, cut_curve, seam_gap};
use super::*;

/// Two axes at a bend in degrees.
fn bent(degrees: f64) -> [DVec3; 2] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [DVec3::X, DVec3::new(cos, sin, 0.0)]
}

/// The gap where every segment thins by `taper` and is four joint radii long.
fn gap(degrees: f64, taper: f64, join: ReferenceJoin) -> f64 {
    seam_gap(bent(degrees), [4.0; 2], [taper, 1.0, 1.0 / taper], join)
}

#[test]
fn mitre_points_of_one_cone_lie_on_the_other() {
    let mut rng = SplitMix64::new(50);
    let growth = Growth {
        joints: 3,
        bend: 175.0,
        taper: 8.0,
        aspect: (1.0, 20.0),
        branches: 0,
        folded: 0.0,
    };
    let (mut mitres, mut largest) = (0, 0f64);
    for _ in 0..20_000 {
        let joints = growth.grow(&mut rng);
        let scene = ReferenceScene::new(&joints, ReferenceSettings::default());
        let bodies = [scene.segments()[0].body, scene.segments()[1].body];
        let [
            SegmentBody::Frustum { cone, end, .. },
            SegmentBody::Frustum { cone: next, .. },
        ] = bodies
        else {
            continue;
        };
        if end.kind != EndKind::Mitre {
            continue;
        }
        mitres += 1;
        for p in cut_curve(&cone, &end.plane, 64) {
            // In units of the distances that the rounding happens at.
            let scale = p.distance(cone.base).max(p.distance(next.tip()));
            largest = largest.max(next.residual(p).abs() / scale);
        }
    }
    println!("largest residual of {mitres} mitres: {largest:.1e}");
    assert!(mitres > 5000);
    assert!(largest < 1e-12, "{largest}");
}

#[test]
fn only_the_mitre_closes_at_every_bend_and_taper() {
    println!("bend,taper,mitre,paper,iterated");
    for degrees in [10.0, 30.0, 60.0, 90.0] {
        for taper in [1.0, 2.0, 4.0] {
            let [mitre, paper, iterated] = [
                ReferenceJoin::Mitre,
                ReferenceJoin::Paper,
                ReferenceJoin::PaperIterated,
            ]
            .map(|join| gap(degrees, taper, join));
            println!("{degrees},{taper},{mitre:.1e},{paper:.5},{iterated:.1e}");
            assert!(mitre < 1e-12, "{degrees} {taper} {mitre}");
            // Two cylinders of one radius need no fitting: the paper's plane is the mitre's.
            assert!((paper < 1e-12) == (taper == 1.0));
        }
    }
}

#[test]
fn a_fitted_cone_touches_the_sphere_that_its_parent_touches() {
    // Two cones with crossing axes meet in a plane curve only if they touch one sphere about the
    // point of crossing. So where the paper's iteration ends, it has found the mitre.
    for degrees in [10.0, 30.0, 60.0] {
        for taper in [1.0, 1.2, 2.0] {
            let [first, second] = bent(degrees);
            let joints = [
                joint(-4.0 * first, taper, None),
                joint(DVec3::ZERO, 1.0, Some(0)),
                joint(4.0 * second, 1.0 / taper, Some(1)),
            ];
            let iterated = settings(ReferenceJoin::PaperIterated, ReferenceEnds::Round);
            let scene = ReferenceScene::new(&joints, iterated);
            let spheres = [0, 1].map(|i| match scene.segments()[i].body {
                SegmentBody::Frustum { cone, .. } => {
                    cone.cosine() * cone.radius_at(cone.length * (1 - i) as f64)
                }
                _ => panic!("no cone"),
            });
            println!("{degrees} {taper} {spheres:?}");
            assert!((spheres[0] - spheres[1]).abs() < 1e-8);
        }
    }
}

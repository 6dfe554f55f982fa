use glam::DVec3;

use super::super::{sphere_trace, swept_sphere_distance};
use super::*;

/// Everything that `Round` promises to draw.
const WILD: Growth = Growth {
    joints: 5,
    bend: 180.0,
    taper: 8.0,
    aspect: (0.02, 5.0),
    branches: 3,
    folded: 0.1,
};

const ROUND: ReferenceSettings = ReferenceSettings {
    join: ReferenceJoin::Round,
    ends: ReferenceEnds::Round,
};

fn normal(joints: &[ReferenceJoint], p: DVec3, step: f64) -> DVec3 {
    DVec3::AXES
        .map(|axis| {
            let there = |sign: f64| swept_sphere_distance(joints, p + sign * step * axis);
            axis * (there(1.0) - there(-1.0))
        })
        .into_iter()
        .sum::<DVec3>()
        .normalize_or_zero()
}

#[test]
fn round_joins_are_the_union_of_swept_spheres() {
    let mut rng = SplitMix64::new(30);
    let (mut both, mut neither, mut grazing) = (0, 0, 0);
    for _ in 0..600 {
        let joints = WILD.grow(&mut rng);
        let scene = ReferenceScene::new(&joints, ROUND);
        for _ in 0..30 {
            let (origin, dir, _) = ray_at(&mut rng, &joints, 1.3);
            let cast = scene.cast(origin, dir, 0.0);
            let traced = sphere_trace(&joints, origin, dir, 0.0);
            match (cast, traced) {
                (None, None) => neither += 1,
                (Some(hit), Some(t)) if (hit.t - t).abs() <= 1e-6 * t => {
                    both += 1;
                    let off = swept_sphere_distance(&joints, hit.position);
                    assert!(off.abs() < 1e-9 * t, "{off}");
                }
                // Sphere tracing stops short of a surface that the ray grazes.
                (hit, Some(t)) if hit.is_none_or(|hit| hit.t > t) => {
                    let facing = normal(&joints, origin + t * dir, 1e-6 * t).dot(dir);
                    assert!(facing.abs() < 1e-3, "{hit:?} {t} {facing}\n{joints:#?}");
                    grazing += 1;
                }
                _ => panic!("{cast:?} {traced:?} {joints:#?}"),
            }
        }
    }
    assert!(both > 10_000 && neither > 100, "{both} {neither}");
    assert!(grazing < 20, "{grazing}");
}

#[test]
fn the_distance_is_the_least_over_all_spheres_of_the_sweep() {
    let mut rng = SplitMix64::new(31);
    for _ in 0..2000 {
        let joints = Growth {
            joints: 2,
            branches: 0,
            ..WILD
        }
        .grow(&mut rng);
        let (a, b) = (joints[0], joints[1]);
        let p = rng.direction() * rng.log_range(0.1, 10.0);
        let closed = swept_sphere_distance(&joints, p);
        let sampled = (0..=4000)
            .map(|i| {
                let h = f64::from(i) / 4000.0;
                p.distance(a.position.lerp(b.position, h)) - (a.radius + h * (b.radius - a.radius))
            })
            .fold(f64::INFINITY, f64::min);
        // Sampling misses the least by half a step along the axis, at most.
        let step = a.position.distance(b.position) / 4000.0;
        assert!(closed <= sampled + 1e-12 && sampled <= closed + step + 1e-12);
    }
}

use super::super::Cone;
use super::super::cone::CutPlane;
use super::SplitMix64;

/// A cone on a random axis, by its half-angle's sine.
fn random_cone(rng: &mut SplitMix64) -> Cone {
    let s: f64 = rng.range(-0.95, 0.95);
    let length = rng.log_range(0.1, 10.0);
    // One sphere given, the other one follows from s, and must not vanish.
    let start = rng.log_range(0.1, 10.0).max(1.01 * s * length);
    Cone::tangent(
        rng.direction() * 3.0,
        rng.direction(),
        length,
        start,
        start - s * length,
    )
}

#[test]
fn a_tangent_cone_touches_both_spheres_on_circles() {
    let mut rng = SplitMix64::new(1);
    for _ in 0..1000 {
        let cone = random_cone(&mut rng);
        let (s, c) = (cone.sine(), cone.cosine());
        for (center, radius) in [
            (cone.base, cone.radius * c),
            (cone.tip(), cone.radius_at(cone.length) * c),
        ] {
            let e = rng
                .direction()
                .reject_from_normalized(cone.axis)
                .normalize();
            let touching = center + radius * (s * cone.axis + c * e);
            let scale = radius + cone.length;
            assert!(cone.residual(touching).abs() < 1e-14 * scale);
            assert!((cone.normal(touching) * radius).distance(touching - center) < 1e-12 * scale);
            // Nowhere does the sphere leave the cone.
            let other = center + radius * rng.direction();
            assert!(cone.residual(other) < 1e-13 * scale);
        }
    }
}

#[test]
fn both_ends_of_a_span_are_on_the_proper_nappe() {
    let mut rng = SplitMix64::new(2);
    let (mut found, mut half_lines) = (0, 0);
    for _ in 0..20_000 {
        let cone = random_cone(&mut rng);
        let origin = cone.base + rng.direction() * rng.log_range(0.1, 20.0);
        // Some of them along the axis, or along the cone's own lines, where w² − m² vanishes.
        let e = cone.axis.any_orthonormal_vector();
        let dir = match rng.below(4) {
            0 => cone.axis,
            1 => (cone.axis + cone.slope * e).normalize(),
            _ => rng.direction(),
        };
        let Some((from, to)) = cone.ray_span(origin, dir) else {
            continue;
        };
        found += 1;
        assert!(from <= to);
        for t in [from, to] {
            if t.is_infinite() {
                half_lines += 1;
            } else if t.abs() < 1e6 {
                let p = origin + t * dir;
                let scale = 1.0 + p.length();
                assert!(cone.residual(p).abs() < 1e-12 * scale);
                assert!(cone.radius_at(cone.axis.dot(p - cone.base)) > -1e-9 * scale);
            }
        }
        // Inside between them, and outside beyond.
        let middle = match (from.is_finite(), to.is_finite()) {
            (true, true) => 0.5 * (from + to),
            (true, false) => from + 1.0,
            (false, true) => to - 1.0,
            (false, false) => 0.0,
        };
        if middle.abs() < 1e6 {
            assert!(cone.residual(origin + middle * dir) < 1e-9);
        }
    }
    assert!(found > 5000 && half_lines > 1000);
}

#[test]
fn rays_that_miss_the_span_are_outside_all_along() {
    let mut rng = SplitMix64::new(3);
    for _ in 0..2000 {
        let cone = random_cone(&mut rng);
        let origin = cone.base + rng.direction() * rng.log_range(0.1, 20.0);
        let dir = rng.direction();
        if cone.ray_span(origin, dir).is_none() {
            for i in -200..=200 {
                let p = origin + 0.25 * f64::from(i) * dir;
                assert!(cone.residual(p) > -1e-12);
            }
        }
    }
}

#[test]
fn the_cut_range_holds_the_cut_curve_and_touches_it() {
    let mut rng = SplitMix64::new(4);
    let mut ellipses = 0;
    for _ in 0..2000 {
        let cone = random_cone(&mut rng);
        let plane = CutPlane {
            point: cone.base,
            normal: rng.direction(),
            offset: rng.range(-1.0, 1.0),
        };
        let Some((low, high)) = cone.cut_range(&plane) else {
            continue;
        };
        ellipses += 1;
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for p in super::super::cut_curve(&cone, &plane, 720) {
            let y = cone.axis.dot(p - cone.base);
            assert!(plane.distance(p).abs() < 1e-9 * (1.0 + y.abs()));
            (least, most) = (least.min(y), most.max(y));
        }
        // The curve's y changes with the square of the azimuth near its ends: (π/720)² ≈ 2e-5,
        // times how sharp the end is (the quotient of the poles).
        let size = high - low + 1e-9;
        assert!(low - 1e-9 * size <= least && most <= high + 1e-9 * size);
        let pole = |y: f64| (y - low).abs().min((high - y).abs()) / size;
        assert!(pole(least) < 0.02 && pole(most) < 0.02);
    }
    assert!(ellipses > 500);
}

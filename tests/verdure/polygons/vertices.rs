//! Vertices lie where the reference has its surface, at the (u, v) that it has there.

use super::*;

#[test]
fn vertices_lie_on_the_relief_at_their_uv() {
    let radii = [0.2, 0.18, 0.15, 0.13, 0.1];
    let relative = Thickness::Relative(0.3);
    for (bend, thickness, continuous_u) in [
        (0.0f64, METRES, false),
        (30.0, relative, true),
        (60.0, METRES, true),
        (60.0, relative, false),
    ] {
        let joints = chain(&radii, bend.to_radians());
        for m in 0..3 {
            let both = both(
                &joints,
                m,
                (Join::Mitre, Ends::Round),
                &waves,
                (thickness, continuous_u),
            );
            let mut poles = 0;
            for (i, &p) in both.mesh.positions.iter().enumerate() {
                let segment = both.mesh.segments[i] as usize;
                let [u, v] = both.mesh.uvs[i].map(f64::from);
                // The poles, where all u meet, have u between those of the rings.
                if ((u * f64::from(8 << m)).fract() - 0.5).abs() < 1e-3 {
                    poles += 1;
                    continue;
                }
                let parts = [ReliefPart::Cone, ReliefPart::StartCap, ReliefPart::EndCap];
                let best = parts
                    .iter()
                    .filter_map(|&part| both.scene.locate(segment, part, point(p)))
                    .min_by(|a, b| (a.w - a.height).abs().total_cmp(&(b.w - b.height).abs()))
                    .unwrap();
                // 1e-4 of a radius; f32 has 1e-7 of a coordinate.
                let miss = (best.w - best.height).abs() * THICKNESS;
                assert!(miss < 1e-4 * radii[segment], "bend {bend}: {miss} {best:?}");
                assert!(apart(best.u, u) < 1e-4, "{best:?} {u}");
                assert!((best.map_v - v).abs() < 1e-4, "{best:?} {v}");
            }
            assert_eq!(poles, 2 * (8 << m));
        }
    }
}

#[test]
fn round_joins_lie_on_the_balls() {
    // With one height all round, for across a round join the mesh's u is turned with the axis, and the reference's is
    // that of the first segment.
    let joints = chain(&[0.2, 0.18, 0.15, 0.13], 1.2);
    let both = both(
        &joints,
        3,
        (Join::Round, Ends::Flat),
        &flat,
        (METRES, false),
    );
    for (i, &p) in both.mesh.positions.iter().enumerate() {
        let segment = both.mesh.segments[i] as usize;
        let parts = [ReliefPart::Cone, ReliefPart::EndCap];
        let located = parts.map(|part| both.scene.locate(segment, part, point(p)));
        let misses = located
            .iter()
            .flatten()
            .map(|at| (at.w - at.height).abs() * THICKNESS);
        let miss = misses.fold(f64::INFINITY, f64::min);
        let [u, _] = both.mesh.uvs[i].map(f64::from);
        let pole = ((u * 64.0).fract() - 0.5).abs() < 1e-3;
        assert!(pole || miss < 2e-5, "{miss}");
    }
}

#[test]
fn coordinates_without_intersections_are_those_of_equation_7() {
    let joints = chain(&[0.2, 0.18, 0.15, 0.13, 0.1], 0.9);
    for (thickness, continuous_u) in [(METRES, true), (Thickness::Relative(0.4), false)] {
        let both = both(
            &joints,
            3,
            (Join::Mitre, Ends::Round),
            &waves,
            (thickness, continuous_u),
        );
        for (i, &p) in both.mesh.positions.iter().enumerate() {
            let segment = both.mesh.segments[i] as usize;
            let shell = &both.shells[segment];
            let (u, v, w) = shell.coordinates(point(p) - shell.frustum.base, TWIST);
            // Neither takes a generator through a point below the shell.
            if !(0.01..0.99).contains(&v) || w < 0.0 {
                continue;
            }
            let at = both
                .scene
                .locate(segment, ReliefPart::Cone, point(p))
                .unwrap();
            assert!(
                (v - at.v).abs() < 1e-12 && (w - at.w).abs() < 1e-9,
                "{v} {w} {at:?}"
            );
            assert!(apart(u, at.u) < 1e-12, "{u} {at:?}");
        }
    }
}

#[test]
fn u_can_be_in_line_all_round_a_cut() {
    let joints = chain(&[0.25, 0.2, 0.15, 0.1], 0.8);
    let skin = (Join::Mitre, Ends::Round);
    for (continuous_u, limit) in [(false, 0.06), (true, 1e-6)] {
        // The ring of the planes' height, where both cones meet.
        let both = both(&joints, 4, skin, &flat, (METRES, continuous_u));
        let mut worst: f64 = 0.0;
        let mut shared = 0;
        for (i, &p) in both.mesh.positions.iter().enumerate() {
            let sides = [both.mesh.segments[i], both.mesh.neighbours[i]];
            if sides[0] == sides[1] {
                continue;
            }
            let u = sides.map(|segment| {
                let at = both
                    .scene
                    .locate(segment as usize, ReliefPart::Cone, point(p));
                at.unwrap().u
            });
            worst = worst.max(apart(u[0], u[1]));
            shared += 1;
        }
        assert_eq!(shared, 2 * (8 * 16 + 1));
        // A single f32 of a place is 3e-8 of the circumference off.
        assert!(worst < limit && (continuous_u || worst > 0.01), "{worst}");
    }
}

#[test]
fn round_joins_carry_the_relief_over_the_ball() {
    for bend in [0.3, 1.0, 2.0, 3.0] {
        let joints = chain(&[0.2; 4], bend);
        let skin = (Join::Round, Ends::Flat);
        let both = both(&joints, 3, skin, &waves, (METRES, true));
        let mut bridges = 0;
        for (i, &p) in both.mesh.positions.iter().enumerate() {
            let segment = both.mesh.segments[i];
            if segment == both.mesh.neighbours[i] {
                continue;
            }
            // On the inside of the bend the strip lies within both cones, and nobody's ball.
            let (joint, before, next) = (
                joints[segment as usize].position,
                joints[segment as usize - 1].position,
                joints[segment as usize + 1].position,
            );
            let x = point(p) - joint;
            if x.dot(joint - before) < 1e-6 || x.dot(next - joint) > -1e-6 {
                continue;
            }
            let at = both
                .scene
                .locate(segment as usize, ReliefPart::EndCap, point(p))
                .unwrap();
            let [u, _] = both.mesh.uvs[i].map(f64::from);
            assert!(apart(at.u, u) < 1e-4, "{at:?} {u}");
            assert!((at.w - at.height).abs() * THICKNESS < 1e-5, "{at:?}");
            bridges += 1;
        }
        assert!(bridges > 100, "{bridges}");
    }
}

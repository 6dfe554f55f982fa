//! The mesh's normals against those of the surface that it stands for.

use super::*;

/// Casts a ray at each vertex from outside; returns the angles, in degrees, between the mesh's normals and those of
/// what was hit, and the distances.
fn compare(both: &Both, skip: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
    let mut found = Vec::new();
    for (i, &p) in both.mesh.positions.iter().enumerate() {
        let normal = point(both.mesh.normals[i]);
        if skip(f64::from(both.mesh.uvs[i][1])) {
            continue;
        }
        let hit = both.scene.cast(point(p) + 0.02 * normal, -normal, 0.0);
        let hit = hit.expect("a vertex lies on the surface");
        let angle = hit.normal.dot(normal).clamp(-1.0, 1.0).acos().to_degrees();
        found.push((angle, (hit.t - 0.02).abs()));
    }
    found
}

#[test]
fn normals_are_those_of_the_surface_away_from_cuts() {
    let joints = chain(&[0.2, 0.18, 0.15, 0.13], 0.5);
    for (relief, limit) in [(&flat as &dyn Fn(f64, f64) -> f64, 0.5), (&waves, 3.0)] {
        let both = both(
            &joints,
            4,
            (Join::Mitre, Ends::Round),
            relief,
            (METRES, false),
        );
        // At a cut the mesh has the mean of both sides.
        let found = compare(&both, |v| (v - v.round()).abs() < 1e-3);
        let worst = found.iter().fold((0.0, 0.0), |worst: (f64, f64), x| {
            (worst.0.max(x.0), worst.1.max(x.1))
        });
        assert!(worst.0 < limit && worst.1 < 1e-5, "{worst:?}");
    }
}

#[test]
fn across_a_cut_normals_stay_between_those_of_both_sides() {
    let bend = 0.5f64;
    let joints = chain(&[0.2, 0.18, 0.15, 0.13], bend);
    let both = both(
        &joints,
        4,
        (Join::Mitre, Ends::Round),
        &flat,
        (METRES, false),
    );
    let at_cuts = compare(&both, |v| {
        !(1.9..3.1).contains(&v) || (v - v.round()).abs() > 1e-3
    });
    assert_eq!(at_cuts.len(), 2 * (8 * 16 + 1));
    for (angle, distance) in at_cuts {
        assert!(angle < 0.5 * bend.to_degrees() + 1.0, "{angle}");
        // A cut's ring is where the first segment has it; the second misses it by a share of the taper.
        assert!(distance < 0.02 * THICKNESS, "{distance}");
    }
}

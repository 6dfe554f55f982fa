//! What makes a mesh a good one: its counts, that it is closed, that it faces outwards, that it is smooth.

mod trees;

use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

use bevy::math::{DQuat, DVec3, Vec3};

use super::*;
use crate::frusta::double::join::{Link, NONE, PosedJoint};

/// A chain of segments of length 1 that winds out of its plane, each bent by `bend` radians from the one before.
fn chain(radii: &[f64], bend: f64) -> (Vec<Link>, Vec<PosedJoint>) {
    let mut axis = DVec3::new(0.2, 1.0, 0.1).normalize();
    let mut about = DVec3::Z.cross(axis).normalize();
    let mut position = DVec3::ZERO;
    let count = radii.len() as u32;
    let mut joints = Vec::new();
    for (i, &radius) in radii.iter().enumerate() {
        if i > 1 {
            axis = (DQuat::from_axis_angle(about, bend) * axis).normalize();
            about = DQuat::from_axis_angle(axis, 1.0) * about;
        }
        if i > 0 {
            position += axis;
        }
        joints.push(PosedJoint { position, radius });
    }
    let links = (0..count).map(|i| Link {
        parent: i.checked_sub(1).unwrap_or(NONE),
        next: if i + 1 < count { i + 1 } else { NONE },
        continues: true,
        branches: false,
        twist: 0.3 * f64::from(i),
    });
    (links.collect(), joints)
}

fn mesh((links, joints): &(Vec<Link>, Vec<PosedJoint>), settings: &MeshSettings) -> MeshParts {
    let v_ranges: Vec<_> = (0..links.len())
        .map(|i| [i as f64 - 1.0, i as f64])
        .collect();
    polygons(links, joints, &v_ranges, |_| DVec3::Z, settings).unwrap()
}

const WAVES: MeshRelief = MeshRelief {
    height: &|u, v| 0.5 + 0.3 * (3.0 * TAU * u).sin() + 0.2 * (2.0 * TAU * v).cos(),
    shell: ShellShape {
        thickness: Thickness::Relative(0.3),
        level: 0.0,
    },
};

/// Every combination of joins, ends and relief.
fn all(subdivisions: u32) -> impl Iterator<Item = MeshSettings<'static>> {
    (0..8).map(move |i| MeshSettings {
        subdivisions,
        join: [Join::Mitre, Join::Round][i & 1],
        ends: [Ends::Round, Ends::Flat][(i >> 1) & 1],
        relief: (i & 4 != 0).then_some(WAVES),
        continuous_u: i & 1 == 0,
        close_branches: true,
    })
}

/// Triangles by place: vertices at one place are one. Those without area are left out.
fn welded(parts: &MeshParts) -> Vec<[usize; 3]> {
    let mut places = HashMap::new();
    let mut place = |vertex: u32| {
        // -0.0 is where 0.0 is.
        let key = parts.positions[vertex as usize].map(|x| (x + 0.0).to_bits());
        let next = places.len();
        *places.entry(key).or_insert(next)
    };
    let triangles = parts
        .indices
        .chunks(3)
        .map(|t| [place(t[0]), place(t[1]), place(t[2])]);
    triangles
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect()
}

/// Asserts that each edge has one triangle on either side; or, where `folded`, as many on one as on the other, for
/// limbs that go back the way they came.
fn assert_closed(parts: &MeshParts, folded: bool, what: &str) {
    let mut edges: HashMap<(usize, usize), i32> = HashMap::new();
    for [a, b, c] in welded(parts) {
        for edge in [(a, b), (b, c), (c, a)] {
            *edges.entry(edge).or_default() += 1;
        }
    }
    for (&(a, b), &count) in &edges {
        assert!(
            folded || count == 1,
            "{what}: an edge is used twice in one direction"
        );
        assert_eq!(edges.get(&(b, a)), Some(&count), "{what}: an edge is open");
    }
}

fn volume(parts: &MeshParts) -> f64 {
    let at = |vertex: u32| Vec3::from(parts.positions[vertex as usize]).as_dvec3();
    let triangles = parts.indices.chunks(3);
    triangles
        .map(|t| at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0)
        .sum()
}

#[test]
fn a_segment_has_sixteen_triangles_and_each_subdivision_four_times_as_many() {
    let plant = chain(&[0.2, 0.18, 0.15, 0.1, 0.1], 0.5);
    for m in 0..4 {
        for settings in all(m) {
            let parts = mesh(&plant, &settings);
            let triangles = parts.indices.len() / 3;
            assert_eq!(triangles - parts.extra_triangles, 16 * 4 * 4usize.pow(m));
            if settings.join == Join::Mitre {
                let side = 1 << m;
                let cap = match settings.ends {
                    Ends::Flat => 8 * side,
                    _ => 8 * side * (4 * side - 1),
                };
                assert_eq!(parts.extra_triangles, 2 * cap);
            }
            let count = parts.positions.len();
            assert!(parts.indices.iter().all(|&i| (i as usize) < count));
            assert_eq!(
                [
                    parts.normals.len(),
                    parts.uvs.len(),
                    parts.segments.len(),
                    parts.neighbours.len()
                ],
                [count; 4]
            );
        }
    }
}

#[test]
fn chains_are_closed_up_to_a_bend_of_sixty_degrees_and_round_ones_up_to_a_fold() {
    for bend in [0.0f64, 5.0, 30.0, 60.0, 100.0, 150.0, 180.0] {
        for radii in [
            [0.15; 5],
            [0.2, 0.16, 0.12, 0.08, 0.04],
            [0.1, 0.2, 0.1, 0.2, 0.1],
        ] {
            let plant = chain(&radii, bend.to_radians());
            for settings in (0..4).flat_map(all) {
                let what = format!("bend {bend}, radii {radii:?}, {:?}", settings.join);
                let parts = mesh(&plant, &settings);
                assert_closed(&parts, bend == 180.0, &what);
                assert!(volume(&parts) > 0.0, "{what}");
                for n in &parts.normals {
                    assert!(
                        (Vec3::from(*n).length() - 1.0).abs() < 1e-5,
                        "{what}: {n:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_volume_is_that_of_the_frusta() {
    // Inscribed polygons of 128 sides lack 4e-4 of a circle's area.
    let settings = MeshSettings {
        subdivisions: 4,
        ..MeshSettings::default()
    };
    let ball = |r: f64| 4.0 / 3.0 * PI * r.powi(3);
    let assert_near = |volume: f64, expected: f64| {
        assert!(
            (volume / expected - 1.0).abs() < 1e-3,
            "{volume} {expected}"
        );
    };
    // A mitre between cylinders takes from one side what it gives to the other.
    for bend in [0.0, 0.5, 1.0] {
        let parts = mesh(&chain(&[0.2; 5], bend), &settings);
        assert_near(volume(&parts), 4.0 * PI * 0.04 + ball(0.2));
    }
    // Relief of one height is a thicker limb.
    let relief = MeshRelief {
        height: &|_, _| 0.5,
        shell: ShellShape {
            thickness: Thickness::Metres(0.1),
            level: 0.0,
        },
    };
    let thick = MeshSettings {
        relief: Some(relief),
        ..settings
    };
    let parts = mesh(&chain(&[0.2; 5], 0.7), &thick);
    assert_near(volume(&parts), 4.0 * PI * 0.0625 + ball(0.25));
    // A cone between two flat ends, the radii at the joints being those of spheres that it touches.
    let flat = MeshSettings {
        ends: Ends::Flat,
        ..settings
    };
    let (r1, r2) = (0.3, 0.1);
    let c = (1.0f64 - 0.04).sqrt();
    let parts = mesh(&chain(&[r1, r2], 0.0), &flat);
    assert_near(
        volume(&parts),
        PI / 3.0 * (r1 * r1 + r1 * r2 + r2 * r2) / (c * c),
    );
}

#[test]
fn triangles_face_the_way_of_their_normals() {
    for settings in all(3) {
        let parts = mesh(&chain(&[0.2, 0.17, 0.15, 0.12], 0.6), &settings);
        if settings.join == Join::Round {
            continue; // The strips' hidden sides are inside out.
        }
        let at = |vertex: u32| Vec3::from(parts.positions[vertex as usize]);
        for t in parts.indices.chunks(3) {
            let facet = (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
            for &vertex in t {
                assert!(facet.dot(Vec3::from(parts.normals[vertex as usize])) >= 0.0);
            }
        }
    }
}

#[test]
fn vertices_at_one_place_have_one_normal_but_for_flat_ends() {
    for settings in all(2) {
        if settings.ends == Ends::Flat {
            continue;
        }
        let parts = mesh(&chain(&[0.2, 0.17, 0.15, 0.12], 0.6), &settings);
        let mut normals = HashMap::new();
        for (p, n) in parts.positions.iter().zip(&parts.normals) {
            let n = Vec3::from(*n);
            let known = *normals.entry(p.map(f32::to_bits)).or_insert(n);
            // Where a round join's strip has no width its rings meet, each with its own neighbours.
            let limit = if settings.join == Join::Round {
                0.8
            } else {
                1.0 - 1e-5
            };
            assert!(known.dot(n) > limit, "{p:?} {known} {n}");
        }
    }
}

#[test]
fn rings_at_cuts_move_with_both_segments() {
    let plant = chain(&[0.2, 0.2, 0.2], 0.4);
    let parts = mesh(&plant, &MeshSettings::default());
    let shared: Vec<_> = (0..parts.segments.len())
        .filter(|&i| parts.segments[i] != parts.neighbours[i])
        .collect();
    assert_eq!(shared.len(), 9);
    for i in shared {
        assert_eq!((parts.segments[i], parts.neighbours[i]), (1, 2));
        assert!((Vec3::from(parts.positions[i]).distance(plant.1[1].position.as_vec3())) < 0.3);
    }
}

#[test]
fn branches_and_segments_without_cone_are_closed_by_themselves() {
    let (mut links, mut joints) = chain(&[0.2, 0.2, 0.2, 0.9], 0.3);
    // The last joint's sphere is near enough to hold its parent's; another segment branches off.
    joints[3].position = joints[2].position + DVec3::Y * 0.5;
    joints.push(PosedJoint {
        position: joints[1].position + DVec3::X,
        radius: 0.1,
    });
    links[1].branches = true;
    links.push(Link {
        parent: 1,
        next: NONE,
        continues: false,
        branches: false,
        twist: 0.0,
    });
    let plant = (links, joints);
    for settings in (0..3).flat_map(all) {
        let parts = mesh(&plant, &settings);
        assert_closed(&parts, false, "forest");
        let side = 1 << settings.subdivisions;
        assert_eq!(
            parts.indices.len() / 3 - parts.extra_triangles,
            16 * 3 * side * side
        );
    }
}

#[test]
fn a_mesh_that_indices_cannot_reach_is_refused() {
    let plant = chain(&[0.2, 0.2], 0.0);
    let v_ranges = [[0.0, 1.0]; 2];
    for subdivisions in [13, 31, 32, u32::MAX] {
        let settings = MeshSettings {
            subdivisions,
            ..MeshSettings::default()
        };
        let error = polygons(&plant.0, &plant.1, &v_ranges, |_| DVec3::Z, &settings).unwrap_err();
        assert!(error.to_string().contains("fewer subdivisions"));
    }
}

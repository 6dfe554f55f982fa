//! The plain files against the definitions, and the shaders against the plain files.

use bevy::math::{DVec3, Vec3};
use bevy::prelude::*;
use bevy_verdure::frusta::double::cast::{Ray, cast_ray};
use bevy_verdure::frusta::double::cone::{Cone, EndKind, Frustum};
use bevy_verdure::frusta::double::join::{JoinKind, Skin, skin};
use bevy_verdure::frusta::double::links::{joints_at_rest, links};
use bevy_verdure::frusta::double::mitre::mitre;
use bevy_verdure::frusta::{double, single};
use bevy_verdure::lab::reference::{ReferenceJoin, seam_gap, swept_sphere_distance};
use bevy_verdure::lab::{Lens, NEAR, Shot, Studio};
use bevy_verdure::prelude::*;

use crate::skeletons::{Dice, Growth, Roll, ball, double, reference_joints};

const HARSH: Growth = Growth {
    joints: 8,
    bend: 180.0,
    taper: 8.0,
    aspect: (0.02, 5.0),
    branching: 0.25,
};
const GENTLE: Growth = Growth {
    joints: 14,
    bend: 70.0,
    taper: 1.6,
    aspect: (0.05, 0.5),
    branching: 0.3,
};

fn frusta(skeleton: &Skeleton, join: JoinKind) -> Vec<Frustum> {
    let links = links(skeleton);
    let mut frusta = vec![Frustum::default(); links.len()];
    let style = Skin {
        join,
        ends: EndKind::Round,
    };
    skin(&links, &joints_at_rest(skeleton), style, &mut frusta);
    frusta
}

#[test]
fn points_of_one_cone_on_a_mitres_plane_lie_on_the_other() {
    let mut dice = Dice::new(1);
    let (mut cuts, mut worst) = (0, 0.0f64);
    while cuts < 5_000 {
        let first = double(dice.direction()).normalize();
        let bend = f64::from(dice.between(0.0, 170.0)).to_radians();
        let across = first.any_orthonormal_vector();
        let second = first * bend.cos() + across * bend.sin();
        let radius = 1.0;
        let [before, after] = [(); 2].map(|()| f64::from(dice.log_between(0.125, 8.0)));
        let [l1, l2] = [(); 2].map(|()| f64::from(dice.log_between(0.5, 40.0)));
        if (before - radius).abs() >= 0.99 * l1 || (after - radius).abs() >= 0.99 * l2 {
            continue;
        }
        // The first cone from its joint on: its radius there is that of the tangent cone at its end.
        let c1 = Cone::touching(first, l1, before, radius);
        let c1 = Cone {
            radius: c1.radius_at(l1),
            ..c1
        };
        let c2 = Cone::touching(second, l2, radius, after);
        let Some(mitre) = mitre(&c1, &c2, radius) else {
            continue;
        };
        let plane = mitre.plane;
        cuts += 1;
        let (u, w) = first.any_orthonormal_pair();
        for i in 0..32 {
            let (sin, cos) = (f64::from(i) * core::f64::consts::TAU / 32.0).sin_cos();
            let e = u * cos + w * sin;
            let q = plane.normal.dot(e);
            let m = plane.normal.dot(first) + c1.slope * q;
            let y = (plane.offset - c1.radius * q) / m;
            let point = first * y + e * c1.radius_at(y);
            // Relative to the point's distance, which the last bit of its coordinates scales with; the division by m
            // loses as many digits again as the plane is steep.
            worst = worst.max(c2.residual(point).abs() * m.min(1.0) / point.length());
        }
    }
    println!("mitre: worst residual {worst:e} of {cuts} cuts");
    assert!(worst < 1e-12);
}

#[test]
fn the_papers_joins_leave_gaps_where_exact_mitres_leave_none() {
    println!("seam gap in radii of the joint; bend, taper: mitre, paper, paper iterated");
    for bend in [10.0f64, 30.0, 60.0, 90.0] {
        for taper in [1.0f64, 2.0, 4.0] {
            let (sin, cos) = bend.to_radians().sin_cos();
            let axes = [DVec3::Y, DVec3::new(sin, cos, 0.0)];
            let radii = [taper, 1.0, 1.0 / taper];
            let lengths = [4.0, 4.0];
            let gap = |join| seam_gap(axes, lengths, radii, join);
            let gaps = [
                ReferenceJoin::Mitre,
                ReferenceJoin::Paper,
                ReferenceJoin::PaperIterated,
            ]
            .map(gap);
            println!(
                "{bend:>3}° {taper}:1  {:.1e}  {:.4}  {:.1e}",
                gaps[0], gaps[1], gaps[2]
            );
            assert!(gaps[0] < 1e-12);
            if taper > 1.0 {
                assert!(
                    gaps[1] > 1e-2,
                    "the paper's planes fit the major axes alone"
                );
            }
        }
    }
}

#[test]
fn round_joins_are_swept_spheres() {
    let mut dice = Dice::new(7);
    let (mut hits, mut worst) = (0, 0.0f64);
    for growth in [HARSH, GENTLE].into_iter().cycle().take(60) {
        let skeleton = growth.grow(&mut dice);
        let frusta = frusta(&skeleton, JoinKind::Round);
        let joints = reference_joints(&skeleton);
        let (centre, radius) = ball(&skeleton);
        for _ in 0..300 {
            let eye = double(centre + dice.direction() * (radius * dice.log_between(1.1, 100.0)));
            let target = double(centre + dice.direction() * (radius * dice.between(0.0, 0.8)));
            let direction = (target - eye).normalize();
            let nearest = frusta
                .iter()
                .filter_map(|frustum| {
                    let ray = Ray {
                        origin: eye - frustum.base,
                        direction,
                    };
                    cast_ray(&ray, frustum, 0.0, 0.0)
                })
                .map(|hit| hit.t)
                .reduce(f64::min);
            let Some(t) = nearest else { continue };
            // The point lies on the sweep's surface, and nothing of the sweep lies before it.
            let distance = swept_sphere_distance(&joints, eye + direction * t);
            worst = worst.max(distance.abs() / t);
            let before = (1..20).map(|i| {
                swept_sphere_distance(&joints, eye + direction * (t * f64::from(i) / 20.0))
            });
            assert!(before.fold(f64::INFINITY, f64::min) > -1e-6 * t);
            hits += 1;
        }
    }
    println!("round: {hits} hits, worst distance {worst:e} of the ray's length");
    assert!(hits > 4_000);
    assert!(worst < 1e-6);
}

#[test]
fn bounds_hold_their_frustum_and_touch_it() {
    let mut dice = Dice::new(12);
    for growth in [HARSH, GENTLE].into_iter().cycle().take(200) {
        let skeleton = growth.grow(&mut dice);
        for join in [JoinKind::Mitre, JoinKind::Round] {
            for frustum in frusta(&skeleton, join) {
                let Some(bounds) = double::bounds::Bounds::new(&frustum, 0.0) else {
                    continue;
                };
                let corners: Vec<DVec3> = (0..8).map(|i| bounds.corner(i)).collect();
                let size = corners
                    .iter()
                    .map(|corner| corner.length())
                    .fold(0.0, f64::max);
                let points = surface_points(&frustum);
                for face in [
                    [0, 2, 3],
                    [4, 5, 7],
                    [0, 1, 5],
                    [2, 6, 7],
                    [0, 4, 6],
                    [1, 3, 7],
                ] {
                    let [a, b, c] = face.map(|i| corners[i]);
                    let normal = (b - a).cross(c - a);
                    // A side that has shrunk to a point or a line bounds nothing.
                    if normal.length() < 1e-9 * size * size {
                        continue;
                    }
                    let normal = normal.normalize();
                    let reach = points
                        .iter()
                        .map(|p| normal.dot(*p - a))
                        .fold(f64::NEG_INFINITY, f64::max);
                    assert!(reach <= 1e-9 * size, "{reach} outside of {frustum:?}");
                }
            }
        }
    }
}

/// Points all over a frustum's surface, relative to its base.
fn surface_points(frustum: &Frustum) -> Vec<DVec3> {
    let mut points = Vec::new();
    let (u, w) = frustum.axis.any_orthonormal_pair();
    for i in 0..48 {
        let (sin, cos) = (f64::from(i) * core::f64::consts::TAU / 48.0).sin_cos();
        let e = u * cos + w * sin;
        if frustum.has_cone() {
            let (low, high) = double::surface::generator_span(frustum, e);
            for j in 0..=8 {
                let y = low + (high - low) * f64::from(j) / 8.0;
                points.push(frustum.axis * y + e * frustum.cone().radius_at(y).max(0.0));
            }
        }
        for j in 0..=16 {
            let (s, c) = (f64::from(j) * core::f64::consts::PI / 16.0).sin_cos();
            let on_sphere = frustum.axis * c + e * s;
            if frustum.start.kind == EndKind::Round {
                let x = on_sphere * frustum.start.radius;
                if frustum.start.normal.dot(x) <= frustum.start.offset {
                    points.push(x);
                }
            }
            if frustum.end.kind == EndKind::Round {
                let x = on_sphere * frustum.end.radius;
                if frustum.end.normal.dot(x) >= frustum.end.offset {
                    points.push(x + frustum.axis * frustum.length);
                }
            }
        }
    }
    points
}

#[test]
fn sides_of_plain_bounds_touch_the_cone_and_ends_are_the_cutting_planes() {
    // A bent, tapering limb: its middle segment has two mitres.
    let mut limb = Skeleton::builder();
    let base = limb.root(Vec3::ZERO, 0.3);
    limb.chain(
        base,
        &[
            (Vec3::Y, 0.25),
            (Vec3::new(0.5, 2.0, 0.0), 0.2),
            (Vec3::new(1.3, 2.6, 0.2), 0.15),
        ],
    );
    let frusta = frusta(&limb.build().unwrap(), JoinKind::Mitre);
    let frustum = &frusta[2];
    assert_eq!(
        (frustum.start.kind, frustum.end.kind),
        (EndKind::Cut, EndKind::Cut)
    );
    let bounds = double::bounds::Bounds::new(frustum, 0.0).unwrap();
    for corner in 0..8 {
        let point = bounds.corner(corner);
        // Corners are √2 radii off the axis, and on the planes.
        let y = point.dot(frustum.axis);
        let off_axis = (point - frustum.axis * y).length();
        assert!((off_axis - 2f64.sqrt() * frustum.cone().radius_at(y)).abs() < 1e-12);
        let (end, joint) = if corner < 4 {
            (&frustum.start, DVec3::ZERO)
        } else {
            (&frustum.end, frustum.axis * frustum.length)
        };
        assert!((end.normal.dot(point - joint) - end.offset).abs() < 1e-12);
    }
}

#[test]
fn the_shaders_compute_what_the_plain_files_compute() {
    let mut studio = Studio::default();
    let mut dice = Dice::new(77);
    let (mut hits, mut wrong, mut worst_depth, mut worst_uv, mut worst_normal) =
        (0, 0, 0f32, 0f32, 0f32);
    for growth in [GENTLE, HARSH, GENTLE] {
        let skeleton = growth.grow(&mut dice);
        let links = single::links::links(&skeleton);
        let rest = single::links::joints_at_rest(&skeleton);
        let mut frusta = vec![single::cone::Frustum::default(); links.len()];
        let style = single::join::Skin {
            join: single::join::JoinKind::Mitre,
            ends: single::cone::EndKind::Round,
        };
        single::join::skin(&links, &rest, style, &mut frusta);
        single::surface::align(&links, &mut frusta, |i| {
            if frusta_axis_is_along_z(&rest, &links, i) {
                Vec3::X
            } else {
                Vec3::Z
            }
        });
        let (centre, radius) = ball(&skeleton);
        let shot = Shot {
            eye: centre + dice.direction() * (radius * 2.0),
            at: centre,
            lens: Lens::Perspective(0.8),
            size: UVec2::new(256, 192),
        };
        let plant = studio.plant(skeleton.clone(), Frusta::default(), Transform::IDENTITY);
        let figures = studio.measure(&shot);
        studio.uproot(plant);
        for y in 0..192 {
            for x in 0..256 {
                let (_, direction) = shot.ray(x as f32 + 0.5, y as f32 + 0.5);
                let nearest = frusta
                    .iter()
                    .enumerate()
                    .filter_map(|(i, frustum)| {
                        let ray = single::cast::Ray {
                            origin: shot.eye - frustum.base,
                            direction: direction.as_vec3(),
                        };
                        Some((
                            i,
                            single::cast::cast_ray(&ray, frustum, NEAR, 1e-5 * radius)?,
                        ))
                    })
                    .min_by(|a, b| a.1.t.total_cmp(&b.1.t));
                let seen = figures.get(x, y);
                let (Some((i, hit)), Some(seen)) = (nearest, seen) else {
                    wrong += usize::from(nearest.is_some() != seen.is_some());
                    continue;
                };
                if i as u32 != seen.segment {
                    wrong += 1;
                    continue;
                }
                hits += 1;
                worst_depth = worst_depth.max((hit.t - seen.depth).abs() / hit.t);
                let point = single::surface::surface_point(
                    &frusta[i],
                    links[i].twist,
                    hit.point,
                    hit.part,
                    single::surface::Normals::Continuous,
                );
                let du = (point.u - seen.uv.x).abs();
                // Near the axis, at the pole of a cap, u has no meaning.
                let across = hit.point - frusta[i].axis * hit.point.dot(frusta[i].axis);
                worst_uv = worst_uv.max(du.min(1.0 - du) * across.length() / radius);
                worst_normal = worst_normal.max((point.normal - seen.normal).length());
            }
        }
    }
    println!(
        "{hits} hits, {wrong} wrong; worst depth {worst_depth:e}, u {worst_uv:e}, normal {worst_normal:e}"
    );
    assert!(hits > 5_000);
    // Along outlines, where the last bit decides.
    assert!(wrong * 2_000 <= hits, "{wrong} wrong");
    // At a grazing hit the root of the discriminant turns roundings of 6e-8 into some 2.4e-4 of the radius.
    assert!(worst_depth < 3e-4);
    // References travel in 16 bits an axis, 5e-5 radians, which adds up along a limb by no more than as much again.
    assert!(worst_uv < 1e-4);
    // As depth, times the curvature: a hit that slides along the ray by 2.4e-4 radii turns the normal by as much.
    assert!(worst_normal < 2e-3);
}

/// Whether a limb's first segment leaves +z open as the place of u = 0.
fn frusta_axis_is_along_z(
    joints: &[single::join::PosedJoint],
    links: &[single::join::Link],
    i: usize,
) -> bool {
    let along = joints[i].position - joints[links[i].parent as usize].position;
    along.normalize_or(Vec3::Y).z.abs() >= 0.9
}

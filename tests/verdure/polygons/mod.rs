//! Polygons against the reference ray caster, which shares no code with them.

mod normals;
mod vertices;

use std::f64::consts::TAU;

use bevy::math::{DQuat, DVec3, Vec3};
use bevy_verdure::frusta::double::cone::{EndKind, Frustum};
use bevy_verdure::frusta::double::join::Skin;
use bevy_verdure::frusta::double::join::{JoinKind, Link, NONE, PosedJoint};
use bevy_verdure::frusta::double::shell::{Shell, Thickness, align_shells, skin_shell};
use bevy_verdure::frusta::polygons::{MeshParts, MeshRelief, MeshSettings, polygons};
use bevy_verdure::frusta::{Ends, Join};
use bevy_verdure::lab::reference::relief::{
    ReliefOptions, ReliefPart, ReliefScene, SegmentTexture, ShellThickness,
};
use bevy_verdure::lab::reference::{
    ReferenceEnds, ReferenceJoin, ReferenceJoint, ReferenceSettings,
};

const THICKNESS: f64 = 0.05;
const METRES: Thickness = Thickness::Metres(THICKNESS);
const TWIST: f64 = 0.4;

/// Low waves, which a mesh of few subdivisions follows.
fn waves(u: f64, v: f64) -> f64 {
    0.5 + 0.3 * (3.0 * TAU * u + TAU * v).sin() + 0.2 * (TAU * v).cos()
}

fn flat(_: f64, _: f64) -> f64 {
    0.5
}

/// A chain of segments of length 1 that winds out of its plane.
fn chain(radii: &[f64], bend: f64) -> Vec<ReferenceJoint> {
    let (mut axis, mut about) = (DVec3::Y, DVec3::X);
    let mut position = DVec3::ZERO;
    let mut joints = Vec::new();
    for (i, &radius) in radii.iter().enumerate() {
        if i > 1 {
            axis = DQuat::from_axis_angle(about, bend) * axis;
            about = DQuat::from_axis_angle(axis, 1.0) * about;
        }
        if i > 0 {
            position += axis;
        }
        joints.push(ReferenceJoint {
            position,
            radius,
            parent: i.checked_sub(1),
        });
    }
    joints
}

/// One plant both ways.
struct Both<'a> {
    mesh: MeshParts,
    scene: ReliefScene<'a>,
    shells: Vec<Shell>,
}

fn both<'a>(
    joints: &[ReferenceJoint],
    subdivisions: u32,
    (join, ends): (Join, Ends),
    relief: &'a dyn Fn(f64, f64) -> f64,
    (thickness, continuous_u): (Thickness, bool),
) -> Both<'a> {
    let count = joints.len() as u32;
    let links: Vec<_> = (0..count)
        .map(|i| Link {
            parent: i.checked_sub(1).unwrap_or(NONE),
            next: if i + 1 < count { i + 1 } else { NONE },
            continues: true,
            branches: false,
            twist: TWIST,
        })
        .collect();
    let posed: Vec<_> = joints
        .iter()
        .map(|joint| PosedJoint {
            position: joint.position,
            radius: joint.radius,
        })
        .collect();
    let v_ranges: Vec<_> = (0..count)
        .map(|i| [f64::from(i), f64::from(i + 1)])
        .collect();
    let settings = MeshSettings {
        subdivisions,
        join,
        ends,
        relief: Some(MeshRelief {
            height: relief,
            shell: thickness.into(),
        }),
        continuous_u,
        close_branches: false,
    };
    let mesh = polygons(&links, &posed, &v_ranges, |_| DVec3::Z, &settings).unwrap();
    let textures = v_ranges.iter().map(|&[v_start, v_end]| SegmentTexture {
        twist: TWIST,
        v_start,
        v_end,
    });
    let options = ReliefOptions {
        textures: Some(textures.collect()),
        continuous_u,
        ..ReliefOptions::default()
    };
    let skin = ReferenceSettings {
        join: match join {
            Join::Round => ReferenceJoin::Round,
            _ => ReferenceJoin::Mitre,
        },
        ends: match ends {
            Ends::Flat => ReferenceEnds::Flat,
            _ => ReferenceEnds::Round,
        },
    };
    let shell_thickness = match thickness {
        Thickness::Metres(h) => ShellThickness::Metres(h),
        Thickness::Relative(share) => ShellThickness::Relative(share),
    };
    let scene = ReliefScene::with_options(joints, skin, relief, shell_thickness, &options);
    let mut frusta = vec![Frustum::default(); links.len()];
    let skin = Skin {
        join: match join {
            Join::Round => JoinKind::Round,
            _ => JoinKind::Mitre,
        },
        ends: match ends {
            Ends::Flat => EndKind::Flat,
            Ends::Round => EndKind::Round,
        },
    };
    let mut shells = skin_shell(&links, &posed, skin, thickness, &mut frusta);
    align_shells(&links, &mut shells, continuous_u, |_| DVec3::Z);
    Both {
        mesh,
        scene,
        shells,
    }
}

fn point(p: [f32; 3]) -> DVec3 {
    Vec3::from(p).as_dvec3()
}

/// How far two u are apart, round the circle.
fn apart(a: f64, b: f64) -> f64 {
    let d = (a - b).rem_euclid(1.0);
    d.min(1.0 - d)
}

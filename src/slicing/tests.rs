//! What the tests of several files share.

use bevy::math::{Vec2, Vec3};

use super::bake::{BakeSettings, CrownMaterial, CrownMesh, CrownVertex, bake};
use super::slicing::Slicing;

/// A few leaves, baked as small as can be.
pub(super) fn tiny() -> Slicing {
    leaves(16)
}

/// The same with so many pixels a slice.
pub(super) fn leaves(pixels: u32) -> Slicing {
    let mut mesh = CrownMesh::default();
    mesh.add_material(CrownMaterial::default());
    for i in 0..9 {
        let foot = Vec3::new(
            (i % 3) as f32,
            2.0 + (i / 3) as f32,
            (i * 5 % 7) as f32 * 0.5,
        );
        let corner = |at: Vec3| CrownVertex {
            position: foot + at,
            normal: Vec3::Y,
            uv: Vec2::ZERO,
            color: [0.2, 0.5, 0.1, 1.0],
        };
        mesh.push(
            [
                corner(Vec3::ZERO),
                corner(Vec3::new(0.6, 0.3, 0.2)),
                corner(Vec3::new(0.1, 0.7, 0.5)),
            ],
            0,
        );
    }
    let settings = BakeSettings {
        levels: vec![2, 1],
        switches: vec![10.0],
        samples: 2,
        pixels,
        ..BakeSettings::default()
    };
    bake(&mesh, &settings).expect("the leaves can be baked")
}

//! The skins of cacti: pleated ribs with rows of spines on them.

use bevy::math::{IVec2, Vec2, Vec3};

use super::Paint;
use super::noise::{Noise, again, unit};
use crate::plants::shape::{mix, smooth};

/// What tells one ribbed cactus from another.
struct Ribs {
    /// Ribs round the stem.
    count: i32,
    /// Areoles, the cushions that spines stand on, along a rib in one map.
    areoles: i32,
    /// Length of a map over that of the circumference.
    length: f32,
    /// Radius of an areole across and along, in ribs.
    cushion: Vec2,
    /// Spines on an areole.
    spines: u32,
    /// Length of the longest spines, in ribs.
    reach: f32,
    /// Half the width of a spine's foot, in ribs.
    thick: f32,
    /// Share of the shell's thickness between grooves and ridges.
    depth: f32,
    skin: Vec3,
    groove: Vec3,
    felt: Vec3,
    spine: Vec3,
    seed: u32,
}

/// A saguaro's: 16 ribs, tufts of short straw-coloured spines.
pub(super) fn saguaro(uv: Vec2) -> Paint {
    ribbed(
        uv,
        &Ribs {
            count: 16,
            areoles: 10,
            length: super::finish::CACTUS_LENGTH,
            cushion: Vec2::new(0.1, 0.12),
            spines: 11,
            reach: 0.46,
            thick: 0.032,
            depth: 0.85,
            skin: Vec3::new(0.125, 0.178, 0.072),
            groove: Vec3::new(0.03, 0.052, 0.02),
            felt: Vec3::new(0.22, 0.165, 0.1),
            spine: Vec3::new(0.5, 0.44, 0.32),
            seed: 51,
        },
    )
}

/// A barrel cactus': 24 ribs, denser spines that redden towards the tip.
pub(super) fn barrel(uv: Vec2) -> Paint {
    ribbed(
        uv,
        &Ribs {
            count: 24,
            areoles: 9,
            length: super::finish::CACTUS_LENGTH,
            cushion: Vec2::new(0.14, 0.2),
            spines: 9,
            reach: 0.62,
            thick: 0.04,
            depth: 0.87,
            skin: Vec3::new(0.078, 0.135, 0.05),
            groove: Vec3::new(0.022, 0.044, 0.017),
            felt: Vec3::new(0.25, 0.2, 0.12),
            spine: Vec3::new(0.46, 0.26, 0.15),
            seed: 61,
        },
    )
}

fn ribbed(uv: Vec2, ribs: &Ribs) -> Paint {
    let sway = Noise::new(ribs.count / 2, 2, ribs.seed).gradient(uv) * 0.07;
    let across = uv.x * ribs.count as f32 + sway;
    let rib = across.round();
    // 0 on the ridge, 1 in the groove; rounded ridges, and grooves with a narrow floor.
    let side = (across - rib).abs() * 2.0;
    let pleat = 1.0 - (side * side + 0.0064).sqrt() * 0.35 - 0.65 * side.powi(3);
    let pleat = pleat.clamp(0.0, 1.0);
    let pleat = mix(pleat, pleat * pleat * (3.0 - 2.0 * pleat), 0.5);

    // Lengths in ribs from here on.
    let pitch = ribs.length * ribs.count as f32 / ribs.areoles as f32;
    let along = uv.y * ribs.areoles as f32;
    let lattice = Noise::new(ribs.count, ribs.areoles, ribs.seed + 1);
    let (mut felt, mut spine) = (0.0_f32, 0.0_f32);
    for side in -1..=1 {
        // In turn on every second rib.
        let column = rib as i32 + side;
        let shift = 0.5 * column.rem_euclid(2) as f32;
        let nearest = (along - shift).round() as i32;
        for row in nearest - 1..=nearest + 1 {
            let id = lattice.id(IVec2::new(column, row));
            let stray = shift + (unit(again(id, 1)) - 0.5) * 0.24;
            let from = Vec2::new(across - column as f32, (along - row as f32 - stray) * pitch);
            let distance = (from / ribs.cushion).length();
            felt = felt.max(1.0 - smooth(0.45, 1.0, distance));
            spine = spine.max(tuft(from, id, ribs));
        }
    }

    let wrinkle = Noise::new(ribs.count * 2, 9, ribs.seed + 2).fractal(uv, 2);
    let blotch = Noise::new(6, 3, ribs.seed + 3).fractal(uv, 3);
    let height = 0.04 + ribs.depth * pleat + (0.94 - ribs.depth) * felt + 0.018 * wrinkle;
    let skin = ribs.groove.lerp(ribs.skin, smooth(0.0, 0.85, pleat));
    // A waxy bloom on the ridges.
    let skin = skin.lerp(ribs.skin * 1.35, smooth(0.75, 1.0, pleat))
        * (1.0 + 0.12 * wrinkle + 0.14 * blotch);
    let color = skin.lerp(ribs.felt, felt).lerp(ribs.spine, spine);
    Paint::new(color, height)
}

/// How far the spines of an areole cover a point `from` its middle, in ribs.
fn tuft(from: Vec2, id: u32, ribs: &Ribs) -> f32 {
    if from.length() > ribs.reach + ribs.thick {
        return 0.0;
    }
    let mut cover = 0.0_f32;
    for i in 0..ribs.spines {
        let odd = again(id, 10 + i);
        // Directions all round, by the slopes of a square so that no sine is needed.
        let turn = (i as f32 + 0.7 * unit(odd)) / ribs.spines as f32 * 4.0;
        let (quarter, t) = (turn as u32 % 4, turn.fract() * 2.0 - 1.0);
        let direction = match quarter {
            0 => Vec2::new(t, 1.0),
            1 => Vec2::new(1.0, -t),
            2 => Vec2::new(-t, -1.0),
            _ => Vec2::new(-1.0, t),
        }
        .normalize();
        let length = ribs.reach * mix(0.55, 1.0, unit(again(odd, 1)));
        let t = (from.dot(direction) / length).clamp(0.0, 1.0);
        let distance = from.distance(direction * (t * length));
        let width = ribs.thick * (1.0 - 0.75 * t);
        cover = cover.max((1.0 - smooth(0.5 * width, 1.3 * width, distance)) * (1.0 - 0.35 * t));
    }
    cover
}

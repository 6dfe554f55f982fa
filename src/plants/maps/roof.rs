//! A roof of curved tiles.

use bevy::math::{IVec2, Vec2, Vec3};

use super::Paint;
use super::noise::{Noise, again, unit};
use crate::plants::shape::{mix, smooth};

/// Tiles round the roof.
const TILES: i32 = 28;
/// Rows of tiles in a map.
const ROWS: i32 = 5;

/// Covers over pans, each row over the one below it; v runs up the slope.
pub(super) fn tiles(uv: Vec2) -> Paint {
    let across = uv.x * TILES as f32;
    let column = across.round();
    let side = (across - column).abs() * 2.0;
    // Covers and pans in turn.
    let lattice = Noise::new(2 * TILES, ROWS, 151);

    // The lower edges of covers and pans are not in line: each tile slipped a little.
    let row_at = |tile: f32, stray: f32| {
        let along = uv.y * ROWS as f32;
        let slip = |row: i32| {
            let id = lattice.id(IVec2::new(tile as i32 * 2 + stray as i32, row));
            (0.22 * (unit(id) - 0.5), id)
        };
        let near = along.floor() as i32;
        let row = (near - 1..=near + 1).rfind(|row| *row as f32 + slip(*row).0 <= along);
        let row = row.unwrap_or(near - 1);
        let (from, id) = slip(row);
        let to = 1.0 + slip(row + 1).0;
        (
            ((along - row as f32 - from) / (to - from)).clamp(0.0, 1.0),
            id,
        )
    };
    // Tiles slope down from their lower edge and end under the next row's: a cliff, bevelled.
    let slope = |t: f32| mix(0.58, mix(1.0, 0.58, t), smooth(0.0, 0.17, t));

    let (t_cover, cover_id) = row_at(column, 0.0);
    let (t_pan, pan_id) = row_at(across.floor(), 1.0);
    // Covers taper towards their upper end.
    let width = mix(0.66, 0.58, t_cover);
    let arch = (1.0 - (side / width).powi(2)).max(0.0);
    let cover = 0.99 * slope(t_cover) * mix(0.4, 1.0, arch);
    let hollow = (1.0 - side).powi(2);
    let pan = 0.52 * slope(t_pan) * mix(0.55, 1.0, hollow);
    let on_cover = smooth(0.0, 0.25, arch);
    let rough = Noise::new(56, 14, 152).fractal(uv, 2);
    let height = mix(pan, cover, on_cover) + 0.02 * rough;

    let (id, t) = if arch > 0.0 {
        (cover_id, t_cover)
    } else {
        (pan_id, t_pan)
    };
    let clay = Vec3::new(0.36, 0.135, 0.065)
        .lerp(Vec3::new(0.42, 0.215, 0.115), unit(again(id, 1)))
        * mix(0.78, 1.1, unit(again(id, 2)));
    let age = smooth(-0.1, 0.8, Noise::new(14, 4, 153).fractal(uv, 4));
    let lichen = smooth(0.3, 0.6, Noise::new(24, 6, 154).fractal(uv, 3));
    let clay = clay.lerp(Vec3::new(0.13, 0.085, 0.06), 0.55 * age);
    let clay = clay.lerp(Vec3::new(0.33, 0.31, 0.2), 0.4 * lichen);
    let gap = (1.0 - smooth(0.0, 0.06, t)).max(smooth(0.9, 1.0, t) * 0.45);
    let crease = 1.0 - smooth(0.0, 0.16, (side - width).abs());
    let shade = (1.0 - 0.6 * gap) * (1.0 - 0.45 * crease) * mix(0.7, 1.0, on_cover);
    Paint::new(clay * shade * (1.0 + 0.16 * rough), height)
}

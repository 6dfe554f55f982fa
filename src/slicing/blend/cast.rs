//! What casts shadows: one slicing that faces the light, whose leaves lie at depths by chance.

use bevy::math::{Vec2, Vec3};

use super::{DrawnSlice, SliceOrder};
use crate::slicing::orientation::Orientation;
use crate::slicing::slicing::SlicingShape;

/// The greatest opacity of a place in the eyes of the light, from 0 to 1: an opaque place does not tell how many leaves lie
/// behind one another. With this one, which is four, crowns have as much sun as their meshes; with 0.8, half as much more.
pub const DENSEST: f32 = 0.985;

/// The slices that cast shadows for light from `direction` (unit), that of a directional light: those of the nearest
/// orientation, in the coarsest level of detail (in the paper's order, the finest). What is next to the light comes first.
pub fn cast_slices(shape: &SlicingShape, direction: Vec3, order: SliceOrder) -> Vec<DrawnSlice> {
    let level = match order {
        SliceOrder::Paper => 0,
        SliceOrder::Steady => shape.levels.len() - 1,
    };
    let count = shape.levels[level];
    let (mut nearest, mut greatest) = (0, -2.0);
    for (i, o) in shape.orientations.iter().enumerate() {
        let cosine = o.direction.dot(direction);
        if cosine > greatest {
            (nearest, greatest) = (i as u32, cosine);
        }
    }
    let slice = |number| DrawnSlice {
        orientation: nearest,
        level: level as u32,
        index: if greatest >= 0.0 {
            count - 1 - number
        } else {
            number
        },
        opacity: 1.0,
    };
    (0..count).map(slice).collect()
}

/// How far light comes before it meets a leaf, from 0 to 1, at a place of opacity `alpha` for which a `lot` of 0 to 1 was
/// drawn that is less: where leaves are spread evenly, (1 − alpha)^t is left of it on the share t of the way (Beer and
/// Lambert), so that t is ln(1 − lot) / ln(1 − alpha). The far side stops what is left.
pub fn first_leaf(lot: f32, alpha: f32) -> f32 {
    (1.0 - lot.min(DENSEST)).log2() / (1.0 - alpha.min(DENSEST)).log2()
}

/// Where a place of a slice casts its shadow from, from the centroid: turned to face light from `direction` (unit), and
/// so much wider along the tilt that an ellipsoid which fills the slicing box has the shadow that it should have.
pub fn facing(o: &Orientation, direction: Vec3, place: Vec3) -> Vec3 {
    let size = o.high - o.low;
    let cosine = direction.dot(o.direction);
    let tilt = direction - o.direction * cosine;
    let sine = tilt.length();
    let flat = place - direction * place.dot(direction);
    if sine < 1e-3 {
        return flat;
    }
    // The slice's half-width along the tilt, of its inscribed ellipse.
    let along = Vec2::new(tilt.dot(o.right) / size.x, tilt.dot(o.up) / size.y).length() / sine;
    let wider = Vec2::new(1.0, size.z * along * sine / cosine.abs().max(0.02)).length();
    let axis = (o.direction - direction * cosine).normalize();
    flat + axis * (place.dot(axis) * (wider - 1.0))
}

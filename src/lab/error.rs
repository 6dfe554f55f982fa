//! How wrong a picture of figures is, against one of finer settings.

use bevy::math::UVec2;

use super::studio::Figures;
use super::timing::median;

/// How far one picture's geometry is from another's.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GeometryError {
    /// Median error of depth, relative to the reference's, where both see a plant.
    pub median_depth: f64,
    /// What 99 of 100 such pixels stay below.
    pub worst_depth: f64,
    /// Share of pixels that see another segment, a plant instead of the background, or the reverse; of all in which
    /// either sees a plant.
    pub wrong_segments: f64,
    /// How many pixels that are.
    pub pixels: usize,
}

impl GeometryError {
    /// Compares two pictures of the same size. Segments are told apart by their index within a plant.
    ///
    /// # Panics
    /// If the sizes differ.
    pub fn between(reference: &Figures, test: &Figures) -> Self {
        assert_eq!(reference.size(), test.size());
        let UVec2 { x, y } = reference.size();
        let (mut depths, mut wrong, mut pixels) = (Vec::new(), 0usize, 0usize);
        for (x, y) in (0..y).flat_map(|y| (0..x).map(move |x| (x, y))) {
            let both = (reference.get(x, y), test.get(x, y));
            match both {
                (None, None) => continue,
                (Some(reference), Some(test)) => {
                    let off = f64::from(test.depth) - f64::from(reference.depth);
                    depths.push(off.abs() / f64::from(reference.depth).max(1e-9));
                    wrong += usize::from(reference.segment != test.segment);
                }
                _ => wrong += 1,
            }
            pixels += 1;
        }
        depths.sort_by(f64::total_cmp);
        let worst = depths.len().saturating_sub(1) * 99 / 100;
        Self {
            median_depth: median(&depths),
            worst_depth: depths.get(worst).copied().unwrap_or(0.0),
            wrong_segments: wrong as f64 / pixels.max(1) as f64,
            pixels,
        }
    }
}

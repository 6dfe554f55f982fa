//! Colours and shapes by which series differ: either alone is enough to tell seven apart.

use plotters::style::RGBColor;

/// The colours of M. Okabe and K. Ito, *Color Universal Design* (2008), which people with any kind of colour vision
/// tell apart; but for their yellow, too pale for lines on white.
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
];

/// Corners about the middle, within ±1; none stands for a disc.
const SHAPES: [&[(f64, f64)]; 7] = [
    &[],
    &[(-0.85, -0.85), (0.85, -0.85), (0.85, 0.85), (-0.85, 0.85)],
    &[(0.0, -1.15), (1.05, 0.75), (-1.05, 0.75)],
    &[(0.0, -1.25), (1.05, 0.0), (0.0, 1.25), (-1.05, 0.0)],
    &[(0.0, 1.15), (1.05, -0.75), (-1.05, -0.75)],
    &[
        (-0.35, -1.1),
        (0.35, -1.1),
        (0.35, -0.35),
        (1.1, -0.35),
        (1.1, 0.35),
        (0.35, 0.35),
        (0.35, 1.1),
        (-0.35, 1.1),
        (-0.35, 0.35),
        (-1.1, 0.35),
        (-1.1, -0.35),
        (-0.35, -0.35),
    ],
    &[
        (-1.1, -0.6),
        (-0.6, -1.1),
        (0.0, -0.5),
        (0.6, -1.1),
        (1.1, -0.6),
        (0.5, 0.0),
        (1.1, 0.6),
        (0.6, 1.1),
        (0.0, 0.5),
        (-0.6, 1.1),
        (-1.1, 0.6),
        (-0.5, 0.0),
    ],
];

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    pub colour: RGBColor,
    /// Corners about the middle, within about ±1; none stands for a disc.
    pub corners: &'static [(f64, f64)],
}

impl Mark {
    /// The look of the series with an index: 49 of them differ.
    pub fn of(series: usize) -> Self {
        let (round, i) = (series / COLOURS.len(), series % COLOURS.len());
        Self {
            colour: COLOURS[i],
            corners: SHAPES[(i + round) % SHAPES.len()],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_of_49_series_look_alike() {
        let marks: Vec<_> = (0..49).map(Mark::of).collect();
        for (i, mark) in marks.iter().enumerate() {
            assert!(!marks[..i].contains(mark), "{i}");
        }
    }
}

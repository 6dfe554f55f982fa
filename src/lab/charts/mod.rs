//! Charts: figures as a picture, twice, and as a table.
//!
//! A chart is plain data. [`Chart::save`] writes it as SVG and PNG, drawn by the same code, and as CSV with every point
//! of it, also those that a picture has no room for: infinite ones, ones without a value, and zeros on a logarithmic
//! axis.
//!
//! | file | what it does |
//! |---|---|
//! | `scale` | ranges of axes, their ticks, and what is written beside these |
//! | `mark` | colours and shapes by which series differ |
//! | `canvas` | lines and text on either kind of picture |
//! | `picture` | where on the page everything goes |
//! | `table` | the CSV |

mod canvas;
mod mark;
mod picture;
mod scale;
mod table;

use std::path::Path;

/// Width and height of a picture, in pixels.
pub const SIZE: (u32, u32) = (900, 600);

/// Figures to be shown.
///
/// The font of the pictures has the characters of ASCII only; in titles, labels and names others become `?`.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What is shown, in a line.
    pub title: String,
    /// Where it was measured: the name of the adapter or machine, or that it is arithmetic. Stands on each line of
    /// the CSV too.
    pub subtitle: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn, the last on top.
    pub series: Vec<Series>,
}

/// One of the two axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What it measures, with the unit.
    pub label: String,
    /// How values are spread over it.
    pub scale: Scale,
    /// Values below are drawn here: what a zero needs on a logarithmic axis.
    pub floor: Option<f64>,
}

/// How values are spread over an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithms. Zero and negative values are left out of the picture, unless the axis has a floor.
    Log,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What stands in the legend.
    pub name: String,
    /// In the order in which they are joined.
    pub points: Vec<Point>,
    /// Whether lines join them. A point that is left out interrupts the line.
    pub lines: bool,
}

/// One figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
    /// Is written beside the point where there is room.
    pub label: Option<String>,
    /// Draws a ring round the point: the settings that are the default.
    pub marked: bool,
}

impl Axis {
    /// An axis with evenly spread values.
    pub fn linear(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            floor: None,
        }
    }

    /// An axis with values spread by their logarithms.
    pub fn log(label: impl Into<String>) -> Self {
        Self {
            scale: Scale::Log,
            ..Self::linear(label)
        }
    }

    /// The axis with values below `floor` drawn there.
    pub fn with_floor(mut self, floor: f64) -> Self {
        self.floor = Some(floor);
        self
    }
}

impl Series {
    /// Points joined by lines.
    pub fn line(
        name: impl Into<String>,
        points: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        Self {
            lines: true,
            ..Self::scatter(name, points)
        }
    }

    /// Points on their own.
    pub fn scatter(
        name: impl Into<String>,
        points: impl IntoIterator<Item = impl Into<Point>>,
    ) -> Self {
        Self {
            name: name.into(),
            points: points.into_iter().map(Into::into).collect(),
            lines: false,
        }
    }
}

impl From<(f64, f64)> for Point {
    fn from((x, y): (f64, f64)) -> Self {
        Self {
            x,
            y,
            ..Self::default()
        }
    }
}

impl Point {
    /// The point with something written beside it.
    pub fn labelled(mut self, label: impl Into<String>) -> Self {
        self.label = Some(label.into());
        self
    }

    /// The point with a ring round it if `marked`.
    pub fn marked(mut self, marked: bool) -> Self {
        self.marked = marked;
        self
    }
}

impl Chart {
    /// Writes `name`.svg, `name`.png and `name`.csv to a folder, which is made if it is not there.
    pub fn save(&self, dir: &Path, name: &str) -> Result<(), String> {
        std::fs::create_dir_all(dir).map_err(|error| format!("{}: {error}", dir.display()))?;
        let write = |ending: &str, bytes: &[u8]| {
            let path = dir.join(format!("{name}.{ending}"));
            std::fs::write(&path, bytes).map_err(|error| format!("{}: {error}", path.display()))
        };
        write("csv", self.to_csv().as_bytes())?;
        write("svg", self.to_svg()?.as_bytes())?;
        write("png", &self.to_png()?)
    }
}

//! What can be wrong with a slicing, or with the file that it is read from, and what to do about it.

use thiserror::Error;

use super::limits::{MAX_PIXELS, MAX_PIXELS_TOTAL};

/// Why a shape and pictures make no [`Slicing`](super::Slicing).
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SlicingError {
    /// Something is there too often or not often enough.
    #[error("the number of {what} is {value}: make it {least} to {most}")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        value: usize,
        /// How many there must be.
        least: usize,
        /// How many there may be.
        most: usize,
    },
    /// The side of a slice is no power of two in range.
    #[error("pixels is {pixels}: make it a power of two, at most {MAX_PIXELS}")]
    Pixels {
        /// What it is.
        pixels: u32,
    },
    /// There are too many pixels in all.
    #[error(
        "all slices together have {total} pixels, more than {MAX_PIXELS_TOTAL}: use fewer slices, or slices of fewer \
         pixels"
    )]
    TotalPixels {
        /// How many there are.
        total: u64,
    },
    /// The number of switches does not fit the number of levels.
    #[error("{levels} levels of detail need one switch fewer, but there are {switches}")]
    Switches {
        /// How many switches there are.
        switches: usize,
        /// How many levels there are.
        levels: usize,
    },
    /// The switches do not rise.
    #[error(
        "switches are not distances greater than 0, each by a quarter more than the last: correct them"
    )]
    SwitchOrder,
    /// A number is out of range.
    #[error(
        "{what} is {value}: make it a finite number, the radius greater than 0, the correction 0 to 4, the diffuse transmission 0 to 1"
    )]
    Number {
        /// Which number.
        what: &'static str,
        /// What it is.
        value: f32,
    },
    /// The axes of an orientation are not at right angles, or its box has no room.
    #[error(
        "orientation {index}: direction, right and up must be unit vectors at right angles, and each coordinate of low \
         less than that of high, neither further from the centroid than 4 radii: bake it anew"
    )]
    Orientation {
        /// Which orientation, counted from 0.
        index: usize,
    },
    /// The pictures have not the pixels that the shape asks for.
    #[error("the pictures have {found} pixels, where the slices have {expected}: bake them anew")]
    PictureSize {
        /// How many there should be.
        expected: usize,
        /// How many there are.
        found: usize,
    },
}

/// Why a file makes no [`Slicing`](super::Slicing): which file, where in it, and what is wrong.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{path}{}: {kind}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct SlicingFileError {
    /// The file.
    pub path: String,
    /// The line in the file, counted from 1, where the error is about one.
    pub line: Option<u64>,
    /// What is wrong, and what to do about it.
    pub kind: SlicingFileErrorKind,
}

impl SlicingFileError {
    pub(super) fn new(path: &str, kind: impl Into<SlicingFileErrorKind>) -> Self {
        Self {
            path: path.into(),
            line: None,
            kind: kind.into(),
        }
    }
}

/// What is wrong with a file of a slicing, and what to do about it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SlicingFileErrorKind {
    /// The file could not be read or written.
    #[error("cannot be read or written ({message}): check that it exists and is accessible")]
    Read {
        /// What the reader said.
        message: String,
    },
    /// The file is too large.
    #[error("is larger than {limit} bytes: is it a slicing?")]
    TooLarge {
        /// The limit.
        limit: usize,
    },
    /// The text is no slicing in RON.
    #[error("{message}: correct it, or bake the slicing anew")]
    Ron {
        /// What the parser said, or what is missing.
        message: String,
    },
    /// A picture is not one.
    #[error(
        "is no picture that can be read ({message}): bake it anew, and enable Bevy's feature `png`"
    )]
    Picture {
        /// What the decoder said.
        message: String,
    },
    /// A picture has another size than its slicing says.
    #[error(
        "is {width} × {height} pixels, where its slices take {expected_width} × {expected_height}: bake it anew"
    )]
    PictureSize {
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
        /// What its width should be.
        expected_width: u32,
        /// What its height should be.
        expected_height: u32,
    },
    /// The parts make no slicing.
    #[error(transparent)]
    Slicing(#[from] SlicingError),
}

//! What can be wrong with a file, and what to do about it.

use std::fmt::Display;
use std::io;

use thiserror::Error;

use super::super::error::TexelError;
use super::MAX_DOCUMENT_BYTES;

/// Why a file makes no volume: which file, where in it, and what is wrong.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{path}{}: {kind}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct TexelFileError {
    /// The file: the `*.texel.ron`, or one of its images.
    pub path: String,
    /// The line in it, counted from 1, where the error is about one.
    pub line: Option<u64>,
    /// What is wrong, and what to do about it.
    pub kind: TexelFileErrorKind,
}

impl TexelFileError {
    /// An error about a whole file.
    pub(crate) fn new(path: impl Display, kind: impl Into<TexelFileErrorKind>) -> Self {
        Self {
            path: path.to_string(),
            line: None,
            kind: kind.into(),
        }
    }
}

/// What is wrong with a file, and what to do about it.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TexelFileErrorKind {
    /// It could not be read.
    #[error("cannot be read ({message}): check that it exists beside the others and may be read")]
    Read {
        /// What the reader said.
        message: String,
    },
    /// It could not be written.
    #[error("cannot be written ({message}): check that the folder exists and may be written to")]
    Write {
        /// What the writer said.
        message: String,
    },
    /// Its name has another end.
    #[error("is no name of a volume: let it end in `.texel.ron`")]
    Extension,
    /// The document is larger than any that is needed.
    #[error(
        "is larger than {MAX_DOCUMENT_BYTES} bytes: is it another file? A volume's voxels are in its images"
    )]
    TooLarge,
    /// The document is not text.
    #[error("has bytes that are not UTF-8 text: save it as UTF-8")]
    NotUtf8,
    /// The text is no volume in RON.
    #[error("{message}: {fix}")]
    Ron {
        /// What the parser said.
        message: String,
        /// What to do about it.
        fix: &'static str,
    },
    /// Slices don't fill a grid.
    #[error(
        "`columns` is {columns}, which does not divide the {slices} slices: take a power of two of at most {slices}"
    )]
    Columns {
        /// What it is.
        columns: u32,
        /// How many slices there are.
        slices: u32,
    },
    /// The thickness is none.
    #[error(
        "`thickness` is not three finite numbers greater than 0: leave it out to have it measured"
    )]
    Thickness,
    /// A name of an image leads elsewhere.
    #[error(
        "the image name `{name}` is not that of a file in the same folder: write a name without `/` and `\\`"
    )]
    ImageName {
        /// The name.
        name: String,
    },
    /// An image is no PNG.
    #[error("is no readable PNG ({message}): export it again")]
    Png {
        /// What the decoder said.
        message: String,
    },
    /// An image has another size than the volume's slices.
    #[error(
        "is {}x{} pixels, where the slices in their grid are {}x{}: scale it, or correct `size` and `columns`",
        found[0], found[1], expected[0], expected[1]
    )]
    ImageSize {
        /// Its width and height.
        found: [u32; 2],
        /// What they should be.
        expected: [u32; 2],
    },
    /// The voxels make no volume.
    #[error(transparent)]
    Volume(#[from] TexelError),
}

impl TexelFileErrorKind {
    pub(super) fn read(error: &io::Error) -> Self {
        Self::Read {
            message: error.to_string(),
        }
    }

    pub(super) fn write(error: &io::Error) -> Self {
        Self::Write {
            message: error.to_string(),
        }
    }
}

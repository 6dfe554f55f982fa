//! What can be wrong with a skeleton, or with the file that it is read from, and what to do about it.

use bevy::math::{DVec3, Vec3};
use thiserror::Error;

use super::joint::{MAX_COORDINATE, MAX_RADIUS};
use super::skeleton::MAX_JOINTS;
use super::text::MAX_FILE_BYTES;

/// Why joints make no [`Skeleton`](super::Skeleton). Joints are named by their index, counted from 0 in
/// the order in which they were given.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SkeletonError {
    /// There are no joints.
    #[error("a skeleton needs at least one joint: add a root joint, which has no parent")]
    Empty,
    /// There are more than [`MAX_JOINTS`] joints.
    #[error("there are more than {MAX_JOINTS} joints: split the plant into several skeletons")]
    TooManyJoints,
    /// A position is not finite, or too far from the origin.
    #[error(
        "joint {joint}: position {position} is not finite or more than {MAX_COORDINATE} m from the origin \
         along an axis: move the skeleton near its origin, or for a file set `recentre` to `Always` or \
         correct `scale` in the loader settings"
    )]
    Position {
        /// Index of the joint.
        joint: u32,
        /// What its position is, in metres.
        position: Vec3,
    },
    /// A radius is not positive, or too large.
    #[error(
        "joint {joint}: radius is {radius} m: make it greater than 0 and at most {MAX_RADIUS} m"
    )]
    Radius {
        /// Index of the joint.
        joint: u32,
        /// What its radius is, in metres.
        radius: f32,
    },
    /// A twist is not finite.
    #[error("joint {joint}: twist is {twist}: give it a finite number of radians")]
    Twist {
        /// Index of the joint.
        joint: u32,
        /// What its twist is.
        twist: f32,
    },
    /// A texture length is not positive, or not finite.
    #[error(
        "joint {joint}: texture_length is {metres} m: make it greater than 0, or leave it out to take the \
         parent's"
    )]
    TextureLength {
        /// Index of the joint.
        joint: u32,
        /// What its texture length is.
        metres: f32,
    },
    /// A joint names a parent that is not there.
    #[error(
        "joint {joint}: parent {parent} is not one of the {count} joints it can grow from, counted from 0: \
         correct the index, or leave it out for a root"
    )]
    MissingParent {
        /// Index of the joint.
        joint: u32,
        /// The parent that it names.
        parent: u32,
        /// How many joints there are for it to name.
        count: u32,
    },
    /// A change was asked for to a joint that is not there.
    #[error(
        "joint {joint} is not one of the {count} joints added so far: add it before changing it"
    )]
    MissingJoint {
        /// The index that was given.
        joint: u32,
        /// How many joints had been added.
        count: u32,
    },
    /// A joint is its own ancestor.
    #[error(
        "joint {joint} is its own ancestor: follow its parents, and make one joint of that cycle a root"
    )]
    Cycle {
        /// Index of a joint on the cycle.
        joint: u32,
    },
    /// An offset is not finite.
    #[error("offset {offset} is not finite: give it finite coordinates, or leave it out")]
    Offset {
        /// What the offset is.
        offset: DVec3,
    },
}

impl SkeletonError {
    /// Index of the joint that the error is about, if it is about one.
    pub fn joint(&self) -> Option<u32> {
        match *self {
            Self::Position { joint, .. }
            | Self::Radius { joint, .. }
            | Self::Twist { joint, .. }
            | Self::TextureLength { joint, .. }
            | Self::MissingParent { joint, .. }
            | Self::MissingJoint { joint, .. }
            | Self::Cycle { joint } => Some(joint),
            Self::Empty | Self::TooManyJoints | Self::Offset { .. } => None,
        }
    }
}

/// Why a file makes no [`Skeleton`](super::Skeleton): which file, where in it, and what is wrong.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{path}{}: {kind}", line.map(|line| format!(", line {line}")).unwrap_or_default())]
pub struct SkeletonFileError {
    /// The file, as the caller named it.
    pub path: String,
    /// The line in the file, counted from 1, where the error is about one.
    pub line: Option<u64>,
    /// What is wrong, and what to do about it.
    pub kind: SkeletonFileErrorKind,
}

impl SkeletonFileError {
    /// An error on a line of a file that the caller names with [`in_file`](Self::in_file).
    pub(super) fn on_line(line: u64, kind: impl Into<SkeletonFileErrorKind>) -> Self {
        Self {
            path: String::new(),
            line: Some(line),
            kind: kind.into(),
        }
    }

    /// The same error, naming the file.
    pub(super) fn in_file(mut self, path: &str) -> Self {
        path.clone_into(&mut self.path);
        self
    }

    /// An error about joints that were read from `lines`, one a joint.
    pub(super) fn in_joints(error: SkeletonError, lines: &[u64]) -> Self {
        let line = error.joint().and_then(|joint| lines.get(joint as usize));
        match (line, error) {
            (Some(&line), SkeletonError::Cycle { .. }) => {
                Self::on_line(line, SkeletonFileErrorKind::Cycle)
            }
            (Some(&line), error) => Self::on_line(line, error),
            (None, error) => error.into(),
        }
    }
}

impl<K: Into<SkeletonFileErrorKind>> From<K> for SkeletonFileError {
    fn from(kind: K) -> Self {
        Self {
            path: String::new(),
            line: None,
            kind: kind.into(),
        }
    }
}

/// What is wrong with a file, and what to do about it.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SkeletonFileErrorKind {
    /// The file could not be read.
    #[error("cannot be read ({message}): check that it exists and may be read")]
    Read {
        /// What the reader said.
        message: String,
    },
    /// The file name ends in none of the known extensions.
    #[error("is no known kind of skeleton file: name it *.skeleton.ron, *.swc or *.csv")]
    UnknownExtension,
    /// The file is larger than [`MAX_FILE_BYTES`].
    #[error(
        "is larger than {MAX_FILE_BYTES} bytes: split the plants into several files, or leave out columns \
         that are not needed"
    )]
    TooLarge,
    /// The file is in UTF-16 or UTF-32.
    #[error("is text in UTF-16 or UTF-32: save it as UTF-8")]
    WideText,
    /// The file contains a zero byte.
    #[error("is a binary file, with a zero byte in this line: export the plant as text")]
    Binary,
    /// The file is not UTF-8.
    #[error("has bytes that are not UTF-8 text: save it as UTF-8, or remove accented letters")]
    NotUtf8,
    /// A setting of the loader is out of range.
    #[error("loader setting `{setting}` is {value}: make it a finite number greater than 0")]
    Setting {
        /// Name of the field of [`SkeletonLoaderSettings`](super::SkeletonLoaderSettings).
        setting: &'static str,
        /// What it is set to.
        value: f32,
    },
    /// The text is not a skeleton in RON.
    #[error("{message}: {fix}")]
    Ron {
        /// What the parser said.
        message: String,
        /// What to do about it.
        fix: &'static str,
    },
    /// A line of an SWC file has too few columns.
    #[error(
        "the number of columns is {found}, where SWC has 7: write `id type x y z radius parent` separated by \
         spaces (is the file cut short, or of another format?)"
    )]
    SwcColumns {
        /// How many columns the line has.
        found: usize,
    },
    /// A word that should be a number is none.
    #[error(
        "{column} is `{text}`, not a finite number: write a number such as 0.5 (is the file cut short, \
         or of another format?)"
    )]
    Number {
        /// Which column it is in.
        column: &'static str,
        /// The word, shortened.
        text: String,
    },
    /// A word that should be an id is none.
    #[error(
        "{column} is `{text}`, not a whole number: write an id such as 12 (is the file cut short, or of \
         another format?)"
    )]
    Id {
        /// Which column it is in.
        column: &'static str,
        /// The word, shortened.
        text: String,
    },
    /// Two lines have the same id.
    #[error("id {id} was already used on line {first_line}: give every line an id of its own")]
    DuplicateId {
        /// The id.
        id: i64,
        /// The line that used it first.
        first_line: u64,
    },
    /// A line names a parent that no line has.
    #[error(
        "parent {parent} is not in the file: correct it, or write -1 for a root (is the file cut short?)"
    )]
    MissingParent {
        /// The parent that is named.
        parent: i64,
    },
    /// Lines are each other's ancestors.
    #[error(
        "is its own ancestor: follow the parents from here, and make one of that cycle a root, with \
         parent -1"
    )]
    Cycle,
    /// A radius is not positive, or too large.
    #[error(
        "radius is {radius}: make it greater than 0 and, in metres, at most {MAX_RADIUS}, or set \
         `min_radius` in the loader settings to widen thin parts"
    )]
    Radius {
        /// What the radius is, in the file's units.
        radius: f64,
    },
    /// A table has no header that names its columns.
    #[error(
        "has no header line with columns separated by comma, semicolon or tab: name the columns in the \
         first line, such as `start_x,start_y,start_z,end_x,end_y,end_z,radius,parent`"
    )]
    NoHeader,
    /// A column that is needed is not there.
    #[error("has no column for {what}: name it {names} in the header")]
    MissingColumn {
        /// What the column is for.
        what: &'static str,
        /// Names that would be understood.
        names: &'static str,
    },
    /// Two columns have the same name.
    #[error("names two columns `{name}`: rename or remove one of them")]
    DuplicateColumn {
        /// The name, as it is compared: small letters and digits.
        name: String,
    },
    /// A row has not as many fields as the header.
    #[error(
        "the number of fields is {found}, where the header names {expected}: give every row the header's \
         columns, numbers with a decimal point, no row names (is the file cut short?)"
    )]
    Fields {
        /// How many fields the row has.
        found: usize,
        /// How many columns the header names.
        expected: usize,
    },
    /// A cylinder has a length, but no direction, or a negative length.
    #[error(
        "length is {length} along axis {axis}: make the length at least 0 and the axis a direction other \
         than (0, 0, 0)"
    )]
    Axis {
        /// What the length is.
        length: f64,
        /// What the axis is.
        axis: DVec3,
    },
    /// The joints make no skeleton.
    #[error(transparent)]
    Joints(#[from] SkeletonError),
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_file_and_the_line_if_there_is_one() {
        let error = SkeletonFileError::on_line(12, SkeletonFileErrorKind::Radius { radius: 0.0 });
        let message = error.in_file("oak.swc").to_string();
        assert!(
            message.starts_with("oak.swc, line 12: radius is 0:"),
            "{message}"
        );
        let error = SkeletonFileError::from(SkeletonFileErrorKind::WideText).in_file("oak.csv");
        assert_eq!(
            error.to_string(),
            "oak.csv: is text in UTF-16 or UTF-32: save it as UTF-8"
        );
    }

    #[test]
    fn joints_are_traced_to_their_lines() {
        let lines = [4, 8, 15];
        let error = SkeletonFileError::in_joints(SkeletonError::Cycle { joint: 2 }, &lines);
        assert_eq!(error.line, Some(15));
        let error = SkeletonFileError::in_joints(SkeletonError::Empty, &lines);
        assert_eq!(error.line, None);
    }
}

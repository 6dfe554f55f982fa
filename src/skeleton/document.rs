//! The written form of a skeleton: serde data, and `*.skeleton.ron` files (format: see the module above).

use std::fmt;

use bevy::math::DVec3;
use ron::error::{Error as RonError, SpannedError};
use ron::ser::PrettyConfig;
use serde::de::{Error as _, SeqAccess, Visitor};
use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::error::{SkeletonError, SkeletonFileError, SkeletonFileErrorKind};
use super::joint::Joint;
use super::skeleton::{MAX_JOINTS, Skeleton};
use super::text::{decode, shorten};
use crate::ron_text::{options, reaches_end};

/// What stands for the path in an error about text that came from no file.
const NO_PATH: &str = "<text>";

/// Levels of brackets that a file may nest. A skeleton has four, each read in a few steps.
const RECURSION_LIMIT: usize = 32;

/// Longest message of the RON parser that is passed on, in characters.
const MAX_MESSAGE: usize = 240;

/// What is read for a skeleton: plain data, not yet checked.
#[derive(Deserialize)]
#[serde(rename = "Skeleton", deny_unknown_fields)]
pub(super) struct SkeletonDocument {
    #[serde(deserialize_with = "bounded_joints")]
    joints: Vec<Joint>,
    #[serde(default)]
    offset: DVec3,
}

impl TryFrom<SkeletonDocument> for Skeleton {
    type Error = SkeletonError;

    fn try_from(document: SkeletonDocument) -> Result<Self, SkeletonError> {
        Self::new(document.joints)?.with_offset(document.offset)
    }
}

impl Serialize for Skeleton {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let has_offset = self.offset() != DVec3::ZERO;
        let mut document = serializer.serialize_struct("Skeleton", 1 + usize::from(has_offset))?;
        document.serialize_field("joints", self.joints())?;
        if has_offset {
            document.serialize_field("offset", &self.offset())?;
        } else {
            document.skip_field("offset")?;
        }
        document.end()
    }
}

impl Skeleton {
    /// This skeleton as the text of a `*.skeleton.ron` file, one joint a line. Reading it back gives an
    /// equal skeleton, to the last bit of every number.
    pub fn to_ron(&self) -> String {
        let layout = PrettyConfig::new().depth_limit(2).new_line("\n");
        let mut text = options(RECURSION_LIMIT)
            .to_string_pretty(self, layout)
            .expect("a list of plain numbers can always be written");
        text.push('\n');
        text
    }

    /// Reads the text of a `*.skeleton.ron` file.
    ///
    /// # Errors
    /// When the text is not a skeleton in RON, or [`Skeleton::new`] refuses its joints. The error's path is
    /// `<text>`; [`skeleton_from_bytes`](super::skeleton_from_bytes) gives it one.
    pub fn from_ron_str(text: &str) -> Result<Self, SkeletonFileError> {
        Self::from_ron_bytes(text.as_bytes())
    }

    /// Reads the bytes of a `*.skeleton.ron` file, in UTF-8.
    ///
    /// # Errors
    /// As [`from_ron_str`](Self::from_ron_str), and when the bytes are not UTF-8 text.
    pub fn from_ron_bytes(bytes: &[u8]) -> Result<Self, SkeletonFileError> {
        decode(bytes)
            .and_then(read)
            .map_err(|error| error.in_file(NO_PATH))
    }
}

/// Reads the text of a `*.skeleton.ron` file.
pub(super) fn read(text: &str) -> Result<Skeleton, SkeletonFileError> {
    let document: SkeletonDocument = options(RECURSION_LIMIT)
        .from_str(text)
        .map_err(|error| explain(&error, text))?;
    Ok(Skeleton::try_from(document)?)
}

/// Says what to do about an error of the RON parser in `text`.
fn explain(error: &SpannedError, text: &str) -> SkeletonFileError {
    let fix = match error.code {
        _ if reaches_end(error, text) => "complete the file, which seems to be empty or cut short",
        RonError::Eof | RonError::ExpectedArrayEnd | RonError::ExpectedStructLikeEnd => {
            "close the bracket after the last value that belongs in it"
        }
        RonError::NoSuchStructField { .. } => "correct or remove the field",
        RonError::MissingStructField { .. } => "add the field",
        RonError::DuplicateStructField { .. } => "keep one of them",
        RonError::ExpectedFloat | RonError::ExpectedInteger => "write a number such as 1 or 0.5",
        RonError::IntegerOutOfBounds => "count joints from 0, and leave `parent` out for a root",
        RonError::Message(_) => "correct the value",
        _ => "write `(joints: [(position: (0, 0, 0), radius: 0.1), ...])`",
    };
    let kind = SkeletonFileErrorKind::Ron {
        message: shorten(&error.code.to_string(), MAX_MESSAGE),
        fix,
    };
    SkeletonFileError::on_line(error.span.end.line as u64, kind)
}

/// Reads no more than [`MAX_JOINTS`] joints, whatever the length that the data claims.
fn bounded_joints<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<Joint>, D::Error> {
    struct Joints;

    impl<'de> Visitor<'de> for Joints {
        type Value = Vec<Joint>;

        fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
            formatter.write_str("a list of joints")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut data: A) -> Result<Vec<Joint>, A::Error> {
            let mut joints = Vec::new();
            while let Some(joint) = data.next_element()? {
                if joints.len() == MAX_JOINTS {
                    return Err(A::Error::custom(SkeletonError::TooManyJoints));
                }
                joints.push(joint);
            }
            Ok(joints)
        }
    }

    deserializer.deserialize_seq(Joints)
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    const FORK: &str = "(\n    joints: [\n        (position: (0, 0, 0), radius: 0.2),\n        \
        (position: (0, 1.5, 0), radius: 0.1, parent: 0),\n    ],\n)\n";

    fn message(text: &str) -> String {
        Skeleton::from_ron_str(text).unwrap_err().to_string()
    }

    #[test]
    fn numbers_survive_writing_and_reading_to_the_last_bit() {
        let root = Joint::root(Vec3::new(0.1, -0.0, 16_777_217.0 / 3e2), f32::MIN_POSITIVE);
        let tip = Joint::new(Vec3::new(-1e-30, 1.0 / 3.0, 1e6), 1e5, 0)
            .with_twist(core::f32::consts::PI)
            .with_texture_length(1e-38);
        let skeleton = Skeleton::new(vec![root, tip])
            .unwrap()
            .with_offset(DVec3::new(384_512.1, 6_671_034.3, -1e-300))
            .unwrap();
        assert_eq!(Skeleton::from_ron_str(&skeleton.to_ron()), Ok(skeleton));
    }

    #[test]
    fn the_written_form_has_a_joint_a_line_and_only_what_differs() {
        let skeleton = Skeleton::from_ron_str(FORK).unwrap();
        let expected = "(\n    joints: [\n        (position: (0.0, 0.0, 0.0), radius: 0.2),\n        \
            (position: (0.0, 1.5, 0.0), radius: 0.1, parent: 0),\n    ],\n)\n";
        assert_eq!(skeleton.to_ron(), expected);
    }

    #[test]
    fn options_may_be_written_out() {
        let fork = Skeleton::from_ron_str(FORK);
        assert!(fork.is_ok());
        for text in [
            FORK.replace("parent: 0", "parent: Some(0)"),
            FORK.replace("radius: 0.2", "radius: 0.2, parent: None, twist: 0"),
            format!("#![enable(implicit_some)]\nSkeleton{FORK}"),
            FORK.replace('\n', "\r\n"),
            FORK.replace("],", "], offset: (0, 0, 0), // where it stood"),
        ] {
            assert_eq!(Skeleton::from_ron_str(&text), fork, "{text}");
        }
    }

    #[test]
    fn mistakes_are_named_by_line_with_their_fix() {
        let cases = [
            (
                ", parent",
                ", colour: 3, parent",
                "line 4: Unexpected field named `colour`",
                "remove",
            ),
            (
                "radius: 0.1, ",
                "",
                "line 4: Unexpected missing field named `radius`",
                "add",
            ),
            (
                "parent: 0",
                "parent: -1",
                "line 4: Integer",
                "leave `parent` out",
            ),
            (
                "parent: 0",
                "parent: 4294967296",
                "line 4: Integer",
                "from 0",
            ),
            (
                "parent: 0",
                "parent: 0, parent: 0",
                "line 4: Unexpected duplicate",
                "one of them",
            ),
            (
                "radius: 0.1",
                "radius: wide",
                "line 4: Expected float",
                "number",
            ),
            (
                "(0, 1.5, 0)",
                "(0, 1.5)",
                "line 4: Expected a sequence of 3",
                "joints: [",
            ),
            (
                "],",
                "], colour: 3",
                "line 5: Unexpected field named `colour`",
                "remove",
            ),
        ];
        for (old, new, place, fix) in cases {
            let message = message(&FORK.replacen(old, new, 1));
            assert!(
                message.starts_with(&format!("<text>, {place}")),
                "{message}"
            );
            assert!(message.contains(fix), "{message}");
        }
    }

    #[test]
    fn joints_that_make_no_skeleton_are_named_by_index() {
        let cases = [
            ("radius: 0.1", "radius: NaN", "joint 1: radius is NaN"),
            ("radius: 0.2", "radius: 0", "joint 0: radius is 0"),
            ("1.5", "-inf", "joint 1: position"),
            ("parent: 0", "parent: 2", "joint 1: parent 2"),
            ("parent: 0", "parent: 1", "joint 1 is its own ancestor"),
            ("parent: 0", "twist: inf", "joint 1: twist is inf"),
            (
                "parent: 0",
                "texture_length: 0",
                "joint 1: texture_length is 0",
            ),
            (
                "],",
                "], offset: (0, NaN, 0)",
                "offset [0, NaN, 0] is not finite",
            ),
        ];
        for (old, new, what) in cases {
            let message = message(&FORK.replacen(old, new, 1));
            assert!(message.starts_with(&format!("<text>: {what}")), "{message}");
        }
        assert!(message("(joints: [])").contains("at least one joint"));
    }

    #[test]
    fn a_file_cut_short_anywhere_is_refused_as_such() {
        let text = FORK.trim_end();
        for end in 0..text.len() {
            let message = message(&text[..end]);
            assert!(message.contains("cut short"), "{end}: {message}");
        }
    }

    #[test]
    fn nesting_is_bounded() {
        for open in ["(", "[", "(joints: [", "(joints: [(position: (", "/*"] {
            assert!(Skeleton::from_ron_str(&open.repeat(100_000)).is_err());
        }
    }
}

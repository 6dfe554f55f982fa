//! `*.swc`: trees of neurons, and of anything else that is made of points with radii.
//!
//! One sample a line, `id type x y z radius parent`, with parent -1 for a root (R. C. Cannon et al., *An
//! on-line archive of reconstructed hippocampal neurons*, Journal of Neuroscience Methods 84, 1998; the
//! dialect of NeuroMorpho.Org). Samples may come in any order and form any number of trees, ids are any
//! whole numbers, `#` starts a comment, and columns after the seventh are left alone, as is the type.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use bevy::math::DVec3;

use super::error::{SkeletonError, SkeletonFileError, SkeletonFileErrorKind};
use super::frame::Frame;
use super::joint::Joint;
use super::settings::{SkeletonLoaderSettings, UpAxis};
use super::skeleton::{MAX_JOINTS, Skeleton};
use super::text::{id, lines, number};

/// What SWC writes for no parent.
const ROOT: i64 = -1;

/// One line of the file, in the file's units.
struct Sample {
    line: u64,
    position: DVec3,
    radius: f64,
    parent: i64,
}

/// Reads the text of an SWC file: a joint a sample, in the order of the file where that has parents first.
pub(super) fn read(
    text: &str,
    settings: &SkeletonLoaderSettings,
) -> Result<Skeleton, SkeletonFileError> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut index_of = HashMap::new();
    for (line, content) in lines(text) {
        let content = content.split('#').next().unwrap_or_default();
        let Some((id, sample)) =
            sample(line, content).map_err(|kind| SkeletonFileError::on_line(line, kind))?
        else {
            continue;
        };
        if samples.len() == MAX_JOINTS {
            return Err(SkeletonError::TooManyJoints.into());
        }
        match index_of.entry(id) {
            Entry::Vacant(entry) => entry.insert(samples.len() as u32),
            Entry::Occupied(entry) => {
                let first_line = samples[*entry.get() as usize].line;
                let kind = SkeletonFileErrorKind::DuplicateId { id, first_line };
                return Err(SkeletonFileError::on_line(line, kind));
            }
        };
        samples.push(sample);
    }

    let base = samples.iter().find(|sample| sample.parent == ROOT);
    let base = base.map_or(DVec3::ZERO, |sample| sample.position);
    let positions = samples.iter().map(|sample| sample.position);
    let frame = Frame::new(settings, UpAxis::Y, base, positions);
    let joints: Result<_, _> = samples
        .iter()
        .map(|sample| {
            joint(sample, &frame, &index_of)
                .map_err(|kind| SkeletonFileError::on_line(sample.line, kind))
        })
        .collect();
    let lines: Vec<_> = samples.iter().map(|sample| sample.line).collect();
    let skeleton = Skeleton::new(joints?);
    skeleton
        .and_then(|skeleton| frame.place(skeleton))
        .map_err(|error| SkeletonFileError::in_joints(error, &lines))
}

/// The sample on a line, with its id; none on a blank line.
fn sample(line: u64, content: &str) -> Result<Option<(i64, Sample)>, SkeletonFileErrorKind> {
    let mut columns = [""; 7];
    let mut found = 0;
    for (column, word) in columns.iter_mut().zip(content.split_whitespace()) {
        *column = word;
        found += 1;
    }
    if found == 0 {
        return Ok(None);
    }
    if found < columns.len() {
        return Err(SkeletonFileErrorKind::SwcColumns { found });
    }
    let [own_id, _type, x, y, z, radius, parent] = columns;
    let own_id = id(own_id, "id")?;
    let position = DVec3::new(number(x, "x")?, number(y, "y")?, number(z, "z")?);
    let radius = number(radius, "radius")?;
    let parent = id(parent, "parent")?;
    let sample = Sample {
        line,
        position,
        radius,
        parent,
    };
    Ok(Some((own_id, sample)))
}

fn joint(
    sample: &Sample,
    frame: &Frame,
    index_of: &HashMap<i64, u32>,
) -> Result<Joint, SkeletonFileErrorKind> {
    let position = frame.position(sample.position);
    let radius = frame.radius(sample.radius)?;
    let parent = sample.parent;
    if parent == ROOT {
        return Ok(Joint::root(position, radius));
    }
    match index_of.get(&parent) {
        Some(&index) => Ok(Joint::new(position, radius, index)),
        None => Err(SkeletonFileErrorKind::MissingParent { parent }),
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    fn parse(text: &str) -> Result<Skeleton, SkeletonFileError> {
        read(text, &SkeletonLoaderSettings::default())
    }

    fn message(text: &str) -> String {
        parse(text).unwrap_err().in_file("a.swc").to_string()
    }

    #[test]
    fn samples_become_joints_in_the_order_of_the_file() {
        let skeleton =
            parse("# a fork\n1 1 0 0 0 0.5 -1\n2 3 0 1 0 .25 1\n3 3 1 2 0 1e-1 2").unwrap();
        let expected = [
            Joint::root(Vec3::ZERO, 0.5),
            Joint::new(Vec3::Y, 0.25, 0),
            Joint::new(Vec3::new(1.0, 2.0, 0.0), 0.1, 1),
        ];
        assert_eq!(skeleton.joints(), expected);
        assert_eq!(skeleton.offset(), DVec3::ZERO);
    }

    #[test]
    fn layout_does_not_matter() {
        let plain = parse("1 1 0 0 0 0.5 -1\n2 3 0 1 0 0.25 1\n3 3 1 2 0 0.1 2\n").unwrap();
        let spellings = [
            "# comment\r\n\r\n 1\t1 0  0 0 0.5 -1 # base\r\n2 3 0 1 0 0.25 1\r\n3 3 1 2 0 0.1 2",
            "1 1 0 0 0 0.5 -1\r2 3 0 1 0 0.25 1\r3 3 1 2 0 0.1 2\r",
            "1 1 0 0 0 0.5 -1 extra 9\n2 3 0 1 0 0.25 1 8\n3 3 1 2 0 0.1 2#tip\n#\n",
            "1.0 1.0 0 0 0 0.5 -1.0\n2.0 3 0 1 0 0.25 1.0\n3 3 1 2 0 0.1 2.0\n",
        ];
        for text in spellings {
            assert_eq!(parse(text).as_ref(), Ok(&plain), "{text:?}");
        }
    }

    #[test]
    fn ids_are_names_and_samples_come_in_any_order() {
        let skeleton = parse("700 0 0 2 0 0.1 -3\n-3 0 0 1 0 0.2 12\n12 0 0 0 0 0.3 -1\n").unwrap();
        let expected = [
            Joint::root(Vec3::ZERO, 0.3),
            Joint::new(Vec3::Y, 0.2, 0),
            Joint::new(Vec3::Y * 2.0, 0.1, 1),
        ];
        assert_eq!(skeleton.joints(), expected);
    }

    #[test]
    fn there_may_be_several_trees() {
        let skeleton = parse("1 0 0 0 0 1 -1\n2 0 5 0 0 1 -1\n3 0 5 1 0 1 2\n").unwrap();
        assert_eq!((skeleton.len(), skeleton.segment_count()), (3, 1));
    }

    #[test]
    fn coordinates_far_away_are_moved_to_the_first_root() {
        let skeleton =
            parse("1 0 384512.25 6671034.5 112 1 -1\n2 0 384512.25 6671035.501 112 1 1\n").unwrap();
        assert_eq!(
            skeleton.offset(),
            DVec3::new(384_512.25, 6_671_034.5, 112.0)
        );
        assert_eq!(skeleton.joints()[0].position, Vec3::ZERO);
        // The coordinate is rounded to the f64 grid at 7e6, 1e-9 apart, and 1.001 to f32.
        assert!((skeleton.joints()[1].position.y - 1.001).abs() < 2e-7);
    }

    #[test]
    fn mistakes_are_named_by_line_with_their_fix() {
        let base = "1 1 0 0 0 0.5 -1\n";
        let cases = [
            ("\n2 3 0 1 0 0.25 7\n", "line 3: parent 7", "-1 for a root"),
            ("2 3 0 1 0 0.25 -2\n", "line 2: parent -2", "-1 for a root"),
            ("2 3 0 1 0 0.25 2\n", "line 2: is its own ancestor", "root"),
            ("1 3 0 1 0 0.25 1\n", "line 2: id 1", "line 1"),
            ("2 3 0 1 0 0 1\n", "line 2: radius is 0", "min_radius"),
            ("2 3 0 1 0 -1 1\n", "line 2: radius is -1", "min_radius"),
            ("2 3 0 1 0 NaN 1\n", "line 2: radius is `NaN`", "number"),
            ("2 3 0 inf 0 1 1\n", "line 2: y is `inf`", "number"),
            ("2 3 0 1", "line 2: the number of columns is 4", "cut short"),
            ("x 3 0 1 0 1 1", "line 2: id is `x`", "whole number"),
            (
                "2 3 0 9e5 0 1 1\n3 0 0 0 -2e6 1 2",
                "line 3: joint 2: position",
                "recentre",
            ),
        ];
        for (rest, place, fix) in cases {
            let message = message(&format!("{base}{rest}"));
            assert!(message.starts_with(&format!("a.swc, {place}")), "{message}");
            assert!(message.contains(fix), "{message}");
        }
    }

    #[test]
    fn a_file_without_samples_is_refused() {
        for text in ["", "\n\n", "# nothing here\n"] {
            assert!(message(text).contains("at least one joint"));
        }
    }
}

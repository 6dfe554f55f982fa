//! `*.csv`: quantitative structure models, the cylinders that are fitted to laser scans of trees.
//!
//! A table with a cylinder a row, as TreeQSM (P. Raumonen et al., *Fast automatic precision tree models
//! from terrestrial laser scanner data*, Remote Sensing 5, 2013) and tools like it write it. Columns are
//! found by their names in the header (`header`): start, end or axis and length, radius or diameter,
//! parent, and id if there is one. Commas, semicolons or tabs separate them, fields may be quoted, `#` starts
//! a line of comment. Parents are ids, or where there are none, numbers of rows counted from 1; -1, nothing
//! and NA stand for no parent, and so does 0 unless a cylinder has that id.
//!
//! # From cylinders to joints
//!
//! A cylinder's end becomes a joint of the cylinder's radius. Where its start lies is decided by distance:
//!
//! * within the larger of its own and its parent's radius from the parent's end, it is *welded* to it: the
//!   new joint grows from the parent's, so that the frusta meet in a join;
//! * else, as where a branch leaves the side of a long cylinder, it becomes a root of its own. Any segment
//!   from the parent's joints to it would draw wood that is not there; a root leaves the cylinder as it was
//!   measured, and the cap of its start is hidden in the parent.
//!
//! So a tree may have many roots, and a cylinder is drawn as a frustum that tapers to its own radius.

mod header;
mod table;

use std::collections::HashMap;

use bevy::math::DVec3;

use self::table::{Cylinder, cylinders};
use super::error::{SkeletonFileError, SkeletonFileErrorKind};
use super::frame::Frame;
use super::joint::Joint;
use super::order::parents_first;
use super::settings::{SkeletonLoaderSettings, UpAxis};
use super::skeleton::Skeleton;

/// Reads the text of a cylinder table: for each row, in the order of the file where that has parents first,
/// a joint at its start unless it is welded, and a joint at its end.
pub(super) fn read(
    text: &str,
    settings: &SkeletonLoaderSettings,
) -> Result<Skeleton, SkeletonFileError> {
    let rows = cylinders(text)?;
    let parents = parent_rows(&rows)?;
    let root = parents.iter().position(Option::is_none);
    let base = root.map_or(DVec3::ZERO, |root| rows[root].start);
    let points = rows.iter().flat_map(|row| [row.start, row.end]);
    let frame = Frame::new(settings, UpAxis::Z, base, points);

    let radius = |row: &Cylinder| {
        frame
            .radius(row.radius)
            .map_err(|kind| SkeletonFileError::on_line(row.line, kind))
    };
    let radii = rows.iter().map(radius).collect::<Result<Vec<_>, _>>()?;
    let is_welded = |row: usize, parent: u32| {
        let parent = parent as usize;
        let gap = frame.metres(rows[row].start.distance(rows[parent].end));
        gap <= f64::from(radii[row].max(radii[parent]))
    };
    let welds = parents.iter().enumerate();
    let welds = welds.map(|(row, parent)| parent.filter(|&parent| is_welded(row, parent)));
    let welds: Vec<Option<u32>> = welds.collect();

    // A row's last joint is at its end; a parent may be a later row.
    let mut count = 0;
    let end_joints = welds.iter().map(|weld| {
        count += if weld.is_some() { 1 } else { 2 };
        count - 1
    });
    let end_joints: Vec<u32> = end_joints.collect();

    let mut joints = Vec::new();
    let mut lines = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let radius = radii[index];
        let start = match welds[index] {
            Some(parent) => end_joints[parent as usize],
            None => {
                joints.push(Joint::root(frame.position(row.start), radius));
                lines.push(row.line);
                end_joints[index] - 1
            }
        };
        joints.push(Joint::new(frame.position(row.end), radius, start));
        lines.push(row.line);
    }
    Skeleton::new(joints)
        .and_then(|skeleton| frame.place(skeleton))
        .map_err(|error| SkeletonFileError::in_joints(error, &lines))
}

/// The row of each row's parent, after checking that there is one and that no row is its own ancestor.
fn parent_rows(rows: &[Cylinder]) -> Result<Vec<Option<u32>>, SkeletonFileError> {
    let row_of = rows_by_id(rows)?;
    let find = |parent: i64| match &row_of {
        Some(row_of) => row_of.get(&parent).copied(),
        None => {
            let row = parent
                .checked_sub(1)
                .and_then(|row| u32::try_from(row).ok());
            row.filter(|&row| (row as usize) < rows.len())
        }
    };
    let parent_row = |row: &Cylinder| match row.parent.map(|parent| (parent, find(parent))) {
        None | Some((0, None)) => Ok(None),
        Some((parent, None)) => {
            let kind = SkeletonFileErrorKind::MissingParent { parent };
            Err(SkeletonFileError::on_line(row.line, kind))
        }
        Some((_, found)) => Ok(found),
    };
    let parents = rows.iter().map(parent_row).collect::<Result<Vec<_>, _>>()?;
    match parents_first(&parents) {
        Ok(_) => Ok(parents),
        Err(row) => Err(SkeletonFileError::on_line(
            rows[row as usize].line,
            SkeletonFileErrorKind::Cycle,
        )),
    }
}

/// Which row has which id; none when rows have no ids.
fn rows_by_id(rows: &[Cylinder]) -> Result<Option<HashMap<i64, u32>>, SkeletonFileError> {
    let mut row_of = HashMap::new();
    for (row, index) in rows.iter().zip(0..) {
        let Some(id) = row.id else {
            return Ok(None);
        };
        if let Some(first) = row_of.insert(id, index) {
            let first_line = rows[first as usize].line;
            let kind = SkeletonFileErrorKind::DuplicateId { id, first_line };
            return Err(SkeletonFileError::on_line(row.line, kind));
        }
    }
    Ok(Some(row_of))
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec3;

    use super::*;

    const HEADER: &str = "id,parent,start_x,start_y,start_z,end_x,end_y,end_z,radius\n";

    fn parse(text: &str) -> Result<Skeleton, SkeletonFileError> {
        let settings = SkeletonLoaderSettings {
            up: Some(UpAxis::Y),
            ..Default::default()
        };
        read(text, &settings)
    }

    #[test]
    fn cylinders_end_to_end_share_a_joint() {
        let text = format!("{HEADER}1,0,0,0,0,0,1,0,0.2\n2,1,0,1,0,1,2,0,0.1\n");
        let expected = [
            Joint::root(Vec3::ZERO, 0.2),
            Joint::new(Vec3::Y, 0.2, 0),
            Joint::new(Vec3::new(1.0, 2.0, 0.0), 0.1, 1),
        ];
        assert_eq!(parse(&text).unwrap().joints(), expected);
    }

    #[test]
    fn a_start_within_the_larger_radius_is_welded_and_one_beyond_is_a_root() {
        for (gap, joints) in [(0.0, 3), (0.2, 3), (0.21, 4)] {
            let text = format!("{HEADER}1,0,0,0,0,0,1,0,0.2\n2,1,{gap},1,0,1,1,0,0.1\n");
            let skeleton = parse(&text).unwrap();
            assert_eq!(skeleton.len(), joints, "gap {gap}");
            assert_eq!(skeleton.segment_count(), 2, "gap {gap}");
        }
    }

    #[test]
    fn a_branch_from_the_side_starts_where_it_was_measured() {
        let rows = "1,0,0,0,0,0,10,0,0.2\n2,1,0.1,5,0,3,6,0,0.05\n3,2,3,6,0,4,8,0,0.02\n";
        let expected = [
            Joint::root(Vec3::ZERO, 0.2),
            Joint::new(Vec3::Y * 10.0, 0.2, 0),
            Joint::root(Vec3::new(0.1, 5.0, 0.0), 0.05),
            Joint::new(Vec3::new(3.0, 6.0, 0.0), 0.05, 2),
            Joint::new(Vec3::new(4.0, 8.0, 0.0), 0.02, 3),
        ];
        let skeleton = parse(&format!("{HEADER}{rows}")).unwrap();
        assert_eq!(skeleton.joints(), expected);
    }

    #[test]
    fn parents_may_come_after_their_children() {
        let (trunk, twig) = ("1,0,0,0,0,0,1,0,0.2\n", "2,1,0,1,0,0,2,0,0.1\n");
        let ordered = parse(&format!("{HEADER}{trunk}{twig}"));
        assert!(ordered.is_ok());
        assert_eq!(parse(&format!("{HEADER}{twig}{trunk}")), ordered);
    }

    #[test]
    fn without_ids_parents_are_row_numbers_from_one() {
        let rows = "0,0,0,0,0,1,0,0.2\n1,0,1,0,0,2,0,0.1\n";
        let skeleton = parse(&format!("{}{rows}", &HEADER[3..])).unwrap();
        assert_eq!(skeleton.segment_count(), 2);
        assert_eq!(skeleton.joints()[2].parent, Some(1));
    }

    #[test]
    fn no_parent_is_written_in_several_ways() {
        for none in ["0", "-1", ""] {
            let text = format!("{HEADER}7,{none},0,0,0,0,1,0,0.2\n");
            assert_eq!(parse(&text).unwrap().len(), 2, "{none:?}");
        }
    }

    #[test]
    fn zero_is_a_parent_where_it_is_an_id() {
        let text = format!("{HEADER}0,-1,0,0,0,0,1,0,0.2\n1,0,0,1,0,0,2,0,0.1\n");
        assert_eq!(parse(&text).unwrap().len(), 3);
    }

    #[test]
    fn z_is_up_unless_the_settings_say_otherwise() {
        let text = format!("{HEADER}1,0,0,0,0,1,2,3,0.2\n");
        let skeleton = read(&text, &SkeletonLoaderSettings::default()).unwrap();
        assert_eq!(skeleton.joints()[1].position, Vec3::new(1.0, 3.0, -2.0));
    }

    #[test]
    fn map_coordinates_become_local_and_the_offset_is_kept() {
        let header = "parent,sx,sy,sz,ax,ay,az,length,radius\n";
        let row = "0,384512.25,6671034.5,112,0,0,1,1.001,0.2\n";
        let text = format!("{header}{row}");
        let skeleton = read(&text, &SkeletonLoaderSettings::default()).unwrap();
        let base = DVec3::new(384_512.25, 6_671_034.5, 112.0);
        assert_eq!(skeleton.offset(), base);
        // 113.001 is rounded to the f64 grid, 1e-14 apart, and 1.001 to f32.
        assert!((skeleton.joints()[1].position.y - 1.001).abs() < 2e-7);
    }

    #[test]
    fn mistakes_are_named_by_line_with_their_fix() {
        let cases = [
            ("2,7,0,1,0,0,2,0,0.1", "line 3: parent 7", "-1 for a root"),
            ("2,-2,0,1,0,0,2,0,0.1", "line 3: parent -2", "-1 for a root"),
            ("2,2,0,1,0,0,2,0,0.1", "line 3: is its own ancestor", "root"),
            ("1,1,0,1,0,0,2,0,0.1", "line 3: id 1", "line 2"),
            ("2,1,0,1,0,0,2,0,0", "line 3: radius is 0", "min_radius"),
            ("2,1,0,1,0,0,2,0,NaN", "line 3: radius is `NaN`", "number"),
            ("\n2,1,0,1,0,0,inf,0,1", "line 4: end y is `inf`", "number"),
            (
                "2,1,0,1,0",
                "line 3: the number of fields is 5",
                "cut short",
            ),
            (
                "r2,2,1,0,1,0,0,2,0,1",
                "line 3: the number of fields is 10",
                "row names",
            ),
            ("x,1,0,1,0,0,2,0,1", "line 3: id is `x`", "whole number"),
            (
                "2,1.5,0,1,0,0,2,0,1",
                "line 3: parent is `1.5`",
                "whole number",
            ),
            (
                "2,1,0,1,0,0,2e6,0,1",
                "line 3: joint 2: position",
                "recentre",
            ),
        ];
        for (row, place, fix) in cases {
            let text = format!("{HEADER}1,0,0,0,0,0,1,0,0.2\n{row}");
            let message = parse(&text).unwrap_err().in_file("a.csv").to_string();
            assert!(message.starts_with(&format!("a.csv, {place}")), "{message}");
            assert!(message.contains(fix), "{message}");
        }
    }

    #[test]
    fn a_table_without_rows_is_refused() {
        let error = parse(HEADER).unwrap_err();
        assert!(error.to_string().contains("at least one joint"));
    }
}

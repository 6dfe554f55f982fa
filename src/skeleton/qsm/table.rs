//! The rows of a cylinder table: one cylinder each, in the file's units.

use std::iter;

use bevy::math::DVec3;

use super::super::error::{SkeletonError, SkeletonFileError, SkeletonFileErrorKind};
use super::super::skeleton::MAX_JOINTS;
use super::super::text::{id, lines, number};
use super::header::{Columns, Extent};

/// What always stands for no parent.
const NO_PARENT: i64 = -1;

/// One row of the table, in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cylinder {
    pub line: u64,
    pub id: Option<i64>,
    pub start: DVec3,
    pub end: DVec3,
    pub radius: f64,
    pub parent: Option<i64>,
}

/// All rows of the table.
pub(super) fn cylinders(text: &str) -> Result<Vec<Cylinder>, SkeletonFileError> {
    let is_content = |line: &str| !line.trim().is_empty() && !line.starts_with('#');
    let mut table = lines(text).filter(|(_, line)| is_content(line));
    let Some((line, header)) = table.next() else {
        return Err(SkeletonFileErrorKind::NoHeader.into());
    };
    let on_line = |line| move |kind| SkeletonFileError::on_line(line, kind);
    let separator = separator(header).map_err(on_line(line))?;
    let columns = Columns::find(fields(header, separator)).map_err(on_line(line))?;
    let mut rows = Vec::new();
    let mut row = Vec::new();
    for (line, content) in table {
        if rows.len() == MAX_JOINTS {
            return Err(SkeletonError::TooManyJoints.into());
        }
        row.clear();
        row.extend(fields(content, separator));
        rows.push(cylinder(&columns, &row, line).map_err(on_line(line))?);
    }
    Ok(rows)
}

/// What separates the columns of a table: whichever of the three its header has most of.
fn separator(header: &str) -> Result<u8, SkeletonFileErrorKind> {
    let count = |separator: &u8| header.bytes().filter(|byte| byte == separator).count();
    [b'\t', b';', b',']
        .into_iter()
        .max_by_key(count)
        .filter(|separator| count(separator) > 0)
        .ok_or(SkeletonFileErrorKind::NoHeader)
}

/// The fields of a line, without quotes and spaces round them. A separator between quotes separates nothing.
fn fields(line: &str, separator: u8) -> impl Iterator<Item = &str> {
    let mut rest = Some(line);
    iter::from_fn(move || {
        let line = rest?;
        let mut quoted = false;
        let end = line.bytes().position(|byte| {
            quoted ^= byte == b'"';
            byte == separator && !quoted
        });
        rest = end.map(|end| &line[end + 1..]);
        let field = line[..end.unwrap_or(line.len())].trim();
        Some(field.trim_matches('"').trim())
    })
}

/// The cylinder in a row.
fn cylinder(columns: &Columns, row: &[&str], line: u64) -> Result<Cylinder, SkeletonFileErrorKind> {
    let (found, expected) = (row.len(), columns.count);
    // A separator at the end of a row is no field.
    if found < expected || row[expected..].iter().any(|field| !field.is_empty()) {
        return Err(SkeletonFileErrorKind::Fields { found, expected });
    }
    let point = |fields: [usize; 3], names: [&'static str; 3]| {
        Ok::<_, SkeletonFileErrorKind>(DVec3::new(
            number(row[fields[0]], names[0])?,
            number(row[fields[1]], names[1])?,
            number(row[fields[2]], names[2])?,
        ))
    };
    let start = point(columns.start, ["start x", "start y", "start z"])?;
    let end = match columns.extent {
        Extent::End(end) => point(end, ["end x", "end y", "end z"])?,
        Extent::Axis(axis, length) => {
            let axis = point(axis, ["axis x", "axis y", "axis z"])?;
            start + along(axis, number(row[length], "length")?)?
        }
    };
    let radius = number(row[columns.thickness], "radius")? * columns.radius_factor;
    let parent = match row[columns.parent] {
        "" | "NA" => None,
        text => Some(id(text, "parent")?).filter(|&parent| parent != NO_PARENT),
    };
    let id = columns.id.map(|field| id(row[field], "id")).transpose()?;
    Ok(Cylinder {
        line,
        id,
        start,
        end,
        radius,
        parent,
    })
}

/// The vector of this `length` along `axis`, whose own length does not matter.
fn along(axis: DVec3, length: f64) -> Result<DVec3, SkeletonFileErrorKind> {
    match axis.try_normalize() {
        Some(direction) if length >= 0.0 => Ok(direction * length),
        None if length == 0.0 => Ok(DVec3::ZERO),
        _ => Err(SkeletonFileErrorKind::Axis { length, axis }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "\
id,parent,start_x,start_y,start_z,end_x,end_y,end_z,radius
1,0,0,0,0,0,1,0,0.2
2,1,0,1,0,1,2,0,0.1
";

    /// The cylinders, as if they all stood on line 0.
    fn parse(text: &str) -> Vec<Cylinder> {
        let mut rows = cylinders(text).unwrap();
        rows.iter_mut().for_each(|row| row.line = 0);
        rows
    }

    #[test]
    fn a_row_is_a_cylinder_and_knows_its_line() {
        let expected = Cylinder {
            line: 3,
            id: Some(2),
            start: DVec3::Y,
            end: DVec3::new(1.0, 2.0, 0.0),
            radius: 0.1,
            parent: Some(1),
        };
        assert_eq!(cylinders(TABLE).unwrap()[1], expected);
    }

    #[test]
    fn separators_quotes_and_blank_lines_do_not_matter() {
        let expected = parse(TABLE);
        for text in [
            TABLE.replace(',', ";"),
            TABLE.replace(',', "\t"),
            TABLE.replace(',', " , "),
            TABLE.replace('\n', ",\r\n"),
            TABLE.replace('\n', "\r"),
            TABLE.replace('\n', "\n\n# comment\n \n"),
            format!("\n# made by hand\n{TABLE}"),
            TABLE.replace("start_x", "\"start, x (m)\""),
        ] {
            assert_eq!(parse(&text), expected, "{text:?}");
        }
    }

    #[test]
    fn no_parent_is_minus_one_or_nothing() {
        for none in ["-1", "-1.0", "", "NA", "\"\""] {
            let text = TABLE.replace("2,1,", &format!("2,{none},"));
            assert_eq!(parse(&text)[1].parent, None, "{none:?}");
        }
        assert_eq!(parse(TABLE)[0].parent, Some(0));
    }

    #[test]
    fn an_axis_and_a_length_make_an_end() {
        let table = |row| format!("parent,sx,sy,sz,ax,ay,az,length,diameter\n{row}\n");
        // The axis need not be a unit vector: tools round it.
        let cylinder = &parse(&table("0,1,0,0,0,0.5,0,3,0.4"))[0];
        assert_eq!(cylinder.end, DVec3::new(1.0, 3.0, 0.0));
        assert_eq!(cylinder.radius, 0.2);
        let point = &parse(&table("0,1,0,0,0,0,0,0,0.4"))[0];
        assert_eq!(point.end, point.start);
        for bad in ["0,1,0,0,0,0,0,3,0.4", "0,1,0,0,0,1,0,-3,0.4"] {
            let error = cylinders(&table(bad)).unwrap_err();
            assert!(matches!(error.kind, SkeletonFileErrorKind::Axis { .. }));
        }
    }

    #[test]
    fn a_table_needs_a_header() {
        for text in ["", "\n#\n", "id parent radius\n", "(joints: [])"] {
            let error = cylinders(text).unwrap_err();
            assert_eq!(error.kind, SkeletonFileErrorKind::NoHeader, "{text:?}");
        }
        let error = cylinders("\n1,0,0,0,0,0,1,0,0.2\n").unwrap_err();
        assert_eq!(error.line, Some(2));
        assert!(error.to_string().contains("name it start_x"));
    }
}

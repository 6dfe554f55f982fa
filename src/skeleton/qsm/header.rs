//! The header of a cylinder table: which column holds what, whatever the tool calls it.

use super::super::error::SkeletonFileErrorKind;

/// Letters and digits that tools put behind a point's name, for its three coordinates.
const AXES: [[&str; 2]; 3] = [["x", "1"], ["y", "2"], ["z", "3"]];

/// Names of points and directions, as they are compared. One alone, without a coordinate behind it, stands
/// for three columns, as in the text files that TreeQSM writes.
const START: &[&str] = &["start", "startpoint", "s"];
const END: &[&str] = &["end", "endpoint", "e"];
const AXIS: &[&str] = &["axis", "axisdirection", "a"];

/// Names of the other columns, as they are compared. When a table has several of them, the first counts.
const LENGTH: &[&str] = &["length", "len", "cylinderlength"];
const RADIUS: &[&str] = &["radius", "r", "cylinderradius"];
const DIAMETER: &[&str] = &["diameter", "diam", "d", "cylinderdiameter"];
const PARENT: &[&str] = &[
    "parent",
    "parentid",
    "parentcylinder",
    "parentcylinderid",
    "parentcylid",
    "p2",
];
const ID: &[&str] = &["id", "cylinderid", "cylid", "p1"];

/// Which field of a row holds what.
#[derive(Debug, PartialEq)]
pub(super) struct Columns {
    pub start: [usize; 3],
    pub extent: Extent,
    /// The field of the radius, or of the diameter.
    pub thickness: usize,
    /// What to multiply thickness by to get the radius: 1, or ½ for a diameter.
    pub radius_factor: f64,
    pub parent: usize,
    /// Without ids, parents are numbers of rows, counted from 1.
    pub id: Option<usize>,
    /// How many fields a row has.
    pub count: usize,
}

/// How a cylinder gets from its start to its end.
#[derive(Debug, PartialEq)]
pub(super) enum Extent {
    /// By the fields of its end.
    End([usize; 3]),
    /// By the fields of its axis, of any length, and its length.
    Axis([usize; 3], usize),
}

impl Columns {
    /// Finds the columns by the names in a table's header.
    pub fn find<'a>(header: impl Iterator<Item = &'a str>) -> Result<Self, SkeletonFileErrorKind> {
        let names = Names::new(header);
        let start = names.point(START)?.ok_or(missing(
            "where a cylinder starts",
            "start_x, start_y and start_z",
        ))?;
        let extent = match (names.point(END)?, names.point(AXIS)?, names.field(LENGTH)?) {
            (Some(end), _, _) => Extent::End(end),
            (None, Some(axis), Some(length)) => Extent::Axis(axis, length),
            _ => {
                return Err(missing(
                    "where a cylinder ends",
                    "end_x, end_y and end_z, or axis_x, axis_y, axis_z and length",
                ));
            }
        };
        let (thickness, radius_factor) = match (names.field(RADIUS)?, names.field(DIAMETER)?) {
            (Some(radius), _) => (radius, 1.0),
            (None, Some(diameter)) => (diameter, 0.5),
            (None, None) => return Err(missing("the radius", "radius or diameter")),
        };
        let parent = names
            .field(PARENT)?
            .ok_or(missing("the parent", "parent or parent_id"))?;
        Ok(Self {
            start,
            extent,
            thickness,
            radius_factor,
            parent,
            id: names.field(ID)?,
            count: names.0.len(),
        })
    }
}

fn missing(what: &'static str, names: &'static str) -> SkeletonFileErrorKind {
    SkeletonFileErrorKind::MissingColumn { what, names }
}

/// The comparable name of each field of a row.
struct Names(Vec<String>);

impl Names {
    fn new<'a>(header: impl Iterator<Item = &'a str>) -> Self {
        let mut names: Vec<_> = header.map(comparable).collect();
        // A separator at the end of the header names no column.
        while names.pop_if(|name| name.is_empty()).is_some() {}
        let is_point = |name: &String| {
            let points = [START, END, AXIS];
            points.iter().any(|point| point.contains(&name.as_str()))
        };
        let fields = names.into_iter().flat_map(|name| {
            if is_point(&name) {
                AXES.map(|[axis, _]| format!("{name}{axis}")).to_vec()
            } else {
                vec![name]
            }
        });
        Self(fields.collect())
    }

    /// The field with the first of these `names` that there is.
    fn field(&self, names: &[&str]) -> Result<Option<usize>, SkeletonFileErrorKind> {
        for name in names {
            let mut fields = (0..self.0.len()).filter(|&field| self.0[field] == *name);
            match (fields.next(), fields.next()) {
                (Some(_), Some(_)) => {
                    let name = (*name).to_owned();
                    return Err(SkeletonFileErrorKind::DuplicateColumn { name });
                }
                (Some(field), None) => return Ok(Some(field)),
                (None, _) => {}
            }
        }
        Ok(None)
    }

    /// The three fields of a point, if it has all of them, by the first of these `names` that has.
    fn point(&self, names: &[&str]) -> Result<Option<[usize; 3]>, SkeletonFileErrorKind> {
        for name in names {
            let mut point = [None; 3];
            for (field, axis) in point.iter_mut().zip(AXES) {
                let spellings = axis.map(|axis| format!("{name}{axis}"));
                *field = self.field(&spellings.each_ref().map(String::as_str))?;
            }
            if let [Some(x), Some(y), Some(z)] = point {
                return Ok(Some([x, y, z]));
            }
        }
        Ok(None)
    }
}

/// A column's name as it is compared: small letters and digits, without a unit in brackets.
fn comparable(name: &str) -> String {
    let mut depth = 0_u32;
    let outside = name.chars().filter(|character| match character {
        '(' | '[' => {
            depth += 1;
            false
        }
        ')' | ']' => {
            depth = depth.saturating_sub(1);
            false
        }
        _ => depth == 0,
    });
    outside
        .filter(|character| character.is_ascii_alphanumeric())
        .map(|character| character.to_ascii_lowercase())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(header: &str) -> Result<Columns, SkeletonFileErrorKind> {
        Columns::find(header.split(','))
    }

    #[test]
    fn case_spaces_punctuation_and_units_do_not_matter() {
        assert_eq!(comparable(" Start_X (m)"), "startx");
        assert_eq!(comparable("axis.1"), "axis1");
        assert_eq!(comparable("Radius [m] (fitted)"), "radius");
    }

    #[test]
    fn ends_are_preferred_to_axes() {
        let columns = find(
            "id,parent,start_x,start_y,start_z,axis_x,axis_y,axis_z,length,end_x,end_y,end_z,radius",
        );
        let expected = Columns {
            start: [2, 3, 4],
            extent: Extent::End([9, 10, 11]),
            thickness: 12,
            radius_factor: 1.0,
            parent: 1,
            id: Some(0),
            count: 13,
        };
        assert_eq!(columns, Ok(expected));
    }

    #[test]
    fn spellings_of_several_tools_are_understood() {
        let rows = [
            "parent,start.1,start.2,start.3,axis.1,axis.2,axis.3,length,radius",
            "p2,sx,sy,sz,ax,ay,az,length,radius",
            "Parent Cylinder,Start Point X,Start Point Y,Start Point Z,axisX,axisY,axisZ,LENGTH,Radius (m)",
        ];
        for row in rows {
            let columns = find(row).unwrap();
            assert_eq!((columns.parent, columns.start), (0, [1, 2, 3]), "{row}");
            assert_eq!(columns.extent, Extent::Axis([4, 5, 6], 7), "{row}");
            assert_eq!((columns.thickness, columns.id), (8, None), "{row}");
        }
    }

    #[test]
    fn a_point_named_once_takes_three_columns() {
        let columns = find(
            "radius (m),length (m),start_point,axis_direction,parent,extension,UnmodRadius (m)",
        )
        .unwrap();
        assert_eq!(columns.start, [2, 3, 4]);
        assert_eq!(columns.extent, Extent::Axis([5, 6, 7], 1));
        assert_eq!((columns.parent, columns.count), (8, 11));
    }

    #[test]
    fn a_diameter_is_halved_unless_there_is_a_radius() {
        let columns = find("parent,sx,sy,sz,ex,ey,ez,diameter").unwrap();
        assert_eq!((columns.thickness, columns.radius_factor), (7, 0.5));
        let columns = find("parent,sx,sy,sz,ex,ey,ez,diameter,radius").unwrap();
        assert_eq!((columns.thickness, columns.radius_factor), (8, 1.0));
    }

    #[test]
    fn what_is_missing_is_named_with_names_to_use() {
        let cases = [
            ("parent,ex,ey,ez,radius", "start_x"),
            ("parent,sx,sy,ex,ey,ez,radius", "start_x"),
            ("parent,sx,sy,sz,ax,ay,az,radius", "length"),
            ("parent,sx,sy,sz,ex,ey,ez", "diameter"),
            ("sx,sy,sz,ex,ey,ez,radius", "parent_id"),
            ("", "start_x"),
        ];
        for (header, hint) in cases {
            let message = find(header).unwrap_err().to_string();
            assert!(message.contains(hint), "{header}: {message}");
        }
    }

    #[test]
    fn one_name_for_two_columns_is_refused() {
        let error = find("parent,sx,sy,sz,ex,ey,ez,radius (m),Radius (cm)");
        let name = "radius".to_owned();
        assert_eq!(error, Err(SkeletonFileErrorKind::DuplicateColumn { name }));
    }
}

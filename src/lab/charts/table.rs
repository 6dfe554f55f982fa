//! The figures of a chart as CSV (RFC 4180): one row a point.

use super::Chart;

/// Digits that are kept: more than a measurement has, few enough to be the same from machine to machine.
const DIGITS: usize = 6;

impl Chart {
    /// The chart as CSV: the columns `series`, `x`, `y`, `label`, `marked` and `adapter`, which holds the subtitle.
    pub fn to_csv(&self) -> String {
        let mut rows = String::from("series,x,y,label,marked,adapter\n");
        for series in &self.series {
            for point in &series.points {
                let row = [
                    quoted(&series.name),
                    number(point.x),
                    number(point.y),
                    quoted(point.label.as_deref().unwrap_or_default()),
                    point.marked.to_string(),
                    quoted(&self.subtitle),
                ];
                rows.push_str(&row.join(","));
                rows.push('\n');
            }
        }
        rows
    }
}

/// A number of six digits; `inf`, `-inf` or `NaN` where it is none.
fn number(value: f64) -> String {
    let digits = DIGITS - 1;
    let rounded = format!("{value:.digits$e}").parse().unwrap_or(value);
    let size = f64::abs(rounded);
    if size != 0.0 && size.is_finite() && !(1e-3..1e7).contains(&size) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

/// A field, in quotes where it needs them.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.into()
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Axis, Point, Series};
    use super::*;

    #[test]
    fn every_point_has_a_row_also_those_that_no_picture_shows() {
        let chart = Chart {
            title: "t".into(),
            subtitle: "llvmpipe, 256 bits".into(),
            x: Axis::linear("x"),
            y: Axis::log("y"),
            series: vec![
                Series::line("a \"b\"", [(1.0, f64::INFINITY), (2.0, f64::NAN)]),
                Series::scatter(
                    "c",
                    [
                        Point::from((0.1, 0.0)).labelled("8 steps").marked(true),
                        Point::from((1.0 / 3.0, 1e-16)),
                    ],
                ),
            ],
        };
        assert_eq!(
            chart.to_csv(),
            "series,x,y,label,marked,adapter\n\
             \"a \"\"b\"\"\",1,inf,,false,\"llvmpipe, 256 bits\"\n\
             \"a \"\"b\"\"\",2,NaN,,false,\"llvmpipe, 256 bits\"\n\
             c,0.1,0,8 steps,true,\"llvmpipe, 256 bits\"\n\
             c,0.333333,1e-16,,false,\"llvmpipe, 256 bits\"\n"
        );
    }
}

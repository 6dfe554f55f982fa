//! Where on the page everything goes: title, legend, axes, and the points between them.
//!
//! The legend stands above the plot and takes as many rows as it needs, so that it hides no point.

use plotters::backend::DrawingBackend;
use plotters::style::RGBColor;

use super::canvas::{Anchor, Canvas, Place, text_width};
use super::mark::Mark;
use super::scale::Span;
use super::{Chart, Point, SIZE, Scale, Series};

const INK: RGBColor = RGBColor(0, 0, 0);
const PALE_INK: RGBColor = RGBColor(90, 90, 90);
const GRID: RGBColor = RGBColor(222, 222, 222);

/// Empty space along the edges, in pixels.
const MARGIN: f64 = 18.0;
/// From one line of text to the next.
const LINE: f64 = 24.0;
/// Radius of a point.
const DOT: f64 = 4.5;
/// Radius of the ring round points that are the default.
const RING: f64 = 9.5;
/// What stands for the ring in the legend.
const RING_NAME: &str = "default";
/// Length of the sample before a name in the legend.
const SAMPLE: f64 = 36.0;
/// Between two names in the legend.
const GAP: f64 = 22.0;

/// Left, top, right and bottom of a box.
type Box4 = [f64; 4];

/// The plot between its axes.
struct Plot {
    area: Box4,
    x: Span,
    y: Span,
}

impl Plot {
    fn place(&self, x: f64, y: f64) -> Option<Place> {
        let [left, top, right, bottom] = self.area;
        let at = (self.x.at(x)?, self.y.at(y)?);
        Some((left + at.0 * (right - left), bottom - at.1 * (bottom - top)))
    }

    fn of(&self, point: &Point) -> Option<Place> {
        self.place(point.x, point.y)
    }
}

impl Chart {
    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &Canvas<DB>) -> Result<(), String> {
        let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
        let mut y = MARGIN + 0.5 * LINE - 6.0;
        canvas.text(&self.title, (MARGIN, y), Anchor::Left, INK)?;
        if !self.subtitle.is_empty() {
            y += LINE;
            canvas.text(&self.subtitle, (MARGIN, y), Anchor::Left, PALE_INK)?;
        }
        y = self.draw_legend(canvas, y + LINE + 4.0)?;
        // The vertical axis is named above it: text that is read without turning the head.
        y += LINE + 4.0;
        canvas.text(&self.y.label, (MARGIN, y), Anchor::Left, PALE_INK)?;

        let points = || self.series.iter().flat_map(|series| &series.points);
        let shown = |point: &&Point| {
            // A point that one axis cannot show does not stretch the other.
            let fits = |value: f64, axis: &super::Axis| {
                value.is_finite()
                    && (axis.scale == Scale::Linear || axis.floor.is_some() || value > 0.0)
            };
            fits(point.x, &self.x) && fits(point.y, &self.y)
        };
        let x_span = Span::new(&self.x, points().filter(shown).map(|point| point.x));
        let y_span = Span::new(&self.y, points().filter(shown).map(|point| point.y));
        let widest = y_span
            .ticks()
            .iter()
            .map(|&tick| text_width(&y_span.tick_label(tick)))
            .fold(0.0, f64::max);
        let plot = Plot {
            area: [
                MARGIN + widest + 10.0,
                y + 20.0,
                width - MARGIN - 12.0,
                height - MARGIN - 2.0 * LINE + 4.0,
            ],
            x: x_span,
            y: y_span,
        };
        self.draw_axes(canvas, &plot)?;
        for (i, series) in self.series.iter().enumerate() {
            draw_series(canvas, &plot, series, Mark::of(i))?;
        }
        self.draw_labels(canvas, &plot)
    }

    /// Draws the names of all series from a height on; returns the height of the last row.
    fn draw_legend<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        mut y: f64,
    ) -> Result<f64, String> {
        let (mut x, mut last) = (MARGIN, y);
        let mut advance = |name: &str| {
            let needed = SAMPLE + text_width(name);
            if x > MARGIN && x + needed > f64::from(SIZE.0) - MARGIN {
                (x, y) = (MARGIN, y + LINE);
            }
            let at = (x, y);
            x += needed + GAP;
            at
        };
        for (i, series) in self.series.iter().enumerate() {
            let at = advance(&series.name);
            let mark = Mark::of(i);
            if series.lines {
                canvas.line(&[at, (at.0 + SAMPLE - 8.0, at.1)], mark.colour, 2.0)?;
            }
            draw_mark(canvas, (at.0 + 0.5 * (SAMPLE - 8.0), at.1), mark)?;
            canvas.text(&series.name, (at.0 + SAMPLE, at.1), Anchor::Left, INK)?;
            last = at.1;
        }
        if (self.series.iter()).any(|series| series.points.iter().any(|point| point.marked)) {
            let at = advance(RING_NAME);
            canvas.ring((at.0 + 0.5 * (SAMPLE - 8.0), at.1), RING, INK)?;
            canvas.text(RING_NAME, (at.0 + SAMPLE, at.1), Anchor::Left, INK)?;
            last = at.1;
        }
        Ok(last)
    }

    fn draw_axes<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        plot: &Plot,
    ) -> Result<(), String> {
        let [left, top, right, bottom] = plot.area;
        for tick in plot.y.ticks() {
            let y = bottom - plot.y.at(tick).unwrap_or(0.0) * (bottom - top);
            canvas.line(&[(left, y), (right, y)], GRID, 1.0)?;
            let label = plot.y.tick_label(tick);
            canvas.text(&label, (left - 8.0, y), Anchor::Right, INK)?;
        }
        for tick in plot.x.ticks() {
            let x = left + plot.x.at(tick).unwrap_or(0.0) * (right - left);
            canvas.line(&[(x, top), (x, bottom + 5.0)], GRID, 1.0)?;
            let label = plot.x.tick_label(tick);
            canvas.text(&label, (x, bottom + 0.5 * LINE + 6.0), Anchor::Middle, INK)?;
        }
        canvas.line(&[(left, top), (left, bottom), (right, bottom)], INK, 1.0)?;
        let below = bottom + 1.5 * LINE + 6.0;
        canvas.text(&self.x.label, (right, below), Anchor::Right, PALE_INK)
    }

    /// Writes labels beside their points, in the colour of their series: those of the default first, each on the first
    /// side where it hides nothing.
    fn draw_labels<DB: DrawingBackend>(
        &self,
        canvas: &Canvas<DB>,
        plot: &Plot,
    ) -> Result<(), String> {
        let all = || {
            let series = self.series.iter().enumerate();
            series.flat_map(|(i, series)| series.points.iter().map(move |point| (i, point)))
        };
        let mut taken: Vec<Box4> = all()
            .filter_map(|(_, point)| {
                let (x, y) = plot.of(point)?;
                let half = if point.marked { RING } else { DOT };
                Some([x - half, y - half, x + half, y + half])
            })
            .collect();
        let marked = all().filter(|(_, point)| point.marked);
        for (i, point) in marked.chain(all().filter(|(_, point)| !point.marked)) {
            let (Some(label), Some((x, y))) = (&point.label, plot.of(point)) else {
                continue;
            };
            let width = text_width(label);
            let (half, off) = (0.4 * LINE, if point.marked { RING } else { DOT } + 4.0);
            let up = off + half;
            let sides = [
                (x + off, y),
                (x - off - width, y),
                (x + 2.0, y - up),
                (x + 2.0, y + up),
                (x - 2.0 - width, y - up),
                (x - 2.0 - width, y + up),
            ];
            let free = sides.into_iter().find_map(|(left, middle)| {
                let place = [left, middle - half, left + width, middle + half];
                let [_, top, right, bottom] = plot.area;
                let inside = place[0] > plot.area[0]
                    && place[1] > top - LINE
                    && place[2] < right + 12.0
                    && place[3] < bottom;
                (inside && !taken.iter().any(|other| overlap(other, &place))).then_some(place)
            });
            if let Some(place) = free {
                taken.push(place);
                let at = (place[0], 0.5 * (place[1] + place[3]));
                canvas.text(label, at, Anchor::Left, Mark::of(i).colour)?;
            }
        }
        Ok(())
    }
}

fn overlap(one: &Box4, other: &Box4) -> bool {
    one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3]
}

fn draw_series<DB: DrawingBackend>(
    canvas: &Canvas<DB>,
    plot: &Plot,
    series: &Series,
    mark: Mark,
) -> Result<(), String> {
    let places: Vec<_> = series.points.iter().map(|point| plot.of(point)).collect();
    if series.lines {
        for run in places.split(|place| place.is_none()) {
            let run: Vec<_> = run.iter().copied().flatten().collect();
            if run.len() > 1 {
                canvas.line(&run, mark.colour, 2.0)?;
            }
        }
    }
    for (point, place) in series.points.iter().zip(&places) {
        if let Some(place) = *place {
            draw_mark(canvas, place, mark)?;
            if point.marked {
                canvas.ring(place, RING, INK)?;
            }
        }
    }
    Ok(())
}

fn draw_mark<DB: DrawingBackend>(canvas: &Canvas<DB>, at: Place, mark: Mark) -> Result<(), String> {
    if mark.corners.is_empty() {
        return canvas.disc(at, DOT, mark.colour);
    }
    let corners: Vec<_> = mark
        .corners
        .iter()
        .map(|(x, y)| (at.0 + DOT * x, at.1 + DOT * y))
        .collect();
    canvas.polygon(&corners, mark.colour)
}

#[cfg(test)]
mod tests {
    use super::super::Axis;
    use super::*;

    fn chart(points: Vec<Point>) -> Chart {
        Chart {
            title: "Error against time".into(),
            subtitle: "some adapter".into(),
            x: Axis::log("time a frame (ms)"),
            y: Axis::log("mean FLIP"),
            series: vec![Series::line("frusta", points)],
        }
    }

    #[test]
    fn a_png_has_its_size_and_shows_its_points() {
        let points = [(1.0, 0.1), (2.0, 0.02)].map(Point::from);
        let decode = |chart: &Chart| {
            let png = chart.to_png().unwrap();
            image::load_from_memory(&png).unwrap().to_rgb8()
        };
        let full = decode(&chart(points.to_vec()));
        assert_eq!(full.dimensions(), SIZE);
        let blue = image::Rgb([0, 114, 178]);
        let count = |image: &image::RgbImage| image.pixels().filter(|&&p| p == blue).count();
        // An empty chart has blue in its legend alone: a disc and a line, of which less than 4 by 28 pixels show.
        let empty = count(&decode(&chart(vec![])));
        assert!(
            empty > 40 && count(&full) > 2 * empty,
            "{empty} {}",
            count(&full)
        );
    }

    #[test]
    fn what_cannot_be_shown_leaves_no_trace_in_the_picture() {
        let points = [(1.0, 0.1), (2.0, 0.02)].map(Point::from);
        let hidden = [
            (3.0, f64::INFINITY),
            (f64::NAN, 0.1),
            (1e9, 0.0),
            (1e9, -1.0),
        ];
        let with: Vec<_> = points
            .iter()
            .cloned()
            .chain(hidden.map(Point::from))
            .collect();
        assert_eq!(
            chart(with).to_svg().unwrap(),
            chart(points.to_vec()).to_svg().unwrap()
        );
    }

    #[test]
    fn an_svg_holds_its_text_and_a_ring_round_the_default() {
        let plain = vec![
            Point::from((1.0, 0.1)),
            Point::from((2.0, 0.02)).labelled("32 steps"),
        ];
        let svg = chart(plain.clone()).to_svg().unwrap();
        for text in [
            "Error against time",
            "some adapter",
            "mean FLIP",
            "32 steps",
        ] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(!svg.contains(RING_NAME));
        let marked = plain.into_iter().map(|point| point.marked(true)).collect();
        assert!(chart(marked).to_svg().unwrap().contains(RING_NAME));
    }
}

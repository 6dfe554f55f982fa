//! Lines and text on either kind of picture.
//!
//! Both are drawn a few times larger than they are shown: bitmaps are averaged down, for plotters draws their lines
//! without smoothing, and vector pictures are scaled down, for plotters rounds their coordinates to whole numbers.

use std::sync::OnceLock;

use bevy::text::DEFAULT_FONT_DATA;
use plotters::backend::{BitMapBackend, DrawingBackend, SVGBackend};
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{
    Color, FontFamily, FontStyle, IntoFont, RGBColor, TextStyle, WHITE, register_font,
};

use super::{Chart, SIZE};

/// How many times larger pictures are drawn.
const ZOOM: u32 = 3;
/// The size of all text, from the top of the highest to the bottom of the lowest character, in pixels.
pub(super) const TEXT: f64 = 18.0;
/// Width of a character of the font, in shares of [`TEXT`].
const ADVANCE: f64 = 0.49;

/// A place on the page, in pixels from the top left.
pub(super) type Place = (f64, f64);

/// A page that can be drawn on, in units of the finished picture's pixels.
pub(super) struct Canvas<'a, DB: DrawingBackend> {
    area: &'a DrawingArea<DB, Shift>,
}

/// The side of text that its place is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Left,
    Middle,
    Right,
}

fn zoomed((x, y): Place) -> (i32, i32) {
    let zoomed = |value: f64| (value * f64::from(ZOOM)).round() as i32;
    (zoomed(x), zoomed(y))
}

/// What the font can show.
fn ascii(text: &str) -> String {
    text.chars()
        .map(|character| if character.is_ascii() { character } else { '?' })
        .collect()
}

/// Width of a text, in pixels: all characters are as wide.
pub(super) fn text_width(text: &str) -> f64 {
    ADVANCE * TEXT * text.chars().count() as f64
}

impl<DB: DrawingBackend> Canvas<'_, DB> {
    pub fn line(&self, places: &[Place], colour: RGBColor, width: f64) -> Result<(), String> {
        let places: Vec<_> = places.iter().copied().map(zoomed).collect();
        let width = (width * f64::from(ZOOM)).round() as u32;
        let style = colour.stroke_width(width);
        self.area
            .draw(&PathElement::new(places, style))
            .map_err(|error| error.to_string())
    }

    pub fn polygon(&self, places: &[Place], colour: RGBColor) -> Result<(), String> {
        let places: Vec<_> = places.iter().copied().map(zoomed).collect();
        self.area
            .draw(&Polygon::new(places, colour.filled()))
            .map_err(|error| error.to_string())
    }

    pub fn disc(&self, at: Place, radius: f64, colour: RGBColor) -> Result<(), String> {
        let radius = (radius * f64::from(ZOOM)).round() as i32;
        self.area
            .draw(&Circle::new(zoomed(at), radius, colour.filled()))
            .map_err(|error| error.to_string())
    }

    pub fn ring(&self, at: Place, radius: f64, colour: RGBColor) -> Result<(), String> {
        let corners = 48;
        let places: Vec<_> = (0..=corners)
            .map(|i| {
                let (sin, cos) =
                    (core::f64::consts::TAU * f64::from(i) / f64::from(corners)).sin_cos();
                (at.0 + radius * cos, at.1 + radius * sin)
            })
            .collect();
        self.line(&places, colour, 2.0)
    }

    /// Writes text, halfway up at its place.
    pub fn text(
        &self,
        text: &str,
        at: Place,
        anchor: Anchor,
        colour: RGBColor,
    ) -> Result<(), String> {
        let side = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        let font = (FontFamily::Monospace, TEXT * f64::from(ZOOM)).into_font();
        let style = TextStyle::from(font)
            .color(&colour)
            .pos(Pos::new(side, VPos::Center));
        self.area
            .draw(&Text::new(ascii(text), zoomed(at), style))
            .map_err(|error| error.to_string())
    }
}

/// Bevy's own font, in the name that SVG has for its kind.
fn provide_font() -> Result<(), String> {
    static FONT: OnceLock<bool> = OnceLock::new();
    let provided = FONT.get_or_init(|| {
        let name = FontFamily::Monospace.as_str();
        register_font(name, FontStyle::Normal, DEFAULT_FONT_DATA).is_ok()
    });
    provided
        .then_some(())
        .ok_or("the font cannot be read".into())
}

impl Chart {
    /// The chart as SVG.
    pub fn to_svg(&self) -> Result<String, String> {
        provide_font()?;
        let (width, height) = (SIZE.0 * ZOOM, SIZE.1 * ZOOM);
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, (width, height)).into_drawing_area();
            area.fill(&WHITE).map_err(|error| error.to_string())?;
            self.draw(&Canvas { area: &area })?;
            area.present().map_err(|error| error.to_string())?;
        }
        let drawn = format!("width=\"{width}\" height=\"{height}\" viewBox");
        let shown = format!("width=\"{}\" height=\"{}\" viewBox", SIZE.0, SIZE.1);
        Ok(svg.replacen(&drawn, &shown, 1))
    }

    /// The chart as PNG.
    pub fn to_png(&self) -> Result<Vec<u8>, String> {
        provide_font()?;
        let (width, height) = (SIZE.0 * ZOOM, SIZE.1 * ZOOM);
        let mut large = vec![0; (width * height * 3) as usize];
        {
            let area = BitMapBackend::with_buffer(&mut large, (width, height)).into_drawing_area();
            area.fill(&WHITE).map_err(|error| error.to_string())?;
            self.draw(&Canvas { area: &area })?;
            area.present().map_err(|error| error.to_string())?;
        }
        let mut png = Vec::new();
        let encoder = image::codecs::png::PngEncoder::new_with_quality(
            &mut png,
            image::codecs::png::CompressionType::Best,
            // Even areas and sharp edges: rows repeat as they are.
            image::codecs::png::FilterType::NoFilter,
        );
        image::ImageEncoder::write_image(
            encoder,
            &averaged(&large),
            SIZE.0,
            SIZE.1,
            image::ExtendedColorType::Rgb8,
        )
        .map_err(|error| error.to_string())?;
        Ok(png)
    }
}

/// The picture at its own size. Shades along edges are rounded to 16 levels, which halves the file and is not seen.
fn averaged(large: &[u8]) -> Vec<u8> {
    const LEVEL: u32 = 17;
    let (width, zoom) = (SIZE.0 as usize, ZOOM as usize);
    let count = ZOOM * ZOOM;
    let mut small = Vec::with_capacity(large.len() / (zoom * zoom));
    for y in 0..SIZE.1 as usize {
        for x in 0..width {
            for channel in 0..3 {
                let (mut sum, mut low, mut high) = (0, u8::MAX, 0);
                for row in y * zoom..(y + 1) * zoom {
                    for column in x * zoom..(x + 1) * zoom {
                        let value = large[(row * width * zoom + column) * 3 + channel];
                        sum += u32::from(value);
                        (low, high) = (low.min(value), high.max(value));
                    }
                }
                let rounded = (sum + count * LEVEL / 2) / (count * LEVEL) * LEVEL;
                small.push(if low == high { low } else { rounded as u8 });
            }
        }
    }
    small
}

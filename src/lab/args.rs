//! The arguments that all examples share.

use std::path::PathBuf;

use bevy::math::{UVec2, Vec3};
use clap::Args;

use super::charts::Chart;
use crate::texel::build::Filling;

/// Arguments of every example.
#[derive(Args, Clone, Debug)]
pub struct CommonArgs {
    /// Render without a window and write PNGs.
    #[arg(long)]
    pub headless: bool,
    /// Size of the window or the pictures, in pixels.
    #[arg(long, default_value = "1024x768", value_parser = parse_size)]
    pub size: Size,
    /// Frames to render when headless.
    #[arg(long, default_value_t = 24)]
    pub frames: usize,
    /// Folder for what is written.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
    /// Write figures of the run to this JSON file.
    #[arg(long, value_name = "FILE.json")]
    pub stats: Option<PathBuf>,
}

/// Arguments of every example that draws charts.
#[derive(Args, Clone, Debug)]
pub struct ChartArgs {
    /// Folder for the charts: SVG, PNG and CSV of each.
    #[arg(long, default_value = "docs/charts")]
    pub out: PathBuf,
    /// Only those whose name contains this.
    #[arg(long, default_value = "")]
    pub only: String,
}

impl ChartArgs {
    /// Saves a chart of this name, if it is asked for.
    ///
    /// # Errors
    /// When it cannot be drawn or written.
    pub fn draw(
        &self,
        name: &str,
        chart: impl FnOnce() -> Result<Chart, String>,
    ) -> Result<(), String> {
        if name.contains(&self.only) {
            chart()?.save(&self.out, name)?;
            println!("{}", self.out.join(name).with_extension("png").display());
        }
        Ok(())
    }
}

/// Width and height in pixels.
pub type Size = UVec2;

/// Largest side of a picture, in pixels: what every device can render to.
const LARGEST: u32 = 8192;

/// Reads a size like `640x480`.
pub fn parse_size(text: &str) -> Result<Size, String> {
    let parts = text.split_once(['x', 'X', '×']);
    let side = |side: &str| {
        side.trim()
            .parse::<u32>()
            .ok()
            .filter(|&side| (1..=LARGEST).contains(&side))
    };
    parts
        .and_then(|(width, height)| Some(UVec2::new(side(width)?, side(height)?)))
        .ok_or_else(|| {
            format!("'{text}' is no size: write it like 640x480, each side 1 to {LARGEST}")
        })
}

/// Reads a point like `1.5,0,-2`.
pub fn parse_vec3(text: &str) -> Result<Vec3, String> {
    let numbers: Vec<f32> = text
        .split(',')
        .filter_map(|number| number.trim().parse().ok())
        .filter(|number: &f32| number.is_finite())
        .collect();
    match (numbers.as_slice(), text.split(',').count()) {
        (&[x, y, z], 3) => Ok(Vec3::new(x, y, z)),
        _ => Err(format!("'{text}' is no point: write it like 1.5,0,-2")),
    }
}

/// Reads a share, of which 0 is nothing and 1 is all.
pub fn parse_share(text: &str) -> Result<f32, String> {
    let share = text
        .parse()
        .ok()
        .filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| format!("'{text}' is no share: give a number from 0 to 1"))
}

/// Reads what of a shape is opaque.
pub fn parse_filling(text: &str) -> Result<Filling, String> {
    match text {
        "flood" => Ok(Filling::Flood),
        "parity" => Ok(Filling::Parity),
        "none" => Ok(Filling::None),
        _ => Err(format!(
            "'{text}' is no filling: write flood, parity or none"
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_arguments_say_is_read_and_nonsense_is_named() {
        assert_eq!(parse_size("640x480"), Ok(UVec2::new(640, 480)));
        assert!(parse_size("640").unwrap_err().contains("640x480"));
        assert!(parse_size("0x99999").is_err());
        assert_eq!(parse_vec3("1.5, 0,-2"), Ok(Vec3::new(1.5, 0.0, -2.0)));
        assert!(parse_vec3("1,2").is_err());
        assert!(parse_vec3("1,2,x,3").is_err());
        assert!(parse_vec3("1,2,NaN").is_err());
        assert_eq!(parse_share("0.25"), Ok(0.25));
        assert!(parse_share("1.5").unwrap_err().contains("0 to 1"));
        assert!(parse_share("NaN").is_err());
        assert_eq!(parse_filling("none"), Ok(Filling::None));
        let message = parse_filling("full").unwrap_err();
        assert!(message.contains("'full'") && message.contains("flood, parity or none"));
    }
}

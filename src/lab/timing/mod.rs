//! Time: how long frames take, and the figures of a run as examples write them with `--stats`.
//!
//! | file | what it does |
//! |---|---|
//! | `race` | frames of several variants of a scene in turns |
//! | `device` | what the device says that a frame took |

mod device;
mod race;

use std::path::Path;

pub use device::{GpuClockPlugin, gpu_frame, has_timestamps};
pub use race::{Clock, Race, Timing, Variant};

use serde::Serialize;

/// What an example measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameStats {
    /// The device that drew.
    pub adapter: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Frames that the medians are of.
    pub frames: usize,
    /// Plants in the scene.
    pub plants: usize,
    /// Their segments.
    pub segments: usize,
    /// Median time of a frame, in milliseconds.
    pub median_frame_ms: f64,
    /// The same with the plants hidden.
    pub median_empty_frame_ms: f64,
    /// Median time spent on cones and cutting planes, in milliseconds.
    pub median_cutting_planes_ms: f64,
    /// Median number of bytes written to the GPU a frame.
    pub uploaded_bytes_per_frame: usize,
}

impl FrameStats {
    /// Writes the figures as JSON.
    pub fn save(&self, path: &Path) -> Result<(), String> {
        let text = serde_json::to_string_pretty(self).map_err(|error| error.to_string())?;
        std::fs::write(path, text + "\n").map_err(|error| format!("{}: {error}", path.display()))
    }
}

/// The median of some figures, 0 of none.
pub fn median<T: Copy + PartialOrd + Default>(figures: &[T]) -> T {
    let mut sorted = figures.to_vec();
    sorted.sort_by(|a, b| a.partial_cmp(b).unwrap_or(core::cmp::Ordering::Equal));
    sorted.get(sorted.len() / 2).copied().unwrap_or_default()
}

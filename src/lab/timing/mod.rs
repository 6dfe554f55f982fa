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

use bevy::math::UVec2;
use serde::Serialize;

use super::headless::{Headless, adapter_name};
use crate::frusta::FrustaStats;

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
    /// Times frames with and without plants, in turns; `show` shows or hides them.
    pub fn measure(
        headless: &mut Headless,
        size: UVec2,
        frames: usize,
        show: impl Fn(&mut Headless, bool),
    ) -> Self {
        let race = Race {
            rounds: frames.max(1),
            warm_up: 0,
            settle: 1,
        };
        let mut variants = [("plants", true), ("empty", false)].map(|(name, shown)| {
            Variant::new(name, {
                let show = &show;
                move |headless: &mut Headless| show(headless, shown)
            })
        });
        let (mut cutting_planes, mut uploaded) = (Vec::new(), Vec::new());
        let timings = race.run_and_look(headless, &mut variants, |_, headless| {
            let stats = headless.world().resource::<FrustaStats>();
            cutting_planes.push(stats.cutting_planes.as_secs_f64() * 1e3);
            uploaded.push(stats.uploaded_bytes);
        });
        show(headless, true);
        headless.step();
        let stats = *headless.world().resource::<FrustaStats>();
        Self {
            adapter: adapter_name(headless.world()),
            size: size.to_array(),
            frames: race.rounds,
            plants: stats.plants,
            segments: stats.segments,
            median_frame_ms: timings[0].frame_ms,
            median_empty_frame_ms: timings[1].frame_ms,
            median_cutting_planes_ms: median(&cutting_planes),
            uploaded_bytes_per_frame: median(&uploaded),
        }
    }

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

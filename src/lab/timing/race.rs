//! A race: frames of several variants in turns, A B C A B C, so that whatever else the machine does falls on all alike.

use std::collections::VecDeque;
use std::time::Instant;

use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;

use super::super::headless::{Headless, wait_for_gpu};
use super::{device, median};

/// One of the things that are compared.
pub struct Variant<'a> {
    /// What it is called.
    pub name: String,
    /// Makes the scene this variant's, whatever it was before.
    pub apply: Box<dyn FnMut(&mut Headless) + 'a>,
}

impl<'a> Variant<'a> {
    /// A variant of a name that `apply` makes the scene.
    pub fn new(name: impl Into<String>, apply: impl FnMut(&mut Headless) + 'a) -> Self {
        Self {
            name: name.into(),
            apply: Box::new(apply),
        }
    }
}

/// What a variant's frames took.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timing {
    /// What it is called.
    pub name: String,
    /// Median time of a frame, from its first system to the device's last pass, in milliseconds.
    pub frame_ms: f64,
    /// Median time that the device was at work on a frame, in milliseconds; `None` where it has no timestamps or no
    /// [`GpuClockPlugin`](super::GpuClockPlugin).
    pub gpu_ms: Option<f64>,
    /// Frames that the medians are of.
    pub frames: usize,
}

impl Timing {
    /// What is left when the cost of another variant, the empty scene's, is taken off. Not below 0: a difference of
    /// medians that small is noise.
    pub fn less(&self, empty: &Timing) -> Timing {
        let gpu = self.gpu_ms.zip(empty.gpu_ms);
        Timing {
            frame_ms: (self.frame_ms - empty.frame_ms).max(0.0),
            gpu_ms: gpu.map(|(own, empty)| (own - empty).max(0.0)),
            ..self.clone()
        }
    }

    /// By a clock; by that of frames where there is no other.
    pub fn ms(&self, clock: Clock) -> f64 {
        match (clock, self.gpu_ms) {
            (Clock::Device, Some(ms)) => ms,
            _ => self.frame_ms,
        }
    }
}

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The whole frame, with the CPU's share.
    Frames,
    /// The device's work alone.
    Device,
}

impl Clock {
    /// The one that tells most: the device's, where it has timestamps and is not the CPU itself.
    pub fn of(world: &World) -> Self {
        let info = world.get_resource::<RenderAdapterInfo>();
        // Bevy does not name the type of this field.
        let is_gpu = info.is_some_and(|info| format!("{:?}", info.device_type) != "Cpu");
        if is_gpu && device::has_timestamps(world) {
            Self::Device
        } else {
            Self::Frames
        }
    }

    /// For axes and headings.
    pub fn label(self) -> &'static str {
        match self {
            Self::Frames => "frame time",
            Self::Device => "GPU time",
        }
    }
}

/// How a race is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Race {
    /// Rounds that count.
    pub rounds: usize,
    /// Rounds before them that do not: pipelines are compiled, buffers grow, clocks rise.
    pub warm_up: usize,
    /// Frames of a variant, each time it comes round, that are not timed. At least 1, for what changes a scene costs the
    /// frame that it changes in.
    pub settle: usize,
}

impl Default for Race {
    fn default() -> Self {
        Self {
            rounds: 21,
            warm_up: 2,
            settle: 1,
        }
    }
}

/// Frames after which the device's figures of a frame are in the app.
const LATENCY: usize = 2;

impl Race {
    /// Runs the variants against each other; their timings, in the same order.
    pub fn run(&self, headless: &mut Headless, variants: &mut [Variant]) -> Vec<Timing> {
        self.run_and_look(headless, variants, |_, _| {})
    }

    /// The same, with a look at the app after each frame that counts.
    pub fn run_and_look(
        &self,
        headless: &mut Headless,
        variants: &mut [Variant],
        mut look: impl FnMut(usize, &mut Headless),
    ) -> Vec<Timing> {
        let mut frame_ms = vec![Vec::new(); variants.len()];
        let mut gpu_ms = vec![Vec::new(); variants.len()];
        // Which variant each of the last frames counts for: the device's figures belong to the oldest.
        let mut counted: VecDeque<Option<usize>> = VecDeque::from(vec![None; LATENCY]);
        let mut step = |headless: &mut Headless, counts_for: Option<usize>| {
            let started = Instant::now();
            headless.step();
            wait_for_gpu(headless.world());
            let took = started.elapsed().as_secs_f64() * 1e3;
            counted.push_back(counts_for);
            if let Some(variant) = counted.pop_front().flatten() {
                gpu_ms[variant].extend(device::gpu_frame(headless.world(), started));
            }
            took
        };
        for round in 0..self.warm_up + self.rounds.max(1) {
            for (i, variant) in variants.iter_mut().enumerate() {
                (variant.apply)(headless);
                for _ in 0..self.settle.max(1) {
                    step(headless, None);
                }
                if round < self.warm_up {
                    continue;
                }
                frame_ms[i].push(step(headless, Some(i)));
                look(i, headless);
            }
        }
        for _ in 0..LATENCY {
            step(headless, None);
        }
        let names = variants.iter().map(|variant| variant.name.clone());
        let times = frame_ms.iter().zip(&gpu_ms);
        names
            .zip(times)
            .map(|(name, (frame, gpu))| Timing {
                name,
                frame_ms: median(frame),
                gpu_ms: (!gpu.is_empty()).then(|| median(gpu)),
                frames: frame.len(),
            })
            .collect()
    }
}

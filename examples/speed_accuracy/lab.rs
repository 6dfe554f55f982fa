//! The app that everything is measured in.

use bevy::prelude::*;
use bevy_verdure::lab::rivals::{Exhibit, Rival, Wardrobe, aim};
use bevy_verdure::lab::{Clock, GpuClockPlugin, Race, Shot, Studio, Timing, Variant, adapter_name};

/// The app, its device, and the looks that are painted so far.
pub struct Lab {
    pub studio: Studio,
    pub wardrobe: Wardrobe,
    /// The device's name.
    pub adapter: String,
    /// What is timed on it.
    pub clock: Clock,
}

impl Lab {
    pub fn open() -> Self {
        let mut studio = Studio::new(|app| {
            app.add_plugins(GpuClockPlugin);
        });
        let world = studio.world();
        Self {
            adapter: adapter_name(world),
            clock: Clock::of(world),
            studio,
            wardrobe: Wardrobe::default(),
        }
    }

    /// Runs the empty scene and some rivals that stand against each other; the time of each above the empty scene's.
    pub fn race(
        &mut self,
        exhibit: &Exhibit,
        shot: &Shot,
        race: Race,
        rivals: &[Rival],
    ) -> Vec<Timing> {
        aim(&mut self.studio, shot);
        let shown = core::iter::once(None).chain(rivals.iter().copied().map(Some));
        let mut variants: Vec<_> = shown
            .map(|rival| {
                let name = rival.map_or("empty".into(), |rival| format!("{rival:?}"));
                Variant::new(name, move |headless| exhibit.show(headless, rival))
            })
            .collect();
        let timings = race.run(&mut self.studio.headless, &mut variants);
        timings[1..]
            .iter()
            .map(|timing| timing.less(&timings[0]))
            .collect()
    }

    /// Puts up rivals that are sure to fit.
    pub fn put_up(&mut self, exhibit: &mut Exhibit, rivals: &[Rival]) -> Result<(), String> {
        for rival in rivals {
            exhibit
                .put_up(
                    &mut self.studio.headless,
                    &mut self.wardrobe,
                    *rival,
                    usize::MAX,
                )
                .map_err(|error| error.to_string())?;
        }
        Ok(())
    }

    /// Heading of an axis of times.
    pub fn time_label(&self) -> String {
        format!("{} above the empty scene's (ms)", self.clock.label())
    }
}

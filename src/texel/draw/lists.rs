//! The slices of every surface in every view. What has changed is listed anew, and written to the GPU.

use core::ops::Range;

use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::render_resource::{Buffer, BufferUsages};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bevy::render::sync_world::MainEntity;
use bytemuck::Zeroable;

use super::extract::ExtractedTexels;
use super::groups::Groups;
use super::jobs::{Job, list_stale};
use super::leader::Leaders;
use super::limit::DeviceLimits;
use super::mirror::{BLOCK, Mirror};
use super::records::{SliceRecord, SurfaceRecord};
use super::stats::TexelStats;
use super::view::{Seeing, ShowsTexels, ViewInFrame, views};

/// Slices that are drawn at once: what a view has of a group of surfaces across one axis.
pub(crate) struct Run {
    /// Which slices.
    pub records: Range<u32>,
    /// The buffer that their facets are in.
    pub pool: usize,
    pub leaders: Leaders,
}

/// Runs begin at multiples of as many slices, so that one that grows or shrinks a little leaves the others where they are.
const ALIGNED: usize = BLOCK / size_of::<SliceRecord>();

/// The slices of every surface in every view of this frame, on the GPU.
#[derive(Resource)]
pub(crate) struct SliceLists {
    records: Mirror<SliceRecord>,
    surfaces: Mirror<SurfaceRecord>,
    groups: Groups,
    views: Vec<ViewInFrame>,
    /// The numbers of views.
    numbers: HashMap<Entity, usize>,
    /// By view, in the order of surfaces. Kept from frame to frame.
    jobs: Vec<Vec<Job>>,
    /// By view, group and axis.
    runs: Vec<Run>,
}

impl Default for SliceLists {
    fn default() -> Self {
        Self {
            records: Mirror::new("texel_slices", BufferUsages::VERTEX),
            surfaces: Mirror::new("texel_surfaces", BufferUsages::STORAGE),
            groups: Groups::default(),
            views: Vec::new(),
            numbers: HashMap::default(),
            jobs: Vec::new(),
            runs: Vec::new(),
        }
    }
}

impl SliceLists {
    /// The buffer of slices, and which of them an item of a view stands for, if there are any.
    pub(crate) fn run(&self, view: Entity, slices: MainEntity) -> Option<(&Buffer, &Run)> {
        let view = self.numbers.get(&view)?;
        let (group, axis) = self.groups.of_slices(slices)?;
        let run = (view * self.groups.len() + group) * 3 + axis;
        let run = self.runs.get(run).filter(|run| !run.records.is_empty())?;
        Some((self.records.buffer()?, run))
    }

    /// The buffer of surfaces.
    pub(crate) fn surfaces(&self) -> Option<&Buffer> {
        self.surfaces.buffer()
    }

    /// Begins a frame with these views. Tells whether they are others than before, wherever they are now.
    fn look(&mut self, views: impl Iterator<Item = ViewInFrame>) -> bool {
        self.views.clear();
        self.views.extend(views);
        // What is seen itself goes before what casts shadows.
        self.views
            .sort_unstable_by_key(|view| (view.from.is_light, view.entity));
        let numbers = self.views.iter().enumerate();
        let mut numbers = numbers.map(|(number, view)| (view.entity, number));
        let are_the_same = self.numbers.len() == self.views.len()
            && numbers.all(|(view, number)| self.numbers.get(&view) == Some(&number));
        if !are_the_same {
            self.numbers.clear();
            let numbers = self.views.iter().enumerate();
            self.numbers
                .extend(numbers.map(|(number, view)| (view.entity, number)));
        }
        !are_the_same
    }

    /// Lists in parallel what has changed. Tells how many lists that are.
    fn list(&mut self, texels: &ExtractedTexels) -> usize {
        let mut listed = 0;
        self.jobs.resize_with(self.views.len(), Vec::new);
        for (view, jobs) in self.views.iter().zip(&mut self.jobs) {
            jobs.resize_with(self.groups.job_count(), Job::default);
            for (job, (surface, part)) in jobs.iter_mut().zip(self.groups.jobs()) {
                let is_stale = job.follow(view, &texels.surfaces[surface], part);
                listed += usize::from(is_stale);
            }
        }
        list_stale(self.jobs.iter_mut().flatten(), listed);
        listed
    }

    /// Joins lists to runs: at most so many slices.
    fn join(&mut self, texels: &ExtractedTexels, limit: usize) {
        let records = self.records.next();
        self.runs.clear();
        for (view, jobs) in self.views.iter().zip(&self.jobs) {
            for group in self.groups.sorted(&texels.surfaces, &view.from) {
                for axis in 0..3 {
                    let end = records.len();
                    let start = end.next_multiple_of(ALIGNED).min(limit);
                    records.resize(start, SliceRecord::zeroed());
                    for placed in group {
                        for job in &jobs[placed.jobs.clone()] {
                            let list = &job.lists[axis];
                            if records.len() + list.len() > limit {
                                error_once!(
                                    "texels are left out: the slices of a frame do not fit in the {limit} that a buffer of \
                                     this device takes; raise TexelQuality::pixels or depth, or lower TexelSettings::most_slices"
                                );
                                continue;
                            }
                            let surface = placed.surface as u32;
                            records.extend(list.iter().map(|slice| slice.of_surface(surface)));
                        }
                    }
                    self.runs.push(Run {
                        records: start as u32..records.len() as u32,
                        pool: group[0].pool,
                        leaders: Leaders::default(),
                    });
                    if records.len() == start {
                        records.truncate(end);
                    }
                }
            }
        }
    }
}

/// Chooses slices for every surface in every view, and writes the lists of them to the GPU.
pub(crate) fn list_slices(
    mut lists: ResMut<SliceLists>,
    texels: Res<ExtractedTexels>,
    found: Query<Seeing, ShowsTexels>,
    time: Res<Time>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
    mut stats: ResMut<TexelStats>,
) {
    if device.is_changed() {
        // Buffers of a lost device are lost.
        *lists = SliceLists::default();
    }
    let lists = &mut *lists;
    let views = views(&found, &texels, time.elapsed_secs_wrapped());
    let are_others = lists.look(views) | lists.groups.follow(&texels.surfaces);
    stats.listed = lists.list(&texels);
    let limit = device.limits().max_buffer_size as usize / size_of::<SliceRecord>();
    let limit = limit.min(u32::MAX as usize);
    let most = DeviceLimits::of(Some(&device)).surfaces;
    let records = texels.surfaces.iter().map(|surface| surface.record);
    lists.surfaces.next().extend(records);
    stats.list_bytes = lists.surfaces.write(most, &device, &queue);
    if are_others || stats.listed > 0 {
        lists.join(&texels, limit);
        stats.list_bytes += lists.records.write(limit, &device, &queue);
    }
    for run in &mut lists.runs {
        run.leaders.clear();
    }
    let drawn = lists.runs.iter().map(|run| run.records.len());
    stats.slices = drawn.clone().sum();
    stats.draws = drawn.filter(|&slices| slices > 0).count();
}

//! Lists of what views have of surfaces, which are kept as long as they would come out the same.

use core::ops::Range;
use std::sync::Mutex;

use bevy::math::Affine3A;
use bevy::tasks::ComputeTaskPool;

use super::extract::SurfaceInFrame;
use super::records::SliceRecord;
use super::source::{SeenFrom, SliceSource};
use super::view::ViewInFrame;

/// The most facets that a job lists: large surfaces are listed by all cores.
const MOST_FACETS: usize = 8_192;

/// How many jobs a surface of so many facets is.
pub(crate) fn count(facets: usize) -> usize {
    facets.div_ceil(MOST_FACETS)
}

/// What one view has of some facets of one surface.
#[derive(Default)]
pub(crate) struct Job {
    /// What it is listed from; none if it is not shown.
    seen: Option<Seen>,
    /// Whether it is still to be listed.
    is_stale: bool,
    /// For facets to be sorted in.
    order: Vec<(f32, u32)>,
    /// Its slices across u, v and w, of a surface whose number is not known here.
    pub lists: [Vec<SliceRecord>; 3],
}

/// All that a list depends on.
struct Seen {
    source: SliceSource,
    facets: Range<usize>,
    world_from_local: Affine3A,
    from: SeenFrom,
}

impl Job {
    /// Follows a part of a surface in a view. Tells whether it has to be listed.
    pub(crate) fn follow(
        &mut self,
        view: &ViewInFrame,
        surface: &SurfaceInFrame,
        part: usize,
    ) -> bool {
        let casts_none = view.from.is_light && !surface.casts_shadows;
        let is_shown = !casts_none && view.layers.intersects(&surface.layers);
        let source = &surface.source;
        let from = source.heeded(&view.from);
        let start = part * MOST_FACETS;
        let facets = start..source.facets.len().min(start + MOST_FACETS);
        let is_as_before = match &self.seen {
            Some(seen) => {
                is_shown
                    && seen.from == from
                    && seen.world_from_local == surface.world_from_local
                    && seen.facets == facets
                    && seen.source.lists_as(source)
            }
            None => !is_shown,
        };
        if !is_as_before {
            self.is_stale = true;
            self.seen = is_shown.then(|| Seen {
                source: source.clone(),
                facets,
                world_from_local: surface.world_from_local,
                from,
            });
        }
        self.is_stale
    }

    fn list(&mut self) {
        self.is_stale = false;
        self.lists.iter_mut().for_each(Vec::clear);
        if let Some(seen) = &self.seen {
            seen.source.list(
                &seen.world_from_local,
                &seen.from,
                seen.facets.clone(),
                &mut self.order,
                &mut self.lists,
            );
        }
    }
}

/// Does the jobs that are to be done, `count` of them, on all cores.
pub(crate) fn list_stale<'a>(jobs: impl Iterator<Item = &'a mut Job> + Send, count: usize) {
    if count == 0 {
        return;
    }
    let stale = Mutex::new(jobs.filter(|job| job.is_stale));
    let work = || {
        loop {
            let next = stale.lock().expect("work does not panic").next();
            let Some(job) = next else { break };
            job.list();
        }
    };
    let pool = ComputeTaskPool::get();
    pool.scope(|scope| {
        for _ in 0..pool.thread_num().clamp(1, count) {
            scope.spawn(async { work() });
        }
    });
}

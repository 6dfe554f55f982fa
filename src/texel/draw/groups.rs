//! Which surfaces are drawn at once: those whose facets are in one buffer, and that share their looks.

use core::ops::Range;

use bevy::asset::AssetId;
use bevy::platform::collections::HashMap;
use bevy::prelude::*;
use bevy::render::sync_world::MainEntity;

use super::extract::SurfaceInFrame;
use super::jobs;
use super::material::TexelMaterial;
use super::source::SeenFrom;

/// What surfaces of a group share.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct GroupKey {
    pool: usize,
    material: AssetId<TexelMaterial>,
}

/// What of a surface its place depends on.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Member {
    key: GroupKey,
    slices: [Entity; 6],
    jobs: usize,
}

impl Member {
    fn of(surface: &SurfaceInFrame) -> Self {
        let source = &surface.source;
        Self {
            key: GroupKey {
                pool: source.room.pool,
                material: source.material,
            },
            slices: source.slices,
            jobs: jobs::count(source.facets.len()),
        }
    }
}

/// A surface's place among the others.
#[derive(Clone)]
pub(crate) struct Placed {
    /// Its number among the surfaces of the frame.
    pub surface: usize,
    group: usize,
    /// The buffer of its facets, which is that of its group.
    pub pool: usize,
    /// Its jobs among those of a view.
    pub jobs: Range<usize>,
    /// How far it is, in the view for which places were sorted.
    far: f32,
}

/// The groups of the surfaces of a frame.
#[derive(Default)]
pub(crate) struct Groups {
    members: Vec<Member>,
    /// In the order of surfaces.
    placed: Vec<Placed>,
    /// In the order of a view.
    sorted: Vec<Placed>,
    numbers: HashMap<GroupKey, usize>,
    /// The group and the axis of the children that slices are drawn by.
    of_slices: HashMap<MainEntity, (usize, usize)>,
}

impl Groups {
    /// Follows the surfaces of a frame. Tells whether they are grouped in another way than those of the frame before.
    pub(crate) fn follow(&mut self, surfaces: &[SurfaceInFrame]) -> bool {
        let members = surfaces.iter().map(Member::of);
        if members.clone().eq(self.members.iter().copied()) {
            return false;
        }
        self.members.clear();
        self.members.extend(members);
        self.placed.clear();
        self.numbers.clear();
        self.of_slices.clear();
        let mut end = 0;
        for (surface, member) in self.members.iter().enumerate() {
            let next = self.numbers.len();
            let group = *self.numbers.entry(member.key).or_insert(next);
            let jobs = end..end + member.jobs;
            end = jobs.end;
            self.placed.push(Placed {
                surface,
                group,
                pool: member.key.pool,
                jobs,
                far: 0.0,
            });
            for (i, slices) in member.slices.into_iter().enumerate() {
                self.of_slices.insert(slices.into(), (group, i % 3));
            }
        }
        true
    }

    /// How many groups there are.
    pub(crate) fn len(&self) -> usize {
        self.numbers.len()
    }

    /// The jobs of a view: which surface each is of, and which part of that.
    pub(crate) fn jobs(&self) -> impl Iterator<Item = (usize, usize)> {
        self.placed.iter().flat_map(|placed| {
            let parts = 0..placed.jobs.len();
            parts.map(|part| (placed.surface, part))
        })
    }

    /// How many those are.
    pub(crate) fn job_count(&self) -> usize {
        self.placed.last().map_or(0, |last| last.jobs.end)
    }

    /// The group that a child is of, and the axis.
    pub(crate) fn of_slices(&self, slices: MainEntity) -> Option<(usize, usize)> {
        self.of_slices.get(&slices).copied()
    }

    /// The surfaces of each group, group by group in order, near ones first in a view.
    pub(crate) fn sorted(
        &mut self,
        surfaces: &[SurfaceInFrame],
        from: &SeenFrom,
    ) -> impl Iterator<Item = &[Placed]> {
        self.sorted.clone_from(&self.placed);
        for placed in &mut self.sorted {
            let surface = &surfaces[placed.surface];
            placed.far = surface.source.far(&surface.world_from_local, from);
        }
        self.sorted.sort_unstable_by(|a, b| {
            let by_group = a.group.cmp(&b.group);
            let by_place = a.far.total_cmp(&b.far).then(a.surface.cmp(&b.surface));
            by_group.then(by_place)
        });
        self.sorted.chunk_by(|a, b| a.group == b.group)
    }
}

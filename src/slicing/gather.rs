//! Gathers slicings into sets, so that crowns of several are one draw.
//!
//! A slicing that comes into use is drawn at once, from a set of its own. When none has come, gone or changed for a while,
//! sets are made of all that may be drawn together, behind the frames; crowns look the same before and after.

use core::time::Duration;

use bevy::asset::AssetId;
use bevy::platform::collections::HashSet;
use bevy::prelude::*;
use bevy::tasks::{AsyncComputeTaskPool, Task, TaskPool, block_on};
use bevy::time::Real;

use super::library::{CrownAssets, CrownLibrary, Prepared};
use super::limits::MAX_SET_PIXELS;
use super::set::{SetKind, SetSource};
use super::slicing::Slicing;
use super::upload::data_behind;
use crate::wind::Wind;

/// How long nothing has to have changed before sets are made: so it is done once for what a scene loads together.
const CALM: Duration = Duration::from_secs(1);

/// The most that a frame counts for: of a long one others may have been waiting too.
const LONGEST: Duration = Duration::from_millis(100);

/// Frames in which a set may get to the GPU before crowns are drawn from it.
const WAIT: u32 = 4;

/// A set in the making.
struct Coming {
    kind: SetKind,
    slicings: Vec<(AssetId<Slicing>, Slicing)>,
    data: Task<[Vec<u8>; 2]>,
}

/// How far gathering is.
#[derive(Default)]
pub(crate) struct Gathering {
    /// The library's number of changes, and for how long it has been that.
    changes: u32,
    calm: Duration,
    is_planned: bool,
    coming: Option<Coming>,
    /// And how many frames it still waits.
    ready: Option<(Prepared, u32)>,
}

/// A slicing in use, for the planning of sets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    pub id: AssetId<Slicing>,
    pub kind: SetKind,
    pub layers: u32,
    /// Those that came first stay together.
    pub age: u32,
    pub set: u32,
    /// Layers of that set.
    pub set_layers: u32,
}

/// Makes one set at a time of slicings that are in several.
pub(crate) fn gather(
    mut gathering: Local<Gathering>,
    mut library: ResMut<CrownLibrary>,
    mut assets: CrownAssets,
    slicings: Res<Assets<Slicing>>,
    wind: Res<Wind>,
    time: Res<Time<Real>>,
) {
    let gathering = &mut *gathering;
    if gathering.changes != library.changes {
        *gathering = Gathering {
            changes: library.changes,
            ..default()
        };
    }
    gathering.calm = gathering.calm.saturating_add(time.delta().min(LONGEST));
    if gathering.calm >= CALM && !gathering.is_planned {
        gathering.is_planned = true;
        let layers = assets.most_layers();
        let planned = plan(movable(&library, &slicings), |kind| most(kind, layers));
        gathering.coming = planned.map(|members| Coming::new(&members, &slicings));
    }
    let is_there = |coming: &mut Coming| coming.data.is_finished();
    if let Some(coming) = gathering.coming.take_if(is_there) {
        let slicings = coming.slicings.iter();
        let slicings: Vec<_> = slicings.map(|(id, slicing)| (*id, slicing)).collect();
        let source = SetSource {
            kind: coming.kind,
            slicings: &slicings,
            data: block_on(coming.data),
        };
        let prepared = library.prepare(source, wind.limited(), &mut assets);
        gathering.ready = Some((prepared, WAIT));
    }
    if let Some((_, wait)) = &mut gathering.ready {
        *wait -= 1;
    }
    if let Some((prepared, _)) = gathering.ready.take_if(|(_, wait)| *wait == 0) {
        library.draw_from(prepared);
    }
}

/// The slicings that may change their sets. One that is gone is drawn on from where it is, and so are those beside it.
fn movable(library: &CrownLibrary, slicings: &Assets<Slicing>) -> Vec<Placed> {
    let gone = library
        .placed()
        .filter(|placed| !slicings.contains(placed.id));
    let kept: HashSet<u32> = gone.map(|placed| placed.set).collect();
    let moves = library
        .placed()
        .filter(|placed| !kept.contains(&placed.set));
    moves.collect()
}

impl Coming {
    fn new(members: &[Placed], slicings: &Assets<Slicing>) -> Self {
        let kind = members[0].kind;
        let clone = |placed: &Placed| Some((placed.id, slicings.get(placed.id)?.clone()));
        let slicings: Vec<_> = members.iter().filter_map(clone).collect();
        let data = slicings.iter().map(|(_, slicing)| slicing.clone());
        let pool = AsyncComputeTaskPool::get_or_init(TaskPool::new);
        Self {
            kind,
            data: pool.spawn(data_behind(data.collect(), kind.compressed)),
            slicings,
        }
    }
}

/// The most layers of a set of several, on a device whose textures have so many.
fn most(kind: SetKind, layers: u32) -> u32 {
    let in_memory = MAX_SET_PIXELS / u64::from(kind.pixels).pow(2);
    layers.min(u32::try_from(in_memory).unwrap_or(u32::MAX))
}

/// Layers that are in use.
fn live(group: &[Placed]) -> u32 {
    group.iter().map(|placed| placed.layers).sum()
}

/// Slicings that are to be a set and are not; none where all are as they should be: sets of a kind together, the oldest
/// first, as many as have room. They stay whole, or each slicing that leaves would move all that came after it.
fn plan(mut slicings: Vec<Placed>, most: impl Fn(SetKind) -> u32) -> Option<Vec<Placed>> {
    slicings.sort_by_key(|placed| (placed.kind, placed.age));
    let mut sets: Vec<Vec<Placed>> = Vec::new();
    for placed in slicings {
        match sets.iter_mut().find(|set| set[0].set == placed.set) {
            Some(set) => set.push(placed),
            None => sets.push(vec![placed]),
        }
    }
    let mut groups: Vec<Vec<Placed>> = Vec::new();
    for set in sets {
        let kind = set[0].kind;
        let has_room = |group: &&mut Vec<Placed>| {
            group[0].kind == kind && live(group) + live(&set) <= most(kind)
        };
        match groups.iter_mut().find(has_room) {
            Some(group) => group.extend(set),
            None => groups.push(set),
        }
    }
    groups.into_iter().find(|group| {
        let set = group[0].set;
        let is_one = group.iter().all(|placed| placed.set == set);
        // What has left takes memory: more of it than is left is too much.
        !is_one || group[0].set_layers > 2 * live(group)
    })
}

#[cfg(test)]
mod tests {
    use bevy::asset::uuid::Uuid;

    use super::*;

    const KIND: SetKind = SetKind {
        pixels: 256,
        compressed: false,
        transmits: true,
    };

    fn placed(age: u32, layers: u32, set: u32, set_layers: u32) -> Placed {
        Placed {
            id: AssetId::Uuid {
                uuid: Uuid::from_u128(age.into()),
            },
            kind: KIND,
            layers,
            age,
            set,
            set_layers,
        }
    }

    /// Carries out plans until none is left: the ages of slicings in each set.
    fn settled(mut slicings: Vec<Placed>, layers: u32) -> Vec<Vec<u32>> {
        for next in 100..110 {
            let Some(group) = plan(slicings.clone(), |kind| most(kind, layers)) else {
                let mut sets: Vec<Vec<Placed>> = Vec::new();
                for one in slicings {
                    match sets.iter_mut().find(|set| set[0].set == one.set) {
                        Some(set) => set.push(one),
                        None => sets.push(vec![one]),
                    }
                }
                let ages = |set: Vec<Placed>| set.iter().map(|one| one.age).collect();
                return sets.into_iter().map(ages).collect();
            };
            let total = group.iter().map(|one| one.layers).sum();
            for one in &mut slicings {
                if group.iter().any(|other| other.id == one.id) {
                    (one.set, one.set_layers) = (next, total);
                }
            }
        }
        panic!("plans go on for ever");
    }

    #[test]
    fn slicings_of_a_kind_come_together_as_far_as_there_is_room() {
        let mut slicings: Vec<_> = (0..5).map(|age| placed(age, 60, age, 60)).collect();
        assert_eq!(settled(slicings.clone(), 2048), [[0, 1, 2, 3, 4]]);
        assert_eq!(settled(slicings.clone(), 256), [vec![0, 1, 2, 3], vec![4]]);
        // 512 layers of 256² pixels are all that a set takes.
        for one in &mut slicings {
            (one.layers, one.set_layers) = (125, 125);
        }
        assert_eq!(settled(slicings.clone(), 2048), [vec![0, 1, 2, 3], vec![4]]);
        slicings[1].kind.pixels = 128;
        slicings[2].kind.transmits = false;
        let sets = settled(slicings, 2048);
        assert_eq!(sets, [vec![0, 3, 4], vec![1], vec![2]]);
    }

    #[test]
    fn one_that_leaves_moves_no_others() {
        let mut slicings: Vec<_> = (0..12).map(|age| placed(age, 60, age / 4, 240)).collect();
        slicings.remove(1);
        assert!(plan(slicings, |_| 256).is_none());
    }

    #[test]
    fn what_has_left_a_set_is_let_go_of_when_it_is_more_than_half() {
        let mut pair = vec![placed(0, 10, 7, 40), placed(1, 10, 7, 40)];
        assert!(plan(pair.clone(), |_| 256).is_none());
        pair.pop();
        assert_eq!(plan(pair, |_| 256).map(|group| group.len()), Some(1));
        assert!(plan(Vec::new(), |_| 256).is_none());
    }
}

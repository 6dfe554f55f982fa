//! Rooms: where on the GPU the facets of each surface are, all in as few buffers as hold them.

use core::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The buffers of facets, as the main world hands them out. Another one is begun where all are full.
///
/// Not by `offset_allocator`, which refuses what would fill a buffer to its end, as one large mesh may.
#[derive(Clone, Debug, Default)]
pub(crate) struct FacetSpace(Arc<Mutex<Vec<Rooms>>>);

/// The rooms of one buffer.
#[derive(Debug, Default)]
struct Rooms {
    /// What is free below the end: in order, and never two next to one another.
    free: Vec<Range<usize>>,
    /// Facets up to the last room's end.
    end: usize,
}

/// Facets of a buffer that are one surface's, for as long as this is held on to.
#[derive(Debug)]
pub(crate) struct FacetRoom {
    space: FacetSpace,
    /// Which buffer.
    pub pool: usize,
    /// Which of its facets.
    pub range: Range<usize>,
}

impl FacetSpace {
    /// Room for so many facets, in a buffer that holds `most`, which must be no fewer.
    pub(crate) fn room(&self, facets: usize, most: usize) -> Arc<FacetRoom> {
        let mut pools = self.pools();
        let found = (pools.iter_mut().enumerate())
            .find_map(|(pool, rooms)| Some((pool, rooms.take(facets, most)?)));
        let (pool, range) = found.unwrap_or_else(|| {
            let end = facets;
            pools.push(Rooms {
                free: Vec::new(),
                end,
            });
            (pools.len() - 1, 0..end)
        });
        drop(pools);
        Arc::new(FacetRoom {
            space: self.clone(),
            pool,
            range,
        })
    }

    /// How many facets each buffer has to hold.
    pub(crate) fn for_each_pool(&self, mut tell: impl FnMut(usize, usize)) {
        for (pool, rooms) in self.pools().iter().enumerate() {
            tell(pool, rooms.end);
        }
    }

    fn pools(&self) -> MutexGuard<'_, Vec<Rooms>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for FacetRoom {
    fn drop(&mut self) {
        self.space.pools()[self.pool].give_back(self.range.clone());
    }
}

impl Rooms {
    /// The first room for so many that ends before `most`.
    fn take(&mut self, count: usize, most: usize) -> Option<Range<usize>> {
        if let Some(i) = self.free.iter().position(|gap| gap.len() >= count) {
            let gap = &mut self.free[i];
            let range = gap.start..gap.start + count;
            gap.start = range.end;
            if gap.start == gap.end {
                self.free.remove(i);
            }
            return Some(range);
        }
        let range = self.end..self.end + count;
        (range.end <= most).then(|| {
            self.end = range.end;
            range
        })
    }

    fn give_back(&mut self, mut range: Range<usize>) {
        let i = self.free.partition_point(|gap| gap.end < range.start);
        // The neighbours, if there are any, become part of it.
        while let Some(gap) = self.free.get(i)
            && gap.start <= range.end
        {
            range = range.start.min(gap.start)..range.end.max(gap.end);
            self.free.remove(i);
        }
        if range.end == self.end {
            self.end = range.start;
        } else {
            self.free.insert(i, range);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn ends(space: &FacetSpace) -> Vec<usize> {
        let mut ends = Vec::new();
        space.for_each_pool(|_, end| ends.push(end));
        ends
    }

    #[test]
    fn rooms_fill_a_buffer_to_its_end_and_then_the_next_one() {
        let space = FacetSpace::default();
        let first = space.room(60, 100);
        let second = space.room(40, 100);
        let third = space.room(100, 100);
        assert_eq!((first.pool, first.range.clone()), (0, 0..60));
        assert_eq!((second.pool, second.range.clone()), (0, 60..100));
        assert_eq!((third.pool, third.range.clone()), (1, 0..100));
        drop(first);
        let fourth = space.room(25, 100);
        assert_eq!((fourth.pool, fourth.range.clone()), (0, 0..25));
        drop(second);
        assert_eq!(
            ends(&space),
            [25, 100],
            "what is free at the end is no part"
        );
        drop((third, fourth));
        assert_eq!(ends(&space), [0, 0]);
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

        /// Whatever comes and goes.
        #[test]
        fn no_two_rooms_overlap_and_all_comes_back(
            steps in prop::collection::vec((1..30usize, 0..8usize), 1..60),
        ) {
            const MOST: usize = 64;
            let space = FacetSpace::default();
            let mut rooms: Vec<Arc<FacetRoom>> = Vec::new();
            for (count, gone) in steps {
                if gone < rooms.len() {
                    rooms.swap_remove(gone);
                }
                let room = space.room(count, MOST);
                prop_assert!(room.range.len() == count && room.range.end <= MOST);
                for other in &rooms {
                    let apart = room.range.end <= other.range.start || other.range.end <= room.range.start;
                    prop_assert!(room.pool != other.pool || apart, "{room:?} {other:?}");
                }
                rooms.push(room);
            }
            rooms.clear();
            prop_assert!(ends(&space).iter().all(|&end| end == 0));
        }
    }
}

//! Work on all cores whose result does not depend on how many there are.

use std::num::NonZero;
use std::sync::Mutex;
use std::thread;

/// How many threads work at once.
fn cores() -> usize {
    #[cfg(test)]
    if let Some(threads) = tests::THREADS.get() {
        return threads;
    }
    thread::available_parallelism().map_or(1, NonZero::get)
}

/// Calls `work` with every chunk of `len` elements and its number, each once, on all cores.
pub(super) fn for_each_chunk<T: Send>(
    data: &mut [T],
    len: usize,
    work: impl Fn(usize, &mut [T]) + Sync,
) {
    let count = data.len().div_ceil(len.max(1));
    let chunks = Mutex::new(data.chunks_mut(len.max(1)).enumerate());
    let drain = || {
        loop {
            let next = chunks.lock().expect("work does not panic").next();
            let Some((index, chunk)) = next else { break };
            work(index, chunk);
        }
    };
    match cores().min(count) {
        0 | 1 => drain(),
        threads => thread::scope(|scope| {
            for _ in 1..threads {
                scope.spawn(drain);
            }
            drain();
        }),
    }
}

/// What `work` makes of each number below `count`, in order, on all cores.
pub(super) fn map<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
    for_each_chunk(&mut results, 1, |index, slot| slot[0] = Some(work(index)));
    results.into_iter().flatten().collect()
}

#[cfg(test)]
pub(super) mod tests {
    use std::cell::Cell;

    use super::*;

    thread_local! {
        /// How many threads the work that this one begins has, in place of as many as there are cores.
        pub(super) static THREADS: Cell<Option<usize>> = const { Cell::new(None) };
    }

    /// Begins work with so many threads.
    pub(in super::super) fn with_threads<T>(threads: usize, work: impl FnOnce() -> T) -> T {
        THREADS.set(Some(threads));
        let result = work();
        THREADS.set(None);
        result
    }

    #[test]
    fn as_many_threads_work_as_there_are_said_to_be() {
        for threads in [1, 3, 7] {
            let meet = std::sync::Barrier::new(threads);
            // Each waits for all others, so that none could do another's work.
            with_threads(threads, || map(threads, |_| meet.wait()));
        }
    }

    #[test]
    fn every_chunk_is_worked_on_once_and_knows_its_place() {
        let mut data = vec![0usize; 1003];
        for_each_chunk(&mut data, 10, |index, chunk| {
            for (i, value) in chunk.iter_mut().enumerate() {
                *value += index * 10 + i + 1;
            }
        });
        assert!(data.iter().enumerate().all(|(i, &value)| value == i + 1));
        for_each_chunk(&mut [0u8; 0], 10, |_, _| unreachable!("there is no chunk"));
        assert_eq!(map(100, |i| i * i)[99], 99 * 99);
    }
}

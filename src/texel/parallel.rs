//! Work on all cores whose result does not depend on how many there are.

use std::num::NonZero;
use std::sync::Mutex;
use std::thread;

/// How many threads work at once.
fn cores() -> usize {
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
mod tests {
    use super::*;

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

//! What a buffer on the GPU holds. Of what it shall hold next, what differs is written, and no more.

use core::ops::Range;

use bevy::render::render_resource::{Buffer, BufferDescriptor, BufferUsages};
use bevy::render::renderer::{RenderDevice, RenderQueue};
use bytemuck::Pod;

/// Bytes that are compared, and written, at once.
pub(crate) const BLOCK: usize = 4_096;

/// A buffer, and what it holds.
pub(crate) struct Mirror<T> {
    label: &'static str,
    usage: BufferUsages,
    buffer: Option<Buffer>,
    /// What the buffer holds.
    held: Vec<T>,
    /// What it shall hold next.
    next: Vec<T>,
}

impl<T: Pod> Mirror<T> {
    pub(crate) fn new(label: &'static str, usage: BufferUsages) -> Self {
        Self {
            label,
            usage,
            buffer: None,
            held: Vec::new(),
            next: Vec::new(),
        }
    }

    /// The buffer, if anything was ever written.
    pub(crate) fn buffer(&self) -> Option<&Buffer> {
        self.buffer.as_ref()
    }

    /// Where to put what it shall hold next; empty.
    pub(crate) fn next(&mut self) -> &mut Vec<T> {
        self.next.clear();
        &mut self.next
    }

    /// Writes what differs of what it shall hold next, at most `most` of it. Tells how many bytes that are.
    pub(crate) fn write(
        &mut self,
        most: usize,
        device: &RenderDevice,
        queue: &RenderQueue,
    ) -> usize {
        self.next.truncate(most);
        let bytes = size_of_val(self.next.as_slice());
        let room = self
            .buffer
            .as_ref()
            .map_or(0, |buffer| buffer.size() as usize);
        if bytes > room {
            // Not for each that is added a buffer anew.
            let capacity = self.next.len().next_power_of_two().min(most);
            self.buffer = Some(device.create_buffer(&BufferDescriptor {
                label: Some(self.label),
                size: (capacity * size_of::<T>()) as u64,
                usage: BufferUsages::COPY_DST | self.usage,
                mapped_at_creation: false,
            }));
            self.held.clear();
        }
        let mut written = 0;
        if let Some(buffer) = &self.buffer {
            let next = bytemuck::cast_slice(&self.next);
            for range in differing(bytemuck::cast_slice(&self.held), next) {
                written += range.len();
                queue.write_buffer(buffer, range.start as u64, &next[range]);
            }
        }
        core::mem::swap(&mut self.held, &mut self.next);
        written
    }
}

/// Where bytes differ from those that are held, in whole blocks, but for the end. Neighbours are one.
fn differing<'a>(held: &'a [u8], next: &'a [u8]) -> impl Iterator<Item = Range<usize>> + 'a {
    let mut starts = (0..next.len()).step_by(BLOCK);
    let end = |start: usize| next.len().min(start + BLOCK);
    let differs = move |start: usize| held.get(start..end(start)) != Some(&next[start..end(start)]);
    core::iter::from_fn(move || {
        let first = starts.by_ref().find(|&start| differs(start))?;
        let mut last = first;
        // The next one that does not differ is not looked at again.
        for start in starts.by_ref() {
            if !differs(start) {
                break;
            }
            last = start;
        }
        Some(first..end(last))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First and end of what is written.
    fn written(held: &[u8], next: &[u8]) -> Vec<[usize; 2]> {
        differing(held, next)
            .map(|range| [range.start, range.end])
            .collect()
    }

    const NOTHING: [[usize; 2]; 0] = [];

    #[test]
    fn only_blocks_that_differ_are_written() {
        let held = vec![0; 5 * BLOCK + 8];
        assert_eq!(written(&held, &held), NOTHING);
        let mut next = held.clone();
        next[BLOCK - 1] = 1;
        next[BLOCK] = 1;
        next[3 * BLOCK + 5] = 1;
        let both = [[0, 2 * BLOCK], [3 * BLOCK, 4 * BLOCK]];
        assert_eq!(written(&held, &next), both);
        next[5 * BLOCK] = 1;
        let end = [5 * BLOCK, 5 * BLOCK + 8];
        assert_eq!(written(&held, &next), [both[0], both[1], end]);
    }

    #[test]
    fn what_is_longer_is_written_and_what_is_shorter_is_not() {
        let held = vec![7; 2 * BLOCK + 8];
        let shorter = &held[..BLOCK + 4];
        assert_eq!(written(&held, shorter), NOTHING);
        assert_eq!(written(shorter, &held), [[BLOCK, 2 * BLOCK + 8]]);
        assert_eq!(written(&[], &held), [[0, 2 * BLOCK + 8]]);
        assert_eq!(written(&held, &[]), NOTHING);
    }
}

//! A GPU buffer's content as the main world keeps it: rows in ranges that come and go, and which have changed.

use core::ops::Range;

use bytemuck::Pod;
use offset_allocator::{Allocation, Allocator};
use thiserror::Error;

/// Rows of one storage buffer.
pub(crate) struct Table<T> {
    rows: Vec<T>,
    allocator: Allocator,
    changed: Vec<Range<usize>>,
    /// Bytes saved since the changes were cleared, that may be spent on closing gaps between them.
    credit: usize,
    name: &'static str,
    capacity: u32,
}

/// A range of rows that is in use.
#[derive(Clone, Copy)]
pub(crate) struct Rows {
    allocation: Allocation,
    len: u32,
}

impl Rows {
    /// Index of the first row.
    pub(crate) fn first(&self) -> u32 {
        self.allocation.offset
    }
}

/// A table has no room for a plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error(
    "no room for {len} more {name} of plants on the GPU (the limit is {capacity}, in {MAX_RANGES} ranges): the plant is \
     not drawn. Despawn plants, let more of them share a skeleton and a pose, or use skeletons with fewer joints"
)]
pub(crate) struct NoRoomError {
    len: usize,
    name: &'static str,
    capacity: u32,
}

/// Rows that a table has room for: as many as one storage buffer of 128 MiB, the least that every device
/// offers, holds of the largest record.
const CAPACITY: u32 = (128 << 20) / 64;

/// Ranges of rows that a table has room for, gaps between them included: a plant takes one in each table, or shares it.
const MAX_RANGES: u32 = 128 << 10;

/// Bytes that may be uploaded for a row that changed.
const ALLOWANCE: usize = 64;

impl<T: Pod> Table<T> {
    /// An empty table; `name` is for messages.
    pub(crate) fn new(name: &'static str) -> Self {
        Self::with_capacity(name, CAPACITY)
    }

    /// An empty table with room for so many rows.
    pub(crate) fn with_capacity(name: &'static str, capacity: u32) -> Self {
        Self {
            rows: Vec::new(),
            // What is free at the end takes one, and one is never given out.
            allocator: Allocator::with_max_allocs(capacity, MAX_RANGES + 2),
            changed: Vec::new(),
            credit: 0,
            name,
            capacity,
        }
    }

    /// Takes `len` rows, at least one.
    pub(crate) fn allocate(&mut self, len: usize) -> Result<Rows, NoRoomError> {
        let no_room = NoRoomError {
            len,
            name: self.name,
            capacity: self.capacity,
        };
        let len = u32::try_from(len.max(1)).map_err(|_| no_room)?;
        let allocation = self.allocator.allocate(len).ok_or(no_room)?;
        let end = (allocation.offset + len) as usize;
        if self.rows.len() < end {
            self.rows.resize(end, T::zeroed());
        }
        Ok(Rows { allocation, len })
    }

    /// Gives rows back.
    pub(crate) fn free(&mut self, rows: Rows) {
        self.allocator.free(rows.allocation);
    }

    /// Writes `content` over the rows from the `offset`th on, as far as they go, and marks them changed.
    ///
    /// Ranges that nearly touch are uploaded as one, as long as all changes together stay below
    /// [`ALLOWANCE`] bytes a row.
    pub(crate) fn write(&mut self, rows: Rows, offset: usize, content: &[T]) {
        let start = rows.first() as usize + offset;
        let end = start
            + content
                .len()
                .min((rows.len as usize).saturating_sub(offset));
        self.rows[start..end].copy_from_slice(&content[..end - start]);
        self.credit += (end - start) * ALLOWANCE.saturating_sub(size_of::<T>());
        if let Some(last) = self.changed.last_mut()
            && start >= last.end
            && (start - last.end) * size_of::<T>() <= self.credit
        {
            self.credit -= (start - last.end) * size_of::<T>();
            last.end = end;
            return;
        }
        self.changed.push(start..end);
    }

    /// All rows, used or not.
    pub(crate) fn rows(&self) -> &[T] {
        &self.rows
    }

    /// Ranges written since [`clear_changed`](Self::clear_changed).
    pub(crate) fn changed(&self) -> &[Range<usize>] {
        &self.changed
    }

    /// Bytes written since [`clear_changed`](Self::clear_changed).
    pub(crate) fn changed_bytes(&self) -> usize {
        let rows: usize = self.changed.iter().map(|range| range.len()).sum();
        rows * size_of::<T>()
    }

    /// Forgets which rows have changed.
    pub(crate) fn clear_changed(&mut self) {
        self.credit = 0;
        self.changed.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_touch_are_uploaded_as_one_and_those_that_stand_still_not_at_all() {
        let mut table = Table::<[u32; 16]>::new("rows");
        let row = [7; 16];
        let [a, b, c, d] = [3, 2, 4, 1].map(|len| table.allocate(len).unwrap());
        for rows in [a, b, c, d] {
            table.write(rows, 0, &vec![row; rows.len as usize]);
        }
        assert_eq!(table.changed_bytes(), 10 * 64);
        assert_eq!(table.changed().len(), 1);
        table.clear_changed();
        table.write(a, 1, &[row; 2]);
        table.write(b, 0, &[row; 2]);
        table.write(d, 0, &[row]);
        assert_eq!(table.changed(), &[1..5, 9..10]);
    }

    #[test]
    fn small_gaps_are_closed_within_the_allowance() {
        // 60 bytes a row: 15 rows that changed pay for one that did not.
        let mut table = Table::<[u32; 15]>::new("rows");
        let rows = table.allocate(64).unwrap();
        for start in [1, 18, 26] {
            table.write(rows, start, &[[7; 15]; 16][..8.min(34 - start)]);
        }
        assert_eq!(table.changed(), &[1..9, 18..34]);
        table.clear_changed();
        table.write(rows, 1, &[[7; 15]; 16]);
        table.write(rows, 18, &[[7; 15]; 16]);
        assert_eq!(
            (table.changed().len(), table.changed()[0].clone()),
            (1, 1..34)
        );
        assert!(table.changed_bytes() <= 64 * 32);
    }

    #[test]
    fn rows_given_back_are_used_again() {
        let mut table = Table::<u32>::new("rows");
        let first = table.allocate(100).unwrap();
        table.allocate(1).unwrap();
        table.free(first);
        assert!(table.allocate(90).unwrap().first() < 100);
        assert_eq!(table.rows().len(), 101);
    }

    #[test]
    fn a_table_that_is_full_says_so_and_goes_on() {
        let mut table = Table::<u8>::new("rows");
        assert!(table.allocate(CAPACITY as usize + 1).is_err());
        assert!(table.allocate(1).is_ok());
    }

    #[test]
    fn a_table_has_as_many_ranges_as_it_says() {
        let mut table = Table::<u8>::new("rows");
        let ranges = (0..=MAX_RANGES).take_while(|_| table.allocate(1).is_ok());
        assert_eq!(ranges.count(), MAX_RANGES as usize);
        let refused = table.allocate(1).map(|rows| rows.first());
        let refused = refused.unwrap_err().to_string();
        assert!(refused.contains("131072 ranges"), "{refused}");
    }
}

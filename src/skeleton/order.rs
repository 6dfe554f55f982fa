//! Putting parents before their children.

/// Puts every parent before its children.
///
/// `parents[i]` is the index of the parent of `i`, if it has one, and must be less than `parents.len()`.
/// Returns `Ok(None)` when the order is already so, and else the old index at each new place: each index
/// comes at its old turn, right after those of its ancestors that have not come yet. `Err` holds an
/// index on a cycle.
///
/// Every index is looked at a bounded number of times, and the walk to the root is a loop, so that a
/// chain of a million is no deeper than one of two.
pub(super) fn parents_first(parents: &[Option<u32>]) -> Result<Option<Vec<u32>>, u32> {
    let ordered = |(child, parent): (usize, &Option<u32>)| {
        parent.is_none_or(|parent| (parent as usize) < child)
    };
    if parents.iter().enumerate().all(ordered) {
        return Ok(None);
    }

    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        Waiting,
        Climbing,
        Placed,
    }
    let mut marks = vec![Mark::Waiting; parents.len()];
    let mut order = Vec::with_capacity(parents.len());
    let mut climb = Vec::new();
    for start in 0..parents.len() as u32 {
        let mut next = Some(start);
        while let Some(index) = next {
            match marks[index as usize] {
                Mark::Placed => break,
                Mark::Climbing => return Err(index),
                Mark::Waiting => {
                    marks[index as usize] = Mark::Climbing;
                    climb.push(index);
                    next = parents[index as usize];
                }
            }
        }
        while let Some(index) = climb.pop() {
            marks[index as usize] = Mark::Placed;
            order.push(index);
        }
    }
    Ok(Some(order))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_order_that_has_parents_first_is_kept() {
        assert_eq!(
            parents_first(&[None, Some(0), None, Some(1), Some(0)]),
            Ok(None)
        );
        assert_eq!(parents_first(&[]), Ok(None));
    }

    #[test]
    fn only_ancestors_are_moved_forward() {
        // 0 hangs from 3, 3 from 4; 1 and 2 need not move past each other.
        let order = parents_first(&[Some(3), None, Some(1), Some(4), None]);
        assert_eq!(order, Ok(Some(vec![4, 3, 0, 1, 2])));
    }

    #[test]
    fn cycles_are_found_wherever_they_hang() {
        assert_eq!(parents_first(&[Some(0)]), Err(0));
        assert_eq!(parents_first(&[None, Some(2), Some(1)]), Err(1));
        // 0 leads into the cycle 1, 2, 3 without being on it.
        assert_eq!(parents_first(&[Some(1), Some(2), Some(3), Some(1)]), Err(1));
    }

    #[test]
    fn a_chain_of_a_million_in_the_wrong_order_is_turned_round() {
        let count = 1_000_000;
        let parents: Vec<_> = (1..=count)
            .map(|next| (next < count).then_some(next))
            .collect();
        let order = parents_first(&parents).unwrap().unwrap();
        assert!(order.iter().copied().eq((0..count).rev()));
    }
}

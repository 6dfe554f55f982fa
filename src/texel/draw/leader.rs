//! Who draws for all.
//!
//! Bevy's phases have an item for each surface, and one draw shows all surfaces of a group. Which of the items a phase of a
//! view has, and in which order, is Bevy's to say: it culls by rules of its own. So the first item that comes to be drawn
//! leads, and the others of its group leave it to that one.

use core::sync::atomic::{AtomicU64, Ordering};

use bevy::core_pipeline::core_3d::{AlphaMask3d, Opaque3d};
use bevy::core_pipeline::prepass::AlphaMask3dPrepass;
use bevy::pbr::Shadow;
use bevy::prelude::*;
use bevy::render::render_phase::PhaseItem;

/// A phase that texels are drawn in. Each has a number.
pub(crate) trait TexelPhase: PhaseItem {
    const NUMBER: usize;
}

impl TexelPhase for Opaque3d {
    const NUMBER: usize = 0;
}

impl TexelPhase for AlphaMask3d {
    const NUMBER: usize = 1;
}

impl TexelPhase for AlphaMask3dPrepass {
    const NUMBER: usize = 2;
}

impl TexelPhase for Shadow {
    const NUMBER: usize = 3;
}

/// How many phases there are.
const PHASES: usize = 4;

/// The items that lead a group in the phases of a view, in this frame.
#[derive(Debug)]
pub(crate) struct Leaders([AtomicU64; PHASES]);

/// In place of an item where none has come yet. No entity has these bits.
const NOBODY: u64 = 0;

impl Default for Leaders {
    fn default() -> Self {
        Self([const { AtomicU64::new(NOBODY) }; PHASES])
    }
}

impl Leaders {
    /// Whether this item leads. Once it does it does all through the frame, for a phase may be drawn again: as Bevy's
    /// prepasses are, when it culls what is hidden.
    pub(crate) fn leads<P: TexelPhase>(&self, item: Entity) -> bool {
        let leader = &self.0[P::NUMBER];
        let own = item.to_bits();
        let found = leader.compare_exchange(NOBODY, own, Ordering::Relaxed, Ordering::Relaxed);
        found.map_or_else(|leader| leader == own, |_| true)
    }

    /// Begins a frame in which nobody has come yet.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_item_of_each_phase_leads_until_the_next_frame() {
        let [a, b] = [1, 2].map(|i| Entity::from_raw_u32(i).expect("a number below the last"));
        let mut leaders = Leaders::default();
        assert!(leaders.leads::<Opaque3d>(a));
        assert!(!leaders.leads::<Opaque3d>(b));
        assert!(leaders.leads::<Shadow>(b), "another phase");
        assert!(leaders.leads::<Opaque3d>(a), "drawn again");
        leaders.clear();
        assert!(leaders.leads::<Opaque3d>(b));
        assert_ne!(Entity::from_raw_u32(0).map(Entity::to_bits), Some(NOBODY));
    }
}

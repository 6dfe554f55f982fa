//! Rivals: the same plants by frusta and by polygons, under the same sun and before the same eye, and what is to be said
//! of each: how wrong it looks, what it costs, what it weighs.
//!
//! | file | what it does |
//! |---|---|
//! | `dress` | what surfaces look like: maps painted by code, so that a binary needs no files beside it |
//! | `exhibit` | a planting under its sun, as entities of each rival, of which one is shown at a time |
//! | `weight` | bytes of geometry |
//! | `view` | an eye that a planting fills the picture of |
//! | `judge` | mean FLIP against a supersampled reference, and the subdivision that is as good |
//!
//! The reference is what frusta draw with their finest settings, [`March::FINEST`] where there is relief. It has their
//! shading normals (Equation 8), which polygons do not come to; so these are judged by the limit of their own as well
//! ([`Judge::match_polygons`]).

mod dress;
mod exhibit;
mod judge;
mod view;
mod weight;

pub use dress::{Dress, Wardrobe};
pub use exhibit::{Exhibit, NotShown};
pub use judge::{AS_GOOD, Flips, Judge, Match, SUPERSAMPLING, aim};
pub use view::fitting;
pub use weight::Weight;

use crate::frusta::{Relief, ReliefMarch, ReliefSteps, ReliefV};

/// How relief is marched: the settings of [`Relief`] that trade error for time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct March {
    /// Steps through the shell.
    pub steps: ReliefSteps,
    /// Halvings of the step that a ray meets the relief in.
    pub bisections: u32,
    /// How v is found.
    pub v: ReliefV,
    /// Whether steps are looked at one by one or leapt over.
    pub march: ReliefMarch,
}

impl March {
    /// Finer than any picture shows: 256 steps and 10 bisections, v exact.
    pub const FINEST: Self = Self {
        steps: ReliefSteps::Fixed(256),
        bisections: 10,
        v: ReliefV::Exact,
        march: ReliefMarch::Uniform,
    };

    /// Sets a relief's march.
    pub fn apply(self, relief: &mut Relief) {
        relief.steps = self.steps;
        relief.bisections = self.bisections;
        relief.v = self.v;
        relief.march = self.march;
    }
}

impl Default for March {
    /// What [`Relief::new`] sets.
    fn default() -> Self {
        let relief = Relief::new(
            Default::default(),
            crate::prelude::ReliefThickness::Metres(0.0),
        );
        Self {
            steps: relief.steps,
            bisections: relief.bisections,
            v: relief.v,
            march: relief.march,
        }
    }
}

/// One way to draw a planting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Rival {
    /// Frusta, ray cast. Where surfaces have relief it is marched so, or left out.
    Frusta(Option<March>),
    /// Polygons of the same surface, with displaced vertices where there is relief.
    Polygons {
        /// m: 16·4^m triangles a segment.
        subdivisions: u32,
        /// Whether relief displaces them.
        relief: bool,
    },
}

impl Rival {
    /// Frusta with or without relief, as the defaults are.
    pub fn frusta(relief: bool) -> Self {
        Self::Frusta(relief.then(March::default))
    }

    /// Frusta that others are judged by.
    pub fn reference(relief: bool) -> Self {
        Self::Frusta(relief.then_some(March::FINEST))
    }
}

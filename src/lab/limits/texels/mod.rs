//! Where texels fail: what slices show that the volume has not, and what filling gets wrong.
//!
//! | file | question |
//! |---|---|
//! | [`gaps`] | from which view angle on does one see through slices, of one direction and of three? |
//! | [`criteria`] | does each criterion of §4.1 and §4.3 say where what it forbids begins? |
//! | [`filling`] | which shapes does the appendix' parity get wrong? |
//!
//! `wall` has the solid of a known thickness that the first two look at, `solids` has the shapes of the last.

pub mod criteria;
pub mod filling;
pub mod gaps;
mod solids;
mod wall;

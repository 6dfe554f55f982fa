//! The frusta as a GPU draws them, against references: one binary, for each links all of Bevy.

mod agreement;
mod features;
mod geometry;
mod golden;
mod live;
mod skeletons;
mod twins;
mod watertight;

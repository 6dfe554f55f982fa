//! The crate as a user and a GPU see it, against references: one binary, for each links all of Bevy.

mod agreement;
mod compute;
mod features;
mod geometry;
mod golden;
mod jumps;
mod lifecycle;
mod live;
mod meshes;
mod multisample;
mod polygons;
mod recovery;
mod relief;
mod rivals;
mod roll;
mod segments;
mod skeleton_files;
mod skeletons;
mod skinned;
mod slicing;
mod texel;
mod twins;
mod view;
mod views;
mod watertight;
mod wood;

//! An upright wall, as thick in every slice along w, and rays that enter it from its side: of those the share that pass
//! between slices has a closed form.

use glam::{DVec3, UVec3};

use crate::lab::texel::march_slices;
use crate::texel::build::{VolumeSettings, from_implicit};
use crate::texel::{ReferenceVolume, SliceAxis, SliceSet, silent};

/// Voxels along u and w.
const SIDE: u32 = 64;
/// Where the wall begins along u, in voxels: where slices of 8 to 64 along u meet a wall of 4 voxels.
const NEAR: u32 = 4;
/// Rays of each angle.
pub(super) const RAYS: u32 = 1000;

/// The wall in its volume, which is a metre long and high.
pub(super) struct Wall {
    pub volume: ReferenceVolume,
    /// e: its thickness, in metres.
    pub e: f64,
}

/// What a ray sees of a wall that it enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// How far behind the wall's side, along u.
    pub deep: f64,
    /// How far below the place where the ray enters.
    pub below: f64,
}

impl Wall {
    /// A wall as thick as some voxels of 64.
    pub fn new(voxels: u32) -> Self {
        let far = NEAR + voxels;
        let inside = NEAR as f32 / SIDE as f32..far as f32 / SIDE as f32;
        let settings = VolumeSettings::new(UVec3::new(SIDE, 4, SIDE));
        let solid = |at: bevy::math::Vec3| if inside.contains(&at.x) { 2.0 } else { 0.0 };
        let built = from_implicit(solid, |_| bevy::math::Vec3::ONE, &settings, &silent);
        Self {
            volume: built.expect("the volume is in range").volume,
            e: f64::from(voxels) / f64::from(SIDE),
        }
    }

    /// Slices of it.
    pub fn slices(&self, axis: SliceAxis, count: u32) -> SliceSet {
        SliceSet::new(&self.volume, axis, count)
    }

    /// What rays see of slices that come down at the angle `a` from w, towards u, and enter the wall at heights that are
    /// spread evenly from one slice along w of so many to the next, amid the wall; none where they see through.
    pub fn look(&self, slices: &SliceSet, a: f64, count: u32) -> Vec<Option<Seen>> {
        let (sin, cos) = a.sin_cos();
        let dir = DVec3::new(sin, 0.0, -cos);
        let h = 1.0 / f64::from(count);
        let slice = (f64::from(count / 2) + 0.5) * h;
        let near = f64::from(NEAR) / f64::from(SIDE);
        let look = |i: u32| {
            let height = slice + h * (f64::from(i) + 0.5) / f64::from(RAYS);
            let enters = DVec3::new(near, 0.01, height);
            // Until it leaves the wall, or the volume.
            let leaves = (self.e / sin).min(height / cos);
            let hit = march_slices(slices, enters, dir, [0.0, leaves])?;
            Some(Seen {
                deep: hit.uvw.x - near,
                below: height - hit.uvw.z,
            })
        };
        (0..RAYS).map(look).collect()
    }
}

/// The share of rays of which something is true.
pub(super) fn share(seen: &[Option<Seen>], is_wrong: impl Fn(&Option<Seen>) -> bool) -> f64 {
    let wrong = seen.iter().filter(|seen| is_wrong(seen)).count();
    wrong as f64 / seen.len() as f64
}

/// The share of rays that step aside by more than they may, if a step is `ratio` times as far: from 1 on.
pub(super) fn expected(ratio: f64) -> f64 {
    (1.0 - 1.0 / ratio).max(0.0)
}

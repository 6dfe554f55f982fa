//! Any bytes as a `*.skeleton.ron` file: an error, or a skeleton that survives writing and reading.

#![no_main]

use bevy_verdure::skeleton::{Skeleton, SkeletonLoaderSettings, skeleton_from_bytes};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let settings = SkeletonLoaderSettings::default();
    if let Ok(skeleton) = skeleton_from_bytes("fuzz.skeleton.ron", bytes, &settings) {
        assert_eq!(Skeleton::from_ron_str(&skeleton.to_ron()), Ok(skeleton));
    }
});

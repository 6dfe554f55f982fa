//! Any bytes as a `*.csv` file, however it is read: an error, or a skeleton that `Skeleton::new` accepts.

#![no_main]

use bevy_verdure::skeleton::{
    Recentre, Skeleton, SkeletonLoaderSettings, UpAxis, skeleton_from_bytes,
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let widened = SkeletonLoaderSettings {
        scale: 1e-3,
        recentre: Recentre::Always,
        up: Some(UpAxis::Z),
        min_radius: Some(0.001),
    };
    for settings in [SkeletonLoaderSettings::default(), widened] {
        if let Ok(skeleton) = skeleton_from_bytes("fuzz.csv", bytes, &settings) {
            let joints = skeleton.joints().to_vec();
            assert_eq!(Skeleton::new(joints).unwrap().joints(), skeleton.joints());
        }
    }
});

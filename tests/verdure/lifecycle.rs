//! What becomes of a plant's pose and segments when components come and go.

use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;

use crate::skeletons;

/// A straight limb of `segments` segments, planted.
fn limb(studio: &mut Studio, segments: usize) -> Entity {
    studio.plant(
        skeletons::limb(segments),
        Frusta::default(),
        Transform::IDENTITY,
    )
}

fn tip(studio: &mut Studio, plant: Entity) -> Option<Vec3> {
    let posed = studio.world().get::<PosedJoints>(plant)?;
    posed.positions().last().copied()
}

fn steps(studio: &mut Studio, count: usize) {
    for _ in 0..count {
        studio.headless.step();
    }
}

fn bent() -> SkeletonPose {
    let quarter = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    SkeletonPose {
        rotations: vec![Quat::IDENTITY, quarter],
    }
}

#[test]
fn a_plant_stands_at_rest_again_when_its_pose_is_removed() {
    let mut studio = Studio::default();
    let plant = limb(&mut studio, 2);
    studio.world().entity_mut(plant).insert(bent());
    steps(&mut studio, 2);
    // A quarter turn lays the limb along −x; a few roundings of numbers up to 1.
    let lain = tip(&mut studio, plant).unwrap();
    assert!(lain.distance(Vec3::NEG_X) < 1e-5, "{lain}");
    studio.world().entity_mut(plant).remove::<SkeletonPose>();
    steps(&mut studio, 2);
    assert_eq!(tip(&mut studio, plant), None);
}

#[test]
fn a_pose_by_rotations_takes_over_when_a_plant_is_folded() {
    let mut studio = Studio::default();
    let plant = limb(&mut studio, 2);
    let mut entity = studio.world().entity_mut(plant);
    entity.insert((bent(), UnfoldSkeleton));
    steps(&mut studio, 3);
    assert_eq!(tip(&mut studio, plant), Some(Vec3::Y), "segments rule");
    studio.world().entity_mut(plant).remove::<UnfoldSkeleton>();
    steps(&mut studio, 3);
    let lain = tip(&mut studio, plant).unwrap();
    assert!(lain.distance(Vec3::NEG_X) < 1e-5, "{lain}");
}

#[test]
fn a_clone_of_an_unfolded_plant_has_segments_of_its_own() {
    let mut studio = Studio::default();
    let plant = limb(&mut studio, 3);
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    steps(&mut studio, 2);
    let clone = studio.world().entity_mut(plant).clone_and_spawn();
    steps(&mut studio, 2);
    let segments = |studio: &mut Studio, plant| {
        let unfolded = studio.world().get::<SegmentEntities>(plant).unwrap();
        unfolded
            .iter()
            .map(|(_, entity)| entity)
            .collect::<Vec<_>>()
    };
    let (first, second) = (segments(&mut studio, plant), segments(&mut studio, clone));
    assert_eq!((first.len(), second.len()), (3, 3));
    assert!(first.iter().all(|segment| !second.contains(segment)));
    studio.world().despawn(clone);
    steps(&mut studio, 1);
    for segment in first {
        assert!(studio.world().get_entity(segment).is_ok());
    }
}

#[test]
fn a_segment_that_is_despawned_goes_back_to_rest() {
    let mut studio = Studio::default();
    let plant = limb(&mut studio, 2);
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    steps(&mut studio, 2);
    let unfolded = studio.world().get::<SegmentEntities>(plant).unwrap();
    let last = unfolded.get(2).unwrap();
    let quarter = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    studio.world().get_mut::<Transform>(last).unwrap().rotation = quarter;
    steps(&mut studio, 1);
    let turned = tip(&mut studio, plant).unwrap();
    assert!(
        turned.distance(Vec3::new(-0.5, 0.5, 0.0)) < 1e-5,
        "{turned}"
    );
    studio.world().despawn(last);
    steps(&mut studio, 1);
    assert_eq!(tip(&mut studio, plant), Some(Vec3::Y));
}

#[test]
fn a_row_too_long_for_a_hierarchy_is_not_unfolded() {
    let mut studio = Studio::default();
    let plant = limb(&mut studio, 3000);
    studio.world().entity_mut(plant).insert(UnfoldSkeleton);
    steps(&mut studio, 2);
    assert!(studio.world().get::<SegmentEntities>(plant).is_none());
    assert_eq!(studio.world().resource::<FrustaStats>().segments, 3000);
}

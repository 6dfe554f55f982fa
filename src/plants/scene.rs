//! Scenes: several plants at their places.

use bevy::math::{Quat, Vec3};
use bevy::transform::components::Transform;

use super::Plant;
use super::dice::Dice;
use super::shape::heading;

/// Several plants at their places: a scene.
///
/// A plant may stand at several places; its skeletons are then shared, and drawn as many times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planting {
    /// The plants, each in its own local space.
    pub plants: Vec<Plant>,
    /// Where they stand.
    pub places: Vec<Place>,
}

/// Where one plant of a [`Planting`] stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Index into [`Planting::plants`].
    pub plant: usize,
    /// Where its local origin comes to stand, in metres, y up.
    pub position: Vec3,
    /// Turn about y, in radians.
    pub yaw: f32,
    /// Uniform scale, applied first; greater than 0.
    pub scale: f32,
}

impl Place {
    /// From the plant's local space to the scene's.
    pub fn transform(&self) -> Transform {
        Transform {
            translation: self.position,
            rotation: Quat::from_rotation_y(self.yaw),
            scale: Vec3::splat(self.scale),
        }
    }
}

impl Planting {
    /// How many segments are drawn: those of each plant as often as it stands somewhere.
    pub fn segment_count(&self) -> usize {
        let count = |place: &Place| self.plants.get(place.plant).map_or(0, Plant::segment_count);
        self.places.iter().map(count).sum()
    }

    /// Adds a plant that stands nowhere yet, and returns its index.
    pub fn add(&mut self, plant: Plant) -> usize {
        self.plants.push(plant);
        self.plants.len() - 1
    }

    /// Lets a plant stand somewhere.
    pub fn place(&mut self, plant: usize, position: Vec3, yaw: f32, scale: f32) {
        self.places.push(Place {
            plant,
            position,
            yaw,
            scale,
        });
    }
}

/// Ground that fills up: finds places that keep their distance from those found before.
pub(super) struct Ground {
    taken: Vec<(Vec3, f32)>,
}

impl Ground {
    /// Ground on which discs, given by centre and radius in metres, are taken.
    pub fn new(taken: &[(Vec3, f32)]) -> Self {
        Self {
            taken: taken.to_vec(),
        }
    }

    /// Takes a disc, given by centre and radius in metres, and returns its centre.
    pub fn claim(&mut self, place: Vec3, radius: f32) -> Vec3 {
        self.taken.push((place, radius));
        place
    }

    /// The roomiest of some random places between `inner` and `outer` metres from the origin, for something that
    /// needs `radius` metres. Always finds one; where the ground is full, things overlap.
    pub fn find(&mut self, inner: f32, outer: f32, radius: f32, dice: &mut Dice) -> Vec3 {
        let mut best = (f32::NEG_INFINITY, Vec3::ZERO);
        for _ in 0..24 {
            // Even over the ring's area.
            let out = dice.between(inner * inner, outer * outer).sqrt();
            let place = heading(dice.angle()) * out;
            let room = |&(other, size): &(Vec3, f32)| place.distance(other) - size - radius;
            let room = self.taken.iter().map(room).fold(f32::INFINITY, f32::min);
            // Anything beyond twice its size is room enough: places are not to be evenly spaced.
            let room = room.min(2.0 * radius);
            if room > best.0 {
                best = (room, place);
            }
        }
        self.claim(best.1, radius)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plants::testing::ODD;
    use crate::plants::{Desert, Oasis};

    #[test]
    fn a_desert_has_799_segments_and_an_oasis_18557() {
        for seed in [0, 1, 2, 77, u64::MAX] {
            assert_eq!(Desert::default().grow(seed).segment_count(), 799);
            assert_eq!(Oasis::default().grow(seed).segment_count(), 18_557);
        }
    }

    #[test]
    fn scenes_follow_their_seed() {
        assert_eq!(Desert::default().grow(5), Desert::default().grow(5));
        assert_ne!(Desert::default().grow(5), Desert::default().grow(6));
        assert_eq!(Oasis::default().grow(5), Oasis::default().grow(5));
        assert_ne!(Oasis::default().grow(5), Oasis::default().grow(6));
    }

    #[test]
    fn every_place_is_finite_and_has_a_plant_for_any_parameter() {
        for x in ODD {
            for planting in [Desert { radius: x }.grow(1), Oasis { pond: x }.grow(1)] {
                for place in &planting.places {
                    assert!(place.plant < planting.plants.len());
                    assert!(place.position.is_finite() && place.yaw.is_finite());
                    assert!(place.scale > 0.0 && place.scale < 2.0);
                }
            }
        }
    }

    #[test]
    fn places_keep_their_distance_while_there_is_room() {
        let mut dice = Dice::new(4);
        let mut ground = Ground::new(&[(Vec3::ZERO, 2.0)]);
        let places: Vec<_> = (0..12)
            .map(|_| ground.find(2.0, 12.0, 0.5, &mut dice))
            .collect();
        for (i, one) in places.iter().enumerate() {
            assert!(one.length() >= 2.0 && one.length() <= 12.001);
            for other in &places[i + 1..] {
                assert!(one.distance(*other) > 1.0);
            }
        }
    }
}

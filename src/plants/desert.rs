//! Desert: cacti, agaves and ocotillos among stones (Figure 11 of the paper, right).

use super::dice::Dice;
use super::scene::{Ground, Planting};
use super::shape::within;
use super::{Aloe, BarrelCactus, Grass, Ocotillo, Plant, Saguaro, Stones};

/// A piece of the Sonoran desert: six saguaros of different ages, two agaves, two ocotillos, twelve barrel cacti,
/// tussocks of dry grass and heaps of stones. 799 segments in all; those that stand several times share their
/// skeleton.
#[derive(Clone, Debug, PartialEq)]
pub struct Desert {
    /// Radius of the place, in metres; 4 to 1,000.
    pub radius: f32,
}

impl Default for Desert {
    fn default() -> Self {
        Self { radius: 8.0 }
    }
}

impl Desert {
    /// Plants a desert. Values outside their ranges are brought into them, and those that are not finite replaced
    /// by the default's.
    pub fn grow(&self, seed: u64) -> Planting {
        let radius = within(self.radius, 4.0, 1_000.0, Self::default().radius);
        let mut dice = Dice::new(seed);
        let mut ground = Ground::new(&[]);
        let mut desert = Planting::default();
        let mut stand = |plant: Plant, room: f32, times: u32, dice: &mut Dice| {
            let index = desert.add(plant);
            for _ in 0..times {
                let scale = if times > 1 {
                    dice.between(0.75, 1.15)
                } else {
                    1.0
                };
                let position = ground.find(0.0, radius, room * scale, dice);
                desert.place(index, position, dice.angle(), scale);
            }
        };
        // Old ones with many arms, and young ones without: 9 segments and 7 an arm.
        for (arms, height) in [(3, 5.2), (5, 6.4), (2, 4.3), (4, 5.6), (1, 3.4), (0, 1.9)] {
            let saguaro = Saguaro {
                arms,
                height: height * dice.between(0.92, 1.08),
                radius: 0.12 + 0.028 * height,
            };
            stand(saguaro.grow(dice.bits()), 1.1, 1, &mut dice);
        }
        let ocotillo = Ocotillo::default();
        stand(ocotillo.grow(dice.bits()), 1.2, 2, &mut dice);
        let agave = Aloe {
            leaf_length: 0.75,
            leaf_radius: 0.065,
            leaves: 18,
            teeth: 0,
            spread: 0.3,
        };
        stand(agave.grow(dice.bits()), 0.8, 2, &mut dice);
        for (height, radius) in [(0.62, 0.22), (0.42, 0.18)] {
            let barrel = BarrelCactus { height, radius };
            stand(barrel.grow(dice.bits()), 0.35, 6, &mut dice);
        }
        let tussock = Grass {
            height: 0.45,
            blades: 7,
            radius: 0.05,
            arch: 0.6,
        };
        stand(tussock.grow(dice.bits()), 0.3, 5, &mut dice);
        for times in [1, 2] {
            let stones = Stones {
                count: 14,
                size: 0.28,
                radius: 0.9,
            };
            stand(stones.grow(dice.bits()), 0.8, times, &mut dice);
        }
        desert
    }
}

//! Oasis: palms that lean over a pond (Figure 11 of the paper, left).

use core::f32::consts::TAU;

use bevy::math::Vec3;

use super::dice::Dice;
use super::scene::{Ground, Planting};
use super::shape::{heading, within};
use super::{Aloe, CoconutTree, Grass, Plant, Stones, Surface};
use crate::skeleton::Skeleton;

/// How far the water stands above the ground, in metres: enough to hide the ground, too little to be seen.
const WATER_LEVEL: f32 = 0.02;

/// An oasis: four tall palms and a young one round a pond, their crowns over the water, with reeds, grass, agaves and
/// stones. 18,557 segments in all, of which 7,426 are stored for the tall palms, which stand twice each.
///
/// The pond is a flat frustum ([`Surface::Water`]) round the origin, 2 cm above the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Oasis {
    /// Radius of the pond, in metres; 1 to 50.
    pub pond: f32,
}

impl Default for Oasis {
    fn default() -> Self {
        Self { pond: 3.2 }
    }
}

impl Oasis {
    /// Plants an oasis. Values outside their ranges are brought into them, and those that are not finite replaced by
    /// the default's.
    pub fn grow(&self, seed: u64) -> Planting {
        let pond = within(self.pond, 1.0, 50.0, Self::default().pond);
        let mut dice = Dice::new(seed);
        let mut ground = Ground::new(&[(Vec3::ZERO, pond)]);
        let mut oasis = Planting::default();
        let water = oasis.add(water(pond));
        oasis.place(water, Vec3::ZERO, 0.0, 1.0);
        palms(&mut oasis, &mut ground, pond, &mut dice);

        let mut stand = |plant: Plant, room: f32, reach: f32, times: u32, dice: &mut Dice| {
            let index = oasis.add(plant);
            for _ in 0..times {
                let scale = dice.between(0.7, 1.1);
                let position = ground.find(pond * 0.97, pond + reach, room * scale, dice);
                oasis.place(index, position, dice.angle(), scale);
            }
        };
        let agave = Aloe {
            leaf_length: 0.8,
            leaf_radius: 0.07,
            leaves: 18,
            teeth: 0,
            spread: 0.35,
        };
        stand(agave.grow(dice.bits()), 0.6, 2.0, 2, &mut dice);
        let reeds = Grass {
            height: 1.5,
            blades: 18,
            radius: 0.28,
            arch: 0.35,
        };
        stand(reeds.grow(dice.bits()), 0.3, 0.3, 4, &mut dice);
        let stones = Stones {
            radius: 0.42,
            ..Stones::default()
        };
        stand(stones.grow(dice.bits()), 0.35, 0.25, 15, &mut dice);
        stand(stones.grow(dice.bits()), 0.35, 1.6, 10, &mut dice);
        for _ in 0..2 {
            stand(Grass::default().grow(dice.bits()), 0.22, 1.8, 8, &mut dice);
        }
        oasis
    }
}

fn water(radius: f32) -> Plant {
    let mut plant = Skeleton::builder();
    let bed = plant.root(Vec3::Y * -0.3, radius);
    plant.texture_length(bed, radius);
    plant.joint(bed, Vec3::Y * WATER_LEVEL, radius);
    Plant::default().with(Surface::Water, plant)
}

/// Palms stand round the pond and lean over it, the young one upright.
fn palms(oasis: &mut Planting, ground: &mut Ground, pond: f32, dice: &mut Dice) {
    let tall = [(8.4, 0.2), (6.2, 0.34)].map(|(height, lean)| {
        let palm = CoconutTree {
            height,
            lean,
            ..CoconutTree::default()
        };
        oasis.add(palm.grow(dice.bits()))
    });
    let young = CoconutTree {
        height: 1.6,
        trunk_radius: 0.13,
        lean: 0.08,
        fronds: 12,
        frond_length: 3.0,
        leaflets: 24,
        nuts: 0,
    };
    let young = oasis.add(young.grow(dice.bits()));
    let first = dice.angle();
    for (i, plant) in [tall[0], tall[1], young, tall[0], tall[1]]
        .into_iter()
        .enumerate()
    {
        let around = first + TAU * i as f32 / 5.0 + dice.jitter(0.3);
        let position = heading(around) * (pond + dice.between(0.5, 1.0));
        let position = ground.claim(position, 0.5);
        // The heading in which the trunk leans, turned to the one from here to the water.
        let wanted = around + TAU / 2.0 + dice.jitter(0.5);
        let yaw = lean_heading(&oasis.plants[plant]) - wanted;
        oasis.place(plant, position, yaw, dice.between(0.92, 1.08));
    }
}

/// The heading in which a palm's trunk leans, in radians from x towards z.
fn lean_heading(palm: &Plant) -> f32 {
    let trunk = palm.part(Surface::PalmTrunk);
    let top = trunk.and_then(|trunk| trunk.joints().last());
    top.map_or(0.0, |top| top.position.z.atan2(top.position.x))
}

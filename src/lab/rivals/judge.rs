//! How wrong a rival looks.

use bevy::prelude::*;

use super::dress::Wardrobe;
use super::exhibit::{Exhibit, SKY};
use super::{Rival, Weight};
use crate::lab::capture::Pixels;
use crate::lab::compare::mean_flip;
use crate::lab::studio::{Figures, Shot, Studio};
use crate::lab::supersample::box_downsample;

/// By how much mean FLIP may be above that of frusta where polygons count as good. The reference has the shading normals
/// of frusta, which polygons do not come to at joints however fine they are.
pub const AS_GOOD: f32 = 0.002;

/// How many times as wide and as high the reference is taken.
pub const SUPERSAMPLING: u32 = 4;

/// Judges rivals by mean FLIP against a reference of the same scene.
pub struct Judge {
    shot: Shot,
    reference: Vec<u8>,
}

impl Judge {
    /// Takes the reference: of a rival that stands, without MSAA, [`SUPERSAMPLING`] times as large in both directions,
    /// averaged down in linear light.
    pub fn new(studio: &mut Studio, exhibit: &Exhibit, rival: Rival, shot: Shot) -> Self {
        exhibit.show(&mut studio.headless, Some(rival));
        set_msaa(studio, Msaa::Off);
        let large = Shot {
            size: shot.size * SUPERSAMPLING,
            ..shot
        };
        // What is new reaches the device first, in a picture that costs little.
        studio.photograph(
            &Shot {
                size: UVec2::splat(16),
                ..shot
            },
            SKY,
        );
        let picture = studio.photograph(&large, SKY);
        let reference = box_downsample(shot.size, SUPERSAMPLING, &picture.rgb_bytes());
        set_msaa(studio, Msaa::default());
        Self { shot, reference }
    }

    /// The reference's colours, sRGB, row by row.
    pub fn reference(&self) -> &[u8] {
        &self.reference
    }

    /// A picture of a rival that stands, with the anti-aliasing that Bevy's cameras have by default.
    pub fn picture(&self, studio: &mut Studio, exhibit: &Exhibit, rival: Rival) -> Pixels {
        exhibit.show(&mut studio.headless, Some(rival));
        set_msaa(studio, Msaa::default());
        // Pipelines, textures and meshes of what was not seen before are there a frame later.
        studio.headless.step();
        studio.photograph(&self.shot, SKY)
    }

    /// Mean FLIP of a rival that stands.
    pub fn flip(&self, studio: &mut Studio, exhibit: &Exhibit, rival: Rival) -> f32 {
        let picture = self.picture(studio, exhibit, rival);
        let size = (self.shot.size.x, self.shot.size.y);
        mean_flip(size, &self.reference, &picture.rgb_bytes())
    }

    /// What a rival of frusta measures: depth and segment of each pixel. Nothing but the plants is in the picture.
    pub fn figures(&self, studio: &mut Studio, exhibit: &Exhibit, rival: Rival) -> Figures {
        exhibit.show(&mut studio.headless, Some(rival));
        exhibit.show_stage(&mut studio.headless, false);
        set_msaa(studio, Msaa::Off);
        let figures = studio.measure(&self.shot);
        exhibit.show_stage(&mut studio.headless, true);
        set_msaa(studio, Msaa::default());
        figures
    }

    /// Subdivides polygons until their error is at most `target` and [`AS_GOOD`]: 0 to `most` times, in at most `limit`
    /// bytes. The ones found stay up, all others are taken down. `None` if not even the coarsest fit.
    pub fn match_polygons(
        &self,
        studio: &mut Studio,
        exhibit: &mut Exhibit,
        wardrobe: &mut Wardrobe,
        relief: bool,
        target: f32,
        (most, limit): (u32, usize),
    ) -> Option<Match> {
        let mut best: Option<Match> = None;
        let mut tried = Vec::new();
        for subdivisions in 0..=most {
            let rival = Rival::Polygons {
                subdivisions,
                relief,
            };
            let put_up = exhibit.put_up(&mut studio.headless, wardrobe, rival, limit);
            let Ok(weight) = put_up else { break };
            let flip = self.flip(studio, exhibit, rival);
            if let Some(best) = &best {
                exhibit.take_down(&mut studio.headless, best.rival);
            }
            tried.push(flip);
            let reached = flip <= target + AS_GOOD;
            best = Some(Match {
                rival,
                subdivisions,
                flip,
                weight,
                reached,
                tried: tried.clone(),
            });
            if reached {
                break;
            }
        }
        best
    }
}

/// Polygons that are as good as frusta, or as good as they get.
#[derive(Clone, Debug, PartialEq)]
pub struct Match {
    /// The polygons.
    pub rival: Rival,
    /// m.
    pub subdivisions: u32,
    /// Mean FLIP.
    pub flip: f32,
    /// What they weigh.
    pub weight: Weight,
    /// Whether they are as good, or just the finest that were tried.
    pub reached: bool,
    /// Mean FLIP of each subdivision that was tried, from 0 on.
    pub tried: Vec<f32>,
}

/// Aims the camera, so that frames may be timed, with the anti-aliasing that Bevy's cameras have by default.
pub fn aim(studio: &mut Studio, shot: &Shot) {
    set_msaa(studio, Msaa::default());
    studio.photograph(shot, SKY);
}

/// Sets the anti-aliasing of a studio's camera.
fn set_msaa(studio: &mut Studio, msaa: Msaa) {
    let camera = studio.camera();
    studio.world().entity_mut(camera).insert(msaa);
}

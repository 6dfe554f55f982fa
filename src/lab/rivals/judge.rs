//! How wrong a rival looks.

use bevy::prelude::*;

use super::dress::Wardrobe;
use super::exhibit::Exhibit;
use super::{Rival, Weight};
use crate::lab::capture::Pixels;
use crate::lab::compare::mean_flip;
use crate::lab::daylight::SKY;
use crate::lab::studio::{Figures, Shot, Studio};
use crate::lab::supersample::box_downsample;

/// By how much mean FLIP may be above that of frusta where polygons count as good: what two pictures of one quality
/// differ by.
pub const AS_GOOD: f32 = 0.001;

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
        self.flip_of(&picture.rgb_bytes())
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
    /// bytes. Where none are that good the best are taken, which need not be the finest: triangles smaller than a pixel
    /// flicker. `None` if not even the coarsest fit. The ones found stay up, all others are taken down.
    ///
    /// Frusta and polygons shade alike only where a limb is straight: Equation 8 is continuous at joints, and on steep
    /// cones it is not the surface's normal. So polygons are judged by two references, whichever is nearer: that of
    /// frusta, and that of the finest polygons that may be had, which stands for their own limit. The finest
    /// themselves are judged by frusta alone, for nothing tells how far from their limit they are.
    pub fn match_polygons(
        &self,
        studio: &mut Studio,
        exhibit: &mut Exhibit,
        wardrobe: &mut Wardrobe,
        relief: bool,
        target: f32,
        (most, limit): (u32, usize),
    ) -> Option<Match> {
        let polygons = |subdivisions| Rival::Polygons {
            subdivisions,
            relief,
        };
        let mut put_up = |studio: &mut Studio, exhibit: &mut Exhibit, m| {
            exhibit.put_up(&mut studio.headless, wardrobe, polygons(m), limit)
        };
        let finest = (0..=most).rfind(|&m| put_up(studio, exhibit, m).is_ok())?;
        let own = Self::new(studio, exhibit, polygons(finest), self.shot);
        let mut tried: Vec<Flips> = Vec::new();
        for m in 0..=finest {
            put_up(studio, exhibit, m).ok()?;
            let picture = self.picture(studio, exhibit, polygons(m)).rgb_bytes();
            tried.push(Flips {
                to_frusta: self.flip_of(&picture),
                to_own_limit: (m < finest).then(|| own.flip_of(&picture)),
            });
            if m < finest {
                exhibit.take_down(&mut studio.headless, polygons(m));
            }
            if tried[m as usize].nearer() <= target + AS_GOOD {
                break;
            }
        }
        let flips = tried.iter().map(Flips::nearer);
        let (subdivisions, flip) = (0..).zip(flips).min_by(|a, b| a.1.total_cmp(&b.1))?;
        if subdivisions < finest {
            exhibit.take_down(&mut studio.headless, polygons(finest));
        }
        Some(Match {
            rival: polygons(subdivisions),
            subdivisions,
            flip,
            weight: put_up(studio, exhibit, subdivisions).ok()?,
            reached: flip <= target + AS_GOOD,
            tried,
        })
    }

    fn flip_of(&self, picture: &[u8]) -> f32 {
        let size = (self.shot.size.x, self.shot.size.y);
        mean_flip(size, &self.reference, picture)
    }
}

/// How wrong polygons look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flips {
    /// Mean FLIP against the finest frusta.
    pub to_frusta: f32,
    /// Mean FLIP against the finest polygons that may be had; `None` for these.
    pub to_own_limit: Option<f32>,
}

impl Flips {
    /// The smaller of both.
    pub fn nearer(&self) -> f32 {
        self.to_own_limit
            .map_or(self.to_frusta, |own| own.min(self.to_frusta))
    }
}

/// Polygons that are as good as frusta, or as good as they get.
#[derive(Clone, Debug, PartialEq)]
pub struct Match {
    /// The polygons.
    pub rival: Rival,
    /// m.
    pub subdivisions: u32,
    /// Mean FLIP, against the nearer of both references.
    pub flip: f32,
    /// What they weigh.
    pub weight: Weight,
    /// Whether they are as good, or just the best that were tried.
    pub reached: bool,
    /// The errors of each subdivision that was tried, from 0 on.
    pub tried: Vec<Flips>,
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

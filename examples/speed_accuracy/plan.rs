//! How much is measured.

use bevy::math::UVec2;
use bevy_verdure::lab::Race;

use super::scenes::Scene;

/// How much is measured.
pub struct Plan {
    /// Size of the pictures, in pixels.
    pub size: UVec2,
    /// Scenes of the table; the first is that of the settings and of the sizes.
    pub scenes: Vec<Scene>,
    /// Frames of each race.
    pub race: Race,
    /// How often polygons are subdivided at most.
    pub subdivisions: u32,
    /// Bytes that the polygons of one scene may take.
    pub limit: usize,
    /// Numbers of steps.
    pub steps: &'static [u32],
    /// Numbers of halvings.
    pub bisections: &'static [u32],
    /// Numbers of segments.
    pub segments: &'static [usize],
    /// Sizes of pictures.
    pub sizes: &'static [(u32, u32)],
    /// Milliseconds of a frame beyond which a rival gets no larger task.
    pub patience: f64,
}

impl Plan {
    /// All of it, or what two minutes of a software driver are enough for.
    pub fn new(quick: bool, size: Option<UVec2>, scenes: &[Scene]) -> Self {
        let plan = if quick { Self::quick() } else { Self::full() };
        Self {
            size: size.unwrap_or(plan.size),
            scenes: if scenes.is_empty() {
                plan.scenes
            } else {
                scenes.to_vec()
            },
            ..plan
        }
    }

    fn full() -> Self {
        Self {
            size: UVec2::new(1024, 768),
            scenes: Scene::ALL.to_vec(),
            race: Race::default(),
            subdivisions: 7,
            limit: 256 << 20,
            steps: &[4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256],
            bisections: &[0, 1, 2, 3, 4, 5, 6, 8, 10],
            segments: &[100, 1_000, 10_000, 100_000, 1_000_000],
            sizes: &[(256, 192), (512, 384), (1024, 768), (2048, 1536)],
            patience: 1_500.0,
        }
    }

    fn quick() -> Self {
        Self {
            size: UVec2::new(256, 192),
            scenes: vec![Scene::Saguaro, Scene::Aloe, Scene::Well],
            race: Race {
                rounds: 3,
                warm_up: 1,
                ..Race::default()
            },
            subdivisions: 2,
            limit: 64 << 20,
            steps: &[4, 16, 64],
            bisections: &[0, 4, 10],
            segments: &[100, 1_000, 10_000],
            sizes: &[(128, 96), (256, 192)],
            patience: 150.0,
        }
    }
}

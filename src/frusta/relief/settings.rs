//! What a game's author sets.

use bevy::prelude::*;

use crate::frusta::double::shell as double;
use crate::frusta::material::{FrustaMaterial, frusta_material};
use crate::frusta::single::shell::{ShellShape, Thickness};

/// Relief on a [`FrustaMaterial`]: bark, ribs and masonry that stand out on silhouettes, in shadows and in every
/// prepass.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// # fn bark(assets: Res<AssetServer>, mut materials: ResMut<Assets<FrustaMaterial>>) {
/// let bark = materials.add(relief_material(
///     StandardMaterial { base_color_texture: Some(assets.load("bark.png")), ..default() },
///     Relief::new(assets.load("bark_height.png"), ReliefThickness::Metres(0.02)),
/// ));
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
pub struct Relief {
    /// The relief map: heights from 0 (black, the inner frustum) to 1 (white, the outer), 8 bits a pixel, of any
    /// aspect. It repeats in both directions, u once round the limb and v along it, transformed by the material's
    /// `uv_transform` like all other maps.
    ///
    /// Grey images are taken as they are. Of colour images the red channel counts, and of 16-bit ones the upper byte,
    /// with a warning. An image that cannot be loaded or used gives an error in the log, and the plant is drawn
    /// without relief.
    pub map: Handle<Image>,
    /// How thick the shell is. Zero, negative or no number: no relief.
    pub thickness: ReliefThickness,
    /// The relief height, 0 to 1, that lies at the joints' radius: at 0 the relief stands on the surface that the plant
    /// would have without it (as in the paper), at 1 it is carved into it. Clamped; no number counts as 0.
    pub level: f32,
    /// How many steps a ray takes through the shell. More find thinner features.
    pub steps: ReliefSteps,
    /// Whether steps through air are taken one by one or leapt over.
    pub march: ReliefMarch,
    /// Halvings of the step in which a ray meets the relief, at most 16. Each halves the error of depth and texture
    /// coordinates.
    pub bisections: u32,
    /// How v is found along a ray.
    pub v: ReliefV,
    /// Steps of a march from each hit towards the main light, the first directional one: the shadow that ribs and bark
    /// cast on their own segment, which shadow maps are too coarse for. 0 for none (the default), at most 64; 8 are
    /// enough for most. Only where materials are lit forward.
    pub self_shadow: u32,
}

impl Relief {
    /// Relief by a map, in a shell of some thickness, as the defaults march it.
    pub fn new(map: Handle<Image>, thickness: ReliefThickness) -> Self {
        Self {
            map,
            thickness,
            level: 0.0,
            steps: ReliefSteps::default(),
            march: ReliefMarch::default(),
            bisections: 4,
            v: ReliefV::default(),
            self_shadow: 0,
        }
    }

    /// The same with another height at the joints' radius.
    pub fn with_level(mut self, level: f32) -> Self {
        self.level = level;
        self
    }

    /// The same with other steps.
    pub fn with_steps(mut self, steps: ReliefSteps) -> Self {
        self.steps = steps;
        self
    }

    /// The same with shadows that it casts on itself, by so many steps.
    pub fn with_self_shadow(mut self, steps: u32) -> Self {
        self.self_shadow = steps;
        self
    }

    /// The shell, or `None` if it has no thickness.
    pub fn shell(&self) -> Option<ShellShape> {
        let shape = ShellShape {
            thickness: match self.thickness {
                ReliefThickness::Metres(h) => Thickness::Metres(h),
                ReliefThickness::Relative(share) => Thickness::Relative(share),
            },
            level: self.level,
        };
        (shape.thickness.at(1.0) > 0.0).then_some(shape)
    }

    /// The same shell as [`MeshRelief`](crate::frusta::MeshRelief) has it, for polygons of the same surface.
    pub fn mesh_shell(&self) -> Option<double::ShellShape> {
        let shape = self.shell()?;
        Some(double::ShellShape {
            thickness: match shape.thickness {
                Thickness::Metres(h) => double::Thickness::Metres(f64::from(h)),
                Thickness::Relative(share) => double::Thickness::Relative(f64::from(share)),
            },
            level: f64::from(shape.level),
        })
    }
}

/// How thick the shell of a relief is at a joint. At most 8 radii of the joint, and below the joint's radius
/// at most 0.95 of it: more is taken for that.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, PartialEq)]
pub enum ReliefThickness {
    /// The same everywhere, in metres of the plant's local space.
    Metres(f32),
    /// This share of the joint's radius.
    Relative(f32),
}

/// How many steps a ray takes through the shell before its hit is refined. `docs/limits.md` charts which features are
/// missed with how many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum ReliefSteps {
    /// As many as the shell needs at its size on screen: about one for each pixel, of the screen or of the map,
    /// whichever is larger, that the ray passes over, from 3 to 64.
    #[default]
    Auto,
    /// So many, 1 to 1024.
    Fixed(u32),
}

/// How a ray gets through the air above the relief. Both look at the same steps of the same ray and find the same hit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum ReliefMarch {
    /// Looks at every step (the paper's choice, §3).
    #[default]
    Uniform,
    /// Leaps over steps that a mip level of greatest heights tells to be in air. Takes twice the memory for the map, and on
    /// a software driver more time than it saves, as `docs/speed_accuracy.md` charts.
    Leaping,
}

/// How v is found at a point of a ray. `docs/limits.md` charts by how much interpolation is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum ReliefV {
    /// By Equation 7, at every step.
    #[default]
    Exact,
    /// By linear interpolation between where the ray enters and leaves the shell (§3). Exact where a segment's planes
    /// are parallel; where they are not, relief swims as the eye moves, and segments that bend by more than 45° are
    /// marched exactly all the same.
    Interpolated,
}

/// A [`FrustaMaterial`] of a [`StandardMaterial`], or of what becomes one, with relief.
pub fn relief_material(base: impl Into<StandardMaterial>, relief: Relief) -> FrustaMaterial {
    let mut material = frusta_material(base);
    material.extension.relief = Some(relief);
    material
}

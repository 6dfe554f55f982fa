//! What strokes texels: a hand, a comb, a foot in the grass.

use core::f32::consts::FRAC_PI_2;

use bevy::prelude::*;

use super::super::facet::comb;

/// Strokes the texels of every [`TexelSurface`](super::TexelSurface) that is [`StrokedTexels`], where its entity goes: a
/// hand over fur, a foot through grass.
///
/// Height vectors within its radius are laid down in the direction in which it moves, most in its middle and not at all at
/// its rim; where it comes down on a surface, away from it. They keep their lengths. How far they lie depends on the way
/// that it went, and not on its speed; what stands still strokes nothing. It goes straight from where it was in the frame
/// before: to begin elsewhere, leave the component out for a frame. One whose [`Transform`] is no number does nothing until
/// it is one again, and then begins anew.
///
/// No facet loses its texels: height vectors that would lead through the surface or cross are laid down less. So grass that
/// is taller than the brush is wide is parted less than it might be.
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// # #[derive(Component)]
/// # struct Cat;
/// fn pet(mut commands: Commands, cats: Query<Entity, With<Cat>>) {
///     for cat in &cats {
///         commands.entity(cat).insert(StrokedTexels { recovery: 5.0 });
///     }
///     // Move it over them.
///     let hand = TexelBrush { radius: 0.12, ..default() };
///     commands.spawn((hand, Transform::from_xyz(0.0, 0.4, 0.0)));
/// }
/// ```
///
/// A system of a game's own does the same by changing [`TexelHeights`](super::TexelHeights), in `Update`, or before
/// [`VerdureSystems::Attach`](crate::VerdureSystems::Attach):
///
/// ```
/// # use bevy::prelude::*;
/// # use bevy_verdure::prelude::*;
/// use bevy_verdure::texel::facet::comb;
///
/// /// Lays grass on level ground down towards x, all of it in a few seconds.
/// fn blow(time: Res<Time>, mut lawns: Query<&mut TexelHeights>) {
///     for mut heights in &mut lawns {
///         for height in &mut heights.0 {
///             *height = comb(*height, Vec3::Y, Vec3::X, time.delta_secs());
///         }
///     }
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
#[require(Transform)]
pub struct TexelBrush {
    /// How far it reaches, in metres in world space, whatever its scale is. Where it is not finite and above 0 nothing is
    /// stroked.
    pub radius: f32,
    /// How far it lays down in one stroke what its middle goes over, as a share of all the way: 0 leaves it as it is, and 1
    /// is nearly all. What is below or above is taken for the nearest, and no number for 0.
    pub strength: f32,
}

impl Default for TexelBrush {
    fn default() -> Self {
        Self {
            radius: 0.1,
            strength: 0.9,
        }
    }
}

/// Lets every [`TexelBrush`] stroke the [`TexelSurface`](super::TexelSurface) of the same entity.
///
/// Its height vectors are then [`TexelHeights`](super::TexelHeights), put there once a brush has moved one, and written in
/// frames in which one moves. The mesh's, or those that it has already, are what they return to, and so are those that a
/// system of the game's writes later. Without the component what is combed stays so; remove `TexelHeights` as well to have
/// it as it was.
///
/// Where the mesh changes, what is combed goes along, unless it has another number of vertices. The mesh of a `SkinnedMesh`
/// is stroked where it is at rest. Without a mesh, or one that carries texels, there is nothing to stroke.
#[derive(Component, Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Component, Clone, Debug, Default, PartialEq)]
pub struct StrokedTexels {
    /// Seconds in which what lies down rises by a right angle, once no brush is within its radius; what lies less is up
    /// sooner. With `INFINITY`, the default, it stays as it is combed. What is below 0 is taken for 0, at once, and no
    /// number for `INFINITY`.
    pub recovery: f32,
}

impl Default for StrokedTexels {
    fn default() -> Self {
        Self {
            recovery: f32::INFINITY,
        }
    }
}

impl StrokedTexels {
    /// By which angle height vectors rise in so many seconds.
    pub(crate) fn rise(&self, seconds: f32) -> f32 {
        let recovery = if self.recovery.is_nan() {
            f32::INFINITY
        } else {
            self.recovery.max(0.0)
        };
        // No time of none is no number, and then nothing rises.
        (FRAC_PI_2 * seconds / recovery).max(0.0)
    }
}

/// The most of a brush's strength: with all of it, its rim would be as strong as its middle.
const MOST_STRENGTH: f32 = 0.99;

/// What [`Stroke::felt`] is where the middle of a brush goes over a place.
const FELT_MOST: f32 = 16.0 / 15.0;

/// The way of a brush in a frame, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke {
    from: Vec3,
    to: Vec3,
    radius: f32,
    /// The rate at which what is left to be laid down becomes less, as more is [felt](Self::felt).
    rate: f32,
}

impl Stroke {
    /// None of a brush that reaches nothing.
    pub(crate) fn new(brush: &TexelBrush, from: Vec3, to: Vec3) -> Option<Self> {
        // No number becomes 0.
        let strength = brush.strength.clamp(0.0, MOST_STRENGTH).max(0.0);
        let reaches = brush.radius.is_finite() && brush.radius > 0.0;
        reaches.then(|| Self {
            from,
            to,
            radius: brush.radius,
            rate: -(1.0 - strength).ln() / FELT_MOST,
        })
    }

    /// Whether the brush has moved.
    pub(crate) fn moves(&self) -> bool {
        self.from != self.to
    }

    /// Whether a place is within the radius, somewhere on the way.
    pub(crate) fn reaches(&self, place: Vec3) -> bool {
        place.distance_squared(self.nearest(place)) < self.radius * self.radius
    }

    /// Whether a place within so far from another may be within the radius, somewhere on the way.
    pub(crate) fn comes_near(&self, place: Vec3, within: f32) -> bool {
        place.distance(self.nearest(place)) <= self.radius + within
    }

    /// Where the way is nearest to a place.
    fn nearest(&self, place: Vec3) -> Vec3 {
        let way = self.to - self.from;
        let share = (place - self.from).dot(way) / way.length_squared().max(f32::MIN_POSITIVE);
        self.from + way * share.clamp(0.0, 1.0)
    }

    /// How much of the way a place feels: (1 − (distance/radius)²)² summed up along it, in radii. So a way in several pieces
    /// is felt as in one.
    fn felt(&self, place: Vec3) -> f32 {
        let way = self.to - self.from;
        let along = way.normalize_or_zero();
        let foot = (place - self.from).dot(along);
        let aside = place - self.from - along * foot;
        // What is left of it at x radii from the foot is (middle − x²)², as long as x² is less.
        let middle = 1.0 - aside.length_squared() / (self.radius * self.radius);
        let end = middle.max(0.0).sqrt();
        let sum = |from_foot: f32| {
            let x = (from_foot / self.radius).clamp(-end, end);
            x * (middle * middle - x * x * (2.0 / 3.0 * middle - 0.2 * x * x))
        };
        sum(way.length() - foot) - sum(-foot)
    }

    /// The height vector at a place of a surface, stroked. `normal` is the surface's, of length one or zero.
    pub(crate) fn comb(&self, place: Vec3, normal: Vec3, height: Vec3) -> Vec3 {
        let along = (self.to - self.from).normalize_or_zero();
        let pressed = (-along.dot(normal)).max(0.0);
        let outwards = (place - self.nearest(place)) / self.radius;
        let lean = along + outwards * pressed;
        let lean = lean - normal * lean.dot(normal);
        // Of what is left to be laid down, e to this is left then; next to 1 that would round.
        let exponent = -self.rate * self.felt(place) * lean.length();
        comb(height, normal, lean, -exponent.exp_m1())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BRUSH: TexelBrush = TexelBrush {
        radius: 0.5,
        strength: 0.9,
    };

    fn stroke(from: Vec3, to: Vec3) -> Stroke {
        Stroke::new(&BRUSH, from, to).expect("it reaches something")
    }

    /// Across level ground.
    fn comb_up(stroke: &Stroke, place: Vec3) -> Vec3 {
        stroke.comb(place, Vec3::Y, Vec3::Y)
    }

    #[test]
    fn what_is_near_leans_along_the_way_and_what_is_far_stays() {
        let over = stroke(Vec3::new(-2.0, 0.0, 0.0), Vec3::new(2.0, 0.0, 0.0));
        let mut last = f32::INFINITY;
        for z in [0.0, 0.1, 0.2, 0.3, 0.4, 0.45] {
            let combed = comb_up(&over, Vec3::Z * z);
            assert!(combed.x > 0.0 && combed.x < last, "{z} {combed}");
            assert!(combed.z.abs() < 1e-6 && combed.y > 0.0, "{z} {combed}");
            last = combed.x;
        }
        assert!(last < 0.1, "it fades to the rim: {last}");
        for place in [Vec3::Z * 0.5, Vec3::X * 2.6, Vec3::Y * 0.51] {
            assert!(!over.reaches(place));
            assert_eq!(comb_up(&over, place), Vec3::Y);
        }
        // Of the 78° to where it lies, nine tenths.
        let lies = comb(Vec3::Y, Vec3::Y, Vec3::X, 0.9);
        assert!(comb_up(&over, Vec3::ZERO).distance(lies) < 1e-4);
    }

    #[test]
    fn a_stroke_in_many_frames_is_one_in_one() {
        let (from, to) = (Vec3::new(-1.0, 0.1, 0.2), Vec3::new(0.7, 0.1, -0.1));
        for place in [
            Vec3::ZERO,
            Vec3::new(0.5, 0.0, 0.2),
            Vec3::new(0.8, 0.0, 0.0),
        ] {
            let at_once = comb_up(&stroke(from, to), place);
            let mut slowly = Vec3::Y;
            for step in 0..20u8 {
                let at = |step: u8| from.lerp(to, f32::from(step) / 20.0);
                slowly = stroke(at(step), at(step + 1)).comb(place, Vec3::Y, slowly);
            }
            assert!(at_once.distance(Vec3::Y) > 0.02, "{place}");
            assert!(
                at_once.distance(slowly) < 5e-3,
                "{place} {at_once} {slowly}"
            );
        }
    }

    #[test]
    fn what_a_brush_comes_down_on_makes_way_and_stays_so_as_it_goes() {
        let (above, below) = (Vec3::Y * 0.6, Vec3::Y * 0.1);
        let down = stroke(above, below);
        for place in [Vec3::X * 0.2, Vec3::Z * -0.2] {
            let combed = comb_up(&down, place);
            assert!(combed.dot(place) > 0.01, "{combed}");
            let after = stroke(below, above).comb(place, Vec3::Y, combed);
            assert!(after.distance(combed) < 1e-5, "{combed} {after}");
        }
    }

    #[test]
    fn brushes_that_reach_nothing_and_still_ones_stroke_nothing() {
        for radius in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let brush = TexelBrush { radius, ..BRUSH };
            assert!(Stroke::new(&brush, Vec3::ZERO, Vec3::X).is_none());
        }
        let still = stroke(Vec3::ZERO, Vec3::ZERO);
        assert!(!still.moves() && still.reaches(Vec3::X * 0.4));
        assert_eq!(comb_up(&still, Vec3::X * 0.1), Vec3::Y);
        let tiny = TexelBrush {
            radius: 1e-30,
            ..BRUSH
        };
        let tiny = Stroke::new(&tiny, Vec3::ZERO, Vec3::X).expect("it is above 0");
        assert_eq!(comb_up(&tiny, Vec3::X * 0.5), Vec3::Y);
        for strength in [-1.0, 0.0, f32::NAN] {
            let weak = TexelBrush { strength, ..BRUSH };
            let weak = Stroke::new(&weak, Vec3::NEG_X, Vec3::X).expect("it reaches something");
            assert_eq!(comb_up(&weak, Vec3::ZERO), Vec3::Y, "{strength}");
        }
    }

    #[test]
    fn recovery_is_a_right_angle_in_its_seconds() {
        let rise = |recovery, seconds| StrokedTexels { recovery }.rise(seconds);
        assert_eq!(rise(2.0, 0.5), FRAC_PI_2 / 4.0);
        assert_eq!(rise(0.0, 0.1), f32::INFINITY);
        assert_eq!(rise(-1.0, 0.1), f32::INFINITY);
        for (recovery, seconds) in [(f32::INFINITY, 1.0), (f32::NAN, 1.0), (0.0, 0.0)] {
            assert_eq!(rise(recovery, seconds), 0.0);
        }
    }
}

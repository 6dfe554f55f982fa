//! The direction and the number of slices of every facet, for one view (§4.2, §4.3).

use core::f32::consts::FRAC_PI_2;

use bevy::math::{UVec3, Vec2, Vec3, Vec4};
use bevy::reflect::{Reflect, std_traits::ReflectDefault};

use super::axis::SliceAxis;
use super::criteria::{
    cheapest, count_exponent, depth_limit, direction_cost, finer_share, lots_of_directions,
    sin_view_angle, slices_for_depth, slices_for_pixels, tan_view_angle,
};
use super::facet::{Facet, TexelFrame};
use super::thickness::Thickness;
use super::volume::ReferenceVolume;

/// What of a volume the choice depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VolumeMeasure {
    /// The largest number of slices that there is along u, v and w: powers of two.
    pub most: UVec3,
    /// Lengths of the box, in metres.
    pub lengths: Vec3,
    /// e, in metres of the box.
    pub thickness: Thickness,
}

impl VolumeMeasure {
    /// Of a volume of which there are sets of at most `most` slices, rounded down to a power of two.
    pub fn of(volume: &ReferenceVolume, most: u32) -> Self {
        Self {
            most: volume.size().min(UVec3::splat(1 << most.max(1).ilog2())),
            lengths: volume.lengths(),
            thickness: volume.thickness(),
        }
    }
}

/// Where the scene is seen from, in the space of the facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelView {
    /// The eye of a perspective view; not used if `direction` is given.
    pub eye: Vec3,
    /// The direction in which all rays of an orthographic view go, of any length.
    pub direction: Option<Vec3>,
    /// f: pixels of the screen that one unit of length covers at a distance of one, or of an orthographic view
    /// anywhere.
    pub pixels: f32,
    /// Half-spaces that are seen, as (normal, offset): a point P is in one where normal·P + offset ≥ 0. Normals are
    /// unit. A zero one holds everything.
    pub half_spaces: [Vec4; 6],
}

/// By what the direction of slices is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq, Hash)]
pub enum DirectionRule {
    /// By h·tan(a), how far aside a slice stands from the next: the paper's, for one e of all directions.
    #[default]
    StepAside,
    /// By h·tan(a)/e, the quality criterion with the e of each direction: the one that needs the fewest slices of all
    /// there are.
    Quality,
}

/// What may be seen of slices. A [`depth`](Self::depth) or [`pixels`](Self::pixels) that is no number above 0 allows nothing
/// to be seen: as many slices are drawn as there are, unless the other one is content with fewer.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct TexelQuality {
    /// By what the direction is chosen.
    pub direction: DirectionRule,
    /// d, as a share of the narrowest thickness e; one half is the most that §4.1 allows, one the limit beyond which
    /// gaps show.
    pub depth: f32,
    /// p: the distance between slices on screen, in pixels, that is close enough for any depth.
    pub pixels: f32,
    /// The least angle between the view and the slices' normal, in radians from 0 to π/2, that slices are as many for. Seen
    /// along their normal few slices show no gaps, but then places are as coarse along the view as slices are apart, and
    /// texels that overlap meet in steps. What is below or above is taken for the nearest, and no number for 0; at π/2
    /// `depth` asks for all slices there are.
    pub least_angle: f32,
}

impl Default for TexelQuality {
    fn default() -> Self {
        Self {
            direction: DirectionRule::default(),
            depth: depth_limit(1.0),
            pixels: PIXELS,
            least_angle: LEAST_ANGLE,
        }
    }
}

impl TexelQuality {
    /// Itself, with the least number above 0 that slices can be counted for in place of what is none.
    fn repaired(mut self) -> Self {
        for bound in [&mut self.depth, &mut self.pixels] {
            if bound.is_nan() || *bound < f32::EPSILON {
                *bound = f32::EPSILON;
            }
        }
        if self.least_angle.is_nan() {
            self.least_angle = 0.0;
        }
        self
    }
}

/// A little less than one, at which lit texels are like those of all slices by a mean FLIP below 0.01: a sphere of them 4.6
/// m away, filling most of 512 x 384 pixels of four samples. Nearer by, by as much as more of each texel is seen, it is
/// more.
const PIXELS: f32 = 0.95;

/// That of which the tangent is one half: slices that are next to one another along the view are at most twice as far apart
/// as those next to one another on the screen may be.
const LEAST_ANGLE: f32 = 0.463_647_6;

/// What of a facet is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Choice {
    /// Nothing: it is out of view, or carries no texels.
    #[default]
    LeftOut,
    /// Slices across one axis.
    Slices {
        /// The direction.
        axis: SliceAxis,
        /// The number of slices a texel is two to the power of this.
        exponent: u8,
        /// Whether the view goes to where the axis' coordinate grows, so that the first slices are the nearest.
        along: bool,
    },
}

/// What is drawn across one axis of a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnSlices {
    /// How many slices a texel has, a power of two.
    pub count: u32,
    /// How far, 0 to 1, the two of a pair have moved apart from the middle of the slice of half as many that they lie in
    /// ([`slice_position`](super::facet::slice_position)); 1 if they do not take the place of that one.
    pub apart: f32,
    /// Which pixels of the view are theirs, if each has a lot from 0 to 1: from the first to the second.
    pub lots: [f32; 2],
}

/// Slices across one axis of a facet, as a view shows them that fades what it shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AxisSlices {
    /// The direction.
    pub axis: SliceAxis,
    /// The number of slices a texel is two to the power of this.
    pub exponent: u32,
    /// Whether the view goes to where the axis' coordinate grows, so that the first slices are the nearest.
    pub along: bool,
    /// How far, 0 to 1, twice as many slices have moved apart from the places of these: at 0 these are drawn, else those.
    pub finer: f32,
    /// Which pixels of the view are those of this axis, if each has a lot from 0 to 1: from the first to the second.
    pub lots: [f32; 2],
    /// How far, h·tan(a), slices of that number stand aside of one another as they are seen; a length in the space of the
    /// facet.
    pub step_aside: f32,
    /// e of this direction, in the same space.
    pub thickness: f32,
    /// How much of a texel a pixel of the view covers at most, along the columns and along the rows of a slice.
    pub footprint: Vec2,
}

/// Chooses for one facet: the direction at its centre, for deformations are taken to be small, and the number of slices by
/// the corner of the prism that is seen at the largest angle from them. (The paper takes the angle at the centre too, which
/// serves facets that are small on screen; right below the eye it would show a large one by a single slice.)
///
/// Facets that fail their [`check`](Facet::check) are left out.
pub fn choose(
    facet: &Facet,
    measure: &VolumeMeasure,
    view: &TexelView,
    quality: &TexelQuality,
) -> Choice {
    if facet.check().is_err() {
        return Choice::LeftOut;
    }
    let Some(seen) = FacetInView::new(facet, measure, view, quality) else {
        return Choice::LeftOut;
    };
    let axis = SliceAxis::ALL[cheapest(seen.cost)];
    let slices = seen.count(facet, axis, measure, view, &quality.repaired());
    Choice::Slices {
        axis,
        exponent: slices.exponent as u8,
        along: slices.along,
    }
}

/// Chooses for one facet that passes its [`check`](Facet::check), as [`choose`] does, with what fades in: along with the
/// best direction the second best, where it is nearly as good. None if it is out of view.
pub fn choose_fading(
    facet: &Facet,
    measure: &VolumeMeasure,
    view: &TexelView,
    quality: &TexelQuality,
) -> [Option<AxisSlices>; 3] {
    let Some(seen) = FacetInView::new(facet, measure, view, quality) else {
        return [None; 3];
    };
    let lots = lots_of_directions(seen.cost);
    let quality = quality.repaired();
    SliceAxis::ALL.map(|axis| {
        let lots = lots[axis.index()];
        (lots[0] < lots[1]).then(|| AxisSlices {
            lots,
            ..seen.count(facet, axis, measure, view, &quality)
        })
    })
}

impl AxisSlices {
    /// What is drawn, if anything. Without fading, whichever direction has more of the lots has all, and counts change at
    /// once.
    pub fn drawn(&self, fades: bool) -> Option<DrawnSlices> {
        let (mut lots, mut finer) = (self.lots, self.finer);
        if !fades {
            (lots, finer) = (lots.map(f32::round), 0.0);
        }
        let count = 1u32 << self.exponent;
        let (count, apart) = if finer > 0.0 {
            (2 * count, finer)
        } else {
            (count, 1.0)
        };
        (lots[0] < lots[1]).then_some(DrawnSlices { count, apart, lots })
    }

    /// How deep inside of contours one may see of twice as many slices to the power of `doublings`; a length in the space of
    /// the facet. Beyond e there are gaps, and no inside.
    pub fn inside(&self, doublings: u32) -> f32 {
        (self.step_aside / (1u32 << doublings) as f32).min(self.thickness)
    }
}

/// A facet as a view sees it, along u, v and w.
struct FacetInView {
    /// Cosines of the angles between the view and the normals.
    c: [f32; 3],
    e: [f32; 3],
    cost: [f32; 3],
    /// The least distance of any part of it, so that none is drawn too coarsely; 1 of an orthographic view.
    z: f32,
    /// The largest.
    z_far: f32,
}

impl FacetInView {
    /// None if it is out of view.
    fn new(
        facet: &Facet,
        measure: &VolumeMeasure,
        view: &TexelView,
        quality: &TexelQuality,
    ) -> Option<Self> {
        let (centre, radius) = facet.bounds();
        if !view.may_see(centre, radius) {
            return None;
        }
        let middle = Vec3::splat(1.0 / 3.0);
        let place = facet.point(middle, 0.5);
        // From a point inside the prism every direction may be seen: all cost the same, and the last wins.
        let to_place = view.direction.unwrap_or(place - view.eye);
        let direction = to_place / to_place.length().max(LEAST_LENGTH);
        let frame = TexelFrame::new(facet, middle, 0.5);
        let (mut c, mut e, mut cost) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for axis in SliceAxis::ALL {
            let i = axis.index();
            let (normal, length) = frame.normal_and_length(axis);
            c[i] = normal.dot(direction);
            e[i] = measure.thickness.along(axis) * frame.least_stretch(axis, measure.lengths);
            let h = length / measure.most[i] as f32;
            let step = match quality.direction {
                DirectionRule::StepAside => h,
                DirectionRule::Quality => h / e[i],
            };
            cost[i] = direction_cost(c[i], step);
        }
        let (z, z_far) = match view.direction {
            Some(_) => (1.0, 1.0),
            None => {
                let distance = view.eye.distance(centre);
                (distance - radius, distance + radius)
            }
        };
        Some(Self {
            c,
            e,
            cost,
            z,
            z_far,
        })
    }

    /// Slices across one axis, however good a direction it is; they get all lots.
    fn count(
        &self,
        facet: &Facet,
        axis: SliceAxis,
        measure: &VolumeMeasure,
        view: &TexelView,
        quality: &TexelQuality,
    ) -> AxisSlices {
        let i = axis.index();
        let most = measure.most[i];
        let Needed {
            for_inside,
            for_depth,
            for_pixels,
            slope,
        } = slices_needed(facet, axis, measure, view, quality, self.c[i], self.z);
        // An eye in reach of the prism sees slices however far apart.
        let slices = if self.z > 0.0 {
            for_depth.min(for_pixels)
        } else {
            for_depth
        };
        let exponent = count_exponent(slices, most);
        let d = quality.depth * self.e[i];
        AxisSlices {
            axis,
            exponent,
            along: self.c[i] > 0.0,
            finer: finer_share(slices, exponent, most),
            lots: [0.0, 1.0],
            step_aside: for_inside / (1u32 << exponent) as f32 * d,
            thickness: self.e[i],
            footprint: slope * (self.z_far / view.pixels),
        }
    }
}

impl TexelView {
    /// Whether anything of a sphere is in all half-spaces.
    pub fn may_see(&self, centre: Vec3, radius: f32) -> bool {
        let inside = |plane: &Vec4| plane.truncate().dot(centre) + plane.w >= -radius;
        self.half_spaces
            .iter()
            .all(|plane| *plane == Vec4::ZERO || inside(plane))
    }
}

/// What the corners of a prism ask for.
#[derive(Clone, Copy, Debug, Default)]
struct Needed {
    /// Slices for depth, as they are seen.
    for_inside: f32,
    /// Slices for depth, seen at the least angle at least.
    for_depth: f32,
    /// Slices for pixels, the same.
    for_pixels: f32,
    /// How much of a texel, along columns and rows, a slice shows at most for a unit of length across the view.
    slope: Vec2,
}

/// What the corners of the prism ask for. Each has a frame of its own where height
/// vectors differ. `c` is the cosine at the centre; `z` is the least distance.
fn slices_needed(
    facet: &Facet,
    axis: SliceAxis,
    measure: &VolumeMeasure,
    view: &TexelView,
    quality: &TexelQuality,
    c: f32,
    z: f32,
) -> Needed {
    let mut needed = Needed::default();
    let (least_sin, least_cos) = quality.least_angle.clamp(0.0, FRAC_PI_2).sin_cos();
    // The f32 next to π/2 is beyond it, where the tangent is negative.
    let least_cos = least_cos.max(f32::EPSILON);
    for w in [0.0, 1.0] {
        for (b, corner) in [Vec3::X, Vec3::Y, Vec3::Z]
            .into_iter()
            .zip(facet.corners(w))
        {
            let frame = TexelFrame::new(facet, b, w);
            let (normal, l) = frame.normal_and_length(axis);
            let to_corner = view.direction.unwrap_or(corner - view.eye);
            // Seen from the other side than the centre, slices are seen along themselves in between.
            let side = if c < 0.0 { -1.0 } else { 1.0 };
            let cosine = normal.dot(to_corner) * side / to_corner.length().max(LEAST_LENGTH);
            let cosine = cosine.max(0.0);
            let e = measure.thickness.along(axis) * frame.least_stretch(axis, measure.lengths);
            let d = quality.depth * e;
            let tan_a = tan_view_angle(cosine);
            needed.for_inside = needed.for_inside.max(slices_for_depth(l, tan_a, d));
            let tan_a = tan_a.max(least_sin / least_cos);
            needed.for_depth = needed.for_depth.max(slices_for_depth(l, tan_a, d));
            let [across, up] = axis.in_plane().map(|axis| frame.edges[axis.index()]);
            let gradients = Vec2::new(up.length(), across.length()) / across.cross(up).length();
            needed.slope = needed.slope.max(gradients / cosine);
            let sin_a = sin_view_angle(cosine).max(least_sin);
            let for_pixels = slices_for_pixels(l, sin_a, z, view.pixels, quality.pixels);
            needed.for_pixels = needed.for_pixels.max(for_pixels);
        }
    }
    needed
}

/// In place of the length of a vector that has none.
const LEAST_LENGTH: f32 = 1e-30;

#[cfg(test)]
mod tests;

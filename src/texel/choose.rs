//! The direction and the number of slices of every facet, for one view (§4.2, §4.3).

use bevy::math::{UVec3, Vec3, Vec4};

use super::axis::SliceAxis;
use super::criteria::{
    choose_direction, count_exponent, depth_limit, sin_view_angle, slices_for_depth,
    slices_for_pixels, tan_view_angle,
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
    /// Of a volume of which there are sets of at most `most` slices.
    pub fn of(volume: &ReferenceVolume, most: u32) -> Self {
        Self {
            most: volume.size().min(UVec3::splat(most.max(1))),
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DirectionRule {
    /// By h·tan(a), how far aside a slice stands from the next: the paper's, for one e of all directions.
    #[default]
    StepAside,
    /// By h·tan(a)/e, the quality criterion with the e of each direction: the one that needs the fewest slices of all
    /// there are.
    Quality,
}

/// What may be seen of slices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TexelQuality {
    /// By what the direction is chosen.
    pub direction: DirectionRule,
    /// d, as a share of the narrowest thickness e; one half is the most that §4.1 allows, one the limit beyond which
    /// gaps show.
    pub depth: f32,
    /// p: the distance between slices on screen, in pixels, that is close enough for any depth.
    pub pixels: f32,
}

impl Default for TexelQuality {
    fn default() -> Self {
        Self {
            direction: DirectionRule::default(),
            depth: depth_limit(1.0),
            pixels: 1.0,
        }
    }
}

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

/// Chooses for one facet, at its centre: deformations are taken to be small.
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
    let (centre, radius) = facet.bounds();
    let inside = |plane: &Vec4| plane.truncate().dot(centre) + plane.w >= -radius;
    if !view
        .half_spaces
        .iter()
        .all(|plane| *plane == Vec4::ZERO || inside(plane))
    {
        return Choice::LeftOut;
    }
    let middle = Vec3::splat(1.0 / 3.0);
    let place = facet.point(middle, 0.5);
    // From a point inside the prism every direction may be seen: up the height vectors as much as along the surface.
    let to_place = view.direction.unwrap_or(place - view.eye);
    let Some(direction) = to_place.try_normalize() else {
        return Choice::Slices {
            axis: SliceAxis::W,
            exponent: measure.most.z.ilog2() as u8,
            along: false,
        };
    };
    let frame = TexelFrame::new(facet, middle, 0.5);
    let mut c = [0.0; 3];
    let mut l = [0.0; 3];
    let mut h = [0.0; 3];
    let mut e = [0.0; 3];
    let mut step = [0.0; 3];
    for axis in SliceAxis::ALL {
        let i = axis.index();
        let (normal, length) = frame.normal_and_length(axis);
        c[i] = normal.dot(direction);
        l[i] = length;
        h[i] = length / measure.most[i] as f32;
        e[i] = measure.thickness.along(axis) * frame.least_stretch(axis, measure.lengths);
        step[i] = match quality.direction {
            DirectionRule::StepAside => h[i],
            DirectionRule::Quality => h[i] / e[i],
        };
    }
    let i = choose_direction(c, step);
    let axis = SliceAxis::ALL[i];
    let for_depth = slices_for_depth(l[i], tan_view_angle(c[i]), quality.depth * e[i]);
    // The nearest that the facet can be, so that no part of it is drawn too coarsely. All of an orthographic view is
    // at one.
    let z = match view.direction {
        Some(_) => 1.0,
        None => view.eye.distance(centre) - radius,
    };
    let for_pixels = if z > 0.0 {
        slices_for_pixels(l[i], sin_view_angle(c[i]), z, view.pixels, quality.pixels)
    } else {
        f32::INFINITY
    };
    Choice::Slices {
        axis,
        exponent: count_exponent(for_depth.min(for_pixels), measure.most[i]) as u8,
        along: c[i] > 0.0,
    }
}

/// Chooses for many facets, without allocating.
///
/// # Panics
/// If there are not as many choices as facets.
pub fn choose_all(
    facets: &[Facet],
    measure: &VolumeMeasure,
    view: &TexelView,
    quality: &TexelQuality,
    choices: &mut [Choice],
) {
    assert_eq!(facets.len(), choices.len());
    for (facet, slot) in facets.iter().zip(choices) {
        *slot = choose(facet, measure, view, quality);
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::Vec2;

    use super::super::criteria::gap_ratio;
    use super::*;

    /// A metre of surface with one texel of 64³, a quarter high.
    fn facet() -> Facet {
        Facet {
            positions: [Vec3::ZERO, Vec3::X, Vec3::Y],
            heights: [Vec3::Z * 0.25; 3],
            uvs: [Vec2::ZERO, Vec2::X, Vec2::Y],
        }
    }

    fn measure() -> VolumeMeasure {
        VolumeMeasure {
            most: UVec3::splat(64),
            lengths: Vec3::new(1.0, 1.0, 0.25),
            thickness: Thickness {
                narrowest: Vec3::new(0.02, 0.02, 0.05),
            },
        }
    }

    fn looking(direction: Vec3, distance: f32) -> TexelView {
        let place = Vec3::new(1.0 / 3.0, 1.0 / 3.0, 0.125);
        TexelView {
            eye: place - direction.normalize() * distance,
            direction: None,
            pixels: 900.0,
            half_spaces: [Vec4::ZERO; 6],
        }
    }

    fn chosen(direction: Vec3, distance: f32) -> (SliceAxis, u32) {
        let view = looking(direction, distance);
        match choose(&facet(), &measure(), &view, &TexelQuality::default()) {
            Choice::Slices { axis, exponent, .. } => (axis, 1 << exponent),
            Choice::LeftOut => panic!("it is in view"),
        }
    }

    #[test]
    fn from_above_one_slice_will_do_and_aslant_there_are_more() {
        assert_eq!(chosen(Vec3::NEG_Z, 3.0), (SliceAxis::W, 1));
        let mut last = 0;
        for degrees in [10.0, 30.0, 50.0, 63.0f32] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let (axis, count) = chosen(Vec3::new(sin, 0.0, -cos), 3.0);
            assert_eq!(axis, SliceAxis::W);
            assert!(count >= last, "{degrees}");
            last = count;
        }
        assert!(last > 8);
    }

    #[test]
    fn grazing_views_take_upright_slices_across_the_view() {
        // Upright slices are four times further apart, so that they win where tan > 4/tan, from tan = 2 on.
        assert_eq!(chosen(Vec3::new(1.0, 0.05, -0.1), 3.0).0, SliceAxis::U);
        assert_eq!(chosen(Vec3::new(0.05, -1.0, -0.1), 3.0).0, SliceAxis::V);
        assert_eq!(chosen(Vec3::new(1.0, 0.0, -0.49), 3.0).0, SliceAxis::U);
        assert_eq!(chosen(Vec3::new(1.0, 0.0, -0.51), 3.0).0, SliceAxis::W);
    }

    #[test]
    fn by_quality_a_thick_direction_wins_over_a_fine_one() {
        // Upright slices are four times further apart, but contours are ten times as thick there.
        let mut measure = measure();
        measure.thickness.narrowest = Vec3::new(0.2, 0.2, 0.02);
        let view = looking(Vec3::new(1.0, 0.0, -1.0), 1.5);
        let chosen = |direction| {
            let quality = TexelQuality {
                direction,
                ..TexelQuality::default()
            };
            choose(&facet(), &measure, &view, &quality)
        };
        let axis_and_exponent = |choice| match choice {
            Choice::Slices { axis, exponent, .. } => (axis, exponent),
            Choice::LeftOut => panic!("it is in view"),
        };
        // N ≥ L·tan(45°)/(e/2): 0.25/0.01 and 1/0.1.
        assert_eq!(
            axis_and_exponent(chosen(DirectionRule::StepAside)),
            (SliceAxis::W, 5)
        );
        assert_eq!(
            axis_and_exponent(chosen(DirectionRule::Quality)),
            (SliceAxis::U, 4)
        );
    }

    #[test]
    fn counts_fall_with_distance_to_one() {
        let direction = Vec3::new(1.0, 0.2, -1.0);
        let counts: Vec<_> = (0..14).map(|i| chosen(direction, 2f32.powi(i)).1).collect();
        assert!(counts.is_sorted_by(|near, far| near >= far), "{counts:?}");
        assert!(counts[0] > 8 && counts[13] == 1, "{counts:?}");
    }

    #[test]
    fn near_counts_are_dense_enough_that_no_gap_can_show() {
        for i in 0..500 {
            let turn = i as f32 * 2.4;
            let z = -(i as f32 + 0.5) / 500.0;
            let r = (1.0 - z * z).sqrt();
            let direction = Vec3::new(r * turn.cos(), r * turn.sin(), z);
            let (axis, count) = chosen(direction, 1.5);
            let (c, l) = (
                [direction.x, direction.y, direction.z][axis.index()],
                [1.0, 1.0, 0.25][axis.index()],
            );
            let ratio = gap_ratio(
                l / count as f32,
                tan_view_angle(c),
                measure().thickness.along(axis),
            );
            // Or all slices are drawn that there are, or they are closer than a pixel.
            let pixels = l / count as f32 * sin_view_angle(c) * 900.0 / (1.5 - 1.0);
            assert!(
                ratio <= 0.5001 || count == 64 || pixels <= 1.0,
                "{direction}: {ratio}"
            );
        }
    }

    #[test]
    fn what_is_out_of_view_or_broken_is_left_out() {
        let mut view = looking(Vec3::NEG_Z, 3.0);
        let choice = |facet: &Facet, view: &TexelView| {
            choose(facet, &measure(), view, &TexelQuality::default())
        };
        view.half_spaces[2] = Vec4::new(1.0, 0.0, 0.0, -0.9);
        assert_ne!(
            choice(&facet(), &view),
            Choice::LeftOut,
            "its corner reaches in"
        );
        view.half_spaces[2].w = -3.0;
        assert_eq!(choice(&facet(), &view), Choice::LeftOut);
        let broken = Facet {
            uvs: [Vec2::ONE; 3],
            ..facet()
        };
        assert_eq!(choice(&broken, &looking(Vec3::NEG_Z, 3.0)), Choice::LeftOut);
    }

    #[test]
    fn an_eye_within_the_texel_gets_what_the_depth_asks_for() {
        // tan(a) = 1.044/0.5, so that L·tan(a)/d = 0.25 · 2.088/0.025 = 20.9.
        assert_eq!(chosen(Vec3::new(1.0, 0.3, -0.5), 1e-3), (SliceAxis::W, 32));
        let view = TexelView {
            eye: facet().point(Vec3::splat(1.0 / 3.0), 0.5),
            ..looking(Vec3::X, 1.0)
        };
        let choice = choose(&facet(), &measure(), &view, &TexelQuality::default());
        assert!(
            matches!(choice, Choice::Slices { exponent: 6, .. }),
            "{choice:?}"
        );
    }

    #[test]
    fn an_orthographic_view_is_alike_at_any_distance() {
        let along = |eye: Vec3| TexelView {
            eye,
            direction: Some(Vec3::new(1.0, 0.0, -1.0)),
            pixels: 40.0,
            half_spaces: [Vec4::ZERO; 6],
        };
        let mut choices = [Choice::LeftOut; 2];
        for (eye, slot) in [Vec3::ZERO, Vec3::splat(1e4)].into_iter().zip(&mut choices) {
            choose_all(
                &[facet()],
                &measure(),
                &along(eye),
                &TexelQuality::default(),
                std::slice::from_mut(slot),
            );
        }
        assert_eq!(choices[0], choices[1]);
        // 0.25 m · sin 45° · 40 pixels a metre is 7.07 pixels: as many slices, rounded up.
        assert_eq!(
            choices[0],
            Choice::Slices {
                axis: SliceAxis::W,
                exponent: 3,
                along: false
            }
        );
    }
}

//! e: the narrowest thickness of the contours in the slices of each direction (§4.1, Figure 7).
//!
//! The paper names e and does not say how to find it. Any round contour has chords of length zero where it ends, so
//! the shortest chord says nothing; what counts is the narrowest *feature*. A contour S has a feature narrower than D
//! when the discs of diameter D that fit into S leave some of it far away (the morphological opening of S by the
//! disc, after T. Hildebrand and P. Rüegsegger, *A new method for the model-independent assessment of thickness in
//! three-dimensional images*, 1997). With Q the centres of such discs, which are the points at least D/2 deep,
//!
//! > no feature is narrower than D  ⇔  every point of S is within D of Q.
//!
//! A twig thinner than D has no centre near. The corner of angle θ of a wide contour is D/2 / sin(θ/2) from one, so
//! that corners sharper than 60° count as the thin features that they are, and blunter ones do not.
//!
//! One in [`NARROW_SHARE`] pixels of the contours may be further, so that tips of round shapes and specks do not count.
//!
//! Slices are judged along u and v with what lies beyond the border: the next copy of a tiling volume, nothing of an
//! isolated one. Below w = 0 the surface stops sight, so that a contour goes on there.

mod distance;

use std::sync::atomic::{AtomicUsize, Ordering};

use bevy::math::Vec3;
use serde::{Deserialize, Serialize};

use super::axis::SliceAxis;
use super::parallel;
use super::progress::{BuildStep, Progress};
use super::topology::Topology;
use super::volume::ReferenceVolume;
use distance::Plane;

/// The narrowest thickness of contours, in metres of the volume's box, in the slices along u, v and w.
///
/// It is rounded down: by as much as a pixel for features an even number of pixels wide, and to the next of
/// the widths that are tried. Nothing wider than [`MOST_PIXELS`] pixels is told apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Thickness {
    /// e along u, v and w.
    pub narrowest: Vec3,
}

impl Thickness {
    /// Not measured yet.
    pub(super) const NONE: Self = Self {
        narrowest: Vec3::ZERO,
    };

    /// e of one direction.
    pub fn along(&self, axis: SliceAxis) -> f32 {
        self.narrowest[axis.index()]
    }
}

/// The widest feature that is measured, in pixels of the smaller side. Colours from half as deep inside, which an e
/// larger than this would allow by §4.1, have no more to do with the surface, however thick the contour.
pub const MOST_PIXELS: u32 = 8;

/// The widths that are tried, in pixels. The first always passes.
const WIDTHS: [u32; 7] = [1, 2, 3, 4, 5, 6, MOST_PIXELS];

/// One in so many pixels of the contours may belong to features that are narrower than e, and do not count: any round
/// shape has a small tip in its topmost slice, and the stalk of a pear should not cost the pear its slices.
pub const NARROW_SHARE: usize = 50;

/// Pixels beyond the border that are looked at: as far as Q may be, and as deep as it must be there.
const MARGIN: u32 = MOST_PIXELS + MOST_PIXELS / 2;

/// Measures a volume.
pub(super) fn measure(volume: &ReferenceVolume, progress: Progress) -> Thickness {
    // A quarter of the memory of the colours, which slices along u and v read across.
    let opaque: Vec<bool> = volume.colors().iter().map(|color| color[3] != 0).collect();
    let mut narrowest = Vec3::ZERO;
    for axis in SliceAxis::ALL {
        narrowest[axis.index()] = measure_axis(volume, &opaque, axis);
        progress(BuildStep::Measuring, (axis.index() + 1) as f32 / 3.0);
    }
    Thickness { narrowest }
}

fn measure_axis(volume: &ReferenceVolume, opaque: &[bool], axis: SliceAxis) -> f32 {
    let count = volume.size()[axis.index()] as usize;
    let planes = parallel::map(count, |slice| {
        let plane = plane(volume, opaque, axis, slice as u32);
        let depth = plane.depth_squared();
        let contour = plane.contour(&depth);
        (plane, depth, contour)
    });
    let contours = planes.iter().map(|(_, _, contour)| contour.len());
    let most_far = contours.sum::<usize>() / NARROW_SHARE;
    let spacing = planes[0].0.spacing;
    let pixel = spacing[0].min(spacing[1]);
    let mut width = WIDTHS[0];
    for &next in &WIDTHS[1..] {
        let diameter = next as f32 * pixel;
        let far = AtomicUsize::new(0);
        parallel::map(count, |slice| {
            let (plane, depth, contour) = &planes[slice];
            // Once there are too many it makes no difference how many more.
            if far.load(Ordering::Relaxed) <= most_far {
                far.fetch_add(
                    plane.far_from_deep(depth, contour, diameter),
                    Ordering::Relaxed,
                );
            }
        });
        if far.into_inner() > most_far {
            break;
        }
        width = next;
    }
    width as f32 * pixel
}

/// One slice with its surroundings.
fn plane(volume: &ReferenceVolume, opaque: &[bool], axis: SliceAxis, slice: u32) -> Plane {
    let size = volume.size();
    let in_plane = axis.in_plane();
    let sides = in_plane.map(|axis| size[axis.index()]);
    let spacing = in_plane.map(|axis| volume.slice_distance(axis, size[axis.index()]));
    let margins = in_plane.map(|axis| match (axis, volume.topology()) {
        // The deepest centre of a disc lies half of its diameter below.
        (SliceAxis::W, _) => [MOST_PIXELS / 2 + 1, 1],
        (_, Topology::Tiling) => [MARGIN, MARGIN],
        (_, Topology::Isolated) => [1, 1],
    });
    let wraps = in_plane.map(|axis| axis != SliceAxis::W && volume.topology() == Topology::Tiling);
    // Place in the volume of a place in the plane; none beyond a border where nothing is.
    let place = |i: usize, at: u32| {
        let at = i64::from(at) - i64::from(margins[i][0]);
        let side = i64::from(sides[i]);
        if wraps[i] {
            Some(at.rem_euclid(side) as u32)
        } else {
            (0..side).contains(&at).then_some(at as u32)
        }
    };
    let width = sides[0] + margins[0][0] + margins[0][1];
    let height = sides[1] + margins[1][0] + margins[1][1];
    let mut solid = Vec::with_capacity((width * height) as usize);
    let mut voxel = [0; 3];
    voxel[axis.index()] = slice;
    for row in 0..height {
        for column in 0..width {
            solid.push(match (place(0, column), place(1, row)) {
                (Some(a), Some(b)) => {
                    voxel[in_plane[0].index()] = a;
                    voxel[in_plane[1].index()] = b;
                    opaque[volume.index(voxel[0], voxel[1], voxel[2])]
                }
                // Below w = 0 is the surface.
                _ => in_plane[1] == SliceAxis::W && row < margins[1][0],
            });
        }
    }
    let own = [0, 1].map(|i| margins[i][0] as usize..(margins[i][0] + sides[i]) as usize);
    Plane {
        size: [width as usize, height as usize],
        own,
        spacing,
        solid,
    }
}

#[cfg(test)]
mod tests {
    use bevy::math::UVec3;

    use super::super::progress::silent;
    use super::super::volume::VolumeParts;
    use super::*;

    /// e in voxels along w of a volume whose every layer is the same picture; voxels are cubes.
    fn narrowest(side: u32, topology: Topology, solid: impl Fn(f32, f32) -> bool) -> f32 {
        let size = UVec3::new(side, side, 2);
        let mut colors = Vec::new();
        for _ in 0..2 {
            for y in 0..side {
                for x in 0..side {
                    let opaque = solid(x as f32 + 0.5, y as f32 + 0.5);
                    colors.push([255, 255, 255, if opaque { 255 } else { 0 }]);
                }
            }
        }
        let parts = VolumeParts {
            size,
            lengths: size.as_vec3(),
            topology,
            normals: vec![[128, 128, 255, 255]; colors.len()],
            colors,
        };
        let volume = ReferenceVolume::new(parts, &silent).unwrap();
        volume.thickness().along(SliceAxis::W)
    }

    #[test]
    fn a_bar_is_as_thick_as_it_is_wide() {
        // Odd widths are exact where they are tried; even ones lose up to a pixel, then round down to a width tried.
        for (width, least) in [
            (1, 1),
            (2, 1),
            (3, 3),
            (4, 3),
            (5, 5),
            (6, 5),
            (7, 6),
            (9, 8),
            (30, 8),
        ] {
            let (from, to) = (20.0, 20.0 + width as f32);
            let e = narrowest(64, Topology::Tiling, |x, _| from < x && x < to);
            assert!(e >= least as f32 && e <= width as f32, "{width}: {e}");
        }
    }

    #[test]
    fn a_disc_is_as_thick_as_its_diameter_and_a_square_as_its_side() {
        for diameter in [5.0, 7.0, 9.0f32] {
            // On a pixel's centre.
            let centre = 32.5;
            let disc = |x: f32, y: f32| (x - centre).hypot(y - centre) < diameter / 2.0;
            let e = narrowest(64, Topology::Isolated, disc);
            // A pixel at each end of the diameter, and rounding down to a width tried, by at most a fifth.
            assert!(
                e >= (diameter - 2.0) * 0.8 && e <= diameter,
                "{diameter}: {e}"
            );
            let square =
                |x: f32, y: f32| (x - centre).abs().max((y - centre).abs()) <= diameter / 2.0;
            let e = narrowest(64, Topology::Isolated, square);
            assert!(
                e >= (diameter - 2.0) * 0.8 && e <= diameter,
                "{diameter}: {e}"
            );
        }
    }

    #[test]
    fn the_thin_twig_of_a_thick_shape_counts() {
        let e = narrowest(64, Topology::Isolated, |x, y| {
            (x - 20.0).hypot(y - 32.0) < 12.0
                || ((y - 32.5).abs() < 1.0 && (20.0..58.0).contains(&x))
        });
        assert_eq!(e, 1.0);
    }

    #[test]
    fn a_tiling_bar_across_the_border_is_one_bar() {
        let across = |x: f32, _| !(3.0..=58.0).contains(&x);
        // 3 pixels on one side and 6 on the other.
        let tiling = narrowest(64, Topology::Tiling, across);
        assert!(tiling == 8.0, "{tiling}");
    }

    #[test]
    fn the_tips_of_a_ball_do_not_count() {
        let ball = |radius: f32| {
            let size = UVec3::splat(64);
            let within = |i: usize| {
                let at = UVec3::new(i as u32 % 64, i as u32 / 64 % 64, i as u32 / 4096);
                (at.as_vec3() + 0.5).distance(Vec3::splat(32.0)) < radius
            };
            let color = |i| [9, 9, 9, if within(i) { 255 } else { 0 }];
            let parts = VolumeParts {
                size,
                lengths: size.as_vec3(),
                topology: Topology::Isolated,
                colors: (0..64 * 64 * 64).map(color).collect(),
                normals: vec![[128, 128, 255, 255]; 64 * 64 * 64],
            };
            ReferenceVolume::new(parts, &silent).unwrap().thickness()
        };
        // Discs of the outermost slices, h = ½ below the pole, are 2·√(24·h − h²) = 6.9 wide, and have 2·π·6.9 of
        // π²·12² pixels of contours, one in 33. Tips of a ball twice as large have one in 4·33.
        let large = ball(24.0);
        for axis in SliceAxis::ALL {
            assert!((4.0..=6.9).contains(&ball(12.0).along(axis)));
            assert_eq!(large.along(axis), MOST_PIXELS as f32);
        }
    }

    #[test]
    fn the_ground_goes_on_below() {
        // One layer of ground on the surface: upright slices see a band one voxel high, which the surface below closes.
        let size = UVec3::new(16, 16, 4);
        let layer = 16 * 16;
        let color = |i| [9, 9, 9, if i < layer { 255 } else { 0 }];
        let parts = VolumeParts {
            size,
            lengths: size.as_vec3(),
            topology: Topology::Tiling,
            colors: (0..4 * layer).map(color).collect(),
            normals: vec![[128, 128, 255, 255]; 4 * layer],
        };
        let thickness = ReferenceVolume::new(parts, &silent).unwrap().thickness();
        assert_eq!(thickness.narrowest, Vec3::splat(MOST_PIXELS as f32));
    }
}

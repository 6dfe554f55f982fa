//! Polygons of the surface that the frusta ray cast, with or without relief: for collision, for export, and as the
//! rival that ray casting is measured against.
//!
//! A segment is a grid of 8 quads around and 1 along, 16 triangles; each subdivision doubles both, so that n
//! segments have 16·n·4^m. A vertex stands at (u, v) of the parametrization (§2.3), on the generator of the cone
//! of its own relief height, between the planes of both ends.
//!
//! * Along a limb, segments share the ring of vertices on the plane that divides them: there is nothing to crack. A
//!   round join is a strip of the joint's sphere, swung from the end of one cone to the start of the next.
//! * The ring at a mitre stands where the first segment has it. The second's cone of the same height and its u differ
//!   there by little (see [`shell`](super::double::shell)), and not at all without taper.
//! * u = 0 and u = 1 are two vertices at one place; so are the points of the poles, one a sector.
//! * Round ends are closed by rings towards a pole, flat ends by a fan. A segment without cone is a sphere. These, and
//!   the strips of round joins, are counted apart, as [`MeshParts::extra_triangles`].
//! * A branch starts open inside its parent, unless [`MeshSettings::close_branches`] asks for solids.
//! * Normals are those of the polygons round a vertex, weighted by angle, so that they follow the relief and run on
//!   across cuts; only a flat end keeps its edge.
//!
//! Triangles wind counterclockwise seen from outside. At the inside of a round join both cones, and the strip between
//! them, lie inside each other; everything else that is closed is also free of overlaps between neighbours.

mod limb;
mod normals;
mod sheet;
#[cfg(test)]
mod tests;

use bevy::math::DVec3;
use thiserror::Error;

use super::component::{Ends, Join};
use super::double::cone::{EndKind, Frustum};
use super::double::join::{JoinKind, Link, NONE, PosedJoint, Skin};
use super::double::shell::{ShellShape, Thickness, align_shells, skin_shell};

use limb::Limbs;
use sheet::Sheet;

/// Relief for a mesh (§3).
#[derive(Clone, Copy)]
pub struct MeshRelief<'a> {
    /// H of u and the map's v, both of which repeat with 1. Clamped to 0..=1; NaN counts as 0.
    pub height: &'a dyn Fn(f64, f64) -> f64,
    /// The shell that H spans.
    pub shell: ShellShape,
}

/// How a skeleton is made into polygons.
#[derive(Clone, Copy)]
pub struct MeshSettings<'a> {
    /// m: each step quadruples the triangles.
    pub subdivisions: u32,
    /// How frusta meet: `Mitre` or `Round`. The paper's own joins leave gaps and stand for `Mitre`.
    pub join: Join,
    /// How free ends are closed: `Round` or `Flat`.
    pub ends: Ends,
    /// Relief on the surface; `None` leaves it smooth.
    pub relief: Option<MeshRelief<'a>>,
    /// Has u in line all round each cut, not at u = 0 alone; see [`align_shells`].
    pub continuous_u: bool,
    /// Closes the starts of branches, which their parents hide.
    pub close_branches: bool,
}

impl Default for MeshSettings<'_> {
    fn default() -> Self {
        Self {
            subdivisions: 0,
            join: Join::Mitre,
            ends: Ends::Round,
            relief: None,
            continuous_u: false,
            close_branches: false,
        }
    }
}

/// A mesh in plain arrays, one entry a vertex but for `indices`. Positions are in the plant's local space, in metres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshParts {
    /// Where the vertices are.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals.
    pub normals: Vec<[f32; 3]>,
    /// u once round the circumference, and the map's v.
    pub uvs: Vec<[f32; 2]>,
    /// Three a triangle, counterclockwise seen from outside.
    pub indices: Vec<u32>,
    /// The joint whose segment a vertex moves with.
    pub segments: Vec<u32>,
    /// Where two segments share a vertex the joint of the other one, else the same: a skin that weighs both by half
    /// keeps a cut half way between them.
    pub neighbours: Vec<u32>,
    /// How many of the triangles are not of segments' grids: caps, strips of round joins, and spheres.
    pub extra_triangles: usize,
}

/// Why there is no mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum MeshError {
    /// Indices have 32 bits.
    #[error(
        "{segments} segments at {subdivisions} subdivisions have more vertices than 32-bit indices reach: use fewer \
         subdivisions"
    )]
    TooLarge {
        /// How many segments the skeleton has.
        segments: usize,
        /// The setting.
        subdivisions: u32,
    },
    /// A vertex names the joints that it moves with by 16 bits.
    #[error(
        "{segments} segments are more than the 65536 joints of a skin: divide the skeleton, or bend it as frusta"
    )]
    TooManyJoints {
        /// How many segments the skeleton has.
        segments: usize,
    },
}

/// Makes polygons of a posed skeleton.
///
/// `v_ranges` has the map's v at both ends of each joint's segment; `first` gives the direction of u = 0 of segments
/// that begin at a root, as for [`align_shells`].
///
/// # Errors
/// When there would be more vertices than 32-bit indices reach.
///
/// # Panics
/// If the slices differ in length or a link names a joint outside them.
pub fn polygons(
    links: &[Link],
    joints: &[PosedJoint],
    v_ranges: &[[f64; 2]],
    first: impl Fn(usize) -> DVec3,
    settings: &MeshSettings,
) -> Result<MeshParts, MeshError> {
    assert_eq!(links.len(), v_ranges.len());
    let segments = links.iter().filter(|link| link.parent != NONE).count();
    if !fits(segments, settings.subdivisions) {
        return Err(MeshError::TooLarge {
            segments,
            subdivisions: settings.subdivisions,
        });
    }
    let join = match settings.join {
        Join::Round => JoinKind::Round,
        _ => JoinKind::Mitre,
    };
    let skin = Skin {
        join,
        ends: match settings.ends {
            Ends::Round => EndKind::Round,
            Ends::Flat => EndKind::Flat,
        },
    };
    let shape = match settings.relief {
        Some(relief) => relief.shell,
        None => Thickness::Metres(0.0).into(),
    };
    let mut frusta = vec![Frustum::default(); links.len()];
    let mut shells = skin_shell(links, joints, skin, shape, &mut frusta);
    align_shells(links, &mut shells, settings.continuous_u, first);
    let mut sheet = Sheet::new(8 << settings.subdivisions);
    Limbs {
        links,
        shells: &shells,
        v_ranges,
        height: settings.relief.map(|relief| relief.height),
        along: 1 << settings.subdivisions,
        close_branches: settings.close_branches,
    }
    .draw(&mut sheet);
    let grids = shells.iter().filter(|shell| shell.frustum.has_cone());
    let grid_triangles = grids.count() * 16 * (1 << (2 * settings.subdivisions));
    Ok(sheet.finish(grid_triangles))
}

/// Whether the vertices of so many segments, all of them spheres or closed at both ends, have indices of 32 bits.
fn fits(segments: usize, subdivisions: u32) -> bool {
    let Some(side) = 1u64
        .checked_shl(subdivisions)
        .filter(|&side| side < 1 << 20)
    else {
        return false;
    };
    // A grid, two caps and a bridge, or a sphere: at most 1 + 2 + 2 + 4 rings a unit of `side`, and poles.
    let vertices = (8 * side + 1) * (9 * side + 6);
    vertices
        .checked_mul(segments as u64)
        .is_some_and(|vertices| vertices <= u64::from(u32::MAX))
}

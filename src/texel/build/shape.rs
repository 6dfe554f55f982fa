//! From triangles (§3.1, §3.2).

use bevy::math::{UVec3, Vec2, Vec3, Vec4};

use super::super::error::TexelError;
use super::super::progress::{BuildStep, Progress};
use super::super::topology::Topology;
use super::draft::{Draft, Mark};
use super::edges::check_closed;
use super::inside::{mark_by_flood, mark_by_parity};
use super::rasterise::rasterise;
use super::{BuildReport, Built, Paint, Spreading};

/// Triangles with paint, in a space whose third axis is up.
///
/// Lists other than `positions` and `triangles` may be empty, else they have an entry for each vertex, or for each
/// triangle in `paint_of`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Shape {
    /// Where the vertices are.
    pub positions: Vec<Vec3>,
    /// Normals at the vertices, of any length; if empty, those of the triangles, counterclockwise seen from outside.
    pub normals: Vec<Vec3>,
    /// Texture coordinates at the vertices.
    pub uvs: Vec<Vec2>,
    /// Linear colours and alpha at the vertices, which multiply the paint.
    pub colors: Vec<Vec4>,
    /// Vertices of each triangle.
    pub triangles: Vec<[u32; 3]>,
    /// Which of the paints each triangle has; if empty, the first.
    pub paint_of: Vec<u16>,
    /// The paints; if empty, white.
    pub paints: Vec<Paint>,
}

/// What of a shape is opaque.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filling {
    /// The surface, and all that it keeps from the outside. The surface is cut along all three axes, so that its
    /// contours have no gaps, and the outside is flooded. It must be closed, but may stand open on the bottom of the
    /// box, and on the sides of a tiling one.
    #[default]
    Flood,
    /// The surface, and what lies after an odd number of crossings in a column; the paper's way (appendix): the shape
    /// is cut from above only, and contours are closed where it is steep. It fails on surfaces that run along a
    /// column, and on parts thinner than two slices; [`failed_columns`](super::BuildReport::failed_columns) counts
    /// what is noticed of that.
    Parity,
    /// The surface alone, as for foliage; it may be open, and alpha cuts holes.
    None,
}

/// How a shape is made into a volume.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeSettings {
    /// Voxels along u, v and w: powers of two.
    pub size: UVec3,
    /// Lower and upper corner of the box that is sliced. `None` takes that of the shape, with a margin of a
    /// voxel along u and v if it is isolated.
    pub bounds: Option<[Vec3; 2]>,
    /// How copies meet. What reaches over the sides of a tiling volume, by up to eight of its lengths, comes in on the
    /// other side.
    pub topology: Topology,
    /// What is opaque.
    pub filling: Filling,
    /// Where colour spreads to.
    pub spreading: Spreading,
}

impl ShapeSettings {
    /// An isolated solid in a box of its own.
    pub fn new(size: UVec3) -> Self {
        Self {
            size,
            bounds: None,
            topology: Topology::Isolated,
            filling: Filling::default(),
            spreading: Spreading::default(),
        }
    }
}

/// Builds a volume from triangles.
///
/// Triangles without area are left out. What a voxel gets of several is averaged.
///
/// # Errors
/// When the shape has no triangles, lists that don't agree, indices out of range or numbers that are not finite;
/// reaches out of the box; is open and to be filled; or the volume is refused (see
/// [`ReferenceVolume`](super::super::ReferenceVolume)).
pub fn from_shape(
    shape: &Shape,
    settings: &ShapeSettings,
    progress: Progress,
) -> Result<Built, TexelError> {
    shape.check()?;
    let [min, max] = bounds(shape, settings)?;
    let mut draft = Draft::new(settings.size, max - min, settings.topology)?;
    check_in_box(shape, settings.topology, [min, max])?;
    if settings.filling != Filling::None {
        // Copies close the sides of a tiling shape, and the surface closes its bottom.
        let on_border = |axis: usize, a: Vec3, b: Vec3| {
            (a[axis] <= min[axis] && b[axis] <= min[axis])
                || (axis < 2 && a[axis] >= max[axis] && b[axis] >= max[axis])
        };
        check_closed(&shape.positions, &shape.triangles, |a, b| {
            let sides = settings.topology == Topology::Tiling;
            on_border(2, a, b) || (sides && (on_border(0, a, b) || on_border(1, a, b)))
        })?;
    }
    let mut report = BuildReport {
        zero_area_triangles: rasterise(&mut draft, shape, settings.filling, min, progress),
        ..BuildReport::default()
    };
    report.surface_voxels = draft.count(Mark::Coloured);
    match settings.filling {
        Filling::Flood => mark_by_flood(&mut draft),
        Filling::Parity => report.failed_columns = mark_by_parity(&mut draft),
        Filling::None => return draft.finish(report, progress),
    }
    progress(BuildStep::Filling, 0.5);
    draft.fill(settings.spreading, report, progress)
}

impl Shape {
    /// The paint of a triangle.
    pub(super) fn paint(&self, triangle: usize) -> Option<&Paint> {
        let paint = self.paint_of.get(triangle).copied().unwrap_or(0);
        self.paints.get(usize::from(paint))
    }

    fn check(&self) -> Result<(), TexelError> {
        if self.triangles.is_empty() {
            return Err(TexelError::NoTriangles);
        }
        let (vertices, triangles) = (self.positions.len(), self.triangles.len());
        for (what, found, expected) in [
            ("normals", self.normals.len(), vertices),
            ("texture coordinates", self.uvs.len(), vertices),
            ("vertex colours", self.colors.len(), vertices),
            ("paints of triangles", self.paint_of.len(), triangles),
        ] {
            if found != 0 && found != expected {
                return Err(TexelError::Count {
                    what,
                    found,
                    expected,
                });
            }
        }
        for (paint, kind) in self.paints.iter().enumerate() {
            for (what, is_finite) in [
                ("colour", kind.color.is_finite()),
                ("alpha_cutoff", kind.alpha_cutoff.is_finite()),
            ] {
                if !is_finite {
                    return Err(TexelError::PaintNotFinite { paint, what });
                }
            }
            if let Some(texture) = &kind.texture {
                let [found, expected] = texture.counts;
                if found != expected || expected == 0 {
                    return Err(TexelError::Texture {
                        paint,
                        found,
                        expected,
                    });
                }
            }
        }
        for triangle in 0..triangles {
            self.check_triangle(triangle)?;
        }
        Ok(())
    }

    fn check_triangle(&self, triangle: usize) -> Result<(), TexelError> {
        for vertex in self.triangles[triangle] {
            let i = vertex as usize;
            let count = self.positions.len();
            let Some(position) = self.positions.get(i) else {
                return Err(TexelError::MissingVertex {
                    triangle,
                    vertex,
                    count,
                });
            };
            let finite = [
                ("position", position.is_finite()),
                (
                    "normal",
                    self.normals.get(i).is_none_or(|normal| normal.is_finite()),
                ),
                (
                    "texture coordinate",
                    self.uvs.get(i).is_none_or(|uv| uv.is_finite()),
                ),
                (
                    "colour",
                    self.colors.get(i).is_none_or(|color| color.is_finite()),
                ),
            ];
            if let Some((what, _)) = finite.into_iter().find(|&(_, finite)| !finite) {
                return Err(TexelError::VertexNotFinite {
                    triangle,
                    vertex,
                    what,
                });
            }
        }
        let count = self.paints.len();
        let paint = self.paint_of.get(triangle).copied().unwrap_or(0);
        let Some(kind) = self.paint(triangle) else {
            return match (paint, count) {
                (0, 0) => Ok(()),
                _ => Err(TexelError::MissingPaint {
                    triangle,
                    paint,
                    count,
                }),
            };
        };
        if kind.texture.is_some() && self.uvs.is_empty() {
            return Err(TexelError::NoUvs { triangle });
        }
        Ok(())
    }

    /// The corners of all triangles.
    fn corners(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let triangles = self.triangles.iter().enumerate();
        triangles.flat_map(|(index, triangle)| {
            triangle.map(|vertex| (index, self.positions[vertex as usize]))
        })
    }
}

/// The box that is sliced.
fn bounds(shape: &Shape, settings: &ShapeSettings) -> Result<[Vec3; 2], TexelError> {
    let [min, max] = settings.bounds.unwrap_or_else(|| {
        let (mut min, mut max) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for (_, corner) in shape.corners() {
            (min, max) = (min.min(corner), max.max(corner));
        }
        if settings.topology == Topology::Isolated {
            // The shape takes all voxels but one at either side, and a little less, so that rounding keeps it there.
            let inner = (settings.size.as_vec3() - 2.0).max(Vec3::ONE);
            let mut margin = (max - min) / inner * 1.001;
            margin.z = 0.0;
            (min, max) = (min - margin, max + margin);
        }
        [min, max]
    });
    let lengths = max - min;
    if lengths.is_finite() && lengths.min_element() > 0.0 {
        Ok([min, max])
    } else {
        Err(TexelError::Box { min, max })
    }
}

/// How many boxes further a shape may reach over the sides of a tiling volume.
const MOST_COPIES: f32 = 8.0;

/// Nothing may be cut off by the box, but what goes on at the other side of a tiling volume.
fn check_in_box(
    shape: &Shape,
    topology: Topology,
    [min, max]: [Vec3; 2],
) -> Result<(), TexelError> {
    let copies = match topology {
        Topology::Isolated => 0.0,
        Topology::Tiling => MOST_COPIES,
    };
    let reach = (max - min) * Vec3::new(copies, copies, 0.0);
    let outside = |corner: Vec3| corner.cmplt(min - reach).any() || corner.cmpgt(max + reach).any();
    match shape.corners().find(|&(_, corner)| outside(corner)) {
        Some((triangle, position)) => Err(TexelError::OutsideBox {
            triangle,
            position,
            min,
            max,
        }),
        None => Ok(()),
    }
}

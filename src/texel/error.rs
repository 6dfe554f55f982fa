//! What can be wrong with a reference volume, or with what it is built from, and what to do about it.

use bevy::math::{UVec3, Vec3};
use thiserror::Error;

use super::axis::SliceAxis;
use super::volume::{MAX_SIDE, MAX_VOXELS};

/// Why there is no [`ReferenceVolume`](super::ReferenceVolume). Triangles, vertices and images are named by their
/// index, counted from 0.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum TexelError {
    /// A side of the volume is no power of two.
    #[error(
        "the volume has {side} voxels along {}, which is no power of two: take {nearest}, so that slices can be halved \
         down to one (§4.3)",
        axis.name()
    )]
    NotPowerOfTwo {
        /// Along which axis.
        axis: SliceAxis,
        /// How many voxels it has.
        side: u32,
        /// How many it may have instead.
        nearest: u32,
    },
    /// A volume of more voxels than are built.
    #[error(
        "a volume of {size} voxels is larger than {MAX_SIDE} along an axis or {MAX_VOXELS} in all: take fewer, a texel \
         is a detail that repeats"
    )]
    TooLarge {
        /// Voxels along u, v and w.
        size: UVec3,
    },
    /// A volume's lengths are no lengths.
    #[error(
        "lengths {lengths} are not all finite and greater than 0: give the size of the volume's box in metres"
    )]
    Lengths {
        /// What they are.
        lengths: Vec3,
    },
    /// A list has another length than the volume or its source asks for.
    #[error("there are {found} {what}, where {expected} are needed: give one for each")]
    Count {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many are needed.
        expected: usize,
    },
    /// A voxel is half transparent.
    #[error(
        "voxel {voxel} has alpha {alpha}: make it 0 (empty) or 255 (opaque), the method needs no sorting for that"
    )]
    HalfTransparent {
        /// Which voxel.
        voxel: UVec3,
        /// Its alpha.
        alpha: u8,
    },
    /// An isolated shape reaches the border of its volume.
    #[error(
        "the shape is isolated, but {voxels} voxels lie on the sides of the volume (the first is {first}): leave a \
         margin of one voxel, or make it `Tiling` if its opposite sides fit"
    )]
    ReachesBorder {
        /// How many do.
        voxels: usize,
        /// The first of them.
        first: UVec3,
    },
    /// Nothing of the shape lies in the volume.
    #[error("no voxel is opaque: check the shape, its alpha, and the box that is sliced")]
    Empty,
    /// A shape without triangles.
    #[error("the shape has no triangles: give it at least one")]
    NoTriangles,
    /// A triangle names a vertex that is not there.
    #[error("triangle {triangle}: vertex {vertex} is not one of {count}: correct the index")]
    MissingVertex {
        /// Which triangle.
        triangle: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// A vertex whose position, normal, colour or texture coordinate is no number.
    #[error(
        "triangle {triangle}: the {what} of vertex {vertex} is not finite: correct or remove it"
    )]
    VertexNotFinite {
        /// The first triangle that uses it.
        triangle: usize,
        /// Which vertex.
        vertex: u32,
        /// What of it.
        what: &'static str,
    },
    /// A triangle is textured, but the shape has no texture coordinates.
    #[error(
        "triangle {triangle} has a texture, but the shape has no texture coordinates: add UVs, or remove the texture"
    )]
    NoUvs {
        /// The first such triangle.
        triangle: usize,
    },
    /// A triangle names a paint that is not there.
    #[error("triangle {triangle}: paint {paint} is not one of {count}: correct the index")]
    MissingPaint {
        /// Which triangle.
        triangle: usize,
        /// The paint that it names.
        paint: u16,
        /// How many there are.
        count: usize,
    },
    /// A paint's colour, or the alpha of its holes, is no number.
    #[error("the {what} of paint {paint} is not finite: correct it, 0 to 1 is usual")]
    PaintNotFinite {
        /// Which paint.
        paint: usize,
        /// What of it.
        what: &'static str,
    },
    /// A texture's pixels don't fit its size.
    #[error(
        "the texture of paint {paint} has {found} pixels where its size asks for {expected}: correct its size"
    )]
    Texture {
        /// Which paint.
        paint: usize,
        /// How many pixels there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A surface that is to be filled does not enclose anything.
    #[error(
        "the surface is open: {edges} edges have an odd number of triangles, the first from {from} to {to} in triangle \
         {triangle}. Close it, or leave it unfilled with `Filling::None`, as sparse foliage is"
    )]
    Open {
        /// How many edges.
        edges: usize,
        /// A triangle of the first.
        triangle: usize,
        /// Where the first starts.
        from: Vec3,
        /// Where the first ends.
        to: Vec3,
    },
    /// A vertex lies outside the box.
    #[error(
        "triangle {triangle} reaches {position}, outside the box that is sliced (from {min} to {max}): enlarge \
         the box, or leave it out to take the shape's own"
    )]
    OutsideBox {
        /// Which triangle.
        triangle: usize,
        /// Where.
        position: Vec3,
        /// The box's lower corner.
        min: Vec3,
        /// The box's upper corner.
        max: Vec3,
    },
    /// The box that is sliced has no volume.
    #[error(
        "the box that is sliced, from {min} to {max}, has no finite volume: give corners that differ along every axis"
    )]
    Box {
        /// The box's lower corner.
        min: Vec3,
        /// The box's upper corner.
        max: Vec3,
    },
    /// A height is no number.
    #[error("the height of pixel ({x}, {y}) is {height}: make it a number from 0 to 1")]
    Height {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// What it is.
        height: f32,
    },
    /// A normal of a height field is no number.
    #[error(
        "the normal of pixel ({x}, {y}) is {normal}: make it finite, or leave normals out to have them taken from heights"
    )]
    HeightNormal {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// What it is.
        normal: Vec3,
    },
    /// A function of space is no number.
    #[error("the function is {value} at {at}: make it finite everywhere in the volume")]
    FunctionNotFinite {
        /// Where, from 0 to 1 along u, v and w.
        at: Vec3,
        /// What it is there.
        value: f32,
    },
    /// The colour of a place is no number.
    #[error("the colour is {color} at {at}: make it finite wherever the volume is opaque")]
    ColorNotFinite {
        /// Where, from 0 to 1 along u, v and w.
        at: Vec3,
        /// What it is there.
        color: Vec3,
    },
    /// Images of a stack differ in size.
    #[error(
        "image {image} is {}x{}, where image 0 is {}x{}: give all images one size",
        found[0], found[1], expected[0], expected[1]
    )]
    ImageSize {
        /// Which image.
        image: usize,
        /// Its width and height.
        found: [u32; 2],
        /// Width and height of the first.
        expected: [u32; 2],
    },
    /// An image or height field has another size than the volume.
    #[error(
        "the {what} is {}x{} pixels, where the volume has {}x{} voxels along u and v: scale one of them",
        found[0], found[1], expected[0], expected[1]
    )]
    SourceSize {
        /// What it is.
        what: &'static str,
        /// Its width and height.
        found: [u32; 2],
        /// The volume's.
        expected: [u32; 2],
    },
}

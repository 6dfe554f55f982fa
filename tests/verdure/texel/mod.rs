//! Texels as they are drawn.

mod agreement;
mod edits;
mod fog;
mod groups;
mod lighting;
mod models;
mod passes;
mod selection;
mod skinned;
mod steady;
mod stroke;
mod through;
mod turns;
mod twins;
mod uploads;
mod views;

use std::sync::LazyLock;

use bevy::asset::RenderAssetUsages;
use bevy::math::DVec3;
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::prelude::*;
use bevy_verdure::lab::texel::ReferenceFacet;
use bevy_verdure::lab::{Lens, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::build::{VolumeSettings, from_hypertexture};
use bevy_verdure::texel::facet::Facet;
use bevy_verdure::texel::{ATTRIBUTE_HEIGHT_VECTOR, ReferenceVolume, silent};

/// Size of the tests' pictures, in pixels.
const SIZE: UVec2 = UVec2::new(128, 96);

/// Voxels along each side of the tests' volume.
const SIDE: u32 = 32;

/// A ball on a post, in colours that are the place.
static LOLLY: LazyLock<ReferenceVolume> = LazyLock::new(|| {
    let solid = |at: Vec3| {
        let ball = 0.33 - at.distance(Vec3::new(0.5, 0.5, 0.6));
        let post = 0.16 - at.truncate().distance(Vec2::splat(0.5));
        ball.max(post)
    };
    let linear = |at: Vec3| at.map(bevy_verdure::texel::color::srgb_to_linear);
    let settings = VolumeSettings::new(UVec3::splat(SIDE));
    from_hypertexture(|at| (0.5 + solid(at), linear(at)), &settings, &silent)
        .expect("the volume is in range")
        .volume
});

/// A surface as a test writes it down: a square of two triangles in the ground.
#[derive(Clone, Debug)]
struct Square {
    positions: [Vec3; 4],
    heights: [Vec3; 4],
    uvs: [Vec2; 4],
}

impl Default for Square {
    fn default() -> Self {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
        Self {
            // Counterclockwise from above, so that the volume is as it was built.
            positions: corners.map(|corner| Vec3::new(corner.x, 0.0, -corner.y)),
            heights: [Vec3::Y; 4],
            uvs: corners,
        }
    }
}

const TRIANGLES: [[usize; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

impl Square {
    fn mesh(&self) -> Mesh {
        Mesh::new(
            PrimitiveTopology::TriangleList,
            RenderAssetUsages::default(),
        )
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, self.positions.to_vec())
        .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, self.uvs.to_vec())
        .with_inserted_attribute(ATTRIBUTE_HEIGHT_VECTOR, self.heights.to_vec())
        .with_inserted_indices(Indices::U16(
            TRIANGLES.as_flattened().iter().map(|&i| i as u16).collect(),
        ))
    }

    /// Its facets in world space, if it stands at `place`.
    fn facets(&self, place: &Transform) -> [Facet; 2] {
        TRIANGLES.map(|triangle| Facet {
            positions: triangle.map(|i| place.transform_point(self.positions[i])),
            heights: triangle.map(|i| place.to_matrix().transform_vector3(self.heights[i])),
            uvs: triangle.map(|i| self.uvs[i]),
        })
    }
}

fn reference(facet: &Facet) -> ReferenceFacet {
    ReferenceFacet {
        positions: facet.positions.map(|at| at.as_dvec3()),
        heights: facet.heights.map(|height| height.as_dvec3()),
        uvs: facet.uvs.map(|uv| uv.as_dvec2()),
    }
}

/// Colours of the volume, as they are.
fn unlit() -> TexelSettings {
    TexelSettings {
        lighting: PlantLighting::Unlit,
        ..default()
    }
}

/// Covers a square.
fn cover(
    studio: &mut Studio,
    square: &Square,
    place: Transform,
    settings: TexelSettings,
) -> Entity {
    let world = studio.world();
    let mesh = world.resource_mut::<Assets<Mesh>>().add(square.mesh());
    let surface = lollies(world, 1.0);
    world.spawn((Mesh3d(mesh), surface, settings, place)).id()
}

/// Covers the default square where it is.
pub fn cover_default(studio: &mut Studio, settings: TexelSettings) -> Entity {
    cover(studio, &Square::default(), Transform::IDENTITY, settings)
}

/// A cover of the tests' volume.
fn lollies(world: &mut World, thickness: f32) -> TexelSurface {
    let volume = world
        .resource_mut::<Assets<TexelVolume>>()
        .add(LOLLY.clone());
    TexelSurface { volume, thickness }
}

/// A shot of the unit cube over the default square.
fn shot(eye: Vec3) -> Shot {
    Shot {
        eye,
        at: Vec3::new(0.5, 0.5, -0.5),
        lens: Lens::Perspective(0.7),
        size: SIZE,
    }
}

/// Rays of a shot, as `DVec3`s, row by row.
fn rays(shot: &Shot) -> impl Iterator<Item = (DVec3, DVec3)> {
    let pixels = (0..shot.size.y).flat_map(|y| (0..shot.size.x).map(move |x| (x, y)));
    pixels.map(|(x, y)| shot.ray(x as f32 + 0.5, y as f32 + 0.5))
}

/// Whether a background pixel shows.
fn is_background(color: [u8; 3]) -> bool {
    color == [0, 0, 255]
}

/// What pictures are taken before: no colour of the volume, of which none has so much blue and so little else.
const BACKGROUND: Color = Color::srgb(0.0, 0.0, 1.0);

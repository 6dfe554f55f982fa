//! A rival of slicing: an octahedral impostor, what engines draw far trees with.
//!
//! Pictures of the crown are taken from directions over the upper half of the octahedron, unfolded to a square (Z. Cigolle
//! and others, *A Survey of Efficient Representations for Independent Unit Vectors*, JCGT 2014); a quad turned to the eye
//! shows the three that are next to it, blended (R. Brucks, *Octahedral Impostors*, 2018). Here they are baked as slices
//! are, trimmed as slices are, and lit as [`PlantLighting::Simple`](crate::lighting::PlantLighting::Simple) lights slices.
//! Into shadow maps the picture next to the light's direction is cast.

mod material;
mod views;

use bevy::asset::{RenderAssetUsages, embedded_asset};
use bevy::mesh::{Indices, PrimitiveTopology};
use bevy::pbr::MaterialPlugin;
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureFormat};
use bevy::render::storage::ShaderBuffer;

pub use material::ImpostorMaterial;
use material::{ShapeUniform, ViewUniform};
use views::{directions, outline};

use crate::slicing::{BakeError, BakeSettings, CrownMesh, MAX_ORIENTATIONS, bake_towards};
use crate::texture_array::texture_array;

/// Draws impostors.
pub struct ImpostorPlugin;

impl Plugin for ImpostorPlugin {
    fn build(&self, app: &mut App) {
        embedded_asset!(app, "impostor.wgsl");
        app.add_plugins(MaterialPlugin::<ImpostorMaterial>::default());
    }
}

/// What an impostor is drawn with.
pub type Impostor = (Handle<Mesh>, Handle<ImpostorMaterial>);

/// Bakes and adds an impostor of `side` × `side` views (2 or more) of so many pixels a side.
///
/// # Errors
/// As [`bake()`](crate::slicing::bake()) says.
pub fn add_impostor(
    world: &mut World,
    crown: &CrownMesh,
    side: u32,
    pixels: u32,
) -> Result<Impostor, BakeError> {
    let settings = BakeSettings {
        vertical: false,
        ..BakeSettings::default().with_slices(1).with_pixels(pixels)
    };
    let directions = directions(side.max(2));
    let (mut colors, mut normals) = (Vec::new(), Vec::new());
    let (mut views, mut corners) = (Vec::new(), Vec::new());
    let (mut centroid, mut radius) = (Vec3::ZERO, 1.0);
    for some in directions.chunks(MAX_ORIENTATIONS) {
        let slicing = bake_towards(crown, &settings, some.to_vec())?;
        let shape = slicing.shape();
        (centroid, radius) = (shape.centroid, shape.radius);
        let [color, normal] = slicing.texture_bytes();
        colors.extend(color);
        normals.extend(normal);
        for (o, octagon) in shape.orientations.iter().zip(slicing.octagons()) {
            views.push(ViewUniform::new(o));
            let size = o.high - o.low;
            corners.extend(
                octagon.map(|uv| Vec2::new(o.low.x + uv.x * size.x, o.high.y - uv.y * size.y)),
            );
        }
    }
    let size = Extent3d {
        width: pixels,
        height: pixels,
        depth_or_array_layers: directions.len() as u32,
    };
    let mut images = world.resource_mut::<Assets<Image>>();
    let mut image = |data, format| {
        let sampler = bevy::image::ImageSamplerDescriptor::linear();
        images.add(texture_array(
            size,
            pixels.ilog2() + 1,
            format,
            data,
            sampler,
        ))
    };
    let color = image(colors, TextureFormat::Rgba8UnormSrgb);
    let normal = image(normals, TextureFormat::Rgba8Unorm);
    let views = world
        .resource_mut::<Assets<ShaderBuffer>>()
        .add(ShaderBuffer::from(views));
    let material = ImpostorMaterial {
        shape: ShapeUniform {
            centroid,
            radius,
            side: side.max(2),
        },
        views,
        color,
        normal,
    };
    let material = world
        .resource_mut::<Assets<ImpostorMaterial>>()
        .add(material);
    let mesh = quad(centroid, radius, &outline(&corners));
    Ok((world.resource_mut::<Assets<Mesh>>().add(mesh), material))
}

/// The quad, trimmed to `outline` (metres from the centroid). Its positions are never drawn: they are corners of the ball's
/// box, which tells Bevy the bounds.
fn quad(centroid: Vec3, radius: f32, outline: &[Vec2]) -> Mesh {
    let positions: Vec<Vec3> = (0..outline.len())
        .map(|i| {
            let side = |bit: usize| if i >> bit & 1 == 0 { -radius } else { radius };
            centroid + Vec3::new(side(0), side(1), side(2))
        })
        .collect();
    let places: Vec<[f32; 2]> = outline.iter().map(Vec2::to_array).collect();
    let indices = (1..outline.len() as u32 - 1).flat_map(|i| [0, i, i + 1]);
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
    .with_inserted_attribute(Mesh::ATTRIBUTE_UV_0, places)
    .with_inserted_indices(Indices::U32(indices.collect()))
}

//! Volumes of models.

use std::path::Path;

use bevy::prelude::*;
use bevy_verdure::lab::load_model;
use bevy_verdure::texel::build::{Filling, ShapeSettings, from_shape};
use bevy_verdure::texel::color::srgb_to_linear;
use bevy_verdure::texel::silent;
use image::RgbaImage;

/// A square leaf of 1 m upright in x and y, which the default scene has twice: twice as large at z = -0.53, and a mirrored
/// one of half its width beside it. It has a texture, a mask, and vertex colours.
const LEAVES: &str = r#"{"asset":{"version":"2.0"},"scene":1,"scenes":[{"nodes":[1]},{"nodes":[0,2]}],
    "nodes":[{"children":[1],"scale":[2,2,2]},{"mesh":0,"translation":[0,0,-0.265]},
    {"mesh":0,"scale":[-1,2,2],"translation":[0,0,-0.53]}],
    "meshes":[{"name":"leaf","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2},"indices":3,
    "material":0}]}],
    "materials":[{"alphaMode":"MASK","alphaCutoff":0.6,"pbrMetallicRoughness":{"baseColorFactor":[RED,1,1,1],
    "baseColorTexture":{"index":0}}}],
    "textures":[{"source":0}],"images":[{"uri":"leaf.png"}],
    "buffers":[{"byteLength":140,"uri":"leaves.bin"}],
    "bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":32},
    {"buffer":0,"byteOffset":80,"byteLength":48},{"buffer":0,"byteOffset":128,"byteLength":12}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5126,"count":4,"type":"VEC2"},
    {"bufferView":2,"componentType":5126,"count":4,"type":"VEC3"},
    {"bufferView":3,"componentType":5123,"count":6,"type":"SCALAR"}]}"#;

/// Writes the leaves: upper left red, lower left cyan, lower right white, and a hole at the upper right.
fn write_leaves(folder: &Path) -> std::io::Result<()> {
    let corners: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut floats: Vec<f32> = corners.iter().flat_map(|&[x, y]| [x, y, 0.0]).collect();
    floats.extend(corners.iter().flat_map(|&[x, y]| [x, 1.0 - y]));
    // Vertex colours leave no blue.
    floats.extend([1.0f32, 1.0, 0.0].repeat(4));
    let mut data: Vec<u8> = floats
        .iter()
        .flat_map(|float| float.to_le_bytes())
        .collect();
    data.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    std::fs::write(folder.join("leaves.bin"), data)?;
    // Half as bright to the eye.
    let red = srgb_to_linear(128.0 / 255.0).to_string();
    std::fs::write(folder.join("leaves.gltf"), LEAVES.replace("RED", &red))?;
    let pixels: [[u8; 4]; 4] = [
        [255, 0, 0, 255],
        [0, 255, 0, 10],
        [0, 255, 255, 255],
        [255, 255, 255, 200],
    ];
    RgbaImage::from_raw(2, 2, pixels.as_flattened().to_vec())
        .expect("four pixels")
        .save(folder.join("leaf.png"))
        .map_err(std::io::Error::other)
}

#[test]
fn a_model_becomes_voxels_where_its_masked_leaves_are_and_nowhere_else() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("texel_model");
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    write_leaves(&folder).expect("the model can be written");
    let model = load_model(&folder.join("leaves.gltf")).expect("two leaves");
    let shape = model.shape().expect("they are triangles");
    assert_eq!((shape.triangles.len(), shape.paints.len()), (4, 1));
    let settings = ShapeSettings {
        bounds: Some([Vec3::new(-2.0, 0.0, 0.0), Vec3::new(6.0, 1.0, 2.0)]),
        filling: Filling::None,
        ..ShapeSettings::new(UVec3::splat(16))
    };
    let volume = from_shape(&shape, &settings, &silent)
        .expect("the leaves are in their box")
        .volume;
    for index in 0..16 * 16 * 16 {
        let (x, y, z) = (index % 16, index / 16 % 16, index / 256);
        // glTF's x, -z and y, in voxels; a leaf of 2 m is four wide, and the mirrored one two.
        let color = match (y, x, z) {
            (8, 3..=5, 8..) => [128, 0, 0, 255],
            (8, 3..=5, _) => [0, 255, 0, 255],
            (8, 2 | 6 | 7, ..8) => [128, 255, 0, 255],
            _ => [0; 4],
        };
        assert_eq!(volume.color(x, y, z), color, "{x} {y} {z}");
        if color[3] > 0 {
            // Mirrored or not, glTF's z is the front.
            assert_eq!(volume.normal(x, y, z).round(), Vec3::NEG_Y, "{x} {y} {z}");
        }
    }
}

#[test]
fn a_model_that_is_not_there_is_named() {
    let message = load_model(Path::new("out/no_such_model.glb")).unwrap_err();
    assert!(
        message.contains("no_such_model.glb: ") && message.contains("*.glb or *.gltf"),
        "{message}"
    );
}

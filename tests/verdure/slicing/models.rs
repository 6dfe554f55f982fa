//! Models to bake, right and wrong.

use bevy::prelude::*;
use bevy_verdure::lab::load_model;
use image::RgbaImage;

use super::files::folder;

/// What is told of a triangle of 1 m on a node at x = 2, with a red material whose texture is `leaf 1.png`.
const TWIG: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"translation":[2,0,0]}],
    "meshes":[{"name":"twig","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2},"indices":1,"material":0,"mode":4}]}],
    "materials":[{"name":"leaf","pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1],"baseColorTexture":{"index":0,
    "extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.5707964,"scale":[0.5,0.25]}}}}}],
    "textures":[{"source":0}],"images":[{"uri":"leaf%201.png"}],
    "buffers":[{"byteLength":68}],
    "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6},
    {"buffer":0,"byteOffset":44,"byteLength":24}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},
    {"bufferView":2,"componentType":5126,"count":3,"type":"VEC2"}]}"#;

/// A binary glTF of a text, and of a triangle whose first corner is `corner`, and whose index buffer is `indices`.
fn glb(json: &str, corner: [f32; 3], indices: [u16; 3]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let corners = [corner, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bytes =
        |floats: &[f32]| -> Vec<u8> { floats.iter().flat_map(|x| x.to_le_bytes()).collect() };
    let mut data = bytes(corners.as_flattened());
    data.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
    data.resize(44, 0);
    data.extend(bytes(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]));
    let mut file = b"glTF".to_vec();
    let length = 12 + 8 + json.len() + 8 + data.len();
    for number in [2, length as u32, json.len() as u32] {
        file.extend(number.to_le_bytes());
    }
    file.extend(b"JSON");
    file.extend(json);
    file.extend((data.len() as u32).to_le_bytes());
    file.extend(b"BIN\0");
    file.extend(data);
    file
}

#[test]
fn models_are_read_from_gltf_or_refused_by_name() {
    let folder = folder("model");
    let path = folder.join("twig.glb");
    RgbaImage::new(2, 2)
        .save(folder.join("leaf 1.png"))
        .expect("a picture can be written");
    let whole = glb(TWIG, [0.0; 3], [0, 1, 2]);
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).expect("the model can be written");
        load_model(&path)
    };
    let model = read(&whole).expect("a triangle");
    let [part] = model.parts.as_slice() else {
        panic!("{model:?}")
    };
    assert_eq!(
        (part.mesh.as_str(), part.material.as_str()),
        ("twig", "leaf")
    );
    let crown = model.crown(|_| true).expect("the triangle is near");
    let triangle = crown.triangles[0];
    assert_eq!(
        triangle.positions(),
        [Vec3::X * 2.0, Vec3::X * 3.0, Vec3::new(2.0, 1.0, 0.0)]
    );
    assert_eq!(triangle.vertices[0].normal.normalize(), Vec3::Z);
    assert_eq!(crown.materials[0].color, [1.0, 0.0, 0.0, 1.0]);
    // A quarter turn, counter-clockwise where v runs down: from u to -v.
    let uv = crown.materials[0]
        .uv_transform
        .transform_point2(Vec2::new(1.0, 0.0));
    assert!(uv.distance(Vec2::new(0.5, -0.25)) < 1e-6, "{uv}");
    // Nodes that hold one another twice would be met 2^40 times.
    let tower: Vec<_> = (1..=40)
        .map(|i| format!(r#"{{"children":[{i},{i}]}}"#))
        .collect();
    let tower = format!(r#""nodes":[{},{{"mesh":0}}]"#, tower.join(","));
    let node = r#""nodes":[{"mesh":0,"translation":[2,0,0]}]"#;
    let with = |old: &str, new: &str| {
        assert!(TWIG.contains(old), "{old}");
        glb(&TWIG.replace(old, new), [0.0; 3], [0, 1, 2])
    };
    for (bytes, what) in [
        (
            glb(TWIG, [0.0; 3], [0, 1, 7]),
            "`twig`: triangle 0 names vertex 7 of 3",
        ),
        (
            glb(TWIG, [f32::NAN, 0.0, 0.0], [0, 1, 2]),
            "`twig`: the positions of vertex 0 are not finite",
        ),
        (
            with(r#","TEXCOORD_0":2"#, ""),
            "`twig` has a texture, but no texture coordinates",
        ),
        (with(node, r#""nodes":[{}]"#), "has no triangles"),
        (
            with(r#""mode":4"#, r#""mode":5"#),
            "`twig` is not a list of triangles",
        ),
        (
            with("VEC3", "VEC2"),
            "`twig` has no positions that can be read",
        ),
        (
            with(
                r#""count":3,"type":"SCALAR""#,
                r#""count":2,"type":"SCALAR""#,
            ),
            "2 corners",
        ),
        (
            with(
                r#""count":3,"type":"SCALAR""#,
                r#""count":30000,"type":"SCALAR""#,
            ),
            "no indices",
        ),
        (
            with(r#""componentType":5123"#, r#""componentType":5126"#),
            "no indices",
        ),
        (with(r#""POSITION":0"#, r#""POSITION":9"#), "not there"),
        (with("leaf%201", "oak"), "oak.png: "),
        (with(node, &tower), "node 40 stands in two places"),
        (with(node, r#""nodes":[{"children":[0]}]"#), "node 0 stands"),
        (
            with(
                r#"{"asset":"#,
                r#"{"extensionsRequired":["KHR_draco_mesh_compression"],"asset":"#,
            ),
            "uncompressed",
        ),
        (whole[..40].to_vec(), "is no glTF"),
        (b"solid".to_vec(), "is no glTF"),
    ] {
        let message = read(&bytes).unwrap_err();
        assert!(
            message.contains("twig.glb: ") && message.contains(what),
            "{message}"
        );
    }
}

//! What is promised of baking.

use bevy::asset::{Assets, Handle, RenderAssetUsages};
use bevy::image::Image;
use bevy::math::{Affine2, Mat4, Vec2, Vec3};
use bevy::mesh::{Indices, Mesh, PrimitiveTopology, UvChannel};
use bevy::pbr::StandardMaterial;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};
use proptest::prelude::*;

use super::*;
use crate::plants::Dice;
use crate::slicing::octagon;

fn vertex(position: Vec3, normal: Vec3) -> CrownVertex {
    CrownVertex {
        position,
        normal,
        uv: Vec2::ZERO,
        color: [1.0; 4],
    }
}

/// A parallelogram at `centre` with half sides `a` and `b`.
fn quad(mesh: &mut CrownMesh, centre: Vec3, a: Vec3, b: Vec3, material: u32) {
    let n = a.cross(b);
    let corner = |x: f32, y: f32| vertex(centre + a * x + b * y, n);
    mesh.push(
        [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)],
        material,
    );
    mesh.push(
        [corner(-1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        material,
    );
}

fn crown(leaves: usize) -> CrownMesh {
    let mut dice = Dice::new(11);
    let mut mesh = CrownMesh::default();
    let green = mesh.add_material(CrownMaterial {
        color: [0.1, 0.4, 0.05, 1.0],
        ..CrownMaterial::default()
    });
    let unit = |dice: &mut Dice| Vec3::new(dice.jitter(1.0), dice.jitter(1.0), dice.jitter(1.0));
    for _ in 0..leaves {
        let centre = unit(&mut dice) * 2.0 + Vec3::Y * 5.0;
        let (a, b) = (unit(&mut dice) * 0.1, unit(&mut dice) * 0.1);
        quad(&mut mesh, centre, a, b, green);
    }
    mesh
}

fn small() -> BakeSettings {
    BakeSettings {
        pixels: 32,
        samples: 2,
        ..BakeSettings::default()
    }
}

#[test]
fn the_same_crown_bakes_to_the_same_bytes_with_any_number_of_threads() {
    let crown = crown(300);
    let [one, three] = [1, 3].map(|threads| {
        let settings = BakeSettings { threads, ..small() };
        bake(&crown, &settings).unwrap()
    });
    assert_eq!(one, three);
    assert_eq!(one.shape().layers(), 7 * 9);
}

#[test]
fn progress_counts_every_slice_once() {
    let told = Mutex::new(Vec::new());
    bake_with_progress(&crown(20), &small(), |done, all| {
        told.lock().unwrap().push((done, all));
    })
    .unwrap();
    let mut told = told.into_inner().unwrap();
    told.sort_unstable();
    assert_eq!(told, (1..=63).map(|done| (done, 63)).collect::<Vec<_>>());
}

#[test]
fn coverage_is_that_of_the_triangles_and_colours_are_theirs() {
    // A square of 1 m, facing +x, of known colour.
    let mut mesh = CrownMesh::default();
    let material = mesh.add_material(CrownMaterial {
        color: [0.25, 0.5, 0.125, 1.0],
        ..CrownMaterial::default()
    });
    quad(
        &mut mesh,
        Vec3::Y,
        Vec3::Y * 0.5,
        Vec3::NEG_Z * 0.5,
        material,
    );
    let settings = small().with_slices(1).with_pixels(64);
    let slicing = bake(&mesh, &settings).unwrap();
    let o = slicing.shape().orientations[0];
    let size = o.high - o.low;
    let pixels = slicing.color(0);
    let covered: f32 = pixels.iter().map(|p| f32::from(p[3]) / 255.0).sum();
    let area = covered / 4096.0 * size.x * size.y;
    // An edge is off by half a sample at most: 4 sides of 1 m, each ½ · size/128.
    assert!((area - 1.0).abs() < 4.0 * 0.5 * size.x / 128.0, "{area}");
    // All pixels have the colour, the transparent ones by bleeding.
    let expected = [0.25, 0.5, 0.125].map(color::encode);
    assert!(pixels.iter().all(|p| p[..3] == expected));
    // Seen from +x the normal is +x; from −x it is −x.
    let normal_at = |orientation: usize| {
        let layer = slicing.shape().first_layer(0, orientation);
        slicing.normal(layer)[32 * 64 + 32]
    };
    assert_eq!(normal_at(0)[..3], [255, 128, 128]);
    assert_eq!(normal_at(3)[..3], [0, 128, 128]);
}

#[test]
fn every_small_triangle_is_on_one_slice_of_each_orientation() {
    let crown = crown(60);
    let shape = shape(&crown, &small(), small().directions());
    for o in &shape.orientations {
        let projection = Projection {
            orientation: o,
            centroid: shape.centroid,
            side: 256,
        };
        for (index, triangle) in crown.triangles.iter().enumerate() {
            let alone = CrownMesh {
                triangles: vec![*triangle],
                materials: crown.materials.clone(),
            };
            let on = (0..5).filter(|slice| {
                let seen = rasterize(&alone, &projection, *slice, 5);
                seen.contains(&0)
            });
            let centroid = o.axes(triangle.centroid() - shape.centroid).z;
            let nearest = o.slice_at(centroid, 5);
            // Seen from its edge it may fall between the samples.
            for slice in on {
                assert_eq!(slice, nearest, "triangle {index}");
            }
        }
    }
}

#[test]
fn a_primitive_larger_than_the_spacing_is_on_several_slices_without_a_crack() {
    // A wall that runs through the depth of all slices of the first orientation, beside leaves that fill the box.
    let mut mesh = crown(50);
    let count = mesh.triangles.len();
    quad(
        &mut mesh,
        Vec3::Y * 5.0,
        Vec3::new(1.5, 0.0, 1.5),
        Vec3::Y,
        0,
    );
    let shape = shape(&mesh, &small(), small().directions());
    let o = &shape.orientations[0];
    let projection = Projection {
        orientation: o,
        centroid: shape.centroid,
        side: 128,
    };
    mesh.triangles.drain(..count);
    let slices: Vec<_> = (0..5)
        .map(|slice| rasterize(&mesh, &projection, slice, 5))
        .collect();
    let on: Vec<usize> = (0..128 * 128)
        .map(|i| {
            slices
                .iter()
                .filter(|seen| seen[i] != raster::NOTHING)
                .count()
        })
        .collect();
    let parts = slices
        .iter()
        .filter(|seen| seen.iter().any(|seen| *seen != raster::NOTHING));
    assert!(parts.count() >= 3);
    let whole = rasterize(&mesh, &projection, 0, 1);
    for (i, on) in on.iter().enumerate() {
        assert_eq!(*on, usize::from(whole[i] != raster::NOTHING), "sample {i}");
    }
}

#[test]
fn the_inside_of_a_crown_is_darker() {
    let crown = crown(4000);
    let light = occlusion::light_from_around(&crown);
    let mean = |inside: bool| {
        let all = crown.triangles.iter().zip(&light);
        let some = all.filter(|(triangle, _)| {
            let r = (triangle.centroid() - Vec3::Y * 5.0).abs().max_element();
            if inside { r < 0.7 } else { r > 1.7 }
        });
        let (sum, count) = some.fold((0.0, 0), |(sum, count), (_, light)| {
            (sum + light, count + 1)
        });
        sum / count as f32
    };
    // From the middle there are 2 m of ρ = 4000 · 0.01 · E|a × b| / 64 m³ to pass; from a face, half of the sky is free.
    assert!(
        mean(true) < 0.75 * mean(false),
        "{} {}",
        mean(true),
        mean(false)
    );
    assert!(light.iter().all(|light| (0.0..=1.0).contains(light)));
}

#[test]
fn octagons_hold_every_opaque_pixel() {
    let slicing = bake(&crown(200), &small()).unwrap();
    for (layer, outline) in slicing.octagons().iter().enumerate() {
        for (i, pixel) in slicing.color(layer).iter().enumerate() {
            let centre = Vec2::new((i % 32) as f32 + 0.5, (i / 32) as f32 + 0.5) / 32.0;
            assert!(pixel[3] == 0 || octagon::contains(outline, centre));
        }
    }
}

#[test]
fn a_textures_transform_is_that_of_the_standard_material() {
    let mut images = Assets::<Image>::default();
    let texture = images.add(Image::new(
        Extent3d {
            width: 2,
            height: 1,
            ..Default::default()
        },
        TextureDimension::D2,
        vec![255, 0, 0, 255, 0, 0, 255, 255],
        TextureFormat::Rgba8UnormSrgb,
        RenderAssetUsages::default(),
    ));
    let mut standard = StandardMaterial {
        base_color_texture: Some(texture),
        ..Default::default()
    };
    // A quarter into a texture of two pixels is the middle of the first, red one.
    let place = Vec2::new(0.25, 0.5);
    let red = CrownMaterial::from_standard("leaf", &standard, &images).unwrap();
    assert_eq!(red.sample(place), [1.0, 0.0, 0.0, 1.0]);
    standard.uv_transform = Affine2::from_translation(Vec2::new(0.5, 0.0));
    let blue = CrownMaterial::from_standard("leaf", &standard, &images).unwrap();
    assert_eq!(blue.sample(place), [0.0, 0.0, 1.0, 1.0]);
}

#[test]
fn a_mask_cuts_holes() {
    let mut mesh = CrownMesh::default();
    // Left half opaque, right half a hole; nearest to the pixels' centres filtering does nothing.
    let texture =
        CrownTexture::new([2, 1], vec![[255, 255, 255, 255], [255, 255, 255, 0]]).unwrap();
    let material = mesh.add_material(CrownMaterial {
        texture: Some(texture),
        cutoff: 0.5,
        ..CrownMaterial::default()
    });
    quad(&mut mesh, Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, material);
    for triangle in &mut mesh.triangles {
        for vertex in &mut triangle.vertices {
            vertex.uv = Vec2::new(0.5 - 0.5 * vertex.position.z, 0.5);
        }
    }
    let slicing = bake(&mesh, &small().with_slices(1)).unwrap();
    let covered: f32 = slicing
        .color(0)
        .iter()
        .map(|p| f32::from(p[3]) / 255.0)
        .sum();
    let o = slicing.shape().orientations[0];
    let area = covered / 1024.0 * (o.high.x - o.low.x) * (o.high.y - o.low.y);
    // Half of 4 m², give or take a sample along the edge of each of three rows of ~2 m.
    assert!((area - 2.0).abs() < 8.0 * 0.5 * 2.3 / 64.0, "{area}");
}

#[test]
fn what_cannot_be_baked_is_refused_with_the_fix() {
    let message = |mesh: &CrownMesh| bake(mesh, &small()).unwrap_err().to_string();
    assert!(message(&CrownMesh::default()).contains("add the mesh"));
    let mut flat = crown(2);
    for triangle in &mut flat.triangles {
        triangle.vertices = [triangle.vertices[0]; 3];
    }
    assert!(message(&flat).contains("no triangle has an area"));
    for bad in [f32::NAN, f32::INFINITY, 1e9] {
        let mut mesh = crown(2);
        mesh.triangles[3].vertices[1].position.y = bad;
        assert!(message(&mesh).starts_with("triangle 3: position"), "{bad}");
    }
    let mut mesh = crown(2);
    mesh.triangles[1].vertices[0].normal.x = f32::NAN;
    assert!(message(&mesh).starts_with("triangle 1: a normal"));
    let mut mesh = crown(2);
    mesh.triangles[2].material = 7;
    assert!(message(&mesh).contains("material 7 is not one of the 1"));
    let refused = |settings: BakeSettings| bake(&crown(2), &settings).unwrap_err().to_string();
    assert!(refused(small().with_pixels(100)).contains("`pixels` is 100"));
    assert!(refused(small().with_slices(0)).contains("`levels` is [0]"));
    assert!(refused(small().with_slices(1_000_000)).contains("`levels` is [1000000]"));
    assert!(
        refused(small().with_orientations(Orientations::Circle(2))).contains("`orientations` is 2")
    );
    assert!(
        refused(
            small()
                .with_orientations(Orientations::Circle(31))
                .with_slices(20)
        )
        .contains("640 slices")
    );
    let settings = BakeSettings {
        correction: f32::NAN,
        ..small()
    };
    assert!(refused(settings).contains("`correction` is NaN"));
}

#[test]
fn bevy_meshes_are_taken_with_or_without_indices_and_normals() {
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let bare = Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions.clone());
    let mut crown = CrownMesh::default();
    let white = crown.add_material(CrownMaterial::default());
    crown
        .add_mesh("bare", &bare, Mat4::from_scale(Vec3::splat(2.0)), white)
        .unwrap();
    assert_eq!(crown.triangles[0].vertices[1].position, Vec3::X * 2.0);
    assert_eq!(crown.triangles[0].vertices[1].normal.normalize(), Vec3::Z);
    let wrong = bare
        .clone()
        .with_inserted_indices(Indices::U32(vec![0, 1, 3]));
    let error = crown
        .add_mesh("wrong", &wrong, Mat4::IDENTITY, white)
        .unwrap_err();
    assert!(
        error
            .to_string()
            .contains("`wrong`: triangle 0 names vertex 3 of 3"),
        "{error}"
    );
    let points = Mesh::new(PrimitiveTopology::PointList, RenderAssetUsages::default());
    assert!(matches!(
        crown.add_mesh("points", &points, Mat4::IDENTITY, white),
        Err(BakeError::Topology { .. })
    ));
    let texture = CrownTexture::new([1, 1], vec![[255; 4]]).unwrap();
    let textured = crown.add_material(CrownMaterial {
        texture: Some(texture),
        ..CrownMaterial::default()
    });
    let error = crown
        .add_mesh("bare", &bare, Mat4::IDENTITY, textured)
        .unwrap_err();
    assert!(
        error.to_string().contains("no texture coordinates"),
        "{error}"
    );
}

#[test]
fn a_trunk_is_solid_and_leaves_are_sparse() {
    let mut plant = crown(40);
    let leaves = plant.triangles.len();
    quad(&mut plant, Vec3::Y * 3.0, Vec3::X * 0.2, Vec3::Y * 3.0, 0);
    let parts = separate(&plant, 0.25);
    assert_eq!(
        (parts.solid.triangles.len(), parts.sparse.triangles.len()),
        (2, leaves)
    );
}

/// A material of a colour and a texture of one pixel.
fn material(color: [f32; 4], pixel: [u8; 4]) -> CrownMaterial {
    CrownMaterial {
        color,
        texture: Some(CrownTexture::new([1, 1], vec![pixel]).unwrap()),
        ..CrownMaterial::default()
    }
}

#[test]
fn alpha_means_what_the_material_says() {
    // A leaf of half an alpha before a red one: what is seen from +x, of colour and alpha.
    let seen = |front: CrownMaterial, vertex_alpha: f32| {
        let mut mesh = CrownMesh::default();
        let front = mesh.add_material(front);
        let red = mesh.add_material(CrownMaterial {
            color: [1.0, 0.0, 0.0, 1.0],
            ..CrownMaterial::default()
        });
        quad(&mut mesh, Vec3::X * 0.1, Vec3::Y, Vec3::NEG_Z, front);
        for vertex in mesh.triangles.iter_mut().flat_map(|t| &mut t.vertices) {
            vertex.color[3] = vertex_alpha;
        }
        quad(&mut mesh, Vec3::ZERO, Vec3::Y, Vec3::NEG_Z, red);
        let slicing = bake(&mesh, &small().with_slices(1)).unwrap();
        slicing.color(0)[16 * 32 + 16]
    };
    let green = [0.0, 1.0, 0.0, 0.5];
    let (solid, gone) = ([255; 4], [255, 255, 255, 0]);
    let blended = material(green, solid);
    let opaque = CrownMaterial {
        opaque: true,
        ..material(green, gone)
    };
    let masked = |cutoff| CrownMaterial {
        cutoff,
        ..material(green, solid)
    };
    assert_eq!(seen(blended, 0.5), [0, 255, 0, 64]);
    // What is not there hides nothing.
    assert_eq!(seen(material(green, gone), 1.0), [255, 0, 0, 255]);
    assert_eq!(seen(opaque, 0.0), [0, 255, 0, 255]);
    // A mask looks at alpha of colour, texture and vertices together.
    assert_eq!(seen(masked(0.4), 1.0), [0, 255, 0, 255]);
    assert_eq!(seen(masked(0.4), 0.5), [255, 0, 0, 255]);
}

#[test]
fn a_tiny_crown_far_from_the_origin_bakes() {
    // A millimetre is less there than single precision tells apart.
    let mut mesh = CrownMesh::default();
    mesh.add_material(CrownMaterial::default());
    let far = Vec3::splat(9e4);
    quad(&mut mesh, far, Vec3::X * 0.02, Vec3::Y * 0.02, 0);
    bake(&mesh, &small()).unwrap();
}

#[test]
fn second_texture_coordinates_are_read_where_the_material_says() {
    let mut mesh = triangle();
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_0, vec![[0.25_f32, 0.5]; 3]);
    mesh.insert_attribute(Mesh::ATTRIBUTE_UV_1, vec![[0.75_f32, 0.5]; 3]);
    for (uv_channel, u) in [(UvChannel::Uv0, 0.25), (UvChannel::Uv1, 0.75)] {
        let mut crown = CrownMesh::default();
        let material = crown.add_material(CrownMaterial {
            uv_channel,
            ..CrownMaterial::default()
        });
        crown
            .add_mesh("leaf", &mesh, Mat4::IDENTITY, material)
            .unwrap();
        assert_eq!(crown.triangles[0].vertices[0].uv.x, u);
    }
}

#[test]
fn what_a_mesh_and_its_material_lack_is_told_with_the_meshs_name() {
    let told = |mesh: &Mesh| {
        let error = CrownMesh::default().add_mesh("leaf", mesh, Mat4::IDENTITY, 0);
        error.unwrap_err().to_string()
    };
    let odd = triangle().with_inserted_indices(Indices::U32(vec![0, 1, 2, 0]));
    assert!(told(&odd).contains("`leaf` has 4 indices, no multiple of 3"));
    let positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, f32::NAN, 0.0]];
    let broken = triangle().with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions);
    let text = told(&broken);
    assert!(
        text.contains("`leaf`: triangle 0: position") && text.contains("correct the mesh"),
        "{text}"
    );
    // A texture that is not loaded, and one whose pixels cannot be read.
    let mut images = Assets::<Image>::default();
    let mut compressed = Image::default();
    compressed.texture_descriptor.format = TextureFormat::Bc1RgbaUnorm;
    for (texture, why) in [
        (
            Handle::default(),
            "`leaf`: its base colour texture is missing",
        ),
        (images.add(compressed), "`leaf`: a texture cannot be read"),
    ] {
        let material = StandardMaterial {
            base_color_texture: Some(texture),
            ..Default::default()
        };
        let error = CrownMaterial::from_standard("leaf", &material, &images).unwrap_err();
        assert!(error.to_string().contains(why), "{error}");
    }
    let mut crown = crown(2);
    crown.materials[0].cutoff = f32::NAN;
    let error = bake(&crown, &small()).unwrap_err().to_string();
    assert!(error.contains("material 0, counted from 0"), "{error}");
}

/// A mesh of one triangle.
fn triangle() -> Mesh {
    let positions = vec![[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    Mesh::new(
        PrimitiveTopology::TriangleList,
        RenderAssetUsages::default(),
    )
    .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn any_triangles_bake_or_are_refused(
        numbers in prop::collection::vec(prop_oneof![
            4 => -3.0_f32..3.0,
            1 => prop::num::f32::ANY,
            1 => Just(0.0),
        ], 0..90),
        sphere in any::<bool>(),
        slices in 1_u32..5,
    ) {
        let mut mesh = CrownMesh::default();
        mesh.add_material(CrownMaterial::default());
        for corners in numbers.chunks_exact(9) {
            let at = |i: usize| Vec3::new(corners[i], corners[i + 1], corners[i + 2]);
            mesh.push([0, 3, 6].map(|i| vertex(at(i), Vec3::Y)), 0);
        }
        let orientations = if sphere { Orientations::Sphere(7) } else { Orientations::Circle(3) };
        let settings = BakeSettings { samples: 1, pixels: 16, ..BakeSettings::default() }
            .with_slices(slices)
            .with_orientations(orientations);
        if let Ok(slicing) = bake(&mesh, &settings) {
            prop_assert_eq!(slicing.octagons().len(), slicing.shape().layers());
        }
    }
}

//! What cannot be built is refused with a reason and a fix.

use bevy::math::{UVec2, UVec3, Vec2, Vec3, Vec4};
use proptest::prelude::*;

use super::*;

fn refused(shape: &Shape, change: impl Fn(&mut ShapeSettings)) -> String {
    let mut settings = ShapeSettings::new(UVec3::splat(8));
    change(&mut settings);
    from_shape(shape, &settings, &silent)
        .unwrap_err()
        .to_string()
}

fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "`{part}` is not in `{message}`");
    }
}

#[test]
fn broken_shapes_are_named_by_triangle_and_vertex() {
    let good = cuboid(Vec3::ZERO, Vec3::ONE);
    let with = |change: &dyn Fn(&mut Shape)| {
        let mut shape = good.clone();
        change(&mut shape);
        refused(&shape, |_| ())
    };
    assert_says(&with(&|s| s.triangles.clear()), &["no triangles"]);
    assert_says(
        &with(&|s| s.triangles[3][1] = 8),
        &["triangle 3: vertex 8 is not one of 8"],
    );
    assert_says(
        &with(&|s| s.positions[7].y = f32::NAN),
        &["triangle 3: the position of vertex 7", "not finite"],
    );
    assert_says(
        &with(&|s| s.normals = vec![Vec3::INFINITY; 8]),
        &["triangle 0: the normal of vertex 0"],
    );
    assert_says(
        &with(&|s| s.uvs = vec![Vec2::ZERO; 3]),
        &["3 texture coordinates, where 8"],
    );
    assert_says(
        &with(&|s| s.paint_of = vec![1; 12]),
        &["triangle 0: paint 1 is not one of 0"],
    );
    let textured = |size| Paint {
        texture: Some(PaintTexture::new(size, &[[255; 4]])),
        ..Paint::default()
    };
    let colored = |red: f32, alpha_cutoff: f32| Paint {
        color: Vec4::new(red, 0.5, 0.5, 1.0),
        alpha_cutoff,
        texture: None,
    };
    for (paint, what) in [
        (colored(f32::NAN, 0.5), "colour of paint 1"),
        (colored(0.5, f32::NAN), "alpha_cutoff of paint 1"),
        (colored(0.5, f32::INFINITY), "alpha_cutoff of paint 1"),
    ] {
        let message = with(&|s| s.paints = vec![Paint::default(), paint.clone()]);
        assert_says(&message, &[what, "not finite", "correct it"]);
    }
    assert_says(
        &with(&|s| s.paints = vec![textured([1, 1])]),
        &["triangle 0 has a texture", "add UVs"],
    );
    assert_says(
        &with(&|s| s.paints = vec![textured([2, 2])]),
        &["paint 0 has 1 pixels where its size asks for 4"],
    );
}

#[test]
fn an_open_surface_is_not_filled_but_may_be_left_unfilled() {
    let mut open = cuboid(Vec3::ZERO, Vec3::ONE);
    open.triangles.remove(2);
    let message = refused(&open, |_| ());
    assert_says(&message, &["open: 3 edges", "triangle 2", "Filling::None"]);
    let settings = ShapeSettings {
        filling: Filling::None,
        ..ShapeSettings::new(UVec3::splat(8))
    };
    assert!(from_shape(&open, &settings, &silent).is_ok());
}

#[test]
fn triangles_without_area_are_left_out_and_counted() {
    let mut shape = cuboid(Vec3::ZERO, Vec3::ONE);
    shape.triangles.extend([[0, 0, 1], [2, 2, 2]]);
    let built = from_shape(&shape, &ShapeSettings::new(UVec3::splat(8)), &silent).unwrap();
    assert_eq!(built.report.zero_area_triangles, 2);
}

#[test]
fn edges_of_many_triangles_are_fine_where_solids_touch() {
    let mut shape = cuboid(Vec3::ZERO, Vec3::ONE);
    let other = cuboid(Vec3::new(1.0, 1.0, 0.0), Vec3::new(2.0, 2.0, 1.0));
    shape
        .triangles
        .extend(other.triangles.iter().map(|t| t.map(|i| i + 8)));
    shape.positions.extend(other.positions);
    assert!(from_shape(&shape, &ShapeSettings::new(UVec3::splat(16)), &silent).is_ok());
}

#[test]
fn boxes_that_cut_the_shape_or_have_no_volume_are_refused() {
    let shape = cuboid(Vec3::ZERO, Vec3::ONE);
    let message = refused(&shape, |s| {
        s.bounds = Some([Vec3::ZERO, Vec3::new(2.0, 2.0, 0.5)])
    });
    assert_says(&message, &["outside the box", "enlarge the box"]);
    let message = refused(&shape, |s| s.bounds = Some([Vec3::ONE, Vec3::ZERO]));
    assert_says(&message, &["no finite volume"]);
    let message = refused(&cuboid(Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0)), |_| ());
    assert_says(&message, &["no finite volume"]);
    let message = refused(&shape, |s| s.bounds = Some([Vec3::ZERO, Vec3::splat(1.5)]));
    assert_says(&message, &["lie on the sides", "leave a margin"]);
    let message = refused(&cuboid(Vec3::ZERO, Vec3::new(1e6, 1.0, 1.0)), |s| {
        s.topology = Topology::Tiling;
        s.bounds = Some([Vec3::ZERO, Vec3::ONE]);
    });
    assert_says(&message, &["outside the box"]);
    let message = refused(&shape, |s| s.size.y = 9);
    assert_says(&message, &["9 voxels along v", "take 8"]);
}

#[test]
fn height_fields_images_and_functions_are_checked() {
    let settings = VolumeSettings::new(UVec3::new(4, 4, 2));
    let field = HeightField::new(UVec2::splat(4), vec![0.5; 16], [0; 3]);
    let with = |change: &dyn Fn(&mut HeightField)| {
        let mut field = field.clone();
        change(&mut field);
        from_height_field(&field, &settings, &silent)
            .unwrap_err()
            .to_string()
    };
    assert_says(
        &with(&|f| f.size = UVec2::new(4, 8)),
        &["height field is 4x8 pixels, where the volume has 4x4"],
    );
    assert_says(
        &with(&|f| f.heights[6] = f32::NAN),
        &["pixel (2, 1) is NaN"],
    );
    let broken = |f: &mut HeightField| {
        let mut normals = vec![Vec3::Z; 16];
        normals[7].x = f32::INFINITY;
        f.normals = Some(normals);
    };
    assert_says(
        &with(&broken),
        &["normal of pixel (3, 1) is [inf, 0, 1]", "make it finite"],
    );
    assert_says(&with(&|f| f.colors.truncate(3)), &["3 colours, where 16"]);
    assert_says(&with(&|f| f.heights.fill(-1.0)), &["no voxel is opaque"]);

    let image = |side: u32| StackImage {
        size: [side; 2],
        pixels: vec![[255; 4]; (side * side) as usize],
    };
    let of = |images: &[StackImage]| {
        from_images(images, &settings, &silent)
            .unwrap_err()
            .to_string()
    };
    assert_says(
        &of(&[image(4), image(5)]),
        &["image 1 is 5x5, where image 0 is 4x4"],
    );
    assert_says(
        &of(&[image(2), image(2)]),
        &["image is 2x2 pixels, where the volume has 4x4"],
    );
    assert_says(&of(&[image(4)]), &["1 images, where 2"]);
    let mut short = image(4);
    short.pixels.pop();
    assert_says(&of(&[image(4), short]), &["15 pixels in an image"]);

    let nan = |at: Vec3| {
        if at.x > 0.5 && at.z > 0.5 {
            f32::NAN
        } else {
            2.0
        }
    };
    let message = from_implicit(nan, |at| at, &settings, &silent)
        .unwrap_err()
        .to_string();
    assert_says(&message, &["NaN at [0.625, 0.125, 0.75]"]);
    let color = |at: Vec3| {
        if at.y > 0.5 {
            Vec3::new(at.x, f32::NAN, 0.0)
        } else {
            at
        }
    };
    let message = from_implicit(|_| 2.0, color, &settings, &silent)
        .unwrap_err()
        .to_string();
    assert_says(
        &message,
        &[
            "colour is [0.125, NaN, 0] at [0.125, 0.625, 0.25]",
            "finite",
        ],
    );
    let texture = |at: Vec3| (1.0, color(at));
    let message = from_hypertexture(texture, &settings, &silent)
        .unwrap_err()
        .to_string();
    assert_says(&message, &["at [0.125, 0.625, 0.25]"]);
}

/// Numbers of all kinds.
fn number() -> impl Strategy<Value = f32> {
    prop_oneof![
        8 => -2.0..2.0f32,
        4 => prop::sample::select(vec![0.0, -0.0, 1.0, 0.5, -1.0]),
        1 => prop::sample::select(vec![
            f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN_POSITIVE, 1e30, -1e30, 1e-30,
        ]),
    ]
}

fn vector() -> impl Strategy<Value = Vec3> {
    [number(), number(), number()].prop_map(Vec3::from_array)
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(600) })]

    #[test]
    fn any_shape_gives_a_volume_or_an_error(
        positions in prop::collection::vec(vector(), 0..8),
        triangles in prop::collection::vec(prop::array::uniform3(0..8u32), 0..6),
        filling in prop::sample::select(vec![Filling::Flood, Filling::Parity, Filling::None]),
        tiles in any::<bool>(),
        bounds in prop::option::of([vector(), vector()]),
        sides in prop::array::uniform3(0..6u32),
    ) {
        let shape = Shape { positions, triangles, ..Shape::default() };
        let settings = ShapeSettings {
            bounds,
            topology: if tiles { Topology::Tiling } else { Topology::Isolated },
            filling,
            ..ShapeSettings::new(UVec3::from_array(sides.map(|side| 1 << side)))
        };
        if let Ok(built) = from_shape(&shape, &settings, &silent) {
            prop_assert!(built.volume.opaque_voxels() > 0);
            let thickness = built.volume.thickness().narrowest;
            prop_assert!(thickness.min_element() > 0.0, "{}", thickness);
        }
    }

    #[test]
    fn any_heights_give_a_volume_or_an_error(
        heights in prop::collection::vec(number(), 16),
        lengths in vector(),
        tiles in any::<bool>(),
    ) {
        let settings = VolumeSettings {
            lengths,
            topology: if tiles { Topology::Tiling } else { Topology::Isolated },
            ..VolumeSettings::new(UVec3::new(4, 4, 8))
        };
        let field = HeightField::new(UVec2::splat(4), heights, [9; 3]);
        if let Ok(built) = from_height_field(&field, &settings, &silent) {
            prop_assert!(built.volume.opaque_voxels() > 0);
        }
    }
}

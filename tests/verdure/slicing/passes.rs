//! Crowns among other things: opaque, transparent, light and shadow, fog, MSAA, prepasses, several cameras.

use bevy::camera::{Hdr, RenderTarget, Viewport};
use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy_verdure::lab::{Pixels, Studio, mean_flip};
use bevy_verdure::prelude::*;

use super::{CROWN, SIZE, UNLIT, covered, eye, mean, plant, plant_mesh, shot, studio, sun};

/// A pane that faces +z, `size` metres wide and high.
fn pane(studio: &mut Studio, at: Vec3, size: f32, material: StandardMaterial) -> Entity {
    let world = studio.world();
    let mesh = world
        .resource_mut::<Assets<Mesh>>()
        .add(Rectangle::new(size, size));
    let material = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(material);
    world
        .spawn((
            Mesh3d(mesh),
            MeshMaterial3d(material),
            Transform::from_translation(at),
        ))
        .id()
}

fn unlit(color: Color) -> StandardMaterial {
    StandardMaterial {
        base_color: color,
        unlit: true,
        alpha_mode: if color.alpha() < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        },
        ..default()
    }
}

#[test]
fn what_is_opaque_hides_a_crown_from_before_and_shows_through_from_behind() {
    let centroid = CROWN.shape().centroid;
    let front = eye(90.0, 0.0, 16.0);
    let (mut studio, _) = studio(UNLIT);
    let wall = pane(
        &mut studio,
        centroid + Vec3::Z * 6.0,
        30.0,
        unlit(Color::srgb(0.0, 0.0, 1.0)),
    );
    let hidden = studio.photograph(&shot(front), Color::BLACK);
    assert_eq!(covered(&hidden, [0, 0, 255]), 0);
    studio
        .world()
        .entity_mut(wall)
        .insert(Transform::from_translation(centroid - Vec3::Z * 6.0));
    let before_wall = studio.photograph(&shot(front), Color::BLACK);
    studio.world().despawn(wall);
    let before_clear = studio.photograph(&shot(front), Color::srgb(0.0, 0.0, 1.0));
    let flip = mean_flip(
        (SIZE.x, SIZE.y),
        &before_wall.rgb_bytes(),
        &before_clear.rgb_bytes(),
    );
    // The same colour behind, whatever it is.
    assert!(flip < 0.001, "{flip}");
}

#[test]
fn crowns_are_sorted_among_what_is_transparent() {
    let centroid = CROWN.shape().centroid;
    let front = shot(eye(90.0, 0.0, 16.0));
    let (mut studio, _) = studio(UNLIT);
    let alone = studio.photograph(&front, Color::BLACK);
    let glass = |studio: &mut Studio, z: f32| {
        let blue = unlit(Color::srgba(0.0, 0.0, 1.0, 0.5));
        pane(studio, centroid + Vec3::Z * z, 30.0, blue)
    };
    let pane = glass(&mut studio, 8.0);
    let behind_glass = studio.photograph(&front, Color::BLACK);
    studio.world().despawn(pane);
    glass(&mut studio, -8.0);
    let before_glass = studio.photograph(&front, Color::BLACK);
    // Glass in front halves the crown's green; behind it, it leaves what covers it as it is.
    let light = |picture| mean(picture, 1);
    assert!(
        light(&behind_glass) < 0.85 * light(&alone),
        "{} {}",
        light(&behind_glass),
        light(&alone)
    );
    assert!(
        light(&before_glass) > 0.95 * light(&alone),
        "{} {}",
        light(&before_glass),
        light(&alone)
    );
}

#[test]
fn crowns_cast_shadows_and_receive_them() {
    for composition in [Composition::Blended, Composition::Hashed] {
        let settings = CrownSettings {
            composition,
            ..default()
        };
        let (mut studio, crown) = studio(settings);
        sun(&mut studio);
        let floor = {
            let world = studio.world();
            let mesh = world
                .resource_mut::<Assets<Mesh>>()
                .add(Plane3d::default().mesh().size(60.0, 60.0));
            let white = world
                .resource_mut::<Assets<StandardMaterial>>()
                .add(Color::WHITE);
            world.spawn((Mesh3d(mesh), MeshMaterial3d(white))).id()
        };
        let mut down = shot(Vec3::new(0.0, 2.2, 9.0));
        down.at = Vec3::ZERO;
        for _ in 0..3 {
            studio.headless.step();
        }
        let shaded = mean(&studio.photograph(&down, Color::BLACK), 1);
        studio.world().entity_mut(crown).insert(Visibility::Hidden);
        let sunny = mean(&studio.photograph(&down, Color::BLACK), 1);
        // Its shadow is a tenth of the picture.
        assert!(shaded < 0.97 * sunny, "{composition:?}: {shaded} {sunny}");
        // And under a roof it is dark.
        studio
            .world()
            .entity_mut(crown)
            .insert(Visibility::Inherited);
        let look = shot(eye(90.0, 0.0, 16.0));
        studio.world().despawn(floor);
        let lit = mean(&studio.photograph(&look, Color::BLACK), 1);
        let roof = pane(
            &mut studio,
            CROWN.shape().centroid + Vec3::Y * 8.0,
            30.0,
            unlit(Color::BLACK),
        );
        let lying = Transform::from_translation(CROWN.shape().centroid + Vec3::Y * 8.0)
            .with_rotation(Quat::from_rotation_x(-core::f32::consts::FRAC_PI_2));
        studio.world().entity_mut(roof).insert(lying);
        let dark = mean(&studio.photograph(&look, Color::BLACK), 1);
        assert!(dark < 0.5 * lit, "{composition:?}: {dark} {lit}");
    }
}

#[test]
fn a_hashed_crown_covers_as_much_as_a_blended_one_and_writes_every_prepass() {
    let look = shot(eye(20.0, 10.0, 16.0));
    let (mut blended, _) = studio(UNLIT);
    let blended = blended.photograph(&look, Color::WHITE);
    let (mut hashed, _) = studio(CrownSettings {
        composition: Composition::Hashed,
        ..UNLIT
    });
    let plain = hashed.photograph(&look, Color::WHITE);
    // In linear light, blue is what the white behind shows through with. Chance at some 3,000 pixels has a standard
    // deviation of ½/√3000, 1 %, of the crown; lots are drawn for cells a little larger than pixels, up to four to one.
    let cover = |picture: &Pixels| {
        let bytes = picture.rgb_bytes();
        let light = |byte: u8| f64::from(Color::srgb_u8(0, 0, byte).to_linear().blue);
        bytes
            .chunks_exact(3)
            .map(|rgb| 1.0 - light(rgb[2]))
            .sum::<f64>()
    };
    let (one, other) = (cover(&plain), cover(&blended));
    println!("hashed covers {one:.0} pixels, blended {other:.0}");
    assert!((one - other).abs() < 0.06 * other, "{one} {other}");
    let camera = hashed.camera();
    let prepasses = (DepthPrepass, NormalPrepass, MotionVectorPrepass);
    hashed.world().entity_mut(camera).insert(prepasses);
    hashed.headless.step();
    let with_prepass = hashed.photograph(&look, Color::WHITE);
    let same = plain
        .rgb_bytes()
        .iter()
        .zip(with_prepass.rgb_bytes())
        .filter(|(a, b)| **a != *b)
        .count();
    // Both passes draw the same lots for the same places; derivatives may round another way.
    assert!(same * 50 < plain.rgb_bytes().len(), "{same}");
}

#[test]
fn multisampling_hdr_fog_and_two_cameras_draw_the_crown() {
    let look = shot(eye(20.0, 10.0, 16.0));
    let (mut studio, _) = studio(CrownSettings::default());
    sun(&mut studio);
    let plain = studio.photograph(&look, Color::BLACK);
    let camera = studio.camera();
    studio
        .world()
        .entity_mut(camera)
        .insert((Msaa::Sample4, Hdr));
    studio.headless.step();
    let better = studio.photograph(&look, Color::BLACK);
    let flip = mean_flip((SIZE.x, SIZE.y), &plain.rgb_bytes(), &better.rgb_bytes());
    assert!(flip < 0.01, "{flip}");
    let fog = DistanceFog {
        color: Color::srgb(1.0, 0.0, 1.0),
        falloff: FogFalloff::Linear {
            start: 0.0,
            end: 1.0,
        },
        ..default()
    };
    studio.world().entity_mut(camera).insert(fog);
    studio.headless.step();
    let foggy = studio.photograph(&look, Color::BLACK);
    // Red like blue, and no green, wherever there is crown; and nowhere else.
    assert!(mean(&foggy, 1) < 0.1 && mean(&foggy, 0) > 5.0);
    assert!(covered(&foggy, [0, 0, 0]) > 2000);
    // A second camera, from the other side, in the left half of the same picture.
    studio.world().entity_mut(camera).remove::<DistanceFog>();
    let target = studio.headless.target(SIZE, TextureFormat::Rgba8UnormSrgb);
    let half = |x: u32| {
        Some(Viewport {
            physical_position: UVec2::new(x, 0),
            physical_size: UVec2::new(SIZE.x / 2, SIZE.y),
            ..default()
        })
    };
    for (order, from) in [(0, eye(20.0, 10.0, 24.0)), (1, eye(200.0, -5.0, 24.0))] {
        let other = shot(from);
        let camera = (
            Camera3d::default(),
            Camera {
                order,
                viewport: half(order as u32 * SIZE.x / 2),
                clear_color: ClearColorConfig::Custom(Color::BLACK),
                ..default()
            },
            target.clone(),
            Tonemapping::None,
            Msaa::Off,
            other.transform(),
            other.projection(),
        );
        studio.world().spawn(camera);
    }
    studio
        .world()
        .entity_mut(camera)
        .insert(RenderTarget::None { size: UVec2::ONE });
    studio.headless.step();
    let both = studio.headless.capture(&target);
    let side = |from: u32| {
        let all = (0..SIZE.y).flat_map(|y| (from..from + SIZE.x / 2).map(move |x| (x, y)));
        all.filter(|(x, y)| both.rgb(*x, *y) != [0, 0, 0]).count()
    };
    assert!(
        side(0) > 500 && side(SIZE.x / 2) > 500,
        "{} {}",
        side(0),
        side(SIZE.x / 2)
    );
}

#[test]
fn crowns_are_seen_from_everywhere_mirrored_and_from_within() {
    let (mut mesh, crown) = studio(UNLIT);
    mesh.world().despawn(crown);
    plant_mesh(&mut mesh, Transform::IDENTITY, true);
    mesh.headless.step();
    let (mut studio, crown) = studio(UNLIT);
    for elevation in [-90.0, -60.0, -30.0, 0.0, 30.0, 60.0, 90.0] {
        let look = shot(eye(75.0, elevation, 16.0));
        let [seen, triangles] = [&mut studio, &mut mesh]
            .map(|studio| covered(&studio.photograph(&look, Color::WHITE), [255; 3]));
        println!("{elevation}: {seen} pixels touched, by the triangles {triangles}");
        // Pixels of slices spread what they touch by up to their own size.
        assert!(seen >= triangles, "{elevation}: {seen} {triangles}");
        assert!(seen <= 2 * triangles, "{elevation}: {seen} {triangles}");
    }
    let inside = studio.photograph(&shot(eye(75.0, 10.0, 0.5)), Color::WHITE);
    assert!(covered(&inside, [255; 3]) > 3000);
    // A mirror image of the crown, seen mirrored, is the crown.
    let straight = studio.photograph(&shot(eye(75.0, 0.0, 16.0)), Color::WHITE);
    studio
        .world()
        .entity_mut(crown)
        .insert(Transform::from_scale(Vec3::new(-1.0, 1.0, 1.0)));
    let centroid = CROWN.shape().centroid * Vec3::new(-1.0, 1.0, 1.0);
    let mut look = shot(eye(75.0, 0.0, 16.0) * Vec3::new(-1.0, 1.0, 1.0));
    look.at = centroid;
    let mirrored = studio.photograph(&look, Color::WHITE);
    let mut off = 0;
    for y in 0..SIZE.y {
        for x in 0..SIZE.x {
            let (a, b) = (straight.rgb(x, y), mirrored.rgb(SIZE.x - 1 - x, y));
            off += usize::from(a.iter().zip(b).any(|(a, b)| a.abs_diff(b) > 3));
        }
    }
    assert!(off * 200 < (SIZE.x * SIZE.y) as usize, "{off}");
    // Many at once.
    for i in 0..20 {
        plant(
            &mut studio,
            UNLIT,
            Transform::from_xyz(i as f32 * 3.0, 0.0, -5.0),
        );
    }
    studio.headless.step();
    studio.photograph(&shot(eye(60.0, 5.0, 40.0)), Color::WHITE);
}

//! Surfaces that are drawn at once: in what they look like, no other than each drawn by itself.

use std::time::Duration;

use bevy::core_pipeline::prepass::{DepthPrepass, MotionVectorPrepass, NormalPrepass};
use bevy::light::NotShadowCaster;
use bevy::mesh::Indices;
use bevy::prelude::*;
use bevy::render::RenderApp;
use bevy::render::render_resource::{TextureFormat, WgpuLimits};
use bevy::render::settings::WgpuSettings;
use bevy_verdure::lab::{Headless, Lens, Shot, Studio};
use bevy_verdure::prelude::*;
use bevy_verdure::texel::TexelStats;

use crate::recovery::{lose_device, recovering_studio};

use super::passes::{floor, sun};
use super::uploads::stats;
use super::{BACKGROUND, SIZE, Square, is_background, lollies, unlit};

/// Surfaces of a field, in rows.
const COUNT: usize = 12;
const ROW: usize = 4;

/// How far apart they stand.
const SPACING: f32 = 1.6;

/// Bytes of a surface, as its shaders have it.
const SURFACE: usize = 112;

/// Bytes that are written at once.
const BLOCK: usize = 4096;

/// Surfaces of one volume, of which no two have the same mesh or stand alike. Apart, they have looks of their own, which
/// nobody sees.
fn field(studio: &mut Studio, settings: TexelSettings, apart: bool) -> [Entity; COUNT] {
    let world = studio.world();
    let surface = lollies(world, 1.0);
    core::array::from_fn(|i| {
        let mut square = Square {
            heights: [Vec3::Y * (0.7 + 0.03 * i as f32); 4],
            ..Square::default()
        };
        square.heights[i % 4].x += 0.1;
        let mesh = world.resource_mut::<Assets<Mesh>>().add(square.mesh());
        let (column, row) = ((i % ROW) as f32, (i / ROW) as f32);
        let place = Transform::from_xyz(SPACING * column, 0.0, -SPACING * row)
            .with_rotation(Quat::from_rotation_y(0.2 * i as f32))
            .with_scale(Vec3::splat(0.8 + 0.02 * i as f32));
        let settings = TexelSettings {
            roughness: settings.roughness + if apart { 0.01 * i as f32 } else { 0.0 },
            ..settings
        };
        world
            .spawn((Mesh3d(mesh), surface.clone(), settings, place))
            .id()
    })
}

/// The field drawn at once, and each surface by itself.
fn fields(settings: TexelSettings) -> [(Studio, [Entity; COUNT]); 2] {
    [false, true].map(|apart| {
        let mut studio = Studio::default();
        let surfaces = field(&mut studio, settings, apart);
        (studio, surfaces)
    })
}

/// All of the field.
fn overview() -> Shot {
    Shot {
        eye: Vec3::new(2.0, 4.0, 4.5),
        at: Vec3::new(2.6, 0.3, -1.6),
        lens: Lens::Perspective(0.9),
        size: SIZE,
    }
}

fn picture(studio: &mut Studio, shot: &Shot) -> Vec<u8> {
    studio.headless.step();
    studio.photograph(shot, BACKGROUND).rgb_bytes()
}

fn covered(picture: &[u8]) -> usize {
    let pixels = picture.chunks_exact(3);
    let colors = pixels.map(|pixel| [pixel[0], pixel[1], pixel[2]]);
    colors.filter(|&color| !is_background(color)).count()
}

/// Fails where more than a few pixels differ, of slices of two surfaces that are at the very same depth.
#[track_caller]
fn assert_alike(a: &[u8], b: &[u8]) {
    let pixels = a.chunks_exact(3).zip(b.chunks_exact(3));
    let differ = pixels.filter(|(a, b)| a != b).count();
    assert!(differ < 5, "{differ} pixels differ");
}

#[test]
fn surfaces_of_one_volume_are_drawn_at_once_and_look_as_if_each_were_by_itself() {
    let [(mut grouped, _), (mut apart, _)] = fields(unlit());
    let pictures = [&mut grouped, &mut apart].map(|studio| picture(studio, &overview()));
    assert!(covered(&pictures[0]) > 300);
    assert_alike(&pictures[0], &pictures[1]);
    let [together, alone] = [&mut grouped, &mut apart].map(stats);
    println!("{} draws instead of {}", together.draws, alone.draws);
    assert_eq!(together.slices, alone.slices);
    assert!((1..=3).contains(&together.draws), "no more than one's axes");
    assert!(alone.draws >= COUNT);
}

#[test]
fn what_stands_still_is_neither_listed_nor_written() {
    let mut studio = Studio::default();
    let surfaces = field(&mut studio, unlit(), false);
    let before = picture(&mut studio, &overview());
    let still = |studio: &mut Studio| {
        let TexelStats {
            listed, list_bytes, ..
        } = stats(studio);
        (listed, list_bytes)
    };
    assert_eq!(still(&mut studio), (0, 0));
    let slices = stats(&mut studio).slices;
    assert!(slices > 0);
    assert_eq!(before, picture(&mut studio, &overview()));
    let turn = |studio: &mut Studio, angle| {
        let mut place = studio.world().get_mut::<Transform>(surfaces[5]).unwrap();
        place.rotate_y(angle);
        stats(studio)
    };
    let turned = turn(&mut studio, 0.5);
    assert_eq!(turned.listed, 1, "in one view");
    assert!(turned.list_bytes > COUNT * SURFACE);
    // Where it was in the frame before has changed.
    assert_eq!(still(&mut studio), (0, COUNT * SURFACE));
    assert_eq!(still(&mut studio), (0, 0));
    assert!(before != picture(&mut studio, &overview()));
    turn(&mut studio, -0.5);
    assert_alike(&before, &picture(&mut studio, &overview()));
    // The eye moves, and so does one in the wind.
    let camera = studio.camera();
    studio
        .world()
        .get_mut::<Transform>(camera)
        .unwrap()
        .translation
        .y += 0.1;
    assert_eq!(stats(&mut studio).listed, COUNT);
    assert_eq!(still(&mut studio), (0, 0));
    let reed = TexelSettings {
        flexibility: 0.03,
        ..unlit()
    };
    let world = studio.world();
    world.entity_mut(surfaces[2]).insert(reed);
    world.insert_resource(Wind::new(Vec3::X * 3.0));
    stats(&mut studio);
    assert_eq!(stats(&mut studio).listed, 1);
    studio.world().insert_resource(Wind::default());
    stats(&mut studio);
    assert_eq!(still(&mut studio), (0, 0));
}

#[test]
fn surfaces_out_of_view_take_none_of_their_group_with_them() {
    let [(mut grouped, _), (mut apart, _)] = fields(unlit());
    // From among them, so that some are behind the eye whichever way it looks.
    let eye = Vec3::new(2.0, 1.4, -1.4);
    for aside in [Vec3::X, Vec3::NEG_X, Vec3::Z, Vec3::NEG_Z] {
        let shot = Shot {
            eye,
            at: eye + aside + Vec3::NEG_Y * 0.5,
            lens: Lens::Perspective(0.9),
            size: SIZE,
        };
        let pictures = [&mut grouped, &mut apart].map(|studio| picture(studio, &shot));
        assert!(covered(&pictures[0]) > 300, "{aside}");
        assert_alike(&pictures[0], &pictures[1]);
    }
}

#[test]
fn the_others_of_a_group_stay_when_some_go() {
    let [mut grouped, mut apart] = fields(unlit());
    let mut seen = Vec::new();
    let gone: [&[usize]; 3] = [&[0], &[11, 4], &[1, 2, 3, 5]];
    for gone in gone {
        let pictures = [&mut grouped, &mut apart].map(|(studio, surfaces)| {
            for &i in gone {
                studio.world().despawn(surfaces[i]);
            }
            picture(studio, &overview())
        });
        assert_alike(&pictures[0], &pictures[1]);
        seen.push(covered(&pictures[0]));
    }
    assert!(seen[0] > seen[1] && seen[1] > seen[2] && seen[2] > 0);
    // What comes takes the room of what went.
    let pictures = [(&mut grouped.0, false), (&mut apart.0, true)].map(|(studio, is_apart)| {
        field(studio, unlit(), is_apart);
        picture(studio, &overview())
    });
    assert!(covered(&pictures[0]) > seen[0]);
    let [(mut fresh, _), _] = fields(unlit());
    assert_alike(&pictures[1], &pictures[0]);
    assert_alike(&picture(&mut fresh, &overview()), &pictures[0]);
}

#[test]
fn groups_cast_shadows_and_are_in_prepasses_as_single_surfaces_are() {
    let [mut grouped, mut apart] = fields(TexelSettings::default());
    let all = [&mut grouped, &mut apart];
    let pictures = all.map(|(studio, surfaces)| {
        sun(studio);
        floor(studio);
        let whole = picture(studio, &overview());
        // One that casts none is no part of what the light sees.
        let one = surfaces[6];
        studio.world().entity_mut(one).insert(NotShadowCaster);
        let fewer = picture(studio, &overview());
        let camera = studio.camera();
        studio.world().entity_mut(camera).insert((
            DepthPrepass,
            NormalPrepass,
            MotionVectorPrepass,
        ));
        [whole, fewer, picture(studio, &overview())]
    });
    let [together, alone] = pictures;
    for (a, b) in together.iter().zip(&alone) {
        assert_alike(a, b);
    }
    let [whole, fewer, with_prepass] = together;
    assert!(whole != fewer);
    assert_alike(&fewer, &with_prepass);
    let draws = stats(&mut grouped.0).draws;
    assert!((2..=6).contains(&draws), "an eye and a sun: {draws}");
}

#[test]
fn groups_come_back_after_their_device_is_lost() {
    let mut studio = recovering_studio();
    field(&mut studio, unlit(), false);
    let before = picture(&mut studio, &overview());
    assert!(covered(&before) > 300);
    lose_device(&mut studio);
    assert_alike(&before, &picture(&mut studio, &overview()));
}

#[test]
fn only_slices_that_change_are_written() {
    let [_, (mut studio, surfaces)] = fields(unlit());
    picture(&mut studio, &overview());
    assert_eq!(stats(&mut studio).list_bytes, 0);
    let mut place = studio
        .world()
        .get_mut::<Transform>(surfaces[5])
        .expect("it has one");
    place.rotate_y(0.5);
    let turned = stats(&mut studio);
    // Its slices across three axes, one block each, and where surfaces are; not those of the other groups.
    let most = 3 * BLOCK + COUNT * SURFACE;
    assert!(turned.list_bytes <= most, "{turned:?}");
    assert!(turned.list_bytes < turned.slices * 32, "{turned:?}");
    let drawn = picture(&mut studio, &overview());
    let [_, (mut fresh, surfaces)] = fields(unlit());
    let mut place = fresh
        .world()
        .get_mut::<Transform>(surfaces[5])
        .expect("it has one");
    place.rotate_y(0.5);
    assert_alike(&drawn, &picture(&mut fresh, &overview()));
}

/// A lawn of so many squares along each side.
fn lawn(side: u32) -> Mesh {
    Plane3d::default().mesh().subdivisions(side - 1).build()
}

#[test]
fn large_surfaces_are_listed_in_parts_that_are_one() {
    let mesh = lawn(70);
    let Some(Indices::U32(all)) = mesh.indices() else {
        panic!("a plane has indices of 32 bits");
    };
    let (first, second) = all.split_at(all.len() / 2);
    let halves = [first, second].map(|half| {
        let half = Indices::U32(half.to_vec());
        mesh.clone().with_inserted_indices(half)
    });
    let shot = Shot {
        eye: Vec3::new(0.8, 1.1, 0.9),
        at: Vec3::ZERO,
        lens: Lens::Perspective(0.9),
        size: SIZE,
    };
    let [whole, split] = [vec![mesh.clone()], halves.to_vec()].map(|meshes| {
        let mut studio = Studio::default();
        let world = studio.world();
        let surface = lollies(world, 0.3);
        let mut surfaces = Vec::new();
        for mesh in meshes {
            let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh);
            let surface = (Mesh3d(mesh), surface.clone(), unlit());
            surfaces.push(world.spawn(surface).id());
        }
        let seen = picture(&mut studio, &shot);
        for surface in surfaces {
            let mut place = studio.world().get_mut::<Transform>(surface).unwrap();
            place.rotate_y(1.0);
        }
        (seen, stats(&mut studio))
    });
    assert_eq!((whole.1.listed, split.1.listed), (2, 2));
    assert_eq!(whole.1.slices, split.1.slices);
    assert!(covered(&whole.0) > 300);
    assert_alike(&whole.0, &split.0);
}

/// Lawns side by side, on a device whose buffers hold so many bytes: what they look like, and their stats.
fn lawns(bytes: u64) -> (Vec<u8>, TexelStats) {
    let settings = WgpuSettings {
        constrained_limits: Some(WgpuLimits {
            max_storage_buffer_binding_size: bytes,
            ..WgpuLimits::default()
        }),
        ..default()
    };
    let mut headless = Headless::with_settings(Duration::from_millis(16), settings, |app| {
        app.add_plugins(VerdurePlugin);
    });
    let target = headless.target(SIZE, TextureFormat::Rgba8UnormSrgb);
    let world = headless.world();
    let surface = lollies(world, 0.3);
    let mesh = lawn(50);
    for x in [-1.2, 0.0, 1.2] {
        // No two share their facets.
        let mesh = world.resource_mut::<Assets<Mesh>>().add(mesh.clone());
        let place = Transform::from_xyz(x, 0.0, 0.0);
        world.spawn((Mesh3d(mesh), surface.clone(), unlit(), place));
    }
    world.spawn((
        Camera3d::default(),
        Camera {
            clear_color: ClearColorConfig::Custom(BACKGROUND),
            ..default()
        },
        Msaa::Off,
        target.clone(),
        Transform::from_xyz(0.5, 2.0, 3.0).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    for _ in 0..4 {
        headless.step();
    }
    let picture = headless.capture(&target).rgb_bytes();
    let render = headless.app().sub_app(RenderApp).world();
    (picture, *render.resource::<TexelStats>())
}

#[test]
fn facets_that_one_buffer_does_not_hold_are_in_the_next() {
    let (expected, one) = lawns(1 << 27);
    // 7,281 facets, of which a lawn has 5,000.
    let (seen, three) = lawns(1 << 20);
    assert!(covered(&expected) > 300);
    assert_alike(&expected, &seen);
    assert_eq!(one.slices, three.slices);
    assert!(one.draws <= 3 && three.draws >= 3, "{one:?} {three:?}");
}

//! Volumes and meshes that are edited, taken away and put back while a surface shows them, and surfaces that go.

use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;
use bevy_verdure::texel::{TexelMaterial, TexelSlices};

use super::turns::ball;
use super::{BACKGROUND, LOLLY, Square, cover_default, shot, unlit};

fn lolly() -> TexelVolume {
    LOLLY.clone().into()
}

/// The default square, covered with a volume.
fn covered_with(volume: TexelVolume) -> (Studio, Entity, Handle<TexelVolume>) {
    let mut studio = Studio::default();
    let surface = cover_default(&mut studio, unlit());
    let world = studio.world();
    let volume = world.resource_mut::<Assets<TexelVolume>>().add(volume);
    let texels = TexelSurface {
        volume: volume.clone(),
        thickness: 1.0,
    };
    world.entity_mut(surface).insert(texels);
    (studio, surface, volume)
}

/// What is seen once edits have been told of, which is in the second frame.
fn seen(studio: &mut Studio) -> Vec<u8> {
    studio.headless.step();
    let look = shot(Vec3::new(1.9, 2.3, 1.2));
    studio.photograph(&look, BACKGROUND).rgb_bytes()
}

/// What is seen of a volume that has always been as it is.
fn fresh(volume: TexelVolume) -> Vec<u8> {
    let (mut studio, ..) = covered_with(volume);
    seen(&mut studio)
}

fn edit(studio: &mut Studio, edit: impl FnOnce(&mut Assets<TexelVolume>)) {
    edit(&mut studio.world().resource_mut::<Assets<TexelVolume>>());
}

#[test]
fn an_edited_volume_is_seen_as_if_it_had_always_been_so() {
    let expected = fresh(ball());
    let (mut studio, _, volume) = covered_with(lolly());
    let before = seen(&mut studio);
    assert!(before != expected);
    // Another size, other places, another colour.
    edit(&mut studio, |volumes| {
        *volumes.get_mut(&volume).expect("it is there") = ball();
    });
    assert!(seen(&mut studio) == expected, "written to");
    edit(&mut studio, |volumes| {
        let replaced = volumes.insert(&volume, lolly());
        replaced.expect("its handle is in use");
    });
    assert!(seen(&mut studio) == before, "replaced");
}

#[test]
fn a_volume_that_is_taken_away_stays_on_screen_until_another_is_in_its_place() {
    let expected = fresh(ball());
    let (mut studio, _, volume) = covered_with(lolly());
    let before = seen(&mut studio);
    let take_away = |volumes: &mut Assets<TexelVolume>| {
        assert!(volumes.remove(&volume).is_some());
    };
    let put_back = |volumes: &mut Assets<TexelVolume>, other: TexelVolume| {
        let replaced = volumes.insert(&volume, other);
        replaced.expect("its handle is in use");
    };
    edit(&mut studio, take_away);
    assert!(seen(&mut studio) == before, "taken away");
    edit(&mut studio, |volumes| put_back(volumes, ball()));
    assert!(seen(&mut studio) == expected, "another in its place");
    // What was there for no frame was never good.
    edit(&mut studio, |volumes| {
        *volumes.get_mut(&volume).expect("it is there") = lolly();
        take_away(volumes);
    });
    assert!(seen(&mut studio) == expected, "edited and taken away");
    edit(&mut studio, |volumes| put_back(volumes, lolly()));
    assert!(seen(&mut studio) == before, "back again");
    edit(&mut studio, |volumes| {
        take_away(volumes);
        put_back(volumes, ball());
    });
    assert!(seen(&mut studio) == expected, "exchanged in one frame");
}

#[test]
fn a_mesh_that_is_taken_away_stays_on_screen_until_another_is_in_its_place() {
    let other = || {
        let heights = [Vec3::new(0.2, 0.6, 0.0); 4];
        let square = Square {
            heights,
            ..Square::default()
        };
        square.mesh()
    };
    let mesh_of = |studio: &mut Studio, surface| {
        let mesh = studio.world().get::<Mesh3d>(surface);
        mesh.expect("surfaces have meshes").0.clone()
    };
    let (mut fresh, surface, _) = covered_with(lolly());
    let mesh = fresh.world().resource_mut::<Assets<Mesh>>().add(other());
    fresh.world().entity_mut(surface).insert(Mesh3d(mesh));
    let expected = seen(&mut fresh);

    let (mut studio, surface, _) = covered_with(lolly());
    let before = seen(&mut studio);
    assert!(before != expected);
    let mesh = mesh_of(&mut studio, surface);
    let taken = studio.world().resource_mut::<Assets<Mesh>>().remove(&mesh);
    assert!(seen(&mut studio) == before, "taken away");
    for (put_back, expected) in [(Some(other()), expected), (taken, before)] {
        let mut meshes = studio.world().resource_mut::<Assets<Mesh>>();
        meshes.remove(&mesh);
        let replaced = meshes.insert(&mesh, put_back.expect("it was there"));
        replaced.expect("its handle is in use");
        assert!(seen(&mut studio) == expected, "put back");
    }
}

#[test]
fn a_surface_that_is_given_a_volume_still_loading_keeps_what_it_shows_until_it_is_there() {
    let expected = fresh(ball());
    let (mut studio, surface, volume) = covered_with(lolly());
    let before = seen(&mut studio);
    let world = studio.world();
    let loading = world.resource::<Assets<TexelVolume>>().reserve_handle();
    let texels = TexelSurface {
        volume: loading.clone(),
        thickness: 1.0,
    };
    world.entity_mut(surface).insert(texels);
    let old = volume.id();
    drop(volume);
    assert!(seen(&mut studio) == before);
    let volumes = studio.world().resource::<Assets<TexelVolume>>();
    assert!(!volumes.contains(old), "nothing holds the old one any more");
    edit(&mut studio, |volumes| {
        let loaded = volumes.insert(&loading, ball());
        loaded.expect("its handle is in use");
    });
    assert!(seen(&mut studio) == expected);
}

#[test]
fn nothing_is_left_of_surfaces_that_are_despawned() {
    let (mut studio, surface, _) = covered_with(lolly());
    let alone = seen(&mut studio);
    let slices = |studio: &mut Studio| {
        let world = studio.world();
        world.query::<&TexelSlices>().iter(world).count()
    };
    let of_one = slices(&mut studio);
    // It shares the mesh, the volume and the materials.
    let world = studio.world();
    let mesh = world.get::<Mesh3d>(surface).expect("a mesh").clone();
    let texels = world.get::<TexelSurface>(surface).expect("texels").clone();
    let aside = Transform::from_xyz(0.3, 0.1, -0.2);
    let other = world.spawn((mesh, texels, unlit(), aside)).id();
    assert!(seen(&mut studio) != alone);
    studio.world().despawn(other);
    assert!(seen(&mut studio) == alone, "the other one stays");
    assert_eq!(slices(&mut studio), of_one);
    studio.world().despawn(surface);
    let empty = seen(&mut studio);
    assert!(empty.chunks_exact(3).all(|color| color == [0, 0, 255]));
    assert_eq!(slices(&mut studio), 0);
    let materials = studio.world().resource::<Assets<TexelMaterial>>();
    assert_eq!(materials.len(), 0, "what no surface uses is forgotten");
}

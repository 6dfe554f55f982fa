//! Crowns on screen whose files change for better or worse, or whose slicing is taken away.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bevy::asset::LoadState;
use bevy::asset::io::embedded::EmbeddedAssetRegistry;
use bevy::prelude::*;
use bevy_verdure::lab::Studio;
use bevy_verdure::prelude::*;
use image::DynamicImage;

use super::files::{png, saved};
use super::{CROWN, SMALL, UNLIT, eye, shot, studio};

/// A crown's text, among the files that an app holds in memory.
const TEXT: &str = "crown.slicing.ron";
/// Where the asset server finds it.
const PATH: &str = "embedded://crowns/crown.slicing.ron";

/// Puts a file where the asset server looks for it, or takes it away.
fn put(studio: &mut Studio, name: &str, bytes: Option<Vec<u8>>) {
    let registry = studio.world().resource::<EmbeddedAssetRegistry>();
    let path = Path::new("crowns").join(name);
    match bytes {
        Some(bytes) => registry.insert_asset(PathBuf::new(), &path, bytes),
        None => assert!(registry.remove_asset(&path).is_some(), "{name}"),
    }
}

/// Puts the files of a slicing there, the text last, and gives back the text. The pictures' names begin with a stem that is
/// theirs alone: who still reads an older version meets no picture of this one.
fn put_all(studio: &mut Studio, slicing: &Slicing, stem: &str) -> String {
    let mut files = saved(slicing, stem);
    let text = files
        .remove(&format!("{stem}.slicing.ron"))
        .expect("a slicing has a text");
    for (name, bytes) in files {
        put(studio, &name, Some(bytes));
    }
    put(studio, TEXT, Some(text.clone()));
    String::from_utf8(text).expect("the text is UTF-8")
}

/// Steps until something is so. What is waited for is a change, not a speed.
fn wait(studio: &mut Studio, mut is_so: impl FnMut(&mut World) -> bool) {
    let started = Instant::now();
    while !is_so(studio.world()) {
        assert!(started.elapsed() < Duration::from_secs(60));
        studio.headless.step();
    }
}

fn picture(studio: &mut Studio) -> Vec<u8> {
    // Changes of assets are seen in the frame after.
    for _ in 0..2 {
        studio.headless.step();
    }
    let look = shot(eye(75.0, 10.0, 16.0));
    studio.photograph(&look, Color::BLACK).rgb_bytes()
}

#[test]
fn the_last_good_version_of_a_file_stays_on_screen_until_there_is_a_better_one() {
    let versions: [&Slicing; 2] = [&CROWN, &SMALL];
    let (mut studio, crown) = studio(UNLIT);
    // On one entity all along, so that nothing but the slicing differs.
    let show = |studio: &mut Studio, slicing: Handle<Slicing>| {
        let mut crown = studio.world().entity_mut(crown);
        crown.insert(SlicedCrown(slicing));
    };
    let fresh = versions.map(|version| {
        let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
        let slicing = slicings.add(version.clone());
        show(&mut studio, slicing);
        picture(&mut studio)
    });
    assert!(fresh[0] != fresh[1]);
    let mut text = put_all(&mut studio, versions[0], "crown0");
    let server = studio.world().resource::<AssetServer>().clone();
    let handle: Handle<Slicing> = server.load(PATH);
    show(&mut studio, handle.clone());
    let wait_for = |studio: &mut Studio, version: &Slicing| {
        wait(studio, |world| {
            world.resource::<Assets<Slicing>>().get(&handle) == Some(version)
        });
    };
    wait_for(&mut studio, versions[0]);
    assert!(picture(&mut studio) == fresh[0]);
    for fault in 0..4 {
        let color = format!("crown{fault}.0.color.png");
        let (name, bytes) = match fault {
            0 => {
                let wrong = text.replacen("pixels: ", "pixels: 1", 1);
                (TEXT.to_string(), Some(wrong.into_bytes()))
            }
            1 => (color, None),
            2 => (color, Some(vec![137, 80, 78])),
            _ => (color, Some(png(&DynamicImage::new_rgba8(8, 8)))),
        };
        put(&mut studio, &name, bytes);
        server.reload(PATH);
        // After a reload that fails the server tries once more, and is loading again meanwhile; an error may also be that
        // of the fault before.
        wait(&mut studio, |_| {
            let state = server.load_state(&handle);
            matches!(state, LoadState::Failed(error) if error.to_string().contains(&name))
        });
        assert!(picture(&mut studio) == fresh[fault % 2], "fault {fault}");
        let next = (fault + 1) % 2;
        text = put_all(&mut studio, versions[next], &format!("crown{}", fault + 1));
        server.reload(PATH);
        wait_for(&mut studio, versions[next]);
        assert!(picture(&mut studio) == fresh[next], "after fault {fault}");
    }
}

#[test]
fn a_crown_whose_slicing_is_taken_away_stays_as_it_was_until_another_is_in_its_place() {
    let (mut studio, crown) = studio(UNLIT);
    let before = picture(&mut studio);
    assert!(before.iter().any(|byte| *byte > 0));
    let slicing = studio.world().get::<SlicedCrown>(crown);
    let slicing = slicing.expect("a crown").0.clone();
    let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
    assert!(slicings.remove(&slicing).is_some());
    assert!(picture(&mut studio) == before);
    let mut slicings = studio.world().resource_mut::<Assets<Slicing>>();
    slicings
        .insert(&slicing, SMALL.clone())
        .expect("the handle is alive");
    let (mut fresh, crown) = self::studio(UNLIT);
    let small = fresh
        .world()
        .resource_mut::<Assets<Slicing>>()
        .add(SMALL.clone());
    fresh.world().entity_mut(crown).insert(SlicedCrown(small));
    fresh.headless.step();
    studio.headless.step();
    assert!(picture(&mut studio) == picture(&mut fresh));
}

//! Slicings from files, right and wrong.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use bevy::asset::{AssetPlugin, LoadState};
use bevy::prelude::*;
use bevy_verdure::lab::save_slicing;
use bevy_verdure::prelude::*;
use bevy_verdure::slicing::SlicingLoader;
use image::{DynamicImage, ImageFormat};

use super::CROWN;

/// A folder of this test's own, emptied.
pub fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("slicing_{name}"));
    // It may not be there yet.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder for the test");
    folder
}

/// The files that a slicing is saved in, by their names, which begin with a stem.
pub fn saved(slicing: &Slicing, stem: &str) -> BTreeMap<String, Vec<u8>> {
    let folder = folder(&format!("{stem}_{}", std::process::id()));
    let report = save_slicing(slicing, &folder, stem).expect("the folder can be written to");
    let files = report.files.iter().map(|path| {
        let name = path.file_name().expect("a file has a name");
        let bytes = std::fs::read(path).expect("what was written can be read");
        (name.to_string_lossy().into_owned(), bytes)
    });
    let files = files.collect();
    std::fs::remove_dir_all(&folder).expect("the folder can be removed");
    files
}

/// The bytes of a picture's file.
pub fn png(picture: &DynamicImage) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let written = picture.write_to(&mut bytes, ImageFormat::Png);
    written.expect("a picture can be written to memory");
    bytes.into_inner()
}

fn edit(path: &Path, old: &str, new: &str) {
    let text = std::fs::read_to_string(path).expect("the slicing's text");
    assert!(text.contains(old), "{old}");
    std::fs::write(path, text.replacen(old, new, 1)).expect("the slicing's text can be changed");
}

#[test]
fn what_is_saved_is_read_back_pixel_by_pixel() {
    let folder = folder("saved");
    let report = save_slicing(&CROWN, &folder, "crown").expect("the folder can be written to");
    assert_eq!(report.files.len(), 1 + 2 * CROWN.shape().orientations.len());
    let size: u64 = report
        .files
        .iter()
        .map(|file| file.metadata().map_or(0, |data| data.len()))
        .sum();
    assert_eq!(size, report.bytes);
    assert_eq!(
        Slicing::read(&folder.join("crown.slicing.ron")).as_ref(),
        Ok(&*CROWN)
    );
}

#[test]
fn wrong_files_are_refused_with_the_file_and_the_fix() {
    let folder = folder("wrong");
    let path = folder.join("crown.slicing.ron");
    let refusal = |spoil: &dyn Fn()| {
        save_slicing(&CROWN, &folder, "crown").expect("the folder can be written to");
        spoil();
        Slicing::read(&path).unwrap_err().to_string()
    };
    let missing = refusal(&|| {
        std::fs::remove_file(folder.join("crown.2.normal.png")).expect("the picture is there");
    });
    assert!(
        missing.contains("crown.2.normal.png: cannot be read"),
        "{missing}"
    );
    let other = refusal(&|| {
        std::fs::copy(
            "assets/plants/stone_color.png",
            folder.join("crown.1.color.png"),
        )
        .expect("a picture");
    });
    assert!(
        other.contains("crown.1.color.png: is ") && other.contains("bake it anew"),
        "{other}"
    );
    let cut = refusal(&|| {
        let file = folder.join("crown.1.color.png");
        let bytes = std::fs::read(&file).expect("the picture");
        std::fs::write(&file, &bytes[..bytes.len() / 2]).expect("the picture can be changed");
    });
    assert!(cut.contains("crown.1.color.png: is no picture"), "{cut}");
    for (old, new, what) in [
        (
            "pixels: 64",
            "pixels: 32",
            "crown.0.color.png: is 64 × 576 pixels",
        ),
        ("        5,\n", "        0,\n", "the number of slices is 0"),
        (
            "        5,\n",
            "        1000000,\n",
            "the number of slices is 1000000",
        ),
        ("radius:", "girth:", "girth"),
    ] {
        let message = refusal(&|| edit(&path, old, new));
        assert!(message.contains(what), "{message}");
    }
    std::fs::remove_file(&path).expect("the slicing's text is there");
    let gone = Slicing::read(&path).unwrap_err().to_string();
    assert!(gone.contains("crown.slicing.ron: cannot be read"), "{gone}");
}

#[test]
fn the_asset_server_loads_a_crown_and_a_bad_reload_keeps_the_last_good_one() {
    let picture = "crown.0.color.png";
    type Break = fn(&Path);
    let faults: [(Break, &str); 4] = [
        (
            |folder| {
                edit(
                    &folder.join("crown.slicing.ron"),
                    "pixels: 64",
                    "pixels: 63",
                )
            },
            "crown.slicing.ron: pixels is 63",
        ),
        (
            |folder| std::fs::remove_file(folder.join("crown.0.color.png")).unwrap(),
            picture,
        ),
        (
            |folder| std::fs::write(folder.join("crown.0.color.png"), [137, 80, 78]).unwrap(),
            picture,
        ),
        (
            |folder| {
                let other = folder.join("crown.0.color.png");
                image::RgbaImage::new(8, 8).save(other).unwrap();
            },
            picture,
        ),
    ];
    for (number, (fault, what)) in faults.into_iter().enumerate() {
        let error = reloaded_with(&folder(&format!("served{number}")), fault);
        assert!(error.contains(what), "{error}");
    }
}

/// Why a crown that was loaded from a folder cannot be loaded again once something there is broken. The loaded one stays.
fn reloaded_with(folder: &Path, fault: fn(&Path)) -> String {
    save_slicing(&CROWN, folder, "crown").expect("the folder can be written to");
    let mut app = App::new();
    app.add_plugins((
        MinimalPlugins,
        AssetPlugin {
            file_path: folder.to_string_lossy().into_owned(),
            ..default()
        },
    ))
    .init_asset::<Slicing>()
    .register_asset_loader(SlicingLoader);
    let server = app.world().resource::<AssetServer>().clone();
    let handle: Handle<Slicing> = server.load("crown.slicing.ron");
    // What is waited for is a change, not a speed. The state is given as it was seen: after a reload that fails the
    // server tries once more without the asset's type, and is loading again meanwhile.
    let wait = |app: &mut App, until: fn(&LoadState) -> bool| {
        let started = Instant::now();
        loop {
            let state = server.load_state(&handle);
            if until(&state) {
                app.update();
                return state;
            }
            assert!(started.elapsed() < Duration::from_secs(60), "{state:?}");
            app.update();
            std::thread::sleep(Duration::from_millis(2));
        }
    };
    wait(&mut app, LoadState::is_loaded);
    let is_crown =
        |app: &App| app.world().resource::<Assets<Slicing>>().get(&handle) == Some(&*CROWN);
    assert!(is_crown(&app));
    fault(folder);
    server.reload("crown.slicing.ron");
    let LoadState::Failed(error) = wait(&mut app, LoadState::is_failed) else {
        unreachable!("it was waited for");
    };
    assert!(is_crown(&app));
    error.to_string()
}

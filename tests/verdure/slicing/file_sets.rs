//! Sets of files spoiled by chance: each loads as a slicing that is what its files say, or fails with an error that names
//! the file.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

use bevy::asset::io::memory::{Dir, MemoryAssetReader};
use bevy::asset::io::{AssetReaderError, AssetSourceBuilder, AssetSourceId};
use bevy::asset::{AssetLoadError, AssetPath, LoadState};
use bevy::prelude::{
    App, AssetApp, AssetPlugin, AssetServer, Assets, Handle, MinimalPlugins, default,
};
use bevy_verdure::slicing::{Slicing, SlicingDocument, SlicingFileError, SlicingLoader};
use image::{DynamicImage, ImageFormat};
use proptest::prelude::*;
use proptest::sample::{Index, select};

use super::SMALL;
use super::files::{png, saved};

/// Files by name.
type Files = BTreeMap<String, Vec<u8>>;

/// A set that is right.
static FILES: LazyLock<Files> = LazyLock::new(|| saved(&SMALL, "elm"));
/// The file of it that is no picture.
const TEXT: &str = "elm.slicing.ron";
/// Where that is: in a folder, so that pictures are seen to be looked for beside it.
const PATH: &str = "crowns/elm.slicing.ron";

/// Loads a slicing as a game does.
fn load(files: &Files) -> Result<Slicing, Arc<AssetLoadError>> {
    let root = Dir::default();
    for (name, bytes) in files {
        root.insert_asset(&Path::new("crowns").join(name), bytes.clone());
    }
    let mut app = App::new();
    app.register_asset_source(
        AssetSourceId::Default,
        AssetSourceBuilder::new(move || Box::new(MemoryAssetReader { root: root.clone() })),
    )
    .add_plugins((
        MinimalPlugins,
        AssetPlugin {
            watch_for_changes_override: Some(false),
            ..default()
        },
    ))
    .init_asset::<Slicing>()
    .register_asset_loader(SlicingLoader);
    let server = app.world().resource::<AssetServer>().clone();
    let handle: Handle<Slicing> = server.load(PATH);
    let started = Instant::now();
    loop {
        app.update();
        match server.load_state(&handle) {
            LoadState::Loaded => {
                let slicings = app.world().resource::<Assets<Slicing>>();
                return Ok(slicings.get(&handle).expect("it is loaded").clone());
            }
            LoadState::Failed(error) => return Err(error),
            state => assert!(started.elapsed() < Duration::from_secs(60), "{state:?}"),
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// What is wrong with a file.
#[derive(Clone, Debug)]
enum Fault {
    /// It is not there.
    Missing,
    /// It ends early.
    Cut(Index),
    /// Some bits of a byte are others.
    Flipped(Index, u8),
    /// It holds anything.
    Junk(Vec<u8>),
    /// A picture is black, and of another size.
    Resized(u32, u32),
    /// The pixels of a picture are kept in another way.
    Recoded(usize),
    /// A number of the text is another.
    Number(Index, String),
    /// A name in the text is another.
    Name(Index, String),
    /// Some lines of the text are gone, or there twice.
    Lines {
        at: Index,
        count: usize,
        are_twice: bool,
    },
}

impl Fault {
    /// Spoils a file of a set, if it is still there.
    fn spoil(&self, name: &str, files: &mut Files) {
        let Some(bytes) = files.get_mut(name) else {
            return;
        };
        match self {
            Self::Missing => {
                files.remove(name);
            }
            Self::Cut(at) => bytes.truncate(at.index(bytes.len().max(1))),
            Self::Flipped(at, bits) => {
                if !bytes.is_empty() {
                    let at = at.index(bytes.len());
                    bytes[at] ^= *bits;
                }
            }
            Self::Junk(junk) => bytes.clone_from(junk),
            Self::Resized(width, height) => {
                *bytes = png(&DynamicImage::new_rgba8(*width, *height));
            }
            Self::Recoded(format) => *bytes = png(&recoded(&decoded(&FILES[name]), *format)),
            Self::Number(at, new) => {
                let is_number = |word: &str| word.parse::<f64>().is_ok();
                edit(bytes, |text| swapped(text, is_number, *at, new));
            }
            Self::Name(at, new) => {
                let is_name = |word: &str| word.starts_with('"');
                edit(bytes, |text| swapped(text, is_name, *at, new));
            }
            Self::Lines {
                at,
                count,
                are_twice,
            } => edit(bytes, |text| {
                let mut lines: Vec<&str> = text.lines().collect();
                let start = at.index(lines.len().max(1));
                let end = (start + count).min(lines.len());
                if *are_twice {
                    let run = lines[start..end].to_vec();
                    lines.splice(end..end, run);
                } else {
                    lines.drain(start..end);
                }
                lines.join("\n")
            }),
        }
    }
}

fn edit(bytes: &mut Vec<u8>, change: impl FnOnce(&str) -> String) {
    let changed = change(&String::from_utf8_lossy(bytes));
    *bytes = changed.into_bytes();
}

/// Where the words of a text are: numbers, fields, names in quotes.
fn words(text: &str) -> Vec<Range<usize>> {
    let is_gap = |c: char| !c.is_ascii_alphanumeric() && !"\"._+-".contains(c);
    let mut start = 0;
    let pieces = text.split_inclusive(is_gap);
    let words = pieces.map(|piece| {
        let word = start..start + piece.trim_end_matches(is_gap).len();
        start += piece.len();
        word
    });
    words.collect()
}

/// A text with one of such words swapped for another, if it has any.
fn swapped(text: &str, is_such: impl Fn(&str) -> bool, at: Index, new: &str) -> String {
    let mut words = words(text);
    words.retain(|word| is_such(&text[word.clone()]));
    let mut text = text.to_string();
    if !words.is_empty() {
        text.replace_range(words[at.index(words.len())].clone(), new);
    }
    text
}

fn decoded(bytes: &[u8]) -> DynamicImage {
    image::load_from_memory_with_format(bytes, ImageFormat::Png).expect("it is a picture")
}

/// A picture with other channels, or more bits to each.
fn recoded(picture: &DynamicImage, format: usize) -> DynamicImage {
    match format {
        0 => DynamicImage::ImageLuma8(picture.to_luma8()),
        1 => DynamicImage::ImageLumaA8(picture.to_luma_alpha8()),
        2 => DynamicImage::ImageRgb8(picture.to_rgb8()),
        3 => DynamicImage::ImageLuma16(picture.to_luma16()),
        4 => DynamicImage::ImageLumaA16(picture.to_luma_alpha16()),
        5 => DynamicImage::ImageRgb16(picture.to_rgb16()),
        _ => DynamicImage::ImageRgba16(picture.to_rgba16()),
    }
}

/// One or two faults, each with the name of its file.
fn faults() -> impl Strategy<Value = Vec<(String, Fault)>> {
    let names: Vec<String> = FILES.keys().cloned().collect();
    let pictures: Vec<String> = names.iter().filter(|name| *name != TEXT).cloned().collect();
    let of_any = prop_oneof![
        Just(Fault::Missing),
        any::<Index>().prop_map(Fault::Cut),
        (any::<Index>(), 1..=u8::MAX).prop_map(|(at, bits)| Fault::Flipped(at, bits)),
        prop::collection::vec(any::<u8>(), 0..200).prop_map(Fault::Junk),
    ];
    let of_picture = prop_oneof![
        (1..40_u32, 1..100_u32).prop_map(|(width, height)| Fault::Resized(width, height)),
        (0..7_usize).prop_map(Fault::Recoded),
    ];
    let numbers = [
        "0",
        "-0.0",
        "1",
        "-1",
        "1024",
        "4294967295",
        "4294967296",
        "18446744073709551616",
        "1e-45",
        "1e38",
        "1e39",
        "NaN",
        "inf",
        "-inf",
    ];
    let number = prop_oneof![
        select(numbers.to_vec()).prop_map(String::from),
        (0..80_u32).prop_map(|number| number.to_string()),
        any::<f32>().prop_map(|number| format!("{number:?}")),
    ];
    let paths = [
        "",
        ".",
        "..",
        "/",
        "#",
        "#a",
        "elm.0.color.png#",
        "://elm.0.color.png",
        "none://elm.0.color.png",
        "none://",
        "../elm.0.color.png",
        "../../..",
        "elm.slicing.ron",
        "elm.1.normal.png",
    ];
    // The text gives each orientation nine lines.
    let count = prop_oneof![Just(1_usize), Just(9), 1..12_usize];
    let of_text = prop_oneof![
        3 => (any::<Index>(), number).prop_map(|(at, new)| Fault::Number(at, new)),
        2 => (any::<Index>(), select(paths.to_vec())).prop_map(|(at, new)| Fault::Name(at, format!("\"{new}\""))),
        3 => (any::<Index>(), count, any::<bool>())
            .prop_map(|(at, count, are_twice)| Fault::Lines { at, count, are_twice }),
    ];
    let fault = prop_oneof![
        (select(names), of_any.clone()),
        (Just(TEXT.to_string()), of_any),
        (select(pictures), of_picture),
        (Just(TEXT.to_string()), of_text.clone()),
        (Just(TEXT.to_string()), of_text),
    ];
    prop::collection::vec(fault, 1..3)
}

/// Checks that a slicing passes its own check, and is what files say; `pictures` has what each shows.
fn check_slicing(slicing: &Slicing, files: &Files, pictures: &Files) {
    let shape = slicing.shape();
    let all = |of: fn(&Slicing, usize) -> &[[u8; 4]]| -> Vec<[u8; 4]> {
        let layers = 0..shape.layers();
        layers
            .flat_map(|layer| of(slicing, layer))
            .copied()
            .collect()
    };
    let again = Slicing::new(shape.clone(), all(Slicing::color), all(Slicing::normal));
    assert!(again.as_ref() == Ok(slicing), "{shape:?}");
    let document = SlicingDocument::parse(PATH, &files[TEXT]).expect("what loads can be parsed");
    // All but the names of pictures.
    let numbers = |document: &SlicingDocument| -> Vec<String> {
        let text = document.to_ron();
        let lines = text.lines().filter(|line| !line.contains('"'));
        lines.map(String::from).collect()
    };
    let described = SlicingDocument::describe(slicing, "elm");
    assert_eq!(numbers(&described), numbers(&document));
    assert_eq!(document.pictures().count(), shape.orientations.len());
    for (orientation, names) in document.pictures().enumerate() {
        for (name, pixels) in names.into_iter().zip(slicing.pictures(orientation)) {
            let picture = decoded(&pictures[name]);
            let color = picture.color();
            assert_eq!(
                color.bytes_per_pixel(),
                color.channel_count(),
                "{name}: {color:?}"
            );
            assert!(
                picture.to_rgba8().as_raw().as_slice() == pixels.as_flattened(),
                "{name}"
            );
        }
    }
}

/// Checks that an error is of the loader, which has not panicked, and names a file that is to blame.
fn check_error(error: &AssetLoadError, files: &Files, faults: &[(String, Fault)]) {
    let message = error.to_string();
    let error = match error {
        AssetLoadError::AssetLoaderError(error) => error.error().downcast_ref::<SlicingFileError>(),
        AssetLoadError::AssetReaderError(AssetReaderError::NotFound(_)) => {
            assert!(!files.contains_key(TEXT), "{message}");
            assert!(message.contains(PATH), "{message}");
            return;
        }
        _ => None,
    };
    let Some(error) = error else {
        panic!("{message}");
    };
    let text = AssetPath::parse(PATH);
    let beside = |name: &str| Some(text.resolve_embed_str(name).ok()?.to_string());
    let mut blamed: Vec<String> = faults.iter().filter_map(|(name, _)| beside(name)).collect();
    // A text that is wrong may name pictures that are none, or ask for others than are there.
    if faults.iter().any(|(name, _)| name == TEXT)
        && let Some(bytes) = files.get(TEXT)
        && let Ok(document) = SlicingDocument::parse(PATH, bytes)
    {
        blamed.extend(document.pictures().flatten().filter_map(beside));
    }
    assert!(blamed.contains(&error.path), "{message}: not of {blamed:?}");
    let told = error.to_string();
    assert!(message.contains(&told), "{message}");
    // Long words of a file are not repeated in full.
    assert!(told.len() < 1000, "{told}");
}

#[test]
fn a_set_of_files_that_is_right_loads_as_what_was_saved() {
    let loaded = load(&FILES);
    assert!(loaded.is_ok_and(|slicing| slicing == *SMALL));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(96) })]

    #[test]
    fn a_spoiled_set_of_files_loads_as_what_it_says_or_the_error_names_the_file(faults in faults()) {
        let mut files = FILES.clone();
        // A picture that was damaged shows what it showed before, if it shows anything: PNGs are summed up.
        let mut pictures = FILES.clone();
        for (name, fault) in &faults {
            fault.spoil(name, &mut files);
            if name == TEXT || !matches!(fault, Fault::Cut(_) | Fault::Flipped(..)) {
                fault.spoil(name, &mut pictures);
            }
        }
        match load(&files) {
            Ok(slicing) => check_slicing(&slicing, &files, &pictures),
            Err(error) => {
                assert!(files != *FILES, "{error}");
                check_error(&error, &files, &faults);
            }
        }
    }
}

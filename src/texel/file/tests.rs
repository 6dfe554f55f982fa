//! Files are read as they were written, and what is broken is named.

use bevy::math::{UVec3, Vec3};
use proptest::prelude::*;

use super::super::progress::silent;
use super::super::topology::Topology;
use super::super::volume::VolumeParts;
use super::*;

fn volume(size: UVec3, opaque: impl Fn(usize) -> bool) -> ReferenceVolume {
    let voxels = 0..size.element_product() as usize;
    let byte = |i: usize, factor: usize| (i * factor % 251) as u8;
    let parts = VolumeParts {
        size,
        lengths: Vec3::new(1.0, 2.0, 0.3),
        topology: Topology::Tiling,
        colors: voxels
            .clone()
            .map(|i| {
                [
                    byte(i, 3),
                    byte(i, 7),
                    byte(i, 11),
                    if opaque(i) { 255 } else { 0 },
                ]
            })
            .collect(),
        normals: voxels
            .map(|i| [byte(i, 5), 200, byte(i, 13), 255])
            .collect(),
    };
    ReferenceVolume::new(parts, &silent).unwrap()
}

fn read(
    document: &TexelDocument,
    images: &[Vec<u8>; 2],
) -> Result<ReferenceVolume, TexelFileError> {
    let text = document.to_ron();
    let document = TexelDocument::from_ron("a/b.texel.ron", text.as_bytes())?;
    document.volume("a/b.texel.ron", &images[0], Some(&images[1]), &silent)
}

fn message(text: &str) -> String {
    TexelDocument::from_ron("a.texel.ron", text.as_bytes())
        .unwrap_err()
        .to_string()
}

const GOOD: &str = "(\n    size: (4, 4, 2),\n    lengths: (1, 1, 0.5),\n    \
    topology: Tiling,\n    colors: \"a.png\",\n)\n";

#[test]
fn a_volume_survives_its_files() {
    for size in [
        UVec3::new(8, 4, 16),
        UVec3::new(1, 1, 1),
        UVec3::new(2, 32, 8),
    ] {
        let volume = volume(size, |i| i % 3 != 1);
        let (document, images) = TexelDocument::of(&volume, "b");
        assert_eq!(read(&document, &images), Ok(volume));
    }
}

#[test]
fn files_are_written_and_read_by_name() {
    let folder = std::env::temp_dir().join(format!("texel-files-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("meadow.texel.ron");
    let volume = volume(UVec3::splat(8), |i| i % 2 == 0);
    assert_eq!(
        save(&volume, &path).unwrap(),
        ["meadow.color.png", "meadow.normal.png"]
    );
    assert_eq!(load(&path, &silent), Ok(volume.clone()));
    let error = save(&volume, &folder.join("meadow.ron"))
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("meadow.ron: is no name of a volume"),
        "{error}"
    );
    fs::remove_file(folder.join("meadow.color.png")).unwrap();
    let error = load(&path, &silent).unwrap_err().to_string();
    assert!(
        error.contains("meadow.color.png: cannot be read"),
        "{error}"
    );
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn the_written_form_is_short_and_what_may_be_left_out_may() {
    let volume = volume(UVec3::new(4, 4, 2), |_| true);
    let (document, images) = TexelDocument::of(&volume, "b");
    let text = document.to_ron();
    assert!(
        text.starts_with(
            "(\n    size: (4, 4, 2),\n    lengths: (1.0, 2.0, 0.3),\n    topology: Tiling,\n"
        ),
        "{text}"
    );
    let short = TexelDocument::from_ron("a", GOOD.as_bytes()).unwrap();
    assert_eq!(
        (short.columns, short.normals.clone(), short.thickness),
        (1, None, None)
    );
    let grid = TexelDocument {
        columns: 1,
        ..document
    };
    let one = images::encode(volume.colors(), volume.size(), 1, 4);
    let plain = TexelDocument {
        lengths: grid.lengths,
        ..short
    }
    .volume("a", &one, None, &silent)
    .unwrap();
    assert_eq!(plain.colors(), volume.colors());
    // Measured anew.
    assert_eq!(plain.thickness(), volume.thickness());
    assert_eq!(plain.normal(0, 0, 0).round(), Vec3::Z);
    assert_eq!(images.len(), 2);
}

#[test]
fn mistakes_are_named_by_line_with_their_fix() {
    assert!(TexelDocument::from_ron("a", GOOD.as_bytes()).is_ok());
    let cases = [
        (
            "lengths",
            "length",
            "line 3: Unexpected field named `length`",
            "remove",
        ),
        (
            "    topology: Tiling,\n",
            "",
            "line 5: Unexpected missing field named `topology`",
            "add the field",
        ),
        ("Tiling", "Torus", "line 4: ", "`Tiling` or `Isolated`"),
        ("(4, 4, 2)", "(4, -4, 2)", "line 2: ", "number"),
        ("0.5", "thick", "line 3: ", "number"),
        ("0.5", "NaN", "lengths [1, 1, NaN]", "in metres"),
        ("(4, 4, 2)", "(4, 6, 2)", "6 voxels along v", "take 8"),
        (
            "(4, 4, 2)",
            "(4096, 4096, 4096)",
            "larger than",
            "take fewer",
        ),
        ("a.png", "../a.png", "`../a.png`", "without `/`"),
        (",\n)", ", columns: 3)", "`columns` is 3", "power of two"),
        (",\n)", ", columns: 0)", "`columns` is 0", "power of two"),
        (
            ",\n)",
            ", thickness: (0, 1, 1))",
            "`thickness`",
            "leave it out",
        ),
    ];
    for (old, new, what, fix) in cases {
        let message = message(&GOOD.replacen(old, new, 1));
        assert!(message.starts_with("a.texel.ron"), "{message}");
        assert!(
            message.contains(what) && message.contains(fix),
            "{old} {new}: {message}"
        );
    }
    let wide = TexelDocument::from_ron("a", &[0xFF, 0xFE, 0])
        .unwrap_err()
        .to_string();
    assert!(wide.contains("UTF-8"), "{wide}");
    assert!(message(&" ".repeat(MAX_DOCUMENT_BYTES + 1)).contains("is larger than"));
}

#[test]
fn a_file_cut_short_anywhere_is_refused_as_such() {
    let text = GOOD.trim_end();
    for end in 0..text.len() {
        let message = message(&text[..end]);
        assert!(message.contains("cut short"), "{end}: {message}");
    }
}

#[test]
fn images_that_do_not_fit_are_named() {
    let made = volume(UVec3::new(8, 4, 16), |_| true);
    let (document, images) = TexelDocument::of(&made, "b");
    let other = TexelDocument {
        size: UVec3::new(8, 8, 16),
        ..document.clone()
    };
    let error = read(&other, &images).unwrap_err().to_string();
    assert!(error.starts_with("a/b.color.png: is "), "{error}");
    assert!(error.contains("scale it"), "{error}");
    let error = read(&document, &[images[0].clone(), vec![1, 2, 3]])
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("a/b.normal.png: is no readable PNG"),
        "{error}"
    );
    let empty = images::encode(&[[9, 9, 9, 0]; 512], document.size, document.columns, 4);
    let error = read(&document, &[empty, images[1].clone()])
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("a/b.texel.ron: no voxel is opaque"),
        "{error}"
    );
}

#[test]
fn a_document_made_in_code_is_checked_as_one_of_a_file() {
    let made = volume(UVec3::new(8, 4, 16), |_| true);
    let (document, [colors, normals]) = TexelDocument::of(&made, "b");
    let refused = |change: &dyn Fn(&mut TexelDocument)| {
        let mut changed = document.clone();
        change(&mut changed);
        let volume = changed.volume("a/b.texel.ron", &colors, Some(&normals), &silent);
        volume.unwrap_err().to_string()
    };
    for (message, fix) in [
        (refused(&|d| d.columns = 0), "power of two"),
        (refused(&|d| d.columns = u32::MAX), "power of two"),
        (refused(&|d| d.size = UVec3::MAX), "take"),
        (refused(&|d| d.size = UVec3::splat(1 << 31)), "take fewer"),
        (refused(&|d| d.size.z = 0), "take"),
        (refused(&|d| d.lengths.x = f32::NAN), "in metres"),
    ] {
        assert!(message.starts_with("a/b.texel.ron: "), "{message}");
        assert!(message.contains(fix), "{message}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(200) })]

    #[test]
    fn any_bytes_give_an_answer(
        junk in prop::collection::vec(any::<u8>(), 0..200),
        at in 0..400usize,
        image in 0..2usize,
    ) {
        let made = volume(UVec3::new(4, 4, 2), |i| i % 2 == 0);
        let (document, mut images) = TexelDocument::of(&made, "b");
        let mut text = document.to_ron().into_bytes();
        let place = at % text.len();
        let end = text.len().min(place + junk.len());
        text.splice(place..end, junk.iter().copied());
        // What is read must be a volume or an error, in either file.
        if let Ok(document) = TexelDocument::from_ron("a", &text)
            && let Ok(volume) = document.volume("a", &images[0], Some(&images[1]), &silent)
        {
            prop_assert!(volume.opaque_voxels() > 0);
        }
        let place = at % images[image].len();
        let end = images[image].len().min(place + junk.len());
        images[image].splice(place..end, junk);
        if let Ok(volume) = document.volume("a", &images[0], Some(&images[1]), &silent) {
            prop_assert_eq!(volume.size(), made.size());
        }
    }
}

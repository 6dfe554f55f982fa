//! Skeleton files: whatever is in them, reading gives a skeleton or an error that helps.

use std::ops::Range;
use std::time::{Duration, Instant};

use bevy::asset::{AssetPlugin, LoadState};
use bevy::math::{DVec3, Vec3};
use bevy::prelude::{App, AssetServer, Assets, TaskPoolPlugin};
use bevy_verdure::skeleton::{
    Joint, MAX_JOINTS, Recentre, Skeleton, SkeletonFileError, SkeletonLoaderSettings,
    SkeletonPlugin, UpAxis, skeleton_from_bytes,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};

/// A file of each kind that loads, by path and content.
const SAMPLES: [(&str, &str); 4] = [
    (
        "fork.skeleton.ron",
        include_str!("../../assets/test/fork.skeleton.ron"),
    ),
    ("fork.swc", include_str!("../../assets/test/fork.swc")),
    ("treeqsm.csv", include_str!("../../assets/test/treeqsm.csv")),
    (
        "simpleforest.csv",
        include_str!("../../assets/test/simpleforest.csv"),
    ),
];

const HEADER: &str = "start_x,start_y,start_z,end_x,end_y,end_z,radius,parent\n";

fn read(path: &str, bytes: impl AsRef<[u8]>) -> Result<Skeleton, SkeletonFileError> {
    skeleton_from_bytes(path, bytes.as_ref(), &SkeletonLoaderSettings::default())
}

/// Reads a file that is no skeleton, and checks that the message names it and has all the `hints`.
fn refuses(path: &str, bytes: impl AsRef<[u8]>, hints: &[&str]) {
    let message = match read(path, bytes) {
        Ok(skeleton) => panic!("{path} is a skeleton: {skeleton:?}"),
        Err(error) => error.to_string(),
    };
    for hint in [path].iter().chain(hints) {
        assert!(message.contains(hint), "no `{hint}` in: {message}");
    }
}

// ---------------------------------------------------------------- samples

#[test]
fn the_ron_sample_is_read_as_written() {
    let (path, text) = SAMPLES[0];
    let expected = [
        Joint::root(Vec3::ZERO, 0.2),
        Joint::new(Vec3::new(0.0, 2.0, 0.0), 0.15, 0),
        Joint::new(Vec3::new(0.5, 2.75, 0.0), 0.0625, 1).with_twist(0.5),
        Joint::new(Vec3::new(-0.5, 3.0, 0.25), 0.05, 1).with_texture_length(0.5),
    ];
    assert_eq!(read(path, text).unwrap().joints(), expected);
}

#[test]
fn the_swc_sample_has_the_same_joints() {
    let [ron, swc] = [SAMPLES[0], SAMPLES[1]].map(|(path, text)| read(path, text).unwrap());
    let shape = |skeleton: &Skeleton| -> Vec<_> {
        let joints = skeleton.joints().iter();
        joints.map(|j| (j.position, j.radius, j.parent)).collect()
    };
    assert_eq!(shape(&ron), shape(&swc));
}

#[test]
fn the_treeqsm_sample_is_a_trunk_and_a_branch_from_its_side_near_the_origin() {
    let (path, text) = SAMPLES[2];
    let skeleton = read(path, text).unwrap();
    assert_eq!(
        skeleton.offset(),
        DVec3::new(384_512.25, 6_671_034.5, 112.0)
    );
    let expected = [
        (Vec3::ZERO, 0.2, None),
        (Vec3::new(0.0, 2.0, 0.0), 0.2, Some(0)),
        (Vec3::new(0.0, 3.5, 0.0), 0.15, Some(1)),
        (Vec3::new(0.25, 1.0, 0.0), 0.05, None),
        (Vec3::new(0.957_106_8, 1.707_106_8, 0.0), 0.05, Some(3)),
        (Vec3::new(0.957_1, 2.207_1, 0.0), 0.025, Some(4)),
    ];
    assert_eq!(skeleton.len(), expected.len());
    for (joint, (position, radius, parent)) in skeleton.joints().iter().zip(expected) {
        // Coordinates of 4e5 are read to 6e-11, and of 2 m written as f32 to 2e-7.
        assert!(joint.position.abs_diff_eq(position, 1e-6), "{joint:?}");
        assert_eq!((joint.radius, joint.parent), (radius, parent));
    }
}

#[test]
fn the_simpleforest_sample_counts_ids_from_zero() {
    let (path, text) = SAMPLES[3];
    let expected = [
        Joint::root(Vec3::new(1.0, 3.0, -2.0), 0.2),
        Joint::new(Vec3::new(1.0, 5.0, -2.0), 0.2, 0),
        Joint::new(Vec3::new(1.5, 6.0, -2.0), 0.125, 1),
        Joint::new(Vec3::new(0.5, 5.5, -2.25), 0.0625, 1),
    ];
    assert_eq!(read(path, text).unwrap().joints(), expected);
}

// ---------------------------------------------------------------- the asset server

/// Loads a file of the asset folder as a game does, with a scale of its own.
fn load(path: &'static str, scale: f32) -> Result<Skeleton, String> {
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        AssetPlugin::default(),
        SkeletonPlugin,
    ));
    let server = app.world().resource::<AssetServer>().clone();
    let with_scale = move |settings: &mut SkeletonLoaderSettings| settings.scale = scale;
    let handle = server.load_builder().with_settings(with_scale).load(path);
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(60) {
        app.update();
        match server.load_state(&handle) {
            LoadState::Loaded => {
                let skeletons = app.world().resource::<Assets<Skeleton>>();
                return Ok(skeletons.get(&handle).unwrap().clone());
            }
            LoadState::Failed(error) => return Err(error.to_string()),
            _ => std::thread::sleep(Duration::from_millis(1)),
        }
    }
    panic!("{path} was not loaded in a minute");
}

#[test]
fn the_asset_server_loads_every_kind_of_file() {
    for (path, bytes) in SAMPLES {
        let asset_path = std::format!("test/{path}").leak();
        assert_eq!(load(asset_path, 1.0), Ok(read(path, bytes).unwrap()));
    }
}

#[test]
fn the_asset_server_passes_settings_on() {
    let skeleton = load("test/fork.swc", 0.5).unwrap();
    assert_eq!(skeleton.joints()[1], Joint::new(Vec3::Y, 0.075, 0));
}

#[test]
fn the_asset_server_says_what_is_wrong_and_where() {
    let message = load("test/broken.swc", 1.0).unwrap_err();
    for hint in ["test/broken.swc, line 3: parent 7", "-1 for a root"] {
        assert!(message.contains(hint), "{message}");
    }
}

// ---------------------------------------------------------------- bad input

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for bad in ["NaN", "inf", "-inf"] {
        let joint = format!("(position: (0, {bad}, 0), radius: 1)");
        refuses(
            "a.ron",
            format!("(joints: [{joint}])"),
            &["joint 0", "position"],
        );
        let joint = format!("(position: (0, 0, 0), radius: {bad})");
        refuses(
            "a.ron",
            format!("(joints: [{joint}])"),
            &["joint 0", "radius"],
        );
        refuses(
            "a.swc",
            format!("1 1 0 0 {bad} 1 -1"),
            &["line 1", "z is", "number"],
        );
        refuses(
            "a.csv",
            format!("{HEADER}0,0,0,0,0,{bad},1,0"),
            &["line 2", "end z", "number"],
        );
    }
    // Finite where they are read, but not as metres.
    refuses(
        "a.swc",
        "1 1 0 0 0 1 -1\n2 1 1e39 0 0 1 1",
        &["line 2", "position", "scale"],
    );
    refuses(
        "a.csv",
        format!("{HEADER}0,0,0,0,0,1e308,1,0"),
        &["line 2", "position", "scale"],
    );
}

#[test]
fn radii_that_are_not_positive_are_refused() {
    for bad in ["0", "-0.5", "1e-60"] {
        let joint = format!("(position: (0, 0, 0), radius: {bad})");
        refuses(
            "a.ron",
            format!("(joints: [{joint}])"),
            &["joint 0", "radius", "greater than 0"],
        );
        refuses(
            "a.swc",
            format!("1 1 0 0 0 {bad} -1"),
            &["line 1", "radius", "min_radius"],
        );
        refuses(
            "a.csv",
            format!("{HEADER}0,0,0,0,0,1,{bad},0"),
            &["line 2", "radius", "min_radius"],
        );
    }
}

#[test]
fn a_least_radius_mends_thin_joints() {
    let settings = SkeletonLoaderSettings {
        min_radius: Some(0.01),
        ..Default::default()
    };
    let csv = format!("{HEADER}0,0,0,0,0,1,0,0\n0,0,1,0,0,2,-1,1");
    let files = [
        ("a.swc", "1 1 0 0 0 0 -1\n2 1 0 1 0 -1 1"),
        ("a.csv", csv.as_str()),
    ];
    for (path, text) in files {
        let skeleton = skeleton_from_bytes(path, text.as_bytes(), &settings).unwrap();
        assert!(skeleton.joints().iter().all(|joint| joint.radius == 0.01));
    }
}

#[test]
fn parents_that_are_missing_are_refused() {
    let joint = "(position: (0, 0, 0), radius: 1, parent: 5)";
    refuses(
        "a.ron",
        format!("(joints: [{joint}])"),
        &["joint 0", "parent 5", "root"],
    );
    refuses(
        "a.swc",
        "1 1 0 0 0 1 -1\n2 1 0 1 0 1 5",
        &["line 2", "parent 5", "-1 for a root"],
    );
    refuses(
        "a.swc",
        "1 1 0 0 0 1 0",
        &["line 1", "parent 0", "-1 for a root"],
    );
    refuses(
        "a.csv",
        format!("{HEADER}0,0,0,0,0,1,1,5"),
        &["line 2", "parent 5", "-1 for a root"],
    );
}

#[test]
fn cycles_are_refused() {
    let [first, second] =
        [1, 0].map(|parent| format!("(position: (0, 0, 0), radius: 1, parent: {parent})"));
    refuses(
        "a.ron",
        format!("(joints: [{first}, {second}])"),
        &["joint 0", "ancestor", "root"],
    );
    refuses(
        "a.swc",
        "1 1 0 0 0 1 -1\n2 1 0 0 0 1 3\n3 1 0 0 0 1 2",
        &["line 2", "ancestor", "root"],
    );
    // Refused also where starts are too far away to be welded, and no joint would be its own ancestor.
    for far in [0, 50] {
        refuses(
            "a.csv",
            format!("{HEADER}0,0,0,0,0,1,1,2\n{far},0,1,0,0,0,1,1"),
            &["line 2", "ancestor", "root"],
        );
    }
}

#[test]
fn ids_that_are_used_twice_are_refused() {
    refuses(
        "a.swc",
        "1 1 0 0 0 1 -1\n1 1 0 1 0 1 1",
        &["line 2", "id 1", "line 1"],
    );
    let row = "7,0,0,0,0,0,1,1,0";
    refuses(
        "a.csv",
        format!("id,{HEADER}{row}\n{row}"),
        &["line 3", "id 7", "line 2"],
    );
}

#[test]
fn files_cut_short_are_refused_where_it_can_be_told() {
    let (path, text) = SAMPLES[0];
    refuses(path, &text[..text.len() / 2], &["line", "cut short"]);
    let (path, text) = SAMPLES[1];
    refuses(
        path,
        &text[..text.rfind(" 0.25").unwrap()],
        &["line 6", "cut short"],
    );
    let (path, text) = SAMPLES[2];
    refuses(
        path,
        &text[..text.len() - 12],
        &["line 5", "fields", "cut short"],
    );
    for (path, hint) in [
        ("a.ron", "cut short"),
        ("a.swc", "at least one joint"),
        ("a.csv", "header"),
    ] {
        refuses(path, "", &[hint]);
    }
}

#[test]
fn counts_in_a_file_are_not_believed() {
    for count in ["4294967295", "18446744073709551615"] {
        refuses("a.ron", count, &["line 1", "joints"]);
        refuses("a.ron", format!("(joints: {count})"), &["line 1", "joints"]);
        refuses("a.swc", count, &["line 1", "columns"]);
        refuses("a.csv", count, &["header"]);
        refuses(
            "a.csv",
            format!("{HEADER}0,0,0,0,0,1,1,{count}"),
            &["line 2", "parent"],
        );
    }
}

#[test]
fn files_of_another_format_are_refused() {
    let texts = [
        "<?xml version=\"1.0\"?>\n<tree/>\n",
        "{\"joints\": [1, 2]}\n",
        "v 0 0 0\nv 1 0 0\nl 1 2\n",
        "Lorem ipsum, dolor; sit\tamet.\n",
    ];
    let samples = SAMPLES.iter();
    for (name, text) in samples.copied().chain(texts.map(|text| ("", text))) {
        let own = name.rsplit('.').next();
        for (path, hint) in [
            ("a.ron", "joints: ["),
            ("a.swc", "another format"),
            ("a.csv", "header"),
        ] {
            if path.rsplit('.').next() != own {
                refuses(path, text, &[hint]);
            }
        }
    }
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let utf16: Vec<u8> = "\u{FEFF}1 1 0 0 0 1 -1\n"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for path in ["a.ron", "a.swc", "a.csv"] {
        refuses(path, &utf16, &["UTF-16", "UTF-8"]);
        refuses(
            path,
            b"# one\n# Jos\xE9 two\n",
            &["line 2", "save it as UTF-8"],
        );
        refuses(
            path,
            b"\x89PNG\r\n\x1A\n\0\0\0\rIHDR",
            &["line 3", "binary"],
        );
    }
}

#[test]
fn more_joints_than_the_limit_are_refused() {
    let count = MAX_JOINTS + 1;
    let swc: String = (0..count)
        .map(|id| format!("{id} 0 0 0 0 1 -1\n"))
        .collect();
    refuses("a.swc", swc, &["2000000", "split"]);
    let csv = "0,0,0,0,0,1,1,0\n".repeat(count);
    refuses("a.csv", format!("{HEADER}{csv}"), &["2000000", "split"]);
}

#[test]
fn a_million_joints_in_the_worst_order_are_read() {
    // Every sample hangs from the next, so that each one has to move past all others.
    let count = 1_000_000;
    let swc: String = (1..=count)
        .map(|id| {
            let parent = if id == count { -1 } else { id + 1 };
            format!("{id} 3 0 {} 0 0.1 {parent}\n", count - id)
        })
        .collect();
    let skeleton = read("a.swc", swc).unwrap();
    assert_eq!(
        (skeleton.len(), skeleton.segment_count()),
        (count as usize, count as usize - 1)
    );
    let expected = |index: u32| match index {
        0 => Joint::root(Vec3::ZERO, 0.1),
        _ => Joint::new(Vec3::Y * index as f32, 0.1, index - 1),
    };
    assert!(
        (0..)
            .zip(skeleton.joints())
            .all(|(index, joint)| *joint == expected(index))
    );

    let written = skeleton.to_ron();
    assert!(read("a.skeleton.ron", written).unwrap() == skeleton);
}

// ---------------------------------------------------------------- properties

/// A finite number of any size up to `range.end`, small ones as often as large.
fn number(range: Range<f32>) -> impl Strategy<Value = f32> {
    let largest = range.end;
    prop_oneof![
        range,
        (-30..6_i32).prop_map(|exponent| 10_f32.powi(exponent)),
    ]
    .prop_map(move |number| number.min(largest))
}

/// A joint with any numbers that are valid, and any parent.
fn joint() -> impl Strategy<Value = (Joint, Index, bool)> {
    let position = [-1e6..1e6_f32, -10.0..10.0, -1e-3..1e-3];
    let position = position.map(|range| range.prop_map(|number| number));
    let position = position.prop_map(Vec3::from_array);
    let radius = number(f32::MIN_POSITIVE..1e5);
    let twist = prop_oneof![Just(0.0), -100.0..100.0_f32];
    let texture_length = prop::option::of(number(f32::MIN_POSITIVE..1e5));
    let numbers = (position, radius, twist, texture_length);
    let joint = numbers.prop_map(|(position, radius, twist, texture_length)| Joint {
        position,
        radius,
        parent: None,
        twist,
        texture_length,
    });
    (joint, any::<Index>(), any::<bool>())
}

/// Joints that make a skeleton, parents first.
fn joints() -> impl Strategy<Value = Vec<Joint>> {
    vec(joint(), 1..60).prop_map(|joints| {
        let with_parents = joints.into_iter().enumerate();
        let with_parents = with_parents.map(|(index, (mut joint, parent, is_root))| {
            if index > 0 && !is_root {
                joint.parent = Some(parent.index(index) as u32);
            }
            joint
        });
        with_parents.collect()
    })
}

/// The bytes of a sample after a few edits: bytes changed, removed, put in, repeated, the end cut off.
fn damaged() -> impl Strategy<Value = (&'static str, Vec<u8>)> {
    let pieces = [
        "NaN",
        "inf",
        "-1",
        "1e999",
        "0",
        "-",
        ".",
        ",",
        ";",
        "\t",
        "(",
        ")",
        "[",
        "]",
        "\"",
        "#",
        "/*",
        "\r",
        "\n",
        "\0",
        "é",
        "\u{FEFF}",
        "parent",
        "4294967296",
        "9223372036854775808",
    ];
    let piece = prop_oneof![
        select(pieces.to_vec()).prop_map(|piece| piece.as_bytes().to_vec()),
        vec(any::<u8>(), 0..4),
    ];
    let edit = (any::<Index>(), 0..12_usize, piece, any::<bool>());
    (select(SAMPLES.to_vec()), vec(edit, 1..6)).prop_map(|((path, text), edits)| {
        let mut bytes = text.as_bytes().to_vec();
        for (at, removed, piece, cuts) in edits {
            let start = at.index(bytes.len() + 1);
            let end = (start + removed).min(bytes.len());
            bytes.splice(start..end, piece);
            if cuts && removed == 0 {
                bytes.truncate(start);
            }
        }
        (path, bytes)
    })
}

fn settings() -> impl Strategy<Value = SkeletonLoaderSettings> {
    let scale = select(std::vec![
        1.0,
        1e-6,
        1e6,
        f32::MAX,
        f32::MIN_POSITIVE,
        0.0,
        f32::NAN
    ]);
    let recentre = select(std::vec![Recentre::Auto, Recentre::Always, Recentre::Never]);
    let up = select(std::vec![None, Some(UpAxis::Y), Some(UpAxis::Z)]);
    let min_radius = select(std::vec![None, Some(1e-3), Some(f32::MAX), Some(-1.0)]);
    let all = (scale, recentre, up, min_radius);
    all.prop_map(|(scale, recentre, up, min_radius)| SkeletonLoaderSettings {
        scale,
        recentre,
        up,
        min_radius,
    })
}

/// What every answer must be: an error that names the file, or a skeleton that keeps its promises.
fn check(path: &str, bytes: &[u8], settings: &SkeletonLoaderSettings) {
    match skeleton_from_bytes(path, bytes, settings) {
        Ok(skeleton) => {
            let joints = skeleton.joints();
            assert!(!joints.is_empty() && skeleton.offset().is_finite());
            assert!(
                (0..)
                    .zip(joints)
                    .all(|(index, joint)| { joint.parent.is_none_or(|parent| parent < index) })
            );
            let again = Skeleton::new(joints.to_vec()).unwrap();
            assert_eq!(again.joints(), joints);
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with(path), "{message}");
            // Long words of the file are not repeated in full.
            assert!(message.len() < 1000, "{message}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..Default::default() })]

    #[test]
    fn any_bytes_give_a_skeleton_or_an_error(bytes in vec(any::<u8>(), 0..200), settings in settings()) {
        for path in ["a.skeleton.ron", "a.swc", "a.csv"] {
            check(path, &bytes, &settings);
        }
    }

    #[test]
    fn any_text_gives_a_skeleton_or_an_error(
        words in vec(select(std::vec![
            "(", ")", "[", "]", ":", ",", "joints", "position", "radius", "parent", "0", "1", "-1", "0.5", "1e99",
            "NaN", " ", "\n", "\t", ";", "#", "//", "/*", "*/", "sx", "sy", "sz", "ex", "ey", "ez", "start", "id",
        ]), 0..80),
        settings in settings(),
    ) {
        for path in ["a.skeleton.ron", "a.swc", "a.csv"] {
            check(path, words.concat().as_bytes(), &settings);
        }
    }

    #[test]
    fn damaged_files_give_a_skeleton_or_an_error((path, bytes) in damaged(), settings in settings()) {
        check(path, &bytes, &settings);
    }

    #[test]
    fn skeletons_survive_writing_and_reading(
        joints in joints(),
        offset in [-1e9..1e9_f64, -1.0..1.0, -1e-9..1e-9],
    ) {
        let skeleton = Skeleton::new(joints.clone()).unwrap();
        prop_assert_eq!(skeleton.joints(), joints);
        let skeleton = skeleton.with_offset(offset.into()).unwrap();
        prop_assert_eq!(Skeleton::from_ron_str(&skeleton.to_ron()), Ok(skeleton));
    }

    #[test]
    fn shuffled_joints_make_the_same_tree(joints in joints(), keys in vec(any::<u32>(), 60)) {
        // The place of each joint after shuffling, and the joints there.
        let mut order: Vec<usize> = (0..joints.len()).collect();
        order.sort_by_key(|&index| keys[index]);
        let mut place = vec![0; joints.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old] = new as u32;
        }
        let shuffled = order.iter().map(|&old| {
            let mut joint = joints[old].clone();
            joint.parent = joint.parent.map(|parent| place[parent as usize]);
            joint
        });
        let skeleton = Skeleton::new(shuffled.collect()).unwrap();
        prop_assert_eq!(paths(skeleton.joints()), paths(&joints));
    }
}

/// For every joint the positions from its root to it, in an order that does not depend on that of the joints.
fn paths(joints: &[Joint]) -> Vec<Vec<[u32; 3]>> {
    let mut paths: Vec<Vec<[u32; 3]>> = Vec::new();
    for joint in joints {
        let mut path = joint
            .parent
            .map_or_else(Vec::new, |parent| paths[parent as usize].clone());
        path.push(joint.position.to_array().map(f32::to_bits));
        paths.push(path);
    }
    paths.sort();
    paths
}

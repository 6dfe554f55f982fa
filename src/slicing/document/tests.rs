//! What is promised of a slicing's files.

use proptest::prelude::*;

use super::*;
use crate::slicing::tests::tiny;

#[test]
fn what_is_written_is_read_back_to_the_last_bit() {
    let slicing = tiny();
    let document = SlicingDocument::describe(&slicing, "elm");
    let text = document.to_ron();
    let read = SlicingDocument::parse("elm.slicing.ron", text.as_bytes()).unwrap();
    assert_eq!(read, document);
    assert_eq!(
        read.pictures().next(),
        Some(["elm.0.color.png", "elm.0.normal.png"])
    );
    let pictures: Vec<_> = (0..slicing.shape().orientations.len())
        .map(|i| slicing.pictures(i))
        .collect();
    assert_eq!(read.assemble("elm.slicing.ron", &pictures), Ok(slicing));
}

#[test]
fn files_that_ask_for_nonsense_are_refused_by_name() {
    let text = SlicingDocument::describe(&tiny(), "elm").to_ron();
    let cases = [
        ("pixels: 16", "pixels: 17", "elm.slicing.ron: pixels is 17"),
        ("pixels: 16", "pixels: 4294967295", "pixels is 4294967295"),
        ("        2,\n", "        0,\n", "the number of slices is 0"),
        (
            "        2,\n",
            "        1000000,\n",
            "the number of slices is 1000000",
        ),
        (
            "transmission: 0.0",
            "transmission: 1.5",
            "diffuse transmission is 1.5",
        ),
        ("radius:", "radius: NaN, //", "radius is NaN"),
        (
            "switches: [\n        10.0,",
            "switches: [\n        10.0, 11.0, 30.0",
            "one switch fewer",
        ),
        ("sphere: false", "sphere: maybe", "elm.slicing.ron, line"),
        ("sphere: false", "round: false", "round"),
        ("direction: (1.0", "direction: (7.0", "orientation 0"),
        (
            "elm.1.normal.png",
            "..",
            "a picture of orientation 1 has no name",
        ),
        (
            "elm.0.color.png",
            "",
            "a picture of orientation 0 has no name",
        ),
    ];
    for (old, new, what) in cases {
        assert!(text.contains(old), "{old} in {text}");
        let wrong = text.replacen(old, new, 1);
        let error = SlicingDocument::parse("elm.slicing.ron", wrong.as_bytes()).unwrap_err();
        let message = error.to_string();
        assert!(
            message.starts_with("elm.slicing.ron") && message.contains(what),
            "{message}"
        );
    }
    for end in 0..text.trim_end().len() {
        assert!(SlicingDocument::parse("a", &text.as_bytes()[..end]).is_err());
    }
}

#[test]
fn pictures_of_another_size_or_kind_are_refused() {
    // The header of a picture of 65,535 × 65,535, and nothing after it: no pixels are unpacked to tell its size.
    let mut bomb = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR".to_vec();
    bomb.extend([0, 0, 255, 255, 0, 0, 255, 255]);
    let message = read_picture("elm.0.color.png", &bomb, [16, 48])
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("elm.0.color.png: is 65535 × 65535 pixels, where"),
        "{message}"
    );
    let message = read_picture("elm.0.color.png", b"GIF89a", [16, 48])
        .unwrap_err()
        .to_string();
    assert!(message.contains("does not begin as a PNG"), "{message}");
    // Two channels of 16 bits take as many bytes as four of 8.
    let mut gray = std::io::Cursor::new(Vec::new());
    image::DynamicImage::new_luma_a16(16, 48)
        .write_to(&mut gray, image::ImageFormat::Png)
        .unwrap();
    let message = read_picture("elm.0.color.png", gray.get_ref(), [16, 48])
        .unwrap_err()
        .to_string();
    assert!(message.contains("not of 8 bits"), "{message}");
    let slicing = tiny();
    let document = SlicingDocument::describe(&slicing, "elm");
    let error = document
        .assemble("elm.slicing.ron", &[])
        .unwrap_err()
        .to_string();
    assert!(error.contains("the pictures have 0 pixels"), "{error}");
}

proptest! {
    #[test]
    fn any_text_is_read_or_refused(
        text in "[-(){}\\[\\]:, a-z0-9.\"]{0,200}",
        at in 0_usize..900,
        byte in any::<u8>(),
    ) {
        let _ = SlicingDocument::parse("a", text.as_bytes());
        let mut right = SlicingDocument::describe(&tiny(), "elm").to_ron().into_bytes();
        let at = at % right.len();
        right[at] = byte;
        let _ = SlicingDocument::parse("a", &right);
    }

    #[test]
    fn any_bytes_are_a_picture_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..80)) {
        let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\x10\0\0\0\x30".to_vec();
        png.extend(&bytes);
        prop_assert!(read_picture("a", &png, [16, 48]).is_err());
    }
}

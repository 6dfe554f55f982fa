//! Reading a skeleton from the bytes of a file, whichever kind it is.

use super::error::{SkeletonFileError, SkeletonFileErrorKind};
use super::settings::SkeletonLoaderSettings;
use super::skeleton::Skeleton;
use super::text::decode;
use super::{document, qsm, swc};

/// What a file may end in, without the first dot. `*.ron` is read as `*.skeleton.ron` too, where there is
/// no asset server to tell them apart.
pub(super) const EXTENSIONS: &[&str] = &["skeleton.ron", "swc", "csv"];

/// Reads a skeleton from the `bytes` of the file at `path`.
///
/// The end of `path` says what they are, in capital or small letters: `.ron` (also `.skeleton.ron`), `.swc`
/// or `.csv`. Nothing is opened: `path` otherwise only names the file in errors. `settings` apply to SWC and
/// CSV; see [`skeleton`](super) for the formats.
///
/// Any bytes give a skeleton or an error, in time and memory in proportion to their number, of which there
/// may be [`MAX_FILE_BYTES`](super::MAX_FILE_BYTES).
///
/// # Errors
/// When the file is too large, not text in UTF-8, not what its name says, or when its joints do not make a
/// skeleton. The error names the file, the line or joint, and what to do.
pub fn skeleton_from_bytes(
    path: &str,
    bytes: &[u8],
    settings: &SkeletonLoaderSettings,
) -> Result<Skeleton, SkeletonFileError> {
    read(path, bytes, settings).map_err(|error| error.in_file(path))
}

fn read(
    path: &str,
    bytes: &[u8],
    settings: &SkeletonLoaderSettings,
) -> Result<Skeleton, SkeletonFileError> {
    let extension = path.rsplit_once('.').map_or("", |(_, extension)| extension);
    match extension.to_ascii_lowercase().as_str() {
        "ron" => document::read(decode(bytes)?),
        "swc" => {
            settings.validate()?;
            swc::read(decode(bytes)?, settings)
        }
        "csv" => {
            settings.validate()?;
            qsm::read(decode(bytes)?, settings)
        }
        _ => Err(SkeletonFileErrorKind::UnknownExtension.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_chooses_the_format_and_its_up_axis() {
        let files = [
            (
                "a.skeleton.ron",
                "(joints: [(position: (0, 0, 0), radius: 1), (position: (0, 2, 0), radius: 1, parent: 0)])",
            ),
            ("b/c.d/a.SWC", "1 1 0 0 0 1 -1\n2 1 0 2 0 1 1"),
            ("a.csv", "sx,sy,sz,ex,ey,ez,radius,parent\n0,0,0,0,0,2,1,0"),
        ];
        let settings = SkeletonLoaderSettings::default();
        let [ron, swc, csv] = files
            .map(|(path, text)| skeleton_from_bytes(path, text.as_bytes(), &settings).unwrap());
        assert_eq!(ron, swc);
        assert_eq!(ron, csv);
    }

    #[test]
    fn unknown_extensions_are_refused_by_name() {
        for path in ["tree.obj", "tree", "", "dir.swc/tree"] {
            let error = skeleton_from_bytes(path, b"", &SkeletonLoaderSettings::default());
            let message = error.unwrap_err().to_string();
            assert!(
                message.starts_with(path) && message.contains("*.swc"),
                "{message}"
            );
        }
    }

    #[test]
    fn settings_are_checked_before_they_are_used() {
        let settings = SkeletonLoaderSettings {
            scale: 0.0,
            ..Default::default()
        };
        for path in ["a.swc", "a.csv"] {
            let message = skeleton_from_bytes(path, b"1 1 0 0 0 1 -1", &settings)
                .unwrap_err()
                .to_string();
            assert!(message.contains("`scale` is 0"), "{message}");
        }
    }
}

//! The `*.texel.ron` document (format: see the module above).

use std::str;

use bevy::math::{UVec3, Vec3};
use ron::error::{Error as RonError, SpannedError};
use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};

use super::super::progress::Progress;
use super::super::thickness::Thickness;
use super::super::topology::Topology;
use super::super::volume::{ReferenceVolume, VolumeParts, check_size};
use super::error::{TexelFileError, TexelFileErrorKind};
use super::{MAX_DOCUMENT_BYTES, images};
use crate::ron_text::{options, reaches_end};

/// Levels of brackets that a file may nest.
const RECURSION_LIMIT: usize = 16;

/// Longest message of the RON parser that is passed on, in characters.
const MAX_MESSAGE: usize = 240;

/// What a `*.texel.ron` file says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename = "Texel", deny_unknown_fields)]
pub struct TexelDocument {
    /// Voxels along u, v and w.
    pub size: UVec3,
    /// Lengths of the box along u, v and w, in metres.
    pub lengths: Vec3,
    /// How copies meet.
    pub topology: Topology,
    /// How many slices there are in a row of the images.
    #[serde(default = "one")]
    pub columns: u32,
    /// Name of the image of colours.
    pub colors: String,
    /// Name of the image of normals.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normals: Option<String>,
    /// e along u, v and w, in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness: Option<Thickness>,
}

fn one() -> u32 {
    1
}

impl TexelDocument {
    /// The document of a volume and the bytes of its images, colours and normals. Images are named after `stem`.
    pub fn of(volume: &ReferenceVolume, stem: &str) -> (Self, [Vec<u8>; 2]) {
        let size = volume.size();
        let columns = images::columns(size);
        let document = Self {
            size,
            lengths: volume.lengths(),
            topology: volume.topology(),
            columns,
            colors: format!("{stem}.color.png"),
            normals: Some(format!("{stem}.normal.png")),
            thickness: Some(volume.thickness()),
        };
        let colors = images::encode(volume.colors(), size, columns, 4);
        let normals = images::encode(volume.normals(), size, columns, 3);
        (document, [colors, normals])
    }

    /// Its text.
    pub fn to_ron(&self) -> String {
        let layout = PrettyConfig::new().depth_limit(1).new_line("\n");
        let mut text = options(RECURSION_LIMIT)
            .to_string_pretty(self, layout)
            .expect("plain numbers and names can always be written");
        text.push('\n');
        text
    }

    /// Reads a document. `path` names the file in errors.
    ///
    /// # Errors
    /// When the bytes are not such a document in RON, or what it says cannot be a volume.
    pub fn from_ron(path: &str, bytes: &[u8]) -> Result<Self, TexelFileError> {
        let fail = |kind: TexelFileErrorKind| TexelFileError::new(path, kind);
        if bytes.len() > MAX_DOCUMENT_BYTES {
            return Err(fail(TexelFileErrorKind::TooLarge));
        }
        let text = str::from_utf8(bytes).map_err(|_| fail(TexelFileErrorKind::NotUtf8))?;
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
        let document: Self =
            options(RECURSION_LIMIT)
                .from_str(text)
                .map_err(|error| TexelFileError {
                    line: Some(error.span.end.line as u64),
                    ..fail(explain(&error, text))
                })?;
        document.check().map_err(fail)?;
        Ok(document)
    }

    fn check(&self) -> Result<(), TexelFileErrorKind> {
        check_size(self.size, self.lengths)?;
        let (columns, slices) = (self.columns, self.size.z);
        if columns == 0 || !slices.is_multiple_of(columns) {
            return Err(TexelFileErrorKind::Columns { columns, slices });
        }
        for name in [Some(&self.colors), self.normals.as_ref()]
            .into_iter()
            .flatten()
        {
            if name.is_empty() || name.contains(['/', '\\']) || name == ".." {
                return Err(TexelFileErrorKind::ImageName { name: name.clone() });
            }
        }
        match self.thickness {
            Some(Thickness { narrowest: e }) if !e.is_finite() || e.min_element() <= 0.0 => {
                Err(TexelFileErrorKind::Thickness)
            }
            _ => Ok(()),
        }
    }

    /// Makes the volume from the bytes of the images. `path` is that of the document.
    ///
    /// # Errors
    /// When the document says what cannot be a volume, as one of a file does, an image is no PNG of the size that slices ask
    /// for, or the voxels make no volume.
    pub fn volume(
        &self,
        path: &str,
        colors: &[u8],
        normals: Option<&[u8]>,
        progress: Progress,
    ) -> Result<ReferenceVolume, TexelFileError> {
        // Whoever made it in code may have written anything into its fields.
        self.check()
            .map_err(|kind| TexelFileError::new(path, kind))?;
        let beside = |name: &str| match path.rfind(['/', '\\']) {
            Some(end) => format!("{}{name}", &path[..=end]),
            None => name.to_owned(),
        };
        let decode = |name: &str, bytes: &[u8]| {
            images::decode(bytes, self.size, self.columns)
                .map_err(|kind| TexelFileError::new(beside(name), kind))
        };
        let mut colors = decode(&self.colors, colors)?;
        for [.., alpha] in &mut colors {
            *alpha = if *alpha >= 128 { 255 } else { 0 };
        }
        let normals = match (normals, &self.normals) {
            (Some(bytes), Some(name)) => decode(name, bytes)?,
            _ => vec![[128, 128, 255, 255]; colors.len()],
        };
        let parts = VolumeParts {
            size: self.size,
            lengths: self.lengths,
            topology: self.topology,
            colors,
            normals,
        };
        let volume = match self.thickness {
            Some(thickness) => ReferenceVolume::with_thickness(parts, thickness),
            None => ReferenceVolume::new(parts, progress),
        };
        volume.map_err(|error| TexelFileError::new(path, error))
    }
}

/// Says what to do about an error of the RON parser in `text`.
fn explain(error: &SpannedError, text: &str) -> TexelFileErrorKind {
    let fix = match error.code {
        _ if reaches_end(error, text) => "complete the file, which seems to be empty or cut short",
        RonError::ExpectedStringEnd => {
            "close the quotation, or complete the file, which seems to be cut short"
        }
        RonError::NoSuchStructField { .. } => "correct or remove the field",
        RonError::MissingStructField { .. } => "add the field",
        RonError::DuplicateStructField { .. } => "keep one of them",
        RonError::NoSuchEnumVariant { .. } => "write `Tiling` or `Isolated`",
        RonError::ExpectedFloat | RonError::ExpectedInteger | RonError::IntegerOutOfBounds => {
            "write a number such as 64, or 0.5 for a length"
        }
        RonError::Message(_) => "correct the value",
        _ => {
            "write `(size: (64, 64, 32), lengths: (1, 1, 0.5), topology: Tiling, colors: \"name.png\")`"
        }
    };
    TexelFileErrorKind::Ron {
        message: error.code.to_string().chars().take(MAX_MESSAGE).collect(),
        fix,
    }
}

//! What shapes the frusta of a plant: its own settings, and the shell of its material's relief.

use super::component::Frusta;
use super::material::FrustaMaterial;
use super::single::shell::{ShellShape, Thickness};

/// A plant's settings and its shell. Plants of one skeleton that are shaped alike share their data.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Shaping {
    pub frusta: Frusta,
    shell: Option<ShellKey>,
}

/// A shell, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct ShellKey {
    relative: bool,
    thickness: u32,
    level: u32,
}

impl Shaping {
    /// That of a plant with these settings and this material.
    pub(crate) fn new(frusta: Frusta, material: Option<&FrustaMaterial>) -> Self {
        let relief = material.and_then(|material| material.extension.relief.as_ref());
        let shell = relief.and_then(|relief| relief.shell()).map(|shell| {
            let (relative, thickness) = match shell.thickness {
                Thickness::Metres(h) => (false, h),
                Thickness::Relative(share) => (true, share),
            };
            ShellKey {
                relative,
                thickness: thickness.to_bits(),
                level: shell.level.to_bits(),
            }
        });
        Self { frusta, shell }
    }

    /// The shell, if there is relief.
    pub(crate) fn shell(&self) -> Option<ShellShape> {
        self.shell.map(|shell| {
            let thickness = f32::from_bits(shell.thickness);
            ShellShape {
                thickness: if shell.relative {
                    Thickness::Relative(thickness)
                } else {
                    Thickness::Metres(thickness)
                },
                level: f32::from_bits(shell.level),
            }
        })
    }
}

//! Whether a reference volume may be repeated (§3, Figure 3): checked on its voxels.

use bevy::math::UVec3;
use serde::{Deserialize, Serialize};

use super::volume::ReferenceVolume;

/// How copies of a volume meet where the texture repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Topology {
    /// The shape goes on in the next copy: opposite sides along u and v fit, as on a torus.
    #[default]
    Tiling,
    /// The shape keeps away from the sides along u and v, so that copies do not touch.
    Isolated,
}

/// What the sides of a volume are like.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TopologyReport {
    /// Opaque voxels on the four sides along u and v.
    pub on_border: usize,
    /// The first of them.
    pub first_on_border: Option<UVec3>,
    /// The share of voxels, 0 to 1, that are opaque on one side of the seam between two copies and empty on the other.
    pub seam: f32,
    /// The same share between two neighbouring layers inside the volume: mean over all of them.
    pub inside: f32,
}

impl TopologyReport {
    /// Whether nothing reaches the sides.
    pub fn is_isolated(&self) -> bool {
        self.on_border == 0
    }

    /// Whether the seam between copies looks like any other place: it changes at most twice as much as neighbouring
    /// layers do on average.
    pub fn tiles(&self) -> bool {
        self.seam <= 2.0 * self.inside + f32::EPSILON
    }
}

impl ReferenceVolume {
    /// Looks at the sides along u and v.
    pub fn topology_report(&self) -> TopologyReport {
        let size = self.size();
        let (mut on_border, mut first_on_border) = (0, None);
        let (mut seam, mut seam_pairs) = (0usize, 0usize);
        let (mut inside, mut inside_pairs) = (0usize, 0usize);
        for z in 0..size.z {
            for y in 0..size.y {
                for x in 0..size.x {
                    let here = self.is_opaque(x, y, z);
                    let border = x == 0 || y == 0 || x == size.x - 1 || y == size.y - 1;
                    if border && here {
                        on_border += 1;
                        first_on_border.get_or_insert(UVec3::new(x, y, z));
                    }
                    let next_u = self.is_opaque((x + 1) % size.x, y, z) != here;
                    let next_v = self.is_opaque(x, (y + 1) % size.y, z) != here;
                    for (differs, at_seam) in [(next_u, x + 1 == size.x), (next_v, y + 1 == size.y)]
                    {
                        if at_seam {
                            seam += usize::from(differs);
                            seam_pairs += 1;
                        } else {
                            inside += usize::from(differs);
                            inside_pairs += 1;
                        }
                    }
                }
            }
        }
        TopologyReport {
            on_border,
            first_on_border,
            seam: seam as f32 / seam_pairs.max(1) as f32,
            inside: inside as f32 / inside_pairs.max(1) as f32,
        }
    }
}

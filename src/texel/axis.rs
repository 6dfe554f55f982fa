//! The three directions of slices (§4.2, Figure 8).

/// A direction in which a reference volume is cut into slices, and the axis of the volume that its slices are
/// perpendicular to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SliceAxis {
    /// Along the surface, in the direction in which u grows.
    U,
    /// Along the surface, in the direction in which v grows.
    V,
    /// Along the height vectors: the main set, whose slices are parallel to the surface.
    W,
}

impl SliceAxis {
    /// All three.
    pub const ALL: [Self; 3] = [Self::U, Self::V, Self::W];

    /// 0, 1 or 2.
    pub const fn index(self) -> usize {
        self as usize
    }

    /// The two axes in which a slice extends: the columns and the rows of its picture. Rows of upright slices go up
    /// along the height vectors.
    pub const fn in_plane(self) -> [Self; 2] {
        match self {
            Self::U => [Self::V, Self::W],
            Self::V => [Self::U, Self::W],
            Self::W => [Self::U, Self::V],
        }
    }

    /// Its name, for messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::U => "u",
            Self::V => "v",
            Self::W => "w",
        }
    }
}

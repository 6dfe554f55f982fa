//! How far a build has come.

/// What a build is at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BuildStep {
    /// The shape is cut into slices.
    Slicing,
    /// Contours are closed and the inside is marked.
    Filling,
    /// Colours spread inward.
    Spreading,
    /// The narrowest thickness is measured.
    Measuring,
}

impl BuildStep {
    /// All of them, in order.
    pub const ALL: [Self; 4] = [
        Self::Slicing,
        Self::Filling,
        Self::Spreading,
        Self::Measuring,
    ];

    /// Its name, for people.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Slicing => "slicing",
            Self::Filling => "filling",
            Self::Spreading => "spreading colour",
            Self::Measuring => "measuring",
        }
    }
}

/// What is told how far a step has come, 0 to 1. It is called from several threads.
pub type Progress<'a> = &'a (dyn Fn(BuildStep, f32) + Sync);

/// Tells nobody.
pub fn silent(_: BuildStep, _: f32) {}

//! How much a slicing may hold, so that no file and no setting takes memory or time out of proportion.

/// Most orientations of a slicing, the vertical one included.
pub const MAX_ORIENTATIONS: usize = 32;
/// Most slices of one orientation in one level of detail.
pub const MAX_SLICES: u32 = 64;
/// Most levels of detail.
pub const MAX_LEVELS: usize = 3;
/// Most pixels along a slice's side.
pub const MAX_PIXELS: u32 = 1024;
/// Most samples along a slice's side: half a gigabyte would go to each thread for twice as many.
pub const MAX_SAMPLES: u32 = 4096;
/// Most slices in all: what every device allows as layers of a texture.
pub const MAX_LAYERS: usize = 256;
/// Most pixels of all slices together.
pub const MAX_PIXELS_TOTAL: u64 = 1 << 26;
/// Most pixels of slicings that are gathered to be drawn at once, 8 of the default size: their pictures are written to the
/// GPU in one frame.
pub(crate) const MAX_SET_PIXELS: u64 = 1 << 25;

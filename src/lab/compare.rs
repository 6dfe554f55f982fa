//! The difference between two pictures, as a viewer flickering between them sees it.

/// Mean FLIP (Andersson et al. 2020) between two pictures of 8-bit sRGB colours: 0 for the same picture, 1 for black
/// against white.
///
/// # Panics
/// If the pictures differ in size.
pub fn mean_flip(size: (u32, u32), reference: &[u8], test: &[u8]) -> f32 {
    let picture = |bytes: &[u8]| nv_flip::FlipImageRgb8::with_data(size.0, size.1, bytes);
    let error = nv_flip::flip(
        picture(reference),
        picture(test),
        nv_flip::DEFAULT_PIXELS_PER_DEGREE,
    );
    nv_flip::FlipPool::from_image(&error).mean()
}

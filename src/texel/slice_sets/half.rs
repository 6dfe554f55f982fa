//! The next mip level of a slice: sums over its pixels.

/// Sides of the next level, in pixels. Sides are powers of two.
pub(super) fn halved(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| (side / 2).max(1))
}

/// Sums of 2×2 pixels, or of two where one side is a pixel already.
pub(super) fn half<T: Default>(pixels: &[T], size: [u32; 2], add: impl Fn(&mut T, &T)) -> Vec<T> {
    let halved = halved(size);
    let steps = [size[0] / halved[0], size[1] / halved[1]];
    let mut sums = Vec::with_capacity((halved[0] * halved[1]) as usize);
    for row in 0..halved[1] {
        for column in 0..halved[0] {
            let mut sum = T::default();
            for dy in 0..steps[1] {
                for dx in 0..steps[0] {
                    let (x, y) = (column * steps[0] + dx, row * steps[1] + dy);
                    add(&mut sum, &pixels[(y * size[0] + x) as usize]);
                }
            }
            sums.push(sum);
        }
    }
    sums
}

//! A relief map: eight bits a pixel, repeated in both directions, bilinear in between.

/// A height image. Pixel (i, j) is centred on u = (i + ½)/width, v = (j + ½)/height.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct HeightImage {
    width: usize,
    height: usize,
    pixels: Vec<u8>,
}

impl HeightImage {
    /// An image of rows from v = 0 on.
    ///
    /// # Panics
    ///
    /// When there are no pixels, or not `width` × `height` of them.
    pub fn new(width: usize, height: usize, pixels: Vec<u8>) -> Self {
        assert!(
            !pixels.is_empty() && pixels.len() == width * height,
            "{} pixels are not {width} × {height}",
            pixels.len()
        );
        Self {
            width,
            height,
            pixels,
        }
    }

    /// The image of a function of (u, v) with values from 0 to 1.
    pub fn from_fn(width: usize, height: usize, heights: impl Fn(f64, f64) -> f64) -> Self {
        let at = |n: usize, size: usize| (n as f64 + 0.5) / size as f64;
        let pixels = (0..width * height).map(|n| {
            let value = heights(at(n % width, width), at(n / width, height));
            (255.0 * value.clamp(0.0, 1.0)).round() as u8
        });
        Self::new(width, height, pixels.collect())
    }

    /// H at any (u, v), from 0 to 1.
    pub fn sample(&self, u: f64, v: f64) -> f64 {
        let (left, right, x) = neighbours(u, self.width);
        let (low, high, y) = neighbours(v, self.height);
        let pixel = |i: usize, j: usize| f64::from(self.pixels[j * self.width + i]);
        let row = |j: usize| pixel(left, j) * (1.0 - x) + pixel(right, j) * x;
        (row(low) * (1.0 - y) + row(high) * y) / 255.0
    }
}

/// The two pixels about a coordinate, and how far it is from the first to the second.
fn neighbours(coordinate: f64, size: usize) -> (usize, usize, f64) {
    let x = coordinate.rem_euclid(1.0) * size as f64 - 0.5;
    let first = x.floor();
    let wrap = |i: f64| i.rem_euclid(size as f64) as usize;
    (wrap(first), wrap(first + 1.0), x - first)
}

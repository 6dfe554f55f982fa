//! Slices are trimmed to their opaque part: empty pixels cost fill.

use bevy::math::Vec2;

/// Corners of a trimmed slice.
pub const CORNERS: usize = 8;

/// A convex octagon in texture coordinates, counter-clockwise with v down the picture; corners may coincide. All zero
/// where a slice is empty.
pub type Octagon = [Vec2; CORNERS];

/// The octagon with sides along the axes and the diagonals that encloses all pixels for which `is_opaque` holds, with
/// `margin` pixels to spare for filtering, cut to the picture of `size` × `size` pixels.
pub fn octagon(size: u32, margin: f32, is_opaque: impl Fn(u32, u32) -> bool) -> Octagon {
    // Greatest of x, x + y, y, y − x, −x, −x − y, −y, x − y over the pixels' corners, in pixels.
    let mut support = [f32::NEG_INFINITY; 8];
    for y in 0..size {
        let mut row = (0..size).filter(|x| is_opaque(*x, y));
        let Some(first) = row.next() else { continue };
        let last = row.next_back().unwrap_or(first);
        for x in [first as f32, last as f32 + 1.0] {
            for y in [y as f32, y as f32 + 1.0] {
                let along = [x, x + y, y, y - x, -x, -x - y, -y, x - y];
                for (support, along) in support.iter_mut().zip(along) {
                    *support = support.max(along);
                }
            }
        }
    }
    if support[0] == f32::NEG_INFINITY {
        return [Vec2::ZERO; CORNERS];
    }
    let side = size as f32;
    let bounds = [side, 2.0 * side, side, side, 0.0, 0.0, 0.0, side];
    for (i, (support, bound)) in support.iter_mut().zip(bounds).enumerate() {
        // A diagonal side moves by the margin where its sum or difference grows by √2 of it.
        let margin = if i % 2 == 1 {
            margin * 2.0_f32.sqrt()
        } else {
            margin
        };
        *support = (*support + margin).min(bound);
    }
    let [e, mut se, s, mut sw, w, mut nw, n, mut ne] = support;
    // Where the picture's edge cuts off the margin, the diagonals end on its corner.
    se = se.min(e + s);
    sw = sw.min(s + w);
    nw = nw.min(w + n);
    ne = ne.min(e + n);
    // Each side meets the next: x = e with x + y = se, and so on round.
    let corners = [
        Vec2::new(e, se - e),
        Vec2::new(se - s, s),
        Vec2::new(s - sw, s),
        Vec2::new(-w, sw - w),
        Vec2::new(-w, w - nw),
        Vec2::new(n - nw, -n),
        Vec2::new(ne - n, -n),
        Vec2::new(e, e - ne),
    ];
    corners.map(|corner| (corner / side).clamp(Vec2::ZERO, Vec2::ONE))
}

/// Area of an octagon, as a share of the whole picture.
pub fn area(octagon: &Octagon) -> f32 {
    let next = octagon.iter().cycle().skip(1);
    let twice: f32 = octagon.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum();
    0.5 * twice
}

/// Whether a place lies in an octagon.
pub fn contains(octagon: &Octagon, place: Vec2) -> bool {
    let next = octagon.iter().cycle().skip(1);
    let mut sides = octagon.iter().zip(next);
    // A side that has shrunk to a point cuts nothing off; rounding may cost a side 2⁻²² of the picture.
    area(octagon) > 0.0 && sides.all(|(a, b)| (*b - *a).perp_dot(place - *a) >= -1e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(x: u32, y: u32) -> bool {
        let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        at.distance(Vec2::splat(32.0)) < 20.0
    }

    #[test]
    fn an_octagon_encloses_all_that_is_opaque_and_little_more() {
        let shapes: [fn(u32, u32) -> bool; 6] = [
            disc,
            |x, y| x == 0 && y == 63,
            |_, _| true,
            |x, y| x + y == 63,
            |x, y| x == y,
            |x, y| (x, y) == (63, 0) || (x, y) == (10, 30),
        ];
        for is_opaque in shapes {
            for margin in [0.0, 2.0] {
                let trimmed = octagon(64, margin, is_opaque);
                assert!(area(&trimmed) > 0.0 && area(&trimmed) <= 1.0);
                for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
                    let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / 64.0;
                    assert!(
                        !is_opaque(x, y) || contains(&trimmed, centre),
                        "{x}, {y}: {trimmed:?}"
                    );
                }
            }
        }
        // Of a disc's circumscribed octagon, area 8 r² tan 22.5° (r of 20, and up to a pixel's corner).
        let least = 8.0 * 20.0 * 20.0 * 22.5_f32.to_radians().tan() / 4096.0;
        let trimmed = area(&octagon(64, 0.0, disc));
        assert!(trimmed < least * (21.0 / 20.0) * (21.0 / 20.0), "{trimmed}");
    }

    #[test]
    fn an_empty_slice_has_no_area() {
        let trimmed = octagon(16, 2.0, |_, _| false);
        assert_eq!(area(&trimmed), 0.0);
        assert!(!contains(&trimmed, Vec2::ZERO));
    }
}

//! Which direction of slices to draw, and how many of them (§4.1 to §4.3).
//!
//! Symbols are the paper's: c, the cosine of the angle a between the view direction and the normal of the slices; L,
//! the length of one texel along that normal; N, the number of slices; h = L/N, their distance; e, the narrowest
//! thickness of contours; d, how deep one may see into a contour; p, the distance of slices on screen, in pixels; z,
//! the depth of the texel from the eye; f, the distance of the screen from the eye in pixels. L, h, e, d and z are
//! lengths of one unit.

/// The tangent of the view angle, √(1 − c²)/c; infinite along the slices. Any sign of c will do.
pub fn tan_view_angle(c: f32) -> f32 {
    sin_view_angle(c) / c.abs()
}

/// The sine of the view angle.
pub fn sin_view_angle(c: f32) -> f32 {
    (1.0 - c * c).max(0.0).sqrt()
}

/// What the best direction has least of: (1/c² − 1)·h², the square of h·tan(a) (§4.2). Infinite along the slices.
pub fn direction_cost(c: f32, h: f32) -> f32 {
    let c2 = c * c;
    // Not 1/c² − 1, which is not exactly zero or more at |c| = 1 and cancels near it.
    (1.0 - c2).max(0.0) / c2 * (h * h)
}

/// The direction with the smallest cost; the later one of equals, so that the slices parallel to the surface win.
pub fn choose_direction(c: [f32; 3], h: [f32; 3]) -> usize {
    cheapest([0, 1, 2].map(|i| direction_cost(c[i], h[i])))
}

/// The smallest of three costs; the later one of equals.
pub fn cheapest(cost: [f32; 3]) -> usize {
    let mut best = 2;
    for i in [1, 0] {
        if cost[i] < cost[best] {
            best = i;
        }
    }
    best
}

/// The gap criterion, h·tan(a)/e: no gap can show up to 1 (§4.1, Figure 7 left).
pub fn gap_ratio(h: f32, tan_a: f32, e: f32) -> f32 {
    h * tan_a / e
}

/// The largest d that §4.1 allows, e/2: from deeper inside, colours are nearer to those of the opposite side (Figure 7
/// right).
pub fn depth_limit(e: f32) -> f32 {
    e * 0.5
}

/// How many slices show no deeper than d: N ≥ L·tan(a)/d (§4.3).
pub fn slices_for_depth(l: f32, tan_a: f32, d: f32) -> f32 {
    l * tan_a / d
}

/// How many slices are no more than p pixels apart: h·sin(a)/(z/f) ≤ p (§4.3), which is N ≥ L·sin(a)/(z/f)/p.
pub fn slices_for_pixels(l: f32, sin_a: f32, z: f32, f: f32, p: f32) -> f32 {
    l * sin_a / (z / f) / p
}

/// The exponent of the power of two that a number of slices is rounded up to, from 1 to `most`, itself a power of
/// two. What is no number becomes `most`.
pub fn count_exponent(slices: f32, most: u32) -> u32 {
    let most = most.max(1).ilog2();
    let mut exponent = 0;
    // Not by log2, which rounds.
    let enough = |exponent: u32| slices <= (1u32 << exponent) as f32;
    while exponent < most && !enough(exponent) {
        exponent += 1;
    }
    exponent
}

/// The last part of the way to the next count, and to the next direction, in which one turns into the other. Twice the
/// slices of a count are drawn meanwhile, and those of both directions: a longer part would draw more, a sixteenth would
/// pop.
pub const FADE: f32 = 0.09375;

/// How far twice as many slices have moved apart before they are needed, where 2^`exponent` still do: 0 to 1. So nothing
/// pops when the count doubles, and slices are never further apart than asked for.
pub fn finer_share(slices: f32, exponent: u32, most: u32) -> f32 {
    if 1u32 << (exponent + 1) > most {
        return 0.0;
    }
    let used = slices / (1u32 << exponent) as f32;
    ((used - (1.0 - FADE)) / FADE).clamp(0.0, 1.0)
}

/// The share of the second best direction, 0 to ½, given the costs of the best and of the second: ½ where both are alike, so
/// that nothing pops when they change places.
pub fn second_share(best: f32, second: f32) -> f32 {
    // Both may be zero, or infinite.
    if best == second {
        return 0.5;
    }
    let alike = best / second;
    0.5 * ((alike - (1.0 - FADE)) / FADE).clamp(0.0, 1.0)
}

/// The lots, from the first to the second of 0 to 1, that each direction gets of a view's pixels: all of them if it is the
/// best by far, none if it is not, and a share where the second best is nearly as good.
pub fn lots_of_directions(cost: [f32; 3]) -> [[f32; 2]; 3] {
    let best = cheapest(cost);
    let mut others = cost;
    others[best] = f32::MAX;
    let second = cheapest(others);
    let mut lots = [[0.0; 2]; 3];
    let share = second_share(cost[best], cost[second]);
    // The direction of the lower index gets the lower lots, so that both share all of them.
    if best < second {
        (lots[best], lots[second]) = ([0.0, 1.0 - share], [1.0 - share, 1.0]);
    } else {
        (lots[second], lots[best]) = ([0.0, share], [share, 1.0]);
    }
    lots
}

/// How many slices to draw: as many as either criterion asks for, the one that is content with fewer, rounded up to a
/// power of two of at most `most`. Slices that are close enough on screen need not be closer, however deep one sees.
pub fn slice_count(for_depth: f32, for_pixels: f32, most: u32) -> u32 {
    1 << count_exponent(for_depth.min(for_pixels), most)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Angles from 0 to nearly a right angle.
    fn angles() -> impl Iterator<Item = f32> {
        (0..90).map(|degrees| (degrees as f32).to_radians())
    }

    #[test]
    fn the_view_angle_comes_from_its_cosine() {
        for a in angles() {
            // The cosine is rounded by 2⁻²⁵; its arc moves by that over sin(a), and the tangent by that over cos².
            let bound = 1e-6 / a.sin().max(1e-3) / a.cos().powi(2);
            assert!(
                (tan_view_angle(a.cos()) - a.tan()).abs() < bound.max(4e-4),
                "{a}"
            );
            assert!(
                (tan_view_angle(-a.cos()) - a.tan()).abs() < bound.max(4e-4),
                "{a}"
            );
        }
        assert_eq!(tan_view_angle(0.0), f32::INFINITY);
        assert_eq!(tan_view_angle(1.0 + f32::EPSILON), 0.0);
    }

    #[test]
    fn the_cost_of_a_direction_is_the_square_of_its_step_aside() {
        for a in angles().skip(1) {
            let step = 0.3 * a.tan();
            assert!(
                (direction_cost(a.cos(), 0.3) / (step * step) - 1.0).abs() < 1e-3,
                "{a}"
            );
        }
        assert_eq!(direction_cost(1.0, 0.3), 0.0);
        assert_eq!(direction_cost(0.0, 0.3), f32::INFINITY);
    }

    #[test]
    fn with_equal_steps_the_direction_nearest_the_view_is_best() {
        for i in 0..1000 {
            let turn = i as f32 * 2.4;
            let z = (i as f32 + 0.5) / 500.0 - 1.0;
            let r = (1.0 - z * z).sqrt();
            let c = [r * turn.cos(), r * turn.sin(), z];
            let chosen = choose_direction(c, [0.1; 3]);
            assert!(
                c.iter().all(|other| other.abs() <= c[chosen].abs()),
                "{c:?}"
            );
        }
    }

    #[test]
    fn finer_slices_win_over_a_better_angle() {
        // At 45° both are alike; slices twice as fine are taken up to tan(a) = 2 from their normal.
        let c = |degrees: f32| [degrees.to_radians().cos(), 0.0, degrees.to_radians().sin()];
        assert_eq!(choose_direction(c(45.0 - 1.0), [0.1, 0.1, 0.1]), 0);
        assert_eq!(choose_direction(c(45.0 + 1.0), [0.1, 0.1, 0.1]), 2);
        let even = 0.5f32.sqrt().atan().to_degrees();
        assert_eq!(choose_direction(c(even - 1.0), [0.1, 0.1, 0.05]), 0);
        assert_eq!(choose_direction(c(even + 1.0), [0.1, 0.1, 0.05]), 2);
    }

    #[test]
    fn the_paper_s_own_example_holds() {
        // §4.1: a = π/3 and e = 3 pixels ask for slices less than 0.9 pixels apart.
        let tan_a = core::f32::consts::FRAC_PI_3.tan();
        let n = slices_for_depth(64.0, tan_a, depth_limit(3.0));
        let h = 64.0 / n;
        assert!((h - 0.866).abs() < 1e-3, "{h}");
        // Half the thickness is half way to a gap.
        assert!((gap_ratio(h, tan_a, 3.0) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn as_many_slices_as_asked_for_meet_the_criterion() {
        for a in angles().skip(1) {
            for n in [1.5, 3.0, 17.0, 60.0f32] {
                let (l, f, p) = (0.5, 900.0, 1.0);
                // The depth at which n slices are p pixels apart.
                let z = l / n * a.sin() * f / p;
                let needed = slices_for_pixels(l, a.sin(), z, f, p);
                assert!((needed / n - 1.0).abs() < 1e-5);
                let count = slice_count(f32::INFINITY, needed * 0.999, 64);
                assert!(l / count as f32 * a.sin() / (z / f) <= p * 1.001);
                assert!(
                    count < 2 * n.ceil() as u32,
                    "no more than rounding up asks for"
                );
            }
        }
    }

    #[test]
    fn shares_go_on_where_counts_and_directions_change() {
        for exponent in 0..5 {
            let switch = (1 << exponent) as f32;
            assert_eq!(finer_share(switch, exponent, 64), 1.0);
            assert_eq!(finer_share(switch * 1.001, exponent + 1, 64), 0.0);
            assert_eq!(finer_share(switch * (1.0 - FADE), exponent, 64), 0.0);
        }
        assert_eq!(finer_share(64.0, 6, 64), 0.0, "there are no more");
        assert_eq!(second_share(2.0, 2.0), 0.5);
        assert_eq!(second_share(0.0, 0.0), 0.5);
        assert_eq!(second_share(1.0 - FADE, 1.0), 0.0);
        assert_eq!(second_share(0.1, f32::INFINITY), 0.0);
        assert_eq!(second_share(f32::INFINITY, f32::INFINITY), 0.5);
    }

    #[test]
    fn directions_share_all_lots() {
        let near = 1.0 - 0.4 * FADE;
        let cases = [
            ([1.0, 9.0, 9.0], [[0.0, 1.0], [0.0, 0.0], [1.0, 1.0]]),
            ([9.0, 1.0, 1.0], [[0.0, 0.0], [0.0, 0.5], [0.5, 1.0]]),
            ([near, 9.0, 1.0], [[0.0, 0.7], [0.0, 0.0], [0.7, 1.0]]),
            ([1.0, 9.0, near], [[0.0, 0.3], [0.0, 0.0], [0.3, 1.0]]),
        ];
        for (cost, expected) in cases {
            let lots = lots_of_directions(cost);
            for (lots, expected) in lots.as_flattened().iter().zip(expected.as_flattened()) {
                assert!((lots - expected).abs() < 1e-5, "{cost:?}: {lots}");
            }
        }
        let infinite = lots_of_directions([f32::INFINITY; 3]);
        assert_eq!(
            infinite
                .as_flattened()
                .iter()
                .filter(|lot| lot.is_nan())
                .count(),
            0
        );
    }

    #[test]
    fn counts_are_powers_of_two_within_their_bounds() {
        let cases = [
            (0.0, 1),
            (1.0, 1),
            (1.01, 2),
            (2.0, 2),
            (33.0, 64),
            (64.0, 64),
            (65.0, 64),
        ];
        for (slices, count) in cases {
            assert_eq!(slice_count(slices, f32::INFINITY, 64), count, "{slices}");
            assert_eq!(slice_count(f32::INFINITY, slices, 64), count, "{slices}");
        }
        assert_eq!(1 << count_exponent(f32::NAN, 64), 64);
        assert_eq!(1 << count_exponent(f32::INFINITY, 64), 64);
        assert_eq!(1 << count_exponent(-1.0, 64), 1);
    }
}

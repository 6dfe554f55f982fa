//! From values to places on an axis, and the ticks of it.

use super::{Axis, Scale};

/// Ticks an axis has at most.
const MOST_TICKS: f64 = 10.0;
/// Ticks a logarithmic axis has at least; with fewer decades it is divided further.
const LEAST_TICKS: usize = 4;

/// The part of an axis that is shown. Positions are values, or their decimal logarithms.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Span {
    scale: Scale,
    floor: Option<f64>,
    low: f64,
    high: f64,
}

impl Span {
    /// A span that holds all values that can be shown, and ends on ticks where that costs little room.
    pub fn new(axis: &Axis, values: impl Iterator<Item = f64>) -> Self {
        let mut span = Self {
            scale: axis.scale,
            floor: axis.floor,
            low: f64::INFINITY,
            high: f64::NEG_INFINITY,
        };
        for value in values {
            if let Some(position) = span.position(value) {
                span.low = span.low.min(position);
                span.high = span.high.max(position);
            }
        }
        if span.low > span.high {
            (span.low, span.high) = (0.0, 1.0);
        }
        if span.low == span.high {
            let half = if span.low == 0.0 || span.scale == Scale::Log {
                1.0
            } else {
                0.5 * span.low.abs()
            };
            (span.low, span.high) = (span.low - half, span.high + half);
        }
        let mut step = step(span.high - span.low);
        if span.scale == Scale::Log {
            step = step.max(1.0);
        }
        if span.scale == Scale::Linear || span.high - span.low > 2.0 {
            span.low = (span.low / step + 1e-9).floor() * step;
            span.high = (span.high / step - 1e-9).ceil() * step;
        } else {
            let room = 0.05 * (span.high - span.low);
            (span.low, span.high) = (span.low - room, span.high + room);
        }
        span
    }

    fn position(&self, value: f64) -> Option<f64> {
        let value = self.floor.map_or(value, |floor| value.max(floor));
        let position = match self.scale {
            Scale::Linear => value,
            Scale::Log if value > 0.0 => value.log10(),
            Scale::Log => return None,
        };
        position.is_finite().then_some(position)
    }

    /// Where a value lies, from 0 to 1; `None` for one that cannot be shown.
    pub fn at(&self, value: f64) -> Option<f64> {
        // Not a number stays none: `max` with the floor would make it one.
        let value = Some(value).filter(|value| !value.is_nan())?;
        Some((self.position(value)? - self.low) / (self.high - self.low))
    }

    /// The values of the ticks, in order.
    pub fn ticks(&self) -> Vec<f64> {
        let step = step(self.high - self.low);
        let multiples = |step: f64| {
            let first = (self.low / step - 1e-6).ceil() as i64;
            let last = (self.high / step + 1e-6).floor() as i64;
            (first..=last).map(move |i| i as f64 * step)
        };
        if self.scale == Scale::Linear {
            return multiples(step).collect();
        }
        let decades: Vec<_> = multiples(step.max(1.0)).map(power_of_ten).collect();
        if decades.len() >= LEAST_TICKS {
            return decades;
        }
        let divided: Vec<_> = ((self.low.floor() as i64)..=(self.high.ceil() as i64))
            .flat_map(|decade| [1.0, 2.0, 5.0].map(|share| share * power_of_ten(decade as f64)))
            .filter(|&value| self.at(value).is_some_and(|at| (0.0..=1.0).contains(&at)))
            .collect();
        if divided.len() >= LEAST_TICKS {
            return divided;
        }
        // Less than a decade: even steps of the values themselves.
        let linear = Self {
            scale: Scale::Linear,
            floor: None,
            low: power_of_ten(self.low),
            high: power_of_ten(self.high),
        };
        linear.ticks()
    }

    /// What is written beside a tick.
    pub fn tick_label(&self, tick: f64) -> String {
        let size = tick.abs();
        if size != 0.0 && !(1e-3..1e4).contains(&size) {
            let short = format!("{tick:.0e}");
            // Ticks are multiples of 1, 2 or 5, and those above ten steps have two digits.
            let is_exact = short
                .parse::<f64>()
                .is_ok_and(|rounded| (rounded - tick).abs() < 1e-6 * size);
            return if is_exact {
                short
            } else {
                format!("{tick:.1e}")
            };
        }
        // As many decimals as the tick has, once what binary fractions add is taken off.
        format!("{}", (tick * 1e6).round() / 1e6)
    }
}

fn power_of_ten(exponent: f64) -> f64 {
    // Exact for whole exponents, unlike `powf`.
    format!("1e{}", exponent.round())
        .parse()
        .ok()
        .filter(|_| exponent.fract() == 0.0)
        .unwrap_or_else(|| 10f64.powf(exponent))
}

/// The least of 1, 2, 5 times a power of ten that divides a length into few enough parts.
fn step(length: f64) -> f64 {
    let least = length / MOST_TICKS;
    let decade = power_of_ten(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .map(|share| share * decade)
        .into_iter()
        .find(|&step| step >= least * (1.0 - 1e-9))
        .unwrap_or(10.0 * decade)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn span(axis: &Axis, values: &[f64]) -> Span {
        Span::new(axis, values.iter().copied())
    }

    fn labels(span: &Span) -> Vec<String> {
        span.ticks()
            .iter()
            .map(|&tick| span.tick_label(tick))
            .collect()
    }

    #[test]
    fn linear_axes_have_round_ticks() {
        let span = span(&Axis::linear(""), &[0.0, 180.0]);
        let expected = [
            "0", "20", "40", "60", "80", "100", "120", "140", "160", "180",
        ];
        assert_eq!(labels(&span), expected);
        assert_eq!((span.at(0.0), span.at(180.0)), (Some(0.0), Some(1.0)));
    }

    #[test]
    fn ticks_beyond_what_is_written_out_differ() {
        let span = span(&Axis::linear(""), &[0.0, 18_000.0]);
        let labels = labels(&span);
        assert!(labels.contains(&"1.2e4".into()) && labels.contains(&"1e4".into()));
    }

    #[test]
    fn small_steps_are_written_without_what_binary_fractions_add() {
        let span = span(&Axis::linear(""), &[0.02, 0.61]);
        let expected = ["0", "0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7"];
        assert_eq!(labels(&span), expected);
    }

    #[test]
    fn logarithmic_axes_have_powers_of_ten() {
        let wide = span(&Axis::log(""), &[3e-8, 40.0]);
        assert!(wide.ticks().contains(&1e-8));
        for tick in wide.ticks() {
            assert_eq!(tick.log10().fract(), 0.0, "{tick}");
        }
        let narrow = span(&Axis::log(""), &[4.0, 256.0]);
        assert_eq!(labels(&narrow), ["5", "10", "20", "50", "100", "200"]);
        let less = span(&Axis::log(""), &[3.0, 6.0]);
        assert!(less.ticks().len() >= LEAST_TICKS, "{:?}", less.ticks());
    }

    #[test]
    fn what_cannot_be_shown_has_no_place_and_a_floor_gives_zero_one() {
        let log = span(&Axis::log(""), &[0.0, -1.0, f64::INFINITY, 1.0, 100.0]);
        assert_eq!(log.at(0.0), None);
        assert_eq!(log.at(f64::NAN), None);
        assert_eq!(log.at(f64::INFINITY), None);
        let at_one = log.at(1.0).unwrap();
        assert!((0.0..0.1).contains(&at_one), "{at_one}");
        let floored = span(&Axis::log("").with_floor(1e-3), &[0.0, 1.0]);
        assert_eq!(floored.at(0.0), Some(0.0));
        assert_eq!(floored.at(f64::NAN), None);
    }

    #[test]
    fn axes_without_extent_or_values_have_some() {
        for values in [&[][..], &[5.0], &[0.0]] {
            for axis in [Axis::linear(""), Axis::log("")] {
                let span = span(&axis, values);
                assert!(span.low < span.high && span.ticks().len() > 1, "{span:?}");
            }
        }
    }
}

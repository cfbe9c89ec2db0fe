//! Axes: ranges of values, with round numbers as ticks.
//!
//! Values that differ by rounding errors only are drawn as one value: an axis is given the size of the rounding errors,
//! does not magnify differences below it, and states this in its name.

/// Approximate number of ticks of a linear axis.
const TICKS: f64 = 6.0;
/// Approximate largest number of ticks of a logarithmic axis.
const MOST_TICKS: i32 = 9;
/// Part of the range that is added at both ends.
const MARGIN: f64 = 0.04;
/// Relative difference of values below which they count as equal.
const ROUNDING: f64 = 1e-12;

/// The function of the value to which the length along an axis is proportional.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scale {
    /// The value itself.
    Linear,
    /// Its logarithm to base ten.
    Logarithmic,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Axis {
    scale: Scale,
    /// Ends of the axis; for a logarithmic axis, their logarithms to base ten.
    low: f64,
    high: f64,
    /// If all values count as equal, a bound on their differences; otherwise `None`.
    constant: Option<f64>,
}

/// A tick of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tick {
    /// Position, from 0 at the lower end to 1 at the upper end.
    pub part: f64,
    /// Label.
    pub label: String,
}

impl Scale {
    fn place(self, value: f64) -> f64 {
        match self {
            Self::Logarithmic => value.log10(),
            Self::Linear => value,
        }
    }
}

impl Axis {
    /// Returns the axis that includes the given values, except those without a finite position. The values count as
    /// equal if they differ by at most `noise`, or by relative rounding errors.
    pub(crate) fn around(scale: Scale, values: impl Iterator<Item = f64>, noise: f64) -> Self {
        let places = values.map(|value| scale.place(value)).filter(|place| place.is_finite());
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Self { scale, low: -1.0, high: 1.0, constant: None };
        }
        let (range, largest) = (high - low, low.abs().max(high.abs()));
        if scale == Scale::Linear && range <= noise.max(ROUNDING * largest) {
            let (middle, room) = (0.5 * (low + high), if largest <= noise { 1.0 } else { 0.5 * largest });
            return Self {
                scale,
                low: middle - room,
                high: middle + room,
                constant: Some(range.max(largest.min(noise))),
            };
        }
        let margin = match scale {
            Scale::Linear => MARGIN * range,
            Scale::Logarithmic => (MARGIN * range).max(0.05),
        };
        Self { scale, low: low - margin, high: high + margin, constant: None }
    }

    /// Returns the position of a value, from 0 at the lower end to 1 at the upper end; 0.5 if all values count as
    /// equal.
    pub(crate) fn part(&self, value: f64) -> f64 {
        match self.constant {
            Some(_) => 0.5,
            None => (self.scale.place(value) - self.low) / (self.high - self.low),
        }
    }

    /// Whether a value has a finite position on the axis.
    pub(crate) fn has(&self, value: f64) -> bool {
        self.scale.place(value).is_finite()
    }

    /// Returns the middle of the range.
    pub(crate) fn middle(&self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Returns a name, with a remark if all values count as equal.
    pub(crate) fn named(&self, name: &str) -> String {
        match self.constant {
            Some(spread) if self.middle().abs() <= spread => format!("{name} = 0"),
            Some(_) => format!("{name}, constant"),
            None => name.to_owned(),
        }
    }

    /// Returns a bound on the differences that the axis does not show, in words; `None` if there are none.
    pub(crate) fn rounding(&self) -> Option<String> {
        self.constant.filter(|spread| *spread > 0.0).map(|spread| format!("rounding {}", below(spread)))
    }

    /// Returns the ticks, at round numbers within the range.
    pub(crate) fn ticks(&self) -> Vec<Tick> {
        let tick = |value: f64, label: String| Tick { part: self.part(value), label };
        if let Some(spread) = self.constant {
            let middle = self.middle();
            let zero = middle.abs() <= spread;
            let digits = 10f64.powf((middle.abs().log10()).floor() - 5.0);
            return vec![tick(middle, if zero { "0".into() } else { number(middle, digits) })];
        }
        match self.scale {
            Scale::Linear => {
                let step = round_step(self.high - self.low);
                let within = (self.low / step).ceil() as i64..=(self.high / step).floor() as i64;
                within.map(|k| k as f64 * step).map(|value| tick(value, number(value, step))).collect()
            }
            Scale::Logarithmic => self.decades().map(|(value, label)| tick(value, label)).collect(),
        }
    }

    /// Returns powers of ten with their labels; on a short axis, also two and five times these powers.
    fn decades(&self) -> impl Iterator<Item = (f64, String)> {
        let (low, high) = (self.low.floor() as i32, self.high.ceil() as i32);
        let factors: &[f64] = if self.high - self.low < 2.5 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let every = ((high - low) / MOST_TICKS + 1).max(1);
        let powers = (low..=high).filter(move |power| power.rem_euclid(every) == 0);
        let ticks = powers.flat_map(|power| factors.iter().map(move |factor| (*factor, power)));
        let (first, last) = (self.low, self.high);
        let value = |(factor, power): (f64, i32)| factor * 10f64.powi(power);
        let within = move |place: &(f64, i32)| (first..=last).contains(&value(*place).log10());
        ticks
            .filter(within)
            .map(move |(factor, power)| (value((factor, power)), scientific(&factor.to_string(), power)))
    }
}

/// Returns the distance of ticks in a range, about a sixth of it: one, two or five times a power of ten.
pub(crate) fn round_step(range: f64) -> f64 {
    let wanted = range.max(f64::MIN_POSITIVE) / TICKS;
    let power = 10f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0].map(|factor| factor * power).into_iter().find(|step| *step >= wanted).unwrap_or(10.0 * power)
}

/// Formats a number, with a minus sign (U+2212) and with as many digits as are needed to distinguish multiples of
/// `step`.
pub(crate) fn number(value: f64, step: f64) -> String {
    let rounded = (value / step).round() * step;
    if rounded == 0.0 {
        return "0".into();
    }
    let power = rounded.abs().log10().floor() as i32;
    if (step < 2e-5 && rounded.abs() < 1e-3) || rounded.abs() >= 1e6 {
        let digits = (f64::from(power) - step.log10().floor()).clamp(0.0, 15.0) as usize;
        let factor = rounded / 10f64.powi(power);
        return scientific(&signed(&format!("{factor:.digits$}")), power);
    }
    let digits = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
    signed(&format!("{rounded:.digits$}"))
}

/// Formats a number with at most `digits` significant digits, without trailing zeros.
pub fn rounded(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return signed(&value.to_string());
    }
    let mut power = value.abs().log10().floor() as i32 + 1 - digits;
    // one more than there are digits, as 0.99996 has fewer places than its own decade
    for _ in 0..digits {
        let [step, next] = [power, power + 1].map(|power| 10f64.powf(f64::from(power)));
        if ((value / step).round() * step - (value / next).round() * next).abs() < 0.5 * step {
            power += 1;
        }
    }
    number(value, 10f64.powf(f64::from(power)))
}

/// Formats an upper bound of a positive number as one digit and a power of ten.
pub(crate) fn below(value: f64) -> String {
    let power = value.log10().floor() as i32;
    let factor = (value / 10f64.powi(power)).ceil();
    format!("below {}", if factor < 10.0 { scientific(&factor.to_string(), power) } else { scientific("1", power + 1) })
}

/// Returns a power of ten by which numbers are divided to be short, given the largest of them, and the text that is
/// appended to the name of the quantity.
pub(crate) fn unit(largest: f64) -> (f64, String) {
    let power = largest.log10().floor() as i32;
    if largest > 0.0 && !(-2..=3).contains(&power) {
        return (10f64.powi(power), format!(" ({})", scientific("1", power)));
    }
    (1.0, String::new())
}

/// Formats a factor times a power of ten.
fn scientific(factor: &str, power: i32) -> String {
    let raised = |c: char| match c {
        '-' => '\u{207b}',
        '1' => '\u{b9}',
        '2' => '\u{b2}',
        '3' => '\u{b3}',
        _ => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
    };
    let ten: String = "10".chars().chain(power.to_string().chars().map(raised)).collect();
    if factor == "1" { ten } else { format!("{factor}\u{b7}{ten}") }
}

/// Replaces hyphens by minus signs (U+2212).
fn signed(number: &str) -> String {
    number.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|tick| tick.label).collect()
    }

    /// Claim: ticks are round numbers within the range, evenly spaced, with minus signs and without rounding errors in
    /// their last digits.
    #[test]
    fn ticks_are_round() {
        let axis = Axis::around(Scale::Linear, [-0.83, 0.21].into_iter(), 0.0);
        assert_eq!(labels(&axis), ["\u{2212}0.8", "\u{2212}0.6", "\u{2212}0.4", "\u{2212}0.2", "0", "0.2"]);
        let parts: Vec<f64> = axis.ticks().iter().map(|tick| tick.part).collect();
        assert!(parts.windows(3).all(|p| (p[2] - 2.0 * p[1] + p[0]).abs() <= 1e-12), "{parts:?}");
        assert!(parts.iter().all(|part| (0.0..=1.0).contains(part)));
        assert_eq!([0.9, 6.0, 31.0].map(round_step), [0.2, 1.0, 10.0]);
        let small = Axis::around(Scale::Linear, [0.0, 3e-7].into_iter(), 0.0);
        assert_eq!(labels(&small)[..3], ["0", "10\u{207b}\u{2077}", "2\u{b7}10\u{207b}\u{2077}"]);
    }

    /// Claim: powers of ten are evenly spaced; on a short axis there are ticks between them, and a long axis has no
    /// more ticks than fit.
    #[test]
    fn logarithmic_axes() {
        let axis = |values: [f64; 2]| Axis::around(Scale::Logarithmic, values.into_iter(), 0.0);
        let decades = axis([1e-6, 1.0]);
        assert!((decades.part(1e-3) - 0.5).abs() <= 1e-12);
        assert_eq!(labels(&decades).len(), 7);
        assert_eq!(
            labels(&axis([4e-4, 2e-3])),
            ["5\u{b7}10\u{207b}\u{2074}", "10\u{207b}\u{b3}", "2\u{b7}10\u{207b}\u{b3}"]
        );
        assert!(labels(&axis([1e-30, 1e30])).len() <= MOST_TICKS as usize + 1);
    }

    /// Claim: values that differ by rounding errors are drawn as one value in the middle, and the name of the axis
    /// gives the size of the errors; values that differ by more are drawn, however small they are.
    #[test]
    fn rounding_is_one_value() {
        let noise = Axis::around(Scale::Linear, [0.0, 3e-17, -2e-16].into_iter(), 1e-9);
        assert_eq!([noise.part(3e-17), noise.part(-2e-16)], [0.5, 0.5]);
        assert_eq!(labels(&noise), ["0"]);
        assert_eq!(noise.named("strain12"), "strain12 = 0");
        assert_eq!(noise.rounding().unwrap(), "rounding below 3\u{b7}10\u{207b}\u{b9}\u{2076}");
        let constant = Axis::around(Scale::Linear, [13.434309619, 13.434309619 + 2e-15].into_iter(), 0.0);
        assert_eq!((labels(&constant), constant.part(13.434309619)), (vec!["13.4343".to_owned()], 0.5));
        assert!(constant.named("energy") == "energy, constant" && constant.rounding().is_some());
        let small = Axis::around(Scale::Linear, [0.0, 3e-17].into_iter(), 0.0);
        assert!(small.part(3e-17) > 0.9 && small.named("energy") == "energy");
    }

    /// Claim: values without a position on an axis are ignored; an axis without values has ticks too.
    #[test]
    fn what_has_no_place() {
        let axis = Axis::around(Scale::Logarithmic, [0.0, -1.0, f64::NAN, f64::INFINITY, 1.0, 10.0].into_iter(), 0.0);
        assert!(axis.has(2.0) && !axis.has(0.0) && !axis.has(f64::NAN) && axis.part(1.0) > 0.0);
        assert!(!labels(&Axis::around(Scale::Linear, std::iter::empty(), 0.0)).is_empty());
    }

    /// Claim: numbers have the required number of digits.
    #[test]
    fn digits() {
        assert_eq!(
            [number(-0.5, 0.1), number(1e-12, 0.1), number(2e6, 1e6)],
            ["\u{2212}0.5", "0", "2\u{b7}10\u{2076}"]
        );
        let three = [18.91665, 0.25, 5.6789e-9, 0.0, -3.0, 1e6, 2e-7].map(|value| rounded(value, 3));
        assert_eq!([rounded(13.712287, 5), rounded(0.277977, 5)], ["13.712", "0.27798"]);
        assert_eq!(
            [rounded(1.0, 4), rounded(1.0 - 1e-15, 4), rounded(-0.1, 5), rounded(2e3, 4)],
            ["1", "1", "\u{2212}0.1", "2000"]
        );
        assert_eq!([unit(0.5), unit(3e-7)], [(1.0, String::new()), (1e-7, " (10\u{207b}\u{2077})".to_owned())]);
        assert_eq!(
            three,
            [
                "18.9",
                "0.25",
                "5.68\u{b7}10\u{207b}\u{2079}",
                "0",
                "\u{2212}3",
                "10\u{2076}",
                "2\u{b7}10\u{207b}\u{2077}"
            ]
        );
    }
}

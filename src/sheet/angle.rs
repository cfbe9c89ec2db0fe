//! An angle in a file that a user writes: a number of radians, or a text with its unit.

use std::f64::consts::PI;
use std::str::FromStr;

use serde::de::{Error, Unexpected};
use serde::{Deserialize, Deserializer};

use super::written::{Written, read_as_written, schema_any_of};

/// An angle: `1.2`, in radians, or a text with its unit, `"60 deg"` or `"1.2 rad"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// The angle in radians.
    pub radians: f64,
    /// Whether it was written with its unit.
    pub has_unit: bool,
}

/// A degree in radians, and what it is off by rounding: with both, 60 degrees are the double nearest to pi/3.
const DEGREE: f64 = PI / 180.0;
const DEGREE_REMAINDER: f64 = 2.948_652_270_870_168_7e-19;

/// The error in the text of an angle.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no angle, expected a number of radians, or a text with a unit such as \"60 deg\" or \"1.2 rad\"")]
pub struct AngleError(String);

impl FromStr for Angle {
    type Err = AngleError;

    fn from_str(text: &str) -> Result<Self, AngleError> {
        let wrong = || AngleError(text.to_owned());
        let words = text.trim();
        let number = words.trim_end_matches(|c: char| c.is_ascii_alphabetic() || c == '\u{b0}');
        let value: f64 = number.trim_end().parse().map_err(|_| wrong())?;
        let radians = match &words[number.len()..] {
            "deg" | "\u{b0}" => value.mul_add(DEGREE, value * DEGREE_REMAINDER),
            "rad" => value,
            _ => return Err(wrong()),
        };
        if radians.is_finite() { Ok(Self { radians, has_unit: true }) } else { Err(wrong()) }
    }
}

impl From<f64> for Angle {
    fn from(radians: f64) -> Self {
        Self { radians, has_unit: false }
    }
}

read_as_written!(Angle);

/// Numbers are accepted as they are, infinite ones too.
impl Written for Angle {
    const FORMS: &str = "a number of radians, or a text with a unit such as \"60 deg\"";

    fn from_word<E: Error>(text: &str) -> Result<Self, E> {
        text.parse().map_err(E::custom)
    }

    fn from_number<E: Error>(radians: f64, _: Unexpected<'_>) -> Result<Self, E> {
        Ok(radians.into())
    }

    fn from_unsigned<E: Error>(radians: u64) -> Result<Self, E> {
        Ok((radians as f64).into())
    }
}

schema_any_of!(Angle as "Angle", _generator, [
    { "type": "number", "description": "in radians" },
    { "type": "string", "pattern": "^ *[-+.0-9eE]+ *(deg|\u{b0}|rad) *$", "description": "with its unit: \"60 deg\"" },
]);

/// Reads an angle as its number of radians.
pub(crate) fn radians<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Angle::deserialize(deserializer).map(|angle| angle.radians)
}

/// Returns the degrees that are read as exactly this angle: the shortest of the numbers next to it that are.
pub(crate) fn in_degrees(angle: f64) -> f64 {
    shortest(angle.to_degrees(), |degrees| degrees.to_radians() == angle)
}

/// Returns the shortest of the numbers next to one that are right; that one if none is.
pub(crate) fn shortest(near: f64, is_right: impl Fn(f64) -> bool) -> f64 {
    let rounded = [1e3, 1e6, 1e9, 1e12].map(|scale| (near * scale).round() / scale);
    let candidates = rounded.into_iter().chain([near, near.next_up(), near.next_down()]);
    candidates.into_iter().find(|number| is_right(*number)).unwrap_or(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_3;

    /// Claim: all forms of 60 degrees are the same angle, to the last bit.
    #[test]
    fn units_are_read() {
        #[derive(Deserialize)]
        struct One {
            a: Angle,
        }
        for text in ["\"60 deg\"", "\"60deg\"", "\" 6e1 deg \"", "\"60\u{b0}\"", "\"1.0471975511965979 rad\""] {
            let One { a } = toml::from_str(&format!("a = {text}")).unwrap();
            assert_eq!(a, Angle { radians: FRAC_PI_3, has_unit: true }, "{text}");
        }
        for (text, radians) in [("1.5", 1.5), ("-2", -2.0), ("inf", f64::INFINITY)] {
            assert_eq!(toml::from_str::<One>(&format!("a = {text}")).unwrap().a, radians.into());
        }
    }

    /// Claim: what is no angle is refused, with the forms that are.
    #[test]
    fn other_texts_are_refused() {
        for text in ["", "60", "deg", "60 grad", "60 degrees", "1e999 rad", "nan deg", "60 deg deg", "6 0 deg"] {
            let fault = text.parse::<Angle>().unwrap_err().to_string();
            assert!(fault.contains("60 deg") && fault.contains(&format!("`{text}`")), "{fault}");
        }
    }
}

//! An axis of a sweep: one key with its values, or the keys of a table of points with its rows.

use super::super::rows::read_table;
use super::super::setting::{Setting, float};
use super::super::spec::{SweepAxis, SweepRange, SweepValues};
use super::super::{SceneError, SceneFile};
use super::rows;
use std::ops::Range;
use std::path::PathBuf;

/// Name of the table of sweeps.
pub(super) const TABLE: &str = "sweep";

/// Where a value of an axis is written.
pub(super) enum ValueLocation {
    /// In the scene.
    Span(Range<usize>),
    /// In a line of a table.
    Line(PathBuf, usize),
}

/// An axis with its values.
#[derive(Clone, Debug)]
pub(super) struct ResolvedAxis {
    /// The paths of the keys that are set.
    pub(super) keys: Vec<String>,
    /// The place of the axis in the scene.
    pub(super) span: Range<usize>,
    /// The text of each value for each key.
    values: Vec<Vec<String>>,
    /// The table of points and the lines of its rows.
    table: Option<(PathBuf, Vec<usize>)>,
}

impl ResolvedAxis {
    /// Reads the values of an axis.
    pub(super) fn read(file: &SceneFile, spec: &SweepAxis) -> Result<Self, SceneError> {
        let texts = match &*spec.values {
            SweepValues::File(path) => return Self::of_table(file, spec, file.resolve(path)),
            SweepValues::List(values) => values.iter().map(|value| file.text()[value.span()].to_owned()).collect(),
            SweepValues::Linear(range) => linear(range),
            SweepValues::Log(range) => logarithmic(range),
            SweepValues::Seeds { from, count } => (*from..).take(*count).map(|seed| seed.to_string()).collect(),
        };
        if texts.is_empty() {
            let message = format!("`{}` has no values", *spec.key);
            return Err(file.error_at(spec.values.span(), message, "give at least one, as in [1e2]"));
        }
        check_key(file, spec, &spec.key)?;
        let values = texts.into_iter().map(|text| vec![text]).collect();
        Ok(Self { keys: vec![spec.key.to_string()], span: spec.key.span(), values, table: None })
    }

    fn of_table(file: &SceneFile, spec: &SweepAxis, path: PathBuf) -> Result<Self, SceneError> {
        let rows::PointTable { header, rows, lines } =
            read_table(&path, rows::parse).map_err(|error| file.placed(error))?;
        header.iter().try_for_each(|key| check_key(file, spec, key))?;
        Ok(Self { keys: header, span: spec.key.span(), values: rows, table: Some((path, lines)) })
    }

    /// Returns the number of values.
    pub(super) fn len(&self) -> usize {
        self.values.len()
    }

    /// Returns the settings of a value.
    pub(super) fn settings(&self, row: usize) -> Vec<Setting> {
        // made anew each time: those of a million values would take a gigabyte
        let texts = self.values.get(row).into_iter().flatten();
        self.keys.iter().zip(texts).filter_map(|(key, text)| Setting::new(key, text).ok()).collect()
    }

    /// Returns the place of a value.
    pub(super) fn place(&self, row: usize) -> ValueLocation {
        match &self.table {
            Some((path, lines)) => ValueLocation::Line(path.clone(), lines.get(row).copied().unwrap_or(1)),
            None => ValueLocation::Span(self.span.clone()),
        }
    }
}

/// Checks that a key is the path of one that a point can set.
fn check_key(file: &SceneFile, spec: &SweepAxis, key: &str) -> Result<(), SceneError> {
    let refused = |message: String| {
        let help = "write the path of a key of the scene in quotes, as in \"energy.bars.stiffness\" or \"study.NAME.tolerance\"";
        Err(file.error_at(spec.key.span(), message, help))
    };
    match Setting::new(key, "0") {
        Err(_) => refused(format!("`{key}` is no path of a key")),
        Ok(found) if found.table() == TABLE => refused(format!("`{key}` is a key of the sweep itself")),
        Ok(_) => Ok(()),
    }
}

/// Returns numbers the same distance apart. The ends are exact.
fn linear(range: &SweepRange) -> Vec<String> {
    between(range, |x| x, |x| x)
}

/// Returns numbers each of which is the same multiple of the one before. The ends are exact, and powers of ten are
/// where they should be: the logarithms are divided evenly, to base 10.
fn logarithmic(range: &SweepRange) -> Vec<String> {
    between(range, libm::log10, libm::exp10)
}

fn between(range: &SweepRange, into: impl Fn(f64) -> f64, back: impl Fn(f64) -> f64) -> Vec<String> {
    let (ends, last) = (range.ends.map(&into), range.count - 1);
    let inside = |k: usize| back((ends[0] * (last - k) as f64 + ends[1] * k as f64) / last as f64);
    let number = |k: usize| {
        if k == 0 {
            range.ends[0]
        } else if k == last {
            range.ends[1]
        } else {
            inside(k)
        }
    };
    (0..=last).map(|k| float(number(k))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: ranges have their ends exactly, decades where they are written so, and tenths where they are divided so.
    #[test]
    fn ranges_have_round_numbers() {
        let log = logarithmic(&SweepRange { ends: [1e-8, 1e10], count: 19 });
        let decades: Vec<f64> = (-8..=10).map(|k| format!("1e{k}").parse().unwrap()).collect();
        assert_eq!(log.iter().map(|x| x.parse::<f64>().unwrap()).collect::<Vec<_>>(), decades);
        assert_eq!(linear(&SweepRange { ends: [0.0, 1.0], count: 11 })[3], "0.3");
        assert_eq!(linear(&SweepRange { ends: [-1.0, 1.0], count: 3 }), ["-1.0", "0.0", "1.0"]);
        let down = logarithmic(&SweepRange { ends: [7.0, 0.3], count: 2 });
        assert_eq!(down, ["7.0", "0.3"]);
    }
}

//! Tables as CSV: a header, then a row per state.
//!
//! Numbers are written with as many digits as reading them back exactly needs; what was not computed is empty.

use std::fmt::Write;
use std::path::Path;

use super::OutputError;
use super::fault::ShapeError;
use super::files;
use crate::sheet::EdgeKey;

/// Reads columns of a table that was written here: one row after the other, NaN where there is no number or no such
/// column.
///
/// # Errors
/// [`OutputError::Read`].
pub(crate) fn read_columns(path: &Path, names: &[&str]) -> Result<Vec<Vec<f64>>, OutputError> {
    let text = std::fs::read_to_string(path).map_err(|source| OutputError::Read { path: path.into(), source })?;
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let places: Vec<_> = names.iter().map(|name| header.iter().position(|column| column == name)).collect();
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |place: &Option<usize>| place.and_then(|k| fields.get(k)?.parse().ok()).unwrap_or(f64::NAN);
        places.iter().map(number).collect()
    };
    Ok(lines.map(row).collect())
}

/// A value of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    /// Not computed.
    Empty,
    /// A whole number.
    Whole(i64),
    /// A number; NaN is written as not computed.
    Number(f64),
}

/// A table on its way to a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    /// A table without rows.
    pub(crate) fn new(header: Vec<String>) -> Self {
        Self { header, rows: Vec::new() }
    }

    /// The table of the states of a study: its columns are those of [`StateRow`], the edges of the cell last. The error to
    /// the exact kinematics has a column where some state knows it.
    pub(crate) fn of_states(edges: &[EdgeKey], states: &[StateRow]) -> Self {
        let compared = states.iter().any(|state| state.error_to_kinematic.is_some());
        let columns = StateRow::COLUMNS.iter().copied().chain(compared.then_some("error_to_kinematic"));
        let fold = edges.iter().map(Self::fold_column);
        let header = columns.map(str::to_owned).chain(fold).collect();
        Self { header, rows: states.iter().map(|state| state.values(compared)).collect() }
    }

    /// The name of the column with the fold angle of an edge.
    pub(crate) fn fold_column(edge: &EdgeKey) -> String {
        format!("fold_{}_{}_{}_{}", edge.i, edge.j, edge.shift[0], edge.shift[1])
    }

    /// Adds a row.
    pub(crate) fn push(&mut self, row: Vec<Value>) {
        self.rows.push(row);
    }

    /// Writes the table.
    ///
    /// # Errors
    /// [`OutputError::Shape`] where a row does not have a value for every column, [`OutputError::Write`].
    pub(crate) fn write(&self, path: &Path) -> Result<(), OutputError> {
        let text = self.to_csv().map_err(|fault| OutputError::Shape { path: path.into(), fault })?;
        files::write(path, text)
    }

    fn to_csv(&self) -> Result<String, ShapeError> {
        let mut text = self.header.join(",");
        text.push('\n');
        for (row, values) in self.rows.iter().enumerate() {
            if values.len() != self.header.len() {
                return Err(ShapeError::Row { row, found: values.len(), expected: self.header.len() });
            }
            for (at, value) in values.iter().enumerate() {
                text.push_str(if at > 0 { "," } else { "" });
                value.append_to(&mut text);
            }
            text.push('\n');
        }
        Ok(text)
    }
}

impl Value {
    fn append_to(self, text: &mut String) {
        // writing to a string does not fail
        let _ = match self {
            Self::Empty => Ok(()),
            Self::Whole(number) => write!(text, "{number}"),
            Self::Number(number) if number.is_nan() => Ok(()),
            // the shortest digits that read back exactly, with an exponent where the number is very large or small
            Self::Number(number) => write!(text, "{number:?}"),
        };
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<Option<f64>> for Value {
    fn from(number: Option<f64>) -> Self {
        number.map_or(Self::Empty, Self::Number)
    }
}

impl From<Option<i64>> for Value {
    fn from(number: Option<i64>) -> Self {
        number.map_or(Self::Empty, Self::Whole)
    }
}

/// A state in the table of a study; what is `None` was not computed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StateRow {
    /// Number of the branch on which the state lies.
    pub branch: Option<i64>,
    /// Which way along the branch, +1 or -1.
    pub sign: Option<i64>,
    /// Number of the state along its branch.
    pub step: Option<i64>,
    /// Arc length in fold angles.
    pub arc_length: Option<f64>,
    /// Curvature at vertex 0.
    pub curvature: Option<f64>,
    /// Angles of the two lattice rotations.
    pub theta: [Option<f64>; 2],
    /// Strain: 11, 22, 12.
    pub strain: [Option<f64>; 3],
    /// Energy of bars, creases, facets, and in all.
    pub energy: [Option<f64>; 4],
    /// Largest unbalanced force over the largest force of any term.
    pub residual_force: Option<f64>,
    /// Largest error of a length over the mean edge.
    pub residual_length: Option<f64>,
    /// Whether faces pass through each other.
    pub self_intersecting: Option<bool>,
    /// Largest difference of a fold angle to the exact kinematics, in radians.
    pub error_to_kinematic: Option<f64>,
    /// Fold angles of the edges of the cell, NaN where there is none.
    pub fold: Vec<f64>,
}

impl StateRow {
    /// The columns before the fold angles.
    pub(crate) const COLUMNS: [&str; 17] = [
        "branch",
        "sign",
        "step",
        "arc_length",
        "curvature",
        "theta1",
        "theta2",
        "strain11",
        "strain22",
        "strain12",
        "energy_bars",
        "energy_creases",
        "energy_facets",
        "energy_total",
        "residual_force",
        "residual_length",
        "self_intersecting",
    ];

    fn values(&self, compared: bool) -> Vec<Value> {
        let counts = [self.branch, self.sign, self.step].map(Value::from);
        let shape = [&[self.arc_length, self.curvature][..], &self.theta, &self.strain].concat();
        let solution = [&self.energy[..], &[self.residual_force, self.residual_length]].concat();
        let numbers = shape.into_iter().chain(solution).map(Value::from);
        let crossing = Value::from(self.self_intersecting.map(i64::from));
        let error = compared.then(|| Value::from(self.error_to_kinematic));
        let fold = self.fold.iter().map(|&angle| Value::Number(angle));
        counts.into_iter().chain(numbers).chain([crossing]).chain(error).chain(fold).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers read back bit for bit, over all magnitudes; what is not computed is empty.
    #[test]
    fn numbers_read_back_exactly() {
        let numbers = [0.1, -1.0 / 3.0, 5e-324, f64::MAX, 1e16 + 2.0, -0.0, f64::INFINITY, 123_456_789.125];
        let mut table = Table::new(numbers.iter().map(|_| "x".to_owned()).collect());
        table.push(numbers.iter().map(|&x| Value::Number(x)).collect());
        let text = table.to_csv().unwrap();
        let back: Vec<f64> = text.lines().nth(1).unwrap().split(',').map(|field| field.parse().unwrap()).collect();
        assert_eq!(back.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), numbers.map(f64::to_bits));
    }

    /// The columns of the contract, in its order, each value under its own name.
    #[test]
    fn a_state_fills_its_columns() {
        let keys = [EdgeKey { i: 0, j: 1, shift: [0, -1] }, EdgeKey { i: 0, j: 3, shift: [0, 0] }];
        let state = StateRow {
            sign: Some(-1),
            arc_length: Some(1.0),
            curvature: Some(2.0),
            theta: [Some(3.0), Some(4.0)],
            strain: [Some(5.0), None, Some(6.0)],
            energy: [Some(7.0), Some(8.0), Some(9.0), Some(10.0)],
            residual_force: Some(11.0),
            residual_length: Some(12.0),
            self_intersecting: Some(true),
            fold: vec![0.5, f64::NAN],
            ..StateRow::default()
        };
        let text = Table::of_states(&keys, &[state]).to_csv().unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].ends_with("self_intersecting,fold_0_1_0_-1,fold_0_3_0_0"), "{}", lines[0]);
        assert_eq!(lines[1], ",-1,,1.0,2.0,3.0,4.0,5.0,,6.0,7.0,8.0,9.0,10.0,11.0,12.0,1,0.5,");
        assert_eq!(lines[0].split(',').count(), lines[1].split(',').count());
    }

    /// A row that is too short is refused, with its number.
    #[test]
    fn rows_have_a_value_for_every_column() {
        let keys = [EdgeKey { i: 0, j: 1, shift: [0, 0] }];
        let table = Table::of_states(&keys, &[StateRow::default()]);
        assert_eq!(table.to_csv(), Err(ShapeError::Row { row: 0, found: 17, expected: 18 }));
    }
}

//! Tables in CSV format: a header, then one row for each state.
//!
//! Numbers are written with the fewest digits that are read back exactly; values that were not computed are empty
//! fields.

use std::fmt::{self, Display, Write};

use super::error::ShapeError;
use crate::analysis::state::Cylinder;
use crate::sheet::EdgeKey;

/// Returns the numbers of the named columns of a table that was written by this module: one vector for each row, with
/// NaN for empty fields and for columns that do not exist.
pub(crate) fn columns_of(text: &str, names: &[&str]) -> Vec<Vec<f64>> {
    let mut lines = text.trim_start_matches('\u{feff}').lines();
    let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let places: Vec<_> = names.iter().map(|name| header.iter().position(|column| column == name)).collect();
    let row = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |place: &Option<usize>| place.and_then(|k| fields.get(k)?.parse().ok()).unwrap_or(f64::NAN);
        places.iter().map(number).collect()
    };
    lines.filter(|line| !line.is_empty()).map(row).collect()
}

/// Returns a line of a table with texts: one with a comma, a quote or a line break stands in quotes.
pub(crate) fn csv_line<'a>(fields: impl Iterator<Item = &'a str>) -> String {
    let special = |letter: char| matches!(letter, ',' | '"' | '\n' | '\r');
    let field = |text: &str| {
        if text.contains(special) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
    };
    fields.map(field).collect::<Vec<_>>().join(",") + "\n"
}

/// A value of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Value {
    /// An integer.
    Whole(i64),
    /// A number; NaN, which is written as an empty field, where it was not computed.
    Number(f64),
    /// A word without commas and quotes.
    Word(&'static str),
}

/// The values of a column of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Whole numbers, and no row without one.
    Whole(Vec<i64>),
    /// Numbers; NaN where there is none.
    Numbers(Vec<f64>),
    /// Words; empty where there is none.
    Words(Vec<String>),
}

impl Column {
    fn new(values: impl Iterator<Item = Value> + Clone) -> Self {
        let whole = |value| if let Value::Whole(number) = value { Some(number) } else { None };
        let number = |value| match value {
            Value::Whole(number) => Some(number as f64),
            Value::Number(number) => Some(number),
            Value::Word(_) => None,
        };
        let wholes = values.clone().map(whole).collect::<Option<_>>().map(Self::Whole);
        let numbers = || values.clone().map(number).collect::<Option<_>>().map(Self::Numbers);
        wholes.or_else(numbers).unwrap_or_else(|| Self::Words(values.map(|value| value.to_string()).collect()))
    }
}

/// A table to be written to a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    /// Makes a table without rows, with these names of columns, which commas separate.
    pub(crate) fn new(header: &str) -> Self {
        Self { header: header.split(',').map(str::to_owned).collect(), rows: Vec::new() }
    }

    /// Returns the table with further columns.
    pub(crate) fn with(mut self, columns: impl IntoIterator<Item = impl Into<String>>) -> Self {
        self.header.extend(columns.into_iter().map(Into::into));
        self
    }

    /// Makes the table of the states of a study, with the columns of [`StateRow`] followed by `state`, the number of
    /// the row from 0, and the fold angles of the edges of the cell. The column `error_to_kinematic` is present if at
    /// least one state has this value, the columns [`RATIOS`] if the states have ratios, and [`SEAM`] if they have
    /// seams.
    pub(crate) fn of_states(edges: &[EdgeKey], states: &[StateRow]) -> Self {
        let compared = states.iter().any(|state| state.error_to_kinematic.is_some());
        let others = states.first().map(|state| state.solution.energy.others.as_slice()).unwrap_or_default();
        let solution = EnergiesAndResiduals::columns(others.iter().map(|(name, _)| name.as_str()));
        let ratios = states.iter().any(|state| state.ratios.is_some()).then_some(RATIOS).into_iter().flatten();
        let seam = states.iter().any(|state| state.seam.is_some()).then_some(SEAM).into_iter().flatten();
        let table = Self::new("branch,sign,step,arc_length").with(CYLINDER).with(solution).with(["self_intersecting"]);
        let table = table.with(compared.then_some("error_to_kinematic")).with(ratios).with(seam).with(["state"]);
        let table = table.with_edges("fold", edges);
        Self { rows: states.iter().enumerate().map(|(row, state)| state.values(row, compared)).collect(), ..table }
    }

    /// Returns the table with a further column for each edge, whose name begins with this word.
    pub(crate) fn with_edges<'a>(self, word: &str, edges: impl IntoIterator<Item = &'a EdgeKey>) -> Self {
        self.with(edges.into_iter().map(|edge| Self::edge_column(word, edge)))
    }

    /// Returns the name of a column with a quantity of an edge; that of a further hinge round it has the hinge's number
    /// behind.
    pub(crate) fn edge_column(word: &str, edge: &EdgeKey) -> String {
        let round = if edge.has_bar() { String::new() } else { format!("_{}", edge.round) };
        format!("{word}_{}_{}_{}_{}{round}", edge.i, edge.j, edge.shift[0], edge.shift[1])
    }

    /// Returns the number of rows.
    pub(crate) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Returns the names of the columns with their values, one for each row.
    pub fn columns(&self) -> impl Iterator<Item = (&str, Column)> {
        self.header
            .iter()
            .enumerate()
            .map(|(at, name)| (name.as_str(), Column::new(self.rows.iter().map(|row| row[at]))))
    }

    /// Returns the table with further rows.
    pub(crate) fn with_rows(mut self, rows: impl IntoIterator<Item = impl IntoIterator<Item = Value>>) -> Self {
        rows.into_iter().for_each(|row| self.push(row));
        self
    }

    /// Returns the table with further rows, each of which begins with its number, counted from 0.
    pub(crate) fn with_numbered<V: Into<Value>>(
        self,
        rows: impl IntoIterator<Item = impl IntoIterator<Item = V>>,
    ) -> Self {
        let rows = rows.into_iter().enumerate();
        self.with_rows(rows.map(|(number, row)| [number.into()].into_iter().chain(row.into_iter().map(V::into))))
    }

    /// Appends a row.
    pub(crate) fn push(&mut self, row: impl IntoIterator<Item = Value>) {
        self.rows.push(row.into_iter().collect());
    }

    /// Returns the text of the table.
    pub(crate) fn to_csv(&self) -> Result<String, ShapeError> {
        let mut text = self.header.join(",");
        text.push('\n');
        for (row, values) in self.rows.iter().enumerate() {
            if values.len() != self.header.len() {
                return Err(ShapeError::Row { row, found: values.len(), expected: self.header.len() });
            }
            for (at, value) in values.iter().enumerate() {
                text.push_str(if at > 0 { "," } else { "" });
                let _ = write!(text, "{value}"); // writing to a string does not fail
            }
            text.push('\n');
        }
        Ok(text)
    }
}

/// As in a table: a number that is not known is an empty field.
impl Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(number) => write!(f, "{number}"),
            Self::Word(word) => write!(f, "{word}"),
            Self::Number(number) if number.is_nan() => Ok(()),
            // `{:?}` writes the fewest digits that are read back exactly, with an exponent for very large and small
            // numbers
            Self::Number(number) => write!(f, "{number:?}"),
        }
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<i64> for Value {
    fn from(number: i64) -> Self {
        Self::Whole(number)
    }
}

impl From<usize> for Value {
    fn from(number: usize) -> Self {
        Self::Whole(number as i64)
    }
}

impl<T: Into<Self>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Number(f64::NAN), Into::into)
    }
}

/// Energies of a state; values that were not computed are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Energies {
    /// Those of the bars, the creases and the facets.
    pub of_edges: [Option<f64>; 3],
    /// Names and energies of the other terms.
    pub others: Vec<(String, Option<f64>)>,
    /// Their sum.
    pub total: Option<f64>,
}

/// Energies and residuals of a state, as all tables list them; values that were not computed are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct EnergiesAndResiduals {
    /// Energies of the terms.
    pub energy: Energies,
    /// Largest unbalanced force, relative to the largest force of any term.
    pub residual_force: Option<f64>,
    /// Largest error of a length, relative to the mean edge length.
    pub residual_length: Option<f64>,
}

impl EnergiesAndResiduals {
    /// The energies of a state, and its residual force and length where they are known.
    pub(crate) fn new(energy: Energies, residuals: Option<[f64; 2]>) -> Self {
        let [residual_force, residual_length] = [0, 1].map(|k| residuals.map(|residuals| residuals[k]));
        Self { energy, residual_force, residual_length }
    }

    /// Returns the names of the columns, with one for each of these terms beside those of edges.
    pub(crate) fn columns<'a>(others: impl IntoIterator<Item = &'a str>) -> Vec<String> {
        let others = others.into_iter().map(|name| format!("energy_{name}"));
        let first = ["energy_bars", "energy_creases", "energy_facets"].map(str::to_owned);
        let last = ["energy_total", "residual_force", "residual_length"].map(str::to_owned);
        first.into_iter().chain(others).chain(last).collect()
    }

    /// Returns the values of the columns.
    pub(crate) fn values(&self) -> Vec<Value> {
        let Energies { of_edges, others, total } = &self.energy;
        let others = others.iter().map(|(_, energy)| *energy);
        let last = [*total, self.residual_force, self.residual_length];
        of_edges.iter().copied().chain(others).chain(last).map(Value::from).collect()
    }
}

/// A row of the table of a study, which describes one state; values that were not computed are `None`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct StateRow {
    /// Number of the branch on which the state lies.
    pub branch: Option<i64>,
    /// Direction along the branch, +1 or -1.
    pub sign: Option<i64>,
    /// Number of the state along its branch.
    pub step: Option<i64>,
    /// Arc length along the branch in the space of fold angles, in radians.
    pub arc_length: Option<f64>,
    /// The cylinder of a state that is periodic up to screw motions.
    pub shape: Option<Cylinder>,
    /// Energies and residuals.
    pub solution: EnergiesAndResiduals,
    /// Whether faces pass through each other.
    pub self_intersecting: Option<bool>,
    /// Largest difference between a fold angle and that of the exact kinematics, in radians.
    pub error_to_kinematic: Option<f64>,
    /// Poisson's ratios in the plane and of bending along the first lattice vector, where they exist; `None` if the
    /// study does not ask for them, and then for all rows.
    pub ratios: Option<[Option<f64>; 2]>,
    /// Turn in radians and rise of the seam of a tube, which may not be known; `None` for all rows of other sheets.
    pub seam: Option<[Option<f64>; 2]>,
    /// Fold angles of the edges of the cell in radians; NaN for edges without a hinge.
    pub fold: Vec<f64>,
}

/// Names of the columns of a state that is periodic up to screw motions.
pub(crate) const CYLINDER: [&str; 6] = ["curvature", "theta1", "theta2", "strain11", "strain22", "strain12"];
/// Names of the columns of Poisson's ratios.
pub(crate) const RATIOS: [&str; 2] = ["poisson_in_plane", "poisson_bending"];
/// Names of the columns of the seam of a tube.
pub(crate) const SEAM: [&str; 2] = ["seam_turn", "seam_rise"];

impl StateRow {
    fn values(&self, row: usize, compared: bool) -> Vec<Value> {
        let counts = [self.branch, self.sign, self.step].map(Value::from);
        let shape = self.shape.map_or([f64::NAN; CYLINDER.len()], |shape| {
            let Cylinder { curvature, theta, strain } = shape;
            [curvature, theta[0], theta[1], strain[0], strain[1], strain[2]]
        });
        let numbers = [self.arc_length.into()].into_iter().chain(shape.map(Value::from)).chain(self.solution.values());
        let crossing = Value::from(self.self_intersecting.map(i64::from));
        let error = compared.then(|| Value::from(self.error_to_kinematic));
        let ratios = [self.ratios, self.seam].into_iter().flatten().flatten().map(Value::from);
        let fold = self.fold.iter().map(|&angle| Value::Number(angle));
        let row = [Value::Whole(row as i64)];
        counts.into_iter().chain(numbers).chain([crossing]).chain(error).chain(ratios).chain(row).chain(fold).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of all magnitudes are read back bit for bit.
    #[test]
    fn numbers_read_back_exactly() {
        let numbers = [0.1, -1.0 / 3.0, 5e-324, f64::MAX, 1e16 + 2.0, -0.0, f64::INFINITY, 123_456_789.125];
        let mut table = Table::new("x,x,x,x,x,x,x,x");
        table.push(numbers.map(Value::from));
        let text = table.to_csv().unwrap();
        let back: Vec<f64> = text.lines().nth(1).unwrap().split(',').map(|field| field.parse().unwrap()).collect();
        assert_eq!(back.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), numbers.map(f64::to_bits));
    }

    /// The columns have the documented order, and each value is in its own column.
    #[test]
    fn a_state_fills_its_columns() {
        let keys = [EdgeKey { i: 0, j: 1, shift: [0, -1], round: 0 }, EdgeKey { i: 0, j: 3, shift: [0, 0], round: 0 }];
        let state = StateRow {
            sign: Some(-1),
            arc_length: Some(1.0),
            shape: Some(Cylinder { curvature: 2.0, theta: [3.0, 4.0], strain: [5.0, f64::NAN, 6.0] }),
            solution: EnergiesAndResiduals {
                energy: Energies {
                    of_edges: [Some(7.0), Some(8.0), Some(9.0)],
                    others: vec![("springs".into(), Some(9.5))],
                    total: Some(10.0),
                },
                residual_force: Some(11.0),
                residual_length: Some(12.0),
            },
            self_intersecting: Some(true),
            fold: vec![0.5, f64::NAN],
            ..StateRow::default()
        };
        let text = Table::of_states(&keys, &[state]).to_csv().unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].contains("energy_facets,energy_springs,energy_total"), "{}", lines[0]);
        assert!(lines[0].ends_with("self_intersecting,state,fold_0_1_0_-1,fold_0_3_0_0"), "{}", lines[0]);
        assert_eq!(lines[1], ",-1,,1.0,2.0,3.0,4.0,5.0,,6.0,7.0,8.0,9.0,9.5,10.0,11.0,12.0,1,0,0.5,");
        assert_eq!(lines[0].split(',').count(), lines[1].split(',').count());
    }

    /// A row that is too short is an error, which names the row.
    #[test]
    fn rows_have_a_value_for_every_column() {
        let keys = [EdgeKey { i: 0, j: 1, shift: [0, 0], round: 0 }];
        let table = Table::of_states(&keys, &[StateRow::default()]);
        assert_eq!(table.to_csv(), Err(ShapeError::Row { row: 0, found: 18, expected: 19 }));
    }
}

//! The laws of a scene: curves are read from their files, formulas checked.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use super::error::TableFault;
use super::rows::numbered_lines;
use super::spec::{BarLawSpec, CurveSpec, HingeLawSpec};
use super::{Located, SceneError, SceneFile};
use crate::model::{
    Bilinear, CurveError, Formula, FormulaError, GreenLagrange, Law, Measured, OfAngle, OfStrain, Ogden, Power,
    Stiffening,
};
use crate::sheet::text::read_text;

/// A law of a scene.
pub(super) struct GivenLaw {
    /// The law.
    pub law: Arc<dyn Law>,
    /// The stiffness at rest, if the law says it.
    pub stiffness: Option<f64>,
}

impl<L: Law + 'static> From<L> for GivenLaw {
    fn from(law: L) -> Self {
        Self { law: Arc::new(law), stiffness: None }
    }
}

/// Returns the law of the bars.
///
/// # Errors
/// [`SceneError`] if a curve or a formula is none.
pub(super) fn of_bars(file: &SceneFile, spec: &Located<BarLawSpec>) -> Result<GivenLaw, SceneError> {
    match &**spec {
        BarLawSpec::Ogden { exponents } => Ok(Ogden { exponents: exponents.0 }.into()),
        BarLawSpec::GreenLagrange {} => Ok(GreenLagrange.into()),
        BarLawSpec::Bilinear { ratio, at } => Ok(OfStrain(Bilinear { ratio: ratio.0, at: at.0 }).into()),
        BarLawSpec::Table(curve) => table(file, (curve, spec.span()), ["strain", "force"], OfStrain),
        BarLawSpec::Formula { force } => formula(file, spec.span(), Formula::of_length(force), "length"),
    }
}

/// Returns the law of creases or facets.
///
/// # Errors
/// [`SceneError`] if a curve or a formula is none.
pub(super) fn of_hinges(file: &SceneFile, spec: &Located<HingeLawSpec>) -> Result<GivenLaw, SceneError> {
    match &**spec {
        HingeLawSpec::Stiffening { limits } => Ok(Stiffening { limits: limits.0 }.into()),
        HingeLawSpec::Power { exponent } => Ok(OfAngle(Power { exponent: exponent.0 }).into()),
        HingeLawSpec::Bilinear { ratio, at } => Ok(OfAngle(Bilinear { ratio: ratio.0, at: at.0 }).into()),
        HingeLawSpec::Table(curve) => table(file, (curve, spec.span()), ["angle", "torque"], OfAngle),
        HingeLawSpec::Formula { torque } => formula(file, spec.span(), Formula::of_angle(torque), "angle"),
    }
}

/// Returns the law of a curve, which says the stiffness at rest too.
fn table<L: Law + 'static>(
    file: &SceneFile,
    spec: (&CurveSpec, Range<usize>),
    columns: [&'static str; 2],
    law: fn(Measured) -> L,
) -> Result<GivenLaw, SceneError> {
    let curve = measured(file, spec, columns)?;
    Ok(GivenLaw { stiffness: Some(curve.slope()), ..law(curve).into() })
}

/// Returns the law of a formula.
fn formula(
    file: &SceneFile,
    span: Range<usize>,
    read: Result<Formula, FormulaError>,
    measure: &str,
) -> Result<GivenLaw, SceneError> {
    let help =
        format!("m is the {measure}, m0 the {measure} at rest, k the spring constant; near rest it is k*(m - m0)");
    read.map(GivenLaw::from).map_err(|fault| file.error_at(span, fault.to_string(), help))
}

/// The line of a row, and its two numbers.
type CurveRow = (usize, [f64; 2]);

/// Returns the curve through the points of a table or of the scene itself.
fn measured(
    file: &SceneFile,
    (spec, span): (&CurveSpec, Range<usize>),
    columns: [&'static str; 2],
) -> Result<Measured, SceneError> {
    let help = format!("give `file`, a table `{},{}`, or `points`, a list of such pairs", columns[0], columns[1]);
    match (&spec.file, &spec.points) {
        (Some(name), None) => {
            let path = file.resolve(name);
            let (lines, points): (Vec<usize>, Vec<[f64; 2]>) = rows(&path, columns)?.into_iter().unzip();
            let line = |fault: &CurveError| fault.point().map_or(1, |at| lines[at]);
            Measured::new(&points).map_err(|fault| SceneError::Table {
                line: line(&fault),
                path,
                fault: TableFault::Curve(fault),
            })
        }
        (None, Some(points)) => Measured::new(points).map_err(|fault| file.error_at(span, fault.to_string(), help)),
        (Some(_), Some(_)) => Err(file.error_at(span, "a curve has a file and points at once", help)),
        (None, None) => Err(file.error_at(span, "a law of kind \"table\" has no curve", help)),
    }
}

/// Returns the rows of a table with these two columns, each with its line.
fn rows(path: &Path, columns: [&'static str; 2]) -> Result<Vec<CurveRow>, SceneError> {
    let text = read_text(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
    let fault = |line, fault| SceneError::Table { path: path.into(), line, fault };
    let mut lines = numbered_lines(&text);
    let (at, header) = lines.next().ok_or_else(|| fault(1, TableFault::Empty))?;
    if header.split(',').map(str::trim).ne(columns) {
        let found = header.trim().into();
        return Err(fault(at, TableFault::CurveHeader { found, columns }));
    }
    let read = |(line, text): (usize, &str)| {
        let fields: Vec<&str> = text.split(',').map(str::trim).collect();
        let [first, second] = fields[..] else {
            return Err(fault(line, TableFault::Fields { found: fields.len(), expected: 2 }));
        };
        let number = |field: &str, column| {
            let number = field.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| fault(line, TableFault::Number { field: field.into(), column }))
        };
        Ok((line, [number(first, columns[0])?, number(second, columns[1])?]))
    };
    lines.map(read).collect()
}

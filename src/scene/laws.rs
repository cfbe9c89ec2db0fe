//! The laws of a scene: curves are read from their files, formulas checked.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use super::elements::{ElementKind, ElementValues};
use super::error::TableFault;
use super::rows::{ColumnQuantity, Fault, numbered_lines, read_table};
use super::spec::{BarLawSpec, CurveSpec, HingeLawSpec, HingeYieldSpec, LawForm};
use super::turns::fault_of_turns;
use super::{Located, SceneError, SceneFile};
use crate::model::{
    Bilinear, CurveError, ElasticPlastic, Formula, FormulaError, GreenLagrange, Law, Laws, Measured, Memory, OfAngle,
    OfStrain, Ogden, Power, Stiffening, Stiffness, TermLaw,
};
use crate::sheet::Assignment;

/// The laws that a scene gives a term.
pub(super) struct GivenLaw {
    /// The laws of its elements; `None` if all are springs.
    law: Option<TermLaw>,
    /// The stiffness at rest, if the law of all says it.
    pub stiffness: Option<f64>,
    span: Range<usize>,
}

/// A law, `None` if it is that of a spring, and the stiffness at rest, if the law says it.
type ReadLaw = (Option<Arc<dyn Law>>, Option<f64>);

/// Returns a law from what stands at a place of a scene.
type LawReader<T> = fn(&SceneFile, (&T, Range<usize>)) -> Result<ReadLaw, SceneError>;

/// Returns the laws that bars, creases and facets are given.
pub(super) fn given(file: &SceneFile, values: &ElementValues) -> Result<[Option<GivenLaw>; 3], SceneError> {
    let energy = &file.scene.energy;
    let [in_creases, in_facets] = energy.hinges().map(|spec| spec?.law.as_ref());
    let in_bars = energy.bars.as_ref().and_then(|spec| spec.law.as_ref());
    Ok([
        in_bars.map(|law| of_elements(file, (values, ElementKind::Bars), law, of_bars)).transpose()?,
        in_creases.map(|law| of_elements(file, (values, ElementKind::Creases), law, of_hinges)).transpose()?,
        in_facets.map(|law| of_elements(file, (values, ElementKind::Facets), law, of_hinges)).transpose()?,
    ])
}

/// Returns the laws of the elements of a term: one for all, those of their letters, or those of a table.
fn of_elements<T>(
    file: &SceneFile,
    (values, of): (&ElementValues, ElementKind),
    spec: &Located<LawForm<T>>,
    read: LawReader<T>,
) -> Result<GivenLaw, SceneError> {
    let span = spec.span();
    match &**spec {
        LawForm::All(law) => {
            let (law, stiffness) = read(file, (law, spec.span()))?;
            Ok(GivenLaw { law: law.map(TermLaw::Uniform), stiffness, span })
        }
        LawForm::Letters(letters) => {
            let read = |(letter, law): (&Assignment, &T)| Ok((*letter, read(file, (law, spec.span()))?.0));
            let letters = letters.iter().map(read).collect::<Result<BTreeMap<_, _>, SceneError>>()?;
            let each = values.each_by_letter((&letters, "law"), of, spec.span(), (None, |_| Some(None)))?;
            Ok(GivenLaw { law: Some(TermLaw::PerEdge(each)), stiffness: None, span })
        }
        LawForm::Listed(table, laws) => {
            let read = |law: &T| Ok(read(file, (law, spec.span()))?.0);
            let laws = laws.iter().map(read).collect::<Result<Vec<_>, SceneError>>()?;
            let numbers = values.file_values(table, ColumnQuantity::Law(laws.len()), of)?;
            let law = |number: &f64| laws.get((*number as usize).wrapping_sub(1)).cloned().flatten();
            let law = Some(TermLaw::PerEdge(numbers.iter().map(law).collect()));
            Ok(GivenLaw { law, stiffness: None, span })
        }
    }
}

/// Returns the laws of the elements of bars, creases and facets, from those that are given and from where they yield.
pub(super) fn of_terms(
    file: &SceneFile,
    [of_bars, of_creases, of_facets]: [Option<GivenLaw>; 3],
    [bar, crease, facet]: [Option<Stiffness>; 3],
) -> Result<Laws, SceneError> {
    let energy = &file.scene.energy;
    let of_hinges =
        |spec: &Located<HingeYieldSpec>| Yield::new(spec.span(), [spec.moment.0, spec.hardening.0, spec.isotropic.0]);
    let in_bars = energy.bars.as_ref().and_then(|spec| spec.yields.as_ref());
    let in_bars = in_bars.map(|spec| Yield::new(spec.span(), [spec.force.0, spec.hardening.0, spec.isotropic.0]));
    let [in_creases, in_facets] = energy.hinges().map(|spec| spec?.yields.as_ref().map(of_hinges));
    Ok(Laws {
        bars: of_term(file, of_bars, (in_bars, bar), OfStrain)?,
        creases: of_term(file, of_creases, (in_creases, crease), OfAngle)?,
        facets: of_term(file, of_facets, (in_facets, facet), OfAngle)?,
    })
}

/// Returns the law of the bars.
fn of_bars(file: &SceneFile, (spec, span): (&BarLawSpec, Range<usize>)) -> Result<ReadLaw, SceneError> {
    match spec {
        BarLawSpec::Linear {} => Ok((None, None)),
        BarLawSpec::Ogden { exponents } => Ok(alone(OfStrain(Ogden { exponents: exponents.0 }))),
        BarLawSpec::GreenLagrange {} => Ok(alone(OfStrain(GreenLagrange))),
        BarLawSpec::Bilinear { ratio, at } => Ok(alone(OfStrain(Bilinear { ratio: ratio.0, at: at.0 }))),
        BarLawSpec::Table(curve) => table(file, (curve, span), ["strain", "force"], OfStrain),
        BarLawSpec::Formula { force } => formula(file, span, Formula::of_length(force), "length"),
    }
}

/// Returns the law of creases or facets.
fn of_hinges(file: &SceneFile, (spec, span): (&HingeLawSpec, Range<usize>)) -> Result<ReadLaw, SceneError> {
    match spec {
        HingeLawSpec::Linear {} => Ok((None, None)),
        HingeLawSpec::Stiffening { limits } => Ok(alone(Stiffening { limits: limits.0 })),
        HingeLawSpec::Power { exponent } => Ok(alone(OfAngle(Power { exponent: exponent.0 }))),
        HingeLawSpec::Bilinear { ratio, at } => {
            Ok(alone(OfAngle(Bilinear { ratio: ratio.0, at: at.0.map(|angle| angle.radians) })))
        }
        HingeLawSpec::Table(curve) => table(file, (curve, span), ["angle", "torque"], OfAngle),
        HingeLawSpec::Formula { torque } => formula(file, span, Formula::of_angle(torque), "angle"),
    }
}

/// A law that does not say the stiffness at rest.
fn alone(law: impl Law + 'static) -> ReadLaw {
    (Some(Arc::new(law)), None)
}

/// A bound at which the elements of a term yield, and its hardening: slope and isotropic part.
struct Yield {
    bound: f64,
    slope: f64,
    isotropic: f64,
    span: Range<usize>,
}

impl Yield {
    fn new(span: Range<usize>, [bound, slope, isotropic]: [f64; 3]) -> Self {
        Self { bound, slope, isotropic, span }
    }

    /// The law of an element of this stiffness; `None` if it is rigid, or none is there.
    fn of(&self, stiffness: f64) -> Option<ElasticPlastic> {
        let hardening = self.slope / (1.0 - self.slope);
        let [isotropic, kinematic] = [self.isotropic * hardening, (1.0 - self.isotropic) * hardening];
        let there = stiffness.is_finite();
        there.then(|| ElasticPlastic { at: self.bound / stiffness, kinematic, isotropic, memory: Memory::default() })
    }
}

/// Returns the laws of the elements of a term, given its law and where it yields, which may be left out.
fn of_term<L: Law + 'static>(
    file: &SceneFile,
    law: Option<GivenLaw>,
    (yields, stiffness): (Option<Yield>, Option<Stiffness>),
    of_curve: fn(ElasticPlastic) -> L,
) -> Result<Option<TermLaw>, SceneError> {
    if let (Some(GivenLaw { law: Some(law), span, .. }), Some(stiffness)) = (&law, &stiffness)
        && law.slackens_rigid(stiffness)
    {
        let message = "the law has no force on one side of rest, where what is rigid would be slack";
        return Err(file.error_at(span.clone(), message, "give elements of this law a finite stiffness"));
    }
    let (Some(yields), Some(stiffness)) = (yields, stiffness) else {
        return Ok(law.and_then(|law| law.law));
    };
    let refused = |message: &str, help: &str| Err(file.error_at(yields.span.clone(), message, help));
    if law.is_some_and(|law| law.law.is_some()) {
        return refused("the term has a law and yields at once", "leave out `law`: what yields is linear up to there");
    }
    if stiffness.is_rigid() {
        return refused("what is rigid does not yield", "give the term a finite stiffness");
    }
    let of = |stiffness: f64| yields.of(stiffness).map(|law| Arc::new(of_curve(law)) as Arc<dyn Law>);
    Ok(match stiffness {
        Stiffness::Uniform(stiffness) => of(stiffness).map(TermLaw::Uniform),
        Stiffness::PerEdge(each) => Some(TermLaw::PerEdge(each.iter().map(|stiffness| of(*stiffness)).collect())),
    })
}

/// Returns the law of a curve, which says the stiffness at rest too.
fn table<L: Law + 'static>(
    file: &SceneFile,
    spec: (&CurveSpec, Range<usize>),
    columns: [&'static str; 2],
    law: fn(Measured) -> L,
) -> Result<ReadLaw, SceneError> {
    let curve = measured(file, spec, columns)?;
    let slope = curve.slope();
    Ok((Some(Arc::new(law(curve))), Some(slope)))
}

/// Returns the law of a formula.
fn formula(
    file: &SceneFile,
    span: Range<usize>,
    read: Result<Formula, FormulaError>,
    measure: &str,
) -> Result<ReadLaw, SceneError> {
    let help =
        format!("m is the {measure}, m0 the {measure} at rest, k the spring constant; near rest it is k*(m - m0)");
    read.map(alone).map_err(|fault| file.error_at(span, fault.to_string(), help))
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
            let (lines, points): (Vec<usize>, Vec<[f64; 2]>) =
                read_table(&path, |text| rows(text, columns))?.into_iter().unzip();
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
fn rows(text: &str, columns: [&'static str; 2]) -> Result<Vec<CurveRow>, Fault> {
    let mut lines = numbered_lines(text);
    let (at, header) = lines.next().ok_or((1, TableFault::Empty))?;
    if header.split(',').map(str::trim).ne(columns) {
        let found = header.trim().into();
        return Err((at, TableFault::CurveHeader { found, columns }));
    }
    let read = |(line, text): (usize, &str)| {
        let fields: Vec<&str> = text.split(',').map(str::trim).collect();
        let [first, second] = fields[..] else {
            return Err((line, TableFault::Fields { found: fields.len(), expected: 2 }));
        };
        let number = |field: &str, column| {
            let number = field.parse().ok().filter(|number: &f64| number.is_finite());
            number.ok_or_else(|| (line, TableFault::Number { field: field.into(), column }))
        };
        let first = number(first, columns[0])?;
        let beyond = fault_of_turns(first).filter(|_| columns[0] == "angle");
        beyond.map_or(Ok(()), |[message, help]| Err((line, TableFault::Turns { message, help })))?;
        Ok((line, [first, number(second, columns[1])?]))
    };
    lines.map(read).collect()
}

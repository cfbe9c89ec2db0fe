//! The points of a sweep: the settings of every point, and the scene that they make.

mod axis;
mod rows;

use super::checks::check;
use super::setting::{Setting, without};
use super::spec::SweepSpec;
use super::{Located, SceneError, SceneFile};
use axis::{ResolvedAxis, TABLE, ValueLocation};

/// Largest number of points.
const MOST_POINTS: usize = 1_000_000;

/// The points of a scene with a table `[sweep]`, in order: the first axis is the slowest.
///
/// ```
/// use foldwell::scene::{Sweep, parse};
///
/// let scene = "[sheet]\nmesh = \"a.fold\"\ncells = [2, 2]\n[energy]\ncreases = { stiffness = 1 }\n\
///              [sweep]\n\"energy.creases.stiffness\" = { log = [1, 100, 3] }\n\"sheet.cells.0\" = [4, 8]\n";
/// let sweep = Sweep::of(&parse(scene, "scene.toml")?)?.expect("the scene has a sweep");
/// assert_eq!(sweep.len(), 6);
/// assert_eq!(sweep.keys().collect::<Vec<_>>(), ["energy.creases.stiffness", "sheet.cells.0"]);
/// assert_eq!(sweep.shape(), Some(vec![3, 2]));
/// assert_eq!(sweep.point(3).values, ["10.0", "8"]);
/// assert_eq!(sweep.point(3).settings[1].to_string(), "sheet.cells.0=8");
/// assert!(sweep.scene(3)?.scene.sweep.is_none());
/// # Ok::<(), foldwell::scene::SceneError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sweep {
    file: SceneFile,
    /// The text of the scene without its sweep.
    text: String,
    zip: bool,
    axes: Vec<ResolvedAxis>,
    len: usize,
}

/// A point of a sweep.
#[derive(Clone, Debug)]
pub struct Point {
    /// Number of the point, from 0.
    pub index: usize,
    /// The values of the keys of the sweep, as fields of a table: numbers, texts without quotes.
    pub values: Vec<String>,
    /// The settings that make the scene of this point of the scene without its sweep.
    pub settings: Vec<Setting>,
}

impl Sweep {
    /// Reads the axes of a sweep, and the table of points that it names; `None` if the scene has no sweep.
    ///
    /// # Errors
    /// [`SceneError`] with the place in the scene if an axis is wrong or sets a key that the scene does not have, if
    /// axes that run together have different lengths, or if there are too many points; with the line if the table is
    /// wrong.
    pub fn of(file: &SceneFile) -> Result<Option<Self>, SceneError> {
        let Some(spec) = &file.scene.sweep else { return Ok(None) };
        // before the values are made, of which there may be too many for the memory
        let counts = spec.axes.iter().filter_map(|axis| axis.values.count());
        number_of_points(file, spec, counts)?;
        let axes = spec.axes.iter().map(|axis| ResolvedAxis::read(file, axis)).collect::<Result<Vec<_>, _>>()?;
        if axes.is_empty() {
            let help = "add one, as in \"energy.bars.stiffness\" = [1e2, 1e4]";
            return Err(file.error_at(spec.span(), "the sweep has no axes", help));
        }
        different_keys(file, &axes)?;
        if spec.zip {
            common_length(file, &axes)?;
        }
        let len = number_of_points(file, spec, axes.iter().map(ResolvedAxis::len))?;
        Ok(Some(Self { file: file.clone(), text: without(file.text(), TABLE), zip: spec.zip, axes, len }))
    }

    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there are no points, which is never the case.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns the scene file with its sweep.
    pub fn file(&self) -> &SceneFile {
        &self.file
    }

    /// Returns the paths of the keys that the points set, in the order of [`Point::values`].
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().flat_map(|axis| axis.keys.iter().map(String::as_str))
    }

    /// Returns the number of values of each key if the points are their product, the first key the slowest; `None` if
    /// keys run together.
    pub fn shape(&self) -> Option<Vec<usize>> {
        let product = !self.zip && self.axes.iter().all(|axis| axis.keys.len() == 1);
        product.then(|| self.axes.iter().map(ResolvedAxis::len).collect())
    }

    /// Returns a point by its number, from 0 to [`len`](Self::len); numbers beyond begin anew.
    pub fn point(&self, index: usize) -> Point {
        let settings: Vec<Setting> = self.rows(index).into_iter().flat_map(|(axis, row)| axis.settings(row)).collect();
        Point { index, values: settings.iter().map(Setting::field).collect(), settings }
    }

    /// Returns the scene without its sweep, which is complete.
    ///
    /// # Errors
    /// [`SceneError`] with the first error in it.
    pub fn base(&self) -> Result<SceneFile, SceneError> {
        self.with(&[])
    }

    /// Returns the scene of a point: the scene without its sweep, with the settings of the point.
    ///
    /// # Errors
    /// [`SceneError`] with the place of the axis, the point and what is wrong with its scene.
    pub fn scene(&self, index: usize) -> Result<SceneFile, SceneError> {
        let point = self.point(index);
        self.with(&point.settings).map_err(|fault| self.at_point(&point, fault))
    }

    fn with(&self, settings: &[Setting]) -> Result<SceneFile, SceneError> {
        let file = self.file.with(&self.text, settings)?;
        check(&file)?;
        Ok(file)
    }

    /// Returns the numbers of the values that a point has on the axes.
    fn rows(&self, index: usize) -> Vec<(&ResolvedAxis, usize)> {
        let mut rest = index;
        let mut row = |axis: &ResolvedAxis| {
            let row = rest % axis.len();
            if !self.zip {
                rest /= axis.len();
            }
            row
        };
        let mut rows: Vec<_> = self.axes.iter().rev().map(|axis| (axis, row(axis))).collect();
        rows.reverse();
        rows
    }

    /// Returns the error of the scene of a point at the axis that alone makes it wrong; at the first if none does.
    fn at_point(&self, point: &Point, fault: SceneError) -> SceneError {
        let rows = self.rows(point.index);
        let guilty = rows.iter().find(|(axis, row)| self.with(&axis.settings(*row)).is_err()).or(rows.first());
        let settings: Vec<_> = point.settings.iter().map(Setting::to_string).collect();
        let (message, help) = match fault {
            SceneError::At { message, help, .. } => (message, help),
            SceneError::Setting { fault, .. } => (fault.to_string(), None),
            other => (other.to_string(), None),
        };
        let message = format!("point {} ({}): {message}", point.index, settings.join(", "));
        let place = guilty.map(|(axis, row)| axis.place(*row));
        match place {
            Some(ValueLocation::Line(path, line)) => {
                let message = help.map_or(message.clone(), |help| format!("{message}; {help}"));
                SceneError::Table { path, line, fault: super::error::TableFault::Point(message) }
            }
            place => {
                let span = place.map_or(0..0, |place| if let ValueLocation::Span(span) = place { span } else { 0..0 });
                let help = help.unwrap_or_else(|| "the path of a key has dots, as in energy.bars.stiffness".into());
                self.file.error_at(span, message, help)
            }
        }
    }
}

fn different_keys(file: &SceneFile, axes: &[ResolvedAxis]) -> Result<(), SceneError> {
    let first: Vec<(&ResolvedAxis, Setting)> =
        axes.iter().flat_map(|axis| axis.settings(0).into_iter().map(move |setting| (axis, setting))).collect();
    for (k, (axis, setting)) in first.iter().enumerate() {
        if first[..k].iter().any(|(_, other)| setting.same_key(other)) {
            let path = setting.to_string();
            let path = path.split('=').next().unwrap_or_default().trim();
            let message = format!("two axes set the key `{path}`");
            return Err(file.error_at(axis.span.clone(), message, "leave out one of them"));
        }
    }
    Ok(())
}

fn common_length(file: &SceneFile, axes: &[ResolvedAxis]) -> Result<(), SceneError> {
    let len = axes.first().map_or(0, ResolvedAxis::len);
    let Some(other) = axes.iter().find(|axis| axis.len() != len) else { return Ok(()) };
    let message = format!("the axes run together, and this one has {} values, the first {len}", other.len());
    let help = "give all axes one length, or leave out zip: then every value meets every other";
    Err(file.error_at(other.span.clone(), message, help))
}

/// Returns the number of points of a sweep whose axes have these numbers of values: their product, or the largest of
/// them if they run together.
fn number_of_points(
    file: &SceneFile,
    spec: &Located<SweepSpec>,
    counts: impl Iterator<Item = usize>,
) -> Result<usize, SceneError> {
    let counts: Vec<usize> = if spec.zip { counts.max().into_iter().collect() } else { counts.collect() };
    let len = counts.iter().try_fold(1usize, |product, count| product.checked_mul(*count));
    len.filter(|len| *len <= MOST_POINTS).ok_or_else(|| {
        let counts: Vec<_> = counts.iter().map(usize::to_string).collect();
        let message = format!("the sweep has {} points", counts.join(" x "));
        file.error_at(spec.span(), message, format!("{MOST_POINTS} are the most that one sweep can have"))
    })
}

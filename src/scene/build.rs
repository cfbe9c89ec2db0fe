//! The assembly of a scene: reads the mesh, and checks every value of the scene that refers to the sheet.

pub(crate) use super::drives::rest as rest_drive;
use super::elements::{ElementKind, ElementValues};
use super::forms::{Mode, RatesFile};
use super::laws::GivenLaw;
use super::material::{mass, material};
use super::places::Places;
use super::rest::{ModeRest, RestSpec};
use super::rows::ColumnQuantity;
use super::spec::{CreasesSpec, DomainSpec, Lattice};
use super::stiffness::StiffnessSpec;
use super::values::EdgeName;
use super::{Located, SceneError, SceneFile, drives, laws, loads, ties};
use crate::kinematics::folding_modes_with_locked;
use crate::model::{Assembly, Bars, Boundary, Drive, Hinges, RIGID, Stiffness, Terms};
use crate::sheet::pattern::{self, Cleanup, Format};
use crate::sheet::{EdgeKind, Sheet, Tiling, fold, generate, obj, stl};
use std::ops::Range;
use std::path::Path;

/// Reads the mesh of a scene and assembles the sheet, boundary conditions and terms of its studies.
///
/// # Errors
/// [`SceneError`] if the mesh cannot be read, or the scene refers to a part of the sheet that does not exist.
pub fn assembly(file: &SceneFile) -> Result<Assembly, SceneError> {
    assembly_of(file, sheet(file)?)
}

/// Does the same as [`assembly`] with a sheet that is there already, instead of the mesh of the scene.
///
/// # Errors
/// [`SceneError`] if the scene refers to a part of the sheet that does not exist.
pub fn assembly_of(file: &SceneFile, sheet: Sheet) -> Result<Assembly, SceneError> {
    built(file, sheet).map_err(|error| file.placed(error))
}

fn built(file: &SceneFile, sheet: Sheet) -> Result<Assembly, SceneError> {
    let sheet = super::material::with_panels(file, sheet)?;
    let boundary = boundary(file, &sheet)?;
    super::memory::check(file, &sheet)?;
    let cells = file.scene.sheet.cells();
    let bare = match super::rolled::roll(file, &sheet)? {
        Some(roll) => Assembly::tube_without_terms(sheet, &roll, cells),
        None => Assembly::without_terms(sheet, cells, boundary),
    };
    let bare = bare.map_err(|error| file.error_at(0..0, error.to_string(), "see [sheet]"))?;
    let reader = TermReader::new(file, &bare);
    let assembly = loads::loaded(file, &bare.with_terms(reader.terms()?).with_best_axis())?;
    super::rolled::polygons_bend(file, &assembly)?;
    file.scene.drives.iter().try_for_each(|spec| drives::resolve(file, &assembly, spec).map(|_| ()))?;
    Ok(assembly)
}

/// Returns the drive of a scene that has this name.
///
/// # Errors
/// [`SceneError`] if there is no such drive, or it drives nothing on this sheet.
pub fn drive(file: &SceneFile, assembly: &Assembly, name: &str) -> Result<Drive, SceneError> {
    let found = file.scene.drives.iter().find(|drive| drive.name.0 == name);
    let spec = found.ok_or_else(|| file.error_at(0..0, format!("no drive is called `{name}`"), "add a [[drive]]"))?;
    drives::resolve(file, assembly, spec)
}

/// Returns the rates of a mode from its table, for every edge of the tiling; NaN if the table has none.
pub(crate) fn rates(file: &SceneFile, assembly: &Assembly, name: &RatesFile) -> Result<Vec<f64>, SceneError> {
    TermReader::new(file, assembly).rates(name, (ElementKind::Creases, ElementKind::Facets))
}

/// Returns the sheet of a scene, from its mesh or its generator.
///
/// # Errors
/// [`SceneError`] if the mesh cannot be read, or the pattern does not exist for its parameters.
pub fn sheet(file: &SceneFile) -> Result<Sheet, SceneError> {
    let spec = &file.scene.sheet;
    if let Some(mesh) = &spec.mesh {
        return mesh_of(file, &file.resolve(mesh)).map_err(|error| file.placed(error));
    }
    let Some(table) = &spec.generate else {
        return Err(file.error_at(0..0, "the sheet has no mesh", "give `mesh = \"file.fold\"` or `generate = { .. }`"));
    };
    let found = generate::Pattern::of(table).and_then(|pattern| generate::generate(&pattern));
    found.map_err(|error| file.error_at(table.span(), error.to_string(), error.help()))
}

/// Returns another sheet that a study names, from its mesh.
pub(crate) fn other_sheet(file: &SceneFile, path: &Path) -> Result<Sheet, SceneError> {
    let path = file.resolve(path);
    fold::read(&path).map_err(|error| file.placed(error.into()))
}

/// Reads the mesh at `path` in the format of its ending; FOLD if that is unknown.
fn mesh_of(file: &SceneFile, path: &Path) -> Result<Sheet, SceneError> {
    let spec = &file.scene.sheet;
    let frame = spec.frame.as_ref();
    let ending = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let lines = Format::of(path);
    let is_mesh = ["obj", "stl"].contains(&ending.as_str());
    if let Some(frame) = frame.filter(|_| lines.is_some() || is_mesh) {
        let kind = if lines.is_some() { "a crease pattern of lines" } else { "a mesh of faces" };
        let help = "frames are those of FOLD files; leave out `frame`";
        return Err(file.error_at(frame.span(), format!("{kind} has no frames"), help));
    }
    if let Some(merge) = spec.merge.as_ref().filter(|_| is_mesh) {
        let help = "points are merged in drawings of lines and in flat FOLD files; leave out `merge`";
        return Err(file.error_at(merge.span(), "a mesh of faces has no lines to join", help));
    }
    let cleanup = Cleanup { merge: spec.merge.as_ref().map(|merge| **merge), split: true };
    match (lines, ending.as_str()) {
        (Some(format), _) => Ok(pattern::read(path, format, &cleanup)?),
        (None, "obj") => Ok(obj::read(path)?),
        (None, "stl") => Ok(stl::read(path)?),
        (None, "vtu") => {
            let span = file.scene.sheet.mesh.as_ref().map_or(0..0, Located::span);
            let help = "convert it to a .fold file; a state to start from is `start` of a study";
            Err(file.error_at(span, "a mesh of a scene is no .vtu file", help))
        }
        (None, _) => {
            let cleanup = spec.merge.as_ref().map(|_| &cleanup);
            Ok(fold::read_frame(path, frame.map(|frame| **frame), cleanup)?)
        }
    }
}

fn boundary(file: &SceneFile, sheet: &Sheet) -> Result<Boundary, SceneError> {
    let spec = &file.scene.sheet;
    let periodic = match spec.domain() {
        DomainSpec::Patch => return Ok(Boundary::Patch),
        DomainSpec::Torus if spec.lattice() == Lattice::Fixed => Boundary::FixedTorus,
        DomainSpec::Torus => Boundary::FreeTorus,
        // the roll of a tube says its boundary conditions
        DomainSpec::Screw | DomainSpec::Tube => Boundary::Screw,
    };
    if sheet.lattice.is_some() || (sheet.screws.is_some() && spec.domain() == DomainSpec::Tube) {
        return Ok(periodic);
    }
    if sheet.screws.is_some() {
        let span = spec.domain.as_ref().map_or(0..0, Located::span);
        let help = "give domain = \"tube\" with a seam, or \"patch\" for a piece of it that is not joined";
        return Err(file.error_at(span, "the mesh is drawn as a tube, without lattice vectors", help));
    }
    let span = spec.domain.as_ref().map_or(0..0, Located::span);
    let help = "a finite sheet has domain \"patch\"; a periodic one has the key `foldwell:lattice` in its mesh, \
                in OBJ as two comments `# foldwell:lattice x y z`";
    Err(file.error_at(span, "the mesh has no lattice", help))
}

/// The reader of the terms of a scene, which refer to its sheet.
struct TermReader<'a> {
    file: &'a SceneFile,
    assembly: &'a Assembly,
    sheet: &'a Sheet,
    tiling: &'a Tiling,
    values: ElementValues<'a>,
    /// Drawn fold angle of every edge of the tiling; NaN for an edge that is not a hinge.
    angles: &'a [f64],
}

impl<'a> TermReader<'a> {
    fn new(file: &'a SceneFile, assembly: &'a Assembly) -> Self {
        let (sheet, tiling, angles) = (assembly.sheet(), assembly.tiling(), assembly.drawn_angles());
        Self { file, assembly, sheet, tiling, values: ElementValues::new(file, assembly), angles }
    }

    fn terms(&self) -> Result<Terms, SceneError> {
        let energy = &self.file.scene.energy;
        let (bar_spec, [crease_spec, facet_spec]) = (energy.bars.as_ref(), energy.hinges());
        let [bar_law, crease_law, facet_law] = laws::given(self.file, &self.values)?;
        let given = bar_spec.and_then(|spec| spec.stiffness.as_ref());
        let bars = self.stiffness(given, bar_law.as_ref(), ElementKind::Bars)?;
        let rest = bar_spec.and_then(|spec| spec.rest.as_ref());
        let bars = bars.map(|stiffness| self.values.lengths(rest).map(|rest| Bars { stiffness, rest })).transpose()?;
        // without facets on the tiling, those of the cell still say which folding modes there are
        let given = |spec: Option<&'a CreasesSpec>| spec.and_then(|spec| spec.stiffness.as_ref());
        let facet_stiffness = self.stiffness(given(facet_spec), facet_law.as_ref(), ElementKind::Facets)?;
        let facet_stiffness = facet_stiffness.unwrap_or(RIGID.into());
        let rigid = self.rigid_facets(&facet_stiffness);
        let crease_stiffness = self.stiffness(given(crease_spec), crease_law.as_ref(), ElementKind::Creases)?;
        let hinges = |stiffness, of, spec| self.rest(spec, of, &rigid).map(|rest| Hinges { stiffness, rest });
        let creases = crease_stiffness.map(|stiffness| hinges(stiffness, ElementKind::Creases, crease_spec));
        let has_facets = self.tiling.facets().next().is_some();
        let facets = has_facets.then(|| hinges(facet_stiffness, ElementKind::Facets, facet_spec)).transpose()?;
        let creases = creases.transpose()?;
        let of_hinges = |hinges: &'_ Option<Hinges>| hinges.as_ref().map(|hinges| hinges.stiffness.clone());
        let stiffness = [bars.as_ref().map(|bars| bars.stiffness.clone()), of_hinges(&creases), of_hinges(&facets)];
        let laws = laws::of_terms(self.file, [bar_law, crease_law, facet_law], stiffness)?;
        let (locks, mass) = (self.locks()?, mass(self.file));
        let terms = Terms { bars, creases, facets, locks, mass, laws, ..Terms::default() };
        self.placed(terms)
    }

    /// Returns the stiffness of a term, as given, as its law has it at rest or as the material has it; `None` if none
    /// of them says anything of it.
    fn stiffness(
        &self,
        given: Option<&Located<StiffnessSpec>>,
        law: Option<&GivenLaw>,
        of: ElementKind,
    ) -> Result<Option<Stiffness>, SceneError> {
        if let Some(spec) = given {
            return self.values.stiffness(spec, of).map(Some);
        }
        if let Some(stiffness) = law.and_then(|law| law.stiffness) {
            return Ok(Some(stiffness.into()));
        }
        let Some(material) = material(self.file) else { return Ok(None) };
        let energy = &self.file.scene.energy;
        Ok(match of {
            ElementKind::Bars if energy.has_membrane() && energy.bars.is_none() => None,
            ElementKind::Bars => Some(super::material::bars(self.file, self.assembly, &material)?),
            ElementKind::Creases => material.creases(),
            ElementKind::Facets => Some(material.facets(self.assembly)),
        })
    }

    /// Returns the diagonals of the cell's polygons that are rigid in every cell.
    fn rigid_facets(&self, stiffness: &Stiffness) -> Vec<usize> {
        if let Some(stiffness) = stiffness.uniform() {
            return self.sheet.facets().filter(|_| stiffness.is_infinite()).collect();
        }
        let mut soft = vec![false; self.sheet.edges.len()];
        self.tiling
            .facets()
            .filter(|&k| stiffness.of(k).is_finite())
            .for_each(|k| soft[self.tiling.edges[k].edge] = true);
        self.sheet.facets().filter(|&edge| !soft[edge]).collect()
    }

    /// Returns the rest angle of every edge of the tiling; only those of hinges of this term are meant.
    fn rest(
        &self,
        spec: Option<&CreasesSpec>,
        of: ElementKind,
        rigid_facets: &[usize],
    ) -> Result<Vec<f64>, SceneError> {
        let Some(CreasesSpec { rest: Some(rest), fraction, .. }) = spec else { return Ok(self.angles.to_vec()) };
        let fraction = fraction.as_ref().map_or(1.0, |fraction| fraction.0);
        let part = |angles: Vec<f64>| angles.into_iter().map(|angle| fraction * angle).collect();
        match &**rest {
            RestSpec::Target => self.targets(fraction, rest.span()),
            RestSpec::Assigned => self.flat_folded(of, rest.span()).map(part),
            RestSpec::Letters(letters) => self.values.angles_by_letter(letters, of, rest.span()).map(part),
            RestSpec::Drawn => Ok(self.angles.to_vec()),
            RestSpec::Flat => Ok(vec![0.0; self.angles.len()]),
            RestSpec::Angle(angle) => Ok(vec![angle.radians; self.angles.len()]),
            RestSpec::Mode(mode) => self.along_mode(mode, of, rigid_facets),
            RestSpec::File(name) => {
                let angles = self.values.file_values(name, ColumnQuantity::Angle, of)?;
                let rigid = if of == ElementKind::Creases { rigid_facets } else { &[] };
                self.values.flat_at(rigid, &name.file).map(|()| angles)
            }
        }
    }

    /// Returns the angles of the sheet folded flat by its letters.
    fn flat_folded(&self, of: ElementKind, span: Range<usize>) -> Result<Vec<f64>, SceneError> {
        let angles = self.assembly.assigned_angles();
        let unfolded = of == ElementKind::Creases && angles.iter().all(|angle| *angle == 0.0);
        let help = "give `edges_assignment` in the mesh, or other rest angles";
        self.file.error_if(unfolded, span, "no crease has the letter M or V", help)?;
        Ok(angles)
    }

    /// Returns a fraction of the target angles of the mesh file; the drawn angles where it gives none.
    fn targets(&self, fraction: f64, span: Range<usize>) -> Result<Vec<f64>, SceneError> {
        if self.sheet.targets.is_empty() {
            let help = "fold angles of the mesh, if it has them, are the drawn ones: rest = \"drawn\"; rest = \"assigned\" \
                        folds by the letters M and V";
            return Err(self.file.error_at(span, "the mesh gives no target angles", help));
        }
        Ok(self.assembly.target_angles(fraction))
    }

    fn along_mode(&self, rest: &ModeRest, of: ElementKind, rigid_facets: &[usize]) -> Result<Vec<f64>, SceneError> {
        let rates = match &*rest.mode {
            // soft facets fold as creases do, and a table of rates may have rows for both
            Mode::Rates(name) if of == ElementKind::Facets => {
                self.rates(name, (ElementKind::Facets, ElementKind::Creases))?
            }
            Mode::Rates(name) => self.rates(name, (ElementKind::Creases, ElementKind::Facets))?,
            Mode::Wave(_) => {
                let help = "name the mode by its curvatures, [k11, k22, k12], or by its rates";
                return Err(self.file.error_at(rest.mode.span(), "rest angles do not go along waves", help));
            }
            Mode::Curvature(curvature) => {
                let modes = folding_modes_with_locked(self.sheet, rigid_facets);
                let mode = modes.and_then(|modes| modes.named(*curvature));
                let help = "name the mode by its rates: { rates = \"file.csv\" }";
                let mode = mode.map_err(|e| self.file.error_at(rest.mode.span(), e.to_string(), help))?;
                self.tiling.edges.iter().map(|edge| mode[edge.edge]).collect()
            }
        };
        let amplitude = rest.amplitude.0;
        Ok(self.angles.iter().zip(&rates).map(|(angle, rate)| angle + amplitude * rate).collect())
    }

    /// Returns the rates of a table: every hinge of the first term has one, and hinges of the second may have one.
    fn rates(&self, name: &RatesFile, of: (ElementKind, ElementKind)) -> Result<Vec<f64>, SceneError> {
        self.values.named_values(&name.rates, ColumnQuantity::Rate, of)
    }

    fn locks(&self) -> Result<Vec<(usize, f64)>, SceneError> {
        let mut locks = Vec::new();
        for lock in &self.file.scene.locks {
            let before = locks.len();
            self.check_crease(&lock.crease)?;
            if lock.angle.is_some() {
                drives::one_hinge(self.file, self.sheet, &lock.crease)?;
            }
            for (k, tiled) in self.tiling.edges.iter().enumerate() {
                if self.sheet.edges[tiled.edge].key.whole() == lock.crease.0 && !self.angles[k].is_nan() {
                    let start = self.assembly.start_angles()[k];
                    locks.push((k, lock.angle.as_ref().map_or(start, |angle| angle.radians)));
                }
            }
            let [n1, n2] = self.tiling.cells;
            let message = format!("no copy of the crease {} folds in a patch of {n1} x {n2} cells", lock.crease.0);
            let help = "all of them are on its rim or beyond: lock a crease inside, or give more `cells`";
            self.file.error_if(locks.len() == before, lock.crease.span(), message, help)?;
        }
        Ok(locks)
    }

    /// Checks that the sheet has a crease.
    fn check_crease(&self, crease: &Located<EdgeName>) -> Result<(), SceneError> {
        let key = crease.0;
        if self.values.has(key, |kind| kind == EdgeKind::Crease) {
            return Ok(());
        }
        let creases = self.sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease && edge.key.has_bar());
        let known: Vec<String> = creases.take(4).map(|edge| edge.key.to_string()).collect();
        let help = format!("the creases are {}, ...", known.join(", "));
        Err(self.file.error_at(crease.span(), format!("the sheet has no crease {key}"), help))
    }

    /// Adds what holds and joins vertices to the terms.
    fn placed(&self, terms: Terms) -> Result<Terms, SceneError> {
        let places = Places::new(self.file, self.assembly);
        let mut held = places.held()?;
        let (mut parts, springs) = (places.parts(&held)?, places.springs()?);
        ties::add((self.file, self.assembly), &mut held, &mut parts)?;
        let own = springs.into_iter().chain(super::material::membrane(self.file, self.assembly)).collect();
        Ok(Terms { parts, pins: held.pins, guides: held.guides, own, ..terms })
    }
}

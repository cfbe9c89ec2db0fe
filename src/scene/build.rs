//! The assembly of a scene: reads the mesh, and checks every value of the scene that refers to the sheet.

use super::angles::{AngleRow, read_angles, read_rates};
use super::error::TableFault;
use super::forms::{Mode, ModeRest, RatesFile, RestSpec};
use super::spec::{DomainSpec, Lattice};
use super::values::{CellIndex, EdgeName};
use super::{Located, SceneError, SceneFile};
use crate::kinematics::folding_modes_with_locked;
use crate::math::Vec3;
use crate::model::{Assembly, AssemblyError, Boundary, Hinges, Terms};
use crate::sheet::{EdgeKey, EdgeKind, Sheet, Tiling, fold, generate};
use std::collections::HashMap;
use std::ops::Range;
use std::path::Path;

/// Reads the mesh of a scene and assembles the sheet, boundary conditions and terms of its studies.
///
/// # Errors
/// [`SceneError`] if the mesh cannot be read, or the scene refers to a part of the sheet that does not exist.
pub fn assembly(file: &SceneFile) -> Result<Assembly, SceneError> {
    let sheet = sheet(file)?;
    let boundary = boundary(file, &sheet)?;
    super::memory::check(file, &sheet)?;
    let bare = Assembly::without_terms(sheet, file.scene.sheet.cells(), boundary);
    let bare = bare.map_err(|error| file.error_at(0..0, error.to_string(), "see [sheet]"))?;
    let terms = Reader::new(file, &bare).terms()?;
    Ok(bare.with_terms(terms).with_best_axis())
}

/// Returns remarks about a scene for the user, made before its studies.
pub(crate) fn notes(file: &SceneFile, assembly: &Assembly) -> Vec<String> {
    super::turns::notes(file, assembly.terms())
}

/// Returns the rates of a mode from its table, for every edge of the tiling; NaN if the table has none.
///
/// # Errors
/// [`SceneError`] if the table cannot be read, names an edge that does not fold, or lacks a crease.
pub(crate) fn rates(file: &SceneFile, assembly: &Assembly, name: &RatesFile) -> Result<Vec<f64>, SceneError> {
    Reader::new(file, assembly).rates(name)
}

/// Returns the sheet of a scene, from its mesh or its generator.
///
/// # Errors
/// [`SceneError`] if the mesh cannot be read, or the pattern does not exist for its parameters.
pub fn sheet(file: &SceneFile) -> Result<Sheet, SceneError> {
    let spec = &file.scene.sheet;
    if let Some(mesh) = &spec.mesh {
        return Ok(fold::read(&file.resolve(mesh))?);
    }
    let Some(table) = &spec.generate else {
        return Err(file.error_at(0..0, "the sheet has no mesh", "give `mesh = \"file.fold\"` or `generate = { .. }`"));
    };
    let wrong = |message: String| file.error_at(table.span(), message, "see `foldwell new --help` for the patterns");
    let pattern: generate::Pattern =
        (**table).clone().try_into().map_err(|e: toml::de::Error| wrong(e.message().into()))?;
    generate::generate(&pattern).map_err(|error| wrong(error.to_string()))
}

fn boundary(file: &SceneFile, sheet: &Sheet) -> Result<Boundary, SceneError> {
    let spec = &file.scene.sheet;
    let periodic = match spec.domain() {
        DomainSpec::Patch => return Ok(Boundary::Patch),
        DomainSpec::Torus if spec.lattice() == Lattice::Fixed => Boundary::FixedTorus,
        DomainSpec::Torus => Boundary::FreeTorus,
        DomainSpec::Screw => Boundary::Screw,
    };
    if sheet.lattice.is_some() {
        return Ok(periodic);
    }
    let span = spec.domain.as_ref().map_or(0..0, Located::span);
    let help = "a finite sheet has domain \"patch\"; a periodic one has the key `foldwell:lattice` in its mesh";
    Err(file.error_at(span, "the mesh has no lattice", help))
}

fn names(sheet: &Sheet) -> HashMap<EdgeKey, usize> {
    sheet.edges.iter().enumerate().map(|(k, edge)| (edge.key, k)).collect()
}

/// The reader of the terms of a scene, which refer to its sheet.
struct Reader<'a> {
    file: &'a SceneFile,
    sheet: &'a Sheet,
    tiling: &'a Tiling,
    /// Number of each edge of the cell by its name.
    names: HashMap<EdgeKey, usize>,
    /// Drawn fold angle of every edge of the tiling; NaN for an edge that is not a hinge.
    angles: &'a [f64],
}

impl<'a> Reader<'a> {
    fn new(file: &'a SceneFile, assembly: &'a Assembly) -> Self {
        let (sheet, tiling, angles) = (assembly.sheet(), assembly.tiling(), assembly.drawn_angles());
        Self { file, sheet, tiling, names: names(sheet), angles }
    }

    fn terms(&self) -> Result<Terms, SceneError> {
        let energy = &self.file.scene.energy;
        let creases = match &energy.creases {
            Some(spec) => Some(Hinges { stiffness: spec.stiffness.0, rest: self.rest(spec.rest.as_ref())? }),
            None => None,
        };
        let stiffness = self.facet_stiffness();
        let has_facets = self.tiling.facets().next().is_some();
        let facets = has_facets.then(|| Hinges { stiffness, rest: self.angles.to_vec() });
        let terms = Terms {
            bars: energy.bars.as_ref().map(|spec| spec.stiffness.0),
            creases,
            facets,
            locks: self.locks()?,
            pins: self.pins()?,
            loads: self.loads()?,
        };
        self.balance(&terms)?;
        Ok(terms)
    }

    /// Returns the stiffness of the facets; infinite, that is rigid, if the scene gives none.
    fn facet_stiffness(&self) -> f64 {
        self.file.scene.energy.facets.as_ref().map_or(f64::INFINITY, |spec| spec.stiffness.0)
    }

    /// Returns the diagonals of the cell's polygons if these are rigid; none otherwise.
    fn rigid_facets(&self) -> Vec<usize> {
        let rigid = self.facet_stiffness().is_infinite();
        self.sheet.facets().filter(|_| rigid).collect()
    }

    /// Returns the rest angle of every edge of the tiling.
    fn rest(&self, rest: Option<&Located<RestSpec>>) -> Result<Vec<f64>, SceneError> {
        let Some(rest) = rest else { return Ok(self.angles.to_vec()) };
        match &**rest {
            RestSpec::Drawn => Ok(self.angles.to_vec()),
            RestSpec::Flat => Ok(vec![0.0; self.angles.len()]),
            RestSpec::Angle(angle) => Ok(vec![*angle; self.angles.len()]),
            RestSpec::Mode(mode) => self.along_mode(mode),
            RestSpec::File(name) => {
                let path = self.file.resolve(&name.file);
                let rows = read_angles(&path)?;
                self.table(&path, &rows, &[EdgeKind::Crease], name.file.span())
            }
        }
    }

    fn along_mode(&self, rest: &ModeRest) -> Result<Vec<f64>, SceneError> {
        let rates = match &*rest.mode {
            Mode::Rates(name) => self.rates(name)?,
            Mode::Wave(_) => {
                let help = "name the mode by its curvatures, [k11, k22, k12], or by its rates";
                return Err(self.file.error_at(rest.mode.span(), "rest angles do not go along waves", help));
            }
            Mode::Curvature(curvature) => {
                let modes = folding_modes_with_locked(self.sheet, &self.rigid_facets());
                let mode = modes.and_then(|modes| modes.named(*curvature));
                let help = "name the mode by its rates: { rates = \"file.csv\" }";
                let mode = mode.map_err(|e| self.file.error_at(rest.mode.span(), e.to_string(), help))?;
                self.tiling.edges.iter().map(|edge| mode[edge.edge]).collect()
            }
        };
        let amplitude = rest.amplitude.0;
        Ok(self.angles.iter().zip(&rates).map(|(angle, rate)| angle + amplitude * rate).collect())
    }

    fn rates(&self, name: &RatesFile) -> Result<Vec<f64>, SceneError> {
        let path = self.file.resolve(&name.rates);
        // soft facets fold as creases do; those without a row have no rate
        self.table(&path, &read_rates(&path)?, &[EdgeKind::Crease, EdgeKind::Facet], name.rates.span())
    }

    /// Returns the values of a table on the edges of the tiling. Every hinge of the first of these kinds must have a
    /// value, hinges of the other kinds may have one.
    fn table(
        &self,
        path: &Path,
        rows: &[AngleRow],
        kinds: &[EdgeKind],
        span: Range<usize>,
    ) -> Result<Vec<f64>, SceneError> {
        let mut values = vec![f64::NAN; self.tiling.edges.len()];
        let mut copies: HashMap<(usize, Option<[usize; 2]>), Vec<usize>> = HashMap::new();
        for (k, tiled) in self.tiling.edges.iter().enumerate() {
            copies.entry((tiled.edge, None)).or_default().push(k);
            copies.entry((tiled.edge, Some(tiled.cell))).or_default().push(k);
        }
        for row in rows {
            let fault = |fault| SceneError::Table { path: path.into(), line: row.line, fault };
            let edge = self
                .hinge(row.key, kinds)
                .ok_or_else(|| fault(TableFault::Edge(format!("the sheet has no crease {}", name(row.key)))))?;
            let Some(found) = copies.get(&(edge, row.cell)) else {
                let [c1, c2] = row.cell.unwrap_or_default();
                let message = format!("there is no crease {} in cell [{c1}, {c2}]", name(row.key));
                return Err(fault(TableFault::Edge(message)));
            };
            found.iter().for_each(|&k| values[k] = row.value);
        }
        let missing = |k: &usize| kinds.first() == Some(&self.tiling.edges[*k].kind) && values[*k].is_nan();
        match (0..values.len()).find(missing) {
            None => Ok(values),
            Some(k) => {
                let (tiled, key) = (&self.tiling.edges[k], self.sheet.edges[self.tiling.edges[k].edge].key);
                let message =
                    format!("{} has no row for crease {} of cell {:?}", path.display(), name(key), tiled.cell);
                Err(self.file.error_at(span, message, "give one row for each crease"))
            }
        }
    }

    /// Returns the number of an edge of the cell that is a hinge of one of these kinds.
    fn hinge(&self, key: EdgeKey, kinds: &[EdgeKind]) -> Option<usize> {
        self.names.get(&key).copied().filter(|&k| kinds.contains(&self.sheet.edges[k].kind))
    }

    fn locks(&self) -> Result<Vec<(usize, f64)>, SceneError> {
        let mut locks = Vec::new();
        for lock in &self.file.scene.locks {
            let edge = self.crease(&lock.crease)?;
            for (k, tiled) in self.tiling.edges.iter().enumerate() {
                if tiled.edge == edge && !self.angles[k].is_nan() {
                    locks.push((k, lock.angle.as_ref().map_or(self.angles[k], |angle| angle.0)));
                }
            }
        }
        Ok(locks)
    }

    fn crease(&self, crease: &Located<EdgeName>) -> Result<usize, SceneError> {
        let key = crease.0;
        self.hinge(key, &[EdgeKind::Crease]).ok_or_else(|| {
            let known: Vec<String> =
                self.sheet.edges.iter().filter(|e| e.kind == EdgeKind::Crease).take(4).map(|e| name(e.key)).collect();
            let help = format!("the creases are {}, ...; `foldwell info` counts them", known.join(", "));
            self.file.error_at(crease.span(), format!("the sheet has no crease {}", name(key)), help)
        })
    }

    fn vertex(&self, vertex: &Located<usize>, cell: [usize; 2], span: Range<usize>) -> Result<usize, SceneError> {
        let count = self.sheet.vertices.len();
        if **vertex >= count {
            let help = format!("the vertices of a cell are 0 to {}", count - 1);
            return Err(self.file.error_at(vertex.span(), format!("there is no vertex {}", **vertex), help));
        }
        let [n1, n2] = self.tiling.cells;
        if cell[0] >= n1 || cell[1] >= n2 {
            let help = format!("the cells are [0, 0] to [{}, {}]", n1 - 1, n2 - 1);
            return Err(self.file.error_at(span, format!("there is no cell {cell:?}"), help));
        }
        Ok((cell[1] * n1 + cell[0]) * count + **vertex)
    }

    fn pins(&self) -> Result<Vec<(usize, [bool; 3])>, SceneError> {
        let place = |cell: &Option<Located<CellIndex>>| cell.as_ref().map_or(0..0, Located::span);
        let pins = &self.file.scene.pins;
        pins.iter().map(|pin| Ok((self.vertex(&pin.vertex, pin.cell(), place(&pin.cell))?, pin.axes()))).collect()
    }

    fn loads(&self) -> Result<Vec<(usize, Vec3)>, SceneError> {
        let place = |cell: &Option<Located<CellIndex>>| cell.as_ref().map_or(0..0, Located::span);
        let loads = &self.file.scene.loads;
        let load = |load: &super::spec::LoadSpec| {
            Ok((self.vertex(&load.vertex, load.cell(), place(&load.cell))?, Vec3::from(load.force.0)))
        };
        loads.iter().map(load).collect()
    }

    /// Checks that the loads balance along every axis on which no vertex is pinned: otherwise there is no equilibrium.
    fn balance(&self, terms: &Terms) -> Result<(), SceneError> {
        let Some((axis, force)) = terms.unbalanced_axis() else { return Ok(()) };
        let span = self.file.scene.loads[0].force.span();
        let message = AssemblyError::Unbalanced { axis, force }.to_string();
        let help = "balance the loads, or pin a vertex along that axis; a sheet with fewer than three pinned vertices \
                    still turns as a whole, until its loads pull straight";
        Err(self.file.error_at(span, message, help))
    }
}

fn name(key: EdgeKey) -> String {
    format!("[{}, {}, {}, {}]", key.i, key.j, key.shift[0], key.shift[1])
}

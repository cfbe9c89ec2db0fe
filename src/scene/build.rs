//! From a scene to what is computed: reads the mesh, and checks everything that a scene says about its sheet.

use super::angles::{AngleRow, read_angles, read_rates};
use super::error::TableFault;
use super::forms::{Mode, ModeRest, RatesFile, Rest};
use super::spec::{Domain, Lattice};
use super::values::{CellIndex, EdgeName};
use super::{Located, SceneError, SceneFile};
use crate::analysis::axis::drawn_for;
use crate::kinematics::folding_modes_with_locked;
use crate::math::Vec3;
use crate::model::assemble::{Boundary, Drawn, Hinges, Terms, drawn_angles};
use crate::sheet::{EdgeKey, EdgeKind, Sheet, Tiling, fold, generate, tile};
use std::collections::{HashMap, HashSet};
use std::ops::Range;
use std::path::Path;

/// A scene made ready.
pub struct Built {
    /// The sheet.
    pub sheet: Sheet,
    /// Its cells as the studies see them.
    pub tiling: Tiling,
    /// What surrounds them.
    pub boundary: Boundary,
    /// The drawn state.
    pub drawn: Drawn,
    /// What the sheet is made of and what acts on it.
    pub terms: Terms,
    /// How many cells pictures of a screw show.
    pub shown: [usize; 2],
    /// What is to be said about the scene before its studies.
    pub notes: Vec<String>,
}

/// Reads the mesh of a scene and builds what its studies need.
pub fn build(file: &SceneFile) -> Result<Built, SceneError> {
    let sheet = sheet(file)?;
    let spec = &file.scene.sheet;
    let boundary = boundary(file, &sheet)?;
    let screw = boundary == Boundary::Screw;
    let cells = if screw || sheet.lattice.is_none() { [1, 1] } else { spec.cells() };
    super::memory::check(file, &sheet)?;
    let tiling = tile(&sheet, cells, boundary != Boundary::Patch);
    let drawn = Drawn::new(&sheet, &tiling, boundary);
    let builder = Builder::new(file, &sheet, &tiling, drawn_angles(&drawn, &tiling));
    let terms = builder.terms()?;
    let drawn = drawn_for(&sheet, &tiling, boundary, &terms);
    let notes = super::turns::notes(file, &terms);
    Ok(Built { boundary, drawn, terms, shown: spec.cells(), notes, tiling, sheet })
}

/// Rates of a mode from its table, for every edge of the tiling; NaN where the table has none.
pub fn rates(file: &SceneFile, built: &Built, name: &RatesFile) -> Result<Vec<f64>, SceneError> {
    let angles = drawn_angles(&built.drawn, &built.tiling);
    Builder::new(file, &built.sheet, &built.tiling, angles).rates(name)
}

/// The sheet of a scene, from its mesh or its generator.
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
        Domain::Patch => return Ok(Boundary::Patch),
        Domain::Torus if spec.lattice() == Lattice::Fixed => Boundary::FixedTorus,
        Domain::Torus => Boundary::FreeTorus,
        Domain::Screw => Boundary::Screw,
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

/// What the parts of the energy are built from.
struct Builder<'a> {
    file: &'a SceneFile,
    sheet: &'a Sheet,
    tiling: &'a Tiling,
    /// Number of each edge of the cell.
    names: HashMap<EdgeKey, usize>,
    /// Drawn fold angle of every edge of the tiling; NaN where there is no hinge.
    angles: Vec<f64>,
}

impl<'a> Builder<'a> {
    fn new(file: &'a SceneFile, sheet: &'a Sheet, tiling: &'a Tiling, angles: Vec<f64>) -> Self {
        Self { file, sheet, tiling, names: names(sheet), angles }
    }

    fn terms(&self) -> Result<Terms, SceneError> {
        let energy = &self.file.scene.energy;
        let creases = match &energy.creases {
            Some(spec) => Some(Hinges { stiffness: spec.stiffness.0, rest: self.rest(spec.rest.as_ref())? }),
            None => None,
        };
        let stiffness = self.facet_stiffness();
        let has_facets = self.tiling.edges.iter().any(|edge| edge.kind == EdgeKind::Facet);
        let facets = has_facets.then(|| Hinges { stiffness, rest: self.angles.clone() });
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

    /// Left out, polygons are rigid.
    fn facet_stiffness(&self) -> f64 {
        self.file.scene.energy.facets.as_ref().map_or(f64::INFINITY, |spec| spec.stiffness.0)
    }

    /// Diagonals of the cell's polygons where these are rigid.
    fn rigid_facets(&self) -> Vec<usize> {
        let rigid = self.facet_stiffness().is_infinite();
        let edges = &self.sheet.edges;
        (0..edges.len()).filter(|&edge| rigid && edges[edge].kind == EdgeKind::Facet).collect()
    }

    /// Rest angle of every edge of the tiling.
    fn rest(&self, rest: Option<&Located<Rest>>) -> Result<Vec<f64>, SceneError> {
        let Some(rest) = rest else { return Ok(self.angles.clone()) };
        match &**rest {
            Rest::Drawn => Ok(self.angles.clone()),
            Rest::Flat => Ok(vec![0.0; self.angles.len()]),
            Rest::Angle(angle) => Ok(vec![*angle; self.angles.len()]),
            Rest::Mode(mode) => self.along_mode(mode),
            Rest::File(name) => {
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
        // soft facets fold as creases do; those without a row are left open
        self.table(&path, &read_rates(&path)?, &[EdgeKind::Crease, EdgeKind::Facet], name.rates.span())
    }

    /// Values of a table on the edges of the tiling: every hinge of the first of these kinds must have one, those of the
    /// others may.
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

    /// Number of an edge of the cell that is a hinge of one of these kinds.
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

    /// Loads must balance along every axis on which no vertex is pinned: otherwise there is no equilibrium.
    fn balance(&self, terms: &Terms) -> Result<(), SceneError> {
        let total: Vec3 = terms.loads.iter().map(|(_, force)| force).sum();
        let largest = terms.loads.iter().map(|(_, force)| force.amax()).fold(0.0, f64::max);
        for (axis, letter) in ["x", "y", "z"].iter().enumerate() {
            let pinned = terms.pins.iter().any(|(_, axes)| axes[axis]);
            if !pinned && total[axis].abs() > 1e-12 * largest {
                let span = self.file.scene.loads[0].force.span();
                let message = format!("the loads push the whole sheet along {letter} with a force of {}", total[axis]);
                let help = "balance the loads, or pin a vertex along that axis; a sheet with fewer than three pinned vertices \
                            still turns as a whole, until its loads pull straight";
                return Err(self.file.error_at(span, message, help));
            }
        }
        Ok(())
    }
}

fn name(key: EdgeKey) -> String {
    format!("[{}, {}, {}, {}]", key.i, key.j, key.shift[0], key.shift[1])
}

impl Built {
    /// Terms that are built, and what this scene made unnecessary, each with its reason.
    pub fn terms(&self) -> (Vec<String>, Vec<String>) {
        let terms = &self.terms;
        let kinds: HashSet<EdgeKind> = self.tiling.edges.iter().map(|edge| edge.kind).collect();
        let no_facets = if kinds.contains(&EdgeKind::Facet) { "" } else { "facets: every face is a triangle" };
        let table = [
            ("bars", terms.bars.is_some(), "bars: not in [energy]"),
            ("creases", terms.creases.is_some(), "creases: not in [energy]"),
            ("facets", terms.facets.is_some(), no_facets),
            ("locks", !terms.locks.is_empty(), "locks: none given"),
            ("pins", !terms.pins.is_empty(), "pins: none given"),
            ("loads", !terms.loads.is_empty(), "loads: none given"),
        ];
        let (there, missing): (Vec<_>, Vec<_>) = table.into_iter().partition(|(_, there, _)| *there);
        let terms = there.into_iter().map(|(term, ..)| term.to_owned()).collect();
        (terms, missing.into_iter().map(|(_, _, why)| why.to_owned()).collect())
    }
}

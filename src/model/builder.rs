//! The builder of assemblies: sets their terms, and names edges and vertices as the sheet does.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::boundary::Boundary;
use super::domain::OwnDomain;
use super::law::{Laws, TermLaw};
use super::mass::Mass;
use super::material::Material;
use super::roll::Roll;
use super::stiffness::Stiffness;
use super::terms::{Bars, Hinges, Part, RIGID, RestLengths, Terms};
use crate::math::Vec3;
use crate::sheet::{EdgeKey, EdgeKind, Sheet};

/// The rest angles of the creases, or of the facets, in radians.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Rest {
    /// The drawn fold angles.
    #[default]
    Drawn,
    /// Zero for every hinge.
    Flat,
    /// The same angle for every hinge.
    Angle(f64),
    /// This part of the angles of the sheet folded flat by its letters: -pi for mountains, pi for valleys, 0 for
    /// others.
    Assigned(f64),
    /// This part of the target angles of the file; the drawn angle where it gives none.
    Target(f64),
    /// One angle for each edge of the tiling, in the tiling's order; only those of hinges of this kind are used.
    PerEdge(Vec<f64>),
}

impl Assembly {
    /// Begins a patch with free edges: `cells[0] x cells[1]` cells of a sheet with lattice, or a whole finite sheet.
    pub fn patch(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::Patch)
    }

    /// Begins a torus of `cells[0] x cells[1]` cells with free lattice vectors.
    pub fn torus(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::FreeTorus)
    }

    /// Begins a torus of `cells[0] x cells[1]` cells with the lattice vectors held as drawn.
    pub fn fixed_torus(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::FixedTorus)
    }

    /// Begins one cell repeated by two screw motions about a common axis, a cylinder of any curvature; pictures show
    /// `cells[0] x cells[1]` copies of it.
    pub fn screw(sheet: Sheet, cells: [usize; 2]) -> Builder {
        Builder::new(sheet, cells, Boundary::Screw)
    }

    /// Begins a tube from the state to which a sheet was [rolled up](crate::rolled_up); pictures show `cells[0]` of its
    /// strands and `cells[1]` rows of cells.
    pub fn tube(sheet: Sheet, roll: Roll, cells: [usize; 2]) -> Builder {
        Builder { sheet, cells, place: CellPlacement::Rolled(Box::new(roll)), given: Given::default() }
    }

    /// Begins one cell on a domain of one's own, from the state with these coordinates: x, y and z of every vertex of
    /// the cell, then the shared ones; pictures show `cells[0] x cells[1]` copies of it. See
    /// [`CellMaps`](super::CellMaps).
    pub fn own(sheet: Sheet, domain: OwnDomain, coordinates: Vec<f64>, cells: [usize; 2]) -> Builder {
        Builder { sheet, cells, place: CellPlacement::Own(domain, coordinates), given: Given::default() }
    }
}

/// A vertex of a cell, and that cell.
type NamedVertex = (usize, [usize; 2]);

/// An assembly under construction; [`Assembly::patch`] and the similar functions begin one and [`Builder::build`]
/// ends it.
#[derive(Clone, Debug)]
#[must_use]
pub struct Builder {
    sheet: Sheet,
    cells: [usize; 2],
    place: CellPlacement,
    given: Given,
}

/// Where the cell is drawn.
#[derive(Clone, Debug)]
enum CellPlacement {
    /// As in the file, with these boundary conditions.
    File(Boundary),
    /// Rolled up to a tube.
    Rolled(Box<Roll>),
    /// On a domain of one's own, with these coordinates.
    Own(OwnDomain, Vec<f64>),
}

/// The settings of a builder, by the names of vertices and edges of the sheet.
#[derive(Clone, Debug, Default)]
struct Given {
    bars: Option<Stiffness>,
    lengths: Option<RestLengths>,
    creases: Option<Stiffness>,
    rest: Option<Rest>,
    facets: Option<Stiffness>,
    facet_rest: Rest,
    material: Option<Material>,
    locks: Vec<(EdgeKey, Option<f64>)>,
    pins: Vec<(NamedVertex, [bool; 3])>,
    loads: Vec<(NamedVertex, Vec3)>,
    gravity: Option<Vec3>,
    guides: Vec<(NamedVertex, Vec3)>,
    parts: Vec<(Vec<NamedVertex>, [bool; 6])>,
    mass: Option<Mass>,
    laws: Laws,
}

impl Builder {
    pub(super) fn new(sheet: Sheet, cells: [usize; 2], boundary: Boundary) -> Self {
        Self { sheet, cells, place: CellPlacement::File(boundary), given: Given::default() }
    }

    /// Gives every edge a bar of stiffness `EA`, in force per strain; [`RIGID`] keeps its length exactly. The stiffness
    /// is one number, or a list with one for each edge of the tiling.
    pub fn bars(mut self, stiffness: impl Into<Stiffness>) -> Self {
        self.given.bars = Some(stiffness.into());
        self
    }

    /// Sets the rest lengths of the bars. Without this call they are the drawn lengths.
    pub fn rest_lengths(mut self, lengths: RestLengths) -> Self {
        self.given.lengths = Some(lengths);
        self
    }

    /// Gives every crease this stiffness, in torque per radian and length: one number, or a list with one for each edge
    /// of the tiling, of which only those of creases are used.
    pub fn creases(mut self, stiffness: impl Into<Stiffness>) -> Self {
        self.given.creases = Some(stiffness.into());
        self
    }

    /// Gives the diagonals of polygons this stiffness, in torque per radian and length: one number, or a list with one
    /// for each edge of the tiling, of which only those of diagonals are used. Without this call polygons are rigid.
    pub fn facets(mut self, stiffness: impl Into<Stiffness>) -> Self {
        self.given.facets = Some(stiffness.into());
        self
    }

    /// Sets the rest angles of the diagonals of polygons. Without this call they are the drawn angles.
    pub fn facet_rest(mut self, rest: Rest) -> Self {
        self.given.facet_rest = rest;
        self
    }

    /// Sets the rest angles of the creases. Without this call they are the drawn angles.
    pub fn rest(mut self, rest: Rest) -> Self {
        self.given.rest = Some(rest);
        self
    }

    /// Gives bars, creases and facets the stiffness of an elastic sheet, unless another one is given.
    pub fn material(mut self, material: Material) -> Self {
        self.given.material = Some(material);
        self
    }

    /// Locks a crease of the cell, in all its copies, at a fold angle in radians; `None` locks it at the drawn angle,
    /// or that of the closed tube.
    pub fn lock(mut self, crease: EdgeKey, angle: Option<f64>) -> Self {
        self.given.locks.push((crease, angle));
        self
    }

    /// Pins a vertex of a cell: its coordinates along the axes (x, y, z) that are true keep their drawn values.
    pub fn pin(mut self, vertex: usize, cell: [usize; 2], axes: [bool; 3]) -> Self {
        self.given.pins.push(((vertex, cell), axes));
        self
    }

    /// Lets a vertex of a cell move only across a direction: its coordinate along it keeps its drawn value, as that of
    /// a roller on an inclined plane, or of a vertex in a plane of symmetry.
    pub fn guide(mut self, vertex: usize, cell: [usize; 2], normal: [f64; 3]) -> Self {
        self.given.guides.push(((vertex, cell), Vec3::from(normal).normalize()));
        self
    }

    /// Makes vertices, each of a cell, one rigid body, which keeps free what is true: displacements along x, y, z and
    /// rotations about x, y, z through the centroid of its vertices. See [`Part`].
    pub fn part(mut self, vertices: impl IntoIterator<Item = (usize, [usize; 2])>, free: [bool; 6]) -> Self {
        self.given.parts.push((vertices.into_iter().collect(), free));
        self
    }

    /// Applies a force (x, y, z) to a vertex of a cell.
    pub fn load(mut self, vertex: usize, cell: [usize; 2], force: [f64; 3]) -> Self {
        self.given.loads.push(((vertex, cell), Vec3::from(force)));
        self
    }

    /// Lets the mass of the sheet weigh: `gravity` is the acceleration (x, y, z).
    pub fn weight(mut self, gravity: [f64; 3]) -> Self {
        self.given.gravity = Some(Vec3::from(gravity));
        self
    }

    /// Gives the sheet a mass, from which frequencies follow; it weighs nothing without [`Builder::weight`].
    pub fn mass(mut self, mass: Mass) -> Self {
        self.given.mass = Some(mass);
        self
    }

    /// Gives the bars that are not rigid a law other than that of a spring, or a list of laws, one for each edge of the
    /// tiling; their stiffness is that at rest.
    pub fn bar_law(mut self, law: impl Into<TermLaw>) -> Self {
        self.given.laws.bars = Some(law.into());
        self
    }

    /// Gives the creases that are not rigid a law, as [`Builder::bar_law`] does.
    pub fn crease_law(mut self, law: impl Into<TermLaw>) -> Self {
        self.given.laws.creases = Some(law.into());
        self
    }

    /// Gives the diagonals of polygons that are not rigid a law, as [`Builder::bar_law`] does.
    pub fn facet_law(mut self, law: impl Into<TermLaw>) -> Self {
        self.given.laws.facets = Some(law.into());
        self
    }

    /// Builds the assembly.
    ///
    /// # Errors
    /// [`AssemblyError`] if the sheet cannot have these boundary conditions, a stiffness, a rest length or the mass is
    /// not a positive number, a law lets rigid elements be slack, rest values are given without a stiffness or weight
    /// without mass, the length of a list does not match the tiling, a crease or a vertex does not exist in it, or loads do not balance along an axis
    /// without pins.
    pub fn build(self) -> Result<Assembly, AssemblyError> {
        let Self { sheet, cells, place, mut given } = self;
        let bare = match place {
            CellPlacement::File(boundary) => Assembly::without_terms(sheet, cells, boundary)?,
            CellPlacement::Rolled(roll) => Assembly::tube_without_terms(sheet, &roll, cells)?,
            CellPlacement::Own(domain, coordinates) => {
                Assembly::own_without_terms(sheet, (domain, coordinates), cells)?
            }
        };
        if let Some(material) = given.material {
            given.bars = given.bars.or_else(|| Some(material.bars(&bare)));
            given.creases = given.creases.or_else(|| material.creases());
            given.facets = given.facets.or_else(|| Some(material.facets(&bare)));
        }
        let creases = match (given.creases, given.rest) {
            (None, Some(_)) => return Err(AssemblyError::RestWithoutCreases),
            (None, None) => None,
            (Some(stiffness), rest) => Some((stiffness, rest.unwrap_or_default())),
        };
        let creases = creases.map(|given| hinges(&bare, ("creases", EdgeKind::Crease), given)).transpose()?;
        let facets = (given.facets.unwrap_or(RIGID.into()), given.facet_rest);
        let facets = hinges(&bare, ("facets", EdgeKind::Facet), facets)?;
        let facets = bare.tiling().facets().next().map(|_| facets);
        let bars = with_lengths(&bare, given.bars, given.lengths)?;
        let mass = given.mass;
        if let Some(mass) = mass.map(Mass::amount).filter(|mass| !(*mass > 0.0 && mass.is_finite())) {
            return Err(AssemblyError::Mass { mass });
        }
        let mut terms =
            Terms { bars, creases, facets, mass, laws: given.laws.for_edges(bare.edges())?, ..Terms::default() };
        terms.check_laws()?;
        for (crease, angle) in given.locks {
            let hinges = bare.sheet().hinges_round(crease);
            if angle.is_some() && hinges > 1 {
                return Err(AssemblyError::SeveralHinges { key: crease, hinges });
            }
            let locked = copies(&bare, crease)?.into_iter().map(|k| (k, angle.unwrap_or(bare.start_angles()[k])));
            terms.locks.extend(locked);
        }
        terms.pins = on_vertices(&bare, given.pins)?;
        terms.guides = on_vertices(&bare, given.guides)?;
        terms.loads = on_vertices(&bare, given.loads)?;
        if let Some(gravity) = given.gravity {
            let mass = mass.ok_or(AssemblyError::WeightWithoutMass)?;
            let weights = mass.of_tiling(bare.drawn(), bare.tiling()).into_iter().map(|mass| gravity * mass);
            terms.loads.extend(weights.enumerate());
        }
        for (vertices, free) in given.parts {
            let numbers = vertices.into_iter().map(|vertex| numbered(&bare, vertex));
            terms.parts.push(Part { vertices: numbers.collect::<Result<_, _>>()?, free });
        }
        let assembly = bare.with_terms(terms);
        assembly.check_balance(&[])?;
        Ok(assembly.with_best_axis())
    }
}

/// Returns the bars; `None` if no stiffness is given.
fn with_lengths(
    assembly: &Assembly,
    stiffness: Option<Stiffness>,
    lengths: Option<RestLengths>,
) -> Result<Option<Bars>, AssemblyError> {
    let (stiffness, rest) = match (stiffness, lengths) {
        (None, Some(_)) => return Err(AssemblyError::RestWithoutBars),
        (None, None) => return Ok(None),
        (Some(stiffness), lengths) => (stiffness, lengths.unwrap_or_default()),
    };
    check(assembly, "bars", &stiffness, |_| true)?;
    let bad = |length: &f64| !(*length > 0.0 && length.is_finite());
    let wrong = match &rest {
        RestLengths::PerEdge(each) if each.len() != assembly.edges() => {
            let edges = assembly.edges();
            return Err(AssemblyError::Count { what: "rest lengths", given: each.len(), edges });
        }
        RestLengths::PerEdge(each) => each.iter().copied().find(bad),
        RestLengths::Factor(factor) => Some(*factor).filter(bad),
        RestLengths::Drawn => None,
    };
    wrong.map_or(Ok(Some(Bars { stiffness, rest })), |length| Err(AssemblyError::RestLength { length }))
}

/// Returns the hinges of a kind.
fn hinges(
    assembly: &Assembly,
    (term, kind): (&'static str, EdgeKind),
    (stiffness, rest): (Stiffness, Rest),
) -> Result<Hinges, AssemblyError> {
    check(assembly, term, &stiffness, |edge| assembly.tiling().edges[edge].kind == kind)?;
    Ok(Hinges { stiffness, rest: angles(assembly, rest)? })
}

/// Checks that the stiffness of every element is a positive number.
fn check(
    assembly: &Assembly,
    term: &'static str,
    stiffness: &Stiffness,
    is_element: impl Fn(usize) -> bool,
) -> Result<(), AssemblyError> {
    let edges = assembly.edges();
    let bad = |stiffness: &f64| !(*stiffness > 0.0);
    let wrong = match stiffness {
        Stiffness::PerEdge(each) if each.len() != edges => {
            return Err(AssemblyError::Count { what: "stiffnesses", given: each.len(), edges });
        }
        Stiffness::PerEdge(each) => (0..edges).filter(|&edge| is_element(edge)).map(|edge| each[edge]).find(bad),
        Stiffness::Uniform(stiffness) => Some(*stiffness).filter(bad),
    };
    wrong.map_or(Ok(()), |stiffness| Err(AssemblyError::Stiffness { term, stiffness }))
}

/// Returns the rest angles, one for each edge of the tiling.
fn angles(assembly: &Assembly, rest: Rest) -> Result<Vec<f64>, AssemblyError> {
    let edges = assembly.edges();
    match rest {
        Rest::Drawn => Ok(assembly.drawn_angles().to_vec()),
        Rest::Flat => Ok(vec![0.0; edges]),
        Rest::Angle(angle) => Ok(vec![angle; edges]),
        Rest::Assigned(part) => Ok(assembly.assigned_angles().into_iter().map(|angle| part * angle).collect()),
        Rest::Target(part) => Ok(assembly.target_angles(part)),
        Rest::PerEdge(angles) if angles.len() == edges => Ok(angles),
        Rest::PerEdge(angles) => Err(AssemblyError::Count { what: "rest angles", given: angles.len(), edges }),
    }
}

/// Returns the numbers of the tiling's edges that are copies of this crease and have a hinge.
fn copies(assembly: &Assembly, crease: EdgeKey) -> Result<Vec<usize>, AssemblyError> {
    let (sheet, tiling, angles) = (assembly.sheet(), assembly.tiling(), assembly.drawn_angles());
    let name = sheet.edges[sheet.crease(crease).ok_or(AssemblyError::NoCrease { key: crease })?].key;
    let is_copy = |k: &usize| sheet.edges[tiling.edges[*k].edge].key.whole() == name && !angles[*k].is_nan();
    let found: Vec<usize> = (0..tiling.edges.len()).filter(is_copy).collect();
    if found.is_empty() { Err(AssemblyError::NoCopy { key: crease, cells: tiling.cells }) } else { Ok(found) }
}

/// Returns what is given on vertices of cells, on the vertices of the tiling.
fn on_vertices<T>(assembly: &Assembly, given: Vec<(NamedVertex, T)>) -> Result<Vec<(usize, T)>, AssemblyError> {
    given.into_iter().map(|(vertex, what)| Ok((numbered(assembly, vertex)?, what))).collect()
}

/// Returns the number that a cell's vertex has in the tiling.
fn numbered(assembly: &Assembly, (vertex, cell): NamedVertex) -> Result<usize, AssemblyError> {
    let (count, cells) = (assembly.sheet().vertices.len(), assembly.tiling().cells);
    let there = vertex < count && cell[0] < cells[0] && cell[1] < cells[1];
    if there {
        Ok((cell[1] * cells[0] + cell[0]) * count + vertex)
    } else {
        Err(AssemblyError::NoVertex { vertex, cell })
    }
}

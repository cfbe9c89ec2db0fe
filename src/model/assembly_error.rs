//! The errors of building an assembly.

use crate::sheet::EdgeKey;
use thiserror::Error;

/// The reason why an assembly cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum AssemblyError {
    #[error("the sheet has no lattice: it can only be a patch")]
    NoLattice,
    #[error("{given} coordinates were given: the vertices and the domain have {needed}")]
    Coordinates { given: usize, needed: usize },
    #[error("the sheet is drawn as a tube: it is a tube or a patch")]
    DrawnAsTube,
    #[error("there is at least one cell along each lattice vector")]
    NoCells,
    #[error("the stiffness of the {term} is {stiffness}, not a positive number")]
    Stiffness { term: &'static str, stiffness: f64 },
    #[error("the law of the {term} has no force on one side of rest, where what is rigid would be slack")]
    RigidSlack { term: &'static str },
    #[error("the mass is {mass}, not a positive number")]
    Mass { mass: f64 },
    #[error("rest angles are those of creases: give these a stiffness")]
    RestWithoutCreases,
    /// Rest lengths were given, but no stiffness of the bars.
    #[error("rest lengths are those of bars: give these a stiffness")]
    RestWithoutBars,
    /// A rest length, or the factor of all rest lengths, is not a positive finite number.
    #[error("a rest length, or the factor of all, is {length}, not a positive number")]
    RestLength {
        /// The length or the factor.
        length: f64,
    },
    #[error("{given} {what} were given for {edges} edges of the tiling")]
    Count { what: &'static str, given: usize, edges: usize },
    #[error("the sheet has no crease {key}")]
    NoCrease { key: EdgeKey },
    #[error("the crease {key} has {hinges} hinges: a lock without an angle keeps all of them")]
    SeveralHinges { key: EdgeKey, hinges: usize },
    #[error("no copy of the crease {key} folds in a patch of {} x {} cells", cells[0], cells[1])]
    NoCopy { key: EdgeKey, cells: [usize; 2] },
    #[error("there is no vertex {vertex} of cell {cell:?}")]
    NoVertex {
        vertex: usize,
        /// The cell, counted along the two lattice vectors.
        cell: [usize; 2],
    },
    #[error("the sheet has weight and no mass")]
    WeightWithoutMass,
    #[error(
        "faces are under pressure and enclose no volume: at the side between vertices {} and {} they do not close",
        vertices[0],
        vertices[1]
    )]
    Open { vertices: [usize; 2] },
    #[error(
        "what turns with the part has no potential: it has to turn about {} and about no other axis",
        ["x", "y", "z"][*axis]
    )]
    Turning { part: usize, axis: usize },
    #[error("nothing holds the sheet, which a torque would turn for ever")]
    Loose,
    #[error("only faces of a patch have a pressure")]
    NoPatch,
    #[error(
        "the loads push {} along {} with a force of {force}",
        piece.map_or("the whole sheet".to_owned(), |vertex| format!("the piece of the sheet with vertex {vertex}")),
        ["x", "y", "z"][*axis]
    )]
    Unbalanced { piece: Option<usize>, axis: usize, force: f64 },
    #[error(
        "the energy of the term `{term}` changes where the sheet {} as a whole, and nothing holds the sheet there",
        ["moves along x", "moves along y", "moves along z", "turns about x", "turns about y", "turns about z"][*motion]
    )]
    Moving { term: String, motion: usize },
}

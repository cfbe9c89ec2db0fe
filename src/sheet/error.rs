//! The errors of a mesh: what is wrong, where, and what would be right.

use super::assignment::Assignment;
use super::pattern_fault::PatternFault;
use std::fmt;
use std::path::PathBuf;

/// An edge of a drawn mesh, named by the numbers that the file gives to its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnEdge(pub usize, pub usize);

impl fmt::Display for DrawnEdge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", self.0, self.1)
    }
}

/// The reason why a file gives no sheet.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum SheetError {
    #[error("{}: {source}", path.display())]
    Read { path: PathBuf, source: std::io::Error },
    #[error("{name}:{line}:{column}: {problem}")]
    Bad {
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        problem: Box<MeshProblem>,
    },
}

impl SheetError {
    /// Makes the error of a file that has this problem in a line and column.
    pub(crate) fn bad(name: &str, [line, column]: [usize; 2], problem: impl Into<Box<MeshProblem>>) -> Self {
        Self::Bad { name: name.to_owned(), line, column, problem: problem.into() }
    }
}

/// The part of a drawn mesh to which a [`Defect`] refers, numbered from 0 whatever the file does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeshPart {
    /// The mesh as a whole.
    Mesh,
    /// A drawn vertex.
    Vertex(usize),
    /// A drawn face.
    Face(usize),
    /// An entry of the list of edges.
    Edge(usize),
    /// An entry of the list of fold angles.
    FoldAngle(usize),
    /// The lattice vectors.
    Lattice,
    /// A listed opening.
    Hole(usize),
}

/// A [`MeshProblem`] together with the part of the mesh that has it.
#[derive(Debug, thiserror::Error)]
#[error("{problem}")]
pub struct Defect {
    /// The part of the mesh.
    pub place: MeshPart,
    /// The problem of that part.
    pub problem: Box<MeshProblem>,
}

impl Defect {
    /// Makes the defect of `place` that has this problem.
    pub(crate) fn new(place: MeshPart, problem: MeshProblem) -> Self {
        Self { place, problem: Box::new(problem) }
    }
}

/// A problem of a mesh; the message says what would be right. Vertices and faces carry the file's own numbers.
#[derive(Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum MeshProblem {
    #[error("not a FOLD file: {message}; a FOLD file is one JSON object")]
    Syntax { message: String },
    #[error("`{key}` is missing; {right}")]
    Missing { key: &'static str, right: &'static str },
    #[error("{what} is `{found}`; it should be {right}")]
    Type { what: String, found: String, right: &'static str },
    /// Two lists that belong together differ in length.
    #[error("`{key}` has {found} entries; it should have {right}, one per entry of `edges_vertices`")]
    Length { key: &'static str, found: usize, right: usize },
    #[error("{what} names vertex {found}; {}", numbering(*first, *last))]
    Index { what: String, found: String, first: usize, last: usize },
    #[error("the mesh has no {what}; a sheet needs at least one face of three vertices")]
    Empty { what: &'static str },
    /// The mesh does not fit the memory: its number of vertices, the GB that they need, and those that there are.
    #[error("the mesh has {0} vertices, which need at least {1:.1} GB; there is room for {2:.1} GB")]
    TooLarge(usize, f64, f64),
    #[error(
        "vertex {vertex} has {found} coordinates where the vertices before it have {right}; all should have 2, or all 3"
    )]
    Dimension { vertex: usize, found: usize, right: usize },
    #[error("vertex {vertex} has the coordinate {value:e}; coordinates should be finite and at most 1e50 in magnitude")]
    Coordinate { vertex: usize, value: f64 },
    #[error(
        "the lattice vectors span an area of {area:e} with lengths {lengths:?}; they should be finite, between 1e-50 \
         and 1e50 long, and neither parallel nor so skew \
         that the area is under 1e-6 of the product of the lengths"
    )]
    Lattice {
        area: f64,
        /// The two lengths.
        lengths: [f64; 2],
    },
    #[error(
        "vertex {vertex} stands where vertex {other} stands; a place should have one vertex, except where different faces of \
         a finite sheet touch that are all listed"
    )]
    DuplicateVertex { vertex: usize, other: usize },
    #[error("vertex {vertex} is a copy of vertex {other} in cell ({n1:e}, {n2:e}); copies should be within 1e6 cells")]
    FarAway { vertex: usize, other: usize, n1: f64, n2: f64 },
    #[error("vertex {vertex} belongs to no face; remove it, or add its faces")]
    UnusedVertex { vertex: usize },
    #[error("vertex {vertex} joins separate fans of faces; give each fan its own vertex")]
    NonManifoldVertex { vertex: usize },
    #[error("face {face} has {corners} corners; it should have at least 3")]
    FewCorners { face: usize, corners: usize },
    #[error("face {face} names vertex {vertex} twice; every corner should be another vertex")]
    RepeatedVertex { face: usize, vertex: usize },
    #[error("face {face} is face {other} again{}; every face of the cell should be drawn once", translated(*cell))]
    DuplicateFace { face: usize, other: usize, cell: [i32; 2] },
    #[error(
        "face {face} has a triangle {triangle:?} of area {area:e} with a side of {longest:e}; the area should be over 1e-12 \
         of the side squared"
    )]
    ZeroArea { face: usize, triangle: [usize; 3], area: f64, longest: f64 },
    #[error(
        "face {face} crosses itself or has no area, so it cannot be split into triangles; its outline should be simple"
    )]
    NotSimple { face: usize },
    #[error("face {face} would be split along {edge}, which is an edge already; draw its triangles instead")]
    DiagonalIsEdge { face: usize, edge: DrawnEdge },
    #[error("edges of more than two faces, or of none, have no two sides along which a solid could lie")]
    NoSurface,
    #[error(
        "faces {faces:?} run along edge {edge} in the same direction; all faces should be counter-clockwise from one \
         side"
    )]
    Orientation { edge: DrawnEdge, faces: [usize; 2] },
    #[error(
        "edge {edge} has only face {face}; with `foldwell:lattice` every edge should have two faces (is its copy missing \
         or out of place?), or be on a rim listed in `foldwell:holes`"
    )]
    Unmatched { edge: DrawnEdge, face: usize },
    #[error(
        "opening {hole} passes along {edge}, which is an edge of {faces} faces; its sides should be edges of one face"
    )]
    HoleSide { hole: usize, edge: DrawnEdge, faces: usize },
    #[error("opening {hole} has {corners} corners; it should go round, with at least 3")]
    SmallHole { hole: usize, corners: usize },
    #[error("`foldwell:holes` without `foldwell:lattice`; a finite sheet needs no list of its openings")]
    HolesWithoutLattice,
    #[error("edge {edge} of the list runs from vertex {vertex} to itself; it should join two vertices")]
    Loop { edge: usize, vertex: usize },
    #[error("edge {edge} of the list is edge {other} again, {ends}; every edge should be listed once")]
    DuplicateEdge { edge: usize, other: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, is a side of no face; every edge should bound a face, and the outline of the \
         sheet be listed too; bars without faces, as of a truss, are read where `faces_vertices` is given, if only as []"
    )]
    LooseEdge { edge: usize, ends: DrawnEdge },
    #[error("edges {a} and {b} cross or touch in the plane; edges should meet at common vertices only")]
    Crossing { a: DrawnEdge, b: DrawnEdge },
    #[error(
        "edge {0} has no length seen along z; give `faces_vertices`, which cannot be rebuilt for it, or [] for a truss of bars"
    )]
    Upright(DrawnEdge),
    #[error(
        "edge {edge} of the list, {ends}, belongs to edges inside a face that are not joined to the others; give \
         `faces_vertices`, which cannot be rebuilt for them, or join them by edges that do not fold, J"
    )]
    Nested { edge: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, is assigned B, a boundary, but it lies between two faces; assign C to cut the \
         sheet there, M, V, F or U to a crease, or take away the face that is a hole"
    )]
    BoundaryInside { edge: usize, ends: DrawnEdge },
    #[error("edge {edge} of the list, {ends}, is assigned J, which joins two faces, but it has only one; assign B")]
    JoinAtRim { edge: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, is assigned {letter}, but the vertices draw a fold angle of {drawn} degrees \
         (valley positive, seen from the side of the face normals); assign the other letter, or turn all faces over"
    )]
    OtherSide {
        edge: usize,
        ends: DrawnEdge,
        letter: Assignment,
        /// Fold angle that the vertices draw, in degrees.
        drawn: f64,
    },
    #[error(
        "`foldwell:glue` has {found} word(s) for edge {edge} of {faces} face(s); it is for edges of three or more faces, \
         and has one word, or one for each face"
    )]
    Glue { edge: DrawnEdge, faces: usize, found: usize },
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but the sheet stays joined at both of its ends, so that this cut \
         cannot open; let cuts of two edges or more meet, or reach the rim"
    )]
    ClosedCut { edge: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but a periodic sheet cannot be cut along an edge; draw the cut \
         as an opening, with vertices of its own on both sides, and list it in `foldwell:holes`"
    )]
    PeriodicCut { edge: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, has {given} in `{key}`, and another copy of it in the drawing has {before}; \
         give both the same, or one of them null"
    )]
    StiffnessOfCopies { key: &'static str, edge: usize, ends: DrawnEdge, given: f64, before: f64 },
    #[error("there is no frame {frame}; {}", frames(*last))]
    NoFrame { frame: usize, last: usize },
    #[error("`frame_parent` of frame {frame} is {parent}; {}", frames(*last))]
    NoParent { frame: usize, parent: usize, last: usize },
    #[error("frame {frame} inherits from itself by way of `frame_parent`; parents should lead to frame 0")]
    FrameCycle { frame: usize },
    #[error(
        "edge {edge} of the list, {ends}, has the fold angle {given} degrees; a target angle should be between -180 and \
         180 degrees, valley positive"
    )]
    AngleRange {
        edge: usize,
        ends: DrawnEdge,
        /// The fold angle, in degrees.
        given: f64,
    },
    #[error(
        "edge {edge} of the list, {ends}, is assigned {letter} and has the fold angle {given} degrees; mountains have \
         negative angles and valleys positive ones: change the sign or the letter"
    )]
    AngleOtherSide {
        edge: usize,
        ends: DrawnEdge,
        letter: Assignment,
        /// The fold angle, in degrees.
        given: f64,
    },
    #[error(
        "edge {edge} of the list, {ends}, has the fold angle {given} degrees, and another copy of it in the drawing has \
         {before} degrees; give both the same, or one of them null"
    )]
    AngleOfCopies {
        edge: usize,
        ends: DrawnEdge,
        /// Fold angle of this copy, in degrees.
        given: f64,
        /// Fold angle of the copy that is listed before, in degrees.
        before: f64,
    },
    #[error(transparent)]
    Pattern(#[from] PatternFault),
}

fn numbering(first: usize, last: usize) -> String {
    if last < first {
        "no vertices stand before it".to_owned()
    } else {
        format!("vertices are numbered {first} to {last}")
    }
}

fn frames(last: usize) -> String {
    if last == 0 {
        "the file has frame 0 only".to_owned()
    } else {
        format!("frames are 0, the top of the file, and 1 to {last}, those of `file_frames`")
    }
}

fn translated(cell: [i32; 2]) -> String {
    if cell == [0, 0] { String::new() } else { format!(", {} and {} cells further", cell[0], cell[1]) }
}

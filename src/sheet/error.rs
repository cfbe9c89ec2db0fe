//! The errors of a mesh: what is wrong, where, and what would be right.

use super::assignment_fault::AssignmentFault;
pub use super::drawn_edge::DrawnEdge;
use super::fold_angle_fault::FoldAngleFault;
use super::frame_fault::FrameFault;
use super::pattern_fault::PatternFault;
use super::plane_fault::PlaneFault;
use std::path::PathBuf;

/// The reason why a file gives no sheet.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// The file cannot be read at all.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: std::io::Error,
    },
    /// The file can be read, but is not the mesh of a sheet.
    #[error("{name}:{line}:{column}: {problem}")]
    Bad {
        /// Name of the file.
        name: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// What is wrong.
        problem: Box<Problem>,
    },
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

/// A [`Problem`] together with the part of the mesh that has it.
#[derive(Debug, thiserror::Error)]
#[error("{problem}")]
pub struct Defect {
    /// The part of the mesh.
    pub place: MeshPart,
    /// The problem of that part.
    pub problem: Box<Problem>,
}

impl Defect {
    /// Makes the defect of `place` that has this problem.
    pub(crate) fn new(place: MeshPart, problem: Problem) -> Self {
        Self { place, problem: Box::new(problem) }
    }
}

/// A problem of a mesh; the message says what would be right. Vertices and faces carry the file's own numbers.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// The text is not JSON, or has a key twice.
    #[error("not a FOLD file: {message}; a FOLD file is one JSON object")]
    Syntax {
        /// The parser's message.
        message: String,
    },
    /// A required key is missing.
    #[error("`{key}` is missing; {right}")]
    Missing {
        /// The key.
        key: &'static str,
        /// Value that the key should have.
        right: &'static str,
    },
    /// A value has another type than it should have.
    #[error("{what} is `{found}`; it should be {right}")]
    Type {
        /// Name of the value.
        what: String,
        /// Its text, shortened.
        found: String,
        /// Type that it should have.
        right: &'static str,
    },
    /// Two lists that belong together differ in length.
    #[error("`{key}` has {found} entries; it should have {right}, one per entry of `edges_vertices`")]
    Length {
        /// Name of the key.
        key: &'static str,
        /// Number of its entries.
        found: usize,
        /// Number of entries of the other list.
        right: usize,
    },
    /// A line of an OBJ file cannot be read.
    #[error("`{found}` is no {what}; it should be {right}")]
    ObjLine {
        /// The word that cannot be read.
        found: String,
        /// Kind of value that it should be.
        what: &'static str,
        /// An example.
        right: &'static str,
    },
    /// A vertex number is outside the range of the file's vertices.
    #[error("{what} names vertex {found}; {}", numbering(*first, *last))]
    Index {
        /// Name of the face, edge or opening that has the number.
        what: String,
        /// The number, as it is in the file.
        found: String,
        /// Number of the first vertex.
        first: usize,
        /// Number of the last vertex.
        last: usize,
    },
    /// The mesh has no vertices or no faces.
    #[error("the mesh has no {what}; a sheet needs at least one face of three vertices")]
    Empty {
        /// The word `vertices` or `faces`.
        what: &'static str,
    },
    /// The mesh does not fit the memory: its number of vertices, the GB that they need, and those that there are.
    #[error("the mesh has {0} vertices, which need at least {1:.1} GB; there is room for {2:.1} GB")]
    TooLarge(usize, f64, f64),
    /// Some vertices have two coordinates and others three.
    #[error(
        "vertex {vertex} has {found} coordinates where the vertices before it have {right}; all should have 2, or all 3"
    )]
    Dimension {
        /// The vertex.
        vertex: usize,
        /// Number of its coordinates.
        found: usize,
        /// Number of coordinates of vertex 0.
        right: usize,
    },
    /// A coordinate is not finite or larger than 1e50.
    #[error("vertex {vertex} has the coordinate {value:e}; coordinates should be finite and at most 1e50 in magnitude")]
    Coordinate {
        /// The vertex.
        vertex: usize,
        /// The coordinate.
        value: f64,
    },
    /// The lattice vectors do not span a cell.
    #[error(
        "the lattice vectors span an area of {area:e} with lengths {lengths:?}; they should be finite, between 1e-50 \
         and 1e50 long, and neither parallel nor so skew \
         that the area is under 1e-6 of the product of the lengths"
    )]
    Lattice {
        /// Area of the parallelogram.
        area: f64,
        /// The two lengths.
        lengths: [f64; 2],
    },
    /// Two drawn vertices have the same position.
    #[error(
        "vertex {vertex} stands where vertex {other} stands; a place should have one vertex, except where different faces of \
         a finite sheet touch that are all listed"
    )]
    DuplicateVertex {
        /// The later one.
        vertex: usize,
        /// The earlier one.
        other: usize,
    },
    /// A copy of a vertex is more than a million cells away from it.
    #[error("vertex {vertex} is a copy of vertex {other} in cell ({n1:e}, {n2:e}); copies should be within 1e6 cells")]
    FarAway {
        /// The vertex.
        vertex: usize,
        /// The vertex of which it is a copy.
        other: usize,
        /// First number of the cell.
        n1: f64,
        /// Second number of the cell.
        n2: f64,
    },
    /// A vertex belongs to no face.
    #[error("vertex {vertex} belongs to no face; remove it, or add its faces")]
    UnusedVertex {
        /// The vertex.
        vertex: usize,
    },
    /// The faces around a vertex form more than one fan.
    #[error("vertex {vertex} joins separate fans of faces; give each fan its own vertex")]
    NonManifoldVertex {
        /// The vertex.
        vertex: usize,
    },
    /// A face has less than three corners.
    #[error("face {face} has {corners} corners; it should have at least 3")]
    FewCorners {
        /// The face.
        face: usize,
        /// Number of its corners.
        corners: usize,
    },
    /// A face passes twice through a vertex.
    #[error("face {face} names vertex {vertex} twice; every corner should be another vertex")]
    RepeatedVertex {
        /// The face.
        face: usize,
        /// The vertex.
        vertex: usize,
    },
    /// A face is drawn twice, perhaps as a copy in another cell.
    #[error("face {face} is face {other} again{}; every face of the cell should be drawn once", translated(*cell))]
    DuplicateFace {
        /// The later one.
        face: usize,
        /// The earlier one.
        other: usize,
        /// Translation in cells of the later face from the earlier one.
        cell: [i32; 2],
    },
    /// A face has a triangle without area.
    #[error(
        "face {face} has a triangle {triangle:?} of area {area:e} with a side of {longest:e}; the area should be over 1e-12 \
         of the side squared"
    )]
    ZeroArea {
        /// The face.
        face: usize,
        /// The triangle without area.
        triangle: [usize; 3],
        /// Area of the triangle.
        area: f64,
        /// Longest side of the triangle.
        longest: f64,
    },
    /// A polygon cannot be split into triangles by its own corners.
    #[error(
        "face {face} crosses itself or has no area, so it cannot be split into triangles; its outline should be simple"
    )]
    NotSimple {
        /// The face.
        face: usize,
    },
    /// A diagonal that would split a face is already an edge.
    #[error("face {face} would be split along {edge}, which is an edge already; draw its triangles instead")]
    DiagonalIsEdge {
        /// The face.
        face: usize,
        /// The diagonal.
        edge: DrawnEdge,
    },
    /// A surface is wanted, and the sheet is an assembly of several.
    #[error("edges of more than two faces, or of none, have no two sides along which a solid could lie")]
    NoSurface,
    /// Two neighbouring faces have opposite orientations.
    #[error(
        "faces {faces:?} run along edge {edge} in the same direction; all faces should be counter-clockwise from one \
         side"
    )]
    Orientation {
        /// The edge.
        edge: DrawnEdge,
        /// The two faces.
        faces: [usize; 2],
    },
    /// An edge of a periodic sheet has only one face.
    #[error(
        "edge {edge} has only face {face}; with `foldwell:lattice` every edge should have two faces (is its copy missing \
         or out of place?), or be on a rim listed in `foldwell:holes`"
    )]
    Unmatched {
        /// The edge.
        edge: DrawnEdge,
        /// Its face.
        face: usize,
    },
    /// A side of an opening is not an edge of exactly one face.
    #[error(
        "opening {hole} passes along {edge}, which is an edge of {faces} faces; its sides should be edges of one face"
    )]
    HoleSide {
        /// The opening.
        hole: usize,
        /// The side.
        edge: DrawnEdge,
        /// Number of faces at the side.
        faces: usize,
    },
    /// An opening has less than three corners.
    #[error("opening {hole} has {corners} corners; it should go round, with at least 3")]
    SmallHole {
        /// The opening.
        hole: usize,
        /// Number of its corners.
        corners: usize,
    },
    /// Openings are listed for a sheet that is not periodic.
    #[error("`foldwell:holes` without `foldwell:lattice`; a finite sheet needs no list of its openings")]
    HolesWithoutLattice,
    /// An edge runs from a vertex to itself.
    #[error("edge {edge} of the list runs from vertex {vertex} to itself; it should join two vertices")]
    Loop {
        /// Index in `edges_vertices`.
        edge: usize,
        /// The vertex.
        vertex: usize,
    },
    /// An edge is listed twice.
    #[error("edge {edge} of the list is edge {other} again, {ends}; every edge should be listed once")]
    DuplicateEdge {
        /// The later one.
        edge: usize,
        /// The earlier one.
        other: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// A listed edge is not a side of a face.
    #[error(
        "edge {edge} of the list, {ends}, is a side of no face; every edge should bound a face, and the outline of the \
         sheet be listed too"
    )]
    LooseEdge {
        /// Index in `edges_vertices`.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// Two edges cross or touch outside their ends, seen along z.
    #[error("edges {a} and {b} cross or touch in the plane; edges should meet at common vertices only")]
    Crossing {
        /// One edge.
        a: DrawnEdge,
        /// The other.
        b: DrawnEdge,
    },
    /// Edges from which faces cannot be rebuilt.
    #[error(transparent)]
    Plane(#[from] PlaneFault),
    /// An assignment that contradicts the mesh.
    #[error(transparent)]
    Assignment(#[from] AssignmentFault),
    /// Two drawn copies of an edge with different stiffnesses.
    #[error(
        "edge {edge} of the list, {ends}, has {given} in `{key}`, and another copy of it in the drawing has {before}; \
         give both the same, or one of them null"
    )]
    StiffnessOfCopies {
        /// Name of the key.
        key: &'static str,
        /// Index in `edges_vertices`.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
        /// Stiffness of this copy.
        given: f64,
        /// Stiffness of the copy that is listed before.
        before: f64,
    },
    /// A frame that cannot be read.
    #[error(transparent)]
    Frame(#[from] FrameFault),
    /// A fold angle that the sheet cannot have.
    #[error(transparent)]
    FoldAngle(#[from] FoldAngleFault),
    /// Lines that are not a crease pattern.
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

fn translated(cell: [i32; 2]) -> String {
    if cell == [0, 0] { String::new() } else { format!(", {} and {} cells further", cell[0], cell[1]) }
}

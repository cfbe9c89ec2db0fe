//! What can be wrong with a mesh, where, and what would be right.

use std::path::PathBuf;

use super::assignment_fault::AssignmentFault;
pub use super::drawn_edge::DrawnEdge;

/// Why a file gave no sheet.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// The file could not be read at all.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        source: std::io::Error,
    },
    /// The file was read and is no mesh of a sheet.
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

/// The part of a drawn mesh that a [`Defect`] is about, numbered from 0 whatever the file does.
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
    /// The lattice vectors.
    Lattice,
    /// A listed opening.
    Hole(usize),
}

/// A [`Problem`] with the part of the mesh where it sits.
#[derive(Debug, thiserror::Error)]
#[error("{problem}")]
pub struct Defect {
    /// Where.
    pub place: MeshPart,
    /// What.
    pub problem: Box<Problem>,
}

impl Defect {
    /// `problem` at `place`.
    pub(crate) fn new(place: MeshPart, problem: Problem) -> Self {
        Self { place, problem: Box::new(problem) }
    }
}

/// What is wrong with a mesh, and what would be right. Vertices and faces carry the file's own numbers.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// Not JSON, or a key twice.
    #[error("not a FOLD file: {message}; a FOLD file is one JSON object")]
    Syntax {
        /// The parser's message.
        message: String,
    },
    /// A key that must be there is not.
    #[error("`{key}` is missing; {right}")]
    Missing {
        /// The key.
        key: &'static str,
        /// What it should hold.
        right: &'static str,
    },
    /// Something of another type.
    #[error("{what} is `{found}`; it should be {right}")]
    Type {
        /// Which value.
        what: String,
        /// Its text, shortened.
        found: String,
        /// What belongs there.
        right: &'static str,
    },
    /// Two lists that belong together differ in length.
    #[error("`{key}` has {found} entries; it should have {right}, one per entry of `edges_vertices`")]
    Length {
        /// The key.
        key: &'static str,
        /// Its entries.
        found: usize,
        /// Entries of the other list.
        right: usize,
    },
    /// A line of an OBJ file that cannot be read.
    #[error("`{found}` is no {what}; it should be {right}")]
    ObjLine {
        /// The text.
        found: String,
        /// What it should be.
        what: &'static str,
        /// An example.
        right: &'static str,
    },
    /// A number of a vertex that does not exist.
    #[error("{what} names vertex {found}; {}", numbering(*first, *last))]
    Index {
        /// Which face, edge or opening.
        what: String,
        /// The number found.
        found: String,
        /// First number.
        first: usize,
        /// Last number.
        last: usize,
    },
    /// No vertices or no faces.
    #[error("the mesh has no {what}; a sheet needs at least one face of three vertices")]
    Empty {
        /// vertices or faces
        what: &'static str,
    },
    /// Vertices in the plane and in space.
    #[error(
        "vertex {vertex} has {found} coordinates where the vertices before it have {right}; all should have 2, or all 3"
    )]
    Dimension {
        /// The vertex.
        vertex: usize,
        /// Its coordinates.
        found: usize,
        /// Coordinates of vertex 0.
        right: usize,
    },
    /// A coordinate that is not finite or beyond all use.
    #[error("vertex {vertex} has the coordinate {value:e}; coordinates should be finite and at most 1e50 in magnitude")]
    Coordinate {
        /// The vertex.
        vertex: usize,
        /// The coordinate.
        value: f64,
    },
    /// A lattice that spans no cell.
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
    /// Two drawn vertices at one place.
    #[error(
        "vertex {vertex} stands where vertex {other} stands; every place should have one vertex, shared by its faces"
    )]
    DuplicateVertex {
        /// The later one.
        vertex: usize,
        /// The earlier one.
        other: usize,
    },
    /// A copy of a vertex a million cells away.
    #[error("vertex {vertex} is a copy of vertex {other} in cell ({n1:e}, {n2:e}); copies should be within 1e6 cells")]
    FarAway {
        /// The vertex.
        vertex: usize,
        /// The vertex it copies.
        other: usize,
        /// First number of the cell.
        n1: f64,
        /// Second number of the cell.
        n2: f64,
    },
    /// A vertex in no face.
    #[error("vertex {vertex} belongs to no face; remove it, or add its faces")]
    UnusedVertex {
        /// The vertex.
        vertex: usize,
    },
    /// Faces round a vertex that form more than one fan.
    #[error("vertex {vertex} joins separate fans of faces; give each fan its own vertex")]
    NonManifoldVertex {
        /// The vertex.
        vertex: usize,
    },
    /// A face with less than three corners.
    #[error("face {face} has {corners} corners; it should have at least 3")]
    FewCorners {
        /// The face.
        face: usize,
        /// Its corners.
        corners: usize,
    },
    /// A face that passes twice through a vertex.
    #[error("face {face} names vertex {vertex} twice; every corner should be another vertex")]
    RepeatedVertex {
        /// The face.
        face: usize,
        /// The vertex.
        vertex: usize,
    },
    /// The same face twice, perhaps as a copy in another cell.
    #[error("face {face} is face {other} again{}; every face of the cell should be drawn once", translated(*cell))]
    DuplicateFace {
        /// The later one.
        face: usize,
        /// The earlier one.
        other: usize,
        /// Where the later one is drawn, relative to the earlier one.
        cell: [i32; 2],
    },
    /// A face without area.
    #[error(
        "face {face} has a triangle {triangle:?} of area {area:e} with a side of {longest:e}; the area should be over 1e-12 \
         of the side squared"
    )]
    ZeroArea {
        /// The face.
        face: usize,
        /// Its flat triangle.
        triangle: [usize; 3],
        /// Area of that.
        area: f64,
        /// Its longest side.
        longest: f64,
    },
    /// A polygon that has no triangulation by its own corners.
    #[error(
        "face {face} crosses itself or has no area, so it cannot be split into triangles; its outline should be simple"
    )]
    NotSimple {
        /// The face.
        face: usize,
    },
    /// A diagonal that is already an edge.
    #[error("face {face} would be split along {edge}, which is an edge already; draw its triangles instead")]
    DiagonalIsEdge {
        /// The face.
        face: usize,
        /// Its diagonal.
        edge: DrawnEdge,
    },
    /// An edge of more than two faces.
    #[error("edge {edge} belongs to the faces {faces:?}; an edge should have at most two")]
    NonManifoldEdge {
        /// The edge.
        edge: DrawnEdge,
        /// Its faces.
        faces: Vec<usize>,
    },
    /// Two neighbours of opposite orientation.
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
    /// An edge of one face in a periodic sheet.
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
    /// A side of an opening that is not an edge of exactly one face.
    #[error(
        "opening {hole} passes along {edge}, which is an edge of {faces} faces; its sides should be edges of one face"
    )]
    HoleSide {
        /// The opening.
        hole: usize,
        /// The side.
        edge: DrawnEdge,
        /// Faces there.
        faces: usize,
    },
    /// An opening with less than three corners.
    #[error("opening {hole} has {corners} corners; it should go round, with at least 3")]
    SmallHole {
        /// The opening.
        hole: usize,
        /// Its corners.
        corners: usize,
    },
    /// Openings of a sheet that is not periodic.
    #[error("`foldwell:holes` without `foldwell:lattice`; a finite sheet needs no list of its openings")]
    HolesWithoutLattice,
    /// An edge from a vertex to itself.
    #[error("edge {edge} of the list runs from vertex {vertex} to itself; it should join two vertices")]
    Loop {
        /// Entry of `edges_vertices`.
        edge: usize,
        /// The vertex.
        vertex: usize,
    },
    /// An edge twice in the list.
    #[error("edge {edge} of the list is edge {other} again, {ends}; every edge should be listed once")]
    DuplicateEdge {
        /// The later one.
        edge: usize,
        /// The earlier one.
        other: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// A listed edge that is no side of a face.
    #[error("edge {edge} of the list, {ends}, is a side of no face; every edge should bound a face")]
    LooseEdge {
        /// Entry of `edges_vertices`.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// Two edges that meet outside their ends, seen along z.
    #[error("edges {a} and {b} cross or touch in the plane; edges should meet at common vertices only")]
    Crossing {
        /// One edge.
        a: DrawnEdge,
        /// The other.
        b: DrawnEdge,
    },
    /// An edge that stands upright where faces had to be rebuilt.
    #[error("edge {edge} has no length seen along z; give `faces_vertices`, which cannot be rebuilt for it")]
    Upright {
        /// The edge.
        edge: DrawnEdge,
    },
    /// Edges that do not hang together, where faces had to be rebuilt.
    #[error("the edges fall into {pieces} separate pieces; give `faces_vertices`, which cannot be rebuilt for them")]
    Pieces {
        /// How many.
        pieces: usize,
    },
    /// An assignment that contradicts the mesh.
    #[error(transparent)]
    Assignment(#[from] AssignmentFault),
    /// A fold angle that contradicts the coordinates.
    #[error(
        "edge {edge} of the list, {ends}, has the fold angle {given} degrees, but the vertices draw {drawn} degrees \
         (valley positive); give the drawn angle or null"
    )]
    FoldAngle {
        /// Entry of `edges_vertices`.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
        /// The file's angle.
        given: f64,
        /// The angle of the geometry.
        drawn: f64,
    },
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

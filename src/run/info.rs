//! Counts of a mesh, and of the energy of a scene; vertices and edges as tables, for the numbers and names that a scene
//! refers to.

use std::fmt;

use serde::Serialize;

use crate::math::short;
use crate::model::{Assembly, Hinges, Stiffness};
use crate::output::table::{Table, Value};
use crate::sheet::{EdgeKind, Info, Sheet, TiledEdge};

/// Largest difference of a rest angle from the drawn angle, in radians, that counts as none.
const SAME_ANGLE_RAD: f64 = 1e-9;

/// Largest difference of two stiffnesses, relative to them, that is rounding.
const SAME_STIFFNESS: f64 = 1e-12;

/// Counts and measures of a sheet, and what a scene sets on it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Counts {
    /// The sheet of the mesh, one cell.
    #[serde(flatten)]
    pub sheet: Info,
    /// The energy of a scene; `None` for a mesh.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub energy: Option<EnergyCounts>,
}

/// The elements of the energy of a scene, over all cells of its model. `None`: the energy has no such term.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EnergyCounts {
    /// Numbers of cells of the model along the two lattice vectors.
    pub cells: [usize; 2],
    /// The bars.
    pub bars: Option<ElementCounts>,
    /// The creases.
    pub creases: Option<ElementCounts>,
    /// The diagonals of polygons.
    pub facets: Option<ElementCounts>,
}

/// Counts of the elements of a term.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ElementCounts {
    /// Number of elements.
    pub elements: usize,
    /// Number of rigid elements.
    pub rigid: usize,
    /// Number of different finite stiffnesses.
    pub stiffnesses: usize,
    /// The smallest finite stiffness; `None` if all elements are rigid.
    pub softest: Option<f64>,
    /// The largest finite stiffness; `None` if all elements are rigid.
    pub stiffest: Option<f64>,
    /// Number of elements whose rest length or rest angle is not the drawn one.
    pub rest_not_drawn: usize,
}

impl EnergyCounts {
    /// Counts the elements of an assembly.
    pub fn new(assembly: &Assembly) -> Self {
        let (terms, drawn) = (assembly.terms(), assembly.drawn_angles());
        let hinges = |hinges: &Option<Hinges>, kind: EdgeKind| {
            let hinges = hinges.as_ref()?;
            let is_one = |edge: &TiledEdge| edge.kind == kind;
            let off = |edge: usize| (hinges.rest[edge] - drawn[edge]).abs() > SAME_ANGLE_RAD;
            let edges = assembly.tiling().edges.iter().enumerate().filter(|(_, edge)| is_one(edge));
            let rest_not_drawn = edges.filter(|(edge, _)| off(*edge)).count();
            Some(ElementCounts { rest_not_drawn, ..ElementCounts::of(assembly, &hinges.stiffness, is_one) })
        };
        let bars = terms.bar_stiffness().map(|stiffness| ElementCounts {
            rest_not_drawn: assembly.bars_off_rest(),
            ..ElementCounts::of(assembly, stiffness, |_| true)
        });
        Self {
            cells: assembly.tiling().cells,
            bars,
            creases: hinges(&terms.creases, EdgeKind::Crease),
            facets: hinges(&terms.facets, EdgeKind::Facet),
        }
    }
}

impl ElementCounts {
    fn of(assembly: &Assembly, stiffness: &Stiffness, is_one: impl Fn(&TiledEdge) -> bool) -> Self {
        let edges = assembly.tiling().edges.iter().enumerate().filter(|(_, edge)| is_one(edge));
        let all: Vec<f64> = edges.map(|(edge, _)| stiffness.of(edge)).collect();
        let mut soft: Vec<f64> = all.iter().copied().filter(|stiffness| stiffness.is_finite()).collect();
        soft.sort_by(f64::total_cmp);
        let (softest, stiffest) = (soft.first().copied(), soft.last().copied());
        let rigid = all.len() - soft.len();
        soft.dedup_by(|next, one| *next - *one <= SAME_STIFFNESS * *one);
        Self { elements: all.len(), rigid, stiffnesses: soft.len(), softest, stiffest, rest_not_drawn: 0 }
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.sheet.fmt(f)?;
        let Some(EnergyCounts { cells: [n1, n2], bars, creases, facets }) = &self.energy else { return Ok(()) };
        write!(f, "\nenergy                 of {n1} x {n2} cells")?;
        for (name, counts, rest) in
            [("bars", bars, "rest lengths"), ("creases", creases, "rest angles"), ("facets", facets, "rest angles")]
        {
            if let Some(counts) = counts {
                write!(f, "\n{name:<23}{counts}")?;
                match counts.rest_not_drawn {
                    0 => {}
                    off => write!(f, "; {off} {rest} are not the drawn ones")?,
                }
            }
        }
        Ok(())
    }
}

impl fmt::Display for ElementCounts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { elements, rigid, stiffnesses, softest, stiffest, .. } = self;
        write!(f, "{elements}")?;
        match (softest, stiffest) {
            (Some(softest), Some(stiffest)) if stiffnesses > &1 => {
                write!(f, ", {stiffnesses} stiffnesses from {} to {}", short(*softest), short(*stiffest))?;
            }
            (Some(softest), _) => write!(f, ", stiffness {}", short(*softest))?,
            _ => {}
        }
        match rigid {
            0 => Ok(()),
            _ if rigid == elements => f.write_str(", all rigid"),
            _ => write!(f, ", {rigid} of them rigid"),
        }
    }
}

/// Returns a table of the vertices of a cell: number and coordinates.
pub fn vertices(sheet: &Sheet) -> Table {
    Table::new("vertex,x,y,z").with_numbered(sheet.vertices.iter().map(|position| position.iter().copied()))
}

/// Returns a table of the edges of a cell: number, name `[i, j, n1, n2]`, kind, assignment as a letter of FOLD, length,
/// and drawn fold angle in radians, which is empty for edges of one face.
pub fn edges(sheet: &Sheet) -> Table {
    let rows = sheet.edges.iter().map(|edge| {
        let key = edge.key;
        let place = [key.i, key.j].map(Value::from).into_iter().chain(key.shift.map(i64::from).map(Value::from));
        let words = [edge.kind.word(), sheet.assignment(edge).letter()].map(Value::Word);
        place.chain(words).chain([sheet.length(key).into(), sheet.drawn_angle(edge).into()])
    });
    Table::new("edge,i,j,n1,n2,kind,assignment,length,angle").with_numbered(rows)
}

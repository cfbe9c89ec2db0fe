//! A patch in fold angles and lengths instead of positions.
//!
//! In fold angles nothing is far away: the energy `sum k (rho - rho0)^2 / 2 + sum EA/L0 (L - L0)^2 / 2` is exactly
//! quadratic, and the only equations are local. The faces close round every interior vertex (three equations) and along
//! the rim of every opening (six); a bar across a notch of a rim has the distance of its ends as its length (one). This
//! is the problem that [`minimize_constrained`](crate::solver::constrained::minimize_constrained) solves; positions
//! follow from the angles ([`IntrinsicModel::hand_over`]). The multipliers of the closure are the rates of the dual
//! motion, and give the forces of all bars and hinges, also of rigid ones.

mod loops;
mod place;
#[cfg(test)]
mod tests;
mod word;

use super::configuration::Configuration;
use super::element::{Element, TermKind};
use super::law::Spring;
use super::problem::Model;
use crate::solver::constrained::{Block, Blocks, ConstrainedProblem};
use crate::solver::{Problem, Start};
pub use loops::Unsupported;
use loops::{LoopCondition, LoopStep, Topology};
use word::{EdgeValue, Ends, FrameMotion, TriangleAngle, Word};

/// A patch in fold angles and lengths.
#[derive(Debug)]
pub struct IntrinsicModel {
    topology: Topology,
    conditions: Vec<LoopCondition>,
    mean_edge: f64,
    /// Fold angle of each edge; rims have the fixed angle 0.
    angles: Vec<EdgeValue>,
    lengths: Vec<EdgeValue>,
    target: Vec<f64>,
    compliance: Vec<f64>,
    words: Vec<Word>,
    blocks: Blocks,
}

impl IntrinsicModel {
    /// Makes the intrinsic form of a model.
    ///
    /// # Errors
    /// [`Unsupported`] with the reason for which the model has none.
    pub fn new(model: &Model) -> Result<Self, Unsupported> {
        if !model.takes_any_shape() {
            let patch = matches!(model.domain(), super::Domain::Patch);
            return Err(if patch { Unsupported::Pins } else { Unsupported::Domain });
        }
        let (bars, hinges, topology) = collected(model)?;
        let (mut target, mut compliance) = (vec![], vec![]);
        let mut value = |spring: Spring| {
            if spring.stiffness.is_infinite() {
                return EdgeValue::Fixed(spring.rest);
            }
            target.push(spring.rest);
            compliance.push(1.0 / spring.stiffness);
            EdgeValue::Variable(target.len() as u32 - 1)
        };
        let angles: Vec<EdgeValue> =
            hinges.into_iter().map(|spring| spring.map_or(EdgeValue::Fixed(0.0), &mut value)).collect();
        let lengths: Vec<EdgeValue> = bars.into_iter().map(&mut value).collect();
        let conditions = conditions(&topology)?;
        let mean_edge = model.unit_of_length();
        let (words, blocks) = words(&conditions, &angles, &lengths, mean_edge);
        Ok(Self { topology, conditions, mean_edge, angles, lengths, target, compliance, words, blocks })
    }

    /// Returns the number of interior vertices.
    pub fn interior_vertices(&self) -> usize {
        let along_edges =
            |condition: &&LoopCondition| condition.steps.iter().any(|step| matches!(step, LoopStep::Along { .. }));
        self.conditions.len() - self.conditions.iter().filter(along_edges).count()
    }

    /// Returns the variables of a state of the model: fold angles and lengths that are not fixed.
    pub fn variables(&self, model: &Model, x: &[f64]) -> Vec<f64> {
        let mut z = self.target.clone();
        let all = model.coordinates(x);
        for element in model.elements() {
            let values = if element.is_angle() { &self.angles } else { &self.lengths };
            if let Some(EdgeValue::Variable(variable)) = element.edge().map(|edge| values[edge]) {
                z[variable as usize] = element.value(&all);
            }
        }
        z
    }

    /// Returns the fold angle and the length of every edge.
    pub fn measures(&self, z: &[f64]) -> [Vec<f64>; 2] {
        [&self.angles, &self.lengths].map(|values| values.iter().map(|value| value.get(z)).collect())
    }

    /// Returns the torque at the hinge and the force along the bar of every edge, for multipliers of the closure:
    /// minus the product of its transposed Jacobian, by all angles and all lengths, and the multipliers.
    fn forces(&self, z: &[f64], multipliers: &[f64]) -> [Vec<f64>; 2] {
        let edges = self.angles.len();
        let variable = |k: usize| EdgeValue::Variable(k as u32);
        let [angles, lengths]: [Vec<EdgeValue>; 2] =
            [(0..edges).map(variable).collect(), (edges..2 * edges).map(variable).collect()];
        let (words, blocks) = words(&self.conditions, &angles, &lengths, self.mean_edge);
        let all = self.measures(z).concat();
        let mut forces = vec![0.0; 2 * edges];
        let mut out = Block::default();
        for (block, word) in words.iter().enumerate() {
            let members = blocks.variables.members(block);
            let local: Vec<f64> = members.iter().map(|&k| all[k as usize]).collect();
            word.linearize(&local, None, &mut out);
            let multipliers = &multipliers[blocks.rows(block)];
            for (&member, column) in members.iter().zip(out.jacobian.chunks_exact(word.rows())) {
                forces[member as usize] -= column.iter().zip(multipliers).map(|(a, b)| a * b).sum::<f64>();
            }
        }
        let lengths = forces.split_off(edges);
        [forces, lengths]
    }

    /// Returns the whole sheet in the state of these variables, put together face by face from the middle outward and
    /// moved as close to the model's reference state as a rigid motion can. Where the closure is not met yet, the faces
    /// that were placed last do not fit: the vertices are those of the faces placed first, and angles and lengths
    /// remain those of the variables.
    pub fn folded_up(&self, model: &Model, z: &[f64], multipliers: &[f64]) -> FoldedUp {
        let [angles, lengths] = self.measures(z);
        let [torques, forces] = self.forces(z, multipliers);
        let coordinates = place::placed(&self.topology, &angles, &lengths, &model.coordinates(&model.start()));
        FoldedUp { coordinates, angles, lengths, torques, forces }
    }

    /// Moves the model to a state: its vertices where these variables and its pins put them, its angles continued to
    /// these, and tensions that balance but for loads. Returns the start of a minimisation from there.
    pub fn hand_over(&self, model: &mut Model, z: &[f64], multipliers: &[f64]) -> Start {
        let FoldedUp { coordinates, angles, torques, forces, .. } = self.folded_up(model, z, multipliers);
        let force = |element: Element<'_>| {
            let of_edges = if element.is_angle() { &torques } else { &forces };
            element.edge().map_or(0.0, |edge| of_edges[edge])
        };
        let tension = Some(model.stiff().map(force).collect());
        let coordinates = model.onto_pins(coordinates);
        model.enter(&Configuration::new(coordinates, model.angles_among(&angles), tension))
    }
}

/// A sheet put together from fold angles and lengths.
#[derive(Clone, Debug)]
pub struct FoldedUp {
    /// Coordinates of all vertices.
    pub coordinates: Vec<f64>,
    /// Fold angle of every edge, in radians; 0 on rims.
    pub angles: Vec<f64>,
    /// Length of every edge.
    pub lengths: Vec<f64>,
    /// Torque of the hinge of every edge by the multipliers of the closure.
    pub torques: Vec<f64>,
    /// Force along the bar of every edge by these multipliers, positive where it is stretched.
    pub forces: Vec<f64>,
}

impl ConstrainedProblem for IntrinsicModel {
    fn blocks(&self) -> &Blocks {
        &self.blocks
    }

    fn target(&self) -> &[f64] {
        &self.target
    }

    fn compliance(&self) -> &[f64] {
        &self.compliance
    }

    fn linearize(&self, number: usize, z: &[f64], multipliers: Option<&[f64]>, out: &mut Block) {
        let local: Vec<f64> = self.blocks.variables.members(number).iter().map(|&k| z[k as usize]).collect();
        self.words[number].linearize(&local, multipliers, out);
    }
}

/// The springs of all bars, and of the hinges that there are, by edge, and the topology.
type Collected = (Vec<Spring>, Vec<Option<Spring>>, Topology);

/// Collects the springs of all bars and hinges by their edges, and the topology that follows from their vertices. A
/// lock comes before a crease on the same edge.
fn collected(model: &Model) -> Result<Collected, Unsupported> {
    let edges = model.edges();
    let (mut bars, mut hinges) = (vec![None; edges], vec![None; edges]);
    let (mut ends, mut wings) = (vec![[0; 2]; edges], Vec::new());
    for element in model.elements() {
        let Some(edge) = element.edge().filter(|_| !element.has_law()) else { return Err(Unsupported::Law) };
        let (kind, spring) = (element.kind(), Some(element.spring));
        match (kind, element.sites()) {
            (TermKind::Bars, &[i, j]) => {
                bars[edge] = spring;
                ends[edge] = [i.vertex, j.vertex];
            }
            (TermKind::Creases | TermKind::Facets | TermKind::Locks, &[i, j, left, right]) => {
                hinges[edge] = if kind == TermKind::Locks { spring } else { hinges[edge].or(spring) };
                wings.push([i, j, left, right].map(|site| site.vertex));
            }
            _ => return Err(Unsupported::Topology),
        }
    }
    let missing = |edge: usize| Unsupported::NoBar { edge };
    let bars = (0..).zip(bars).map(|(edge, spring)| spring.ok_or(missing(edge))).collect::<Result<Vec<Spring>, _>>()?;
    let topology = Topology::new(model.coordinates(&model.start()).len() / 3, &ends, &wings)?;
    let folds = |hinge: &Option<Spring>| hinge.is_some_and(|spring| (1.0 / spring.stiffness).is_finite());
    let inside = |edge: usize| {
        let [i, j] = ends[edge];
        [[i, j], [j, i]].iter().all(|&[a, b]| topology.get(a, b).is_some_and(|found| found.left.is_some()))
    };
    match (0..edges).find(|&edge| inside(edge) && !folds(&hinges[edge])) {
        Some(edge) => Err(Unsupported::NoHinge { edge }),
        None => Ok((bars, hinges, topology)),
    }
}

/// Returns the conditions: the loops round the interior vertices, those along all rims but the longest, which is the
/// outer one and closes if all others do, and the bridges between two vertices of a rim.
fn conditions(topology: &Topology) -> Result<Vec<LoopCondition>, Unsupported> {
    let mut rims = topology.rims()?;
    if !topology.is_disk(rims.len()) {
        return Err(Unsupported::Topology);
    }
    let bridges = topology.bridges(&rims)?;
    if let Some(outer) = (0..rims.len()).max_by_key(|&k| rims[k].len()) {
        rims.remove(outer);
    }
    let rounds = topology.rounds()?.into_iter().chain(rims.iter().map(loops::Rim::round));
    Ok(rounds.map(|steps| LoopCondition { steps, bridge: None }).chain(bridges).collect())
}

/// Returns the conditions as products of motions, in these variables, and the variables of each.
fn words(conditions: &[LoopCondition], angles: &[EdgeValue], lengths: &[EdgeValue], unit: f64) -> (Vec<Word>, Blocks) {
    let mut blocks = Blocks::default();
    let words = conditions.iter().map(|condition| {
        let mut variables: Vec<u32> = Vec::new();
        let mut own = |value: EdgeValue| {
            let EdgeValue::Variable(variable) = value else { return value };
            let place = variables.iter().position(|v| *v == variable).unwrap_or_else(|| {
                variables.push(variable);
                variables.len() - 1
            });
            EdgeValue::Variable(place as u32)
        };
        let (mut factors, mut ends) = (vec![], Ends::Round);
        for step in &condition.steps {
            match *step {
                LoopStep::Cross { edge, sign } => factors.push(FrameMotion::Fold { angle: own(angles[edge]), sign }),
                LoopStep::Sector { edges, sign } => factors.push(sector(edges.map(|edge| own(lengths[edge])), sign)),
                LoopStep::Along { edge } => {
                    ends = Ends::Rim { unit };
                    factors.push(FrameMotion::Shift { length: own(lengths[edge]) });
                    factors.push(FrameMotion::Turn { sine: 0.0, cosine: -1.0 });
                }
            }
        }
        if let Some(edge) = condition.bridge {
            ends = Ends::Bridge { length: own(lengths[edge]), unit };
        }
        let word = Word { factors, ends };
        blocks.push(word.rows(), &variables);
        word
    });
    let words = words.collect();
    (words, blocks)
}

/// Returns the rotation through a triangle with these sides, evaluated once if they are fixed.
fn sector(lengths: [EdgeValue; 3], sign: f64) -> FrameMotion {
    let [EdgeValue::Fixed(a), EdgeValue::Fixed(b), EdgeValue::Fixed(c)] = lengths else {
        return FrameMotion::Sector { lengths, sign };
    };
    let corner = TriangleAngle::new([a, b, c]);
    FrameMotion::Turn { sine: sign * corner.sine, cosine: corner.cosine }
}

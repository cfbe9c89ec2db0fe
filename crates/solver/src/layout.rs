//! Unknowns of a problem, which of them are coupled, and what follows from that alone.

use foldwell_numerics::factor::FactorError;
use foldwell_numerics::sparse::{Cliques, Slots, SparsityPattern};
use foldwell_numerics::tearing::Tearing;
use std::sync::{Arc, OnceLock};

/// The unknowns of a problem and their couplings, the same at every state. A problem, its linearizations and their
/// factorizations share one layout.
#[derive(Debug)]
pub struct Layout {
    /// Number of unknowns.
    pub unknowns: usize,
    /// Block of each unknown (a vertex, say), numbered without gaps: blocks stay together in the order of elimination.
    pub node: Vec<u32>,
    /// Unknowns of each soft element.
    pub soft: Cliques,
    /// Unknowns of each stiff measure.
    pub stiff: Cliques,
    plan: OnceLock<SymbolicHessian>,
}

/// The pattern of the Hessian, the places of the elements in it, and how it is factored: the same for all states and
/// all solves.
#[derive(Debug)]
pub(super) struct SymbolicHessian {
    pub(super) pattern: SparsityPattern,
    pub(super) soft: Slots,
    pub(super) stiff: Slots,
    tearing: OnceLock<Result<Arc<Tearing>, FactorError>>,
}

impl Layout {
    /// A layout of `node.len()` unknowns: the block of each, the unknowns of every soft element, and those of every
    /// stiff measure.
    pub fn new(node: Vec<u32>, soft: Cliques, stiff: Cliques) -> Arc<Self> {
        Arc::new(Self { unknowns: node.len(), node, soft, stiff, plan: OnceLock::new() })
    }

    /// The plan, made when it is first asked for.
    pub(super) fn plan(&self) -> &SymbolicHessian {
        self.plan.get_or_init(|| {
            let pattern = SparsityPattern::new(self.unknowns, &[&self.soft, &self.stiff]);
            let (soft, stiff) = (Slots::new(&pattern, &self.soft), Slots::new(&pattern, &self.stiff));
            SymbolicHessian { pattern, soft, stiff, tearing: OnceLock::new() }
        })
    }

    /// The symbolic analysis by which matrices of the Hessian's pattern are factored, made once.
    ///
    /// # Errors
    /// As [`Tearing::new`].
    pub fn tearing(&self) -> Result<&Arc<Tearing>, FactorError> {
        let plan = self.plan();
        let analyse = || Tearing::new(&plan.pattern, &self.node, &[&self.soft, &self.stiff]).map(Arc::new);
        plan.tearing.get_or_init(analyse).as_ref().map_err(|error| *error)
    }
}

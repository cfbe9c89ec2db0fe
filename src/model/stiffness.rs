//! The stiffness of the elements of a term: one number, or one for each edge.

/// The stiffness of the bars, the creases or the facets: `EA`, a force, for bars; torque per radian and unit length for
/// hinges. Infinite for exactly rigid elements, which may stand beside soft ones.
///
/// ```
/// use foldwell::{Assembly, Pattern, RIGID, generate, model::Stiffness};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let mut each = vec![1.0; 12]; // a cell of Miura-ori has 8 creases and 4 diagonals
/// each[3] = RIGID;
/// let assembly = Assembly::torus(sheet, [1, 1]).bars(RIGID).creases(each).build()?;
/// let creases = &assembly.terms().creases.as_ref().ok_or("creases have an energy")?.stiffness;
/// assert_eq!((creases.of(0), creases.of(3), creases.softest()), (1.0, RIGID, 1.0));
/// assert!(matches!(creases, Stiffness::PerEdge(_)) && !creases.is_rigid());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Stiffness {
    /// The same for all elements.
    Uniform(f64),
    /// One for each edge of the tiling; NaN where there is no element of the term.
    PerEdge(Vec<f64>),
}

impl From<f64> for Stiffness {
    fn from(stiffness: f64) -> Self {
        Self::Uniform(stiffness)
    }
}

impl From<Vec<f64>> for Stiffness {
    fn from(each: Vec<f64>) -> Self {
        Self::PerEdge(each)
    }
}

impl Stiffness {
    /// Returns the stiffness of the element at an edge of the tiling; NaN if the term has none there.
    pub fn of(&self, edge: usize) -> f64 {
        match self {
            Self::Uniform(stiffness) => *stiffness,
            Self::PerEdge(each) => each[edge],
        }
    }

    /// Returns the stiffness that all elements have; `None` if they differ.
    pub fn uniform(&self) -> Option<f64> {
        match self {
            Self::Uniform(stiffness) => Some(*stiffness),
            Self::PerEdge(_) => None,
        }
    }

    /// Returns the smallest stiffness of an element; infinite if there is none.
    pub fn softest(&self) -> f64 {
        self.values().fold(f64::INFINITY, f64::min)
    }

    /// Returns the largest stiffness of an element; zero if there is none.
    pub fn stiffest(&self) -> f64 {
        self.values().fold(0.0, f64::max)
    }

    /// Returns the lower median of the stiffnesses of all elements that are not rigid; infinite if there is none.
    pub fn median(&self) -> f64 {
        let mut soft: Vec<f64> = self.values().filter(|stiffness| stiffness.is_finite()).collect();
        soft.sort_by(f64::total_cmp);
        soft.get(soft.len().saturating_sub(1) / 2).copied().unwrap_or(f64::INFINITY)
    }

    /// Returns the stiffness with no element stiffer than this.
    pub fn at_most(&self, most: f64) -> Self {
        match self {
            Self::Uniform(stiffness) => Self::Uniform(stiffness.min(most)),
            Self::PerEdge(each) => Self::PerEdge(each.iter().map(|k| if *k > most { most } else { *k }).collect()),
        }
    }

    /// Whether all elements are rigid.
    pub fn is_rigid(&self) -> bool {
        self.values().all(f64::is_infinite)
    }

    /// Whether any element is rigid.
    pub fn has_rigid(&self) -> bool {
        self.values().any(f64::is_infinite)
    }

    /// Returns the stiffness with the soft elements left out; `None` if no element is rigid.
    pub fn rigid_part(&self) -> Option<Self> {
        self.has_rigid().then(|| match self {
            Self::Uniform(_) => self.clone(),
            Self::PerEdge(each) => {
                Self::PerEdge(each.iter().map(|k| if k.is_infinite() { *k } else { f64::NAN }).collect())
            }
        })
    }

    /// The stiffness of every element; of a uniform one the same number once.
    fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let all = match self {
            Self::Uniform(stiffness) => std::slice::from_ref(stiffness),
            Self::PerEdge(each) => each,
        };
        all.iter().copied().filter(|stiffness| !stiffness.is_nan())
    }

    /// Returns the stiffness with NaN at the edges that have no element, and as one number if all elements have the
    /// same.
    pub(super) fn at_elements(&self, is_element: impl Fn(usize) -> bool) -> Self {
        let Self::PerEdge(each) = self else { return self.clone() };
        let kept = |(edge, k): (usize, &f64)| if is_element(edge) { *k } else { f64::NAN };
        let each: Vec<f64> = each.iter().enumerate().map(kept).collect();
        let first = each.iter().copied().find(|k| !k.is_nan());
        match first {
            Some(first) if (0..each.len()).all(|edge| !is_element(edge) || each[edge] == first) => Self::Uniform(first),
            _ => Self::PerEdge(each),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: values at edges without element do not count, equal values are one number, and the rigid part keeps what
    /// is rigid.
    #[test]
    fn only_elements_count() {
        let each = || Stiffness::from(vec![2.0, 5.0, 2.0, f64::INFINITY]);
        assert_eq!(each().at_elements(|edge| edge % 2 == 0), Stiffness::Uniform(2.0));
        let mixed = each().at_elements(|edge| edge != 0);
        assert!(mixed.of(0).is_nan() && mixed.uniform().is_none());
        assert!((mixed.softest(), mixed.is_rigid(), mixed.has_rigid()) == (2.0, false, true));
        assert!((mixed.stiffest(), mixed.median(), mixed.at_most(3.0).of(1)) == (f64::INFINITY, 2.0, 3.0));
        assert!(mixed.at_most(3.0).of(0).is_nan() && mixed.at_most(3.0).of(2) == 2.0);
        let rigid = mixed.rigid_part().unwrap();
        assert!(rigid.is_rigid() && rigid.of(1).is_nan() && rigid.of(3).is_infinite());
        assert_eq!(Stiffness::from(3.0).rigid_part(), None);
    }
}

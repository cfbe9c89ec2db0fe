//! Random flat-foldable crease patterns, folded by a fifth from the flat state: how many leave it, and what is said of
//! the others.
//!
//! `cargo test --release --test integration random_folds -- --include-ignored --nocapture` prints the counts of 400
//! patterns of each family.

use foldwell::analysis::relax::{RelaxError, Relaxed};
use foldwell::sheet::{Edge, Sheet, fold};
use foldwell::solver::Failure;
use foldwell::{Assembly, RIGID, Rest, relax};

use crate::common::Scene;
use crate::sheet::random_patterns::Family;

/// The part of the flat fold that is asked for.
const PART: f64 = 0.2;
/// Number of patterns of a family.
const PATTERNS: u64 = 200;
/// Number of those that have to come to rest folded: 95 of 100, which is what is asked of the program.
const MOST: usize = 190;
/// Stiffness of soft facets, over that of the creases.
const SOFT: f64 = 10.0;

/// Folds a pattern by its letters.
fn folded(sheet: &Sheet, bars: f64, facets: f64) -> Result<Relaxed, Box<RelaxError>> {
    let pattern = Assembly::patch(sheet.clone(), [1, 1]).bars(bars).creases(1.0).facets(facets);
    relax(&pattern.rest(Rest::Assigned(PART)).build().unwrap())
}

/// How far a pattern has folded.
struct Fold {
    failure: Option<Failure>,
    minimum: bool,
    /// Largest and mean ratio of a crease's angle to its rest angle, and the part of the creases on the side of theirs.
    largest: f64,
    mean: f64,
    on_side: f64,
    /// Energy over that of the flat state.
    energy: f64,
}

impl Fold {
    fn new(sheet: &Sheet, bars: f64, facets: f64) -> Self {
        let found = folded(sheet, bars, facets);
        let (state, failure) = match &found {
            Ok(found) => (&found.state, None),
            Err(error) => (&error.state, Some(error.failure)),
        };
        let rest = |edge: &Edge| PART * sheet.assignment(edge).flat_folded_angle().unwrap_or(0.0);
        let aimed = sheet.edges.iter().zip(&state.fold_angle).filter(|(edge, _)| rest(edge) != 0.0);
        let ratios: Vec<f64> = aimed.map(|(edge, angle)| angle / rest(edge)).collect();
        let flat: f64 = sheet
            .edges
            .iter()
            .map(|edge| {
                let [a, b] = edge.key.ends().map(|end| sheet.position(end));
                0.5 * (b - a).norm() * rest(edge).powi(2)
            })
            .sum();
        Self {
            failure,
            minimum: found.as_ref().is_ok_and(|found| found.negative_eigenvalues == Some(0)),
            largest: ratios.iter().fold(0.0, |largest, ratio| largest.max(ratio.abs())),
            mean: ratios.iter().sum::<f64>() / ratios.len() as f64,
            on_side: ratios.iter().filter(|ratio| **ratio > 0.0).count() as f64 / ratios.len() as f64,
            energy: state.total() / flat,
        }
    }

    /// Whether the sheet came to rest in a minimum out of the plane.
    fn left(&self) -> bool {
        self.minimum && self.largest > 0.1 && self.energy < 0.99
    }

    fn unbounded(&self) -> bool {
        matches!(self.failure, Some(Failure::Unbounded { .. }))
    }
}

fn folds(family: Family, bars: f64, facets: f64, count: u64) -> Vec<Fold> {
    let sheet = |seed| fold::parse(&family.pattern(seed), "random.fold").unwrap();
    (0..count).map(|seed| Fold::new(&sheet(seed), bars, facets)).collect()
}

fn count(folds: &[Fold], which: impl Fn(&Fold) -> bool) -> usize {
    folds.iter().filter(|fold| which(fold)).count()
}

/// Claim: at least 95 of 100 random patterns that fold rigidly by all their creases come to rest in a minimum with
/// every crease on the side of its rest angle, and on average more than half of it, with bars of 1e4 and rigid ones,
/// soft and rigid facets. Source: the Miura-like zigzags fold rigidly with creases of one magnitude along every line
/// (Tachi 2009, see `flat_patterns`); a rigid motion leads from the flat state of a single vertex to each of its folded
/// ones (I. Streinu, W. Whiteley, "Single-vertex origami and spherical expansive motions", LNCS 3742 (2005)).
/// Tolerance: 95 of 100 is what is asked of the program; 200 and 198 of 200 were measured.
#[test]
fn rigidly_foldable_patterns_fold_by_a_fifth() {
    for family in [Family::Zigzags, Family::Vertex] {
        for (bars, facets) in [(1e4, RIGID), (RIGID, RIGID), (1e4, SOFT), (RIGID, SOFT)] {
            let folds = folds(family, bars, facets, PATTERNS);
            let whole = count(&folds, |fold| fold.left() && fold.on_side == 1.0 && fold.mean > 0.5);
            assert!(whole >= MOST, "{family:?}, bars {bars}, facets {facets}: {whole}");
        }
    }
}

/// Claim: at least 95 of 100 sheets that are folded along random lines one after the other come to rest in a minimum
/// out of the plane, with bars of 1e4 and rigid ones, if facets bend. With rigid bars and facets many have no balance,
/// as few of them fold rigidly by all creases at once; each that does not come to rest out of the plane fails, and
/// nearly all of these because the forces have no balance. Tolerance: 95 of 100 is what is asked of the program; 193 of
/// 200 were measured with soft facets, 142 with rigid ones.
#[test]
fn simple_folds_leave_the_flat_state_or_say_why_not() {
    for (bars, facets) in [(1e4, RIGID), (1e4, SOFT), (RIGID, SOFT), (RIGID, RIGID)] {
        let folds = folds(Family::SimpleFolds, bars, facets, PATTERNS);
        let [left, failed] = [count(&folds, Fold::left), count(&folds, |fold| fold.failure.is_some())];
        // one of redundant rigid bars, whose stability depends on their self stress, is not known to be a minimum
        assert!(left + failed + 1 >= folds.len(), "bars {bars}, facets {facets}: {left} left, {failed} failed");
        let least = if bars == RIGID && facets == RIGID { 120 } else { MOST };
        assert!(left >= least, "bars {bars}, facets {facets}: {left}");
        let unbounded = count(&folds, Fold::unbounded);
        assert!(5 * unbounded >= 4 * failed, "bars {bars}, facets {facets}: {unbounded} of {failed}");
    }
}

/// Claim: where Newton's method with rigid bars takes a branch on which next to nothing is relieved, the one to which
/// soft bars lead is taken. Source: one of 400 random zigzags, which folded by 3% of its rest angles with rigid bars
/// alone, and kept 92% of the energy, while all of them fold rigidly. Tolerance: others keep less than half of it.
#[test]
fn a_branch_that_relieves_nothing_is_not_kept() {
    let sheet = fold::parse(&Family::Zigzags.pattern(328), "random.fold").unwrap();
    let fold = Fold::new(&sheet, RIGID, RIGID);
    assert!(fold.left() && fold.on_side == 1.0 && fold.energy < 0.5, "{} {}", fold.energy, fold.mean);
}

/// Three valleys that meet at angles of 120 degrees.
const THREE_VALLEYS: &str = "{\"vertices_coords\": [[0,0],[1,0],[-0.5,0.8660254037844386],[-0.5,-0.8660254037844386]],\n\
    \"edges_vertices\": [[0,1],[0,2],[0,3],[1,2],[2,3],[3,1]],\n\
    \"edges_assignment\": [\"V\",\"V\",\"V\",\"B\",\"B\",\"B\"]}";

/// Claim: three valleys that meet at 120 degrees do not fold rigidly at all, since a pyramid with three faces is rigid.
/// With bars of 1e4 the sheet leaves the flat state; with rigid ones it is said that the forces have no balance, after
/// states that tend to the flat one, with tensions that grow by 10^(1/3) for bars ten times as stiff. Source: the
/// minimum of `k a^4 - torque a`. Tolerance: the next order is a part of the fold angle, which is 3e-3 with the
/// stiffest bars.
#[test]
fn a_pattern_without_rigid_folds_says_so() {
    let sheet = fold::parse(THREE_VALLEYS, "three.fold").unwrap();
    assert!(Fold::new(&sheet, 1e4, RIGID).left());
    let rigid = Fold::new(&sheet, RIGID, RIGID);
    assert!(rigid.largest < 0.01 && rigid.energy < 1.0 && rigid.energy > 0.98, "{} {}", rigid.largest, rigid.energy);
    let Some(Failure::Unbounded { growth }) = rigid.failure else { panic!("{:?}", rigid.failure) };
    assert!((growth - 10f64.cbrt()).abs() < 1e-2, "{growth}");
}

/// Claim: the program says this too, with an exit status other than 0.
#[test]
fn the_program_says_that_nothing_balances() {
    let scene = "[sheet]\nmesh = \"three.fold\"\n[energy]\nbars = { stiffness = inf }\n\
                 creases = { stiffness = 1.0, rest = \"assigned\", fraction = 0.2 }\n\
                 [[study]]\nname = \"a\"\nkind = \"relax\"\n";
    let said = Scene::new(scene).with("three.fold", THREE_VALLEYS).program("").ends(1);
    let studies = said.folder.studies();
    let reason = studies[0]["reason"].as_str().unwrap();
    assert!(
        reason.starts_with("with rigid bars the forces cannot balance") && reason.contains("a factor of 2.1"),
        "{reason}"
    );
    let history = studies[0]["history"].as_array().unwrap();
    assert!(history.iter().all(|row| row["method"] == "soft-bars"));
}

/// Claim: of 400 patterns of each family no more than one in twenty fails, unless bars and facets are both rigid.
/// Prints the counts.
#[test]
#[ignore = "prints a table; the claim is that of the tests of 200 patterns"]
fn counts_of_400_patterns() {
    println!(
        "family, bars, facets: left the flat state / no balance / other failures; whole side; mean angle over rest"
    );
    for family in Family::ALL {
        for (bars, facets) in [(1e4, RIGID), (RIGID, RIGID), (1e4, SOFT), (RIGID, SOFT)] {
            let folds = folds(family, bars, facets, 400);
            let [left, unbounded] = [count(&folds, Fold::left), count(&folds, Fold::unbounded)];
            let failed = count(&folds, |fold| fold.failure.is_some());
            let whole = count(&folds, |fold| fold.on_side == 1.0);
            let mean = folds.iter().map(|fold| fold.mean).sum::<f64>() / folds.len() as f64;
            println!("{family:?}, {bars}, {facets}: {left} / {unbounded} / {}; {whole}; {mean:.3}", failed - unbounded);
            assert!(left >= 380 || family == Family::SimpleFolds && bars == RIGID && facets == RIGID);
        }
    }
}

//! The summary of a run (`summary.json`) and of a sheet (`foldwell info`).
//!
//! Numbers that were not computed, NaN and infinity are `null`. The docs of the keys are the descriptions of the JSON schema
//! ([`schema::schema`]); a key that can be `null` says when.

use std::path::Path;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::OutputError;
use super::files;
use super::schema;

/// What a run of `foldwell` found: `summary.json`. Angles are radians; lengths and energies have the units of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(title = "foldwell summary")]
pub struct Summary {
    /// Version of the program.
    pub version: &'static str,
    /// The scene file, as it was named.
    pub scene: String,
    /// A fingerprint of the scene and of every file that it names.
    pub digest: String,
    /// The sheet.
    pub sheet: SheetSummary,
    /// The terms of the energy, and the locks, that were built.
    pub terms: Vec<String>,
    /// What the scene made unnecessary.
    pub left_out: Vec<String>,
    /// The studies, in the order of the scene.
    pub studies: Vec<StudySummary>,
}

/// Counts of one cell, and of the model.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SheetSummary {
    /// Vertices of a cell.
    pub vertices: usize,
    /// Edges of a cell, diagonals of polygons included.
    pub edges: usize,
    /// Triangles of a cell.
    pub faces: usize,
    /// Polygons of a cell, as the mesh has them.
    pub polygons: usize,
    /// Whether the sheet can be laid flat: no angle defect at any vertex.
    pub developable: bool,
    /// Cells of the model.
    pub cells: [usize; 2],
    /// Unknowns of the model.
    pub degrees_of_freedom: usize,
}

/// What came out of a study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StudySummary {
    /// Its name.
    pub name: String,
    /// Its kind; the other keys depend on it.
    #[schemars(schema_with = "schema::kind")]
    pub kind: String,
    /// Whether it gave its answer.
    pub converged: bool,
    /// Time in seconds, drawing and writing excluded.
    pub seconds: f64,
    /// The study's own error estimate; null where it gave no answer.
    pub error: Option<f64>,
    /// Why it did not converge; absent where it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub reason: Option<String>,
    /// What it wrote, by which a resumed run sees whether that is still there; absent while it is not finished.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Files")]
    pub files: Option<Files>,
    /// The keys of its kind; null where it did not get so far.
    #[serde(flatten)]
    #[schemars(schema_with = "schema::answers")]
    pub result: Option<StudyResult>,
}

/// The files of a study, taken together.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Files {
    /// How many there are.
    pub count: usize,
    /// Their bytes in all.
    pub bytes: u64,
    /// Sixteen hexadecimal digits that change with any name and any byte of theirs.
    pub digest: String,
}

/// The keys of each kind of study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum StudyResult {
    /// `kind = "relax"`.
    Relax(RelaxSummary),
    /// `kind = "modes"`.
    Modes(ModesSummary),
    /// `kind = "branches"`.
    Branches(BranchesSummary),
    /// `kind = "surface"`.
    Surface(SurfaceSummary),
    /// `kind = "landscape"`.
    Landscape(LandscapeSummary),
    /// `kind = "bloch"`.
    Bloch(BlochSummary),
    /// `kind = "wells"`.
    Wells(WellsSummary),
    /// Of `trace`.
    Trace(TraceSummary),
}

/// Energy by terms; null where the term is not there, or not finite after a relaxation that failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EnergySummary {
    /// Stretching.
    pub bars: Option<f64>,
    /// Folding.
    pub creases: Option<f64>,
    /// Bending of polygons.
    pub facets: Option<f64>,
    /// Their sum: the elastic energy.
    #[schemars(with = "Option<f64>")]
    pub total: f64,
}

/// An equilibrium.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RelaxSummary {
    /// Energy of the last state.
    pub energy: EnergySummary,
    /// Accepted Newton steps.
    pub iterations: usize,
    /// Factorizations.
    pub factorizations: usize,
    /// Solves with a factorization that was there already.
    pub chord_solves: usize,
    /// Largest unbalanced force over the largest force of any term; null where a relaxation failed before it was known.
    #[schemars(with = "Option<f64>")]
    pub residual_force: f64,
    /// Largest error of a length over the mean edge; null where a relaxation failed before it was known.
    #[schemars(with = "Option<f64>")]
    pub residual_length: f64,
    /// Negative eigenvalues of the energy's Hessian on what the rigid terms leave free; null where it did not converge.
    pub negative_eigenvalues: Option<usize>,
    /// Redundant rigid terms; null where they were not counted.
    pub self_stresses: Option<usize>,
    /// Whether faces of the last state pass through each other; null where that was not asked.
    pub self_intersecting: Option<bool>,
    /// Largest difference of a fold angle to the exact solver; null where that says nothing.
    pub error_to_kinematic: Option<f64>,
    /// Number of rays of rigid folding that leave the drawn state from which a rigid cell with locks was relaxed, where that is a branch
    /// point: other branches may end in other equilibria. Null elsewhere, and where these rays are not known.
    pub branch_point_start: Option<usize>,
    /// What is established about the directions of rigid folding there, in the words of `branches`; null where they were not looked for:
    /// other starts, bars that are not rigid, no locks.
    #[serde(default)]
    #[schemars(extend("enum" = ["listed", "continuum", "not-established", null]))]
    pub directions_at_start: Option<String>,
    /// A row per iteration.
    pub history: Vec<IterationSummary>,
}

/// One iteration of a relaxation; null: not finite, before a relaxation failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IterationSummary {
    /// Number of the iteration; 0 is the start.
    pub iteration: usize,
    /// The merit: the energy, with the stiff terms through their tensions.
    #[schemars(with = "Option<f64>")]
    pub energy: f64,
    /// Largest unbalanced force over the largest force of any term.
    #[schemars(with = "Option<f64>")]
    pub residual_force: f64,
    /// Largest error of a length over the mean edge.
    #[schemars(with = "Option<f64>")]
    pub residual_length: f64,
    /// Fraction of the Newton step that was taken.
    pub step: f64,
    /// Shift added to the Hessian, over its largest diagonal entry.
    pub shift: f64,
}

/// Modes of a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModesSummary {
    /// Null space of the rigidity matrix of the bars.
    pub zero_modes: usize,
    /// Left null space of the rigidity matrix of the bars.
    pub self_stresses: usize,
    /// Zero modes that move the sheet as a whole.
    pub rigid_motions: usize,
    /// Null space of the closure conditions in fold angles; null where these do not say all, or are too many.
    pub folding_modes: Option<usize>,
    /// Columns minus rows of the rigidity matrix.
    pub maxwell_count: i64,
    /// Smallest singular value that was kept over the largest that was dropped; null: none was dropped, or it was 0.
    pub gap: Option<f64>,
    /// Lowest eigenvalues of the energy's Hessian, ascending.
    pub eigenvalues: Vec<f64>,
}

/// The trajectories of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TraceSummary {
    /// What is established about all directions in which folding leaves the drawn state, in the words of `branches`: whether the rays
    /// below, or those of the branch that was asked for, are all of them.
    #[serde(default)]
    #[schemars(extend("enum" = ["listed", "continuum", "not-established"]))]
    pub directions: String,
    /// One for each ray that was followed; where no ray is real, the one entry that says so.
    pub branches: Vec<TrajectorySummary>,
}

/// A trajectory along one ray.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrajectorySummary {
    /// Number of the branch; null where no ray is real.
    pub branch: Option<usize>,
    /// Which way along it, +1 or -1; null where no ray is real.
    #[schemars(schema_with = "schema::sign_or_null")]
    pub sign: Option<i8>,
    /// Whether the fold angles come back to the start modulo 2 pi.
    pub closed: bool,
    /// Length in fold angles, radians.
    pub arc_length: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Corrections of all steps.
    pub iterations: usize,
    /// Largest residual: of closure, or scaled, of the relaxations beside; null where there is no state.
    pub max_residual: Option<f64>,
    /// The ray along which it comes back; null where it does not.
    pub ends_at: Option<RayName>,
    /// How it ended.
    #[schemars(extend("enum" = ["closed", "stop", "failed", "interrupted", "no-real-branch"]))]
    pub end: String,
    /// Whether faces of a state on it pass through each other; null where that was not asked.
    #[serde(default)]
    pub self_intersecting: Option<bool>,
    /// Where faces first pass through each other; null where they do not, or it was not asked.
    pub first_self_intersection: Option<ArcLength>,
    /// Largest difference of a fold angle to the energy's; null where the two were not compared.
    pub error_to_kinematic: Option<f64>,
    /// Largest difference of a signed curvature to the energy's; left out where the two were not compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "f64")]
    pub error_of_curvature: Option<f64>,
    /// Largest difference of a strain to the energy's; left out where the two were not compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "f64")]
    pub error_of_strain: Option<f64>,
    /// Largest difference of a rotation angle to the energy's, in radians; left out where the two were not compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "f64")]
    pub error_of_theta: Option<f64>,
    /// Where curvature and strains turn.
    pub turning_points: Vec<TurningPoint>,
}

/// A ray by its branch and sign.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RayName {
    /// Number of the branch.
    pub branch: usize,
    /// +1 or -1.
    #[schemars(schema_with = "schema::sign")]
    pub sign: i8,
}

/// A place on a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ArcLength {
    /// Arc length in fold angles, radians.
    pub arc_length: f64,
}

/// An extremum of a quantity along a trajectory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TurningPoint {
    /// Which quantity.
    #[schemars(extend("enum" = ["curvature", "strain11", "strain22", "strain12"]))]
    pub of: String,
    /// Arc length in fold angles, radians.
    pub arc_length: f64,
    /// Its value there.
    pub value: f64,
}

/// The landscapes of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LandscapeSummary {
    /// One for each mode.
    pub modes: Vec<ModeLandscape>,
    /// Energies in all directions, where they were asked for.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "MapSummary")]
    pub map: Option<MapSummary>,
}

/// Energies over the sphere of curvature tensors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapSummary {
    /// Norm of the tensors.
    pub amplitude: f64,
    /// Samples.
    pub samples: usize,
    /// Those that did not converge.
    pub failed: usize,
    /// Newton steps of all samples.
    pub iterations: usize,
    /// Largest energy; null where no sample converged.
    pub largest_energy: Option<f64>,
    /// Points on the exact cone of cylinders that the kinematics found.
    pub cone_points: usize,
    /// Largest angle, in radians, between some of these points and the zeros of the energy beside them; null without any.
    pub cone_distance: Option<f64>,
}

/// What a mode costs; null: too few samples for a fit, or no prediction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModeLandscape {
    /// The curvature tensor `[k11, k22, k12]` of a mode of a patch; null for waves.
    pub mode: Option<[f64; 3]>,
    /// How often a mode of a torus goes round it, where it was named so.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "[i32; 2]")]
    pub wave: Option<[i32; 2]>,
    /// By rising amplitude.
    pub samples: Vec<SampleSummary>,
    /// Slope of log energy on the smallest amplitudes.
    pub exponent: Option<f64>,
    /// Standard error of the exponent; null also where there are no more samples than numbers to fit, and nothing tells it.
    pub exponent_error: Option<f64>,
    /// Limit of energy over the fourth power of the amplitude, from a fit.
    pub coefficient: Option<f64>,
    /// Standard error of the coefficient; null likewise.
    pub coefficient_error: Option<f64>,
    /// The same without a fit, from the second order.
    pub predicted_coefficient: Option<f64>,
    /// Coefficient of the fifth power, without a fit.
    pub predicted_fifth: Option<f64>,
    /// Coefficient of the sixth power, without a fit: where the fourth vanishes it leads.
    pub predicted_sixth: Option<f64>,
    /// Samples left out of the fits, because so much of their energy may be rounding.
    #[serde(default)]
    pub below_rounding: usize,
    /// Whether the fitted coefficient is the predicted one within both errors; null where there is no fit.
    #[serde(default)]
    pub fit_agrees: Option<bool>,
    /// Gaussian curvature `k11 k22 - k12^2` of the mode of a patch; null for waves.
    pub defect: Option<f64>,
}

/// A sample of a landscape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SampleSummary {
    /// Amplitude of the mode.
    pub amplitude: f64,
    /// Energy of the relaxed patch; null where it was not found.
    pub energy: Option<f64>,
    /// Whether so much of the energy may be rounding that it was left out of the fits.
    #[serde(default)]
    pub below_rounding: bool,
    /// Whether it was found.
    pub converged: bool,
}

/// Spatially varying modes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BlochSummary {
    /// `[m, n, c]` of the centred determinant `sum c z1^m z2^n`.
    pub determinant: Vec<[f64; 3]>,
    /// Largest `|c_mn - c_-m,-n|` over the largest coefficient.
    pub symmetry_error: f64,
    /// Largest imaginary part on the zone over the largest magnitude.
    pub imaginary_part: f64,
    /// At every given `q1`.
    pub decay: Vec<DecaySummary>,
    /// Largest `|kappa2 + kappa2'|` of a pair; null where no pair is known well enough to be compared.
    pub pairing_error: Option<f64>,
    /// Largest condition number of the roots of these pairs; null where there are none.
    pub pairing_condition: Option<f64>,
    /// Roots left out of the pairing, whose condition is larger.
    pub ill_conditioned: usize,
    /// Half the difference of the numbers of roots `z1`, `z2` inside and outside the unit circle, averaged.
    pub polarization: [f64; 2],
    /// Mean numbers of roots on the unit circle.
    pub on_circle: [f64; 2],
    /// Part of the zone in which the determinant is positive; null where it is not real.
    pub positive_fraction: Option<f64>,
    /// Number of lines of zeros in the zone; null where the determinant is not real, and none were looked for.
    pub zero_lines: Option<usize>,
    /// The lines.
    pub lines: Vec<ZeroLineSummary>,
    /// Parts of the zone of one sign, the largest first.
    pub regions: Vec<RegionSummary>,
    /// Order to which the determinant vanishes at `q = 0`; null where it is not real.
    pub order_at_origin: Option<usize>,
    /// Angles in the plane of `(q1, q2)` at which zero lines pass `q = 0`.
    pub directions: Vec<f64>,
    /// Rotation angles from a cell to the next of the state that was asked about: wavenumbers of its rotations about
    /// directions across the axis. Null of the drawn state.
    pub theta: Option<[f64; 2]>,
    /// Distance of these wavenumbers from a zero of the determinant, its value there over its gradient; null of the drawn state.
    pub theta_to_zero: Option<f64>,
}

/// Stable states, and the barriers between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WellsSummary {
    /// Random starts.
    pub starts: usize,
    /// Those in which a relaxation failed, however often it was tried.
    pub failed: usize,
    /// Why they failed, the most frequent reason first.
    #[serde(default)]
    pub failures: Vec<FailedStartsSummary>,
    /// Those that ended in an equilibrium which is no minimum.
    pub saddles: usize,
    /// By rising energy.
    pub wells: Vec<WellSummary>,
    /// Those that were asked for.
    pub barriers: Vec<BarrierSummary>,
    /// The same in fold angles alone; null where it was not asked for.
    pub rigid: Option<RigidSummary>,
}

/// Random starts that failed for one reason.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FailedStartsSummary {
    /// The reason.
    pub reason: String,
    /// How many failed for it.
    pub starts: usize,
}

/// A stable state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WellSummary {
    /// Energy.
    pub energy: f64,
    /// How many starts reached it.
    pub reached: usize,
    /// Whether faces pass through each other.
    pub self_intersecting: bool,
    /// Largest unbalanced force over the largest force of any term.
    pub residual_force: f64,
    /// Largest error of a length over the mean edge.
    pub residual_length: f64,
    /// Number of the well of the rigid sheet with these fold angles; null where there is none.
    pub rigid: Option<usize>,
}

/// A barrier that was asked for; null: not found, or not asked for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BarrierSummary {
    /// Between which wells.
    pub between: [usize; 2],
    /// Whether a pass was found: one negative eigenvalue, two different wells on its sides.
    pub confirmed: bool,
    /// The wells into which the sheet descends from the pass.
    pub joins: Option<[usize; 2]>,
    /// Energy of the pass at the sheet's own stiffness; where it is singular in the rigid limit, what the energies at finite stiffness tend to.
    pub energy: Option<f64>,
    /// Stiffness of the bars for which energy and height hold; null: rigid bars, or no pass was found.
    #[serde(default)]
    pub bars: Option<f64>,
    /// Stiffness of the bars in which the path was found that led to the pass.
    #[serde(default)]
    pub path_bars: Option<f64>,
    /// Energy of the pass above that of either of the wells that it joins.
    pub height: Option<[f64; 2]>,
    /// Whether there is no regular pass at the sheet's own stiffness, which is infinite: branches cross there.
    pub singular: bool,
    /// Energies tend to their rigid limit as this power of 1/stiffness; null where they are too few or too close.
    pub exponent: Option<f64>,
    /// Their limit, extrapolated.
    pub limit: Option<f64>,
    /// The lowest pass of the rigid sheet between these wells, in fold angles alone.
    pub rigid: Option<f64>,
    /// Largest scaled residual of the pass.
    pub residual: Option<f64>,
    /// The pass on its way from soft bars.
    pub heights: Vec<HeightSummary>,
    /// Why there is no pass, or none whose energy is known; absent where there is.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "String")]
    pub reason: Option<String>,
}

/// A pass at one stiffness of the bars.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeightSummary {
    /// Stiffness of the bars; null: rigid.
    pub bars: Option<f64>,
    /// Energy of the pass.
    pub energy: f64,
}

/// Wells and passes of a rigid sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RigidSummary {
    /// Dimension of the folded states.
    pub dimension: usize,
    /// How many were sampled.
    pub states: usize,
    /// Energies of the wells.
    pub wells: Vec<f64>,
    /// Energies of states that only the contact of two panels holds, a crease being shut.
    pub contacts: Vec<f64>,
    /// The passes at which lakes around wells meet as the water rises.
    pub passes: Vec<RigidPassSummary>,
    /// Wells and passes of the samples that could not be made exact: the study did not converge where there are any.
    pub lost: usize,
    /// Places beyond which the folded states go on, or may, and were not sampled: likewise.
    #[serde(default)]
    pub open: usize,
}

/// A pass of a rigid sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RigidPassSummary {
    /// The lowest wells on its sides.
    pub joins: [usize; 2],
    /// Energy.
    pub energy: f64,
    /// Whether branches cross there.
    pub singular: bool,
}

/// Roots at one wavenumber.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DecaySummary {
    /// The wavenumber.
    pub q1: f64,
    /// `log|z2|` of every root, ascending.
    pub kappa2: Vec<f64>,
    /// Condition number of every root.
    pub condition: Vec<f64>,
    /// How many roots coincide with every root, itself among them, as far as the rigidity matrix tells.
    pub multiplicity: Vec<usize>,
}

/// A line of zeros of the determinant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ZeroLineSummary {
    /// How often it goes round the zone along both wavenumbers.
    pub winding: [i32; 2],
    /// How often it passes `q = 0`.
    pub passes: usize,
    /// Length in the plane of `(q1, q2)`.
    pub length: f64,
    /// Largest error of a point.
    pub residual: f64,
}

/// A part of the zone in which the determinant has one sign.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RegionSummary {
    /// The sign, +1 or -1.
    #[schemars(schema_with = "schema::sign")]
    pub sign: i8,
    /// Its part of the zone.
    pub fraction: f64,
}

/// The surface of folded states.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SurfaceSummary {
    /// States.
    pub points: usize,
    /// Triangles of states.
    pub triangles: usize,
    /// How the covering ended.
    #[schemars(extend("enum" = ["complete", "open", "given-up", "too-many-points", "interrupted", "no-real-branch"]))]
    pub coverage: String,
    /// Where no surface leaves the drawn state: what establishes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub established: Option<String>,
    /// Of a complete covering: states within the largest curvature beside which triangles are missing, as where two surfaces cross
    /// at a small angle. No state is missing there.
    #[serde(default)]
    pub gaps: usize,
    /// Whether the surface has no border: it closes modulo 2 pi without meeting the largest curvature.
    pub closed: bool,
    /// Whether neighbouring triangles go the same way round everywhere.
    pub oriented: bool,
    /// Spatially periodic states on the surface, once for each nappe that ends there.
    pub tips: usize,
    /// The curvature at which the surface ends.
    pub max_curvature: f64,
    /// Largest radius of a chart in fold angles.
    pub radius: f64,
    /// Largest closure residual; null where there is no state.
    pub max_residual: Option<f64>,
    /// The nappes from which the surface was begun, with the states that were reached from each.
    pub branches: Vec<PieceSummary>,
}

/// The states that were reached from one nappe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PieceSummary {
    /// Number of the branch: the same for nappes opposite each other, and for those on one piece of the surface.
    pub branch: usize,
    /// Sign of the curvature with which it leaves the drawn state.
    #[schemars(schema_with = "schema::sign")]
    pub sign: i8,
    /// States.
    pub points: usize,
}

/// The branches along which exact folding leaves the drawn state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BranchesSummary {
    /// Linear folding motions.
    pub modes: usize,
    /// Independent quadrics that these must satisfy to extend.
    pub quadrics: usize,
    /// Positive, negative and zero eigenvalues of the quadric; null where it is not just one.
    pub signature: Option<[usize; 3]>,
    /// Dimension of the set of solutions: 0 points, 1 a curve, and so on.
    pub dimension: usize,
    /// Isolated complex solutions, with multiplicity; where `dimension` is not 0, those on a random linear space.
    pub complex_solutions: usize,
    /// The same without multiplicity.
    pub distinct: usize,
    /// Bezout's number.
    pub expected: usize,
    /// Ends of paths on curves or more of solutions, where single ones are expected.
    pub on_continua: usize,
    /// Solutions of random combinations that do not satisfy all quadrics.
    pub extraneous: usize,
    /// Real singular points of the set of solutions, where it is a curve or of one quadric, and they are single points;
    /// otherwise null.
    pub singular: Option<usize>,
    /// What is established about the real directions: `listed` (each is one of `rays`), `continuum` (infinitely many, of which only
    /// those that stand alone are in `rays`), `not-established` (others were neither found nor excluded).
    #[schemars(extend("enum" = ["listed", "continuum", "not-established"]))]
    pub directions: String,
    /// Number of isolated real rays, two for each real solution.
    pub real_rays: usize,
    /// The isolated real rays.
    pub rays: Vec<RaySummary>,
}

/// A direction in which folding leaves the drawn state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RaySummary {
    /// Number of the branch, the same for a ray and its opposite.
    pub branch: usize,
    /// 1 for the ray whose first rate beyond 1e-6 is positive, -1 for its opposite.
    #[schemars(schema_with = "schema::sign")]
    pub sign: i8,
    /// Multiplicity of the solution.
    pub multiplicity: usize,
    /// Rates of the fold angles of all edges, of norm 1.
    pub direction: Vec<f64>,
    /// Sign of the curvature, positive towards the face normals, 0 without any; null for a finite sheet.
    #[schemars(extend("minimum" = -1, "maximum" = 1))]
    pub curvature_sign: Option<i8>,
}

impl StudySummary {
    /// The summary of a study that has given no answer yet.
    pub fn unanswered(name: &str, kind: &str) -> Self {
        Self {
            name: name.to_owned(),
            kind: kind.to_owned(),
            converged: false,
            seconds: 0.0,
            error: None,
            reason: None,
            files: None,
            result: None,
        }
    }
}

impl Summary {
    /// Whether every study gave its answer.
    pub fn converged(&self) -> bool {
        self.studies.iter().all(|study| study.converged)
    }

    /// The text of `summary.json`.
    pub fn to_json(&self) -> String {
        to_json(self)
    }

    /// Writes `summary.json`.
    ///
    /// # Errors
    /// [`OutputError::Write`].
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        files::write(path, self.to_json())
    }
}

/// Pretty JSON with a newline at its end.
pub fn to_json(value: &impl Serialize) -> String {
    // the types above have string keys and no own serializers: nothing in them can fail
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn sample() -> Summary {
        let study = |name: &str, kind: &str, result| StudySummary {
            name: name.into(),
            kind: kind.into(),
            converged: true,
            seconds: 0.25,
            error: Some(1e-13),
            reason: None,
            files: None,
            result,
        };
        let relax = RelaxSummary { residual_force: f64::NAN, history: vec![<_>::default()], ..<_>::default() };
        let branches = BranchesSummary { rays: vec![<_>::default()], ..<_>::default() };
        let modes = ModesSummary { gap: Some(f64::INFINITY), eigenvalues: vec![0.1, 1e-300], ..<_>::default() };
        Summary {
            version: "0",
            scene: "scene.toml".into(),
            digest: "0".into(),
            sheet: SheetSummary {
                vertices: 4,
                edges: 12,
                faces: 8,
                polygons: 8,
                developable: false,
                cells: [6, 6],
                degrees_of_freedom: 432,
            },
            terms: vec!["bars".into()],
            left_out: vec!["facets".into()],
            studies: vec![
                study("a", "relax", Some(StudyResult::Relax(relax))),
                study("b", "modes", Some(StudyResult::Modes(modes))),
                study("d", "branches", Some(StudyResult::Branches(branches))),
                StudySummary { converged: false, reason: Some("why".into()), ..study("c", "relax", None) },
            ],
        }
    }

    fn keys(value: &Value) -> Vec<&str> {
        value.as_object().unwrap().keys().map(String::as_str).collect()
    }

    /// The keys that readers of summaries rely on.
    #[test]
    fn the_summary_has_its_keys() {
        let json: Value = serde_json::from_str(&sample().to_json()).unwrap();
        assert_eq!(keys(&json), ["digest", "left_out", "scene", "sheet", "studies", "terms", "version"]);
        let sheet = ["cells", "degrees_of_freedom", "developable", "edges", "faces", "polygons", "vertices"];
        assert_eq!(keys(&json["sheet"]), sheet);
        for key in ["name", "kind", "converged", "seconds", "error", "energy", "iterations", "factorizations"] {
            assert!(json["studies"][0].get(key).is_some(), "{key}");
        }
        for key in ["residual_force", "residual_length", "negative_eigenvalues", "error_to_kinematic", "history"] {
            assert!(json["studies"][0].get(key).is_some(), "{key}");
        }
        for key in ["zero_modes", "self_stresses", "rigid_motions", "folding_modes", "maxwell_count", "gap"] {
            assert!(json["studies"][1].get(key).is_some(), "{key}");
        }
        assert_eq!(keys(&json["studies"][0]["energy"]), ["bars", "creases", "facets", "total"]);
        for key in ["complex_solutions", "distinct", "expected", "real_rays", "rays"] {
            assert!(json["studies"][2].get(key).is_some(), "{key}");
        }
        let ray = ["branch", "curvature_sign", "direction", "multiplicity", "sign"];
        assert_eq!(keys(&json["studies"][2]["rays"][0]), ray);
        assert_eq!(keys(&json["studies"][3]), ["converged", "error", "kind", "name", "reason", "seconds"]);
    }

    /// Not a number and infinity are null; finite numbers read back exactly.
    #[test]
    fn numbers_that_json_lacks_are_null() {
        let json: Value = serde_json::from_str(&sample().to_json()).unwrap();
        assert!(json["studies"][0]["residual_force"].is_null());
        assert!(json["studies"][1]["gap"].is_null());
        assert_eq!(json["studies"][1]["eigenvalues"], json!([0.1, 1e-300]));
    }

    /// A run gave its answer when all its studies did.
    #[test]
    fn one_failed_study_fails_the_run() {
        let mut summary = sample();
        assert!(!summary.converged());
        summary.studies.pop();
        assert!(summary.converged());
    }
}

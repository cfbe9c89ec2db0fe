//! Laws of bars and hinges against closed forms, at every stiffness.

use crate::common::Scene;
use foldwell::analysis::path::{PathEnd, PathOptions, follow_path};
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_all};
use foldwell::model::{
    Assembly, Builder, Drive, Driven, GreenLagrange, Law, Length, Ogden, OwnTerm, Site, Spring, Stiffening,
};
use foldwell::sheet::{EdgeKind, Sheet, fold};
use foldwell::solver::Options;
use foldwell::{Pattern, RIGID, Rest, generate, relax};
use std::f64::consts::PI;

/// Two triangles of sides of length 2 along x, joined there.
fn hinge() -> Sheet {
    let text = r#"{"vertices_coords": [[0, 0, 0], [2, 0, 0], [1, 1.5, 0.1], [1, -1.5, 0.1]],
        "faces_vertices": [[0, 1, 2], [1, 0, 3]]}"#;
    fold::parse(text, "hinge.fold").unwrap()
}

/// A triangle with a force along the bar between its first two vertices, which carries it alone, held so that it cannot
/// turn.
fn pulled(stiffness: f64, force: f64) -> Builder {
    let text = r#"{"vertices_coords": [[0, 0, 0], [2, 0, 0], [1, 1.5, 0]], "faces_vertices": [[0, 1, 2]]}"#;
    let sheet = fold::parse(text, "triangle.fold").unwrap();
    let bars = Assembly::patch(sheet, [1, 1]).bars(stiffness).load(1, [0, 0], [force, 0.0, 0.0]);
    bars.pin(0, [0, 0], [true; 3]).pin(1, [0, 0], [false, true, true]).pin(2, [0, 0], [false, false, true])
}

/// Gives bars a law.
type Given = fn(Builder) -> Builder;
/// The force of a bar by its stretch, over `EA`.
type Force = fn(f64) -> f64;

/// Claim: a bar under a force is stretched as its law says, be it soft or 1e12 times stiffer. Source: the laws, force
/// by stretch, as published. Tolerance: 1e-10 of the force, which is that of the residual; forces are known to 1e-10 of
/// themselves where strains are above 1e-3, and strains to rounding below.
#[test]
fn bars_are_stretched_by_their_law() {
    let forces: [(Given, Force); 3] = [
        (|bars| bars.bar_law(Ogden { exponents: [5.0, 1.0] }), |l| (l.powi(4) - 1.0) / 4.0),
        (|bars| bars.bar_law(Ogden { exponents: [2.0, 0.0] }), |l| (l - 1.0 / l) / 2.0),
        (|bars| bars.bar_law(GreenLagrange), |l| l * (l * l - 1.0) / 2.0),
    ];
    for (law, by_stretch) in forces {
        for (stiffness, force) in [(3.0, 1.0), (3.0, -0.4), (1e3, 20.0), (1e6, -5.0), (1e12, 1.0)] {
            let found = relax(&law(pulled(stiffness, force)).build().unwrap()).unwrap().state;
            let bar = (0..3).max_by(|a, b| found.strain[*a].abs().total_cmp(&found.strain[*b].abs())).unwrap();
            let expected = stiffness * by_stretch(1.0 + found.strain[bar]);
            let known = 1e-10 * force.abs() + 4.0 * f64::EPSILON * stiffness;
            assert!(
                (expected - force).abs() <= known,
                "EA {stiffness:e}, force {force}: {expected} of {}",
                found.strain[bar]
            );
            assert!((found.tension[bar] - force).abs() <= 1e-9 * force.abs(), "{}", found.tension[bar]);
        }
    }
}

/// Claim: a stiffening hinge that rests beyond its limit stops where its torque vanishes, short of the full fold, be it
/// soft or carry a tension; its energy is that of its law. Source: the torque
/// `m1 - rest + (2 s / pi) tan(pi (m - m1) / (2 s))`. Tolerance: that of the residual, 1e-10 of the largest torque.
#[test]
fn hinges_do_not_fold_through() {
    let law = Stiffening { limits: [-1.0, 1.0] };
    let unit = (PI - 1.0) / (0.5 * PI);
    for rest in [1.5, 3.0, 6.0, -4.0f64] {
        let expected = (1.0 + unit * ((rest.abs() - 1.0) / unit).atan()).copysign(rest);
        for (bars, creases) in [(RIGID, 1.0), (1e3, 1.0), (1.0, 1e5)] {
            let hinge = Assembly::patch(hinge(), [1, 1]).bars(bars).creases(creases).rest(Rest::Angle(rest));
            let assembly = hinge.crease_law(law).build().unwrap();
            let state = relax(&assembly).unwrap_or_else(|e| panic!("{rest} {bars} {creases}: {e}")).state;
            let edge = assembly.tiling().edges.iter().position(|edge| edge.kind == EdgeKind::Crease).unwrap();
            let angle = state.fold_angle[edge];
            assert!(
                (angle - expected).abs() <= 1e-9,
                "rest {rest}, bars {bars}, creases {creases}: {angle}, not {expected}"
            );
            let energy = 2.0 * creases * law.at(angle, rest)[0];
            assert!((state.energy_creases - energy).abs() <= 1e-9 * energy, "{} not {energy}", state.energy_creases);
        }
    }
}

/// Claim: a rigid element cannot have a law, which would be left out without a word.
#[test]
#[should_panic(expected = "a rigid element has no law")]
fn rigid_elements_have_no_law() {
    let ends = [0, 1].map(|vertex| Site { vertex, shift: [0, 0] });
    OwnTerm::with_law("rod", Length, [(ends, Spring { stiffness: RIGID, rest: 1.0 })], GreenLagrange);
}

/// Claim: on a path of rest angles the work of the drive is the energy, with laws too: the derivatives by rest values
/// are those of the energy. Tolerance: that of the integral of the work over steps of 0.02, 1e-9.
#[test]
fn rest_angles_do_work_against_laws() {
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let drawn = Assembly::patch(sheet.clone(), [2, 2]).build().unwrap().drawn_angles_or_zero();
    let largest = drawn.iter().fold(0.0f64, |largest, angle| largest.max(angle.abs()));
    let rest: Vec<f64> =
        (0..).zip(&drawn).map(|(k, angle)| angle + 1.5 * ((f64::from(k) * 0.618).fract() - 0.5)).collect();
    for (bars, creases) in [(1e3, 1.0), (1e6, 1e5)] {
        let energy = Assembly::patch(sheet.clone(), [2, 2]).bars(bars).creases(creases).facets(3.0);
        let energy = energy.rest(Rest::PerEdge(rest.clone())).bar_law(GreenLagrange);
        let laws = energy.crease_law(Stiffening { limits: [-1.05 * largest, 1.05 * largest] });
        let drive = Drive { quantity: Driven::Rest, to: 1.0 };
        let options = PathOptions { max_step: 0.02, ..PathOptions::default() };
        let found = follow_path(&laws.build().unwrap(), &drive, None, &options, &mut |_, _| true).unwrap();
        let branch = &found[0];
        assert!(branch.end == PathEnd::Arrived, "creases {creases}: {:?}", branch.end);
        let last = branch.points.last().unwrap();
        let (energy, work) = (last.state.total(), last.work);
        assert!(
            energy > 0.01 * creases && (energy - work).abs() <= 1e-9 * energy,
            "creases {creases}: {energy} {work}"
        );
    }
}

/// Returns a scene with laws, with these studies.
fn scene(law: &str, studies: &str) -> Scene {
    Scene::new(format!(
        "[sheet]\ngenerate = {{ pattern = \"miura\", fold = 0.4 }}\ncells = [2, 2]\n[energy]\n\
         bars = {{ stiffness = 1e3, law = {{ kind = \"ogden\", exponents = [5.0, 1.0] }} }}\n\
         creases = {{ stiffness = 1.0, rest = \"assigned\", law = {{ {law} }} }}\nfacets = {{ stiffness = 10.0 }}\n{studies}"
    ))
}

/// Claim: a scene with laws that rests folded flat is relaxed, starts again from its file where it is, is driven by its
/// rest angles to an equilibrium, and its wells are found, none of which folds through. Source: the restart and the
/// path, which go there by other ways. Tolerance: that of relaxations.
#[test]
fn scenes_have_laws() {
    let studies = "[[drive]]\nname = \"fold\"\nrest = true\nto = 1.0\n[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n\
        [[study]]\nname = \"again\"\nkind = \"relax\"\nstart = \"relaxed\"\n\
        [[study]]\nname = \"path\"\nkind = \"path\"\ndrive = \"fold\"\n\
        [[study]]\nname = \"wells\"\nkind = \"wells\"\nstarts = 8\n";
    let limits = "kind = \"stiffening\", limits = [-2.5, \"140 deg\"]";
    let ran = scene(limits, studies).converged();
    let [first, again] =
        ["relaxed", "again"].map(|name| (ran.relaxed(name).energy.total, ran.relaxed(name).iterations));
    assert!((first.0 - again.0).abs() <= 1e-10 * first.0 && again.1 == 0, "{first:?} {again:?}");
}

/// Claim: what needs springs says so by the name of the term, and a law that is none is refused.
#[test]
fn laws_are_refused_by_name() {
    let limits = "kind = \"stiffening\", limits = [-2.5, 2.5]";
    for (law, study, said) in [
        (limits, "kind = \"landscape\"\nmodes = [[1.0, 0.0, 0.0]]\namplitudes = [0.1]", "here is another: bars"),
        (limits, "kind = \"wells\"\nbarriers = [[0, 1]]", "here is another: bars"),
        ("kind = \"stiffening\", limits = [0.5, 2.5]", "kind = \"relax\"", "the limits are 0.5 and 2.5 rad"),
        ("kind = \"stiff\"", "kind = \"relax\"", "unknown word `stiff`"),
    ] {
        scene(law, &format!("[[study]]\nname = \"a\"\n{study}\n")).refused(said);
    }
}

/// Claim: a spring between two vertices of a sheet that is rigid but for its creases pulls them together until its
/// force balances the torques: energy is lowest there, is listed by the name of the term in summary and table, and a
/// rigid one keeps their distance. Source: the states that are nearby on the one way in which the patch folds, whose
/// energies the path in the rest length gives. Tolerance: that of relaxations.
#[test]
fn springs_between_vertices() {
    let scene = |spring: &str| {
        Scene::new(format!(
            "[sheet]\ngenerate = {{ pattern = \"miura\", fold = 0.4 }}\ncells = [2, 2]\n\
             [energy]\nbars = {{ stiffness = inf }}\ncreases = {{ stiffness = 1.0 }}\n{spring}\n\
             [[study]]\nname = \"relaxed\"\nkind = \"relax\"\ndraw = []\n"
        ))
    };
    let spring = |stiffness: &str, rest: f64| {
        format!("[[spring]]\nvertices = [[0, 0, 0], [0, 1, 1]]\nstiffness = {stiffness}\nrest = {rest}")
    };
    let ran = scene(&spring("2.0", 1.0)).ran();
    let energy = &ran.relaxed("relaxed").energy;
    let springs = energy.others["springs"].unwrap();
    assert!(springs > 0.0 && (energy.creases.unwrap() + springs - energy.total).abs() <= 1e-15);
    let table = ran.out.table("relaxed.csv");
    assert_eq!(table.header[table.place("energy_springs") + 1], "energy_total");
    assert_eq!(table.last("energy_springs"), springs);
    // at the distance d that it has reached a rigid spring gives the same creases; a little off it the sum is larger
    let reached = 1.0 + springs.sqrt();
    let at = |distance: f64| {
        let ran = scene(&spring("inf", distance)).ran();
        let energy = &ran.relaxed("relaxed").energy;
        assert_eq!(energy.others["springs"], Some(0.0));
        energy.creases.unwrap() + (distance - 1.0).powi(2)
    };
    let [below, there, above] = [-1e-3, 0.0, 1e-3].map(|off| at(reached + off));
    assert!((there - energy.total).abs() <= 1e-10 && below > there && above > there, "{below} {there} {above}");
    for (wrong, said) in [
        ("[[spring]]\nvertices = [0, 1, 2]\nstiffness = 1.0", "a spring is between two vertices"),
        ("[[spring]]\nvertices = [0, [0, 2, 0]]\nstiffness = 1.0", "there is no cell [2, 0]"),
        ("[[spring]]\nvertices = [0, 1]\nstiffness = -1.0", "the stiffness is -1"),
    ] {
        scene(wrong).refused(said);
    }
}

/// Claim: the energy of a well is that of all its terms: bars and creases with a law, and a term of one's own, soft or
/// stiff. Source: the energies by term of the well's state. Tolerance: rounding of sums in another order.
#[test]
fn wells_have_the_energy_of_all_terms() {
    let miura = || {
        let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
        Assembly::patch(sheet, [2, 2]).bars(1e3).creases(1.0).rest(Rest::Assigned(0.6))
    };
    let plain = miura().build().unwrap();
    let ends = [0, 3 * plain.sheet().vertices.len()].map(|vertex| Site { vertex, shift: [0, 0] });
    let band =
        |stiffness: f64| plain.with_own_term(OwnTerm::new("band", Length, [(ends, Spring { stiffness, rest: 1.0 })]));
    let of_bars = miura().bar_law(GreenLagrange).build().unwrap();
    let of_creases = miura().crease_law(Stiffening { limits: [-3.0, 3.0] }).build().unwrap();
    for assembly in [band(2.0), band(1e9), of_bars, of_creases, plain] {
        let starts = Starts { count: 2, seed: 0, spread: 0.1, options: Options::default() };
        for end in relax_all(&assembly, &starts, &|| true) {
            let Outcome::Well(well) = end else { continue };
            let total = well.relaxed.state.total();
            assert!(total > 1e-3 && (well.energy - total).abs() <= 1e-12 * total, "{} {total}", well.energy);
        }
    }
}

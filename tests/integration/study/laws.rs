//! Laws of bars and hinges against closed forms, at every stiffness.

use crate::common::Scene;
use foldwell::analysis::path::{PathEnd, PathOptions, follow_path};
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::model::{
    Assembly, AssemblyError, Bilinear, Builder, Drive, Driven, Formula, GreenLagrange, Law, Length, Measured, OfAngle,
    OfStrain, Ogden, OwnTerm, Power, Site, Spring, Stiffening,
};
use foldwell::sheet::generate::Random;
use foldwell::sheet::{EdgeKind, Sheet, fold};
use foldwell::solver::Options;
use foldwell::{Pattern, RIGID, Rest, generate, relax};
use nalgebra::Vector3;
use std::f64::consts::PI;

type Vec3 = Vector3<f64>;

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

/// Claim: a bar under a force is stretched as its law says, be it soft or 1e12 times stiffer, and a stiff one stores the
/// energy of a spring. Source: the laws, force by stretch, as published. Tolerance: 1e-10 of the force, which is that of the residual; forces are known to 1e-10 of
/// themselves where strains are above 1e-3, and strains to rounding below.
#[test]
fn bars_are_stretched_by_their_law() {
    let forces: [(Given, Force); 6] = [
        (|bars| bars.bar_law(Formula::of_length("k*m*((m/m0)^2 - 1)/2").unwrap()), |l| l * (l * l - 1.0) / 2.0),
        (|bars| bars.bar_law(Formula::of_length("k*m0*ln(m/m0)").unwrap()), |l| l.ln()),
        (
            |bars| bars.bar_law(OfStrain(Bilinear { ratio: 0.5, at: [-0.01, 0.1] })),
            |l| (l - 1.0).clamp(-0.01, 0.1) + 0.5 * ((l - 1.1).max(0.0) + (l - 0.99).min(0.0)),
        ),
        (|bars| bars.bar_law(OfStrain(Ogden { exponents: [5.0, 1.0] })), |l| (l.powi(4) - 1.0) / 4.0),
        (|bars| bars.bar_law(OfStrain(Ogden { exponents: [2.0, 0.0] })), |l| (l - 1.0 / l) / 2.0),
        (|bars| bars.bar_law(OfStrain(GreenLagrange)), |l| l * (l * l - 1.0) / 2.0),
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
            // of the length 2, a spring but for its strain
            let energy = force * force / stiffness;
            let off = (found.energy_bars / energy - 1.0).abs();
            assert!(stiffness < 1e6 || off <= 5.0 * force.abs() / stiffness + 1e-9, "EA {stiffness:e}: {off:e}");
        }
    }
}

/// Claim: rigid bars of a law that has no force on one side of rest are refused, in a scene at the law, since a rigid cable
/// would push; beside them soft ones, and rigid bars of laws with forces on both sides, are not.
#[test]
fn rigid_cables_are_refused() {
    let built = |stiffness: f64, ratio| {
        let law = OfStrain(Bilinear { ratio, at: [0.0, f64::INFINITY] });
        Assembly::patch(hinge(), [1, 1]).bars(stiffness).bar_law(law).build().map(|_| ())
    };
    assert_eq!(built(RIGID, 0.0), Err(AssemblyError::RigidSlack { term: "bars" }));
    assert_eq!((built(RIGID, 0.1), built(1e12, 0.0)), (Ok(()), Ok(())));
    let scene = |creases: &str| {
        let energy = format!("[energy]\nbars = {{ stiffness = 1e3 }}\ncreases = {{ {creases} }}\n");
        let study = "[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n";
        Scene::on("generate = { pattern = \"miura\", fold = 0.4 }\ncells = [2, 2]", &(energy + study))
    };
    let slack = "{ kind = \"bilinear\", ratio = 0.0, at = [0.0, inf] }";
    scene(&format!("stiffness = {{ M = 1.0, V = inf }}, law = {slack}")).refused("what is rigid would be slack");
    scene(&format!("stiffness = {{ M = 1.0, V = inf }}, law = {{ M = {slack} }}")).converged();
    let energy = |law: &str| scene(&format!("stiffness = 1.0, rest = 0.5{law}")).converged();
    let total = |law: &str| energy(law).relaxed("relaxed").energy.total;
    assert_eq!(total(", law = { kind = \"linear\" }"), total(""));
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

/// Claim: a hinge whose wings a spring pulls together rests where the torque of its law, a formula, a power, two
/// stiffnesses or measured points, balances the spring, be it soft or stiff. Source: virtual work of a turn about the
/// crease; the torques in closed form. Tolerance: 1e-9, ten times that of the residual.
#[test]
fn hinges_have_the_torque_of_their_law() {
    let measured =
        Measured::new(&[[-2.0, -1.5], [-0.5, -1.0], [0.0, 0.0], [0.4, 1.0], [1.0, 0.8], [2.0, 3.0]]).unwrap();
    type Case = (Box<dyn Fn(Builder) -> Builder>, Box<dyn Fn(f64) -> f64>);
    let laws: [Case; 4] = [
        (
            Box::new(|hinges| hinges.crease_law(Formula::of_angle("k*sinh(3*(m - m0))/3").unwrap())),
            Box::new(|off| (3.0 * off).sinh() / 3.0),
        ),
        (
            Box::new(|hinges| hinges.crease_law(OfAngle(Power { exponent: 1.5 }))),
            Box::new(|off| off * off.abs().sqrt()),
        ),
        (
            Box::new(|hinges| hinges.crease_law(OfAngle(Bilinear { ratio: 0.1, at: [-0.2, 0.2] }))),
            Box::new(|off| off.clamp(-0.2, 0.2) * 0.9 + 0.1 * off),
        ),
        (
            Box::new({
                let measured = measured.clone();
                move |hinges| hinges.crease_law(OfAngle(measured.clone()))
            }),
            // harmonic means of the slopes on both sides: 2.5 and 2 at rest, 0 at the point where the torque turns
            Box::new(|off| {
                let rest = 3.0 * 0.9 / ((0.8 + 0.5) / 2.0 + (0.4 + 1.0) / 2.5);
                let t = off / 0.4;
                assert!((0.0..=1.0).contains(&t));
                ((t * (1.0 - t).powi(2)) * 0.4 * rest + t * t * (3.0 - 2.0 * t)) / rest
            }),
        ),
    ];
    for (law, torque) in laws {
        for (bars, creases) in [(RIGID, 1.0), (1e3, 1.0), (1.0, 1e5)] {
            let hinge = Assembly::patch(hinge(), [1, 1]).bars(bars).creases(creases).rest(Rest::Angle(0.3));
            let plain = law(hinge).build().unwrap();
            // a spring between the wings, shorter at rest than they are apart, folds the hinge
            let ends = [2, 3].map(|vertex| Site { vertex, shift: [0, 0] });
            let pull = Spring { stiffness: 2.0 * creases.min(bars), rest: 2.0 };
            let state = relax(&plain.with_own_term(OwnTerm::new("pull", Length, [(ends, pull)]))).unwrap().state;
            let edge = plain.tiling().edges.iter().position(|edge| edge.kind == EdgeKind::Crease).unwrap();
            let angle = state.fold_angle[edge];
            let place = |k: usize| Vec3::from_column_slice(&state.coordinates[3 * k..3 * k + 3]);
            let [wings, width] = [[2, 3].map(place), [0, 1].map(place)];
            let across = wings[0] - wings[1];
            // virtual work of a turn about the crease: how fast the wings come closer
            let axis = (width[1] - width[0]).normalize();
            let [a, b] = wings.map(|wing| {
                let arm = wing - width[0];
                (arm - arm.dot(&axis) * axis).norm()
            });
            let opening = a * b * (PI - angle).sin() / across.norm();
            let found = 2.0 * torque(angle - 0.3);
            let expected = pull.stiffness / creases * (across.norm() - pull.rest) * opening;
            assert!(
                (found - expected).abs() <= 1e-9 * expected.abs().max(0.1),
                "bars {bars}, creases {creases}, off rest {}: {found} {expected}",
                angle - 0.3
            );
        }
    }
}

/// Claim: a rigid element cannot have a law, which would be left out without a word.
#[test]
#[should_panic(expected = "a rigid element has no law")]
fn rigid_elements_have_no_law() {
    let ends = [0, 1].map(|vertex| Site { vertex, shift: [0, 0] });
    OwnTerm::with_law("rod", Length, [(ends, Spring { stiffness: RIGID, rest: 1.0 })], OfStrain(GreenLagrange));
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
        let energy = energy.rest(Rest::PerEdge(rest.clone())).bar_law(OfStrain(GreenLagrange));
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

/// Claim: so it is with curves and formulas of bars and creases.
#[test]
fn rest_angles_do_work_against_curves() {
    let curve = || Measured::new(&[[-2.0, -1.5], [-0.5, -1.0], [0.0, 0.0], [0.4, 1.0], [2.0, 1.5]]).unwrap();
    let strains = Measured::new(&[[-0.1, -0.2], [0.0, 0.0], [0.1, 0.1]]).unwrap();
    type Case = (&'static str, Box<dyn Fn(Builder) -> Builder>);
    let laws: [Case; 3] = [
        ("curves", Box::new(move |given| given.bar_law(OfStrain(strains.clone())).crease_law(OfAngle(curve())))),
        ("power", Box::new(|given| given.crease_law(OfAngle(Power { exponent: 1.5 })))),
        (
            "formulas",
            Box::new(|given| {
                let bars = given.bar_law(Formula::of_length("k*m0*ln(m/m0)").unwrap());
                bars.crease_law(Formula::of_angle("k*(m - m0)*(1 + 0.2*m0^2)/(1 + 0.2*m^2)").unwrap())
            }),
        ),
    ];
    for (name, law) in laws {
        let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
        let given = Assembly::patch(sheet, [2, 2]).bars(1e3).creases(1.0).facets(3.0).rest(Rest::Assigned(0.3));
        let drive = Drive { quantity: Driven::Rest, to: 1.0 };
        let options = PathOptions { max_step: 0.02, ..PathOptions::default() };
        let found = follow_path(&law(given).build().unwrap(), &drive, None, &options, &mut |_, _| true).unwrap();
        let branch = &found[0];
        assert!(branch.end == PathEnd::Arrived, "{name}: {:?}", branch.end);
        let last = branch.points.last().unwrap();
        let (energy, work) = (last.state.total(), last.work);
        assert!(energy > 0.01 && (energy - work).abs() <= 1e-7 * energy, "{name}: {energy} {work}");
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
        ("kind = \"power\", exponent = 0.5", "kind = \"relax\"", "the exponent is 0.5"),
        ("kind = \"bilinear\", ratio = -0.1, at = 0.2", "kind = \"relax\"", "the ratio is -0.1"),
        ("kind = \"bilinear\", ratio = 0.1, at = [0.1, 0.2]", "kind = \"relax\"", "changes at 0.1 and 0.2 off rest"),
        ("kind = \"table\", points = [[0, 0], [1, 1], [1, 2]]", "kind = \"relax\"", "point 2 is at 1.0"),
        ("kind = \"table\"", "kind = \"relax\"", "has no curve"),
        ("kind = \"formula\", torque = \"2*k*(m - m0)\"", "kind = \"relax\"", "with the slope 2"),
        ("kind = \"formula\", torque = \"k*sin(m - rest)\"", "kind = \"relax\"", "`rest` at character 11"),
    ] {
        scene(law, &format!("[[study]]\nname = \"a\"\n{study}\n")).refused(said);
    }
}

/// Claim: a scene has the same states with the points of a curve in a file or in the scene, with or without the
/// stiffness that is the slope at rest, and with a formula or two stiffnesses that are the same torque; twice the
/// stiffness is twice the energy. Source: each other. Tolerance: rounding errors; that of relaxations for the last.
#[test]
fn curves_come_from_files_and_scenes() {
    let energy = |given: &str, bars: &str| {
        let text = format!(
            "[sheet]\ngenerate = {{ pattern = \"miura\", fold = 0.4 }}\ncells = [2, 2]\n[energy]\n\
             bars = {{ stiffness = {bars} }}\ncreases = {{ rest = \"assigned\", fraction = 0.4, {given} }}\n\
             [[study]]\nname = \"relaxed\"\nkind = \"relax\"\n"
        );
        let file = "angle,torque\n-2.0,-2.0\n\n-1.0, -1.0\n0,0\n1.0,1.0\n2.0,2.0\n";
        Scene::new(text).with("torque.csv", file).converged().relaxed("relaxed").energy.total
    };
    let points = "points = [[-2, -2], [-1, -1], [0, 0], [1, 1], [2, 2]]";
    let linear = energy("stiffness = 1.0", "1e3");
    for law in [
        "law = { kind = \"table\", file = \"torque.csv\" }".to_owned(),
        format!("law = {{ kind = \"table\", {points} }}"),
        format!("stiffness = 1.0, law = {{ kind = \"table\", {points} }}"),
        "stiffness = 1.0, law = { kind = \"bilinear\", ratio = 1.0, at = 0.1 }".into(),
        "stiffness = 1.0, law = { kind = \"power\", exponent = 1 }".into(),
        "stiffness = 1.0, law = { kind = \"formula\", torque = \"k*(m - m0)\" }".into(),
    ] {
        let found = energy(&law, "1e3");
        assert!((found - linear).abs() <= 1e-10 * linear, "{law}: {found}, {linear} with springs");
        if law.contains("stiffness = 1.0") {
            let twice = energy(&law.replace("stiffness = 1.0", "stiffness = 2.0"), "2e3");
            assert!((twice - 2.0 * found).abs() <= 1e-9 * found, "{law}: {twice} is not twice {found}");
        }
    }
    Scene::new(
        "sheet = { generate = { pattern = \"miura\" } }\n[energy]\nbars = { stiffness = 1e3 }\n\
         creases = { law = { kind = \"table\", file = \"torque.csv\" } }\n[[study]]\nname = \"a\"\nkind = \"relax\"\n",
    )
    .with("torque.csv", "angle,torque\n-1,-1\n0,0\n\n0,1\n")
    .refused("torque.csv:5: point 2 is at 0.0");
}

/// Claim: a law that has no stiffness at rest has no moduli there, which are refused by its name; ratios of rigid
/// foldings do not need it, and a law that is a spring at rest has the moduli of that spring.
#[test]
fn moduli_need_a_stiffness_at_rest() {
    let found = |law: &str| {
        let scene = Scene::new(format!(
            "[sheet]\ngenerate = {{ pattern = \"miura\" }}\ndomain = \"torus\"\ncells = [1, 1]\n[energy]\n\
             bars = {{ stiffness = 1e3 }}\ncreases = {{ stiffness = 1.0{law} }}\nfacets = {{ stiffness = 10.0 }}\n\
             [[study]]\nname = \"a\"\nkind = \"response\"\n"
        ));
        let ran = scene.converged();
        let response = ran.response("a");
        (response.moduli.is_some(), response.no_moduli.clone().unwrap_or_default(), ran.json()[0]["moduli"].clone())
    };
    let (any, reason, _) = found(", law = { kind = \"power\", exponent = 1.5 }");
    assert!(!any && reason.contains("the law of the creases has another stiffness"), "{reason}");
    let (spring, law) = (found(""), found(", law = { kind = \"bilinear\", ratio = 2, at = 0.1 }"));
    assert!(spring.0 && !spring.2.is_null());
    assert_eq!(spring, law);
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
    let of_bars = miura().bar_law(OfStrain(GreenLagrange)).build().unwrap();
    let of_creases = miura().crease_law(Stiffening { limits: [-3.0, 3.0] }).build().unwrap();
    for assembly in [band(2.0), band(1e9), of_bars, of_creases, plain] {
        let starts = Starts { count: 2, seed: 0, spread: 0.1, options: Options::default() };
        for end in relax_around(&assembly, None, &starts, &|| true) {
            let Outcome::Well(well) = end else { continue };
            let total = well.relaxed.state.total();
            assert!(total > 1e-3 && (well.energy - total).abs() <= 1e-12 * total, "{} {total}", well.energy);
        }
    }
}

/// Claim: creases without stiffness at rest unfold a Miura-ori and relax a random sheet, for every power and stiffness of
/// the bars. Steps shrink by a constant factor at worst, `1 - 1/p` of the angles left, so that 1e-10 of a force takes
/// some `10 ln 10 / (p ln(p / (p - 1)))` of them, 12 to 19. Tolerance: five times that, where rigid bars nearly depend
/// on each other in the flat sheet. With the stiffness of a spring in the shift 200 were not enough.
#[test]
fn powers_converge() {
    for exponent in [4.0 / 3.0, 1.5, 2.0, 3.0] {
        for bars in [1e2, 1e6, RIGID] {
            for name in ["miura", "random"] {
                let sheet = generate(&Pattern::named(name).unwrap()).unwrap();
                let hinges = Assembly::patch(sheet, [3, 3]).bars(bars).creases(1.0).rest(Rest::Flat).facets(10.0);
                let assembly = hinges.crease_law(OfAngle(Power { exponent })).build().unwrap();
                let found = relax(&assembly).unwrap();
                assert!(found.iterations <= 100, "{name} {exponent} {bars}: {} iterations", found.iterations);
                assert!(name == "random" || found.state.total() < 1e-13, "{}", found.state.total());
            }
        }
    }
}

/// Claim: sheets of creases without stiffness at rest are minima where they are drawn, at rest: the energy is never
/// negative. Rounding errors of tensions, beside which nothing is stiff there, are no negative eigenvalues.
#[test]
fn powers_are_stable_at_rest() {
    for exponent in [4.0 / 3.0, 1.5, 2.0, 3.0] {
        for seed in 0..12 {
            let sheet = generate(&Pattern::Random(Random { seed, ..Random::default() })).unwrap();
            let hinges = Assembly::patch(sheet, [3, 3]).bars(50.0).creases(1.0).rest(Rest::Drawn);
            let assembly = hinges.crease_law(OfAngle(Power { exponent })).build().unwrap();
            let found = relax(&assembly).unwrap();
            assert!(found.negative_eigenvalues == Some(0) && found.state.total() < 1e-24, "{exponent} {seed}");
        }
    }
}

/// Claim: a path goes on where creases come to the limit of one of their two stiffnesses, for every step, to the same
/// state. Tolerance: rounding.
#[test]
fn paths_pass_kinks() {
    let sheet = fold::parse(include_str!("../../cases/kink.fold"), "kink.fold").unwrap();
    let hinges = Assembly::patch(sheet, [1, 1]).bars(20.0).creases(1.0);
    let hinges = hinges.crease_law(OfAngle(Bilinear { ratio: 0.3, at: [-0.3, 0.3] }));
    let corners = [0, 2, 6, 8].into_iter();
    let assembly = corners.fold(hinges, |hinges, at| hinges.pin(at, [0, 0], [true; 3])).build().unwrap();
    let drive = Drive { quantity: Driven::Vertices { vertices: vec![4], direction: Vec3::z() }, to: -0.8 };
    let ends = [0.05, 0.02, 0.005].map(|max_step| {
        let options = PathOptions { max_step, ..PathOptions::default() };
        let branches = follow_path(&assembly, &drive, None, &options, &mut |_, _| true).unwrap();
        assert_eq!(branches[0].end, PathEnd::Arrived, "{max_step}");
        branches[0].points.last().unwrap().state.total()
    });
    assert!(ends.iter().all(|end| (end - ends[0]).abs() <= 1e-9 * ends[0]), "{ends:?}");
}

/// Claim: paths lead from the drawn state, where hinges that bend by a power have no stiffness, to all rest angles: to the
/// state that a relaxation finds. Tolerance: 1e-9 of its energy, as residuals are 1e-12; a yoshimura folds without any.
#[test]
fn powers_follow_their_rest_angles() {
    let third = 4.0 / 3.0;
    let all = [
        ("miura", 1e3, third, 1.0),
        ("miura", 1e3, 1.0, third),
        ("miura", 1e3, third, third),
        ("miura", 1e3, 2.0, 1.0),
        ("miura", 1e3, 3.0, 1.0),
        ("eggbox", 1e2, third, third),
        ("eggbox", RIGID, 1.0, third),
        ("yoshimura", 1e2, third, 1.0),
    ];
    for (pattern, bars, of_creases, of_facets) in all {
        let sheet = generate(&Pattern::named(pattern).unwrap()).unwrap();
        let hinges = Assembly::patch(sheet, [2, 2]).bars(bars).creases(1.0).rest(Rest::Angle(0.9)).facets(3.0);
        let [creases, facets] = [of_creases, of_facets].map(|exponent| OfAngle(Power { exponent }));
        let assembly = hinges.crease_law(creases).facet_law(facets).build().unwrap();
        let drive = Drive { quantity: Driven::Rest, to: 1.0 };
        let branches = follow_path(&assembly, &drive, None, &PathOptions::default(), &mut |_, _| true).unwrap();
        let what = format!("{pattern} {of_creases} {of_facets}");
        assert_eq!(branches[0].end, PathEnd::Arrived, "{what}");
        let (found, relaxed) = (branches[0].points.last().unwrap(), relax(&assembly).unwrap().state.total());
        assert!(found.negative_eigenvalues == Some(0) && branches[0].points.len() < 200, "{what}");
        assert!((found.state.total() - relaxed).abs() < 1e-9 * relaxed + 1e-20, "{what}: {relaxed}");
    }
}

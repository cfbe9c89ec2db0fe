//! Laws by the letters of edges, and of single elements.

use crate::common::Scene;
use foldwell::model::{Assembly, Bilinear, Law, OfAngle, Stiffening};
use foldwell::sheet::{Assignment, EdgeKey, EdgeKind};
use foldwell::{Pattern, Rest, generate, relax};
use std::sync::Arc;

const STIFFENING: &str = "{ kind = \"stiffening\", limits = [-1.2, 1.0] }";
const BILINEAR: &str = "{ kind = \"bilinear\", ratio = 3.0, at = [-0.2, 0.1] }";
const SPRING: &str = "{ kind = \"table\", points = [[-1, -1], [0, 0], [1, 1]] }";

/// A patch of Miura-ori with these keys of its creases.
fn scene(creases: &str) -> Scene {
    Scene::new(format!(
        "[sheet]\ngenerate = {{ pattern = \"miura\", fold = 0.4 }}\ncells = [2, 2]\n\
         [energy]\nbars = {{ stiffness = 1e3 }}\n\
         creases = {{ rest = \"assigned\", fraction = 0.6, {creases} }}\nfacets = {{ stiffness = 10.0 }}\n\
         [[study]]\nname = \"relaxed\"\nkind = \"relax\"\n"
    ))
}

fn energy(creases: &str) -> f64 {
    scene(creases).converged().relaxed("relaxed").energy.total
}

/// Claim: mountains and valleys have their own laws, and creases of letters without law are springs, also those that
/// are rigid. Source: the laws of single creases of the library; the same law for both letters is that of all; a curve
/// that is a straight line is a spring. Tolerance: that of relaxations.
#[test]
fn mountains_and_valleys_have_their_own_laws() {
    let near = |found: f64, expected: f64| assert!((found - expected).abs() <= 1e-9 * expected, "{found} {expected}");
    let of_mountains = energy(&format!("stiffness = 1.0, law = {{ M = {STIFFENING} }}"));
    near(of_mountains, energy(&format!("stiffness = 1.0, law = {{ V = {SPRING}, M = {STIFFENING} }}")));
    let of_both = energy(&format!("stiffness = 1.0, law = {{ M = {STIFFENING}, V = {BILINEAR} }}"));
    assert!((of_both - of_mountains).abs() > 1e-3 * of_both, "{of_both} {of_mountains}");
    let same = energy(&format!("stiffness = 1.0, law = {{ M = {BILINEAR}, V = {BILINEAR} }}"));
    near(same, energy(&format!("stiffness = 1.0, law = {BILINEAR}")));
    // rigid creases have no law
    let held = |law: &str| energy(&format!("stiffness = {{ M = 1.0, V = inf }}, law = {law}"));
    near(held(&format!("{{ M = {STIFFENING}, V = {BILINEAR} }}")), held(&format!("{{ M = {STIFFENING} }}")));

    let mut pattern = Pattern::named("miura").unwrap();
    if let Pattern::Miura(miura) = &mut pattern {
        miura.fold = 0.4;
    }
    let folded = generate(&pattern).unwrap();
    let plain = Assembly::patch(folded.clone(), [2, 2]).build().unwrap();
    let law = |edge: usize| -> Option<Arc<dyn Law>> {
        let edge = &plain.sheet().edges[edge];
        match plain.sheet().assignment(edge) {
            Assignment::Mountain if edge.kind == EdgeKind::Crease => Some(Arc::new(Stiffening { limits: [-1.2, 1.0] })),
            Assignment::Valley => Some(Arc::new(OfAngle(Bilinear { ratio: 3.0, at: [-0.2, 0.1] }))),
            _ => None,
        }
    };
    let laws: Vec<_> = plain.tiling().edges.iter().map(|tiled| law(tiled.edge)).collect();
    let builder = Assembly::patch(folded, [2, 2]).bars(1e3).creases(1.0).facets(10.0).rest(Rest::Assigned(0.6));
    near(relax(&builder.crease_law(laws).build().unwrap()).unwrap().state.total(), of_both);
}

/// Claim: laws of single creases by a table are those by letters where it says the same, 0 is a spring, and numbers that no
/// law has are refused with their line. Source: the laws by letters. Tolerance: that of relaxations.
#[test]
fn single_creases_have_their_own_laws() {
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let table = |number: &dyn Fn(Assignment) -> &'static str| {
        let rows = sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease).map(|edge| {
            let EdgeKey { i, j, shift: [n1, n2], .. } = edge.key;
            format!("{i},{j},{n1},{n2},{}\n", number(sheet.assignment(edge)))
        });
        format!("i,j,n1,n2,law\n{}", rows.collect::<String>())
    };
    let law = format!("stiffness = 1.0, law = {{ each = {{ file = \"laws.csv\" }}, of = [{STIFFENING}, {BILINEAR}] }}");
    let mountain = |of_mountains: &'static str, of_others: &'static str| {
        table(&move |letter| if letter == Assignment::Mountain { of_mountains } else { of_others })
    };
    let found = |table: String| scene(&law).with("laws.csv", table).converged().relaxed("relaxed").energy.total;
    let near = |found: f64, expected: f64| assert!((found - expected).abs() <= 1e-9 * expected, "{found} {expected}");
    near(found(mountain("1", "2")), energy(&format!("stiffness = 1.0, law = {{ M = {STIFFENING}, V = {BILINEAR} }}")));
    near(found(mountain("0", "2")), energy(&format!("stiffness = 1.0, law = {{ V = {BILINEAR} }}")));
    for wrong in ["3", "-1", "0.5", "stiffening"] {
        scene(&law)
            .with("laws.csv", mountain(wrong, "1"))
            .refused("is no law of the list: they are counted from 1 to 2");
    }
}

/// Claim: what is no law by letters is refused, with what would be right.
#[test]
fn letters_without_law_are_refused() {
    for (creases, said) in [
        (format!("stiffness = 1.0, law = {{ B = {STIFFENING} }}"), "no crease has the letter B"),
        (format!("stiffness = 1.0, law = {{ M = {STIFFENING}, kind = \"power\" }}"), "`kind` is none of the letters"),
        (format!("stiffness = 1.0, law = {{ M = {STIFFENING}, X = {BILINEAR} }}"), "`X` is none of the letters"),
        (format!("stiffness = 1.0, law = {{ Z = {BILINEAR} }}"), "`Z` is none of the letters"),
        ("stiffness = 1.0, law = { M = { kind = \"stiff\" } }".into(), "unknown word `stiff`"),
        ("stiffness = 1.0, law = { V = { kind = \"power\", exponent = 0.5 } }".into(), "the exponent is 0.5"),
        ("stiffness = 1.0, law = {}".into(), "missing key `kind`"),
        (format!("stiffness = 1.0, law = {{ of = [{SPRING}] }}"), "both without other keys"),
        (
            format!("stiffness = 1.0, law = {{ each = {{ file = \"a.csv\" }}, of = [], M = {SPRING} }}"),
            "both without other keys",
        ),
        (format!("law = {{ M = {SPRING} }}"), "missing key `stiffness`"),
        (format!("stiffness = 1.0, yield = {{ moment = 1.0 }}, law = {{ M = {SPRING} }}"), "a law and yields at once"),
    ] {
        scene(&creases).refused(said);
    }
}

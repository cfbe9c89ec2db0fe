//! Bars whose rest lengths are not the drawn ones: prestress and swelling.

use crate::common::{Folder, Scene, Testing};
use foldwell::model::{AssemblyError, RestLengths};
use foldwell::run::{Wanted, info};
use foldwell::sheet::generate::{Pattern, Truss};
use foldwell::solver::Failure;
use foldwell::{Assembly, RIGID, generate, relax};

fn truss(height: f64) -> foldwell::Sheet {
    generate(&Pattern::Truss(Truss { half_span: 1.0, height })).unwrap()
}

fn bar(assembly: &Assembly, ends: [usize; 2]) -> usize {
    let edges = &assembly.tiling().edges;
    edges.iter().position(|edge| edge.ends.map(|end| end.vertex) == ends).unwrap()
}

fn per_edge(lengths: [([usize; 2], f64); 3]) -> RestLengths {
    let bare = Assembly::patch(truss(0.3), [1, 1]).build().unwrap();
    let mut each = vec![f64::NAN; 3];
    lengths.iter().for_each(|&(ends, length)| each[bar(&bare, ends)] = length);
    RestLengths::PerEdge(each)
}

/// Claim: a swollen triangle without supports reaches its rest lengths, soft or rigid, and has no energy. Source: three
/// lengths that fulfil the triangle inequality are those of a triangle. Tolerance: residuals of 1e-12.
#[test]
fn a_free_triangle_swells() {
    for stiffness in [2.0, 1e8, RIGID] {
        for rest in [RestLengths::Factor(1.1), per_edge([([0, 1], 1.2), ([1, 2], 1.3), ([0, 2], 2.1)])] {
            let builder = Assembly::patch(truss(0.3), [1, 1]).bars(stiffness).rest_lengths(rest.clone());
            let found = relax(&builder.build().unwrap()).unwrap();
            assert!(found.state.strain.iter().all(|strain| strain.abs() < 1e-11), "{:?}", found.state.strain);
            assert!(found.state.total().abs() < 1e-20 * stiffness.min(1e9), "{}", found.state.total());
        }
    }
}

/// Claim: lengths that no triangle has strain all bars: two bars of rest length 1 in a row beside one of 3 carry the
/// force `EA / 5` and are 12/5 long together. Source: springs in series and in parallel, `T = EA (3 - x) / 3 = EA (x -
/// 2) / 2`. Rigid bars cannot have such lengths, and the relaxation says so. Tolerance: residuals of 1e-12.
#[test]
fn impossible_lengths() {
    let rest = per_edge([([0, 1], 1.0), ([1, 2], 1.0), ([0, 2], 3.0)]);
    let soft = Assembly::patch(truss(0.3), [1, 1]).bars(2.0).rest_lengths(rest.clone()).build().unwrap();
    let found = relax(&soft).unwrap();
    let state = |ends| (found.state.strain[bar(&soft, ends)], found.state.tension[bar(&soft, ends)]);
    for (ends, strain) in [([0, 1], 0.2), ([1, 2], 0.2), ([0, 2], -0.2)] {
        let (found, tension) = state(ends);
        assert!((found - strain).abs() < 1e-11 && (tension - 2.0 * strain).abs() < 1e-11, "{ends:?}: {found}");
    }
    let rigid = soft.with_bars(RIGID);
    let failure = relax(&rigid).unwrap_err().failure;
    assert!(matches!(failure, Failure::Infeasible { .. }), "{failure}");
}

/// Claim: between fixed supports a truss whose bars are longer by a factor rises to the height at which they are at
/// rest, and a load on the apex has the closed form `F(z) = 2 EA / L0 (L0 - l) z / l` with the *rest* length `L0`; the
/// bar between the supports has the strain `1 / factor - 1`. Source: force of two springs. Tolerance: residuals of
/// 1e-12.
#[test]
fn the_arch_rises() {
    let factor = 1.05;
    let rest = factor * 1f64.hypot(0.3);
    for (stiffness, force) in [(1.0, 0.0), (1.0, -4e-3), (50.0, -0.1)] {
        let builder = Assembly::patch(truss(0.3), [1, 1]).bars(stiffness).rest_lengths(RestLengths::Factor(factor));
        let held = builder.pin(0, [0, 0], [true; 3]).pin(1, [0, 0], [true, true, false]).pin(2, [0, 0], [true; 3]);
        let arch = held.load(1, [0, 0], [0.0, 0.0, force]).build().unwrap();
        let found = relax(&arch).unwrap();
        let z = found.state.coordinates[5];
        let l = 1f64.hypot(z);
        let closed = 2.0 * stiffness / rest * (rest - l) * z / l;
        assert!((closed + force).abs() < 1e-11, "{z}: {closed} {force}");
        let strain = found.state.strain[bar(&arch, [0, 2])];
        assert!((strain - (1.0 / factor - 1.0)).abs() < 1e-14, "{strain}");
        if force == 0.0 {
            assert!((z - (rest * rest - 1.0).sqrt()).abs() < 1e-11, "{z}");
        }
    }
}

/// Claim: rigid bars of a patch reach rest lengths that are those of the same shape in another size. Tolerance:
/// residuals of 1e-12.
#[test]
fn a_rigid_patch_grows() {
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    for factor in [0.7, 1.01, 1.5] {
        let builder = Assembly::patch(sheet.clone(), [4, 4]).bars(RIGID).creases(1.0);
        let grown = builder.rest_lengths(RestLengths::Factor(factor)).build().unwrap();
        let found = relax(&grown).unwrap();
        assert!(found.state.strain.iter().all(|strain| strain.abs() < 1e-11));
        assert!(found.state.total() < 1e-20);
        assert_eq!(grown.bars_off_rest(), grown.edges());
    }
}

/// Claim: the builder refuses lists of another length, values that are no lengths, and rest lengths without bars.
#[test]
fn the_builder_refuses() {
    let with = |rest| Assembly::patch(truss(0.3), [1, 1]).bars(1.0).rest_lengths(rest).build().err();
    assert_eq!(with(RestLengths::Factor(0.0)), Some(AssemblyError::RestLength { length: 0.0 }));
    let count = AssemblyError::Count { what: "rest lengths", given: 1, edges: 3 };
    assert_eq!(with(RestLengths::PerEdge(vec![1.0])), Some(count));
    let bare = Assembly::patch(truss(0.3), [1, 1]).rest_lengths(RestLengths::Drawn).build();
    assert_eq!(bare.err(), Some(AssemblyError::RestWithoutBars));
    let short = Assembly::patch(truss(0.3), [1, 1]).bars(vec![1.0]).build();
    assert_eq!(short.err(), Some(AssemblyError::Count { what: "stiffnesses", given: 1, edges: 3 }));
    let zero = Assembly::patch(truss(0.3), [1, 1]).bars(vec![1.0, 0.0, 1.0]).build();
    assert_eq!(zero.err(), Some(AssemblyError::Stiffness { term: "bars", stiffness: 0.0 }));
}

/// Claim: kinds of study that need bars at rest as drawn, or one stiffness, refuse others with the reason, and nothing
/// is written.
#[test]
fn studies_that_need_one_stiffness_or_drawn_lengths() {
    let swollen = "bars = { stiffness = 1e3, rest = 1.01 }\ncreases = { stiffness = 1 }";
    let uneven = "bars = { stiffness = 1e3 }\ncreases = { stiffness = { M = 1, V = 2 } }";
    let mixed = "bars = { stiffness = 1e3 }\ncreases = { stiffness = 1 }\n\
                 facets = { stiffness = 1.0, rest = 0.1 }";
    let rigid = "bars = { stiffness = inf }\ncreases = { stiffness = { M = inf, V = 2 }, rest = \"flat\" }";
    let landscape = "kind = \"landscape\"\nmodes = [[1, 0, 0]]\namplitudes = [0.01]";
    let bands = "kind = \"bloch\"\npath = [[0, 0], [1, 0]]";
    let cases = [
        (swollen, "patch", "kind = \"wells\"", "wells need bars at rest as drawn, and "),
        (swollen, "screw", "kind = \"trace\"", "branches of rigid folding need bars at rest as drawn, and 12 have"),
        (swollen, "screw", "kind = \"branches\"", "branches of rigid folding need bars at rest as drawn, and 12 have"),
        (swollen, "screw", "kind = \"surface\"", "surfaces of folded states need bars at rest as drawn, and 12 have"),
        (swollen, "patch", landscape, "a landscape is that of a sheet drawn at rest"),
        (swollen, "patch", "kind = \"modes\"\neigenvalues = 3", "eigenvalues need bars at rest"),
        (uneven, "screw", "kind = \"surface\"", "surfaces of folded states need one stiffness for all creases"),
        (
            uneven,
            "patch",
            landscape,
            "a landscape is that of equal cells, and the creases have more than one stiffness",
        ),
        (
            &format!("{uneven}\nfacets = {{ stiffness = 1 }}"),
            "patch",
            bands,
            "bands need one stiffness for all creases",
        ),
        (
            rigid,
            "screw",
            "kind = \"branches\"",
            "branches of rigid folding leave the drawn state, and the rigid hinge [",
        ),
        (mixed, "screw", "kind = \"branches\"\nanswer = 1", "unknown key `answer`"),
    ];
    for (energy, domain, study, expected) in cases {
        let sheet = format!("generate = {{ pattern = \"miura\", fold = 0.4 }}\ndomain = \"{domain}\"\ncells = [2, 2]");
        Scene::on(&sheet, &format!("[energy]\n{energy}\n[[study]]\nname = \"a\"\n{study}")).refused(expected);
    }
}

/// Claim: `foldwell info` counts the stiffnesses, the rigid elements and the rest values of a scene that are not drawn.
/// Source: a cell of Miura-ori on a torus has 8 creases, 6 valleys or mountains of either sort as drawn, 4 facets and
/// 12 bars.
#[test]
fn info_counts_what_is_set() {
    let folder = Folder::new();
    let text = "[sheet]\ngenerate = { pattern = \"miura\", fold = 0.4 }\ndomain = \"torus\"\n[energy]\n\
                bars = { stiffness = inf, rest = 1.02 }\ncreases = { stiffness = { M = inf, V = 2 } }\n\
                facets = { stiffness = 3, rest = 0.1 }\n";
    let counts = info(&folder.scene(text).written(), &Wanted::default()).unwrap();
    let energy = counts.energy.clone().unwrap();
    let (bars, creases, facets) = (energy.bars.unwrap(), energy.creases.unwrap(), energy.facets.unwrap());
    assert_eq!((bars.elements, bars.rigid, bars.rest_not_drawn, bars.softest), (12, 12, 12, None));
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let mountains = sheet.edges.iter().filter(|edge| sheet.assignment(edge).to_string() == "M").count();
    assert_eq!((creases.elements, creases.rigid, creases.stiffnesses), (8, mountains, 1));
    assert_eq!((creases.softest, creases.stiffest, creases.rest_not_drawn), (Some(2.0), Some(2.0), 0));
    assert_eq!((facets.elements, facets.rigid, facets.rest_not_drawn), (4, 0, 4));
    let said = counts.to_string();
    assert!(said.contains("bars                   12, all rigid; 12 rest lengths are not the drawn ones"), "{said}");
    assert!(said.contains(&format!("creases                8, stiffness 2, {mountains} of them rigid")), "{said}");
    folder.write("m.fold", foldwell::sheet::fold::write(&sheet));
    assert_eq!(info(&folder.file("m.fold"), &Wanted::default()).unwrap().energy, None);
}

//! Stiffnesses and rest angles of single creases, facets and bars: from lists, tables, letters and the mesh.

use crate::common::{Numbers, Scene, distance, mesh};
use foldwell::analysis::branches::branches;
use foldwell::analysis::modes::modes;
use foldwell::model::{Hinges, RestLengths, Stiffness, Terms};
use foldwell::sheet::fold;
use foldwell::sheet::generate::{Miura, Pattern};
use foldwell::{Assembly, RIGID, Rest, Sheet, generate, relax};
use nalgebra::Vector3;

/// Builds the assembly of a scene in a folder with these files.
fn assembly(scene: &str, files: &[(&str, &str)]) -> Result<Assembly, String> {
    let scene = files.iter().fold(Scene::new(scene).named("s"), |scene, (name, text)| scene.with(name, text));
    let folder = format!("{}/", scene.written().parent().unwrap().display());
    let assembled = scene.assembled().map_err(|error| error.to_string().replace(&folder, ""));
    assembled.map(|(_, assembly)| assembly)
}

const MIURA: &str = "[sheet]\ngenerate = { pattern = \"miura\", fold = 0.5 }\ncells = [3, 2]\n[energy]\n";

fn miura(energy: &str, files: &[(&str, &str)]) -> Result<Assembly, String> {
    assembly(&format!("{MIURA}{energy}"), files)
}

fn miura_cell() -> Sheet {
    generate(&Pattern::Miura(Miura { fold: 0.5, ..Miura::default() })).unwrap()
}

fn creases(assembly: &Assembly) -> &Hinges {
    assembly.terms().creases.as_ref().unwrap()
}

/// Claim: a table of letters, a file and the mesh that give all elements the same stiffness are the same as one number,
/// bit by bit of the relaxed coordinates.
#[test]
fn equal_stiffnesses_are_one_number() {
    let rest = "rest = \"flat\" }\n";
    let facets = "facets = { stiffness = { F = 7.0 } }\n";
    let one = miura(
        &format!("bars = {{ stiffness = 1e4 }}\ncreases = {{ stiffness = 2.0, {rest}facets = {{ stiffness = 7.0 }}\n"),
        &[],
    );
    let one = relax(&one.unwrap()).unwrap();
    let cell = miura_cell();
    let mut table = "i,j,n1,n2,stiffness\n".to_owned();
    for edge in cell.edges.iter().filter(|edge| edge.kind == foldwell::sheet::EdgeKind::Crease) {
        let key = edge.key;
        table += &format!("{},{},{},{},2\n", key.i, key.j, key.shift[0], key.shift[1]);
    }
    let forms = ["{ M = 2.0, V = 2, F = 1.0 }", "{ file = \"k.csv\" }"];
    for form in forms {
        let bars = "bars = { stiffness = { M = 1e4, V = 1e4, J = 1e4 } }\n";
        let text = format!("{bars}creases = {{ stiffness = {form}, {rest}{facets}");
        let found = miura(&text, &[("k.csv", &table)]).unwrap();
        assert_eq!(creases(&found).stiffness, Stiffness::Uniform(2.0));
        let found = relax(&found).unwrap();
        assert!(found.configuration == one.configuration, "{form}");
    }
}

fn angle([i, j, left, right]: [Vector3<f64>; 4]) -> f64 {
    let (l, r) = ((j - i).cross(&(left - i)), (i - j).cross(&(right - j)));
    f64::atan2(-l.cross(&r).dot(&(j - i).normalize()), l.dot(&r))
}

/// The energies of bars and hinges of a patch, summed here from positions alone.
fn summed(patch: &Assembly, coordinates: &[f64]) -> [f64; 2] {
    let at = |vertex: usize| Vector3::from_column_slice(&coordinates[3 * vertex..3 * vertex + 3]);
    let terms = patch.terms();
    let mut sums = [0.0; 2];
    for (k, edge) in patch.tiling().edges.iter().enumerate() {
        let ends = edge.ends.map(|end| end.vertex);
        let drawn = (patch.tiling().positions[ends[1]] - patch.tiling().positions[ends[0]]).norm();
        let bars = terms.bars.as_ref().unwrap();
        let rest = match &bars.rest {
            RestLengths::Drawn => drawn,
            RestLengths::Factor(factor) => factor * drawn,
            RestLengths::PerEdge(lengths) => lengths[k],
        };
        let length = (at(ends[1]) - at(ends[0])).norm();
        sums[0] += 0.5 * bars.stiffness.of(k) / rest * (length - rest).powi(2);
        let Some(sites) = edge.hinge() else { continue };
        let facet = edge.kind == foldwell::sheet::EdgeKind::Facet;
        let hinges = if facet { &terms.facets } else { &terms.creases }.as_ref().unwrap();
        let off = angle(sites.map(|site| at(site.vertex))) - hinges.rest[k];
        sums[1] += 0.5 * hinges.stiffness.of(k) * drawn * off * off;
    }
    sums
}

/// A patch of Miura-ori each of whose bars, creases and facets has a stiffness and a rest value of its own.
fn motley() -> Assembly {
    let bare = Assembly::patch(miura_cell(), [3, 3]).build().unwrap();
    let mut numbers = Numbers::new(5);
    let edges = bare.edges();
    let mut spread = |size: f64| -> Vec<f64> { (0..edges).map(|_| size * (1.5 + numbers.within(1.0))).collect() };
    let (bars, creases, facets) = (spread(200.0), spread(1.0), spread(4.0));
    let off = spread(0.05);
    let angles: Vec<f64> = bare.drawn_angles().iter().zip(&off).map(|(angle, off)| angle + off).collect();
    let lengths = bare.tiling().edges.iter().zip(&off).map(|(edge, off)| {
        let [i, j] = edge.ends.map(|end| bare.tiling().positions[end.vertex]);
        (j - i).norm() * (1.0 + 0.2 * off)
    });
    let lengths = RestLengths::PerEdge(lengths.collect());
    let builder = Assembly::patch(miura_cell(), [3, 3]).bars(bars).rest_lengths(lengths).creases(creases);
    builder.rest(Rest::PerEdge(angles.clone())).facets(facets).facet_rest(Rest::PerEdge(angles)).build().unwrap()
}

/// Claim: the energy of a patch whose elements all differ is the sum that its positions give, and the relaxed state is
/// stationary for that sum. Source: the sum is computed here, without code of the model; its derivative by central
/// differences. Tolerances: rounding of 200 terms; differences of step 1e-5, whose rounding is 1e-11 of the energy.
#[test]
fn energies_of_single_elements_add_up() {
    let patch = motley();
    let found = relax(&patch).unwrap();
    let [bars, hinges] = summed(&patch, &found.state.coordinates);
    let state = &found.state;
    assert!((state.energy_bars / bars - 1.0).abs() < 1e-10, "{} {bars}", state.energy_bars);
    assert!(((state.energy_creases + state.energy_facets) / hinges - 1.0).abs() < 1e-10);
    let total = |x: &[f64]| summed(&patch, x).iter().sum::<f64>();
    let mut numbers = Numbers::new(9);
    for _ in 0..5 {
        let direction = numbers.many(state.coordinates.len(), 1.0);
        let moved = |step: f64| state.coordinates.iter().zip(&direction).map(|(x, d)| x + step * d).collect::<Vec<_>>();
        let slope = (total(&moved(1e-5)) - total(&moved(-1e-5))) / 2e-5;
        assert!(slope.abs() < 1e-6 * total(&moved(1e-3)).max(1.0), "{slope}");
    }
    assert!(found.negative_eigenvalues == Some(0) && total(&state.coordinates) > 1e-3);
}

/// Claim: the relaxations in positions and in fold angles find the same state of elements that all differ. Tolerance:
/// residuals of 1e-12 over the softest eigenvalue.
#[test]
fn both_methods_know_single_elements() {
    use foldwell::analysis::relax::relax_from;
    use foldwell::analysis::relax::{Method, RelaxOptions};
    let patch = motley();
    let angles = [Method::Vertices, Method::Intrinsic].map(|method| {
        let model = patch.model(foldwell::model::Gauge::Held);
        let options = RelaxOptions { method, ..RelaxOptions::default() };
        let found = relax_from(&model, model.start(), options, &mut |_| true).unwrap();
        assert_eq!(found.intrinsic_failure, None);
        found.state.fold_angle
    });
    assert!(distance(&angles[0], &angles[1]) < 1e-9);
}

/// Claim: rigid creases beside soft ones are locks at their rest angles. Source: the same sheet with `[[lock]]`.
/// Tolerance: residuals of both relaxations.
#[test]
fn rigid_creases_are_locks() {
    let sheet = mesh("open-star");
    let bare = Assembly::patch(sheet.clone(), [3, 3]).build().unwrap();
    let rest: Vec<f64> = Numbers::new(2).many(bare.edges(), 0.02);
    let rest: Vec<f64> = rest.iter().zip(bare.drawn_angles()).map(|(off, angle)| angle + off).collect();
    let hinged: Vec<usize> = (0..bare.edges()).filter(|&k| bare.tiling().edges[k].hinge().is_some()).collect();
    let rigid = [hinged[2], hinged[9], hinged[20]];
    let mut each = vec![1.0; bare.edges()];
    rigid.iter().for_each(|&k| each[k] = RIGID);
    let build = |stiffness: Stiffness| {
        let builder = Assembly::patch(sheet.clone(), [3, 3]).bars(1e3).creases(stiffness);
        builder.rest(Rest::PerEdge(rest.clone())).build().unwrap()
    };
    let mixed = build(each.into());
    let soft = build(1.0.into());
    let locks = rigid.map(|k| (k, rest[k])).to_vec();
    let locked = soft.with_terms(Terms { locks, ..soft.terms().clone() });
    let [a, b] = [&mixed, &locked].map(|assembly| relax(assembly).unwrap());
    assert!(distance(&a.state.coordinates, &b.state.coordinates) < 1e-10);
    assert!(rigid.iter().all(|&k| (a.state.fold_angle[k] - rest[k]).abs() < 1e-12));
    assert_eq!(mixed.locked_edges(), rigid);
}

/// Claim: rigid folding sees a rigid crease beside soft ones as a lock: as many rays, and the same directions.
/// Tolerance: the numbers come from the same equations.
#[test]
fn rigid_folding_sees_rigid_creases() {
    let sheet = mesh("open-star");
    let key = sheet.edges[0].key;
    let mut each = vec![1.0; sheet.edges.len()];
    each[0] = RIGID;
    let mixed = Assembly::screw(sheet.clone(), [2, 2]).bars(RIGID).creases(each).build().unwrap();
    let locked = Assembly::screw(sheet.clone(), [2, 2]).bars(RIGID).creases(1.0).lock(key, None).build().unwrap();
    let free = Assembly::screw(sheet, [2, 2]).bars(RIGID).creases(1.0).build().unwrap();
    let rays = |assembly: &Assembly| branches(assembly).unwrap().rays.rays.len();
    assert_eq!(rays(&mixed), rays(&locked));
    assert_ne!(rays(&mixed), rays(&free));
}

/// Claim: where some bars are rigid the lowest eigenvalues are the limits of those with stiff bars in their place, and
/// there are as many as the rigid bars leave free. Source: first-order perturbation, an error of the order of 1e-7.
#[test]
fn spectra_of_rigid_bars_beside_soft_ones() {
    let bare = Assembly::patch(miura_cell(), [2, 2]).build().unwrap();
    let rigid = |k: usize| k.is_multiple_of(3);
    let spectrum = |stiff: f64| {
        let bars: Vec<f64> = (0..bare.edges()).map(|k| if rigid(k) { stiff } else { 2.0 + k as f64 / 10.0 }).collect();
        let assembly = Assembly::patch(miura_cell(), [2, 2]).bars(bars).creases(1.0).facets(3.0).build().unwrap();
        modes(&assembly, 1000, &mut || true).unwrap().eigenvalues
    };
    let (limit, stiff) = (spectrum(RIGID), spectrum(1e7));
    let count = (0..bare.edges()).filter(|&k| rigid(k)).count();
    assert_eq!((limit.len(), stiff.len()), (48 - count, 48));
    for (k, (a, b)) in limit.iter().zip(&stiff).enumerate() {
        assert!((a - b).abs() < 1e-4 * (1.0 + a), "{k}: {a} {b}");
    }
}

/// Claim: rows of a cell hold in all cells, rows with cells in theirs, and facets and bars have tables too.
#[test]
fn tables_of_cells_and_patches() {
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let diagonals = sheet.edges.iter().filter(|edge| edge.kind == foldwell::sheet::EdgeKind::Facet);
    let mut facets = "i,j,n1,n2,stiffness\n".to_owned();
    for (k, key) in diagonals.map(|edge| edge.key).enumerate() {
        let stiffness = if k == 0 { "inf".to_owned() } else { k.to_string() };
        facets += &format!("{},{},{},{},{stiffness}\n", key.i, key.j, key.shift[0], key.shift[1]);
    }
    let found = miura("facets = { stiffness = { file = \"f.csv\" } }\n", &[("f.csv", &facets)]).unwrap();
    let each = &found.terms().facets.as_ref().unwrap().stiffness;
    let first = sheet.edges.iter().position(|edge| edge.kind == foldwell::sheet::EdgeKind::Facet).unwrap();
    for k in found.tiling().facets() {
        let edge = found.tiling().edges[k].edge;
        assert_eq!(each.of(k), if edge == first { RIGID } else { (edge - first) as f64 });
    }
    assert_eq!(found.rigid_facets_of_cell(), [first]);
    let sheet = mesh("open-star");
    let bare = Assembly::patch(sheet.clone(), [2, 1]).build().unwrap();
    let mut table = "cell1,cell2,i,j,n1,n2,stiffness\n".to_owned();
    for (k, edge) in bare.tiling().edges.iter().enumerate() {
        let (key, [c1, c2]) = (sheet.edges[edge.edge].key, edge.cell);
        // backward names: the edge then starts in the cell of its other end
        let [d1, d2] = [c1 as i32 + key.shift[0], c2 as i32 + key.shift[1]];
        table += &format!("{d1},{d2},{},{},{},{},{}\n", key.j, key.i, -key.shift[0], -key.shift[1], k + 1);
    }
    let scene =
        "[sheet]\nmesh = \"open-star.fold\"\ncells = [2, 1]\n[energy]\nbars = { stiffness = { file = \"k.csv\" } }\n";
    let found = assembly(scene, &[("k.csv", &table)]).unwrap();
    let bars = &found.terms().bars.as_ref().unwrap().stiffness;
    assert!((0..found.edges()).all(|k| bars.of(k) == (k + 1) as f64));
}

/// Claim: facets have rest angles of all forms that creases have: flat, an angle, a table, a mode by its rates. Source:
/// the drawn angle of a facet of Miura-ori is 0, and a rate of 0.5 at an amplitude of 0.2 adds 0.1.
#[test]
fn facets_have_rest_angles() {
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let diagonals = sheet.edges.iter().filter(|edge| edge.kind == foldwell::sheet::EdgeKind::Facet);
    let rows: Vec<String> = diagonals
        .map(|edge| format!("{},{},{},{},", edge.key.i, edge.key.j, edge.key.shift[0], edge.key.shift[1]))
        .collect();
    let table = |value: &str, number: &str| -> String {
        let lines: Vec<String> = rows.iter().map(|row| format!("{row}{number}\n")).collect();
        format!("i,j,n1,n2,{value}\n{}", lines.concat())
    };
    let (angles, rates) = (table("angle", "0.3"), table("rate", "0.5"));
    let cases = [
        ("\"drawn\"", 0.0),
        ("\"flat\"", 0.0),
        ("-0.2", -0.2),
        ("{ file = \"a.csv\" }", 0.3),
        ("{ mode = { rates = \"r.csv\" }, amplitude = 0.2 }", 0.1),
    ];
    for (rest, expected) in cases {
        let text = format!("facets = {{ stiffness = 2.0, rest = {rest} }}\n");
        let found = miura(&text, &[("a.csv", &angles), ("r.csv", &rates)]).unwrap();
        let hinges = found.terms().facets.as_ref().unwrap();
        assert!(found.tiling().facets().count() > 0);
        assert!(found.tiling().facets().all(|k| (hinges.rest[k] - expected).abs() < 1e-14), "{rest}");
    }
    let found = miura("facets = { stiffness = 2.0, rest = 60 }\n", &[]).err().unwrap();
    assert!(found.contains("the angle 60 is beyond pi"), "{found}");
}

/// Claim: wrong tables are refused with their file and line, and incomplete ones with the edge that is missing.
#[test]
fn wrong_tables_are_refused() {
    let of = |table: &str| {
        let text = "bars = { stiffness = 1.0 }\ncreases = { stiffness = { file = \"k.csv\" } }\n";
        miura(text, &[("k.csv", table)]).err().unwrap()
    };
    let cases = [
        ("i,j,n1,n2,angle\n0,1,0,0,1\n", "k.csv:1: the header is `i,j,n1,n2,angle`, expected `i,j,n1,n2,stiffness`"),
        (
            "i,j,n1,n2,stiffness\n0,1,0,0,1\n1,3,0,0,-2\n",
            "k.csv:3: `-2` in column `stiffness` is not a positive number",
        ),
        (
            "i,j,n1,n2,stiffness\n0,1,0,0,nan\n",
            "k.csv:2: `nan` in column `stiffness` is not a positive number or `inf`",
        ),
        // too large for a number, which is not the same as rigid
        (
            "i,j,n1,n2,stiffness\n0,1,0,0,1e999\n",
            "k.csv:2: `1e999` in column `stiffness` is not a positive number or `inf`",
        ),
        ("i,j,n1,n2,stiffness\n0,1,0,0\n", "k.csv:2: the line has 4 fields, expected 5"),
        ("i,j,n1,n2,stiffness\n0,1.5,0,0,1\n", "k.csv:2: `1.5` in column `j` is not a whole number"),
        ("i,j,n1,n2,stiffness\n", "k.csv:1: the table has no rows"),
        ("i,j,n1,n2,stiffness\n1,2,0,0,1\n", "k.csv:2: the sheet has no crease [1, 2, 0, 0]"),
        ("i,j,n1,n2,stiffness\n0,1,0,0,1\n1,0,0,0,1\n", "k.csv:3: the edge is given twice, first in line 2"),
        ("i,j,n1,n2,stiffness\n0,1,0,0,1\n", "s.toml:6:34: k.csv has no row for crease [1, 3, 0, 0] of cell [0, 0]"),
        ("cell1,cell2,i,j,n1,n2,stiffness\n3,0,0,1,0,0,1\n", "k.csv:2: there is no crease [0, 1, 0, 0] in cell [3, 0]"),
    ];
    for (table, expected) in cases {
        let found = of(table);
        assert!(found.starts_with(expected), "{found}");
    }
    let lengths = |table: &str| {
        let text = "bars = { stiffness = 1.0, rest = { file = \"l.csv\" } }\n";
        miura(text, &[("l.csv", table)]).err().unwrap()
    };
    let found = lengths("i,j,n1,n2,length\n0,1,0,0,inf\n");
    assert!(found.starts_with("l.csv:2: `inf` in column `length` is not a finite number above 0"), "{found}");
    let found = lengths("i,j,n1,n2,length\n0,1,0,0,1\n");
    assert!(found.contains("l.csv has no row for bar [1, 3, 0, 0]"), "{found}");
}

/// Claim: letters without stiffness are listed with their counts, and letters that no element has are refused. Source:
/// a patch of 3 x 2 cells of Miura-ori has 17 creases that are left inside, counted by their drawn angles.
#[test]
fn letters_have_to_be_complete() {
    let found = miura("creases = { stiffness = { M = 1.0 } }\n", &[]).err().unwrap();
    let bare = Assembly::patch(miura_cell(), [3, 2]).build().unwrap();
    let edges = bare.tiling().edges.iter().zip(bare.drawn_angles());
    let valleys = edges.filter(|(edge, angle)| edge.kind == foldwell::sheet::EdgeKind::Crease && **angle > 0.0).count();
    let expected = format!("s.toml:5:25: the table has no stiffness for the letters V ({valleys} creases)");
    assert!(valleys > 0 && found == expected, "{found}");
    let found = miura("creases = { stiffness = { M = 1.0, V = 1, B = 2 } }\n", &[]).err().unwrap();
    assert!(found.contains("no crease has the letter B"), "{found}");
    let found = miura("creases = { stiffness = { M = 1.0, X = 1 } }\n", &[]).err().unwrap();
    assert!(found.contains("unknown key `X`"), "{found}");
    let found = miura("creases = { stiffness = { M = 0, V = 1 } }\n", &[]).err().unwrap();
    assert!(found.contains("the stiffness is 0"), "{found}");
    let bars = miura("bars = { stiffness = { M = 1, V = 2, J = 3 } }\n", &[]).unwrap();
    let bars = &bars.terms().bars.as_ref().unwrap().stiffness;
    for (k, (edge, angle)) in bare.tiling().edges.iter().zip(bare.drawn_angles()).enumerate() {
        match edge.kind {
            foldwell::sheet::EdgeKind::Facet => assert_eq!(bars.of(k), 3.0),
            foldwell::sheet::EdgeKind::Crease => assert_eq!(bars.of(k), if *angle > 0.0 { 2.0 } else { 1.0 }),
            foldwell::sheet::EdgeKind::Boundary => assert!([1.0, 2.0].contains(&bars.of(k))),
        }
    }
}

/// Two squares side by side, the right one split by a joined edge.
fn square_mesh(stiffness: &str) -> String {
    format!(
        r#"{{"vertices_coords": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]],
"faces_vertices": [[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]],
"edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [1, 4], [4, 5], [5, 2], [1, 5]],
"edges_assignment": ["B", "F", "B", "B", "U", "B", "B", "B", "J"],
{stiffness}}}"#
    )
}

/// Claim: the mesh gives hinges and bars their stiffnesses by two keys, `"inf"` is rigid, the file is written with them
/// again, and missing or wrong entries are refused with key and place.
#[test]
fn meshes_have_stiffnesses() {
    let lists = r#""foldwell:stiffness": [null, 2.5, null, null, 3, null, null, null, "inf"],
"foldwell:bar_stiffness": [1, 2, 3, 4, 5, 6, 7, 8, 9]"#;
    let text = square_mesh(lists);
    let sheet = fold::parse(&text, "m.fold").unwrap();
    assert_eq!(fold::parse(&fold::write(&sheet), "m.fold").unwrap(), sheet);
    assert_eq!((sheet.stiffness.hinges.len(), sheet.stiffness.bars.len()), (3, 9));
    let energy = "[sheet]\nmesh = \"m.fold\"\n[energy]\nbars = { stiffness = \"mesh\" }\n\
                  creases = { stiffness = \"mesh\" }\nfacets = { stiffness = \"mesh\" }\n";
    let found = assembly(energy, &[("m.fold", &text)]).unwrap();
    let (terms, edges) = (found.terms(), &found.tiling().edges);
    let facet = found.tiling().facets().next().unwrap();
    assert_eq!(terms.facets.as_ref().unwrap().stiffness, Stiffness::Uniform(RIGID));
    assert_eq!(sheet.edges[edges[facet].edge].key.ends().map(|end| end.vertex), [1, 5]);
    let given = [([0, 2], 3.0, 5.0), ([1, 2], 2.5, 2.0)];
    for ([i, j], hinge, bar) in given {
        let k = edges.iter().position(|edge| edge.ends.map(|end| end.vertex) == [i, j]).unwrap();
        assert_eq!((creases(&found).stiffness.of(k), terms.bars.as_ref().unwrap().stiffness.of(k)), (hinge, bar));
    }
    let refused = |lists: &str| assembly(energy, &[("m.fold", &square_mesh(lists))]).err().unwrap();
    let bars = r#""foldwell:bar_stiffness": [1, 2, 3, 4, 5, 6, 7, 8, 9]"#;
    let cases = [
        (String::from(r#""file_author": "none""#), "s.toml:4:22: the mesh has no `foldwell:bar_stiffness`"),
        (
            format!(r#""foldwell:stiffness": [null, 2.5, null, null, null, null, null, null, 1], {bars}"#),
            "`foldwell:stiffness` of the mesh has no value for crease [0, 2, 0, 0]",
        ),
        (
            format!(r#""foldwell:stiffness": [null, 2.5], {bars}"#),
            "m.fold:5:23: `foldwell:stiffness` has 2 entries; it should have 9",
        ),
        (
            format!(r#""foldwell:stiffness": [null, 2.5, null, null, 0, null, null, null, 1], {bars}"#),
            "m.fold:5:47: entry 4 of `foldwell:stiffness` is `0`; it should be a positive number, \"inf\" (exactly rigid) or null",
        ),
    ];
    for (lists, expected) in cases {
        let found = refused(&lists);
        assert!(found.contains(expected), "{found}");
    }
}

/// Claim: copies of one edge in a periodic drawing have one stiffness: equal entries and null beside a number are read,
/// different ones are refused with both numbers. Source: the drawing of a cell of Miura-ori lists 12 sides of its 8
/// creases.
#[test]
fn copies_in_a_drawing_agree() {
    let text = fold::write(&generate(&Pattern::named("miura").unwrap()).unwrap());
    let with = |entry: fn(usize) -> String| {
        let list: Vec<String> = (0..12).map(entry).collect();
        let list = format!("\"foldwell:stiffness\": [{}],\n  \"faces_vertices\"", list.join(", "));
        fold::parse(&text.replace("\"faces_vertices\"", &list), "m.fold")
    };
    let sheet = with(|_| "2.5".to_owned()).unwrap();
    assert!(sheet.stiffness.hinges.len() == 8 && sheet.stiffness.hinges.values().all(|k| *k == 2.5));
    let found = with(|k| (k + 1).to_string()).unwrap_err().to_string();
    assert!(found.contains("and another copy of it in the drawing has"), "{found}");
    let some = with(|k| if k == 3 { "7".to_owned() } else { "null".to_owned() }).unwrap();
    assert_eq!(some.stiffness.hinges.values().copied().collect::<Vec<_>>(), [7.0]);
    assert_eq!(fold::parse(&fold::write(&some), "m.fold").unwrap(), some);
}

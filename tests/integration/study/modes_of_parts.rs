//! Modes of sheets with rigid parts, and of pieces that are tied.
//!
//! Source: a Hessian of bars and hinges by differences that shares no code with the library, in the coordinates of the
//! parts; MERLIN's energy of two tubes (see `coupled_tubes.rs`).

use super::assemblies::hessian;
use super::coupled_tubes::{MERLIN, apart};
use crate::common::{Scene, eigenvalues, mesh};
use foldwell::analysis::modes::modes;
use foldwell::model::{Assembly, Builder, Mass};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::fold;
use foldwell::{Rest, Sheet};
use nalgebra::Vector3;

type Vec3 = Vector3<f64>;

/// Velocities of all coordinates for the six motions of a part about its centroid, rotations times the mean edge, as
/// columns; then those of the single coordinates of the other vertices.
fn motions(sheet: &Sheet, part: &[usize]) -> DenseMatrix {
    let centroid = part.iter().map(|&v| sheet.vertices[v]).sum::<Vec3>() / part.len() as f64;
    let lengths = sheet.edges.iter().map(|edge| (sheet.vertices[edge.key.j] - sheet.vertices[edge.key.i]).norm());
    let mean_edge = lengths.sum::<f64>() / sheet.edges.len() as f64;
    let others: Vec<usize> = (0..sheet.vertices.len()).filter(|v| !part.contains(v)).collect();
    let mut motions = DenseMatrix::zeros(3 * sheet.vertices.len(), 6 + 3 * others.len());
    for &v in part {
        for axis in 0..3 {
            motions[(3 * v + axis, axis)] = 1.0;
            let turned = Vec3::ith(axis, 1.0 / mean_edge).cross(&(sheet.vertices[v] - centroid));
            (0..3).for_each(|k| motions[(3 * v + k, 3 + axis)] = turned[k]);
        }
    }
    for (k, v) in others.iter().enumerate() {
        (0..3).for_each(|axis| motions[(3 * v + axis, 6 + 3 * k + axis)] = 1.0);
    }
    motions
}

/// Claim: a drum whose upper end is a plate has the eigenvalues of the Hessian in the coordinates of the plate, six of
/// them those of rigid motions; with the lower end held and a plate that moves along its axis and turns about it, those
/// of two coordinates. Tolerance: differences of 1e-5 are good to 1e-9 of the largest eigenvalue.
#[test]
fn a_drum_with_plates() {
    let sheet = mesh("drum");
    let [bottom, top] = ["bottom", "top"].map(|name| sheet.names[name].iter().map(|c| c.vertex).collect::<Vec<_>>());
    let full = hessian(&sheet, [1e3, 1.0, 10.0]);
    let all = motions(&sheet, &top);
    let assembly = || Assembly::patch(sheet.clone(), [1, 1]).bars(1e3).creases(1.0).facets(10.0).rest(Rest::Drawn);
    let home = |part: &[usize]| part.iter().map(|&vertex| (vertex, [0, 0])).collect::<Vec<_>>();
    let compare = |found: Vec<f64>, kept: &DenseMatrix| {
        let expected = eigenvalues(kept.transpose() * &full * kept);
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-9 * 1e3, "{found} {expected}");
        }
    };
    let free = modes(&assembly().part(home(&top), [true; 6]).build().unwrap(), 24, &mut || true).unwrap();
    assert_eq!((free.rigid_motions, free.folding_modes), (6, None));
    compare(free.eigenvalues, &all);
    let [along, turning] = [false, true].map(|turns| [false, false, !turns, false, false, turns]);
    let both = [false, false, true, false, false, true];
    for (moves, columns) in [(both, vec![2, 5]), (along, vec![2]), (turning, vec![5])] {
        let held = assembly().part(home(&bottom), [false; 6]).part(home(&top), moves).build().unwrap();
        let found = modes(&held, columns.len(), &mut || true).unwrap();
        assert_eq!((found.rigid_motions, found.zero_modes), (0, 0));
        compare(found.eigenvalues, &all.select_columns(&columns));
    }
}

/// Squared frequencies by the Hessian of all coordinates, for motions with these velocities and this mass at every
/// vertex.
fn squares(hessian: &DenseMatrix, motions: &DenseMatrix, mass: f64) -> Vec<f64> {
    let motions = motions.clone().qr().q() / mass.sqrt();
    eigenvalues(motions.transpose() * hessian * &motions)
}

/// Claim: a drum with a plate, and pieces that are tied, have the frequencies of the Hessian in the coordinates of plate
/// and ties against the masses that these move, also where the vertices of the plate are not spread evenly about its
/// middle, so that its motions are coupled. Source: motions whose velocities are orthonormal have a mass matrix that is
/// the mass of a vertex. Tolerance: as of the eigenvalues.
#[test]
fn plates_and_ties_vibrate() {
    let compare = |assembly: Assembly, expected: Vec<f64>| {
        let found = modes(&assembly, 20, &mut || true).unwrap().vibrations.unwrap().squares;
        for (found, expected) in found.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-9 * 1e3, "{found} {expected}");
        }
    };
    let home = |part: &[usize]| part.iter().map(|&vertex| (vertex, [0, 0])).collect::<Vec<_>>();
    let sheet = mesh("drum");
    let top: Vec<usize> = sheet.names["top"].iter().map(|corner| corner.vertex).collect();
    let drum = Assembly::patch(sheet.clone(), [1, 1]).bars(1e3).creases(1.0).facets(10.0).rest(Rest::Drawn);
    let drum = drum.mass(Mass::Vertex(2.0));
    let plate = drum.clone().part(home(&top), [true; 6]).build().unwrap();
    compare(plate, squares(&hessian(&sheet, [1e3, 1.0, 10.0]), &motions(&sheet, &top), 2.0));
    let uneven = &top[..top.len() - 1];
    let plate = drum.part(home(uneven), [true; 6]).build().unwrap();
    compare(plate, squares(&hessian(&sheet, [1e3, 1.0, 10.0]), &motions(&sheet, uneven), 2.0));

    let pieces = apart();
    let ties: Vec<[usize; 2]> = (0..10).map(|k| [6 * (k / 2) + k % 2, 30 + k]).collect();
    let alone = (0..pieces.vertices.len()).filter(|v| !ties.iter().any(|tie| tie.contains(v))).map(|v| vec![v]);
    let groups: Vec<Vec<usize>> = ties.iter().map(|tie| tie.to_vec()).chain(alone).collect();
    let mut moved = DenseMatrix::zeros(3 * pieces.vertices.len(), 3 * groups.len());
    for (group, vertices) in groups.iter().enumerate() {
        (0..3).for_each(|axis| vertices.iter().for_each(|v| moved[(3 * v + axis, 3 * group + axis)] = 1.0));
    }
    let expected = squares(&hessian(&pieces, [1e3, 0.1, 1.0]), &moved, 0.5);
    let tubes =
        Assembly::patch(pieces, [1, 1]).bars(1e3).creases(0.1).facets(1.0).rest(Rest::Drawn).mass(Mass::Vertex(0.5));
    let tie = |builder: Builder, tie: &[usize; 2]| builder.part(home(tie), [true, true, true, false, false, false]);
    compare(ties.iter().fold(tubes, tie).build().unwrap(), expected);
}

/// A scene of two tubes as pieces, with MERLIN's stiffnesses.
fn tied(ties: &str, held: &str, study: &str) -> Scene {
    let energy = "[energy]\nbars = { stiffness = 1e3 }\ncreases = { stiffness = 0.1 }\nfacets = { stiffness = 1.0 }\n";
    let study = format!("[[study]]\nname = \"s\"\ndraw = []\n{study}\n");
    Scene::on("mesh = \"apart.fold\"", &format!("{energy}{held}{ties}{study}"))
        .with("apart.fold", fold::write(&apart()))
}

/// Claim: pieces that a scene ties have the energy of MERLIN's tubes with merged degrees of freedom, and a pin on one of
/// two tied vertices is one on both. Ties without vertices in one place, of vertices of parts, and of sheets that are no
/// patch are refused. Tolerance: the ten digits of MERLIN.
#[test]
fn scenes_tie_vertices() {
    let all = "[[tie]]\nvertices = \"coincident\"\n";
    let pins = |a: usize, b: usize, c: usize| {
        let pin = |vertex: usize, axes: &str| format!("[[pin]]\nvertex = {vertex}\naxes = \"{axes}\"\n");
        pin(a, "xyz") + &pin(b, "yz") + &pin(c, "z")
    };
    let load = "[[load]]\nvertex = 28\nforce = [0.0, 0.01, 0.01]\n";
    let energy = |ties: &str, pins: &str| {
        let scene = tied(ties, &format!("{load}{pins}"), "kind = \"relax\"");
        scene.converged().relaxed("s").energy.total
    };
    let found = energy(all, &pins(3, 2, 9));
    assert!((found - MERLIN).abs() < 6e-15, "{found:e}");
    let one_by_one: String =
        (0..10).map(|k| format!("[[tie]]\nvertices = [{}, {}]\n", 6 * (k / 2) + k % 2, 30 + k)).collect();
    assert!((energy(&one_by_one, &pins(3, 2, 9)) - found).abs() < 1e-15);
    let [first, second] = [pins(0, 1, 9), pins(30, 31, 9)].map(|pins| energy(all, &pins));
    assert!((first - second).abs() < 1e-15 && first > 0.0, "{first:e} {second:e}");

    let refused = |ties: &str, message: &str| tied(ties, "", "kind = \"relax\"").refused(message);
    refused("[[tie]]\nvertices = [0, 5]\n", "no two of these vertices stand in one place");
    refused(&all.repeat(2), "vertex 0 is in another part or tie too");
    refused(
        &format!("[[pin]]\nvertex = 30\nnormal = [0, 0, 1]\n{all}"),
        "vertex 30 is tied, and pinned along a normal",
    );
    let driven = "[[drive]]\nname = \"d\"\nvertices = [30]\naxis = \"z\"\nto = 0.1\n";
    tied(all, driven, "kind = \"path\"").refused("vertex 30 is tied to another vertex");
}

/// Claim: a scene asks for modes and vibrations of tied pieces, as the library does.
#[test]
fn scenes_ask_for_modes_of_parts() {
    let all = "[[tie]]\nvertices = \"coincident\"\n";
    let study = "kind = \"modes\"\neigenvalues = 9";
    let ran = tied(all, "", study).ran();
    let found = ran.modes("s");
    assert_eq!((found.rigid_motions, found.eigenvalues.len()), (6, 9));
    assert!(found.eigenvalues[5].abs() < 1e-9 && found.eigenvalues[6] > 1e-3, "{:?}", found.eigenvalues);
    let mass = "[mass]\nvertex = 1.0\n";
    let frequencies = tied(mass, all, study).ran().modes("s").frequencies.clone().unwrap();
    assert!(frequencies[5] == Some(0.0) && frequencies[6] > Some(0.0), "{frequencies:?}");
}

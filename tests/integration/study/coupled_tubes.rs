//! Two Miura tubes that are coupled, as pieces whose vertices are tied and as one mesh, aligned and as a zipper.
//!
//! Sources: K. Liu and G. H. Paulino's MERLIN, whose two tubes with merged degrees of freedom have the energy
//! 1.476808587e-5 under the load below; and a Hessian of bars and hinges by differences that shares no code with the
//! library. The couplings are those of E. T. Filipov, T. Tachi and G. H. Paulino, PNAS 112, 12321 (2015).

use super::assemblies::hessian;
use crate::common::eigenvalues;
use foldwell::analysis::intersections::Finder;
use foldwell::analysis::modes::modes;
use foldwell::model::Assembly;
use foldwell::sheet::build::{Drawing, build};
use foldwell::sheet::generate::MiuraTubes;
use foldwell::sheet::{EdgeKey, EdgeKind, Glue, fold, welded};
use foldwell::{Pattern, Rest, Sheet, generate, relax};
use nalgebra::Vector3;
use std::collections::BTreeMap;

type Vec3 = Vector3<f64>;

/// Vertices of a ring of the generator: 0 and 1 are those of the shared wall.
const RING: usize = 6;
/// Energy of two tubes under a load by MERLIN, ten digits.
pub(super) const MERLIN: f64 = 1.476808587e-5;
const HOME: [usize; 2] = [0, 0];

fn is_shared(vertex: usize) -> bool {
    vertex % RING < 2
}

/// MERLIN's two tubes of rhombi with an angle of 60 degrees, whose zigzags stand at 0.6 rad to the axis; vertices and
/// faces are in the order of the generator.
fn tubes() -> Sheet {
    let generated = generate(&Pattern::AlignedTubes(MiuraTubes::default())).unwrap();
    let p = 0.5 / 0.6f64.cos();
    let (u, v) = (Vec3::new(p, (1.0 - p * p).sqrt(), 0.0), Vec3::new(p, -(1.0 - p * p).sqrt(), 0.0));
    let ring = [Vec3::zeros(), u, u + v, v, u - v, -v];
    let place = |r: usize| Vec3::new(r as f64 * 0.6f64.cos(), 0.0, (r % 2) as f64 * 0.6f64.sin());
    let coords = (0..30).map(|k| ring[k % RING] + place(k / RING)).collect();
    let faces = generated.polygons.iter().map(|face| face.iter().map(|corner| corner.vertex).collect()).collect();
    build(&Drawing { coords, faces, ..Drawing::default() }).unwrap()
}

/// The two aligned tubes apart, each with a wall of its own where they touch: the second tube has the vertices from 30
/// on where the first has 0 and 1.
pub(super) fn apart() -> Sheet {
    let joined = tubes();
    let own = |vertex: usize| 30 + 2 * (vertex / RING) + vertex % RING;
    let mut coords = joined.vertices.clone();
    coords.extend((0..30).filter(|&v| is_shared(v)).map(|v| joined.vertices[v]));
    let mut faces: Vec<Vec<usize>> =
        joined.polygons.iter().map(|face| face.iter().map(|corner| corner.vertex).collect()).collect();
    let wall = |face: &Vec<usize>| face.iter().all(|&v| is_shared(v));
    let second = |face: &Vec<usize>| face.iter().any(|&v| v % RING > 3);
    let doubled: Vec<Vec<usize>> = faces.iter().filter(|face| wall(face)).cloned().collect();
    faces.extend(doubled);
    let count = faces.len();
    for (f, face) in faces.iter_mut().enumerate() {
        if second(face) || f >= count - 4 {
            face.iter_mut().filter(|v| is_shared(**v)).for_each(|v| *v = own(*v));
        }
    }
    build(&Drawing { coords, faces, ..Drawing::default() }).unwrap()
}

/// Pins and the load of MERLIN's problem.
fn assembly(sheet: Sheet, [bars, creases, facets]: [Vec<f64>; 3], ties: &[[usize; 2]]) -> Assembly {
    let mut builder = Assembly::patch(sheet, [1, 1]).bars(bars).creases(creases).facets(facets);
    builder = builder.pin(3, HOME, [true; 3]).pin(2, HOME, [false, true, true]).pin(9, HOME, [false, false, true]);
    builder = builder.load(28, HOME, [0.0, 0.01, 0.01]);
    for tie in ties {
        builder = builder.part(tie.map(|vertex| (vertex, HOME)), [true, true, true, false, false, false]);
    }
    builder.build().unwrap()
}

/// Claim: two tubes as pieces whose vertices are tied, and as one mesh in which three faces meet at the sides of the
/// shared wall, have MERLIN's energy, and that of each other, and the same eigenvalues. The shared wall of the one mesh is doubled by its
/// stiffnesses, and the walls of different tubes are freed of each other. Tolerance: the ten digits of MERLIN, and 1e-10
/// of the energy, whose parts are 1e-2 of the forces that balance to 1e-12; of eigenvalues 1e-12 of the stiffness of bars.
#[test]
fn tubes_tied_and_drawn_as_one_mesh() {
    let pieces = apart();
    let ends = |sheet: &Sheet, k: usize| [sheet.edges[k].key.i, sheet.edges[k].key.j];
    let all = |sheet: &Sheet, of: &dyn Fn(usize) -> f64| (0..sheet.edges.len()).map(of).collect::<Vec<f64>>();
    let same = [1e3, 0.1, 1.0].map(|stiffness| all(&pieces, &|_| stiffness));
    let ties: Vec<[usize; 2]> = (0..10).map(|k| [RING * (k / 2) + k % 2, 30 + k]).collect();
    let tied = assembly(pieces, same, &ties);

    let mut joined = tubes();
    let mut glue: BTreeMap<_, Vec<Glue>> = BTreeMap::new();
    for edge in &joined.edges {
        let [a, b] = edge.wings.map(|wing| wing.is_some_and(|wing| is_shared(wing.vertex)));
        if joined.hinges_round(edge.key) == 3 {
            glue.entry(edge.key.whole()).or_default().push(if a || b { Glue::Fold } else { Glue::Free });
        }
    }
    assert_eq!(glue.len(), 8, "four sides of the wall along each of two lines have three faces");
    joined.glue = glue;
    let joined = fold::parse(&fold::write(&joined), "joined.fold").unwrap();
    let on_wall = |k: usize| ends(&joined, k).iter().all(|&v| is_shared(v));
    let along = |k: usize| joined.hinges_round(joined.edges[k].key) == 2 && joined.edges[k].kind == EdgeKind::Crease;
    let double = |stiffness: f64, on: bool| if on { 2.0 * stiffness } else { stiffness };
    let bars = all(&joined, &|k| double(1e3, on_wall(k)));
    let creases = all(&joined, &|k| double(0.1, on_wall(k) && !along(k)));
    let facets = all(&joined, &|k| double(1.0, on_wall(k)));
    let one = assembly(joined, [bars, creases, facets], &[]);
    let spectra = [&tied, &one].map(|assembly| modes(assembly, 40, &mut || true).unwrap().eigenvalues);
    assert_eq!(spectra.each_ref().map(Vec::len), [40, 40]);
    for (tied, one) in spectra[0].iter().zip(&spectra[1]) {
        assert!((tied - one).abs() < 1e-12 * 1e3, "{tied} {one}");
    }
    let [tied, one] = [tied, one].map(|assembly| relax(&assembly).unwrap().state.total());
    assert!((tied - MERLIN).abs() < 6e-15 && (one - MERLIN).abs() < 6e-15, "{tied:e} {one:e}");
    assert!((tied - one).abs() < 1e-10 * MERLIN, "{tied:e} {one:e}");
}

/// Claim: pieces that touch are joined to the mesh that is drawn as one, and `convert --weld` does it.
#[test]
fn pieces_are_welded() {
    let (joined, less) = welded(&apart()).unwrap();
    let drawn = tubes();
    assert_eq!(less, [10, 4]);
    let named = |sheet: &Sheet| sheet.edges.iter().map(|edge| (edge.key, edge.kind)).collect::<BTreeMap<_, _>>().len();
    assert_eq!((joined.vertices.len(), joined.polygons.len()), (drawn.vertices.len(), drawn.polygons.len()));
    assert_eq!((joined.edges.len(), named(&joined)), (drawn.edges.len(), drawn.edges.len()));
    let folder = crate::common::Folder::new().with("apart.fold", fold::write(&apart()));
    let said = folder.foldwell("convert apart.fold joined.fold --weld").well();
    assert!(said.all().contains("10; faces on others left out: 4"), "{}", said.all());
    let read = fold::parse(&folder.text("joined.fold"), "joined.fold").unwrap();
    assert_eq!(read.edges, joined.edges);
}

/// Claim: the eigenvalues of coupled tubes are those of a Hessian by differences, six of rigid motions, and exact folding
/// says nothing of them. Both couplings have one soft motion, the common folding, and the next one is less than twice as
/// stiff in aligned tubes, which squeeze, but more than a thousand times as stiff in a zipper: what zippers are for
/// (Filipov, Tachi and Paulino). Tolerance: differences of 1e-5 are good to 1e-9 of the largest eigenvalue.
#[test]
fn modes_of_coupled_tubes() {
    let gap = |pattern: &Pattern| {
        let sheet = generate(pattern).unwrap();
        let expected = eigenvalues(hessian(&sheet, [1e5, 0.1, 1.0]));
        let assembly = Assembly::patch(sheet, [1, 1]).bars(1e5).creases(0.1).facets(1.0).rest(Rest::Drawn);
        let found = modes(&assembly.build().unwrap(), 12, &mut || true).unwrap();
        assert_eq!((found.rigid_motions, found.folding_modes), (6, None));
        for (found, expected) in found.eigenvalues.iter().zip(&expected) {
            assert!((found - expected).abs() < 1e-9 * 1e5, "{found} {expected}");
        }
        found.eigenvalues[7] / found.eigenvalues[6]
    };
    let aligned = gap(&Pattern::AlignedTubes(MiuraTubes::default()));
    let zipper = gap(&Pattern::ZipperTubes(MiuraTubes::default()));
    assert!(aligned < 2.0 && zipper > 1e3, "{aligned} {zipper}");
}

/// Claim: the tubes of a zipper fold together without stretching, however far they are folded: every edge has the same
/// length in all of them. Their faces do not pass through each other, and sides that are too long to cross halfway
/// are refused. Tolerance: rounding of coordinates up to 4.
#[test]
fn zippers_fold() {
    let zipper = |fold: f64| generate(&Pattern::ZipperTubes(MiuraTubes { b: 1.2, fold, ..MiuraTubes::default() }));
    let lengths = |sheet: &Sheet| -> BTreeMap<EdgeKey, f64> {
        let length = |key: EdgeKey| (sheet.vertices[key.j] - sheet.vertices[key.i]).norm();
        sheet.edges.iter().map(|edge| (edge.key, length(edge.key))).collect()
    };
    let drawn = lengths(&zipper(0.8).unwrap());
    for fold in [0.53, 0.6, 1.0, 1.5] {
        let sheet = zipper(fold).unwrap();
        for (key, length) in lengths(&sheet) {
            // diagonals of equal length are split by either
            let expected = drawn.get(&key).copied().unwrap_or(length);
            assert!((length - expected).abs() < 1e-13, "{key:?} at {fold}: {length} {expected}");
        }
        let triangles = sheet.triangles.iter().map(|triangle| triangle.corners.map(|corner| corner.vertex)).collect();
        assert!(Finder::new(triangles).crossings(&sheet.vertices, 1e-12).pairs.is_empty(), "{fold}");
    }
    let long = Pattern::ZipperTubes(MiuraTubes { b: 2.1, ..MiuraTubes::default() });
    assert!(generate(&long).unwrap_err().to_string().starts_with("`b` is 2.1; it should be above 0 and below 2"));
}

//! Unfolding of developable sheets: `foldwell convert --flatten`.

use crate::common::Folder;
use foldwell::analysis::state::State;
use foldwell::math::Vec3;
use foldwell::sheet::generate::{Kresling, MiuraPatch};
use foldwell::sheet::{Assignment, EdgeKind, NotDevelopable, Sheet, flatten, fold, obj};
use foldwell::{Assembly, Pattern, RIGID, Rest, generate, relax};

use crate::sheet::targets::FLAT as WATERBOMB;

fn miura(fold: f64) -> Sheet {
    generate(&Pattern::MiuraPatch(MiuraPatch { fold, cells: [3, 2], ..MiuraPatch::default() })).unwrap()
}

/// The largest difference between the distances of any two vertices in two drawings.
fn apart(one: &[Vec3], other: &[Vec3]) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = (0..one.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let off = pairs.map(|(i, j)| ((one[i] - one[j]).norm() - (other[i] - other[j]).norm()).abs());
    off.fold(0.0, f64::max)
}

/// Claim: folded Miura-ori unfolds to its crease pattern, which the generator makes by another formula (fold = 0), and
/// to nothing else: all distances are the same, all vertices in the plane, faces upwards. Letters are the signs of the
/// fold angles, which become targets. Tolerance: rounding over a path of ten triangles, 1e-12 of an edge.
#[test]
fn folded_miura_unfolds_to_its_crease_pattern() {
    for fold in [0.0, 0.02, 0.3, 0.9, 1.5] {
        let (folded, pattern) = (miura(fold), flatten(&miura(fold)).unwrap());
        assert!(pattern.vertices.iter().all(|x| x.z == 0.0));
        assert!(apart(&pattern.vertices, &miura(0.0).vertices) < 1e-12, "{fold}");
        for triangle in &pattern.triangles {
            let [a, b, c] = triangle.corners.map(|corner| pattern.position(corner));
            assert!((b - a).cross(&(c - a)).z > 0.0);
        }
        for edge in pattern.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease) {
            let angle = folded.drawn_angle(edge).unwrap();
            assert!((pattern.targets[&edge.key] - angle).abs() < 1e-12);
            let shown = [Assignment::Mountain, Assignment::Valley][usize::from(angle > 0.0)];
            assert_eq!(pattern.assignment(edge), if fold == 0.0 { Assignment::Flat } else { shown });
        }
    }
}

/// Claim: the crease pattern folds back: with its targets as rest angles it relaxes without energy to the distances of
/// the sheet that was unfolded. Source: the folded sheet has these angles, rigid bars and no energy. Tolerance: a
/// residual of 1e-12 leaves angles to 1e-9, which turn distant vertices of a sheet of six edges by 1e-8.
#[test]
fn the_pattern_folds_back() {
    let folded = miura(0.6);
    let pattern = Assembly::patch(flatten(&folded).unwrap(), [1, 1]).bars(RIGID).creases(1.0).rest(Rest::Target(1.0));
    let relaxed = relax(&pattern.build().unwrap()).unwrap();
    let State { coordinates, .. } = &relaxed.state;
    let points: Vec<Vec3> = coordinates.chunks_exact(3).map(Vec3::from_column_slice).collect();
    assert!(relaxed.state.total() < 1e-16, "{}", relaxed.state.total());
    assert!(apart(&points, &folded.vertices) < 1e-8, "{:e}", apart(&points, &folded.vertices));
}

const PYRAMID: &str = "v 0 0 1\nv 1 0 0\nv 0 1 0\nv -1 0 0\nv 0 -1 0\nf 1 2 3\nf 1 3 4\nf 1 4 5\nf 1 5 2\n";

/// Claim: what cannot be unfolded is refused with the reason and the vertex: a pyramid, whose angles at the apex are
/// four of 60 degrees, a Kresling tube, two pieces, a periodic sheet. Exact up to rounding, 1e-12.
#[test]
fn what_cannot_be_unfolded_is_refused() {
    let pyramid = obj::parse(PYRAMID, "pyramid.obj").unwrap();
    let Err(NotDevelopable::Defect { vertex: 0, defect }) = flatten(&pyramid) else {
        panic!("{:?}", flatten(&pyramid))
    };
    assert!((defect - std::f64::consts::TAU / 3.0).abs() < 1e-12);
    let tube = generate(&Pattern::Kresling(Kresling::default())).unwrap();
    assert!(matches!(flatten(&tube), Err(NotDevelopable::Tube { distance, .. }) if distance > 1.0));
    let closed = generate(&Pattern::Kresling(Kresling { closed: true, ..Kresling::default() })).unwrap();
    assert!(matches!(flatten(&closed), Err(NotDevelopable::Defect { .. })));
    let two = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 3 0 0\nv 4 0 0\nv 3 1 0\nf 1 2 3\nf 4 5 6\n";
    assert_eq!(flatten(&obj::parse(two, "two.obj").unwrap()), Err(NotDevelopable::Pieces { pieces: 2 }));
    assert_eq!(flatten(&generate(&Pattern::named("miura").unwrap()).unwrap()), Err(NotDevelopable::Periodic));
}

/// Claim: the state that a relaxation with rigid bars writes unfolds to the crease pattern from which it was folded, as
/// FOLD, SVG and CP; without `--flatten` lines of it are refused with this word; what cannot be unfolded makes status 2
/// and no file. Tolerance: the bars keep their lengths to 1e-12, ten times that over the sheet, and SVG keeps all
/// digits.
#[test]
fn a_relaxed_state_unfolds_to_its_pattern() {
    let scene = "[sheet]\nmesh = \"p.fold\"\n[energy]\nbars = { stiffness = inf }\n\
                 creases = { stiffness = 1, rest = \"assigned\", fraction = 0.3 }\n[[study]]\nname = \"r\"\nkind = \"relax\"\n";
    let folder = Folder::new().with("p.fold", WATERBOMB).with("pyramid.obj", PYRAMID);
    folder.scene(scene).program("--quiet").well();
    folder.foldwell("convert out/r/r_0001.vtu q.svg").refused("--flatten");
    for file in ["q.fold", "q.svg", "q.cp"] {
        folder.foldwell(&format!("convert out/r/r_0001.vtu {file} --flatten")).well();
        // a round trip through FOLD reads files of lines
        folder.foldwell(&format!("convert {file} back.fold")).well();
        let (back, first) = (fold::read(&folder.file("back.fold")).unwrap(), fold::parse(WATERBOMB, "p.fold").unwrap());
        let lengths = |sheet: &Sheet, letter: Assignment| {
            let creases = sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter);
            let ends = creases.map(|edge| edge.key.ends().map(|end| sheet.position(end)));
            let mut lengths: Vec<f64> = ends.map(|[a, b]| (b - a).norm()).collect();
            lengths.sort_by(f64::total_cmp);
            lengths
        };
        for letter in [Assignment::Mountain, Assignment::Valley, Assignment::Boundary] {
            let [found, expected] = [&back, &first].map(|sheet| lengths(sheet, letter));
            assert_eq!(found.len(), expected.len(), "{file} {letter}");
            assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-11), "{file} {letter}");
        }
        if file == "q.fold" {
            assert!(apart(&back.vertices, &first.vertices) < 1e-11);
        }
    }
    folder.foldwell("convert pyramid.obj never.svg --flatten").refused("at vertex 0 sum to");
    assert!(!folder.has("never.svg"));
    folder.foldwell("convert p.fold q.cp --flatten --split").ends(2);
}

//! Assemblies: edges of more than two faces, pieces that are joined, bars without faces, and sheets with one side.
//!
//! Sources: the statics of three flaps, of a hanging chain and of a truss; and a Hessian of bars and hinges by differences
//! that shares no code with the library.

use crate::common::{Scene, eigenvalues};
use foldwell::analysis::bloch::bands::{DynamicalMatrix, Stiffnesses};
use foldwell::analysis::modes::modes;
use foldwell::model::{Assembly, AssemblyError, Bilinear, OfStrain};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::symmetry::symmetries;
use foldwell::sheet::{EdgeKey, EdgeKind, Glue, fold};
use foldwell::{RIGID, Rest, Sheet, relax};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

type Vec3 = Vector3<f64>;

const HOME: [usize; 2] = [0, 0];

/// The joint of two neighbours among the polygons that meet at an edge. In a zipper the faces of six sides belong to both
/// tubes: they are welded to the triangles beside them, which complete the faces of one tube, and fold against the walls
/// of five sides, which belong to the other; triangle and wall are not joined.
fn joint(sheet: &Sheet, meeting: usize, [one, other]: [usize; 2]) -> Glue {
    let sides = [one, other].map(|polygon| sheet.polygons[polygon].len());
    match (sides[0].min(sides[1]), sides[0].max(sides[1])) {
        _ if one == other => Glue::Weld,
        (3, 6) if meeting == 3 => Glue::Weld,
        (3, 5) if meeting == 3 => Glue::Free,
        _ => Glue::Fold,
    }
}

/// The Hessian of bars and hinges at rest, of all coordinates: by differences of lengths and of angles between faces,
/// and hinges between all neighbours round an edge.
pub(super) fn hessian(sheet: &Sheet, [bars, creases, facets]: [f64; 3]) -> DenseMatrix {
    let mut at: BTreeMap<[usize; 2], Vec<(usize, usize)>> = BTreeMap::new();
    for triangle in &sheet.triangles {
        let [a, b, c] = triangle.corners.map(|corner| corner.vertex);
        for (i, j, apex) in [(a, b, c), (b, c, a), (c, a, b)] {
            at.entry([i.min(j), i.max(j)]).or_default().push((apex, triangle.polygon));
        }
    }
    let mut hessian = DenseMatrix::zeros(3 * sheet.vertices.len(), 3 * sheet.vertices.len());
    let mut add = |points: Vec<usize>, stiffness: f64, measure: &dyn Fn(&[Vec3]) -> f64| {
        let places: Vec<Vec3> = points.iter().map(|&v| sheet.vertices[v]).collect();
        let slope = |k: usize| {
            let at = |step: f64| {
                let mut moved = places.clone();
                moved[k / 3][k % 3] += step;
                measure(&moved)
            };
            (at(1e-5) - at(-1e-5)) / 2e-5
        };
        let slopes: Vec<f64> = (0..3 * points.len()).map(slope).collect();
        let index = |k: usize| 3 * points[k / 3] + k % 3;
        for row in 0..slopes.len() {
            (0..slopes.len()).for_each(|k| hessian[(index(row), index(k))] += stiffness * slopes[row] * slopes[k]);
        }
    };
    for ([i, j], mut flaps) in at {
        let along = sheet.vertices[j] - sheet.vertices[i];
        add(vec![i, j], bars / along.norm(), &|x| (x[1] - x[0]).norm());
        let arm = |apex: usize| along.normalize().cross(&(sheet.vertices[apex] - sheet.vertices[i]));
        let [e1, e2] = [arm(flaps[0].0).normalize(), along.normalize().cross(&arm(flaps[0].0)).normalize()];
        let angle = |apex: usize| arm(apex).dot(&e2).atan2(arm(apex).dot(&e1)).rem_euclid(TAU);
        flaps.sort_by(|a, b| angle(a.0).total_cmp(&angle(b.0)));
        let pairs = if flaps.len() < 3 { flaps.len() - 1 } else { flaps.len() };
        for k in 0..pairs {
            let (one, other) = (flaps[k], flaps[(k + 1) % flaps.len()]);
            let stiffness = match joint(sheet, flaps.len(), [one.1, other.1]) {
                Glue::Weld => facets,
                Glue::Fold => creases,
                Glue::Free => 0.0,
            };
            add(vec![i, j, one.0, other.0], stiffness * along.norm(), &|x| {
                // from the straight continuation of one face to the other, so that flat faces are at 0
                let axis = (x[1] - x[0]).normalize();
                let [a, b] = [axis.cross(&(x[2] - x[0])), -axis.cross(&(x[3] - x[0]))];
                axis.dot(&a.cross(&b)).atan2(a.dot(&b))
            });
        }
    }
    hessian
}

/// Three flaps at the edge of length 1 from the origin to (0, 0, 1), at these angles.
fn flaps(angles: [f64; 3], glue: &str) -> Sheet {
    let apexes = angles.map(|angle: f64| format!("[{}, {}, 0.5]", angle.cos(), angle.sin())).join(", ");
    let text = format!(
        "{{\"vertices_coords\": [[0,0,0],[0,0,1],{apexes}], \"faces_vertices\": [[0,1,2],[0,1,3],[1,0,4]],
         \"edges_vertices\": [[0,1]], \"foldwell:glue\": [{glue}]}}"
    );
    fold::parse(&text, "flaps.fold").unwrap()
}

/// Claim: three flaps with three equal hinges at rest at 0 open to 120 degrees, since the fold angles sum up to pi, and
/// store `3/2 k (pi/3)^2`; two of them that are welded at the angle `a` keep it, and the others share the rest; a
/// hinge that is left alone comes to rest. Turned and mirrored drawings do the same. Tolerance: 1e-9, where
/// residuals of 1e-12 end.
#[test]
fn three_flaps() {
    let relaxed = |angles: [f64; 3], glue: &str| {
        let sheet = flaps(angles, glue);
        let assembly = Assembly::patch(sheet, [1, 1]).bars(RIGID).creases(2.0).rest(Rest::Flat);
        relax(&assembly.build().unwrap()).unwrap().state.total()
    };
    for [a, b, c] in [[0.0, 1.5, 3.5], [0.0, 3.5, 1.5], [1.0, 2.5, 4.5], [0.3, 2.0, 4.4]] {
        let all = relaxed([a, b, c], "null");
        assert!((all - 3.0 * (PI / 3.0).powi(2)).abs() < 1e-9, "{all}");
        assert!((relaxed([a, b, c], "\"fold\"") - all).abs() < 1e-9);
        // the pair from the first flap to the next in the sense of the screw
        let first = (b - a).rem_euclid(TAU).min((c - a).rem_euclid(TAU));
        let welded = relaxed([a, b, c], "[\"weld\", \"fold\", \"fold\"]");
        assert!((welded - 2.0 * (first / 2.0).powi(2)).abs() < 1e-9, "{welded} {first}");
    }
    let free = relaxed([0.0, 1.8, 4.0], "[\"free\", \"fold\", \"free\"]");
    assert!(free.abs() < 1e-12, "{free}");
    let none = flaps([0.0, 1.8, 4.0], "\"free\"");
    assert!(none.edges.iter().all(|edge| edge.kind == EdgeKind::Boundary) && none.edges.len() == 7);
}

/// Claim: a file with glue, and with edges of no face, is read as it was written; wrong words are refused with the place,
/// and so is exact folding of such a sheet.
#[test]
fn files_of_assemblies() {
    let sheet = flaps([0.0, 1.5, 3.5], "[\"weld\", \"fold\", \"free\"]");
    assert_eq!(fold::parse(&fold::write(&sheet), "flaps.fold").unwrap(), sheet);
    let text = fold::write(&sheet);
    for (wrong, message) in [
        ("[\"weld\", \"fold\"]", "2 word(s) for edge [0, 1] of 3 face(s)"),
        ("\"glued\"", "entry 0 of `foldwell:glue`"),
    ] {
        let text = text.replacen("[\"weld\",\"fold\",\"free\"]", wrong, 1);
        let error = fold::parse(&text, "flaps.fold").unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    let lines = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1.0 }\n[[study]]\nname = \"t\"\nkind = \"trace\"\n";
    let scene = Scene::on("mesh = \"flaps.fold\"", lines).with("flaps.fold", text);
    scene.refused("studies of kind trace fold surfaces with two sides exactly");
}

/// Claim: scenes mean all hinges of an edge: a lock without an angle keeps the drawn state of the three flaps, a row of a
/// table is for each of them, and a lock with an angle is refused; a bar without a face has no stiffness from the
/// material. The stiffness of the shared bar is that of three triangles. Tolerance: rounding; 1e-9 of the energy.
#[test]
fn what_scenes_say_of_joints() {
    let drawn = [0.0, 1.5, 3.5];
    let text = fold::write(&flaps(drawn, "null"));
    let scene = |lines: &str, creases: &str| {
        let terms =
            format!("[energy]\nbars = {{ stiffness = inf }}\ncreases = {{ {creases}, rest = \"flat\" }}\n{lines}");
        let study = "[[study]]\nname = \"r\"\nkind = \"relax\"\n";
        Scene::on("mesh = \"flaps.fold\"", &format!("{terms}{study}")).with("flaps.fold", text.clone())
    };
    let energy = |scene: Scene| scene.converged().relaxed("r").energy.total;
    let angles = [PI - 1.5, PI - 2.0, PI - (TAU - 3.5)];
    let held = angles.iter().map(|angle| angle.powi(2)).sum::<f64>();
    let locked = energy(scene("[[lock]]\ncrease = [0, 1, 0, 0]\n", "stiffness = 2.0"));
    assert!((locked - held).abs() < 1e-9, "{locked} {held}");
    scene("[[lock]]\ncrease = [0, 1, 0, 0]\nangle = 1.0\n", "stiffness = 2.0").refused("the crease has 3 hinges");
    let listed = scene("", "stiffness = { file = \"k.csv\" }").with("k.csv", "i,j,n1,n2,stiffness\n0,1,0,0,2.0\n");
    assert!((energy(listed) - 3.0 * (PI / 3.0).powi(2)).abs() < 1e-9);

    for [i, j] in [[0, 1], [1, 0]] {
        let lock = |angle| {
            let bare = Assembly::patch(flaps(drawn, "null"), [1, 1]).bars(RIGID).creases(2.0);
            bare.lock(EdgeKey { i, j, shift: [0, 0], round: 0 }, angle).build()
        };
        assert_eq!(lock(None).unwrap().terms().locks.len(), 3);
        assert!(matches!(lock(Some(1.0)), Err(AssemblyError::SeveralHinges { hinges: 3, .. })));
    }

    let material = foldwell::model::Material { young: 3.0, poisson: 0.25, thickness: 0.1, crease_length: None };
    let sheet = flaps(drawn, "null");
    let assembly = Assembly::patch(sheet.clone(), [1, 1]).material(material).creases(1.0).build().unwrap();
    let bars = material.bars(&assembly);
    let section = |edge: usize| {
        let ends = [sheet.edges[edge].key.i, sheet.edges[edge].key.j];
        let beside = sheet
            .triangles
            .iter()
            .filter(|triangle| ends.iter().all(|end| triangle.corners.iter().any(|corner| corner.vertex == *end)));
        beside
            .map(|triangle| {
                let [a, b, c] = triangle.corners.map(|corner| sheet.vertices[corner.vertex]);
                let perimeter = (b - a).norm() + (c - b).norm() + (a - c).norm();
                (b - a).cross(&(c - a)).norm() * 0.1 / (0.75 * perimeter)
            })
            .sum::<f64>()
    };
    for (edge, found) in sheet.edges.iter().enumerate().filter(|(_, found)| found.key.has_bar()) {
        assert!((bars.of(edge) - 3.0 * section(edge)).abs() < 1e-14, "{:?}", found.key);
    }
    let alone = "{\"vertices_coords\": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], \"faces_vertices\": [[0,1,2]], \"edges_vertices\": [[1,3]]}";
    let lines = "[material]\nyoung = 1.0\npoisson = 0.3\nthickness = 0.1\n[energy]\nbars = {}\n[[study]]\nname = \"r\"\nkind = \"relax\"\n";
    Scene::on("mesh = \"alone.fold\"", lines).with("alone.fold", alone).refused("which has no face");
}

/// A chain of bars without faces between two supports, drawn as a circular arc.
fn chain(bars: usize, length: f64, span: f64) -> Sheet {
    let angle = |k: usize| PI * k as f64 / bars as f64;
    let coords: Vec<[f64; 3]> =
        (0..=bars).map(|k| [-0.5 * span * angle(k).cos(), 0.0, -0.5 * length * angle(k).sin()]).collect();
    let edges: Vec<[usize; 2]> = (0..bars).map(|k| [k, k + 1]).collect();
    let text = format!("{{\"vertices_coords\": {coords:?}, \"faces_vertices\": [], \"edges_vertices\": {edges:?}}}");
    fold::parse(&text, "chain.fold").unwrap()
}

/// Claim: a chain of equal bars without faces, rigid ones or cables that stretch, hangs as statics say: with the weight 1
/// at each joint and the pull `h`, bar `k` of `n` has the slope `(k - (n - 1)/2) / h` and is longer by its force over
/// `EA`, and `h` is that for which the bars reach over the span. Tolerance: 1e-9, where residuals of 1e-12 end.
#[test]
fn a_hanging_chain() {
    let (bars, span, length) = (10, 2.0, 3.0);
    let each = length / bars as f64;
    for stiffness in [RIGID, 100.0] {
        let mut builder = Assembly::patch(chain(bars, length, span), [1, 1]).bars(stiffness);
        if stiffness.is_finite() {
            builder = builder.bar_law(OfStrain(Bilinear { ratio: 0.0, at: [0.0, f64::INFINITY] }));
        }
        builder = builder.rest_lengths(foldwell::model::RestLengths::PerEdge(vec![each; bars]));
        builder = builder.pin(0, HOME, [true; 3]).pin(bars, HOME, [true; 3]);
        for joint in 1..bars {
            builder = builder.load(joint, HOME, [0.0, 0.0, -1.0]);
        }
        let slope = |k: usize, pull: f64| (k as f64 - (bars - 1) as f64 / 2.0) / pull;
        let along = |k: usize, pull: f64| {
            let steepness = slope(k, pull).hypot(1.0);
            each * (1.0 + pull * steepness / stiffness) / steepness
        };
        let reach = |pull: f64| (0..bars).map(|k| along(k, pull)).sum::<f64>();
        let (mut low, mut high) = (1e-3, 1e3);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if reach(middle) < span { low = middle } else { high = middle }
        }
        let state = relax(&builder.build().unwrap()).unwrap().state;
        let mut depth = 0.0;
        for k in 0..bars - 1 {
            depth += along(k, low) * slope(k, low);
            let found = state.coordinates[3 * (k + 1) + 2];
            assert!((found - depth).abs() < 1e-9, "joint {} of {stiffness}: {found} {depth}", k + 1);
        }
    }
}

/// A Moebius band of `n` quadrangles.
fn moebius(n: usize) -> String {
    let point = |k: usize, side: f64| {
        let (round, turn) = (TAU * k as f64 / n as f64, PI * k as f64 / n as f64);
        let radius = 2.0 + side * 0.4 * turn.cos();
        [radius * round.cos(), radius * round.sin(), side * 0.4 * turn.sin()]
    };
    let coords: Vec<[f64; 3]> = (0..n).flat_map(|k| [point(k, -1.0), point(k, 1.0)]).collect();
    let next = |k: usize| if k + 1 < n { [2 * k + 2, 2 * k + 3] } else { [1, 0] };
    let faces: Vec<[usize; 3]> = (0..n)
        .flat_map(|k| {
            let [a, b] = next(k);
            [[2 * k, a, b], [2 * k, b, 2 * k + 1]]
        })
        .collect();
    format!("{{\"vertices_coords\": {coords:?}, \"faces_vertices\": {faces:?}}}")
}

/// Claim: a Moebius band, which has one side, is a sheet: drawn at rest it has no energy, no more zero modes than its
/// count of bars says, and the eigenvalues of a Hessian by differences. A sheet with two sides of which one
/// face is turned over is refused as before.
#[test]
fn a_moebius_band() {
    let sheet = fold::parse(&moebius(9), "moebius.fold").unwrap();
    assert!(!sheet.is_surface());
    assert_eq!(sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease).count(), 18);
    let expected = eigenvalues(hessian(&sheet, [1e3, 1.0, 1.0]));
    let assembly = Assembly::patch(sheet, [1, 1]).bars(1e3).creases(1.0).rest(Rest::Drawn).build().unwrap();
    assert!(relax(&assembly).unwrap().state.total() < 1e-20);
    let found = modes(&assembly, 10, &mut || true).unwrap();
    for (found, expected) in found.eigenvalues.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-9 * 1e3, "{found} {expected}");
    }
    let turned = "{\"vertices_coords\": [[0,0,0],[1,0,0],[1,1,0],[0,1,0.2]], \"faces_vertices\": [[0,1,2],[0,3,2]]}";
    let error = fold::parse(turned, "turned.fold").unwrap_err().to_string();
    assert!(error.contains("run along edge"), "{error}");
}

/// Claim: a periodic block of cells, where three and four faces meet at every edge, has on a torus of 2 x 2 cells the
/// eigenvalues of the dynamical matrix at the four waves of that period. Two ways: the model, and bands of the sheet.
/// Tolerance: rounding of the largest, 1e-12 of it.
#[test]
fn a_block_of_cells_has_the_bands_of_its_torus() {
    let coords = [[0.0, 0.0, 0.0], [1.0, 0.1, 0.0], [0.2, 1.0, 0.0], [1.2, 1.1, 0.0]];
    let above = coords.map(|[x, y, _]| [x + 0.1, y - 0.05, 0.8]);
    let text = format!(
        "{{\"vertices_coords\": {:?}, \"foldwell:lattice\": [[1, 0.1, 0], [0.2, 1, 0]],
         \"faces_vertices\": [[0,1,3,2],[4,5,7,6],[0,1,5,4],[0,2,6,4]]}}",
        [coords, above].concat()
    );
    let sheet = fold::parse(&text, "block.fold").unwrap();
    assert!(symmetries(&sheet).is_empty(), "symmetries say nothing of hinges round an edge");
    let stiffnesses = Stiffnesses { bars: 30.0, creases: 1.0, facets: 2.0 };
    let matrix = DynamicalMatrix::new(&sheet, stiffnesses).unwrap();
    let waves = [[0.0, 0.0], [PI, 0.0], [0.0, PI], [PI, PI]];
    let mut expected: Vec<f64> = waves.iter().flat_map(|&q| matrix.bands(q).unwrap()).collect();
    expected.sort_by(f64::total_cmp);
    let torus = Assembly::fixed_torus(sheet, [2, 2]).bars(30.0).creases(1.0).facets(2.0).rest(Rest::Drawn);
    let found = modes(&torus.build().unwrap(), 24, &mut || true).unwrap().eigenvalues;
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        assert!((found - expected).abs() < 1e-12 * 1e3, "{found} {expected}");
    }
}

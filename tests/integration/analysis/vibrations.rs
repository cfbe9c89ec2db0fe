//! Frequencies: mass and stiffness scale them, zeros stay zeros, and the generalized eigenvalues are those of another
//! library and of closed forms.

use crate::common::{Scene, Testing, eigenvalues, energy_hessian, mesh};
use approx::assert_abs_diff_eq;
use foldwell::analysis::bloch::bands::{DynamicalMatrix, Stiffnesses};
use foldwell::analysis::bloch::{BlochError, Density};
use foldwell::analysis::modes::{DENSE_LIMIT, Vibrations, modes, modes_at};
use foldwell::model::Configuration;
use foldwell::model::{AssemblyError, Builder, Gauge, Mass};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::fold;
use foldwell::sheet::generate::{Miura, MiuraPatch, Pattern, Random};
use foldwell::{Assembly, RIGID, Rest, Sheet, generate, relax};

fn miura_patch() -> Sheet {
    generate(&Pattern::MiuraPatch(MiuraPatch { cells: [3, 3], ..MiuraPatch::default() })).unwrap()
}

fn random(seed: u64) -> Sheet {
    generate(&Pattern::Random(Random { seed, ..Random::default() })).unwrap()
}

fn vibrations(builder: Builder, count: usize) -> Vibrations {
    modes(&builder.build().unwrap(), count, &mut || true).unwrap().vibrations.unwrap()
}

/// Returns the matrices `H` and the diagonal of `M`, by coordinates of all vertices, of an assembly at its drawn state.
fn matrices(assembly: &Assembly) -> (DenseMatrix, Vec<f64>) {
    let model = assembly.model(Gauge::Free);
    let masses = assembly.masses().unwrap().into_iter().flat_map(|mass| [mass; 3]).collect();
    (energy_hessian(&model, &model.start()), masses)
}

/// Claim: with all masses multiplied by `c` and all stiffnesses by `d`, every frequency of a Miura-ori patch is
/// multiplied by `sqrt(d / c)`, and the zeros, six rigid motions, are exactly 0 before and after. With lengths, areas
/// and crease lengths multiplied by `s`, bar constants `EA / L` fall as `1 / s` and those of hinges, `k L` over a
/// squared length, too, so that a mass per area gives `s^(-3/2)`. Source: `H u = omega^2 M u`. Tolerance: 1e-9
/// relative, since the softest frequency squared is 1e-6 of the stiffest entry, and rounding 1e-16 of it.
#[test]
fn frequencies_scale() {
    let patch = |sheet: Sheet, mass: Mass, d: f64| {
        vibrations(Assembly::patch(sheet, [1, 1]).bars(1e3 * d).creases(0.1 * d).facets(d).mass(mass), 24)
    };
    for mass in [Mass::Vertex as fn(f64) -> Mass, Mass::Area] {
        let reference = patch(miura_patch(), mass(1.0), 1.0).frequencies();
        assert_eq!((reference.len(), &reference[..6]), (24, &[Some(0.0); 6][..]));
        assert!(reference[6..].iter().all(|frequency| *frequency > Some(0.01)), "{reference:?}");
        for (c, d) in [(4.0, 1.0), (1e-6, 1.0), (1.0, 0.01), (7.3, 1e6)] {
            let found = patch(miura_patch(), mass(c), d).frequencies();
            assert_eq!(found[..6], [Some(0.0); 6]);
            for (found, reference) in found[6..].iter().zip(&reference[6..]) {
                let ratio = found.unwrap() / reference.unwrap() / (d / c).sqrt();
                assert!((ratio - 1.0).abs() <= 1e-9, "c = {c}, d = {d}: {ratio}");
            }
        }
    }
    let per_area = |s: f64| patch(crate::common::scaled(miura_patch(), s), Mass::Area(1.0), 1.0).frequencies();
    for (large, small) in per_area(3.0)[6..].iter().zip(&per_area(1.0)[6..]) {
        let ratio = large.unwrap() / small.unwrap() * 3f64.powf(1.5);
        assert!((ratio - 1.0).abs() <= 1e-9, "{ratio}");
    }
}

/// Claim: a mass per area is shared out to the vertices so that the sum is density times area, and the centre of mass
/// is that of the sheet: on Miura-ori the area of its parallelograms, `a b sin(sector)` each; a cell of the periodic
/// sheet has four of them. Tolerance: rounding of some 50 terms.
#[test]
fn area_masses_sum_up() {
    let area = 3f64.sqrt() / 2.0;
    let sheet = miura_patch();
    let masses = Assembly::patch(sheet.clone(), [1, 1]).mass(Mass::Area(0.3)).build().unwrap().masses().unwrap();
    assert_abs_diff_eq!(masses.iter().sum::<f64>(), 0.3 * 36.0 * area, epsilon = 1e-13);
    let centre = |weights: &[f64], points: &[nalgebra::Vector3<f64>]| {
        let sum: nalgebra::Vector3<f64> = weights.iter().zip(points).map(|(m, p)| p * *m).sum();
        sum / weights.iter().sum::<f64>()
    };
    // centroids of parallelograms of equal area, from their corners
    let middles: Vec<_> = sheet
        .polygons
        .iter()
        .map(|corners| corners.iter().map(|corner| sheet.position(*corner)).sum::<nalgebra::Vector3<f64>>() / 4.0)
        .collect();
    let off = centre(&masses, &sheet.vertices) - centre(&vec![1.0; middles.len()], &middles);
    assert!(off.norm() <= 1e-13, "{off:?}");
    let cell = generate(&Pattern::Miura(Miura::default())).unwrap();
    let of_cell = Mass::Area(0.3).of_cell(&cell);
    assert_abs_diff_eq!(of_cell.iter().sum::<f64>(), 0.3 * 4.0 * area, epsilon = 1e-14);
    let torus = Assembly::fixed_torus(cell, [2, 3]).mass(Mass::Area(0.3)).build().unwrap().masses().unwrap();
    for cell in torus.chunks(of_cell.len()) {
        cell.iter().zip(&of_cell).for_each(|(a, b)| assert_abs_diff_eq!(a, b, epsilon = 1e-15));
    }
}

/// Claim: squared frequencies with unequal masses are the eigenvalues of `L^-1 H L^-T` with nalgebra's Cholesky factor
/// `L` of `M`, for patches, pinned patches and fixed tori, by the dense and by the sparse way; their motions fulfil
/// `H u = omega^2 M u` and `u^T M u = 1`. Tolerance: 1e-8 relative and 1e-13 of the largest, as of the eigenvalues.
#[test]
fn generalized_eigenvalues_agree_with_another_library() {
    let star = || mesh("open-star");
    let cases = [
        (Assembly::patch(random(3), [2, 2]), 6),
        (Assembly::fixed_torus(random(4), [2, 2]), 3),
        (
            Assembly::patch(star(), [2, 2]).pin(0, [0, 0], [true; 3]).pin(1, [1, 1], [true; 3]).pin(
                2,
                [1, 0],
                [true; 3],
            ),
            0,
        ),
        (Assembly::patch(star(), [10, 11]), 6),
    ];
    for (builder, zeros) in cases {
        let assembly = builder.bars(1e3).creases(1.0).mass(Mass::Area(0.2)).build().unwrap();
        let model = assembly.model(Gauge::Free);
        let (hessian, masses) = matrices(&assembly);
        let masses = model.unknowns(&masses);
        let factor = DenseMatrix::from_diagonal(&masses.clone().into()).cholesky().unwrap().l();
        let inverse = factor.try_inverse().unwrap();
        let expected = eigenvalues(&inverse * &hessian * inverse.transpose());
        let largest = expected[expected.len() - 1];
        println!("{} unknowns, of the dense way at most {DENSE_LIMIT}", masses.len());
        let found = modes(&assembly, 20, &mut || true).unwrap().vibrations.unwrap();
        assert_eq!(found.squares[..zeros], vec![0.0; zeros]);
        assert!(found.squares[zeros] > 0.0 && found.squares.len() == 20);
        for ((square, vector), expected) in found.squares.iter().zip(&found.vectors).zip(&expected) {
            assert!(
                (square - expected).abs() <= 1e-8 * expected.abs() + 1e-13 * largest,
                "{square:e} for {expected:e}"
            );
            let u = nalgebra::DVector::from_vec(model.unknowns(vector));
            let mass_times_u = u.component_mul(&nalgebra::DVector::from_column_slice(&masses));
            assert_abs_diff_eq!(u.dot(&mass_times_u), 1.0, epsilon = 1e-12);
            let off = (&hessian * &u - &mass_times_u * *square).norm() / mass_times_u.norm();
            assert!(off <= 1e-7 * largest, "{off:e}");
        }
    }
}

/// Claim: two rigid right-angled pairs of triangles that share a crease of length `2 b` between wings at the distance
/// `a` vibrate with `omega^2 = (2 k L / a^2) (1 / m_wing + 1 / m_end)`, from the two heights with momentum zero. With
/// equal masses `m` that is `8 k b / (a^2 m)`, with a mass per area `18 k / (rho a^3)`. It is the only motion that is
/// not rigid. Tolerance: rounding.
#[test]
fn a_single_hinge() {
    let (a, b, k) = (0.7f64, 1.3, 0.4);
    let text = format!(
        r#"{{"vertices_coords": [[0, {0:?}, 0], [0, {b:?}, 0], [{1:?}, 0, 0], [{a:?}, 0, 0]], "faces_vertices": [[0, 1, 2], [1, 0, 3]],
        "edges_vertices": [[0, 1], [1, 2], [2, 0], [0, 3], [3, 1]], "edges_assignment": ["V", "B", "B", "B", "B"]}}"#,
        -b, -a
    );
    let sheet = fold::parse(&text, "hinge.fold").unwrap();
    let expected = [(Mass::Vertex(2.5), 8.0 * k * b / (a * a * 2.5)), (Mass::Area(1.7), 18.0 * k / (1.7 * a.powi(3)))];
    for (mass, square) in expected {
        let found = vibrations(Assembly::patch(sheet.clone(), [1, 1]).bars(RIGID).creases(k).mass(mass), 12);
        assert_eq!((found.squares.len(), &found.squares[..6]), (7, &[0.0; 6][..]));
        assert_abs_diff_eq!(found.squares[6] / square, 1.0, epsilon = 1e-13);
    }
}

/// Returns a state of equilibrium, that of random rest angles, with its tensions.
fn equilibrium(assembly: &Assembly) -> Configuration {
    relax(assembly).unwrap().configuration
}

/// Claim: eigenvalues that are zero are found with at most a tenth of the bound below which they are called zero, and
/// the smallest others are above ten times that bound: bars from soft to rigid, drawn and under stress, by the dense
/// and by the sparse way. With one mass 1 for all vertices the squares before rounding are the eigenvalues.
#[test]
fn zeros_are_told_from_small_frequencies() {
    let small = [1.0, 1e3, 1e6, 1e9, RIGID].into_iter().flat_map(|bars| [(3, bars, 0.0), (3, bars, 0.1)]);
    for (cells, bars, off) in small.chain([(11, 1e3, 0.0), (11, RIGID, 0.0)]) {
        let rest = Assembly::patch(random(1), [cells; 2]).build().unwrap().rest_per_hinge(off, 1);
        let builder = Assembly::patch(random(1), [cells; 2]).bars(bars).creases(1.0).rest(Rest::PerEdge(rest));
        let assembly = builder.mass(Mass::Vertex(1.0)).build().unwrap();
        let found = modes_at(&assembly, &equilibrium(&assembly), 8, &mut || true).unwrap();
        let Vibrations { squares, rounding, .. } = found.vibrations.unwrap();
        let zero = found.eigenvalues[..6].iter().fold(0.0f64, |most, value| most.max(value.abs())) / rounding;
        let other = found.eigenvalues[6] / rounding;
        println!("{cells} x {cells} cells, bars {bars:e}, {off}: zeros {zero:.1e}, then {other:.1e} of the bound");
        assert!(zero <= 0.1 && other >= 10.0, "{zero:e}, {other:e}");
        assert_eq!((&squares[..6], &squares[6..]), (&[0.0; 6][..], &found.eigenvalues[6..]));
    }
}

/// Claim: about a state that is no minimum, motions that grow have no frequency but a rate, `sqrt(-lambda / m)`, as
/// many as there are negative eigenvalues; all others have a frequency and no rate.
#[test]
fn growing_motions_have_no_frequency() {
    let bare = Assembly::patch(random(2), [3, 3]);
    let rest = bare.clone().build().unwrap().rest_per_hinge(2.0, 5);
    let assembly = bare.bars(1e3).creases(1.0).rest(Rest::PerEdge(rest)).mass(Mass::Vertex(4.0)).build().unwrap();
    let found = modes(&assembly, 30, &mut || true).unwrap();
    let vibrations = found.vibrations.unwrap();
    let negative = found.eigenvalues.iter().filter(|value| **value < -vibrations.rounding).count();
    assert!(negative > 0 && negative < 24, "{negative}");
    let (frequencies, rates) = (vibrations.frequencies(), vibrations.growth_rates());
    assert!(frequencies[..negative].iter().all(Option::is_none) && frequencies[negative..].iter().all(Option::is_some));
    for (rate, eigenvalue) in rates[..negative].iter().zip(&found.eigenvalues) {
        assert_abs_diff_eq!(rate.unwrap(), (-eigenvalue / 4.0).sqrt(), epsilon = 1e-12 * rate.unwrap());
    }
    assert_eq!(rates[negative..], vec![None; 30 - negative]);
}

/// Claim: a mass needs coordinates that are those of vertices, each with a mass; numbers that are no mass are refused.
#[test]
fn what_has_no_mass_is_refused() {
    let star = || mesh("open-star");
    let energy = |builder: Builder, mass: Mass| builder.bars(1e3).creases(1.0).mass(mass).build().unwrap();
    let refused = |assembly: &Assembly| modes(assembly, 3, &mut || true).unwrap_err().to_string();
    let line = Assembly::patch(star(), [2, 2]).part([(0, [0, 0]), (1, [0, 0])], [true; 6]);
    for (builder, of) in [
        (Assembly::torus(star(), [1, 1]), "the vectors of a free lattice"),
        (Assembly::screw(star(), [1, 1]), "the turns of a cylinder"),
        (line, "a motion of part 0 moves no mass"),
    ] {
        let said = refused(&energy(builder, Mass::Vertex(1.0)));
        assert!(said.contains(of), "{said}");
    }
    // a cell of one quadrilateral and one opening: a vertex at the rim of the patch has its faces in cells beyond it
    let said = refused(&energy(Assembly::patch(mesh("kirigami"), [2, 2]), Mass::Area(1.0)));
    assert!(said.starts_with("vertex 8 of cell [1, 1] belongs to no face"), "{said}");
    for mass in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for mass in [Mass::Vertex(mass), Mass::Area(mass)] {
            let error = Assembly::patch(star(), [1, 1]).mass(mass).build().unwrap_err();
            assert!(matches!(error, AssemblyError::Mass { .. }) && error.to_string().contains("not a positive number"));
        }
    }
    // without eigenvalues nothing reads the mass
    assert!(modes(&energy(Assembly::torus(star(), [1, 1]), Mass::Vertex(1.0)), 0, &mut || true).is_ok());
}

/// Returns the dynamical matrix of a cell whose bars have 1e3 and whose creases 1, with a mass per area.
fn heavy(sheet: &Sheet) -> DynamicalMatrix {
    let stiffnesses = Stiffnesses { bars: 1e3, creases: 1.0, facets: 0.0 };
    DynamicalMatrix::new(sheet, stiffnesses).unwrap().with_masses(&Mass::Area(0.2).of_cell(sheet))
}

/// Claim: the frequencies of waves at `q = 0` are those of the fixed torus of one cell, three zeros exactly; those at
/// the wavenumbers `2 pi (k1 / 2, k2 / 3)` together are all frequencies of the torus of 2 x 3 cells. Source: waves that
/// repeat after these cells are its vibrations. Tolerance: squares to 1e-13 of the largest.
#[test]
fn bands_are_the_frequencies_of_tori() {
    for sheet in [mesh("open-star"), random(6)] {
        let matrix = heavy(&sheet);
        for cells in [[1, 1], [2, 3]] {
            let builder = Assembly::fixed_torus(sheet.clone(), cells).bars(1e3).creases(1.0).mass(Mass::Area(0.2));
            let torus = vibrations(builder, 3 * sheet.vertices.len() * cells[0] * cells[1]).squares;
            let mut bands = matrix.on_grid(cells, |_| true).unwrap().concat();
            bands.sort_by(f64::total_cmp);
            assert_eq!((bands.len(), &bands[..3], &torus[..3]), (torus.len(), &[0.0; 3][..], &[0.0; 3][..]));
            assert!(bands[3] > 0.1, "{}", bands[3]);
            let largest = torus[torus.len() - 1];
            for (band, square) in bands.iter().zip(&torus) {
                assert_abs_diff_eq!(band * band, square, epsilon = 1e-13 * largest);
            }
        }
    }
}

/// Claim: the number of states below a frequency is that of a histogram at 100 x 100 other wavenumbers, and the
/// integral of the density is the number of bands to rounding. Tolerance: 0.02 of 12 states, some spacings of the
/// grids.
#[test]
fn density_of_states_against_a_histogram() {
    let sheet = mesh("open-star");
    let (matrix, bands) = (heavy(&sheet), 3 * sheet.vertices.len());
    let grid = [24, 24];
    let density = Density::new(&matrix.on_grid(grid, |_| true).unwrap(), grid, 40);
    assert_abs_diff_eq!(density.integral(), bands as f64, epsilon = 1e-12);
    // wavenumbers off the grid, without its symmetry
    let shifted = |k: usize| std::f64::consts::TAU * (k as f64 + 0.37) / 100.0;
    let wavenumbers = (0..10_000).map(|k| [shifted(k % 100), shifted(k / 100)]);
    let all: Vec<f64> = wavenumbers.flat_map(|q| matrix.frequencies(q).unwrap()).collect();
    let width = density.edges[1];
    let mut states = 0.0;
    for (edge, value) in density.edges[1..].iter().zip(&density.values) {
        states += value * width;
        let counted = all.iter().filter(|frequency| *frequency <= edge).count() as f64 / 10_000.0;
        assert_abs_diff_eq!(states, counted, epsilon = 0.02);
    }
    assert!(matches!(matrix.on_grid(grid, |step| step < 5), Err(BlochError::Interrupted)));
}

/// Claim: the scene of frequencies writes six zeros and the others into its summary and its table, and a picture of
/// every vibration; its eigenvalues are those without mass. With one mass 4 for all vertices the frequencies are
/// `sqrt(lambda / 4)` with the eigenvalues `lambda` of a published program. A study that is kept has the same
/// frequencies.
#[test]
fn a_scene_with_mass() {
    let scene = Scene::of("miura-frequencies");
    let ran = scene.converged();
    let found = ran.modes("spectrum");
    let frequencies = found.frequencies.clone().unwrap();
    assert_eq!((frequencies.len(), &frequencies[..6], found.growth_rates.len()), (12, &[Some(0.0); 6][..], 0));
    let table = ran.out.text("spectrum-frequencies.csv");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("mode,frequency,growth_rate"));
    for (k, (line, frequency)) in lines.zip(&frequencies).enumerate() {
        assert_eq!(line, format!("{k},{:?},", frequency.unwrap()));
    }
    for file in ["spectrum-vibrations.pvd", "spectrum/spectrum_vibration_0011.vtu", "spectrum/spectrum_0011.vtu"] {
        assert!(ran.out.has(file), "{file}");
    }
    let picture = ran.out.text("spectrum.svg");
    assert!(picture.contains("vibration 6, frequency 0.1676"), "the picture is that of the slowest vibration");
    let again = scene.clone().resumed().ran();
    assert_eq!((again.report.kept.len(), again.modes("spectrum")), (1, found));

    let vertex = scene.clone().replaced("area = 0.1", "vertex = 4.0").out("vertex").ran();
    let vertex = vertex.modes("spectrum");
    assert_eq!(vertex.eigenvalues, found.eigenvalues);
    let published = [5.97381064e-3, 6.94778873e-3, 2.88042394e-2, 4.28524374e-2f64];
    for (frequency, published) in vertex.frequencies.as_ref().unwrap()[6..].iter().zip(published) {
        assert_abs_diff_eq!(frequency.unwrap() / (published / 4.0).sqrt(), 1.0, epsilon = 1e-8);
    }
    let without = scene.replaced("mass = { area = 0.1 }", "").out("without").ran();
    assert!(!without.out.has("spectrum-frequencies.csv"));
    let without = without.modes("spectrum");
    assert_eq!((&without.frequencies, &without.eigenvalues), (&None, &found.eigenvalues));
}

/// Claim: a study of bands of a sheet with mass adds columns of frequencies to its table, whose columns without mass
/// stay what they are, a density of states with as many states as bands, and a picture of both.
#[test]
fn a_scene_of_waves_with_mass() {
    let scene = Scene::of("star-waves");
    let with = scene.converged().out;
    let without = scene.replaced("mass = ", "# ").replaced("density = ", "# ").out("without").converged().out;
    let [table, bare] = [&with, &without].map(|out| out.table("waves_bands.csv"));
    assert_eq!((table.len(), table.header.len(), bare.header.len()), (bare.len(), 3 + 12 + 12, 3 + 12));
    assert!(table.header[..15] == bare.header && table.rows.iter().zip(&bare.rows).all(|(a, b)| a[..15] == b[..]));
    let first = (table.header[15].as_str(), table.rows[0][15].as_str(), table.rows[0][17].as_str());
    assert_eq!(first, ("frequency_0", "0.0", "0.0"));
    let density = with.table("waves-density.csv");
    assert_abs_diff_eq!(density.numbers()[density.len() - 1][3], 12.0, epsilon = 1e-12);
    assert!(with.has("waves-bands.svg") && !without.has("waves-bands.svg"));
}

/// Claim: a density of states without a mass, a mass that no study reads, or that not every coordinate has, is refused
/// with its place and what would be right.
#[test]
fn scenes_whose_mass_means_nothing() {
    let scene = |sheet: &str, study: &str| {
        Scene::new(format!(
            "mass = {{ area = 0.1 }}\n[sheet]\n{sheet}\n[energy]\nbars = {{ stiffness = 1e3 }}\ncreases = {{ stiffness = 1.0 }}\n\
             [[study]]\nname = \"a\"\n{study}\n"
        ))
    };
    let star = |domain: &str| format!("generate = {{ pattern = \"random\" }}\ndomain = \"{domain}\"");
    let modes = "kind = \"modes\"\neigenvalues = 3";
    for (sheet, study, said) in [
        (star("patch"), "kind = \"relax\"", "scene.toml:1:8: no study of this scene reads the mass"),
        (star("patch"), "kind = \"modes\"", "no study of this scene reads the mass"),
        (star("patch"), "kind = \"bloch\"", "no study of this scene reads the mass"),
        ("mesh = \"kirigami.fold\"".to_owned(), "kind = \"bloch\"\ndensity = {}", "bands need an energy of springs"),
        (star("torus"), modes, "scene.toml:1:8: frequencies are those of vertices: the vectors of a free lattice"),
        (star("screw"), modes, "the turns of a cylinder have no mass"),
        ("mesh = \"kirigami.fold\"\ncells = [2, 2]".to_owned(), modes, "vertex 8 of cell [1, 1] belongs to no face"),
    ] {
        scene(&sheet, study).refused(said);
    }
}

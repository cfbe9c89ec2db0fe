//! Stiffnesses that follow from an elastic sheet, against closed forms of plates.

use crate::common::{Scene, mesh, on};
use foldwell::model::{Boundary, Material, Site};
use foldwell::sheet::fold;
use foldwell::{Assembly, Sheet, relax};
use nalgebra::Matrix2;

/// Newtons and millimetres, about those of paper.
const PAPER: Material = Material { young: 3000.0, poisson: 1.0 / 3.0, thickness: 0.1, crease_length: Some(25.0) };

/// One vertex whose neighbours make equilateral triangles of side 2.
fn equilateral() -> Sheet {
    let text = r#"{"vertices_coords": [[0, 0], [2, 0], [3, 1.7320508075688772], [1, 1.7320508075688772]],
        "faces_vertices": [[0, 1, 3], [1, 2, 3]], "foldwell:lattice": [[2, 0, 0], [1, 1.7320508075688772, 0]]}"#;
    fold::parse(text, "equilateral.fold").unwrap()
}

/// Returns the places of two sites of an edge, or of three of a triangle, in the plane.
fn places<const N: usize>(assembly: &Assembly, sites: [Site; N]) -> [[f64; 2]; N] {
    let drawn = assembly.drawn();
    drawn.domain.points(&drawn.coordinates, &sites).map(|p| [p.x, p.y])
}

/// Returns the area of all triangles, and the energy of all bars where the sheet has this strain everywhere.
fn area_and_energy(assembly: &Assembly, material: Material, strain: Matrix2<f64>) -> [f64; 2] {
    let (bars, mut area, mut energy) = (material.bars(assembly), 0.0, 0.0);
    for triangle in &assembly.tiling().triangles {
        let [a, b, c] = places(assembly, triangle.corners);
        area += 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
    }
    for (edge, tiled) in assembly.tiling().edges.iter().enumerate() {
        let [a, b] = places(assembly, tiled.ends);
        let along = nalgebra::Vector2::new(b[0] - a[0], b[1] - a[1]);
        let stretch = (strain * along).dot(&along) / along.norm_squared();
        energy += bars.of(edge) * along.norm() * stretch * stretch / 2.0;
    }
    [area, energy]
}

/// Claim: a stretch that is the same in all directions costs what it costs the sheet, `E t e^2 / (1 - nu)` for each
/// area, on any mesh, at any Poisson's ratio, and with a rim too. Source: plane stress. Tolerance: rounding of sums.
#[test]
fn equal_stretch_is_exact_on_every_mesh() {
    for (name, boundary) in
        [("open-flat", Boundary::FreeTorus), ("open-flat", Boundary::Patch), ("crane", Boundary::Patch)]
    {
        for poisson in [-0.3, 0.0, 0.45] {
            let (assembly, material) = (on(mesh(name), [3, 2], boundary), Material { poisson, ..PAPER });
            let [area, energy] = area_and_energy(&assembly, material, Matrix2::identity() * 1e-3);
            // an edge of a patch without a triangle has the bar of its cell, which is beside the sheet
            let bare = assembly.tiling().edges.iter().any(|edge| edge.wings == [None, None]);
            let expected = PAPER.young * PAPER.thickness * 1e-6 * area / (1.0 - poisson);
            let right = if bare { energy > expected } else { (energy / expected - 1.0).abs() < 1e-12 };
            assert!(area > 0.0 && right, "{name} {boundary:?} {poisson}: {energy} of {expected}");
        }
    }
}

/// Claim: equilateral triangles at Poisson's ratio 1/3 have the energy of the sheet in every strain, pulled, sheared or
/// turned. Source: plane stress, `E t / (2 (1 - nu^2)) (e11^2 + e22^2 + 2 nu e11 e22 + 2 (1 - nu) e12^2)` for each
/// area. Tolerance: rounding.
#[test]
fn equilateral_triangles_are_an_isotropic_sheet() {
    let (assembly, nu) = (on(equilateral(), [2, 2], Boundary::FreeTorus), PAPER.poisson);
    for [e11, e22, e12] in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.7, -0.2, 0.4]] {
        let [area, energy] = area_and_energy(&assembly, PAPER, Matrix2::new(e11, e12, e12, e22));
        let form = e11 * e11 + e22 * e22 + 2.0 * nu * e11 * e22 + 2.0 * (1.0 - nu) * e12 * e12;
        let expected = area * PAPER.young * PAPER.thickness / (2.0 * (1.0 - nu * nu)) * form;
        assert!((energy / expected - 1.0).abs() < 1e-12, "{energy} of {expected}");
    }
}

/// Claim: a scene with a material and no stiffness has bars, creases of `D / L*` and facets of `0.55 D (L / t)^(1/3) /
/// L`; a stiffness that is given stays, and without `crease_length` there are no creases. Source: Filipov et al.
/// (2017), by hand for E = 3000, nu = 1/3, t = 0.1: D = 0.28125. Tolerance: rounding.
#[test]
fn terms_follow_from_the_material() {
    let material = "[material]\nyoung = 3000.0\npoisson = 0.3333333333333333\nthickness = 0.1\n";
    let study = "[[study]]\nname = \"a\"\nkind = \"relax\"\n";
    let scene = |more: &str| Scene::on("generate = { pattern = \"miura\" }", &format!("{material}{more}{study}"));
    let (_, whole) = scene("crease_length = 25.0\n").assembled().unwrap();
    let terms = whole.terms();
    let (creases, facets) = (terms.creases.as_ref().unwrap(), terms.facets.as_ref().unwrap());
    assert!((creases.stiffness.uniform().unwrap() - 0.28125 / 25.0).abs() < 1e-15);
    let diagonal = whole.tiling().facets().next().unwrap();
    let [a, b] = whole.tiling().edges[diagonal].ends.map(|site| whole.tiling().positions[site.vertex]);
    let length = (b - a).norm();
    let expected = 0.55 * 0.28125 * (length / 0.1).cbrt() / length;
    assert!((facets.stiffness.of(diagonal) / expected - 1.0).abs() < 1e-12);
    assert!(relax(&whole).unwrap().state.total() == 0.0 && terms.bar_stiffness().unwrap().softest() > 0.0);
    let (_, given) = scene("[energy]\nbars = { stiffness = 7.0 }\nfacets = { stiffness = inf }\n").assembled().unwrap();
    assert!(given.terms().creases.is_none() && given.terms().has_rigid_facets());
    assert_eq!(given.bar_stiffness(), 7.0);
    scene("[energy]\ncreases = { rest = \"flat\" }\n").refused("missing key `stiffness`");
}

/// Claim: a builder takes a material as a scene does, and refuses one of no thickness. Source: the formulas. Tolerance:
/// none, the same numbers.
#[test]
fn a_builder_takes_a_material() {
    let given = Assembly::patch(mesh("crane"), [1, 1]).material(PAPER).build().unwrap();
    assert_eq!(given.terms().bar_stiffness().unwrap(), &PAPER.bars(&given));
    assert_eq!(given.terms().creases.as_ref().unwrap().stiffness, PAPER.creases().unwrap());
    let none = Material { thickness: 0.0, ..PAPER };
    assert!(Assembly::patch(mesh("crane"), [1, 1]).material(none).build().is_err());
}

//! Symmetries of cells, and their linear folding modes and self stresses by symmetry type.

use crate::common::mesh;
use foldwell::analysis::response::{Relation, SymmetryTypes, response};
use foldwell::sheet::generate::{CellSymmetry, Symmetric};
use foldwell::sheet::symmetry::{Symmetry, SymmetryKind, symmetries};
use foldwell::{Assembly, Pattern, RIGID, Sheet, generate};

const ALL: [(CellSymmetry, SymmetryKind); 5] = [
    (CellSymmetry::TwoFold, SymmetryKind::AxisAcross),
    (CellSymmetry::Screw, SymmetryKind::ScrewAlong),
    (CellSymmetry::Mirror, SymmetryKind::MirrorAcross),
    (CellSymmetry::Glide, SymmetryKind::GlideAcross),
    (CellSymmetry::GlideAlong, SymmetryKind::GlideAlong),
];

fn cell(symmetry: CellSymmetry, size: [usize; 2], seed: u64) -> Sheet {
    generate(&Pattern::Symmetric(Symmetric { symmetry, size, seed, ..Symmetric::default() })).unwrap()
}

fn types(sheet: Sheet) -> Vec<SymmetryTypes> {
    response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).facets(1.0).build().unwrap()).unwrap().symmetries
}

/// Trace of the linear part of a symmetry.
fn trace(kind: SymmetryKind) -> i64 {
    match kind {
        SymmetryKind::AxisAcross | SymmetryKind::AxisAlong | SymmetryKind::ScrewAlong => -1,
        SymmetryKind::MirrorAcross
        | SymmetryKind::GlideAcross
        | SymmetryKind::MirrorAlong
        | SymmetryKind::GlideAlong => 1,
        SymmetryKind::Inversion => -3,
    }
}

/// Even less odd modes of a generic cell, by counting: an edge on which the symmetry lies counts `side`, a vertex on it
/// takes away `side` times the trace of its linear part, and the three conditions that hold at all vertices together
/// give that back once. `side` is -1 if the sheet is turned over. (Symmetry-extended counting as in P. W. Fowler and S.
/// D. Guest, Int. J. Solids Struct. 37, 1793 (2000), for the closure of fold angles.)
fn counted(symmetry: &Symmetry) -> i64 {
    let kept = |images: &[usize]| images.iter().enumerate().filter(|(k, image)| *k == **image).count() as i64;
    let side = if symmetry.turns_over { -1 } else { 1 };
    side * (kept(&symmetry.edges) - trace(symmetry.kind) * (kept(&symmetry.vertices) - 1))
}

/// Claim: a generated cell has the symmetry that was asked for and no other; its three modes split into even and odd
/// ones as counting says, all even under a two-fold axis across the sheet, two and one under a screw axis, a mirror and
/// a glide plane across it, and one and two under a glide plane along it; and the self stresses, which are the modes,
/// split alike, exchanged where the sheet is turned over.
#[test]
fn modes_of_symmetric_cells() {
    for (asked, kind) in ALL {
        for (size, seed) in [([4, 4], 1), ([2, 4], 2), ([4, 2], 3), ([6, 4], 4)] {
            let found = types(cell(asked, size, seed));
            assert_eq!(found.len(), 1, "{asked:?}, {size:?}: {found:?}");
            let SymmetryTypes { symmetry, modes, stresses } = &found[0];
            assert_eq!(symmetry.kind, kind);
            let [even, odd] = *modes;
            assert_eq!(
                (even + odd, even as i64 - odd as i64),
                (3, counted(symmetry)),
                "{asked:?}, {size:?}: {modes:?}"
            );
            let expected = match kind {
                SymmetryKind::AxisAcross => [3, 0],
                SymmetryKind::GlideAlong => [1, 2],
                _ => [2, 1],
            };
            assert_eq!(*modes, expected, "{asked:?}, {size:?}");
            let turned = if symmetry.turns_over { [odd, even] } else { [even, odd] };
            assert_eq!(*stresses, turned, "{asked:?}, {size:?}");
        }
    }
}

/// Claim: a glide plane along the sheet alone gives what is known of sheets of four parallelograms: one mode strains
/// the sheet and does not bend it, two bend it, so that Poisson's ratios are opposite. Tolerance: rounding of a null
/// space of 48 edges.
#[test]
fn glide_planes_along_make_ratios_opposite() {
    for seed in 0..10 {
        let sheet = cell(CellSymmetry::GlideAlong, [4, 4], seed);
        let found = response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).build().unwrap()).unwrap();
        assert_eq!(found.symmetries[0].modes, [1, 2], "seed {seed}");
        let poisson = found.poisson.unwrap();
        assert!(matches!(poisson.relation.opposite(), Some(true)), "seed {seed}: {:?}", poisson.relation);
        assert!(poisson.sum.unwrap() < 1e-9, "seed {seed}: {:?}", poisson.sum);
    }
    let other = cell(CellSymmetry::TwoFold, [4, 4], 0);
    let found = response(&Assembly::torus(other, [1, 1]).bars(RIGID).build().unwrap()).unwrap();
    let relation: Relation = found.poisson.unwrap().relation;
    assert_ne!(relation.opposite(), Some(true));
}

/// Claim: no symmetry is seen where there is none, and those of a sheet stay where it is drawn otherwise: with a longer
/// lattice vector, far away, and in another unit.
#[test]
fn symmetries_do_not_depend_on_the_drawing() {
    assert!(symmetries(&mesh("open-star")).is_empty());
    for (asked, kind) in ALL {
        let sheet = cell(asked, [4, 4], 5);
        let moved = |scale: f64, origin: [f64; 3]| {
            let mut other = sheet.clone();
            other.vertices.iter_mut().for_each(|x| *x = *x * scale + foldwell::math::Vec3::from(origin));
            other.lattice = other.lattice.map(|lattice| lattice.map(|l| l * scale));
            symmetries(&other)
        };
        for (scale, origin) in [(1.0, [0.0; 3]), (1e3, [1e4, -2e4, 5e3]), (1e-3, [0.5, 0.25, 3.0])] {
            let found = moved(scale, origin);
            assert!(found.len() == 1 && found[0].kind == kind, "{asked:?} times {scale}: {found:?}");
        }
    }
}

//! Domains of a user's own: a sector against the whole ring, a free lattice against the built-in torus.

use crate::common::mesh;
use approx::{assert_abs_diff_eq, assert_relative_eq};
use foldwell::analysis::branches::{BranchesError, branches};
use foldwell::analysis::modes::modes;
use foldwell::analysis::path::{PathOptions, follow_path};
use foldwell::analysis::response::response;
use foldwell::math::Vec3;
use foldwell::model::{Affine, AssemblyError, Builder, CellMap, CellMaps, Drive, Driven, OwnDomain, RIGID};
use foldwell::sheet::build::{Drawing, build};
use foldwell::{Assembly, Picture, Rest, Sheet, relax};
use nalgebra::{Matrix3, Rotation3};
use std::f64::consts::TAU;

/// Cells of a ring about the z axis, with this number of sides.
struct Ring(u32);

impl CellMaps for Ring {
    fn shared(&self) -> usize {
        0
    }

    fn map(&self, _: &[f64], [cell, _]: [i32; 2]) -> CellMap {
        let linear = Rotation3::new(TAU * f64::from(cell) / f64::from(self.0) * Vec3::z()).into_inner();
        CellMap { map: Affine { linear, shift: Vec3::zeros() }, first: vec![], second: vec![] }
    }
}

/// Cells repeated by two translations, which are shared coordinates: the torus with free lattice vectors.
struct Lattice;

impl CellMaps for Lattice {
    fn shared(&self) -> usize {
        6
    }

    fn map(&self, shared: &[f64], cell: [i32; 2]) -> CellMap {
        let by = |k: usize| f64::from(cell[k / 3]) * Vec3::ith(k % 3, 1.0);
        let shift = (0..6).map(|k| shared[k] * by(k)).sum();
        let first = (0..6).map(|k| Affine { linear: Matrix3::zeros(), shift: by(k) }).collect();
        CellMap { map: Affine { linear: Matrix3::identity(), shift }, first, second: vec![] }
    }
}

/// Number of vertices around the tube of a ring.
const AROUND: usize = 6;

/// A ring of this number of sectors as one sector, and as a whole: a closed surface.
fn rings(sectors: usize) -> [Assembly; 2] {
    let at = |sector: usize, row: usize| {
        let (turn, around) = (TAU * sector as f64 / sectors as f64, TAU * row as f64 / AROUND as f64);
        let radius = 2.0 + 0.8 * around.cos();
        Vec3::new(radius * turn.cos(), radius * turn.sin(), 0.8 * around.sin())
    };
    let triangles = |row: usize, corner: &dyn Fn(usize, usize) -> usize| {
        let [a, b, c, d] = [(0, row), (1, row), (0, row + 1), (1, row + 1)].map(|(sector, row)| corner(sector, row));
        [vec![a, b, c], vec![b, d, c]]
    };
    let strip = Drawing {
        coords: (0..=AROUND).flat_map(|row| [0.0, 1.0].map(|x| Vec3::new(x, row as f64, 0.0))).collect(),
        faces: (0..AROUND).flat_map(|row| triangles(row, &|sector, row| 2 * row + sector)).collect(),
        lattice: Some([Vec3::x(), AROUND as f64 * Vec3::y()]),
        ..Drawing::default()
    };
    let places = (0..sectors).flat_map(|sector| (0..AROUND).map(move |row| (sector, row)));
    let whole = Drawing {
        coords: places.clone().map(|(sector, row)| at(sector, row)).collect(),
        faces: places
            .flat_map(|(first, row)| triangles(row, &|sector, row| (first + sector) % sectors * AROUND + row % AROUND))
            .collect(),
        ..Drawing::default()
    };
    let state = (0..AROUND).flat_map(|row| <[f64; 3]>::from(at(0, row))).collect();
    let energies = |builder: Builder| builder.bars(1e2).creases(0.1).rest(Rest::Angle(0.5)).build().unwrap();
    let ring = OwnDomain::new(Ring(sectors as u32));
    [
        energies(Assembly::own(build(&strip).unwrap(), ring, state, [sectors, 1])),
        energies(Assembly::patch(build(&whole).unwrap(), [1, 1])),
    ]
}

/// Claim: one sector of a ring relaxes to the energy of a sector of the whole, which keeps its symmetry, and its
/// picture shows all sectors on the ring. Its rigid motions are along the axis and about it. Tolerance: that of the
/// equilibria.
#[test]
fn a_sector_has_the_energy_of_its_part_of_the_ring() {
    for sectors in [5, 8, 12] {
        let [sector, whole] = rings(sectors);
        let found = [&sector, &whole].map(|assembly| relax(assembly).unwrap().state);
        assert!(found[0].total() > 0.1);
        assert_relative_eq!(sectors as f64 * found[0].total(), found[1].total(), max_relative = 1e-9);
        assert_eq!(modes(&sector, 0, &mut || true).unwrap().rigid_motions, 2);
        let picture = Picture::new(&sector, &found[0]);
        assert_eq!(picture.triangles.len(), 2 * AROUND * sectors);
        let distances = picture.points.iter().map(|point| point.x.hypot(point.y));
        assert!(distances.clone().fold(f64::MAX, f64::min) > 0.5 && distances.fold(0.0, f64::max) < 4.0);
    }
}

/// Claim: a ring pulled out at one vertex of each sector follows the path of its sector: the reaction of a sector, and
/// its energy, at the end. Tolerance: that of the equilibria.
#[test]
fn a_sector_is_driven_as_the_ring() {
    let sectors = 6;
    let [sector, whole] = rings(sectors);
    let upwards = |assembly: &Assembly, vertices: Vec<usize>| {
        // the rows opposite to those that are lifted stand on the ground
        let mut terms = assembly.terms().clone();
        terms.pins = vertices.iter().map(|vertex| (vertex + AROUND / 2, [false, false, true])).collect();
        let lifted = Drive { quantity: Driven::Vertices { vertices, direction: Vec3::z() }, to: 0.3 };
        let assembly = assembly.with_terms(terms);
        let path = follow_path(&assembly, &lifted, None, &PathOptions::default(), &mut |_, _| true).unwrap();
        path[0].points.last().unwrap().clone()
    };
    let one = upwards(&sector, vec![1]);
    let all = upwards(&whole, (0..sectors).map(|sector| sector * AROUND + 1).collect());
    assert_abs_diff_eq!(one.drive, 0.3, epsilon = 1e-12);
    assert_abs_diff_eq!(all.drive, 0.3, epsilon = 1e-12);
    assert_relative_eq!(one.state.total(), all.state.total() / sectors as f64, max_relative = 1e-8);
    assert_relative_eq!(one.reaction, all.reaction / sectors as f64, max_relative = 1e-6);
}

/// Claim: a free lattice as a domain of one's own is the built-in torus: the same minimum at every stiffness, the same
/// counts of motions and self stresses. Tolerance: that of the equilibria.
#[test]
fn a_lattice_of_ones_own_is_the_torus() {
    for (name, angle) in [("open-star", 0.3), ("miura", 1.0)] {
        let sheet = mesh(name);
        let lattice = sheet.lattice.unwrap().into_iter().flat_map(<[f64; 3]>::from);
        let place: Vec<f64> = sheet.vertices.iter().flat_map(|p| <[f64; 3]>::from(*p)).chain(lattice).collect();
        for stiffness in [1e2, 1e6, RIGID] {
            let energies =
                |builder: Builder| builder.bars(stiffness).creases(1.0).rest(Rest::Assigned(angle)).build().unwrap();
            let own = Assembly::own(sheet.clone(), OwnDomain::new(Lattice), place.clone(), [2, 2]);
            let both = [energies(own), energies(Assembly::torus(sheet.clone(), [1, 1]))];
            let [own, torus] = both.each_ref().map(|assembly| relax(assembly).unwrap());
            assert_relative_eq!(own.state.total(), torus.state.total(), max_relative = 1e-10);
            assert_eq!(own.negative_eigenvalues, torus.negative_eigenvalues);
            let [own, torus] = both.map(|assembly| modes(&assembly, 0, &mut || true).unwrap());
            assert_eq!((own.zero_modes, own.self_stresses), (torus.zero_modes, torus.self_stresses));
            assert_eq!(own.rigid_motions, torus.rigid_motions);
        }
    }
}

/// Claim: what knows closed forms of the built-in domains refuses others by name, and coordinates that do not fit the
/// domain, and a sheet without lattice, are no assembly.
#[test]
fn closed_forms_refuse_a_domain_of_ones_own() {
    let [sector, whole] = rings(6);
    assert!(matches!(branches(&sector), Err(BranchesError::OwnDomain)));
    assert!(response(&sector).unwrap_err().to_string().contains("periodic"));
    let place = vec![0.0; 7];
    let own = |sheet: &Sheet| Assembly::own(sheet.clone(), OwnDomain::new(Ring(6)), place.clone(), [6, 1]).build();
    assert_eq!(own(sector.sheet()).unwrap_err(), AssemblyError::Coordinates { given: 7, needed: 18 });
    assert_eq!(own(whole.sheet()).unwrap_err(), AssemblyError::NoLattice);
}

//! Five examples that MERLIN ships, sheets of ten by ten panels under loads, against what MERLIN computes: K. Liu and G. H.
//! Paulino, "Nonlinear mechanics of non-rigid origami", Proc. R. Soc. A 473, 20170348 (2017). A sixth, `Kresling_Folding`, is
//! among the drums here, and `GMiura_pointload` of MERLIN2 among the panels.

use foldwell::analysis::path::{PathEnd, PathEvent, PathOptions, PathPoint, follow_path};
use foldwell::model::{Assembly, Builder, Drive, Driven, OfStrain, Ogden, Stiffening};
use foldwell::sheet::{Sheet, fold};

/// Panels along x and along y.
const PANELS: usize = 10;
/// Numbers of the vertices of one column of vertices, from 1 as in MERLIN.
const COLUMN: usize = PANELS + 1;

/// Stiffness of creases per length.
const CREASES: f64 = 0.1;

/// A sheet, by where its vertices stand: that of a number along x and one along y.
struct Example {
    place: Box<dyn Fn(usize, usize) -> [f64; 3]>,
    /// `EA` of bars, the stiffness of diagonals per length, and the fold angle in degrees from which creases and diagonals
    /// stiffen.
    bars: f64,
    facets: f64,
    stiffens: f64,
    /// The axes along which vertices are held, and that along which others are loaded, by their numbers in MERLIN.
    held: Vec<(usize, &'static str)>,
    loaded: (Vec<usize>, usize),
}

/// Miura-ori of parallelograms of sides 2 with an angle of 60 degrees, folded by an angle in degrees.
fn miura(folded: f64) -> Box<dyn Fn(usize, usize) -> [f64; 3]> {
    let ([sector, folded], side) = ([60f64.to_radians(), folded.to_radians()], 2.0);
    let flat = f64::hypot(1.0, folded.cos() * sector.tan());
    let [across, along] = [side * folded.cos() * sector.tan() / flat, side / flat];
    let (height, step) =
        (side * sector.sin() * folded.sin(), side * (1.0 - (folded.sin() * sector.sin()).powi(2)).sqrt());
    Box::new(move |i, j| [across * i as f64, step * j as f64 + along * (i % 2) as f64, height * (j % 2) as f64])
}

/// An eggbox of parallelograms with an angle of 60 degrees, folded by 45 degrees.
fn eggbox(side: f64) -> Box<dyn Fn(usize, usize) -> [f64; 3]> {
    let [sector, folded] = [60f64, 45.0].map(f64::to_radians);
    let slope = sector.cos() / folded.cos();
    let (heights, across) = ([side * slope, side * folded.cos()], side * (1.0 - slope * slope).sqrt());
    let height = move |i: usize, j: usize| heights[0] * (i % 2) as f64 + heights[1] * (j % 2) as f64;
    Box::new(move |i, j| [across * i as f64, side * folded.sin() * j as f64, height(i, j)])
}

impl Example {
    fn sheet(&self) -> Sheet {
        let points = (0..COLUMN).flat_map(|i| (0..COLUMN).map(move |j| (i, j))).map(|(i, j)| (self.place)(i, j));
        let points: Vec<[f64; 3]> = points.collect();
        let face = |(i, j): (usize, usize)| {
            [i * COLUMN + j, (i + 1) * COLUMN + j, (i + 1) * COLUMN + j + 1, i * COLUMN + j + 1]
        };
        let faces: Vec<_> = (0..PANELS).flat_map(|i| (0..PANELS).map(move |j| (i, j))).map(face).collect();
        fold::parse(&format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": {faces:?}}}"), "sheet.fold")
            .unwrap()
    }

    /// The sheet with linear laws, or with those of the example: Ogden bars, and creases and diagonals that stiffen.
    fn built(&self, own: bool) -> Builder {
        let builder = Assembly::patch(self.sheet(), [1, 1]).bars(self.bars).creases(CREASES).facets(self.facets);
        let (loaded, axis) = &self.loaded;
        let force: [f64; 3] = std::array::from_fn(|k| if k == *axis { -1.0 } else { 0.0 });
        let held = self.held.iter().fold(builder, |builder, (vertex, axes)| {
            builder.pin(vertex - 1, [0, 0], ["x", "y", "z"].map(|axis| axes.contains(axis)))
        });
        let builder = loaded.iter().fold(held, |builder, vertex| builder.load(vertex - 1, [0, 0], force));
        if !own {
            return builder;
        }
        let limit = self.stiffens.to_radians();
        let stiffening = Stiffening { limits: [-limit, limit] };
        let bars = OfStrain(Ogden { exponents: [5.0, 1.0] });
        builder.bar_law(bars).crease_law(stiffening).facet_law(stiffening)
    }

    /// The path of the loads to this factor, with rows at others; its reaction is the displacement of the loads.
    fn followed(&self, own: bool, to: f64, at: Vec<f64>) -> Vec<PathPoint> {
        let (assembly, drive) = (self.built(own).build().unwrap(), Drive { quantity: Driven::Loads, to });
        let options = PathOptions { at, ..PathOptions::default() };
        let branch = follow_path(&assembly, &drive, None, &options, &mut |_, _| true).unwrap().remove(0);
        assert_eq!(branch.end, PathEnd::Arrived, "own {own}");
        branch.points
    }
}

fn odd(first: usize) -> impl Iterator<Item = usize> {
    (first..first + COLUMN).step_by(2)
}

/// `Miura_Bending`.
fn bending_miura() -> Example {
    Example {
        place: miura(54.7356),
        bars: 1e3,
        facets: 1.0,
        stiffens: 179.9,
        held: vec![(56, "x"), (57, "xyz"), (65, "xz")],
        loaded: (vec![56, 66], 2),
    }
}

/// `Eggbox_Bending`.
fn bending_eggbox() -> Example {
    Example {
        place: eggbox(2.0),
        bars: 1e3,
        facets: 2.0,
        stiffens: 157.5,
        held: vec![(27, "xyz"), (29, "xz"), (93, "yz"), (95, "z")],
        loaded: (vec![6, 116], 2),
    }
}

/// `Eggbox_Folding`.
fn folding_eggbox() -> Example {
    let last = PANELS * COLUMN;
    let first = (1..=COLUMN).map(|vertex| (vertex, "x"));
    Example {
        place: eggbox(1.0),
        bars: 1e5,
        facets: 1e3,
        stiffens: 179.9,
        held: first.chain(odd(1).map(|vertex| (vertex, "z"))).chain([(6, "y"), (last + 6, "yz")]).collect(),
        loaded: ((last + 2..last + COLUMN).step_by(2).collect(), 0),
    }
}

/// `Miura_Folding`.
fn folding_miura() -> Example {
    let last = PANELS * COLUMN;
    let first = (1..=COLUMN).map(|vertex| (vertex, "x"));
    Example {
        place: miura(15.0),
        bars: 1e5,
        facets: 1e4,
        stiffens: 179.9,
        held: first.chain(odd(1).chain(odd(last + 1)).map(|vertex| (vertex, "z"))).chain([(1, "y")]).collect(),
        loaded: ((last + 1..=last + COLUMN).collect(), 0),
    }
}

/// `Miura_Bistable`.
fn bistable_miura() -> Example {
    let last = PANELS * COLUMN;
    let left = odd(1).skip(1).map(|vertex| (vertex, "xz"));
    let right = odd(last + 1).skip(1).map(|vertex| (vertex, "z"));
    Example {
        place: miura(30.0),
        bars: 1e3,
        facets: 1.0,
        stiffens: 135.0,
        held: left.chain(right).chain([(1, "xyz"), (last + 1, "yz")]).collect(),
        loaded: (vec![61], 2),
    }
}

/// Claim: with linear laws and with the examples' own the loads of MERLIN's last states displace the sheets as they do
/// there. Source: with linear laws MERLIN under GNU Octave, with the digits that are given; with its own laws its formulas of
/// forces, laws and path, typed anew and run there, whose states are equilibria here to 1e-11.
#[test]
fn sheets_are_bent_and_folded() {
    let [miura, eggbox, small, bistable] = [bending_miura(), bending_eggbox(), folding_eggbox(), bistable_miura()];
    for (example, own, load, expected, digits) in [
        (&miura, false, 75.199, 1.46397, 5e-6),
        (&miura, true, 78.5281570397, 1.44704897019, 1e-10),
        (&eggbox, false, 2.621611, 3.2596178, 1e-6),
        (&eggbox, true, 2.62159706426, 3.25960345587, 1e-10),
        (&small, false, 2.1189533, 26.902772, 1e-6),
        (&small, true, 2.11887964992, 26.9027483237, 1e-10),
        (&bistable, true, 2.74499530395, 2.62560159867, 1e-10),
    ] {
        let found = example.followed(own, load, vec![]).last().unwrap().reaction;
        assert!((found - expected).abs() <= digits * expected, "own {own}, load {load}: {found}, not {expected}");
    }
}

/// Claim: a Miura-ori that pops through has MERLIN's limit loads and limit displacements with linear laws. Source and
/// tolerance: the digits of MERLIN's states, which are close to them.
#[test]
fn a_sheet_pops_through() {
    let path = bistable_miura().followed(false, 2.7278193, vec![]);
    let at = |event: PathEvent| path.iter().filter(move |point| point.event == Some(event));
    let loads: Vec<f64> = at(PathEvent::LimitLoad).map(|point| point.drive).collect();
    let displacements: Vec<f64> = at(PathEvent::LimitDisplacement).map(|point| point.reaction).collect();
    let near = |found: &[f64], expected: [f64; 2]| found.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-6);
    assert!(loads.len() == 2 && near(&loads, [2.314571, -1.760447]), "{loads:?}");
    assert!(displacements.len() == 2 && near(&displacements, [1.373225, 1.196921]), "{displacements:?}");
}

/// Claim: a Miura-ori that is folded nearly flat has MERLIN's last state, which it passes beyond two limit loads, and goes
/// on where creases touch: there the load turns within a ten-millionth of the way, and the path does not go back over its
/// own states. Source: MERLIN's formulas under GNU Octave, and 164.94206 of MERLIN itself. Tolerance: 1e-9, as steep as the
/// load is there.
#[test]
fn a_sheet_is_folded_flat() {
    let load = 0.738842051112;
    let path = folding_miura().followed(true, 2.0, vec![load]);
    let passed = path.iter().filter(|point| point.drive == load);
    let off = passed.map(|point| (point.reaction / 164.942059219 - 1.0).abs()).fold(f64::INFINITY, f64::min);
    assert!(off < 1e-9, "{off:e}");
}

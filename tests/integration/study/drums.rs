//! Drums with laws against their closed form. A drum that keeps its symmetry has three unknowns, the height, the twist
//! and the radius of its upper ring, so that its force is found on paper.

use foldwell::analysis::path::{PathBranch, PathEnd, PathEvent, PathOptions, follow_path};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Builder, Drive, Driven, GreenLagrange, OfStrain, Ogden, Stiffening};
use foldwell::sheet::{Sheet, fold};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// Height, twist and radius of the upper ring.
type Shape = Vec3;

/// A drum of triangles on a ring of radius 1. From each vertex below a bar leads to the one that is drawn above it,
/// turned by the twist, and another one to the vertex after that.
#[derive(Clone, Copy)]
struct Drum {
    sides: usize,
    drawn: [f64; 3],
}

/// The force of a bar over `EA` by its stretch, and the torque of a crease over its stiffness by its angle and its rest
/// angle.
type Laws = (fn(f64) -> f64, fn(f64, f64) -> f64);

/// The material of a drum: `EA`, the stiffness of creases, the laws of both, and whether the upper ring is a rigid plate.
struct Made {
    bars: f64,
    creases: f64,
    laws: Laws,
    plate: bool,
}

impl Drum {
    /// The turn from one side to the next.
    fn side(self) -> f64 {
        TAU / self.sides as f64
    }

    fn below(self, k: usize) -> Vec3 {
        let turn = k as f64 * self.side();
        Vec3::new(turn.cos(), turn.sin(), 0.0)
    }

    fn above(self, k: usize, shape: Shape) -> Vec3 {
        let turn = k as f64 * self.side() + shape[1];
        Vec3::new(shape[2] * turn.cos(), shape[2] * turn.sin(), shape[0])
    }

    fn sheet(self) -> Sheet {
        let n = self.sides;
        let points = (0..n).map(|k| self.below(k)).chain((0..n).map(|k| self.above(k, self.drawn.into())));
        let points: Vec<[f64; 3]> = points.map(Into::into).collect();
        let next = |k: usize| (k + 1) % n;
        let faces = (0..n).flat_map(|k| [[k, next(k), n + next(k)], [k, n + next(k), n + k]]);
        let faces: Vec<[usize; 3]> = faces.collect();
        let text = format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": {faces:?}}}");
        fold::parse(&text, "drum.fold").unwrap()
    }

    /// The squares of the lengths of the three bars of a side, both between the rings and that along the upper one,
    /// with their derivatives by the shape.
    fn squares(self, shape: Shape) -> [(f64, Shape); 3] {
        let [height, twist, radius] = shape.into();
        let slanted = |turn: f64| {
            let square = height * height + 1.0 + radius * radius - 2.0 * radius * turn.cos();
            (square, 2.0 * Shape::new(height, radius * turn.sin(), radius - turn.cos()))
        };
        let across = (2.0 * (self.side() / 2.0).sin()).powi(2);
        let ring = (radius * radius * across, Shape::new(0.0, 0.0, 2.0 * radius * across));
        [slanted(twist), slanted(twist + self.side()), ring]
    }

    /// The length and the fold angle of the two creases of a side.
    fn creases(self, shape: Shape) -> [(f64, f64); 2] {
        let ([a, b], [c, d, e]) = ([0, 1].map(|k| self.below(k)), [0, 1, 2].map(|k| self.above(k, shape)));
        let crease = |[from, to, left, right]: [Vec3; 4]| {
            let along = to - from;
            let [n, m] = [along.cross(&(left - from)), (right - from).cross(&along)];
            let length = along.norm();
            (length, (length * (left - from).dot(&m)).atan2(n.dot(&m)))
        };
        [crease([a, d, c, b]), crease([b, d, a, e])]
    }

    /// The derivatives of the energy of a side: exact for bars; those of fold angles are extrapolated central
    /// differences.
    fn gradient(self, shape: Shape, made: &Made) -> Shape {
        let (drawn, (by_stretch, by_angle)) = (Shape::from(self.drawn), made.laws);
        let mut gradient = Shape::zeros();
        for ((square, slope), (rest, _)) in self.squares(shape).into_iter().zip(self.squares(drawn)) {
            let force = made.bars * by_stretch((square / rest).sqrt());
            gradient += force / (2.0 * square.sqrt()) * slope;
        }
        for crease in [0, 1] {
            let ([_, angle], [length, rest]) = (self.creases(shape)[crease].into(), self.creases(drawn)[crease].into());
            let at = |axis: usize, step: f64| {
                let [more, less] = [step, -step].map(|by| self.creases(shape + Shape::ith(axis, by))[crease].1);
                more - less - TAU * ((more - less) / TAU).round()
            };
            let slope = |axis| (8.0 * at(axis, 1e-3) - at(axis, 2e-3)) / 12e-3;
            let torque: f64 = made.creases * length * by_angle(angle, rest);
            gradient += torque * Shape::new(slope(0), slope(1), slope(2));
        }
        gradient
    }

    /// The force on the upper ring, of all sides, where it has this height and is else without force. Newton's method
    /// from a state nearby in the unknowns that are free.
    fn force(self, near: Shape, made: &Made) -> f64 {
        let mut shape = near;
        for _ in 0..20 {
            let of = |axis: usize, step: f64| self.gradient(shape + Shape::ith(axis, step), made);
            let slope = |axis| (of(axis, 1e-6) - of(axis, -1e-6)) / 2e-6;
            let [twisted, widened, rest] = [slope(1), slope(2), self.gradient(shape, made)];
            let mut matrix = Matrix2::new(twisted[1], widened[1], twisted[2], widened[2]);
            let mut right = Vector2::new(rest[1], rest[2]);
            if made.plate {
                (matrix, right) = (Matrix2::new(twisted[1], 0.0, 0.0, 1.0), Vector2::new(rest[1], 0.0));
            }
            let step = matrix.lu().solve(&right).unwrap();
            shape -= Shape::new(0.0, step[0], step[1]);
        }
        assert!((shape - near).norm() < 1e-6, "the closed form is elsewhere: {shape:?} {near:?}");
        self.sides as f64 * self.gradient(shape, made)[0]
    }

    /// The shape of a state: means over the ring, so that what is not symmetric counts in second order only.
    fn shape(self, coordinates: &[f64]) -> Shape {
        let of = |k: usize| {
            let [x, y, z] = [0, 1, 2].map(|axis| coordinates[3 * (self.sides + k) + axis]);
            let turn = y.atan2(x) - k as f64 * self.side();
            let near = turn - TAU * ((turn - self.drawn[1]) / TAU).round();
            Shape::new(z, near, x.hypot(y))
        };
        (0..self.sides).map(of).sum::<Shape>() / self.sides as f64
    }
}

const LINEAR: Laws = (|stretch| stretch - 1.0, |angle, rest| angle - rest);

fn followed(builder: Builder, quantity: Driven, to: f64) -> PathBranch {
    let assembly = builder.build().unwrap();
    let branch = follow_path(&assembly, &Drive { quantity, to }, None, &PathOptions::default(), &mut |_, _| true);
    let branch = branch.unwrap().remove(0);
    assert_eq!(branch.end, PathEnd::Arrived);
    branch
}

fn limit_loads(branch: &PathBranch) -> Vec<f64> {
    let limits = branch.points.iter().filter(|point| point.event == Some(PathEvent::LimitLoad));
    limits.map(|point| point.drive).collect()
}

/// Claim: a conical drum of seven sides between rigid plates has the force of its fourteen bars at every height, beyond
/// its limit points, whatever the law of the bars. Source: the derivative by the height where that by the twist
/// vanishes. Tolerance: 1e-9 of the largest force; heights are kept to 1e-12.
#[test]
fn a_conical_drum_is_pressed_as_its_bars_say() {
    let drum = Drum { sides: 7, drawn: [1.2, 0.9, 0.7] };
    type Case = (fn(Builder) -> Builder, fn(f64) -> f64);
    let cases: [Case; 4] = [
        (|bars| bars, |l| l - 1.0),
        (|bars| bars.bar_law(OfStrain(GreenLagrange)), |l| l * (l * l - 1.0) / 2.0),
        (|bars| bars.bar_law(OfStrain(Ogden { exponents: [5.0, 1.0] })), |l| (l.powi(4) - 1.0) / 4.0),
        (|bars| bars.bar_law(OfStrain(Ogden { exponents: [2.0, -1.0] })), |l| (l - l.powi(-2)) / 3.0),
    ];
    let ring = |first: usize| (first..first + 7).map(|vertex| (vertex, [0, 0]));
    for (number, (law, by_stretch)) in cases.into_iter().enumerate() {
        let bars = Assembly::patch(drum.sheet(), [1, 1]).bars(50.0).part(ring(0), [false; 6]);
        let bars = law(bars.part(ring(7), [false, false, true, false, false, true]));
        let branch = followed(bars, Driven::Part { part: 1, axis: 2 }, -0.9);
        assert!(limit_loads(&branch).len() >= 2, "law {number}: {:?}", limit_loads(&branch));
        let made = Made { bars: 50.0, creases: 0.0, laws: (by_stretch, LINEAR.1), plate: true };
        let largest = branch.points.iter().map(|point| point.reaction.abs()).fold(0.0, f64::max);
        for point in &branch.points {
            let expected = drum.force(drum.shape(&point.state.coordinates), &made);
            let found = point.reaction;
            assert!((found - expected).abs() <= 1e-9 * largest, "law {number}: {found}, not {expected}");
        }
    }
}

/// Claim: the drum of MERLIN's example `Kresling_Folding`, eight sides under eight loads, has the loads of its closed
/// form with linear laws and with the example's own, Ogden bars and creases that stiffen beyond 135 degrees; the first
/// limit load with linear laws is MERLIN's. Source: the energy of a side; MERLIN with linear laws run under GNU Octave,
/// the largest load of whose 180 states is 0.43080, so that the limit is a little above. Tolerance: 1e-9 of the largest
/// load.
#[test]
fn a_drum_of_merlin_is_folded_as_its_closed_form() {
    let drum = Drum { sides: 8, drawn: [1.0, FRAC_PI_4, 1.0] };
    let stiffening: fn(f64, f64) -> f64 = |angle, rest| {
        let limit: f64 = 0.75 * PI;
        let unit = 2.0 * (PI - limit) / PI;
        let beyond = angle - angle.clamp(-limit, limit);
        angle - beyond - rest + unit * (beyond / unit).tan()
    };
    let own: Laws = (|l| (l.powi(4) - 1.0) / 4.0, stiffening);
    for (laws, with_own, to) in [(LINEAR, false, 0.5), (own, true, 1.0)] {
        let builder = Assembly::patch(drum.sheet(), [1, 1]).bars(500.0).creases(1e-3);
        let builder = (0..8).fold(builder, |builder, vertex| {
            builder.pin(vertex, [0, 0], [true; 3]).load(8 + vertex, [0, 0], [0.0, 0.0, -1.0])
        });
        let limits = Stiffening { limits: [-0.75 * PI, 0.75 * PI] };
        let builder = if with_own {
            builder.bar_law(OfStrain(Ogden { exponents: [5.0, 1.0] })).crease_law(limits)
        } else {
            builder
        };
        let branch = followed(builder, Driven::Loads, to);
        if !with_own {
            let first = limit_loads(&branch)[0];
            assert!((0.43080..0.43085).contains(&first), "{first}");
        }
        let made = Made { bars: 500.0, creases: 1e-3, laws, plate: false };
        let largest = branch.points.iter().map(|point| point.drive.abs()).fold(0.0, f64::max);
        // creases that are springs fold through each other, where angles of the closed form begin anew
        let shapes = branch.points.iter().map(|point| (point.drive, drum.shape(&point.state.coordinates)));
        let before =
            |(_, shape): &(f64, Shape)| with_own || drum.creases(*shape).iter().all(|(_, angle)| angle.abs() < 3.0);
        let compared: Vec<(f64, Shape)> = shapes.take_while(before).collect();
        assert!(compared.len() > 40, "{} states", compared.len());
        for (found, shape) in compared {
            let expected = -drum.force(shape, &made) / 8.0;
            assert!((found - expected).abs() <= 1e-9 * largest, "own {with_own}: {found}, not {expected}");
        }
    }
}

/// Claim: the drum of Sim-FAST's example `Kresling`, six sides under six loads, has the loads of its closed form with the
/// Green-Lagrange bars of that program; with linear bars its limit load is a little above the largest of the program's 20
/// states, 4.9276 by the same law, and its own law adds 0.7 %. Source: the energy of a side; Sim-FAST. Tolerance: 1e-9 of
/// the largest load; the hinges of the example, 1e-6 Nm a radian, count in the sixth digit and are left out.
#[test]
fn a_drum_of_sim_fast_is_pressed_as_its_closed_form() {
    let drum = Drum { sides: 6, drawn: [1.0, PI / 6.0, 1.0] };
    // a millimetre of a material of 10 MPa, panels of a ring of 50 mm, by the formula of MERLIN2 for triangles
    let stiffness = 197.152380745;
    let green_lagrange: fn(f64) -> f64 = |l| l * (l * l - 1.0) / 2.0;
    let limits = [(false, LINEAR.0), (true, green_lagrange)].map(|(own, by_stretch)| {
        let bars = Assembly::patch(drum.sheet(), [1, 1]).bars(stiffness);
        let bars = if own { bars.bar_law(OfStrain(GreenLagrange)) } else { bars };
        let builder = (0..6).fold(bars, |builder, vertex| {
            builder.pin(vertex, [0, 0], [true; 3]).load(6 + vertex, [0, 0], [0.0, 0.0, -1.0])
        });
        let branch = followed(builder, Driven::Loads, 1.0);
        let made = Made { bars: stiffness, creases: 0.0, laws: (by_stretch, LINEAR.1), plate: false };
        let to_limit = branch.points.iter().take_while(|point| point.event != Some(PathEvent::LimitLoad));
        for point in to_limit {
            let expected = -drum.force(drum.shape(&point.state.coordinates), &made) / 6.0;
            assert!((point.drive - expected).abs() <= 1e-9, "own {own}: {}, not {expected}", point.drive);
        }
        6.0 * limit_loads(&branch)[0]
    });
    assert!((4.9276..4.9276 * 1.001).contains(&limits[0]), "{limits:?}");
    assert!((1.006..1.008).contains(&(limits[1] / limits[0])), "{limits:?}");
}

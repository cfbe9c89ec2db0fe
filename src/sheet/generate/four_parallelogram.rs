//! A cell of four parallelograms of any lengths and angles: Miura-ori and the eggbox are two of them.

use std::f64::consts::{FRAC_PI_2, PI};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, length};
use super::parts::{Parts, VertexGrid, parameters};
use crate::math::Vec3;
use crate::sheet::cell::Sheet;

const SOURCE: &str = "Cell of four parallelograms: J. McInerney, G. H. Paulino, D. Z. Rocklin, PNAS 119, e2202777119 \
                      (2022).";

parameters! {
    /// One cell of four parallelograms: along one direction its sides are `a` and `b` in turn, along the other `c` and
    /// `d`.
    ///
    /// Vertices are at `0, a, c, a + c`, the lattice vectors are `a + b` and `c + d`. The sides `c` and `d` have the
    /// directions `(0, cos f, -sin f)` and `(0, cos f, sin f)`; those of `a` and `b` have their angles with both, and
    /// point to the same side of the plane of `c` and `d`. All is then turned so that the lattice vectors lie in the
    /// plane of x and y, the first along x.
    FourParallelogram {
        /// First side of the zigzag along the first direction. Default 1.
        a: f64 = 1.0,
        /// Second side of that zigzag. Default 0.9.
        b: f64 = 0.9,
        /// First side of the zigzag along the second direction. Default 0.8.
        c: f64 = 0.8,
        /// Second side of that zigzag. Default 1.
        d: f64 = 1.0,
        /// Angle between `a` and `c` in radians, in `(0, pi)`. Default 65 degrees.
        ac: f64 as "radians" = 65f64.to_radians(),
        /// Angle between `a` and `d` in radians, in `(0, pi)`. Default 110 degrees.
        ad: f64 as "radians" = 110f64.to_radians(),
        /// Angle between `b` and `c` in radians, in `(0, pi)`. Default 105 degrees.
        bc: f64 as "radians" = 105f64.to_radians(),
        /// Angle between `b` and `d` in radians, in `(0, pi)`. Default 60 degrees.
        bd: f64 as "radians" = 60f64.to_radians(),
        /// Slope `f` of the sides `c` and `d` in radians, half the angle between them; the mirror image with the
        /// opposite sign. `2 |f|` lies between the difference of `ac` and `ad` and their sum (or `2 pi` less that), and
        /// the same for `bc` and `bd`. Default 45 degrees.
        fold: f64 as "radians" = 45f64.to_radians(),
    }
}

impl FourParallelogram {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let vectors = self.sides()?;
        let [a, b, c, d] = in_the_plane(vectors);
        let grid = VertexGrid { size: [2, 2] };
        let parts = Parts {
            title: "four-parallelogram",
            source: SOURCE,
            vertices: vec![Vec3::zeros(), a, c, a + c],
            lattice: Some([Vec3::new((a + b).x, 0.0, 0.0), Vec3::new((c + d).x, (c + d).y, 0.0)]),
            polygons: grid.all().map(|at| grid.quad(at).to_vec()).collect(),
        };
        let Self { a, b, c, d, ac, ad, bc, bd, fold } = self;
        parts.sheet(format!(
            "a = {a}, b = {b}, c = {c}, d = {d}, ac = {ac}, ad = {ad}, bc = {bc}, bd = {bd}, fold = {fold}."
        ))
    }

    /// The sides as vectors, `c` and `d` in the plane of y and z.
    fn sides(&self) -> Result<[Vec3; 4], GenerateError> {
        let lengths = [("a", self.a), ("b", self.b), ("c", self.c), ("d", self.d)];
        for (name, value) in lengths {
            length(name, value)?;
        }
        for (name, value) in [("ac", self.ac), ("ad", self.ad), ("bc", self.bc), ("bd", self.bd)] {
            angle_between(name, value, 0.0, PI)?;
        }
        self.check_fold()?;
        let (sin, cos) = (libm::sin(self.fold), libm::cos(self.fold));
        let direction = |with_c: f64, with_d: f64| {
            let [along_c, along_d] = [with_c, with_d].map(libm::cos);
            let (y, z) = ((along_c + along_d) / (2.0 * cos), (along_d - along_c) / (2.0 * sin));
            Vec3::new((1.0 - y * y - z * z).max(0.0).sqrt(), y, z)
        };
        Ok([
            self.a * direction(self.ac, self.ad),
            self.b * direction(self.bc, self.bd),
            self.c * Vec3::new(0.0, cos, -sin),
            self.d * Vec3::new(0.0, cos, sin),
        ])
    }

    /// Checks that triangles on the sphere have these angles as sides: those of `a`, `c`, `d` and of `b`, `c`, `d`.
    fn check_fold(&self) -> Result<(), GenerateError> {
        let pairs = [[self.ac, self.ad], [self.bc, self.bd]];
        let low = pairs.iter().map(|[c, d]| 0.5 * (c - d).abs()).fold(0.0, f64::max);
        let high = pairs.iter().map(|[c, d]| 0.5 * (c + d).min(2.0 * PI - c - d)).fold(FRAC_PI_2, f64::min);
        if !(low < high) {
            return Err(GenerateError::NoFold { low, high });
        }
        let (low, high) = if self.fold < 0.0 { (-high, -low) } else { (low, high) };
        angle_between("fold", self.fold, low, high).map(|_| ())
    }
}

/// The sides turned so that the lattice vectors `a + b` and `c + d` lie in the plane of x and y, the first along x.
fn in_the_plane([a, b, c, d]: [Vec3; 4]) -> [Vec3; 4] {
    let (first, second) = (a + b, c + d);
    let x = first / first.norm();
    let across = second - x * x.dot(&second);
    let y = across / across.norm();
    let z = x.cross(&y);
    let turned = |side: Vec3| Vec3::new(x.dot(&side), y.dot(&side), z.dot(&side));
    [a, b, c, d].map(turned)
}

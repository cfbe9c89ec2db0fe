//! The volume that faces under pressure enclose: one measure of all their vertices, which a drive prescribes.

use super::domain::{Domain, Site};
use super::element::{Elements, Head, Local, TermKind};
use super::law::Stored;
use crate::math::taylor::Taylor;
use crate::math::{in_lower_triangle, lower_triangle, point};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The volume of faces over their area in the drawn state: a length, as other measures of stiff elements are. The
/// tension of the element is minus the pressure times that area.
pub(super) struct Enclosed {
    head: Head,
    faces: Arc<dyn Elements>,
    /// The area of the faces in the drawn state.
    pub area: f64,
    sites: Vec<Site>,
    /// Where the corners of each face are among the sites.
    corners: Vec<Vec<usize>>,
}

impl Enclosed {
    /// Makes the measure from the volumes that faces have, one element for each, whose sites are its corners.
    pub(super) fn new(faces: Arc<dyn Elements>, drawn: &[f64]) -> Self {
        let of = |k: usize| faces.sites(k).iter().map(|site| site.vertex);
        let vertices: Vec<usize> = (0..faces.len()).flat_map(of).collect::<BTreeSet<_>>().into_iter().collect();
        let place = |vertex: usize| vertices.partition_point(|other| *other < vertex);
        let corners = (0..faces.len()).map(|k| of(k).map(place).collect()).collect();
        let area = |k: usize| {
            let [a, b, c] = [0, 1, 2].map(|n| point(drawn, faces.sites(k)[n].vertex));
            0.5 * (b - a).cross(&(c - a)).norm()
        };
        let name = faces.head().name.clone();
        let stored = vec![Stored::Spring];
        Self {
            head: Head { kind: TermKind::Pressure, name, is_angle: false, is_hinge: false, edges: vec![None], stored },
            area: (0..faces.len()).map(area).sum(),
            sites: vertices.iter().map(|&vertex| Site { vertex, shift: [0, 0] }).collect(),
            corners,
            faces,
        }
    }
}

impl Elements for Enclosed {
    fn head(&self) -> &Head {
        &self.head
    }

    fn sites(&self, _: usize) -> &[Site] {
        &self.sites
    }

    fn value(&self, _: usize, domain: &Domain, x: &[f64]) -> f64 {
        (0..self.faces.len()).map(|k| self.faces.value(k, domain, x)).sum::<f64>() / self.area
    }

    fn local(&self, _: usize, domain: &Domain, x: &[f64], want_hessian: bool, out: &mut Local) {
        let size = 3 * self.sites.len();
        let entries = if want_hessian { size * (size + 1) / 2 } else { 0 };
        *out = Local { value: 0.0, gradient: vec![0.0; size], hessian: vec![0.0; entries] };
        let mut face = Local::default();
        for (k, corners) in self.corners.iter().enumerate() {
            self.faces.local(k, domain, x, want_hessian, &mut face);
            let number = |coordinate: usize| 3 * corners[coordinate / 3] + coordinate % 3;
            out.value += face.value / self.area;
            face.gradient.iter().enumerate().for_each(|(row, g)| out.gradient[number(row)] += g / self.area);
            for ((row, column), h) in lower_triangle(face.gradient.len()).zip(&face.hessian) {
                out.hessian[in_lower_triangle(number(row), number(column))] += h / self.area;
            }
        }
    }

    fn along(&self, _: usize, _: &Domain, _: &[&[f64]; 3]) -> Option<Taylor> {
        None
    }
}

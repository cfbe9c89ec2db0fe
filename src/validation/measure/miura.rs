//! Fold angles of Miura-ori in closed form.

use crate::sheet::{EdgeKind, Sheet};

/// Whether an edge runs along the zigzags: the straight creases have no part along x.
fn is_zigzag(sheet: &Sheet, edge: usize) -> bool {
    let [a, b] = sheet.edges[edge].key.ends().map(|end| sheet.position(end));
    (a.x - b.x).abs() > 1e-9
}

/// The first crease of the zigzags.
pub fn first_zigzag(sheet: &Sheet) -> Option<usize> {
    (0..sheet.edges.len()).find(|&k| sheet.edges[k].kind == EdgeKind::Crease && is_zigzag(sheet, k))
}

/// Fold angle of every crease of a generated Miura-ori whose zigzags are folded by `zigzag` radians, mountains and valleys as
/// drawn: `tan(straight/2) = cos(sector) tan(zigzag/2)` (M. Schenk, S. D. Guest, PNAS 110, 3276 (2013)). NaN for edges that
/// are no creases.
pub fn fold_angles(sheet: &Sheet, sector: f64, zigzag: f64) -> Vec<f64> {
    let straight = 2.0 * (sector.cos() * (zigzag / 2.0).tan()).atan();
    let angle = |k: usize| {
        let edge = &sheet.edges[k];
        let sign = sheet.drawn_angle(edge).map_or(f64::NAN, f64::signum);
        match edge.kind {
            EdgeKind::Crease => sign * if is_zigzag(sheet, k) { zigzag } else { straight },
            _ => f64::NAN,
        }
    };
    (0..sheet.edges.len()).map(angle).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::generate::Miura;
    use crate::sheet::{Pattern, generate};

    /// Claim: the closed form gives the angles that the generator draws from coordinates, at folds from flat to nearly shut
    /// and for sharp and blunt sectors. Tolerance: rounding, over the sine of the smallest angle.
    #[test]
    fn the_closed_form_is_what_is_drawn() {
        for (fold, sector) in [(0.02, 1.0), (0.3, 0.4), (0.8, 1.2), (1.5, 1.0)] {
            let sheet = generate(&Pattern::Miura(Miura { fold, sector, ..Miura::default() })).unwrap();
            let drawn: Vec<f64> = sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap()).collect();
            let zigzag = drawn[first_zigzag(&sheet).unwrap()].abs();
            let expected = fold_angles(&sheet, sector, zigzag);
            let known: Vec<usize> = (0..12).filter(|&k| !expected[k].is_nan()).collect();
            assert_eq!(known.len(), 8);
            let off = known.iter().map(|&k| (drawn[k] - expected[k]).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-13 && known.iter().all(|&k| !drawn[k].is_nan()), "{fold} {sector}: {off}");
        }
    }
}

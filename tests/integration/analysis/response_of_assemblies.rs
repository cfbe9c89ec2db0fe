//! The linear response of periodic sheets that are no surfaces: with openings, and with edges of three faces.

use crate::common;
use foldwell::analysis::response::{Relation, Response, ResponseError, moduli, response};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Bilinear, OfStrain, RIGID};
use foldwell::sheet::build::{Drawing, build, draw};
use foldwell::sheet::generate::{Miura, ThickMiura};
use foldwell::sheet::{Corner, EdgeKind, Pattern, Sheet, generate};

fn of_rigid_panels(sheet: Sheet) -> Response {
    response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).facets(RIGID).build().unwrap()).unwrap()
}

/// Returns the sheet with an opening in place of its first triangle, and with a pyramid on that triangle, whose sides
/// have three faces then.
fn opened_and_capped(sheet: &Sheet) -> [Sheet; 2] {
    let drawing = draw(sheet);
    let first = drawing.faces[0].clone();
    let [a, b, c] = [0, 1, 2].map(|k| drawing.coords[first[k]]);
    let open = Drawing { faces: drawing.faces[1..].to_vec(), holes: vec![first.clone()], ..drawing.clone() };
    let (mut capped, apex) = (drawing.clone(), drawing.coords.len());
    capped.coords.push((a + b + c) / 3.0 + (b - a).cross(&(c - a)).normalize() * 0.4);
    capped.faces.extend((0..3).map(|k| vec![first[k], first[(k + 1) % 3], apex]));
    [build(&open).unwrap(), build(&capped).unwrap()]
}

/// Claim: a triangle of bars keeps its shape without its face, and a pyramid on it adds nothing that folds: modes have
/// the strains and curvatures of the sheet as it is. Nothing says that the ratios are opposite. Bars alone have the
/// same moduli where the face is left out. Tolerance: rounding over the least singular value.
#[test]
fn an_opening_and_a_pyramid_change_nothing() {
    for name in ["open-star", "random"] {
        let sheet = common::mesh(name);
        let of = |sheet: &Sheet| {
            response(&Assembly::torus(sheet.clone(), [1, 1]).bars(RIGID).facets(1.0).build().unwrap()).unwrap()
        };
        let expected = of(&sheet);
        let [open, capped] = opened_and_capped(&sheet);
        for found in [of(&open), of(&capped)] {
            assert_eq!(found.modes.len(), expected.modes.len(), "{name}");
            assert_eq!(found.table.rank, expected.table.rank);
            for (mode, as_drawn) in found.modes.iter().zip(&expected.modes) {
                for k in 0..3 {
                    let off = [mode.strain[k] - as_drawn.strain[k], mode.curvature[k] - as_drawn.curvature[k]];
                    assert!(off.iter().all(|off| off.abs() <= 1e-9), "{name}: {mode:?} for {as_drawn:?}");
                }
            }
        }
        let [whole, open] = [sheet, open].map(|sheet| {
            let bars = Assembly::torus(sheet, [1, 1]).bars(1.0).build().unwrap();
            moduli(&bars).unwrap().matrices.unwrap()
        });
        for (a, b) in [(whole.stretching, open.stretching), (whole.bending, open.bending)] {
            let pairs = a.iter().flatten().zip(b.iter().flatten());
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() <= 1e-9), "{name}: {a:?} {b:?}");
        }
    }
}

/// Claim: the velocities of the modes of a cell with openings stretch no bar of any cell. Tolerance: rounding at a
/// distance of some cells.
#[test]
fn modes_of_kirigami_stretch_no_bar() {
    let sheet = common::mesh("kirigami");
    let found = response(&Assembly::torus(sheet.clone(), [1, 1]).bars(RIGID).facets(1.0).build().unwrap()).unwrap();
    assert_eq!(found.poisson.unwrap().relation, Relation::NoReciprocity);
    assert!(!found.modes.is_empty());
    for mode in &found.modes {
        let at = |corner: Corner| mode.field.at(corner.vertex, corner.shift).unwrap();
        for (edge, shift) in sheet.edges.iter().flat_map(|edge| [[0, 0], [3, -2]].map(|shift| (edge, shift))) {
            let [i, j] = edge.key.ends().map(|end| Corner { shift: [0, 1].map(|k| end.shift[k] + shift[k]), ..end });
            let stretch = (sheet.position(j) - sheet.position(i)).dot(&(at(j) - at(i)));
            assert!(stretch.abs() <= 1e-10, "{stretch:e}");
        }
    }
}

/// Claim: Miura-ori of thick panels has one mode; its strain is that of the lattice of the generator at other folds, by
/// differences, with `-cos^2 g tan^2 t` at no thickness, and its creases turn at the rates of the sheet without
/// thickness (Y. Chen, R. Peng, Z. You, Science 349, 396 (2015)). Tolerance: 1e-7 of differences, 1e-9 of rates.
#[test]
fn thick_panels_fold_as_thin_ones() {
    let (fold, step) = (0.6, 1e-4);
    let rates = |sheet: &Sheet, found: &Response| {
        let creases = sheet.edges.iter().zip(&found.modes[0].rates).filter(|(edge, _)| edge.kind == EdgeKind::Crease);
        let mut rates: Vec<f64> = creases.map(|(_, rate)| rate.abs()).collect();
        rates.sort_by(f64::total_cmp);
        let largest = rates[rates.len() - 1];
        rates.into_iter().map(|rate| rate / largest).collect::<Vec<_>>()
    };
    let thin = generate(&Pattern::Miura(Miura { fold, ..Miura::default() })).unwrap();
    let without = rates(&thin, &of_rigid_panels(thin.clone()));
    for thickness in [1e-6, 0.1, 0.3] {
        let at =
            |fold| generate(&Pattern::ThickMiura(ThickMiura { fold, thickness, ..ThickMiura::default() })).unwrap();
        let sheet = at(fold);
        let found = of_rigid_panels(sheet.clone());
        let ratios = found.poisson.as_ref().unwrap();
        assert_eq!((found.modes.len(), found.table.curvatures, ratios.relation.opposite()), (1, 0, None));
        let lengths = [fold - step, fold + step].map(|fold| at(fold).lattice.unwrap().map(|l| l.norm()));
        let change = [0, 1].map(|k| (lengths[1][k] / lengths[0][k]).ln());
        let ratio = ratios.in_plane.ratio(0.0).unwrap();
        assert!((ratio + change[1] / change[0]).abs() <= 1e-7, "{thickness}: {ratio} {change:?}");
        if thickness < 1e-5 {
            assert!((ratio + 2.0435366317).abs() <= 1e-4, "{ratio}");
        }
        let with = rates(&sheet, &found);
        assert!(with.iter().zip(&without).all(|(a, b)| (a - b).abs() <= 1e-9), "{thickness}: {with:?} {without:?}");
    }
}

/// A slab of aligned Miura tubes beside each other, repeated along the tubes and across them: walls of the sides `u`
/// above and below, and of `v` between them, so that three faces meet at every line along the tubes.
fn slab(fold: f64) -> Sheet {
    let y = 0.5 / fold.sin();
    let [u, v] = [1.0, -1.0].map(|side| Vec3::new(0.0, y, side * (1.0 - y * y).sqrt()));
    let place = |r: usize| Vec3::new(r as f64 * fold.cos(), (r % 2) as f64 * fold.sin(), 0.0);
    let point = |r: usize, i: usize, j: usize| 4 * r + 2 * i + j;
    let all = (0..3).flat_map(|r| [(r, 0, 0), (r, 0, 1), (r, 1, 0), (r, 1, 1)]);
    let coords = all.map(|(r, i, j)| place(r) + u * i as f64 + v * j as f64).collect();
    let walls = [[(0, 0), (1, 0)], [(0, 1), (1, 1)], [(0, 0), (0, 1)]];
    let faces = (0..2).flat_map(|r| {
        walls.map(|[(i, j), (k, l)]| vec![point(r, i, j), point(r, k, l), point(r + 1, k, l), point(r + 1, i, j)])
    });
    let lattice = Some([Vec3::new(2.0 * fold.cos(), 0.0, 0.0), u]);
    build(&Drawing { coords, faces: faces.collect(), lattice, ..Drawing::default() }).unwrap()
}

/// Claim: a slab of tubes folds along them with the ratio 0 across, since its walls keep the side `u`: the strain
/// `[1, 0, 0]` without curvature is one of its modes, or a combination of them. Tolerance: rounding.
#[test]
fn a_slab_of_tubes_folds_along_them() {
    for fold in [0.7, 1.0, 1.3] {
        let sheet = slab(fold);
        assert!(sheet.edges.iter().any(|edge| sheet.hinges_round(edge.key) == 3) && !sheet.is_surface());
        let found = of_rigid_panels(sheet);
        let [modes, planar] = [found.modes.len(), found.modes.len() - found.table.curvatures];
        assert!(modes >= 1 && planar >= 1, "{fold}: {modes} {planar}");
        let strain = found.modes[0].strain;
        assert!([0.0, 0.0].iter().zip(&strain[1..]).all(|(a, b)| (a - b).abs() <= 1e-10), "{fold}: {strain:?}");
        assert_eq!((strain[0], found.symmetries.len()), (1.0, 0));
        let poisson = found.poisson.unwrap();
        assert!(poisson.in_plane.ratio(0.0).unwrap().abs() <= 1e-10, "{fold}");
        assert!(matches!(poisson.relation, Relation::NoReciprocity | Relation::NoBendingMode { .. }), "{poisson:?}");
    }
}

/// Claim: two sheets above each other that nothing joins have three modes more, in which one moves as a whole and nothing
/// folds: these neither strain nor bend, whatever rounding leaves of them.
#[test]
fn loose_sheets_do_not_bend() {
    let sheet = common::mesh("open-star");
    let drawing = draw(&sheet);
    let (count, mut both) = (drawing.coords.len(), drawing.clone());
    both.coords.extend(drawing.coords.iter().map(|point| point + Vec3::new(0.1, 0.2, 3.0)));
    both.faces.extend(drawing.faces.iter().map(|face| face.iter().map(|corner| corner + count).collect::<Vec<_>>()));
    let both = build(&both).unwrap();
    let other = |facets: f64| Assembly::torus(both.clone(), [1, 1]).bars(RIGID).facets(facets).build().unwrap();
    let loose = response(&other(1.0)).unwrap();
    let one = response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).facets(1.0).build().unwrap()).unwrap();
    assert_eq!(
        (one.table.rank, loose.modes.len(), loose.table.rank),
        (3, 3, 0),
        "the same lattice, bent in one way each"
    );
    assert!(loose.error <= 1e-10, "{:e}", loose.error);
}

/// Claim: next to a flat state, where motions change lengths so little that they may be modes of the flat sheet, no number
/// of modes is given. Source: Miura-ori has three modes at every fold, and six where it is flat.
#[test]
fn nearly_flat_cells_have_no_count() {
    let at = |fold: f64| {
        let sheet = generate(&Pattern::Miura(Miura { fold, ..Miura::default() })).unwrap();
        response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).facets(1.0).build().unwrap())
    };
    assert_eq!([0.0, 1e-6, 1e-2].map(|fold| at(fold).unwrap().modes.len()), [6, 3, 3]);
    for fold in [1e-8, 1e-9] {
        let found = at(fold).map(|found| found.modes.len());
        assert!(matches!(found, Err(ResponseError::UnclearModes { .. })), "{fold}: {found:?}");
    }
}

/// Claim: the response of rigid panels does not depend on the unit of length. Tolerance: rounding.
#[test]
fn panels_have_no_unit() {
    for unit in [1e-4, 1e-3, 1e3, 1e5] {
        let panels = ThickMiura { a: unit, b: unit, thickness: 0.1 * unit, fold: 0.6, ..ThickMiura::default() };
        let found = of_rigid_panels(generate(&Pattern::ThickMiura(panels)).unwrap());
        let same = ThickMiura { thickness: 0.1, fold: 0.6, ..ThickMiura::default() };
        let expected = of_rigid_panels(generate(&Pattern::ThickMiura(same)).unwrap());
        let ratio = |found: &Response| found.poisson.as_ref().unwrap().in_plane.ratio(0.0).unwrap();
        assert_eq!((found.modes.len(), found.self_stresses), (expected.modes.len(), expected.self_stresses));
        assert!((ratio(&found) - ratio(&expected)).abs() <= 1e-10, "{unit}");
    }
}

/// Claim: cables, which only pull, have no moduli: their stiffness at rest is that of one side.
#[test]
fn cables_have_no_moduli() {
    let lattice = Some([Vec3::x(), Vec3::y()]);
    let coords = vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::new(1.0, 1.0, 0.0)];
    let net = build(&Drawing { coords, bars: vec![[0, 1], [0, 2], [0, 3]], lattice, ..Drawing::default() }).unwrap();
    for (ratio, refused) in [(0.0, true), (0.5, true), (1.0, false)] {
        let law = OfStrain(Bilinear { ratio, at: [0.0, f64::INFINITY] });
        let cables = Assembly::torus(net.clone(), [1, 1]).bars(8.0).bar_law(law).build().unwrap();
        let error = moduli(&cables).err().map(|error| error.to_string());
        assert_eq!(error.is_some_and(|error| error.contains("springs at rest")), refused, "{ratio}");
    }
}

//! Folded states whose layers touch: vertices of different faces that stand at one place.

use crate::common::{Scene, case_folder};
use foldwell::run::convert;
use foldwell::sheet::{EdgeKind, Info, Sheet, fold, obj};
use foldwell::{Assembly, RIGID, Rest, relax};
use std::f64::consts::PI;

fn read(name: &str) -> Sheet {
    fold::read(&case_folder().join("fold").join(name)).unwrap()
}

/// Claim: vertices of different faces may stand at one place, also in drawings in the plane of a sheet folded flat, and
/// are counted; the sheet is the same as before it was folded: a disc with its creases. Counted by hand.
#[test]
fn layers_may_touch() {
    for (name, touching, creases, boundary) in
        [("diagonal-folded.fold", 2, 1, 4), ("box.fold", 8, 4, 12), ("pleat-state.fold", 8, 2, 8)]
    {
        let sheet = read(name);
        let info = Info::new(&sheet);
        assert_eq!((info.touching_vertices, info.creases, info.boundary), (touching, creases, boundary), "{name}");
        assert_eq!((info.pieces, info.euler_characteristic, info.target_angles), (1, 1, 0), "{name}");
        assert!(info.to_string().contains(&format!("touching layers        {touching} vertices")), "{info}");
        assert_eq!(fold::parse(&fold::write(&sheet), name).unwrap(), sheet, "{name}");
        let again = obj::parse(&obj::write(&sheet), name).unwrap();
        assert_eq!(
            (&again.edges, &again.vertices, &again.assignments),
            (&sheet.edges, &sheet.vertices, &sheet.assignments)
        );
    }
    assert_eq!(Info::new(&read("simulator-flat.fold")).touching_vertices, 0);
}

/// Claim: sheets that are drawn folded flat or as a box relax as others do: they open to flat, and a flat fold opens to
/// half of its angle. Source: a developable sheet has no energy at its rest angles. Tolerance: 1e-12 of the torques.
#[test]
fn touching_sheets_relax() {
    for name in ["diagonal-folded.fold", "box.fold", "pleat-state.fold"] {
        for bars in [1e4, RIGID] {
            let sheet = read(name);
            let half =
                sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).map_or(0.0, |angle| 0.5 * angle)).collect();
            let assembly = Assembly::patch(sheet, [1, 1]).bars(bars).creases(1.0).rest(Rest::PerEdge(half));
            let assembly = assembly.build().unwrap();
            let found = relax(&assembly).unwrap_or_else(|error| panic!("{name}, {bars}: {error}"));
            assert!(found.state.total() < 1e-20, "{name}, {bars}: {}", found.state.total());
            let angle = if name == "box.fold" { PI / 4.0 } else { PI / 2.0 };
            let creases = assembly.tiling().edges.iter().zip(&found.state.fold_angle);
            let mut angles = creases.filter(|(edge, _)| edge.kind == EdgeKind::Crease).map(|(_, angle)| angle.abs());
            assert!(angles.all(|found| (found - angle).abs() < 1e-10), "{name}");
        }
    }
}

/// Claim: layers that touch do not pass through each other, the pictures and files of a run are written, and a state
/// goes to VTU and back.
#[test]
fn touching_layers_do_not_cross() {
    for name in ["diagonal-folded", "box", "pleat-state"] {
        let ran = Scene::on(
            &format!("mesh = \"cases/fold/{name}.fold\""),
            "[energy]\nbars = { stiffness = 1e4 }\ncreases = { stiffness = 1.0 }\n\
             [[study]]\nname = \"a\"\nkind = \"relax\"\ncheck = [\"self-intersection\"]\n\
             [[study]]\nname = \"b\"\nkind = \"modes\"",
        );
        let ran = ran.converged();
        assert_eq!(ran.json()[0]["self_intersecting"], false, "{name}");
        let svg = ran.out.text("a.svg");
        assert!(svg.contains("</svg>") && !svg.contains("NaN"), "{name}");
        let [vtu, back] = ["a/a_0001.vtu", "back.fold"].map(|file| ran.out.file(file));
        convert(&vtu, &back, None, None).unwrap();
        let (sheet, before) = (fold::read(&back).unwrap(), read(&format!("{name}.fold")));
        assert_eq!(Info::new(&sheet).touching_vertices, Info::new(&before).touching_vertices);
    }
}

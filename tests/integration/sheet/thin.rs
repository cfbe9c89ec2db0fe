//! Thin triangles: those that a mesh has, and those that splitting polygons must not make.

use foldwell::sheet::{Info, fold};
use foldwell::{Assembly, Rest, Sheet, relax};

/// Returns a waterbomb base in which a vertex at the height `h` over the crease [4, 5] makes a sliver with it.
fn with_sliver(h: f64) -> String {
    format!(
        "{{\"vertices_coords\": [[-1,-1],[1,-1],[1,1],[-1,1],[0,0],[1,0],[-1,0],[0.5,{h:?}]],\n\
         \"faces_vertices\": [[0,1,4],[1,5,4],[4,5,7],[4,7,2],[7,5,2],[2,3,4],[3,6,4],[6,0,4]],\n\
         \"edges_vertices\": [[4,0],[4,1],[4,2],[4,3],[4,5],[4,6],[4,7],[7,5],[7,2]],\n\
         \"edges_assignment\": [\"V\",\"V\",\"V\",\"V\",\"M\",\"M\",\"F\",\"F\",\"F\"]}}"
    )
}

fn energy_folded(sheet: Sheet) -> f64 {
    let assembly = Assembly::patch(sheet, [1, 1]).bars(1e4).creases(1.0).rest(Rest::Assigned(0.2)).build().unwrap();
    let found = relax(&assembly).unwrap();
    assert!(found.residual_force < 1e-11 && found.negative_eigenvalues == Some(0));
    found.state.total()
}

/// Claim: thin triangles are counted, and the thinnest named by their vertices and quality. Source: a height h over a
/// base of 1 gives `4 sqrt(3) (h / 2) / (3 / 2 + 2 h^2)`.
#[test]
fn thin_triangles_are_named() {
    let sheet = fold::parse(&with_sliver(1e-5), "a.fold").unwrap();
    let info = Info::new(&sheet);
    assert_eq!((info.thin_triangles, info.thinnest.len(), info.thinnest[0].vertices), (1, 1, [4, 5, 7]));
    let quality = 4.0 * 3f64.sqrt() * 0.5e-5 / 1.5;
    assert!(
        (info.thinnest[0].quality / quality - 1.0).abs() < 1e-9
            && info.worst_triangle_quality == info.thinnest[0].quality
    );
    assert!(
        info.to_string().contains("thin triangles         1 of quality under 0.001: [4, 5, 7] of 2.3e-5"),
        "{info}"
    );
    assert_eq!(Info::new(&fold::parse(&with_sliver(0.1), "a.fold").unwrap()).thin_triangles, 0);
    let message = fold::parse(&with_sliver(1.5e-12), "a.fold").unwrap_err().to_string();
    assert!(message.contains("face 2 has a triangle [4, 5, 7] of area"), "{message}");
}

/// Claim: relaxations reach their tolerance on single triangles down to a height of 1e-4, and the sliver does not
/// change the energy of the sheet. Tolerance: the sliver's own crease takes part of the fold; the energies of three
/// heights differ by less than its height.
#[test]
fn slivers_down_to_a_ten_thousandth_relax() {
    let energy = |h: f64| energy_folded(fold::parse(&with_sliver(h), "a.fold").unwrap());
    let [coarse, middle, fine] = [1e-2, 1e-3, 1e-4].map(energy);
    assert!((coarse - fine).abs() < 1e-2 * fine && (middle - fine).abs() < 1e-3 * fine, "{coarse} {middle} {fine}");
}

/// Claim: a crease pattern in which a crease ends on the straight side of a face, with coordinates that are rounded, is
/// read without a thin triangle. Here the middle of the right side of a square, off the straight line by rounding to
/// either side, is a straight corner of the left face.
#[test]
fn straight_corners_make_no_slivers() {
    for off in [0.0, 1e-16, -1e-16, 4e-7, -4e-7] {
        let text = format!(
            "{{\"vertices_coords\": [[0,0],[1,0],[2,0],[2,1],[2,2],[1,2],[0,2],[{:?},1]],\n\
             \"edges_vertices\": [[0,1],[1,2],[2,3],[3,4],[4,5],[5,6],[6,0],[1,7],[7,5],[7,3]],\n\
             \"edges_assignment\": [\"B\",\"B\",\"B\",\"B\",\"B\",\"B\",\"B\",\"V\",\"V\",\"M\"]}}",
            1.0 + off
        );
        let info = Info::new(&fold::parse(&text, "a.fold").unwrap());
        assert_eq!((info.polygons, info.faces, info.facets), (3, 7, 4), "{off}");
        assert!(info.worst_triangle_quality > 0.5, "{off}: {info}");
    }
}

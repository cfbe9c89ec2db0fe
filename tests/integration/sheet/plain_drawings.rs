//! Drawings in which no colour and no layer says what is a crease, and faces that are holes.

use foldwell::sheet::pattern::{self, Format};
use foldwell::sheet::{Assignment, Sheet, fold};

/// A line between two points of a grid, and its layer.
type Drawn = ([[usize; 2]; 2], &'static str);

/// The lines of three by three squares: the border on layer `0`, the others on layers whose names say nothing here.
fn grid() -> Vec<Drawn> {
    let lines = (0..4).flat_map(|k| {
        let [upright, level] = if k % 3 == 0 { ["0", "0"] } else { ["Rot", "Blau"] };
        [([[k, 0], [k, 3]], upright), ([[0, k], [3, k]], level)]
    });
    lines.collect()
}

/// A drawing without colours and without a table of layers.
fn dxf(lines: &[Drawn]) -> String {
    let line = |([[x1, y1], [x2, y2]], layer): &Drawn| {
        format!("0\nLINE\n8\n{layer}\n10\n{x1}\n20\n{y1}\n11\n{x2}\n21\n{y2}\n")
    };
    format!("0\nSECTION\n2\nENTITIES\n{}0\nENDSEC\n0\nEOF\n", lines.iter().map(line).collect::<String>())
}

/// A drawing with these colours of the lines of the layers, black ones of the others.
fn svg(lines: &[Drawn], colours: &[[&str; 2]]) -> String {
    let line = |([[x1, y1], [x2, y2]], layer): &Drawn| {
        let colour = colours.iter().find(|[known, _]| known == layer).map_or("black", |[_, colour]| colour);
        format!("<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"{colour}\"/>")
    };
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{}</svg>", lines.iter().map(line).collect::<String>())
}

fn letters(sheet: &Sheet, letter: Assignment) -> usize {
    sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter).count()
}

/// Claim: where no line of a drawing is a crease by its colour or layer, the lines between its faces are creases without
/// a letter, in DXF and SVG alike, all faces are kept, and it is said. A name counts, with a line without one on it too:
/// on a layer of cuts the same lines are cuts. Source: nine squares have 12 sides between them and 12 outside.
#[test]
fn lines_without_a_letter_are_creases() {
    let lines = grid();
    for (text, format) in [(dxf(&lines), Format::Dxf), (svg(&lines, &[]), Format::Svg)] {
        let sheet = pattern::parse(&text, "a", format).unwrap();
        let found = [Assignment::Unassigned, Assignment::Boundary].map(|letter| letters(&sheet, letter));
        assert_eq!((sheet.polygons.len(), found, sheet.vertices.len()), (9, [12, 12], 16), "{format:?}");
        let said = &sheet.record.redrawing;
        assert_eq!((said.unlettered, said.holes), (12, 0), "{format:?}");
    }
    let mut named = lines.clone();
    named.extend(lines.iter().filter(|(_, layer)| *layer == "Rot").map(|(ends, _)| (*ends, "cuts")));
    let sheet = pattern::parse(&dxf(&named), "a", Format::Dxf).unwrap();
    let found = [Assignment::Unassigned, Assignment::Cut].map(|letter| letters(&sheet, letter));
    assert_eq!((sheet.polygons.len(), found), (9, [6, 12]), "three strips of three squares");
}

/// Claim: colours count as soon as one line has that of a crease: black lines between two faces are then refused in SVG.
#[test]
fn black_is_a_boundary_beside_creases() {
    let lines = grid();
    let sheet = pattern::parse(&svg(&lines, &[["Rot", "red"], ["Blau", "blue"]]), "a", Format::Svg).unwrap();
    assert_eq!((sheet.polygons.len(), sheet.record.redrawing.unlettered), (9, 0));
    let refused = pattern::parse(&svg(&lines, &[["Rot", "red"]]), "a", Format::Svg).unwrap_err().to_string();
    assert!(refused.contains("assigned B"), "{refused}");
}

/// Claim: a face that boundaries make a hole is counted, whichever file says so. Source: the square in the middle of
/// nine, of which the four sides are boundaries.
#[test]
fn holes_are_counted() {
    let side = |x: usize, y: usize, [dx, dy]: [usize; 2]| {
        let rim = x + dx == 0 || y + dy == 0 || (dx == 0 && x.is_multiple_of(3)) || (dy == 0 && y.is_multiple_of(3));
        let inner = (dx == 0 && (1..=2).contains(&x) && y == 1) || (dy == 0 && (1..=2).contains(&y) && x == 1);
        ([[x, y], [x + dx, y + dy]], if rim || inner { 1 } else { 2 })
    };
    let points = (0..4).flat_map(|x| (0..4).map(move |y| [x, y]));
    let sides: Vec<([[usize; 2]; 2], usize)> = points
        .flat_map(|[x, y]| [side(x, y, [1, 0]), side(x, y, [0, 1])])
        .filter(|([_, [x, y]], _)| *x < 4 && *y < 4)
        .collect();
    assert_eq!(sides.len(), 24);
    let cp = sides.iter().map(|([[a, b], [c, d]], kind)| format!("{kind} {a} {b} {c} {d}\n")).collect::<String>();
    let corners = (0..16).map(|k| format!("[{}, {}]", k / 4, k % 4)).collect::<Vec<_>>().join(", ");
    let ends = sides.iter().map(|([[a, b], [c, d]], _)| format!("[{}, {}]", 4 * a + b, 4 * c + d)).collect::<Vec<_>>();
    let names = sides.iter().map(|(_, kind)| ["\"B\"", "\"M\""][kind - 1]).collect::<Vec<_>>();
    let fold = format!(
        "{{\"vertices_coords\": [{corners}],\n\"edges_vertices\": [{}],\n\"edges_assignment\": [{}]}}",
        ends.join(", "),
        names.join(", ")
    );
    for sheet in [pattern::parse(&cp, "a.cp", Format::Cp).unwrap(), fold::parse(&fold, "a.fold").unwrap()] {
        assert_eq!((sheet.polygons.len(), sheet.record.redrawing.holes), (8, 1));
    }
}

/// Claim: a polyline that lies in a plane whose normal points down has its x the other way, as the "DXF Reference" has
/// it, so that it meets lines, which have coordinates of the drawing; and a point without a coordinate is refused.
#[test]
fn entities_seen_from_below_are_turned_over() {
    let line = |[x1, y1, x2, y2]: [f64; 4]| format!("0\nLINE\n8\nValley\n10\n{x1}\n20\n{y1}\n11\n{x2}\n21\n{y2}\n");
    let corners = [[-1.0, 0.0], [-4.0, 0.0], [-3.0, 2.0], [-1.0, 3.0]];
    let polyline = |normal: &str| {
        let points: String = corners.iter().map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).collect();
        format!("0\nLWPOLYLINE\n8\nCut\n90\n4\n70\n1\n{normal}{points}")
    };
    let parse = |entities: &str| {
        let text = format!("0\nSECTION\n2\nENTITIES\n{entities}0\nENDSEC\n0\nEOF\n");
        pattern::parse(&text, "a", Format::Dxf)
    };
    let below = polyline("210\n0\n220\n0\n230\n-1\n");
    let sheet = parse(&(below + &line([1.0, 0.0, 3.0, 2.0]))).unwrap();
    assert_eq!((sheet.polygons.len(), sheet.vertices.len()), (2, 4));
    assert!(parse(&(polyline("") + &line([1.0, 0.0, 3.0, 2.0]))).is_err(), "the line is beside the outline");
    let refused = parse(&line([1.0, 0.0, 3.0, 2.0]).replace("21\n2\n", "")).unwrap_err().to_string();
    assert!(refused.contains("a LINE without the number 21"), "{refused}");
}

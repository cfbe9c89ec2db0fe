//! Drawings in which no colour and no layer says what is a crease, and faces that are holes.

use crate::common::Numbers;
use foldwell::sheet::pattern::{self, Format};
use foldwell::sheet::{Assignment, Info, Sheet, fold};

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

/// Claim: a gradient of one colour is that colour, also by way of another that it names, and one of two colours is
/// refused; the opacity that a colour is written with is exact. Source: half a turn is 180 degrees.
#[test]
fn swatches_and_opacities_are_read() {
    let drawing = |stops: &str, paint: &str| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\"><defs>\
             <linearGradient id=\"h\">{stops}</linearGradient><linearGradient id=\"g\" xlink:href=\"#h\"/>\
             <linearGradient id=\"round\" xlink:href=\"#round\"/></defs>\
             <rect width=\"9\" height=\"9\" stroke=\"black\"/><path d=\"M0 0L9 9\" stroke=\"{paint}\"/></svg>"
        )
    };
    let stop = |colour: &str| format!("<stop style=\"stop-color:{colour};stop-opacity:1\"/>");
    let read = |stops: &str, paint: &str| pattern::parse(&drawing(stops, paint), "a", Format::Svg);
    let target = |paint: &str| {
        let sheet = read(&(stop("#f00") + &stop("#f00")), paint).unwrap();
        let crease = sheet.edges.iter().find(|edge| sheet.assignment(edge) == Assignment::Mountain);
        sheet.targets[&crease.expect("a mountain").key].to_degrees()
    };
    for (paint, degrees) in [
        ("url(#g)", -180.0),
        ("rgba(255, 0, 0, 0.5)", -90.0),
        ("rgba(255, 0, 0, 0.125)", -22.5),
        ("hsl(0 100% 50% / 0.25)", -45.0),
        ("#ff000033", -36.0),
    ] {
        assert!((target(paint) - degrees).abs() < 1e-12, "{paint}: {}", target(paint));
    }
    for (stops, paint) in
        [(stop("red") + &stop("blue"), "url(#g)"), (String::new(), "url(#round)"), (stop("red"), "url(#k)")]
    {
        let fault = read(&stops, paint).unwrap_err().to_string();
        assert!(fault.contains("is no colour of a stroke") && fault.contains("a gradient of one colour"), "{fault}");
    }
}

/// Claim: `info` counts edges by letters, and lengths have their digits in drawings of any size.
#[test]
fn letters_and_lengths_are_said() {
    let cp = "1 0 0 1e-7 0\n1 1e-7 0 1e-7 1e-7\n1 1e-7 1e-7 0 1e-7\n1 0 1e-7 0 0\n2 0 0 1e-7 1e-7\n";
    let said = Info::new(&pattern::parse(cp, "a", Format::Cp).unwrap()).to_string();
    assert!(said.contains("\nletters                4 B, 1 M\n"), "{said}");
    assert!(said.contains("\nedge lengths           1e-7 to 1.4142136e-7\n"), "{said}");
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

/// Claim: what a DXF drawing does not display is left out: entities that are invisible or on a page, those of layers that
/// are frozen or off, and the corners that only shape the curve of a polyline. An ellipse in a plane that is seen from
/// below has its arc on the other side of its long axis. Lines have the true colour of their layer; white is black.
#[test]
fn what_is_not_displayed_is_left_out() {
    let line = |more: &str, layer: &str, [x1, y1, x2, y2]: [f64; 4]| {
        format!("0\nLINE\n8\n{layer}\n{more}10\n{x1}\n20\n{y1}\n11\n{x2}\n21\n{y2}\n")
    };
    let square = "0\nLWPOLYLINE\n8\nCut\n90\n4\n70\n1\n10\n0\n20\n0\n10\n4\n20\n0\n10\n4\n20\n4\n10\n0\n20\n4\n";
    let layer = |name: &str, more: &str| format!("0\nLAYER\n2\n{name}\n{more}");
    let layers = [
        ("Ice", "70\n1\n62\n1\n"),
        ("Dark", "70\n0\n62\n-1\n"),
        ("Sea", "62\n7\n420\n255\n"),
        ("Snow", "420\n16777215\n"),
    ];
    let layers: String = layers.iter().map(|(name, more)| layer(name, more)).collect();
    let layers = format!("0\nSECTION\n2\nTABLES\n{layers}0\nENDSEC\n");
    let parse = |entities: &str| {
        let text = format!("{layers}0\nSECTION\n2\nENTITIES\n{square}{entities}0\nENDSEC\n0\nEOF\n");
        pattern::parse(&text, "a", Format::Dxf).unwrap()
    };
    let across = [0.0, 2.0, 4.0, 2.0];
    assert_eq!(parse(&line("", "Valley", across)).polygons.len(), 2);
    for (more, layer) in [("60\n1\n", "Valley"), ("67\n1\n", "Valley"), ("", "Ice"), ("", "dark")] {
        let hidden = line(more, layer, [2.0, 0.0, 2.0, 4.0]) + &line("", "Valley", across);
        assert_eq!(parse(&hidden).polygons.len(), 2, "{more:?} {layer}");
    }
    let blue = parse(&line("", "Sea", across));
    assert_eq!((letters(&blue, Assignment::Valley), letters(&blue, Assignment::Boundary)), (1, 6));
    let black = parse(&(line("", "Snow", [2.0, 0.0, 2.0, 2.0]) + &line("", "Valley", across)));
    assert_eq!(letters(&black, Assignment::Valley), 2);
    let vertex = |[x, y]: [f64; 2], flag: u32| format!("0\nVERTEX\n8\nValley\n10\n{x}\n20\n{y}\n70\n{flag}\n");
    let corners = vertex([1.0, 3.0], 16) + &vertex([0.0, 2.0], 8) + &vertex([3.0, 1.0], 16) + &vertex([4.0, 2.0], 8);
    let fitted = parse(&format!("0\nPOLYLINE\n8\nValley\n70\n4\n{corners}0\nSEQEND\n"));
    assert_eq!((fitted.polygons.len(), fitted.vertices.len()), (2, 6));
    // from the middle of the left side to that of the lower one, round the corner, or away from it
    let arc = |normal: &str, [from, to]: [f64; 2]| {
        let ellipse = "0\nELLIPSE\n8\nValley\n10\n0\n20\n0\n11\n2\n21\n0\n40\n1\n";
        parse(&format!("{ellipse}{normal}41\n{from}\n42\n{to}\n"))
    };
    let quarter = std::f64::consts::FRAC_PI_2;
    let above = arc("", [0.0, quarter]);
    let below = arc("210\n0\n220\n0\n230\n-1\n", [3.0 * quarter, 4.0 * quarter]);
    assert_eq!((above.polygons.len(), below.polygons.len(), above.vertices.len()), (2, 2, below.vertices.len()));
}

/// Claim: of a `switch` the first child is drawn, a `symbol` only where it is used, and a shape whose transform has
/// another origin is refused, as are rules of a style sheet for what lines look like that would not be applied; twenty exact chords of a square, of which two end close to each other, are read as Euler's
/// formula says.
#[test]
fn shapes_are_drawn_as_browsers_draw_them() {
    let svg = |inner: &str| {
        let rim = "<rect width=\"100\" height=\"100\" stroke=\"black\"/>";
        let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 100 100\">{rim}{inner}</svg>");
        pattern::parse(&text, "a", Format::Svg)
    };
    let line = |x1: f64, y1: f64, x2: f64, y2: f64| {
        format!("<line x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\" stroke=\"red\"/>")
    };
    let (level, upright) = (line(0.0, 50.0, 100.0, 50.0), line(50.0, 0.0, 50.0, 100.0));
    assert_eq!(svg(&format!("<switch>{level}{upright}</switch>")).unwrap().polygons.len(), 2);
    assert_eq!(svg(&format!("<symbol id=\"s\">{upright}</symbol>{level}")).unwrap().polygons.len(), 2);
    let used = format!("<symbol id=\"s\">{upright}</symbol>{level}<use href=\"#s\"/>");
    assert_eq!(svg(&used).unwrap().polygons.len(), 4);
    let turned = level.replace("<line", "<line transform=\"rotate(90)\" transform-origin=\"50 50\"");
    assert!(svg(&turned).unwrap_err().to_string().contains("origin of a transform"));
    let sheet =
        |rules: &str| svg(&format!("<style>{rules}</style>{level}{}", upright.replace("<line", "<line class=\"b\"")));
    let (by_class, comment) = ("/* } x:not(.b) { */ line.b { stroke: blue }", "text:not(.b) { fill: red }");
    for read in [by_class, comment, "line.b:hover { stroke: red }", "@font-face { src: url(a) } "] {
        assert_eq!(sheet(read).unwrap().polygons.len(), 4, "{read}");
    }
    let nested =
        ["@media print { text { fill: red } line.b { stroke: blue } }", "@supports (x: y) { line { display: none } }"];
    let selectors =
        ["line:not(.b) { stroke: blue }", "a, line:nth-child(2) { stroke: none }", ":root line { stroke: blue }"];
    for unread in nested.iter().chain(&selectors) {
        let message = sheet(unread).unwrap_err().to_string();
        assert!(message.contains("no selector of a style sheet that is read"), "{unread}: {message}");
    }
    let mut numbers = Numbers::new(4);
    let mut chords = vec![[[0.0, 81.078], [35.577, 0.0]], [[0.0, 81.062], [100.0, 2.13]]];
    chords.extend((0..18).map(|_| {
        let [a, b, c, d] = [0; 4].map(|_| 50.0 + numbers.within(49.0));
        if numbers.within(1.0) > 0.0 { [[0.0, a], [100.0, b]] } else { [[c, 0.0], [d, 100.0]] }
    }));
    let crossings = |k: usize| (0..k).filter(|l| cross(chords[k], chords[*l])).count();
    let faces = 1 + chords.len() + (0..chords.len()).map(crossings).sum::<usize>();
    let drawn: String = chords.iter().map(|[[x1, y1], [x2, y2]]| line(*x1, *y1, *x2, *y2)).collect();
    assert_eq!(svg(&drawn).unwrap().polygons.len(), faces);
}

/// Whether two chords cross.
fn cross([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let side = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

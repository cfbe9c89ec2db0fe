//! Crease patterns as the programs of the field write them: 91 files, each in the dialect of a program, with what is to
//! come of it. They are made here, by small generators, so that every count is known without reading anything.

use crate::common::Folder;
use foldwell::analysis::relax::{RelaxError, Relaxed};
use foldwell::sheet::pattern::{self, Cleanup, Format};
use foldwell::sheet::{Assignment, Edge, EdgeKind, Pattern, Sheet, TiledEdge, fold, generate, tile};
use foldwell::{Assembly, Rest, relax};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// A crease pattern: lines from point to point with their letters, y upwards.
#[derive(Clone)]
pub(super) struct Creases {
    pub name: String,
    /// Numbers of vertices and edges that it has once its lines are split.
    pub counts: [usize; 2],
    pub lines: Vec<([[f64; 2]; 2], char)>,
}

impl Creases {
    fn new(name: &str, counts: [usize; 2], lines: &[(f64, f64, f64, f64, char)]) -> Self {
        let lines = lines.iter().map(|&(x1, y1, x2, y2, letter)| ([[x1, y1], [x2, y2]], letter)).collect();
        Self { name: name.into(), counts, lines }
    }

    /// Returns the pattern with these lines and the boundary of the unit square.
    fn on_square(name: &str, counts: [usize; 2], lines: &[(f64, f64, f64, f64, char)]) -> Self {
        let rim = [(0., 0., 1., 0., 'B'), (1., 0., 1., 1., 'B'), (1., 1., 0., 1., 'B'), (0., 1., 0., 0., 'B')];
        Self::new(name, counts, &[&rim, lines].concat())
    }

    /// Returns the pattern scaled and moved so that a square drawing fills `[low, low + size]` in both directions.
    pub fn placed(&self, low: f64, size: f64) -> Vec<([[f64; 2]; 2], char)> {
        let ends = || self.lines.iter().flat_map(|(ends, _)| *ends);
        let least = |k: usize| ends().map(|end| end[k]).fold(f64::INFINITY, f64::min);
        let most = |k: usize| ends().map(|end| end[k]).fold(f64::NEG_INFINITY, f64::max);
        let scale = size / (most(0) - least(0)).max(most(1) - least(1));
        let move_ = |end: [f64; 2]| [0, 1].map(|k| low + scale * (end[k] - least(k)));
        self.lines.iter().map(|(ends, letter)| (ends.map(move_), *letter)).collect()
    }
}

/// `n x m` parallelograms of Miura-ori, each edge drawn as a line.
fn miura(n: usize, m: usize) -> Creases {
    let at = |i: usize, j: usize| [i as f64 * 0.75f64.sqrt(), j as f64 + 0.5 * (i % 2) as f64];
    let mut lines = vec![];
    for j in 0..=m {
        for i in 0..=n {
            let rim = |at: usize, last: usize, letter: char| if at == 0 || at == last { 'B' } else { letter };
            if i < n {
                lines.push(([at(i, j), at(i + 1, j)], rim(j, m, ['V', 'M'][j % 2])));
            }
            if j < m {
                lines.push(([at(i, j), at(i, j + 1)], rim(i, n, ['M', 'V'][(i + j) % 2])));
            }
        }
    }
    let counts = [(n + 1) * (m + 1), n * (m + 1) + m * (n + 1)];
    Creases { name: format!("miura {n} x {m}"), counts, lines }
}

/// `n` pleats across the unit square.
fn pleats(n: usize) -> Creases {
    let line = |k: usize| (k as f64 / n as f64, 0.0, k as f64 / n as f64, 1.0, ['M', 'V'][k % 2]);
    let lines: Vec<_> = (1..n).map(line).collect();
    Creases::on_square(&format!("{n} pleats"), [2 * n + 2, 3 * n + 1], &lines)
}

/// Cells of a pattern of this program, drawn flat; the letters are those of its folded state.
fn tiled(name: &str, cells: [usize; 2]) -> Creases {
    let with = |fold: f64| {
        let pattern: Pattern = toml::from_str(&format!("pattern = \"{name}\"\nfold = {fold}\n")).unwrap();
        generate(&pattern).unwrap()
    };
    let (flat, folded) = (with(0.0), with(0.3));
    let tiling = tile(&flat, cells, false);
    let bounds_a_face = |edge: &&TiledEdge| edge.kind != EdgeKind::Facet && edge.wings.iter().any(Option::is_some);
    let line = |edge: &TiledEdge| {
        let ends = edge.ends.map(|site| tiling.positions[site.vertex]).map(|x| [x.x, x.y]);
        let angle = folded.drawn_angle(&folded.edges[edge.edge]).unwrap_or(0.0);
        let letter = match edge.kind {
            EdgeKind::Boundary => 'B',
            _ if angle > 0.0 => 'V',
            _ => 'M',
        };
        (ends, letter)
    };
    let drawn = || tiling.edges.iter().filter(bounds_a_face);
    let vertices: BTreeSet<usize> = drawn().flat_map(|edge| edge.ends.map(|site| site.vertex)).collect();
    let counts = [vertices.len(), drawn().count()];
    let lines = drawn().map(line).collect();
    Creases { name: format!("{name} {} x {}", cells[0], cells[1]), counts, lines }
}

/// The crease pattern of a FOLD file of this folder.
fn of_file(name: &str, text: &str, counts: [usize; 2]) -> Creases {
    let sheet = fold::parse(text, name).unwrap();
    let sides = sheet.edges.iter().filter(|edge| edge.kind != EdgeKind::Facet);
    let line = |edge: &Edge| {
        let ends = edge.key.ends().map(|end| sheet.position(end)).map(|x| [x.x, x.y]);
        (ends, sheet.assignment(edge).to_string().chars().next().unwrap())
    };
    Creases { name: name.into(), counts, lines: sides.map(line).collect() }
}

/// Half the height of a rabbit ear of the unit square, `1 - 1 / sqrt(2)`: the radius of the circle in half of it.
const EAR: f64 = 1.0 - std::f64::consts::FRAC_1_SQRT_2;

/// All patterns, with the numbers of their vertices and edges, counted by hand or by formula.
pub(super) fn patterns() -> Vec<Creases> {
    let cross = [(0., 0., 1., 1., 'V'), (0., 1., 1., 0., 'V'), (0., 0.5, 1., 0.5, 'M')];
    let preliminary = [(0., 0.5, 1., 0.5, 'V'), (0.5, 0., 0.5, 1., 'V'), (0., 0., 1., 1., 'M')];
    let (near, far) = (EAR, 1.0 - EAR);
    let fish = [
        (0., 0., 1., 1., 'M'),
        (0., 0., far, near, 'V'),
        (1., 0., far, near, 'V'),
        (1., 1., far, near, 'V'),
        (far, 0., far, near, 'M'),
        (0., 0., near, far, 'V'),
        (0., 1., near, far, 'V'),
        (1., 1., near, far, 'V'),
        (0., far, near, far, 'M'),
    ];
    vec![
        Creases::on_square("diagonal", [4, 5], &[(0., 0., 1., 1., 'V')]),
        Creases::on_square("book", [6, 7], &[(0.5, 0., 0.5, 1., 'M')]),
        Creases::on_square("waterbomb base", [7, 12], &cross),
        Creases::on_square("preliminary base", [9, 14], &preliminary),
        Creases::on_square("fish base", [8, 15], &fish),
        of_file("bird base", include_str!("../../cases/fold/bird-base.fold"), [17, 40]),
        of_file("square twist", include_str!("../../cases/fold/square-twist.fold"), [16, 24]),
        pleats(5),
        miura(3, 2),
        miura(6, 6),
        tiled("yoshimura", [3, 3]),
        tiled("waterbomb", [2, 2]),
        tiled("square-twist", [2, 2]),
    ]
}

/// A file of the corpus.
struct File {
    name: String,
    /// `None` for FOLD.
    format: Option<Format>,
    text: String,
}

impl File {
    fn read(&self) -> Result<Sheet, String> {
        let read = match self.format {
            None => fold::parse(&self.text, "a.fold"),
            Some(format) => pattern::parse(&self.text, "a", format),
        };
        read.map_err(|error| error.to_string())
    }
}

/// ORIPA's `.cp`: types and coordinates from -200 to 200, y downwards, lines ended as on Windows.
pub(super) fn cp(creases: &Creases) -> String {
    let line = |([[x1, y1], [x2, y2]], letter): ([[f64; 2]; 2], char)| {
        format!("{} {x1} {} {x2} {}\r\n", number(letter), -y1, -y2)
    };
    creases.placed(-200.0, 400.0).into_iter().map(line).collect()
}

pub(super) fn number(letter: char) -> usize {
    " BMV".find(letter).unwrap_or(0)
}

/// ORIPA's `.opx`: the same as Java beans; properties that are 0 are left out.
pub(super) fn opx(creases: &Creases) -> String {
    let property = |name: &str, value: f64| match value {
        0.0 => String::new(),
        _ => format!("     <void property=\"{name}\">\n      <double>{value:?}</double>\n     </void>\n"),
    };
    let line = |(k, (ends, letter)): (usize, ([[f64; 2]; 2], char))| {
        let [[x0, y0], [x1, y1]] = ends;
        let places = [("x0", x0), ("y0", -y0), ("x1", x1), ("y1", -y1)].map(|(name, value)| property(name, value));
        format!(
            "   <void index=\"{k}\">\n    <object class=\"oripa.OriLineProxy\">\n     <void property=\"type\">\n      \
             <int>{}</int>\n     </void>\n{}    </object>\n   </void>\n",
            number(letter),
            places.concat()
        )
    };
    let lines: String = creases.placed(-200.0, 400.0).into_iter().enumerate().map(line).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<java version=\"1.6.0_26\" class=\"java.beans.XMLDecoder\">\n <object \
         class=\"oripa.DataSet\">\n  <void property=\"lines\">\n  <array class=\"oripa.OriLineProxy\" length=\"{}\">\n\
         {lines}  </array>\n  </void>\n  <void property=\"title\">\n   <string>{}</string>\n  </void>\n </object>\n</java>\n",
        creases.lines.len(),
        creases.name
    )
}

/// Illustrator: classes of a style sheet, its own red and blue, an entity, two decimals.
pub(super) fn illustrator(creases: &Creases) -> String {
    let line = |([[x1, y1], [x2, y2]], letter): ([[f64; 2]; 2], char)| {
        let class = " BMV".find(letter).unwrap() - 1;
        let [y1, y2] = [y1, y2].map(|y| 200.0 - y);
        format!("<line class=\"st{class}\" x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\"/>\n")
    };
    let lines: String = creases.placed(0.0, 200.0).into_iter().map(line).collect();
    format!(
        "\u{feff}<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- Generator: Adobe Illustrator 24.0.1, SVG Export Plug-In -->\n\
         <!DOCTYPE svg PUBLIC \"-//W3C//DTD SVG 1.1//EN\" \"http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd\" [\n\t<!ENTITY \
         ns_svg \"http://www.w3.org/2000/svg\">\n]>\n<svg version=\"1.1\" xmlns=\"&ns_svg;\" viewBox=\"0 0 200 200\">\n<style \
         type=\"text/css\">\n\t.st0{{fill:none;stroke:#231F20;stroke-miterlimit:10;}}\n\t.st1{{fill:none;stroke:#ED1C24;}}\n\t\
         .st2{{fill:none;stroke:#2E3192;}}\n</style>\n<rect fill=\"#FFFFFF\" width=\"200\" height=\"200\"/>\n<g id=\"creases\">\n\
         {lines}</g>\n</svg>\n"
    )
}

/// Inkscape: relative paths with `style`, layers with transforms, and elements of its own.
pub(super) fn inkscape(creases: &Creases) -> String {
    let line = |([[x1, y1], [x2, y2]], letter): ([[f64; 2]; 2], char)| {
        let colour = ["#000000", "#ff0000", "#0000ff"][" BMV".find(letter).unwrap() - 1];
        format!(
            "<path style=\"fill:none;stroke:{colour};stroke-width:0.26458332px;stroke-opacity:1\" d=\"m {x1},{y1} {},{}\"/>\n",
            x2 - x1,
            y2 - y1
        )
    };
    let lines: String = creases.placed(0.0, 100.0).into_iter().map(line).collect();
    format!(
        "<svg width=\"210mm\" height=\"297mm\" viewBox=\"0 0 210 297\" xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         xmlns:sodipodi=\"http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd\">\n<sodipodi:namedview id=\"base\" \
         pagecolor=\"#ffffff\"/>\n<metadata/>\n<g inkscape:label=\"Layer 1\" inkscape:groupmode=\"layer\" \
         transform=\"translate(20,150)\">\n<g transform=\"matrix(0.70710678118654752,-0.70710678118654752,-0.70710678118654752,\
         -0.70710678118654752,3,4)\">\n{lines}</g>\n<text x=\"1\" y=\"2\" style=\"fill:#000000\">notes</text>\n</g>\n</svg>\n"
    )
}

/// Origami Simulator's example patterns: plain lines with named colours, folds of 90 degrees by opacity.
pub(super) fn simulator_svg(creases: &Creases) -> String {
    let line = |([[x1, y1], [x2, y2]], letter): ([[f64; 2]; 2], char)| {
        let stroke = ["black", "rgb(255, 0, 0)\" opacity=\"0.5", "#00F\" stroke-opacity=\"50%"];
        let stroke = stroke[" BMV".find(letter).unwrap() - 1];
        let [y1, y2] = [y1, y2].map(|y| 500.0 - y);
        format!("<line stroke=\"{stroke}\" x1=\"{x1}\" y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"/>\n")
    };
    let lines: String = creases.placed(0.0, 500.0).into_iter().map(line).collect();
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{lines}</svg>\n")
}

fn list<T>(of: impl IntoIterator<Item = T>, text: impl Fn(T) -> String) -> String {
    format!("[{}]", of.into_iter().map(text).collect::<Vec<_>>().join(",\n"))
}

/// Rabbit Ear: two dimensions, the crease pattern on top and a frame that inherits from it.
fn rabbit_ear(sheet: &Sheet) -> String {
    let sides: Vec<&Edge> = sheet.edges.iter().filter(|edge| edge.kind != EdgeKind::Facet).collect();
    let ends = |edge: &&Edge| format!("[{}, {}]", edge.key.i, edge.key.j);
    let degrees =
        |edge: &&Edge| sheet.assignment(edge).flat_folded_angle().map_or("0".into(), |a| a.to_degrees().to_string());
    let points = |factor: f64| list(&sheet.vertices, |x| format!("[{:?}, {:?}]", x.x * factor, x.y));
    format!(
        "{{\"file_spec\": 1.1, \"file_creator\": \"Rabbit Ear\", \"frame_classes\": [\"creasePattern\"],\n\"vertices_coords\": {},\n\
         \"edges_vertices\": {},\n\"edges_assignment\": {},\n\"edges_foldAngle\": {},\n\"file_frames\": [{{\"frame_classes\": \
         [\"foldedForm\"], \"frame_inherit\": true, \"frame_parent\": 0, \"vertices_coords\": {}}}]}}",
        points(1.0),
        list(&sides, ends),
        list(&sides, |edge| format!("\"{}\"", sheet.assignment(edge))),
        list(&sides, degrees),
        points(0.5),
    )
}

/// Origami Simulator's export of an unfolded pattern: triangles in the plane of x and z, their diagonals as F.
fn simulator_fold(sheet: &Sheet) -> String {
    let angle = |edge: &Edge| match sheet.assignment(edge) {
        Assignment::Boundary => "null".into(),
        letter => letter.flat_folded_angle().unwrap_or(0.0).to_degrees().to_string(),
    };
    let letter = |edge: &Edge| match edge.kind {
        EdgeKind::Facet => "\"F\"".to_owned(),
        _ => format!("\"{}\"", sheet.assignment(edge)),
    };
    format!(
        "{{\"file_spec\": 1.1, \"file_creator\": \"Origami Simulator: http://git.amandaghassaei.com/OrigamiSimulator/\",\n\
         \"frame_attributes\": [\"3D\"], \"frame_unit\": \"unit\",\n\"vertices_coords\": {},\n\"edges_vertices\": {},\n\
         \"edges_assignment\": {},\n\"edges_foldAngle\": {},\n\"faces_vertices\": {}}}",
        list(&sheet.vertices, |x| format!("[{:?}, 0, {:?}]", x.x, -x.y)),
        list(&sheet.edges, |edge| format!("[{}, {}]", edge.key.i, edge.key.j)),
        list(&sheet.edges, letter),
        list(&sheet.edges, angle),
        list(&sheet.triangles, |t| format!("{:?}", t.corners.map(|corner| corner.vertex))),
    )
}

/// Returns the files of a pattern in all dialects.
fn files(creases: &Creases) -> Vec<File> {
    let sheet =
        pattern::parse(&cp(creases), "a.cp", Format::Cp).unwrap_or_else(|error| panic!("{}: {error}", creases.name));
    let dialects: [(&str, Option<Format>, String); 7] = [
        ("ORIPA cp", Some(Format::Cp), cp(creases)),
        ("ORIPA opx", Some(Format::Opx), opx(creases)),
        ("Illustrator", Some(Format::Svg), illustrator(creases)),
        ("Inkscape", Some(Format::Svg), inkscape(creases)),
        ("Origami Simulator svg", Some(Format::Svg), simulator_svg(creases)),
        ("Rabbit Ear", None, rabbit_ear(&sheet)),
        ("Origami Simulator fold", None, simulator_fold(&sheet)),
    ];
    let file = |(dialect, format, text)| File { name: format!("{}, {dialect}", creases.name), format, text };
    dialects.into_iter().map(file).collect()
}

/// Returns the total length of the edges of a letter, in units of that of the boundary.
fn share(sheet: &Sheet, letter: Assignment) -> f64 {
    let length = |letter: Assignment| -> f64 {
        let of_letter = sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter);
        of_letter.map(|edge| edge.key.ends().map(|end| sheet.position(end))).map(|[a, b]| (b - a).norm()).sum()
    };
    length(letter) / length(Assignment::Boundary)
}

/// Claim: every file of every dialect is the pattern that it draws: its numbers of vertices and edges, and the shares
/// of mountains and valleys of the total length. Source: counts by hand or formula; lengths of the generator's lines.
/// Tolerance: Illustrator's two decimals on 200 units, on lines of 10 units or more.
#[test]
fn every_dialect_is_read() {
    let mut count = 0;
    for creases in patterns() {
        let drawn = |letter: char| -> f64 {
            let lines = creases.lines.iter().filter(|(_, own)| *own == letter);
            lines.map(|([[x1, y1], [x2, y2]], _)| (x2 - x1).hypot(y2 - y1)).sum()
        };
        for file in files(&creases) {
            let sheet = file.read().unwrap_or_else(|error| panic!("{}: {error}", file.name));
            let sides = sheet.edges.iter().filter(|edge| {
                let flat = file.name.ends_with("fold") && sheet.assignment(edge) == Assignment::Flat;
                edge.kind != EdgeKind::Facet && !flat
            });
            assert_eq!([sheet.vertices.len(), sides.count()], creases.counts, "{}", file.name);
            for (letter, name) in [(Assignment::Mountain, 'M'), (Assignment::Valley, 'V')] {
                let off = share(&sheet, letter) - drawn(name) / drawn('B');
                assert!(off.abs() < 1e-3, "{}: {off}", file.name);
            }
            count += 1;
        }
    }
    assert_eq!(count, 7 * patterns().len());
}

/// Relaxes a pattern to a fifth of its targets, with faces that do not bend and stiff bars.
pub(super) fn folded(sheet: Sheet) -> Result<Relaxed, Box<RelaxError>> {
    relax(&Assembly::patch(sheet, [1, 1]).bars(1e4).creases(1.0).rest(Rest::Target(0.2)).build().unwrap())
}

/// Claim: at least 95% of the patterns relax to a fifth of their target angles, from the flat state of their file to
/// one out of the plane: the energy is below that of the flat state, and the forces balance to the solver's tolerance,
/// 1e-11.
#[test]
fn patterns_fold_from_their_files() {
    let mut failures = Vec::new();
    let mut count = 0;
    for file in patterns().iter().flat_map(files) {
        count += 1;
        match folded(file.read().unwrap()) {
            Ok(found) => {
                assert!(found.residual_force < 1e-11 && found.negative_eigenvalues == Some(0), "{}", file.name);
                let most = found
                    .state
                    .fold_angle
                    .iter()
                    .filter(|angle| angle.is_finite())
                    .fold(0.0, |m: f64, a| m.max(a.abs()));
                assert!(most > 0.02 * PI, "{}: flat, {most}", file.name);
            }
            Err(error) => failures.push(format!("{}: {error}", file.name)),
        }
    }
    assert!(failures.len() * 20 <= count, "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}

/// Claim: drawings that are no crease patterns are refused, each by the line and column and by what is wrong.
#[test]
fn other_drawings_are_refused_by_name() {
    use Format::Svg;
    let svg = |shapes: &str| format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{shapes}\n</svg>");
    let square = "<rect width=\"10\" height=\"10\" stroke=\"black\"/>";
    let on_square = |shape: &str| svg(&format!("{square}\n{shape}"));
    let deep = format!("<svg>{}{}</svg>", "<g>".repeat(1000), "</g>".repeat(1000));
    let many = (0..30).map(|k| format!("<g id=\"a{k}\"><use href=\"#a{n}\"/><use href=\"#a{n}\"/></g>", n = k + 1));
    let many = format!("<svg>{}<g id=\"a30\"/></svg>", many.collect::<String>());
    let table = [
        (Svg, String::new(), ":1:1: not an SVG file: "),
        (Svg, "{}".into(), ":1:1: not an SVG file: "),
        (Svg, "<html/>".into(), ":1:1: `html` is no outermost element of an SVG file"),
        (Svg, svg(""), ":1:1: there is no line to fold along; draw shapes with a coloured stroke"),
        (Svg, svg("<line x2=\"5\" stroke=\"#07b\"/>"), ":2:1: `#0077bb` is no colour of a line; it should be black"),
        (Svg, svg("<line x2=\"5\" stroke=\"rouge\"/>"), ":2:1: `rouge` is no colour of a stroke"),
        (Svg, svg("<line x2=\"5\" stroke=\"red\" opacity=\"half\"/>"), ":2:1: `half` is no opacity"),
        (Svg, svg("<line x2=\"5%\" stroke=\"red\"/>"), ":2:1: `5%` is no length"),
        (
            Svg,
            svg("<line x2=\"1e300\" stroke=\"red\"/>"),
            ":2:1: the line from (0, 0) to (1e300, 0) has a coordinate over",
        ),
        (Svg, svg("<line x2=\"5\" stroke=\"red\" transform=\"turn(3)\"/>"), ":2:1: `turn(3)` is no transform"),
        (Svg, svg("<polygon points=\"0,0 1,0 1\" stroke=\"red\"/>"), ":2:1: `0,0 1,0 1` is no list of points"),
        (Svg, svg("<path d=\"M 0 0 L x\" stroke=\"red\"/>"), ":2:1: `M 0 0 L x` is no path"),
        (
            Svg,
            svg("<path d=\"M 0 0 L 9 0\" stroke=\"red\"/>"),
            ":2:1: the line from (0, 0) to (9, 0) bounds no face, and",
        ),
        (
            Svg,
            svg("<rect width=\"9\" height=\"9\" rx=\"1\" ry=\"2\" stroke=\"blue\"/>"),
            ":2:1: a rect with elliptic corners",
        ),
        (Svg, svg("<use href=\"#there\"/>"), ":2:1: `#there` is no element of this file"),
        (Svg, deep, "too many elements in a crease pattern"),
        (Svg, many, "too many elements in a crease pattern"),
        (Svg, svg("<rect stroke=\"black\"/>"), ":1:1: there is no line to fold along; draw shapes"),
        (
            Svg,
            on_square("<line x1=\"1\" x2=\"3\" y2=\"5\" stroke=\"blue\"/>"),
            ":3:1: the line from (1, 0) to (3, 5), or a",
        ),
        (
            Svg,
            on_square("<line x2=\"10\" y2=\"10\" stroke=\"black\"/><line x1=\"10\" y2=\"10\" stroke=\"blue\"/>"),
            ":3:1: the line from (0, 0) to (10, 10): ",
        ),
        (
            Svg,
            on_square("<line x2=\"10\" stroke=\"red\"/>"),
            "(0, 0) to (10, 0) and from (0, 0) to (10, 0) lie on each other",
        ),
    ];
    refuse(table);
}

/// Claim: slits and outlines inside a face are refused with the lines that join them; coordinates have eight digits.
#[test]
fn what_is_not_joined_is_told_how() {
    let on_square = |shape: &str| {
        let square = "<rect width=\"10\" height=\"10\" stroke=\"black\"/>";
        format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n{square}\n{shape}\n</svg>")
    };
    let table = [
        (
            "<rect x=\"3\" y=\"3\" width=\"2\" height=\"2\" stroke=\"red\"/>",
            "does not touch the other lines; join it to them by two lines or more that do not fold (cyan in SVG",
        ),
        (
            "<line x1=\"3\" y1=\"2.123456789012\" x2=\"7\" y2=\"5\" stroke=\"lime\"/>",
            ":3:1: the line from (3, 2.1234568) to (7, 5)",
        ),
        (
            "<path d=\"M1 5H3H7\" stroke=\"lime\"/>",
            "join the ends of a slit to others by lines that do not fold (cyan in SVG",
        ),
    ];
    refuse(table.map(|(shape, words)| (Format::Svg, on_square(shape), words)));
}

/// Claim: files of ORIPA that cannot be read are refused in the same way.
#[test]
fn other_files_are_refused_by_name() {
    use Format::{Cp, Opx};
    let triangle = "1 0 0 1 0\n1 1 0 1 1\n1 1 1 0 0\n";
    let table = [
        (Cp, String::new(), ":1:1: there is no line to fold along"),
        (
            Cp,
            format!("{triangle} 7 0 0 1 1"),
            ":4:2: `7` is no type of a line; it should be 1 (boundary), 2 (mountain)",
        ),
        (Cp, format!("{triangle}2 0 0 1"), ":4:1: `2 0 0 1` is no line of a crease pattern"),
        (Cp, format!("{triangle}2 0 0 1 one"), ":4:1: `one` is no coordinate"),
        (Opx, "<java/>".into(), ":1:1: there is no line to fold along"),
        (
            Opx,
            "<java><object class=\"oripa.OriLineProxy\"><void property=\"type\"><int>9</int></void></object></java>"
                .into(),
            ":1:7: `9` is no type of a line",
        ),
        (Opx, triangle.into(), ":1:1: not an OPX file: "),
    ];
    refuse(table);
}

fn refuse<const N: usize>(table: [(Format, String, &str); N]) {
    for (format, text, part) in table {
        let message = pattern::parse(&text, "a", format).map(|_| ()).unwrap_err().to_string();
        assert!(message.starts_with("a:") && message.contains(part), "{message}\nnot {part}");
    }
}

/// Claim: edges that cross, touch and almost meet in a FOLD file, which is refused as it is, are split and merged on
/// request with their letters and angles, and the file keeps its author; without `split` crossings stay and are
/// refused; sheets that are folded or periodic, and a distance out of range, are refused by name.
#[test]
fn fold_files_are_merged_and_split() {
    let text = r#"{"file_author": "A", "vertices_coords": [[0,0],[2,0],[2,2],[0,2],[0.0003,0],[2,2.0002],[1,2]],
"edges_vertices": [[0,1],[1,2],[5,3],[3,4],[0,5],[1,3],[1,6]], "edges_assignment": ["B","B","B","B","M","V","F"],
"edges_foldAngle": [null,null,null,null,-90,90,0]}"#;
    assert!(fold::parse(text, "a.fold").is_err());
    let clean = |text: &str, merge: Option<f64>, split: bool| {
        fold::parse_frame(text, "a.fold", None, Some(&Cleanup { merge, split })).map_err(|error| error.to_string())
    };
    let sheet = clean(text, Some(1e-3), true).unwrap();
    let sides = sheet.edges.iter().filter(|edge| edge.kind != EdgeKind::Facet).count();
    assert_eq!((sheet.vertices.len(), sides, sheet.polygons.len()), (7, 12, 6));
    let angle = |letter: Assignment| -> Vec<f64> {
        let edges = sheet.edges.iter().filter(|edge| sheet.assignment(edge) == letter);
        edges.map(|edge| sheet.targets[&edge.key].to_degrees()).collect()
    };
    assert_eq!(angle(Assignment::Mountain), [-90.0; 3]);
    assert_eq!(angle(Assignment::Valley), [90.0; 2]);
    assert!(fold::write(&sheet).contains("\"file_author\": \"A\""));
    let refused = |text: &str, merge: f64, split: bool, part: &str| {
        let message = clean(text, Some(merge), split).unwrap_err();
        assert!(message.contains(part), "{message}\nnot {part}");
    };
    refused(text, 1e-3, false, "cross or touch in the plane");
    refused(text, 0.0, true, "the distance should be above 0");
    refused(text, f64::NAN, true, "the distance should be above 0");
    refused(text, 1.0, true, "below a tenth of the extent, 2");
    let doubled = clean(&text.replace("[1,6]", "[1,2]"), Some(1e-3), true).unwrap();
    assert_eq!(doubled.polygons.len(), 4);
    refused(
        &text.replace("[5,3]", "[0,2]"),
        1e-3,
        true,
        "lie on each other, one with B and one with M and -90 degrees",
    );
    let folded = include_str!("../../cases/fold/simulator-half-folded.fold");
    refused(folded, 1e-3, true, "this frame is a folded form");
    refused(&fold::write(&generate(&Pattern::named("miura").unwrap()).unwrap()), 1e-3, true, "this sheet is periodic");
}

/// Claim: 101 x 101 long lines that all cross, and 10,000 lines between two long ones, are split into `2 n (n - 1)`
/// sides of squares and, for the comb, two points on the rim for each line. Source: counted by formula.
#[test]
fn large_drawings_are_split_where_they_meet() {
    let n = 101;
    let line = |k: usize| {
        let (at, kind) = (k as f64, if k == 0 || k == n - 1 { 1 } else { 2 + k % 2 });
        format!("{kind} {at} 0 {at} {end}\n{kind} 0 {at} {end} {at}\n", end = n - 1)
    };
    let grid: String = (0..n).map(line).collect();
    let sheet = pattern::parse(&grid, "a", Format::Cp).unwrap();
    let sides = sheet.edges.iter().filter(|edge| edge.kind != EdgeKind::Facet).count();
    assert_eq!((sheet.vertices.len(), sides), (n * n, 2 * n * (n - 1)));
    let teeth = 5_000;
    let tooth = |k: usize| format!("2 {k}.5 0 {k}.75 10\n3 {k}.5 10 {k}.25 0\n");
    let rim = format!("1 0 0 {teeth} 0\n1 {teeth} 0 {teeth} 10\n1 {teeth} 10 0 10\n1 0 10 0 0\n");
    let comb = rim + &(0..teeth).map(tooth).collect::<String>();
    let cleanup = Cleanup { merge: Some(1e-3), split: true };
    let sheet = pattern::parse_cleaned(&comb, "a", Format::Cp, &cleanup).unwrap();
    let sides = sheet.edges.iter().filter(|edge| edge.kind != EdgeKind::Facet).count();
    // no two teeth cross: each pair has four ends on the rim
    assert_eq!((sheet.vertices.len(), sides), (4 + 4 * teeth, 4 + 4 * teeth + 2 * teeth));
}

/// Claim: SVG to FOLD to SVG gives the same text, and so do points, letters and target angles, of every pattern; a
/// pattern of which every line has another opacity keeps them all bit by bit, and `.cp` to FOLD to `.cp` its types.
#[test]
fn patterns_go_there_and_back() {
    let shades = |creases: &Creases| -> String {
        let shade = |(k, (ends, letter)): (usize, &([[f64; 2]; 2], char))| {
            let [[x1, y1], [x2, y2]] = ends;
            let stroke = ["#000", "#f00", "#00f"][" BMV".find(*letter).unwrap() - 1];
            let opacity = (k as f64 + 1.0) * 0.617 % 1.0;
            format!(
                "<line x1=\"{x1:?}\" y1=\"{y1:?}\" x2=\"{x2:?}\" y2=\"{y2:?}\" stroke=\"{stroke}\" opacity=\"{opacity:?}\"/>"
            )
        };
        format!("<svg>{}</svg>", creases.lines.iter().enumerate().map(shade).collect::<String>())
    };
    for creases in patterns() {
        for (text, format) in
            [(shades(&creases), Format::Svg), (illustrator(&creases), Format::Svg), (cp(&creases), Format::Cp)]
        {
            let sheet = pattern::parse(&text, "a", format).unwrap();
            let drawn = pattern::write_svg(&sheet).unwrap();
            let stored = fold::parse(&fold::write(&sheet), "a.fold").unwrap();
            assert_eq!(stored, sheet, "{}", creases.name);
            assert_eq!(pattern::write_svg(&stored).unwrap(), drawn, "{}", creases.name);
            let again = pattern::parse(&drawn, "a", Format::Svg).unwrap();
            assert_eq!(again, sheet, "{}", creases.name);
            let (lines, changed) = pattern::write_cp(&sheet).unwrap();
            let again = pattern::parse(&lines, "a", Format::Cp).unwrap();
            assert_eq!((pattern::write_cp(&again).unwrap().0, changed), (lines, 0), "{}", creases.name);
        }
    }
}

/// Claim: the target angle of a fold is its opacity times 180 degrees, in a line and over the groups around it,
/// negative for mountains. Source: the definition of Origami Simulator. Tolerance: none, the products of these numbers
/// are exact.
#[test]
fn opacity_is_the_part_of_a_whole_fold() {
    let rim = "<rect width=\"4\" height=\"4\" stroke=\"#000\"/>";
    for (line, degrees) in [
        ("<line x2=\"4\" y2=\"4\" stroke=\"#f00\"/>", -180.0),
        ("<line x2=\"4\" y2=\"4\" stroke=\"#f00\" opacity=\"0.5\"/>", -90.0),
        ("<line x2=\"4\" y2=\"4\" stroke=\"#00f\" stroke-opacity=\"25%\"/>", 45.0),
        ("<g opacity=\"0.5\"><line x2=\"4\" y2=\"4\" stroke=\"#00f\" style=\"opacity:0.5\"/></g>", 45.0),
    ] {
        let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{rim}{line}</svg>");
        let sheet = pattern::parse(&text, "a", Format::Svg).unwrap();
        let folds: Vec<f64> =
            sheet.targets.values().map(|target| target.to_degrees()).filter(|fold| *fold != 0.0).collect();
        assert_eq!(folds, [degrees], "{line}");
    }
}

/// Claim: all letters survive a drawing: hinges, facets, joints and cuts have their colours, a hole stays a hole, and a
/// folded or periodic sheet is refused.
#[test]
fn all_colours_are_written_as_they_are_read() {
    let lines = "<rect width=\"9\" height=\"9\" stroke=\"black\"/><rect x=\"3\" y=\"3\" width=\"3\" height=\"3\" stroke=\"black\"/>\
                 <line y1=\"3\" x2=\"3\" y2=\"3\" stroke=\"#ff0\"/><line x1=\"6\" y1=\"6\" x2=\"9\" y2=\"6\" stroke=\"#f0f\"/>\
                 <line x1=\"3\" x2=\"3\" y2=\"3\" stroke=\"#0ff\"/><line x1=\"6\" y1=\"6\" x2=\"6\" y2=\"9\" stroke=\"#0f0\"/>";
    let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\">{lines}</svg>");
    let sheet = pattern::parse(&text, "a", Format::Svg).unwrap();
    assert_eq!(sheet.polygons.len(), 4, "the square in the middle is a hole");
    let drawn = pattern::write_svg(&sheet).unwrap();
    for colour in ["#ff0", "#f0f", "#0ff", "#0f0"] {
        assert_eq!(drawn.matches(&format!("\"{colour}\"")).count(), 1, "{colour}");
    }
    assert_eq!(pattern::parse(&drawn, "a", Format::Svg).unwrap(), sheet);
    assert_eq!(pattern::write_cp(&sheet).unwrap().1, 2);
    let dxf = pattern::write_dxf(&sheet).unwrap();
    assert_eq!(pattern::parse(&dxf, "a", Format::Dxf).unwrap().edges, sheet.edges);
    for name in ["miura", "miura-patch"] {
        let folded = generate(&Pattern::named(name).unwrap()).unwrap();
        assert!(pattern::write_svg(&folded).is_err() && pattern::write_cp(&folded).is_err());
    }
}

/// Claim: the program cleans, converts and relaxes these files: a drawing goes to FOLD, and a FOLD file whose edges
/// cross is split on request and refused without; frames are asked for in vain; a scene reads a drawing.
#[test]
fn the_program_reads_patterns() {
    let folder = Folder::new().with("a.svg", inkscape(&patterns()[2]));
    let crossed = r#"{"vertices_coords": [[0,0],[1,0],[1,1],[0,1]],
        "edges_vertices": [[0,1],[1,2],[2,3],[3,0],[0,2],[1,3]], "edges_assignment": ["B","B","B","B","M","V"]}"#;
    folder.write("b.fold", crossed);
    for words in
        ["convert a.svg a.fold", "convert a.fold a.stl", "convert a.fold a.cp", "convert b.fold c.fold --split"]
    {
        folder.foldwell(words).well();
    }
    assert_eq!(folder.text("a.stl").matches("facet normal 0.0 0.0 1.0").count(), 6);
    for (words, part) in [
        ("convert b.fold d.fold", "cross or touch"),
        ("info a.svg --frame 1", "this file has no frames"),
        ("convert a.gif d.fold", "expected one of .fold, .obj, .stl, .vtu, .svg, .cp, .opx, .ori or .dxf"),
        ("convert a.fold d.vtu --split --frame 3", "there is no frame 3"),
        ("convert a.stl d.fold --split", "expected one of .fold, .svg, .cp, .opx, .ori or .dxf"),
    ] {
        folder.foldwell(words).refused(part);
    }
    let scene = "[sheet]\nmesh = \"a.svg\"\n[energy]\nbars = { stiffness = 1e4 }\n\
                 creases = { stiffness = 1.0, rest = \"target\", fraction = 0.2 }\n[[study]]\nname = \"r\"\nkind = \"relax\"\n";
    folder.write("s.toml", scene);
    assert_eq!(folder.foldwell("run s.toml --quiet").well().err, "");
    folder.foldwell("run s.toml --quiet --frame 1").refused("a crease pattern of lines has no frames");
}

/// Claim: states of simulators are read as they are drawn, with their targets: half folded with all angles on the way,
/// and folded flat in two dimensions with `faceOrders`, as Flat-Folder writes it; they go to no file of lines.
#[test]
fn folded_states_are_read_and_not_drawn_as_lines() {
    let half = fold::parse(include_str!("../../cases/fold/simulator-half-folded.fold"), "half.fold").unwrap();
    assert_eq!((half.vertices.len(), half.targets_not_drawn()), (6, 1));
    let state = r#"{"file_spec": 1.1, "file_creator": "flat-folder", "file_classes": ["singleModel"],
        "frame_classes": ["foldedForm"], "vertices_coords": [[1,0],[0,0],[1,0],[1,1],[0,1],[1,1]],
        "edges_vertices": [[0,1],[1,2],[2,3],[3,4],[4,5],[5,0],[1,4]], "edges_assignment": ["B","B","B","B","B","B","V"],
        "faces_vertices": [[0,1,4,5],[1,2,3,4]], "faceOrders": [[0,1,1]]}"#;
    let state = fold::parse(state, "state.fold").unwrap();
    assert_eq!((state.vertices.len(), state.polygons.len()), (6, 2));
    let refused = |sheet: &Sheet| pattern::write_svg(sheet).unwrap_err().to_string();
    assert!(refused(&half).contains("a crease pattern is flat"), "{}", refused(&half));
    assert!(refused(&state).contains("folded flat"), "{}", refused(&state));
}

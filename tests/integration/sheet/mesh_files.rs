//! Files of meshes that are drawn with an error, come from other programs in an unusual form, or are made to do harm;
//! and the names of files that are written.

use crate::common::{Folder, Numbers, Scene, case_folder, mesh_folder};
use foldwell::math::Vec3;
use foldwell::sheet::pattern::{self, Cleanup, Format};
use foldwell::sheet::{Assignment, EdgeKind, Info, Sheet};
use std::fmt::Write;
use std::fs;
use std::process::Command;

/// Lines along each side of the squares that are drawn, and the side of the drawing. Points are merged within 1e-4 of
/// it.
const SQUARES: usize = 4;
const SIDE: f64 = 400.0;
const MERGED: f64 = 1e-4 * SIDE;

/// Returns a square of `SQUARES x SQUARES` squares with a diagonal each as 56 lines from vertex to vertex, every end
/// moved by up to `error`.
fn careless(error: f64, seed: u64) -> String {
    let mut random = Numbers::new(seed);
    let step = SIDE / SQUARES as f64;
    let mut text = String::new();
    let mut line = |kind: usize, ends: [[usize; 2]; 2]| {
        let [[x1, y1], [x2, y2]] = ends.map(|[i, j]| {
            let [angle, off] = [random.within(std::f64::consts::PI), random.within(error)];
            [i as f64 * step + off * angle.cos(), j as f64 * step + off * angle.sin()]
        });
        writeln!(text, "{kind} {x1:?} {y1:?} {x2:?} {y2:?}").unwrap();
    };
    let rim = |k: usize| if k == 0 || k == SQUARES { 1 } else { 2 + k % 2 };
    for i in 0..=SQUARES {
        for j in 0..SQUARES {
            line(rim(i), [[i, j], [i, j + 1]]);
            line(rim(i), [[j, i], [j + 1, i]]);
            if i < SQUARES {
                line(2, [[i, j], [i + 1, j + 1]]);
            }
        }
    }
    text
}

fn read(text: &str) -> Result<Sheet, String> {
    pattern::parse(text, "a", Format::Cp).map_err(|error| error.to_string())
}

/// Claim: ends that miss a vertex by less than half the distance of merging are one vertex. With larger errors a
/// drawing has its 25 vertices, or is refused, or it is said that two vertices are close: it never gets other vertices
/// without a word, and it always comes to an end. Refusals name a gap of less than three distances of merging, or the
/// chain of points. Source: two points within half a distance of a third are within that distance of each other; pieces
/// become shorter or points fewer in every round.
#[test]
fn careless_drawings_are_read_or_refused() {
    for error in [0.1, 0.3, 0.45, 0.499, 0.6, 0.7, 0.8, 1.0, 1.3, 1.7, 2.5, 5.0] {
        let mut right = 0;
        for seed in 0..20 {
            match read(&careless(error * MERGED, seed)) {
                Ok(sheet) if sheet.vertices.len() == 25 => right += 1,
                Ok(sheet) => assert!(sheet.record.redrawing.gap.is_some(), "{error}, {seed}: {}", sheet.vertices.len()),
                Err(said) => {
                    let named = ["there is a gap of", "a chain of points", "has the same face", "do not touch"];
                    assert!(named.iter().any(|part| said.contains(part)), "{error}, {seed}: {said}");
                    assert!(!said.contains("lie on each other"), "{error}, {seed}: {said}");
                }
            }
        }
        println!("{error}: {right} of 20 are right");
        assert!(error > 0.5 || right == 20, "{error}: {right}");
    }
}

/// Claim: creases side by side that end a little short, and sheets side by side, stay apart, their close vertices are named,
/// and corners that both sides pass are where these meet. Source: as drawn; a distance of merging that bridges the gap of
/// 1 is below the distance of the lines.
#[test]
fn lines_side_by_side_stay_two() {
    let square = |x: f64| format!("1 {x} 0 {0} 0\n1 {0} 0 {0} 60\n1 {0} 60 {x} 60\n1 {x} 60 {x} 0\n", x + 100.0);
    for (letter, strip) in [(2, 1.5), (2, 2.5), (3, 2.0), (3, 3.5)] {
        let sheet = read(&format!("{}2 1 30 99 30\n{letter} 1 {1} 99 {1}\n", square(0.0), 30.0 + strip)).unwrap();
        let creases = sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease).count();
        assert_eq!((creases, sheet.vertices.len(), sheet.polygons.len()), (2, 8, 3), "{letter}, {strip}");
        let gap = sheet.record.redrawing.gap.unwrap();
        assert!((gap.distance - strip).abs() < 1e-12, "{gap:?}");
    }
    let two = read(&format!("{}{}2 50 1 50 59\n3 153 1 153 59\n", square(0.0), square(103.0))).unwrap();
    let right = two.vertices.iter().map(|vertex| vertex.x).fold(0.0, f64::max);
    assert_eq!((two.vertices.len(), two.polygons.len(), right), (12, 4, 203.0));
    let over = read("1 -1 0 101 0\n1 100 -1 100 61\n1 101 60 -1 60\n1 0 61 0 -1\n2 0 0 100 60\n").unwrap();
    let corners = [[0.0, 0.0], [100.0, 0.0], [100.0, -60.0], [0.0, -60.0]];
    assert!(
        over.vertices.len() == 4
            && corners.iter().zip(&over.vertices).all(|(c, v)| (c[0] - v.x).hypot(c[1] - v.y) < 1e-12)
    );
}

/// Claim: where a gap in the rim asks for a larger distance of merging, three creases that miss one point by four times as
/// much as that gap meet there too, since all other points are three hundred times as far apart; where no gap asks for it
/// their sliver is kept. Source: by hand.
#[test]
fn points_much_nearer_than_all_others_are_one() {
    let drawing = |corner: f64| {
        let rim = format!("1 0 0 600 0\n1 {corner} 0 600 600\n1 600 600 0 600\n1 0 600 0 0\n");
        read(&format!("{rim}2 0 0 600 600\n2 600 0 0 600\n3 300.7 0 300.7 600\n")).unwrap()
    };
    let [careless, exact] = [600.19, 600.0].map(drawing);
    assert_eq!((careless.vertices.len(), careless.polygons.len()), (7, 6));
    assert_eq!((exact.vertices.len(), exact.polygons.len()), (9, 7));
}

/// Claim: three creases that miss one point of the square by 1.1 distances of merging end in one vertex there, as do
/// two creases that end beside a corner; where a gap is wider, the message gives its ends and both distances. Source:
/// by hand; rounds that double the pieces of the three lines do not end.
#[test]
fn lines_that_nearly_meet() {
    let square = "1 0 0 400 0\n1 400 0 400 400\n1 400 400 0 400\n1 0 400 0 0\n";
    let three = "2 0 200 400 200\n3 84.529946 0 315.470054 400\n3 315.514054 0 84.573946 400\n";
    let sheet = read(&format!("{square}{three}")).unwrap();
    assert_eq!((sheet.vertices.len(), sheet.polygons.len()), (11, 6));
    let corner = read(&format!("{square}2 0.046 0 400 400\n")).unwrap();
    assert_eq!((corner.vertices.len(), corner.polygons.len(), corner.record.redrawing.gap), (4, 2, None));
    let within = |text: String| {
        let cleanup = Cleanup { merge: Some(0.04), split: true };
        pattern::parse_cleaned(&text, "a", Format::Cp, &cleanup).map_err(|error| error.to_string())
    };
    let close = within(format!("{square}2 0.1 0 400 400\n")).unwrap();
    assert_eq!(close.vertices.len(), 5);
    let gap = close.record.redrawing.gap.unwrap();
    assert!((gap.distance - 0.1).abs() < 1e-12 && gap.merged == 0.04, "{gap:?}");
    let said = "two vertices are 1.000e-1 apart, from (0, 0) to (0.1, 0), and points are merged up to 4.000e-2";
    assert!(Info::new(&close).to_string().contains(said), "{}", Info::new(&close));
    let cured = read(&format!("{square}2 0.1 0 400 400\n")).unwrap();
    assert_eq!((cured.vertices.len(), cured.record.redrawing.gap), (4, None));
    let [merged, first] = cured.record.redrawing.merged.unwrap();
    assert!((merged - 0.09).abs() < 1e-12 && (first - 0.04).abs() < 1e-15, "{merged} {first}");
    let apart = format!("{square}2 0 0 200 200.03\n3 199.97 199.97 400 400\n");
    assert_eq!(read(&apart).unwrap().vertices.len(), 5);
    let apart = within(apart).unwrap_err();
    let gap = "there is a gap of 6.708e-2 from (200, 200.03) to (199.97, 199.97), and points are merged up to 4.000e-2; draw \
               one point, or merge within 6.00e-2";
    assert!(apart.contains(gap), "{apart}");
    let steps = (0..20).map(|k| format!("2 {:?} 100 {:?} 100\n", 0.03 * k as f64, 0.03 * (k + 1) as f64));
    let chain = within(format!("{square}{}", steps.collect::<String>())).unwrap_err();
    assert!(chain.contains("meets a chain of points of which each is within 4.000e-2 of the next"), "{chain}");
}

/// Claim: a line of type 4 of an OPX file has no letter, and one of a CP file is flat. Source: the types of ORIPA and
/// Oriedita.
#[test]
fn type_4_is_what_its_program_means() {
    let lines = [(1, [0, 0, 9, 0]), (1, [9, 0, 9, 9]), (1, [9, 9, 0, 9]), (1, [0, 9, 0, 0]), (4, [0, 0, 9, 9])];
    let cp: String = lines.iter().map(|(kind, [a, b, c, d])| format!("{kind} {a} {b} {c} {d}\n")).collect();
    let property =
        |name: &str, kind: &str, value: i32| format!("<void property=\"{name}\"><{kind}>{value}</{kind}></void>");
    let object = |(kind, ends): &(i32, [i32; 4])| {
        let ends = ["x0", "y0", "x1", "y1"].into_iter().zip(ends).map(|(name, x)| property(name, "double", *x));
        format!(
            "<object class=\"oripa.OriLineProxy\">{}{}</object>",
            property("type", "int", *kind),
            ends.collect::<String>()
        )
    };
    let opx = format!("<java>{}</java>", lines.iter().map(object).collect::<String>());
    for (format, text, letter) in [(Format::Cp, cp, Assignment::Flat), (Format::Opx, opx, Assignment::Unassigned)] {
        let sheet = pattern::parse(&text, "a", format).unwrap();
        let inner: Vec<_> = sheet.edges.iter().filter(|edge| edge.wings.iter().all(Option::is_some)).collect();
        assert_eq!((inner.len(), sheet.assignment(inner[0])), (1, letter), "{format:?}");
    }
}

/// Returns a VTU file of these pieces, each two triangles of a square that is moved by its number times 10.
fn vtu(pieces: usize) -> String {
    let array = |kind: &str, name: &str, more: &str, numbers: &str| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" {more}format=\"ascii\">{numbers}</DataArray>")
    };
    let piece = |k: usize| {
        let x = 10 * k;
        let points = format!("{x} 0 0 {r} 0 0 {r} 1 0 {x} 1 0", r = x + 1);
        format!(
            "<Piece NumberOfPoints=\"4\" NumberOfCells=\"2\"><Points>{}</Points><Cells>{}{}{}</Cells></Piece>",
            array("Float64", "Points", "NumberOfComponents=\"3\" ", &points),
            array("Int64", "connectivity", "", "0 1 2 0 2 3"),
            array("Int64", "offsets", "", "3 6"),
            array("UInt8", "types", "", "5 5"),
        )
    };
    let pieces: String = (0..pieces).map(piece).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\
         <UnstructuredGrid>{pieces}</UnstructuredGrid></VTKFile>"
    )
}

/// Returns a VTU file of a quadrangle, a pentagon above it and a line, with its arrays as raw bytes behind it, each
/// after its length, as ParaView saves them.
fn raw_vtu(length: impl Fn(usize) -> Vec<u8>, header: &str) -> Vec<u8> {
    let (mut data, mut offsets) = (Vec::new(), Vec::new());
    let mut push = |bytes: Vec<u8>| {
        offsets.push(data.len());
        data.extend(length(bytes.len()));
        data.extend(bytes);
    };
    let points = [[0, 0], [2, 0], [2, 1], [0, 1], [2, 2], [1, 3], [0, 2]];
    push(points.iter().flat_map(|[x, y]| [*x, *y, 0]).flat_map(|x| (x as f32).to_le_bytes()).collect());
    push([0, 1, 2, 3, 3, 2, 4, 5, 6, 2, 3].iter().flat_map(|v: &i64| v.to_le_bytes()).collect());
    push([4, 9, 11].iter().flat_map(|v: &i64| v.to_le_bytes()).collect());
    push(vec![9, 7, 3]);
    let array = |k: usize, kind: &str, name: &str, inner: &str| {
        let end = if inner.is_empty() { "/>".into() } else { format!(">{inner}</DataArray>") };
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"appended\" offset=\"{}\" {end}", offsets[k])
    };
    let inner = "<InformationKey name=\"a\" location=\"b\" length=\"1\"><Value index=\"0\">0</Value></InformationKey>";
    let points = array(0, "Float32", "Points", inner).replace(" format", " NumberOfComponents=\"3\" format");
    let mut file = format!(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\"{header}><UnstructuredGrid>\
         <Piece NumberOfPoints=\"7\" NumberOfCells=\"3\"><Points>{points}</Points><Cells>{}{}{}</Cells></Piece>\
         </UnstructuredGrid><AppendedData encoding=\"raw\">\n_",
        array(1, "Int64", "connectivity", ""),
        array(2, "Int64", "offsets", ""),
        array(3, "UInt8", "types", ""),
    )
    .into_bytes();
    file.extend(data);
    file.extend(b"</AppendedData></VTKFile>");
    file
}

/// Claim: quadrangles and polygons are faces that are split by facets, and arrays of raw bytes are read whether their
/// lengths have four bytes or eight; a file that is cut off is refused. Source: counted by hand.
#[test]
fn vtu_files_of_raw_arrays_and_polygons() {
    let long = raw_vtu(|n| (n as u64).to_le_bytes().to_vec(), " header_type=\"UInt64\"");
    let short = raw_vtu(|n| (n as u32).to_le_bytes().to_vec(), "");
    let here = &Folder::new().with("cut.vtu", &long[..long.len() - 60]);
    for file in [long, short] {
        here.write("a.vtu", file);
        let info = here.foldwell("info a.vtu --json").well().json();
        let counts = ["vertices", "polygons", "creases", "facets"].map(|key| info[key].as_u64().unwrap());
        assert_eq!(counts, [7, 2, 1, 3]);
    }
    here.foldwell("info cut.vtu").refused("an array is beyond its end");
}

/// Claim: files that VTK 9.7.2 wrote with its LZMA compressor are read, with blocks of 32 bytes: in the elements, as
/// base64 behind them with lengths of eight bytes, and as raw bytes; one that is damaged or cut off is refused. Source:
/// counted by hand, the sheet of the test before.
#[test]
fn vtu_files_compressed_with_lzma() {
    let here = &Folder::new();
    for file in ["lzma-binary.vtu", "lzma-appended.vtu", "lzma-raw.vtu"] {
        let path = case_folder().join(file);
        let info = here.foldwell(&format!("info {} --json", path.display())).well().json();
        let counts = ["vertices", "polygons", "creases", "facets"].map(|key| info[key].as_u64().unwrap());
        assert_eq!(counts, [7, 2, 1, 3], "{file}");
        assert_eq!([&info["shortest_edge"], &info["longest_edge"]], [1.0, 5f64.sqrt()], "{file}");
    }
    let raw = fs::read(case_folder().join("lzma-raw.vtu")).unwrap();
    let streams: Vec<usize> = (0..raw.len() - 6).filter(|&at| &raw[at..at + 6] == b"\xfd7zXZ\0").collect();
    let mut damaged = raw.clone();
    damaged[streams[1] + 30] ^= 0x55;
    here.write("a.vtu", damaged);
    here.foldwell("info a.vtu").refused("an array is no LZMA data");
    here.write("a.vtu", &raw[..streams[streams.len() - 1] + 20]);
    here.foldwell("info a.vtu").refused("an array is beyond its end");
}

/// Claim: a sheet goes to PLY and GLB, and to STL and back with its vertices and triangles, whatever its title says.
/// Source: counts.
#[test]
fn faces_go_to_programs_that_show_and_print_them() {
    let fold = r#"{"file_title": "endsolid vertex 2", "vertices_coords": [[0,0],[2,0],[2,1],[0,1],[1,0],[1,1]],
        "faces_vertices": [[0,4,5,3],[4,1,2,5]]}"#;
    let here = &Folder::new().with("a.fold", fold);
    for to in ["a.ply", "a.glb", "a.stl", "a.dxf"] {
        here.foldwell(&format!("convert a.fold {to}")).well();
    }
    assert!(here.bytes("a.glb").starts_with(b"glTF") && here.text("a.ply").contains("element face 2\n"));
    assert!(!here.text("a.stl").contains("vertex 2\n"));
    let info = here.foldwell("info a.stl --json").well().json();
    assert_eq!([&info["vertices"], &info["faces"]], [6, 4]);
    assert_eq!(here.foldwell("info a.dxf --json").well().json()["polygons"], 2);
}

/// Claim: all pieces of a VTU file are read, as in VTK; a pipe is refused and not waited for, also as a start. Source:
/// counts.
#[test]
fn vtu_files_of_several_pieces_and_pipes() {
    let here = &Folder::new();
    for pieces in 1..4 {
        here.write("a.vtu", vtu(pieces));
        let info = here.foldwell("info a.vtu --json").well().json();
        let counts = ["vertices", "faces", "pieces"].map(|key| info[key].as_u64().unwrap() as usize);
        assert_eq!(counts, [4 * pieces, 2 * pieces, pieces]);
    }
    if cfg!(unix) {
        let pipe = "this is a device or a pipe";
        assert!(Command::new("mkfifo").arg(here.file("a.pvd")).status().unwrap().success());
        here.foldwell("film a.pvd").refused(pipe);
        assert!(Command::new("mkfifo").arg(here.file("pipe.vtu")).status().unwrap().success());
        let study = "[[study]]\nname = \"a\"\nkind = \"relax\"\nstart = \"pipe.vtu\"\n";
        let sheet = "generate = { pattern = \"miura\" }\n[energy]\nbars = { stiffness = 1e3 }";
        Scene::on(sheet, study).within(here).program("").refused(pipe);
        for words in ["info pipe.vtu", "convert pipe.vtu b.fold"] {
            here.foldwell(words).refused(pipe);
        }
    }
}

/// Claim: VTU files of periodic cells are said to be finite, and it is said of those whose cell is no sheet of its own,
/// since faces meet in a vertex alone; these are refused for that reason. Source: the file is read back.
#[test]
fn vtu_files_of_periodic_cells() {
    let folder = Folder::new();
    let mut tried = [0, 0];
    for entry in fs::read_dir(mesh_folder()).unwrap() {
        let mesh = entry.unwrap().path();
        if mesh.extension().is_none_or(|ending| ending != "fold") {
            continue;
        }
        let said = folder.program(&["convert", mesh.to_str().unwrap(), "a.vtu"]).err;
        let refused = said.contains("it cannot be read as such");
        let reason = folder.foldwell("info a.vtu").ends(if refused { 2 } else { 0 }).err;
        assert_eq!(reason.contains("separate fans"), said.contains("separate fans"), "{}: {said}", mesh.display());
        tried[usize::from(refused)] += usize::from(said.contains("is written as a finite sheet"));
    }
    assert!(tried[0] > 3 && tried[1] > 0, "{tried:?}");
}

/// Claim: an SVG of 200 kB whose entity stands for 2.5 GB, and one with entities in each other, are refused; entities
/// as Illustrator defines them are read.
#[test]
fn entities_do_not_make_short_files_long() {
    let drawing = |entities: &str, title: &str| {
        format!(
            "<!DOCTYPE svg [{entities}]>\n<svg xmlns=\"&ns;\"><title>{title}</title>\
             <rect width=\"9\" height=\"9\" stroke=\"black\"/><path d=\"M 0 0 L 9 9\" stroke=\"red\"/></svg>"
        )
    };
    let ns = "<!ENTITY ns \"http://www.w3.org/2000/svg\">";
    let sheet = pattern::parse(&drawing(ns, "&lt; &ns;"), "a", Format::Svg).unwrap();
    assert_eq!((sheet.vertices.len(), sheet.title.as_str()), (4, "< http://www.w3.org/2000/svg"));
    let long = format!("{ns}<!ENTITY a '{}'>", "x".repeat(50_000));
    let inner = format!("{ns}<!ENTITY a \"{}\"><!ENTITY b \"{}\">", "x".repeat(5_000), "&a;".repeat(200));
    for (entities, named) in [(long, "&a;".repeat(50_000)), (inner, "&b;".repeat(1_000))] {
        let error = pattern::parse(&drawing(&entities, &named), "a", Format::Svg).unwrap_err().to_string();
        assert!(error.contains("its entities may stand for more than 64 MiB of text"), "{error}");
    }
}

/// Claim: pages and patterns are written into files of their kind only, so that a slip does not replace a scene or the
/// summary of a run, and the format of a pattern is that of the ending. A study without branches says so.
#[test]
fn outputs_have_their_endings() {
    let here = &Folder::new();
    let scene = "[sheet]\ngenerate = { pattern = \"miura\" }\ncells = [2, 2]\n[energy]\nbars = { stiffness = 1e3 }\n\
                 creases = { stiffness = 1.0, rest = \"flat\" }\n[[study]]\nname = \"a\"\nkind = \"relax\"\n";
    here.scene(scene).program("").well();
    for file in ["scene.toml", "out/summary.json", "out/a.csv"] {
        let content = here.bytes(file);
        here.foldwell(&format!("view out -o {file}")).refused("expected one of .html");
        here.foldwell(&format!("new miura -o {file}")).refused("expected one of .fold");
        assert_eq!(here.bytes(file), content);
    }
    for ending in ["fold", "obj", "vtu"] {
        let file = format!("x.{ending}");
        here.foldwell(&format!("new miura -o {file}")).well();
        assert!(here.foldwell(&format!("info {file}")).well().out.contains("of 4 polygons") || ending == "vtu");
    }
    here.foldwell("view out -o page.html").well();
    here.foldwell("film out/a.pvd --branch 9").refused("this study has no branches; leave out --branch");
}

/// Claim: help that cannot be written is a failure of the place, status 3, as all other output is.
#[test]
#[cfg(target_os = "linux")]
fn help_needs_a_place_too() {
    for words in ["--help", "--version", "run --help", "schema"] {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let status = Folder::new().command(&words.split(' ').collect::<Vec<_>>()).stdout(full).status().unwrap();
        assert_eq!(status.code(), Some(3), "{words}");
    }
}

/// Claim: a sheet with a thickness is written as a closed surface with both sides and walls, in every format of faces;
/// a thickness that is none is refused, and nothing is written. Source: counts of two triangles' sides and four walls.
#[test]
fn sheets_with_a_thickness_are_closed() {
    let fold = r#"{"vertices_coords": [[0,0],[2,0],[2,1],[0,1]], "faces_vertices": [[0,1,2,3]]}"#;
    let here = &Folder::new().with("a.fold", fold);
    for to in ["b.stl", "b.ply", "b.obj", "b.vtu", "b.fold"] {
        here.foldwell(&format!("convert a.fold {to} --thickness 0.1")).well();
    }
    for from in ["b.stl", "b.obj", "b.fold"] {
        let info = here.foldwell(&format!("info {from} --json")).well().json();
        let counts = ["vertices", "faces", "boundary"].map(|key| info[key].as_u64().unwrap());
        assert_eq!(counts, [8, 12, 0], "{from}");
    }
    for none in ["0", "-1", "nan"] {
        here.foldwell(&format!("convert a.fold c.stl --thickness={none}")).refused("expected a number above 0");
    }
    assert!(!here.path().join("c.stl").exists());
}

/// Claim: ellipses and splines of a DXF drawing are curves of the sheet: an ellipse encloses its area, a spline that is
/// closed and one from edge to edge divide a square into faces, and rational splines are refused by name. Source: area
/// `pi a b`. Tolerance: 1%, for polylines within 1e-3 of the extent.
#[test]
fn curves_of_cad_programs_are_creases() {
    let line =
        |[a, b]: [[f64; 2]; 2]| format!("0\nLINE\n8\nCut\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", a[0], a[1], b[0], b[1]);
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    let square: String = (0..4).map(|k| line([corners[k], corners[(k + 1) % 4]])).collect();
    let ellipse = "0\nELLIPSE\n8\nValley\n10\n2\n20\n2\n11\n0.6\n21\n0.8\n40\n0.5\n41\n0\n42\n6.283185307179586\n";
    let spline = |weight: &str| {
        let control = [[0.0, 2.0], [1.0, 3.5], [3.0, 0.5], [4.0, 2.0]];
        let knots = [0, 0, 0, 0, 1, 1, 1, 1].map(|knot| format!("40\n{knot}\n")).concat();
        let points: String = control.iter().map(|[x, y]| format!("10\n{x}\n20\n{y}\n")).collect();
        format!("0\nSPLINE\n8\nMountain\n70\n8\n71\n3\n{knots}41\n1\n41\n{weight}\n42\n1e-7\n{points}")
    };
    let file = |entities: &str| format!("0\nSECTION\n2\nENTITIES\n{square}{entities}0\nENDSEC\n0\nEOF\n");
    let parse = |entities: &str| pattern::parse(&file(entities), "a", Format::Dxf);
    let spokes = [[[2.6, 2.8], [4.0, 4.0]], [[1.4, 1.2], [0.0, 0.0]]].map(line).concat().replace("Cut", "Mountain");
    let oval = parse(&format!("{ellipse}{spokes}")).unwrap();
    let area = |polygon: usize| -> f64 {
        let triangles = oval.triangles.iter().filter(|triangle| triangle.polygon == polygon);
        let corners = triangles.map(|triangle| triangle.corners.map(|corner| oval.vertices[corner.vertex]));
        corners.map(|[a, b, c]| (b - a).cross(&(c - a)).norm() / 2.0).sum()
    };
    let inner = (0..oval.polygons.len()).map(area).fold(f64::INFINITY, f64::min);
    assert!((inner / (0.5 * std::f64::consts::PI) - 1.0).abs() < 0.01, "{inner}");
    let divided = parse(&spline("1")).unwrap();
    assert_eq!(divided.polygons.len(), 2);
    let middle = Vec3::new(2.0, 2.0, 0.0);
    assert!(divided.vertices.iter().any(|vertex| (vertex - middle).norm() < 0.3), "the curve goes through the middle");
    let rational = parse(&spline("2")).unwrap_err().to_string();
    assert!(rational.contains("this SPLINE") && rational.contains("equal weights"), "{rational}");
}

/// Claim: walls that are thinner than asked for, beside vertices whose moved faces have no common point, are said; those of a
/// drum, whose sharpest corner is 2.5 half thicknesses from its vertex, are as thick as asked for; layers that lie on each
/// other have no room. Source: distances of corners from the planes of faces.
#[test]
fn walls_of_solids() {
    for (name, said) in
        [("helical-tube", Some("walls are as thin as 0.56 of it")), ("drum", None), ("open-star", Some("as thin as"))]
    {
        let folder = Folder::new().with("a.fold", fs::read(mesh_folder().join(format!("{name}.fold"))).unwrap());
        let all = folder.foldwell("convert a.fold a.ply --thickness 0.01").well().all();
        assert_eq!(all.contains("the thickness is not kept everywhere"), said.is_some(), "{name}: {all}");
        assert!(said.is_none_or(|said| all.contains(said)), "{name}: {all}");
    }
    let folded = r#"{"vertices_coords": [[0,0,0],[1,0,0],[0,1,0],[1,0,0]], "faces_vertices": [[0,1,2],[0,2,3]],
        "edges_vertices": [[0,2]], "edges_assignment": ["M"], "frame_classes": ["foldedForm"]}"#;
    let folder = Folder::new().with("a.fold", folded);
    folder
        .foldwell("convert a.fold a.stl --thickness 0.1")
        .refused("layers of a sheet that is folded flat have no room");
}

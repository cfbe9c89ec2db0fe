"""Sheets from files, arrays and patterns."""

import inspect
import io
import json
import re
import warnings

import foldwell as fw
import numpy as np
import pytest
from conftest import ROOT

SQUARE = ([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])


def test_every_pattern_is_generated_and_described():
    for pattern in fw.patterns():
        sheet = fw.generate(pattern)
        assert len(sheet.edges) == len(sheet.kinds) == len(sheet.letters) == len(sheet.fold_angles)
        assert "[default: " in fw.pattern_help(pattern)


def test_parameters_of_patterns_are_arguments():
    """Editors complete the parameters of all patterns, and no others."""
    described = {name for pattern in fw.patterns() for name in re.findall(r"^ *--([a-z-]+)", fw.pattern_help(pattern), re.M)}
    assert {name.replace("-", "_") for name in described} == set(inspect.signature(fw.generate).parameters) - {"pattern"}


def test_arrays_make_the_sheet_that_they_draw():
    sheet = fw.Sheet.from_arrays(*SQUARE, edges=[[0, 2]], letters=["V"], fold_angles=[1.0], title="square")
    assert sheet.title == "square" and sheet.lattice is None
    assert sheet.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    diagonal = int(np.flatnonzero(sheet.kinds == "crease")[0])
    assert sheet.edges[diagonal].tolist() == [0, 2, 0, 0] and sheet.letters[diagonal] == "V"
    assert (sheet.kinds == "boundary").sum() == 4
    # the fold angle differs from the drawn one, 0: it is a target
    folded = fw.relax(fw.Assembly.patch(sheet, bars=fw.RIGID, creases=1.0, rest="target"))
    assert folded.state.fold_angles[diagonal] == pytest.approx(1.0, abs=1e-9)


def test_a_periodic_sheet_of_arrays_is_that_of_the_generator(miura):
    fold = miura.to_fold()
    again = fw.Sheet.from_arrays(fold["vertices_coords"], fold["faces_vertices"], lattice=fold["foldwell:lattice"])
    assert np.array_equal(again.vertices, miura.vertices) and np.array_equal(again.edges, miura.edges)
    assert np.array_equal(again.lattice, miura.lattice)


def test_files_are_read_and_written(tmp_path, miura):
    miura.save(tmp_path / "a.fold")
    again = fw.Sheet.read(tmp_path / "a.fold")
    assert np.array_equal(again.vertices, miura.vertices)
    with open(tmp_path / "a.fold") as file:
        assert np.array_equal(fw.Sheet.read(file).vertices, miura.vertices)
    with pytest.warns(UserWarning, match="STL"):
        miura.save(tmp_path / "a.stl")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        fw.convert(tmp_path / "a.fold", tmp_path / "b.vtu")
    assert (tmp_path / "b.vtu").stat().st_size > 0


def test_info_is_that_of_the_program(miura):
    assert miura.info["vertices"] == len(miura.vertices)


def test_mistakes_are_named(tmp_path):
    with pytest.raises(fw.SheetError, match=r"no-such\.fold"):
        fw.Sheet.read("no-such.fold")
    with pytest.raises(fw.SceneError, match="there is no pattern `miurra`") as caught:
        fw.generate("miurra")
    assert caught.value.help.startswith("did you mean `miura`?")
    with pytest.raises(fw.SceneError, match="`miura` has no parameter `sides`"):
        fw.generate("miura", sides=3)
    with pytest.raises(ValueError, match="closed"):
        file = open(ROOT / "meshes/miura.fold")
        file.close()
        fw.Sheet.read(file)
    with pytest.raises(fw.SheetError, match="<text>"):
        fw.Sheet.read(io.StringIO("{"))
    (tmp_path / "a.txt").write_text("")
    with pytest.raises(fw.SceneError, match=r"\.fold, \.obj"):
        fw.Sheet.read(tmp_path / "a.txt")


@pytest.mark.parametrize(
    ("vertices", "faces", "error", "words"),
    [
        ([[0, 0], [1, 0], [np.nan, 1]], [[0, 1, 2]], ValueError, r"vertices\[2\] is not finite"),
        ([[0, 0], [1, 0], [np.inf, 1]], [[0, 1, 2]], ValueError, r"vertices\[2\] is not finite"),
        ([0.0, 1.0, 2.0], [[0, 1, 2]], ValueError, r"vertices has shape \(3,\), expected"),
        ([[0, 0, 0, 0]], [[0, 0, 0]], ValueError, r"shape \(1, 4\)"),
        ([["a", "b"]], [[0, 0, 0]], TypeError, "expected real numbers"),
        (np.zeros((3, 2), dtype=complex), [[0, 1, 2]], TypeError, "complex128"),
        ([[0, 0], [1, 0], [1, 1]], [[0, 1, 7]], fw.SheetError, "7"),
        ([[0, 0], [1, 0], [1, 1]], [[0, 1, 1]], fw.SheetError, "face"),
        ([[0, 0], [1, 0], [1, 1]], [], fw.SheetError, "face"),
        ([[0, 0], [1, 0], [1, 1]], [[0, 1, -1]], ValueError, r"faces\[0\] names vertex -1"),
        ([[0, 0], [1, 0], [1, 1]], [0, 1, 2], ValueError, r"faces\[0\] is 0, expected a list of vertex numbers"),
        ([[0, 0], [1, 0], [1, 1]], [[0, 1, 1.5]], ValueError, r"faces\[0\] is .*, expected a list of vertex numbers"),
    ],
)
def test_wrong_arrays_are_refused(vertices, faces, error, words):
    with pytest.raises(error, match=words):
        fw.Sheet.from_arrays(vertices, faces)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"edges": [[0, 7]]}, "edge 0 of the list names vertex 7"),
        ({"edges": [[1, 1]]}, "edge 0"),
        ({"edges": [[0, 2], [2, 0]]}, "edge 1"),
        ({"edges": [[1, 3]]}, "side of no face"),
        ({"edges": [[0, 2]], "letters": ["M", "V"]}, r"letters has shape \(2,\), expected \(1,\)"),
        ({"edges": [[0, 2]], "fold_angles": []}, None),
        ({"edges": [[0, 2]], "letters": ["X"]}, "`X` is no letter"),
        ({"edges": [0, 2]}, r"edges has shape \(2,\) and type int64, expected whole numbers of shape \(m, 2\)"),
        ({"edges": [[0, 2], [1]]}, "edges has rows of different lengths"),
        ({"edges": [[0.5, 2.0]]}, "edges has shape .* type float64, expected whole"),
        ({"lattice": [[0, 0], [1, 0]]}, "lattice"),
    ],
)
def test_wrong_edges_of_arrays_are_refused(more, words):
    if words is None:
        fw.Sheet.from_arrays(*SQUARE, **more)
    else:
        with pytest.raises(ValueError, match=words):
            fw.Sheet.from_arrays(*SQUARE, **more)


def test_sheets_of_arrays_are_those_of_files():
    """Letters and angles of files, finite and periodic: the same sheet as the reader's, and letters of the other side turn the faces."""
    for name in ("crane", "open-star", "near-cross", "drum", "degree-four"):
        sheet = fw.Sheet.read(ROOT / f"meshes/{name}.fold")
        fold = sheet.to_fold()
        angles = [np.nan if angle is None else np.radians(angle) for angle in fold["edges_foldAngle"]]
        given = {"edges": fold["edges_vertices"], "letters": fold["edges_assignment"], "fold_angles": angles, "title": sheet.title}
        again = fw.Sheet.from_arrays(fold["vertices_coords"], fold["faces_vertices"], lattice=fold.get("foldwell:lattice"), **given)
        for array in ("vertices", "edges", "letters", "kinds", "fold_angles"):
            assert np.array_equal(getattr(again, array), getattr(sheet, array)), (name, array)
        assert again.to_fold()["edges_foldAngle"] == pytest.approx(fold["edges_foldAngle"], abs=1e-12), name


def test_the_cell_of_a_tube():
    """Screw motions of a file are those of the sheet; a Kresling tube of one vertex relaxes, and does not close elsewhere."""
    sheet = fw.Sheet.read(ROOT / "meshes/kresling-cell.fold")
    assert sheet.lattice is None and "cell of a tube" in repr(sheet)
    np.testing.assert_allclose(sheet.screws, [[np.pi / 3, 0.0], [np.pi / 6, 0.8]], rtol=1e-15)
    assert fw.Sheet.read(io.StringIO(json.dumps(sheet.to_fold()))).screws.tolist() == sheet.screws.tolist()
    relaxed = fw.relax(fw.Assembly.tube(sheet, (6, 0), bars=1e3, creases=1.0, rest="flat"))
    assert relaxed.converged and relaxed.summary["negative_eigenvalues"] == 0
    with pytest.raises(fw.SceneError, match="turns by 300"):
        fw.Assembly.tube(sheet, (5, 0))
    with pytest.raises(fw.SceneError, match="inwards"):
        fw.Assembly.tube(sheet, (6, 0), inwards=True)
    with pytest.raises(fw.SceneError, match="drawn as a tube"):
        fw.Assembly.torus(sheet)


def test_line_ends_that_miss_each_other_are_merged(tmp_path):
    """Claim: `merge` is the distance of merging of a drawing; too small a one is refused with one that reads it, and an open file
    has none."""
    path = tmp_path / "a.cp"
    path.write_text("1 0 0 400 0\n1 400 0 400 400\n1 400 400 0 400\n1 0 400 0 0\n2 0.2 0 399 399.5\n")
    assert fw.Sheet.read(path).vertices.shape == (4, 3)
    assert fw.Sheet.read(path, merge=1.5).vertices.shape == (4, 3)
    with pytest.raises(fw.SheetError, match="merge within 9.00e-1"):
        fw.Sheet.read(path, merge=0.4)
    with path.open() as file, pytest.raises(ValueError, match="merge"):
        fw.Sheet.read(file, merge=0.4)

"""Files of states, read by other programs."""

import json
import struct

import foldwell as fw
import meshio
import numpy as np
import pytest
from conftest import ROOT


@pytest.fixture(scope="module")
def states():
    """States of every kind of boundary condition, folded and stretched."""
    miura, star = fw.generate("miura"), fw.generate("random", seed=3)
    terms = {"bars": 1e3, "creases": 1.0, "facets": 3.0, "rest": 0.5}
    kresling = fw.Sheet.read(ROOT / "meshes/kresling-cell.fold")
    assemblies = {
        "patch": fw.Assembly.patch(miura, (3, 2), **terms),
        "torus": fw.Assembly.torus(miura, (2, 2), **terms),
        "screw": fw.Assembly.screw(star, (3, 3), bars=fw.RIGID, creases=1.0),
        "tube": fw.Assembly.tube(kresling, (6, 0), bars=1e3, creases=1.0, rest="flat"),
    }
    return {name: fw.relax(assembly).state for name, assembly in assemblies.items()}


def same_corners(triangles, state):
    """Whether these are the triangles of a state, each from any of its corners on."""
    def sorted_by_least(corners):
        return sorted(tuple(np.roll(t, -int(np.lexsort(t.T[::-1])[0]), axis=0).ravel()) for t in corners)

    return np.allclose(sorted_by_least(triangles), sorted_by_least(state.positions[state.faces]), rtol=0.0, atol=1e-6)


def test_stl_and_obj_have_the_triangles_of_the_state(states, tmp_path):
    """meshio finds the same triangles, those of OBJ as polygons that the reader of foldwell splits again."""
    for name, state in states.items():
        state.save(tmp_path / "a.stl")
        mesh = meshio.read(tmp_path / "a.stl")
        assert same_corners(mesh.points[mesh.cells_dict["triangle"]], state), name
        state.save(tmp_path / "a.obj")
        mesh = meshio.read(tmp_path / "a.obj")
        assert sum((len(block.data[0]) - 2) * len(block.data) for block in mesh.cells) == len(state.faces), name
        used = np.unique(state.faces)
        assert np.abs(mesh.points - state.positions[used]).max() < 1e-14, name


def test_fold_is_the_sheet_in_this_state(states, tmp_path):
    for name, state in states.items():
        state.save(tmp_path / "a.fold")
        sheet = fw.Sheet.read(tmp_path / "a.fold")
        used = np.unique(state.faces)
        assert np.array_equal(sheet.vertices, state.positions[used]), name
        number = np.full(len(state.positions), -1)
        number[used] = np.arange(len(used))
        angles = {tuple(sorted(number[ends])): angle for ends, angle in zip(state.edges, state.fold_angles, strict=True)}
        for (i, j, _, _), kind, angle in zip(sheet.edges.tolist(), sheet.kinds, sheet.fold_angles, strict=True):
            if kind == "crease":
                assert abs(angles[i, j] - angle) < 1e-9, name


def test_glb_is_binary_gltf(states, tmp_path):
    """The header, the chunks, and every accessor within its view and its bounds; the triangles and the edges of the state."""
    for name, state in states.items():
        state.save(tmp_path / "a.glb")
        data = (tmp_path / "a.glb").read_bytes()
        magic, version, length, text, kind = struct.unpack_from("<4s4I", data)
        assert (magic, version, length, kind) == (b"glTF", 2, len(data), 0x4E4F534A) and text % 4 == 0
        gltf = json.loads(data[20 : 20 + text])
        size, kind = struct.unpack_from("<2I", data, 20 + text)
        binary = data[28 + text :]
        assert kind == 0x004E4942 and len(binary) == size == gltf["buffers"][0]["byteLength"] and size % 4 == 0

        def array(number):
            accessor = gltf["accessors"][number]  # noqa: B023
            view = gltf["bufferViews"][accessor["bufferView"]]  # noqa: B023
            width = {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
            assert view["byteLength"] == 4 * width * accessor["count"] and view["byteOffset"] + view["byteLength"] <= size  # noqa: B023
            kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
            return np.frombuffer(binary, kind, width * accessor["count"], view["byteOffset"]).reshape(-1, width), accessor  # noqa: B023

        primitives = gltf["meshes"][0]["primitives"]
        points, about = array(primitives[0]["attributes"]["POSITION"])
        assert np.array_equal(points, state.positions.astype(np.float32))
        assert np.array_equal(points.min(axis=0), np.float32(about["min"])) and np.array_equal(points.max(axis=0), np.float32(about["max"]))
        drawn = {primitive["material"]: array(primitive["indices"])[0].ravel() for primitive in primitives}
        assert {primitive["mode"] for primitive in primitives[1:]} == {1} and primitives[0].get("mode") == 4
        assert np.array_equal(drawn.pop(0).reshape(-1, 3), state.faces), name
        mountains = state.edges[(state.fold_angles < -1e-6) & (state.kinds != "facet")]
        assert np.array_equal(drawn.get(1, np.empty(0)).reshape(-1, 2), mountains), name
        assert sum(map(len, drawn.values())) == 2 * (state.kinds != "facet").sum(), name


def test_other_endings_are_refused(states, tmp_path):
    for name in ("a.dae", "a", "a.vtk"):
        with pytest.raises(fw.SceneError, match=r"\.vtu, \.stl, \.ply, \.obj, \.fold or \.glb"):
            states["patch"].save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_a_state_with_a_thickness_is_closed(states, tmp_path):
    """PyVista finds no open edge, and a volume of about area times thickness: within 10%, as folds add and take some."""
    pyvista = pytest.importorskip("pyvista")
    state = states["patch"]
    a, b, c = (state.positions[state.faces[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
    for ending in ("stl", "ply"):
        state.save(tmp_path / f"a.{ending}", thickness=0.01)
        solid = pyvista.read(tmp_path / f"a.{ending}").clean()
        assert solid.n_open_edges == 0 and abs(solid.volume / (0.01 * area) - 1.0) < 0.1
    with pytest.raises(fw.SceneError, match="the thickness is 0, expected a number above 0"):
        state.save(tmp_path / "b.stl", thickness=0.0)
    assert not (tmp_path / "b.stl").exists()

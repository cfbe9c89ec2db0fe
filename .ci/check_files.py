#!/usr/bin/env python3
"""Opens what a run wrote with the readers other people use, and compares it with what the run says about itself.

    python .ci/check_files.py OUT... [--render PICTURE.png]        needs: vtk, pyvista, meshio, numpy, h5py

OUT is the folder of a run. Every .vtu is opened by VTK and by meshio, every .vtp and .vti by VTK, every .pvd by PyVista; counts, cell arrays, tables
and summary.json have to agree: every edge and every face of the model is in a .vtu once, and the energies of its lines add up to
the energy in the table (of a screw for each cell that is shown). Indices are signed whole numbers. meshio converts one .vtu of each
run to STL, XDMF and PLY and back. --render draws the last state off-screen with PyVista. The exit status is 1 where a check
fails. A table has the fold angles of one cell: of a patch or a torus the one in the middle, of a screw the only one there is.
Each of them must be among the angles that the lines of this edge have in the last picture; where all of these agree, as on
a screw, it must be that one.
"""
import argparse
import csv
import json
import math
import sys
import tempfile
import tomllib
import xml.etree.ElementTree as xml
from pathlib import Path

import meshio
import numpy as np
import pyvista
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import published

TRIANGLE, LINE = 5, 3
ON_LINES = ["fold_angle", "rest_angle", "strain", "energy", "tension", "torque"]
PLACES = ["vertex", "cell1", "cell2"]
CELL_ARRAYS = ON_LINES + ["self_intersecting", "edge", "assignment"]
SUMMARY = {"version", "scene", "title", "digest", "sheet", "terms", "left_out", "notes", "studies"}
SHEET = {"vertices", "edges", "faces", "polygons", "developable", "cells", "degrees_of_freedom"}
STUDY = {"name", "kind", "converged", "seconds", "error"}
KINDS = {
    "relax": {"energy", "iterations", "factorizations", "residual_force", "residual_length", "negative_eigenvalues",
              "error_to_kinematic", "history"},
    "surface": {"points", "triangles", "coverage", "closed", "oriented", "tips", "max_curvature", "radius", "max_residual",
                "branches"},
    "bloch": {"determinant", "symmetry_error", "imaginary_part", "decay", "pairing_error", "polarization",
              "positive_fraction", "zero_lines"},
    "wells": {"starts", "failed", "saddles", "wells", "barriers", "rigid"},
    "path": {"drive", "driven", "to", "branches"},
    "response": {"linear_modes", "table_rank", "table", "self_stresses", "stresses", "lattice", "poisson",
                 "moduli", "no_moduli"},
    "modes": {"zero_modes", "self_stresses", "rigid_motions", "folding_modes", "maxwell_count", "gap", "eigenvalues"},
}
STATE_COLUMNS = ("branch,sign,step,arc_length,curvature,theta1,theta2,strain11,strain22,strain12,energy_bars,"
                 "energy_creases,energy_facets,energy_total,residual_force,residual_length,self_intersecting").split(",")
PATH_COLUMNS = ("branch,step,arc_length,drive,reaction,work,energy_bars,energy_creases,energy_facets,energy_total,"
                "residual_force,residual_length,negative_eigenvalues,event").split(",")
RATIOS = ["poisson_in_plane", "poisson_bending"]
CYLINDER = ["curvature", "theta1", "theta2", "strain11", "strain22", "strain12"]
EVENTS = {"", "limit-load", "limit-displacement", "branch-point", "self-intersection", "snap", "stop"}


class Checks:
    """Counts what holds and prints what does not."""

    def __init__(self):
        self.passed = self.failed = 0

    def that(self, truth, claim):
        if truth:
            self.passed += 1
        else:
            self.failed += 1
            print(f"FAILED {claim}")
        return bool(truth)


def read_vtk(path):
    """Points, cell types, connectivity, offsets and arrays, as VTK reads them."""
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    if reader.GetErrorCode() or grid.GetPoints() is None:
        return None
    cells = grid.GetCells()
    arrays = lambda data: {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    types = np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())])
    return {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "types": types,
        "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
        "point_arrays": arrays(grid.GetPointData()),
        "cell_arrays": arrays(grid.GetCellData()),
    }


def check_vtu(checks, path):
    """One state: both readers, every array, everything where it belongs."""
    grid = read_vtk(path)
    if not checks.that(grid is not None, f"{path}: VTK opens it"):
        return None
    types, cell_arrays = grid["types"], grid["cell_arrays"]
    faces, lines = types == TRIANGLE, types == LINE
    checks.that(np.all(faces | lines), f"{path}: triangles and lines only")
    checks.that(np.all(np.isfinite(grid["points"])), f"{path}: finite points")
    used = grid["connectivity"]
    checks.that(used.size == 0 or (used.min() >= 0 and used.max() < len(grid["points"])), f"{path}: indices of points")
    displacement = grid["point_arrays"].get("displacement")
    checks.that(displacement is not None and displacement.shape == grid["points"].shape, f"{path}: array displacement")
    for name in PLACES:
        numbers = grid["point_arrays"].get(name)
        checks.that(numbers is not None and len(numbers) == len(grid["points"]) and numbers.dtype.kind == "i",
                    f"{path}: point array {name}")
    for name in CELL_ARRAYS:
        if not checks.that(name in cell_arrays and len(cell_arrays[name]) == len(types), f"{path}: array {name}"):
            return None
    for name in ON_LINES:
        checks.that(np.all(np.isnan(cell_arrays[name][faces])), f"{path}: {name} is NaN on triangles")
    checks.that(np.all(cell_arrays["self_intersecting"][lines] == 0), f"{path}: self_intersecting is 0 on lines")
    checks.that(np.all(np.isin(cell_arrays["self_intersecting"], [0, 1])), f"{path}: self_intersecting is 0 or 1")
    checks.that(np.all(cell_arrays["edge"][faces] == -1), f"{path}: edge is -1 on triangles")
    checks.that(np.all(cell_arrays["edge"][lines] >= 0), f"{path}: every line has an edge")
    checks.that(np.all(cell_arrays["assignment"][faces] == -1), f"{path}: assignment is -1 on triangles")
    checks.that(np.all(np.isin(cell_arrays["assignment"][lines], range(7))), f"{path}: every line has a letter")
    check_meshio(checks, path, grid)
    check_indices(checks, path)
    return grid


def check_vtp(checks, path, table, study):
    """A surface of states: a point for each row of the table, at its strains, with its numbers."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    surface = reader.GetOutput()
    if not checks.that(not reader.GetErrorCode() and surface.GetPoints() is not None, f"{path}: VTK opens it"):
        return
    header, rows = read_table(table)
    number = lambda field: float(field) if field else np.nan
    column = lambda name: np.array([number(row[header.index(name)]) for row in rows])
    points = vtk_to_numpy(surface.GetPoints().GetData())
    strains = np.column_stack([column(name) for name in ["strain11", "strain22", "strain12"]])
    checks.that(np.array_equal(points, strains), f"{path}: the points are the strains of the table")
    triangles = surface.GetNumberOfPolys()
    checks.that(triangles == surface.GetNumberOfCells() == study["triangles"], f"{path}: {triangles} triangles")
    checks.that(len(points) == study["points"], f"{path}: {len(points)} points")
    used = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
    checks.that(len(used) == 3 * triangles and used.min() >= 0 and used.max() < len(points), f"{path}: its indices")
    data = surface.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    expected = {name: name for name in header if name.startswith("fold_")} | {"curvature": "curvature"}
    optional = {"energy": "energy_total", "self_intersecting": "self_intersecting"}
    expected |= {name: source for name, source in optional.items() if np.any(np.isfinite(column(source)))}
    checks.that(set(arrays) == set(expected) | {"theta"}, f"{path}: arrays {sorted(arrays)}")
    for name, source in expected.items():
        same = name in arrays and np.array_equal(arrays[name], column(source), equal_nan=True)
        checks.that(same, f"{path}: {name} is {source} of the table")
    theta = np.column_stack([column("theta1"), column("theta2")])
    checks.that(np.array_equal(arrays.get("theta"), theta), f"{path}: theta is that of the table")


def check_sphere(checks, path, table, study):
    """Energies over the sphere of curvature tensors: a point for each row of the table, then the cone where they vanish."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    sphere = reader.GetOutput()
    if not checks.that(not reader.GetErrorCode() and sphere.GetPoints() is not None, f"{path}: VTK opens it"):
        return
    header, rows = read_table(table)
    column = lambda name: np.array([float(row[header.index(name)]) for row in rows])
    points, data = vtk_to_numpy(sphere.GetPoints().GetData()), sphere.GetPointData()
    array = lambda name: vtk_to_numpy(data.GetArray(name))
    tensors = np.column_stack([column("k11"), column("k22"), np.sqrt(2) * column("k12")])
    checks.that(len(rows) == study["map"]["samples"], f"{path}: {len(rows)} samples")
    checks.that(np.allclose(points[: len(rows)], tensors, rtol=0, atol=1e-15), f"{path}: points are the tensors of the table")
    checks.that(np.allclose(np.linalg.norm(points, axis=1), 1, rtol=0, atol=1e-12), f"{path}: points of the unit sphere")
    checks.that(np.array_equal(array("energy")[: len(rows)], column("energy_total")), f"{path}: energies of the table")
    checks.that(np.all(array("energy")[len(rows) :] == 0), f"{path}: no energy on the cone")
    checks.that(len(points) - len(rows) == study["map"]["cone_points"], f"{path}: points of the cone")
    euler = len(rows) - sphere.GetNumberOfPolys() // 2
    checks.that(euler == 2 and sphere.GetNumberOfLines() == 2, f"{path}: a closed surface and two curves")


def determinant(study, q1, q2):
    """The centred determinant from the coefficients of the summary."""
    return sum(c * np.exp(1j * (m * q1 + n * q2)) for m, n, c in study["determinant"])


def check_map(checks, path, study):
    """The determinant over the zone: the sum of the coefficients in the summary."""
    reader = vtk.vtkXMLImageDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    image = reader.GetOutput()
    if not checks.that(not reader.GetErrorCode() and image.GetNumberOfPoints() > 0, f"{path}: VTK opens it"):
        return
    n1, n2, _ = image.GetDimensions()
    q = lambda n: (np.arange(n) + 0.5) * 2 * np.pi / n - np.pi
    expected = determinant(study, q(n1)[None, :], q(n2)[:, None]).ravel()
    largest = np.abs(expected).max()
    for name, part in [("determinant", expected.real), ("imaginary_part", expected.imag)]:
        found = vtk_to_numpy(image.GetPointData().GetArray(name))
        checks.that(np.abs(found - part).max() <= 1e-12 * largest, f"{path}: {name} is that of the coefficients")
    corner = [image.GetOrigin()[0] - q(n1)[0], image.GetOrigin()[1] - q(n2)[0]]
    checks.that(np.abs(corner).max() <= 1e-6, f"{path}: the corner of the zone")


def check_curves(checks, path, study):
    """Zero lines: as many as the summary says, and the determinant vanishes on them."""
    reader = vtk.vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    curves = reader.GetOutput()
    if not checks.that(not reader.GetErrorCode(), f"{path}: VTK opens it"):
        return
    checks.that(curves.GetNumberOfLines() == study["zero_lines"], f"{path}: {study['zero_lines']} lines")
    if curves.GetNumberOfPoints():
        points = vtk_to_numpy(curves.GetPoints().GetData())
        largest = max(abs(c) for _, _, c in study["determinant"])
        values = np.abs(determinant(study, points[:, 0], points[:, 1]))
        checks.that(values.max() <= 1e-10 * largest, f"{path}: the determinant is {values.max():.1e} on its zero lines")


def check_meshio(checks, path, grid):
    """The second reader sees the same."""
    mesh = meshio.read(path)
    checks.that(np.array_equal(mesh.points, grid["points"]), f"{path}: meshio has VTK's points")
    kinds = {block.data.dtype.kind for block in mesh.cells}
    checks.that(kinds <= {"i"}, f"{path}: meshio has whole numbers as indices, not {kinds}")
    counts = {kind: sum(len(block.data) for block in mesh.cells if block.type == kind) for kind in ["triangle", "line"]}
    expected = {"triangle": int(np.sum(grid["types"] == TRIANGLE)), "line": int(np.sum(grid["types"] == LINE))}
    checks.that(counts == expected, f"{path}: meshio has {counts}, VTK {expected}")
    for name in CELL_ARRAYS:
        blocks = mesh.cell_data.get(name)
        same = blocks is not None and np.array_equal(np.concatenate(blocks), grid["cell_arrays"][name], equal_nan=True)
        checks.that(same, f"{path}: meshio has VTK's {name}")


def check_indices(checks, path):
    """Every list of indices in the file is of VTK's own type."""
    text = path.read_bytes().decode("latin-1")
    tags = [tag.split(">")[0] for tag in text.split("<DataArray ")[1:]]
    types = {tag.split('type="')[1].split('"')[0] for tag in tags if 'Name="connectivity"' in tag or 'Name="offsets"' in tag}
    checks.that(types <= {"Int64"}, f"{path}: indices are Int64, not {sorted(types)}")


def check_conversions(checks, path):
    """meshio writes the faces as STL and PLY, everything as XDMF, and reads them back: the same points, the same cells."""
    mesh = meshio.read(path)
    faces = mesh.cells_dict.get("triangle", np.empty((0, 3), int))
    if not checks.that(len(faces) > 0, f"{path}: has faces"):
        return
    only_faces = meshio.Mesh(mesh.points, [("triangle", faces)])
    with tempfile.TemporaryDirectory() as folder:
        for ending, written in [("stl", only_faces), ("ply", only_faces), ("xdmf", mesh)]:
            file = Path(folder) / f"mesh.{ending}"
            try:
                meshio.write(file, written)
                back = meshio.read(file)
            except Exception as fault:  # whatever a reader says: the file is not what it can use
                checks.that(False, f"{path}: meshio writes and reads .{ending}: {fault!r}")
                continue
            corners = back.points[back.cells_dict["triangle"]]
            size = np.abs(mesh.points).max()
            same = corners.shape == (len(faces), 3, 3) and np.abs(corners - mesh.points[faces]).max() <= 1e-6 * size
            checks.that(same, f"{path}: the faces come back from .{ending}")
            if ending == "xdmf":
                lines = np.array_equal(back.cells_dict.get("line"), mesh.cells_dict.get("line"))
                checks.that(lines and np.array_equal(back.points, mesh.points), f"{path}: everything comes back from .xdmf")


def check_elements(checks, path, grid, summary):
    """Every edge and every face of the model once: those of a torus, a screw or a tube are complete, a patch loses some at its rim."""
    counts = np.bincount(grid["cell_arrays"]["edge"][grid["types"] == LINE], minlength=summary["sheet"]["edges"])
    faces = int(np.sum(grid["types"] == TRIANGLE))
    pairs = grid["connectivity"][3 * faces:].reshape(-1, 2).tolist()
    numbers = grid["cell_arrays"]["edge"][grid["types"] == LINE].tolist()
    # an edge of more than two faces is there for each of its hinges
    unique = {(*sorted(pair), number) for pair, number in zip(pairs, numbers)}
    checks.that(len(unique) == counts.sum(), f"{path}: no line is there twice")
    n1, n2 = summary["shown"]
    if summary["domain"] == "patch":
        checks.that(counts.max() <= n1 * n2 and faces <= n1 * n2 * summary["sheet"]["faces"], f"{path}: no more than there is")
    else:
        checks.that(np.all(counts == n1 * n2), f"{path}: every edge of the {n1} x {n2} cells once, not {sorted(set(counts))} times")
        checks.that(faces == n1 * n2 * summary["sheet"]["faces"], f"{path}: every face of the {n1} x {n2} cells, not {faces}")


def check_energy(checks, path, grid, energy, summary):
    """The energies of the lines add up to that of the model; a screw or a tube is one cell, shown several times."""
    copies = np.prod(summary["shown"]) if summary["domain"] in ("screw", "tube") else 1
    found = np.nansum(grid["cell_arrays"]["energy"])
    checks.that(abs(found - copies * energy) <= 1e-9 * abs(found) + 1e-25, f"{path}: energies add up to {found}, not {copies} x {energy}")


def read_table(path):
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]


def own_energies(header):
    """The columns of terms other than bars, creases and facets, whose energies are on no line of the pictures."""
    known = ("energy_bars", "energy_creases", "energy_facets", "energy_total")
    return [name for name in header if name.startswith("energy_") and name not in known]


def check_table(checks, path, kind, edges):
    """Header, widths, and numbers that are numbers; gives the fold angles of the last row."""
    if not checks.that(path.exists(), f"{path} is there"):
        return None
    header, rows = read_table(path)
    checks.that(rows or kind == "modes", f"{path}: has rows")
    checks.that(all(len(row) == len(header) for row in rows), f"{path}: rows as wide as the header")
    for row in rows:
        for column, field in zip(header, row):
            if column == "event":
                checks.that(field in EVENTS, f"{path}: `{field}` is an event")
                continue
            try:
                float(field or 0)
            except ValueError:
                checks.that(False, f"{path}: `{field}` in column {column} is a number")
    header = [name for name in header if name not in own_energies(header)]
    if kind == "path":
        between = header[len(PATH_COLUMNS):-edges]
        checks.that(header[: len(PATH_COLUMNS)] == PATH_COLUMNS, f"{path}: the first columns")
        probes = [name for name in between if name.startswith("probe_")] + [name for name in between if name.startswith("volume_")]
        checks.that(between[len(between) - 1 - len(probes) : -1] == probes, f"{path}: probes and volumes stand before `state`, {between}")
        own = [name for name in between if name not in CYLINDER + RATIOS + probes + ["dissipated"]]
        checks.that(own in (["state"], ["self_intersecting", "state"]), f"{path}: the columns between, {between}")
        checks.that(not set(between) & set(CYLINDER) or set(CYLINDER) <= set(between), f"{path}: a whole cylinder")
        return None
    if kind not in ("relax", "trace", "surface", "wells"):
        return None
    checks.that(header[: len(STATE_COLUMNS)] == STATE_COLUMNS, f"{path}: the first columns")
    fold = header[-edges:]
    between = header[len(STATE_COLUMNS):-edges]
    checks.that(all(name.startswith("fold_") for name in fold), f"{path}: a column for every edge")
    known = (["state"], ["error_to_kinematic", "state"], ["seam_turn", "seam_rise", "state"], ["error_to_kinematic", "seam_turn", "seam_rise", "state"])
    checks.that([name for name in between if name not in RATIOS] in known, f"{path}: the columns between, {between}")
    return [float(field) if field else np.nan for field in rows[-1][-edges:]] if rows else None


def check_angles(checks, where, grid, table):
    """Every angle in the table is the angle of a copy of its edge in the picture."""
    edge, angle = grid["cell_arrays"]["edge"], grid["cell_arrays"]["fold_angle"]
    checks.that(np.all(edge < len(table)), f"{where}: every edge is in the table")
    for number, folded in enumerate(table):
        copies = angle[(edge == number) & np.isfinite(angle)]
        # the copy in the cell of the table may be outside the picture (an edge to the next cell): then one cannot tell
        if len(copies) and np.isfinite(folded):
            nearest = copies[np.argmin(np.abs(copies - folded))]
            same = abs(nearest - folded) <= 1e-9
            checks.that(same, f"{where}: edge {number} folds by {nearest} in the picture, {folded} in the table")


def listed(path):
    """The files of a collection."""
    return [path.parent / entry.get("file") for entry in xml.parse(path).getroot().iter("DataSet")]


def motions(checks, out, name):
    """The pictures of motions, of which each kind has a collection of its own."""
    found = set()
    for collected, beginning in (("vibrations", "vibration"), ("buckling", "buckling")):
        collection = out / f"{name}-{collected}.pvd"
        moving = set((out / name).glob(f"{name}_{beginning}_*.vtu"))
        if moving or collection.exists():
            checks.that(set(listed(collection)) == moving, f"{collection}: lists every motion of {name}/")
        found |= moving
    return found


def check_collection(checks, out, name):
    """The collection lists the states there are but for motions; gives the last state, of a sheet only."""
    path, moving = out / f"{name}.pvd", motions(checks, out, name)
    there = {file for ending in ["vtu", "vtp", "vti"] for file in (out / name).glob(f"*.{ending}")}
    files = listed(path)
    checks.that(files and all(file.exists() for file in files), f"{path}: its files are there")
    checks.that(sorted(files) == sorted(there - moving), f"{path}: lists every state of {name}/")
    reader = pyvista.get_reader(str(path))
    times = list(reader.time_values)
    checks.that(len(times) == len(files) and times == sorted(times), f"{path}: PyVista finds {len(times)} times")
    reader.set_active_time_value(times[-1])
    last = reader.read()
    if files[-1].suffix != ".vtu":
        checks.that(sum(block.n_points for block in last) > 0, f"{path}: PyVista's surface, curves or map")
        return None
    checks.that(sum(block.n_cells for block in last) == len(read_vtk(files[-1])["types"]), f"{path}: PyVista's last state")
    return files[-1]


def check_study(checks, out, study, summary):
    """All files of one study; gives the last picture."""
    name, kind, edges = study["name"], study["kind"], summary["sheet"]["edges"]
    missing = (STUDY | KINDS.get(kind, set())) - set(study)
    checks.that(not missing or not study["converged"], f"summary of {name}: keys {sorted(missing)}")
    checks.that(study["converged"] or "reason" in study, f"summary of {name}: a failure has a reason")
    table = check_table(checks, out / f"{name}.csv", kind, edges) if study["converged"] else None
    if kind == "wells" and study["converged"]:
        check_wells(checks, out, study)
    if kind == "path" and study["converged"]:
        check_path(checks, out, study)
    grids = {path: check_vtu(checks, path) for path in sorted((out / name).glob("*.vtu"))}
    energies = energies_of(out, study) if study["converged"] else []
    for k, (path, grid) in enumerate((path, grid) for path, grid in grids.items() if grid is not None):
        check_elements(checks, path, grid, summary)
        if k < len(energies):
            check_energy(checks, path, grid, energies[k], summary)
    if kind in ("relax", "wells"):
        checks.that(not grids or not study["converged"] or len(energies) == len(grids), f"{name}: an energy for every picture")
    for path in sorted((out / name).glob("*.vtp")):
        check_indices(checks, path)
        if kind == "bloch":
            check_curves(checks, path, study)
        elif kind == "landscape":
            check_sphere(checks, path, out / f"{name}-map.csv", study)
        else:
            check_vtp(checks, path, out / f"{name}.csv", study)
    for path in sorted((out / name).glob("*.vti")):
        check_map(checks, path, study)
    if (out / f"{name}.svg").exists():
        root = xml.parse(out / f"{name}.svg").getroot()
        checks.that(root.tag.endswith("svg") and len(root) > 3, f"{name}.svg: a picture")
    if not (out / f"{name}.pvd").exists():
        checks.that(set(grids) == motions(checks, out, name), f"{name}.pvd collects the states of {name}/")
        return None
    last = check_collection(checks, out, name)
    if table is not None and grids.get(last) is not None:
        check_angles(checks, last, grids[last], table)
    return last


def energies_of(out, study):
    """Energies of the states in the pictures of a study, in their order; of a trace, where its table has them."""
    if study["kind"] not in ("relax", "trace", "wells", "path"):
        return []
    header, rows = read_table(out / f"{study['name']}.csv")
    own = [header.index(name) for name in own_energies(header)]
    energies = [float(row[header.index("energy_total")] or "nan") - sum(float(row[k]) for k in own) for row in rows]
    if study["kind"] in ("path", "trace"):
        found = [energies[row] for row in pictured_rows(out, study)]
        return found if np.all(np.isfinite(found)) else []
    if study["kind"] == "relax":
        last = study["energy"]["total"]
        return energies[:-1] + [last]
    pictures = len(list((out / study["name"]).glob("*.vtu")))
    return energies if len(energies) == pictures and np.all(np.isfinite(energies)) else []


def pictured_rows(out, study):
    """The rows of the table of which there are pictures: a picture has the number of its row."""
    return sorted(int(file.stem.rpartition("_")[2]) for file in (out / study["name"]).glob("*.vtu"))


def check_path(checks, out, study):
    """A row for every state of every branch, pictures of its events and ends, and events as in the summary."""
    header, rows = read_table(out / f"{study['name']}.csv")
    where, event = f"{study['name']}.csv", header.index("event")
    checks.that(len(rows) == sum(branch["steps"] for branch in study["branches"]), f"{where}: a row for every state")
    pictured, first = set(pictured_rows(out, study)), 0
    for branch in study["branches"]:
        own = rows[first : first + branch["steps"]]
        checks.that([row[event] for row in own if row[event]] == [found["event"] for found in branch["events"]], f"{where}: events")
        wanted = {first, first + len(own) - 1} | {first + k for k, row in enumerate(own) if row[event]}
        checks.that(not pictured or wanted <= pictured, f"{where}: pictures of events and ends")
        first += len(own)


def check_wells(checks, out, study):
    """A row for every well, by rising energy, then one for every pass that was found; a pass lies above the wells that it joins."""
    header, rows = read_table(out / f"{study['name']}.csv")
    energy = [float(row[header.index("energy_total")]) for row in rows]
    wells = [well["energy"] for well in study["wells"]]
    found = [barrier for barrier in study["barriers"] if barrier["confirmed"]]
    where = f"{study['name']}.csv"
    checks.that(len(rows) == len(wells) + len(found), f"{where}: {len(wells)} wells and {len(found)} passes")
    checks.that(wells == sorted(wells) and np.allclose(wells, energy[: len(wells)], rtol=1e-9), f"{where}: wells by energy")
    for barrier in found:
        heights = [barrier["energy"] - wells[well] for well in barrier["joins"]]
        checks.that(np.allclose(heights, barrier["height"], rtol=0, atol=1e-9), f"{where}: height of {barrier['between']}")
        checks.that(min(heights) > 0, f"{where}: the pass of {barrier['between']} lies above its wells")
    _, passes = read_table(out / f"{study['name']}-barriers.csv")
    checks.that(len(passes) == sum(len(barrier["heights"]) for barrier in found), f"{where}: heights of all passes")


def render(path, picture):
    pyvista.OFF_SCREEN = True
    grid = pyvista.read(path)
    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(grid.extract_cells(grid.celltypes == TRIANGLE), color="ivory")
    lines = grid.extract_cells(grid.celltypes == LINE)
    sharpest = np.nanmax(np.abs(lines["fold_angle"]), initial=1e-9)
    plotter.add_mesh(lines, scalars="fold_angle", cmap="coolwarm_r", clim=[-sharpest, sharpest], line_width=4)
    plotter.screenshot(picture)


def shown_cells(scene, summary):
    """The cells of pictures: those of the model, or, where it is one cell, as many as the scene says or its domain shows."""
    if summary["domain"] not in ("screw", "tube"):
        return summary["sheet"]["cells"]
    if summary["domain"] == "screw":
        return scene.get("cells", [6, 6])
    strands, around = math.gcd(*scene["seam"]), sum(map(abs, scene["seam"]))
    return scene.get("cells", [strands, -(-6 * around // strands)])


def check_run(checks, out):
    """All files of one run; gives its last picture."""
    summary = json.loads((out / "summary.json").read_text())
    checks.that(SUMMARY <= set(summary), f"{out}/summary.json: its keys")
    checks.that(SHEET <= set(summary["sheet"]), f"{out}/summary.json: keys of the sheet")
    checks.that(not list(out.rglob("*.part")), f"{out}: no half-written files")
    scene = tomllib.loads(Path(summary["scene"]).read_text())["sheet"]
    summary["domain"] = scene.get("domain", "patch")
    summary["shown"] = shown_cells(scene, summary)
    lasts = [check_study(checks, out, study, summary) for study in summary["studies"]]
    vtu = next(iter(sorted(out.rglob("*.vtu"))), None)
    if vtu:
        check_conversions(checks, vtu)
    return next((last for last in reversed(lasts) if last), None)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=Path, nargs="+")
    parser.add_argument("--render", metavar="PICTURE")
    arguments = parser.parse_args()
    checks = Checks()
    lasts = [check_run(checks, Path(run)) for out in arguments.out for run in published.runs_in(out)]
    if arguments.render and checks.that(lasts[-1], "there is a state to render"):
        render(lasts[-1], arguments.render)
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed or not checks.passed else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Looks for the lowest minima of scenes on the grid of `tests/differential/grid.rs`, by a minimizer that shares no solver with ours.

    python validation/independent.py SCENE ...            prints a table of all points of these scenes
    python validation/independent.py --explain [SCENE ...]  fills in the reasons in tests/cases/grid.csv

Points are parts of the way from the drawn state to the rest values, and stiffnesses EA of the bars. `inf` stands for a penalty of 1e7,
whose energy is that of rigid bars less about one over it. A row of the table has the lowest minimum that was found:

    energy       of the state
    gradient     its largest entry over the largest force that a bar or a hinge puts on a vertex
    lowest       lowest eigenvalue of the Hessian that is no rigid motion's, over the largest; negative at a saddle
    quality      smallest height of a triangle over its longest side
    triangle     the vertices of that triangle
    verdict      `equilibrium`; `collapse` where every start ends at a triangle without height, or `none`

What is used of the program is its energy with gradient and Hessian, which `python/tests/test_energy.py` compares with formulas
written anew. The minimizer is Newton's method with a dense Cholesky factorization of the shifted Hessian. A step changes no fold angle
by more than 0.3 rad to first order and keeps 0.4 of the height of every triangle, because the gradient of a fold angle grows as one over
that height; it is halved until the energy falls. A saddle is left along its negative mode, both ways. Every point starts from the drawn
state, and then, pass after pass, from the lowest minima that were found at the next part and the next stiffness on either side, until
none is lowered. Scenes with locks, loads or rigid facets are not asked.
"""

import csv
import itertools
import sys
import tempfile
import tomllib
from pathlib import Path

import numpy as np
from scipy.linalg import LinAlgError, cho_factor, cho_solve, eigh

import foldwell

ROOT = Path(__file__).resolve().parent.parent
MESHES, TABLE = ROOT / "meshes", ROOT / "tests/cases/grid.csv"
PARTS = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
BARS = [30.0, 1e2, 3e2, 1e3, 1e4, 1e6, np.inf]
PASSES = 3
PENALTY = 1e7
STEPS = 1500
TAU = 2.0 * np.pi
# A triangle that is lower than this part of its longest side has no fold angles beside it.
COLLAPSED = 1e-5
# Largest force over that of an element at which a state counts as an equilibrium; and the smallest eigenvalue that rounding leaves of 0.
BALANCED = 1e-8
ZERO = 1e-9


class Problem:
    """A scene with other stiffnesses of its bars and its rest values at a part of the way from the drawn state."""

    def __init__(self, scene, part, bars):
        self.path, self.part = MESHES / f"{scene}.toml", part
        text = self.path.read_text()
        if "[[lock]]" in text or "[[load]]" in text:
            raise NotAsked(scene)
        self.keys = {"energy.bars.stiffness": PENALTY if np.isinf(bars) else bars}
        if "fraction = " in text:
            self.keys["energy.creases.fraction"] = 1.0
        whole = self.assembly(self.keys)
        if len(whole.constraints(whole.start)) > 0:
            raise NotAsked(scene)
        self.shown = shown_edges(whole)
        rest = np.nan_to_num(whole.drawn.rest_angles[self.shown])
        drawn = np.nan_to_num(whole.sheet.fold_angles[whole.drawn.cell_edges[self.shown]])
        self.whole, self.rest = whole, drawn + part * (rest - drawn)
        self.keys.pop("energy.creases.fraction", None)
        self.known = {}

    def assembly(self, keys):
        scene = tomllib.loads(self.path.read_text())
        if "energy.creases.rest" in keys:
            scene["energy"]["creases"].pop("fraction", None)
        return foldwell.Assembly.from_scene(scene, set=keys, base=MESHES)

    def turned(self, turns):
        """The assembly whose energy continues where fold angles have gone through pi so often: the rest angles are turned back.
        None where an angle would be more than a turn from rest, which scenes refuse."""
        if np.abs(self.rest - TAU * turns).max() > TAU:
            return None
        key = turns.tobytes()
        if key not in self.known:
            with tempfile.TemporaryDirectory() as folder:
                keys = dict(self.keys)
                for kind in ("crease", "facet"):
                    here = np.flatnonzero(self.whole.kinds == kind)
                    if f"{kind}s" not in tomllib.loads(self.path.read_text())["energy"] or len(here) == 0:
                        continue
                    rows = [",".join(map(str, [*self.whole.edges[k], repr(float(self.rest[k] - TAU * turns[k]))])) for k in here]
                    (Path(folder) / f"{kind}.csv").write_text("\n".join(["cell1,cell2,i,j,n1,n2,angle", *rows]) + "\n")
                    keys[f"energy.{kind}s.rest"] = {"file": str(Path(folder) / f"{kind}.csv")}
                self.known[key] = self.assembly(keys)
        return self.known[key]


def shown_edges(assembly):
    """The edge of a state that shows each edge of the model: of one cell with screw motions a state shows many copies, some at a rim."""
    state, count = assembly.drawn, len(assembly.edges)
    if len(state.cell_edges) == count:
        return np.arange(count)
    folds = np.isfinite(state.fold_angles)
    copies = [np.flatnonzero(state.cell_edges == edge) for edge in range(count)]
    return np.array([those[np.argmax(folds[those])] for those in copies])


class NotAsked(Exception):
    """The scene has locks, loads or rigid facets."""


class Triangles:
    """The triangles of an assembly as triples of its edges, so that heights follow from lengths in every domain."""

    def __init__(self, assembly):
        self.cells = np.array(assembly.cells)
        self.periodic = assembly.sheet.lattice is not None or assembly.sheet.screws is not None
        number = {}
        for k, (c1, c2, i, j, n1, n2) in enumerate(assembly.edges.tolist()):
            number[self.key((i, (c1, c2)), (j, (c1 + n1, c2 + n2)))] = k
        self.edges, self.names = [], []
        for c1, c2 in np.ndindex(*self.cells):
            for polygon in assembly.sheet.polygons:
                self.split([(v, (c1 + n1, c2 + n2)) for v, n1, n2 in polygon], number)
        self.edges = np.array(self.edges, dtype=int).reshape(-1, 3)

    def key(self, a, b):
        """The name of the edge between two vertices, each a number and a cell: ends in a fixed order, cells counted on the torus."""
        apart = tuple(np.subtract(b[1], a[1]).tolist())
        if (b[0], apart) < (a[0], (0, 0)):
            a, b, apart = b, a, tuple(-n for n in apart)
        cell = np.array(a[1]) % self.cells if self.periodic else a[1]
        return a[0], b[0], apart, tuple(int(c) for c in cell)

    def split(self, corners, number):
        """Adds the triangles of a polygon: three corners between which there are edges."""
        for three in itertools.combinations(corners, 3):
            sides = [self.key(a, b) for a, b in itertools.combinations(three, 2)]
            if all(side in number for side in sides):
                self.edges.append([number[side] for side in sides])
                self.names.append([vertex for vertex, _ in three])

    def heights(self, lengths):
        """Height over the longest side, from the area by Heron's formula in the form that is exact for thin triangles."""
        a, b, c = np.sort(lengths[self.edges], axis=1).T[::-1]
        square = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c))
        return np.sqrt(np.maximum(square, 0.0)) / 2.0 / a**2


class Minimizer:
    """A state `x` is known together with the turns of its fold angles beyond those that the energy continues by itself."""

    def __init__(self, problem):
        self.problem, self.whole = problem, problem.whole
        self.triangles = Triangles(problem.whole)
        self.none = np.zeros(len(problem.rest), dtype=int)

    def heights(self, x):
        return self.triangles.heights(self.whole.lengths(x))

    def after(self, x, turns, other):
        """The turns at another state next to `x`."""
        jumps = (self.whole.fold_angles(other) - self.whole.fold_angles(x)) / TAU
        return turns - np.nan_to_num(np.round(jumps)).astype(int)

    def energy(self, at):
        assembly = self.problem.turned(at[1])
        return np.inf if assembly is None else assembly.energy(at[0])

    def gradient(self, at):
        return self.problem.turned(at[1]).gradient(at[0])

    def hessian(self, at):
        return self.problem.turned(at[1]).hessian(at[0]).toarray()

    def bounded(self, x, step):
        """The step, shortened until it changes no fold angle by more than 0.3 rad and keeps 0.4 of every height."""
        turned = np.nanmax(np.abs(self.whole.fold_angles_jacobian(x) @ step), initial=0.0)
        step = step * min(1.0, 0.3 / max(turned, 1e-300))
        before = self.heights(x)
        while np.any(self.heights(x + step) < 0.4 * before) and np.abs(step).max() > 1e-14:
            step = 0.5 * step
        return step

    def minimize(self, at):
        """A state from which the energy falls no more."""
        shift = 1e-3
        for _ in range(STEPS):
            energy, gradient, hessian = self.energy(at), self.gradient(at), self.hessian(at)
            found, scale = None, np.abs(np.diag(hessian)).max()
            while found is None and shift < 1e3:
                step = newton_step(hessian, gradient, shift * scale)
                found = None if step is None else self.lower(at, step, energy, gradient)
                shift = 4.0 * shift if found is None else max(shift / 8.0, 1e-12)
            if found is None:
                return at
            at = found
            # the step promised nothing: it only moved the sheet about, along motions that cost no energy
            if -gradient @ step < 1e-17 * max(energy, 1e-3) or self.heights(at[0]).min() < COLLAPSED / 10.0:
                return at
        return at

    def lower(self, at, step, energy, gradient):
        """The state after the step, or a part of it, if the energy is lower there."""
        x, turns = at
        step = self.bounded(x, step)
        for _ in range(6):
            new = (x + step, self.after(x, turns, x + step))
            there = self.energy(new)
            if there < energy:
                return new
            # next to a minimum rounding hides what a step gains; then the gradient has to fall
            if there <= energy + 1e-14 * abs(energy) and np.abs(self.gradient(new)).max() < 0.9 * np.abs(gradient).max():
                return new
            step = 0.5 * step
        return None

    def spectrum(self, at):
        """Eigenvalues over the largest and modes, without those of rigid motions."""
        values, modes = eigh(self.hessian(at))
        values = values / np.abs(values).max()
        kept = np.abs(values) > ZERO
        return values[kept], modes[:, kept]

    def settle(self, at, leaves=3):
        """A minimum: saddles are left along their lowest mode, both ways, and the lower end is kept."""
        at = self.minimize(at)
        if leaves == 0 or self.heights(at[0]).min() < COLLAPSED:
            return at
        values, modes = self.spectrum(at)
        if values[0] > 0.0:
            return at
        mode = modes[:, 0] * 0.05 / np.abs(self.whole.fold_angles_jacobian(at[0]) @ modes[:, 0]).max()
        sides = [(x, self.after(at[0], at[1], x)) for x in (at[0] + mode, at[0] - mode)]
        ends = [self.settle(side, leaves - 1) for side in sides if np.isfinite(self.energy(side))]
        return min([*ends, at], key=self.energy)

    def force(self, at):
        """Largest entry of the gradient over the largest force that a bar or a hinge puts on a vertex."""
        state, shown = self.problem.turned(at[1]).state(at[0]), self.problem.shown
        bars = self.whole.lengths_jacobian(at[0]), state.tensions[shown]
        hinges = self.whole.fold_angles_jacobian(at[0]), state.torques[shown]
        largest = [np.abs(rows.multiply(np.nan_to_num(forces)[:, None])).max() for rows, forces in (bars, hinges)]
        # where all is relieved there is no force to compare with: rest angles are of order 1
        return np.abs(self.gradient(at)).max() / max(*largest, 1e-3)

    def judge(self, at):
        heights = self.heights(at[0])
        low = int(np.argmin(heights))
        thin = heights[low] < COLLAPSED
        lowest = np.nan if thin else self.spectrum(at)[0][0]
        force = self.force(at)
        good = not thin and lowest > 0.0 and force < BALANCED
        return {
            "energy": self.energy(at),
            "gradient": force,
            "lowest": lowest,
            "quality": heights[low],
            "triangle": " ".join(str(v) for v in self.triangles.names[low]),
            "verdict": "equilibrium" if good else "collapse" if thin else "none",
        }


def newton_step(hessian, gradient, shift):
    try:
        return -cho_solve(cho_factor(hessian + shift * np.eye(len(gradient))), gradient)
    except LinAlgError:
        return None


def is_better(one, other):
    """Whether an answer is an equilibrium of lower energy than another one, or the first."""
    if other is None or one["verdict"] != "equilibrium":
        return other is None
    return other["verdict"] != "equilibrium" or one["energy"] < other["energy"] - 1e-9 * abs(other["energy"])


class Grid:
    """The points of a scene with the lowest minimum of each, an answer and the state `(x, turns)`."""

    def __init__(self, scene):
        places = itertools.product(range(len(BARS)), range(len(PARTS)))
        self.minimizers = {(k, p): Minimizer(Problem(scene, PARTS[p], BARS[k])) for k, p in places}
        self.known, self.tried = {}, {}
        for place, minimizer in self.minimizers.items():
            self.start(place, (minimizer.whole.start, minimizer.none))
        # a pass goes both ways along parts and along stiffnesses; a minimum that it finds goes on from point to point
        for _ in range(PASSES):
            lowered = [self.walk(axis, step) for axis in (1, 0) for step in (1, -1)]
            if not any(lowered):
                break

    def start(self, place, at):
        """Looks for a minimum at a point from a state; true if it is lower than those before."""
        minimizer = self.minimizers[place]
        if np.isinf(minimizer.energy(at)):
            return False
        found = minimizer.settle(at)
        answer = minimizer.judge(found)
        better = is_better(answer, self.known.get(place, (None,))[0])
        if better:
            self.known[place] = (answer, found)
        return better

    def walk(self, axis, step):
        """Starts every point from the minimum of its neighbour; true if any point was lowered."""
        lowered = False
        for place in sorted(self.minimizers, key=lambda place: step * place[axis]):
            before = (place[0] - step, place[1]) if axis == 0 else (place[0], place[1] - step)
            answer, at = self.known.get(before, (None, None))
            # the neighbour's minimum has been here before
            key = (place, before)
            if at is None or answer["verdict"] != "equilibrium" or self.tried.get(key) is at:
                continue
            self.tried[key] = at
            lowered |= self.start(place, at)
        return lowered

    def rows(self):
        return [((BARS[k], PARTS[p]), self.known[k, p][0]) for k, p in sorted(self.known)]


def written(value):
    """A number as Rust writes it in the table."""
    return "inf" if np.isinf(value) else f"{value:.10g}"


def explain(scenes):
    """Fills in the column `independent` of the table of exceptions, and whether a failure is a collapse: that of a triangle which the
    program names, at a point where there is no equilibrium here either."""
    with open(TABLE, newline="") as file:
        rows = list(csv.DictReader(file))
    for scene in scenes or sorted({row["scene"] for row in rows}):
        try:
            found = {(written(bars), written(part)): answer for (bars, part), answer in Grid(scene).rows()}
        except NotAsked:
            print(f"{scene}: not asked", flush=True)
            continue
        for row in rows:
            answer = found.get((row["bars"], row["part"])) if row["scene"] == scene else None
            if answer is None:
                continue
            good = answer["verdict"] == "equilibrium"
            mantissa, exponent = f"{answer['energy']:.10e}".split("e")
            row["independent"] = f"{mantissa}e{int(exponent)}" if good else ""  # as Rust writes it
            if row["reason"] in ("fails", "collapse") and row["drawing"] == "base":
                named = answer["verdict"] == "collapse" and "has collapsed" in row["note"]
                row["reason"] = "collapse" if named else "fails"
        with open(TABLE, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
        print(f"{scene}: done", flush=True)


def main():
    if "--explain" in sys.argv:
        return explain([name for name in sys.argv[1:] if name != "--explain"])
    columns = ["scene", "bars", "part", "energy", "gradient", "lowest", "quality", "triangle", "verdict"]
    writer = csv.DictWriter(sys.stdout, columns, lineterminator="\n")
    writer.writeheader()
    for scene in sys.argv[1:]:
        for (bars, part), answer in Grid(scene).rows():
            row = {key: f"{value:.10g}" if isinstance(value, float) else value for key, value in answer.items()}
            writer.writerow({"scene": scene, "bars": written(bars), "part": written(part), **row})
        sys.stdout.flush()


if __name__ == "__main__":
    main()

"""The same relaxation in NumPy and SciPy, to compare the time of one iteration.

    python newton_scipy.py prepare FOLDER [--cells 24]   writes scene.toml and angles.csv: rigid bars, creases of
                                                         stiffness 1, rest angles at random within 0.1 rad of the drawn
    python newton_scipy.py solve FOLDER                  relaxes it; prints JSON: seconds, iterations, energy, residuals

Written as one would write it with care in Python: all elements at once in arrays, hand-written gradients and Hessians,
one call of `splu` per iteration on the system of unknowns and bar tensions, and the same globalisation as the program:
the whole step, pulled back onto the rigid bars by chord corrections with the same factorization, halved until the
energy falls; hinges with their Gauss-Newton Hessian until steps contract. See benches/peers/compare.sh.
"""

import argparse
import csv
import json
import pathlib
import time

import numpy as np
import scipy.linalg
import scipy.sparse
from scipy.sparse.linalg import splu

MESH = pathlib.Path(__file__).resolve().parents[2] / "meshes" / "open-star.fold"


def read_cell():
    """Vertices and lattice of the cell, and its edges {(i, j, n1, n2): [left corner, right corner]}."""
    mesh = json.loads(MESH.read_text())
    lattice = np.array(mesh["foldwell:lattice"])
    vertices, corners = [], []
    for point in np.array(mesh["vertices_coords"]):
        for number, home in enumerate(vertices):
            shift = np.rint(np.linalg.lstsq(lattice.T, point - home, rcond=None)[0])
            if np.linalg.norm(point - home - shift @ lattice) < 1e-6:
                corners.append((number, *shift.astype(int)))
                break
        else:
            corners.append((len(vertices), 0, 0))
            vertices.append(point)
    edges = {}
    for face in mesh["faces_vertices"]:
        a, b, c = (corners[v] for v in face)
        for (p, q, r) in ((a, b, c), (b, c, a), (c, a, b)):
            shift = (q[1] - p[1], q[2] - p[2])
            backwards = (q[0], shift) < (p[0], (0, 0))
            base, end = (q, p) if backwards else (p, q)
            key = (base[0], end[0], end[1] - base[1], end[2] - base[2])
            wing = (r[0], r[1] - base[1], r[2] - base[2])
            edges.setdefault(key, [None, None])[1 if backwards else 0] = wing
    return np.array(vertices), lattice, edges


def patch(n):
    """Positions, bars (pairs), hinges (quadruples i, j, left, right) and the names of the hinges."""
    vertices, lattice, edges = read_cell()
    count = len(vertices)

    def number(v, c1, c2):
        return (c2 * n + c1) * count + v if 0 <= c1 < n and 0 <= c2 < n else None

    positions, bars, hinges, names = [], [], [], []
    for c2 in range(n):
        for c1 in range(n):
            positions.extend(vertices + c1 * lattice[0] + c2 * lattice[1])
            for (i, j, n1, n2), wings in edges.items():
                ends = number(i, c1, c2), number(j, c1 + n1, c2 + n2)
                if None in ends:
                    continue
                bars.append(ends)
                sides = [number(v, c1 + m1, c2 + m2) for v, m1, m2 in wings]
                if None not in sides:
                    hinges.append((*ends, *sides))
                    names.append((c1, c2, i, j, n1, n2))
    return np.array(positions), np.array(bars), np.array(hinges), names


def dot(a, b):
    return np.einsum("ij,ij->i", a, b)


def fold_angles(x, hinges):
    i, j, left, right = (x[hinges[:, k]] for k in range(4))
    e, a, b = j - i, left - i, right - i
    n, m = np.cross(e, a), np.cross(b, e)
    return np.arctan2(np.linalg.norm(e, axis=1) * dot(a, m), dot(n, m))


def cross_matrices(v):
    out = np.zeros((len(v), 3, 3))
    out[:, 0, 1], out[:, 0, 2], out[:, 1, 2] = -v[:, 2], v[:, 1], -v[:, 0]
    return out - out.transpose(0, 2, 1)


def outer(a, b):
    return a[:, :, None] * b[:, None, :]


def hinge_derivatives(x, hinges, hessian):
    """Fold angles, gradients (h, 12) and, where wanted, Hessians (h, 12, 12)."""
    i, j, left, right = (x[hinges[:, k]] for k in range(4))
    e, a, b = j - i, left - i, right - i
    n, m = np.cross(e, a), np.cross(b, e)
    length, squared = np.linalg.norm(e, axis=1), dot(e, e)
    angle = np.arctan2(length * dot(a, m), dot(n, m))
    big_n, big_m = n / dot(n, n)[:, None], m / dot(m, m)[:, None]
    s, r = dot(a, e) / squared, dot(b, e) / squared
    ga, gb = length[:, None] * big_n, length[:, None] * big_m
    ge = -s[:, None] * ga - r[:, None] * gb
    gradient = np.concatenate([-(ga + gb) - ge, ge, ga, gb], axis=1)
    if not hessian:
        return angle, gradient, None
    unit, wide = e / length[:, None], length[:, None, None]
    inverse = lambda normal, big: np.eye(3) / dot(normal, normal)[:, None, None] - 2 * outer(big, big)
    dn, dm = inverse(n, big_n), inverse(m, big_m)
    cross_e = wide * cross_matrices(e)
    aa, bb = dn @ cross_e, -dm @ cross_e
    ae = outer(big_n, unit) - wide * (dn @ cross_matrices(a))
    be = outer(big_m, unit) + wide * (dm @ cross_matrices(b))
    slope = lambda big, wing, foot: wide * outer(big, (wing - 2 * foot[:, None] * e) / squared[:, None])
    ee = -slope(big_n, a, s) - s[:, None, None] * ae - slope(big_m, b, r) - r[:, None, None] * be
    t = lambda block: block.transpose(0, 2, 1)
    zero = np.zeros_like(aa)
    local = np.block([[ee, t(ae), t(be)], [ae, aa, zero], [be, zero, bb]])
    # the variables e, a, b are differences: column sums with the opposite sign stand for vertex i
    full = np.empty((len(hinges), 12, 12))
    full[:, 3:, 3:] = local
    sums = local[:, :, 0:3] + local[:, :, 3:6] + local[:, :, 6:9]
    full[:, 3:, :3] = -sums
    full[:, :3, 3:] = -t(sums)
    full[:, :3, :3] = sums[:, 0:3] + sums[:, 3:6] + sums[:, 6:9]
    return angle, gradient, full


class Sheet:
    """Unknowns: free coordinates, then the tensions of all bars."""

    def __init__(self, positions, bars, hinges, stiffness, rest, ordering):
        self.drawn, self.bars, self.hinges = positions, bars, hinges
        self.stiffness, self.rest, self.ordering = stiffness, rest, ordering
        self.lengths = np.linalg.norm(positions[bars[:, 1]] - positions[bars[:, 0]], axis=1)
        self.last = fold_angles(positions, hinges)
        held = self.choose_held()
        self.free = np.setdiff1d(np.arange(positions.size), held)
        new = np.full(positions.size, -1)
        new[self.free] = np.arange(len(self.free))
        spread = lambda points: new[(3 * points[:, :, None] + np.arange(3)).reshape(len(points), -1)]
        self.hinge_unknowns, self.bar_unknowns = spread(hinges), spread(bars)
        tensions = len(self.free) + np.arange(len(bars))
        row = lambda u: np.repeat(u, u.shape[1], axis=1).ravel()
        column = lambda u: np.tile(u, (1, u.shape[1])).ravel()
        jacobian = np.repeat(tensions, 6)
        rows = [row(self.hinge_unknowns), row(self.bar_unknowns), jacobian, self.bar_unknowns.ravel()]
        columns = [column(self.hinge_unknowns), column(self.bar_unknowns), self.bar_unknowns.ravel(), jacobian]
        rows, columns = np.concatenate(rows), np.concatenate(columns)
        self.kept = (rows >= 0) & (columns >= 0)
        self.rows, self.columns = rows[self.kept], columns[self.kept]
        self.size = len(self.free) + len(bars)

    def choose_held(self):
        """Six coordinates that pin the rigid motions, well separated."""
        arms = self.drawn - self.drawn.mean(axis=0)
        arms /= np.linalg.norm(arms, axis=1).max()
        motions = np.concatenate([np.tile(np.eye(3), (len(arms), 1, 1)), -cross_matrices(arms)], axis=2)
        return scipy.linalg.qr(motions.reshape(-1, 6).T, mode="economic", pivoting=True)[2][:6]

    def points(self, x):
        all_points = self.drawn.copy().ravel()
        all_points[self.free] = x
        return all_points.reshape(-1, 3)

    def continued(self, angle):
        return angle + 2 * np.pi * np.round((self.last - angle) / (2 * np.pi))

    def energy(self, x, tension):
        """Energy of the hinges; gaps still open enter with their tension, to first order."""
        off = self.continued(fold_angles(self.points(x), self.hinges)) - self.rest
        return 0.5 * np.sum(self.stiffness * off**2) + tension @ self.gaps(x)

    def gaps(self, x):
        p = self.points(x)
        return np.linalg.norm(p[self.bars[:, 1]] - p[self.bars[:, 0]], axis=1) - self.lengths

    def linearize(self, x, tension, full):
        """The matrix, the unbalanced force, the gaps and the largest force of an element."""
        p = self.points(x)
        angle, gradient, hessian = hinge_derivatives(p, self.hinges, full)
        off = self.continued(angle) - self.rest
        torque = self.stiffness * off
        hinge = self.stiffness[:, None, None] * outer(gradient, gradient)
        if full:
            hinge += torque[:, None, None] * hessian
        along = p[self.bars[:, 1]] - p[self.bars[:, 0]]
        length = np.linalg.norm(along, axis=1)
        unit = along / length[:, None]
        across = (tension / length)[:, None, None] * (np.eye(3) - outer(unit, unit))
        bar = np.block([[across, -across], [-across, across]])
        jacobian = np.concatenate([-unit, unit], axis=1)
        values = np.concatenate([hinge.ravel(), bar.ravel(), jacobian.ravel(), jacobian.ravel()])[self.kept]
        matrix = scipy.sparse.coo_matrix((values, (self.rows, self.columns)), shape=(self.size, self.size)).tocsc()
        force = np.zeros(len(self.free) + 1)  # held coordinates have number -1: the last place
        np.add.at(force, self.hinge_unknowns.ravel(), -(torque[:, None] * gradient).ravel())
        np.add.at(force, self.bar_unknowns.ravel(), -(tension[:, None] * jacobian).ravel())
        unit_torque = self.stiffness * np.maximum(np.abs(off), 1e-3)
        largest = max(np.max(unit_torque * np.abs(gradient).max(axis=1)), np.abs(tension).max(initial=0.0))
        return matrix, force[:-1], length - self.lengths, largest

    def relax(self, tolerance=1e-12, most=100):
        x, tension = self.drawn.ravel()[self.free], np.zeros(len(self.bars))
        full, iterations, solves, factor_time = False, 0, 0, 0.0
        mean = self.lengths.mean()
        energy = self.energy(x, tension)
        while True:
            matrix, force, gap, largest = self.linearize(x, tension, full)
            residuals = np.abs(force).max() / largest, np.abs(gap).max() / mean
            if max(residuals) <= tolerance or iterations == most:
                break
            clock = time.perf_counter()
            lu = splu(matrix, permc_spec=self.ordering)
            factor_time += time.perf_counter() - clock
            right = np.concatenate([force, -gap])
            step = lu.solve(right)
            step += lu.solve(right - matrix @ step)
            solves += 2
            wanted = np.clip(1e-3 * residuals[0], 1e-14, 1e-8)
            for fraction in 0.5 ** np.arange(12):
                trial, count = self.retract(lu, x, tension, fraction * step, wanted, mean)
                solves += count
                if trial is not None and (after := self.energy(*trial)) <= energy + 1e-13 * abs(energy):
                    break
            else:
                break
            full = full or (fraction == 1 and energy - after < 0.5 * energy)
            (x, tension), energy = trial, after
            self.last = self.continued(fold_angles(self.points(x), self.hinges))
            iterations += 1
        return {
            "iterations": iterations, "solves": solves, "energy": energy, "residual_force": residuals[0],
            "residual_length": residuals[1], "converged": bool(max(residuals) <= tolerance),
            "seconds_factorizing": factor_time,
        }

    def retract(self, lu, x, tension, step, wanted, mean):
        x, tension = x + step[: len(x)], tension + step[len(x) :]
        last = np.inf
        for count in range(13):
            gap = self.gaps(x)
            size = np.abs(gap).max() / mean
            if size <= wanted or (size <= 1e-12 and size > 0.5 * last):
                return (x, tension), count
            if not size < 0.9 * last:
                return None, count
            last = size
            change = lu.solve(np.concatenate([np.zeros(len(x)), -gap]))
            x, tension = x + change[: len(x)], tension + change[len(x) :]
        return None, 12


SCENE = """# written by benches/peers/newton_scipy.py
[sheet]
mesh = "{mesh}"
domain = "patch"
cells = [{n}, {n}]
[energy]
bars = {{ stiffness = inf }}
creases = {{ stiffness = 1.0, rest = {{ file = "angles.csv" }} }}
[[study]]
name = "relaxed"
kind = "relax"
draw = []
"""


def prepare(folder, n):
    folder.mkdir(parents=True, exist_ok=True)
    positions, _, hinges, names = patch(n)
    rest = fold_angles(positions, hinges) + np.random.default_rng(1).uniform(-0.1, 0.1, len(hinges))
    with open(folder / "angles.csv", "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow("cell1 cell2 i j n1 n2 angle".split())
        rows.writerows([*name, repr(float(angle))] for name, angle in zip(names, rest))
    (folder / "scene.toml").write_text(SCENE.format(mesh=MESH, n=n))


def solve(folder, ordering):
    with open(folder / "angles.csv", newline="") as file:
        rows = list(csv.reader(file))[1:]
    n = 1 + max(int(row[0]) for row in rows)
    positions, bars, hinges, names = patch(n)
    assert [list(map(int, row[:6])) for row in rows] == [list(name) for name in names]
    rest = np.array([float(row[6]) for row in rows])
    widths = np.linalg.norm(positions[hinges[:, 1]] - positions[hinges[:, 0]], axis=1)
    clock = time.perf_counter()
    sheet = Sheet(positions, bars, hinges, widths, rest, ordering)
    found = sheet.relax()
    print(json.dumps({"seconds": time.perf_counter() - clock, **found}))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("what", choices=["prepare", "solve"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--cells", type=int, default=24)
    parser.add_argument("--ordering", default="COLAMD", help="splu's permc_spec")
    given = parser.parse_args()
    if given.what == "prepare":
        prepare(given.folder, given.cells)
    else:
        solve(given.folder, given.ordering)


if __name__ == "__main__":
    main()

"""The systems that `cargo bench --bench systems -- write FOLDER` wrote, by CHOLMOD and MKL PARDISO, on one thread and two.

    apt-get install libsuitesparse-dev
    python3 -m venv peers && peers/bin/pip install -r benches/peers/requirements.txt
    cargo bench --bench systems -- write systems && peers/bin/python benches/peers/systems.py systems

Each analyses the pattern once, untimed; the numeric factorization and the solve of one right-hand side are timed (wall clock), median of
seven, and compared with what the bench wrote beside the matrices. CHOLMOD factors L L^T, supernodal, with its nested
dissection; PARDISO, with its own, the positive definite (type 2) and the indefinite one (type -2) that also tells inertia.
"""
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy
import scipy.io
import scipy.sparse
from pypardiso import PyPardisoSolver
from sksparse.cholmod import analyze

ROUNDS = 7


def timed(work):
    times = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        result = work()
        times.append(time.perf_counter() - start)
    return result, statistics.median(times)


def cholmod(matrix, right):
    factor = analyze(scipy.sparse.csc_matrix(matrix), mode="supernodal", ordering_method="metis")
    _, factoring = timed(lambda: factor.cholesky_inplace(matrix))
    solution, solving = timed(lambda: factor(right))
    return solution, factoring, solving


def pardiso(kind):
    def run(matrix, right):
        upper = scipy.sparse.csr_matrix(scipy.sparse.triu(matrix))
        solver = PyPardisoSolver(mtype=kind)
        solver._check_A = lambda matrix: None  # it knows whole matrices only, PARDISO wants the upper triangle
        solver.set_iparm(34, 0)
        def phase(number):
            solver.set_phase(number)
            return solver._call_pardiso(upper, right.reshape(-1, 1))
        phase(11)
        _, factoring = timed(lambda: phase(22))
        solution, solving = timed(lambda: phase(33))
        return solution.ravel(), factoring, solving
    return run


def processor():
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.processor())


def compare(folder, threads):
    programs = {"CHOLMOD": cholmod, "PARDISO (2)": pardiso(2), "PARDISO (-2)": pardiso(-2)}
    for path in sorted(Path(folder).glob("*.mtx"), key=lambda path: int(path.stem)):
        matrix = scipy.sparse.csc_matrix(scipy.io.mmread(path))
        right = numpy.random.default_rng(2).uniform(-1, 1, matrix.shape[0])
        ours = json.loads(path.with_suffix(".json").read_text())
        factor, solve = (ours[name][threads - 1] for name in ("factor", "solve"))
        print(f"{path.stem} x {path.stem} cells, {matrix.shape[0]} unknowns, threads: {threads}; foldwell {1e3 * factor:.2f} ms to "
              f"factor, {1e3 * solve:.2f} ms to solve")
        for name, program in programs.items():
            solution, factoring, solving = program(matrix, right)
            residual = abs(matrix @ solution - right).max() / (abs(matrix).max() * abs(solution).max())
            print(f"  {name:>12}: {1e3 * factoring:9.2f} ms, {1e3 * solving:8.2f} ms, residual {residual:.0e}; foldwell takes "
                  f"{factor / factoring:.2f} and {solve / solving:.2f} of that, {(factor + solve) / (factoring + solving):.2f} of the sum",
                  flush=True)


def main():
    folder, *threads = sys.argv[1:]
    if threads:
        return compare(folder, int(threads[0]))
    print(processor(), flush=True)
    for count in ("1", "2"):
        # the libraries read these once, when they are loaded
        counts = dict.fromkeys(("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS"), count)
        subprocess.run([sys.executable, __file__, folder, count], env=os.environ | counts, check=True)


main()

"""How much faster a sweep of 1,000 points runs on two worker processes of Dask than on one, side by side.

    pip install '.[all]' distributed && python python/benches/workers.py [CELLS] [ROUNDS]

The points are 200 random cells at 5 stiffnesses of the bars, each a relaxation of a patch. Both clusters alternate; tables are compared
byte for byte.
"""

import sys
import tempfile
import time
from pathlib import Path

import distributed
import foldwell as fw
import numpy as np

SCENE = {
    "sheet": {"generate": {"pattern": "random", "seed": 0}, "cells": [4, 4]},
    "energy": {"bars": {"stiffness": 1e3}, "creases": {"stiffness": 1.0, "rest": 0.1}},
    "study": [{"name": "bent", "kind": "relax", "draw": []}],
}


def seconds(workers: int, seeds: int) -> tuple[float, bytes]:
    """Returns the time of the sweep on so many workers, and the bytes of its table."""
    axes = {"sheet.generate.seed": range(seeds), "energy.bars.stiffness": np.logspace(2, 6, 5)}
    with (
        tempfile.TemporaryDirectory() as out,
        distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        client.run(lambda: __import__("foldwell"))
        clock = time.perf_counter()
        fw.sweep(SCENE, axes, out=out, executor=client.get_executor())
        return time.perf_counter() - clock, (Path(out) / "sweep.csv").read_bytes()


if __name__ == "__main__":
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    found = [[seconds(workers, seeds) for workers in (1, 2)] for _ in range(rounds)]
    assert len({table for pair in found for _, table in pair}) == 1
    one, two = (min(pair[k][0] for pair in found) for k in (0, 1))
    print(f"{5 * seeds} points: one worker {one:.1f} s, two {two:.1f} s, ratio {one / two:.2f}")

"""How much longer a relaxation of 48 x 48 cells takes from Python than by the program, side by side.

    cargo build --release && pip install . && python python/benches/relax.py [CELLS] [ROUNDS]

The time of the program is that of the study in its `summary.json`, drawing and writing excluded; the time from Python is that of the call
`foldwell.relax`, with everything that it adds. Both alternate, and the shortest times count, since everything else on the machine
only adds to them.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import foldwell as fw

ROOT = Path(__file__).parents[2]
CELLS = int(sys.argv[1]) if len(sys.argv) > 1 else 48
ROUNDS = int(sys.argv[2]) if len(sys.argv) > 2 else 5

scene = {
    "sheet": {"mesh": str(ROOT / "meshes/miura.fold"), "cells": [CELLS, CELLS]},
    "energy": {"bars": {"stiffness": fw.RIGID}, "creases": {"stiffness": 1.0, "rest": "flat"}},
}
toml = f"""
sheet = {{ mesh = "{ROOT / "meshes/miura.fold"}", cells = [{CELLS}, {CELLS}] }}
energy = {{ bars = {{ stiffness = inf }}, creases = {{ stiffness = 1.0, rest = "flat" }} }}
study = [{{ name = "relax", kind = "relax", draw = [] }}]
"""
program, python = [], []
assembly = fw.Assembly.from_scene(scene)
with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "scene.toml"
    path.write_text(toml)
    for _ in range(ROUNDS):
        out = Path(folder) / "out"
        subprocess.run([ROOT / "target/release/foldwell", "run", path, "--out", out, "--quiet"], check=True)
        program.append(json.loads((out / "summary.json").read_text())["studies"][0]["seconds"])
        clock = time.perf_counter()
        relaxed = fw.relax(assembly, draw=[])
        python.append(time.perf_counter() - clock)
        assert relaxed.converged
print(f"{CELLS} x {CELLS} cells: program {min(program):.3f} s, Python {min(python):.3f} s, ratio {min(python) / min(program):.3f}")

"""How much longer an assembly of 96 x 96 cells takes to make of an array of rest angles than of one number, side by side.

    pip install . && python python/benches/arrays.py [CELLS] [ROUNDS]

Both alternate, and the shortest times count, since everything else on the machine only adds to them. The energies of the two drawn
states are those of the same rest angles.
"""

import sys
import time

import foldwell as fw
import numpy as np

CELLS = int(sys.argv[1]) if len(sys.argv) > 1 else 96
ROUNDS = int(sys.argv[2]) if len(sys.argv) > 2 else 20
REST = 0.3

sheet = fw.generate("miura")
kinds = fw.Assembly.patch(sheet, (CELLS, CELLS), creases=1.0).kinds


def made(rest):
    """Returns the time it takes to make an assembly with these rest angles, and the assembly."""
    clock = time.perf_counter()
    assembly = fw.Assembly.patch(sheet, (CELLS, CELLS), bars=fw.RIGID, creases=1.0, rest=rest)
    return time.perf_counter() - clock, assembly


times = {"number": [], "array": []}
array = np.where(kinds == "facet", 0.0, REST)
for _ in range(ROUNDS):
    seconds, of_number = made(REST)
    times["number"].append(seconds)
    seconds, of_array = made(array)
    times["array"].append(seconds)
energies = [assembly.energy(assembly.start) for assembly in (of_number, of_array)]
assert energies[0] == energies[1], energies
number, array = min(times["number"]), min(times["array"])
print(f"{CELLS} x {CELLS} cells, {len(kinds)} edges: number {number:.4f} s, array {array:.4f} s, ratio {array / number:.2f}")

#!/bin/sh
# Time of one iteration: this program against benches/peers/newton_scipy.py, on the same sheet, one thread each.
#
#     python3 -m venv peers && peers/bin/pip install -r benches/peers/requirements.txt
#     PYTHON=peers/bin/python benches/peers/compare.sh [PROGRAM]       (default: target/release/foldwell)
#
# Both relax 24 x 24 cells of the reference sheet with rigid bars and random rest angles, in turns; the medians of
# `seconds / iterations` are compared; more than a twentieth is an error. Environment: PYTHON, CELLS (default 24), ROUNDS
# (default 15), ORDERING (of splu; default COLAMD, the fastest here).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=${1:-$here/../../target/release/foldwell}
python=${PYTHON:-python3}
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 MKL_NUM_THREADS=1

"$python" "$here/newton_scipy.py" prepare "$folder" --cells "${CELLS:-24}"
round=0
while [ $round -lt "${ROUNDS:-15}" ]; do
    "$program" run "$folder/scene.toml" --out "$folder/out" --threads 1 --quiet --json > "$folder/ours.$round"
    "$python" "$here/newton_scipy.py" solve "$folder" --ordering "${ORDERING:-COLAMD}" > "$folder/theirs.$round"
    round=$((round + 1))
done

"$python" - "$folder" "$round" <<'PYTHON'
import json, statistics, sys
folder, rounds = sys.argv[1], int(sys.argv[2])
ours = [json.load(open(f"{folder}/ours.{k}"))["studies"][0] for k in range(rounds)]
theirs = [json.load(open(f"{folder}/theirs.{k}")) for k in range(rounds)]
for run in ours:
    run["energy"] = run["energy"]["total"]
per = {}
for name, runs in (("foldwell", ours), ("NumPy + SciPy", theirs)):
    last = runs[-1]
    per[name] = statistics.median(run["seconds"] / run["iterations"] for run in runs)
    print(f"{name:>14}: {1e3 * per[name]:9.2f} ms an iteration, {last['iterations']} iterations, energy "
          f"{last['energy']:.10f}, residuals {last['residual_force']:.1e} {last['residual_length']:.1e}, "
          f"converged: {last['converged']}")
print(f"ratio {per['foldwell'] / per['NumPy + SciPy']:.4f} = 1 / {per['NumPy + SciPy'] / per['foldwell']:.1f}")
if per["foldwell"] > per["NumPy + SciPy"] / 20:
    sys.exit("more than a twentieth")
PYTHON

#!/bin/sh
# Which release profile: build time and speed of the whole program, profile by profile.
#
#     benches/profile.sh [FOLDER]        (default: a new temporary folder; builds of an earlier call are used again)
#
# Each profile is built in its own folder, then all programs relax the same scene in turns, round after round, and the
# medians are compared: seconds of the study, of the whole process, and the size of the program. `native` uses every
# instruction of this machine; it is for information, what is shipped has to run elsewhere.
# Build time is processor time, so that other work on the machine does not enter. Environment: ROUNDS (default 7),
# CELLS (default 24), PROFILES (default: all below).
set -eu
cd "$(dirname "$0")/.."
folder=${1:-$(mktemp -d)}
rounds=${ROUNDS:-7}
cells=${CELLS:-24}
profiles=${PROFILES:-off-1 off-16 thin-1 thin-16 fat-1 opt2-off-1 native-off-1}
mkdir -p "$folder"

cat > "$folder/scene.toml" <<SCENE
[sheet]
mesh = "$PWD/meshes/open-star.fold"
domain = "patch"
cells = [$cells, $cells]
[energy]
bars = { stiffness = inf }
creases = { stiffness = 1.0, rest = { mode = [0.06, 0.0, 0.0], amplitude = 0.2 } }
[[study]]
name = "relaxed"
kind = "relax"
draw = []
SCENE

for profile in $profiles; do
    units=${profile##*-}
    rest=${profile%-*}
    lto=${rest##*-}
    level=3 flags=
    case $profile in opt2-*) level=2 ;; native-*) flags="-C target-cpu=native" ;; esac
    [ -x "$folder/$profile/release/foldwell" ] && continue
    CARGO_PROFILE_RELEASE_LTO=$lto CARGO_PROFILE_RELEASE_CODEGEN_UNITS=$units CARGO_PROFILE_RELEASE_OPT_LEVEL=$level \
        RUSTFLAGS="$flags" bash -c "TIMEFORMAT='%U %S'; time cargo build --quiet --release --target-dir '$folder/$profile'" \
        2> "$folder/$profile.build" || { cat "$folder/$profile.build"; exit 1; }
done

python3 - "$folder" "$rounds" $profiles <<'PYTHON'
import json, os, statistics, subprocess, sys, time
folder, rounds, profiles = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
study = {p: [] for p in profiles}
process = {p: [] for p in profiles}
for _ in range(rounds):
    for p in profiles:
        command = [f"{folder}/{p}/release/foldwell", "run", f"{folder}/scene.toml", "--threads", "1", "--json",
                   "--quiet", "--out", f"{folder}/out"]
        begin = time.perf_counter()
        done = subprocess.run(command, capture_output=True, text=True)
        process[p].append(time.perf_counter() - begin)
        found = json.loads(done.stdout)["studies"][0]
        study[p].append(found["seconds"])
print(f"{found['iterations']} iterations, converged: {found['converged']}; medians of {rounds} rounds")
print(f"{'profile':>16} {'build, cpu s':>13} {'MB':>6} {'study, s':>9} {'process, s':>10} {'ratio':>6}")
first = statistics.median(study[profiles[0]])
for p in profiles:
    build = sum(float(t) for t in open(f"{folder}/{p}.build").read().split()[-2:])
    size = os.path.getsize(f"{folder}/{p}/release/foldwell") / 1e6
    s = statistics.median(study[p])
    print(f"{p:>16} {build:13.0f} {size:6.1f} {s:9.3f} {statistics.median(process[p]):10.3f} {s / first:6.2f}")
PYTHON

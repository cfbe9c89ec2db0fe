"""Whether two builds of the program give the same results: every scene is run by both, and every file compared byte by byte.

    python3 .ci/same_results.py OLD NEW [SCENE ...] [--but GLOB ...]

OLD and NEW are programs; without scenes, those of meshes/ are run. Summaries are compared without the seconds that studies
took. `--but` leaves out files that were changed on purpose, by patterns of
their names ("*.svg"). Ends with status 1 where anything differs; the first differing line of each file is shown.
"""

import argparse
import fnmatch
import json
import pathlib
import subprocess
import sys
import tempfile


def run(program, scene, out):
    done = subprocess.run(
        [program, "run", str(scene), "--out", str(out), "--quiet"], capture_output=True, text=True, check=False
    )
    return done.returncode, done.stdout + done.stderr


def summary(text, left_out):
    """A summary as text, without what two runs of one program do not share either; with files left out, without their digests."""
    found = json.loads(text)
    for study in found["studies"]:
        study.pop("seconds", None)
        if left_out:
            study.pop("files", None)
    return json.dumps(found, indent=1)


def content(path, left_out):
    if path is None or not path.is_file():
        return "(no such file)"
    text = path.read_bytes()
    if path.name == "summary.json":
        return summary(text.decode(), left_out)
    return text.decode(errors="replace")


def first_difference(old, new):
    pairs = zip(old.splitlines() + ["(end)"], new.splitlines() + ["(end)"])
    for number, (a, b) in enumerate(pairs, 1):
        if a != b:
            return f"line {number}\n    {a[:200]}\n    {b[:200]}"
    return "line ends"


def compared(scene, programs, left_out):
    """How many files of a scene were compared, and what differs."""
    with tempfile.TemporaryDirectory() as scratch:
        folders = [pathlib.Path(scratch) / name / "out" for name in ("old", "new")]
        ends = [run(program, scene, folder) for program, folder in zip(programs, folders)]
        ends = [(status, text.replace(str(folder), "OUT")) for (status, text), folder in zip(ends, folders)]
        faults = [] if ends[0][0] == ends[1][0] else [f"{scene}: status {ends[0][0]} and {ends[1][0]}: {ends[1][1]}"]
        names = sorted({p.relative_to(f) for f in folders if f.is_dir() for p in f.rglob("*") if p.is_file()})
        names = [name for name in names if not any(fnmatch.fnmatch(str(name), pattern) for pattern in left_out)]
        for name in names:
            old, new = (content(folder / name, left_out) for folder in folders)
            if old != new:
                faults.append(f"{scene}: {name}: {first_difference(old, new)}")
        return len(names), faults


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("old")
    words.add_argument("new")
    words.add_argument("scenes", nargs="*")
    words.add_argument("--but", nargs="*", default=[])
    words = words.parse_args()
    scenes = words.scenes or sorted(str(path) for path in pathlib.Path("meshes").glob("*.toml"))
    count, faults = 0, []
    for scene in scenes:
        files, found = compared(scene, (words.old, words.new), words.but)
        count += files
        faults += found
    print(*faults, sep="\n")
    print(f"{len(scenes)} scenes, {count} files, {len(faults)} differences")
    sys.exit(1 if faults or count == 0 else 0)


main()

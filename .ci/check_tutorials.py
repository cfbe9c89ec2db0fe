"""Does what the tutorials say and compares what the program prints with what they show.

    python3 .ci/check_tutorials.py FOLDWELL

Scenes are the TOML blocks, each with the file name that the text before it mentions last. Shell blocks run in a folder with the
files that the page starts from; a text block right after one is the beginning of its output. Numbers agree to 1e-8 of their size;
numbers under 1e-10 are rounding, and times in seconds differ from machine to machine.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGES = {
    "fold-a-crease-pattern.md": {"pattern.fold": "tests/cases/fold/square-twist-rigid.fold"},
    "measure-a-landscape.md": {"open-star.fold": "meshes/open-star.fold"},
    "penalty-and-exact.md": {"open-star.fold": "meshes/open-star.fold"},
}
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
SECONDS = re.compile(r"\d+\.\d+ s\b")
RELATIVE, ROUNDING = 1e-8, 1e-10
ROW = re.compile(r"^\| (\w+) \| (\S+) \| (\S+) \| (\S+) \| (\d+) \|$", re.M)


def agree(shown, found, relative=RELATIVE):
    """Whether two numbers are the same up to rounding."""
    return abs(shown - found) <= max(relative * abs(shown), ROUNDING)


def same(shown, printed):
    """Whether two lines have the same words, and numbers that agree."""
    shown, printed = (SECONDS.sub("", line) for line in (shown, printed))
    numbers = [list(map(float, NUMBER.findall(line))) for line in (shown, printed)]
    words = [NUMBER.sub("#", line) for line in (shown, printed)]
    return words[0] == words[1] and all(map(agree, *numbers))


def faults_of_table(page, folder):
    """The rows of a table of stiffnesses that the summaries of its runs do not have."""
    for stiffness, bars, total, error, iterations in ROW.findall(page):
        study = json.loads((folder / f"compare-{stiffness}/summary.json").read_text())["studies"][0]
        found = [study["energy"]["bars"] or 0.0, study["energy"]["total"], study["error_to_kinematic"], study["iterations"]]
        shown = [float(bars), float(total), float(error), int(iterations)]
        # the table has two to seven digits
        if not all(agree(a, b, 0.02) for a, b in zip(shown, found)):
            yield f"the row of {stiffness} has {shown}, the run {found}"


def faults(page, folder, path):
    """What a page shows and the program does not print."""
    output, commands = None, 0
    environment = {**os.environ, "PATH": f"{path.parent}{os.pathsep}{os.environ['PATH']}"}
    for block in BLOCK.finditer(page):
        language, text = block.groups()
        if language == "toml":
            name = re.findall(r"`([\w-]+\.toml)`", page[: block.start()])[-1]
            (folder / name).write_text(text)
        elif language == "text" and output is not None:
            for shown, printed in zip(text.splitlines(), output.splitlines() + [""] * len(text.splitlines())):
                if not same(shown, printed):
                    yield f"shown: {shown}\n       found: {printed}"
        output = None
        if language == "sh":
            run = subprocess.run(["bash", "-e"], input=text, cwd=folder, env=environment, capture_output=True, text=True)
            output, commands = run.stdout, commands + 1
            if run.returncode != 0:
                yield f"status {run.returncode} of {text.strip()}: {run.stderr.strip()}"
    if not commands:
        yield "there is no command"
    yield from faults_of_table(page, folder)


def main():
    path, failed = pathlib.Path(sys.argv[1]).resolve(), 0
    for name, files in PAGES.items():
        with tempfile.TemporaryDirectory() as folder:
            for copy, source in files.items():
                shutil.copy(ROOT / source, pathlib.Path(folder) / copy)
            for fault in faults((ROOT / "docs/src" / name).read_text(), pathlib.Path(folder), path):
                failed += 1
                print(f"FAILED {name}: {fault}")
    print(f"{len(PAGES)} tutorials, {failed} failures")
    sys.exit(1 if failed else 0)


main()

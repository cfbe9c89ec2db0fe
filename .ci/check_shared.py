#!/usr/bin/env python3
"""Checks that program and wheel share what is compiled: every crate that both need is built with the same features for both."""

import re
import subprocess


def features(package: str) -> dict[str, str]:
    """Returns the features of every crate that a package is built with, by its name and version."""
    tree = ["cargo", "tree", "--locked", "--package", package, "--edges", "normal,build", "--prefix", "none", "--format", "{p} [{f}]"]
    lines = subprocess.run(tree, check=True, capture_output=True, text=True).stdout.splitlines()
    return dict(re.fullmatch(r"(\S+ v\S+).* \[(.*)\](?: \(\*\))?", line).groups() for line in lines if line)


program, wheel = features("foldwell"), features("foldwell-python")
different = {name: [program[name], wheel[name]] for name in program if wheel.get(name) != program[name]}
for name, [of_program, of_wheel] in different.items():
    print(f"{name} has the features `{of_program}` for the program and `{of_wheel}` for the wheel: ask for both in Cargo.toml")
print(f"{len(program)} crates, {len(different)} compiled otherwise for the wheel")
raise SystemExit(bool(different))

#!/usr/bin/env python3
"""Checks that all crates, on every platform, have licences that `deny.toml` allows and come from crates.io.

`cargo deny check --config .ci/deny.toml` asks this and more, but takes minutes to compile.
"""

import json
import re
import subprocess
import tomllib
from pathlib import Path

CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"
ALLOWED = set(tomllib.loads((Path(__file__).parent / "deny.toml").read_text())["licenses"]["allow"])


def is_allowed(licence: str) -> bool:
    """Whether every part of an expression that AND joins names an allowed licence; for `A OR (B AND C)` that is more than is needed."""
    return all(any(name.strip("() ") in ALLOWED for name in re.split(r" OR |/", part)) for part in licence.split(" AND "))


for good in ("(MIT OR GPL-3.0) AND ISC", "MIT/Apache-2.0", "Apache-2.0 WITH LLVM-exception OR GPL-3.0"):
    assert is_allowed(good), good
for bad in ("", "GPL-3.0", "MIT AND GPL-3.0", "(GPL-3.0 OR LGPL-3.0) AND MIT"):
    assert not is_allowed(bad), bad
command = ["cargo", "metadata", "--format-version", "1", "--locked", "--all-features"]
packages = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)["packages"]
wrong = [package for package in packages if package["source"] not in (None, CRATES_IO) or not is_allowed(package["license"] or "")]
for package in wrong:
    print(f"{package['name']} {package['version']} has licence {package['license']} and comes from {package['source']}")
print(f"{len(packages)} crates, {len(wrong)} with another licence or source")
raise SystemExit(bool(wrong))

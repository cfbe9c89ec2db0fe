#!/usr/bin/env python3
"""Checks scenes, and those shown in pages, against the published schema: it has to accept each of them, and refuse it with a
key that does not exist, in every table.

    python .ci/check_scenes.py SCHEMA.json SCENE.toml... PAGE.md...        needs: jsonschema
"""
import copy
import sys
import tomllib

import book
import published


def scenes_in(path):
    """The scene of a file, or those shown in a page, each with a name."""
    if path.endswith(".md"):
        return book.scenes_of(path)
    with open(path, "rb") as file:
        return [(path, tomllib.load(file))]


def main():
    schema_path, *paths = sys.argv[1:]
    _, check = published.schema(schema_path)
    failed = 0
    scenes = [scene for path in paths for scene in scenes_in(path)]
    for path, scene in scenes:
        for error in check.iter_errors(scene):
            failed += 1
            print(f"FAILED {path}: {error.json_path}: {error.message}")
        for place in [lambda s: s, lambda s: s["sheet"], lambda s: s["study"][0]]:
            wrong = copy.deepcopy(scene)
            place(wrong)["no_such_key"] = 1
            if check.is_valid(wrong):
                failed += 1
                print(f"FAILED {path}: the schema accepts a key that does not exist")
    print(f"{len(scenes)} scenes, {failed} failures")
    return 1 if failed or not scenes else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Checks scenes against the published schema: it has to accept each of them, and refuse it with a key
that does not exist, in every table.

    python .ci/check_scenes.py SCHEMA.json SCENE.toml...        needs: jsonschema
"""
import copy
import sys
import tomllib

import published


def main():
    schema_path, *scenes = sys.argv[1:]
    _, check = published.schema(schema_path)
    failed = 0
    for path in scenes:
        with open(path, "rb") as file:
            scene = tomllib.load(file)
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

#!/usr/bin/env python3
"""Checks the summaries of runs against the published schema of `summary.json`: it has to accept each of them, and refuse it
with any key of its tables renamed, left out where it has to be there, or holding what no key holds.

    python .ci/check_summaries.py validation/schema/summary.json RUN...        needs: jsonschema
"""
import copy
import json
import os
import sys

import published

# keys that are there only where there is something to say
MAY_BE_ABSENT = {
    *("settings", "reason", "files", "map", "wave", "error_of_curvature", "error_of_strain", "error_of_theta", "closed_tubes"),
    *("frequencies", "growth_rates", "critical_factors", "seam", "units", "length", "force"),
}


def tables(value, path=()):
    """Paths of all tables; of the rows of a list only the first."""
    if isinstance(value, dict):
        yield path
        for key, below in value.items():
            yield from tables(below, (*path, key))
    elif isinstance(value, list):
        # studies differ, rows do not
        for place, below in enumerate(value if path == ("studies",) else value[:1]):
            yield from tables(below, (*path, place))


def faults(summary):
    """Summaries with one fault each, and what it is."""
    for path in tables(summary):
        for key in look_up(summary, path):
            place = ".".join(map(str, (*path, key)))
            for what, replace in [("is renamed", True), ("is left out", False)]:
                if replace or key not in MAY_BE_ABSENT:
                    wrong = copy.deepcopy(summary)
                    table = look_up(wrong, path)
                    value = table.pop(key)
                    if replace:
                        table[key + "_"] = value
                    yield f"{place} {what}", wrong
            wrong = copy.deepcopy(summary)
            look_up(wrong, path)[key] = {"no": "such value"}
            yield f"{place} holds something else", wrong


def look_up(value, path):
    for key in path:
        value = value[key]
    return value


def unanswered(summary):
    """The same summary, had none of its studies given an answer."""
    common = {"name", "kind", "converged", "seconds", "error"}
    empty = copy.deepcopy(summary)
    for study in empty["studies"]:
        for key in set(study) - common:
            del study[key]
        study.update(converged=False, error=None, reason="why")
    return empty


def main():
    schema_path, *runs = sys.argv[1:]
    schema, check = published.schema(schema_path)
    found, tried, kinds = [], 0, set()
    _, check_sweep = published.schema(os.path.join(os.path.dirname(schema_path), "sweep.json"))
    for run in runs:
        if os.path.exists(sweep := os.path.join(run, "sweep.json")):
            with open(sweep) as file:
                found += [f"{sweep}: {error.json_path}: {error.message[:300]}" for error in check_sweep.iter_errors(json.load(file))]
    runs = [folder for run in runs for folder in published.runs_in(run)]
    for run in runs:
        with open(os.path.join(run, "summary.json")) as file:
            summary = json.load(file)
        kinds |= {study["kind"] for study in summary["studies"]}
        found += [f"{run}: {error.json_path}: {error.message[:300]}" for error in check.iter_errors(summary)]
        found += [f"{run}, without answers: {error.message[:300]}" for error in check.iter_errors(unanswered(summary))]
        for what, wrong in faults(summary):
            tried += 1
            if check.is_valid(wrong):
                found.append(f"{run}: the schema accepts it where {what}")
    missing = set(schema["$defs"]["StudySummary"]["properties"]["kind"]["enum"]) - kinds
    found += [f"no run has a study of the kind {kind}" for kind in sorted(missing)]
    print(*(f"FAILED {what}" for what in found), sep="\n", end="\n" if found else "")
    print(f"{len(runs)} summaries, {tried} planted faults, {len(found)} failures")
    return 1 if found or not runs else 0


if __name__ == "__main__":
    sys.exit(main())

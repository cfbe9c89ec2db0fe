"""Published JSON schemas. Needs: jsonschema."""
import json
import pathlib

import jsonschema


def schema(path):
    """The schema in a file, and what checks others against it."""
    with open(path) as file:
        schema = json.load(file)
    validator = jsonschema.validators.validator_for(schema)
    validator.check_schema(schema)
    return schema, validator(schema)


def runs_in(folder):
    """The folders of the runs in a folder: those of the points of a sweep, or the folder itself."""
    folder = pathlib.Path(folder)
    return sorted(folder.glob("points/*")) if (folder / "sweep.json").exists() else [folder]

"""Published JSON schemas. Needs: jsonschema."""
import json

import jsonschema


def schema(path):
    """The schema in a file, and what checks others against it."""
    with open(path) as file:
        schema = json.load(file)
    validator = jsonschema.validators.validator_for(schema)
    validator.check_schema(schema)
    return schema, validator(schema)

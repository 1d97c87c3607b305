"""What bench/schema.json says of results of `wavecrest bench --json`."""

import pathlib

import jsonschema

from harness import read_json

SCHEMA = pathlib.Path(__file__).parents[2] / "bench" / "schema.json"


def validate(result):
    """Raises where a result is not what bench/schema.json says; the validator is Debian's python3-jsonschema."""
    jsonschema.Draft202012Validator(read_json(SCHEMA)).validate(result)

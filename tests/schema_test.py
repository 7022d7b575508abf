"""Validates all scenes against the JSON Schema that the program prints, with Python's jsonschema.

Usage: schema_test.py ASPIC SCENES. Exit code 77: the package jsonschema is missing."""
import json
import pathlib
import subprocess
import sys
import tomllib
import unittest

try:
    import jsonschema
except ImportError:
    sys.exit(77)

ASPIC, SCENES = sys.argv[1], pathlib.Path(sys.argv[2])
SCHEMA = json.loads(subprocess.run([ASPIC, "schema"], check=True, capture_output=True, timeout=30).stdout)
VALIDATOR = jsonschema.Draft7Validator(SCHEMA)

BOX = 'shape = { box = { upper = [1, 0.2, 0.2], cells = [20, 4, 4] } }'


def accepts(text):
    return VALIDATOR.is_valid(tomllib.loads(text))


def body(line):
    return accepts(f"[[body]]\n{BOX}\n{line}")


class Schema(unittest.TestCase):
    def test_output_is_a_json_schema(self):
        jsonschema.Draft7Validator.check_schema(SCHEMA)

    def test_accepts_every_scene(self):
        scenes = sorted(SCENES.rglob("*.toml"))
        self.assertGreater(len(scenes), 5)
        for scene in scenes:
            errors = [error.message for error in VALIDATOR.iter_errors(tomllib.loads(scene.read_text()))]
            self.assertEqual(errors, [], scene.name)

    def test_refuses_misspelled_keys(self):
        self.assertTrue(body("material = { young = 1e6 }"))
        self.assertFalse(body("material = { yuong = 1e6 }"))
        self.assertFalse(body("materiel = { young = 1e6 }"))
        self.assertFalse(accepts(f"[tiem]\nstep = 0.1\n[[body]]\n{BOX}"))

    def test_refuses_wrong_values(self):
        for line in ("material = { young = -1 }", "material = { poisson = 0.5 }", 'material = { model = "rubber" }',
                     "material = { young = true }", "translate = [1, 2]", "[[body.pin]]\nwhere = 3"):
            self.assertFalse(body(line), line)

    def test_accepts_each_kind_of_value(self):
        for line in ('material = { young = "1e5 * (1 + X)" }', "scale = 2", "scale = [1, 2, 3]",
                     '[[body.pin]]\nwhere = "x < 0.1"', "pin = [{ where = { lowest = 0.1 } }]",
                     "pin = { where = { lowest = 0.1 } }", "material = { young = { regions = { 1 = 1e5 } } }"):
            self.assertTrue(body(line), line)

    def test_describes_alternatives(self):
        self.assertFalse(body('mesh = "a.mesh"'))
        self.assertFalse(accepts("[[body]]\nname = 'none'"))
        self.assertTrue(body("material = { lambda = 1e5, mu = 1e5 }"))
        self.assertFalse(body("material = { lambda = 1e5 }"))
        self.assertFalse(body("material = { mu = 1e5, lambda = 1e5, young = 1e5 }"))

    def test_describes_keys_with_units_and_defaults(self):
        step = SCHEMA["definitions"]["time"]["properties"]["step"]
        self.assertIn("[s]", step["description"])
        self.assertIn("default", step)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

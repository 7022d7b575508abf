"""`aspic fit` on measurements of quadratic_fem.py: small cases of tools/capture_oracle.

usage: ASPIC=path/to/aspic capture_truths_test.py. Exit code 77: NumPy or SciPy is missing."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy  # noqa: F401
    import scipy  # noqa: F401
except ImportError:
    sys.exit(77)
import capture_truths as truths


class Fits(unittest.TestCase):
    def fit(self, truth, *arguments, noise=0.01, forces_alone=False, settings="", code=0):
        """Returns the values of one fit by quantity, and its text."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            truths.write(truth, folder / "data", noise, 1, settings)
            if forces_alone:
                (folder / "data" / "positions.csv").unlink()
            (folder / "options.toml").write_text("cross_validation = false\n")
            done = subprocess.run([os.environ["ASPIC"], "fit", "data", "-q", "--unknown", "young=uniform", "--options",
                                   "options.toml", *arguments], cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            if code != 0:
                return {}, done.stderr
            figures = json.loads((folder / "material.fit" / "figures.json").read_text())
        return {q: v["everywhere"] for q, v in figures["values"].items()}, done.stderr

    def assert_found(self, value, truth, tolerance):
        self.assertAlmostEqual(value["value"] / truth, 1, delta=tolerance)
        self.assertLess(value["lower"], truth)
        self.assertGreater(value["upper"], truth)

    def test_block_in_a_rig_has_its_moduli(self):
        truth = truths.block(cells=4)
        truth.cells = (3, 3, 3)
        values, _ = self.fit(truth)
        self.assert_found(values["young"], 2e4, 0.02)
        self.assertAlmostEqual(values["poisson"]["value"], 0.45, delta=0.01)

    def test_tensile_forces_alone_give_the_modulus(self):
        truth = truths.tensile(cells=3)
        truth.cells = (2, 2, 7)
        values, _ = self.fit(truth, "--known", "poisson=0.4", forces_alone=True)
        self.assertAlmostEqual(values["young"]["value"] / 6e4, 1, delta=0.03)  # inverse/docs/capture_results.md: its interval misses

    def test_swapped_sign_of_the_force_is_refused(self):
        truth = truths.tensile(cells=3)
        for reading in truth.readings:
            reading.force = -reading.force
        _, text = self.fit(truth, code=2)
        self.assertIn("the force opposes the motion of the grip", text)


if __name__ == "__main__":
    unittest.main()

"""`aspic fit --model neo_hookean_fibres` on measurements of quadratic_fem.py, whose fibres have known directions.

usage: ASPIC=path/to/aspic fibre_truths_test.py. Exit code 77: NumPy or SciPy is missing. SEEDS: number of noises."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    import scipy  # noqa: F401
except ImportError:
    sys.exit(77)
import capture_truths as truths

SEEDS = range(1, 1 + int(os.environ.get("SEEDS", 1)))
LAW = ("--model", "neo_hookean_fibres", "--unknown", "young=uniform")


def angle(a, b):
    """Between two axes, in degrees."""
    return np.degrees(np.arccos(min(1, abs(np.dot(a, b)))))


class Fibres(unittest.TestCase):
    def fit(self, truth, seed, *arguments, code=None):
        """Returns figures.json, and the text of the fit."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            truths.write(truth, folder / "data", 0.01, seed)
            (folder / "options.toml").write_text("cross_validation = false\n")
            done = subprocess.run([os.environ["ASPIC"], "fit", "data", "--options", "options.toml", *arguments],
                                  cwd=folder, capture_output=True, text=True)
            text = done.stdout + done.stderr
            self.assertIn(done.returncode, (0, 3) if code is None else (code,), text)
            figures = folder / "material.fit" / "figures.json"
            return (json.loads(figures.read_text()) if figures.exists() else None), text

    def assert_found(self, value, truth, tolerance, text):
        self.assertAlmostEqual(value["value"] / truth, 1, delta=tolerance, msg=text)

    def assert_axis(self, found, truth, tolerance, text):
        error = angle(found["direction"], truth)
        print(f"direction {error:.2f} degrees from the truth, 95 % within {found['cone_95']:.2f}", flush=True)
        self.assertLess(error, tolerance, text)
        self.assertLess(found["cone_95"], 3 * tolerance, text)
        return error < found["cone_95"]

    def test_direction_and_moduli_of_a_block(self):
        axis = truths.axis(30, 35)
        truth = truths.fibrous([axis])
        for seed in SEEDS:
            figures, text = self.fit(truth, seed, *LAW, "--known", "fibre_exponent=1")
            self.assertEqual(figures["fibres"][0]["where"], "everywhere")
            self.assert_axis(figures["fibres"][0], axis, 3, text)
            values = {q: v["everywhere"] for q, v in figures["values"].items()}
            self.assert_found(values["young"], 2e4, 0.05, text)
            self.assert_found(values["fibre_ratio"], truths.FIBRE_RATIO, 0.15, text)
            self.assertTrue(figures["verdict"]["good"], text)

    def test_two_regions_have_their_own_directions(self):
        axes = [truths.axis(20, 40), truths.axis(110, 30)]
        truth = truths.fibrous(axes)
        for seed in SEEDS:
            figures, text = self.fit(truth, seed, *LAW, "--unknown", "fibre_direction=regions", "--known",
                                     "fibre_exponent=1")
            self.assertEqual([f["where"] for f in figures["fibres"]], ["region 1", "region 2"])
            for found, axis in zip(figures["fibres"], axes):
                self.assert_axis(found, axis, 6, text)

    def test_without_stretch_the_direction_is_undetermined(self):
        truth = truths.fibrous([truths.axis(0, 90)], only_press=True)
        figures, text = self.fit(truth, 1, *LAW, "--known", "fibre_exponent=1")
        self.assertEqual(figures["fibres"][0]["cone_95"], 90, text)
        self.assertIn("fibres_undetermined", [r["name"] for r in figures["verdict"]["reasons"]])

    def test_isotropic_laws_have_no_direction(self):
        truth = truths.fibrous([truths.axis(30, 35)])
        _, text = self.fit(truth, 1, "--unknown", "fibre_direction=regions", code=2)
        self.assertIn("the model neo_hookean is isotropic; use --model neo_hookean_fibres", text)


if __name__ == "__main__":
    unittest.main()

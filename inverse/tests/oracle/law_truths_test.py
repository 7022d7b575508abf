"""`aspic fit --model auto` on measurements of quadratic_fem.py, whose law is Yeoh's with b2 = 1 and b3 = 0.

usage: ASPIC=path/to/aspic law_truths_test.py. Exit code 77: NumPy or SciPy is missing."""
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


SEEDS = range(1, 1 + int(os.environ.get("SEEDS", 1)))  # of the noise; each takes a minute or two


class Laws(unittest.TestCase):
    def choose(self, truth, seed, noise, *arguments, options="", codes=(0, 3)):
        """Returns the comparison of laws, the rows by law, and the values of the material."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            truths.write(truth, folder / "data", noise, seed)
            (folder / "options.toml").write_text(options)
            done = subprocess.run([os.environ["ASPIC"], "fit", "data", "--model", "auto", "--unknown", "young=uniform",
                                   "--options", "options.toml", *arguments], cwd=folder, capture_output=True, text=True)
            self.assertIn(done.returncode, codes, done.stdout + done.stderr)
            self.output = done.stdout + done.stderr
            figures = json.loads((folder / "material.fit" / "figures.json").read_text())
        self.verdict = figures["verdict"]
        laws = figures["laws"]
        return laws, {t["law"]: t for t in laws["trials"]}, figures["values"]

    def test_large_strains_choose_the_law_of_the_data(self):
        truth = truths.stiffening(0.6)
        for seed in SEEDS:
            laws, trials, values = self.choose(truth, seed, 0.003)
            self.assertEqual(laws["chosen"], "yeoh", self.output)
            self.assertFalse(trials["neo_hookean"]["as_good"])
            self.assertGreater(trials["neo_hookean"]["evidence_loss"], 20)
            self.assertGreater(laws["strain"], 0.3)
            self.assertAlmostEqual(values["b2"]["everywhere"]["value"], 1, delta=0.15)

    def test_a_law_with_a_bad_verdict_is_not_chosen(self):
        # The most probable law of presses and twists predicts the force of pulls with an error of 11 %.
        laws, trials, _ = self.choose(truths.stiffening(0.25), 1, 0.01, "--known", "poisson=0.45",
                                      options='mesh_errors = false\nleave_out = ["pull"]\n', codes=(0,))
        self.assertTrue(self.verdict["good"])
        preferred = trials["mooney_rivlin"]
        self.assertEqual((preferred["evidence_loss"], preferred["held_out_loss"]), (0, 0))
        self.assertRegex(preferred["verdict"], "^its verdict is bad: held-out groups are predicted")
        self.assertFalse(preferred["as_good"])
        self.assertIn("mooney_rivlin would be preferred, but its verdict is bad", laws["text"])
        self.assertIn("do not distinguish", laws["text"])
        self.assertEqual(trials[laws["chosen"]]["verdict"], "chosen")

    def test_small_strains_do_not_distinguish_laws(self):
        truth = truths.stiffening(0.06)
        for seed in SEEDS:
            laws, trials, _ = self.choose(truth, seed, 0.01)
            self.assertEqual(trials[laws["chosen"]]["parameters"], 2, self.output)  # the simplest: E and nu
            for law in ("neo_hookean", "yeoh", "fung"):
                self.assertTrue(trials[law]["as_good"], self.output)
            self.assertIn("do not distinguish", laws["text"])
            self.assertLess(laws["strain"], 0.1)


if __name__ == "__main__":
    unittest.main()

"""`aspic fit` on measurements of quadratic_fem.py: a block under a plate with friction, which presses and slides.

usage: ASPIC=path/to/aspic friction_truths_test.py. Exit code 77: NumPy or SciPy is missing."""
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
import quadratic_fem as fem

FRICTION, YOUNG, POISSON, RADIUS, LAYER = 0.3, 2e4, 0.45, 0.04, 1e9


def plate(mu=FRICTION, cells=3, steps=2):
    """A block that is held below, under a plate that covers it: pressed, and moved obliquely."""
    size = np.array([0.04, 0.04, 0.03])
    across, up = truths.graded(0.04, cells, 0.3), truths.graded(0.03, cells, 0.3)
    solid = fem.Solid(fem.box(across, across, up), truths.uniform(YOUNG), POISSON, b=0)
    held = np.repeat(solid.mesh.X[:, 2] < 1e-9, 3)
    markers = truths.on_sides(size, 60, 7, lambda p: p[2] < 0.03)
    read, readings, touch = fem.Interpolation(solid.mesh, markers), [], np.array([0.02, 0.02, 0.03])
    for name, move in (("press", (0, 0, -2e-3)), ("slide x", (3e-3, 0, -1.5e-3)), ("slide y", (0, -2e-3, -2e-3))):
        solid.indenter = fem.Disc(touch, 0.9 * RADIUS, 0.1 * RADIUS, LAYER, 0.02 * RADIUS)
        path = [touch + np.array(move) * k / steps for k in range(1, steps + 1)]
        x, force = solid.slide(solid.mesh.X.ravel(), held, path, mu, 5e-5)
        columns = {"case": name, "group": name, **{"touch_" + a: t for a, t in zip("xyz", touch)},
                   **{"axis_" + a: n for a, n in zip("xyz", (0, 0, -1))},
                   **{"center_" + a: c for a, c in zip("xyz", touch + move)}}
        readings.append(truths.Reading(columns, read(x), force))
    settings = f'fixed = "z < 1e-6"\n[[tip]]\nshape = "disc"\nradius = {RADIUS}\nrim = {0.064 * RADIUS}\nstiffness = {LAYER}\n'
    return truths.Truth("plate", size, (4, 4, 3), markers, readings, settings, YOUNG, POISSON)


def fit(truth, tip="", seed=1):
    """Returns figures.json of a fit of E, with the true Poisson's ratio, and the summary."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        truth.settings, kept = truth.settings + tip, truth.settings
        truths.write(truth, folder / "data", 0.01, seed)
        truth.settings = kept
        (folder / "options.toml").write_text("cross_validation = false\n")
        done = subprocess.run([os.environ["ASPIC"], "fit", "data", "--unknown", "young=uniform", "--known",
                               f"poisson={POISSON}", "--options", "options.toml", "--allow-unconverged"],
                              cwd=folder, capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(done.stdout + done.stderr)
        return json.loads((folder / "material.fit" / "figures.json").read_text()), done.stdout


class Friction(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.truth = plate()

    def test_sliding_obeys_the_law_of_coulomb(self):
        ratios = [np.linalg.norm(r.force[:2]) / -r.force[2] for r in self.truth.readings]
        self.assertLess(ratios[0], 0.001)
        self.assertLess(abs(ratios[1] / FRICTION - 1), 0.05)
        self.assertLess(ratios[2], 0.9 * FRICTION)  # parts of the face stick

    def test_coefficient_and_modulus_are_found(self):
        figures, summary = fit(self.truth, "friction = 0.5\nfriction_deviation = 0.7\n")
        young, found = figures["values"]["young"]["everywhere"], figures["errors"][0]
        self.assertLess(abs(young["value"] / YOUNG - 1), 0.015, young)
        self.assertEqual((found["name"], found["determined_by"]), ("friction of 'tip'", "data"))
        low, high = found["coefficient_95"]
        self.assertLess(low, FRICTION, found)
        self.assertGreater(high, FRICTION, found)
        self.assertLess(high - low, 0.01, found)
        self.assertIn(f"{found['coefficient']:.4g} (", summary)

    def test_fit_without_friction_is_not_good(self):
        figures, _ = fit(self.truth)
        self.assertFalse(figures["verdict"]["good"])
        self.assertGreater(abs(figures["values"]["young"]["everywhere"]["value"] / YOUNG - 1), 0.1)


if __name__ == "__main__":
    unittest.main()

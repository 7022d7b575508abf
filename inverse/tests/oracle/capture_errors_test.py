"""`aspic fit` on measurements of quadratic_fem.py with systematic errors, outliers, a soft layer and a mesh that was
scanned under gravity.

usage: ASPIC=path/to/aspic capture_errors_test.py. Exit code 77: NumPy or SciPy is missing."""
import copy
import csv
import functools
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

BRIEF = "cross_validation = false\n"


def bar():
    """Pulled and pushed at its top, which also shears and twists a little."""
    size, planes = np.array([0.02, 0.02, 0.08]), truths.graded(0.02, 3, 0.2)
    solid = fem.Solid(fem.box(planes, planes, truths.graded(0.08, 8, 0.4)), truths.uniform(6e4), 0.4)
    markers = truths.on_sides(size, 40, 2, lambda p: p[2] < 0.08)
    motions = [(f"{1000 * d:g} mm", "pull" if d > 0 else "push", (0, 0, d), (0, 0, 0)) for d in (-2e-3, -1e-3, 1e-3, 2e-3)]
    motions += [("bend", "bend", (2e-3, 0, 0), (0, 0.05, 0))]
    return truths.Truth("bar", size, (2, 2, 7), markers, truths.grip_readings(solid, markers, motions),
                        truths.GRIPPED.format(height=0.08), 6e4, 0.4)


def weighed():
    solid, size, markers = truths.standing()
    readings = truths.grip_readings(solid, markers, [("stand", "stand", None, None)], (0, 0, -9.81))
    return truths.Truth("weighed", size, (3, 3, 3), markers, readings, 'fixed = "z < 1e-6"\n', 5e3, 0.4)


def pressed(stiffness, young=2e4):
    """The middle of a block under a disc with a layer of this stiffness; a quarter of the body is solved."""
    size, half, disc = np.array([0.06, 0.06, 0.03]), 0.03, 0.01
    across = np.concatenate([np.linspace(0, 0.0125, 4), half - (half - 0.0125) * np.linspace(1, 0, 3)[1:]])
    mesh = fem.box(across, across, np.linspace(0, 0.03, 5))
    solid, X = fem.Solid(mesh, truths.uniform(young), 0.4), mesh.X
    held = np.stack([X[:, 0] < 1e-9, X[:, 1] < 1e-9, np.zeros(len(X), bool)], 1)
    held[X[:, 2] < 1e-9] = True
    markers = truths.on_sides(size, 10, 5, lambda p: p[2] < 0.03)
    x, readings = X.ravel(), []
    for depth in (1.5e-3, 3e-3):
        solid.indenter = fem.Disc(np.array([0, 0, 0.03 - depth]), 0.9 * disc, 0.1 * disc, stiffness, 0.02 * disc)
        x = solid.solve(x, held.ravel())
        columns = {"case": f"{1000 * depth:g} mm", "group": "press", "touch_x": half, "touch_y": half, "touch_z": 0.03,
                   "axis_x": 0, "axis_y": 0, "axis_z": -1, "depth": depth}
        readings.append(truths.Reading(columns, markers, np.array([0, 0, 4 * solid.contact(x)[3][2]])))
    settings = f'fixed = "z < 1e-6"\n[[tip]]\nshape = "disc"\nradius = {disc}\nrim = {0.064 * disc}\n'
    return truths.Truth("pressed", size, (6, 6, 3), markers, readings, settings, young, 0.4)


@functools.cache
def scanned():
    return truths.scan(cells=7)


def standing_only(truth):
    truth = copy.deepcopy(truth)
    truth.readings = truth.readings[:1]
    return truth


def unaware(truth):
    """The same data without the gravity of the scan."""
    truth = copy.deepcopy(truth)
    truth.settings = truth.settings.replace(truths.MESH_GRAVITY, "")
    return truth


def changed(truth, column=None, by=None, force=None, motion=1):
    """Wrong values of a column of cases.csv, of the force (a function), or of the motion of markers (a factor)."""
    truth = copy.deepcopy(truth)
    for r in truth.readings:
        if column:
            r.columns[column] += by(r.columns)
        if force:
            r.force = force(r.force)
        r.markers = truth.markers + motion * (r.markers - truth.markers)
    return truth


def add_outliers(folder, share, size, seed):
    """Moves some of the readings; returns their cases and markers."""
    path, random = folder / "positions.csv", np.random.default_rng(seed)
    rows = list(csv.DictReader(path.read_text().splitlines()))
    chosen = random.choice(len(rows), int(share * len(rows)), replace=False)
    for i in chosen:
        for a, d in zip("xyz", random.normal(size=3)):
            rows[i][a] = float(rows[i][a]) + size * d
    truths.write_table(path, rows)
    return {(rows[i]["case"], rows[i]["marker"]) for i in chosen}


class Fits(unittest.TestCase):
    def fit(self, truth, settings="", options="", disturb=lambda folder: None, noise=0.01, seed=1):
        """Returns figures.json of a fit of E, with the true Poisson's ratio."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            truths.write(truth, folder / "data", noise, seed, settings)
            disturb(folder / "data")
            (folder / "options.toml").write_text(BRIEF + options)
            done = subprocess.run([os.environ["ASPIC"], "fit", "data", "-q", "--unknown", "young=uniform", "--known",
                                   f"poisson={truth.poisson}", "--options", "options.toml", "--allow-unconverged"],
                                  cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            return json.loads((folder / "material.fit" / "figures.json").read_text())

    def young(self, figures):
        return figures["values"]["young"]["everywhere"]

    def assert_within_interval(self, figures, true):
        young = self.young(figures)
        self.assertLess(young["lower"], true, figures)
        self.assertGreater(young["upper"], true, figures)

    def test_errors_with_priors_restore_the_modulus(self):
        truth, weight = bar(), weighed()
        pulls, presses = copy.deepcopy(truth), copy.deepcopy(truth)
        pulls.readings = [r for r in truth.readings if r.columns["group"] == "pull"]
        presses.readings = [r for r in truth.readings if r.columns["group"] != "bend"]
        tare = np.array([0.05, -0.02, 0.15])
        cases = {
            "position": (changed(truth, "move_z", lambda c: 3e-4 * (c["group"] == "pull")), 3e-4, "position z of 'pull'", -3e-4),
            "rotation": (changed(truth, "rotation_y", lambda c: 0.03 * (c["group"] == "bend")), 0.03, "rotation y of 'bend'", -0.03),
            "backlash": (changed(presses, "move_z", lambda c: 2e-4 * np.sign(c["move_z"])), 2e-4, "backlash", 2e-4),
            "tare": (changed(pulls, force=lambda f: f + tare), 0.15, "tare z", 0.15),
            "force_scale": (changed(truth, force=lambda f: 1.05 * f), 0.05, None, 0),
            "length_scale": (changed(weight, motion=1.05), 0.05, None, 0),
        }
        for key, (wrong, sigma, name, value) in cases.items():
            with self.subTest(key):
                true = wrong.young
                figures = self.fit(wrong, f"errors = {{ {key} = {sigma} }}")
                self.assert_within_interval(figures, true)
                without = self.young(self.fit(wrong))
                self.assertGreater(abs(without["value"] / true - 1), 0.02)
                found = {e["name"]: e for e in figures["errors"]}
                if name:  # the data determine it
                    self.assertEqual(found[name]["determined_by"], "data")
                    self.assertLess(abs(found[name]["value"] - value), 4 * found[name]["deviation"] + 0.1 * abs(value))
                else:  # E is as uncertain as the scale
                    self.assertEqual(figures["errors"][0]["determined_by"], "prior")
                    relative = (self.young(figures)["upper"] - self.young(figures)["lower"]) / true / 2
                    self.assertGreater(relative, 1.8 * sigma)

    def test_outliers_do_not_change_the_modulus(self):
        truth = weighed()
        clean, chosen = self.fit(truth), set()
        disturb = lambda folder: chosen.update(add_outliers(folder, 0.05, 0.02, 3))
        squares = self.fit(truth, disturb=disturb)
        robust = self.fit(truth, options='loss = "robust"\n', disturb=disturb)
        value = self.young(clean)["value"]
        self.assertGreater(abs(self.young(squares)["value"] / value - 1), 0.01)
        self.assertLess(abs(self.young(robust)["value"] / value - 1), 0.01)
        self.assertEqual({(o["case"], o["reading"]) for o in robust["outliers"]}, chosen)

    def test_stated_stiffness_of_a_layer_counts(self):
        stiffness = 10 * 2e4 / 0.01
        truth = pressed(stiffness)
        truth.settings += f"stiffness = {stiffness}\n"
        forces = lambda folder: (folder / "positions.csv").unlink()
        exact = self.fit(truth, disturb=forces)
        self.assertLess(abs(self.young(exact)["value"] / 2e4 - 1), 0.04)
        truth.settings += "stiffness_deviation = 0.2\n"
        uncertain = self.fit(truth, disturb=forces)
        self.assert_within_interval(uncertain, 2e4)
        width = lambda f: self.young(f)["upper"] - self.young(f)["lower"]
        self.assertGreater(width(uncertain), 1.2 * width(exact))

    def test_scan_under_gravity_is_unloaded(self):
        truth = standing_only(scanned())
        figures = self.fit(truth)
        self.assertLess(abs(self.young(figures)["value"] / 5e3 - 1), 0.01)  # tets of 13 mm
        self.assert_within_interval(figures, 5e3)
        without = self.fit(unaware(truth))
        self.assertLess(abs(self.young(without)["value"] / 2.5e3 - 1), 0.05)  # the weight seems to move it twice as far

    def test_error_of_a_law_does_not_hide_a_scan_under_gravity(self):
        self.assertFalse(self.fit(unaware(scanned()))["verdict"]["good"])
        self.assertTrue(self.fit(scanned())["verdict"]["good"])


if __name__ == "__main__":
    unittest.main()

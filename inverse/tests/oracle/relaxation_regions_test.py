"""`aspic fit` of the moduli of two regions of a bar in series, on static cases beside a ramp-and-hold test.

With Poisson's ratio 0 and halves of equal length, forces measure the modulus E = 2 / (1 / E1 + 1 / E2). Its logarithm has
the derivatives g = (E2, E1) / (E1 + E2) with respect to log E1 and log E2. A hold that measures log E with the
standard deviation h changes the estimates p, whose covariance is C, by C g (log E - g'p) / (g'C g + h^2), and C by
-C g g'C / (g'C g + h^2).

usage: ASPIC=path/to/aspic relaxation_regions_test.py. Exit code 77: NumPy is missing."""
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

try:
    import numpy as np
    import scipy  # noqa: F401  (capture_truths)
except ImportError:
    sys.exit(77)
import capture_truths as truths
import relaxation_truths_test as bar

SOFT, STIFF = np.array([1e4, 4e4])
SERIES = 2 / (1 / SOFT + 1 / STIFF)
FORCE, STRETCH = bar.SIDE ** 2 * SERIES * bar.STRAIN, bar.STRAIN * bar.LENGTH
MIDDLE = STRETCH * STIFF / (SOFT + STIFF)  # displacement of the interface
SERIES_SLOPES = np.array([STIFF, SOFT]) / (SOFT + STIFF)
TO_MIDDLE = '[[grip]]\nname = "middle"\nwhere = "abs(z - 0.02) < 1e-6"\n'


def static_case(name, grip, move, force, sd):
    return {"case": name, "group": name, "time": "", "grip": grip, "move_x": 0.0, "move_y": 0.0, "move_z": move,
            "force_z": force, "force_sd_z": sd,
            **{f"force{part}_{a}": v for a in "xy" for part, v in (("", 0.0), ("_sd", FORCE))}}


def write(folder, branches, statics, has_hold=True, marker=None):
    """`marker`: measured displacement of the interface in the first static case, and its standard deviation."""
    bar.write_hold(folder, branches, 0.002, 1, scale=SERIES / bar.YOUNG)
    X, tets = truths.kuhn_box((bar.SIDE, bar.SIDE, bar.LENGTH), (1, 1, 4))
    truths.write_gmsh(folder / "rest.msh", X, tets, np.where(X[tets].mean(1)[:, 2] < bar.LENGTH / 2, 1, 2))
    with open(folder / "cases.csv", newline="") as file:
        rows = list(csv.DictReader(file)) if has_hold else []
    truths.write_table(folder / "cases.csv", rows + statics)
    middle = np.flatnonzero(np.abs(X[:, 2] - bar.LENGTH / 2) < 1e-9)[:1]
    truths.write_table(folder / "markers.csv", [{"marker": "A", "vertex": int(i)} for i in middle])
    if marker:
        truths.write_table(folder / "positions.csv", [
            {"case": statics[0]["case"], "marker": "A", **dict(zip("xy", map(float, X[i]))),
             "z": float(X[i, 2] + marker[0]), "sd_x": STRETCH, "sd_y": STRETCH, "sd_z": marker[1]} for i in middle])
    settings = (folder / "capture.toml").read_text() + TO_MIDDLE
    if not has_hold:
        (folder / "load.csv").unlink()
        settings = re.sub("(steady|forces) = .*\n", "", settings)
    (folder / "capture.toml").write_text(settings)


class Regions(unittest.TestCase):
    def fit(self, young="regions", **data):
        """Returns logarithms of moduli over the true ones, their standard deviations, and the branch."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write(folder / "data", **data)
            branches = "branches = 1\n" if data.get("has_hold", True) else ""
            (folder / "options.toml").write_text("cross_validation = false\nmesh_errors = false\n" + branches)
            done = subprocess.run([os.environ["ASPIC"], "fit", "data", "--unknown", f"young={young}", "--known",
                                   "poisson=0", "--options", "options.toml", "--allow-unconverged"],
                                  cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            figures = json.loads((folder / "material.fit" / "figures.json").read_text())
        values = figures["values"]["young"]
        found = [values[f"region {k}"] for k in (1, 2)] if young == "regions" else [values["everywhere"]]
        logs = np.log([v["value"] for v in found]) - np.log([SOFT, STIFF] if young == "regions" else [SERIES])
        sigmas = np.array([np.log(v["upper"] / v["lower"]) / 2 / 1.96 for v in found])
        return logs, sigmas, (figures["relaxation"]["branches"] if branches else [None])[0]

    def assert_branch(self, branch, ratio, time, delta):
        self.assertAlmostEqual(branch["ratio"] / ratio, 1, delta=delta)
        self.assertAlmostEqual(branch["relaxation_time"] / time, 1, delta=delta)

    def test_posterior_is_that_of_both_readings(self):
        # The ends of forces and of the marker, which measure the series and the ratio of the moduli.
        slow, sd, marker_sd = bar.SLOW, 0.004, 0.02
        statics = [static_case("pull", "top", STRETCH, 1.005 * FORCE, sd * FORCE)]
        marker = (MIDDLE + 0.01 * STRETCH, marker_sd * STRETCH)
        before, sigma, _ = self.fit(branches=slow, statics=statics, has_hold=False, marker=marker)
        (series,), (h,), _ = self.fit("uniform", branches=slow, statics=[])
        after, narrowed, branch = self.fit(branches=slow, statics=statics, marker=marker)
        share = np.array([-1, 1]) * SOFT * STIFF / (SOFT + STIFF) ** 2  # derivatives of MIDDLE / STRETCH
        J = np.array([SERIES_SLOPES / sd, share / marker_sd])
        C, g = np.linalg.inv(J.T @ J), SERIES_SLOPES
        np.testing.assert_allclose(sigma, np.sqrt(np.diag(C)), rtol=0.1)
        gain = C @ g / (g @ C @ g + h ** 2)
        expected = np.sqrt(np.diag(C - np.outer(gain, C @ g)))
        np.testing.assert_allclose(narrowed, expected, rtol=0.1)
        combined = g @ before + g @ gain * (series - g @ before)
        self.assertLess(abs(g @ after - combined), 0.1 * h)
        np.testing.assert_array_less(np.abs(after - before - gain * (series - g @ before)), 0.1 * h)
        self.assert_branch(branch, *slow[0], 0.02)

    def test_hold_determines_the_region_that_static_cases_miss(self):
        # The force at the interface depends on the soft region alone.
        statics = [static_case("middle", "middle", MIDDLE, 2 * bar.SIDE ** 2 * SOFT * MIDDLE / bar.LENGTH, 0.005 * FORCE)]
        _, without_history, _ = self.fit(branches=(), statics=statics, has_hold=False)
        self.assertGreater(without_history[1], 0.5)
        logs, sigma, branch = self.fit(branches=((0.6, 30.0),), statics=statics)
        self.assertLess(abs(logs[0]), 0.002)
        self.assertLess(abs(logs[1]), 0.01)
        np.testing.assert_allclose(sigma[0], without_history[0], rtol=0.1)
        # E2 = 1 / (2 / E - 1 / E1): 1 / SERIES_SLOPES[1] - 1 = 4 times the relative error of E1.
        np.testing.assert_allclose(sigma[1], SERIES_SLOPES[0] / SERIES_SLOPES[1] * sigma[0], rtol=0.15)
        self.assert_branch(branch, 0.6, 30, 0.005)

    def test_hold_determines_the_level_beside_markers(self):
        statics = [static_case("pull", "top", STRETCH, 1.04 * FORCE, 0.05 * FORCE)]
        logs, sigma, branch = self.fit(branches=((0.6, 30.0),), statics=statics, marker=(MIDDLE, 0.002 * STRETCH))
        np.testing.assert_array_less(np.abs(logs), 0.005)
        np.testing.assert_array_less(sigma, 0.015)
        self.assert_branch(branch, 0.6, 30, 0.005)


if __name__ == "__main__":
    unittest.main()

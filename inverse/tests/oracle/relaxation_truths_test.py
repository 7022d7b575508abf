"""`aspic fit` on ramp-and-hold and creep tests of a bar of a generalized Maxwell solid, by closed forms.

With Poisson's ratio 0 the bar is uniaxial, and a Maxwell branch with the shear modulus ratio G of a material with the
shear modulus G = E / 2 has Young's modulus ratio E: E(t) = E (1 + sum of ratio exp(-t / tau)).

usage: ASPIC=path/to/aspic relaxation_truths_test.py. Exit code 77: NumPy is missing."""
import base64
import csv
import json
import os
import pathlib
import subprocess
import sys
import re
import struct
import tempfile
import unittest
import zlib

try:
    import numpy as np
    import scipy  # noqa: F401  (capture_truths)
except ImportError:
    sys.exit(77)
import capture_truths as truths

YOUNG, LENGTH, SIDE, STRAIN, RAMP, END = 2e4, 0.04, 0.01, 1e-3, 0.5, 300.0
TWO = ((0.5, 1.5), (0.8, 40.0))  # ratio, relaxation time [s]

SETTINGS = """version = 1
mesh = "rest.msh"
fixed = "z < 1e-6"
order = 1
steady = "history"
"""
GRIPPED = """forces = "load.csv"
[[grip]]
name = "top"
where = "z > 0.04 - 1e-6"
"""

SCENE = """gravity = [0, 0, 0]
[time]
integrator = "quasi_static"
step = {step}
duration = {end}
[solver]
tolerance = 1e-10
[output]
vtu = false
usd = false
report = false
[[body]]
name = "bar"
mesh = "data/rest.msh"
material = {{ file = "material.vtu" }}
[[body.pin]]
where = "z < 1e-6"
[[body.pin]]
name = "top"
where = "z > 0.04 - 1e-6"
motion = {{ keyframes = [{{ time = 0, displacement = [0, 0, 0] }}, {{ time = {ramp}, displacement = [0, 0, {move}] }},
    {{ time = {end}, displacement = [0, 0, {move}] }}] }}
"""


def cell_field(vtu, name):
    """The numbers of a field of a compressed VTU with one block."""
    data = re.search(rf'Name="{name}"[^>]*>\s*(\S+)', vtu)[1]
    head = data.index("==") + 2
    raw = zlib.decompress(base64.b64decode(data[head:]))
    return np.array(struct.unpack(f"<{len(raw) // 8}d", raw))


def ramp_force(t, branches):
    """The convolution of E(t) with the rate of a ramp that ends at RAMP, integrated by hand."""
    start = np.maximum(t - RAMP, 0)
    response = t - start + sum(g * tau * (np.exp(-start / tau) - np.exp(-t / tau)) for g, tau in branches)
    return SIDE ** 2 * YOUNG * STRAIN / RAMP * response


def write_bar(folder, cells=(1, 1, 2)):
    folder.mkdir()
    X, tets = truths.kuhn_box((SIDE, SIDE, LENGTH), cells)
    truths.write_gmsh(folder / "rest.msh", X, tets, np.ones(len(tets), int))
    return X


def write_hold(folder, branches, noise, seed, samples=3000, scale=1):
    """Uniform samples of the force, as a testing machine writes them."""
    X = write_bar(folder)
    t = np.linspace(0, END, samples + 1)[1:]
    t = np.sort(np.concatenate([t, np.linspace(0, 2, 201)[1:]]))
    t = np.unique(t)
    force = scale * ramp_force(t, branches)
    force += noise * force.max() * np.random.default_rng(seed).normal(size=len(t))
    (folder / "capture.toml").write_text(SETTINGS + GRIPPED)
    truths.write_table(folder / "load.csv", [{"time": float(a), "force": float(f)} for a, f in zip(t, force)])
    truths.write_table(folder / "markers.csv", [{"marker": "A", "vertex": len(X) - 1}])
    rows = [("start", 0.0, 0.0), ("peak", RAMP, STRAIN * LENGTH), ("end", END, STRAIN * LENGTH)]
    truths.write_table(folder / "cases.csv", [
        {"case": name, "group": "hold", "time": time, "grip": "top", "move_x": 0.0, "move_y": 0.0, "move_z": move}
        for name, time, move in rows])


SLOW = ((0.6, 600.0),)  # the hold ends long before the body is relaxed


def add_static_pull(folder, error, sd, relaxes=True):
    """Adds a case after complete relaxation, whose force has the relative error and standard deviation; without the rest
    unless the bar relaxes."""
    path = folder / "cases.csv"
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file)) if relaxes else []
    force = SIDE ** 2 * YOUNG * STRAIN
    rows.append({"case": "pull", "group": "pull", "time": "", "grip": "top", "move_x": 0.0, "move_y": 0.0,
                 "move_z": STRAIN * LENGTH, "force_z": (1 + error) * force, "force_sd_z": sd * force,
                 **{f"force{part}_{a}": v for a in "xy" for part, v in (("", 0.0), ("_sd", force))}})
    truths.write_table(path, rows)
    if not relaxes:
        (folder / "load.csv").unlink()
        settings = (folder / "capture.toml").read_text()
        (folder / "capture.toml").write_text(re.sub("(steady|forces) = .*\n", "", settings))


def write_creep(folder, ratio, tau, noise, seed, count=28, has_static_end=False):
    """A sudden dead load: strain = load / E (1 - ratio / (1 + ratio) exp(-t / (tau (1 + ratio)))), at `count` times. The
    end: a static case after complete creep."""
    write_bar(folder)
    (folder / "capture.toml").write_text(SETTINGS + '[[patch]]\nname = "top"\nwhere = "z > 0.04 - 1e-6"\n')
    corners = np.array([(x, y, LENGTH) for x in (0, SIDE) for y in (0, SIDE)])
    truths.write_table(folder / "markers.csv",
                       [{"marker": m, **dict(zip("xyz", map(float, p)))} for m, p in enumerate(corners)])
    times = np.concatenate([[0], 0.2 * 1.25 ** np.arange(count)])
    random = np.random.default_rng(seed)
    strain = STRAIN * (1 - ratio / (1 + ratio) * np.exp(-times / (tau * (1 + ratio))))
    states = [(f"t{k}", "creep", float(t), e) for k, (t, e) in enumerate(zip(times, strain))]
    states += [("end", "end", "", STRAIN)] * has_static_end
    sd = noise * STRAIN * LENGTH
    truths.write_table(folder / "cases.csv", [
        {"case": name, "group": group, "time": t, "dead_pressure": -YOUNG * STRAIN, "patch": "top"}
        for name, group, t, _ in states])
    truths.write_table(folder / "positions.csv", [
        {"case": name, "marker": m, "x": float(p[0]), "y": float(p[1]),
         "z": float(LENGTH * (1 + e) + sd * random.normal()), "sd": sd}
        for name, _, _, e in states for m, p in enumerate(corners)])


class Relaxation(unittest.TestCase):
    def simulated_forces(self, folder):
        """Times and forces of `aspic run` with the written material and branches."""
        (folder / "scene.toml").write_text(SCENE.format(step=RAMP / 2, ramp=RAMP, end=END, move=STRAIN * LENGTH) + self.scene)
        done = subprocess.run([os.environ["ASPIC"], "run", "scene.toml", "--out", "run", "--quiet"], cwd=folder,
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        with open(folder / "run" / "steps.csv", newline="") as file:
            rows = [row for row in csv.DictReader(file) if row["step"] != "0"]
        return (np.array([float(row["time"]) for row in rows]), np.array([float(row["reaction_bar.top_z"]) for row in rows]))

    def fit(self, write, options="", code=0, arguments=(), simulates=False):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            write(folder / "data")
            (folder / "options.toml").write_text("cross_validation = false\nmesh_errors = false\n" + options)
            arguments = arguments or ("--unknown", "young=uniform", "--known", "poisson=0")
            done = subprocess.run([os.environ["ASPIC"], "fit", "data", *arguments, "--options", "options.toml"], cwd=folder,
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            self.output = done.stdout + done.stderr
            if code == 2:
                return None
            results = folder / "material.fit"
            self.scene = (results / "viscoelastic.toml").read_text() if (results / "viscoelastic.toml").exists() else ""
            vtu = (folder / "material.vtu").read_text()
            self.young = cell_field(vtu, "young")
            self.deviation = cell_field(vtu, "young_deviation") if "young_deviation" in vtu else None
            self.curves = (results / "relaxation.csv").read_text() if (results / "relaxation.csv").exists() else ""
            if simulates:
                self.times, self.forces = self.simulated_forces(folder)
            return json.loads((results / "figures.json").read_text())

    def log_young(self, figures):
        """Logarithm of the fitted over the true long-term modulus, and its standard deviation."""
        young = figures["values"]["young"]["everywhere"]
        return np.log(young["value"] / YOUNG), np.log(young["upper"] / young["lower"]) / 2 / 1.96

    def assert_inside(self, interval, truth):
        self.assertLess(interval["lower"], truth)
        self.assertGreater(interval["upper"], truth)

    def test_ramp_and_hold_has_two_relaxation_times(self):
        for seed in (1, 2, 3):
            figures = self.fit(lambda folder: write_hold(folder, TWO, 0.005, seed))
            found = figures["relaxation"]["branches"]
            self.assertEqual(len(found), 2, self.output)
            for branch, (ratio, tau) in zip(found, TWO):
                self.assertAlmostEqual(branch["ratio"] / ratio, 1, delta=0.03)
                self.assertAlmostEqual(branch["relaxation_time"] / tau, 1, delta=0.03)
            young = figures["values"]["young"]["everywhere"]
            self.assertAlmostEqual(young["value"] / YOUNG, 1, delta=0.01)
            self.assert_inside(young, YOUNG)
            self.assertEqual(self.scene.count("[[body.viscoelastic]]"), 2)

    def test_hold_that_ends_early_corrects_the_stiffness(self):
        # The last force is far above the long-term one.
        slow = ((0.6, 150.0),)
        figures = self.fit(lambda folder: write_hold(folder, slow, 0.002, 1), "branches = 1\n")
        self.assertAlmostEqual(figures["values"]["young"]["everywhere"]["value"] / YOUNG, 1, delta=0.02)
        self.assert_inside(figures["values"]["young"]["everywhere"], YOUNG)
        self.assert_inside(figures["relaxation"]["branches"][0]["time_interval"], 150)

    def test_outputs_have_one_stiffness(self):
        # The body still relaxes at the end, where its force is 8 % above the long-term one.
        slow = ((0.6, 150.0),)
        figures = self.fit(lambda folder: write_hold(folder, slow, 0.002, 1), "branches = 1\n", simulates=True)
        value = figures["values"]["young"]["everywhere"]
        np.testing.assert_allclose(self.young, value["value"], rtol=1e-12)
        np.testing.assert_allclose(self.deviation, np.log(value["upper"] / value["lower"]) / 2 / 1.96, rtol=1e-3)
        self.assertIn(f"the stiffness above includes their factor {figures['relaxation']['scale']['value']:.4g}", self.output)
        self.assertIn("viscoelastic.toml", self.output)
        # The table of cases: the mean force of the last tenth of the hold, of the relaxing body.
        response, = (case["response"] for case in figures["cases"])
        end = ramp_force(np.linspace(0.9 * END, END, 101), slow).mean()
        self.assertAlmostEqual(response["fitted"] / end, 1, delta=0.002)
        self.assertGreater(figures["squares"], 1e-3)  # not that of a first fit of one force by one value
        # A simulation with the written files has the forces of the closed form, at the peak and at the end.
        for time in (RAMP, 10.0, END):
            k = np.abs(self.times - time).argmin()
            self.assertAlmostEqual(self.forces[k] / ramp_force(self.times[k:k + 1], slow)[0], 1, delta=0.005)

    def test_static_case_beside_a_history_counts_as_an_independent_reading(self):
        fits = {}
        for name, has_hold, has_pull in (("hold", True, False), ("pull", False, True), ("both", True, True)):
            def write(folder):
                write_hold(folder, SLOW, 0.002, 1)
                if has_pull:
                    add_static_pull(folder, 0.001, 0.002, has_hold)
            fits[name] = self.fit(write, "branches = 1\n" if has_hold else "")
        branch = fits["both"]["relaxation"]["branches"][0]
        self.assertAlmostEqual(branch["ratio"] / SLOW[0][0], 1, delta=0.02)
        self.assertAlmostEqual(branch["relaxation_time"] / SLOW[0][1], 1, delta=0.02)
        self.assert_inside(branch["ratio_interval"], SLOW[0][0])
        self.assert_inside(branch["time_interval"], SLOW[0][1])
        # Both determine the long-term modulus independently: its logarithm has the weighted mean, and the sum of weights.
        found = {name: self.log_young(figures) for name, figures in fits.items()}
        self.assertGreater(found["hold"][1], 2 * found["both"][1])
        weights = np.array([found[name][1] ** -2 for name in ("hold", "pull")])
        mean = weights @ [found[name][0] for name in ("hold", "pull")] / weights.sum()
        self.assertAlmostEqual(found["both"][1] * weights.sum() ** 0.5, 1, delta=0.03)
        self.assertLess(abs(found["both"][0] - mean), 0.1 * found["both"][1])
        self.assertLess(abs(found["both"][0]), 1.96 * found["both"][1])

    def test_contradiction_of_static_case_and_history_is_not_good(self):
        def write(folder):
            write_hold(folder, ((0.6, 150.0),), 0.002, 1)
            add_static_pull(folder, 0.05, 0.002)
        figures = self.fit(write, "branches = 1\n", code=3)
        self.assertIn("group_missed", [reason["name"] for reason in figures["verdict"]["reasons"]])

    def test_static_motion_completes_a_short_creep_test(self):
        found = {}
        for has_end in (False, True):
            figures = self.fit(lambda folder: write_creep(folder, 0.6, 5.0, 0.005, 1, 14, has_end))
            found[has_end] = self.log_young(figures)
            branch, = figures["relaxation"]["branches"]
            self.assert_inside(branch["ratio_interval"], 0.6)
            self.assert_inside(branch["time_interval"], 5)
        self.assertAlmostEqual(branch["relaxation_time"] / 5, 1, delta=0.05)
        self.assertAlmostEqual(branch["ratio"] / 0.6, 1, delta=0.03)
        self.assertGreater(found[False][1], 3 * found[True][1])
        self.assertLess(abs(found[True][0]), min(0.01, 1.96 * found[True][1]))

    def test_given_stiffness_stays(self):
        figures = self.fit(lambda folder: write_hold(folder, ((0.6, 30.0),), 0.002, 1), "branches = 1\n",
                           arguments=("--known", f"young={YOUNG}", "--unknown", "poisson=uniform", "--allow-unconverged"))
        np.testing.assert_allclose(self.young, YOUNG, rtol=1e-12)
        scale = figures["relaxation"]["scale"]
        self.assertEqual((scale["value"], scale["lower"], scale["upper"], scale["known"]), (1, 1, 1, True))
        self.assertIn("with the given stiffness", self.output)
        self.assertAlmostEqual(figures["relaxation"]["branches"][0]["relaxation_time"] / 30, 1, delta=0.03)

    def test_creep_has_curves_of_motion(self):
        figures = self.fit(lambda folder: write_creep(folder, 0.6, 5.0, 0.005, 1))
        curves = figures["relaxation"]["curves"]
        self.assertEqual([(c["name"], c["unit"]) for c in curves], [("creep", "m")] * 3)  # markers with the largest motions
        for curve in curves:
            self.assertRegex(curve["reading"], "motion of marker [0-3]")
            for p in curve["points"]:
                motion = STRAIN * LENGTH * (1 - 0.375 * np.exp(-p["time"] / 8))
                self.assertAlmostEqual(p["measured"], motion, delta=4.5 * p["sd"])
                self.assertAlmostEqual(p["fitted"], motion, delta=0.01 * STRAIN * LENGTH)
        self.assertIn("creep,motion of marker", self.curves)

    def test_creep_of_markers_gives_the_branch(self):
        figures = self.fit(lambda folder: write_creep(folder, 0.6, 5.0, 0.005, 1))
        found = figures["relaxation"]["branches"]
        self.assertEqual(len(found), 1, self.output)
        self.assertAlmostEqual(found[0]["relaxation_time"] / 5, 1, delta=0.03)
        self.assertAlmostEqual(found[0]["ratio"] / 0.6, 1, delta=0.03)
        self.assertAlmostEqual(figures["values"]["young"]["everywhere"]["value"] / YOUNG, 1, delta=0.01)

    def test_hold_without_motion_in_time_is_refused(self):
        def write(folder):
            write_hold(folder, TWO, 0.005, 1)
            rows = (folder / "cases.csv").read_text().splitlines()
            (folder / "cases.csv").write_text("\n".join([rows[0], rows[-1]]) + "\n")
        self.fit(write, code=2)
        self.assertIn("cases.csv:2", self.output)
        self.assertIn("has one time only", self.output)

    def test_histories_need_times(self):
        def write(folder):
            write_hold(folder, TWO, 0.005, 1)
            text = (folder / "cases.csv").read_text()
            (folder / "cases.csv").write_text(text.replace("case,group,time", "case,group,moment"))
        self.fit(write, code=2)
        self.assertIn('steady = "history" needs cases with a time', self.output)


if __name__ == "__main__":
    unittest.main()

"""`aspic fit-motion` against motions from closed recurrences and from runs of the program.

usage: ASPIC=path/to/aspic fit_motion_test.py [CLASS]"""
import csv
import json
import random
import signal
import struct
import unittest

import linear_beam
from command_line import BEAM, CommandLine

STEP, GRAVITY = 0.01, (0.0, -9.81, 0.0)
BALL = """gravity = [0, -9.81, 0]
[time]
step = 0.01
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [1, 1, 1] } }
material = { model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }
"""
CORNERS = {"low": (0.0, 0.0, 0.0), "right": (0.1, 0.0, 0.0), "top": (0.1, 0.1, 0.1)}


def free_flight(velocity, damping, steps):
    """Displacements by backward Euler: v1 = (v0 + h g) / (1 + h a), x1 = x0 + h v1."""
    v, x, displacements = list(velocity), [0.0, 0.0, 0.0], [(0.0, 0.0, 0.0)]
    for _ in range(steps):
        v = [(vi + STEP * g) / (1 + STEP * damping) for vi, g in zip(v, GRAVITY)]
        x = [xi + STEP * vi for xi, vi in zip(x, v)]
        displacements.append(tuple(x))
    return displacements


def rows_of_flight(velocity=(1.2, 3.4, -0.7), damping=1.7, steps=20):
    flight = free_flight(velocity, damping, steps)
    return [(STEP * k, name, *(a + b for a, b in zip(corner, d)))
            for k, d in enumerate(flight) for name, corner in CORNERS.items()]


def table(rows, header="time,marker,x,y,z"):
    return header + "\n" + "".join(",".join(c if isinstance(c, str) else repr(c) for c in row) + "\n" for row in rows)


def pc2_frames(path):
    """Frames of a point cache: a list of points each."""
    data = path.read_bytes()
    _, _, count, _, _, frames = struct.unpack_from("<12siiffi", data)
    numbers = struct.unpack_from(f"<{3 * count * frames}f", data, 32)
    return [[numbers[3 * (f * count + v):3 * (f * count + v) + 3] for v in range(count)] for f in range(frames)]


class FitMotion(CommandLine):
    def fit(self, scene, positions, names, *arguments, code=0):
        done = self.aspic("fit-motion", scene, positions, "--fit", names, "--json", "--force", *arguments, code=code)
        report = json.loads(done.stdout)
        return report, {p["name"]: p for p in report["parameters"]}

    def test_recovers_damped_flight(self):
        self.write("cube.toml", BALL)
        rows = rows_of_flight()
        middles = [(a[0] + STEP / 2, a[1], *((x + y) / 2 for x, y in zip(a[2:], b[2:])))
                   for a, b in zip(rows[3:], rows[6:])]  # positions are linear between two time steps
        rows += middles
        self.write("flight.csv", table(rows[::-1]))
        report, found = self.fit("cube.toml", "flight.csv", "velocity,mass_damping", "-o", "fit")
        expected = {"velocity_x": 1.2, "velocity_y": 3.4, "velocity_z": -0.7, "mass_damping": 1.7}
        for name, value in expected.items():
            self.assertAlmostEqual(found[name]["value"], value, delta=1e-6, msg=name)
            self.assertTrue(found[name]["determined"], name)
            self.assertLess(found[name]["deviation"], 1e-6)
        self.assertLess(report["rms_after"], 1e-9)
        self.aspic("run", "fit/fitted.toml", "--steps", "3")
        with open(self.folder / "fit/residuals.csv", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), len(rows) - len(CORNERS))

    def test_other_elastic_constants_are_kept_or_replaced(self):
        self.write("cube.toml", BALL)
        self.write("flight.csv", table(rows_of_flight(damping=0, steps=3)))
        lame = ("--set", "material.lambda=1e5", "material.mu=5e4")
        for name, expected in (("density", "lambda = 1e+05, mu = 50000.0"), ("young", "poisson = 0.3333")):
            self.fit("cube.toml", "flight.csv", name + ",velocity", "-o", name, *lame)
            self.assertIn(expected, (self.folder / name / "fitted.toml").read_text())

    def run_of_beam(self, scene="beam.toml", *overrides):
        """Marker rows of a run with other values, from its point cache."""
        self.aspic("run", scene, "--out", "truth", "--force", "--quiet", "--set", *overrides)
        frames = pc2_frames(next((self.folder / "truth/skins").glob("*.pc2")))
        markers = [v for v, x in enumerate(frames[0]) if x[0] > 0.19]
        return [(STEP * k, f"m{v}", *(float(c) for c in frame[v])) for k, frame in enumerate(frames) for v in markers]

    def test_recovers_material_and_damping_of_beam(self):
        self.beam(duration=0.3, cells="6, 2, 2")
        self.write("swing.csv", table(self.run_of_beam("beam.toml", "material.young=1.6e5", "damping.mass=3")))
        report, found = self.fit("beam.toml", "swing.csv", "young,mass_damping", "-o", "fit")
        self.assertAlmostEqual(found["young"]["value"], 1.6e5, delta=1.6e3)
        self.assertAlmostEqual(found["mass_damping"]["value"], 3, delta=0.03)
        self.assertAlmostEqual(found["young"]["guess"], 1e5, delta=1e-9 * 1e5)
        self.assertLess(report["rms_after"], 1e-3 * report["rms_before"])
        self.aspic("run", "fit/fitted.toml", "--out", "again", "--quiet")
        frames = [pc2_frames(next((self.folder / run / "skins").glob("*.pc2"))) for run in ("truth", "again")]
        distance = max(abs(a - b) for one, other in zip(*frames) for x, y in zip(one, other) for a, b in zip(x, y))
        self.assertLess(distance, 1e-5)

    def test_scales_material_of_unlike_tets(self):
        field = BEAM.format(duration=0.15, cells="4, 2, 2").replace("young = 1e5", 'young = "1e5 * (1 + X)"')
        self.write("field.toml", field)
        self.write("stiff.toml", field.replace("1e5 *", "1.3e5 *"))
        self.write("swing.csv", table(self.run_of_beam("stiff.toml", "damping.mass=0")))
        _, found = self.fit("field.toml", "swing.csv", "young", "-o", "fit")
        self.assertAlmostEqual(found["young"]["value"] / found["young"]["guess"], 1.3, delta=1e-4)
        self.assertIn("material.vtu", (self.folder / "fit/fitted.toml").read_text())
        self.aspic("run", "fit/fitted.toml", "--out", "again", "--quiet")

    def test_reports_undetermined_parameters(self):
        self.write("cube.toml", BALL)
        self.write("flight.csv", table(rows_of_flight(damping=0)))
        _, found = self.fit("cube.toml", "flight.csv", "young,density,velocity", "-o", "fit")
        for name in ("young", "density"):
            self.assertFalse(found[name]["determined"])
            self.assertIsNone(found[name]["deviation"])
        text = self.aspic("fit-motion", "cube.toml", "flight.csv", "--fit", "young", "-o", "text").stdout
        self.assertRegex(text, r"young .* not determined")

    def test_stated_sigma_gives_standard_deviation(self):
        self.write("cube.toml", BALL)
        rows = rows_of_flight(damping=0, steps=4)
        self.write("flight.csv", table([(*row, 1e-3) for row in rows], "time,marker,x,y,z,sigma"))
        report, found = self.fit("cube.toml", "flight.csv", "velocity", "-o", "fit")
        expected = 1e-3 / sum(3 * (STEP * k) ** 2 for k in range(1, 5)) ** 0.5
        self.assertAlmostEqual(found["velocity_x"]["deviation"], expected, delta=1e-5 * expected)
        self.assertLess(report["chi_squared"], 1e-12)
        rows = rows_of_flight(damping=3, steps=9)  # a damping that the fit does not model
        self.write("damped.csv", table([(*row, 1e-5) for row in rows], "time,marker,x,y,z,sigma"))
        text = self.aspic("fit-motion", "cube.toml", "damped.csv", "--fit", "velocity", "-o", "damped").stdout
        self.assertRegex(text, r"residuals are [1-9].* times the stated sigma")

    def test_is_bit_reproducible_for_any_threads(self):
        self.beam(duration=0.1)
        self.write("swing.csv", table(self.run_of_beam("beam.toml", "material.young=1.2e5")))
        for threads in ("1", "2"):
            self.fit("beam.toml", "swing.csv", "young,velocity", "-o", threads, "--threads", threads)
        for name in ("fit.json", "fitted.toml", "residuals.csv"):
            self.assertEqual((self.folder / "1" / name).read_bytes(), (self.folder / "2" / name).read_bytes(), name)


class FitMotionSwing(CommandLine):
    """Against the swings of an independent program."""

    SWING = """gravity = [0, 0, -0.4]
[time]
step = 0.01
[[body]]
name = "beam"
shape = { box = { upper = [0.2, 0.05, 0.05], cells = [2, 1, 1] } }
material = { model = "linear", young = 4e4, poisson = 0.3, density = 800 }
damping = { mass = 1 }
[[body.pin]]
where = "x < 1e-9"
"""

    def test_noisy_swings_give_density_and_damping(self):
        self.write("beam.toml", self.SWING)
        vertices, positions = linear_beam.swing((0.2, 0.05, 0.05), (2, 1, 1), (4e4, 0.3, 1000, 3.0), (0, 0, -0.4), 0.01, 60)
        noise, ends = random.Random(1), [v for v, x in enumerate(vertices) if x[0] > 0.19]
        size = max(abs(a - b) for x, X in zip(positions[20], vertices) for a, b in zip(x, X))
        rows = [(k * 0.01, f"m{v}", *(float(c + (0.002 * size * noise.gauss(0, 1) if k else 0)) for c in frame[v]))
                for k, frame in enumerate(positions) for v in ends]
        self.write("swing.csv", table(rows))
        done = self.aspic("fit-motion", "beam.toml", "swing.csv", "--fit", "density,mass_damping", "--json", "-o", "fit")
        found = {p["name"]: p for p in json.loads(done.stdout)["parameters"]}
        self.assertAlmostEqual(found["density"]["value"], 1000, delta=10)
        self.assertAlmostEqual(found["mass_damping"]["value"], 3, delta=0.1)
        for name, truth in (("density", 1000), ("mass_damping", 3)):
            self.assertLess(abs(found[name]["value"] - truth), 4 * found[name]["deviation"] + 2e-3 * truth, name)


class FitMotionErrors(CommandLine):
    def setUp(self):
        super().setUp()
        self.write("cube.toml", BALL)
        self.rows = rows_of_flight(steps=3)

    def refused(self, message, rows=None, *arguments, header="time,marker,x,y,z", names="velocity", scene="cube.toml"):
        self.write("bad.csv", table(self.rows if rows is None else rows, header))
        error = self.aspic("fit-motion", scene, "bad.csv", "--fit", names, *arguments, code=2).stderr
        self.assertIn(message, error)
        self.assertFalse((self.folder / "out").exists(), message)

    def test_hostile_tables(self):
        row = self.rows[-1]
        self.refused("bad.csv:1: unknown column 'X'", header="time,marker,X,y,z")
        self.refused("bad.csv:1: the column 'z' is missing", [r[:4] for r in self.rows], header="time,marker,x,y")
        self.refused("has no rows below the header", [])
        self.refused("bad.csv:14: marker 'top' at time 0.03 is in line 13 already", self.rows[:11] + [row, row])
        for text in ("nan", "inf", "", "1e999", "two"):
            self.refused("is no finite number", self.rows + [(0.5, "top", text, 0.1, 0.1)])
        self.refused("bad.csv:14: time = -0.5 is before the start", self.rows + [(-0.5, "top", 0.1, 0.1, 0.1)])
        self.refused("more than 1e6 time steps", self.rows + [(1e300, "top", 0.1, 0.1, 0.1)])
        self.refused("marker is blank", self.rows + [(0.5, "", 0.1, 0.1, 0.1)])
        self.refused("marker 'new' has no row at the start", self.rows + [(0.01, "new", 0.1, 0.1, 0.1)])
        self.refused("has no rows after the start", self.rows[:3])
        self.refused("off the surface of the body", [(0.0, "top", 0.1, 0.3, 0.1), (0.01, "top", 0.1, 0.3, 0.1)])
        self.refused("seem to be in mm", [(t, m, 1e3 * x, 1e3 * y, 1e3 * z) for t, m, x, y, z in self.rows])
        for sigma in (0.0, -1.0):
            self.refused("a standard deviation must be > 0", [(*r, sigma) for r in self.rows],
                         header="time,marker,x,y,z,sigma")
        self.refused("", [(*r, 1) for r in self.rows])  # more cells than columns

    def test_hostile_arguments(self):
        self.refused("unknown parameter 'yuong' (did you mean 'young'?)", names="yuong")
        self.refused("is given twice", names="velocity,velocity")
        self.refused("--set time.integrator=backward_euler", None, "--set", "time.integrator=bdf2")
        self.refused("velocity is a formula", None, "--set", 'velocity=["X", 0, 0]')
        self.refused("has 2 bodies", scene=self.write("two.toml", BALL + BALL[BALL.index("[[body]]"):].replace(
            '"cube"', '"other"')))
        scene = self.write("creep.toml", BALL + "[[body.viscoelastic]]\nratio = 1\nrelaxation_time = 1\n")
        self.refused(f"creep.toml:{BALL.count(chr(10)) + 1}", scene=scene)
        self.refused("it has 'viscoelastic'; remove it", scene=scene)
        self.refused("the body has no elasticity", None, "--set", "elastic=false", names="young")
        self.refused("--time-limit", None, "--time-limit", "nan")
        self.assertIn("--fit", self.aspic("fit-motion", "cube.toml", "bad.csv", code=2).stderr)
        self.assertIn("none.csv", self.aspic("fit-motion", "cube.toml", "none.csv", "--fit", "young", code=2).stderr)
        self.assertIn("walk.trc: is a recording of another program; it is converted by: python3 -m aspic.recordings 'walk.trc' 'walk.csv'",
                      self.aspic("fit-motion", "cube.toml", "walk.trc", "--fit", "young", code=2).stderr)

    def test_keeps_results_without_force(self):
        self.write("flight.csv", table(self.rows))
        self.aspic("fit-motion", "cube.toml", "flight.csv", "--fit", "velocity")
        self.assertIn("--force", self.aspic("fit-motion", "cube.toml", "flight.csv", "--fit", "velocity", code=2).stderr)
        self.aspic("fit-motion", "cube.toml", "flight.csv", "--fit", "velocity", "--force")

    def test_time_limit_ends_fit(self):
        self.beam(cells="24, 6, 6")
        self.write("long.csv", table([(0.0, "m", 0.4, 0.1, 0.1), (50.0, "m", 0.4, 0.0, 0.1)]))
        self.aspic("fit-motion", "beam.toml", "long.csv", "--fit", "young", "--time-limit", "0.3", code=4)

    def test_signal_ends_fit(self):
        self.beam(cells="24, 6, 6")
        self.write("long.csv", table([(0.0, "m", 0.4, 0.1, 0.1), (50.0, "m", 0.4, 0.0, 0.1)]))
        process = self.start("fit-motion", "beam.toml", "long.csv", "--fit", "mass_damping")
        process.stderr.readline()  # the note about the guess, after which signals are caught
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=60)
        self.assertIn(process.returncode, (130, -signal.SIGINT))  # the latter if the handler is not installed yet

    def test_failed_simulation_is_reported(self):
        self.write("flight.csv", table(self.rows))
        scene = BALL.replace("neo_hookean", "neo_hookean_log") + "deform = { matrix = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]] }\n"
        self.write("inverted.toml", scene)
        done = self.aspic("fit-motion", "inverted.toml", "flight.csv", "--fit", "young", code=3)
        self.assertIn("the motion of the guess failed: the step from 0 s", done.stderr)
        self.assertFalse((self.folder / "out/inverted_motion/fitted.toml").exists())


if __name__ == "__main__":
    unittest.main()

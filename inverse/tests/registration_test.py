#!/usr/bin/env python3
"""`aspic fit` with markers in other coordinates than the mesh, and with forces from a time series: each must reach the figures of
the same measurements as tables.

usage: ASPIC=path/to/aspic registration_test.py [CLASS]"""
import atexit
import csv
import functools
import json
import math
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

from command_line import ASPIC, CommandLine

CUBE = """gravity = [0, 0, 0]
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [4, 4, 4] } }
material = { model = "neo_hookean", young = 3e4, poisson = 0.4 }
[[body.pin]]
where = "Z < 1e-6"
"""
QUICK = "mesh_errors = false\nuncertainty = false\ncross_validation = false\n"
FIT = ("--options", "quick.toml", "--unknown", "young=uniform", "--known", "poisson=0.4", "--allow-unconverged", "--force")


@functools.cache
def measured():
    """A data set as tables, created once."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_registration_"))
    atexit.register(shutil.rmtree, folder)
    (folder / "cube.toml").write_text(CUBE)
    subprocess.run([ASPIC, "capture", "cube.toml", "-o", "data", "--pokes", "2", "--depths", "2", "--markers", "15", "--tip",
                    "disc:0.02", "--quiet"], cwd=folder, check=True, timeout=120)
    return folder / "data"


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def set_cells(path, columns):
    """Adds columns {name: values} to a table."""
    rows = rows_of(path)
    for name, values in columns.items():
        for row, value in zip(rows, values):
            row[name] = value
    with open(path, "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0])
        writer.writeheader()
        writer.writerows(rows)


class Measured(CommandLine):
    """A copy of the data set, and its positions per frame [mm]: at rest, then in each case."""

    def setUp(self):
        super().setUp()
        self.data = self.folder / "data"
        shutil.copytree(measured(), self.data)
        self.write("quick.toml", QUICK)
        self.cases = [row["case"] for row in rows_of(self.data / "cases.csv")]
        self.rest = self.positions_at_rest()
        self.names = list(self.rest)
        moved = {case: {} for case in self.cases}
        for row in rows_of(self.data / "positions.csv"):
            moved[row["case"]][row["marker"]] = self.in_mm(row)
        self.frames = [self.rest] + [moved[case] for case in self.cases]

    @staticmethod
    def in_mm(row):
        return tuple(1000 * float(row[axis]) for axis in "xyz")

    def positions_at_rest(self):
        """From corners and weights of the markers in the mesh of the data set."""
        text = (self.data / "rest.msh").read_text()
        nodes = [tuple(map(float, line.split()[1:]))
                 for line in re.search(r"\$Nodes\n\d+\n(.*?)\$EndNodes", text, re.S)[1].strip().split("\n")]
        rest = {}
        for row in rows_of(self.data / "markers.csv"):
            corners = [nodes[int(row[f"corner_{i}"])] for i in (1, 2, 3)]
            weights = [float(row[f"weight_{i}"]) for i in (1, 2, 3)]
            rest[row["marker"]] = tuple(1000 * sum(w * X[axis] for w, X in zip(weights, corners)) for axis in range(3))
        return rest

    def use(self, rest, frames):
        """Replaces markers and positions of the cases [mm]."""
        sd = rows_of(self.data / "positions.csv")[0]["sd_x"]
        self.write("data/capture.toml", f"deviation = {{ position = {sd} }}\n" + (self.data / "capture.toml").read_text())
        cells = lambda p: ",".join(repr(x / 1000) for x in p)
        self.write("data/markers.csv", "marker,x,y,z\n" + "".join(f"{name},{cells(p)}\n" for name, p in rest.items()))
        self.write("data/positions.csv", "case,marker,x,y,z\n" + "".join(
            f'"{case}",{name},{cells(p)}\n' for case, frame in zip(self.cases, frames) for name, p in frame.items()))

    def fit(self, *arguments, code=0):
        done = self.aspic("fit", "data", *FIT, *arguments, code=code)
        return done, json.loads((self.folder / "material.fit/figures.json").read_text())

    def young(self, *arguments):
        return self.fit(*arguments)[1]["values"]["young"]["everywhere"]["value"]


class Registration(Measured):
    """Markers in other coordinates than the mesh, and back."""

    def setUp(self):
        super().setUp()
        self.reference = self.young()

    def moved(self, points):
        """Turned by 90 degrees about x and by 30 about z, shifted by (100, -200, 300) mm."""
        result = {}
        for name, (x, y, z) in points.items():
            y, z = -z, y
            c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
            result[name] = (c * x - s * y + 100, s * x + c * y - 200, z + 300)
        return result

    def use_moved(self):
        rest, *frames = map(self.moved, self.frames)
        self.use(rest, frames)

    def test_pairs_are_registered_and_reused(self):
        self.use_moved()
        self.assertIn("off the surface", self.aspic("fit", "data", *FIT, code=2).stderr)
        corners = [0, 3, 12]
        nodes = [tuple(float(x) for x in line.split()[1:]) for line in
                 (self.data / "rest.msh").read_text().split("$Nodes\n")[1].split("\n")[1:]
                 if len(line.split()) == 4]
        at = self.moved({i: [1000 * x for x in nodes[i]] for i in corners})
        self.write("data/markers.csv", "marker,vertex,x,y,z\n" + "".join(
            f"corner {i},{i},{at[i][0] / 1000!r},{at[i][1] / 1000!r},{at[i][2] / 1000!r}\n" for i in corners) + "".join(
                f"{name},,{x / 1000!r},{y / 1000!r},{z / 1000!r}\n" for name, (x, y, z) in self.moved(self.rest).items()))
        done, figures = self.fit("--register", "rigid")
        self.assertIn("registration of 3 points", done.stdout)
        young = figures["values"]["young"]["everywhere"]["value"]
        self.assertAlmostEqual(young / self.reference, 1, delta=1e-6)
        shutil.copy(self.folder / "material.fit/registration.toml", self.data)
        self.write("data/capture.toml",
                   'registration = "registration.toml"\n' + (self.data / "capture.toml").read_text())
        self.assertAlmostEqual(self.young() / young, 1, delta=1e-9)
        self.assertIn("remove the key", self.aspic("fit", "data", *FIT, "--register", "rigid", code=2).stderr)

    def test_collinear_markers_are_reported(self):
        self.names = self.names[:3]
        line = {name: (10.0 + 30 * i, 50.0, 100.0) for i, name in enumerate(self.names)}
        self.use(line, [line] * len(self.cases))
        said = self.aspic("check", "data", "--register", "rigid").stdout
        self.assertIn("the points lie on a line: the rotation about it is not determined", said)


class Forces(Measured):
    """Force from a time series instead of the table of cases."""

    def setUp(self):
        super().setUp()
        self.reference = self.young()
        self.forces = [[float(row[f"force_{axis}"]) for axis in "xyz"] for row in rows_of(self.data / "cases.csv")]
        sd = rows_of(self.data / "cases.csv")[0]["force_sd_x"]
        blank = [""] * len(self.cases)
        set_cells(self.data / "cases.csv", {f"force_{axis}": blank for axis in "xyz"} |
                  {f"force_sd_{axis}": blank for axis in "xyz"} | {"time": [2 * k + 1.5 for k in range(len(self.cases))]})
        self.write("data/capture.toml", f'forces = "load.csv"\ndeviation = {{ force = {sd} }}\n' +
                   (self.data / "capture.toml").read_text())
        self.series(lambda t: 0.0)

    def series(self, noise):
        """Each force is held for a second, after a linear ramp of a second from the last one."""
        rows = ["time,force_x,force_y,force_z"]
        for i in range(200 * len(self.cases)):
            t = i / 100
            k, part = int(t // 2), min(t % 2, 1)
            last = self.forces[k - 1] if k > 0 else [0, 0, 0]
            rows.append(f"{t}," + ",".join(repr(a + part * (b - a) + noise(t)) for a, b in zip(last, self.forces[k])))
        self.write("data/load.csv", "\n".join(rows) + "\n")

    def test_steady_forces_reach_the_figures_of_the_table(self):
        done, figures = self.fit()
        self.assertAlmostEqual(figures["values"]["young"]["everywhere"]["value"] / self.reference, 1, delta=1e-9)
        self.assertRegex(done.stdout, r"note: .*cases.csv:2: force of load.csv at 1.5 s: steady within .* N from 1\.\d+ s to 1\.\d+ s")

    def test_noise_averages_out(self):
        self.series(lambda t: 0.05 * math.sin(3700 * t))
        self.assertAlmostEqual(self.young() / self.reference, 1, delta=1e-3)

    def test_ramps_are_refused_with_their_remedy(self):
        set_cells(self.data / "cases.csv", {"time": [0.5, 3.5, 5.5, 7.5]})
        said = self.aspic("fit", "data", *FIT, code=2).stderr
        self.assertRegex(said, r"cases.csv:2: time = 0.5 s: not steady: the force stays within .* only from .* s; the nearest "
                               r"steady state is at (0\.99|1)")
        self.write("data/capture.toml", 'steady = "off"\n' + (self.data / "capture.toml").read_text())
        self.aspic("check", "data")

    def test_times_outside_the_series_are_refused(self):
        set_cells(self.data / "cases.csv", {"time": [99, 3.5, 5.5, ""]})
        said = self.aspic("fit", "data", *FIT, code=2).stderr
        self.assertIn("time = 99 s is not in load.csv, which lasts from 0 s to 7.99 s", said)
        self.assertIn("force and time are blank; the time selects the force in load.csv", said)


if __name__ == "__main__":
    unittest.main()

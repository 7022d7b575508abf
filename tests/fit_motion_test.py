"""`aspic fit-motion` against motions from closed recurrences and from runs of the program.

usage: ASPIC=path/to/aspic fit_motion_test.py"""
import csv
import json
import struct
import unittest

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


if __name__ == "__main__":
    unittest.main()

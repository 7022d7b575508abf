"""`aspic modes` against linear elasticity assembled and solved here with dense matrices.

usage: ASPIC=path/to/aspic modes_test.py. Exit code 77: the package numpy is missing."""
import csv
import json
import os
import sys
import unittest

try:
    import numpy
except ImportError:
    sys.exit(77)
from command_line import BEAM, CommandLine, box_mesh

YOUNG, POISSON, DENSITY = 2e5, 0.3, 900.0
SCENE = f"""[[body]]
mesh = "box.mesh"
material = {{ model = "neo_hookean_log", young = {YOUNG}, poisson = {POISSON}, density = {DENSITY} }}
"""
HELD = "[[body.pin]]\nwhere = 'x < 0.01'\n"


def read_mesh(text):
    """Points [m] and tets of Medit's format."""
    lines = text.split("\n")
    rows = lambda word, kind: numpy.array([line.split()[:-1] for line in lines[lines.index(word) + 2:][
        :int(lines[lines.index(word) + 1])]], dtype=kind)
    return rows("Vertices", float), rows("Tetrahedra", int) - 1


def matrices(points, tets):
    """The stiffness and the consistent mass matrix of linear tets."""
    mu, lam = YOUNG / (2 * (1 + POISSON)), YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    n = 3 * len(points)
    K, M = numpy.zeros((n, n)), numpy.zeros((n, n))
    for tet in tets:
        edges = points[tet[1:]] - points[tet[0]]
        volume = abs(numpy.linalg.det(edges)) / 6
        gradients = numpy.vstack([numpy.zeros(3), numpy.linalg.inv(edges).T])
        gradients[0] = -gradients.sum(axis=0)
        for a in range(4):
            for b in range(4):
                ga, gb = gradients[a], gradients[b]
                block = lam * numpy.outer(ga, gb) + mu * numpy.outer(gb, ga) + mu * ga.dot(gb) * numpy.eye(3)
                rows, columns = slice(3 * tet[a], 3 * tet[a] + 3), slice(3 * tet[b], 3 * tet[b] + 3)
                K[rows, columns] += volume * block
                M[rows, columns] += DENSITY * volume / 20 * (2 if a == b else 1) * numpy.eye(3)
    return K, M


def frequencies(points, tets, held):
    """All natural frequencies [Hz], ascending; the coordinates `held` are fixed."""
    free = numpy.setdiff1d(numpy.arange(3 * len(points)), held)
    K, M = (A[numpy.ix_(free, free)] for A in matrices(points, tets))
    inverse = numpy.linalg.inv(numpy.linalg.cholesky(M))
    squares = numpy.linalg.eigvalsh(inverse @ K @ inverse.T)
    return numpy.sqrt(numpy.maximum(squares, 0)) / (2 * numpy.pi)


class Modes(CommandLine):
    def compare(self, pins, count, cells=3):
        text = box_mesh(cells)
        self.write("box.mesh", text)
        self.write("box.toml", SCENE + pins)
        found = json.loads(self.aspic("modes", "box.toml", "--json", "--count", str(count), "--force").stdout)
        points, tets = read_mesh(text)
        held = [3 * v + axis for v in numpy.where(points[:, 0] < 0.01)[0] for axis in range(3)] if pins else []
        expected = frequencies(points, tets, held)[:count]
        for mode, reference in zip(found["modes"], expected, strict=True):
            self.assertAlmostEqual(mode["frequency"], reference, delta=1e-7 * expected[-1])
        return found

    def test_held_box_agrees_with_numpy(self):
        self.assertEqual(self.compare(HELD, 12)["rigid"], 0)

    def test_free_box_has_six_rigid_modes(self):
        found = self.compare("", 12)
        self.assertEqual(found["rigid"], 6)
        self.assertEqual([mode["frequency"] for mode in found["modes"]][:6], [0] * 6)

    def test_excess_count_gives_all_modes(self):
        self.assertEqual(len(self.compare("", 1000, cells=1)["modes"]), 24)

    def test_frames_open_as_results(self):
        text = self.aspic("modes", self.beam(), "--count", "3", "--time-limit", "60").stdout
        self.assertEqual(self.aspic("modes", self.beam(), "--count", "3", "--out", "quiet", "-q").stdout, "")
        self.assertRegex(text, r"(?m)^ +3 +\d")
        with open(self.folder / "out/beam_modes/modes.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["mode"] for row in rows], ["1", "2", "3"])
        self.assertEqual(len(list((self.folder / "out/beam_modes/frames").iterdir())), 4)
        self.assertIn("already contains a run", self.aspic("modes", "beam.toml", code=2).stderr)
        self.aspic("report", "out/beam_modes", "-o", "modes.html")
        self.assertIn("Steps are modes",
                      self.aspic("run", "beam.toml", "--out", "out/beam_modes", "--resume", code=2).stderr)

    def test_initial_state_contributes_its_stress(self):
        stretched = BEAM.format(duration=1, cells="8, 2, 2").replace(
            "[[body.pin]]", 'deform = { matrix = [[1.2, 0, 0], [0, 1, 0], [0, 0, 1]] }\n[[body.pin]]')
        self.write("stretched.toml", stretched)
        first = {about: json.loads(self.aspic("modes", "stretched.toml", "--about", about, "--out", about, "--json",
                                              "--count", "1").stdout)["modes"][0]["frequency"]
                 for about in ("rest", "start")}
        self.assertGreater(first["start"], 1.2 * first["rest"])

    def test_bad_input_is_named(self):
        self.beam(extra="[[body.pin]]\nwhere = \"x > 1e-9\"\n")
        self.assertIn("pin fewer vertices", self.aspic("modes", "beam.toml", code=2).stderr)
        self.assertIn("--count", self.aspic("modes", "beam.toml", "--count", "0", code=2).stderr)
        self.assertFalse((self.folder / "out").exists())
        self.assertIn("time limit", self.aspic("modes", self.beam(cells="40, 8, 8"), "--time-limit", "0.001",
                                               code=4).stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

#!/usr/bin/env python3
"""aspic-mesh: its files, messages and exit codes."""
import collections
import gzip
import itertools
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM = sys.argv.pop(1)


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=280)


def read_medit(path):
    """Vertices and tets (with their label) of a Medit ASCII file."""
    words = iter(path.read_text().split())
    vertices, tets = [], []
    for word in words:
        if word == "Vertices":
            vertices = [[float(next(words)) for _ in range(4)][:3] for _ in range(int(next(words)))]
        elif word == "Tetrahedra":
            tets = [[int(next(words)) for _ in range(5)] for _ in range(int(next(words)))]
    return vertices, [([v - 1 for v in tet[:4]], tet[4]) for tet in tets]


def volume(vertices, tet):
    a, b, c, d = (vertices[v] for v in tet)
    u, v, w = ([p[i] - a[i] for i in range(3)] for p in (b, c, d))
    return (u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2])
            + u[2] * (v[0] * w[1] - v[1] * w[0])) / 6


def boundary(tets):
    faces = collections.Counter(tuple(sorted(f)) for tet, _ in tets for f in itertools.combinations(tet, 3))
    return [face for face, count in faces.items() if count == 1]


def euler_characteristic(faces):
    edges = {tuple(sorted(e)) for f in faces for e in itertools.combinations(f, 2)}
    return len({v for f in faces for v in f}) - len(edges) + len(faces)


def write_ball(path, center=(0, 0, 0), rings=12, sectors=24, append_to=None, skip=0):
    """A unit ball of latitude rings; returns its lines so that two can share a file."""
    first = 1 if append_to is None else sum(line.startswith("v ") for line in append_to) + 1
    points = [(0, 0, 1)] + [(math.sin(t) * math.cos(p), math.sin(t) * math.sin(p), math.cos(t))
                            for t in (math.pi * r / rings for r in range(1, rings))
                            for p in (2 * math.pi * s / sectors for s in range(sectors))] + [(0, 0, -1)]
    at = lambda ring, sector: 1 + (ring - 1) * sectors + sector % sectors
    faces = []
    for s in range(sectors):
        faces += [(0, at(1, s), at(1, s + 1)), (len(points) - 1, at(rings - 1, s + 1), at(rings - 1, s))]
        for r in range(1, rings - 1):
            faces += [(at(r, s), at(r + 1, s), at(r + 1, s + 1)), (at(r, s), at(r + 1, s + 1), at(r, s + 1))]
    lines = list(append_to or [])
    lines += ["v " + " ".join(repr(x + c) for x, c in zip(p, center)) for p in points]
    lines += ["f " + " ".join(str(first + v) for v in face) for face in faces[skip:]]
    path.write_text("\n".join(lines) + "\n")
    return lines


def write_boxes(path, *boxes):
    """Boxes from one corner to the opposite one, each of twelve triangles."""
    lines = []
    for box in boxes:
        first = 1 + sum(line.startswith("v") for line in lines)
        lines += [f"v {box[x][0]!r} {box[y][1]!r} {box[z][2]!r}" for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
        for a, b, c, d in quads:
            lines += [f"f {first + a} {first + b} {first + c}", f"f {first + a} {first + c} {first + d}"]
    path.write_text("\n".join(lines) + "\n")


def write_tet(path, *corners):
    """The tetrahedron of the origin and three corners."""
    path.write_text("v 0 0 0\n" + "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in corners)
                    + "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")


def write_image(path, labels):
    """An INRIMAGE of bytes from labels[z][y][x]."""
    nz, ny, nx = len(labels), len(labels[0]), len(labels[0][0])
    header = (f"#INRIMAGE-4#{{\nXDIM={nx}\nYDIM={ny}\nZDIM={nz}\nVDIM=1\nTYPE=unsigned fixed\nPIXSIZE=8 bits\n"
              "SCALE=2**0\nCPU=decm\nVX=1\nVY=1\nVZ=1\n")
    data = header.ljust(252, "\n").encode() + b"##}\n" + bytes(x for plane in labels for row in plane for x in row)
    path.write_bytes(gzip.compress(data) if path.suffix == ".gz" else data)


class Mesher(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.out = self.folder / "out.mesh"

    def expect_sound(self, expected_volume, tolerance, euler):
        vertices, tets = read_medit(self.out)
        volumes = [volume(vertices, tet) for tet, _ in tets]
        self.assertGreater(min(volumes), 0)
        self.assertAlmostEqual(sum(volumes), expected_volume, delta=tolerance * expected_volume)
        if euler is not None:
            self.assertEqual(euler_characteristic(boundary(tets)), euler)
        return vertices, tets

    def expect_error(self, code, words, *arguments):
        result = run(*arguments, "-o", self.out)
        self.assertEqual(result.returncode, code, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(self.out.exists())

    def test_a_closed_surface_is_filled_and_reported(self):
        write_ball(self.folder / "ball.obj")
        result = run(self.folder / "ball.obj", "-o", self.out, "--size", 0.25)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_sound(4 * math.pi / 3, 0.06, 2)
        for word in ("vertices", "tets", "dihedral", "mean ratio", "time"):
            self.assertIn(word, result.stdout)

    def test_equal_input_gives_equal_bytes(self):
        write_ball(self.folder / "ball.obj")
        texts = []
        for i in range(2):
            self.assertEqual(run(self.folder / "ball.obj", "-o", self.out, "--size", 0.3, "--quiet").stdout, "")
            texts.append(self.out.read_bytes())
        self.assertEqual(*texts)

    def test_two_balls_are_both_filled(self):
        lines = write_ball(self.folder / "balls.obj")
        write_ball(self.folder / "balls.obj", center=(3, 0, 0), append_to=lines)
        self.assertEqual(run(self.folder / "balls.obj", "-o", self.out, "--size", 0.4).returncode, 0)
        self.expect_sound(2 * 4 * math.pi / 3, 0.1, 4)

    def test_a_small_hole_is_filled_only_when_asked(self):
        write_ball(self.folder / "open.obj", skip=1)
        self.expect_error(2, ["open", "edges", "--fill-holes"], self.folder / "open.obj")
        result = run(self.folder / "open.obj", "-o", self.out, "--size", 0.3, "--fill-holes")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_sound(4 * math.pi / 3, 0.07, 2)

    def test_corners_that_agree_up_to_rounding_are_merged(self):
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        lines, number = [], 0
        for face in faces:
            for corner in face:
                number += 1
                lines.append("v " + " ".join(f"{c + 1e-7 * math.sin(7 * number + i):.9f}" for i, c in enumerate(corners[corner])))
            lines.append(f"f {number - 3} {number - 2} {number - 1} {number}")
        (self.folder / "cube.obj").write_text("\n".join(lines) + "\n")
        result = run(self.folder / "cube.obj", "-o", self.out, "--size", 0.4)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"merged 16 corners of open edges .*within 1e-6 of the diagonal")
        self.expect_sound(1, 0.01, 2)

    def test_slivers_are_reported(self):
        wedge = "".join(f"v {x} {y} {z}\n" for z in (0, 0.2) for x, y in ((0, 0), (1, 0), (1, 0.012)))  # 0.7 degrees
        (self.folder / "wedge.obj").write_text(wedge + "f 1 3 2\nf 4 5 6\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n")
        result = run(self.folder / "wedge.obj", "-o", self.out, "--size", 0.2)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, r"(?m)^slivers +\d+ of \d+ tets have a dihedral angle within 1 degree of 0 or 180")

    def test_planar_meshes_are_named(self):
        (self.folder / "flat.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
        for options in ([], ["--fill-holes"]):
            self.expect_error(2, ["planar", "encloses no volume"], self.folder / "flat.obj", *options)

    def test_an_implicit_torus_keeps_its_hole(self):
        result = run("--implicit", "(sqrt(x^2+y^2)-1)^2+z^2-0.16", "--bounds", -2, -2, -1, 2, 2, 1, "-o", self.out,
                     "--size", 0.2)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_sound(2 * math.pi**2 * 0.16, 0.04, 0)

    def test_separate_implicit_parts_are_all_found(self):
        balls = " , ".join(f"(x-{c})^2+y^2+z^2-0.04" for c in (0, 1, 2, 3))
        result = run("--implicit", f"min({balls})", "--bounds", -0.5, -0.5, -0.5, 3.5, 0.5, 0.5, "-o", self.out,
                     "--size", 0.1)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_sound(4 * 4 * math.pi / 3 * 0.008, 0.1, 8)

    def test_labeled_image_keeps_regions_and_sizes(self):
        n = 16
        inside = lambda x, y, z: (x - 7.5)**2 + (y - 7.5)**2 + (z - 7.5)**2 < 36
        labels = [[[(1 if x < 8 else 2) if inside(x, y, z) else 0 for x in range(n)] for y in range(n)]
                  for z in range(n)]
        for name in ("two.inr", "two.inr.gz"):
            write_image(self.folder / name, labels)
            result = run(self.folder / name, "-o", self.out, "--size", 4, "--region-size", "2=1.5")
            self.assertEqual(result.returncode, 0, result.stderr)
            voxels = sum(label > 0 for plane in labels for row in plane for label in row)
            _, tets = self.expect_sound(voxels, 0.15, 2)
            counts = collections.Counter(label for _, label in tets)
            self.assertEqual(set(counts), {1, 2})
            self.assertGreater(counts[2], 3 * counts[1])
            self.assertIn("region 2", result.stdout)

    def test_bad_input_is_refused_with_its_remedy(self):
        lines = write_ball(self.folder / "meeting.obj")
        write_ball(self.folder / "meeting.obj", center=(1.5, 0, 0), append_to=lines)
        self.expect_error(2, ["intersects itself", "triangles", "unite"], self.folder / "meeting.obj")
        self.expect_error(2, ["missing.obj"], self.folder / "missing.obj")
        self.expect_error(2, ["missing.inr"], self.folder / "missing.inr")
        (self.folder / "broken.inr").write_bytes(b"#INRIMAGE-4#{\nXDIM=9\n")
        self.expect_error(2, ["broken.inr"], self.folder / "broken.inr")
        write_image(self.folder / "empty.inr", [[[0] * 4] * 4] * 4)
        self.expect_error(2, ["labels are 0"], self.folder / "empty.inr")
        self.expect_error(2, ["no label 7"], self.write_block(), "--region-size", "7=1")
        self.expect_error(2, ["LABEL=SIZE"], self.write_block(), "--region-size", "7:1")
        write_ball(self.folder / "ball.obj")
        self.expect_error(2, ["too fine"], self.folder / "ball.obj", "--size", 1e-6)
        self.expect_error(2, ["--size"], self.folder / "ball.obj", "--size", -1)
        bounds = ["--bounds", -2, -2, -2, 2, 2, 2]
        self.expect_error(2, ["did you mean 'sqrt'"], "--implicit", "sqtr(x)-1", *bounds)
        self.expect_error(2, ["negative at no point"], "--implicit", "x^2+1", *bounds)
        self.expect_error(2, ["--bounds"], "--implicit", "x^2+y^2+z^2-1")
        self.expect_error(2, ["either"])
        self.assertEqual(run(self.folder / "ball.obj").returncode, 2)
        result = run(self.folder / "ball.obj", "-o", self.folder / "out.xyz")
        self.assertEqual(result.returncode, 2)
        self.assertIn(".xyz", result.stderr)

    def write_block(self):
        path = self.folder / "block.inr"
        write_image(path, [[[int(0 < x < 5 and 0 < y < 5 and 0 < z < 5) for x in range(6)] for y in range(6)]
                           for z in range(6)])
        return path

    def test_labels_at_the_image_border_are_filled(self):
        write_image(self.folder / "full.inr", [[[3] * 8] * 8] * 8)
        result = run(self.folder / "full.inr", "-o", self.out, "--size", 2)
        self.assertEqual(result.returncode, 0, result.stderr)
        _, tets = read_medit(self.out)
        self.assertEqual({label for _, label in tets}, {3})

    def expect_filled(self, path, expected_volume, tolerance, euler, *arguments):
        result = run(path, "-o", self.out, *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.expect_sound(expected_volume, tolerance, euler)
        return result.stdout

    def test_thin_parts_keep_their_volume(self):
        write_boxes(self.folder / "rod.obj", ((0, 0, 0), (0.4, 0.01, 0.01)))
        self.assertIn("thin", self.expect_filled(self.folder / "rod.obj", 4e-5, 0.02, 2))
        write_boxes(self.folder / "plate.obj", ((0, 0, 0), (0.2, 0.2, 0.01)))
        self.expect_filled(self.folder / "plate.obj", 4e-4, 0.02, 2)

    def test_plate_too_thin_for_limit_is_refused(self):
        write_boxes(self.folder / "plate.obj", ((0, 0, 0), (1, 1, 0.0005)))
        self.expect_error(2, ["0.0005 thick", "--max-tets", "plate.obj"], self.folder / "plate.obj", "--max-tets", 1e4)

    def test_thin_plate_gets_flat_tets_within_limit(self):
        write_boxes(self.folder / "plate.obj", ((0, 0, 0), (0.2, 0.2, 0.002)))
        said = self.expect_filled(self.folder / "plate.obj", 0.2 * 0.2 * 0.002, 1e-6, 2, "--max-tets", 1e4)
        self.assertIn("0.002 thick", said)
        self.assertIn("times as wide as thick", said)
        self.assertIn("--max-tets", said)
        self.assertLess(len(read_medit(self.out)[1]), 12000)

    def test_bodies_with_a_gap_stay_apart(self):
        write_boxes(self.folder / "two.obj", ((0, 0, 0), (1, 1, 1)), ((1.05, 0, 0), (2.05, 1, 1)))
        self.assertIn("2 components", self.expect_filled(self.folder / "two.obj", 2, 0.01, 4, "--size", 0.3))

    def test_a_cavity_stays_empty(self):
        write_boxes(self.folder / "hollow.obj", ((0, 0, 0), (1, 1, 1)), ((0.3, 0.3, 0.3), (0.7, 0.7, 0.7)))
        self.expect_filled(self.folder / "hollow.obj", 1 - 0.4**3, 0.01, 4, "--size", 0.3)

    def test_any_unit_gives_the_same_mesh(self):
        counts = set()
        for unit in (1, 2.0**-100, 2.0**66):
            write_boxes(self.folder / "cube.obj", ((0, 0, 0), (unit, unit, unit)))
            self.expect_filled(self.folder / "cube.obj", unit**3, 0.01, 2, "--size", 0.3 * unit)
            counts.add(len(read_medit(self.out)[1]))
        self.assertEqual(len(counts), 1)

    def test_coordinates_without_resolution_are_refused(self):
        write_boxes(self.folder / "far.obj", ((1e15, 0, 0), (1e15 + 1, 1, 1)))
        self.expect_error(2, ["far.obj", "1e+15", "0.125", "origin"], self.folder / "far.obj")

    def test_sharp_corners_and_spikes_end(self):
        write_tet(self.folder / "corner.obj", (1, 0, 0), (0, 1, 0), (0, 0, 1))
        self.expect_filled(self.folder / "corner.obj", 1 / 6, 0.01, 2, "--size", 0.2)
        width = math.tan(math.radians(1))
        write_tet(self.folder / "spike.obj", (1, 0, 0), (1, width, 0), (1, 0, width))
        self.out.unlink()
        self.expect_error(2, ["spike.obj", "volume", "--size", "--max-tets"], self.folder / "spike.obj", "--time-limit", 60)

    def test_a_blade_of_one_degree_is_filled(self):
        half = math.tan(math.radians(0.5))
        corners = [(0, 0, 0), (0, 1, 0), (1, 0, half), (1, 1, half), (1, 0, -half), (1, 1, -half)]
        (self.folder / "blade.obj").write_text("".join(f"v {x} {y} {z!r}\n" for x, y, z in corners) +
                                               "f 1 3 4 2\nf 1 2 6 5\nf 3 5 6 4\nf 1 5 3\nf 2 4 6\n")
        # Its surface may touch itself where the blade is thinner than a tet.
        self.expect_filled(self.folder / "blade.obj", half, 0.01, None, "--time-limit", 120)

    def test_noisy_labels_end(self):
        random.seed(1)
        write_image(self.folder / "noise.inr", [[[random.randrange(4) for _ in range(8)] for _ in range(8)]
                                                for _ in range(8)])
        self.assertIn(run(self.folder / "noise.inr", "-o", self.out, "--time-limit", 20).returncode, (0, 2, 4))

    def test_the_time_limit_has_its_exit_code(self):
        write_ball(self.folder / "ball.obj")
        self.expect_error(4, ["ball.obj", "0.01 s", "--time-limit"], self.folder / "ball.obj", "--size", 0.05,
                          "--time-limit", 0.01)

    def test_a_defective_surface_is_rebuilt(self):
        lines = write_ball(self.folder / "meeting.obj", skip=3)
        write_ball(self.folder / "meeting.obj", center=(1.5, 0, 0), append_to=lines)
        self.expect_error(2, ["--rebuild"], self.folder / "meeting.obj")
        lens = math.pi * (2 - 1.5)**2 * (1.5**2 + 4 * 1.5) / (12 * 1.5)
        self.assertIn("rebuilt", self.expect_filled(self.folder / "meeting.obj", 2 * 4 * math.pi / 3 - lens, 0.08, 2,
                                                    "--rebuild", "--size", 0.3))

    def test_an_open_box_is_closed_and_rebuilt(self):
        write_boxes(self.folder / "box.obj", ((0, 0, 0), (1, 1, 1)))
        lines = (self.folder / "box.obj").read_text().splitlines()
        (self.folder / "box.obj").write_text("\n".join(lines[:-2]) + "\n")  # a side is missing
        self.expect_filled(self.folder / "box.obj", 1, 0.06, 2, "--rebuild", "--size", 0.3)

    def test_a_sheet_is_not_rebuilt(self):
        (self.folder / "sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
        self.expect_error(2, ["sheet.obj", "sheet", "thickness"], self.folder / "sheet.obj", "--rebuild")

    def test_help_and_version_name_the_license(self):
        for flag in ("--help", "--version"):
            result = run(flag)
            self.assertEqual(result.returncode, 0)
            self.assertIn("General Public License", result.stdout)


if __name__ == "__main__":
    unittest.main()

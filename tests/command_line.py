"""Shared parts of the command-line tests: the program, small inputs, a temporary folder per test."""
import csv
import filecmp
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

ASPIC = os.environ["ASPIC"]
MESHER = pathlib.Path(ASPIC).with_name("aspic-mesh")
HAS_FIT = pathlib.Path(ASPIC).with_name("aspic-fit").exists()  # the package of inverse problems
CUBE_OBJ = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\n"""
BEAM = """[time]
step = 0.01
duration = {duration}
[[body]]
name = "beam"
shape = {{ box = {{ upper = [0.4, 0.1, 0.1], cells = [{cells}] }} }}
material = {{ model = "neo_hookean", young = 1e5, poisson = 0.3, density = 1000 }}
[[body.pin]]
where = "x < 1e-9"
"""
CUBE = """gravity = [0, 0, 0]
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [5, 5, 5] } }
material = { model = "neo_hookean", young = "X < 0.05 ? 2e4 : 5e4", poisson = 0.4 }
[[body.pin]]
where = "Z < 1e-6"
"""
HOLDS_MATERIAL = """[time]
step = 0.01
duration = 0.02
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [3, 3, 3] } }
material = { file = "material.vtu" }
[[body.pin]]
where = "Z < 1e-6"
"""
BENCH = ("--pokes", "3", "--depths", "2", "--markers", "20", "--tip", "disc:0.02", "--quiet")


def box_mesh(cells=2, flip=None):
    """A unit cube of cells^3 x 6 tets in Medit's format; tet number `flip` is turned inside out."""
    n = cells + 1
    vertices = [(i / cells, j / cells, k / cells) for i in range(n) for j in range(n) for k in range(n)]
    index = lambda c: 1 + (c[0] * n + c[1]) * n + c[2]
    tets = []
    for i in range(cells):
        for j in range(cells):
            for k in range(cells):
                for path, even in (((0, 1, 2), 1), ((1, 2, 0), 1), ((2, 0, 1), 1),
                                   ((0, 2, 1), 0), ((2, 1, 0), 0), ((1, 0, 2), 0)):
                    corner, tet = [i, j, k], [index((i, j, k))]
                    for axis in path:
                        corner[axis] += 1
                        tet.append(index(corner))
                    if not even:
                        tet[2], tet[3] = tet[3], tet[2]
                    tets.append(tet)
    if flip is not None:
        tets[flip][2], tets[flip][3] = tets[flip][3], tets[flip][2]
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(vertices))]
    lines += ["%.17g %.17g %.17g 0" % v for v in vertices]
    lines += ["Tetrahedra", str(len(tets))] + ["%d %d %d %d 0" % tuple(t) for t in tets] + ["End", ""]
    return "\n".join(lines)


def reversed_mesh(text):
    """The same mesh with vertices and tets in reverse order."""
    lines = text.split("\n")
    vertices, tets = lines.index("Vertices") + 2, lines.index("Tetrahedra") + 2
    count = int(lines[vertices - 1])
    lines[vertices:vertices + count] = reversed(lines[vertices:vertices + count])
    renamed = [" ".join([str(count + 1 - int(v)) for v in line.split()[:4]] + ["0"]) for line in lines[tets:-2]]
    lines[tets:-2] = reversed(renamed)
    return "\n".join(lines)


class CommandLine(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def beam(self, name="beam.toml", duration=0.05, cells="8, 2, 2", extra=""):
        return self.write(name, BEAM.format(duration=duration, cells=cells) + extra)

    def aspic(self, *arguments, code=0, timeout=600):
        done = subprocess.run([ASPIC, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=timeout)
        self.assertEqual(done.returncode, code, f"aspic {' '.join(arguments)}\n{done.stdout}\n{done.stderr}")
        return done

    def start(self, *arguments):
        return subprocess.Popen([ASPIC, *arguments], cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                text=True)

    def steps(self, run):
        """Rows of the steps, without the initial row of step 0."""
        with open(self.folder / run / "steps.csv", newline="") as file:
            return [row for row in csv.DictReader(file) if row["step"] != "0"]

    def assert_same_results(self, one, other, suffixes=(".vtu", ".pvd", ".pc2", ".usda", ".bin")):
        """Compares bit by bit, except for wall times and memory."""
        left, right = self.folder / one, self.folder / other
        names = {p.relative_to(left) for p in left.rglob("*") if p.is_file()}
        self.assertEqual(names, {p.relative_to(right) for p in right.rglob("*") if p.is_file()})
        for suffix in suffixes:
            self.assertTrue(any(n.suffix == suffix for n in names), f"no {suffix} among the results")
        for name in sorted(names):
            if name.name not in ("timings.csv", "ranks.csv"):
                self.assertTrue(filecmp.cmp(left / name, right / name, shallow=False), f"{name} differs")

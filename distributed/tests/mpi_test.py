#!/usr/bin/env python3
"""A scene on several MPI ranks has the results of aspic run, and an error of one rank ends all.

usage: ASPIC=... ASPIC_MPI=path/to/aspic-mpi MPIRUN=... MPI_EXCEPTION=... mpi_test.py [TestCase...]
"""
import base64
import csv
import math
import os
import random
import resource
import pathlib
import shutil
import signal
import struct
import subprocess
import time
import unittest
import xml.etree.ElementTree
import zlib

from command_line import CommandLine
from crash_test import checkpoint, state_hash

BEAM = """[time]
step = 0.01
duration = 0.03
{time}
[solver]
tolerance = 1e-10
{solver}
[output]
checkpoint_every = 0
{output}
[[body]]
name = "beam"
shape = {{ box = {{ upper = [0.4, 0.1, 0.1], cells = [{cells}] }} }}
material = {{ model = "neo_hookean", young = {young}, poisson = 0.4 }}
{before_pin}
[[body.pin]]
where = "x < 1e-9"
{body}
"""
# Two bodies, a moving pin, a roller, a traction, and materials of different stiffness, so that there are several parts.
MANY = """
[[body.pin]]
name = "pull"
where = "x > 0.4 - 1e-9"
motion = { linear = { velocity = [0.2, 0, 0] } }
[[body]]
name = "ball"
shape = { sphere = { radius = 0.1, size = 0.05 } }
translate = [1, 0, 0]
material = { model = "stable_neo_hookean", young = "X > 1 ? 1e7 : 1e4", poisson = 0.3 }
[[body.pin]]
where = { lowest = 0.2 }
axes = "y"
[[body.traction]]
where = { highest = 0.1 }
value = [50, -100, 0]
"""


def environment():
    root = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"} if os.geteuid() == 0 else {}
    return os.environ | root | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_MCA_mpi_yield_when_idle": "1"}


class Ranks(CommandLine):
    TIMEOUT = 600

    def scene(self, name="beam.toml", cells="8, 2, 2", **parts):
        return self.write(name, BEAM.format(**{"time": "", "solver": "", "output": "", "before_pin": "", "body": "", "cells": cells, "young": "1e5"} | parts))

    def command(self, ranks, *arguments, program="ASPIC_MPI"):
        return [os.environ["MPIRUN"], "--oversubscribe", "-n", str(ranks), os.environ[program], *arguments]

    def mpi(self, ranks, *arguments, code=0, program="ASPIC_MPI"):
        done = subprocess.run(self.command(ranks, *arguments, program=program), cwd=self.folder, env=environment(),
                              capture_output=True, text=True, timeout=self.TIMEOUT)
        self.assertEqual(done.returncode, code, f"{ranks} ranks {arguments}\n{done.stdout}\n{done.stderr}")
        return done

    def start_mpi(self, ranks, *arguments):
        return subprocess.Popen(self.command(ranks, *arguments), cwd=self.folder, env=environment(),
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def positions(self, run):
        return [x for (x,) in struct.iter_unpack("<d", checkpoint(self.folder / run / "checkpoint.bin")["q"])]

    def distance(self, one, other):
        """Largest difference of a coordinate [m]."""
        left, right = self.positions(one), self.positions(other)
        self.assertEqual(len(left), len(right))
        return max(abs(a - b) for a, b in zip(left, right))

    def column(self, run, name):
        return [row[name] for row in self.steps(run)]

    def wait_for_steps(self, run, count):
        table, end = self.folder / run / "steps.csv", time.monotonic() + self.TIMEOUT
        while not table.exists() or len(table.read_text().splitlines()) < count + 2:
            self.assertLess(time.monotonic(), end, "no steps")
            time.sleep(0.02)

    def ranks(self, run):
        with open(self.folder / run / "ranks.csv", newline="") as file:
            return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


class Equality(Ranks):
    NUMBERS = ("kinetic", "potential_total", "pin_work", "numerical_loss", "min_det_F")

    def assert_equal_runs(self, ranks, scene):
        self.aspic("run", scene, "--out", "serial", "--force", "--quiet")
        counts = None
        for n in ranks:
            self.mpi(n, "run", scene, "--out", "ranks", "--force", "--quiet")
            self.assertLess(self.distance("serial", "ranks"), 1e-10, f"{n} ranks [m]")
            counts = counts or self.column("ranks", "iterations")
            self.assertEqual(self.column("ranks", "iterations"), counts, f"{n} ranks")
            for name in ("status", "energy_bound", "criterion", "initial_guess"):
                self.assertEqual(self.column("serial", name), self.column("ranks", name), f"{n} ranks")
            self.assert_equal_energies(n)
        return counts

    def assert_equal_energies(self, ranks):
        for serial, distributed in zip(self.steps("serial"), self.steps("ranks")):
            scale = abs(float(serial["kinetic"])) + abs(float(serial["potential_total"]))
            for name in self.NUMBERS:
                self.assertAlmostEqual(float(serial[name]), float(distributed[name]), delta=1e-9 * max(1, scale),
                                       msg=f"{ranks} ranks: {name}")
            self.assertLess(abs(float(distributed["ledger_error"])), 1e-12 * max(1, scale))
            for name in serial:
                if name.startswith(("reaction_", "load_", "body_")):
                    self.assertAlmostEqual(float(serial[name]), float(distributed[name]), delta=1e-6, msg=name)

    def test_falling_beam(self):
        counts = self.assert_equal_runs((1, 2, 3, 4), self.scene(solver='linear = "multigrid"'))
        self.assertEqual(counts, self.column("serial", "iterations"))

    def test_ranks_with_few_vertices(self):
        self.assert_equal_runs((4,), self.scene(cells="2, 1, 1"))

    def test_two_bodies_with_moving_pins_and_tractions(self):
        self.assert_equal_runs((1, 2, 3, 4), self.scene(body=MANY, solver='linear = "block_jacobi"'))

    def test_auto_with_stiff_bodies(self):
        """Multigrid of each rank with a coarse space, across jumps of the modulus."""
        self.assert_equal_runs((1, 2, 3, 4), self.scene(young="1e7", body=MANY, cells="16, 4, 4"))

    def test_rayleigh_damping(self):
        body = "damping = { mass = 2, stiffness = 0.01 }\n"
        self.assert_equal_runs((1, 2, 4), self.scene(before_pin=body, body=MANY, solver='linear = "multigrid"'))
        self.assertGreater(min(float(loss) for loss in self.column("ranks", "damping_loss")), 0)
        for serial, distributed in zip(self.column("serial", "damping_loss"), self.column("ranks", "damping_loss")):
            self.assertAlmostEqual(float(serial), float(distributed), delta=1e-9)

    def test_equilibrium_by_decrement(self):
        scene = self.scene(time='integrator = "quasi_static"', solver='criterion = "decrement"\ninitial_guess = "current"')
        self.assert_equal_runs((1, 3), scene)


class Parts(Ranks):
    """No rank holds the whole: meshes are sent in parts, boxes are generated in slices, results are pieces."""

    SLICED = """
deform = { twist = { axis = [1, 0, 0], angle_deg = 20 } }
velocity = [0, "X", 0]
rotate = { axis = [1, 2, 3], angle_deg = 20 }
[[body.force]]
value = [0, "1e3 * sin(100 * t)", 0]
[[body.pin]]
name = "base"
where = "X < 0.05"
[[body]]
name = "block"
shape = { box = { upper = [0.1, 0.1, 0.1], size = 0.03, cut = "five" } }
translate = [1, 0, 0]
material = { model = "stable_neo_hookean", young = "X > 1.05 ? 1e7 : 1e4", poisson = 0.3 }
[[body.pin]]
where = { lowest = 0.2 }
motion = { rotate = { axis = [0, 1, 0], rate_deg = 100 } }
[[body.pin]]
where = { vertices = [60, 61, 62, 63] }
axes = "y"
[[body.traction]]
where = { highest = 0.1 }
value = [50, "-100 * t", 0]
"""

    def sliced_scene(self):
        scene = self.scene(body=self.SLICED)
        path = self.folder / scene
        path.write_text(path.read_text().replace('[[body.pin]]\nwhere = "x < 1e-9"\n', "", 1))
        return scene

    def start_hash(self, run):
        return (self.folder / run / "steps.csv").read_text().splitlines()[1].split(",")[-1]

    def test_slices_of_boxes_equal_the_serial_run(self):
        scene = self.sliced_scene()
        self.aspic("run", scene, "--out", "serial", "--quiet")
        for n in (1, 2, 3, 4):
            self.mpi(n, "run", scene, "--out", f"ranks{n}", "--quiet")
            self.assertLess(self.distance("serial", f"ranks{n}"), 1e-10, f"{n} ranks [m]")
            self.assertEqual(self.column("serial", "iterations"), self.column(f"ranks{n}", "iterations"))
        scenes = [(self.folder / run / "scene.toml").read_text().splitlines() for run in ("serial", "ranks3")]
        differing = [b for a, b in zip(*scenes) if a != b]
        self.assertEqual(differing, ["pc2 = false", "usd = false", "report = false"])

    def test_a_generated_box_and_its_file_have_the_same_bits(self):
        self.mpi(1, "run", self.scene(), "--out", "generated", "--steps", "1", "--quiet")
        shutil.copy(self.folder / "generated/frames/body_000000.vtu", self.folder / "mesh.vtu")
        text = (self.folder / self.scene()).read_text()
        shape = next(line for line in text.splitlines() if line.startswith("shape"))
        self.write("file.toml", text.replace(shape, 'mesh = "mesh.vtu"'))
        for n in (1, 3):
            self.mpi(n, "run", self.scene(), "--out", "generated", "--force", "--quiet")
            self.mpi(n, "run", "file.toml", "--out", "file", "--force", "--quiet")
            for name in ("state_hash", "iterations", "potential_total"):
                self.assertEqual(self.column("generated", name), self.column("file", name), f"{n} ranks")

    def arrays(self, path):
        """Returns {name: numbers} of a VTU file of this program, read without it."""
        codes = {"Float64": "d", "Float32": "f", "Int32": "i", "Int64": "q", "UInt8": "B"}
        found = {}
        for array in xml.etree.ElementTree.parse(path).getroot().iter("DataArray"):
            text = array.text.strip()
            blocks, size, last = struct.unpack("<3I", base64.b64decode(text[:16]))
            head = 4 * (3 + blocks)
            encoded = 4 * ((head + 2) // 3)
            sizes = struct.unpack(f"<{blocks}I", base64.b64decode(text[:encoded])[12:head])
            data, at, bytes_ = base64.b64decode(text[encoded:]), 0, b""
            for count in sizes:
                bytes_ += zlib.decompress(data[at:at + count])
                at += count
            code = codes[array.get("type")]
            found[array.get("Name")] = struct.unpack(f"<{len(bytes_) // struct.calcsize(code)}{code}", bytes_)
        return found

    def test_pieces_make_up_the_frame_of_the_serial_run(self):
        scene = self.scene(output='precision = "double"')
        self.aspic("run", scene, "--out", "serial", "--quiet")
        self.mpi(3, "run", scene, "--out", "ranks", "--quiet")
        frames = self.folder / "ranks/frames"
        index = (frames / "body_000003.pvtu").read_text()
        whole = self.arrays(self.folder / "serial/frames/body_000003.vtu")
        points, density, seen = {}, {}, 0
        for rank in range(3):
            piece = f"piece_000003_{rank:05d}.vtu"
            self.assertIn(f'Source="{piece}"', index)
            part = self.arrays(frames / piece)
            for name in set(part) - {"Points", "connectivity", "offsets", "types"}:
                self.assertIn(f'Name="{name}"', index)
            for i, v in enumerate(part["vertex"]):
                points.setdefault(v, part["Points"][3 * i:3 * i + 3])
                self.assertEqual(points[v], part["Points"][3 * i:3 * i + 3], "copies of a vertex")
            for i, t in enumerate(part["tet"]):
                density[t] = part["energy_density"][i]
                corners = [part["vertex"][c] for c in part["connectivity"][4 * i:4 * i + 4]]
                self.assertEqual(corners, list(whole["connectivity"][4 * t:4 * t + 4]))
            seen += len(part["tet"])
        self.assertEqual(len(points), len(whole["Points"]) // 3)
        self.assertEqual((seen, len(density)), (len(whole["det_F"]), len(whole["det_F"])))
        for v, x in points.items():
            for r in range(3):
                self.assertAlmostEqual(x[r], whole["Points"][3 * v + r], delta=1e-10)
        for t, value in density.items():
            self.assertAlmostEqual(value, whole["energy_density"][t], delta=1e-6 * max(whole["energy_density"]))
        self.assertIn("frames/body_000003.pvtu", (self.folder / "ranks/run.pvd").read_text())

    def test_resumes_on_other_numbers_of_ranks_and_with_aspic_run(self):
        scene = self.sliced_scene()
        self.mpi(2, "run", scene, "--out", "whole", "--quiet")
        self.mpi(3, "run", scene, "--out", "part", "--steps", "1", "--quiet")
        for n in (1, 2, 4):
            shutil.copytree(self.folder / "part", self.folder / f"on{n}")
            self.mpi(n, "run", f"on{n}", "--resume", "--quiet")
            self.assertLess(self.distance("whole", f"on{n}"), 1e-10)
            self.assertTrue((self.folder / f"on{n}/frames/body_000001.pvtu").exists())
        self.aspic("run", "part", "--resume", "--quiet")
        self.assertLess(self.distance("whole", "part"), 1e-10)
        pvd = (self.folder / "part/run.pvd").read_text()
        self.assertIn("body_000001.pvtu", pvd)
        self.assertIn("body_000003.vtu", pvd)

    def test_a_damaged_checkpoint_is_replaced_by_the_previous_one(self):
        self.mpi(2, "run", self.scene(), "--out", "run", "--quiet")
        good = (self.folder / "run/checkpoint.bin").read_bytes()
        middle = len(good) // 2  # within a number
        (self.folder / "run/checkpoint.bin").write_bytes(good[:middle] + bytes([good[middle] ^ 1]) + good[middle + 1:])
        said = self.mpi(2, "run", "run", "--resume", code=2).stderr
        self.assertEqual(said.count("no readable checkpoint"), 1, said)
        self.assertIn("its checksum is wrong", said)
        (self.folder / "run/checkpoint.previous.bin").write_bytes(good)
        self.assertIn("continuing from checkpoint.previous.bin", self.mpi(2, "run", "run", "--resume").stdout)

    def test_an_empty_selection_is_reported_once(self):
        said = self.mpi(3, "run", self.scene(body='[[body.traction]]\nwhere = "x > 9"\nvalue = [1, 0, 0]'), code=2).stderr
        self.assertEqual(said.count("error: beam.toml:"), 1, said)
        self.assertIn("selects no boundary triangle of body 'beam', which extends from (0, 0, 0) to (0.4, 0.1, 0.1)", said)


class Slices(Ranks):
    """Binary .msh files of version 4.1 are read in slices, others in one piece, with the same bits."""

    MUTANTS = int(os.environ.get("ASPIC_MUTANTS", 20))

    BODIES = """translate = [0, 0, 0.5]
rotate = { axis = [1, 2, 3], angle_deg = 20 }
[[body.pin]]
where = { highest = 0.3 }
[[body]]
name = "block"
shape = { box = { upper = [0.1, 0.1, 0.1], size = 0.03 } }
translate = [0, 1, 0]
material = { model = "stable_neo_hookean", young = "X > 0.05 ? 1e7 : 1e4", poisson = 0.3 }
"""

    def msh(self, name, is_binary, points, tets, tags=None):
        """Writes a file of two volumes and a surface; the second volume has the physical group 7."""
        tags = tags or [n + 5 for n in range(len(points))]
        out = [b"$MeshFormat\n4.1 %d 8\n" % is_binary + (struct.pack("<i", 1) + b"\n" if is_binary else b"") + b"$EndMeshFormat\n"]

        def put(code, *values):
            out.append(struct.pack("<" + code, *values) if is_binary else (" ".join(map(repr, values)) + "\n").encode())

        def section(title, write):
            out.append(b"$%s\n" % title)
            write()
            out.append((b"\n" if is_binary else b"") + b"$End%s\n" % title)

        def entities():
            put("4q", 0, 0, 1, 2)
            for dimension, tag, group in ((2, 4, 0), (3, 1, 0), (3, 2, 7)):
                put("i6d", tag, *[0.0] * 3, *[1.0] * 3)
                put("qi", 1, group) if group else put("q", 0)
                put("q", 0)

        def nodes():
            half = len(points) // 3
            put("4q", 2, len(points), min(tags), max(tags))
            for dimension, tag, part in ((2, 4, range(half)), (3, 1, range(half, len(points)))):
                put("iiiq", dimension, tag, 0, len(part))
                for n in part:
                    put("q", tags[n])
                for n in part:
                    put("3d", *points[n])

        def elements():
            half = len(tets) // 2
            put("4q", 3, len(tets) + 1, 1, len(tets) + 1)
            for dimension, tag, kind, part in ((3, 1, 4, tets[:half]), (2, 4, 2, [tets[0][:3]]), (3, 2, 4, tets[half:])):
                put("iiiq", dimension, tag, kind, len(part))
                for number, element in enumerate(part):
                    put(f"{1 + len(element)}q", number + 1, *(tags[n] for n in element))

        out.append(b"$PhysicalNames\n1\n3 7 \"skull\"\n$EndPhysicalNames\n")
        for title, write in ((b"Entities", entities), (b"Nodes", nodes), (b"Elements", elements)):
            section(title, write)
        (self.folder / name).write_bytes(b"".join(out))

    def bar(self, n=(8, 3, 2)):
        """Points and tets of a distorted bar, in an order that is far from Hilbert's."""
        number = lambda i, j, k: (i * (n[1] + 1) + j) * (n[2] + 1) + k
        points = [(0.05 * i + 0.004 * ((7 * i + 3 * j + 5 * k) % 5), 0.04 * j, 0.05 * k + 0.003 * (i * j % 4))
                  for i in range(n[0] + 1) for j in range(n[1] + 1) for k in range(n[2] + 1)]
        steps = ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2))
        tets = []
        for i in range(n[0]):
            for j in range(n[1]):
                for k in range(n[2]):
                    for order in steps:
                        at, corners = [i, j, k], [number(i, j, k)]
                        for axis in order:
                            at[axis] += 1
                            corners.append(number(*at))
                        tets.append(corners if order in steps[:3] else [corners[c] for c in (0, 2, 1, 3)])
        return points, tets[::2] + tets[1::2]

    def mesh_scene(self, name):
        text = (self.folder / self.scene(before_pin=self.BODIES, output='precision = "double"')).read_text()
        shape = next(line for line in text.splitlines() if line.startswith("shape = { box = { upper = [0.4"))
        return self.write(f"{name}.toml", text.replace(shape, f'mesh = "{name}.msh"'))

    def test_slices_have_the_bits_of_the_whole(self):
        points, tets = self.bar()
        self.msh("binary.msh", True, points, tets)
        self.msh("text.msh", False, points, tets)
        self.aspic("run", self.mesh_scene("binary"), "--out", "serial", "--quiet")
        for n in (1, 2, 3, 4):
            for name, what in (("binary", "meshes in slices"), ("text", "meshes in one piece")):
                said = self.mpi(n, "run", self.mesh_scene(name), "--out", name, "--force").stdout
                self.assertIn(what, said)
            self.assertEqual(self.column("binary", "state_hash"), self.column("text", "state_hash"), f"{n} ranks")
            self.assertEqual((self.folder / "binary/scene.toml").read_bytes(), (self.folder / "text/scene.toml").read_bytes())
            files = ["checkpoint.bin", *(f"frames/{f.name}" for f in (self.folder / "text/frames").iterdir())]
            self.assertGreater(len(files), 4)
            for file in files:
                self.assertEqual((self.folder / "binary" / file).read_bytes(), (self.folder / "text" / file).read_bytes(), file)
            self.assertLess(self.distance("serial", "binary"), 1e-10, f"{n} ranks [m]")
            self.assertEqual(self.column("serial", "iterations"), self.column("binary", "iterations"))
        self.assertIn(b'Name="region"', (self.folder / "binary/frames/piece_000001_00002.vtu").read_bytes())
        self.mpi(3, "run", "binary", "--resume", "--steps", "4", "--quiet")
        self.assertEqual(len(self.steps("binary")), 4)

    def test_other_files_are_read_in_one_piece(self):
        points, tets = self.bar()
        self.msh("sparse.msh", True, points, tets, tags=[3 * n + 2 for n in range(len(points))])
        self.assertIn("meshes in one piece", self.mpi(2, "run", self.mesh_scene("sparse"), "--steps", "1").stdout)
        self.msh("whole.msh", True, points, tets)
        (self.folder / "cut.msh").write_bytes((self.folder / "whole.msh").read_bytes()[:-500])
        self.assertIn("cut.msh: byte ", self.mpi(2, "run", self.mesh_scene("cut"), code=2).stderr)
        nan = [(float("nan"), 0.0, 0.0)] + points[1:]
        self.msh("nan.msh", True, nan, tets)
        self.assertIn("nan.msh: byte ", self.mpi(2, "run", self.mesh_scene("nan"), code=2).stderr)

    def test_defects_of_slices_are_refused(self):
        points, tets = self.bar()
        for defect, found in (("inverted_tets", tets[:40] + [[tets[40][c] for c in (1, 0, 2, 3)]] + tets[41:]),
                              ("repeated_tets", tets + tets[:1])):
            self.msh("bad.msh", True, points, found)
            for n in (1, 3):
                said = self.mpi(n, "run", self.mesh_scene("bad"), code=2).stderr
                self.assertEqual(said.count("error:"), 1, said)
                self.assertIn("body 'beam': its mesh has " + defect, said)
        self.msh("bad.msh", True, points + [(0.1, 0.1, 9.0)], tets)
        self.assertIn("unreferenced_vertices", self.mpi(3, "run", self.mesh_scene("bad"), code=2).stderr)


    def mutant(self, data, number):
        """A copy with one to three damages, the same in every run."""
        rng, data = random.Random(number), bytearray(data)
        for _ in range(rng.randint(1, 3)):
            at, kind = rng.randrange(len(data)), rng.randrange(4)
            if kind == 0:
                data[at] ^= 1 << rng.randrange(8)
            elif kind == 1:
                value = rng.choice((0, 1, -1, 2**31 - 1, 2**31, 2**63 - 1, -2**63, 0x7ff0 << 48))
                data[at:at + 8] = struct.pack("<q", value)[:len(data) - at]
            elif kind == 2:
                del data[at:at + rng.randint(1, 40)]
            else:
                data[at:at] = data[:rng.randint(1, 40)]
        return bytes(data)

    def test_damaged_files_are_read_or_refused(self):
        """Ranks neither crash, hang nor need more memory than for the whole file."""
        points, tets = self.bar((2, 1, 1))
        self.msh("good.msh", True, points, tets)
        good, scene = (self.folder / "good.msh").read_bytes(), self.mesh_scene("bad")
        limit = 8 << 30  # of addresses [bytes]
        codes = []
        for number in range(self.MUTANTS):
            (self.folder / "bad.msh").write_bytes(self.mutant(good, number))
            command = self.command(1 + number % 2, "run", scene, "--out", "bad", "--force", "--quiet", "--steps", "1")
            done = subprocess.run(command, cwd=self.folder, env=environment(), capture_output=True, text=True, timeout=60,
                                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)))
            said = f"mutant {number}: {done.stdout}{done.stderr}"
            self.assertIn(done.returncode, (0, 2, 3), said)
            self.assertNotIn("signal", said)
            self.assertTrue(done.returncode != 2 or "error:" in done.stderr, said)
            codes.append(done.returncode)
        self.assertTrue({0, 2} <= set(codes), "some are read, and some refused")


class Orders(Ranks):
    """Orders of convergence, certificates and energies of runs on 2 and 4 ranks, against closed forms in this file."""

    COUNTS = (2, 4)

    def steps_of(self, ranks, text):
        """Runs a scene and returns the rows of steps.csv as numbers, with certificate and energy balance checked."""
        self.write("order.toml", text)
        self.mpi(ranks, "run", "order.toml", "--out", "run", "--force", "--quiet")
        rows = [{name: float(value) if value and name not in ("status", "criterion", "initial_guess", "energy_bound",
                                                              "state_hash", "min_gap_pair") else value
                 for name, value in row.items()} for row in self.steps("run")]
        before, *later = [self.first_row(), *rows]
        for row in later:
            self.assertEqual(row["status"], "converged")
            self.assertLess(row["residual"], row["residual_threshold"])
            self.assertIn(row["energy_bound"], ("holds", "none"))
            change = row["kinetic"] + row["potential_total"] - before["kinetic"] - before["potential_total"]
            balance = row["pin_work"] - row["damping_loss"] - row["numerical_loss"] + row["residual_work"]
            scale = abs(row["kinetic"]) + abs(row["potential_total"]) + 1e-3
            if row["initial_guess"] != "none" and row["energy_bound"] == "holds":  # statics has no energy balance
                self.assertAlmostEqual(change, balance, delta=1e-12 * scale)
            before = row
        return rows

    def first_row(self):
        with open(self.folder / "run/steps.csv", newline="") as file:
            row = next(csv.DictReader(file))
        return {name: float(row[name]) for name in ("kinetic", "potential_total")}

    def orders(self, errors):
        return [math.log2(a / b) for a, b in zip(errors, errors[1:])]

    def falling(self, step, pin=True):
        text = BEAM.format(time="", solver="", output="vtu = false", before_pin="", body="", cells="6, 2, 2", young="1e5")
        text = text.replace("step = 0.01\nduration = 0.03", f"step = {step!r}\nduration = 0.08")
        return text if pin else text.replace('[[body.pin]]\nwhere = "x < 1e-9"\n', "")

    def test_a_free_body_falls_by_the_closed_form(self):
        """Backward Euler: the body falls by g h^2 n (n + 1) / 2, an error of g h t / 2, and loses m (g h)^2 / 2 per step."""
        g, mass, t = 9.81, 1000 * 0.4 * 0.1 * 0.1, 0.08
        for ranks in self.COUNTS:
            errors = []
            for step in (0.02, 0.01, 0.005):
                rows, n = self.steps_of(ranks, self.falling(step, pin=False)), round(t / step)
                heights = self.positions("run")[1::3]
                fallen = {round(y, 9) for y in heights} - {round(y - g * step**2 * n * (n + 1) / 2, 9) for y in (0, 0.05, 0.1)}
                self.assertEqual(fallen, set(), f"{ranks} ranks")
                errors.append(max(heights) - (0.1 - g * t**2 / 2))
                for row in rows:
                    self.assertAlmostEqual(row["numerical_loss"], mass * (g * step)**2 / 2, delta=1e-9)
            for order in self.orders([abs(e) for e in errors]):
                self.assertAlmostEqual(order, 1, delta=1e-6)

    def test_backward_euler_has_order_one(self):
        """A clamped beam swings; the reference has steps of 1/32 of the largest."""
        self.write("fine.toml", self.falling(0.01 / 32))
        self.aspic("run", "fine.toml", "--out", "fine", "--quiet")
        for ranks in self.COUNTS:
            errors = []
            for step in (0.01, 0.005, 0.0025):
                self.steps_of(ranks, self.falling(step))
                errors.append(self.distance("fine", "run"))
            # Errors C h have C h (1 - 1/32), C h (1/2 - 1/32), ... with this reference. The next term of the error halves.
            first, second = (exact - order for order, exact in zip(self.orders(errors), (math.log2(31 / 15), math.log2(15 / 7))))
            self.assertLess(abs(first), 0.2, f"{ranks} ranks: {errors}")
            self.assertLess(abs(second), 0.7 * abs(first), f"{ranks} ranks: {errors}")

    BAR = """gravity = [50, 0, 0]
[time]
integrator = "quasi_static"
step = 1
duration = 1
[solver]
tolerance = 1e-10
linear = "multigrid"
[output]
vtu = false
[[body]]
name = "bar"
shape = {{ box = {{ upper = [0.4, 0.1, 0.1], cells = [{0}, {1}, {1}] }} }}
material = {{ model = "stvk", young = 1e5, poisson = 0.3 }}
[[body.pin]]
name = "wall"
where = "x < 1e-9"
[[body.pin]]
name = "guide"
where = "x > 1e-9"
axes = "yz"
"""

    def energy_of_bar(self):
        """Least energy of a hanging bar that cannot contract laterally: psi = M (s^2 - 1)^2 / 8, P = M s (s^2 - 1) / 2."""
        young, poisson, load, length, area, n = 1e5, 0.3, 1000 * 50, 0.4, 0.01, 1000
        modulus = young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson))
        total = 0
        for i in range(n + 1):  # Simpson's rule
            stress, s = load * length * (1 - i / n), 1.0
            for _ in range(30):
                s -= (modulus * s * (s * s - 1) / 2 - stress) / (modulus * (3 * s * s - 1) / 2)
            weight = (1 if i in (0, n) else 4 if i % 2 else 2) * length / n / 3
            total += weight * area * (modulus / 8 * (s * s - 1)**2 - stress * (s - 1))
        return total

    def test_equilibria_of_linear_tets_have_energies_of_order_two(self):
        exact, weight = self.energy_of_bar(), 1000 * 0.4 * 0.1 * 0.1 * 50
        for ranks in self.COUNTS:
            errors = []
            for n in (1, 2, 4):
                row = self.steps_of(ranks, self.BAR.format(4 * n, n))[-1]
                errors.append(row["potential_total"] - self.first_row()["potential_total"] - exact)
                self.assertAlmostEqual(row["reaction_bar.wall_x"], -weight, delta=1e-6 * weight)
            self.assertGreater(min(errors), 0, "a conforming method overestimates the energy")
            orders = self.orders(errors)
            self.assertGreater(orders[0], 1.8, f"{ranks} ranks: {errors}")
            self.assertAlmostEqual(orders[1], 2, delta=0.1, msg=f"{ranks} ranks: {errors}")


class Shares(Ranks):
    """Memory, iterations and communication of the ranks."""

    def test_memory_halves_when_ranks_double(self):
        self.mpi(1, "run", self.scene(), "--steps", "1", "--out", "small", "--quiet")
        process = self.ranks("small")[0]["peak_bytes"]
        scene = self.scene(cells="48, 12, 12", solver='linear = "multigrid"')
        peaks = {}
        for n in (1, 2, 4):
            self.mpi(n, "run", scene, "--steps", "1", "--set", "solver.tolerance=1e-4", "--out", f"on{n}", "--quiet")
            ranks = self.ranks(f"on{n}")
            self.assertEqual(sum(rank["vertices"] for rank in ranks), 49 * 13 * 13)
            peaks[n] = max(rank["peak_bytes"] for rank in ranks) - process
        self.assertLess(peaks[1], 12000 * 49 * 13 * 13)
        self.assertLess(peaks[2], 0.65 * peaks[1])  # ghosts and buffers of MPI come on top of one half
        self.assertLess(peaks[4], 0.70 * peaks[2])

    def test_auto_chooses_by_predicted_cost(self):
        """Soft bodies and short steps: block-Jacobi. Equilibria: multigrid, whose coarse space adds a gather."""
        for solver in ("auto", "block_jacobi"):
            self.mpi(2, "run", self.scene(solver=f'linear = "{solver}"'), "--out", solver, "--quiet")
        self.assertEqual(self.column("auto", "state_hash"), self.column("block_jacobi", "state_hash"))
        scene = self.scene(time='integrator = "quasi_static"')
        for ranks, sums in ((1, 3), (3, 4)):
            self.mpi(ranks, "run", scene, "--out", "run", "--force", "--quiet")
            for rank in self.ranks("run"):
                self.assertAlmostEqual(rank["reductions_per_iteration"], sums, delta=0.2)
                # Two to each neighbor; GAMG has several levels.
                self.assertLess(rank["messages_per_iteration"], 2.5 * (ranks - 1) + 0.1)

    def test_gamg_replaces_multigrid_that_does_not_converge(self):
        """Nearly incompressible linear tets: GAMG solves the same system after 500 iterations, from the same start."""
        options = ("--set", "solver.max_iterations=1", "solver.tolerance=1e-4", "--steps", "1")
        for linear in ("auto", "multigrid"):
            scene = self.folder / self.scene(cells="24, 6, 6", young="1e7", solver=f'linear = "{linear}"')
            scene.write_text(scene.read_text().replace("poisson = 0.4", "poisson = 0.49999"))
            self.mpi(2, "run", scene, *options, "--out", linear, "--quiet", "--allow-unconverged")
        self.assertEqual(self.column("auto", "state_hash"), self.column("multigrid", "state_hash"))
        auto, gamg = (self.ranks(linear)[0]["linear_iterations"] for linear in ("auto", "multigrid"))
        self.assertEqual(auto, 500 + gamg)

    def test_communication_of_block_jacobi(self):
        """Per iteration a message to each neighbor and three sums: p'Hp, r'r and r'z."""
        self.mpi(2, "run", self.scene(solver='linear = "block_jacobi"'), "--out", "run", "--quiet")
        for rank in self.ranks("run"):
            self.assertGreater(rank["linear_iterations"], 100)
            self.assertAlmostEqual(rank["messages_per_iteration"], 1, delta=0.05)
            self.assertAlmostEqual(rank["reductions_per_iteration"], 3, delta=0.1)
        sent, ghosts = [sum(rank[name] for rank in self.ranks("run")) for name in ("bytes_per_iteration", "ghosts")]
        self.assertAlmostEqual(sent, 24 * ghosts, delta=0.05 * sent)

    def test_too_large_a_mesh_is_refused_before_it_is_made(self):
        begin = time.monotonic()
        said = self.mpi(2, "run", self.scene(cells="600, 600, 600"), code=2).stderr
        self.assertEqual(said.count("error:"), 1, said)
        self.assertIn("217081801 vertices on 2 ranks need about", said)
        self.assertIn("GB are free; use more machines", said)
        self.assertLess(time.monotonic() - begin, 60)
        said = self.mpi(1, "run", self.scene(cells="3000, 3000, 3000"), code=2).stderr
        self.assertIn("the scene has 1.62e+11 tets; at most 2147483647 are supported", said)


class Growth(Ranks):
    def iterations(self, ranks, linear, before_pin):
        scene = self.scene(cells="24, 6, 6", young="1e7", before_pin=before_pin, solver=f'linear = "{linear}"')
        options = ("--set", "solver.max_iterations=2", "--steps", "1")
        self.mpi(ranks, "run", scene, *options, "--out", "run", "--force", "--quiet", "--allow-unconverged")
        return self.ranks("run")[0]["linear_iterations"]

    def test_iterations_hardly_grow_with_ranks(self):
        twist = "deform = { twist = { axis = [1, 0, 0], angle_deg = 90 } }\n"
        for linear in ("multigrid", "auto"):  # 20 times as many without a coarse space
            for before_pin in ("", twist):
                counts = {n: self.iterations(n, linear, before_pin) for n in (1, 4, 16)}
                self.assertLessEqual(max(counts.values()), 1.5 * counts[1], f"{linear} {before_pin}: {counts}")


class SameBits(Ranks):
    def assert_same_bits(self, scene):
        for run in ("one", "other"):
            self.mpi(2, "run", scene, "--out", run, "--quiet")
        self.assert_same_results("one", "other", (".vtu", ".pvtu", ".pvd", ".bin"))
        self.assertEqual(self.column("one", "state_hash")[-1], state_hash(checkpoint(self.folder / "one/checkpoint.bin")))
        self.mpi(2, "run", scene, "--out", "part", "--steps", "1", "--quiet")
        shutil.copytree(self.folder / "part", self.folder / "elsewhere")
        self.mpi(2, "run", "part", "--resume", "--quiet")
        self.assertEqual(self.column("one", "state_hash"), self.column("part", "state_hash"))
        self.mpi(3, "run", "elsewhere", "--resume", "--quiet")
        self.assertLess(self.distance("one", "elsewhere"), 1e-10)

    def test_same_bits_again_and_after_resuming(self):
        self.assert_same_bits(self.scene(solver='linear = "multigrid"'))

    def test_same_bits_with_the_coarse_space(self):
        self.assert_same_bits(self.scene(young="1e7", cells="24, 6, 6"))


class Refusals(Ranks):
    def assert_refused(self, key, **parts):
        text = (self.folder / self.scene(**parts)).read_text().splitlines()
        line = 1 + next(n for n, content in enumerate(text) if key in content)
        said = self.mpi(1, "run", "beam.toml", code=2).stderr
        self.assertEqual(said.count("error:"), 1, said)
        self.assertIn(f"beam.toml:{line}:", said)
        self.assertIn("is not supported by aspic-mpi; ", said)
        self.assertFalse((self.folder / "out").exists(), key)

    def test_names_the_line_of_a_key(self):
        for solver in ('linear = "cholesky"', 'method = "lbfgs"', 'fallback = ["lbfgs"]', "time_budget = 1",
                       'definiteness = "progressive"'):
            self.assert_refused(solver, solver=solver)
        for time_ in ('integrator = "bdf2"', "adaptive = { tolerance = 0.1 }"):
            self.assert_refused(time_, time=time_)
        where = 'where = "x > 0.3"\n'
        for body in ("damping = { viscosity = 1 }", "order = 2", "elastic = false", "[contact]", "friction = 0.1"):
            self.assert_refused(body, body=body if body[0] == "[" else "", before_pin=body if body[0] != "[" else "")
        for table, keys in (("spring", where + "stiffness = 1"), ("pressure", where + "value = 1"),
                            ("viscoelastic", "shear = 1\nrelaxation_time = 1"),
                            ("fibre", "direction = [1, 0, 0]\nstiffness = 1"),
                            ("muscle", "direction = [1, 0, 0]\nstrength = 1\nactivation = 1")):
            self.assert_refused(f"[[body.{table}]]", body=f"[[body.{table}]]\n{keys}")
        self.assert_refused("obj = true", output="obj = true")
        self.assert_refused("file =", body='[[body.traction]]\nwhere = { file = "s.ply", name = "a", above = 0.5 }\nvalue = [1, 0, 0]')

    def test_bad_input_is_reported_once(self):
        said = self.mpi(3, "run", self.scene(solver="tolerance = 1"), code=2).stderr
        self.assertEqual(said.count("beam.toml:"), 1, said)
        said = self.mpi(9, "run", self.scene(cells="1, 1, 1"), code=2).stderr
        self.assertEqual(said.count("the scene has 8 vertices for 9 ranks; use fewer ranks"), 1, said)


class Faults(Ranks):
    SECONDS = 60  # a second or two on processors without other work

    def rank_processes(self, launcher):
        """Returns {rank: process id} of the children of mpirun."""
        found = {}
        for path in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                if int((path / "stat").read_text().rsplit(")", 1)[1].split()[1]) != launcher.pid:
                    continue
                values = dict(v.split("=", 1) for v in (path / "environ").read_text().split("\0") if "=" in v)
                found[int(values["OMPI_COMM_WORLD_RANK"])] = int(path.name)
            except (OSError, KeyError):
                pass  # it has ended, or is not a rank
        return found

    def test_exception_on_one_rank_ends_all(self):
        for kind, code, text in (("input", 2, "mesh.msh:7: a test (rank 2)"), ("internal", 1, "a test (rank 2)")):
            begin = time.monotonic()
            self.assertIn(text, self.mpi(3, kind, code=code, program="MPI_EXCEPTION").stderr)
            self.assertLess(time.monotonic() - begin, self.SECONDS)

    def test_killed_rank_ends_the_run(self):
        for rank in (0, 1):
            run = f"killed{rank}"
            process = self.start_mpi(2, "run", self.scene(), "--set", "time.duration=100", "--out", run)
            self.addCleanup(process.kill)
            self.wait_for_steps(run, 1)
            os.kill(self.rank_processes(process)[rank], signal.SIGKILL)
            out, err = process.communicate(timeout=self.SECONDS)
            self.assertNotEqual(process.returncode, 0)
            self.assertIn("exited on signal 9 (Killed)", out + err)
            done = len(self.steps(run))
            self.mpi(2, "run", run, "--resume", "--steps", str(done + 1), "--quiet")
            self.assertEqual(self.column(run, "step")[-1], str(done + 1))

    def test_signals_stop_after_a_step(self):
        process = self.start_mpi(2, "run", self.scene(), "--set", "time.duration=100", "--out", "run")
        self.addCleanup(process.kill)
        self.wait_for_steps("run", 1)
        process.send_signal(signal.SIGUSR1)  # mpirun forwards it
        out, err = process.communicate(timeout=self.SECONDS)
        self.assertEqual(process.returncode, 4, out + err)
        self.assertIn("continue   mpirun -n 2 aspic-mpi run run --resume", out)
        self.assertNotIn("\x1b", out)
        steps = len(self.steps("run"))
        process = self.start_mpi(2, "run", "run", "--resume")
        self.addCleanup(process.kill)
        self.wait_for_steps("run", steps + 1)
        for pid in self.rank_processes(process).values():  # mpirun itself ends all ranks at once
            os.kill(pid, signal.SIGTERM)
        out, err = process.communicate(timeout=self.SECONDS)
        self.assertEqual(process.returncode, 128 + signal.SIGTERM, out + err)
        self.assertGreater(len(self.steps("run")), steps)
        self.assertEqual(self.column("run", "state_hash")[-1], state_hash(checkpoint(self.folder / "run/checkpoint.bin")))


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""Hard cases of contact through the program, with exact checks of every frame. tools/contact_cases runs longer ones.

usage: ASPIC=path/to/aspic contact_test.py [TestCase...]"""
import csv
import dataclasses
import math
import pathlib
import shutil
import struct
import subprocess
import tempfile
import tomllib
import unittest

import contact_cases
import contact_scenes
import exact_surfaces as exact
from contact_scenes import ASPIC, body, case
from contact_shapes import box, placed, spike

SCENES = pathlib.Path(__file__).resolve().parents[1] / "scenes"


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_contact_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def run_scene(self, text):
        (self.folder / "scene.toml").write_text(text)
        return subprocess.run([ASPIC, "run", "scene.toml", "--out", "run", "--force"], cwd=self.folder, capture_output=True, text=True,
                              timeout=600)

    def run_cases(self, cases):
        for number, one in enumerate(cases):
            with self.subTest(one.name):
                outcome = contact_scenes.run(one, self.folder / str(number))
                self.assertEqual(outcome.faults, [], outcome.line())


class Exact(Folder):
    TRIANGLE = ((0., 0., 0.), (1., 0., 0.), (0., 1., 0.))

    def test_edges_and_triangles(self):
        meets = lambda p, q: exact.edge_meets_triangle(p, q, self.TRIANGLE)
        for p, q in (((.2, .2, -1.), (.2, .2, 1.)), ((.2, .2, 0.), (.2, .2, 1.)), ((2., .2, 0.), (-1., .2, 0.)),
                     ((.5, .5, 0.), (1., 1., 0.)), ((0., 0., -1.), (0., 0., 1.)), ((.5, -1., -1.), (.5, 1., 1.)), ((1., 0., 0.), (3., 0., 0.))):
            self.assertTrue(meets(p, q), (p, q))
        for p, q in (((.2, .2, 1e-300), (.2, .2, 1.)), ((2., 2., 0.), (1., 1., 0.)), ((.6, .6, -1.), (.6, .6, 1.)),
                     ((-1e-300, .5, -1.), (-1e-300, .5, 1.)), ((2., 0., 0.), (3., 0., 0.)),
                     ((1., 1., 1.), (2., 2., 1.))):
            self.assertFalse(meets(p, q), (p, q))

    def test_a_point_is_inside_or_outside(self):
        points, tets = box()
        surface = exact.Surface("box", points, exact.boundary(tets), False)
        self.assertTrue(exact.is_closed(surface))
        for point, expected in (((0., .5, 0.), True), ((.49, .01, .49), True), ((.51, .5, 0.), False), ((0., -1e-300, 0.), False)):
            self.assertEqual(exact.is_inside(point, surface), expected, point)

    def test_bodies_without_contact_intersect(self):
        crossing = case("crossing", [body("lower", spike()), body("upper", placed(spike(), (0, 6.05, 0), flip=True), more="velocity = [0, -10, 0]")],
                        h=.01, steps=5, gravity=(0, 0, 0))
        crossing.scene = crossing.scene.replace("[contact]\n", "")
        faults = contact_scenes.run(crossing, self.folder).faults
        self.assertTrue(any("intersections" in fault for fault in faults), faults)


class Bdf2(Folder):
    """Motions measured in the frames, with the formulas of the scheme."""

    def positions(self, integrator, h, steps, gravity, contact="", more=""):
        one = case("block", [body("block", box((-.05, .0005, -.05), (.05, .0255, .05), (4, 1, 4)), 1e7, .3, more=more)],
                   planes=[((0., 0., 0.), (0., 1., 0.))], h=h, steps=steps, gravity=gravity, contact=contact)
        one.scene = one.scene.replace("[time]\n", f'[time]\nintegrator = "{integrator}"\n')
        outcome = contact_scenes.run(one, self.folder / integrator)
        self.assertEqual(outcome.faults, [], outcome.line())
        return [frame[0].points for frame in outcome.frames]

    def test_a_block_slides_with_the_acceleration_of_coulomb(self):
        h, mu, slope, g = .01, .5, math.atan(.6), 9.81
        frames = self.positions("bdf2", h, 50, (g * math.sin(slope), -g * math.cos(slope), 0), f"friction = {mu}")
        x = [sum(p[0] for p in points) / len(points) for points in frames]
        rate = lambda values, n: (3 * values[n] - 4 * values[n - 1] + values[n - 2]) / (2 * h)  # of order 2, as in the scheme
        v = [0., 0.] + [rate(x, n) for n in range(2, len(x))]
        expected = g * (math.sin(slope) - mu * math.cos(slope))
        for n in range(40, 51):
            self.assertAlmostEqual(rate(v, n), expected, delta=5e-3 * expected)

    def test_a_spinning_block_keeps_its_angular_velocity(self):
        h, omega, steps = .01, 2 * math.pi, 100
        left = {}
        for integrator in ("backward_euler", "bdf2"):
            frames = self.positions(integrator, h, steps, (0, -9.81, 0), more=f"angular_velocity = [0, {omega}, 0]")

            def angle(before, after):  # of the rotation about y that fits best
                center = [[sum(p[k] for p in points) / len(points) for k in range(3)] for points in (before, after)]
                a, b = ([(p[2] - c[2], p[0] - c[0]) for p in points] for points, c in zip((before, after), center))
                return math.atan2(sum(p[0] * q[1] - p[1] * q[0] for p, q in zip(a, b)), sum(p[0] * q[0] + p[1] * q[1] for p, q in zip(a, b)))
            left[integrator] = angle(frames[-2], frames[-1]) / (h * omega)
        self.assertAlmostEqual(left["backward_euler"], 1 / math.sqrt(1 + 2 * h * omega ** 2 * h * steps), delta=.03)
        self.assertGreater(left["bdf2"], .99)

    def test_moving_obstacles_give_equal_bits_in_any_threads_and_after_a_restart(self):
        def state(*options):
            done = subprocess.run([ASPIC, "run", *options], cwd=self.folder, capture_output=True, text=True, timeout=600)
            self.assertEqual(done.returncode, 0, done.stderr)
            return [line for line in done.stdout.splitlines() if line.startswith("state")]
        scene = [str(SCENES / "rollers.toml"), "--set", "time.integrator=bdf2"]
        expected = state(*scene, "--steps", "16", "--threads", "1", "--out", "one")
        self.assertEqual(state(*scene, "--steps", "16", "--threads", "3", "--out", "three"), expected)
        state(*scene, "--steps", "9", "--out", "halves")
        self.assertEqual(state("halves", "--resume", "--steps", "16"), expected)


def toml_text(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_text(v)}" for key, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_text, value)) + "]"
    return f'"{value}"' if isinstance(value, str) else repr(value).lower() if isinstance(value, bool) else repr(value)


class Scenes(Folder):
    """Every scene with contact, all frames. Moving obstacles are excluded."""

    def obstacle(self, given):
        """The surface of an obstacle, from a body of the same shape at the same place."""
        place = {key: given[key] for key in ("scale", "rotate", "translate") if key in given}
        if "mesh" in given:
            self.assertEqual(set(place) - {"translate"}, set(), "only translations are supported here")
            points, triangles = exact.read_obj(SCENES / given["mesh"])
            shift = place.get("translate", [0, 0, 0])
            return exact.Surface(given["name"], [tuple(a + b for a, b in zip(p, shift)) for p in points], triangles, True)
        keys = {"shape": given["shape"], **place, "material": {"young": 1e5, "poisson": .3, "density": 1000}}
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder))
        (folder / "scene.toml").write_text("gravity = [0, 0, 0]\n[time]\nduration = 0.01\n[[body]]\n" +
                                           "".join(f"{k} = {toml_text(v)}\n" for k, v in keys.items()))
        subprocess.run([ASPIC, "run", "scene.toml", "--out", "run", "--quiet"], cwd=folder, check=True, timeout=600)
        return exact.body_surfaces(folder / "run/frames/body_000000.vtu")[0]._replace(name="obstacle", is_obstacle=True)

    def test_frames_do_not_intersect(self):
        checked = 0
        for path in sorted(SCENES.glob("**/*.toml")):
            scene = tomllib.loads(path.read_text())
            if "contact" not in scene and "obstacle" not in scene:
                continue
            checked += 1
            with self.subTest(path.name):
                out = self.folder / path.stem
                subprocess.run([ASPIC, "run", path, "--out", out, "--quiet"], timeout=600, check=True)
                still = [o for o in scene.get("obstacle", []) if "motion" not in o]
                planes = [(o["plane"].get("origin", [0, 0, 0]), o["plane"].get("normal", [0, 1, 0])) for o in still if "plane" in o]
                surfaces = [self.obstacle(o) for o in still if "shape" in o or "mesh" in o]
                frames = [exact.body_surfaces(p) for p in sorted((out / "frames").glob("body_*.vtu"))]
                self.assertEqual(contact_scenes.surface_faults(frames, surfaces, planes), [])
                self.assertGreater(len(frames), 10)
        self.assertGreater(checked, 0)


class Pairs(Folder):
    """Two blocks on one slope. Only one slides: x = a h^2 n (n + 1) / 2 with a = g (sin - mu cos)."""

    def test_friction_of_a_pair(self):
        block = "[[body]]\nname = \"{}\"\nshape = {{ box = {{ lower = [{}, 0.0002, 0], upper = [{}, 0.1002, 0.2], cells = [4, 2, 4] }} }}\n" \
                "material = {{ young = 1e7, poisson = 0.3, density = 1000 }}\n"
        sine, cosine, h, steps = .28, .96, .01, 60
        text = f"gravity = [{9.81 * sine}, {-9.81 * cosine}, 0]\n[time]\nstep = {h}\nduration = {h * steps}\n[output]\nevery = {h}\n" \
               "[contact]\nfriction = 0.5\nreach = 0.0005\n[[contact.pair]]\nbetween = [\"smooth\", \"floor\"]\nfriction = 0.1\n" \
               "[[obstacle]]\nname = \"floor\"\nplane = {}\n" + block.format("smooth", 0, .2) + block.format("rough", 1, 1.2)
        done = self.run_scene(text)
        self.assertEqual(done.returncode, 0, done.stderr)
        frames = [exact.body_surfaces(p) for p in sorted((self.folder / "run/frames").glob("body_*.vtu"))]
        moved = []
        for start, end in zip(frames[0], frames[-1]):
            used = {c for t in start.triangles for c in t}
            moved.append(sum(end.points[c][0] - start.points[c][0] for c in used) / len(used))
        slid = .5 * 9.81 * (sine - .1 * cosine) * h * h * steps * (steps + 1)
        self.assertAlmostEqual(moved[0] / slid, 1, delta=.01)
        self.assertLess(abs(moved[1]), 1e-3 * slid)


def distance_to_triangle(p, corners):
    """Distance of a point from a triangle in floating point: to its plane if the foot is inside, else to the nearest edge."""
    a, b, c = corners
    sub = lambda x, y: [x[i] - y[i] for i in range(3)]
    dot = lambda x, y: sum(i * j for i, j in zip(x, y))
    u, v, w = sub(b, a), sub(c, a), sub(p, a)
    det = dot(u, u) * dot(v, v) - dot(u, v) ** 2
    s, t = ((dot(v, v) * dot(u, w) - dot(u, v) * dot(v, w)) / det, (dot(u, u) * dot(v, w) - dot(u, v) * dot(u, w)) / det)
    feet = [[a[i] + s * u[i] + t * v[i] for i in range(3)]] if min(s, t, 1 - s - t) >= 0 else []
    for x, y in ((a, b), (b, c), (c, a)):
        e = sub(y, x)
        k = max(0, min(1, dot(e, sub(p, x)) / dot(e, e)))
        feet.append([x[i] + k * e[i] for i in range(3)])
    return min(math.dist(p, foot) for foot in feet)


class Round(Folder):
    """Spheres and capsules: every triangle of every frame stays outside the radius."""

    SCENE = """[time]
step = 0.01
duration = 0.4
[output]
every = 0.02
[contact]
friction = 0.3
[[body]]
name = "sheet"
shape = { box = { lower = [-0.5, 0.32, -0.5], upper = [0.5, 0.38, 0.5], cells = [8, 1, 8] } }
material = { young = 5e4, poisson = 0.4, density = 1000 }
[[body]]
name = "block"
shape = { box = { lower = [0.9, 0.32, -0.1], upper = [1.1, 0.52, 0.1], cells = [1, 1, 1] } }
material = { young = 5e4, poisson = 0.4, density = 1000 }
[[obstacle]]
name = "ball"
sphere = { center = [0, 0, 0], radius = 0.3 }
motion = { displacement = ["0.1 * t", 0, 0] }
[[obstacle]]
name = "rod"
capsule = { from = [1.05, 0.2, -1], to = [1.05, 0.2, 1], radius = 0.05 }
"""

    def test_triangles_stay_outside(self):
        done = self.run_scene(self.SCENE)
        self.assertEqual(done.returncode, 0, done.stderr)
        gaps = {"ball": math.inf, "rod": math.inf}
        for number, file in enumerate(sorted((self.folder / "run/frames").glob("body_*.vtu"))):
            for surface in exact.body_surfaces(file):
                for triangle in surface.triangles:
                    corners = [surface.points[c] for c in triangle]
                    gaps["ball"] = min(gaps["ball"], distance_to_triangle((.002 * number, 0, 0), corners) - .3)
                    for k in range(41):
                        gaps["rod"] = min(gaps["rod"], distance_to_triangle((1.05, .2, -1 + .05 * k), corners) - .05)
        for name, gap in gaps.items():
            self.assertGreater(gap, 0, name)
            self.assertLess(gap, .01, name + " was not touched")

    def test_overlap_and_rotation_are_refused(self):
        for old, new, words in (("radius = 0.3", "radius = 0.35", "overlap in the initial state: "), ("radius = 0.05 }", "radius = 0 }", "radius"),
                                ('{ displacement = ["0.1 * t", 0, 0] }', "{ rotate = { axis = [0, 1, 0], rate_deg = 5 } }", "do not rotate")):
            done = self.run_scene(self.SCENE.replace(old, new))
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)


class Recorded(Folder):
    """An obstacle from a point cache equals one with the same keyframes."""

    SCENE = """[time]
step = 0.015625
duration = 0.5
[output]
every = 0.0625
[contact]
friction = 0.5
[[body]]
shape = {{ box = {{ lower = [-0.1, 0.01, -0.1], upper = [0.1, 0.21, 0.1], cells = [3, 3, 3] }} }}
material = {{ young = 1e5, poisson = 0.4, density = 1000 }}
[[obstacle]]
name = "table"
mesh = "table.obj"
{}
"""
    CORNERS = ((-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1))
    HEIGHTS = (0, .125, .0625)  # at frames 2, 6, 10 of 32 per second

    def run_motion(self, motion, points=4, samples=None, value=0.):
        samples = len(self.HEIGHTS) if samples is None else samples
        (self.folder / "table.obj").write_text("".join("v %g %g %g\n" % c for c in self.CORNERS) + "f 1 3 2\nf 1 4 3\n")
        data = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, points, 2, 4, samples)
        data += b"".join(struct.pack("<3f", x + value, y + height, z) for height in self.HEIGHTS for x, y, z in self.CORNERS)
        (self.folder / "table.pc2").write_bytes(data)
        return self.run_scene(self.SCENE.format(motion))

    def positions(self, motion):
        done = self.run_motion(motion)
        self.assertEqual(done.returncode, 0, done.stderr)
        last = sorted((self.folder / "run/frames").glob("body_*.vtu"))[-1]
        return [x for surface in exact.body_surfaces(last) for point in surface.points for x in point]

    RECORDING = 'recording = { file = "table.pc2", fps = 32 }'

    def test_moves_as_keyframes(self):
        recorded = self.positions(self.RECORDING)
        keys = ", ".join(f"{{ time = {frame / 32}, displacement = [0, {height}, 0] }}" for frame, height in zip((2, 6, 10), self.HEIGHTS))
        for x, y in zip(recorded, self.positions(f"motion = {{ keyframes = [{keys}] }}")):
            self.assertAlmostEqual(x, y, delta=1e-9)
        self.assertGreater(min(recorded[1::3]), .0625)

    def test_bad_caches_are_refused(self):
        for keys, words in (({"points": 3}, "3 points, but the mesh has 4 vertices"), ({"samples": 9}, "cut short"), ({"samples": 0}, "no samples"),
                            ({"value": math.nan}, "point 0 of sample 0 is not finite")):
            done = self.run_motion(self.RECORDING, **keys)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)
            self.assertIn("scene.toml:14:", done.stderr)
        for motion, words in ((self.RECORDING + '\nmotion = { linear = { velocity = [0, 0, 0] } }', "exclude each other"),
                              ("recording = { file = 'table.obj' }", "point cache")):
            done = self.run_motion(motion)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)


class Start(Folder):
    """Gaps, touching surfaces and enclosed parts in the initial state."""

    HEAD = "[time]\nstep = 0.01\nduration = 0.1\n[output]\nreport = false\n"
    CUBE = '[[body]]\nname = "cube"\nshape = { box = { upper = [1, 1, 1], cells = [2, 2, 2] } }\nmaterial = { young = 1e5 }\n'
    FLOOR = '[[obstacle]]\nname = "floor"\nplane = { origin = [0, HEIGHT, 0] }\n'
    FOUNDATION = ('[[body]]\nname = "foundation"\nshape = { box = { lower = [-1, -0.5, -1], upper = [2, 0, 2], cells = [6, 2, 6] } }\n'
                  'material = { young = 1e5 }\n[[body.pin]]\nwhere = "y < -0.499"\n')

    def steps(self):
        with open(self.folder / "run/steps.csv", newline="") as table:
            return list(csv.DictReader(table))

    def test_nothing_pushes_at_the_start(self):
        done = self.run_scene("gravity = [0, 0, 0]\n" + self.HEAD + self.CUBE + self.FLOOR.replace("HEIGHT", "-0.005"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("contact of cube and floor begins at 0.001 m: a fifth of their gap at the start, 0.005 m", done.stdout)
        self.assertNotIn("warning", done.stderr)
        self.assertEqual({float(row["potential_contact"]) for row in self.steps()}, {0.})

    def test_energy_at_the_start_is_a_warning(self):
        done = self.run_scene(self.HEAD + self.CUBE + self.FLOOR.replace("HEIGHT", "-0.005") + "[contact]\nreach = 0.02\n")
        self.assertRegex(done.stderr, r"warning: contact stores [\d.e+]+ J at the start and pushes bodies apart, most cube and floor, "
                                      r"whose gap of 0.005 m .*; choose a smaller contact.reach")
        self.assertRegex(done.stdout, r"start +contact stores")

    def test_touching_surfaces_start(self):
        for other, name in ((self.FLOOR.replace("HEIGHT", "0"), "cube and floor"), (self.FOUNDATION, "cube and foundation"),
                            (self.FLOOR.replace("HEIGHT", "1e-9"), "cube and floor")):
            done = self.run_scene(self.HEAD + "[contact]\n" + self.CUBE + other)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertRegex(done.stdout, "surfaces touch at the start: .*" + "|".join((name, " and ".join(name.split(" and ")[::-1]))))
            self.assertNotIn("warning", done.stderr)
            highest = max(vertex[1] for path in sorted((self.folder / "run/frames").glob("body_*.vtu"))
                          for surface in exact.body_surfaces(path) for vertex in surface.points)
            self.assertLess(highest, 1.001)  # nothing is thrown off

    def test_excess_of_a_pressed_force_is_estimated(self):
        plate = ('[[obstacle]]\nname = "plate"\nplane = { origin = [0, 1.001, 0], normal = [0, -1, 0] }\n'
                 'motion = { displacement = [0, "-0.01 * t", 0] }\n')
        held = '[[body.pin]]\nname = "base"\nwhere = "y < 0.001"\naxes = "y"\n[[body.pin]]\nwhere = "x < 0.001"\naxes = "x"\n' \
               '[[body.pin]]\nwhere = "z < 0.001"\naxes = "z"\n'
        cube = self.CUBE.replace("young = 1e5", 'model = "linear", young = 1e5, poisson = 0.3')
        done = self.run_scene('gravity = [0, 0, 0]\n[time]\nintegrator = "quasi_static"\nstep = 0.5\nduration = 1\n[output]\nreport = false\n'
                              "[solver]\ntolerance = 1e-8\n" + cube + held + plate)
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.steps()[-1]
        exact, force = 1e5 * 0.009, abs(float(row["reaction_cube.base_y"]))
        self.assertLess(force / exact - 1, 0.0002 / 0.009)
        self.assertAlmostEqual(float(row["contact_force_error"]), 1 - exact / force, delta=1e-4)
        self.assertAlmostEqual(float(row["gap_error"]), 0.0002, delta=1e-12)

    def test_what_pierces_a_body_is_named(self):
        (self.folder / "needle.obj").write_text("v 0.3 0.3 0.3\nv 0.3 0.32 -0.2\nv 0.3 0.34 -0.7\nf 1 2 3\n")
        for obstacle in ('mesh = "needle.obj"', "capsule = { from = [0.3, 0.3, 0.3], to = [0.3, 0.35, -0.7], radius = 0.01 }"):
            for start in ("apart", "inflate"):
                pinned = '[[body.pin]]\nwhere = "all"\n'
                done = self.run_scene(self.HEAD + f'[contact]\nstart = "{start}"\n' + self.CUBE + pinned + f'[[obstacle]]\nname = "pin"\n{obstacle}\n')
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertRegex(done.stderr, "surfaces intersect in the initial state: cube and pin near")

    def test_obstacles_inside_bodies_are_named(self):
        for obstacle in ("sphere = { center = [0.52, 0.51, 0.53], radius = 0.1 }",
                         "shape = { box = { lower = [0.4, 0.4, 0.4], upper = [0.6, 0.6, 0.6], cells = [1, 1, 1] } }"):
            done = self.run_scene(self.HEAD + self.CUBE + f'[[obstacle]]\nname = "core"\n{obstacle}\n')
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("obstacle 'core' starts inside of body 'cube'", done.stderr)
        drum = '[[obstacle]]\nname = "drum"\nshape = { box = { lower = [-1, -1, -1], upper = [2, 2, 2], cells = [1, 1, 1] } }\n'
        done = self.run_scene(self.HEAD + self.CUBE + drum)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("body 'cube' starts inside of obstacle 'drum', which contains it", done.stdout)


class Inflate(Folder):
    """Bodies that overlap in the initial state are separated on request."""

    SCENE = """[time]
step = 0.01
duration = 0.05
[output]
every = 0.01
[contact]
start = "inflate"
[[body]]
name = "cube"
shape = { box = { lower = [-0.1, 0.001, -0.1], upper = [0.1, 0.2, 0.1], cells = [4, 4, 4] } }
PIN
[[body]]
name = "ball"
shape = { sphere = { radius = 0.12, size = 0.06 } }
translate = [0.15, 0.15, 0.02]
[[obstacle]]
plane = {}
"""

    def test_bodies_come_apart(self):
        done = self.run_scene(self.SCENE.replace("PIN\n", ""))
        self.assertEqual(done.returncode, 0, done.stderr)
        frames = [exact.body_surfaces(p) for p in sorted((self.folder / "run/frames").glob("body_*.vtu"))]
        self.assertEqual(contact_scenes.surface_faults(frames, [], [((0, 0, 0), (0, 1, 0))]), [])
        volumes = self.volumes(frames[0])
        self.assertAlmostEqual(volumes[0] / (.2 * .199 * .2), 1, delta=.02)
        self.assertAlmostEqual(volumes[1] / (4 / 3 * math.pi * .12 ** 3), 1, delta=.15)  # a polyhedron

    def volumes(self, frame):
        result = []
        for surface in frame:
            corners = [[surface.points[c] for c in t] for t in surface.triangles]
            result.append(abs(sum(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
                                  for a, b, c in corners)) / 6)
        return result

    def test_eight_spheres_in_one_place_come_apart(self):
        ball = '[[body]]\nname = "ball{}"\nshape = {{ sphere = {{ radius = 0.1, size = 0.08 }} }}\ntranslate = [{}, {}, {}]\n'
        places = [(x, y, z) for x in (-.03, .03) for y in (-.025, .025) for z in (-.02, .02)]
        start = []
        for count in (1, 8):
            done = self.run_scene('gravity = [0, 0, 0]\n[time]\nstep = 0.01\nduration = 0.02\n[output]\nevery = 0.01\n[contact]\n'
                                  'start = "inflate"\n' + "".join(ball.format(i, *place) for i, place in enumerate(places[:count])))
            self.assertEqual(done.returncode, 0, done.stderr)
            frames = [exact.body_surfaces(p) for p in sorted((self.folder / "run/frames").glob("body_*.vtu"))]
            self.assertEqual(contact_scenes.surface_faults(frames, [], []), [])
            start.append(self.volumes(frames[0]))
        self.assertEqual(len(start[1]), 8)
        for volume in start[1]:
            self.assertAlmostEqual(volume / start[0][0], 1, delta=.02)

    def test_default_and_hopeless_overlap_are_refused(self):
        for old, new, words in (('"inflate"', '"apart"', "cube and ball near"),
                                ("translate = [0.15, 0.15, 0.02]", "translate = [0, 0.1, 0.02]", "body 'ball' starts inside of body 'cube'"),
                                ("translate = [0.15, 0.15, 0.02]", "translate = [0.15, -0.05, 0]", "starts behind the plane")):
            text = self.SCENE.replace("PIN", '[[body.pin]]\nwhere = "all"') if "inside" in words else self.SCENE
            done = self.run_scene(text.replace(old, new).replace("PIN\n", ""))
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(words, done.stderr)


class Shapes(Folder):
    def test_degenerate_shapes(self):
        self.run_cases(contact_cases.degenerate_shapes(20))

    def test_slivers_and_bad_surfaces(self):
        self.run_cases(c for c in contact_cases.slivers(8) if "1000" not in c.name)
        self.run_cases(contact_cases.bad_surfaces(10))

    def test_pins_against_obstacles(self):
        self.run_cases(contact_cases.pinned(15))
        self.run_cases(contact_cases.driven(4))

    def test_moving_obstacles(self):
        self.run_cases(contact_cases.moving(12))


class Extremes(Folder):
    def test_steps_moduli_and_friction(self):
        self.run_cases(contact_cases.numbers(10))

    def test_bullets(self):
        self.run_cases(c for c in contact_cases.bullets(10) if "free" not in c.name)

    def test_parallel_edges(self):
        self.run_cases(contact_cases.sliding_edges(60))

    def test_friction_at_round_off_ends(self):
        self.run_cases([dataclasses.replace(contact_cases.blow(9), codes=(0,))])

    def test_random_impacts(self):
        self.run_cases(contact_cases.GROUPS["impacts"](8))

    def test_crowds_and_tumbling_boxes(self):
        self.run_cases([*map(contact_cases.crowd, range(6)), contact_cases.tumble(0, 100)])


if __name__ == "__main__":
    unittest.main()

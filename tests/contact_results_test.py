#!/usr/bin/env python3
"""What a run with contact reports and writes, and how it continues, checked from outside.

usage: ASPIC=path/to/aspic contact_results_test.py [TestCase...]"""
import json
import math
import re
import subprocess
import unittest

import contact_cases
import contact_scenes
import exact_surfaces as exact
from command_line import ASPIC, CommandLine

# A block on a tilted floor. The slope is SINE / 0.96 and the coefficient of friction 0.5.
SLOPE = """gravity = [{}, -9.4176, 0]
[time]
step = 0.01
duration = 0.3
[output]
every = 0.01
[contact]
friction = 0.5
creep = 1e-4
[[obstacle]]
name = "floor"
plane = {{}}
[[body]]
name = "block"
shape = {{ box = {{ lower = [0, 0.0002, 0], upper = [0.1, 0.0502, 0.1], cells = [3, 2, 3] }} }}
material = {{ young = 1e6, poisson = 0.3, density = 1000 }}
"""
# A table rises and carries a cube, and a ball pushes the cube aside.
MOVED = """[time]
step = 0.01
duration = {duration}
[output]
every = 0.02
obj = true
usd = true
pc2 = true
[contact]
friction = 0.4
[[body]]
name = "cube"
shape = {{ box = {{ lower = [-0.1, 0.005, -0.1], upper = [0.1, 0.205, 0.1], cells = [3, 3, 3] }} }}
material = {{ young = 1e5, poisson = 0.4, density = 1000 }}
{pin}
[[obstacle]]
name = "table"
shape = {{ box = {{ lower = [-0.5, -0.1, -0.5], upper = [0.5, 0, 0.5], cells = [1, 1, 1] }} }}
motion = {{ displacement = [0, "{rise} * t", 0] }}
[[obstacle]]
name = "ball"
sphere = {{ center = [-0.2, 0.15, 0], radius = 0.08 }}
motion = {{ displacement = ["0.4 * t", 0, 0] }}
[[obstacle]]
name = "wall"
mesh = "wall.obj"
"""
WALL = "v 0.4 -1 -1\nv 0.4 1 -1\nv 0.4 0 1\nf 1 2 3\n"


def moved_scene(duration=.3, rise=.5, pin=""):
    return MOVED.format(duration=duration, rise=rise, pin=pin)


class Certificate(CommandLine):
    def run_slope(self, sine):
        self.write("slope.toml", SLOPE.format(9.81 * sine))
        lines = [json.loads(line) for line in self.aspic("run", "slope.toml", "--out", "run", "--json").stdout.splitlines()]
        frames = [exact.body_surfaces(p)[0] for p in sorted((self.folder / "run/frames").glob("body_*.vtu"))]
        return self.steps("run"), [line for line in lines if "friction_creep" in line], frames

    def test_creep_is_that_of_the_lowest_vertices(self):
        rows, _, frames = self.run_slope(.24)
        low = [i for i, p in enumerate(frames[0].points) if p[1] < .001]
        self.assertEqual(len(low), 16)
        for row, before, after in list(zip(rows, frames, frames[1:]))[-10:]:
            slip = max(math.hypot(after.points[i][0] - before.points[i][0], after.points[i][2] - before.points[i][2]) for i in low)
            self.assertAlmostEqual(float(row["friction_creep"]) / slip, 1, delta=1e-6)
            self.assertLess(slip, 1e-4 * .01)
            self.assertGreater(slip, 1e-2 * 1e-4 * .01)

    def test_sliding_contacts_do_not_creep(self):
        rows, _, _ = self.run_slope(.6)
        for row in rows[-5:]:
            self.assertEqual(float(row["friction_creep"]), 0)

    def test_names_the_pair_of_the_gap_and_ends_below_the_threshold(self):
        rows, lines, _ = self.run_slope(.24)
        weight, changes = 1000 * .1 * .05 * .1 * 9.81, []
        for row, line in list(zip(rows, lines))[-10:]:
            self.assertEqual(row["min_gap_pair"], "block and floor")
            self.assertEqual(line["min_gap_pair"], "block and floor")
            changes.append(float(row["friction_residual"]))
            self.assertEqual(line["friction_residual"], changes[-1])
            self.assertLess(changes[-1], 1e-3 * weight)
        self.assertGreater(max(changes), 0)
        apart = SLOPE.format(0).replace("0.0002", "0.5").replace("0.0502", "0.55").replace("duration = 0.3", "duration = 0.02")
        self.write("apart.toml", apart)
        self.aspic("run", "apart.toml", "--out", "apart")
        self.assertEqual([row["min_gap_pair"] for row in self.steps("apart")], ["", ""])


class Frames(CommandLine):
    def run_moved(self, scene, code=0):
        self.write("scene.toml", scene)
        self.write("wall.obj", WALL)
        return self.aspic("run", "scene.toml", "--out", "run", code=code)

    def test_obstacles_are_where_they_are_in_each_frame(self):
        self.run_moved(moved_scene())
        frames = self.folder / "run/frames"
        names = sorted(frames.glob("body_*.vtu"))
        start = exact.read_surface(frames / "obstacles_000000.vtu").points
        table, ball = exact.read_obj(frames / "obstacle_table_000000.obj")[0], exact.read_obj(frames / "obstacle_ball_000000.obj")[0]
        self.assertEqual(len(start), len(table) + len(ball) + 3)
        index = (self.folder / "run/run.pvd").read_text()
        for number, name in enumerate(names):
            t = .02 * number
            now = exact.read_surface(frames / f"obstacles_{number:06}.vtu").points
            for k, (before, after) in enumerate(zip(start, now)):
                up, right = (.5 * t, 0) if k < len(table) else (0, .4 * t) if k < len(table) + len(ball) else (0, 0)
                for x, y in zip((before[0] + right, before[1] + up, before[2]), after):
                    self.assertAlmostEqual(x, y, delta=1e-9)
            points, triangles = exact.read_obj(frames / f"obstacle_table_{number:06}.obj")
            for before, after in zip(table, points):
                self.assertAlmostEqual(after[1], before[1] + .5 * t, delta=1e-7)
            surfaces = exact.body_surfaces(name)
            self.assertEqual(exact.intersections(surfaces + [exact.Surface("table", points, triangles, True)]), [])
            self.assertIn(f'timestep="{t:.2g}" group="" part="1" file="frames/obstacles_{number:06}.vtu"', index)
        self.assertGreater(min(p[1] for p in surfaces[0].points), .5 * t, "the cube was not lifted")
        self.assertTrue((self.folder / "run/obstacles/obstacle_wall.obj").exists())
        self.assertFalse((frames / "obstacle_wall_000000.obj").exists(), "it does not move")

    def test_obstacle_that_waits_is_shown_where_it_waits(self):
        self.run_moved(moved_scene(pin='[[body.pin]]\nwhere = "all"', rise=5), code=3)
        for number in range(3, 10):
            low = min(p[1] for p in exact.read_surface(self.folder / f"run/frames/obstacles_{number:06}.vtu").points)
            self.assertLess(low, -.09, "the table is in the cube")
        numbers = [tuple(map(float, p)) for block in re.findall(r"points\.timeSamples = {(.*?)}", (self.folder / "run/run.usda").read_text(), re.S)
                   for p in re.findall(r"\(([^,()]+), ([^,()]+), ([^,()]+)\)", block)]
        self.assertTrue(numbers)
        self.assertLess(max(p[1] for p in numbers), .3)

    def test_later_frames_are_removed_and_written_again(self):
        self.run_moved(moved_scene())
        self.aspic("run", "scene.toml", "--out", "part", "--steps", "14")
        (self.folder / "part/frames/obstacles_000099.vtu").write_text("of a longer run")
        (self.folder / "part/frames/obstacle_table_000099.obj").write_text("of a longer run")
        self.aspic("run", "scene.toml", "--out", "part", "--resume")
        self.assert_same_results("run", "part")
        self.write("free.toml", moved_scene(duration=.02).split("[contact]")[0] + '[[body]]\nshape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }\n')
        self.aspic("run", "free.toml", "--out", "part", "--force")
        self.assertEqual(list((self.folder / "part").rglob("obstacle*")), [])


class Continued(CommandLine):
    """Runs with contact, friction and moving obstacles that end early."""

    def setUp(self):
        super().setUp()
        self.write("scene.toml", moved_scene())
        self.write("wall.obj", WALL)

    def test_time_limits_and_resumed_runs_give_equal_bits(self):
        self.aspic("run", "scene.toml", "--out", "whole")
        limit, ends, rows, how = .02, 0, 0, []
        for _ in range(200):
            done = subprocess.run([ASPIC, "run", "scene.toml", "--out", "run", "--time-limit", str(limit), *how], cwd=self.folder,
                                  capture_output=True, text=True, timeout=120)
            if done.returncode == 0:
                break
            self.assertEqual(done.returncode, 4, done.stderr)
            self.assertIn(f"--time-limit of {limit:g} s", done.stdout)
            ends, how, before, rows = ends + 1, ["--resume"], rows, len(self.steps("run"))
            limit *= 2 if rows == before else 1  # too short for a step of this machine
        self.assertGreater(ends, 0, "the run ended in time")
        self.assert_same_results("whole", "run")

    def test_checkpoint_in_the_middle_of_contact_gives_equal_bits(self):
        self.aspic("run", "scene.toml", "--out", "whole")
        for steps in ("7", "8", "20"):
            self.aspic("run", "scene.toml", "--out", "run", "--steps", steps, *(["--resume"] if steps != "7" else []))
        self.aspic("run", "scene.toml", "--out", "run", "--resume")
        self.assertTrue(all(int(row["contacts"]) for row in self.steps("run")[7:]))
        self.assert_same_results("whole", "run")

    def test_dropped_steps_resume_with_equal_bits(self):
        self.write("scene.toml", moved_scene(pin='[[body.pin]]\nwhere = "all"', rise=5))
        self.aspic("run", "scene.toml", "--out", "whole", code=3)
        self.aspic("run", "scene.toml", "--out", "run", "--steps", "12", code=3)
        self.aspic("run", "scene.toml", "--out", "run", "--resume", code=3)
        self.assertIn("undefined", {row["status"] for row in self.steps("run")})
        self.assert_same_results("whole", "run")

    def test_time_budget_ends_in_words_without_intersections(self):
        self.write("scene.toml", moved_scene() + "[solver]\ntime_budget = 1e-5\n")
        done = self.aspic("run", "scene.toml", "--out", "run")
        self.assertEqual({row["status"] for row in self.steps("run")}, {"budget"})
        self.assertIn("30 steps ended by solver.time_budget", done.stdout)
        for number, name in enumerate(sorted((self.folder / "run/frames").glob("body_*.vtu"))):
            table = exact.Surface("table", *exact.read_obj(self.folder / f"run/frames/obstacle_table_{number:06}.obj"), True)
            self.assertEqual(exact.intersections(exact.body_surfaces(name) + [table]), [])


def in_units(length, mass):
    """Two boxes that fall onto each other, a floor and a ball that moves; units of length [1/m] and mass [1/kg]."""
    pascal, density, m = mass / length, mass / length**3, length
    box = lambda name, low, high, cells: (
        f'[[body]]\nname = "{name}"\nshape = {{ box = {{ lower = {[x * m for x in low]}, upper = {[x * m for x in high]}, cells = {cells} }} }}\n'
        f"material = {{ young = {1e5 * pascal!r}, poisson = 0.4, density = {1000 * density!r} }}\nvelocity = [0, {-1 * m}, 0]\n")
    return (f"gravity = [0, {-9.81 * m}, 0]\n[time]\nstep = 0.01\nduration = 0.25\n[contact]\nfriction = 0.4\n"
            + box("lower", (0, .005, 0), (.1, .105, .1), [2, 2, 2]) + box("upper", (.03, .12, .04), (.12, .2, .12), [2, 1, 3])
            + f'[[obstacle]]\nname = "floor"\nplane = {{}}\n[[obstacle]]\nname = "ball"\nsphere = {{ center = [{.2 * m}, {.1 * m}, {.05 * m}], '
            f'radius = {.05 * m} }}\nmotion = {{ displacement = ["{-.3 * m} * t", 0, 0] }}\n')


class Units(CommandLine):
    def test_millimeters_and_megapascals_change_nothing_but_numbers(self):
        columns = ("status", "contacts", "min_gap_pair")
        runs = {}
        for name, units in (("m and kg", (1, 1)), ("mm and t", (1e3, 1e-3)), ("km and g", (1e-3, 1e3))):
            self.write("scene.toml", in_units(*units))
            self.aspic("run", "scene.toml", "--out", "run", "--force")
            runs[name] = self.steps("run")
        meters = runs["m and kg"]
        self.assertTrue(any(row["min_gap_pair"] == "lower and upper" for row in meters), "the boxes did not meet")
        self.assertTrue(any(int(row["friction_passes"]) > 1 for row in meters))
        for name, rows in runs.items():
            with self.subTest(name):
                self.assertEqual([[row[c] for c in columns] for row in rows], [[row[c] for c in columns] for row in meters])
                for column in ("iterations", "friction_passes"):  # round-off may decide whether an iteration updates friction
                    count, known = ([int(row[column]) for row in run] for run in (rows, meters))
                    self.assertLess(max(abs(a - b) for a, b in zip(count, known)), 5, column)
                    self.assertLess(abs(sum(count) - sum(known)), 0.05 * sum(known), column)


class Commands(CommandLine):
    def setUp(self):
        super().setUp()
        self.write("scene.toml", in_units(1, 1))

    def test_methods_agree_with_friction(self):
        text = self.aspic("compare", "scene.toml", "--methods", "newton,newton:clamped:cholesky", "--step", "14").stdout
        self.assertEqual(text.count("same minimizer"), 2, text)

    def test_derivatives_are_correct_in_contact(self):
        text = self.aspic("check", "scene.toml", "--derivatives").stdout
        for term in ("contact", "friction", "E"):
            for state in ("start", "deformed", "touching"):
                self.assertRegex(text, rf"(?m)^{term} +{state} .* passed$")


class Materials(CommandLine):
    """Contact with quadratic tets, fibres and Maxwell branches."""

    TISSUE = ('[[body.fibre]]\ndirection = ["1", "0.5", "0"]\nstiffness = 3e4\nexponent = 2\n'
              "[[body.viscoelastic]]\nshear = 3e4\nrelaxation_time = 0.05\n")

    def test_no_intersections_and_equal_bits_in_any_threads_and_after_a_restart(self):
        for order, tissue in ((2, ""), (1, self.TISSUE), (2, self.TISSUE)):
            with self.subTest(order=order, tissue=tissue):
                self.write("scene.toml", in_units(1, 1).replace("velocity = [0, -1, 0]\n", f"order = {order}\nvelocity = [0, -1, 0]\n{tissue}"))
                run = lambda out, *options: self.aspic("run", "scene.toml", "--out", out, "--force", *options)
                run("whole", "--threads", "1")
                for threads in ("2", "4"):
                    run("other", "--threads", threads)
                    self.assert_same_results("whole", "other")
                run("other", "--threads", "2", "--steps", "17")
                self.assertGreater(int(self.steps("other")[-1]["contacts"]), 0)
                self.aspic("run", "scene.toml", "--out", "other", "--resume")
                self.assert_same_results("whole", "other")
                frames = [exact.body_surfaces(p) for p in sorted((self.folder / "whole/frames").glob("body_*.vtu"))]
                self.assertEqual(contact_scenes.surface_faults(frames, [], [((0, 0, 0), (0, 1, 0))]), [])


class Failures(CommandLine):
    """Steps that contact makes fail are explained by it, with numbers."""

    def explained(self, case, *words):
        outcome = contact_scenes.run(case, self.folder / "case")
        self.assertEqual(outcome.faults, [])
        self.assertEqual(outcome.code, 3, outcome.line())
        for word in words:
            self.assertRegex(outcome.message, word)

    def test_squeezed_gap_is_named_with_the_step_that_it_allows(self):
        case = next(c for c in contact_cases.bullets(2) if c.name == "bullet 1000 m/s on free plate")
        case.limit = 600
        self.explained(case, r"contact limits the last step to [\d.e-]+: the gap between \w+ and \w+ is [\d.e-]+ m, "
                             r"[\d.e-]+ of the distance at which contact begins")

    def test_blocked_obstacles_are_named(self):
        case = next(c for c in contact_cases.moving(12) if c.name == "press without end")
        self.explained(case, "obstacles cannot move to their next positions", "press and cube")

    def test_directions_that_springs_spoil_are_followed_by_others(self):
        outcome = contact_scenes.run(contact_cases.crowd(36), self.folder / "case")
        self.assertEqual((outcome.faults, outcome.code), ([], 0), outcome.line())


if __name__ == "__main__":
    unittest.main()

#!/usr/bin/env python3
"""The command line as its users meet it: every command, every exit code, interruption and resumption.

usage: ASPIC=path/to/aspic cli_test.py [TestCase...]
"""
import atexit
import csv
import fcntl
import filecmp
import functools
import json
import os
import pathlib
import pty
import re
import select
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
import xml.etree.ElementTree

ASPIC = os.environ["ASPIC"]
MESHER = pathlib.Path(ASPIC).with_name("aspic-mesh")
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
    """The same mesh, its vertices and its tets from the last to the first."""
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
        """Without the row of the start, step 0."""
        with open(self.folder / run / "steps.csv", newline="") as file:
            return [row for row in csv.DictReader(file) if row["step"] != "0"]

    def assert_same_results(self, one, other):
        """To the bit, but for what the clock says."""
        left, right = self.folder / one, self.folder / other
        names = {p.relative_to(left) for p in left.rglob("*") if p.is_file()}
        self.assertEqual(names, {p.relative_to(right) for p in right.rglob("*") if p.is_file()})
        for suffix in (".vtu", ".pvd", ".pc2", ".usda", ".bin"):
            self.assertTrue(any(n.suffix == suffix for n in names), f"no {suffix} among the results")
        for name in sorted(names):
            if name.name != "timings.csv":
                self.assertTrue(filecmp.cmp(left / name, right / name, shallow=False), f"{name} differs")


class Help(CommandLine):
    def test_every_level_has_examples(self):
        for arguments in ([], ["run"], ["check"], ["convert"], ["materials"], ["minimize"], ["capture"], ["fit"], ["fit-curves"],
                          ["closed-loop"], ["verify"], ["modes"], ["schema"], ["completion"]):
            text = self.aspic(*arguments, "--help").stdout
            self.assertIn("Examples:", text)
            self.assertIn(" ".join(["  aspic", *arguments]), text)

    def test_version_states_how_the_program_was_built(self):
        text = self.aspic("--version").stdout
        for fact in ("aspic ", "compiler", "flags", "SIMD", "libraries"):
            self.assertIn(fact, text)

    def test_a_misspelt_command_is_corrected(self):
        self.assertIn("did you mean 'check'", self.aspic("chek", "x.mesh", code=2).stderr)

    def test_a_misspelt_option_is_corrected(self):
        self.assertIn("did you mean '--threads'", self.aspic("run", "x.toml", "--thread", "2", code=2).stderr)

    def test_a_file_without_a_command_is_told_about_run(self):
        self.write("box.mesh", box_mesh())
        self.assertIn("aspic run box.mesh", self.aspic("box.mesh", code=2).stderr)

    def test_no_arguments_show_the_help(self):
        self.assertIn("Examples:", self.aspic(code=2).stdout)


class Completion(CommandLine):
    def test_holds_every_option_of_the_help(self):
        script = self.aspic("completion", "bash").stdout
        page = self.aspic("completion", "man").stdout.replace("\\-", "-")
        for command in re.findall(r"(?m)^    ([a-z-]+)\)", script):
            options = "" if command == "mesh" else self.aspic(command, "--help").stdout.split("Examples:")[0]
            known = re.search(rf"(?m)^    {command}\) options='(.*)' ;;", script)[1].split()
            for option in re.findall(r"(?m)^  (?:-\w,)?(--[a-z-]+)", options):
                self.assertIn(option, known, command)
                self.assertIn(option, page)

    def test_bash_completes_commands_and_options(self):
        script = self.write("aspic.bash", self.aspic("completion", "bash").stdout)
        for words, expected in (("aspic mat", "materials"), ("aspic run x.toml --time", "--time-limit")):
            done = subprocess.run(["bash", "-c", f'source {script}; COMP_WORDS=({words}); COMP_CWORD=$((${{#COMP_WORDS[@]}} - 1)); '
                                   '_aspic; echo "${COMPREPLY[@]}"'], cwd=self.folder, capture_output=True, text=True)
            self.assertEqual((done.stdout, done.stderr), (expected + "\n", ""))

    @unittest.skipUnless(shutil.which("groff"), "needs groff")
    def test_the_man_page_is_well_formed(self):
        done = subprocess.run(["groff", "-man", "-Tascii", "-ww", "-z"], input=self.aspic("completion", "man").stdout,
                              capture_output=True, text=True)
        self.assertEqual(done.stderr, "")

    @unittest.skipUnless(shutil.which("zsh") or shutil.which("fish"), "needs zsh or fish")
    def test_other_shells_read_their_scripts(self):
        for shell in filter(shutil.which, ("zsh", "fish")):
            script = self.write("script", self.aspic("completion", shell).stdout)
            self.assertEqual(subprocess.run([shell, "-n", script], cwd=self.folder).returncode, 0)


class Materials(CommandLine):
    def test_each_has_a_formula(self):
        text = self.aspic("materials").stdout
        for name in ("neo_hookean", "neo_hookean_log", "stvk", "corotated"):
            self.assertRegex(text, rf"(?m)^{name}\n  psi = ")

    def test_json(self):
        listed = json.loads(self.aspic("materials", "--json").stdout)
        self.assertTrue(all(m["name"] and m["formula"] for m in listed))

    def test_a_misspelt_name_is_corrected(self):
        self.assertIn("did you mean 'neo_hookean'", self.aspic("materials", "neo_hokean", code=2).stderr)


class Minimize(CommandLine):
    def rows(self, *arguments, code=0):
        lines = self.aspic("minimize", *arguments, "--json", code=code).stdout.splitlines()
        return [json.loads(line) for line in lines[:-1]], json.loads(lines[-1])

    def test_newton_with_a_line_search_descends_to_the_known_minimum(self):
        for function in ("rosenbrock", "two_bump", "quadratic"):
            rows, end = self.rows(function)
            values = [row["value"] for row in rows] + [end["value"]]
            self.assertTrue(all(b < a for a, b in zip(values, values[1:])), function)
            self.assertLess(end["distance"], 1e-6, function)
            self.assertEqual(end["status"], "converged")

    def test_newton_without_a_line_search_overshoots(self):
        rows, _ = self.rows("rosenbrock", "--test", "none")
        values = [row["value"] for row in rows]
        self.assertTrue(any(b > a for a, b in zip(values, values[1:])))
        self.assertTrue(all(row["alpha"] == 1 for row in rows))

    def test_gradient_descent_crosses_the_valley_at_every_iteration(self):
        rows, end = self.rows("rosenbrock", "--method", "gradient_descent", "--max-iterations", "300", code=3)
        self.assertEqual(end["status"], "iteration_limit")
        # The part of each direction at right angles to the floor of the valley, y = x^2.
        across = [row["direction"][1] - 2 * row["x"][0] * row["direction"][0] for row in rows]
        self.assertEqual(len(across), 300)
        self.assertTrue(all(a * b < 0 for a, b in zip(across, across[1:])))

    def test_the_table_ends_in_words(self):
        text = self.aspic("minimize", "rosenbrock", "--start", "-0.8,0.6").stdout
        self.assertIn("from (-0.8, 0.6)", text)
        self.assertIn("converged after", text)
        self.assertIn("distance to the minimum at (1, 1)", text)

    def test_help_names_every_definiteness(self):
        text = self.aspic("minimize", "--help").stdout
        self.assertIn("auto, on_demand, progressive, clamped, absolute, exact", text)

    def test_a_function_without_a_model_to_minimize_is_not_blamed_on_the_projection(self):
        start = ("minimize", "--expression", "x", "--start", "1,2")
        self.assertNotIn("--definiteness", self.aspic(*start, code=3).stdout)
        self.assertIn("--definiteness on_demand", self.aspic(*start, "--definiteness", "exact", code=3).stdout)

    def test_a_number_that_overflows_has_no_sign(self):
        text = self.aspic("minimize", "--expression", "-exp(x^2+y^2)", "--start", "1,2", code=3).stdout
        self.assertIn("|g| = nan; nan was reached", text)
        self.assertNotIn("-nan", text)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs a device that is always full")
    def test_output_that_does_not_arrive_is_an_error(self):
        for arguments in (["--list"], ["rosenbrock", "--json"],
                          ["rosenbrock", "--json", "--method", "gradient_descent", "--max-iterations", "2000"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([ASPIC, "minimize", *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn("standard output: cannot be written", done.stderr)

    def test_a_flat_place_is_not_taken_for_the_minimum(self):
        self.assertIn("not the minimum", self.aspic("minimize", "two_bump", "--start", "4,4").stdout)

    def test_a_formula_of_your_own(self):
        _, end = self.rows("--expression", "cosh(x - 1) + 2 * (y + 0.5)^2", "--start", "2.5,1")
        self.assertAlmostEqual(end["x"][0], 1, places=5)
        self.assertAlmostEqual(end["x"][1], -0.5, places=5)

    def test_functions_without_a_bound_end_with_a_status(self):
        for formula, method, status in (("x + y", "gradient_descent", "iteration_limit"), ("x + y", "newton", "iteration_limit"),
                                        ("0 - exp(x)", "gradient_descent", "undefined")):
            _, end = self.rows("--expression", formula, "--start", "0,0", "--method", method, code=3)
            self.assertEqual(end["status"], status)
            self.assertFalse(end["converged"])

    def test_bad_input_names_the_remedy(self):
        for arguments, message in ((["rosenbrok"], "did you mean 'rosenbrock'"),
                                   (["rosenbrock", "--method", "newtn"], "did you mean 'newton'"),
                                   (["rosenbrock", "--test", "slid"], "did you mean 'slide'"),
                                   (["rosenbrock", "--criterion", "scal"], "did you mean 'scale'"),
                                   (["rosenbrock", "--start", "nan,1"], "two finite numbers"),
                                   (["rosenbrock", "--start", "1"], "two finite numbers"),
                                   (["rosenbrock", "--shrink", "1"], "at most 0.99"),
                                   (["--expression", "log(x)", "--start", "-1,0"], "not finite at the start"),
                                   (["--expression", "x + z", "--start", "0,0"], "unknown name 'z'"),
                                   (["--expression", "x^2"], "needs --start"),
                                   (["rosenbrock", "--plot", "a.jpeg"], ".svg or .png"),
                                   ([], "--list")):
            self.assertIn(message, self.aspic("minimize", *arguments, code=2).stderr)

    def test_every_listed_function_can_be_minimized(self):
        text = self.aspic("minimize", "--list").stdout
        names = re.findall(r"(?m)^(\w+)\n  f = ", text)
        self.assertEqual(len(names), 3)
        for name in names:
            self.aspic("minimize", name)

    def test_pictures_and_trace(self):
        self.aspic("minimize", "rosenbrock", "--plot", "path.svg", "--plot-model", "model.png", "--iteration", "6",
                   "--trace", "trace")
        self.assertEqual(xml.etree.ElementTree.parse(self.folder / "path.svg").getroot().tag.split("}")[-1], "svg")
        self.assertTrue((self.folder / "model.png").read_bytes().startswith(b"\x89PNG"))
        with open(self.folder / "trace" / "iterations.csv", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 18)

    def test_without_gnuplot_its_package_is_named_before_anything_is_done(self):
        done = subprocess.run([ASPIC, "minimize", "rosenbrock", "--plot", "path.svg"], cwd=self.folder,
                              capture_output=True, text=True, env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual(done.returncode, 2)
        self.assertIn("gnuplot-nox", done.stderr)
        self.assertEqual(done.stdout, "")


class Derivatives(CommandLine):
    def test_those_of_a_scene_are_right(self):
        text = self.aspic("check", self.beam(), "--derivatives", "--plot", "errors.svg").stdout
        for term in ("elasticity", "gravity", "inertia", "E"):
            for state in ("start", "rest", "deformed"):
                self.assertRegex(text, rf"(?m)^{term} +{state} .* passed$")
        self.assertIn("slope 2", (self.folder / "errors.svg").read_text())

    def test_json_has_the_error_for_every_step(self):
        lines = [json.loads(line) for line in self.aspic("check", self.beam(), "--derivatives", "--json").stdout.splitlines()]
        elastic = next(line for line in lines if line["term"] == "elasticity" and line["state"] == "deformed")
        self.assertEqual(len(elastic["gradient"]["error"]), 9)
        for what in ("gradient", "hessian"):
            self.assertAlmostEqual(elastic[what]["order"], 2, delta=0.1)

    def test_what_is_not_right_enough_is_named_with_its_own_exit_code(self):
        text = self.aspic("check", self.beam(), "--derivatives", "--tolerance", "1e-13", code=3).stdout
        self.assertRegex(text, r"(?m)^elasticity +deformed .* WRONG$")
        self.assertRegex(text, r"the gradient of elasticity \(deformed\) differs most at vertex \d+, [xyz] \(tet \d+\)")

    def test_vertices_and_tets_have_the_numbers_of_the_file(self):
        self.write("box.mesh", box_mesh())
        tets = [set(map(int, line.split()[:4])) for line in box_mesh().split("Tetrahedra\n48\n")[1].splitlines()[:48]]
        lines = self.aspic("check", "box.mesh", "--derivatives", "--tolerance", "1e-30", "--json", code=3).stdout
        named = re.findall(r'"vertex (\d+), [xyz](?:; vertex (\d+), [xyz])? \(tet (\d+)\)"', lines)
        self.assertGreater(len(named), 5)
        for vertex, other, tet in named:
            self.assertIn(int(vertex) + 1, tets[int(tet)])
            self.assertIn(int(other or vertex) + 1, tets[int(tet)])

    def test_options_that_do_not_go_together(self):
        self.assertIn("--derivatives", self.aspic("check", self.beam(), "--json", code=2).stderr)


class Check(CommandLine):
    def test_a_good_mesh_passes_with_its_quality(self):
        self.write("box.mesh", box_mesh())
        text = self.aspic("check", "box.mesh").stdout
        self.assertIn("27 vertices, 48 tets", text)
        self.assertIn("mean ratio", text)

    def test_an_inverted_tet_is_named_by_its_index(self):
        self.write("bad.mesh", box_mesh(flip=5))
        text = self.aspic("check", "bad.mesh", code=2).stdout
        self.assertRegex(text, r"error: inverted_tets: .*\n  indices: 5\n")

    def test_repair_mends_it(self):
        self.write("bad.mesh", box_mesh(flip=5))
        self.aspic("check", "bad.mesh", "--repair", "-o", "good.mesh")
        self.aspic("check", "good.mesh")

    def test_an_open_surface_is_an_error(self):
        self.write("open.obj", CUBE_OBJ.rsplit("f ", 1)[0])
        self.assertIn("open", self.aspic("check", "open.obj", code=2).stdout)

    def test_a_scene(self):
        self.assertIn("beam", self.aspic("check", self.beam()).stdout)

    def test_a_scene_is_judged_by_the_numbers_of_its_file(self):
        flat = box_mesh().split("\n")
        flat[4 + 13] = "0.5 0.5 0.9999 0"  # the center: the tets above it become slivers
        self.write("flat.mesh", "\n".join(flat))
        self.write("flat.toml", '[[body]]\nmesh = "flat.mesh"\n')
        of_mesh, of_scene = (self.aspic("check", name).stdout for name in ("flat.mesh", "flat.toml"))
        found = re.findall(r"(?m)^  indices: .*$", of_mesh)
        self.assertTrue(found)
        self.assertEqual(re.findall(r"(?m)^  indices: .*$", of_scene), found)

    def test_a_file_that_is_missing_or_broken(self):
        self.assertIn("none.mesh", self.aspic("check", "none.mesh", code=2).stderr)
        self.write("cut.mesh", box_mesh()[:200])
        self.assertIn("cut.mesh", self.aspic("check", "cut.mesh", code=2).stderr)
        self.write("nan.mesh", box_mesh().replace("0.5", "nan", 1))
        self.assertRegex(self.aspic("check", "nan.mesh", code=2).stderr, r"nan\.mesh:\d+")


class Convert(CommandLine):
    def test_tets_survive_the_round_trip(self):
        self.write("box.mesh", box_mesh())
        self.aspic("convert", "box.mesh", "box.msh", "--binary")
        self.aspic("convert", "box.msh", "box.vtu")
        self.aspic("convert", "box.vtu", "back.mesh")
        self.assertIn("27 vertices, 48 tets", self.aspic("check", "back.mesh").stdout)

    def test_tets_become_their_boundary_in_a_surface_format(self):
        self.write("box.mesh", box_mesh())
        self.assertIn("boundary", self.aspic("convert", "box.mesh", "box.obj").stdout)
        self.assertIn("26 vertices, 48 triangles", self.aspic("check", "box.obj").stdout)

    def test_an_unknown_extension_is_bad_input(self):
        self.write("box.mesh", box_mesh())
        self.assertIn(".xyz", self.aspic("convert", "box.mesh", "box.xyz", code=2).stderr)


@unittest.skipUnless(MESHER.exists(), "aspic-mesh was not built")
class Mesh(CommandLine):
    def test_a_closed_surface_is_filled(self):
        self.write("cube.obj", CUBE_OBJ)
        self.aspic("mesh", "cube.obj", "-o", "cube.mesh", "--size", "0.3")
        self.assertIn("tets", self.aspic("check", "cube.mesh").stdout)

    def test_a_surface_runs_without_a_scene(self):
        self.write("cube.obj", CUBE_OBJ)
        text = self.aspic("run", "cube.obj", "--steps", "2").stdout
        self.assertIn("note:", text)
        self.assertEqual(len(self.steps("out/cube")), 2)


class Run(CommandLine):
    def test_a_scene_ends_with_a_summary(self):
        text = self.aspic("run", self.beam()).stdout
        for part in ("done", "5 of 5", "iterations per step", "peak memory", "out/beam", ".pvd"):
            self.assertIn(part, text)
        self.assertEqual(len(self.steps("out/beam")), 5)

    def test_a_tet_mesh_runs_without_a_scene(self):
        self.write("box.mesh", box_mesh())
        self.assertIn("note:", self.aspic("run", "box.mesh", "--steps", "2").stdout)

    def test_the_summary_names_inverted_tets(self):
        self.write("box.mesh", box_mesh())
        upside_down = ["--set", "material.model=neo_hookean", "--set", 'deform.displacement=["-1.5*X",0,0]']
        text = self.aspic("run", "box.mesh", "--steps", "2", "--set", "time.step=1e-5", *upside_down).stdout
        self.assertRegex(text, r"inverted   \d+ tets at the end, the smallest det F is -0\.\d+ in tet \d+ at \(")
        self.assertRegex(text, r"some tet in 2 of 2 steps, first in step 1")

    def test_an_existing_run_is_kept_unless_forced(self):
        scene = self.beam()
        self.aspic("run", scene)
        self.assertIn("--force", self.aspic("run", scene, code=2).stderr)
        self.aspic("run", scene, "--force")

    def test_the_resolved_scene_gives_the_same_results(self):
        self.aspic("run", self.beam(), "--out", "a")
        shutil.copy(self.folder / "a/scene.toml", self.folder / "beam_again.toml")
        self.aspic("run", "beam_again.toml", "--out", "b")
        self.assert_same_results("a", "b")

    def test_results_do_not_depend_on_the_number_of_threads(self):
        scene = self.beam()
        self.aspic("run", scene, "--out", "one", "--threads", "1")
        self.aspic("run", scene, "--out", "three", "--threads", "3")
        self.assert_same_results("one", "three")

    def test_set_overrides_the_scene(self):
        scene = self.beam()
        lines = {}
        for young in ("1e5", "1e4"):
            out = self.aspic("run", scene, "--json", "--out", young, "--set", f"material.young={young}").stdout
            lines[young] = json.loads(out.splitlines()[-1])
        self.assertNotEqual(lines["1e5"]["potential_total"], lines["1e4"]["potential_total"])
        self.assertIn("material.yung", self.aspic("run", scene, "--set", "material.yung=1", code=2).stderr)

    def test_json_is_one_line_per_step_and_nothing_else(self):
        done = self.aspic("run", self.beam(), "--json")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([line["step"] for line in lines], [1, 2, 3, 4, 5])
        self.assertTrue(all(line["converged"] and line["iterations"] >= 1 for line in lines))
        self.assertIn("elasticity", lines[0]["potential"])
        self.assertIn("done", done.stderr)

    def test_json_names_the_worst_vertex_by_the_number_in_the_file(self):
        worst = []
        for text in (box_mesh(), reversed_mesh(box_mesh())):
            self.write("box.mesh", text)
            self.write("box.toml", '[[body]]\nmesh = "box.mesh"\nscale = [1, 1.1, 1.3]\n'
                                   'velocity = ["sin(3*Y + Z)", "X*Y", "cos(5*X)"]\n')
            out = self.aspic("run", "box.toml", "--json", "--force", "--steps", "2",
                             "--set", "solver.tolerance=0.1").stdout
            worst.append([json.loads(line)["worst_vertex"] for line in out.splitlines()])
        self.assertEqual(worst[1], [26 - vertex for vertex in worst[0]])

    def test_quiet_prints_nothing(self):
        done = self.aspic("run", self.beam(), "--quiet")
        self.assertEqual((done.stdout, done.stderr), ("", ""))

    def test_a_misspelt_key_is_corrected_with_its_place(self):
        self.write("bad.toml", BEAM.format(duration=0.05, cells="2, 1, 1").replace("young", "yuong"))
        self.assertRegex(self.aspic("run", "bad.toml", code=2).stderr, r"bad\.toml:7:\d+: .*yuong.*young")
        self.assertFalse((self.folder / "out").exists())

    def test_a_broken_mesh_is_refused(self):
        self.write("bad.mesh", box_mesh(flip=5))
        self.assertIn("inverted", self.aspic("run", "bad.mesh", code=2).stderr)

    def test_a_trace_changes_no_result(self):
        self.aspic("run", self.beam(), "--out", "plain")
        out = self.aspic("run", self.beam(), "--out", "traced", "--trace", "--landscape", "2:1",
                         "--landscape", "999").stdout
        trace = self.folder / "traced" / "trace"
        self.assertIn("traced/trace", out)
        self.assertEqual(len((trace / "curve_2_1.csv").read_text().splitlines()), 102)
        if shutil.which("gnuplot"):
            self.assertIn("Line search", (trace / "curve_2_1.svg").read_text())
            self.assertEqual((trace / "slice_2_1.png").read_bytes()[1:4], b"PNG")
        rows = [json.loads(line) for line in (trace / "trace.jsonl").read_text().splitlines()]
        self.assertEqual(len(rows), len((self.folder / "plain" / "iterations.csv").read_text().splitlines()) - 1)
        shutil.rmtree(trace)
        for run in ("plain", "traced"):
            (self.folder / run / "report.html").unlink(missing_ok=True)  # it shows the trace
        self.assert_same_results("plain", "traced")

    def test_force_replaces_a_trace_too(self):
        scene = self.beam()
        self.aspic("run", scene, "--trace")
        self.aspic("run", scene, "--force")
        self.assertFalse((self.folder / "out" / "beam" / "trace").exists())

    def test_a_landscape_without_its_iteration_is_told(self):
        error = self.aspic("run", self.beam(), "--landscape", "1:77").stderr
        self.assertIn("no landscape 1:77", error)
        self.assertIn("STEP:ITERATION", self.aspic("run", self.beam("b.toml"), "--landscape", "x", code=2).stderr)
        self.assertFalse((self.folder / "out" / "b").exists())

    def test_a_step_that_does_not_converge_shows_in_the_exit_code(self):
        scene = self.beam()
        hard = ["--set", "solver.max_iterations=1", "--set", "solver.tolerance=1e-12", "--set", "material.young=1e3"]
        self.assertIn("did not converge", self.aspic("run", scene, *hard, code=3).stderr)
        self.aspic("run", scene, *hard, "--force", "--allow-unconverged")
        self.aspic("run", scene, "--resume", code=3)  # also when the steps were taken before

    def test_several_assignments_follow_one_set(self):
        self.aspic("run", "--set", "time.step=0.01", "time.duration=0.03", self.beam(), "--set", "output.report=false")
        self.assertEqual([step["time"] for step in self.steps("out/beam")], ["0.01", "0.02", "0.03"])

    def test_forces_of_pins_loads_and_bodies_are_in_table_json_and_summary(self):
        scene = self.beam(extra='[[body.pin]]\nname = "guide"\nwhere = "x > 0.399"\naxes = "z"\n')
        done = self.aspic("run", scene, "--json", "--set", "output.report=false")
        last, row = json.loads(done.stdout.splitlines()[-1]), self.steps("out/beam")[-1]
        name, (pin, *_) = next(iter(last["reactions"])), last["reactions"].values()
        self.assertEqual([float(row[f"reaction_{name}_{axis}"]) for axis in "xyz"], pin["force"])
        self.assertEqual([float(row[f"reaction_moment_{name}_{axis}"]) for axis in "xyz"], pin["moment"])
        self.assertEqual([float(row[f"load_gravity_{axis}"]) for axis in "xyz"], last["loads"]["gravity"]["force"])
        guide = next(sums for name, sums in last["reactions"].items() if name.endswith("guide"))
        self.assertEqual(guide["force"][:2], [0, 0])
        self.assertIn(f"reactions  {name} exerts (", done.stderr)

    def test_an_explicit_scheme_that_blows_up_ends_the_run(self):
        done = self.aspic("run", self.beam(duration=100), "--set", "time.integrator=\"rk4\"", "--set", "time.step=0.1",
                          "--allow-unconverged", code=3)
        self.assertIn("stopped after step", done.stderr)
        self.assertIn("blew up", done.stderr)
        steps = self.steps("out/beam")
        self.assertLess(len(steps), 1000)
        self.assertEqual(steps[-1]["status"], "undefined")
        self.assertLessEqual({step["status"] for step in steps[:-1]}, {"converged", "unstable"})

    def test_an_explicit_scheme_that_blows_up_beside_a_moving_pin_is_no_success(self):
        scene = self.beam(duration=0.2, cells="4, 1, 1", extra="""[[body.pin]]
where = "x > 0.399"
motion = { keyframes = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.2, displacement = [0, 0.01, 0] }] }
""")
        explicit = ["--set", "material.model=arap", "--set", 'time.integrator="symplectic_euler"', "--force"]
        self.aspic("run", scene, "--set", "time.step=0.001", *explicit)
        self.aspic("run", scene, "--set", "time.step=0.01", *explicit, code=3)
        self.assertIn("unstable", {step["status"] for step in self.steps("out/beam")})

    def test_adaptive_steps_are_counted_in_table_json_and_summary(self):
        done = self.aspic("run", self.beam(), "--set", "time.adaptive.tolerance=1e-5", "--set",
                          "time.integrator=\"tr_bdf2\"", "--json")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        steps = self.steps("out/beam")
        self.assertEqual([line["substeps"] for line in lines], [int(step["substeps"]) for step in steps])
        self.assertEqual([line["rejected"] for line in lines], [int(step["rejected"]) for step in steps])
        taken, rejected = sum(line["substeps"] for line in lines), sum(line["rejected"] for line in lines)
        self.assertGreater(taken, 2 * len(steps))
        self.assertIn(f"parts      {taken} taken, {rejected} rejected", done.stderr)

    def test_an_adaptive_step_without_a_scheme_that_can_is_refused(self):
        done = self.aspic("run", self.beam(), "--set", "time.adaptive.tolerance=1e-5", "--set",
                          "time.integrator=\"bdf2\"", code=2)
        self.assertIn("tr_bdf2", done.stderr)

    def test_a_terminal_gets_a_progress_bar(self):
        scene = self.beam()
        master, slave = pty.openpty()
        process = subprocess.Popen([ASPIC, "run", scene], cwd=self.folder, stdout=slave, stderr=slave)
        os.close(slave)
        text = b""
        while True:
            ready, _, _ = select.select([master], [], [], 60)
            try:
                chunk = os.read(master, 4096) if ready else b""
            except OSError:  # the other end is closed
                chunk = b""
            if not chunk:
                break
            text += chunk
        os.close(master)
        self.assertEqual(process.wait(), 0)
        self.assertIn(b"[####################] 100%", text)


class Report(CommandLine):
    def page(self, file):
        return (self.folder / file).read_text()

    def test_a_run_leaves_one_that_needs_nothing_else(self):
        text = self.aspic("run", self.beam()).stdout
        self.assertIn("browser: open out/beam/report.html: 6 frames", text)
        page = self.page("out/beam/report.html")
        self.assertIn('id="recording"', page)
        self.assertIsNone(re.search(r'<(script|link|img)[^>]*(src|href)="(?!data:)', page))
        self.assertNotIn(str(self.folder), page)

    def test_it_is_made_again_to_the_same_bytes_and_replaced_by_force(self):
        scene = self.beam()
        self.aspic("run", scene)
        first = self.page("out/beam/report.html")
        self.aspic("report", "out/beam", "-o", "again.html")
        self.assertEqual(self.page("again.html"), first)
        self.aspic("run", scene, "--force", "--set", "output.report=false")
        self.assertFalse((self.folder / "out/beam/report.html").exists())

    def test_what_cannot_be_shown_is_no_failure_of_the_run(self):
        off = [word for name in ("vtu", "pc2", "usd") for word in ("--set", f"output.{name}=false")]
        done = self.aspic("run", self.beam(), "--quiet", *off)
        self.assertIn("warning: no report.html", done.stderr)
        self.assertIn("output.vtu = true", self.aspic("report", "out/beam", code=2).stderr)

    def test_bad_input_is_named(self):
        self.assertIn("no directory of a run", self.aspic("report", self.beam(), code=2).stderr)
        (self.folder / "empty").mkdir()
        self.assertIn("holds no run", self.aspic("report", "empty", code=2).stderr)
        self.aspic("run", "beam.toml")
        (self.folder / "out/beam/frames/body_000003.vtu").write_text("<VTKFile")
        self.assertIn("body_000003.vtu", self.aspic("report", "out/beam", code=2).stderr)
        self.assertIn("--max-size", self.aspic("report", "out/beam", "--max-size", "0.1", code=2).stderr)


@unittest.skipUnless(shutil.which("chromium") and shutil.which("ffmpeg"), "chromium or ffmpeg is missing")
class Render(CommandLine):
    def setUp(self):
        super().setUp()
        self.aspic("run", self.beam(duration=0.04))

    def test_frames_a_picture_and_a_video(self):
        self.aspic("render", "out/beam", "-o", "frames", "--size", "160x120", "--color", "von_mises", timeout=200)
        frames = sorted((self.folder / "frames").iterdir())
        self.assertEqual([f.name for f in frames], [f"frame_{i:06}.png" for i in range(1, 6)])
        for frame in frames:
            self.assertEqual(frame.read_bytes()[:24], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes([0, 0, 0, 160, 0, 0, 0, 120]))
        self.assertNotEqual(frames[0].read_bytes(), frames[4].read_bytes())
        self.aspic("render", "out/beam", "-o", "last.png", "--size", "160x120", "--step", "4", "--dark", timeout=200)
        self.assertNotEqual((self.folder / "last.png").read_bytes(), frames[4].read_bytes())
        self.aspic("render", "out/beam", "-o", "beam.webm", "--size", "160x120", "--every-frame", timeout=200)
        self.assertGreater((self.folder / "beam.webm").stat().st_size, 500)
        self.aspic("render", "out/beam", "-o", "beam.gif", "--size", "160x120", "--every-frame", timeout=200)
        self.assertEqual((self.folder / "beam.gif").read_bytes()[:6], b"GIF89a")
        self.assertEqual([f for f in self.folder.iterdir() if f.name.startswith(".aspic")], [])

    def test_bad_input_is_named(self):
        render = lambda *arguments: self.aspic("render", "out/beam", *arguments, code=2, timeout=200).stderr
        self.assertIn("--size 9x: write WIDTHxHEIGHT", render("-o", "a.png", "--step", "1", "--size", "9x"))
        self.assertIn("one picture needs --step", render("-o", "a.png"))
        self.assertIn("a video needs even numbers", render("-o", "a.mp4", "--size", "101x100"))
        self.assertIn("a.bmp: pictures become", render("-o", "a.bmp"))
        self.assertIn("choose one of displacement", render("-o", "a.png", "--step", "1", "--color", "stress"))
        self.assertIn("choose one of front", render("-o", "a.png", "--step", "1", "--view", "above"))
        self.assertFalse((self.folder / "a.png").exists())

    def test_a_missing_browser_is_told_with_its_package(self):
        without = dict(os.environ, PATH=str(self.folder))
        done = subprocess.run([ASPIC, "render", "out/beam", "-o", "frames"], cwd=self.folder, env=without,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("apt-get install chromium", done.stderr)


class Compare(CommandLine):
    def test_methods_reach_the_same_minimizer(self):
        out = self.aspic("compare", self.beam(), "--methods", "newton,newton:clamped:cholesky,gradient_descent",
                         "--step", "2").stdout
        self.assertEqual(out.count("same minimizer"), 3)
        folder = self.folder / "out" / "compare_beam"
        for name in ("index.html", "methods.csv", "work.csv", "comparison.json"):
            self.assertTrue((folder / name).exists(), name)
        methods = {m["method"]: m for m in json.loads((folder / "comparison.json").read_text())["methods"]}
        self.assertGreater(methods["gradient_descent"]["iterations"], 10 * methods["newton"]["iterations"])
        self.assertLess(methods["newton"]["excess"], 1e-9)
        with open(folder / "work.csv", newline="") as file:
            values = [float(row["value"]) for row in csv.DictReader(file) if row["method"] == "newton"]
        self.assertEqual(len(values), methods["newton"]["iterations"] + 1)
        self.assertEqual(values, sorted(values, reverse=True))

    def test_a_method_that_is_cut_off_shows_in_the_exit_code(self):
        out = self.aspic("compare", self.beam(cells="40, 10, 10"), "--methods", "newton,gradient_descent",
                         "--max-seconds", "0.01", code=3).stdout
        self.assertIn("interrupted", out)

    def test_bad_input_is_named(self):
        for arguments, message in ((["--methods", "newtn"], "newton"), (["--methods", "newton:clampd"], "clamped"),
                                   (["--methods", "newton", "--set", "time.integrator=forward_euler"], "implicit")):
            self.assertIn(message, self.aspic("compare", self.beam(), *arguments, code=2).stderr)
class Verify(CommandLine):
    def verify(self, *arguments, code=0):
        return self.aspic("verify", "--quick", *arguments, code=code).stdout

    def results(self):
        return json.loads((self.folder / "out/verify/verify.json").read_text())["checks"]

    def test_every_check_is_listed_and_nothing_is_run(self):
        rows = self.verify("--list").splitlines()
        self.assertGreater(len(rows), 20)
        self.assertIn("statics/cook", [row.split()[0] for row in rows])
        self.assertFalse((self.folder / "out").exists())

    def test_rows_say_what_was_measured_against_what_and_why(self):
        text = self.verify("--only", "free_fall", "--only", "numbering")
        self.assertRegex(text, r"pass  backward_euler: distance from the closed form .* \+- 1e-13 m")
        self.assertIn("(round-off of 10 solves", text)
        self.assertEqual([check["check"] for check in self.results()], ["invariants/numbering", "integrators/free_fall"])
        for check in self.results():
            self.assertTrue(check["passes"] and check["rows"])
            for row in check["rows"]:
                self.assertLessEqual(abs(row["measured"] - row["reference"]), row["tolerance"])
                self.assertTrue(row["reason"])

    def test_the_page_holds_everything(self):
        self.verify("--only", "euler_energies")
        page = (self.folder / "out/verify/index.html").read_text()
        self.assertIn("symplectic_euler: drift", page)
        self.assertIn("<svg", page)
        self.assertNotRegex(page, r'(src|href)="http')

    def test_a_wrong_integrator_or_material_fails(self):
        text = self.verify("--only", "free_fall", "--instead", "bdf2=backward_euler", code=3)
        self.assertIn("FAIL  bdf2:", text)
        self.assertIn("pass  midpoint:", text)
        self.assertFalse(self.results()[0]["passes"])
        self.verify("--only", "materials/uniaxial", "--instead", "stvk=corotated", code=3)
        self.assertEqual(len(self.results()), 1)  # not the table beside it
        self.verify("--only", "uniaxial_table", "--instead", "stvk=corotated", code=3)

    def test_what_cannot_be_computed_fails(self):
        # The explicit scheme explodes where the implicit one is to be measured.
        text = self.verify("--only", "pendulum", "--instead", "midpoint=forward_euler", code=3)
        self.assertIn("FAIL  could not be computed", text)
        self.assertIsNone(self.results()[0]["rows"][-1]["measured"])

    def test_bad_input_is_named(self):
        self.assertIn("no check is about 'nonsense'", self.aspic("verify", "--only", "nonsense", code=2).stderr)
        self.assertIn("--instead bdf2=stvk", self.aspic("verify", "--instead", "bdf2=stvk", code=2).stderr)


class Lecture(CommandLine):
    def lecture(self, *arguments, code=0):
        return self.aspic("lecture", *arguments, code=code).stdout

    def mesh(self, cells):
        return self.write(f"box{cells}.mesh", box_mesh(cells))

    def test_every_page_is_listed(self):
        rows = self.lecture().splitlines()
        self.assertEqual([int(row.split()[0]) for row in rows], list(range(1, 63)))
        self.assertTrue(all(len(row.split()) > 1 for row in rows))

    def test_a_page_says_what_it_claims_measured_and_judged(self):
        text = self.lecture("54")
        self.assertIn("claim: ", text)
        self.assertRegex(text, r"pass  .*: \S+.*\((<=|>=|=) \S+")
        self.assertIn("PASS", text)
        with open(self.folder / "out/lecture/54-59_overshoot/trials.csv", newline="") as file:
            alphas = [float(row["alpha"]) for row in csv.DictReader(file)]
        self.assertEqual(alphas, [1, 0.5, 0.25])

    def test_pages_run_on_a_given_mesh_and_keep_its_scene(self):
        text = self.lecture("26", "--mesh", self.mesh(4), "--out", "here")
        self.assertIn("PASS", text)
        self.assertIn("box4.mesh", text)
        self.aspic("run", "here/26-31_optimization/05_swing.toml", "--steps", "1")

    def test_a_demonstration_that_does_not_show_the_claim_fails(self):
        text = self.lecture("53", "--mesh", self.mesh(1), code=3)  # too few tets to make Newton's method fail
        self.assertRegex(text, r"FAIL  without line search: converged: 1")

    def test_what_cannot_be_judged_is_no_pass(self):
        for page, words, code in (("6", "not available: bunnies fall on chutes: needs contact", 2),
                                  ("4", "nothing to check", 0)):
            text = self.lecture(page, code=code)
            self.assertIn(words, text)
            self.assertNotIn("pass", text.lower())

    def test_a_bad_page_is_named(self):
        for page in ("0", "63", "5x", "first"):
            self.assertIn(f"'{page}' is no page", self.aspic("lecture", page, code=2).stderr)
        self.aspic("lecture", "5", "--mesh", "missing.mesh", code=2)

    def test_without_browser_and_gnuplot_the_numbers_are_judged_all_the_same(self):
        without = dict(os.environ, PATH=str(self.folder))
        done = subprocess.run([ASPIC, "lecture", "25", "--mesh", self.mesh(4)], cwd=self.folder, env=without,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "note: no pictures of meshes: .*(apt-get install chromium|built without)")
        self.assertIn("note: no charts: gnuplot is not installed", done.stdout)
        self.assertIn("PASS", done.stdout)
        self.assertEqual([f.suffix for f in (self.folder / "out/lecture/25_drag").iterdir() if f.suffix in (".png", ".svg")], [])

    def test_all_pages_are_summed_up(self):
        self.lecture("all", "--mesh", self.mesh(6))
        if "render" in self.aspic("--help").stdout:  # formulas are made with the viewer's page
            self.assertIn("<math", (self.folder / "out/lecture/index.html").read_text())
        with open(self.folder / "out/lecture/lecture.json") as file:
            summary = json.load(file)
        verdicts = {page["page"]: page["verdict"] for page in summary["pages"]}
        self.assertEqual([n for n, v in verdicts.items() if v == "nothing to check"], [1, 4, 35, 52])
        self.assertEqual([n for n, v in verdicts.items() if v == "not available"], [6])
        self.assertEqual(sum(v == "pass" for v in verdicts.values()), 57)
        for demonstration in summary["demonstrations"]:
            self.assertTrue(any("bound" in m for m in demonstration["measures"]), demonstration["key"])
            folder = self.folder / "out/lecture" / demonstration["key"]
            self.assertTrue(list(folder.glob("*.csv")), demonstration["key"])
            for picture in demonstration["pictures"]:
                self.assertTrue((self.folder / "out/lecture" / picture["file"]).exists(), picture["file"])
        pictures = [picture["file"] for d in summary["demonstrations"] for picture in d["pictures"]]
        if "25_drag/drag.png" not in pictures:
            why = "apt-get install chromium|built without" if shutil.which("chromium") is None else "built without"
            self.assertRegex(str([d["remarks"] for d in summary["demonstrations"]]), why)
        page = (self.folder / "out/lecture/index.html").read_text()
        for demonstration in summary["demonstrations"]:
            self.assertIn(demonstration["title"], page)
        self.assertNotIn("http://", page.replace("http://www.w3.org", ""))

    def test_a_step_that_is_not_one_minimization_is_refused(self):
        for setting, message in (("time.integrator=tr_bdf2", "minimizes twice"),
                                 ("time.integrator=bdf2", "--step 2"),
                                 ("time.integrator=linearly_implicit_euler", "one iteration"),
                                 ("time.adaptive.tolerance=1e-3", "time.adaptive.tolerance=0")):
            refused = self.aspic("compare", self.beam(), "--methods", "newton,lbfgs", "--set", setting, code=2)
            self.assertIn(message, refused.stderr)
        self.aspic("compare", self.beam(), "--methods", "newton,lbfgs", "--set", "time.integrator=bdf2", "--step", "2")

    def test_a_folder_that_cannot_be_made_is_found_before_the_work(self):
        (self.folder / "taken").write_text("")
        refused = self.aspic("compare", self.beam(), "--methods", "newton", "--out", "taken/here", code=2)
        self.assertIn("cannot be created", refused.stderr)
        self.assertNotIn("newton ...", refused.stderr)


class Interruption(CommandLine):
    """A run of a hundred steps is stopped in its middle, in three ways, and continued."""

    def setUp(self):
        super().setUp()
        self.scene = self.beam(duration=1.0, cells="8, 3, 3")
        shutil.copytree(self.unbroken(), self.folder / "whole")

    @staticmethod
    @functools.cache
    def unbroken():
        """The same run to its end, made once."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_cli_"))
        atexit.register(shutil.rmtree, folder)
        (folder / "beam.toml").write_text(BEAM.format(duration=1.0, cells="8, 3, 3"))
        subprocess.run([ASPIC, "run", "beam.toml", "--out", "whole"], cwd=folder, check=True, timeout=600,
                       capture_output=True)
        return folder / "whole"

    def interrupt(self, with_signal, out):
        process = self.start("run", self.scene, "--out", out, "--json")
        # A pipe that holds a few lines makes the run wait for its reader: it cannot end before it is interrupted.
        fcntl.fcntl(process.stdout, fcntl.F_SETPIPE_SZ, 4096)
        for _ in range(10):
            self.assertTrue(process.stdout.readline())
        process.send_signal(with_signal)
        process.communicate(timeout=60)
        return process.returncode

    def resume_and_compare(self, out):
        self.assertGreaterEqual(len(self.steps(out)), 10)
        self.assertLess(len(self.steps(out)), 100, "the run ended before it was interrupted")
        self.aspic("run", self.scene, "--out", out, "--resume")
        self.assertEqual(len(self.steps(out)), 100)
        self.assert_same_results("whole", out)

    def test_ctrl_c_and_resume_give_the_same_bits(self):
        self.assertEqual(self.interrupt(signal.SIGINT, "stopped"), 130)
        self.resume_and_compare("stopped")

    def test_kill_and_resume_give_the_same_bits(self):
        self.assertEqual(self.interrupt(signal.SIGTERM, "stopped"), 143)
        self.resume_and_compare("stopped")

    def test_kill_9_and_resume_give_the_same_bits(self):
        self.assertEqual(self.interrupt(signal.SIGKILL, "stopped"), -signal.SIGKILL)
        self.resume_and_compare("stopped")

    def test_the_steps_option_and_resume_give_the_same_bits(self):
        self.aspic("run", self.scene, "--out", "stopped", "--steps", "30")
        self.resume_and_compare("stopped")

    def test_resume_needs_a_run(self):
        self.assertIn("no such run", self.aspic("run", self.scene, "--resume", code=2).stderr)

    def test_a_complete_run_has_nothing_to_resume(self):
        scene = self.beam("short.toml")
        self.aspic("run", scene)
        self.assertIn("nothing to do", self.aspic("run", "out/short", "--resume").stdout)


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


class Captured(CommandLine):
    """A cube of 5^3 cells, poked at three sites."""

    def capture(self, out="data", *options, code=0):
        self.write("cube.toml", CUBE)
        return self.aspic("capture", "cube.toml", "-o", out, *BENCH, *options, code=code)

    def change(self, name, old, new, count=1):
        text = (self.folder / name).read_text()
        self.assertIn(old, text)
        self.write(name, text.replace(old, new, count))

    def change_cells(self, table, columns, of):
        """of(value) in these columns of each row of data/table.csv."""
        path = self.folder / "data" / (table + ".csv")
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            for column in columns:
                row[column] = of(row[column])
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)

    def assert_same_files(self, one, other, *names):
        for name in names:
            self.assertTrue(filecmp.cmp(self.folder / one / name, self.folder / other / name, shallow=False), name)


class Capture(Captured):
    TABLES = ("capture.toml", "markers.csv", "cases.csv", "positions.csv", "rest.msh", "truth.vtu")

    def test_a_scene_becomes_a_data_set_without_faults(self):
        self.assertIn("6 cases, 20 markers", self.capture().stdout)
        text = self.aspic("fit", "--check", "data").stdout
        self.assertIn("6 cases in 3 groups", text)
        self.assertNotIn("error:", text)

    def test_by_default_it_goes_to_out_and_an_earlier_one_is_kept(self):
        self.write("cube.toml", CUBE)
        self.assertIn("1 of 3: poke 1, depth 1: ", self.aspic("capture", "cube.toml", "--pokes", "1").stdout)
        self.assertTrue((self.folder / "out/cube_data/capture.toml").exists())
        self.assertIn("--force", self.aspic("capture", "cube.toml", "--pokes", "1", code=2).stderr)

    def test_the_same_seed_gives_the_same_bits_and_another_does_not(self):
        self.capture("one", "--threads", "1")
        self.capture("two", "--threads", "2")
        self.capture("other", "--seed", "2")
        self.assert_same_files("one", "two", *self.TABLES)
        self.assertFalse(filecmp.cmp(self.folder / "one/positions.csv", self.folder / "other/positions.csv", False))

    def test_without_forces_there_are_none_and_the_check_says_what_that_means(self):
        self.capture("data", "--no-force")
        with open(self.folder / "data/cases.csv", newline="") as file:
            self.assertEqual({row["force_x"] for row in csv.DictReader(file)}, {""})
        self.assertIn("only ratios of stiffness", self.aspic("fit", "--check", "data").stdout)

    def test_torques_gravity_and_a_mesh_of_ones_own(self):
        self.write("box.mesh", box_mesh(3))
        self.aspic("convert", "box.mesh", "box.msh")
        self.write("scaled.toml", CUBE.replace("[0.1, 0.1, 0.1]", "[1, 1, 1]").replace("0.05", "0.5"))
        text = self.aspic("capture", "scaled.toml", "-o", "data", "--pokes", "1", "--depths", "1", "--tip", "disc:0.2", "-q",
                          "--torque", "--gravity", "0,0,-1", "--mesh", "box.mesh").stdout
        self.assertIn("2 cases, 100 markers, mesh of 162 tets", text)
        with open(self.folder / "data/cases.csv", newline="") as file:
            poke, hung = csv.DictReader(file)
        self.assertNotEqual(poke["torque_x"], "")
        self.assertEqual(float(hung["gravity_z"]), -9.81)

    def test_interrupted_it_writes_nothing(self):
        self.write("cube.toml", CUBE)
        process = self.start("capture", "cube.toml", "-o", "data", "--pokes", "30", "--depths", "20")
        self.assertIn("1 of", process.stdout.readline())
        process.send_signal(signal.SIGINT)
        self.assertIn("nothing was written", process.communicate(timeout=60)[1])
        self.assertEqual(process.returncode, 130)
        self.assertFalse((self.folder / "data").exists())

    def test_bad_options_name_the_remedy(self):
        self.write("cube.toml", CUBE)
        for arguments, message in ((("--tip", "cone"), "sphere or disc"), (("--tip", "sphere:1e9"), "smaller one (--tip)"),
                                   (("--tip", "sphere:nan"), "must be > 0"), (("--gravity", "0,0,0"), "a direction"),
                                   (("--gravity", "1,2"), "three numbers"), (("--depth", "nan"), "depth must be"),
                                   (("--pokes", "-1"), "0 to 1000"), (("--pokes", "0"), "nothing is measured"),
                                   (("--markers", "2000000000"), "0 to 100000"), (("--noise", "inf"), "noise must be"),
                                   (("--threads", "0"), "--threads"), (("--mesh", "none.msh"), "none.msh")):
            self.assertIn(message, self.aspic("capture", "cube.toml", *arguments, code=2).stderr)


class Fit(Captured):
    QUICK = ("--options", "quick.toml", "--known", "poisson=0.4")
    QUICK_OPTIONS = "mesh_errors = false\nuncertainty = false\ncross_validation = false\n"

    def setUp(self):
        super().setUp()
        self.capture()
        self.write("quick.toml", self.QUICK_OPTIONS)

    def options(self, text):
        self.write("options.toml", text)
        return "--options", "options.toml"

    def test_the_whole_way_from_a_scene_to_a_scene(self):
        done = self.aspic("fit", "data")
        for part in ("converged", "misfit", "95 %", "held out", "next poke", 'material = { file = "material.vtu" }'):
            self.assertIn(part, done.stdout)
        self.assertNotRegex(done.stdout, r"\bnan\b|\binf\b")
        self.assertFalse({".journal", ".state"} & {p.suffix for p in (self.folder / "material.fit").iterdir()})
        self.assertIn("--force", self.aspic("fit", "data", code=2).stderr)
        self.assertIn("complete", self.aspic("fit", "data", "--resume", code=2).stderr)
        self.write("use.toml", HOLDS_MATERIAL)
        self.assertIn("2 of 2", self.aspic("run", "use.toml").stdout)

    def test_what_is_left_out_is_predicted(self):
        left_out = self.options(self.QUICK_OPTIONS + 'leave_out = "poke 2"\n')
        done = self.aspic("fit", "data", *left_out, "--known", "poisson=0.4", "--quiet")
        self.assertEqual(done.stdout, "")
        unknown = self.options('leave_out = ["poke 9"]\n')
        self.assertIn("poke 1", self.aspic("fit", "data", "--force", *unknown, code=2).stderr)

    def test_a_fit_that_was_killed_goes_on_to_the_same_bits(self):
        self.aspic("fit", "data", *self.QUICK, "-o", "whole.vtu")
        process = self.start("fit", "data", *self.QUICK, "-o", "killed.vtu", "-v")
        for line in process.stdout:
            if "fit        iteration   1" in line:
                break
        process.kill()
        process.communicate()
        self.assertIn("--resume continues", self.aspic("fit", "data", *self.QUICK, "-o", "killed.vtu", code=2).stderr)
        self.assertIn("begun with", self.aspic("fit", "data", "-o", "killed.vtu", "--resume", code=2).stderr)
        self.assertIn("resuming", self.aspic("fit", "data", *self.QUICK, "-o", "killed.vtu", "--resume").stdout)
        self.assert_same_files(".", ".", "whole.vtu")
        self.assertTrue(filecmp.cmp(self.folder / "whole.vtu", self.folder / "killed.vtu", shallow=False))

    def test_ctrl_c_writes_what_was_reached_and_says_how_to_go_on(self):
        process = self.start("fit", "data", "-v")
        for line in process.stdout:
            if "fit        iteration   1" in line:
                break
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130)
        self.assertIn("--resume continues", out)
        self.assertTrue((self.folder / "material.vtu").exists())
        self.assertIn("resuming", self.aspic("fit", "data", "--resume").stdout)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs a device that is always full")
    def test_where_nothing_can_be_written_that_is_said(self):
        self.assertIn("/proc", self.aspic("fit", "data", *self.QUICK, "-o", "/proc/none/material.vtu", code=2).stderr)
        with open("/dev/full", "w") as full:
            done = subprocess.run([ASPIC, "fit", "data", *self.QUICK], cwd=self.folder, stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard output: cannot be written", done.stderr)

    def test_options_that_make_no_sense(self):
        for arguments, message in ((("--unknown", "yung=tets"), "young"), (("--known", "poisson=0.7"), "poisson"),
                                   (self.options("weight = -1"), "options.toml:1"), (("-o", "material.txt"), ".vtu"),
                                   (("--resume",), "no such fit")):
            self.assertIn(message, self.aspic("fit", "data", *arguments, code=2).stderr)
        self.write("curves.csv", "test,stretch,stress_Pa\nuniaxial,1.1,1\n")
        self.assertIn("aspic fit-curves curves.csv", self.aspic("fit", "curves.csv", code=2).stderr)
        self.assertIn("aspic fit data", self.aspic("fit-curves", "data", code=2).stderr)


class BadData(Captured):
    """Each fault is named with its file, its row and what to do, by the check and by the fit."""

    def setUp(self):
        super().setUp()
        self.capture()

    def refused(self, *messages):
        for command in (("fit", "--check", "data"), ("fit", "data")):
            done = self.aspic(*command, code=2, timeout=20)
            for message in messages:
                self.assertIn(message, done.stdout + done.stderr)

    def test_a_reading_that_is_no_number(self):
        self.change_cells("positions", ["x"], lambda x: "nan")
        self.refused("positions.csv:2: x = 'nan'", "leave the cell blank")

    def test_lengths_in_millimeters(self):
        self.change_cells("positions", ["x", "y", "z"], lambda x: str(1e3 * float(x)))
        self.refused("positions.csv: markers move", 'units = { length = "mm" }')

    def test_forces_in_grams(self):
        self.change_cells("cases", ["force_x", "force_y", "force_z"], lambda f: str(round(1e4 * float(f) / 9.8)))
        text = self.aspic("fit", "--check", "data").stdout
        self.assertIn("cases.csv", text)
        self.assertIn('units = { force = "g" }', text)

    def test_forces_that_are_all_zero(self):
        self.change_cells("cases", ["force_x", "force_y", "force_z"], lambda f: "0")
        self.refused("cases.csv: all forces are 0", "leave them blank")

    def test_deviations_of_zero(self):
        self.change_cells("positions", ["sd_y"], lambda sd: "0")
        self.refused("positions.csv:2: sd_y = 0", "leave the cell blank")

    def test_names_that_are_given_twice(self):
        self.change_cells("cases", ["case"], lambda name: "poke 1, depth 1")
        self.refused("cases.csv:3: the case 'poke 1, depth 1' is in line 2 already")

    def test_poses_inside_out(self):
        self.change_cells("cases", ["axis_x", "axis_y", "axis_z"], lambda a: str(-float(a)))
        self.refused("cases.csv:2 (poke 1, depth 1): the axis of the tip points out of the body", "turn their signs")

    def test_a_tip_that_touches_nothing(self):
        self.change_cells("cases", ["touch_x", "center_x"], lambda x: str(float(x) + 0.2))
        self.refused("cases.csv:2 (poke 1, depth 1): ", "touch")

    def test_tables_that_are_empty_torn_or_no_tables(self):
        for content, message in ((b"", "is empty"), (b"case,marker,x,y,z\n\"poke 1", "positions.csv:2: has 1 cells"),
                                 (os.urandom(2000) + b"\n", "positions.csv:1"), (b"x" * 3_000_000, "too long")):
            (self.folder / "data/positions.csv").write_bytes(content)
            self.refused(message)

    def test_settings_that_are_meant_to_break_it(self):
        for content, message in ((b"", "version"), (b"a = " + b"[" * 100_000, "depth"),
                                 (b"[" + b"a." * 100_000 + b"a]", "more than 32 parts"), (os.urandom(500), "capture.toml"),
                                 (b'version = 1\nmesh = "/dev/zero"\n', "outside")):
            (self.folder / "data/capture.toml").write_bytes(content)
            self.refused(message)

    def test_data_that_no_material_explains(self):
        self.change_cells("positions", ["z"], lambda z: str(float(z) + 0.02))
        done = self.aspic("fit", "data", *Fit.QUICK, "--unknown", "young=uniform")
        self.assertRegex(done.stdout, r"warning: cases\.csv:\d \('poke \d, depth \d'\) is explained worst: .* \d+ standard")


class MaterialFile(CommandLine):
    TETS = """<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 0.3 0 0 0 0.3 0 0 0 0.3</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray></Cells>
<CellData>{fields}</CellData></Piece></UnstructuredGrid></VTKFile>
"""
    FIELD = '<DataArray type="Float64" Name="{}" format="ascii">{}</DataArray>'

    def run_with(self, extra="", code=0, **fields):
        values = "".join(self.FIELD.format(name, value) for name, value in fields.items())
        self.write("material.vtu", self.TETS.format(fields=values))
        self.write("use.toml", HOLDS_MATERIAL.replace("{ file", '{ model = "neo_hookean", file')
                   .replace("[[body.pin]]", extra + "[[body.pin]]"))
        return self.aspic("run", "use.toml", "--force", code=code)

    def test_another_mesh_takes_its_values_which_is_said(self):
        self.assertIn("are not the 1 of material.vtu", self.run_with(young="1e4", poisson="0.4").stdout)

    def test_a_body_that_was_moved_takes_the_values_where_it_rests(self):
        self.run_with("translate = [3, 0, 0]\n", young="1e4", poisson="0.4")

    def test_what_is_missing_or_no_number_is_named(self):
        self.assertIn("young", self.run_with(poisson="0.4", code=2).stderr)
        self.assertIn("material.vtu", self.run_with(young="nan", poisson="0.4", code=2).stderr)
        self.assertIn("material.vtu", self.run_with(young="-1", poisson="0.4", code=2).stderr)
        self.write("use.toml", HOLDS_MATERIAL.replace("material.vtu", "none.vtu"))
        self.assertIn("none.vtu", self.aspic("run", "use.toml", code=2).stderr)


class Curves(CommandLine):
    def test_a_table_of_a_spreadsheet_gives_parameters_and_a_line_for_a_scene(self):
        rows = "\n".join(f"uniaxial;{l:g};{1e3 * (l - l ** -2):g}".replace(".", ",") for l in (1.1, 1.3, 1.6, 2.0))
        self.write("pull.csv", "# a neo-Hookean rubber, mu = 1 kPa\ntest;stretch;stress_Pa\n" + rows)
        text = self.aspic("fit-curves", "pull.csv", "--material", "neo_hookean_isochoric").stdout
        self.assertRegex(text, r"young +29[78]\d|young +300\d")
        self.assertIn('material = { model = "neo_hookean_isochoric", young = ', text)
        listed = json.loads(self.aspic("fit-curves", "pull.csv", "--material", "fung", "--json").stdout)
        self.assertEqual(len(listed), 1)

    def test_bad_tables_name_the_row(self):
        for text, message in (("", "empty"), ("test,stretch,stress\nuniaxial,1.1,1\n", "stress_MPa"),
                              ("test,stretch,stress_Pa\nuniaxial,1.1,nan\n", "pull.csv:2"),
                              ("test,stretch,stress_Pa\nuniaxal,1.1,1\n", "uniaxial")):
            self.write("pull.csv", text)
            self.assertIn(message, self.aspic("fit-curves", "pull.csv", code=2).stderr)

    def test_a_closed_loop_does_work_unless_there_is_an_energy(self):
        text = self.aspic("closed-loop", "--loops", "1", "--increments", "50").stdout
        interpolated, energy = (re.search(rf"{name}.*?(-?[\d.]+) +(-?[\d.]+) ", text) for name in
                                ("strain space", r"an energy \(corotated\)"))
        self.assertGreater(float(interpolated[1]), 1)
        self.assertLess(abs(float(energy[1])), 1e-4)


if __name__ == "__main__":
    unittest.main(verbosity=2)

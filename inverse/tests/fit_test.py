#!/usr/bin/env python3
"""`aspic fit`: from data to a material and a simulation; errors, interruption and resumption.

usage: ASPIC=path/to/aspic fit_test.py [TestCase...]
"""
import atexit
import contextlib
import csv
import functools
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

from command_line import ASPIC, CommandLine, box_mesh

BODY = """
[[body]]
name = "layers"
shape = { box = { upper = [0.12, 0.12, 0.06], cells = [%s] } }
%s
[[body.pin]]
where = "Z < 1e-6"
"""
TRUTH = BODY % ("CELLS", 'material = { young = "Z < 0.03 ? 4e4 : 1e4", poisson = 0.4 }')


@functools.cache
def measured(cells="5, 5, 4", depths=2):
    """A small data set, created once: two indentations on two layers."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_fit_"))
    atexit.register(shutil.rmtree, folder)
    (folder / "truth.toml").write_text(TRUTH.replace("CELLS", cells))
    subprocess.run([ASPIC, "capture", "truth.toml", "-o", "layers", "--pokes", "2", "--depths", str(depths), "--markers", "30",
                    "--noise", "0.002", "--force-noise", "0.002", "-q"], cwd=folder, check=True, timeout=120)
    return folder / "layers"


@functools.cache
def fitted(options, lines, *data):
    """A fit of the same data without interruption, created once: a folder with whole.vtu and whole.fit."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_fit_"))
    (folder / options[1]).write_text("\n".join(lines) + "\n")
    atexit.register(shutil.rmtree, folder)
    subprocess.run([ASPIC, "fit", str(measured(*data)), *options, "-o", str(folder / "whole.vtu")], check=True, timeout=300,
                   capture_output=True, cwd=folder)
    return folder


class FitCommand(CommandLine):
    DATA = ()  # arguments of measured()

    def setUp(self):
        super().setUp()
        shutil.copytree(measured(*self.DATA), self.folder / "layers")
        self.write("quick.toml", QUICK_OPTIONS)

    def options(self, *lines):
        self.write("options.toml", "\n".join(lines) + "\n")
        return "--options", "options.toml"

    def fit(self, *arguments, code=0):
        return self.aspic("fit", "layers", *arguments, code=code, timeout=300)

    def rows(self, folder="material.fit"):
        with open(self.folder / folder / "history.csv", newline="") as file:
            return list(csv.DictReader(file))

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()


QUICK_OPTIONS = "mesh_errors = false\nuncertainty = false\ncross_validation = false\n"
QUICK = ("--options", "quick.toml", "--unknown", "young=uniform", "--known", "poisson=0.4", "--allow-unconverged")  # one value cannot explain the layers, so the verdict is bad


class Fit(FitCommand):
    def test_data_become_a_material_that_a_scene_simulates(self):
        said = self.fit("--unknown", "young=handles:8", "--known", "poisson=0.4", "--allow-unconverged").stdout
        for fact in ("fit        converged", "misfit     |r|^2 = ", "with one value for all", "softest tet", "95 %: ",
                     "held out   each group predicted from the others: positions within",
                     'material = { file = "material.vtu" }'):
            self.assertIn(fact, said)
        stages = [row["stage"] for row in self.rows()]
        self.assertEqual(stages, sorted(stages, reverse=True))  # uniform before field
        self.assertIn('model = "neo_hookean"', (self.folder / "material.fit/options.toml").read_text())
        left = [p.name for p in (self.folder / "material.fit").iterdir() if p.suffix in (".journal", ".state")]
        self.assertEqual(left, [], "a complete fit has no state for resumption")
        self.write("scene.toml", BODY % ("5, 5, 3", 'material = { file = "material.vtu" }'))
        run = self.aspic("run", "scene.toml", "--steps", "2").stdout
        self.assertIn("its 450 tets are not the", run)
        self.assertTrue((self.folder / "out/scene/inputs/layers.material.vtu").exists())
        self.aspic("run", "out/scene/scene.toml", "--steps", "2", "--out", "again")

    def test_uniform_value_lies_between_the_layers(self):
        value = re.search(r"young +everywhere +([\d.]+) kPa", self.fit(*QUICK).stdout)
        self.assertTrue(10 < float(value[1]) < 60)  # 10 and 40, on a truth whose mesh is about 30 % too stiff

    def test_the_report_is_one_file(self):
        said = self.fit(*QUICK).stdout
        report = self.folder / "material.fit/report.html"
        if "built without its viewer" in said:
            self.assertFalse(report.exists())
            return
        text = report.read_text()
        self.assertIn('<script type="application/json" id="fit">', text)
        self.assertNotRegex(text.replace("http://www.w3.org/", ""), r'(src|href)="https?:')

    def test_quiet_and_verbose(self):
        self.assertEqual(self.fit(*QUICK, "-q").stdout, "")
        loud = self.fit(*QUICK, "-v", "--force").stdout
        self.assertEqual(loud.count("  iteration "), len(self.rows()))
        expected, first = loud.index("expected   about"), loud.index("  iteration ")
        self.assertRegex(loud[expected:], r"^expected   about [\d.]+( min \d+)? s in all, from the first iteration\n")
        self.assertLess(expected, first)

    def test_earlier_fit_is_replaced_only_by_force(self):
        self.fit(*QUICK, "-q")
        self.assertIn("--force replaces it", self.fit(*QUICK, code=2).stderr)
        self.assertIn("this fit is complete", self.fit(*QUICK, "--resume", code=2).stderr)
        self.fit(*QUICK, "-q", "--force")

    def test_unconverged_fit_is_no_success(self):
        few = self.options("iterations = 2", "uncertainty = false", "cross_validation = false")
        options = ("--unknown", "young=tets", *few, "-q")
        self.assertIn("(not_converged)", self.fit(*options, code=3).stderr)
        self.assertTrue((self.folder / "material.vtu").exists())
        self.fit(*options, "--force", "--allow-unconverged")

    def test_contradicted_field_becomes_uniform(self):
        """Forces of one indentation are 20 times too large: material, figures, exit code and report agree."""
        table = self.folder / "layers/cases.csv"
        with open(table, newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            for name in ("force_x", "force_y", "force_z"):
                if row["group"] == rows[0]["group"]:
                    row[name] = repr(20 * float(row[name]))
        with open(table, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        options = (*self.options("mesh_errors = false", "cross_validation = false"), "--known", "poisson=0.4")
        run = self.fit(*options, code=3)
        self.assertIn("not reliable (field_rejected): one value replaces the field", run.stderr)
        self.assertNotIn("verdict    good", run.stdout)
        figures = json.loads((self.folder / "material.fit/figures.json").read_text())
        self.assertFalse(figures["verdict"]["good"])
        self.assertEqual(figures["verdict"]["reasons"][0]["name"], "field_rejected")
        self.assertEqual(figures["unknowns"], 1)
        self.assertEqual(list(figures["values"]["young"]), ["everywhere"])
        value = re.search(r"young +everywhere +([\d.]+) (k?)Pa", run.stdout)
        young = float(value[1]) * (1e3 if value[2] else 1)
        self.assertAlmostEqual(young / figures["values"]["young"]["everywhere"]["value"], 1, places=3)
        self.fit(*options, "-q", "--force", "--allow-unconverged")

    def test_groups_are_held_out(self):
        with open(self.folder / "layers/cases.csv", newline="") as file:
            groups = sorted({row["group"] for row in csv.DictReader(file)})
        def leaving_out(group):
            return [*QUICK[2:], *self.options(QUICK_OPTIONS, f'leave_out = ["{group}"]')]

        self.assertIn("left out   positions within", self.fit(*leaving_out(groups[0])).stdout)
        refused = self.fit(*leaving_out("poke 99"), "--force", code=2).stderr
        self.assertIn("the data have no such group", refused)

    def test_options_are_checked_with_their_line(self):
        for line, message in (("smoth = 1", "did you mean 'smooth'?"), ('weight = "heavy"', "options.toml:1"),
                              ('rule = "evidnce"', "did you mean 'evidence'?"), ("parts = 1", "parts = 1"),
                              ("iterations = 0", "iterations = 0"), ("baselines = true", "baselines"),
                              ("prior = -1", "prior = -1"), ("mesh_errors = 1", "mesh_errors = 1")):
            self.assertIn(message, self.fit(*self.options(line), code=2).stderr, line)
        self.assertIn("none.toml", self.fit("--options", "none.toml", code=2).stderr)
        self.assertIn("cross_validation = true", self.aspic("fit", "--help").stdout)

    def test_options_beside_the_data_are_read_without_a_flag(self):
        beside = self.folder / "layers/aspic.fit.toml"
        beside.write_text("\n" + QUICK_OPTIONS + 'smooth = "tv"\n')
        uniform = QUICK[2:]
        self.fit(*uniform, "-q")
        stored = (self.folder / "material.fit/options.toml").read_text()
        for line in ('smooth = "tv"', "# smooth: layers/aspic.fit.toml:5", "# mesh_errors: layers/aspic.fit.toml:2",
                     "# iterations: default", "# young: command line", "# model: default"):
            self.assertIn(line + "\n", stored)
        self.fit(*uniform, "-q", "--force", *self.options(QUICK_OPTIONS))
        stored = (self.folder / "material.fit/options.toml").read_text()
        for line in ('smooth = "h1"', "# smooth: default", "# mesh_errors: options.toml:1"):
            self.assertIn(line + "\n", stored)
        beside.write_text('mesh_errors = false\nsmoth = "tv"\n')
        refused = self.fit(*uniform, "--force", code=2).stderr
        self.assertIn("layers/aspic.fit.toml:2", refused)
        self.assertIn("did you mean 'smooth'?", refused)

    def test_help_lists_at_most_twelve_flags(self):
        flags = re.findall(r"^  (-[^ ]+)", self.aspic("fit", "--help").stdout, re.M)
        self.assertIn("-h,--help", flags)
        self.assertLessEqual(len(flags) - 1, 12, flags)

    def test_bad_input_names_the_remedy(self):
        for arguments, message in (
                (("--unknown", "yuong=tets"), "did you mean 'young'?"),
                (("--unknown", "young=handles:many"), "handles:40"),
                (("--known", "poisson=0.5"), "poisson = 0.5; must be"),
                (("--known", "poisson"), "give QUANTITY=VALUE"),
                (("--unknown", "young=regions"), "no region labels"),
                (("-o", "material.obj"), "a material file is a .vtu"),
                (("--resume",), "no fit to resume")):
            self.assertIn(message, self.fit(*arguments, code=2).stderr, arguments)
        self.assertIn("nothing", self.aspic("fit", "nothing", code=2).stderr)

    def test_data_with_errors_are_refused_with_their_row(self):
        table = self.folder / "layers/positions.csv"
        lines = table.read_text().splitlines()
        lines[3] = re.sub(r"(?<=,)-?[\d.e-]+$", "nan", lines[3])
        table.write_text("\n".join(lines) + "\n")
        self.assertIn("positions.csv:4", self.fit(code=2).stderr)
        self.assertFalse((self.folder / "material.fit").exists())

    def test_check_reads_and_writes_no_material(self):
        self.aspic("check", "layers")
        self.assertFalse((self.folder / "material.vtu").exists())


class FitInterruption(FitCommand):
    """A long fit is stopped after a few iterations, in three ways, and resumed."""

    LINES = ("mesh_errors = false", "iterations = 12")
    OPTIONS = ("--options", "twelve.toml", "--unknown", "young=tets", "--known", "poisson=0.4", "--allow-unconverged")

    def setUp(self):
        super().setUp()
        self.write("twelve.toml", "\n".join(self.LINES) + "\n")

    def interrupt(self, with_signal):
        process = self.start("fit", "layers", *self.OPTIONS, "-o", "part.vtu", "-v")
        for line in process.stdout:
            if re.match(r"fit +iteration +2 ", line):
                break
        else:
            self.fail(process.stderr.read())
        process.send_signal(with_signal)
        said, complained = process.communicate(timeout=120)
        return process.returncode, said + complained

    def resume_and_compare(self):
        self.assertIn("--resume continues", self.fit(*self.OPTIONS, "-o", "part.vtu", code=2).stderr)
        other = [*self.OPTIONS[2:], *self.options(*self.LINES, 'smooth = "tv"'), "-o", "part.vtu", "--resume"]
        self.assertIn("smooth", self.fit(*other, code=2).stderr)
        before = self.rows("part.fit")
        said = self.fit(*self.OPTIONS, "-o", "part.vtu", "--resume").stdout
        self.assertIn(f"resuming after {len(before)} iterations", said)
        shutil.copytree(fitted(self.OPTIONS, self.LINES), self.folder, dirs_exist_ok=True)
        self.assertEqual(self.rows("part.fit")[:len(before)], before, "earlier rows are kept")
        self.assertEqual(self.rows("part.fit"), self.rows("whole.fit"))
        self.assertEqual(self.bytes_of("part.vtu"), self.bytes_of("whole.vtu"))

    def test_ctrl_c_keeps_progress_and_resumes_equally(self):
        code, said = self.interrupt(signal.SIGINT)
        self.assertEqual(code, 130)
        self.assertIn("the same command with --resume continues", said)
        self.assertTrue((self.folder / "part.vtu").exists())
        self.resume_and_compare()

    def test_kill_keeps_progress_and_resumes_equally(self):
        code, said = self.interrupt(signal.SIGTERM)
        self.assertEqual(code, 143)
        self.assertIn("the same command with --resume continues", said)
        self.assertTrue((self.folder / "part.vtu").exists())

    def test_kill_9_and_resume_give_equal_bits(self):
        code, _ = self.interrupt(signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        self.resume_and_compare()


class FitWithFriction(CommandLine):
    """The coefficient of a plate that presses and slides is estimated: equal bits for any threads and after a kill."""

    SETTINGS = """version = 1
mesh = "rest.mesh"
order = 1
fixed = "z < 1e-6"
[[tip]]
shape = "disc"
radius = 1
rim = 0.064
stiffness = 1e6
friction = 0.5
friction_deviation = 0.7
"""
    CASES = """case,touch_x,touch_y,touch_z,center_x,center_y,center_z,force_x,force_y,force_z,force_sd
press,0.5,0.5,1,0.5,0.5,0.97,0,0,-700,20
slide,0.5,0.5,1,0.6,0.5,0.97,210,0,-700,20
"""
    OPTIONS = ("--options", "friction.toml", "--unknown", "young=uniform", "--known", "poisson=0.4")

    def setUp(self):
        super().setUp()
        (self.folder / "plate").mkdir()
        self.write("plate/rest.mesh", box_mesh(2))
        self.write("plate/capture.toml", self.SETTINGS)
        self.write("plate/markers.csv", "marker,x,y,z\nA,0,0.5,0.5\n")
        self.write("plate/cases.csv", self.CASES)
        self.write("friction.toml", "mesh_errors = false\nlaw_errors = false\ncross_validation = false\n")

    def results(self, name, *options):
        """Material, history and figures of a fit; equilibria are counted per process."""
        self.aspic("fit", "plate", *self.OPTIONS, "-o", f"{name}.vtu", *options)
        folder = self.folder / f"{name}.fit"
        figures = json.loads((folder / "figures.json").read_text())
        del figures["equilibria"]
        return figures, (self.folder / f"{name}.vtu").read_bytes(), (folder / "history.csv").read_bytes()

    def test_bits_do_not_depend_on_threads(self):
        figures, *files = self.results("one", "--threads", "1")
        friction, = figures["errors"]
        self.assertEqual(friction["determined_by"], "data")
        self.assertAlmostEqual(friction["coefficient"], 0.3, delta=0.05)  # ratio of the forces
        self.assertEqual(self.results("four", "--threads", "4"), (figures, *files))

    def test_kill_9_and_resume_give_equal_bits(self):
        whole = self.results("whole")
        for iterations in (2, 6):  # in the first fit, and after a correction of the data
            name = f"part{iterations}"
            process = self.start("fit", "plate", *self.OPTIONS, "-o", f"{name}.vtu", "-v")
            seen = 0
            while seen < iterations:
                line = process.stdout.readline()
                self.assertTrue(line, "the fit ended")
                seen += " iteration " in line
            process.send_signal(signal.SIGKILL)
            process.communicate(timeout=120)
            self.assertEqual(process.returncode, -signal.SIGKILL)
            self.assertEqual(self.results(name, "--resume"), whole, f"killed after {iterations} iterations")


class FitWithLayer(CommandLine):
    """A layer of half the true stiffness on a column of poisson 0, whose compression is uniform."""

    YOUNG, LAYER = 60e3, 80e3  # Pa, Pa/m

    def compressed(self, depth):
        """Height and pressure of the column: E / 2 (1 / s - s) = layer (depth - (1 - s))."""
        low, high = 0.5, 1.0
        while high - low > 1e-12:
            s = (low + high) / 2
            low, high = (s, high) if self.YOUNG / 2 * (1 / s - s) > self.LAYER * (depth - 1 + s) else (low, s)
        return low, self.YOUNG / 2 * (1 / low - low)

    def test_estimates_layer_stiffness_with_interval(self):
        (self.folder / "plate").mkdir()
        self.write("plate/rest.mesh", box_mesh(3))
        self.write("plate/capture.toml", 'version = 1\nmesh = "rest.mesh"\nfixed = "z < 1e-6"\n[[tip]]\n'
                   'shape = "disc"\nradius = 3\ncontact = "bonded"\nstiffness = 4e4\nstiffness_deviation = 0.7\n')
        heights = [0.3, 0.5, 0.6, 0.8, 1.0]
        self.write("plate/markers.csv", "marker,x,y,z\n" + "".join(f"M{z},0,0.5,{z}\n" for z in heights))
        cases, positions = "case,touch_x,touch_y,touch_z,axis_x,axis_y,axis_z,depth,force,force_sd\n", "case,marker,x,y,z,sd\n"
        for depth in (0.025, 0.05, 0.075):
            s, pressure = self.compressed(depth)
            cases += f"{depth},0.5,0.5,1,0,0,-1,{depth},{pressure},10\n"
            positions += "".join(f"{depth},M{z},0,0.5,{s * z},2.5e-4\n" for z in heights)
        self.write("plate/cases.csv", cases)
        self.write("plate/positions.csv", positions)
        self.write("layer.toml", "mesh_errors = false\nlaw_errors = false\ncross_validation = false\n")
        said = self.aspic("fit", "plate", "--options", "layer.toml", "--model", "neo_hookean_log", "--unknown",
                          "young=uniform", "--known", "poisson=0", "-o", "layer.vtu").stdout
        figures = json.loads((self.folder / "layer.fit" / "figures.json").read_text())
        layer, = figures["errors"]
        self.assertEqual(layer["unit"], "Pa/m")
        self.assertAlmostEqual(layer["coefficient"] / self.LAYER, 1, delta=0.05)
        low, high = layer["coefficient_95"]
        self.assertTrue(low < layer["coefficient"] < high)
        self.assertRegex(said, r"layer stiffness of 'tip' +\S+ Pa/m \(\S+ to \S+ with 95 %\)")


class FitJobs(FitCommand):
    """Other processes compute the independent fits, in any order, and some are killed: the bits are those of one process."""

    DATA = ("4, 4, 3", 1)  # dozens of fits
    LINES = ("mesh_errors = false", "iterations = 5")
    FIELD = ("--options", "jobs.toml", "--unknown", "young=handles:6", "--known", "poisson=0.4", "--allow-unconverged")
    LAWS = ("--options", "jobs.toml", "--unknown", "young=uniform", "--known", "poisson=0.4", "--allow-unconverged",
            "--model", "auto")

    def setUp(self):
        super().setUp()
        self.write("jobs.toml", "\n".join(self.LINES) + "\n")
        self.random = random.Random(7)

    def jobs(self, options, codes=(4,)):
        done = subprocess.run([ASPIC, "fit-jobs", "layers", *options, "-o", "part.vtu", "--program", ASPIC],
                              cwd=self.folder, capture_output=True, text=True, timeout=300)
        self.assertIn(done.returncode, codes, done.stderr)
        return done

    def lines(self):
        return (self.folder / "part.fit/jobs.txt").read_text().splitlines()

    def run_lines(self, lines, kills=0):
        """Runs shuffled lines, two at a time; kills some of their processes at random times."""
        self.random.shuffle(lines)
        process = subprocess.Popen(["xargs", "-0", "-n", "1", "-P", "2", "sh", "-c"], stdin=subprocess.PIPE, cwd=self.folder,
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        process.stdin.write("\0".join("exec " + line for line in lines).encode())
        process.stdin.close()
        while kills > 0 and process.poll() is None:
            time.sleep(self.random.uniform(0, 0.1))
            children = subprocess.run(["pgrep", "-P", str(process.pid)], capture_output=True, text=True).stdout.split()
            for child in children[:1]:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(int(child), signal.SIGKILL)
            kills -= 1
        said = process.stdout.read().decode()
        process.stdout.close()
        process.wait(timeout=300)
        return process.returncode, said

    def run_rounds(self, options):
        """Repeats the list and its lines until the fit is complete; returns the names of all jobs, by round."""
        rounds = []
        while self.jobs(options, codes=(0, 4)).returncode == 4:
            lines = self.lines()
            rounds.append({line.split(" --job ")[1].rsplit("-", 1)[0] for line in lines})
            self.assertLess(len(rounds), 12, "no end")
            if len(rounds) == 1:
                self.run_lines(list(lines), kills=3)
                self.jobs(options)  # lists what was killed
                again = self.lines()
                self.assertTrue(set(again) <= set(lines) and again, "the killed jobs are listed again")
            self.assertEqual(self.run_lines(list(lines)), (0, ""), "lines of finished jobs do nothing")
        return rounds

    def assert_equal_fits(self):
        for name in ("vtu", "fit/history.csv"):
            self.assertEqual(self.bytes_of(f"part.{name}"), self.bytes_of(f"whole.{name}"), name)
        # Equilibria count those of this process.
        figures = [json.loads(re.sub(rb'"equilibria": *\d+', b'"x": 0', self.bytes_of(f"{name}.fit/figures.json")))
                   for name in ("part", "whole")]
        self.assertEqual(*figures)
        self.assertTrue(figures[0]["held_out"])
        self.assertEqual(sorted(p.name for p in (self.folder / "part.fit").iterdir()),
                         sorted(p.name for p in (self.folder / "whole.fit").iterdir()), "no jobs remain")

    def test_groups_of_a_field(self):
        shutil.copytree(fitted(self.FIELD, self.LINES, *self.DATA), self.folder, dirs_exist_ok=True)
        rounds = self.run_rounds(self.FIELD)
        self.assertEqual(rounds[0], {"held_out_1", "held_out_2", "one_value_held_out_1", "one_value_held_out_2"})
        self.assert_equal_fits()

    def test_laws(self):
        shutil.copytree(fitted(self.LAWS, self.LINES, *self.DATA), self.folder, dirs_exist_ok=True)
        rounds = self.run_rounds(self.LAWS)
        self.assertIn("law_yeoh_first", rounds[0])
        self.assertIn("law_yeoh_held_out_2", rounds[1])
        self.assertIn("held_out_2", rounds[-1])
        self.assert_equal_fits()

    def test_mistakes_and_repeated_commands(self):
        self.assertIn("no fit has been begun", self.jobs([*self.FIELD, "--job", "x"], codes=(2,)).stderr)
        self.jobs(self.FIELD)
        self.assertIn("no such job", self.jobs([*self.FIELD, "--job", "x"], codes=(2,)).stderr)
        other = [*self.FIELD[:-1], "--model", "stvk"]
        self.assertIn("model", self.jobs(other, codes=(2,)).stderr)
        lines = self.lines()
        self.assertEqual(self.run_lines(lines[:1]), (0, ""))
        result = next((self.folder / "part.fit/jobs").iterdir())
        result.write_bytes(result.read_bytes()[:-1])  # damaged: counts as missing
        self.jobs(self.FIELD)
        self.assertEqual(sorted(self.lines()), sorted(lines))
        self.assertEqual(self.fit(*self.FIELD, "-o", "part.vtu", "--resume").returncode, 0)  # computes the jobs itself
        material = self.bytes_of("part.vtu")
        self.assertIn("complete", self.jobs(self.FIELD, codes=(0,)).stdout)
        self.assertIn("model", self.jobs(other, codes=(2,)).stderr)
        self.assertEqual(self.run_lines(lines), (0, ""))
        self.assertEqual(self.bytes_of("part.vtu"), material)


if __name__ == "__main__":
    unittest.main(verbosity=2)

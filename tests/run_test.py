#!/usr/bin/env python3
"""Runs with their reports and pictures, and their interruption."""
import atexit
import fcntl
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

from command_line import ASPIC, BEAM, CommandLine, box_mesh, reversed_mesh


class Run(CommandLine):
    def test_a_scene_ends_with_a_summary(self):
        text = self.aspic("run", self.beam()).stdout
        for part in ("done", "5 of 5", "iterations per step", "peak memory", "out/beam", ".pvd"):
            self.assertIn(part, text)
        self.assertEqual(len(self.steps("out/beam")), 5)

    def test_a_tet_mesh_runs_without_a_scene(self):
        self.write("box.mesh", box_mesh())
        self.assertIn("note:", self.aspic("run", "box.mesh", "--steps", "2").stdout)

    def test_the_summary_omits_pins_of_twist(self):
        self.write("rod.toml", '[time]\nstep = 0.01\nduration = 0.02\n[[body]]\nname = "rod"\nrod = { radius = 1e-3 }\n'
                   'shape = { line = { to = [0.3, 0, 0], size = 0.1 } }\nmaterial = { young = 1e7, poisson = 0.3 }\n'
                   '[[body.pin]]\nwhere = "X < 0.15"\n')
        text = self.aspic("run", "rod.toml", "--set", "output.ply=true").stdout
        self.assertIn("rod.pin1 exerts", text)
        self.assertNotIn("twist exerts", text)
        self.assertIn(b"element edge 3\n", (self.folder / "out/rod/frames/skin_rod_000001.ply").read_bytes())

    def test_the_summary_names_inverted_tets(self):
        self.write("box.mesh", box_mesh())
        upside_down = ["--set", "material.model=neo_hookean", "--set", 'deform.displacement=["-1.5*X",0,0]']
        text = self.aspic("run", "box.mesh", "--steps", "2", "--set", "time.step=1e-5", *upside_down).stdout
        self.assertRegex(text, r"inverted   \d+ tets at the end, the smallest det F is -0\.\d+ in tet \d+ at \(")
        self.assertRegex(text, r"some tet in 2 of 2 steps, first in step 1")

    def test_the_summary_states_what_the_integrator_removed(self):
        self.write("spin.toml", 'gravity = [0, 0, 0]\n[time]\nstep = 0.01\nduration = 1\n[output]\nvtu = false\n'
                   '[[body]]\nshape = { box = { lower = [-1, 0, -1], upper = [1, 1, 1], cells = [1, 1, 1] } }\n'
                   'angular_velocity = [0, 6.28, 0]\nmaterial = { young = 1e9, poisson = 0.3, density = 1000 }\n')
        text = self.aspic("run", "spin.toml").stdout
        self.assertRegex(text, r"loss       numerical loss \S+ J, 4[34] % of the energy of motion; bdf2 loses less")
        self.assertNotIn("loss  ", self.aspic("run", "spin.toml", "--force", "--set", 'time.integrator="bdf2"').stdout)

    def test_an_existing_run_is_kept_unless_forced(self):
        scene = self.beam()
        self.aspic("run", scene)
        self.assertIn("--force", self.aspic("run", scene, code=2).stderr)
        self.aspic("run", scene, "--force")
        self.write("box.mesh", box_mesh())
        self.aspic("run", "box.mesh", "--steps", "1")
        self.write("box.mesh", "not loaded")
        self.assertIn("--force", self.aspic("run", "box.mesh", code=2).stderr)

    def test_the_resolved_scene_gives_the_same_results(self):
        self.aspic("run", self.beam(), "--out", "a")
        shutil.copy(self.folder / "a/scene.toml", self.folder / "beam_again.toml")
        self.aspic("run", "beam_again.toml", "--out", "b")
        self.assert_same_results("a", "b")

    def test_threads_do_not_change_results(self):
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

    def test_json_is_exactly_one_line_per_step(self):
        done = self.aspic("run", self.beam(), "--json")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([line["step"] for line in lines], [1, 2, 3, 4, 5])
        self.assertTrue(all(line["converged"] and line["iterations"] >= 1 for line in lines))
        self.assertIn("elasticity", lines[0]["potential"])
        self.assertIn("done", done.stderr)

    def test_json_numbers_vertices_as_the_file(self):
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

    def test_misspelled_key_is_corrected_with_its_place(self):
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

    def test_landscape_without_its_iteration_is_reported(self):
        error = self.aspic("run", self.beam(), "--landscape", "1:77").stderr
        self.assertIn("no landscape 1:77", error)
        self.assertIn("STEP:ITERATION", self.aspic("run", self.beam("b.toml"), "--landscape", "x", code=2).stderr)
        self.assertFalse((self.folder / "out" / "b").exists())

    def test_unconverged_step_shows_in_exit_code(self):
        scene = self.beam()
        hard = ["--set", "solver.max_iterations=1", "--set", "solver.tolerance=1e-12", "--set", "material.young=1e3"]
        self.assertIn("did not converge", self.aspic("run", scene, *hard, code=3).stderr)
        self.aspic("run", scene, *hard, "--force", "--allow-unconverged")
        self.aspic("run", scene, "--resume", code=3)  # also if the steps were taken before the resumption

    def test_set_accepts_several_assignments(self):
        self.aspic("run", "--set", "time.step=0.01", "time.duration=0.03", self.beam(), "--set", "output.report=false")
        self.assertEqual([step["time"] for step in self.steps("out/beam")], ["0.01", "0.02", "0.03"])

    def test_table_json_and_summary_contain_reactions(self):
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

    def test_explicit_blow_up_ends_the_run(self):
        done = self.aspic("run", self.beam(duration=100), "--set", "time.integrator=\"rk4\"", "--set", "time.step=0.1",
                          "--allow-unconverged", code=3)
        self.assertIn("stopped after step", done.stderr)
        self.assertIn("blew up", done.stderr)
        steps = self.steps("out/beam")
        self.assertLess(len(steps), 1000)
        self.assertEqual(steps[-1]["status"], "undefined")
        self.assertLessEqual({step["status"] for step in steps[:-1]}, {"converged", "unstable"})

    def test_blow_up_beside_moving_pin_fails(self):
        scene = self.beam(duration=0.2, cells="4, 1, 1", extra="""[[body.pin]]
where = "x > 0.399"
motion = { keyframes = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.2, displacement = [0, 0.01, 0] }] }
""")
        explicit = ["--set", "material.model=arap", "--set", 'time.integrator="symplectic_euler"', "--force"]
        self.aspic("run", scene, "--set", "time.step=0.001", *explicit)
        self.aspic("run", scene, "--set", "time.step=0.01", *explicit, code=3)
        self.assertIn("unstable", {step["status"] for step in self.steps("out/beam")})

    def test_table_json_and_summary_count_adaptive_steps(self):
        done = self.aspic("run", self.beam(), "--set", "time.adaptive.tolerance=1e-5", "--set",
                          "time.integrator=\"tr_bdf2\"", "--json")
        lines = [json.loads(line) for line in done.stdout.splitlines()]
        steps = self.steps("out/beam")
        self.assertEqual([line["substeps"] for line in lines], [int(step["substeps"]) for step in steps])
        self.assertEqual([line["rejected"] for line in lines], [int(step["rejected"]) for step in steps])
        taken, rejected = sum(line["substeps"] for line in lines), sum(line["rejected"] for line in lines)
        self.assertGreater(taken, 2 * len(steps))
        self.assertIn(f"substeps   {taken} accepted, {rejected} rejected", done.stderr)

    def test_adaptive_steps_require_a_capable_integrator(self):
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

    def test_run_writes_a_self_contained_report(self):
        text = self.aspic("run", self.beam()).stdout
        self.assertIn("browser: open out/beam/report.html: 6 frames", text)
        page = self.page("out/beam/report.html")
        self.assertIn('id="recording"', page)
        self.assertIsNone(re.search(r'<(script|link|img)[^>]*(src|href)="(?!data:)', page))
        self.assertNotIn(str(self.folder), page)

    def test_report_is_reproducible_and_replaced_by_force(self):
        scene = self.beam()
        self.aspic("run", scene)
        first = self.page("out/beam/report.html")
        self.aspic("report", "out/beam", "-o", "again.html")
        self.assertEqual(self.page("again.html"), first)
        self.aspic("run", scene, "--force", "--set", "output.report=false")
        self.assertFalse((self.folder / "out/beam/report.html").exists())

    def test_failed_report_does_not_fail_the_run(self):
        off = [word for name in ("vtu", "pc2", "usd") for word in ("--set", f"output.{name}=false")]
        done = self.aspic("run", self.beam(), "--quiet", *off)
        self.assertIn("warning: no report.html", done.stderr)
        self.assertIn("output.vtu = true", self.aspic("report", "out/beam", code=2).stderr)

    def test_bad_input_is_named(self):
        self.assertIn("not the directory of a run", self.aspic("report", self.beam(), code=2).stderr)
        (self.folder / "empty").mkdir()
        self.assertIn("contains no run", self.aspic("report", "empty", code=2).stderr)
        self.aspic("run", "beam.toml")
        (self.folder / "out/beam/frames/body_000003.vtu").write_text("<VTKFile")
        self.assertIn("body_000003.vtu", self.aspic("report", "out/beam", code=2).stderr)
        self.assertIn("--max-size", self.aspic("report", "out/beam", "--max-size", "0.1", code=2).stderr)


@unittest.skipUnless(shutil.which("chromium") and shutil.which("ffmpeg"), "chromium or ffmpeg is missing")
class Render(CommandLine):
    def setUp(self):
        super().setUp()
        self.aspic("run", self.beam(duration=0.04))

    def test_renders_frames_picture_and_video(self):
        self.aspic("render", "out/beam", "-o", "frames", "--size", "160x120", "--color", "von_mises", timeout=200)
        frames = sorted((self.folder / "frames").iterdir())
        self.assertEqual([f.name for f in frames], [f"frame_{i:06}.png" for i in range(1, 6)])
        for frame in frames:
            self.assertEqual(frame.read_bytes()[:24], b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes([0, 0, 0, 160, 0, 0, 0, 120]))
        self.assertNotEqual(frames[0].read_bytes(), frames[4].read_bytes())
        self.aspic("render", "out/beam", "-o", "last.png", "--size", "160x120", "--step", "4", "--dark", timeout=200)
        last = (self.folder / "last.png").read_bytes()
        self.assertNotEqual(last, frames[4].read_bytes())
        for options in (["--preset", "paper", "--transparent"], ["--preset", "talk"], ["--samples", "1"]):
            self.aspic("render", "out/beam", "-o", "a.png", "--size", "160x120", "--step", "4", *options, timeout=200)
            self.assertNotEqual((self.folder / "a.png").read_bytes(), last)
        self.aspic("render", "out/beam", "-o", "beam.webm", "--size", "160x120", "--every-frame", timeout=200)
        self.assertGreater((self.folder / "beam.webm").stat().st_size, 500)
        self.aspic("render", "out/beam", "-o", "beam.gif", "--size", "160x120", "--every-frame", timeout=200)
        self.assertEqual((self.folder / "beam.gif").read_bytes()[:6], b"GIF89a")
        self.assertEqual([f for f in self.folder.iterdir() if f.name.startswith(".aspic")], [])

    def test_draws_the_thickness_of_sheets(self):
        (self.folder / "mat.toml").write_text("""
[time]
step = 0.02
duration = 0.02
[[body]]
shape = { rectangle = { width = 1, height = 1, size = 0.3 } }
shell = { thickness = 0.08 }
material = { young = 1e5, poisson = 0.3, density = 300 }
""")
        self.aspic("run", "mat.toml")
        pictures = []
        for name, options in (("thin.png", []), ("thick.png", ["--thickness"])):
            self.aspic("render", "out/mat", "-o", name, "--size", "160x120", "--step", "1", *options, timeout=200)
            pictures.append((self.folder / name).read_bytes())
        self.assertNotEqual(*pictures)

    def test_bad_input_is_named(self):
        render = lambda *arguments: self.aspic("render", "out/beam", *arguments, code=2, timeout=200).stderr
        self.assertIn("--size 9x: write WIDTHxHEIGHT", render("-o", "a.png", "--step", "1", "--size", "9x"))
        self.assertIn("one picture needs --step", render("-o", "a.png"))
        self.assertIn("a video needs even width and height", render("-o", "a.mp4", "--size", "101x100"))
        self.assertIn("MP4 has no transparency", render("-o", "a.mp4", "--transparent"))
        self.assertIn("a.bmp: must be .png", render("-o", "a.bmp"))
        self.assertIn("the run has no sheets", render("-o", "a.png", "--step", "1", "--thickness"))
        self.assertIn("choose one of displacement", render("-o", "a.png", "--step", "1", "--color", "stress"))
        self.assertIn("choose one of front", render("-o", "a.png", "--step", "1", "--view", "above"))
        self.assertFalse((self.folder / "a.png").exists())

    def test_missing_browser_is_reported_with_its_package(self):
        without = dict(os.environ, PATH=str(self.folder))
        done = subprocess.run([ASPIC, "render", "out/beam", "-o", "frames"], cwd=self.folder, env=without,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("apt-get install chromium", done.stderr)


class Setup(CommandLine):
    """`build` of tools/setup.sh, which ./run calls, with a fake ninja."""

    def build(self, seconds, code=0, pause=0.5):
        for name, text in (("ninja", f"echo '[3/9] Building x'\n/bin/sleep {seconds}\nexit {code}\n"),
                           ("sleep", f"exec /bin/sleep {pause}\n")):
            (self.folder / self.write(name, "#!/bin/sh\n" + text)).chmod(0o755)
        script = f"root={self.folder}; . {pathlib.Path(__file__).parent.parent}/tools/setup.sh; build all"
        return subprocess.run(["sh", "-c", script], env={"PATH": f"{self.folder}:/usr/bin:/bin"}, capture_output=True,
                              text=True, timeout=60)

    def test_only_long_builds_are_announced(self):
        self.assertEqual(self.build(0, pause=100).stderr, "")  # the pause does not keep the pipe open
        self.assertIn("Building everything and its tests ... [3/9]\n", self.build(2).stderr)
        failed = self.build(0, code=1)
        self.assertEqual(failed.returncode, 1)
        self.assertIn("the build failed", failed.stderr)

    def test_the_page_is_announced_with_its_duration(self):
        setup = pathlib.Path(__file__).parent.parent / "tools/setup.sh"
        script = f"root={self.folder}; . {setup}; wasm_preset() {{ say prepare; }}; build() {{ say build; }}; build_site"
        lines = subprocess.run(["sh", "-c", script], capture_output=True, text=True, timeout=60).stderr.splitlines()
        self.assertIn("out/site/index.html", lines[0])
        self.assertIn("5 to 25 minutes the first time", lines[1])
        self.assertEqual(lines[2:], ["prepare", "build"])

    def run_script(self, *arguments):
        return subprocess.run([pathlib.Path(__file__).parent.parent / "run", *arguments], capture_output=True, text=True,
                              env={"PATH": "/usr/bin:/bin"}, timeout=10)

    def test_help_and_errors_name_all_commands_without_a_build(self):
        of_aspic = re.findall(r"^  ([a-z][a-z-]*)  ", self.aspic("--help").stdout, re.M)
        wrong = self.run_script("rum")
        self.assertEqual(wrong.returncode, 1)
        text = self.run_script("--help").stdout
        for name in {*of_aspic, "python", "notebook", "site", "gallery", "render"}:
            self.assertRegex(text, rf"\b{name}\b")
            self.assertRegex(wrong.stderr, rf"\b{name}\b")


class Interruption(CommandLine):
    """A run of a hundred steps is stopped midway, in three ways, and resumed."""

    def setUp(self):
        super().setUp()
        self.scene = self.beam(duration=1.0, cells="8, 3, 3")
        shutil.copytree(self.unbroken(), self.folder / "whole")

    @staticmethod
    @functools.cache
    def unbroken():
        """The same run without interruption, created once."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="aspic_cli_"))
        atexit.register(shutil.rmtree, folder)
        (folder / "beam.toml").write_text(BEAM.format(duration=1.0, cells="8, 3, 3"))
        subprocess.run([ASPIC, "run", "beam.toml", "--out", "whole"], cwd=folder, check=True, timeout=600,
                       capture_output=True)
        return folder / "whole"

    def interrupt(self, with_signal, out):
        process = self.start("run", self.scene, "--out", out, "--json")
        # A pipe with a small buffer blocks the run, so that it cannot end before it is interrupted.
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

    def test_ctrl_c_and_resume_give_equal_bits(self):
        self.assertEqual(self.interrupt(signal.SIGINT, "stopped"), 130)
        self.resume_and_compare("stopped")

    def test_kill_and_resume_give_equal_bits(self):
        self.assertEqual(self.interrupt(signal.SIGTERM, "stopped"), 143)
        self.resume_and_compare("stopped")

    def test_kill_9_and_resume_give_equal_bits(self):
        self.assertEqual(self.interrupt(signal.SIGKILL, "stopped"), -signal.SIGKILL)
        self.resume_and_compare("stopped")

    def test_steps_option_and_resume_give_equal_bits(self):
        self.aspic("run", self.scene, "--out", "stopped", "--steps", "30")
        self.resume_and_compare("stopped")

    def test_resume_needs_a_run(self):
        self.assertIn("no run to resume", self.aspic("run", self.scene, "--resume", code=2).stderr)

    def test_a_complete_run_has_nothing_to_resume(self):
        scene = self.beam("short.toml")
        self.aspic("run", scene)
        self.assertIn("nothing to do", self.aspic("run", "out/short", "--resume").stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)

#!/usr/bin/env python3
"""Commands that compare methods and results: minimize, compare, verify, lecture."""
import csv
import json
import os
import re
import shutil
import subprocess
import time
import unittest
import xml.etree.ElementTree

from command_line import ASPIC, CommandLine, box_mesh


class Minimize(CommandLine):
    def rows(self, *arguments, code=0):
        lines = self.aspic("minimize", *arguments, "--json", code=code).stdout.splitlines()
        return [json.loads(line) for line in lines[:-1]], json.loads(lines[-1])

    def test_newton_with_line_search_reaches_known_minimum(self):
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

    def test_gradient_descent_crosses_the_valley_each_iteration(self):
        rows, end = self.rows("rosenbrock", "--method", "gradient_descent", "--max-iterations", "300", code=3)
        self.assertEqual(end["status"], "iteration_limit")
        # Component of each direction orthogonal to the floor of the valley, y = x^2.
        across = [row["direction"][1] - 2 * row["x"][0] * row["direction"][0] for row in rows]
        self.assertEqual(len(across), 300)
        self.assertTrue(all(a * b < 0 for a, b in zip(across, across[1:])))

    def test_table_ends_with_a_summary(self):
        text = self.aspic("minimize", "rosenbrock", "--start", "-0.8,0.6").stdout
        self.assertIn("from (-0.8, 0.6)", text)
        self.assertIn("converged after", text)
        self.assertIn("distance to the minimum at (1, 1)", text)

    def test_help_names_every_definiteness(self):
        text = self.aspic("minimize", "--help").stdout
        self.assertIn("auto, on_demand, progressive, clamped, absolute, exact", text)

    def test_definiteness_advice_only_with_exact_hessian(self):
        start = ("minimize", "--expression", "x", "--start", "1,2")
        self.assertNotIn("--definiteness", self.aspic(*start, code=3).stdout)
        self.assertIn("--definiteness on_demand", self.aspic(*start, "--definiteness", "exact", code=3).stdout)

    def test_overflow_is_printed_without_sign(self):
        text = self.aspic("minimize", "--expression", "-exp(x^2+y^2)", "--start", "1,2", code=3).stdout
        self.assertIn("|g| = nan; residual nan", text)
        self.assertNotIn("-nan", text)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs a device that is always full")
    def test_lost_output_is_an_error(self):
        for arguments in (["--list"], ["rosenbrock", "--json"],
                          ["rosenbrock", "--json", "--method", "gradient_descent", "--max-iterations", "2000"]):
            with open("/dev/full", "w") as full:
                done = subprocess.run([ASPIC, "minimize", *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 2, arguments)
            self.assertIn("standard output: cannot be written", done.stderr)

    def test_flat_region_is_no_minimum(self):
        self.assertIn("not the minimum", self.aspic("minimize", "two_bump", "--start", "4,4").stdout)

    def test_minimizes_an_own_formula(self):
        _, end = self.rows("--expression", "cosh(x - 1) + 2 * (y + 0.5)^2", "--start", "2.5,1")
        self.assertAlmostEqual(end["x"][0], 1, places=5)
        self.assertAlmostEqual(end["x"][1], -0.5, places=5)

    def test_unbounded_functions_end_with_a_status(self):
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
                                   (["rosenbrock", "--method", "newton,lbfgs", "--trace", "t"], "single method"),
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

    def test_writes_pictures_and_trace(self):
        self.aspic("minimize", "rosenbrock", "--plot", "path.svg", "--plot-model", "model.png", "--iteration", "6",
                   "--trace", "trace")
        self.assertEqual(xml.etree.ElementTree.parse(self.folder / "path.svg").getroot().tag.split("}")[-1], "svg")
        self.assertTrue((self.folder / "model.png").read_bytes().startswith(b"\x89PNG"))
        with open(self.folder / "trace" / "iterations.csv", newline="") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 18)

    def test_draws_the_paths_of_several_methods(self):
        self.aspic("minimize", "rosenbrock", "--method", "gradient_descent,newton:clamped", "--max-iterations", "20000",
                   "--plot", "paths.svg")
        picture = (self.folder / "paths.svg").read_text()
        self.assertRegex(picture, r">gradient descent, \d+ iterations<")
        self.assertRegex(picture, r">newton:clamped, \d+ iterations<")

    def test_json_names_the_method(self):
        rows, end = self.rows("rosenbrock", "--method", "newton", "--method", "lbfgs")
        self.assertEqual([row["method"] for row in rows if "status" in row] + [end["method"]], ["newton", "lbfgs"])
        self.assertEqual({row["method"] for row in rows}, {"newton", "lbfgs"})

    def test_missing_gnuplot_is_reported_first(self):
        done = subprocess.run([ASPIC, "minimize", "rosenbrock", "--plot", "path.svg"], cwd=self.folder,
                              capture_output=True, text=True, env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual(done.returncode, 2)
        self.assertIn("gnuplot-nox", done.stderr)
        self.assertEqual(done.stdout, "")


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

    def test_unfinished_method_shows_in_exit_code(self):
        def distance(seconds):
            out = self.aspic("compare", self.beam(cells="40, 10, 10"), "--methods", "gradient_descent",
                             "--max-seconds", seconds, code=3).stdout
            self.assertIn("time limit", out)
            return json.loads((self.folder / "out" / "compare_beam" / "comparison.json").read_text())["methods"][0]["distance"]

        self.assertLess(distance("2"), distance("0.01"))  # that of the last iterate

    def test_bad_input_is_named(self):
        for arguments, message in ((["--methods", "newtn"], "newton"), (["--methods", "newton:clampd"], "clamped"),
                                   (["--methods", "newton", "--set", "time.integrator=forward_euler"], "implicit")):
            self.assertIn(message, self.aspic("compare", self.beam(), *arguments, code=2).stderr)


class Verify(CommandLine):
    def verify(self, *arguments, code=0):
        return self.aspic("verify", "--quick", *arguments, code=code).stdout

    def results(self):
        return json.loads((self.folder / "out/verify/verify.json").read_text())["checks"]

    def test_list_names_every_check(self):
        rows = self.verify("--list").splitlines()
        self.assertGreater(len(rows), 20)
        self.assertIn("statics/cook", [row.split()[0] for row in rows])
        self.assertFalse((self.folder / "out").exists())

    def test_rows_state_measurement_reference_and_reason(self):
        text = self.verify("--only", "free_fall", "--only", "invariants/numbering")
        self.assertRegex(text, r"pass  backward_euler: distance from the closed form .* \+- 1e-13 m")
        self.assertIn("(round-off of 10 solves", text)
        self.assertEqual([check["check"] for check in self.results()], ["invariants/numbering", "integrators/free_fall"])
        for check in self.results():
            self.assertTrue(check["passes"] and check["rows"])
            for row in check["rows"]:
                self.assertLessEqual(abs(row["measured"] - row["reference"]), row["tolerance"])
                self.assertTrue(row["reason"])

    def test_page_contains_every_check(self):
        self.verify("--only", "euler_energies")
        page = (self.folder / "out/verify/index.html").read_text()
        self.assertIn("symplectic_euler: drift", page)
        self.assertIn("<svg", page)
        self.assertNotRegex(page, r'(src|href)="http')

    def test_page_has_the_formulas_of_a_reference(self):
        self.verify("--only", "free_fall")
        self.assertIn("n (n + 1)", self.results()[0]["formulas"][0])
        page = (self.folder / "out/verify/index.html").read_text()
        judged = page[page.index("Free fall of an elastic box</h"):]  # after the update rules of all integrators
        shown = "<math" if "render" in self.aspic("--help").stdout else "tfrac12 g h^2"
        self.assertEqual(judged.count(shown), 3)

    def test_page_has_formulas_above_material_checks(self):
        self.verify("--only", "uniaxial_table")
        page = (self.folder / "out/verify/index.html").read_text()
        if "render" in self.aspic("--help").stdout:  # formulas are made with the viewer's page
            self.assertLess(page.index("<mi>ψ</mi>"), page.index("aspic verify --only materials/uniaxial_table"))

    def test_a_wrong_integrator_or_material_fails(self):
        text = self.verify("--only", "free_fall", "--instead", "bdf2=backward_euler", code=3)
        self.assertIn("FAIL  bdf2:", text)
        self.assertIn("pass  midpoint:", text)
        self.assertFalse(self.results()[0]["passes"])
        self.verify("--only", "materials/uniaxial", "--instead", "stvk=corotated", code=3)
        self.assertEqual(len(self.results()), 1)  # not the table beside it
        self.verify("--only", "uniaxial_table", "--instead", "stvk=corotated", code=3)

    def test_uncomputable_check_fails(self):
        # The explicit scheme blows up, so the period cannot be measured.
        text = self.verify("--only", "pendulum", "--instead", "midpoint=forward_euler", code=3)
        self.assertIn("FAIL  could not be computed", text)
        self.assertIsNone(self.results()[0]["rows"][-1]["measured"])

    def test_bad_input_is_named(self):
        self.assertIn("no check matches 'nonsense'", self.aspic("verify", "--only", "nonsense", code=2).stderr)
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

    def test_page_states_claim_measurement_and_verdict(self):
        text = self.lecture("54")
        self.assertIn("claim: ", text)
        self.assertRegex(text, r"pass  .*: \S+.*\((<=|>=|=) \S+")
        self.assertIn("PASS", text)
        with open(self.folder / "out/lecture/54-59_overshoot/trials.csv", newline="") as file:
            alphas = [float(row["alpha"]) for row in csv.DictReader(file)]
        self.assertEqual(alphas, [1, 0.5, 0.25])
        page = re.search(r"browser: open (out/lecture/54-59_overshoot/index\.html)", text)[1]
        self.assertIn("Newton", (self.folder / page).read_text())

    def test_pages_run_on_a_given_mesh(self):
        text = self.lecture("26", "--mesh", self.mesh(4), "--out", "here")
        self.assertIn("PASS", text)
        self.assertIn("box4.mesh", text)
        self.aspic("run", "here/26-31_optimization/05_swing.toml", "--steps", "1")

    def test_demonstration_without_its_claim_fails(self):
        text = self.lecture("53", "--mesh", self.mesh(1), code=3)  # too few tets to make Newton's method fail
        self.assertRegex(text, r"FAIL  without line search: converged: 1")

    def test_unjudged_page_is_no_pass(self):
        text = self.lecture("4")
        self.assertIn("nothing to check", text)
        self.assertNotIn("pass", text.lower())

    def test_bodies_tumble_down_chutes(self):
        text = self.lecture("6", "--mesh", self.mesh(2))
        self.assertIn("pass  steps whose surfaces intersect: 0", text)
        self.assertIn("PASS", text)

    def test_a_bad_page_is_named(self):
        for page in ("0", "63", "5x", "first"):
            self.assertIn(f"'{page}' is not a page", self.aspic("lecture", page, code=2).stderr)
        self.aspic("lecture", "5", "--mesh", "missing.mesh", code=2)

    def test_judges_numbers_without_browser_and_gnuplot(self):
        without = dict(os.environ, PATH=str(self.folder))
        done = subprocess.run([ASPIC, "lecture", "25", "--mesh", self.mesh(4)], cwd=self.folder, env=without,
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, "note: no pictures of meshes: .*(apt-get install chromium|built without)")
        self.assertIn("note: no charts: gnuplot is not installed", done.stdout)
        self.assertIn("PASS", done.stdout)
        self.assertEqual([f.suffix for f in (self.folder / "out/lecture/25_drag").iterdir() if f.suffix in (".png", ".svg")], [])

    def test_summary_covers_all_pages(self):
        self.lecture("all", "--mesh", self.mesh(6))
        if "render" in self.aspic("--help").stdout:  # formulas are made with the viewer's page
            self.assertIn("<math", (self.folder / "out/lecture/index.html").read_text())
        with open(self.folder / "out/lecture/lecture.json") as file:
            summary = json.load(file)
        verdicts = {page["page"]: page["verdict"] for page in summary["pages"]}
        self.assertEqual([n for n, v in verdicts.items() if v == "nothing to check"], [4, 35, 52])
        self.assertEqual(verdicts[6], "pass")
        self.assertEqual(sum(v == "pass" for v in verdicts.values()), 59)
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
            self.assertIn(demonstration["title"].replace('"', "&quot;"), page)
        self.assertNotIn("http://", page.replace("http://www.w3.org", ""))

    def test_step_without_single_minimization_is_refused(self):
        for setting, message in (("time.integrator=tr_bdf2", "minimizes twice"),
                                 ("time.integrator=bdf2", "in a later one"),
                                 ("time.integrator=linearly_implicit_euler", "one iteration"),
                                 ("time.adaptive.tolerance=1e-3", "constant step length")):
            refused = self.aspic("compare", self.beam(), "--methods", "newton,lbfgs", "--set", setting, code=2)
            self.assertIn(message, refused.stderr)
        self.aspic("compare", self.beam(), "--methods", "newton,lbfgs", "--set", "time.integrator=bdf2", "--step", "2")

    def test_unwritable_folder_is_reported_before_the_work(self):
        (self.folder / "taken").write_text("")
        refused = self.aspic("compare", self.beam(), "--methods", "newton", "--out", "taken/here", code=2)
        self.assertIn("cannot be created", refused.stderr)
        self.assertNotIn("newton ...", refused.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

#!/usr/bin/env python3
"""The report of `aspic fit` as a browser shows it: its tables have the numbers of figures.json, and its marks agree with
the verdict.

usage: ASPIC=path/to/aspic fit_page_test.py [TestCase...]
"""
import csv
import html.parser
import json
import math
import re
import shutil
import subprocess
import tempfile
import unittest

from command_line import CommandLine, box_mesh

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
PREFIXES = {"G": 1e9, "M": 1e6, "k": 1e3, "m": 1e-3, "µ": 1e-6, "n": 1e-9, "": 1}

BODY = """
[[body]]
name = "block"
shape = { box = { upper = [0.12, 0.12, 0.06], cells = [6, 6, 3] } }
material = { young = 2e4, poisson = 0.4 }
[[body.pin]]
where = "Z < 1e-6"
"""
HOLD = """version = 1
mesh = "rest.mesh"
fixed = "z < 1e-6"
order = 1
steady = "history"
forces = "load.csv"
[[grip]]
name = "top"
where = "z > 1 - 1e-6"
"""


class Tables(html.parser.HTMLParser):
    """Tables of a page: rows of (classes, texts of the cells); and the classes and text of the verdict."""

    def __init__(self, text):
        super().__init__()
        self.tables, self.cell, self.verdict, self.inside = [], None, None, 0
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        classes = (dict(attributes).get("class") or "").split()
        if tag == "table":
            self.tables.append([])
        elif tag == "tr" and self.tables:
            self.tables[-1].append((classes, []))
        elif tag in ("th", "td") and self.tables:
            self.cell = []
        elif tag == "div" and (self.inside or "verdict" in classes):
            self.inside += 1
            self.verdict = self.verdict or {"classes": classes, "text": ""}

    def handle_endtag(self, tag):
        if tag in ("th", "td") and self.cell is not None:
            self.tables[-1][-1][1].append("".join(self.cell))
            self.cell = None
        elif tag == "div" and self.inside:
            self.inside -= 1

    def handle_data(self, data):
        if self.cell is not None:
            self.cell.append(data)
        elif self.inside:
            self.verdict["text"] += data

    def table(self, first):
        """Rows of the table with this first title, by their first cell."""
        found = [t for t in self.tables if t and t[0][1][:1] == [first]]
        return {cells[0]: (classes, cells[1:]) for classes, cells in found[0][1:]} if found else None


def number(text, unit):
    """'12.5 kPa' with the unit Pa: 12500."""
    match = re.fullmatch(rf"([-+\d.e]+) ?([GMkmµn]?){re.escape(unit)}", text.replace("−", "-"))
    assert match, f"{text!r} has not the unit {unit!r}"
    return float(match[1]) * PREFIXES[match[2]]


@unittest.skipUnless(CHROMIUM, "no Chromium")
class FitPage(CommandLine):
    def page(self):
        report = self.folder / "material.fit/report.html"
        if not report.exists():
            self.skipTest("built without the viewer")
        with tempfile.TemporaryDirectory() as profile:
            done = subprocess.run(
                [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader",
                 "--enable-unsafe-swiftshader", f"--user-data-dir={profile}", "--virtual-time-budget=20000", "--dump-dom",
                 report.as_uri()], capture_output=True, text=True, timeout=300)
        self.dom = done.stdout
        return Tables(done.stdout)

    def fit(self, *arguments, code=0):
        self.aspic("fit", "data", "-q", "--force", *arguments, code=code, timeout=400)
        self.figures = json.loads((self.folder / "material.fit/figures.json").read_text())
        tables = self.page()
        self.check_verdict(tables)
        return tables

    def check_verdict(self, tables):
        """One verdict, which agrees with every check and row."""
        verdict = self.figures["verdict"]
        self.assertIn("good" if verdict["good"] else "bad", tables.verdict["classes"])
        for reason in verdict["reasons"]:
            self.assertIn(reason["text"], tables.verdict["text"])
        checks = tables.table("check")
        exceeded = [what for what, (_, cells) in checks.items() if "exceeded" in cells[-1]]
        self.assertEqual(exceeded, [what for what, (classes, _) in checks.items() if "bad" in classes])
        with_figures = [r for r in verdict["reasons"] if "value" in r and r["name"] != "field_rejected"]
        self.assertEqual(bool(exceeded), bool(with_figures), (exceeded, verdict))
        figures = self.figures
        text, squares = checks["|r|² per reading (expected: 1)"][1][0], figures["squares"] / figures["residuals"]
        if squares < 0.01:
            self.assertEqual(text, "< 0.01")
        else:
            self.assert_near(number(text, ""), squares, 0.01)
        for error in figures.get("common_errors", []):
            self.assertIn(f"error of {error['cause']}", checks)
        for truth in figures["truth"]:
            name = {"young": "Young's modulus"}.get(truth["quantity"], truth["quantity"])
            if truth["coverage"] >= 0:
                text = checks[f"tets whose 95 % interval of {name} contains the truth"][1][0]
                self.assertLess(abs(number(text, "%") - 100 * truth["coverage"]), 0.6)
        self.check_values(tables)

    def check_values(self, tables):
        rows = [cells for table in tables.tables if table[0][1][0] == "quantity" for _, cells in table[1:]]
        units = {"young": "Pa", "poisson": ""}
        shown = iter(rows)
        for name, places in self.figures["values"].items():
            for value in places.values():
                _, _, text, interval = next(shown)
                self.assert_near(number(text, units[name]), value["value"], 5e-3)
                if "lower" in value:
                    ends = [number(end, units[name]) for end in interval.split(" to ")]
                    self.assertLess(ends[0], ends[1])
                    width = value["upper"] - value["lower"]
                    self.assertLess(abs(ends[0] - value["lower"]) + abs(ends[1] - value["upper"]), 0.1 * width)

    def assert_near(self, a, b, tolerance):
        self.assertLessEqual(abs(a - b), tolerance * max(abs(b), 1e-12), (a, b))

    def capture(self, young="2e4", pokes=3, markers=30):
        self.write("truth.toml", BODY.replace("2e4", young))
        self.aspic("capture", "truth.toml", "-o", "data", "--pokes", str(pokes), "--depths", "1", "--tip", "disc:0.016",
                   "--depth", "0.06", "--markers", str(markers), "--noise", "0.02", "--force-noise", "0.02", "-q", timeout=300)

    def change_table(self, name, change):
        path = self.folder / "data" / name
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
        change(rows)
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)

    def test_errors_and_outliers(self):
        self.capture()
        settings = self.folder / "data/capture.toml"
        settings.write_text("errors = { tare = 0.02, force_scale = 0.03 }\n" + settings.read_text())
        self.write("data/aspic.fit.toml", 'mesh_errors = false\nloss = "robust"\n')
        self.change_table("positions.csv", lambda rows: rows[7].update(x=repr(float(rows[7]["x"]) + 0.005)))
        tables = self.fit("--unknown", "young=uniform", "--known", "poisson=0.4", "--allow-unconverged")
        shown = tables.table("error")
        for error in self.figures["errors"]:
            name = error["name"] + ("" if error["unit"] else " (logarithm of the factor)")
            estimate, interval, prior, _, determined = shown.pop(name)[1]
            unit, sd = error["unit"], error["deviation"]
            self.assertLess(abs(number(estimate, unit) - error["value"]), 0.01 * abs(error["value"]) + 1e-12)
            ends = [number(end, unit) for end in interval.split(" to ")]
            for end, sign in zip(ends, (-1, 1)):
                self.assertLess(abs(end - error["value"] - 1.96 * sign * sd), 0.1 * sd)
            self.assert_near(number(prior.removeprefix("0 ± "), unit), error["prior_deviation"], 0.01)
            self.assertEqual(determined, error["determined_by"])
        self.assertEqual(shown, {})
        outliers = [(o["case"], "marker " + o["reading"]) for o in self.figures["outliers"]]
        self.assertTrue(outliers)
        self.assertIn([t for t in tables.tables if t[0][1][:2] == ["case", "reading"]][0][1][1][:1], [[o[0]] for o in outliers])
        worst = [cells for t in tables.tables if t[0][1][0] == "marker" for _, cells in t[1:]][0]
        self.assertIn((worst[1], "marker " + worst[0]), outliers)
        self.assertGreater(float(worst[-1]), 5)  # in stated standard deviations, not those of the robust loss

    def test_contradicted_fit(self):
        self.capture()
        self.write("data/aspic.fit.toml", "mesh_errors = false\n")

        def triple(rows):
            rows[0].update({f"force_{a}": repr(3 * float(rows[0][f"force_{a}"])) for a in "xyz"})
        self.change_table("cases.csv", triple)
        tables = self.fit("--unknown", "young=uniform", "--known", "poisson=0.4", code=3)
        self.assertTrue(self.figures["verdict"]["reasons"])
        self.assertTrue(any("exceeded" in cells[-1] for _, cells in tables.table("check").values()))

    def test_laws(self):
        self.capture()
        self.write("data/aspic.fit.toml", "mesh_errors = false\n")
        tables = self.fit("--unknown", "young=uniform", "--known", "poisson=0.4", "--model", "auto", "--allow-unconverged")
        shown, laws = tables.table("law"), self.figures["laws"]
        self.assertEqual(list(shown), [t["law"] for t in laws["trials"]])
        for trial in laws["trials"]:
            classes, cells = shown[trial["law"]]
            self.assertEqual("total" in classes, trial["law"] == laws["chosen"])
            self.assertEqual(cells[-1], trial["verdict"])
            if not trial["ok"]:
                continue
            self.assert_near(number(cells[0], ""), trial["squares_per_reading"], 0.01)
            for text, key in zip(cells[1:3], ("evidence_loss", "held_out_loss")):
                self.assert_near(-number(text, ""), trial[key], 0.01)
            for text, key in zip(cells[3:5], ("position_error", "force_error")):
                self.assert_near(number(text, "%") / 100, trial[key], 0.06)
            self.assertIn("young", cells[5])
            self.assertIn("Pa", cells[5])

    def test_parts(self):
        """Values of parts have intervals, and the volumes and the contrast are those of figures.json."""
        self.capture('"X < 0.06 ? 6e4 : 2e4"', pokes=4, markers=60)
        self.write("data/aspic.fit.toml", "cross_validation = false\nparts = 2\n")
        tables = self.fit("--known", "poisson=0.4", "--allow-unconverged")
        rows = [cells for t in tables.tables if t[0][1][0] == "quantity" for _, cells in t[1:]]
        self.assertEqual([r[1] for r in rows], ["part 1", "part 2", "given"])
        parts, values = self.figures["parts"], self.figures["values"]["young"]
        for true, value in zip((2e4, 6e4), values.values()):
            self.assertLess(value["lower"], true)
            self.assertGreater(value["upper"], true)
        text = re.search(r"(Part 1 is [^<]*)\. The stiffest is ([^<]*) times as stiff as the softest "
                         r"\(95 %: ([^<]*) to ([^<]*)\)", self.dom)
        self.assertAlmostEqual(sum(parts["volumes"]), 1, places=9)
        for k, (shown, volume) in enumerate(zip(text[1].split(", "), parts["volumes"], strict=True)):
            share = re.fullmatch(rf"[Pp]art {k + 1} is (.*) of the body", shown)[1]
            self.assert_near(number(share, "%") / 100, volume, 0.06)
        for shown, end in zip(text.groups()[1:], ("value", "lower", "upper")):
            self.assert_near(float(shown), parts["contrast"][end], 0.01)
        self.assert_near(parts["contrast"]["value"], values["part 2"]["value"] / values["part 1"]["value"], 1e-9)

    def test_relaxation(self):
        """A ramp of 0.1 s that is held, of a standard linear solid with Poisson's ratio 0, by its closed form."""
        (self.folder / "data").mkdir()
        self.write("data/rest.mesh", box_mesh(1))
        self.write("data/capture.toml", HOLD)
        self.write("data/aspic.fit.toml", "mesh_errors = false\ncross_validation = false\nbranches = 1\n")
        ratio, tau, rise, strain, young = 0.5, 3.0, 0.1, 1e-3, 2e4
        times = [0.02 * k for k in range(1, 51)] + [1 + 0.1 * k for k in range(1, 400)]
        lines = ["time,force"]
        for k, t in enumerate(times):
            start = max(t - rise, 0)
            force = young * strain / rise * (t - start + ratio * tau * (math.exp(-start / tau) - math.exp(-t / tau)))
            lines.append(f"{t!r},{force * (1 + 0.003 * math.sin(997 * k * k))!r}")
        self.write("data/load.csv", "\n".join(lines) + "\n")
        self.write("data/markers.csv", "marker,vertex\nA,7\n")
        self.write("data/cases.csv", "case,group,time,grip,move_x,move_y,move_z\n"
                   f"start,hold,0,top,0,0,0\npeak,hold,{rise},top,0,0,{strain}\nend,hold,{times[-1]},top,0,0,{strain}\n")
        tables = self.fit("--unknown", "young=uniform", "--known", "poisson=0", "--allow-unconverged")
        shown = tables.table("relaxation")
        self.assert_near(number(shown["branch 1: relaxation time"][1][0], "s"), tau, 0.05)
        self.assert_near(number(shown["branch 1: shear modulus / that of the material"][1][0], ""), ratio, 0.05)
        for _, (_, interval) in shown.values():
            lower, upper = (float(end.removesuffix(" s")) for end in interval.split(" to "))
            self.assertLess(lower, upper)
        self.assertIn("|r|² per reading of the histories", tables.table("check"))
        self.assertEqual(self.captions(), ["hold: force"])
        value = self.figures["values"]["young"]["everywhere"]["value"]
        self.assert_near(value, young, 0.02)
        self.assertIn("its stiffness includes the factor", self.dom)

    def captions(self):
        """Of the charts over time."""
        section = re.search(r"<h2[^>]*>Relaxation</h2>.*?</section>", self.dom, re.S)[0]
        return re.findall(r"<figcaption>(.*?)</figcaption>", section)

    def test_creep(self):
        """A sudden weight on a standard linear solid with Poisson's ratio 0, by its closed form: a chart per marker."""
        (self.folder / "data").mkdir()
        self.write("data/rest.mesh", box_mesh(1))
        self.write("data/capture.toml", HOLD.split("forces =")[0] + '[[patch]]\nname = "top"\nwhere = "z > 1 - 1e-6"\n')
        self.write("data/aspic.fit.toml", "mesh_errors = false\ncross_validation = false\nbranches = 1\n")
        ratio, tau, strain, young, sd = 0.6, 5.0, 1e-3, 2e4, 2e-6
        times = [0] + [0.2 * 1.25 ** k for k in range(28)]
        self.write("data/markers.csv", "marker,x,y,z\nA,0,0,1\nB,1,1,1\n")
        self.write("data/cases.csv", "case,group,time,dead_pressure,patch\n"
                   + "".join(f"t{k},creep,{t!r},{-young * strain},top\n" for k, t in enumerate(times)))
        rows = ["case,marker,x,y,z,sd"]
        for k, t in enumerate(times):
            e = strain * (1 - ratio / (1 + ratio) * math.exp(-t / (tau * (1 + ratio))))
            rows += [f"t{k},{m},{x},{x},{1 + e + sd * math.sin(997 * k * k + x)!r},{sd}" for m, x in (("A", 0), ("B", 1))]
        self.write("data/positions.csv", "\n".join(rows) + "\n")
        tables = self.fit("--unknown", "young=uniform", "--known", "poisson=0", "--allow-unconverged")
        self.assert_near(number(tables.table("relaxation")["branch 1: relaxation time"][1][0], "s"), tau, 0.05)
        self.assertEqual(sorted(self.captions()), ["creep: motion of marker A", "creep: motion of marker B"])
        self.assertIn("creep: motion of marker A against the logarithm of time", self.dom)
        with open(self.folder / "material.fit/relaxation.csv") as table:
            last = [r for r in csv.DictReader(table) if float(r["time"]) == times[-1]]
        self.assertEqual({(r["history"], r["unit"]) for r in last}, {("creep", "m")})
        for r in last:  # the motion
            self.assert_near(float(r["measured"]), 1e-3, 0.005)
            self.assert_near(float(r["fitted"]), 1e-3, 0.005)


if __name__ == "__main__":
    unittest.main(verbosity=2)

#!/usr/bin/env python3
"""The report of `aspic fit`: its numbers are those of figures.json, agree with the verdict, and have units.

usage: ASPIC=path/to/aspic fit_report_test.py [TestCase...]
"""
import base64
import csv
import gzip
import json
import math
import re
import struct
import unittest

from command_line import CommandLine

BODY = """
[[body]]
name = "block"
shape = { box = { upper = [0.12, 0.12, 0.06], cells = [6, 6, 3] } }
material = { young = "%s", poisson = 0.4 }
[[body.pin]]
where = "Z < 1e-6"
"""


class FitReport(CommandLine):
    def capture(self, young="2e4", *options):
        self.write("truth.toml", BODY % young)
        pokes = () if "--pokes" in options else ("--pokes", "3", "--depths", "2", "--tip", "disc:0.016", "--depth", "0.06")
        self.aspic("capture", "truth.toml", "-o", "data", *pokes, "--markers", "60", "--noise", "0.02", "--force-noise",
                   "0.02", "-q", *options, timeout=200)

    def cases(self):
        with open(self.folder / "data/cases.csv", newline="") as file:
            return list(csv.DictReader(file))

    def fit(self, *arguments, code=0):
        self.aspic("fit", "data", "-q", "--force", *arguments, code=code, timeout=400)
        self.figures = json.loads((self.folder / "material.fit/figures.json").read_text())
        page = self.folder / "material.fit/report.html"
        if not page.exists():
            self.skipTest("built without the viewer")
        packed = re.search(r'id="fit">"([^"]*)"', page.read_text())[1]
        data = gzip.decompress(base64.b64decode(packed))
        self.head = json.loads(data[4:4 + struct.unpack("<I", data[:4])[0]])
        self.check_agreement()

    def check_agreement(self):
        """What must hold for every report."""
        figures = self.figures
        self.assertEqual(self.head["figures"], figures)
        verdict, held_out = figures["verdict"], figures["held_out"]
        for reason in verdict["reasons"]:
            self.assertTrue("value" in reason or reason["name"] in ("interrupted", "not_converged", "mesh_not_settled",
                                                                    "at_bound", "field_rejected"), reason)
            if "value" in reason and reason["name"] != "field_rejected":
                self.assertGreater(reason["value"], reason["limit"])
        self.assertEqual(verdict["good"], not verdict["reasons"])
        if held_out:
            limits, groups = held_out["limits"], held_out["groups"]
            factor = limits["single"] if sum(g["ok"] for g in groups) > 1 else 1
            for group in groups:
                for what in ("position", "force", "torque"):
                    error = group.get(what + "_beyond_noise")
                    if error is not None and error > factor * limits[what]:
                        self.assertTrue(group["poor"])
            is_poor = held_out["poor"] or any(g.get("poor") for g in groups)
            self.assertEqual(is_poor, "predicts_badly" in [r["name"] for r in verdict["reasons"]])
        if verdict["good"]:
            self.assertLessEqual(figures["squares"] / figures["residuals"], figures["limits"]["squares_per_reading"])
            for case in figures["cases"]:
                self.assertLessEqual(case["rms"] or 0, figures["limits"]["missed"])
        for case in figures["cases"]:
            load, response = case["load"], case["response"]
            self.assertTrue(load["unit"] and response["unit"])
            self.assertEqual(case["stiffness_unit"], {("m", "N"): "N/m", ("rad", "N m"): "N m/rad"}.get(
                (load["unit"], response["unit"]), ""))
        self.check_residuals()

    def check_residuals(self):
        """Residuals of the readings in the page, computed here."""
        counted = sum(c["readings"] for c in self.figures["cases"])
        self.assertEqual(counted, sum(self.figures["histogram"]["counts"]))
        left_out = any(c["left_out"] for c in self.figures["cases"])
        if not left_out:
            self.assertEqual(counted, self.figures["residuals"])
        squares = sum(c["readings"] * c["rms"] ** 2 for c in self.figures["cases"] if c["rms"] is not None)
        # The page shows readings without the common errors of mesh and law; the squares also count these.
        self.assertAlmostEqual(squares / self.figures["squares"], 1, delta=0.03)

    def test_good_fit(self):
        self.capture("5e3", "--pokes", "0", "--gravity", "0,0,-1", "--gravity", "1,0,0", "--gravity", "0,1,0")
        self.fit("--unknown", "young=uniform", "--known", "poisson=0.4")
        self.assertTrue(self.figures["verdict"]["good"])
        self.assertEqual(len(self.figures["held_out"]["groups"]), 3)
        self.assertEqual([m["model"] for m in self.figures["comparison"][0]["models"]], ["this fit (one value per parameter)"])
        for case in self.figures["cases"]:
            self.assertEqual((case["load"]["name"], case["response"]["name"]), ("gravity", "mean motion"))
            self.assertAlmostEqual(case["load"]["value"], 9.81, places=6)
            # The correction for the mesh changes the prediction, and the corrected one is near the reading.
            response = case["response"]
            self.assertGreater(abs(response["on_mesh"] / response["fitted"] - 1), 1e-3)
            self.assertLess(abs(response["fitted"] / response["measured"] - 1), 0.1)

    def test_contradicted_fit(self):
        self.capture()
        table = self.folder / "data/cases.csv"
        rows = self.cases()
        for row in rows:
            if row["group"] == rows[0]["group"]:
                row.update({f"force_{a}": repr(3 * float(row[f"force_{a}"])) for a in "xyz"})
        with open(table, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0].keys())
            writer.writeheader()
            writer.writerows(rows)
        self.fit("--unknown", "young=uniform", "--known", "poisson=0.4", code=3)
        reasons = {r["name"]: r for r in self.figures["verdict"]["reasons"]}
        self.assertTrue({"group_missed", "predicts_badly", "groups_disagree"} & set(reasons), reasons)
        self.assertEqual({(c["load"]["name"], c["response"]["name"], c["stiffness_unit"]) for c in self.figures["cases"]},
                         {("depth", "force", "N/m")})
        self.assertTrue(all(math.isfinite(r.get("value", 0)) for r in reasons.values()))

    def test_fields_are_compared_with_one_value(self):
        self.capture("Z < 0.03 ? 4e4 : 1e4", "--regions")
        self.write("data/aspic.fit.toml", "mesh_errors = false\n")
        self.fit("--unknown", "young=regions", "--known", "poisson=0.4", "--allow-unconverged")
        models = {m["model"]: m for m in self.figures["comparison"][0]["models"]}
        self.assertEqual(list(models), ["this fit", "one value per parameter"])

    def test_left_out_groups_are_predicted(self):
        self.capture()
        name = self.cases()[0]["group"]
        self.write("data/aspic.fit.toml", f'mesh_errors = false\ncross_validation = false\nleave_out = ["{name}"]\n')
        self.fit("--unknown", "young=uniform", "--known", "poisson=0.4", "--allow-unconverged")
        self.assertEqual([g["group"] for g in self.figures["held_out"]["groups"]], [name])
        self.assertTrue(self.figures["left_out"]["fit"]["ok"])
        self.assertEqual(self.figures["comparison"], [])


if __name__ == "__main__":
    unittest.main(verbosity=2)

#!/usr/bin/env python3
"""From measurements to a material on the command line: capture, fit, bad data, material files, curves."""
import csv
import filecmp
import os
import subprocess
import unittest

from command_line import ASPIC, BENCH, CUBE, CommandLine, HOLDS_MATERIAL, box_mesh


class Captured(CommandLine):
    """A cube of 5^3 cells with indentations at three sites."""

    def capture(self, out="data", *options, code=0):
        self.write("cube.toml", CUBE)
        return self.aspic("capture", "cube.toml", "-o", out, *BENCH, *options, code=code)

    def change(self, name, old, new, count=1):
        text = (self.folder / name).read_text()
        self.assertIn(old, text)
        self.write(name, text.replace(old, new, count))

    def change_cells(self, table, columns, of):
        """Replaces the values in these columns of data/table.csv by of(value)."""
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

    def test_scene_becomes_a_faultless_data_set(self):
        self.assertIn("6 cases, 20 markers", self.capture().stdout)
        text = self.aspic("check", "data").stdout
        self.assertIn("6 cases in 3 groups", text)
        self.assertIn("64 vertices, 162 tets, 16 vertices fixed", text)
        self.change("data/capture.toml", "order = 1\n", "")
        self.assertIn("64 vertices, 162 quadratic tets, 16 vertices fixed", self.aspic("check", "data").stdout)
        self.assertNotIn("error:", text)

    def test_writes_to_out_and_keeps_earlier_results(self):
        self.write("cube.toml", CUBE)
        self.assertIn("1 of 3: poke 1, depth 1: ", self.aspic("capture", "cube.toml", "--pokes", "1").stdout)
        self.assertTrue((self.folder / "out/cube_data/capture.toml").exists())
        self.assertIn("--force", self.aspic("capture", "cube.toml", "--pokes", "1", code=2).stderr)

    def test_seed_determines_all_bits(self):
        self.capture("one", "--threads", "1")
        self.capture("two", "--threads", "2")
        self.capture("other", "--seed", "2")
        self.assert_same_files("one", "two", *self.TABLES)
        self.assertFalse(filecmp.cmp(self.folder / "one/positions.csv", self.folder / "other/positions.csv", False))

    def test_check_explains_missing_forces(self):
        self.capture("data", "--no-force")
        with open(self.folder / "data/cases.csv", newline="") as file:
            self.assertEqual({row["force_x"] for row in csv.DictReader(file)}, {""})
        self.assertIn("only ratios of stiffness", self.aspic("check", "data").stdout)

    def test_accepts_torques_gravity_and_own_mesh(self):
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

    def test_bad_options_name_the_remedy(self):
        self.write("cube.toml", CUBE)
        for arguments, message in ((("--tip", "cone"), "sphere or disc"), (("--tip", "sphere:1e9"), "smaller one (--tip)"),
                                   (("--tip", "sphere:nan"), "must be > 0"), (("--gravity", "0,0,0"), "a direction"),
                                   (("--gravity", "1,2"), "three numbers"), (("--depth", "nan"), "not a finite number"),
                                   (("--pokes", "-1"), "0 to 1000"), (("--pokes", "0"), "nothing is measured"),
                                   (("--markers", "2000000000"), "0 to 100000"), (("--noise", "inf"), "not a finite number"),
                                   (("--threads", "0"), "--threads"), (("--mesh", "none.msh"), "none.msh")):
            self.assertIn(message, self.aspic("capture", "cube.toml", *arguments, code=2).stderr)


class Fit(Captured):
    QUICK = ("--options", "quick.toml", "--known", "poisson=0.4")
    QUICK_OPTIONS = "mesh_errors = false\nuncertainty = false\ncross_validation = false\n"

    def setUp(self):
        super().setUp()
        self.capture()
        self.write("quick.toml", self.QUICK_OPTIONS)

    def test_captured_and_fitted_scene_runs(self):
        # The mesh of the data is coarse and linear, and a part of the body is far from all sites: the verdict is bad.
        done = self.aspic("fit", "data", "--allow-unconverged")
        for part in ("converged", "misfit", "95 %", "held out", 'material = { file = "material.vtu" }'):
            self.assertIn(part, done.stdout)
        self.assertNotRegex(done.stdout, r"\bnan\b|\binf\b")
        self.assertFalse({".journal", ".state"} & {p.suffix for p in (self.folder / "material.fit").iterdir()})
        self.assertIn("--force", self.aspic("fit", "data", code=2).stderr)
        self.assertIn("complete", self.aspic("fit", "data", "--resume", code=2).stderr)
        self.write("use.toml", HOLDS_MATERIAL)
        self.assertIn("2 of 2", self.aspic("run", "use.toml").stdout)

    @unittest.skipUnless(os.path.exists("/dev/full"), "needs a device that is always full")
    def test_unwritable_folder_is_reported(self):
        self.assertIn("/proc", self.aspic("fit", "data", *self.QUICK, "-o", "/proc/none/material.vtu", code=2).stderr)
        with open("/dev/full", "w") as full:
            done = subprocess.run([ASPIC, "fit", "data", *self.QUICK], cwd=self.folder, stdout=full,
                                  stderr=subprocess.PIPE, text=True, timeout=60)
        self.assertEqual(done.returncode, 2)
        self.assertIn("standard output: cannot be written", done.stderr)


class BadData(Captured):
    """Check and fit report each fault with its file, its row and a remedy."""

    def setUp(self):
        super().setUp()
        self.capture()

    def refused(self, *messages):
        for command in (("check", "data"), ("fit", "data")):
            done = self.aspic(*command, code=2, timeout=20)
            for message in messages:
                self.assertIn(message, done.stdout + done.stderr)

    def test_rejects_readings_that_are_not_numbers(self):
        self.change_cells("positions", ["x"], lambda x: "nan")
        self.refused("positions.csv:2: x = 'nan'", "leave the cell blank")

    def test_finds_lengths_in_millimeters(self):
        self.change_cells("positions", ["x", "y", "z"], lambda x: str(1e3 * float(x)))
        self.refused("positions.csv: markers move", 'units = { length = "mm" }')

    def test_finds_forces_in_grams(self):
        self.change_cells("cases", ["force_x", "force_y", "force_z"], lambda f: str(round(1e4 * float(f) / 9.8)))
        text = self.aspic("check", "data").stdout
        self.assertIn("cases.csv", text)
        self.assertIn('units = { force = "g" }', text)

    def test_finds_forces_that_are_all_zero(self):
        self.change_cells("cases", ["force_x", "force_y", "force_z"], lambda f: "0")
        self.refused("cases.csv: all forces are 0", "leave them blank")

    def test_rejects_zero_standard_deviations(self):
        self.change_cells("positions", ["sd_y"], lambda sd: "0")
        self.refused("positions.csv:2: sd_y = 0", "leave the cell blank")

    def test_rejects_duplicate_names(self):
        self.change_cells("cases", ["case"], lambda name: "poke 1, depth 1")
        self.refused("cases.csv:3: the case 'poke 1, depth 1' already occurs in line 2")

    def test_rejects_axes_that_point_outward(self):
        self.change_cells("cases", ["axis_x", "axis_y", "axis_z"], lambda a: str(-float(a)))
        self.refused("cases.csv:2 (poke 1, depth 1): the axis of the indenter points out of the body", "change their signs")

    def test_finds_tips_without_contact(self):
        self.change_cells("cases", ["touch_x", "center_x"], lambda x: str(float(x) + 0.2))
        self.refused("cases.csv:2 (poke 1, depth 1): ", "touch")

    def test_rejects_empty_and_torn_tables(self):
        for content, message in ((b"", "is empty"), (b"case,marker,x,y,z\n\"poke 1", "positions.csv:2: has 1 cells"),
                                 (os.urandom(2000) + b"\n", "positions.csv:1"), (b"x" * 3_000_000, "too long")):
            (self.folder / "data/positions.csv").write_bytes(content)
            self.refused(message)

    def test_rejects_hostile_settings(self):
        for content, message in ((b"", "version"), (b"a = " + b"[" * 100_000, "depth"),
                                 (b"[" + b"a." * 100_000 + b"a]", "more than 32 parts"), (os.urandom(500), "capture.toml"),
                                 (b'version = 1\nmesh = "/dev/zero"\n', "outside")):
            (self.folder / "data/capture.toml").write_bytes(content)
            self.refused(message)

    def test_reports_data_that_no_material_explains(self):
        self.change_cells("positions", ["z"], lambda z: str(float(z) + 0.02))
        self.write("quick.toml", Fit.QUICK_OPTIONS)
        done = self.aspic("fit", "data", *Fit.QUICK, "--unknown", "young=uniform", code=3)
        self.assertIn("not reliable (unexplained)", done.stderr)
        self.assertRegex(done.stdout + done.stderr, r"warning: cases\.csv:\d \('poke \d, depth \d'\) has the worst fit: .* \d+ standard")


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

    def test_another_mesh_gets_values_with_a_message(self):
        self.assertIn("are not the 1 of material.vtu", self.run_with(young="1e4", poisson="0.4").stdout)

    def test_moved_body_gets_values_at_rest_positions(self):
        self.run_with("translate = [3, 0, 0]\n", young="1e4", poisson="0.4")

    def test_missing_and_invalid_values_are_named(self):
        self.assertIn("young", self.run_with(poisson="0.4", code=2).stderr)
        self.assertIn("material.vtu", self.run_with(young="nan", poisson="0.4", code=2).stderr)
        self.assertIn("material.vtu", self.run_with(young="-1", poisson="0.4", code=2).stderr)
        self.write("use.toml", HOLDS_MATERIAL.replace("material.vtu", "none.vtu"))
        self.assertIn("none.vtu", self.aspic("run", "use.toml", code=2).stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)

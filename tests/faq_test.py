#!/usr/bin/env python3
"""Every symptom of docs/faq.md appears on a case that has its cause, and disappears with the remedy of the page."""
import pathlib
import re
import unittest

from command_line import MESHER, CommandLine, box_mesh

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = re.sub(r"\s+", " ", (ROOT / "docs/faq.md").read_text())
CUBE = """time = { duration = 0.3 }
output = { vtu = false, report = false }
[[body]]
name = "cube"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [3, 3, 3] } }
translate = [0, 0.05, 0]
material = { young = 1e5 }
"""


class Faq(CommandLine):
    def output(self, *arguments, code=0):
        done = self.aspic(*arguments, code=code)
        return done.stdout + done.stderr

    def assert_cured(self, symptom, sick, cured):
        """The page quotes the symptom; `sick` prints it, `cured` does not."""
        self.assertIn(symptom, PAGE)
        self.assertIn(symptom, sick)
        self.assertNotIn(symptom, cured)

    def run_scene(self, scene, *values, code=0):
        return re.sub(r"\s+", " ", self.output("run", scene, "--force", "--out", "run", "--set", "output.report=false", *values, code=code))

    def test_explosion_ends_with_backward_euler(self):
        beam = str(ROOT / "scenes/cantilever.toml")
        sick = self.run_scene(beam, "time.duration=0.1", "time.integrator=symplectic_euler", code=3)
        cured = self.run_scene(beam, "time.duration=0.1", "time.integrator=backward_euler")
        self.assert_cured("warning: step 2 did not converge: undefined", sick, cured)
        self.assert_cured("the explicit scheme symplectic_euler blew up", sick, cured)

    def test_quadratic_tets_bend_more(self):
        statics = str(ROOT / "scenes/cantilever.toml"), "time.integrator=quasi_static", "time.duration=0.01"
        sick, sag = self.run_scene(*statics), {}
        for order in 1, 2:
            cured = self.run_scene(*statics, f"body.beam.order={order}")
            sag[order] = -float(self.steps("run")[-1]["potential_gravity"])
        self.assert_cured("makes 'beam' about 59 % too stiff", sick, cured)
        self.assertGreater(sag[2], 1.3 * sag[1])

    def test_a_floor_stops_the_fall(self):
        def contact_force(scene):
            self.run_scene(self.write("fall.toml", scene))
            return float(self.steps("run")[-1].get("load_contact_y", 0))
        floor = re.search(r"\[\[obstacle\]\] plane = \{\}", PAGE)[0].replace("]] ", "]]\n")
        self.assertEqual(contact_force(CUBE), 0)
        self.assertGreater(contact_force(CUBE + floor), 1)

    def test_contact_stops_cloth(self):
        self.write("cloth.toml", CUBE + '[[body]]\nname = "cloth"\nshape = { rectangle = { width = 0.2, height = 0.2, size = 0.1 } }\nshell = { thickness = 1e-3 }\n'
                   "translate = [0, 0, 0.3]\nmaterial = { young = 1e5 }\n")
        self.assert_cured("contact is off", self.output("check", "cloth.toml"),
                          self.output("check", "cloth.toml", "--set", "contact={}"))

    def test_a_stiffer_body_is_not_crushed(self):
        self.write("cube.toml", CUBE + '[[body.pin]]\nwhere = "Y < 0.051"\n')
        self.assert_cured("its weight crushes it", self.output("check", "cube.toml", "--set", "material.young=100"),
                          self.output("check", "cube.toml", "--set", "material.young=1e5"))

    def test_a_looser_tolerance_saves_iterations(self):
        count = []
        for tolerance in "1e-6", "1e-3":
            summary = self.run_scene(str(ROOT / "scenes/contact.toml"), "time.duration=0.2", f"solver.tolerance={tolerance}")
            count.append(float(re.search(r"iterations per step: mean ([\d.]+)", summary)[1]))
        self.assertLess(count[1], 0.8 * count[0])

    def test_failed_steps_converge_with_the_remedies(self):
        self.beam()
        symptom = "warning: step 1 did not converge"
        cured = self.run_scene("beam.toml", "solver.method=newton")
        for value in "solver.max_iterations=1", "solver.method=gradient_descent":
            sick = self.run_scene("beam.toml", value, code=3)
            self.assert_cured(symptom, sick, cured)
            self.assertIn("iteration_limit", sick)
        self.assertIn("remedy: solver.max_iterations = 200", self.run_scene("beam.toml", "solver.max_iterations=1", code=3))
        hard = str(ROOT / "scenes/lecture/53_hard_step.toml"), 'solver.line_search={ test = "none" }'
        self.assert_cured(symptom, self.run_scene(*hard, code=3), self.run_scene(hard[0], 'solver.line_search={ test = "textbook" }'))

    def test_millimeters_are_noticed(self):
        self.write("mm.toml", CUBE.replace("[0.1, 0.1, 0.1]", "[100, 100, 100]"))
        self.assert_cured("if the file is in millimeters", self.output("check", "mm.toml"),
                          self.output("check", "mm.toml", "--set", "body.cube.scale=0.001"))

    def test_inverted_tets_are_repaired(self):
        self.write("bad.mesh", box_mesh(flip=3))
        sick = self.output("run", "bad.mesh", code=2)
        self.output("check", "bad.mesh", "--repair", "-o", "good.mesh")
        self.assert_cured("tets are inverted", sick, self.output("run", "good.mesh", "--steps", "1"))

    @unittest.skipUnless(MESHER.exists(), "needs aspic-mesh")
    def test_open_surfaces_are_closed(self):
        self.write("box.mesh", box_mesh(cells=8))
        self.output("convert", "box.mesh", "box.obj", "--surface")
        lines = (self.folder / "box.obj").read_text().splitlines()
        faces = [i for i, line in enumerate(lines) if line.startswith("f ")]
        self.write("open.obj", "\n".join(line for i, line in enumerate(lines) if i != faces[0]) + "\n")
        sick = self.output("mesh", "open.obj", "-o", "tets.mesh", code=2)
        for option in "--fill-holes", "--rebuild":
            self.assert_cured("the surface is open", sick, self.output("mesh", "open.obj", option, "-o", "tets.mesh"))
        self.write("sheet.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.assert_cured("it encloses no volume", self.output("mesh", "sheet.obj", "-o", "tets.mesh", code=2),
                          self.run_scene(self.write("sheet.toml", 'time = { duration = 0.01 }\n[[body]]\nmesh = "sheet.obj"\n'
                                                    "shell = { thickness = 1e-3 }\nmaterial = { young = 1e6 }\n")))


if __name__ == "__main__":
    unittest.main()

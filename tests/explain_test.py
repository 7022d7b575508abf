#!/usr/bin/env python3
"""Provoked failures: the message names the cause and one change, and that change works.

usage: ASPIC=path/to/aspic explain_test.py [TestCase...]
"""
import os
import re
import unittest

from command_line import CommandLine, box_mesh

BODY = """[time]
step = {step}
duration = {duration}
integrator = "{integrator}"
[output]
vtu = false
pc2 = false
usd = false
report = false
{solver}
[[body]]
name = "beam"
shape = {{ box = {{ upper = [0.4, 0.1, 0.1], cells = [4, 1, 1] }} }}
material = {{ model = "{model}", young = {young}, poisson = {poisson}, density = {density} }}
{body}
[[body.pin]]
name = "wall"
where = "x < 1e-9"
{pins}
"""
USUAL = {"step": 0.01, "duration": 0.03, "integrator": "backward_euler", "model": "neo_hookean", "young": "1e5",
         "poisson": "0.3", "density": "1000", "solver": "", "body": "", "pins": ""}
CHANGE = r"((?:time|solver|material|body)[\w.]*) = (\"[^\"]*\"|[-+.\w]+)"


class Explanations(CommandLine):
    def scene(self, name="scene.toml", **parts):
        return self.write(name, BODY.format(**{**USUAL, **parts}))

    def run_scene(self, *options, code=0):
        done = self.aspic("run", "scene.toml", "--force", *options, code=code)
        return done.stdout + done.stderr

    def assert_cured(self, text, *said, change=None):
        """Checks that the text contains the words, and that the proposed change makes every step converge."""
        for words in said:
            self.assertIn(words, text)
        remedy = text[text.index("remedy:"):] if "remedy:" in text else text
        found = re.search(CHANGE, remedy) or re.search(CHANGE, text)
        self.assertTrue(found, f"no change in: {text}")
        proposed = f"{found[1]}={found[2]}"
        if change:
            self.assertTrue(proposed.startswith(change), f"{proposed}, not {change}\n{text}")
        return self.run_scene("--set", proposed)


class Explain(Explanations):
    def test_inverted_initial_state(self):
        self.scene(model="neo_hookean_log", body="deform = { matrix = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]] }", pins="")
        self.assert_cured(self.run_scene(code=2), "infinite energy", "tets are inverted", change="material.model=")

    def test_explicit_step_too_long(self):
        self.scene(integrator="symplectic_euler", step=0.02, duration=0.4, young="1e6")
        text = self.run_scene(code=3)
        for words in ("blew up", "0.02 s", "vibrates fastest", "Hz"):
            self.assertIn(words, text)
        found = re.search(r"time\.step = ([\d.e-]+)", text)
        self.run_scene("--set", f"time.step={found[1]}", "--set", f"time.duration={400 * float(found[1])}")
        self.run_scene("--set", "time.integrator=" + re.search(r'time.integrator = ("\w+")', text)[1])

    def test_forward_euler_step_too_long(self):
        self.scene(integrator="forward_euler", step=0.02, duration=2, young="1e6")
        self.assert_cured(self.run_scene(code=3), "blew up", "vibrates fastest", change="time.integrator=")

    def test_explicit_step_too_long_for_damping(self):
        for integrator, damping in (("symplectic_euler", "stiffness = 0.05"), ("rk4", "viscosity = 5000")):
            self.scene(integrator=integrator, step=0.0005, duration=0.3, body=f"damping = {{ {damping} }}")
            self.assert_cured(self.run_scene(code=3), "longer than", "strongest damping", change="time.step=")

    def test_poissons_ratio_too_close_to_one_half(self):
        self.scene(poisson="0.5")
        text = self.run_scene(code=2)
        self.assertIn("poisson = 0.5; must be > -1 and < 0.5", text)
        self.run_scene("--set", "material.poisson=" + re.search(r"\(try ([\d.]+)\)", text)[1])
        self.scene(poisson="0.4999")
        text = self.run_scene()
        self.assertIn("linear tets lock", text)
        self.assertNotIn("tets lock", self.assert_cured(text, "0.4999", change="material.poisson="))

    def test_a_modulus_in_kilopascals(self):
        self.scene(young="100")
        for text in (self.run_scene(), self.aspic("check", "scene.toml").stdout):
            self.assertIn("its weight crushes it", text)
            self.assertNotIn("crushes", self.assert_cured(text, "kPa", change="material.young=1e+05"))

    def test_a_modulus_in_gigapascals(self):
        self.scene(young="1e14")
        text = self.run_scene()
        self.assertNotIn("diamond", self.assert_cured(text, "stiffer than diamond", "Hz", change="material.young=1e+05"))

    def test_pins_that_contradict_each_other(self):
        self.scene(pins='[[body.pin]]\nname = "tip"\nwhere = "x < 0.15"\nmotion = { linear = { velocity = [1, 0, 0] } }')
        text = self.run_scene(code=2)
        for words in ("'wall'", "'tip'", "scene.toml:"):
            self.assertIn(words, text)
        where = re.search(r'where = "([^"]+)"', text[text.index("try"):])[1]
        self.run_scene("--set", f'body.beam.pin.1.where="{where}"')

    def test_a_pin_within_another(self):
        self.scene(pins='[[body.pin]]\nname = "edge"\nwhere = "x < 1e-10"\nmotion = { linear = { velocity = [1, 0, 0] } }')
        text = self.run_scene(code=2)
        self.assertIn("remove pin 'edge'", text)
        self.scene()
        self.run_scene()

    def test_finds_lengths_in_millimeters(self):
        scene = BODY.format(**USUAL).replace("[0.4, 0.1, 0.1]", "[400, 100, 100]")
        self.write("scene.toml", scene)
        self.assertNotIn("crushes", self.assert_cured(self.run_scene(), "400 m are millimeters", change="body.beam.scale="))

    def test_pins_that_flatten_an_element(self):
        # One cell, all of whose vertices are pinned: no step is short enough.
        self.scene(model="neo_hookean_log", pins='[[body.pin]]\nname = "press"\nwhere = "x > 1e-9"\n'
                   'motion = { keyframes = [{ time = 0, displacement = [0, 0, 0] }, { time = 0.02, displacement = [-0.21, 0, 0] }] }')
        self.assert_cured(self.run_scene(code=3), "pins themselves", "corners are all pinned", change="material.model=")
        for integrator in ("midpoint", "symplectic_euler", "rk4"):
            text = self.run_scene("--set", f"time.integrator={integrator}", "--set", "time.step=0.001", code=3)
            self.assertIn("pins themselves", text)

    def test_element_without_volume(self):
        mesh = box_mesh().replace("\n1 1 1 0\n", "\n0.5 0.5 0.5 0\n")
        self.write("flat.mesh", mesh)
        text = self.aspic("run", "flat.mesh", code=2).stderr
        self.assertRegex(text, r"zero|volume|flat")
        self.assertIn("--repair", text)
        self.aspic("check", "flat.mesh", "--repair", "-o", "mended.mesh", code=0)
        self.aspic("run", "mended.mesh", "--steps", "2")

    def test_no_mass(self):
        self.scene(density="0")
        text = self.run_scene(code=2)
        self.assertIn("density = 0; must be > 0", text)
        self.run_scene("--set", "material.density=" + re.search(r"\(try ([\d.]+)\)", text)[1])
        self.scene(density='"x < 0.2 ? 0 : 1000"')
        self.assertIn("density = 0 in tet", self.run_scene(code=2))

    def test_a_vertex_without_mass(self):
        lines = box_mesh().split("\n")
        at = lines.index("Vertices") + 1
        lines[at] = str(int(lines[at]) + 1)
        lines.insert(at + 1 + int(lines[at]) - 1, "5 5 5 0")
        self.write("stray.mesh", "\n".join(lines))
        text = self.aspic("run", "stray.mesh", "--steps", "1", code=2).stderr
        self.assertIn("--repair", text)
        self.aspic("check", "stray.mesh", "--repair", "-o", "mended.mesh")
        self.aspic("run", "mended.mesh", "--steps", "1")

    def test_an_indefinite_hessian(self):
        self.scene(integrator="quasi_static", young="2e3", solver='[solver]\ndefiniteness = "exact"')
        self.assert_cured(self.run_scene(code=3), "negative curvature", change="solver.definiteness=")

    def test_a_tolerance_below_round_off(self):
        self.scene(solver="[solver]\ntolerance = 1e-17")
        self.assertIn("round_off", self.run_scene())  # converged to round-off, which the status reports
        self.scene(solver='[solver]\ntolerance = 1e-17\nmethod = "lbfgs"\npreconditioner = "mass"')
        self.assert_cured(self.run_scene(code=3), "round-off alone is", change="solver.tolerance=")
        self.scene(solver='[solver]\ntolerance = 1e-17\nmethod = "gradient_descent"')
        self.assert_cured(self.run_scene(code=3), "without the Hessian", change="solver.method=")

    def test_an_adaptive_tolerance_below_round_off(self):
        for integrator in ("backward_euler", "midpoint"):
            self.scene(integrator=integrator)
            text = self.run_scene("--set", "time.adaptive.tolerance=1e-15", code=3)
            self.assertIn("16 digits", text)
            found = re.search(CHANGE, text[text.index("remedy:"):])
            self.run_scene("--set", f"{found[1]}={found[2]}")

    def test_field_value_that_is_not_a_number(self):
        self.write("rho.csv", "1000\n" * 11 + "nan\n" + "1000\n" * 12)
        self.scene(density='{ file = "rho.csv" }')
        text = self.run_scene(code=2)
        for words in ("rho.csv:12", "nan"):
            self.assertIn(words, text)
        self.write("rho.csv", "1000\n" * 24)
        self.run_scene()
        self.scene(young='"1e5 / (x - x)"')
        self.assertIn("is inf at (", self.run_scene(code=2))
        self.write("bad.mesh", box_mesh().replace("\n1 1 1 0\n", "\nnan 1 1 0\n"))
        text = self.aspic("run", "bad.mesh", code=2).stderr
        self.assertIn("bad.mesh:", text)
        self.assertIn("nan", text)


if __name__ == "__main__":
    unittest.main()

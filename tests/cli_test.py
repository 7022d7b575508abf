#!/usr/bin/env python3
"""The command line: help, checks, meshes.

usage: ASPIC=path/to/aspic cli_test.py [TestCase...]
"""
import json
import re
import shutil
import subprocess
import unittest

from command_line import CUBE_OBJ, CommandLine, HAS_FIT, MESHER, box_mesh


class Help(CommandLine):
    def test_every_level_has_examples(self):
        for arguments in ([], ["run"], ["check"], ["convert"], ["materials"], ["minimize"], ["verify"], ["modes"], ["schema"],
                          ["sweep"], ["completion"], *([["capture"], ["fit"]] if HAS_FIT else [])):
            text = self.aspic(*arguments, "--help").stdout
            self.assertIn("Examples:", text)
            self.assertIn(" ".join(["  aspic", *arguments]), text)

    def test_version_states_the_build(self):
        text = self.aspic("--version").stdout
        for fact in ("aspic ", "compiler", "flags", "SIMD", "libraries"):
            self.assertIn(fact, text)

    def test_misspelled_command_is_corrected(self):
        self.assertEqual(self.aspic("help", "run").stdout, self.aspic("run", "--help").stdout)
        self.assertEqual(self.aspic("help").stdout, self.aspic("--help").stdout)
        self.assertIn("did you mean 'check'", self.aspic("chek", "x.mesh", code=2).stderr)

    def test_misspelled_option_is_corrected(self):
        self.assertIn("did you mean '--threads'", self.aspic("run", "x.toml", "--thread", "2", code=2).stderr)

    def test_file_without_command_suggests_run(self):
        self.write("box.mesh", box_mesh())
        self.assertIn("aspic run box.mesh", self.aspic("box.mesh", code=2).stderr)

    def test_no_arguments_show_the_help(self):
        self.assertIn("Examples:", self.aspic(code=2).stdout)


class Completion(CommandLine):
    def test_scripts_list_every_option(self):
        script = self.aspic("completion", "bash").stdout
        page = self.aspic("completion", "man").stdout.replace("\\-", "-")
        for command in re.findall(r"(?m)^    ([a-z-]+)\)", script):
            if command.startswith(("fit", "capture", "closed")) and not HAS_FIT:
                continue
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
    def test_man_page_is_well_formed(self):
        done = subprocess.run(["groff", "-man", "-Tascii", "-ww", "-z"], input=self.aspic("completion", "man").stdout,
                              capture_output=True, text=True)
        self.assertEqual(done.stderr, "")

    @unittest.skipUnless(shutil.which("zsh") or shutil.which("fish"), "needs zsh or fish")
    def test_other_shells_read_their_scripts(self):
        for shell in filter(shutil.which, ("zsh", "fish")):
            script = self.write("script", self.aspic("completion", shell).stdout)
            self.assertEqual(subprocess.run([shell, "-n", script], cwd=self.folder).returncode, 0)


class Materials(CommandLine):
    def test_each_material_has_a_formula(self):
        text = self.aspic("materials").stdout
        for name in ("neo_hookean", "neo_hookean_log", "stvk", "corotated"):
            self.assertRegex(text, rf"(?m)^{name}\n  psi = ")

    def test_json(self):
        listed = json.loads(self.aspic("materials", "--json").stdout)
        self.assertTrue(all(m["name"] and m["formula"] and r"\psi =" in m["tex"][0] for m in listed))

    def test_misspelled_name_is_corrected(self):
        self.assertIn("did you mean 'neo_hookean'", self.aspic("materials", "neo_hokean", code=2).stderr)


class Derivatives(CommandLine):
    def test_derivatives_of_a_scene_are_correct(self):
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

    def test_inaccurate_derivatives_have_their_own_exit_code(self):
        text = self.aspic("check", self.beam(), "--derivatives", "--tolerance", "1e-13", code=3).stdout
        self.assertRegex(text, r"(?m)^elasticity +deformed .* WRONG$")
        self.assertRegex(text, r"the gradient of elasticity \(deformed\) differs most at vertex \d+, [xyz] \(tet \d+\)")

    def test_vertices_and_tets_have_file_numbers(self):
        self.write("box.mesh", box_mesh())
        tets = [set(map(int, line.split()[:4])) for line in box_mesh().split("Tetrahedra\n48\n")[1].splitlines()[:48]]
        lines = self.aspic("check", "box.mesh", "--derivatives", "--tolerance", "1e-30", "--json", code=3).stdout
        named = re.findall(r'"vertex (\d+), [xyz](?:; vertex (\d+), [xyz])? \(tet (\d+)\)"', lines)
        self.assertGreater(len(named), 5)
        for vertex, other, tet in named:
            self.assertIn(int(vertex) + 1, tets[int(tet)])
            self.assertIn(int(other or vertex) + 1, tets[int(tet)])

    def test_rejects_contradicting_options(self):
        self.assertIn("--derivatives", self.aspic("check", self.beam(), "--json", code=2).stderr)


class Check(CommandLine):
    def test_a_good_mesh_passes_with_its_quality(self):
        self.write("box.mesh", box_mesh())
        text = self.aspic("check", "box.mesh").stdout
        self.assertIn("27 vertices, 48 tets", text)
        self.assertIn("mean ratio", text)

    def test_inverted_tet_is_named_by_index(self):
        self.write("bad.mesh", box_mesh(flip=5))
        text = self.aspic("check", "bad.mesh", code=2).stdout
        self.assertRegex(text, r"error: inverted_tets: .*\n  indices: 5\n")

    def test_repair_fixes_an_inverted_tet(self):
        self.write("bad.mesh", box_mesh(flip=5))
        self.aspic("check", "bad.mesh", "--repair", "-o", "good.mesh")
        self.aspic("check", "good.mesh")

    def test_surfaces_and_regions_are_listed_with_their_names(self):
        self.write("named.msh", """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "outlet"
3 3 "inside"
$EndPhysicalNames
$Nodes
4
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
$EndNodes
$Elements
2
1 2 2 1 1 1 3 2
2 4 2 3 1 1 2 3 4
$EndElements
""")
        text = self.aspic("check", "named.msh").stdout
        self.assertIn('region 3 "inside": 1 tets\n', text)
        self.assertIn('surface 1 "outlet": 1 triangles\n', text)

    def test_an_open_surface_is_an_error(self):
        self.write("open.obj", CUBE_OBJ.rsplit("f ", 1)[0])
        self.assertIn("open", self.aspic("check", "open.obj", code=2).stdout)

    def test_scene_passes(self):
        self.assertIn("beam", self.aspic("check", self.beam()).stdout)

    def test_scene_messages_use_numbers_of_its_file(self):
        flat = box_mesh().split("\n")
        flat[4 + 13] = "0.5 0.5 0.9999 0"  # the center: the tets above it become slivers
        self.write("flat.mesh", "\n".join(flat))
        self.write("flat.toml", '[[body]]\nmesh = "flat.mesh"\n')
        of_mesh, of_scene = (self.aspic("check", name).stdout for name in ("flat.mesh", "flat.toml"))
        found = re.findall(r"(?m)^  indices: .*$", of_mesh)
        self.assertTrue(found)
        self.assertEqual(re.findall(r"(?m)^  indices: .*$", of_scene), found)

    def test_missing_and_broken_files_are_rejected(self):
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

    def test_surface_formats_get_the_boundary(self):
        self.write("box.mesh", box_mesh())
        self.assertIn("boundary", self.aspic("convert", "box.mesh", "box.obj").stdout)
        self.assertIn("26 vertices, 48 triangles", self.aspic("check", "box.obj").stdout)
        self.aspic("convert", "box.obj", "box.glb")
        self.assertIn("26 vertices, 48 triangles", self.aspic("check", "box.glb").stdout)
        self.assertIn("name the file .glb", self.aspic("convert", "box.obj", "box.gltf", code=2).stderr)

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


if __name__ == "__main__":
    unittest.main(verbosity=2)

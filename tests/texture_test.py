#!/usr/bin/env python3
"""Texture coordinates of surfaces in the results, read by parsers written from the descriptions of the formats."""
import base64
import json
import re
import struct
import unittest

from command_line import MESHER, CommandLine

# A cube of quads. Each face has its own part of the picture, so all edges are seams.
CUBE = "".join(f"v {i & 1}e-1 {i >> 1 & 1}e-1 {i >> 2}e-1\n" for i in range(8)) + "".join(
    f"vt {.15 * f + .1 * (c in (1, 2)):.3f} {.125 * (c > 1) + .25:.3f}\n" for f in range(6) for c in range(4)) + "".join(
    "f " + " ".join(f"{v + 1}/{4 * f + c + 1}" for c, v in enumerate(face)) + "\n"
    for f, face in enumerate([(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]))
FLAG = "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt .5 1\nvt -2 3.25\nf 1/1 2/2 3/3\nf 1/1 3/4 4/2\n"
SCENE = """[time]
step = 0.01
duration = 0.03
[output]
obj = true
[[body]]
name = "block"
shape = { box = { upper = [0.1, 0.1, 0.1], cells = [2, 2, 2] } }
skin = "cube.obj"
material = { young = 1e4, poisson = 0.4 }
[[body.pin]]
where = "Y > 0.09"
[[body]]
name = "flag"
mesh = "FLAG"
shell = { thickness = 0.001 }
material = { young = 1e6, poisson = 0.3, density = 300 }
[[body.pin]]
where = "X < 1.1"
[[body]]
name = "plain"
shape = { box = { lower = [0.2, 0, 0], upper = [0.3, 0.1, 0.1], cells = [1, 1, 1] } }
material = { young = 1e4, poisson = 0.4 }
"""


def obj_corners(text):
    """Position and texture coordinates of the corners of all triangles; polygons are fans."""
    rows = [line.split() for line in text.splitlines()]
    points, uv = ([tuple(map(float, row[1:])) for row in rows if row and row[0] == key] for key in ("v", "vt"))
    corners = []
    for row in rows:
        if row and row[0] == "f":
            face = [tuple(int(i) - 1 for i in word.split("/")) for word in row[1:]]
            for k in range(2, len(face)):
                corners += [(points[v], uv[t]) for v, t in (face[0], face[k - 1], face[k])]
    return corners


def tuples(text):
    return [tuple(map(float, item.split(","))) for item in re.findall(r"\(([^()]*)\)", text)]


def usd_mesh(text, name):
    """Texture coordinates of the corners, and the points of the corners in each sample."""
    block = re.search(rf'def Mesh "{name}"\n    {{\n(.*?)\n    }}\n', text, re.S)[1]
    indices = json.loads(re.search(r"faceVertexIndices = (.*)", block)[1])
    uv = re.search(r'texCoord2f\[\] primvars:st = (.*) \(\n            interpolation = "faceVarying"\n        \)\n', block)
    samples = re.search(r"points\.timeSamples = {(.*?)}", block, re.S)[1].strip().splitlines()
    points = [tuples(line) for line in samples]
    return tuples(uv[1]) if uv else None, [[frame[i] for i in indices] for frame in points]


class Glb:
    def __init__(self, data):
        size = struct.unpack_from("<I", data, 12)[0]
        self.head, self.binary = json.loads(data[20:20 + size]), data[28 + size:]

    def read(self, index):
        accessor = self.head["accessors"][index]
        start = self.head["bufferViews"][accessor["bufferView"]]["byteOffset"]
        columns = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        kind = {5126: "f", 5125: "I"}[accessor["componentType"]]
        numbers = struct.unpack_from(f"<{accessor['count'] * columns}{kind}", self.binary, start)
        return list(zip(*(numbers[c::columns] for c in range(columns))))

    def mesh(self, name):
        """As usd_mesh()."""
        part = next(mesh for mesh in self.head["meshes"] if mesh["name"] == name)["primitives"][0]
        indices = [row[0] for row in self.read(part["indices"])]
        rest, targets = self.read(part["attributes"]["POSITION"]), [self.read(t["POSITION"]) for t in part["targets"]]
        frames = [rest] + [[tuple(map(sum, zip(*rows))) for rows in zip(rest, moved)] for moved in targets]
        uv = self.read(part["attributes"]["TEXCOORD_0"]) if "TEXCOORD_0" in part["attributes"] else None
        assert uv is None or len(uv) == len(rest)
        return uv and [(uv[i][0], 1 - uv[i][1]) for i in indices], [[frame[i] for i in indices] for frame in frames]


class Texture(CommandLine):
    def assert_near(self, one, other):
        self.assertEqual(len(one), len(other))
        for row, expected in zip(one, other):
            self.assertEqual(len(row), len(expected))
            for x, y in zip(row, expected):
                self.assertAlmostEqual(x, y, delta=2e-6)

    def run_scene(self, flag="flag.obj", text=FLAG):
        self.write("cube.obj", CUBE)
        self.write(flag, text)
        self.write("scene.toml", SCENE.replace("FLAG", flag))
        output = self.aspic("run", "scene.toml", "--out", "run").stdout
        self.aspic("convert", "run", "run.glb")
        return output, (self.folder / "run/run.usda").read_text(), Glb((self.folder / "run.glb").read_bytes())

    def test_corners_keep_their_texture_coordinates(self):
        _, usda, glb = self.run_scene()
        for name, source in (("block", CUBE), ("flag", FLAG)):
            expected = obj_corners(source)
            uv, frames = usd_mesh(usda, name)
            self.assert_near(uv, [corner[1] for corner in expected])
            self.assert_near(frames[0], [corner[0] for corner in expected])
            glb_uv, glb_frames = glb.mesh(name)
            self.assert_near(glb_uv, uv)
            for one, other in zip(glb_frames, frames, strict=True):
                self.assert_near(one, other)
            self.assertNotEqual(frames[0], frames[-1])
            rest = obj_corners((self.folder / f"run/skins/skin_{name}.obj").read_text())
            self.assertEqual(rest, expected)
            last = obj_corners((self.folder / f"run/frames/skin_{name}_000003.obj").read_text())
            self.assertEqual([corner[1] for corner in last], [corner[1] for corner in expected])
            self.assert_near([corner[0] for corner in last], frames[3])
        # Only corners at the same place with the same coordinates share a vertex.
        self.assertEqual([a["count"] for a in glb.head["accessors"] if a["type"] == "VEC2"], [24, 5])
        self.assertEqual((usd_mesh(usda, "plain")[0], glb.mesh("plain")[0]), (None, None))

    def test_gltf_keeps_its_texture_coordinates(self):
        points, uv = (0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 1, 0), (0, 0, 1, 0, .25, 1, 0, .75, -2, 3)
        data = struct.pack("<15f10f6I", *(x + (i % 3 == 0) for i, x in enumerate(points)), *uv, 0, 1, 2, 0, 4, 3)
        views = [{"buffer": 0, "byteOffset": a, "byteLength": b} for a, b in ((0, 60), (60, 40), (100, 24))]
        kinds = ((5126, 5, "VEC3"), (5126, 5, "VEC2"), (5125, 6, "SCALAR"))
        gltf = {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
                "accessors": [{"bufferView": i, "componentType": c, "count": n, "type": t}
                              for i, (c, n, t) in enumerate(kinds)],
                "bufferViews": views, "buffers": [{"byteLength": len(data), "uri":
                                                   "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
        _, usda, glb = self.run_scene("flag.gltf", json.dumps(gltf))
        upward = [(uv[2 * i], 1 - uv[2 * i + 1]) for i in (0, 1, 2, 0, 4, 3)]
        self.assert_near(usd_mesh(usda, "flag")[0], upward)
        self.assert_near(glb.mesh("flag")[0], upward)

    def test_incomplete_texture_coordinates_are_dropped_with_a_note(self):
        output, usda, glb = self.run_scene(text=FLAG.replace("3/4", "3"))
        self.assertRegex(output, r"flag.obj:10: a corner has no texture coordinates.*; the results have no texture")
        self.assertEqual((usd_mesh(usda, "flag")[0], glb.mesh("flag")[0]), (None, None))
        self.assertNotIn("vt", (self.folder / "run/skins/skin_flag.obj").read_text())
        self.assertEqual(len(usd_mesh(usda, "block")[0]), 36)

    def test_a_resumed_run_writes_the_same(self):
        self.run_scene()
        self.aspic("run", "scene.toml", "--out", "part", "--steps", "1")
        self.aspic("run", "scene.toml", "--out", "part", "--resume")
        for name in ("run.usda", "skins/skin_block.obj", "skins/skin_flag.obj"):
            self.assertEqual((self.folder / "part" / name).read_bytes(), (self.folder / "run" / name).read_bytes(), name)

    @unittest.skipUnless(MESHER.exists(), "aspic-mesh was not built")
    def test_a_filled_surface_keeps_its_texture_coordinates(self):
        self.write("cube.obj", CUBE)
        self.aspic("run", "cube.obj", "--steps", "1", "--out", "run", "--set", "mesh_size=0.05")
        uv, _ = usd_mesh((self.folder / "run/run.usda").read_text(), "cube")
        self.assert_near(uv, [corner[1] for corner in obj_corners(CUBE)])


if __name__ == "__main__":
    unittest.main()

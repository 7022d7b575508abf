#!/usr/bin/env python3
"""Pictures of `aspic render` look like those in tests/pictures, up to the differences between rasterizers.
ASPIC_UPDATE_PICTURES=1 renews them: look at each before you commit it."""
import os
import pathlib
import struct
import subprocess
import unittest
import zlib

from command_line import CommandLine

STORED = pathlib.Path(__file__).parent / "pictures"
MEAN = 4  # largest mean difference of a color, of 255
FAR, SHARE = 32, 0.04  # largest share of colors that differ by more than FAR: shifted edges
SCENE = """[[body]]
name = "bar"
shape = { box = { upper = [0.3, 0.1, 0.1], cells = [6, 2, 2] } }
material = { young = 1e5, poisson = 0.3 }
[[body.pin]]
where = "X < 1e-6"
[[body]]
name = "sheet"
shape = { rectangle = { width = 0.3, height = 0.2, size = 0.05 } }
rotate = { axis = [1, 0, 0], angle_deg = -60 }
translate = [0.15, 0.2, -0.1]
shell = { thickness = 1e-3 }
material = { young = 1e5, poisson = 0.3 }
[[body]]
name = "coil"
shape = { coil = { radius = 0.04, pitch = 0.02, turns = 4, size = 0.01 } }
translate = [0.4, 0.0, 0.1]
rod = { radius = 4e-3 }
material = { young = 1e7, poisson = 0.3 }
[[obstacle]]
plane = { origin = [0, -0.06, 0] }
[[obstacle]]
sphere = { center = [0.1, 0.0, 0.2], radius = 0.05 }
"""
PICTURES = {"plain": [], "paper": ["--view", "front"], "talk": ["--view", "back"], "tissue": ["--view", "front", "--wires"]}


def colors(png):
    """Red, green and blue of all pixels of an image of 8 bits per color."""
    at, data = 8, b""
    while at < len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        body = png[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, _, color = struct.unpack_from(">IIBB", body)
        data += body if kind == b"IDAT" else b""
        at += length + 12
    depth, raw = {2: 3, 6: 4}[color], zlib.decompress(data)
    stride, above, found = depth * width, bytearray(depth * width), []
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b = row[i - depth] if i >= depth else 0, above[i]
            c = above[i - depth] if i >= depth else 0
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) % 256
        above = row
        found += [value for i, value in enumerate(row) if i % depth < 3]
    return found


def differs(found, stored):
    """Returns in words how two pictures differ beyond the tolerance; empty: they do not."""
    apart = [abs(a - b) for a, b in zip(found, stored, strict=True)]
    mean, share = sum(apart) / len(apart), sum(d > FAR for d in apart) / len(apart)
    return f"mean {mean:.2f} of 255, {100 * share:.1f} % differ by more than {FAR}" if mean > MEAN or share > SHARE else ""


class Pictures(CommandLine):
    def setUp(self):
        super().setUp()
        self.write("bodies.toml", "[time]\nstep = 0.01\nduration = 0.01\n" + SCENE)
        self.aspic("run", "bodies.toml", "--out", "run")

    def picture(self, *options):
        self.aspic("render", "run", "-o", "a.png", "--step", "0", "--size", "144x108", "--samples", "8", *options, timeout=300)
        return (self.folder / "a.png").read_bytes()

    def test_pictures_match_the_stored_ones(self):
        for name, options in PICTURES.items():
            png, path = self.picture("--preset", name, *options), STORED / f"{name}.png"
            if "ASPIC_UPDATE_PICTURES" in os.environ:
                subprocess.run(["ffmpeg", "-loglevel", "error", "-y", "-i", "-", "-pix_fmt", "rgb24", "-pred", "mixed",
                                "-compression_level", "9", path], input=png, check=True)
            self.assertEqual(differs(colors(png), colors(path.read_bytes())), "", name)

    def test_other_cameras_and_colors_are_noticed(self):
        stored = colors((STORED / "plain.png").read_bytes())
        for options in (["--view", "1.5,0.8,1"], ["--color", "displacement"], ["--dark"]):
            self.assertNotEqual(differs(colors(self.picture("--preset", "plain", *options)), stored), "", options)

    def test_a_box_does_not_shine_through_the_sheet_above_it(self):
        self.write("covered.toml", '''[time]
step = 0.01
duration = 0.01
[[body]]
shape = { rectangle = { width = 1.0, height = 1.0, size = 0.1 } }
rotate = { axis = [1, 0, 0], angle_deg = -90 }
translate = [0, 0.003, 0]
shell = { thickness = 1e-3 }
[[obstacle]]
shape = { box = { lower = [-0.2, -0.02, -0.2], upper = [0.2, 0, 0.2], cells = [1, 1, 1] } }
''')
        self.aspic("run", "covered.toml", "--out", "run", "--force")
        found = colors(self.picture("--preset", "plain", "--view", "1,0.3,0.2"))
        self.assertFalse([c for c in zip(found[::3], found[1::3], found[2::3]) if 40 < c[0] and c[0] > 1.05 * c[2]])  # beige


if __name__ == "__main__":
    unittest.main()

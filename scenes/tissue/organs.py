#!/usr/bin/env python3
"""Makes the meshes of scenes/tissue: python3 scenes/tissue/organs.py ASPIC (the program), from any folder. Needs numpy."""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent


def write_medit(path, points, tets, regions):
    edges = points[tets[:, 1:]] - points[tets[:, :1]]
    volumes = np.linalg.det(edges)
    assert np.all(np.abs(volumes) > 0)
    tets = np.where((volumes < 0)[:, None], tets[:, [0, 1, 3, 2]], tets)
    with open(path, "w") as file:
        file.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
        for x, y, z in points:
            file.write(f"{x:.6g} {y:.6g} {z:.6g} 0\n")
        file.write(f"Tetrahedra\n{len(tets)}\n")
        for tet, region in zip(tets + 1, regions):
            file.write("{} {} {} {} ".format(*tet) + f"{region}\n")
        file.write("End\n")


def disc(rings):
    """Points of the unit disc in rings of 6 k points, and its triangles."""
    points = [(0.0, 0.0)]
    first = [0]
    for k in range(1, rings + 1):
        first.append(len(points))
        points += [(k / rings * np.cos(a), k / rings * np.sin(a)) for a in np.pi / 3 / k * np.arange(6 * k)]
    index = lambda k, i: 0 if k == 0 else first[k] + i % (6 * k)
    triangles = []
    for k in range(1, rings + 1):
        for sector in range(6):
            for s in range(k):
                outer, inner = sector * k + s, sector * (k - 1) + s
                triangles.append((index(k, outer), index(k, outer + 1), index(k - 1, inner)))
                if s + 1 < k:
                    triangles.append((index(k, outer + 1), index(k - 1, inner + 1), index(k - 1, inner)))
    return np.array(points), triangles


def revolved(heights, radii, rings):
    """A solid of revolution about the y axis."""
    flat, triangles = disc(rings)
    points = np.array([(r * x, y, r * z) for y, r in zip(heights, radii) for x, z in flat])
    tets = []
    for slice_ in range(len(heights) - 1):
        for a, b, c in (sorted(t) for t in triangles):
            low, high = slice_ * len(flat), (slice_ + 1) * len(flat)
            tets += [(low + a, low + b, low + c, high + c), (low + a, low + b, high + b, high + c),
                     (low + a, high + a, high + b, high + c)]
    return points, np.array(tets)


def biceps():
    """A belly between two tendons; the lower one carries a weight. Regions: 1 weight, 2 tendon, 3 muscle."""
    heights = np.concatenate([np.linspace(0, 0.05, 3), np.linspace(0.062, 0.11, 4), np.linspace(0.122, 0.308, 13),
                              np.linspace(0.32, 0.34, 3)])
    bulge = np.clip((heights - 0.11) / 0.21, 0, 1)
    radii = np.where(heights <= 0.05, 0.032, 0.005 + 0.017 * np.sin(np.pi * bulge) ** 1.5)
    points, tets = revolved(heights, radii, 2)
    middle = points[tets].mean(axis=1)[:, 1]
    return points, tets, np.where(middle < 0.056, 1, np.where((middle < 0.116) | (middle > 0.314), 2, 3))


def ball(aspic):
    """The vertices and tets of the program's ball of radius 1."""
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "ball.toml"
        scene.write_text("gravity = [0, 0, 0]\n[time]\nduration = 0.0\n[[body]]\nname = \"ball\"\n"
                         "shape = { sphere = { radius = 1.0, size = 0.3 } }\n")
        subprocess.run([aspic, "run", scene, "--out", f"{folder}/out", "--quiet"], check=True)
        frame = next(pathlib.Path(folder, "out").rglob("*0.vtu"))
        subprocess.run([aspic, "convert", frame, f"{folder}/ball.mesh"], check=True, stdout=subprocess.DEVNULL)
        words = pathlib.Path(folder, "ball.mesh").read_text().split()

    def block(name, width):
        start = words.index(name) + 1
        count = int(words[start])
        return np.array(words[start + 1 : start + 1 + count * width], dtype=float).reshape(count, width)

    return block("Vertices", 4)[:, :3], block("Tetrahedra", 5)[:, :4].astype(int) - 1


def liver(aspic):
    """A wedge: thick on its right side, thin on its left, hollow below."""
    points, tets = ball(aspic)
    x, y, z = points.T
    thickness = 0.65 - 0.35 * x
    lower = np.where(y < 0, 0.7, 1.0)
    shaped = np.stack([0.105 * x, (0.07 * y * lower + 0.012 * (x + 1) ** 2) * 1.0, 0.075 * z], axis=1)
    shaped[:, 1] = 0.075 * y * lower * thickness + 0.02 * (1 - x**2 - 0.6 * z**2)
    shaped[:, 2] *= 0.7 + 0.3 * thickness
    return shaped, tets, np.ones(len(tets), int)


if __name__ == "__main__":
    write_medit(FOLDER / "biceps.mesh", *biceps())
    write_medit(FOLDER / "liver.mesh", *liver(sys.argv[1]))

#!/usr/bin/python3
"""Compares Aspic's mesh files with meshio, an independent implementation: each reads the files of the other.

Usage: meshio_oracle.py MESH_COPY
"""
import pathlib
import subprocess
import sys
import tempfile

import meshio
import numpy as np

COPY = sys.argv[1]
rng = np.random.default_rng(7)
POINTS = rng.standard_normal((40, 3)) * 10.0 ** rng.integers(-6, 7, (40, 1))
TETS = np.array([rng.permutation(40)[:4] for _ in range(60)])
TRIANGLES = np.array([rng.permutation(40)[:3] for _ in range(60)])
REGION = rng.integers(1, 5, 60)


class Variant:
    """A file format: its extension, options of meshio, stored parts of the mesh, and the name of its labels."""

    def __init__(self, extension, options=None, kinds="tet", label=None, copy_options=(), exact=True, only=None):
        self.extension, self.options, self.kinds, self.label = extension, options or {}, kinds, label
        self.copy_options, self.exact, self.only = copy_options, exact, only

    def __str__(self):
        return f"{self.extension} {self.options or ''} {' '.join(self.copy_options)}".strip()


GMSH = "gmsh:physical"
VARIANTS = [
    Variant(".msh", {"file_format": "gmsh22", "binary": False, "float_fmt": ".17e"}, "tet tri", GMSH),
    Variant(".msh", {"file_format": "gmsh22", "binary": True}, "tet tri", GMSH, ("binary",)),
    Variant(".msh", {"file_format": "gmsh", "binary": False, "float_fmt": ".17e"}, "tet tri", None, only="read"),
    Variant(".msh", {"file_format": "gmsh", "binary": True}, "tet tri", None, only="read"),
    Variant(".mesh", {"float_fmt": ".17e"}, "tet tri", "medit:ref"),
    Variant(".node", {"float_fmt": ".17e"}, "tet", "tetgen:ref"),
    Variant(".vtu", {"binary": False}, "tet", "region"),
    Variant(".vtu", {"binary": True}, "tet tri", "region", ("binary",)),
    *[Variant(".vtk", {"file_format": version, "binary": binary}, "tet tri", "region", only="read")
      for version in ("vtk42", "vtk51") for binary in (False, True)],
    Variant(".obj", {}, "tri"),
    Variant(".ply", {"binary": False}, "tri"),
    Variant(".ply", {"binary": True}, "tri", None, ("binary",)),
    Variant(".stl", {"binary": False}, "tri"),
    Variant(".stl", {"binary": True}, "tri", None, ("binary",), exact=False),
    Variant(".off", {}, "tri"),
]


def mesh(kind, variant):
    cells = [("tetra", TETS)] if kind == "tet" else [("triangle", TRIANGLES)]
    data = {}
    if kind == "tet" and variant.label:
        data[variant.label] = [REGION]
        if variant.label == GMSH:
            data["gmsh:geometrical"] = [np.ones_like(REGION)]
    return meshio.Mesh(POINTS, cells, cell_data=data)


def copy(source, target, options=()):
    result = subprocess.run([COPY, source, target, *options], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


def check(found, kind, label, exact):
    """The corners of each element are compared, since STL does not number vertices."""
    expected = TETS if kind == "tet" else TRIANGLES
    cells = found.cells_dict["tetra" if kind == "tet" else "triangle"]
    corners = found.points[cells]
    assert corners.shape == POINTS[expected].shape, (corners.shape, POINTS[expected].shape)
    if exact:
        assert np.array_equal(corners, POINTS[expected]), np.abs(corners - POINTS[expected]).max()
    else:  # single precision
        assert np.allclose(corners, POINTS[expected], rtol=2.0**-23, atol=0)
    if label:
        assert np.array_equal(np.concatenate(found.cell_data[label]).ravel(), REGION), found.cell_data


def compare(variant, kind, folder):
    """meshio -> Aspic -> plain text .msh -> meshio, then meshio -> plain text .msh -> Aspic -> meshio."""
    plain = VARIANTS[0]
    theirs, ours, middle = folder / f"theirs{variant.extension}", folder / f"ours{variant.extension}", folder / "m.msh"
    if variant.only != "write":
        mesh(kind, variant).write(theirs, **variant.options)
        written = meshio.read(theirs)  # some of meshio's own writers round coordinates
        copy(theirs, middle)
        found = meshio.read(middle)
        label = plain.label if variant.label and kind == "tet" else None
        assert np.array_equal(written.points[written.cells[0].data], found.points[found.cells[0].data])
        check(found, kind, label, exact=False)
    if variant.only != "read":
        mesh(kind, plain).write(middle, **plain.options)
        copy(middle, ours, variant.copy_options)
        check(meshio.read(ours), kind, variant.label if kind == "tet" else None, variant.exact)


def compare_second_order(options, folder):
    """Quadratic tets beside their faces become linear; the fields of cells follow the tets."""
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]
    points = np.vstack([corners, [(corners[a] + corners[b]) / 2 for a, b in edges]])
    cells = [("triangle6", [[0, 2, 1, 6, 5, 4]]), ("tetra10", [list(range(10))])]
    data = {"region": [np.array([3]), np.array([7])]}
    source, target = folder / options.pop("name"), folder / "linear.msh"
    meshio.Mesh(points, cells, cell_data=data).write(source, **options)
    copy(source, target)
    found = meshio.read(target)
    assert np.array_equal(found.points[found.cells_dict["tetra"][0]], corners)
    assert found.cell_data[GMSH][0][0] == 7, found.cell_data


SECOND_ORDER = [{"name": "q.vtk", "file_format": version, "binary": binary}
                for version in ("vtk42", "vtk51") for binary in (False, True)] + [{"name": "q.vtu"}]


def main():
    failures = 0
    for options in SECOND_ORDER:
        with tempfile.TemporaryDirectory() as folder:
            try:
                compare_second_order(dict(options), pathlib.Path(folder))
                print(f"ok    second order {options}")
            except Exception as error:
                failures += 1
                print(f"FAIL  second order {options}: {type(error).__name__}: {error}")
    for variant in VARIANTS:
        for kind in variant.kinds.split():
            with tempfile.TemporaryDirectory() as folder:
                try:
                    if kind == "tri" and variant.extension == ".vtu":
                        variant.only = "read"
                    compare(variant, kind, pathlib.Path(folder))
                    print(f"ok    {kind} {variant}")
                except Exception as error:  # tries all variants and prints each failure
                    failures += 1
                    print(f"FAIL  {kind} {variant}: {type(error).__name__}: {error}")
    return 1 if failures else 0


sys.exit(main())

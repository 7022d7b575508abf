"""Meshes of tets and of triangles, as arrays."""
from __future__ import annotations

import os
from typing import Any

import numpy as np

from . import _aspic
from ._checks import Floats, Ints


class Mesh:
    """A mesh of tets.

    vertices: (n, 3) rest positions [m]; tets: (m, 4) vertices, positively oriented; region: (m,) labels or None.

    >>> mesh = aspic.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
    >>> mesh.volumes.round(6).tolist()
    [0.166667]
    """

    def __init__(self, vertices, tets, region=None) -> None:
        self.vertices, self.tets, self.region = _aspic.check_arrays(vertices, tets, region)

    def __setattr__(self, name, value):
        if getattr(self, "_is_constant", False):
            raise AttributeError("the mesh of a body is constant: change a Mesh before it is added, or add another body")
        super().__setattr__(name, value)

    def _constant(self):
        """A copy that cannot be changed."""
        copy = Mesh(*self._arrays())
        for array in copy._arrays():
            if array is not None:
                array.flags.writeable = False
        copy._is_constant = True
        return copy

    @classmethod
    def from_meshio(cls, mesh) -> Mesh:
        """The tets of a meshio.Mesh."""
        tets = [block.data for block in mesh.cells if block.type == "tetra"]
        if not tets:
            raise _aspic.InvalidInput("the mesh has no cells of type 'tetra'")
        for block in tets:
            _aspic.require_bounded(np.asarray(block), "tets")
        return cls(mesh.points, np.concatenate(tets))

    def __repr__(self):
        return f"<Mesh: {len(self.vertices)} vertices, {len(self.tets)} tets>"

    def _arrays(self):
        return self.vertices, self.tets, self.region

    def _require_sound(self, what, at_least):
        """Raises InvalidInput for errors in a mesh of more tets than `at_least`; smaller ones are checked elsewhere."""
        if len(self.tets) <= at_least:
            return
        for finding in self.check():
            if finding["severity"] == "error":
                raise _aspic.InvalidInput(f"{what}: {finding['message']}; {finding['remedy']}")

    @property
    def volumes(self) -> Floats:
        """Signed volume of each tet, (m,) [m^3]."""
        return _aspic.volumes(self.vertices, self.tets)

    @property
    def centroids(self) -> Floats:
        """Centroid of each tet, (m, 3) [m]."""
        return self.vertices[self.tets].mean(axis=1)

    @property
    def triangles(self) -> Ints:
        """The boundary, (k, 3) vertices, counter-clockwise seen from outside."""
        return _aspic.boundary(self.vertices, self.tets)

    @property
    def quality(self) -> dict[str, float]:
        """Volumes [m^3], dihedral angles [degrees] and mean ratios as a dict."""
        return _aspic.quality(self.vertices, self.tets)

    def check(self) -> list[dict[str, Any]]:
        """Returns the defects: a list of dicts with severity, name, message, remedy and indices."""
        return _aspic.diagnose(*self._arrays())

    def repair(self) -> list[str]:
        """Makes the unambiguous repairs and returns one sentence for each."""
        (self.vertices, self.tets, self.region), actions = _aspic.repair(*self._arrays())
        return actions

    def write(self, path, binary=False) -> None:
        """Writes a file in the format of its extension; reading it back gives the same bits."""
        _aspic.write_mesh(os.fspath(path), *self._arrays(), binary)


class Surface:
    """A mesh of triangles: vertices (n, 3) [m], triangles (m, 3).

    >>> aspic.Surface([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    <Surface: 3 vertices, 1 triangles>
    """

    def __init__(self, vertices, triangles, path=None) -> None:
        self.vertices, self.triangles = _aspic.check_surface(vertices, triangles)
        self._path = path

    def __setattr__(self, name, value):
        if getattr(self, "_is_constant", False):
            raise AttributeError("the surface of a body is constant: change it before it is added, or add another body")
        super().__setattr__(name, value)

    def _constant(self):
        """A copy that cannot be changed."""
        copy = Surface(self.vertices, self.triangles)
        for array in (copy.vertices, copy.triangles):
            array.flags.writeable = False
        copy._is_constant = True
        return copy

    def __repr__(self):
        return f"<Surface: {len(self.vertices)} vertices, {len(self.triangles)} triangles>"

    def check(self) -> list[dict[str, Any]]:
        """Returns the defects, as Mesh.check() does."""
        return _aspic.diagnose_surface(self.vertices, self.triangles)

    def write(self, path) -> None:
        """Writes a file in the format of its extension."""
        _aspic.write_surface(os.fspath(path), self.vertices, self.triangles)

    def fill(self, size=0.0) -> Mesh:
        """Fills a closed surface that was read from a file with tets of edge length `size`, by aspic-mesh."""
        if self._path is None:
            raise _aspic.InvalidInput("fill() needs a surface from a file: write it, then read_mesh(path).fill()")
        arrays, self.notes = _aspic.fill(self._path, float(size), _mesher())
        return Mesh(*arrays)


class Polyline:
    """The middle line of a rod: vertices (n, 3) [m] in their order; closed: the last is joined to the first."""

    def __init__(self, vertices, closed=False) -> None:
        self.vertices, _ = _aspic.check_surface(vertices, np.empty((0, 3), int))
        self.closed = bool(closed)
        if len(self.vertices) < 2 + self.closed:
            raise _aspic.InvalidInput(f"rod: {len(self.vertices)} points; expected at least {2 + self.closed}")

    def __repr__(self):
        return f"<Polyline: {len(self.vertices)} vertices{', closed' if self.closed else ''}>"

    def write(self, path) -> None:
        """Writes an OBJ file."""
        order = [*range(1, len(self.vertices) + 1)] + [1] * self.closed
        with open(path, "w") as file:
            np.savetxt(file, self.vertices, fmt="v %.17g %.17g %.17g")
            file.write(" ".join(["l", *map(str, order)]) + "\n")


class Thin:
    """A sheet or a rod for Scene.add(): its mesh and the keys that make a body thin. Made by sheet() and rod()."""

    def __init__(self, mesh, **table) -> None:
        self.mesh, self.table = mesh, table

    def __repr__(self):
        return f"<{' '.join(self.table)} of {self.mesh!r}>"


def sheet(mesh, thickness, **shell) -> Thin:
    """A sheet [m], with the other keys of `shell`: moment, bending, ...

    mesh: a Surface, the path of a mesh file, or a dict such as {"rectangle": {"width": 1, "height": 1, "size": 0.05}}.

    >>> scene = aspic.Scene()
    >>> flag = scene.add(aspic.sheet({"rectangle": {"width": 1, "height": 1, "size": 0.2}}, thickness=1e-3))
    """
    return Thin(mesh, shell={"thickness": thickness, **shell})


def rod(mesh, radius, closed=False, **keys) -> Thin:
    """A rod [m], with the other keys of `rod`: rest, natural_twist, twist_first, twist_last.

    mesh: the points (n, 3) of its middle line, joined to a ring if `closed`; the path of a file with lines; or a dict
    such as {"line": {"from": [0, 0, 0], "to": [1, 0, 0], "size": 0.02}}.

    >>> scene = aspic.Scene()
    >>> cable = scene.add(aspic.rod(np.linspace([0, 0, 0], [1, 0, 0], 11), radius=0.01))
    """
    if not isinstance(mesh, (str, os.PathLike, dict)):
        mesh = Polyline(mesh, closed)
    elif closed:
        raise _aspic.InvalidInput("closed: is for points; a file or a shape is closed by itself")
    return Thin(mesh, rod={"radius": radius, **keys})


def _mesher():
    """aspic-mesh of the build or of the installation; empty: searched on the PATH."""
    here = os.path.dirname(os.path.abspath(_aspic.__file__))
    candidates = [os.path.join(here, up, "bin", "aspic-mesh") for up in ("../..", "../../../..")]
    return next((path for path in candidates if os.path.exists(path)), "")


def read_mesh(path) -> Mesh | Surface:
    """Reads a mesh file: a Mesh if it has tets, else a Surface.

    >>> aspic.box(1, cells=1).write("box.msh")
    >>> aspic.read_mesh("box.msh")
    <Mesh: 8 vertices, 6 tets>
    """
    path = os.fspath(path)
    arrays = _aspic.read_mesh(path)
    return Mesh(*arrays) if len(arrays) == 3 else Surface(*arrays, path)


def box(size, cells, origin=(0, 0, 0), cut="kuhn") -> Mesh:
    """A box of `size` [m] from `origin`, of cells[0] x cells[1] x cells[2] cells of six tets ("five": of five).

    One number for `size` or `cells` holds for all three axes.

    >>> aspic.box((1, 2, 1), cells=(2, 4, 2))
    <Mesh: 45 vertices, 96 tets>
    """
    low = _three(origin, "origin")
    counts = _three(cells, "cells")
    if (counts != np.floor(counts)).any() or (abs(counts) > 1e9).any():
        raise _aspic.InvalidInput(f"cells = {cells}: must be integers")
    return Mesh(*_aspic.box(low, _three(size, "size"), [int(n) for n in counts], cut))


def _three(value, name):
    """Three numbers, or one for all axes."""
    if np.ndim(value) > 1 or np.size(value) not in (1, 3):
        raise _aspic.InvalidInput(f"{name}: shape {np.shape(value)}; expected three numbers, or one for all axes")
    try:
        array = np.asarray(value, float)
    except (TypeError, ValueError):
        raise _aspic.InvalidInput(f"{name} = {value!r}; expected three numbers, or one for all axes") from None
    if not np.isfinite(array).all():
        raise _aspic.InvalidInput(f"{name} = {value}; must be finite")
    return np.broadcast_to(array, 3)


def cylinder(radius, height, size) -> Mesh:
    """A cylinder about the z axis from 0 to `height`, with edges of about `size` [m].

    >>> rod = aspic.cylinder(radius=0.1, height=1, size=0.05)
    """
    return Mesh(*_aspic.cylinder(radius, height, size))


def sphere(radius, size) -> Mesh:
    """A ball about the origin with edges of about `size` [m].

    >>> ball = aspic.sphere(radius=1, size=0.3)
    """
    return Mesh(*_aspic.sphere(radius, size))


def torus(major_radius, minor_radius, size) -> Mesh:
    """A torus about the z axis with edges of about `size` [m].

    >>> ring = aspic.torus(major_radius=1, minor_radius=0.3, size=0.2)
    """
    return Mesh(*_aspic.torus(major_radius, minor_radius, size))

"""Interactive pictures of arrays."""
from __future__ import annotations

import json
import os
import pathlib
import tempfile
import webbrowser

import numpy as np

from . import _aspic
from ._checks import bounded
from .notebook import Player, in_notebook

_FRAME = 1 / 30  # from a frame to the next [s]
_LONGEST = 0.15  # length of the longest arrow of the first frame, relative to the surface
_MOST_VERTICES = 2_000_000  # three indices fit into a key of 63 bits


def show(vertices, faces, scalars=None, vectors=None, path=None) -> Figure:
    """Shows arrays in 3-D: below the cell of a notebook, else in the browser, or in the HTML file `path`.

    vertices: (n, 3) [m]. faces: (m, 3) triangles or (m, 4) tets, whose boundary is shown. scalars: a number per vertex or per
    face as colors, or a dict of several such arrays. vectors: (n, 3) or (m, 3), as arrows. Returns a Figure.

    >>> ball = aspic.sphere(radius=1, size=0.3)
    >>> x, y, z = ball.vertices.T
    >>> figure = aspic.show(ball.vertices, ball.tets, scalars={"height": y, "volume": ball.volumes}, path="ball.html")
    """
    figure = Figure(vertices, faces, scalars, vectors)
    if path is not None:
        figure.save(path)
    elif not in_notebook():
        figure.open()
    return figure


class Figure(Player):
    """A surface with quantities, made by show(). It is the last value of a cell, or save() writes it."""

    def __init__(self, vertices, faces, scalars=None, vectors=None) -> None:
        self.height, self._frames, self._arrow_scale = 600, [], None
        vertices = _array(vertices, "vertices", [("a row per vertex", (-1, 3))])
        self._counts = {"vertex": len(vertices), "face": 0}
        faces = _indices(faces, len(vertices))
        self._counts["face"] = len(faces)
        self._tets = len(faces) if faces.shape[1] == 4 else 0
        triangles, self._face = _boundary(faces, vertices) if self._tets else (faces, np.arange(len(faces)))
        self._vertex, corners = np.unique(triangles, return_inverse=True)
        self._triangles = corners.reshape(-1, 3)
        scalars = self._scalars(scalars)
        self._names = list(scalars)
        self._is_split = any(place == "face" for place, _ in scalars.values())  # triangles share no corners
        self._add(vertices, scalars, vectors)

    def update(self, vertices=None, scalars=None, vectors=None) -> Figure:
        """Adds a frame 1/30 s later. What is not given stays. Returns the figure.

        >>> mesh = aspic.box((1, 1, 1), cells=2)
        >>> figure = aspic.show(mesh.vertices, mesh.tets, path="motion.html")
        >>> for i in range(30):
        ...     figure = figure.update(vertices=mesh.vertices * (1 + 0.01 * i))
        >>> figure.save("motion.html")
        """
        last = self._frames[-1]
        scalars = self._scalars(scalars)
        strange = [name for name in scalars if name not in self._names]
        if strange:
            raise _aspic.InvalidInput(f"scalars: {strange[0]!r} is new; this figure has {self._names}; call show() again")
        if not self._is_split and any(place == "face" for place, _ in scalars.values()):
            raise _aspic.InvalidInput("scalars: one number per face; this figure has one per vertex; call show() again")
        if vertices is not None:
            vertices = _array(vertices, "vertices", [("a row per vertex", (self._counts["vertex"], 3))])
        self._add(last["vertices"] if vertices is None else vertices, scalars, vectors)
        return self

    @property
    def page(self) -> str:
        """The page as HTML, which needs no network."""
        frames, first = self._frames, self._frames[0]
        points = first["points"]
        is_constant = {name: all(frame["scalars"][name] is first["scalars"][name] for frame in frames) for name in self._names}
        keys = {name: f"scalar{i}" for i, name in enumerate(self._names)}
        corners = self._triangles.ravel() if self._is_split else np.arange(len(points))
        triangles = np.arange(len(corners)) if self._is_split else self._triangles
        arrays = {"point.rest": points, "point.pinned": np.zeros(len(points), np.uint8), "contact.at": points[:0],
                  "contact.point": corners[:0], "cage.rest": points[corners], "cage.triangles": triangles,
                  "cage.tet": self._face, "cage.vertex": self._vertex[corners], "cage.corners": corners,
                  "cage.place": np.arange(len(corners)), "arrows": np.concatenate([frame["arrows"] for frame in frames]),
                  **{f"field.{keys[name]}": first["scalars"][name] for name in self._names if is_constant[name]}}
        moving = {f"field.{keys[name]}": [frame["scalars"][name] for frame in frames]
                  for name in self._names if not is_constant[name]}
        arrays = {name: a if a.dtype.itemsize < 8 else a.astype(np.uint32) for name, a in arrays.items()}
        return _aspic.page_of_arrays(json.dumps(self._head(keys)), arrays, [frame["points"] for frame in frames], moving)

    def open(self) -> None:
        """Opens the page in the browser, from a temporary file, which stays."""
        path = pathlib.Path(tempfile.mkdtemp(prefix="aspic-figure-")) / "figure.html"
        self.save(path)
        has_screen = os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
        if not (has_screen and webbrowser.open(path.as_uri())):
            print("open this file in a browser:", path)

    def __repr__(self):
        return f"<Figure: {self._counts['vertex']} vertices, {self._counts['face']} faces; frames: {len(self._frames)}>"

    def _scalars(self, scalars):
        """{name: (place, values)}."""
        if scalars is None:
            return {}
        named = {f"scalars[{name!r}]": (name, value) for name, value in scalars.items()} if isinstance(scalars, dict) else \
                {"scalars": ("scalars", scalars)}
        found = {str(name): _array(value, key, self._places(())) for key, (name, value) in named.items()}
        return {name: ("vertex" if len(a) == self._counts["vertex"] else "face", a) for name, a in found.items()}

    def _places(self, shape):
        return [(f"one per {place}", (count, *shape)) for place, count in self._counts.items()]

    def _add(self, vertices, scalars, vectors):
        last = self._frames[-1] if self._frames else {"scalars": {}, "vectors": None}
        points = vertices[self._vertex]
        colors = {name: self._on_surface(*found) for name, found in scalars.items()}
        vectors = last["vectors"] if vectors is None else _array(vectors, "vectors", self._places((3,)))
        self._frames.append({"vertices": vertices, "points": points, "vectors": vectors,
                             "scalars": {**last["scalars"], **colors}, "arrows": self._arrows(points, vectors)})

    def _on_surface(self, place, values):
        if place == "face":
            return np.repeat(values[self._face], 3)
        return values[self._vertex][self._triangles.ravel()] if self._is_split else values[self._vertex]

    def _arrows(self, points, vectors):
        """Starts and vectors, (k, 6)."""
        if vectors is None:
            return np.zeros((0, 6), np.float32)
        is_of_vertices = len(vectors) == self._counts["vertex"]
        starts = points if is_of_vertices else points[self._triangles].mean(axis=1)
        vectors = vectors[self._vertex if is_of_vertices else self._face]
        if self._arrow_scale is None:
            size, longest = np.linalg.norm(np.ptp(points, axis=0)), np.linalg.norm(vectors, axis=1).max()
            self._arrow_scale = _LONGEST * size / longest if longest > 0 else None
        return np.hstack([starts, vectors * np.float32(self._arrow_scale or 0)])

    def _head(self, keys):
        frames = self._frames
        low, high = (f([f(frame["points"], axis=0) for frame in frames], axis=0).tolist() for f in (np.min, np.max))
        fields = [{"name": keys[name], "label": name, "unit": "", "center": 0, "log": False,
                   "diverging": _has_both_signs([frame["scalars"][name] for frame in frames])} for name in self._names]
        scene = {"kind": "scene", "side": "a", "generation": 1, "name": "figure", "label": "", "path": "", "overrides": [],
                 "loaded_overrides": [], "notes": [], "surface": "cage", "has_skin": False, "vertices": self._counts["vertex"],
                 "tets": self._tets, "triangles": self._counts["face"] - self._tets, "bodies": ["figure"], "body_tets": [0],
                 "lower": low, "upper": high, "up": [0, 1, 0], "h": _FRAME, "implicit": False, "solver": "",
                 "potentials": [], "fields": fields, "field": fields[0]["name"] if fields else "", "settings": [], "stiffness": 0}
        count = len(frames)
        return {"format": 1, "toml": "", "steps": [], "scenes": [scene],
                "hello": {"kind": "hello", "protocol": 1, "version": _aspic.__version__, "steers": True, "live": False,
                          "lessons": []},
                "frames": {"step": [*range(count)], "time": [i * _FRAME for i in range(count)], "contacts": [0] * count,
                           "arrows": [len(frame["arrows"]) for frame in frames]}}


def _has_both_signs(arrays):
    return bool(min(a.min() for a in arrays) < 0 < max(a.max() for a in arrays))


def _array(value, name, shapes):
    """The argument in single precision; shapes: the accepted ones with what they hold, -1: any length."""
    array = bounded(value, name)
    fits = any(array.ndim == len(shape) and all(n in (-1, m) for n, m in zip(shape, array.shape)) for _, shape in shapes)
    if not fits:
        expected = " or ".join(f"{str(shape).replace('-1', 'n')}, {what}" for what, shape in shapes)
        raise _aspic.InvalidInput(f"{name}: shape {array.shape}; expected {expected}")
    if array.dtype.kind not in "biuf":
        raise _aspic.InvalidInput(f"{name}: holds {array.dtype}; expected real numbers")
    with np.errstate(over="ignore"):
        single = array.astype(np.float32)
    if not np.isfinite(single).all():
        at = tuple(int(i) for i in np.argwhere(~np.isfinite(single))[0])
        raise _aspic.InvalidInput(f"{name}[{', '.join(map(str, at))}] = {array[at]}; must be finite, below 3e38")
    return single


def _indices(faces, count):
    array = bounded(faces, "faces")
    if array.ndim != 2 or array.shape[1] not in (3, 4) or len(array) == 0:
        raise _aspic.InvalidInput(f"faces: shape {array.shape}; expected (m, 3), triangles, or (m, 4), tets")
    if array.dtype.kind not in "iu":
        raise _aspic.InvalidInput(f"faces: holds {array.dtype}; expected integers, the vertices of each face")
    outside = (array < 0) | (array >= count)
    if outside.any():
        row, column = (int(i) for i in np.argwhere(outside)[0])
        raise _aspic.InvalidInput(f"faces[{row}, {column}] = {array[row, column]}; the vertices are 0 to {count - 1}")
    return array.astype(np.int64)


def _boundary(tets, vertices):
    """Triangles of one tet only, counter-clockwise seen from outside, and the tet of each."""
    if len(vertices) > _MOST_VERTICES:
        raise _aspic.InvalidInput(f"vertices: {len(vertices)} rows; at most {_MOST_VERTICES} of tets can be shown")
    corners = tets[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]]
    a, b, c, d = (vertices[tets[:, k]] for k in range(4))
    is_inverted = np.einsum("ij,ij->i", np.cross(b - a, c - a), d - a) < 0
    corners[is_inverted] = corners[is_inverted][:, :, [0, 2, 1]]
    corners = corners.reshape(-1, 3)
    i, j, k = np.sort(corners, axis=1).T
    _, first, count = np.unique((i * len(vertices) + j) * len(vertices) + k, return_index=True, return_counts=True)
    chosen = np.sort(first[count == 1])
    if len(chosen) == 0:
        raise _aspic.InvalidInput("faces: the tets have no boundary; some are listed twice")
    return corners[chosen], chosen // 4

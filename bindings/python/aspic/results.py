"""The results of a run, as arrays."""
from __future__ import annotations

import csv
import os
import pathlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _aspic
from ._checks import Floats, Ints
from .notebook import Player


class Run:
    """A folder that `aspic run` or a Simulation wrote.

    >>> scene = aspic.Scene()
    >>> body = scene.add(aspic.box(0.1, cells=2))
    >>> reports = aspic.Simulation(scene, h=0.01, out="run").run(3)
    >>> run = aspic.Run("run")
    >>> run.positions().shape, run.steps["step"].tolist()
    ((4, 27, 3), [0, 1, 2, 3])
    """

    def __init__(self, path) -> None:
        self.path, self._frame_files = pathlib.Path(path), None
        if not (self.path / "steps.csv").is_file():
            raise _aspic.InvalidInput(f"{self.path}: contains no run (there is no steps.csv)")

    def __repr__(self):
        return f"<Run {self.path}>"

    @property
    def steps(self) -> dict[str, NDArray[Any]]:
        """The columns of steps.csv: {"time": array, "status": array of str, "residual": array, ...}."""
        return _columns(self.path / "steps.csv")

    @property
    def iterations(self) -> dict[str, NDArray[Any]]:
        """The columns of iterations.csv."""
        return _columns(self.path / "iterations.csv")

    @property
    def frame_files(self) -> list[pathlib.Path]:
        """The paths of the frames, sorted. Frames of several ranks are .pvtu."""
        if self._frame_files is None:
            found = {path.stem: path for kind in ("vtu", "pvtu") for path in (self.path / "frames").glob(f"body_*.{kind}")}
            self._frame_files = [found[name] for name in sorted(found)]
        return self._frame_files

    def frame(self, index) -> dict[str, Any]:
        """A frame: points (n, 3) [m], tets (m, 4), point_fields and cell_fields by name."""
        return _aspic.read_frame(os.fspath(self.frame_files[index]))

    def positions(self) -> Floats:
        """Positions of all vertices in all frames, (frames, n, 3) [m]. Needs output.vtu."""
        if not self.frame_files:
            raise _aspic.InvalidInput(f"{self.path}: has no frames of whole bodies; use surface(), or record with "
                                      "out=FOLDER")
        return np.stack([self.frame(i)["points"] for i in range(len(self.frame_files))])

    def surface(self, body=None) -> tuple[Floats, Ints]:
        """Motion of the surface of a body: (frames, k, 3) [m] in single precision, and triangles (l, 3)."""
        caches = sorted((self.path / "skins").glob("skin_*.pc2"))
        names = [cache.stem.removeprefix("skin_") for cache in caches]
        if body is not None and body not in names:
            raise _aspic.InvalidInput(f"{self.path}: no surface of '{body}'; there are: {', '.join(names)}")
        cache = caches[0 if body is None else names.index(body)]
        return _aspic.read_motion(os.fspath(cache)), _aspic.read_mesh(os.fspath(cache.with_suffix(".obj")))[1]

    def page(self, max_megabytes=10) -> str:
        """The page that plays the run, as HTML without a network or a server."""
        return _aspic.page_of_run(os.fspath(self.path), int(max_megabytes * 1e6))[0]

    def show(self, height=600) -> Player:
        """An object that notebooks show as the player of the run; it survives conversion to HTML."""
        return Player(self.page(), height)


def _columns(path):
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    return {name: _array(name, [row[i] for row in rows]) for i, name in enumerate(header)}


def _array(name, texts):
    """Integers, floats or strings; an empty cell of numbers is NaN."""
    if name == "state_hash":  # may look like a number
        return np.array(texts)
    try:
        return np.array([int(text) for text in texts])
    except ValueError:
        pass
    try:
        return np.array([float(text) if text else np.nan for text in texts])
    except ValueError:
        return np.array(texts)

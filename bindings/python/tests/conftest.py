import os
import pathlib

import pytest

import aspic

ROOT = pathlib.Path(__file__).resolve().parents[3]


@pytest.fixture
def scenes():
    return ROOT / "scenes"


@pytest.fixture
def program():
    """The command line of the same build."""
    path = pathlib.Path(os.environ.get("ASPIC_BUILD", ROOT / "build/release")) / "bin/aspic"
    if not path.exists():
        pytest.skip("the command line is not built")
    return path


@pytest.fixture
def jelly():
    """A scene of one cube that hangs from its top."""
    return make_jelly()


def make_jelly(cells=3, **values):
    scene = aspic.Scene()
    material = aspic.Material("neo_hookean", young=5e3, poisson=.4)
    body = scene.add(aspic.box((.1, .1, .1), cells=(cells,) * 3), name="jelly", material=material, **values)
    body.pin(body.vertices[:, 1] == .1, name="top")
    return scene

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
def program_of_fits(program):
    """The same where the package `inverse` is built, too."""
    if not program.with_name("aspic-fit").exists():
        pytest.skip("the package inverse is not built")
    return program


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

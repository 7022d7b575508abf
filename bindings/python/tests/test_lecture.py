"""The programs of docs/python/lecture are short, run by themselves, and agree with the library."""
import re
import runpy

import numpy as np
import pytest
from conftest import ROOT

import aspic

PROGRAMS = sorted((ROOT / "docs/python/lecture").glob("*.py"))


@pytest.mark.parametrize("path", PROGRAMS, ids=[path.stem for path in PROGRAMS])
def test_program_fits_a_page(path):
    text = path.read_text()
    assert len(text.splitlines()) <= 60
    lines = [line for line in text.splitlines() if line.startswith(("import", "from"))]
    own = re.compile(r"from (finite_elements|newton|time_step) import .*")
    assert [line for line in lines if not own.fullmatch(line)] == ["import numpy as np"]


def result(name):
    return runpy.run_path(str(ROOT / f"docs/python/lecture/{name}.py"))


def relative_difference(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


def test_finite_elements():
    page = result("finite_elements")
    mesh = aspic.Mesh(page["X"], page["tets"])
    scene = aspic.Scene(gravity=(0, 0, 0))
    scene.add(mesh, material=aspic.Material("neo_hookean_log", young=page["young"], poisson=page["poisson"], density=1000))
    E, q = aspic.Simulation(scene).objective(), page["q"]
    E.begin_statics(q)
    assert abs(E(q) / page["body"].V(q) - 1) < 1e-12
    assert relative_difference(page["body"].gradient(q), E.gradient(q)) < 1e-12
    statics = E.hessian(q).to_scipy().toarray()
    h = 1e-3
    E.begin_step(page["X"], np.zeros_like(q), h)
    M = E.hessian(q).to_scipy().toarray() - h**2 * statics
    assert relative_difference(np.kron(page["body"].mass(len(q)), np.eye(3)), M) < 1e-12


def test_time_step():
    page = result("time_step")
    scene = aspic.Scene(solver={"mass": "lumped", "tolerance": 1e-10})
    tets = page["tets"]
    tets[24:] = tets[24:, [0, 1, 3, 2]]  # positive volumes
    body = scene.add(aspic.Mesh(page["X"], tets), elastic=False, material=aspic.Material(density=1000))
    body.spring(edges=True, stiffness=page["k"])
    body.pin(body.vertices[:, 0] == 0)
    sim = aspic.Simulation(scene, h=page["h"])
    sim.run(20, check=True)
    assert np.abs(sim.q - page["q"]).max() < 1e-6
    assert page["q"][-1, 1] < -.05


@pytest.mark.parametrize("name", ["descent", "solved", "unguarded"])
def test_newton(name):
    page, path = result("newton")[name], []
    method = ("gradient_descent", {}) if name == "descent" else ("newton", {"definiteness": "absolute"})
    aspic.minimize(aspic.test_function("rosenbrock"), page[0], method[0],
                   {"test": "none" if name == "unguarded" else "textbook", "tol": 1e-16}, lambda it: path.append(it.x),
                   tolerance=1e-8, criterion="absolute", max_iterations=20000, **method[1])
    count = min(len(path), len(page))
    assert abs(len(path) - len(page)) <= 1  # the program stops before the last iterate is observed
    assert np.abs(np.array(path[:count]) - page[:count]).max() < 1e-9


@pytest.fixture
def solutions(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "docs/python/lecture"))
    return lambda week: result(f"week{week}")


def test_solutions_of_derivatives_and_integrators(solutions):
    errors = solutions(1)["errors"]
    assert errors[0] > 50 * errors[1] > 2500 * errors[2]
    kept = solutions(2)["kept"]
    expected = {"forward_euler": 1.868615, "symplectic_euler": 1, "backward_euler": 0.535156}  # tests/bench/results/integrators.md
    assert kept == pytest.approx(expected, abs=3e-4)


def test_solutions_of_minimization(solutions):
    assert solutions(3)["difference"] < 1e-6
    counts = solutions(4)["counts"]
    assert max(counts[3:7]) > 20 and min(counts) == counts[1]
    counts = solutions(5)["counts"]
    assert counts["steepest", True][1] < 0.3 * counts["steepest", False][1]
    assert counts["newton", True][1] >= counts["newton", False][1]

"""Objectives, linear solvers, minimization and derivatives."""
import subprocess

import numpy as np
import pytest
import scipy.sparse.linalg
from conftest import ROOT, make_jelly

import aspic


def moved(sim, size=1e-3):
    return sim.q + np.where(sim.pinned[:, None], 0, size * np.random.default_rng(1).standard_normal(sim.q.shape))


def test_loop_of_the_readme_agrees_with_the_simulation():
    source = (ROOT / "README.md").read_text()
    loop = source.split("```python\n")[2].split("```")[0]
    assert len(loop.strip().splitlines()) <= 12
    sim = aspic.Simulation(make_jelly(), h=0.01, solver={"tolerance": 1e-10})
    names = {"aspic": aspic, "np": np, "sim": sim}
    exec(loop, names)
    sim.run(20)
    np.testing.assert_allclose(names["q"], sim.q, atol=1e-9)


def test_hessian_as_scipy_matrix_is_the_derivative_of_the_gradient():
    sim = aspic.Simulation(make_jelly())
    E, q = sim.objective(), moved(sim)
    E.begin_step(sim.q, sim.v, .01)
    H = E.hessian(q).to_scipy()
    d = np.where(sim.pinned[:, None], 0, np.random.default_rng(2).standard_normal(q.shape))
    difference = (E.gradient(q + 1e-7 * d) - E.gradient(q - 1e-7 * d)).ravel() / 2e-7
    np.testing.assert_allclose((H @ d.ravel())[~np.repeat(sim.pinned, 3)], difference[~np.repeat(sim.pinned, 3)],
                               atol=1e-5 * abs(difference).max())
    assert abs(H - H.T).max() < 1e-12 * abs(H).max()
    np.testing.assert_allclose((E.hessian(q) @ d).ravel(), H @ d.ravel(), atol=1e-12 * abs(H).max())


@pytest.mark.parametrize("method", ["auto", "cholesky", "multigrid", "block_jacobi"])
def test_linear_solvers_agree_with_scipy(method):
    sim = aspic.Simulation(make_jelly())
    E, q = sim.objective(), moved(sim)
    E.begin_step(sim.q, sim.v, .01)
    H, g = E.hessian(q, "clamped"), E.gradient(q)
    x = aspic.LinearSolver(method).factorize(H).solve(g, tolerance=1e-12)
    exact = scipy.sparse.linalg.spsolve(H.to_scipy().tocsc(), g.ravel())
    np.testing.assert_allclose(x.ravel(), exact, atol=1e-8 * abs(exact).max())


def test_indefinite_matrix_raises():
    f = aspic.test_function("two_bump")
    with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
        aspic.LinearSolver("cholesky").factorize(f.hessian([.7, .0]))


def test_hessian_contains_contact():
    scene = aspic.Scene()
    scene.add(aspic.sphere(.1, .06), material=aspic.Material("neo_hookean_log", young=2e4, poisson=.4),
              translate=[0, .1005, 0])
    scene.obstacle(plane={}).contact(reach=.002)
    sim = aspic.Simulation(scene)
    E = sim.objective()
    E.begin_step(sim.q, sim.v, .01)
    assert aspic.check_derivatives(E, moved(sim, 1e-5), length=1e-4)
    down = np.broadcast_to([0., -1., 0.], sim.q.shape)
    assert 0 < E.max_step(sim.q, down) < .01


@pytest.mark.parametrize("method", ["newton", "lbfgs", "gradient_descent", "nonlinear_cg"])
def test_test_functions_are_minimized(method):
    info = next(f for f in aspic.test_functions() if f["name"] == "rosenbrock")
    result = aspic.minimize(aspic.test_function("rosenbrock"), info["start"], method, max_iterations=100000)
    assert result.success
    np.testing.assert_allclose(result.x, info["minimizer"], atol=1e-3)


class Chain:
    """Rosenbrock's function of n variables."""

    def value(self, x):
        return np.sum(100 * (x[1:] - x[:-1]**2)**2 + (1 - x[:-1])**2)

    def gradient(self, x):
        g, r = np.zeros_like(x), x[1:] - x[:-1]**2
        g[:-1] = -400 * x[:-1] * r - 2 * (1 - x[:-1])
        g[1:] += 200 * r
        return g

    def hessian(self, x):
        diagonal = np.zeros_like(x)
        diagonal[:-1] = 1200 * x[:-1]**2 - 400 * x[1:] + 2
        diagonal[1:] += 200
        return self.matrix(np.diag(diagonal) + np.diag(-400 * x[:-1], 1) + np.diag(-400 * x[:-1], -1))

    matrix = staticmethod(np.asarray)


class SparseChain(Chain):
    matrix = staticmethod(scipy.sparse.csr_matrix)


@pytest.mark.parametrize("f, options", [(Chain(), {}), (SparseChain(), {}), (SparseChain(), {"definiteness": "exact"})])
def test_function_written_in_python_is_minimized(f, options):
    assert aspic.check_derivatives(f, np.linspace(.5, 1.4, 7))
    result = aspic.minimize(f, np.full(7, 1.2), tolerance=1e-10, **options)
    assert result.success
    np.testing.assert_allclose(result.x, 1, atol=1e-8)


def test_direction_and_line_search_in_python():
    f, start = aspic.test_function("rosenbrock"), [-1.2, 1.]
    calls = []

    def newton(E, x, g):
        calls.append(x)
        H = E.hessian(x).to_scipy().toarray()
        return -np.linalg.solve(H + max(0, 1e-3 - np.linalg.eigvalsh(H)[0]) * np.eye(2), g)

    for line_search in (None, aspic.backtrack, lambda E, x, d, g: aspic.backtrack(E, x, d, g, p=.3)):
        result = aspic.minimize(f, start, newton, line_search)
        assert result.success and len(calls) >= result.iterations
        np.testing.assert_allclose(result.x, 1, atol=1e-3)


@pytest.mark.parametrize("method", ["newton", "lbfgs", "gradient_descent"])
def test_minimization_equals_that_of_the_command_line(method, program, tmp_path):
    subprocess.run([program, "minimize", "rosenbrock", "--method", method, "--max-iterations", "20000", "--trace", tmp_path],
                   check=True, capture_output=True)
    start = next(f for f in aspic.test_functions() if f["name"] == "rosenbrock")["start"]
    trace = aspic.Trace()
    result = aspic.minimize(aspic.test_function("rosenbrock"), start, method, observe=trace, max_iterations=20000)
    table = aspic.results._columns(tmp_path / "iterations.csv")
    assert result.success and len(trace) == len(table["value"])
    for name in set(table) - {"step", "solve", "iteration"}:
        np.testing.assert_array_equal(trace[name], table[name], err_msg=name)


def test_line_search_in_python_serves_every_method():
    f, start = aspic.test_function("rosenbrock"), [-1.2, 1.]
    for method in ("newton", "lbfgs", "gradient_descent"):
        calls = []

        def search(E, x, d, g):
            calls.append(1)
            return aspic.backtrack(E, x, d, g)

        trace = aspic.Trace()
        result = aspic.minimize(f, start, method, search, observe=trace, max_iterations=20000)
        assert result.success and len(calls) >= result.iterations
        np.testing.assert_allclose(result.x, 1, atol=1e-3)
        assert set(trace["trials"][:-1]) == {1}
    with pytest.raises(ZeroDivisionError):
        aspic.minimize(f, start, line_search=lambda E, x, d, g: 1 / 0)


def test_exceptions_of_directions_and_functions_arrive():
    def bad(E, x, g):
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        aspic.minimize(aspic.test_function("rosenbrock"), [0, 0], bad)
    with pytest.raises(ValueError, match="search direction.*shape"):
        aspic.minimize(aspic.test_function("rosenbrock"), [0, 0], lambda E, x, g: np.zeros(5))


def test_derivative_check_finds_a_wrong_entry():
    class Wrong(Chain):
        def gradient(self, x):
            g = super().gradient(x)
            g[2] *= 1.01
            return g

    report = aspic.check_derivatives(Wrong(), np.linspace(.5, 1.4, 7))
    assert not report
    assert report.gradient["row"] == 2 and "WRONG at entry 2" in repr(report)
    assert repr(report).count("WRONG") == 1 and "not judged" in repr(report)

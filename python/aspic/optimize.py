"""Minimization: with the methods of the library, or with directions and line searches written in Python."""
import types

import numpy as np

from . import _aspic


def test_function(name):
    """A function of two variables with a known minimum, as an Objective; see test_functions()."""
    return _aspic.test_function(name)


def _objective(f, x0):
    return f if isinstance(f, _aspic.Objective) else _aspic.PythonObjective(f, np.asarray(x0, float))


def minimize(f, x0, direction="newton", line_search=None, observe=None, **options):
    """Minimizes f from x0 and returns an object with x, status, success, value, gradient_norm and iterations.

    f: an Objective, such as sim.objective(), or an object with value(x), gradient(x) and, for Newton's method,
    hessian(x), a dense or a scipy matrix for x.ravel().
    direction: a method, see minimizer_names(), or a function direction(E, x, g) -> d in the shape of x.
    line_search: keys of solver.line_search, or a function line_search(E, x, d, g) -> alpha.
    options: keys of [solver]: tolerance, criterion, max_iterations, linear, definiteness, ...
    observe(iteration) is called in every iteration.
    """
    E = _objective(f, x0)
    if callable(line_search):
        return _own_loop(E, x0, direction, line_search, observe, **options)
    if line_search is not None:
        options["line_search"] = line_search
    if not isinstance(f, _aspic.Objective) and direction == "newton" and "definiteness" not in options:
        options["definiteness"] = "on_demand" if np.size(x0) <= 600 else "exact"
    return types.SimpleNamespace(**_aspic.minimize(E, x0, direction, options, observe))


def backtrack(E, x, d, g, alpha=1.0, c=1e-4, p=0.5, smallest=1e-10):
    """The lecture's line search: the first alpha, alpha p, alpha p^2, ... of sufficient decrease; 0: none."""
    alpha, value, slope = min(alpha, 0.99 * E.max_step(x, d)), E(x), float((g * d).sum())
    while not E(x + alpha * d) <= value + c * alpha * slope:
        alpha *= p
        if alpha < smallest:
            return 0.0
    return alpha


def _own_loop(E, x0, direction, line_search, observe, tolerance=1e-6, max_iterations=200, definiteness="clamped",
              linear="auto"):
    x, solver = np.array(x0, float), _aspic.LinearSolver(linear)
    if direction != "newton" and not callable(direction):
        raise _aspic.InvalidInput(f"direction: '{direction}' beside a line search of yours; use 'newton' or a function")
    first = None
    for index in range(max_iterations + 1):
        g = E.gradient(x)
        norm = float(np.linalg.norm(g))
        first = norm if first is None else first
        if norm <= tolerance * first:
            return _result(E, x, "converged", norm, index)
        if index == max_iterations:
            return _result(E, x, "iteration_limit", norm, index)
        d = direction(E, x, g) if callable(direction) else -solver.factorize(E.hessian(x, definiteness)).solve(g)
        alpha = line_search(E, x, d, g)
        if observe is not None:
            observe(types.SimpleNamespace(index=index, value=E(x), gradient_norm=norm, alpha=alpha, x=x, g=g, d=d, E=E))
        if not alpha > 0:
            return _result(E, x, "stuck", norm, index)
        x = x + alpha * d


def _result(E, x, status, norm, iterations):
    return types.SimpleNamespace(x=x, status=status, success=status == "converged", value=E(x), gradient_norm=norm,
                                 iterations=iterations)

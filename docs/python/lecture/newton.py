"""Lecture pages 38-62: gradient descent and Newton's method, each with and without a line search, on Rosenbrock's valley.

The iterates agree to 1e-9 (tested) with those of the program:
aspic minimize rosenbrock --method gradient_descent --start -1.2,1 --criterion absolute --tolerance 1e-8 --max-iterations 20000
Newton's full steps need fewer iterations from here, but E first rises; from other starts and for bodies they diverge.
"""
import numpy as np


def E(x):
    return (1 - x[0])**2 + 100 * (x[1] - x[0]**2)**2


def gradient(x):
    return np.array([-2 * (1 - x[0]) - 400 * x[0] * (x[1] - x[0]**2), 200 * (x[1] - x[0]**2)])


def hessian(x):
    return np.array([[2 - 400 * (x[1] - 3 * x[0]**2), -400 * x[0]], [-400 * x[0], 200]])


def steepest(x):
    """d = -g."""
    return -gradient(x)


def newton(x):
    """H d = -g. Negative eigenvalues of H count with their absolute value, so that d leads downhill."""
    values, vectors = np.linalg.eigh(hessian(x))
    return -vectors @ (vectors.T @ gradient(x) / np.abs(values))


def backtrack(x, d, c=1e-4, p=0.5, alpha_max=1.0, tol=1e-16):
    """The largest of alpha_max, p alpha_max, p^2 alpha_max, ... with E(x + alpha d) <= E(x) + c alpha d'g."""
    alpha = alpha_max
    while E(x + alpha * d) > E(x) + c * alpha * (d @ gradient(x)):
        alpha *= p
        if alpha < tol:
            return 0.0  # stuck
    return alpha


def minimize(x, direction, line_search, tolerance=1e-8, iterations=20000):
    """All iterates, the initial guess first."""
    path = [np.array(x, dtype=float)]
    while np.linalg.norm(gradient(path[-1])) > tolerance and len(path) <= iterations:
        d = direction(path[-1])
        alpha = line_search(path[-1], d)
        if alpha == 0:
            break
        path.append(path[-1] + alpha * d)
    return np.array(path)


descent = minimize([-1.2, 1], steepest, backtrack)
solved = minimize([-1.2, 1], newton, backtrack)
unguarded = minimize([-1.2, 1], newton, lambda x, d: 1.0)
for name, path in (("gradient descent", descent), ("Newton", solved), ("Newton, full steps", unguarded)):
    if __name__ == "__main__":
        print(f"{name:20} {len(path) - 1:5} iterations, E at most {max(map(E, path)):10.4g}, x = {path[-1]}")

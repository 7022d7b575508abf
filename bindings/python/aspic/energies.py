"""Terms of the potential written in Python, and the check of their derivatives."""
from __future__ import annotations

import numpy as np

from . import _aspic
from ._checks import Floats


class Energy:
    """A sum over elements of k vertices. Derive from it, set `elements` and define three methods.

    elements: (E, k) vertices of the scene. x: (E, k, 3) positions [m].
    value(x): (E,) [J]; gradient(x): (E, k, 3) [N]; hessian(x): (E, k, 3, k, 3) [N/m].
    inf or nan: the energy is not defined there. Negative eigenvalues of element Hessians are modified where a method
    requires it. Add it with scene.energy(...).

    >>> class Floor(aspic.Energy):  # 100 N/m below y = 0
    ...     elements = np.arange(8)[:, None]
    ...     def value(self, x):
    ...         return 50 * np.minimum(x[:, 0, 1], 0) ** 2
    ...     def gradient(self, x):
    ...         return 100 * np.minimum(x, 0) * [0, 1, 0]
    ...     def hessian(self, x):
    ...         return np.einsum("eac,i,j->eaicj", 100.0 * (x[:, :, 1:2] < 0), [0, 1, 0], [0, 1, 0])
    >>> aspic.check_derivatives(Floor(), aspic.box(1, 1, origin=(0, -0.5, 0)).vertices).passed
    True
    """

    elements = None

    def value(self, x) -> Floats:
        raise NotImplementedError

    def gradient(self, x) -> Floats:
        raise NotImplementedError

    def hessian(self, x) -> Floats:
        raise NotImplementedError


class TetEnergy(Energy):
    """A material as a function of F. Derive from it and define psi(F), and pk1(F) and tangent(F) if you can.

    psi(F): (T,) energy density [J/m^3] of F (T, 3, 3); pk1(F): (T, 3, 3) dpsi/dF [Pa]; tangent(F): (T, 3, 3, 3, 3) [Pa].
    Without pk1, psi must accept complex F: its derivative is a complex step. Without tangent, it is a central difference.
    The body usually has elastic=False.

    >>> class Dirichlet(aspic.TetEnergy):
    ...     def psi(self, F):
    ...         return 500 * (F ** 2).sum(axis=(1, 2))
    >>> mesh = aspic.box(1, cells=1)
    >>> aspic.check_derivatives(Dirichlet(mesh), mesh.vertices).passed
    True
    """

    def __init__(self, mesh, first_vertex=0) -> None:
        X = mesh.vertices[mesh.tets]
        self.elements = mesh.tets + first_vertex
        self.volumes = mesh.volumes
        inverse = np.linalg.inv((X[:, 1:] - X[:, :1]).transpose(0, 2, 1))
        self._B = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)  # F = sum_a x_a B_a'

    def psi(self, F) -> Floats:
        raise NotImplementedError

    def pk1(self, F) -> Floats:
        P = np.empty(F.shape)
        for i in range(3):
            for j in range(3):
                ahead = F.astype(complex)
                ahead[:, i, j] += 1e-30j
                P[:, i, j] = np.imag(self.psi(ahead)) / 1e-30
        return P

    def tangent(self, F) -> Floats:
        A = np.empty(F.shape + (3, 3))
        step = 6e-6
        for i in range(3):
            for j in range(3):
                change = np.zeros((3, 3))
                change[i, j] = step
                A[..., i, j] = (self.pk1(F + change) - self.pk1(F - change)) / (2 * step)
        return (A + A.transpose(0, 3, 4, 1, 2)) / 2

    def F(self, x) -> Floats:
        """Deformation gradients, (T, 3, 3), of positions (T, 4, 3)."""
        return np.einsum("tai,taj->tij", x, self._B)

    def value(self, x) -> Floats:
        with np.errstate(all="ignore"):
            return self.volumes * self.psi(self.F(x))

    def gradient(self, x) -> Floats:
        with np.errstate(all="ignore"):
            return np.einsum("t,tij,taj->tai", self.volumes, self.pk1(self.F(x)), self._B)

    def hessian(self, x) -> Floats:
        with np.errstate(all="ignore"):
            A = self.tangent(self.F(x))
        return np.einsum("t,tijkl,taj,tbl->taibk", self.volumes, A, self._B, self._B, optimize=True)


class DerivativeReport:
    """The result of check_derivatives(): `gradient` and `hessian`, each a dict with step, error, order, passed."""

    def __init__(self, gradient, hessian, of_vertices=False) -> None:
        self.gradient, self.hessian, self._of_vertices = gradient, hessian, of_vertices
        self.passed = gradient["passed"] and hessian["passed"]

    def __bool__(self):
        return self.passed

    def __repr__(self):
        return "\n".join(self._line(name, check) for name, check in (("gradient", self.gradient),
                                                                     ("hessian ", self.hessian)))

    def _line(self, name, check):
        is_known = check["order"] == check["order"]  # else NaN: only round-off
        order = f", order {check['order']:.1f}" if is_known else ", exact" if check["passed"] else ""
        line = f"{name}: smallest relative error {check['smallest_error']:.1e}{order}"
        if check["passed"]:
            return line + ": correct"
        if check is self.hessian and not self.gradient["passed"]:
            return line + ": not judged, since it is compared with differences of the wrong gradient"
        place = self._entry(check["row"]) + (", " + self._entry(check["column"]) if check["column"] >= 0 else "")
        return line + f": WRONG at {place}: {check['found']:.6g} instead of {check['expected']:.6g}"

    def _entry(self, i):
        return f"vertex {i // 3} {'xyz'[i % 3]}" if self._of_vertices else f"entry {i}"


def check_derivatives(f, x, length=None, tolerance=1e-6, fixed=None) -> DerivativeReport:
    """Compares gradient and Hessian of an Energy or an Objective at x with central differences.

    x: positions, (n, 3) [m], or the point of an objective; perturb the rest shape, where many derivatives vanish.
    length: unit of the steps, by default a tenth of the size of x. fixed: mask of entries that are no variables.

    >>> aspic.check_derivatives(aspic.test_function("rosenbrock"), [-1.2, 1])
    gradient: smallest relative error ..., order 2.0: correct
    hessian : smallest relative error ..., order ...: correct
    """
    _aspic.require_bounded(np.asarray(x), "x")
    x = np.array(x, float)
    flat = x.ravel()
    if length is None:
        length = 0.1 * float(np.ptp(x, axis=0).max()) if x.ndim == 2 and len(x) > 1 else 1.0
    value, gradient, product = _functions(f, x.shape)
    mask = None if fixed is None else np.broadcast_to(np.asarray(fixed, bool).reshape(
        np.shape(fixed) + (1,) * (x.ndim - np.ndim(fixed))), x.shape).ravel()
    checks = _aspic.check_derivatives(value, gradient, product, flat, length or 1.0, tolerance, mask)
    return DerivativeReport(*checks, of_vertices=x.ndim == 2 and x.shape[1] == 3)


def _functions(f, shape):
    if isinstance(f, _aspic.Objective):
        return (lambda v: f(v.reshape(shape)), lambda v: f.gradient(v.reshape(shape)).ravel(),
                lambda v, d: (f.hessian(v.reshape(shape), "exact") @ d.reshape(shape)).ravel())
    if not hasattr(f, "elements"):
        def product(v, d):
            H = f.hessian(v.reshape(shape))
            return np.asarray(H @ d).ravel()
        return (lambda v: float(f.value(v.reshape(shape))), lambda v: np.asarray(f.gradient(v.reshape(shape))).ravel(),
                product)
    elements = np.asarray(f.elements)

    def scatter(values):
        total = np.zeros(shape)
        np.add.at(total, elements, values)
        return total.ravel()

    def gather(v):
        return v.reshape(shape)[elements]

    return (lambda v: float(np.sum(f.value(gather(v)))), lambda v: scatter(f.gradient(gather(v))),
            lambda v, d: scatter(np.einsum("eaibj,ebj->eai", f.hessian(gather(v)), gather(d))))

"""Stress of a homogeneously deformed cube."""
import math

import numpy as np

from .. import _aspic

DEFORMATIONS = ("uniaxial", "equibiaxial", "planar", "simple_shear")


class _Kinematics:
    """Deformation gradients of the points of a curve, for transverse stretches t."""

    def __init__(self, deformation, stretch):
        self.deformation, self.l = deformation, np.asarray(stretch, float)
        self.has_free_faces = deformation != "simple_shear"
        self.free = 1 if deformation == "uniaxial" else 2
        self.entry = (0, 0) if self.has_free_faces else (0, 1)

    def isochoric(self):
        return {"uniaxial": self.l**-0.5, "equibiaxial": self.l**-2.0, "planar": 1 / self.l}.get(self.deformation, self.l)

    def F(self, t):
        F = np.tile(np.eye(3), (len(self.l), 1, 1))
        F[:, *self.entry] = self.l
        if self.deformation == "equibiaxial":
            F[:, 1, 1] = self.l
        if self.has_free_faces:
            F[:, range(self.free, 3), range(self.free, 3)] = t[:, None]
        return F

    def rate(self):
        """dF/dt."""
        axes = range(self.free, 3) if self.has_free_faces else ()
        return np.tile(np.diag([float(i in axes) for i in range(3)]), (len(self.l), 1, 1))


def nominal_stress(material, theta, deformation, stretch, incompressible=True):
    """Stresses (n,) [Pa] and their derivatives (n, parameters) with respect to mu, lambda and the material's own parameters;
    None if no transverse stretch frees the faces. `incompressible`: the limit of an infinite bulk modulus, with J = 1."""
    body = _Kinematics(deformation, stretch)
    relaxes = body.has_free_faces and not incompressible
    t = _free_stretch(material, theta, body) if relaxes else body.isochoric()
    if t is None:
        return None
    P, along, slopes = _aspic.material_stress(material, theta, body.F(t), body.rate())
    entry, free = (..., *body.entry), (..., body.free, body.free)
    # The incompressible body has the stress P - p cof F; on diagonals cof_11 / cof_tt = t / l.
    ratio = t / body.l if incompressible and body.has_free_faces else 0.0
    stress, slopes_of = P[entry] - ratio * P[free], slopes[entry] - ratio * slopes[free]
    if relaxes:
        slopes_of -= along[entry] * slopes[free] / along[free]  # dt/dtheta = -P_tt,theta / P_tt,t
    found = np.isfinite(stress).all() and np.isfinite(slopes_of).all()
    return (stress, slopes_of.T) if found else None


def _free_stretch(material, theta, body, most=100, largest_step=0.3, tolerance=1e-13, largest=1e12):
    """Solves for ln t with traction-free faces by Newton's method with short steps. Uses t P_tt, which keeps the sign of the
    traction and is bounded as t -> 0."""
    t, free = body.isochoric(), (slice(None), body.free, body.free)
    for _ in range(most):
        P, along, _ = _aspic.material_stress(material, theta, body.F(t), t[:, None, None] * body.rate())
        traction, rate = P[free], P[free] + along[free]  # rate: derivative of t P_tt / t by ln t
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(rate > 0, -traction / rate, -np.copysign(largest_step, traction))
        if not np.isfinite(step).all():
            return None
        step = np.clip(step, -largest_step, largest_step)
        t = t * np.exp(step)
        if (np.abs(np.log(t)) > math.log(largest)).any():
            return None
        if (np.abs(step) <= tolerance).all():
            return t
    return None

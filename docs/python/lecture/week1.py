"""A solution of week 1: the St. Venant-Kirchhoff material in Body, and dV/dq checked by differences."""
import numpy as np
from finite_elements import Body, X, edges, la, mu, q, tets


class StVenantKirchhoff(Body):
    def strain(self, q):
        F = edges(q, self.tets) @ self.inverse
        return F, (F.swapaxes(1, 2) @ F - np.eye(3)) / 2

    def V(self, q):
        """psi = mu |G|^2 + la/2 (tr G)^2 with Green's strain G = (F'F - I)/2."""
        G = self.strain(q)[1]
        return self.volume @ (mu * (G**2).sum(axis=(1, 2)) + la / 2 * np.trace(G, axis1=1, axis2=2)**2)

    def gradient(self, q):
        F, G = self.strain(q)
        P = F @ (2 * mu * G + la * np.trace(G, axis1=1, axis2=2)[:, None, None] * np.eye(3))
        g = np.zeros_like(q)
        np.add.at(g, self.tets, self.slopes @ P.swapaxes(1, 2) * self.volume[:, None, None])
        return g


body, d = StVenantKirchhoff(X, tets), np.sin(np.arange(q.size)).reshape(q.shape)
slope, errors = (body.gradient(q) * d).sum(), []
print(f"V = {body.V(q):.3f} J")
for h in (1e-4, 1e-5, 1e-6):
    errors.append(abs((body.V(q + h * d) - body.V(q - h * d)) / (2 * h * slope) - 1))
    print(f"h = {h:.0e}: dV/dq and the difference of V differ by {errors[-1]:.1e}")  # falls like h^2 if dV/dq is right

"""A solution of week 2: energy that an oscillator q'' = -q keeps in one period with h = 0.1, for three integrators.

The page docs/integrators.md states the same numbers: a factor 1 + h^2 per step for forward Euler, its inverse for backward.
"""
import numpy as np

h, periods = 0.1, 100


def forward_euler(q, v):
    return q + h * v, v - h * q


def symplectic_euler(q, v):
    v = v - h * q
    return q + h * v, v


def backward_euler(q, v):
    """Solves q_new = q + h v_new, v_new = v - h q_new."""
    v = (v - h * q) / (1 + h**2)
    return q + h * v, v


def energy_kept(step):
    """Over many periods, because one is no whole number of steps."""
    q, v = 1.0, 0.0
    for _ in range(round(periods * 2 * np.pi / h)):
        q, v = step(q, v)
    return (q**2 + v**2)**(1 / periods)


kept = {step.__name__: energy_kept(step) for step in (forward_euler, symplectic_euler, backward_euler)}
print("; ".join(f"{name} {value:.4f}" for name, value in kept.items()))

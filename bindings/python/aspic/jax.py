"""Equilibria and motions as differentiable functions of jax, also inside jit. Use jax_enable_x64 for double precision."""
import functools

import jax
import numpy as np


def _call(f, like, *arrays):
    """f(*arrays) by the host, with the shapes and dtypes of `like`."""
    like = jax.tree_util.tree_map(lambda one: jax.ShapeDtypeStruct(one.shape, one.dtype), like)

    def host(*values):
        results = f(*(np.asarray(value, float) for value in values))
        return jax.tree_util.tree_map(lambda result, one: np.asarray(result, one.dtype), results, like)

    return jax.pure_callback(host, like, *arrays)


@functools.partial(jax.custom_vjp, nondiff_argnums=(0,))
def equilibrium(equilibrium, parameters):
    """Positions at rest, (n, 3), of an aspic.Equilibrium as a function of its parameters, an array (m, p)."""
    return _call(equilibrium.solve, jax.ShapeDtypeStruct(equilibrium.shape, parameters.dtype), parameters)


def _equilibrium_gradient(equilibrium, parameters, qbar):
    def gradient(parameters, qbar):
        equilibrium.solve(parameters)  # another solve may have moved it
        return equilibrium.vjp(qbar)

    return (_call(gradient, parameters, parameters, qbar),)


equilibrium.defvjp(lambda core, parameters: (equilibrium(core, parameters), parameters), _equilibrium_gradient)


@functools.partial(jax.custom_vjp, nondiff_argnums=(0,))
def trajectory(trajectory, parameters, q, v):
    """The motion, (steps + 1, n, 3), of an aspic.Trajectory as a function of arrays (m, p), (n, 3) and (n, 3)."""
    return _call(trajectory.simulate, jax.ShapeDtypeStruct(trajectory.shape, parameters.dtype), parameters, q, v)


def _trajectory_gradient(trajectory, inputs, qbar):
    def gradient(parameters, q, v, qbar):
        trajectory._set(parameters, q, v)
        found = trajectory.vjp(qbar)
        return tuple(found[key] for key in ("parameters", "q", "v"))

    return _call(gradient, inputs, *inputs, qbar)


trajectory.defvjp(lambda core, *inputs: (trajectory(core, *inputs), inputs), _trajectory_gradient)

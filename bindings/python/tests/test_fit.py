"""Gradients through equilibria and motions, and fits."""
import importlib
import sys
import types

import numpy as np
import pytest
from conftest import make_jelly

import aspic


def differences(f, x, directions):
    """Central differences of a scalar function along directions."""
    return np.array([(f(x + d) - f(x - d)) / 2 for d in directions])


def test_gradient_of_an_equilibrium_is_that_of_differences():
    equilibrium = aspic.Equilibrium(make_jelly(2), tolerance=1e-12)
    theta = equilibrium.parameters
    assert theta.shape == (48, 2)
    np.testing.assert_allclose(theta, np.broadcast_to(aspic.lame(5e3, .4), theta.shape))
    weights = np.random.default_rng(5).standard_normal(equilibrium.solve().shape)
    value, gradient = equilibrium.value_and_gradient(lambda x: (float((weights * x).sum()), weights), theta)
    directions = 1e-3 * theta * np.random.default_rng(6).uniform(-1, 1, (3, *theta.shape))
    found = differences(lambda t: (weights * equilibrium.solve(t)).sum(), theta, directions)
    np.testing.assert_allclose((directions * gradient).sum(axis=(1, 2)), found, rtol=1e-5)
    equilibrium.solve(theta)
    change = equilibrium.jvp(directions[0])
    np.testing.assert_allclose((weights * change).sum(), (directions[0] * gradient).sum(), rtol=1e-8)
    assert value == pytest.approx((weights * equilibrium.solve(theta)).sum())


def test_gradient_of_a_motion_is_that_of_differences():
    trajectory = aspic.Trajectory(make_jelly(2), steps=4, h=.01)
    theta, sim = trajectory.parameters, aspic.Simulation(make_jelly(2))
    q, v = sim.q, sim.v
    target = trajectory.simulate(theta, q, v) + 1e-3
    motion = trajectory.simulate(theta, q, v)
    loss = lambda theta=theta, v=v: .5 * ((trajectory.simulate(theta, q, v) - target)**2).sum()
    gradient = trajectory.vjp(motion - target)

    def objective(point, q, v):
        return .5 * ((q - target[point])**2).sum(), q - target[point]

    value, same = trajectory.value_and_gradient(objective, theta, q, v)
    assert value == pytest.approx(loss())
    np.testing.assert_allclose(same["parameters"], gradient["parameters"], rtol=1e-8, atol=1e-16)
    rng = np.random.default_rng(7)
    along = 1e-3 * theta * rng.uniform(-1, 1, (2, *theta.shape))
    np.testing.assert_allclose((along * gradient["parameters"]).sum(axis=(1, 2)),
                               differences(lambda t: loss(t), theta, along), rtol=1e-4)
    along = np.where(sim.pinned[:, None], 0, 1e-3 * rng.standard_normal((2, *v.shape)))
    np.testing.assert_allclose((along * gradient["v"]).sum(axis=(1, 2)), differences(lambda w: loss(v=w), v, along),
                               rtol=1e-5)
    assert gradient["density"].shape == (48,)


def test_trajectory_is_the_simulation():
    sim = aspic.Simulation(make_jelly(2), h=.01, solver={"tolerance": 1e-9})
    states = np.stack([sim.q, *(sim.q for _ in sim.steps(3))])
    np.testing.assert_allclose(aspic.Trajectory(make_jelly(2), 3, .01).simulate(), states, atol=1e-9)


def test_torch_differentiates_an_equilibrium_and_a_motion():
    torch = pytest.importorskip("torch")
    import aspic.torch
    equilibrium = aspic.Equilibrium(make_jelly(1), tolerance=1e-12)
    scale = torch.tensor(equilibrium.parameters)

    def rest(young):
        return aspic.torch.equilibrium(equilibrium, young[:, None] * scale)

    assert torch.autograd.gradcheck(rest, torch.linspace(.8, 1.2, 6, dtype=torch.float64, requires_grad=True), eps=1e-4,
                                    atol=1e-7, rtol=1e-4)
    trajectory = aspic.Trajectory(make_jelly(1), 2, .01, tolerance=1e-12)
    sim = aspic.Simulation(make_jelly(1))
    q = torch.tensor(sim.q)
    free = torch.tensor(~sim.pinned)[:, None]

    def motion(young, v):
        return aspic.torch.trajectory(trajectory, young[:, None] * scale, q, v * free)[-1] * 1e3

    inputs = (torch.ones(6, dtype=torch.float64, requires_grad=True),
              torch.full((8, 3), .1, dtype=torch.float64, requires_grad=True))
    assert torch.autograd.gradcheck(motion, inputs, eps=1e-3, atol=1e-5, rtol=1e-3)


def test_jax_differentiates_an_equilibrium_and_a_motion():
    jax = pytest.importorskip("jax", reason="jax is not installed (Debian has none); only a stand-in runs the adapter")
    jax.config.update("jax_enable_x64", True)
    from jax.test_util import check_grads

    import aspic.jax
    equilibrium, trajectory, sim = differentiable()
    theta, v = jax.numpy.asarray(equilibrium.parameters), jax.numpy.full((8, 3), .1) * ~sim.pinned[:, None]
    check_grads(jax.jit(lambda s: aspic.jax.equilibrium(equilibrium, s * theta)), (1.,), 1, ["rev"], eps=1e-4, rtol=1e-4)
    check_grads(jax.jit(lambda s, v: aspic.jax.trajectory(trajectory, s * theta, sim.q, v)[-1] * 1e3), (1., v), 1,
                ["rev"], eps=1e-3, rtol=1e-3)


def differentiable():
    return (aspic.Equilibrium(make_jelly(1), tolerance=1e-12), aspic.Trajectory(make_jelly(1), 2, .01, tolerance=1e-12),
            aspic.Simulation(make_jelly(1)))


class StandIn(types.ModuleType):
    """The part of jax that the adapter uses, without tracing. Callbacks must return the shapes and dtypes they state."""

    class ShapeDtypeStruct:
        def __init__(self, shape, dtype):
            self.shape, self.dtype = shape, np.dtype(dtype)

    class tree_util:
        @staticmethod
        def tree_map(f, tree, *trees):
            if isinstance(tree, tuple):
                return tuple(StandIn.tree_util.tree_map(f, *parts) for parts in zip(tree, *trees, strict=True))
            return f(tree, *trees)

    @staticmethod
    def pure_callback(f, result, *arrays):
        def check(one, array):
            assert array.shape == tuple(one.shape) and array.dtype == one.dtype
            return array

        return StandIn.tree_util.tree_map(check, result, f(*arrays))

    class custom_vjp:
        def __init__(self, f, nondiff_argnums):
            assert nondiff_argnums == (0,)
            self.f = f

        def defvjp(self, forward, backward):
            self.forward, self.backward = forward, backward

        def __call__(self, *arguments):
            return self.f(*arguments)


def test_jax_adapter_has_the_gradients_of_differences(monkeypatch):
    monkeypatch.setitem(sys.modules, "jax", StandIn("jax"))
    monkeypatch.delitem(sys.modules, "aspic.jax", raising=False)
    adapter = importlib.import_module("aspic.jax")
    equilibrium, trajectory, sim = differentiable()
    theta, v = equilibrium.parameters, np.where(sim.pinned[:, None], 0, np.full(sim.q.shape, .1))
    rng = np.random.default_rng(8)
    for f, core, inputs in ((adapter.equilibrium, equilibrium, (theta,)),
                            (adapter.trajectory, trajectory, (theta, sim.q, v))):
        result, residuals = f.forward(core, *inputs)
        weights = rng.standard_normal(result.shape)
        f(core, *(1.1 * one for one in inputs))  # moves it
        gradients = f.backward(core, residuals, weights)
        assert [g.shape for g in gradients] == [one.shape for one in inputs]
        for k in {0, len(inputs) - 1}:  # q moves the pins
            along = 1e-3 * inputs[k] * rng.uniform(-1, 1, inputs[k].shape)
            found = differences(lambda x: (weights * f(core, *inputs[:k], x, *inputs[k + 1:])).sum(), inputs[k], [along])
            np.testing.assert_allclose((along * gradients[k]).sum(), found[0], rtol=1e-4)
    assert adapter.equilibrium(equilibrium, theta.astype(np.float32)).dtype == np.float32
    sys.modules.pop("aspic.jax")
    del aspic.jax


def test_fit_recovers_the_modulus_of_a_synthetic_cube(tmp_path):
    scene = aspic.Scene(gravity=(0, 0, 0))
    cube = scene.add({"box": {"upper": [.1, .1, .1], "cells": [4, 4, 4]}}, name="cube",
                     material=aspic.Material(young=2e4, poisson=.4))
    cube.pin("Z < 1e-6")
    aspic.capture(scene, tmp_path / "data", indentations=2, depths=1, markers=40, noise=1e-3, force_noise=1e-3)
    seen = []
    result = aspic.fit(tmp_path / "data", parameters={"young": "uniform", "poisson": "uniform"}, uncertainty=False,
                       cross_validation=False, mesh_errors=False, observe=lambda *it: seen.append(it),
                       out=tmp_path / "material.vtu")
    assert result.quantities["young"]["values"][0] == pytest.approx(2e4, rel=.25)  # on a coarser mesh
    assert seen and (tmp_path / "material.vtu").exists()
    with pytest.raises(aspic.InvalidInput, match="did you mean 'uncertainty'"):
        aspic.fit(tmp_path / "data", uncertanty=False)


def test_parameters_are_checked():
    equilibrium = aspic.Equilibrium(make_jelly(1))
    theta = equilibrium.parameters
    for bad, message in ((theta[:2], "shape"), (-theta, "mu must be positive"), (theta * np.nan, "finite")):
        with pytest.raises(aspic.InvalidInput, match=message):
            equilibrium.solve(bad)
    for poisson in (.5, -1, np.array([.3, .6])):
        with pytest.raises(aspic.InvalidInput, match="less than 0.5"):
            aspic.lame(1e5, poisson)


def test_verification_passes():
    results = aspic.verify("integrators/free_fall")
    assert all(row["passed"] for row in results["integrators/free_fall"])
    with pytest.raises(aspic.InvalidInput, match="there is no check"):
        aspic.verify("nothing")

"""Terms of the potential written in Python."""
import subprocess

import numpy as np
import pytest
from conftest import make_jelly

import aspic


class Floor(aspic.Energy):
    """k/2 y^2 for every vertex below y = height."""
    name = "floor"

    def __init__(self, count, k=500., height=0.):
        self.elements, self.k, self.height, self.calls = np.arange(count)[:, None], k, height, 0

    def depth(self, x):
        return np.minimum(x[:, 0, 1] - self.height, 0)

    def value(self, x):
        self.calls += 1
        return self.k / 2 * self.depth(x)**2

    def gradient(self, x):
        g = np.zeros_like(x)
        g[:, 0, 1] = self.k * self.depth(x)
        return g

    def hessian(self, x):
        H = np.zeros(x.shape + (1, 3))
        H[:, 0, 1, 0, 1] = self.k * (self.depth(x) < 0)
        return H


class Springs(aspic.Energy):
    """k/2 (|a - b| - length)^2, whose Hessian is indefinite when a spring is compressed."""
    name = "springs"

    def __init__(self, pairs, length, k=50.):
        self.elements, self.length, self.k = np.asarray(pairs), np.asarray(length, float), k

    def parts(self, x):
        u = x[:, 1] - x[:, 0]
        r = np.linalg.norm(u, axis=1)
        return r, u / r[:, None]

    def value(self, x):
        return self.k / 2 * (self.parts(x)[0] - self.length)**2

    def gradient(self, x):
        r, n = self.parts(x)
        f = self.k * (r - self.length)[:, None] * n
        return np.stack([-f, f], axis=1)

    def hessian(self, x):
        r, n = self.parts(x)
        nn = n[:, :, None] * n[:, None, :]
        K = self.k * (nn + (1 - self.length / r)[:, None, None] * (np.eye(3) - nn))
        sign = np.array([[1, -1], [-1, 1]])
        return np.einsum("ab,eij->eaibj", sign, K)


class NeoHookean(aspic.TetEnergy):
    """The library's neo_hookean_log, by its energy density alone."""
    name = "mine"
    mu, la = 5e3 / 2.8, 5e3 * .4 / (1.4 * .2)

    def psi(self, F):
        J = np.linalg.det(F)
        return self.mu / 2 * (np.einsum("tij,tij->t", F, F) - 3) - self.mu * np.log(J) + self.la / 2 * np.log(J)**2


class NeoHookeanByHand(NeoHookean):
    def pk1(self, F):
        J, T = np.linalg.det(F), np.linalg.inv(F).transpose(0, 2, 1)
        return self.mu * (F - T) + (self.la * np.log(J))[:, None, None] * T


def falling(energy=None, **values):
    scene = aspic.Scene()
    body = scene.add(aspic.box((.1, .1, .1), (3, 3, 3)), translate=[0, .01, 0],
                     material=aspic.Material("neo_hookean_log", young=5e3, poisson=.4), **values)
    if energy:
        scene.energy(energy(body))
    return scene


def test_floor_in_python_stops_a_fall():
    scene = falling(lambda body: Floor(len(body.vertices)))
    sim = aspic.Simulation(scene, h=.01)
    reports = sim.run(20, check=True)
    lowest = sim.q[:, 1].min()
    free = aspic.Simulation(falling(), h=.01)
    free.run(20)
    assert free.q[:, 1].min() < -.1 < lowest
    assert reports[-1].potential["floor"] > 0
    assert abs(reports["ledger_error"]).max() < 1e-9


@pytest.mark.parametrize("material", [NeoHookean, NeoHookeanByHand])
def test_material_in_python_agrees_with_the_library(material):
    def simulate(scene):
        body = scene.bodies[0]
        body.pin(body.vertices[:, 1] == .1)
        sim = aspic.Simulation(scene, h=.01, solver={"tolerance": 1e-9, "criterion": "absolute"})
        sim.run(5, check=True)
        return sim.q

    ours = simulate(falling(lambda body: material(body.mesh), elastic=False))
    np.testing.assert_allclose(ours, simulate(falling()), atol=1e-7)


def test_derivatives_of_energies_are_checked():
    rng = np.random.default_rng(3)
    mesh = aspic.box((.1, .1, .1), (2, 2, 2))
    x = mesh.vertices + .003 * rng.standard_normal(mesh.vertices.shape)
    assert aspic.check_derivatives(NeoHookeanByHand(mesh), x, tolerance=1e-5)
    assert aspic.check_derivatives(NeoHookean(mesh), x, tolerance=1e-5)
    springs = Springs(mesh.tets[:, :2], .05)
    assert aspic.check_derivatives(springs, x)
    springs.hessian = lambda x: Springs.hessian(springs, x) * np.array([1, 1, 1.02])
    assert not aspic.check_derivatives(springs, x)


def test_negative_eigenvalues_are_modified():
    scene = falling(lambda body: Springs(body.tets[:, :2], .2, 2e3))  # all are compressed
    sim = aspic.Simulation(scene)
    E = sim.objective()
    E.begin_statics(sim.q)
    smallest = {kind: np.linalg.eigvalsh(E.hessian(sim.q, kind).to_scipy().toarray())[0] for kind in
                ("exact", "clamped", "absolute")}
    assert smallest["exact"] < -100
    assert min(smallest["clamped"], smallest["absolute"]) > -1e-6


def test_exception_in_an_energy_leaves_the_last_whole_step():
    class Failing(Floor):
        fails = False

        def gradient(self, x):
            if self.fails:
                raise ZeroDivisionError("mine")
            return super().gradient(x)

    energies = []
    scene = falling(lambda body: energies.append(Failing(len(body.vertices))) or energies[0])
    sim = aspic.Simulation(scene)
    sim.run(2)
    hash_before = sim.state_hash
    energies[0].fails = True
    with pytest.raises(ZeroDivisionError, match="mine"):
        sim.step()
    assert sim.state_hash == hash_before and sim.steps_taken == 2
    energies[0].fails = False
    assert sim.step().step == 3


@pytest.mark.parametrize("method, result, message", [
    ("value", np.zeros(3), r"floor.value: shape \(3,\); expected \(64,\)"),
    ("gradient", np.full((64, 1, 3), np.nan), r"floor.gradient\[0, 0, 0\] = nan; must be finite"),
    ("hessian", np.zeros((64, 1, 3, 1, 3), complex), "floor.hessian: dtype complex128; expected real numbers"),
    ("hessian", "no", "floor.hessian: dtype"),
])
def test_wrong_result_of_an_energy_gets_one_line(method, result, message):
    scene = falling(lambda body: Floor(len(body.vertices)))
    setattr(scene.energies[0], method, lambda x: result)
    with pytest.raises(ValueError, match=message):
        sim = aspic.Simulation(scene)
        sim.objective().hessian(sim.q)
        sim.step()


def test_files_and_the_viewer_refuse_energies_in_python(tmp_path):
    scene = falling(lambda body: Floor(len(body.vertices)))
    for use in (lambda: scene.save(tmp_path), lambda: aspic.view(scene), lambda: aspic.view(aspic.Simulation(scene))):
        with pytest.raises(aspic.InvalidInput, match=r"energies in Python \('floor'\), which neither a file nor the viewer"):
            use()
    scene.energies.clear()
    assert scene.save(tmp_path).exists()


def test_recorded_run_with_energies_in_python_is_not_resumed(program, tmp_path):
    sim = aspic.Simulation(falling(lambda body: Floor(len(body.vertices))), out=tmp_path / "run")
    sim.run(2)
    assert len(sim.results().steps["step"]) == 3
    del sim
    assert (tmp_path / "run/scene.toml").read_text().startswith("# This file lacks the energies")
    result = subprocess.run([program, "run", "--resume", tmp_path / "run"], capture_output=True, text=True)
    assert result.returncode != 0 and "scene.toml" in result.stderr, result.stderr


def test_wrong_elements_get_one_line():
    for elements, message in ((np.array([[0, 64]]), r"elements\[0, 1\] = 64; must be at least 0 and below 64"),
                              (np.array([[3, 3]]), "names a vertex twice"), (np.array([0, 1]), "shape"),
                              (np.array([[0.5]]), "dtype float64; expected integers")):
        floor = Floor(1)
        floor.elements = elements
        with pytest.raises(aspic.InvalidInput, match=message):
            aspic.Simulation(falling(lambda body: floor))


def test_arrays_of_callbacks_may_be_kept():
    kept = []

    class Keeping(Floor):
        def value(self, x):
            kept.append((x, x.copy()))
            return super().value(x)

    aspic.Simulation(falling(lambda body: Keeping(len(body.vertices)))).run(3)
    assert len(kept) > 3
    for x, copy in kept:
        np.testing.assert_array_equal(x, copy)

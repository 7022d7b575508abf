"""Threads, signals, processes and bad input."""
import multiprocessing
import os
import signal
import threading
import time

import numpy as np
import pytest
from conftest import make_jelly

import aspic


def test_step_releases_the_interpreter():
    sim = aspic.Simulation(make_jelly(6))
    thread = threading.Thread(target=sim.run, args=(10,))
    turns = 0
    thread.start()
    while thread.is_alive():
        turns += 1
        time.sleep(1e-3)
    assert turns > 5


def test_two_threads_in_one_simulation_raise():
    sim = aspic.Simulation(make_jelly())
    inside, done = threading.Event(), threading.Event()

    def wait(it):
        inside.set()
        done.wait(20)

    thread = threading.Thread(target=sim.step, args=(wait,))
    thread.start()
    assert inside.wait(20)
    try:
        for use in (sim.step, lambda: sim.q, sim.fields, lambda: setattr(sim, "v", np.zeros_like(sim.rest))):
            with pytest.raises(RuntimeError, match="thread"):
                use()
    finally:
        done.set()
        thread.join()
    assert sim.step().ok


def test_two_threads_in_one_objective_raise():
    class Waiting:
        def value(self, x):
            inside.set()
            done.wait(20)
            return float(x @ x)

        def gradient(self, x):
            return 2 * x

    inside, done = threading.Event(), threading.Event()
    E = aspic._aspic.PythonObjective(Waiting(), np.zeros(2))
    thread = threading.Thread(target=E, args=([1., 2.],))
    thread.start()
    assert inside.wait(20)
    try:
        with pytest.raises(RuntimeError, match="another thread uses this objective"):
            E.gradient([0., 0.])
    finally:
        done.set()
        thread.join()
    assert E([1., 2.]) == 5


def test_step_inside_a_step_raises():
    sim = aspic.Simulation(make_jelly())
    with pytest.raises(RuntimeError, match="inside a step"):
        sim.step(observe=lambda it: sim.step())
    assert sim.steps_taken == 0 and sim.step().ok


def test_two_simulations_run_in_two_threads():
    sims = [aspic.Simulation(make_jelly()) for _ in range(2)]
    threads = [threading.Thread(target=sim.run, args=(5,)) for sim in sims]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    alone = aspic.Simulation(make_jelly())
    alone.run(5)
    assert {sim.state_hash for sim in sims} == {alone.state_hash}


def test_interrupt_leaves_the_last_whole_step():
    sim = aspic.Simulation(make_jelly(6), solver={"tolerance": 0, "max_iterations": 100000, "method": "gradient_descent"},
                           record=False)
    q, times = sim.q, []

    def interrupt():
        time.sleep(.3)
        times.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        for _ in range(1000):
            q = sim.q
            sim.step()
    assert time.monotonic() - times[0] < 5  # 0.02 s on an idle machine
    np.testing.assert_array_equal(sim.q, q)


def state_after(steps):
    sim = aspic.Simulation(make_jelly())
    sim.run(steps)
    return sim.state_hash


def test_processes_of_a_pool_simulate():
    threads = aspic.thread_count()
    aspic.set_thread_count(2)
    try:
        expected = [state_after(n) for n in (1, 2, 3)]  # starts the threads of this process
        with multiprocessing.get_context("fork").Pool(2) as pool:
            assert pool.map_async(state_after, (1, 2, 3)).get(60) == expected
    finally:
        aspic.set_thread_count(threads)


@pytest.mark.parametrize("change, message", [
    (lambda s: s.bodies[0].pin([0, 64]), r"vertices.*64"),
    (lambda s: s.bodies[0].pin(np.zeros(3, bool)), r"mask of shape \(3,\); expected \(64,\)"),
    (lambda s: s.bodies[0].set(material={"young": -1}), "scene.body.jelly.material.young: young = -1; must be > 0"),
    (lambda s: s.bodies[0].set(material={"yung": 1}), "did you mean 'young'"),
    (lambda s: s.bodies[0].set(material={"model": "rubber"}), "unknown name"),
    (lambda s: s.bodies[0].set(velocity=[1, np.nan, 0]), "finite"),
    (lambda s: s.set("time.step", "soon"), "this is a string; expected a number"),
    (lambda s: s.set("solver.method", "newtn"), "did you mean 'newton'"),
    (lambda s: s.add(aspic.box((1, 1, 1), (1, 1, 1)), name="jelly"), "taken"),
    (lambda s: s.add(aspic.box((1, 1, 1), (1, 1, 1)), material={"young": np.ones(5)}), r"shape \(5,\); expected \(6,\)"),
    (lambda s: s.add("no.msh"), "does not exist"),
    (lambda s: s.set("output.vtu", object()), "this is object"),
])
def test_bad_scene_gets_one_line(change, message):
    scene = make_jelly()
    with pytest.raises(ValueError, match=message) as error:
        change(scene)
        aspic.Simulation(scene)
    assert "\n" not in str(error.value)


def test_one_number_holds_for_all_axes_of_a_box():
    np.testing.assert_array_equal(aspic.box(.1, cells=2).vertices, aspic.box((.1,) * 3, (2,) * 3).vertices)
    assert len(aspic.box((.1, .2, .3), 2, origin=1).tets) == 48


@pytest.mark.parametrize("size, cells, message", [
    ((1, 2), 2, r"size: shape \(2,\); expected three numbers, or one"), (1, 2.5, "cells = 2.5: must be integers"),
    (1, 0, "at least 1"), (-1, 2, "each number must be positive"), (np.nan, 2, "size = nan"), ("big", 2, "size = 'big'; expected three numbers"),
    (1, np.inf, "cells = inf"), (1, 10**6, "at most 2e.07"), (None, 2, "size"),
])
def test_bad_boxes_get_one_line(size, cells, message):
    with pytest.raises(aspic.InvalidInput, match=message):
        aspic.box(size, cells)


def test_bad_arrays_get_one_line():
    sim = aspic.Simulation(make_jelly())
    E, q = sim.objective(), sim.q
    hole = q.copy()
    hole[7, 2] = np.inf
    for value, message in ((q[:5], r"x: shape \(5, 3\); expected \(64, 3\)"), (hole, r"x\[7, 2\] = inf; must be finite"),
                           (q.astype(complex), "x: dtype complex128; expected real numbers"), ("q", "x: dtype"),
                           (None, "x: dtype object"), ([[1, 2], [3]], "x: this is list")):
        with pytest.raises(aspic.InvalidInput, match=message):
            E(value)
    with pytest.raises(aspic.InvalidInput, match="tets: dtype float64"):
        aspic.Mesh(q, sim.tets.astype(float))
    with pytest.raises(aspic.InvalidInput, match=r"tets\[0, 0\] = -1"):
        aspic.Mesh(q, sim.tets - sim.tets.min() - 1)


def mangled(rng, array):
    """The array with a random defect, or none."""
    kind = rng.integers(12)
    if kind == 0:
        return array.astype(rng.choice(["complex128", "float32", "int8", "bool", "object", "U5", "float16"]))
    if kind == 1:
        return array[:rng.integers(len(array) + 1)]
    if kind == 2:
        return array.reshape(-1)[::rng.choice([-1, 1, 2])]
    if kind == 3:
        return np.asfortranarray(array)
    if kind == 4:
        return np.broadcast_to(array, (2,) + array.shape)
    if kind == 5:
        things = [None, 3, "text", b"bytes", (), [], {}, 1e400, -0.0]
        return things[rng.integers(len(things))]
    if kind == 6:
        return np.lib.stride_tricks.as_strided(array, array.shape, (0,) * array.ndim)
    if kind == 7:
        return array.astype(float) * rng.choice([0, 1e-300, 1e300, -1])
    if kind == 8:
        return array.byteswap().newbyteorder()
    result = np.array(array)
    flat = result.reshape(-1)
    bad = [np.nan, np.inf, -np.inf, 1e308, -1e308, 0] if result.dtype.kind == "f" else [-1, 2**31 - 1, -2**31, len(flat)]
    for place in rng.integers(flat.size, size=rng.integers(4)):
        flat[place] = rng.choice(bad)
    return result


def test_mangled_arrays_raise_or_work():
    rng = np.random.default_rng(11)
    sim = aspic.Simulation(make_jelly(1), solver={"max_iterations": 3})
    E, mesh, solver = sim.objective(), aspic.box((1, 1, 1), (1, 1, 1)), aspic.LinearSolver()
    E.begin_step(sim.q, sim.v, .01)
    solver.factorize(E.hessian(sim.q, "clamped"))
    snapshot = sim.snapshot()

    def set_state(x):
        sim.restore(snapshot)
        sim.q = x
        sim.step()

    uses = [lambda x: E(x), lambda x: E.gradient(x), lambda x: E.hessian(x, "clamped"),
            lambda x: E.begin_step(x, x, .01), lambda x: E.max_step(sim.q, x), lambda x: solver.solve(x), set_state,
            lambda x: aspic.minimize(E, x, max_iterations=2), lambda x: E.hessian(sim.q) @ x,
            lambda x: aspic.Mesh(x, mesh.tets).check(), lambda x: aspic.check_derivatives(E, x)]
    raised = 0
    for case in range(500):
        if case % 5 == 0:
            use, array = lambda x: aspic.Mesh(mesh.vertices, x).check(), mesh.tets
        else:
            use, array = uses[rng.integers(len(uses))], sim.rest
        try:
            use(mangled(rng, array))
        except (ValueError, np.linalg.LinAlgError) as error:
            raised += 1
            assert str(error) and "\n" not in str(error)
    assert 100 < raised < 450

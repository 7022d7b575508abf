"""Misuse raises an exception: it neither ends the process nor fills the memory nor changes a step."""
import pickle
import resource
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from conftest import ROOT, make_jelly

import aspic
from aspic import _aspic

CLASSES = sorted(name for name, value in vars(_aspic).items() if isinstance(value, type) and value.__module__ == "aspic._aspic"
                 and not issubclass(value, Exception))


class Quadratic:
    """x'x, which calls `nested` with every gradient."""

    def __init__(self, nested=lambda: None):
        self.nested = nested

    def value(self, x):
        return float(x.ravel() @ x.ravel())

    def gradient(self, x):
        self.nested()
        return 2 * x

    def hessian(self, x):
        return 2 * np.eye(x.size)


@pytest.mark.parametrize("name", CLASSES)
def test_objects_without_init_raise(name):
    cls = getattr(_aspic, name)
    empty = cls.__new__(cls)
    for member in dir(cls):
        for arguments in range(0 if member.startswith("__") else 5):
            with pytest.raises((TypeError, RuntimeError)):
                getattr(empty, member)(*[None] * arguments)
    for use in (lambda: empty(np.zeros(3)), lambda: empty @ np.zeros(3), lambda: aspic.minimize(empty, np.zeros(3)),
                lambda: aspic.LinearSolver().factorize(empty), lambda: aspic.Simulation(make_jelly(1)).restore(empty)):
        with pytest.raises((TypeError, RuntimeError, ValueError, AttributeError)):
            use()


@pytest.mark.parametrize("protocol", range(pickle.HIGHEST_PROTOCOL + 1))
def test_pickles_of_every_protocol_raise_or_work(protocol, jelly):
    sim = aspic.Simulation(jelly)
    report, snapshot, E = sim.step(), sim.snapshot(), sim.objective()
    assert pickle.loads(pickle.dumps(report, protocol)).state_hash == report.state_hash
    assert pickle.loads(pickle.dumps(snapshot, protocol)).time == snapshot.time
    for thing in (sim._core, E, E.hessian(sim.q), aspic.LinearSolver(), aspic.test_function("rosenbrock"),
                  aspic.Equilibrium(jelly)._core, aspic.Trajectory(jelly, 1)._core, jelly._source()):
        with pytest.raises(TypeError, match="cannot pickle '.*' object"):
            pickle.dumps(thing, protocol)


@pytest.mark.parametrize("use", [
    lambda: aspic.LinearSolver().factorize(None), lambda: _aspic.Simulation(None), lambda: _aspic.Equilibrium(None, 1e-9),
    lambda: _aspic.Trajectory(None, 1, 0, 1e-9), lambda: _aspic.compare(None, [], 1, 1), lambda: _aspic.capture(None, "", {}),
    lambda: _aspic.compare(make_jelly()._source(), [("newton", None)], 1, 1), lambda: aspic.minimize(None, [1.]),
    lambda: aspic.Simulation(make_jelly(1)).restore(None),
])
def test_none_is_refused(use):
    with pytest.raises((TypeError, ValueError, AttributeError)):
        use()


def test_subclass_without_init_raises():
    class Solver(aspic.LinearSolver):
        def __init__(self):
            self.solve(np.zeros(3))

    with pytest.raises(TypeError, match="was not called"):
        Solver()


def in_thread(function):
    """The exception of the function in another thread, or its result."""
    results = []

    def call():
        try:
            results.append(function())
        except BaseException as error:
            results.append(error)

    thread = threading.Thread(target=call)
    thread.start()
    thread.join()
    return results[0]


LENT = [lambda it: it.E(it.x), lambda it: it.E.gradient(it.x), lambda it: it.E.hessian(it.x), lambda it: it.curve(),
        lambda it: it.E.max_step(it.x, it.d), lambda it: it.slice(3)]


def test_other_threads_cannot_use_an_iteration(jelly):
    errors, kept = [], []

    def observe(it):
        errors.extend(in_thread(lambda use=use: use(it)) for use in LENT)
        for use in LENT:
            use(it)
        kept.append((it, it.E, it.x, it.d))

    aspic.Simulation(jelly).step(observe=observe)
    assert errors and all(isinstance(error, RuntimeError) and "same thread" in str(error) for error in errors)
    it, E, x, d = kept[0]
    for use in (*LENT, lambda _: E(x), lambda _: E.gradient(x), lambda _: E.hessian(x), lambda _: E.max_step(x, d)):
        for error in (in_thread(lambda use=use: use(it)),):
            assert isinstance(error, RuntimeError) and "observer" in str(error)
        with pytest.raises(RuntimeError, match="observer"):
            use(it)


def test_other_threads_cannot_use_the_objective_of_a_method(jelly):
    errors = []

    def direction(E, x, g):
        errors.append(in_thread(lambda: E.hessian(x)))
        return -g

    def line_search(E, x, d, g):
        errors.append(in_thread(lambda: E(x)))
        return aspic.backtrack(E, x, d, g)

    aspic.Simulation(jelly).step(direction=direction, line_search=line_search)
    assert len(errors) > 1 and {type(error) for error in errors} == {RuntimeError}


def test_threads_of_an_observer_change_no_bit(jelly):
    sims = [aspic.Simulation(jelly) for _ in range(2)]
    q, threads = sims[0].q, []

    def observe(it):
        E = it.E

        def evaluate():
            try:
                while True:
                    E.hessian(q * 1.1), E.gradient(q * 1.3)
            except RuntimeError:
                pass

        threads.append(threading.Thread(target=evaluate))
        threads[-1].start()
        time.sleep(.002)

    for _ in range(40):
        assert sims[0].step(observe=observe).state_hash == sims[1].step().state_hash
    for thread in threads:
        thread.join()


def test_observer_may_evaluate_anywhere(jelly):
    sims = [aspic.Simulation(jelly) for _ in range(2)]

    def observe(it):
        for x in (1.1 * it.x, it.x, 0.9 * it.x):
            it.E.hessian(x, "clamped"), it.E.gradient(x), it.E(x), it.E.max_step(x, it.d)
        it.slice(3), it.curve()

    for _ in range(3):
        assert sims[0].step(observe=observe).state_hash == sims[1].step().state_hash


def test_objective_cannot_be_changed_while_it_is_minimized(jelly):
    sim = aspic.Simulation(jelly)
    E, refused = sim.objective(), []
    q = E.begin_step(sim.q, sim.v, .01)

    def observe(it):
        for change in (lambda: E.begin_step(q, q, .01), lambda: E.begin_statics(q), lambda: E.update_lagged(q)):
            with pytest.raises(RuntimeError, match="inside a computation") as error:
                change()
            refused.append(error)

    assert aspic.minimize(E, q, observe=observe).success
    assert refused


def test_motion_cannot_be_changed_while_it_is_computed(jelly):
    trajectory = aspic.Trajectory(jelly, steps=1)
    with pytest.raises(RuntimeError, match="inside a computation"):
        trajectory.value_and_gradient(lambda point, q, v: trajectory.simulate() or 0.)


def nested_minimizations():
    aspic.minimize(Quadratic(nested_minimizations), np.zeros(3) + 1)


def nested_steps(it=None):
    aspic.Simulation(make_jelly(1), record=False).step(observe=nested_steps)


def nested_checks():
    aspic.check_derivatives(Quadratic(nested_checks), np.ones(2))


@pytest.mark.parametrize("recurse", [nested_minimizations, nested_steps, nested_checks])
def test_recursion_is_bounded(recurse):
    with pytest.raises(RecursionError, match="more than 16 levels"):
        recurse()
    size = threading.stack_size(512 * 1024)
    try:
        assert isinstance(in_thread(recurse), RecursionError)
    finally:
        threading.stack_size(size)
    nested = []
    aspic.minimize(Quadratic(lambda: nested.append(aspic.minimize(Quadratic(), np.ones(3)))), np.ones(3))
    assert nested[0].success  # the depth is counted anew


@pytest.fixture
def little_memory():
    """Refuses another 4 GB."""
    limits = resource.getrlimit(resource.RLIMIT_AS)
    with open("/proc/self/statm") as file:
        used = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + 2**32, limits[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, limits)


def huge(value, *shape):
    return np.broadcast_to(value, (10**9, *shape))


class Elements(aspic.Energy):
    elements = huge(0, 4)


BROADCAST = {
    "E": lambda sim, body: sim.objective()(huge(0., 3)),
    "q": lambda sim, body: setattr(sim, "q", huge(0., 3)),
    "vertices": lambda sim, body: aspic.Mesh(huge(0., 3), sim.tets),
    "tets": lambda sim, body: aspic.Mesh(sim.rest, huge(0, 4)),
    "surface": lambda sim, body: aspic.Surface(huge(0., 3), huge(0, 3)).check(),
    "elements": lambda sim, body: aspic.Simulation(with_energy(Elements())),
    "x0": lambda sim, body: aspic.minimize(Quadratic(), huge(0.)),
    "direction": lambda sim, body: sim.step(direction=lambda E, x, g: huge(0., 3)),
    "qbar": lambda sim, body: aspic.Equilibrium(make_jelly(1)).vjp(huge(0., 3)),
    "mask": lambda sim, body: body.pin(huge(True)),
    "selection": lambda sim, body: body.pin(huge(0)),
    "material": lambda sim, body: aspic.Material(young=huge(1.)),
    "values": lambda sim, body: body.set(material={"young": huge(1.)}),
    "velocity": lambda sim, body: body.set(velocity=huge(0., 3)),
    "gravity": lambda sim, body: aspic.Scene(gravity=huge(0.)),
    "override": lambda sim, body: aspic.Scene.load(ROOT / "scenes/cantilever.toml", {"gravity": huge(0.)}),
    "obstacle": lambda sim, body: sim.scene.obstacle(aspic.Surface(huge(0., 3), huge(0, 3))),
    "check": lambda sim, body: aspic.check_derivatives(Quadratic(), huge(0., 3)),
    "box": lambda sim, body: aspic.box(1, huge(2)),
    "picture": lambda sim, body: aspic.plot.body(sim, huge(0.)),
    "start": lambda sim, body: aspic.Trajectory(make_jelly(1), 1).simulate(None, huge(0., 3), huge(0., 3)),
}


def with_energy(energy):
    scene = make_jelly(1)
    scene.energy(energy)
    return scene


@pytest.mark.parametrize("use", BROADCAST.values(), ids=BROADCAST)
def test_broadcast_rows_are_refused(use, little_memory):
    sim = aspic.Simulation(make_jelly(1), record=False)
    with pytest.raises(aspic.InvalidInput, match="shape") as error:
        use(sim, sim.scene.bodies[0])
    assert "\n" not in str(error.value) and len(str(error.value)) < 300


EXIT = """
import sys, threading, time
import numpy as np, aspic
class Spring(aspic.Energy):
    elements = np.array([[0], [1]])
    def value(self, x): return (x**2).sum((1, 2))
    def gradient(self, x): return 2 * x
    def hessian(self, x):
        H = np.zeros((len(x), 1, 3, 1, 3)); H[:, 0, [0, 1, 2], 0, [0, 1, 2]] = 2; return H
scene = aspic.Scene()
scene.add(aspic.box(1, cells=2))
if "energy" in sys.argv: scene.energy(Spring())
def forever(use):
    while True: use()
E = aspic.Simulation(scene, record=False).objective()
sims = [aspic.Simulation(scene, record=False) for _ in range(3)]
uses = {"step": sims[0].step, "energy": sims[1].step, "observe": lambda: sims[2].step(observe=lambda it: time.sleep(.01)),
        "objective": lambda: E.hessian(E.begin_statics(sims[0].rest)), "equilibrium": lambda: aspic.Simulation(scene),
        "fit": lambda: aspic.minimize(E, sims[0].rest, max_iterations=3)}
for name in sys.argv[1:]: threading.Thread(target=forever, args=(uses[name],), daemon=True).start()
time.sleep(.3)
import atexit
atexit.register(lambda: print("after", sims[0].steps_taken >= 0))
print("end")
"""


@pytest.mark.parametrize("names", [["step"], ["energy"], ["observe"], ["objective"], ["equilibrium", "fit"],
                                   ["step", "energy", "observe", "objective"]], ids=" ".join)
def test_program_ends_while_daemon_threads_compute(names):
    for _ in range(3):
        result = subprocess.run([sys.executable, "-c", EXIT, *names], capture_output=True, text=True, timeout=60)
        assert result.returncode == 0 and result.stdout.startswith("end"), result.stderr
        assert not any(word in result.stderr for word in ("after", "terminate", "does not exist"))


def test_exit_does_not_wait_for_sleeping_callbacks():
    code = ("import threading, time, aspic\n"
            "scene = aspic.Scene(); scene.add(aspic.box(1, cells=1)); sim = aspic.Simulation(scene, record=False)\n"
            "threading.Thread(target=lambda: sim.step(observe=lambda it: time.sleep(1000)), daemon=True).start()\n"
            "time.sleep(.3)")
    begin = time.monotonic()
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert result.returncode == 0 and result.stderr == ""
    assert time.monotonic() - begin < 8  # 2 s on an idle machine

"""Scenes in code, steps, states and reports."""
import csv
import gc
import subprocess

import numpy as np
import pytest
from conftest import ROOT, make_jelly

import aspic


def test_programs_of_the_readme_run_as_printed(capsys):
    source = (ROOT / "README.md").read_text()
    first, second = (block.split("```")[0] for block in source.split("```python\n")[1:])
    assert len(first.strip().splitlines()) <= 10
    names = {}
    exec(first, names)
    assert capsys.readouterr().out.count("converged") == 50
    assert "import numpy as np" in second
    exec(second, names)  # continues the first
    assert names["step"] == 19 and np.isfinite(names["q"]).all()


@pytest.mark.parametrize("scene", sorted(p.stem for p in (ROOT / "scenes").glob("*.toml") if p.stem not in ("bunny", "chute")))
def test_hash_equals_that_of_the_command_line(scene, scenes, program, tmp_path):
    path = scenes / f"{scene}.toml"
    off = [word for key in ("vtu", "report", "usd") for word in ("--set", f"output.{key}=false")]
    subprocess.run([program, "run", path, "--steps", "2", "--out", tmp_path / "run", "--quiet", "--allow-unconverged", *off],
                   check=True)
    sim = aspic.Simulation(path, record=False)
    hashes = [report.state_hash for report in sim.steps(2)]
    with open(tmp_path / "run/steps.csv", newline="") as file:
        assert hashes == [row["state_hash"] for row in csv.DictReader(file)][1:]


def test_saved_scene_in_code_has_the_hash_of_the_command_line(program, tmp_path):
    scene = make_jelly(velocity=["Y", 0.1, 0])
    young = np.linspace(4e3, 6e3, len(scene.bodies[0].tets))
    scene.bodies[0].set(material=aspic.Material(young=young, poisson=.4))
    path = scene.save(tmp_path / "saved")
    subprocess.run([program, "run", path, "--steps", "3", "--out", tmp_path / "run", "--quiet"], check=True)
    reports = aspic.Simulation(scene).run(3)
    assert list(aspic.Run(tmp_path / "run").steps["state_hash"][1:]) == list(reports["state_hash"])


def test_values_per_tet_reach_the_model():
    mesh = aspic.box((1, 1, 1), cells=(1, 1, 1))
    young = np.array([1e5, 2e5, 3e5, 4e5, 5e5, 6e5])
    scene = aspic.Scene()
    scene.add(mesh, material=aspic.Material(young=young, poisson=.3))
    np.testing.assert_allclose(aspic.Simulation(scene).fields()["young"], young, rtol=1e-14)


def test_arrays_are_in_the_order_of_the_mesh(jelly):
    sim = aspic.Simulation(jelly)
    mesh = jelly.bodies[0].mesh
    np.testing.assert_array_equal(sim.q, mesh.vertices)
    np.testing.assert_array_equal(sim.tets, mesh.tets)
    np.testing.assert_array_equal(sim.pinned, mesh.vertices[:, 1] == .1)
    sim.step()
    np.testing.assert_array_equal(sim.q[sim.pinned], mesh.vertices[sim.pinned])
    assert sim.mass.sum() == pytest.approx(1000 * 1e-3)


def test_samples_of_curves_are_bounded(jelly):
    refused = []

    def observe(it):
        for sample in (lambda: it.curve(samples=2**31 - 1), lambda: it.curve(samples=1), lambda: it.slice(2**31 - 1)):
            try:
                sample()
            except aspic.InvalidInput as error:
                refused.append(str(error))

    aspic.Simulation(jelly).step(observe=observe)
    assert "samples = 2147483647; must be from 2 to 100000" in refused[0]
    assert len(refused) % 3 == 0


def test_arrays_outlive_the_simulation(jelly):
    sim, observed = aspic.Simulation(jelly), []
    sim.step(observe=lambda it: observed.extend([it.x, it.g, it.trials, it.slice(3)["value"], it]))
    arrays = [sim.q, sim.v, sim.mass, sim.tets, sim.pinned, sim.fields()["cauchy"], *observed[:4]]
    kept = [array.copy() for array in arrays]
    E, snapshot, run = sim.objective(), sim.snapshot(), sim.results()
    q0 = E.begin_step(sim.q, sim.v, .01)
    H, solver = E.hessian(q0, "clamped"), aspic.LinearSolver("cholesky")
    solver.factorize(H)
    g, page = E.gradient(q0), run.steps["status"]
    del sim, E, run
    gc.collect()
    for array, copy in zip(arrays, kept, strict=True):
        np.testing.assert_array_equal(array, copy)
    product = H @ q0
    matrix = H.to_scipy()
    del H
    gc.collect()
    np.testing.assert_allclose((matrix @ q0.ravel()).reshape(q0.shape), product, atol=1e-9 * abs(product).max())
    d = solver.solve(g)
    np.testing.assert_allclose(matrix @ d.ravel(), g.ravel(), atol=1e-9 * abs(g).max())
    assert snapshot.time == pytest.approx(.01) and page[1] == "converged"
    with pytest.raises(RuntimeError, match="over"):
        observed[4].x


def test_restored_snapshot_gives_the_same_bits(jelly):
    sim = aspic.Simulation(jelly)
    sim.run(2)
    snapshot = sim.snapshot()
    first = sim.run(3)["state_hash"]
    sim.restore(snapshot)
    assert list(first) == list(sim.run(3)["state_hash"])


def test_assigned_state_is_simulated(jelly):
    sim = aspic.Simulation(jelly)
    sim.v = np.where(sim.pinned[:, None], 0, [0.3, 0, 0])
    sim.step()
    assert sim.q[:, 0].mean() > jelly.bodies[0].vertices[:, 0].mean() + 1e-3


def test_contact_keeps_a_falling_body_above_the_floor():
    scene = aspic.Scene()
    ball = scene.add(aspic.sphere(.1, .06), material=aspic.Material("neo_hookean_log", young=2e4, poisson=.4),
                     translate=[0, .105, 0], velocity=[0, -1, 0])
    scene.obstacle(plane={}, friction=.5)
    sim = aspic.Simulation(scene, h=.01)
    reports = sim.run(5, check=True)
    assert max(reports["contacts"]) > 0
    assert sim.q[:, 1].min() > 0
    assert ball.name in sim.bodies


def test_failed_step_raises_if_asked(jelly):
    sim = aspic.Simulation(jelly, solver={"max_iterations": 1, "tolerance": 1e-12})
    with pytest.raises(aspic.NotConverged, match="iteration_limit.*remedy"):
        sim.run(3, check=True)


def test_observer_receives_every_iteration(jelly):
    sim, trace = aspic.Simulation(jelly), aspic.Trace(landscape=True, samples=5)
    report = sim.step(observe=trace)
    assert len(trace) >= report.iterations
    assert trace["gradient_norm"][-1] < trace["gradient_norm"][0]
    assert trace.curves[0]["value"].min() < trace["value"][0]
    assert trace.slices[0]["value"].shape == (5, 5)


def test_observer_changes_no_bit(jelly):
    with_observer, without = aspic.Simulation(jelly), aspic.Simulation(jelly)
    assert with_observer.step(observe=lambda it: it.E(it.x)).state_hash == without.step().state_hash


def test_observer_drops_the_step_by_returning_false(jelly):
    sim = aspic.Simulation(jelly)
    q = sim.q
    assert sim.step(observe=lambda it: False).status == "interrupted"
    np.testing.assert_array_equal(sim.q, q)
    assert sim.step().ok


def test_iteration_expires_with_its_observer(jelly):
    kept = []
    aspic.Simulation(jelly).step(observe=kept.append)
    assert kept[0].value is not None
    with pytest.raises(RuntimeError, match="over"):
        kept[0].x
    with pytest.raises(RuntimeError, match="observer"):
        kept[0].E(np.zeros(kept[0].E.shape))


def columns(path):
    return aspic.results._columns(path)


def test_trace_equals_that_of_the_command_line(scenes, program, tmp_path):
    path = scenes / "stretch.toml"
    subprocess.run([program, "run", path, "--steps", "2", "--out", tmp_path / "run", "--quiet", "--trace", "--landscape",
                    "1:1", "--set", "output.vtu=false", "--set", "output.report=false"], check=True)
    sim, trace, first = aspic.Simulation(path, record=False), aspic.Trace(), aspic.Trace(landscape=True)
    sim.step(observe=first)
    sim.step(observe=trace)
    iterations, trials = columns(tmp_path / "run/trace/iterations.csv"), columns(tmp_path / "run/trace/trials.csv")
    for step, mine in ((1, first), (2, trace)):
        rows = iterations["step"] == step
        for name in set(iterations) - {"step", "solve", "iteration"}:
            np.testing.assert_array_equal(mine[name], iterations[name][rows], err_msg=name)
        tried = np.concatenate(mine.trials)
        for i, name in enumerate(("alpha", "value", "bound", "accepted", "by_slope")):
            np.testing.assert_array_equal(tried[:, i], trials[name][trials["step"] == step], err_msg=name)
    for samples, name in ((first.curves[1], "curve"), (first.slices[1], "slice")):
        table = columns(tmp_path / f"run/trace/{name}_1_1.csv")
        assert set(samples) == set(table)
        for column in table:
            np.testing.assert_array_equal(samples[column].ravel(), table[column], err_msg=f"{name} {column}")


def test_compare_equals_that_of_the_command_line(scenes, program, tmp_path):
    path = scenes / "stretch.toml"
    subprocess.run([program, "compare", path, "--methods", "newton,newton:clamped,lbfgs", "--step", "2", "--out",
                    tmp_path], check=True, capture_output=True)
    table = columns(tmp_path / "methods.csv")
    results = aspic.compare(path, ["newton", {"method": "newton", "definiteness": "clamped"}, "lbfgs"], step=2)
    assert list(results) == ["newton", "newton, clamped", "lbfgs"]
    for i, result in enumerate(results.values()):
        assert result["same_minimizer"] and result["report"].ok
        for name in ("excess", "distance"):
            assert result[name] == pytest.approx(table[name][i], rel=1e-9)
        for name in ("iterations", "trials", "objective"):
            assert getattr(result["report"], name) == table[name][i]
        assert len(result["trace"]["index"]) == table["iterations"][i] + 1
        assert result["trace"]["gradient_norm"][-1] == table["gradient_norm"][i]


def test_compare_starts_from_the_settings_of_the_scene(jelly):
    jelly.set("solver.tolerance", 1e-2)
    rough = aspic.compare(jelly, ["newton"])["newton"]["report"].iterations
    jelly.set("solver.tolerance", 1e-10)
    assert aspic.compare(jelly, ["newton"])["newton"]["report"].iterations > rough
    with pytest.raises(aspic.InvalidInput, match="did you mean 'newton'"):
        aspic.compare(jelly, ["newtn"])


def newton_by_hand(E, x, g):
    return -aspic.LinearSolver("cholesky").factorize(E.hessian(x, "clamped")).solve(g)


@pytest.mark.parametrize("method", [{"direction": newton_by_hand}, {"line_search": aspic.backtrack},
                                    {"direction": newton_by_hand, "line_search": aspic.backtrack}])
def test_own_direction_and_line_search_reach_the_minimizer(jelly, method):
    sims = [aspic.Simulation(jelly, h=.01, solver={"tolerance": 1e-10}) for _ in range(2)]
    reports = sims[0].run(4, check=True, **method)
    sims[1].run(4, check=True)
    np.testing.assert_allclose(sims[0].q, sims[1].q, atol=1e-9)
    assert sum(reports["iterations"]) > 0


def test_own_method_serves_one_step_alone(jelly):
    sim, usual, calls = aspic.Simulation(jelly), aspic.Simulation(jelly), []
    start = sim.snapshot()
    sim.step(direction=lambda E, x, g: calls.append(1) or -g)
    count = len(calls)
    assert count > 0
    sim.restore(start)
    assert sim.step().state_hash == usual.step().state_hash
    assert len(calls) == count


def test_own_direction_leaves_pins_in_place(jelly):
    sim = aspic.Simulation(jelly)
    before = sim.q[sim.pinned]
    sim.step(direction=lambda E, x, g: np.where(g == 0, 1., newton_by_hand(E, x, g)))
    np.testing.assert_array_equal(sim.q[sim.pinned], before)


def test_own_line_search_may_find_no_step(jelly):
    report = aspic.Simulation(jelly).step(line_search=lambda E, x, d, g: 0)
    assert report.status == "stuck" and "remedy" in report.explanation


@pytest.mark.parametrize("method, error, message", [
    ({"direction": lambda E, x, g: 1 / 0}, ZeroDivisionError, "division"),
    ({"line_search": lambda E, x, d, g: 1 / 0}, ZeroDivisionError, "division"),
    ({"direction": lambda E, x, g: g[:2]}, aspic.InvalidInput, "search direction: shape"),
    ({"direction": lambda E, x, g: g * np.nan}, aspic.InvalidInput, "search direction.*must be finite"),
    ({"line_search": lambda E, x, d, g: None}, aspic.InvalidInput, "step length of the line search: dtype object"),
    ({"line_search": lambda E, x, d, g: d}, aspic.InvalidInput, r"step length of the line search: shape \(64, 3\)"),
    ({"direction": "newton"}, aspic.InvalidInput, r"direction\(E, x, g\): must be callable"),
])
def test_failure_of_an_own_method_leaves_the_last_whole_step(jelly, method, error, message):
    sim = aspic.Simulation(jelly)
    sim.run(2)
    before = sim.state_hash
    with pytest.raises(error, match=message):
        sim.step(**method)
    assert sim.state_hash == before and sim.steps_taken == 2
    assert sim.step().ok


def test_own_method_needs_a_minimization(jelly):
    sim = aspic.Simulation(jelly, h=1e-4, integrator="symplectic_euler")
    for method in ({"direction": newton_by_hand}, {"line_search": aspic.backtrack}):
        with pytest.raises(aspic.InvalidInput, match="symplectic_euler.*does not minimize"):
            sim.step(**method)
    assert sim.step().ok


def test_loaded_scene_takes_overrides(scenes):
    scene = aspic.Scene.load(scenes / "cantilever.toml", {"time.step": 0.02}).set("material.young", 2e6)
    sim = aspic.Simulation(scene)
    assert sim.h == 0.02
    np.testing.assert_allclose(sim.fields()["young"], 2e6)

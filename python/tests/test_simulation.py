"""Scenes in code, steps, states and reports."""
import csv
import gc
import subprocess

import numpy as np
import pytest
from conftest import ROOT, make_jelly

import aspic


def test_hello_world_of_the_readme_runs():
    source = (ROOT / "README.md").read_text()
    blocks = [block.split("```")[0] for block in source.split("```python\n")[1:]]
    assert len(blocks[0].strip().splitlines()) <= 10
    exec(blocks[0].replace("sim.show()", ""), {})


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
    scene.bodies[0].table["material"]["young"] = scene._material({"young": young}, 0, scene.bodies[0].mesh)["young"]
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


def test_arrays_outlive_the_simulation(jelly):
    sim = aspic.Simulation(jelly)
    sim.step()
    q, fields, H = sim.q, sim.fields(), sim.objective().hessian(sim.q)
    kept = q.copy()
    del sim
    gc.collect()
    np.testing.assert_array_equal(q, kept)
    assert np.isfinite(fields["cauchy"]).all() and np.isfinite(H @ q).all()


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


def test_observer_sees_every_iteration(jelly):
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


def test_compare_finds_the_same_minimizer(jelly):
    results = aspic.compare(jelly, ["newton", {"method": "lbfgs", "preconditioner": "none"}])
    assert all(result["distance"] < 1e-6 for result in results.values())


def test_loaded_scene_takes_overrides(scenes):
    scene = aspic.Scene.load(scenes / "cantilever.toml", {"time.step": 0.02}).set("material.young", 2e6)
    sim = aspic.Simulation(scene)
    assert sim.h == 0.02
    np.testing.assert_allclose(sim.fields()["young"], 2e6)

"""Pictures of traces, comparisons and bodies."""
import numpy as np
import pytest
from conftest import make_jelly

import aspic

pyplot = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(autouse=True)
def close_figures():
    yield
    pyplot.close("all")


def lines_of(ax):
    return {line.get_label(): line.get_ydata() for line in ax.get_lines()}


def test_convergence_draws_traces_and_comparisons(jelly):
    results = aspic.compare(jelly, ["newton", "lbfgs"])
    drawn = lines_of(aspic.plot.convergence(results))
    assert list(drawn) == ["newton", "lbfgs"]
    for name, values in drawn.items():
        np.testing.assert_array_equal(values, results[name]["trace"]["gradient_norm"])
    trace = aspic.Trace()
    aspic.Simulation(jelly).step(observe=trace)
    for single in (trace, results["newton"], results["newton"]["trace"]):
        ax = aspic.plot.convergence(single)
        assert len(ax.get_lines()) == 1 and ax.get_legend() is None
    assert list(lines_of(aspic.plot.convergence({"a": trace, "b": results["lbfgs"]}))) == ["a", "b"]


def test_iterations_and_simulations_are_drawn(jelly):
    axes, sim = [], aspic.Simulation(jelly)

    def observe(it):
        if it.index == 0:
            axes.extend([aspic.plot.line_search(it), aspic.plot.landscape(it)])

    reports = sim.run(2, observe=observe)
    assert "accepted" in lines_of(axes[0]) and axes[1].collections
    drawn = [lines_of(aspic.plot.energies(run))["kinetic"] for run in (reports, sim.results(), sim)]
    np.testing.assert_array_equal(drawn[0], drawn[1][1:])
    np.testing.assert_array_equal(drawn[1], drawn[2])


def test_body_is_drawn_from_anything_with_tets(jelly):
    sim, body = aspic.Simulation(jelly), jelly.bodies[0]
    sim.step()
    stress = sim.fields()["von_mises"]
    for given in ((sim,), (body,), (body.mesh,), (sim.q, sim.tets), (sim, sim.tets)):
        assert aspic.plot.body(*given).collections[0].get_array() is None
    for given in ((sim, stress), (sim, sim.tets, stress), (sim.q, sim.tets, stress), (body, sim.mass)):
        assert len(aspic.plot.body(*given).collections[0].get_array()) == len(body.mesh.triangles)
    first, by_name = (aspic.plot.body(sim, values).collections[0].get_array() for values in (stress, "von_mises"))
    np.testing.assert_array_equal(first, by_name)


@pytest.mark.parametrize("draw, message", [
    (lambda sim: aspic.plot.body(sim.q), "positions need the tets"),
    (lambda sim: aspic.plot.body(sim, "von_misses"), "no field 'von_misses'.*von_mises"),
    (lambda sim: aspic.plot.body(sim, np.ones(5)), r"shape \(5,\).*per tet"),
])
def test_pictures_refuse_what_they_cannot_draw(draw, message):
    with pytest.raises(aspic.InvalidInput, match=message):
        draw(aspic.Simulation(make_jelly(), record=False))
    assert not pyplot.get_fignums()

"""The first steps of a user, for tools/wheel: an installed package simulates and plays."""
import aspic

scene = aspic.Scene(gravity=(0, -9.81, 0))
jelly = scene.add(aspic.box((.1, .1, .1), cells=(4, 4, 4)), name="jelly",
                  material=aspic.Material("neo_hookean", young=5e3, poisson=.4))
jelly.pin(jelly.vertices[:, 1] == .1)
sim = aspic.Simulation(scene, h=0.01)
reports = sim.run(10, check=True)
assert sim.q[0, 1] < -1e-4
assert sim.show()._repr_html_().startswith("<iframe")
with aspic.view(sim, browser=False) as view:
    assert view.address.startswith("http://")
print(f"aspic {aspic.__version__} in {aspic.__file__}: {len(reports)} steps, state {sim.state_hash}")

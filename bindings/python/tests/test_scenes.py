"""Errors are raised where they are made, and changes of scenes and states are never ignored."""
import copy
import gc
import pickle
import warnings

import numpy as np
import pytest
from conftest import ROOT, make_jelly

import aspic

CUBE = aspic.box(.1, 2)


def inverted(cells):
    mesh = aspic.box(.1, cells)
    mesh.tets[0] = mesh.tets[0][[1, 0, 2, 3]]
    return mesh


@pytest.mark.parametrize("make, message", [
    (lambda: aspic.Material("rubber"), "Material.model.*unknown name"),
    (lambda: aspic.Material(young=-1), "Material.young: young = -1; must be > 0"),
    (lambda: aspic.Material(E=1e5), "did you mean 'young'"),
    (lambda: aspic.Material(young=1e5, poisson=[.3, .5]), "poisson = 0.5; must be"),
    (lambda: aspic.Material(young="X +"), "ends too early"),
    (lambda: aspic.Material(young=[1, np.nan]), r"young\[1\] = nan; must be finite"),
    (lambda: aspic.Material(young=[[1, 2]]), r"young: shape \(1, 2\).*one number per tet"),
    (lambda: aspic.Material(young=1, mu=2), "excludes"),
    (lambda: aspic.Mesh(CUBE.vertices, CUBE.tets + 1), r"tets\[42, 3\] = 27; must be .* begin with 0"),
    (lambda: aspic.Mesh(CUBE.vertices, CUBE.tets.astype(float)), r"float64; expected integers, as of tets.astype\(int\)"),
    (lambda: aspic.box((1, -2, 1), 2), "size: -2; each number must be positive"),
    (lambda: aspic.box(1, 0), "cells: 0; each count"),
    (lambda: aspic.sphere(radius=-1, size=.1), "radius = -1; must be positive"),
    (lambda: aspic.Mesh(CUBE.vertices * np.nan, CUBE.tets), "must be finite"),
    (lambda: aspic.Surface(CUBE.vertices, CUBE.triangles + 1), r"triangles.* = 27; must be"),
    (lambda: aspic.Surface(CUBE.vertices, CUBE.tets), r"triangles: shape \(48, 4\)"),
    (lambda: aspic.Scene(tim={}), "did you mean 'time'"),
    (lambda: aspic.Scene(solver={"method": "newtn"}), "did you mean 'newton'"),
    (lambda: aspic.Scene(gravity=-9.81), "three numbers"),
    (lambda: aspic.Scene(body=[]), r"add\(\)"),
    (lambda: aspic.Scene(name=5), "expected a string"),
    (lambda: aspic.Scene.load("no.toml"), "no.toml"),
    (lambda: aspic.Scene.load(ROOT / "scenes/cantilever.toml", {"time.stp": 1}), "did you mean 'step'"),
    (lambda: aspic.Scene().add(inverted(2)), "1 of 48 tets are inverted"),
    (lambda: aspic.Scene().add(inverted(16)), "1 of 24576 tets are inverted"),
    (lambda: aspic.Scene().add("no.msh"), "does not exist"),
    (lambda: aspic.Scene().add(ROOT / "README.md"), "extension"),
    (lambda: aspic.Scene().add({"sphere": {"radius": -1, "size": 1}}), "radius = -1"),
    (lambda: aspic.Scene().add(CUBE.vertices, CUBE.tets), r"mesh: this is ndarray; expected a Mesh\(vertices, tets\)"),
    (lambda: aspic.Scene().add(CUBE, aspic.Material()), "name: this is Material; expected a string; .*material=..."),
    (lambda: aspic.Simulation(ROOT / "scenes/cantilever.toml", h="x"), '^h = "x"; this is a string'),
    (lambda: aspic.Simulation(make_jelly()).run(2.5), "count = 2.5; expected an integer of at least 0"),
    (lambda: aspic.Simulation(make_jelly()).run("3"), "count = '3'; expected"),
    (lambda: aspic.Trajectory(make_jelly(), 0), "steps = 0; expected an integer of at least 1"),
    (lambda: aspic.minimize(abs, [0.]), "f: this is builtin_function_or_method; expected an Objective"),
    (lambda: aspic.Scene().add(CUBE, material="neo_hookean"), "this is str; expected a Material"),
    (lambda: aspic.Scene().add(CUBE, order=2, elastic=False), "elastic = true"),
])
def test_constructors_refuse_errors(make, message):
    with pytest.raises(aspic.InvalidInput, match=message):
        make()


@pytest.mark.parametrize("change, message", [
    (lambda s, b: b.pin([64]), "vertices.*64"),
    (lambda s, b: b.pin("Y > 5"), "selects no vertex"),
    (lambda s, b: b.pin(b.vertices[:3]), r"where: dtype float64, shape \(3, 3\); expected a mask"),
    (lambda s, b: b.pin((b.vertices[:, 1] == 0).astype(int)), r"zeros and ones.*astype\(bool\)"),
    (lambda s, b: b.pin([0], motion={"linear": {"velocity": [1, 0]}}), "velocity"),
    (lambda s, b: b.pin("Y > 0.09", motion={"linear": {"velocity": [1, 0, 0]}}), "different positions"),
    (lambda s, b: b.spring([0], stiffness=-1), "stiffness = -1"),
    (lambda s, b: b.traction("Y > 5", value=[1, 0, 0]), "selects no boundary"),
    (lambda s, b: b.pressure("Y < 1e-9", "a +"), "pressure.0.value"),
    (lambda s, b: b.set(velocity=[1, "W", 0]), "unknown name 'W'"),
    (lambda s, b: b.set(materiel={}), "did you mean 'material'"),
    (lambda s, b: b.set(material=3), "expected a Material"),
    (lambda s, b: b.set(mesh="a.msh"), "keeps its mesh"),
    (lambda s, b: s.add(CUBE, name="jelly"), "taken by another body"),
    (lambda s, b: s.add(CUBE, name="a b"), "letters, digits"),
    (lambda s, b: s.set("time.step", -1), "step = -1"),
    (lambda s, b: s.set("body.jelly.friction", -1), "friction = -1"),
    (lambda s, b: s.set("body.jello.friction", 1), "bodies: jelly"),
    (lambda s, b: s.set("gravity.x", 1), "is no table"),
    (lambda s, b: s.obstacle(), "obstacle needs one of"),
    (lambda s, b: s.obstacle("no.obj"), "no.obj"),
    (lambda s, b: s.contact(friction=-1), "friction = -1"),
    (lambda s, b: s.energy(3), "has no method value"),
    (lambda s, b: s.energy(aspic.Energy()), "elements"),
])
def test_refused_changes_leave_the_scene(change, message):
    scene = make_jelly()
    before = scene._parts()
    with pytest.raises(aspic.InvalidInput, match=message):
        change(scene, scene.bodies[0])
    assert scene._parts() == before
    assert aspic.Simulation(scene, record=False).step().ok


def test_arrays_of_any_layout_give_the_same_mesh():
    v, tets = CUBE.vertices, CUBE.tets
    wide = np.zeros((2 * len(v), 6))
    wide[::2, ::2] = v
    for x in (v.tolist(), np.asfortranarray(v), v.astype(">f8"), wide[::2, ::2]):
        np.testing.assert_array_equal(aspic.Mesh(x, tets).vertices, v)
    for t in (tets.tolist(), np.asfortranarray(tets), *(tets.astype(kind) for kind in ("u1", "u4", "u8", "i8", ">i4"))):
        np.testing.assert_array_equal(aspic.Mesh(v, t).tets, tets)


def test_bodies_in_millimeters_give_a_warning():
    scene = aspic.Scene()
    scene.add(aspic.box(100, 1), material=aspic.Material(young=1e5)).pin([2])
    with pytest.warns(UserWarning, match="its weight crushes it.*are millimeters, set body.body1.scale = 0.001") as found:
        sim = aspic.Simulation(scene, record=False)
    assert found[0].filename == __file__ and found[0].message.args[0] in sim.notes
    scene.bodies[0].set(scale=.001)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        aspic.Simulation(scene, record=False)


def test_springs_may_name_later_bodies():
    scene = make_jelly()
    scene.bodies[0].spring(between=[[0, 26]], to_body="later", stiffness=10)
    with pytest.raises(aspic.InvalidInput, match="stiffness = -1"):
        scene.bodies[0].spring(between=[[0, 26]], to_body="later", stiffness=-1)
    with pytest.raises(aspic.InvalidInput, match="no such body"):
        aspic.Simulation(scene)
    scene.add(CUBE, name="later", translate=[.2, 0, 0])
    assert aspic.Simulation(scene, record=False).step().ok


def test_overrides_of_files_are_checked_at_once(scenes):
    scene = aspic.Scene.load(scenes / "cantilever.toml")
    with pytest.raises(aspic.InvalidInput, match="young = -1"):
        scene.set("material.young", -1)
    assert aspic.Simulation(scene, record=False).fields()["young"].min() > 0


def test_keys_of_bodies_are_set_by_path(jelly):
    jelly.set("body.jelly.material.young", 8e3)
    np.testing.assert_allclose(aspic.Simulation(jelly, record=False).fields()["young"], 8e3)


def test_settings_of_contact_add_up():
    scene = make_jelly().contact(friction=.3).contact(reach=1e-3)
    assert scene.document["contact"] == {"friction": .3, "reach": 1e-3}


@pytest.mark.parametrize("set_attribute, advice", [
    (lambda sim: setattr(sim.scene, "gravity", (0, 0, 0)), r'scene.set\("gravity"'),
    (lambda sim: setattr(sim.scene.bodies[0], "material", aspic.Material()), r"body.set\(material="),
    (lambda sim: setattr(aspic.Material(), "young", 1e5), "a material is constant"),
    (lambda sim: setattr(sim, "gravity", 0), "q and v can be set"),
    (lambda sim: setattr(sim, "scene", aspic.Scene()), "no setter"),
    (lambda sim: setattr(sim.scene.bodies[0].mesh, "vertices", 2 * sim.rest), "mesh of a body is constant"),
    (lambda sim: sim.scene.bodies[0].mesh.repair(), "mesh of a body is constant"),
    (lambda sim: setattr(aspic.Trajectory(sim.scene, 1), "h", .1), "simulate"),
])
def test_attributes_without_effect_raise(set_attribute, advice):
    with pytest.raises(AttributeError, match=advice):
        set_attribute(aspic.Simulation(make_jelly(1), record=False))


def test_own_classes_may_have_attributes():
    class Robot(aspic.Scene):
        def __init__(self):
            super().__init__()
            self.motor = 3

    assert Robot().motor == 3


@pytest.mark.parametrize("name", ["q", "v", "rest", "tets", "mass", "pinned"])
def test_writes_into_copies_raise(name, jelly):
    sim = aspic.Simulation(jelly, record=False)
    with pytest.raises(ValueError, match="read-only"):
        getattr(sim, name)[0] = 1
    with pytest.raises(ValueError, match="read-only"):
        jelly.bodies[0].vertices[0] = 1
    with pytest.raises(TypeError, match="item assignment"):
        aspic.Material().values["young"] = 1


def test_bodies_copy_their_meshes():
    mesh, scene = aspic.box(.1, 1), aspic.Scene()
    for i in range(3):
        scene.add(mesh)
        mesh.vertices[:, 1] += .2
    heights = [body.vertices[:, 1].min() for body in scene.bodies]
    np.testing.assert_allclose(heights, [0, .2, .4])
    np.testing.assert_allclose(aspic.Simulation(scene, record=False).q[::8, 1], heights)


def test_copied_scenes_are_independent():
    scene = make_jelly()
    other = copy.deepcopy(scene)
    sims = [aspic.Simulation(s, record=False) for s in (scene, other)]
    other.bodies[0].set(material=aspic.Material(young=1e6, poisson=.4))
    assert sims[0].step().ok
    with pytest.raises(RuntimeError, match="was changed"):
        sims[1].step()
    del scene, sims
    gc.collect()
    assert aspic.Simulation(other, record=False).step().ok
    with pytest.raises(TypeError, match="pass the path"):
        pickle.dumps(other)


@pytest.mark.parametrize("use", [copy.copy, copy.deepcopy, pickle.dumps])
def test_simulations_are_not_copied(use, jelly):
    with pytest.raises(TypeError, match="restore its snapshot"):
        use(aspic.Simulation(jelly, record=False))


@pytest.mark.parametrize("arguments, message", [
    ({"scene": CUBE}, "this is Mesh; expected a Scene"), ({"scene": None}, "this is NoneType"),
    ({"solver": 3}, "this is int; expected a dict"), ({"solver": "newtn"}, "did you mean 'newton'"),
    ({"h": 0}, "^h = 0; must be > 0"), ({"integrator": "euler"}, "unknown name"),
])
def test_simulations_refuse_bad_arguments(arguments, message):
    with pytest.raises(aspic.InvalidInput, match=message):
        aspic.Simulation(**{"scene": make_jelly(1), **arguments})


def test_solver_may_be_a_method(jelly):
    assert "lbfgs" in aspic.Simulation(jelly, solver="lbfgs", record=False).solver
    assert list(aspic.compare(jelly, "newton")) == ["newton"]


def test_existing_runs_are_kept(jelly, tmp_path):
    aspic.Simulation(jelly, out=tmp_path / "run").run(1)
    with pytest.raises(aspic.InvalidInput, match="already contains a run; overwrite=True replaces it"):
        aspic.Simulation(jelly, out=tmp_path / "run")
    assert aspic.Simulation(jelly, out=tmp_path / "run", overwrite=True).run(1)[0].ok


def test_parts_of_reports_are_reports(jelly):
    reports = aspic.Simulation(jelly, record=False).run(4)
    np.testing.assert_array_equal((reports[:2] + reports[2:])["time"], reports["time"])


def test_materials_are_pickled():
    material = pickle.loads(pickle.dumps(aspic.Material("ogden", young=[1e5, 2e5], poisson=.3)))
    assert material.model == "ogden" and list(material.values["young"]) == [1e5, 2e5]


class Pull(aspic.Energy):
    elements = np.array([[0]])

    def value(self, x):
        return -x[:, 0, 0]

    def gradient(self, x):
        return np.broadcast_to([-1., 0, 0], x.shape)

    def hessian(self, x):
        return np.zeros((len(x), 1, 3, 1, 3))


def change_elements(scene):
    scene.energies[0].elements = np.array([[1]])


@pytest.mark.parametrize("change, name", [
    (lambda s: s.bodies[0].set(material={"young": 1e6}), "body 'jelly': material"),
    (lambda s: s.bodies[0].table["material"].update(young=1e6), "body 'jelly': material"),
    (lambda s: s.bodies[0].pin([0]), "body 'jelly': pin"),
    (lambda s: s.bodies[0].set(name="pudding"), "body 'jelly': name"),
    (lambda s: s.add(CUBE, translate=[1, 0, 0]), "body 'body2': name"),
    (lambda s: s.set("gravity", (0, 0, 0)), "gravity"),
    (lambda s: s.obstacle(plane={"origin": [0, -1, 0]}), "obstacle"),
    (lambda s: s.document.update(time={"step": 1}), "time"),
    (lambda s: s.energy(Pull()), "the energies"),
    (change_elements, "the energies"),
])
def test_changed_scenes_are_not_ignored(change, name):
    scene = make_jelly()
    scene.energy(Pull())
    users = [aspic.Simulation(scene, record=False), aspic.Equilibrium(scene), aspic.Trajectory(scene, 1)]
    uses = [users[0].step, lambda: users[0].run(1), users[0].objective, users[1].solve, users[2].simulate]
    for use in uses:
        use()
    change(scene)
    for use in uses:
        with pytest.raises(RuntimeError, match=f"was changed after.*{name}"):
            use()


def test_changed_file_scene_is_not_ignored(scenes):
    scene = aspic.Scene.load(scenes / "cantilever.toml")
    sim = aspic.Simulation(scene, record=False)
    scene.set("material.young", 1e6)
    with pytest.raises(RuntimeError, match="material.young"):
        sim.step()


def test_equal_settings_are_no_change(jelly):
    sim = aspic.Simulation(jelly, record=False)
    jelly.bodies[0].set(material=aspic.Material("neo_hookean", young=5e3, poisson=.4))
    assert sim.step().ok


def test_simulation_continues_with_a_changed_scene(jelly):
    sim = aspic.Simulation(jelly, record=False)
    sim.run(20)
    sagged = sim.q[:, 1].min()
    jelly.bodies[0].set(material=aspic.Material("neo_hookean", young=1e6, poisson=.4))
    new = aspic.Simulation(jelly, record=False)
    new.restore(sim.snapshot())
    assert new.time == sim.time and new.steps_taken == 20
    new.run(200)
    assert new.q[:, 1].min() > sagged + 1e-3


def test_pins_hold_assigned_positions(jelly):
    sim = aspic.Simulation(jelly, integrator="quasi_static", solver={"tolerance": 1e-10}, record=False)
    sim.run(1)
    held, hanging, shift = sim.pinned, sim.q, np.array([.01, .02, 0])
    sim.q = hanging + np.where(held[:, None], shift, 0)
    for _ in range(2):
        assert sim.step().ok
        np.testing.assert_allclose(sim.q[held], sim.rest[held] + shift, atol=1e-15)
        np.testing.assert_allclose(sim.q, hanging + shift, atol=1e-8)
    assert sim.time == pytest.approx(3 * sim.h)


def test_assigned_motion_of_a_pin_is_its_motion():
    given = make_jelly()
    given.bodies[0].table["pin"][0]["motion"] = {"linear": {"velocity": [.05, 0, 0]}}
    sims = [aspic.Simulation(scene, h=.01, solver={"tolerance": 1e-10}, record=False) for scene in (make_jelly(), given)]
    for _ in range(20):
        q = sims[0].q.copy()
        q[sims[0].pinned, 0] += .0005
        sims[0].q = q
        forces = [sim.step().reactions["jelly.top"] for sim in sims]
        np.testing.assert_allclose(*forces, atol=1e-5)
    np.testing.assert_allclose(sims[0].q, sims[1].q, atol=1e-9)


def test_pins_of_one_axis_hold_that_axis():
    scene = aspic.Scene(gravity=(0, 0, 0))
    body = scene.add(aspic.box(.1, 2), material=aspic.Material(young=1e4, poisson=.3))
    body.pin(body.vertices[:, 1] == 0, axes="y").pin([0])
    sim = aspic.Simulation(scene, h=.1, record=False)
    sim.q = sim.q + np.array([0, .01, 0])
    sim.step()
    np.testing.assert_allclose(sim.q, sim.rest + [0, .01, 0], atol=1e-12)


def moving_scene():
    scene = make_jelly()
    body = scene.bodies[0]
    body.pin(body.vertices[:, 1] == 0, name="grip", motion={"linear": {"velocity": [0, -.1, 0]}})
    return scene


def test_assigned_positions_agree_with_moving_pins():
    sim = aspic.Simulation(moving_scene(), record=False)
    sim.step()
    before = sim.state_hash
    sim.q = sim.q
    sim.v = sim.v
    assert sim.state_hash == before
    grip = sim.rest[:, 1] == 0
    with pytest.raises(aspic.InvalidInput, match=r"q\[0\] = .*'jelly.grip' prescribes \(0, -0.001, 0\)"):
        sim.q = sim.q + np.where(grip[:, None], [.01, 0, 0], 0)
    assert sim.state_hash == before and sim.step().ok


@pytest.mark.parametrize("scene", [make_jelly, moving_scene])
def test_velocities_of_pins_are_refused(scene):
    sim = aspic.Simulation(scene(), record=False)
    sim.step()
    sim.v = 0 * sim.v
    sim.v = np.where(sim.pinned[:, None], sim.v, [.1, 0, 0])
    with pytest.raises(aspic.InvalidInput, match=r"v\[\d+\] = \(0.1, 0, 0\); the pin 'jelly.\w+' prescribes the motion"):
        sim.v = np.full(sim.v.shape, [.1, 0, 0])
    assert sim.step().ok


def test_sheets_of_arrays_files_and_shapes(tmp_path):
    n = 6
    grid = np.stack(np.meshgrid(np.linspace(0, 1, n), [0.], np.linspace(0, 1, n), indexing="ij"), -1).reshape(-1, 3)
    at = np.arange(n * n).reshape(n, n)
    quads = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]], -1).reshape(-1, 4)
    surface = aspic.Surface(grid, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))
    scene = aspic.Scene(time={"step": 0.02, "duration": 0.1}, wind={"velocity": ["1 + t", 0, 0]})
    cloth = scene.add(surface, name="cloth", shell={"thickness": 1e-3}, material={"density": 400.})
    cloth.pin(grid[:, 0] < 0.01)
    scene.add({"disc": {"radius": 0.2, "size": 0.1}}, name="disc", shell={"thickness": 2e-3}, translate=[0, -1, 0])
    sim = scene.simulation() if hasattr(scene, "simulation") else aspic.Simulation(scene)
    assert sim.triangles.shape[1] == 3 and len(sim.tets) == 0
    assert sim.bodies["cloth"]["triangles"] == slice(0, 50, 1)
    assert sim.mass[sim.bodies["cloth"]["vertices"]].sum() == pytest.approx(0.4)
    for _ in range(5):
        assert sim.step().ok
    surface.vertices[:] = 0  # the body has a copy
    with pytest.raises(AttributeError):
        cloth.mesh.vertices = grid
    with pytest.raises(aspic.InvalidInput, match="encloses no volume"):
        aspic.Scene().add({"rectangle": {"width": 1, "height": 1, "size": 0.5}})


def test_sheet_and_rod(tmp_path):
    scene = aspic.Scene(time={"step": 0.01, "duration": 0.03})
    square = aspic.Surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    cloth = scene.add(aspic.sheet(square, 1e-3, moment=1e-5), name="cloth", material={"density": 400.})
    assert cloth.table["shell"] == {"thickness": 1e-3, "moment": 1e-5} and len(cloth.vertices) == 4
    points = [[0, 0, 2], [0.1, 0, 2], [0.2, 1e-17, 2], [0.2, 0.1, 2]]
    scene.add(aspic.rod(points, radius=2e-3), name="cable").pin([0])
    scene.add(aspic.rod(np.array(points) + [0, 0, 1], 2e-3, closed=True, rest="straight"), name="loop")
    scene.add(aspic.rod({"line": {"from": [0, 0, 4], "to": [1, 0, 4], "size": 0.1}}, 2e-3), name="line")
    (tmp_path / "cable.obj").write_text("v 0 0 5\nv 1 0 5\nl 1 2\n")
    scene.add(aspic.rod(tmp_path / "cable.obj", 2e-3), name="file")
    sim = scene.simulation() if hasattr(scene, "simulation") else aspic.Simulation(scene)
    assert (sim.rest[4:8] == points).all() and sim.step().ok
    for mesh, words in ([[0, 0, 0]], "at least 2"), ([[0, 0], [1, 1]], "shape"), ([[0, 0, 0], [np.nan, 0, 0]], "finite"):
        with pytest.raises(aspic.InvalidInput, match=words):
            scene.add(aspic.rod(mesh, 1e-3))
    with pytest.raises(aspic.InvalidInput, match="thickness = -1"):
        scene.add(aspic.sheet(square, -1))
    with pytest.raises(aspic.InvalidInput, match="closed"):
        aspic.rod("cable.obj", 1e-3, closed=True)
    assert len(scene.bodies) == 5

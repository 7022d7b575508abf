"""Recorded runs, frames and the page that plays them."""
import copy
import html
import json
import multiprocessing
import os
import pickle
import re
import subprocess
import sys
import urllib.request

import numpy as np
import pytest
from conftest import make_jelly

import aspic


def test_run_is_read_as_arrays(jelly, tmp_path):
    sim = aspic.Simulation(jelly, out=tmp_path / "run")
    states = [sim.q, *(sim.q for _ in sim.steps(3))]
    run = sim.results()
    np.testing.assert_array_equal(run.positions(), states)
    assert list(run.steps["step"]) == [0, 1, 2, 3]
    assert set(run.steps["status"][1:]) == {"converged"}
    assert run.steps["residual"].dtype == float and run.steps["residual"][-1] > 0
    assert len(run.iterations["step"]) >= 3
    frame = run.frame(2)
    assert frame["cell_fields"]["young"] == pytest.approx(5e3)
    np.testing.assert_array_equal(frame["tets"], sim.tets)
    with pytest.raises(ValueError, match="is writing results into it"):
        aspic.Simulation(jelly, out=tmp_path / "run")
    del sim
    with pytest.raises(ValueError, match="already contains a run"):
        aspic.Simulation(jelly, out=tmp_path / "run")
    aspic.Simulation(jelly, out=tmp_path / "run", overwrite=True)


def write_piece(path, frame, cells):
    """Writes some tets of a frame as a piece in plain text."""
    vertices, corners = np.unique(frame["tets"][cells], return_inverse=True)

    def array(kind, name, values):
        values = np.asarray(values)
        width = values.shape[1] if values.ndim > 1 else 1
        numbers = " ".join(map(repr, values.ravel().tolist()))
        return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{width}" format="ascii">{numbers}</DataArray>'

    point_data = [array("Float64", name, values[vertices]) for name, values in frame["point_fields"].items()]
    cell_data = [array("Float64", name, values[cells]) for name, values in frame["cell_fields"].items()]
    path.write_text(
        '<VTKFile type="UnstructuredGrid" byte_order="LittleEndian"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{len(vertices)}" NumberOfCells="{len(cells)}">'
        f'<Points>{array("Float64", "Points", frame["points"][vertices])}</Points>'
        f'<PointData>{"".join(point_data)}{array("Int32", "vertex", vertices)}</PointData>'
        f'<CellData>{"".join(cell_data)}{array("Int32", "tet", cells)}</CellData>'
        f'<Cells>{array("Int64", "connectivity", corners.ravel())}'
        f'{array("Int64", "offsets", 4 * np.arange(1, len(cells) + 1))}{array("UInt8", "types", np.full(len(cells), 10))}'
        '</Cells></Piece></UnstructuredGrid></VTKFile>')


def test_report_has_every_column_of_its_table(tmp_path):
    scene = aspic.Scene(contact={"friction": .3})
    body = scene.add(aspic.box(.1, cells=2), name="cube", material=aspic.Material(young=1e4, poisson=.3))
    body.pin(body.vertices[:, 1] == .1, name="top", motion={"linear": {"velocity": [.1, 0, 0]}})
    body.traction("Y < 1e-9", value=[10, 0, 0])
    sim = aspic.Simulation(scene, h=.01, out=tmp_path / "run")
    reports = sim.run(2)
    steps = sim.results().steps
    assert {"reaction_cube.top_x", "reaction_moment_cube.top_z", "body_cube_y"} <= set(steps)
    for row, report in enumerate(reports, 1):
        columns = report.to_dict()
        for name in steps:
            assert columns[name] == steps[name][row] or columns[name] == "", name
    np.testing.assert_array_equal(reports["reaction_cube.top_y"], steps["reaction_cube.top_y"][1:])


def test_reactions_balance_the_weight(jelly):
    sim = aspic.Simulation(jelly, h=.01, integrator="quasi_static", solver={"tolerance": 1e-10})
    assert np.isnan(sim.reactions()).all()
    report = sim.step()
    weight = 9.81 * sim.mass.sum()
    force, moment = report.reactions["jelly.top"], report.reaction_moments["jelly.top"]
    np.testing.assert_allclose(force, [0, weight, 0], atol=1e-6 * weight)
    np.testing.assert_allclose(sim.reactions().sum(axis=0), force, atol=1e-12 * weight)
    assert not sim.reactions()[~sim.pinned].any()
    np.testing.assert_allclose(moment, np.cross(sim.q, sim.reactions()).sum(axis=0), atol=1e-12 * weight)


def test_vertices_of_reports_have_numbers_of_the_mesh(program, tmp_path):
    path = make_jelly(5).save(tmp_path / "saved")
    lines = subprocess.run([program, "run", path, "--steps", "2", "--out", tmp_path / "run", "--json"], check=True,
                           capture_output=True, text=True).stdout.splitlines()
    printed = [row["worst_vertex"] for row in map(json.loads, lines) if "worst_vertex" in row]
    reports = aspic.Simulation(path, record=False).run(2)
    assert printed == list(reports["worst_vertex"]) and len(printed) == 2


def test_first_step_that_is_dropped_is_interrupted(jelly):
    assert aspic.Simulation(jelly).step(observe=lambda it: False).to_dict()["status"] == "interrupted"


def continued(snapshot):
    sim = aspic.Simulation(make_jelly(), record=False)
    sim.restore(snapshot)
    return sim.run(2)


@pytest.mark.parametrize("solver", [{}, {"initial_guess": "last_increment"}])
def test_snapshots_and_reports_travel_between_processes(solver):
    sim = aspic.Simulation(make_jelly(), solver=solver, record=False)
    sim.run(3)
    snapshot = sim.snapshot()
    copies = [pickle.loads(pickle.dumps(snapshot)), copy.deepcopy(snapshot), copy.copy(snapshot)]
    hashes = list(sim.run(2)["state_hash"])
    for snapshot_copy in copies:
        sim.restore(snapshot_copy)
        assert list(sim.run(2)["state_hash"]) == hashes
    if solver:
        return
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        reports = pool.apply_async(continued, (snapshot,)).get(60)
    assert [report.state_hash for report in reports] == hashes


def test_pickled_report_is_equal(jelly):
    report = aspic.Simulation(jelly, solver={"max_iterations": 1, "tolerance": 1e-12}).run(2)[-1]
    other = pickle.loads(pickle.dumps(report))
    assert not report.ok and report.explanation and repr(report) == repr(other)
    assert report.to_dict() == other.to_dict()
    for name in [name for name in dir(report) if not name.startswith("__") and not callable(getattr(report, name))]:
        np.testing.assert_equal(getattr(other, name), getattr(report, name), err_msg=name)


def test_exceptions_are_pickled(jelly):
    with pytest.raises(aspic.NotConverged) as raised:
        aspic.Simulation(jelly, solver={"max_iterations": 1, "tolerance": 1e-12}).run(1, check=True)
    other = pickle.loads(pickle.dumps(raised.value))
    assert str(other) == str(raised.value) and other.report.state_hash == raised.value.report.state_hash
    assert str(pickle.loads(pickle.dumps(aspic.InvalidInput("text")))) == "text"


@pytest.mark.parametrize("kind", [aspic.Snapshot, aspic.StepReport])
def test_damaged_pickles_raise(kind):
    for state in ((), (1, 2), {}, {"status": 3}, None, "text", (None,) * 7):
        with pytest.raises((TypeError, ValueError, RuntimeError, KeyError, IndexError)):
            kind.__new__(kind).__setstate__(state)


def test_pieces_of_several_ranks_are_one_frame(jelly, tmp_path):
    sim = aspic.Simulation(jelly, out=tmp_path / "run")
    sim.run(2)
    run, whole = sim.results(), [sim.results().frame(i) for i in range(3)]
    frames = tmp_path / "ranks/frames"
    frames.mkdir(parents=True)
    (tmp_path / "ranks/steps.csv").write_bytes((tmp_path / "run/steps.csv").read_bytes())
    for i, frame in enumerate(whole):
        names = [f"piece_{i:06}_{rank:05}.vtu" for rank in range(3)]
        for rank, name in enumerate(names):
            write_piece(frames / name, frame, np.arange(rank, len(frame["tets"]), 3))
        pieces = "".join(f'<Piece Source="{name}"/>' for name in names)
        (frames / f"body_{i:06}.pvtu").write_text(
            f'<VTKFile type="PUnstructuredGrid"><PUnstructuredGrid>{pieces}</PUnstructuredGrid></VTKFile>')
    pieces = aspic.Run(tmp_path / "ranks")
    np.testing.assert_array_equal(pieces.positions(), run.positions())
    for i, frame in enumerate(whole):
        found = pieces.frame(i)
        np.testing.assert_array_equal(found["tets"], frame["tets"])
        for kind in ("point_fields", "cell_fields"):
            assert set(found[kind]) == set(frame[kind]) and found[kind]
            for name, values in frame[kind].items():
                np.testing.assert_array_equal(found[kind][name], values)
    (frames / "piece_000001_00002.vtu").unlink()
    with pytest.raises(aspic.InvalidInput, match="piece_000001_00002.vtu"):
        pieces.frame(1)


def test_motion_of_the_surface_is_kept_without_a_folder(jelly):
    sim = aspic.Simulation(jelly)
    sim.run(3)
    motion, triangles = sim.results().surface("jelly")
    assert motion.shape == (4, 56, 3) and triangles.max() == 55
    surface = np.unique(jelly.bodies[0].mesh.triangles)
    np.testing.assert_allclose(motion[-1], sim.q[surface], atol=1e-7)


def test_page_plays_in_a_frame_without_a_server(jelly):
    sim = aspic.Simulation(jelly)
    sim.run(3)
    try:
        player = sim.show(height=300)
    except RuntimeError as error:
        if "has no viewer" not in str(error):
            raise
        pytest.skip(str(error))
    frame = player._repr_html_()
    page = html.unescape(re.search('srcdoc="([^"]*)"', frame)[1])
    assert page == player.page and page.lstrip().lower().startswith("<!doctype html")
    assert 'sandbox="allow-scripts"' in frame
    assert not re.search(r"""(src|href)=["']?https?://""", page)


def test_page_continues_after_more_steps(jelly):
    sim = aspic.Simulation(jelly)
    sim.run(2)
    assert len(sim.results().steps["step"]) == 3
    sim.run(2)
    assert len(sim.results().steps["step"]) == 5


def test_nothing_recorded_is_said(jelly):
    sim = aspic.Simulation(jelly, record=False)
    sim.run(1)
    with pytest.raises(RuntimeError, match="nothing is recorded"):
        sim.show()


def test_meshes_survive_files(tmp_path):
    mesh = aspic.torus(.3, .1, .1)
    labels = np.arange(len(mesh.tets)) % 3
    aspic.Mesh(mesh.vertices, mesh.tets, labels).write(tmp_path / "a.msh")
    read = aspic.read_mesh(tmp_path / "a.msh")
    np.testing.assert_array_equal(read.vertices, mesh.vertices)
    np.testing.assert_array_equal(read.tets, mesh.tets)
    np.testing.assert_array_equal(read.region, labels)
    assert not [f for f in read.check() if f["severity"] == "error"]
    assert read.volumes.sum() == pytest.approx(read.quality["total_volume"])


def test_mesh_is_checked_and_repaired():
    mesh = aspic.box((1, 1, 1), (2, 2, 2))
    mesh.tets[0] = mesh.tets[0][[1, 0, 2, 3]]
    assert "inverted_tets" in {f["name"] for f in mesh.check()}
    assert len(mesh.repair()) == 1 and mesh.volumes.min() > 0


def test_live_viewer_serves_the_scene(jelly, program):
    del program  # skips where the command line is not built
    with aspic.view(jelly, browser=False) as view:
        with urllib.request.urlopen(view.address, timeout=20) as page:
            assert b"<!doctype html" in page.read().lower()
        assert f'href="{view.address}"' in view._repr_html_() and "iframe" not in view._repr_html_()
    assert view._process.poll() is not None


def test_live_viewer_in_a_notebook_is_framed_by_its_server_alone(jelly, program, monkeypatch, tmp_path):
    del program
    pytest.importorskip("jupyter_core")
    monkeypatch.setenv("JUPYTER_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("JPY_PARENT_PID", "17")
    monkeypatch.setattr(aspic.live, "in_notebook", lambda: True)
    (tmp_path / "nbserver-17.json").write_text('{"url": "http://localhost:8888/prefix/"}')
    with aspic.view(jelly) as view:
        assert f'<iframe src="{view.address}&settings"' in view._repr_html_()
        with urllib.request.urlopen(view.address, timeout=20) as page:
            assert "frame-ancestors http://localhost:8888;" in page.headers["Content-Security-Policy"]
    (tmp_path / "nbserver-17.json").unlink()
    with aspic.view(jelly) as view:  # as in nbclient: nobody to frame it
        assert "iframe" not in view._repr_html_()
    with pytest.raises(RuntimeError, match="did not start.*--embed everyone: expected a site"):
        aspic.view(jelly, embed="everyone")


def test_live_viewer_ends_with_its_program(jelly, program, tmp_path):
    del program
    path = jelly.save(tmp_path)
    code = f"import aspic; v = aspic.view({str(path)!r}); print(v._process.pid)"
    environment = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY")}
    result = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, timeout=60)
    assert "open this address in a browser: http://127.0.0.1:" in result.stdout, result.stderr
    with pytest.raises(ProcessLookupError):
        os.kill(int(result.stdout.split()[-1]), 0)

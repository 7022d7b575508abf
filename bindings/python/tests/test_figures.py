"""Figures of arrays: what their page holds, and what they refuse."""
import base64
import gzip
import json
import pathlib
import re

import numpy as np
import pytest

import aspic

VERTICES = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0], [9, 9, 9]])  # the last is in no face
TETS = np.array([[0, 1, 2, 3], [1, 3, 2, 4]])  # the second is inverted
NAN = np.full((6, 3), np.nan)


def parts(figure):
    """The header and the arrays of the recording in the page."""
    data = gzip.decompress(base64.b64decode(re.search(r'id="recording">"([^"]+)"', figure.page)[1]))
    length = int.from_bytes(data[:4], "little")
    head, start = json.loads(data[4:4 + length]), 4 + length + -length % 4
    types = {"f32": np.float32, "u32": np.uint32, "u8": np.uint8}
    return head, {a["name"]: np.frombuffer(data, types[a["type"]], a["count"], start + a["at"]) for a in head["arrays"]}


@pytest.fixture
def show(tmp_path):
    return lambda *args, **named: aspic.show(*args, **named, path=tmp_path / "figure.html")


def test_tets_are_shown_by_their_boundary(show):
    head, arrays = parts(show(VERTICES, TETS))
    triangles = arrays["cage.triangles"].reshape(-1, 3)
    corners = arrays["cage.rest"].reshape(-1, 3)[triangles]
    assert triangles.shape == (6, 3) and set(map(tuple, np.sort(triangles))).isdisjoint({(1, 2, 3)})
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
    assert volume == pytest.approx(1 / 2)  # outward triangles
    assert list(arrays["cage.vertex"]) == [0, 1, 2, 3, 4]
    assert head["size"] == [1, 1, 1]


def test_quantities_of_vertices_and_faces_share_a_picture(show):
    scalars = {"a": np.arange(6), "b": np.array([10, -20])}
    head, arrays = parts(show(VERTICES, TETS, scalars=scalars, vectors=VERTICES))
    fields = head["scenes"][0]["fields"]
    assert [(f["label"], f["diverging"]) for f in fields] == [("a", False), ("b", True)]
    assert len(arrays["cage.rest"]) == 3 * 18  # triangles share no corners
    np.testing.assert_array_equal(arrays["field.scalar0"], arrays["cage.vertex"])
    np.testing.assert_array_equal(arrays["field.scalar1"], np.repeat(np.where(arrays["cage.tet"] == 0, 10, -20), 3))
    arrows = arrays["arrows"].reshape(-1, 6)
    np.testing.assert_allclose(arrows[:, 3:], 0.15 * arrows[:, :3], rtol=1e-6)


def test_update_adds_frames(show):
    figure = show(VERTICES, TETS, scalars={"still": VERTICES[:, 0], "moving": VERTICES[:, 1]})
    for i in range(1, 4):
        assert figure.update(vertices=VERTICES * (1 + i), scalars={"moving": np.full(6, 10 * i)}) is figure
    head, arrays = parts(figure)
    assert head["frames"]["step"] == [0, 1, 2, 3] and head["size"] == [4, 4, 4]
    assert arrays["field.scalar0"].dtype == np.float32 and arrays["field.scalar1"].dtype == np.uint8
    np.testing.assert_array_equal(arrays["field.scalar1.range"].reshape(-1, 2)[1:], [[10, 10], [20, 20], [30, 30]])


def test_figure_without_a_path_names_its_file(monkeypatch, capsys):
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    figure = aspic.show(VERTICES, TETS[:, :3])
    path = pathlib.Path(capsys.readouterr().out.split(": ")[1].strip())
    assert path.read_text() == figure.page
    assert figure._repr_html_().startswith("<iframe sandbox=")
    path.unlink()
    path.parent.rmdir()


@pytest.mark.parametrize("arguments, message", [
    ((VERTICES[:, :2], TETS), r"vertices: shape \(6, 2\); expected \(n, 3\)"),
    ((NAN, TETS), r"vertices\[0, 0\] = nan"),
    ((VERTICES * 1e39, TETS), r"vertices\[1, 0\] = 1e\+39"),
    ((VERTICES * 1j, TETS), "vertices: holds complex128; expected real numbers"),
    ((VERTICES, TETS + 3), r"faces\[0, 3\] = 6; the vertices are 0 to 5"),
    ((VERTICES, -TETS), r"faces\[0, 1\] = -1"),
    ((VERTICES, TETS * 1.0), "faces: holds float64"),
    ((VERTICES, []), r"faces: shape \(0,\); expected \(m, 3\), triangles, or \(m, 4\), tets"),
    ((VERTICES, TETS[[0, 0]]), "no boundary"),
    ((VERTICES, TETS, [1, 2, 3]), r"scalars: shape \(3,\); expected \(6,\), one per vertex or \(2,\), one per face"),
    ((VERTICES, TETS, {"a": [1, np.inf]}), r"scalars\['a'\]\[1\] = inf"),
    ((VERTICES, TETS, {"a": ["x", "y"]}), r"scalars\['a'\]: holds <U1"),
    ((VERTICES, TETS, None, VERTICES[:, 0]), r"vectors: shape \(6,\); expected \(6, 3\)"),
    ((np.broadcast_to(0.0, (10**9, 3)), TETS), "vertices"),
])
def test_bad_arrays_are_refused(show, arguments, message):
    with pytest.raises(aspic.InvalidInput, match=message):
        show(*arguments)


def test_updates_that_do_not_fit_are_refused(show):
    figure = show(VERTICES, TETS, scalars={"a": np.zeros(6)})
    for change, message in [({"vertices": VERTICES[:5]}, r"vertices: shape \(5, 3\); expected \(6, 3\)"),
                            ({"scalars": {"b": np.zeros(6)}}, "'b' is new; this figure has"),
                            ({"scalars": {"a": np.zeros(2)}}, "one number per face")]:
        with pytest.raises(aspic.InvalidInput, match=message):
            figure.update(**change)
    assert parts(figure)[0]["frames"]["step"] == [0]

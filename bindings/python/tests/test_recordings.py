"""Recordings of other programs become tables. Their files are written by recording_files.py."""
import csv
import os
import random
import re
import subprocess
import sys
import zipfile

import numpy as np
import pytest
import recording_files as files

from aspic import InvalidInput
from aspic.recordings import read_recording, to_data_set, to_motion

RNG = random.Random(4)
NAMES = ["3", "5", "7", "9"]
REST = {name: tuple(RNG.uniform(-50, 50) for _ in range(3)) for name in NAMES}
FRAMES = [REST] + [{n: tuple(x + RNG.uniform(-3, 3) for x in p) for n, p in REST.items()} for _ in range(3)]
del FRAMES[2]["7"]  # not seen
CASES = "case,frame\npress,2\nhold,3\nrelease,4\n"


def in_m(frames):
    return [{name: tuple(1e-3 * x for x in p) for name, p in frame.items()} for frame in frames]


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def data(tmp_path):
    folder = tmp_path / "pillow"
    folder.mkdir()
    (folder / "capture.toml").write_text("version = 1\n")
    (folder / "cases.csv").write_text(CASES)
    return folder


def write_trc(folder):
    files.write_trc(folder / "walk.trc", NAMES, FRAMES)
    return "walk.trc", 0


def write_c3d(processor, scale):
    def write(folder):
        files.C3dWriter(processor).write(folder / "walk.c3d", NAMES, FRAMES, scale=scale)
        return "walk.c3d", 1e-3 * (0.5 * (scale or 0) + 4e-6)  # rounded [m]
    return write


def write_npz(method):
    def write(folder):
        files.write_npz(folder / "walk.npz", NAMES, [REST] + in_m(FRAMES), method=method)
        return "walk.npz", 1e-18
    return write


def write_correlation(writer):
    def write(folder):
        for f, positions in enumerate(FRAMES):
            positions = {str(i): positions[n] for i, n in enumerate(NAMES, 1) if n in positions}
            writer(folder / f"dic_{f + 8}.txt", ["1", "2", "3", "4"], {str(i): REST[n] for i, n in enumerate(NAMES, 1)}, positions)
        (folder / "capture.toml").write_text('units = { recording = "mm" }\n')
        return "dic_*.txt", 1e-16
    return write


def write_surfaces(extension):
    def write(folder):
        for f, frame in enumerate(in_m(FRAMES)):
            points, markers = [(9.0, 9.0, 9.0), *frame.values()], [-1, *map(int, frame)]
            files.write_ply(folder / f"scan_{f + 8}.ply", points, markers)
            files.write_obj(folder / f"scan_{f + 8}.obj", NAMES, frame)
        return f"scan_*.{extension}", 1e-18
    return write


FORMATS = {"trc": write_trc, **{f"c3d_{p}_{s}": write_c3d(p, s) for p in ("intel", "dec", "mips") for s in (None, 0.004)},
           "npz": write_npz(zipfile.ZIP_STORED), "npz_deflated": write_npz(zipfile.ZIP_DEFLATED),
           "dice": write_correlation(files.write_dice), "pyvale": write_correlation(files.write_pyvale),
           "generic": write_correlation(files.write_generic), "ply": write_surfaces("ply"), "obj": write_surfaces("obj")}


@pytest.mark.parametrize("format", FORMATS)
def test_positions_of_the_cases_are_those_of_the_recording(data, format):
    name, tolerance = FORMATS[format](data)
    notes = to_data_set(data / name, data)
    positions = {(row["case"], row["marker"]): [float(row[a]) for a in "xyz"] for row in rows_of(data / "positions.csv")}
    names = {"dice": ["0", "1", "2", "3"], "pyvale": ["1", "2", "3", "4"], "generic": ["1", "2", "3", "4"]}.get(format, NAMES)
    expected = {(case, names[NAMES.index(n)]): [1e-3 * x for x in p] for case, frame in
                zip(("press", "hold", "release"), FRAMES[1:]) for n, p in frame.items()}
    assert positions.keys() == expected.keys() and ("hold", names[2]) not in positions
    for key, p in expected.items():
        np.testing.assert_allclose(positions[key], p, rtol=1e-15, atol=tolerance)
    rest = {row["marker"]: [float(row[a]) for a in "xyz"] for row in rows_of(data / "markers.csv")}
    assert list(rest) == names
    if "npz" not in format:
        np.testing.assert_allclose(list(rest.values()), [[1e-3 * x for x in p] for p in REST.values()], rtol=1e-15, atol=tolerance)
    assert any("wrote" in note and "11 positions of 4 markers in 3 cases" in note for note in notes)


def test_converted_data_are_read_by_check(data, program_of_fits):
    (data / "cube.toml").write_text('gravity = [0, 0, 0]\n[[body]]\nname = "c"\nshape = { box = { upper = [0.1, 0.1, 0.1], cells = [2, 2, 2] '
                                    '} }\nmaterial = { model = "neo_hookean", young = 3e4, poisson = 0.4 }\n[[body.pin]]\nwhere = "Z < 1e-6"\n')
    run = lambda *arguments: subprocess.run([program_of_fits, *arguments], cwd=data, capture_output=True, text=True, check=True)
    run("capture", "cube.toml", "-o", "made", "--pokes", "1", "--markers", "5", "--tip", "disc:0.02", "--quiet")
    made = data / "made"
    measured = {(r["case"], r["marker"]): r for r in rows_of(made / "positions.csv")}
    names = list(dict.fromkeys(marker for _, marker in measured))
    cases = [row["case"] for row in rows_of(made / "cases.csv")]
    frames = [{m: tuple(1e3 * float(r[a]) for a in "xyz") for (c, m), r in measured.items() if c == case} for case in cases]
    files.write_trc(made / "walk.trc", names, frames)
    (made / "positions.csv").unlink()
    text = (made / "cases.csv").read_text().splitlines()
    (made / "cases.csv").write_text("\n".join([text[0] + ",frame", *(f"{line},{i}" for i, line in enumerate(text[1:], 1))]) + "\n")
    to_data_set(made / "walk.trc", made)
    for row in rows_of(made / "positions.csv"):
        assert [float(row[a]) for a in "xyz"] == pytest.approx([float(measured[row["case"], row["marker"]][a]) for a in "xyz"], rel=1e-15)
    run("check", "made")


def test_times_select_the_nearest_frame_and_complete_cases(data):
    write_trc(data)
    (data / "cases.csv").write_text("case;frame;time\na;;0,024\nb;2;\n")
    (data / "capture.toml").write_text('forces = "load.csv"\n')
    to_data_set(data / "walk.trc", data)
    first = {row["marker"]: row["x"] for row in rows_of(data / "positions.csv") if row["case"] == "a"}
    assert first == {row["marker"]: row["x"] for row in rows_of(data / "positions.csv") if row["case"] == "b"}
    assert (data / "cases.csv").read_text() == "case;frame;time\na;;0,024\nb;2;0.02\n"


def test_table_of_markers_selects_points_and_keeps_its_cells(data):
    write_trc(data)
    (data / "markers.csv").write_text("marker,vertex\n5,17\nnew,3\n9,\n")
    to_data_set(data / "walk.trc", data)
    rows = rows_of(data / "markers.csv")
    assert [(r["marker"], r["vertex"], r["x"] != "") for r in rows] == [("5", "17", True), ("new", "3", False), ("9", "", True)]
    assert {row["marker"] for row in rows_of(data / "positions.csv")} == {"5", "9"}
    with pytest.raises(InvalidInput, match="--force"):
        to_data_set(data / "walk.trc", data)
    (data / "markers.csv").write_text("marker\nleft\n")
    with pytest.raises(InvalidInput, match="has no point 'left', nor any other marker"):
        to_data_set(data / "walk.trc", data, force=True)


def test_units_and_names_of_columns_are_those_of_the_data_set(data):
    write_trc(data)
    (data / "capture.toml").write_text('units = { length = "cm" }\ncolumns = { x = "X", cases = { frame = "Bild" } }\n')
    (data / "cases.csv").write_text("Bild\n2\n")
    to_data_set(data / "walk.trc", data)
    row = rows_of(data / "positions.csv")[0]
    assert row["case"] == "case 1" and float(row["X"]) == pytest.approx(0.1 * FRAMES[1]["3"][0], rel=1e-15)


def test_points_hidden_at_rest_are_no_markers(data):
    write_trc(data)
    notes = to_data_set(data / "walk.trc", data, rest_frame=3)
    assert any("1 points were not seen at rest" in note for note in notes)
    assert [row["marker"] for row in rows_of(data / "markers.csv")] == ["3", "5", "9"]


def test_images_need_the_size_of_a_pixel(data):
    files.write_mudic(data / "image.csv", [(100, 200), (300, 250)], [(101, 200), (300, 252)])
    (data / "cases.csv").write_text("case,frame\na,1\n")
    with pytest.raises(InvalidInput, match="--unit 1e-4"):
        to_data_set(data / "image.csv", data)
    with pytest.raises(InvalidInput, match="deviation = { position"):
        to_data_set(data / "image.csv", data, unit=1e-4)
    (data / "capture.toml").write_text("deviation = { position = 2e-5 }\n")
    to_data_set(data / "image.csv", data, unit=1e-4)
    row = rows_of(data / "positions.csv")[0]
    assert [float(row[c]) for c in ("x", "y", "z", "sd_x")] == pytest.approx([0.0101, 0.02, 0, 2e-5], abs=1e-15)
    assert float(row["sd_z"]) > 1


def test_cases_without_a_frame_are_named(data):
    write_trc(data)
    (data / "cases.csv").write_text("case,frame,time\na,,\nb,99,\nc,,7\nx,1.5,\n")
    with pytest.raises(InvalidInput) as error:
        to_data_set(data / "walk.trc", data)
    lines = str(error.value).split("\n")
    for line, message in zip(lines, ("cases.csv:2: frame and time are blank; one of them selects the frame of ",
                                     "cases.csv:3: frame 99 is not in", "cases.csv:4: time = 7 s is not in",
                                     "cases.csv:5: frame = 1.5 is not a whole number")):
        assert message in line
    assert not (data / "positions.csv").exists()


def test_motion_starts_at_time_zero_without_hidden_markers(tmp_path):
    frames = [{k: v for k, v in FRAMES[0].items() if k != "9"}, *FRAMES[1:]]
    files.write_trc(tmp_path / "late.trc", NAMES, frames)
    text = re.sub(r"(?m)^(\d)\t([\d.]+)\t", lambda m: f"{m[1]}\t{float(m[2]) + 5}\t", (tmp_path / "late.trc").read_text())
    (tmp_path / "late.trc").write_text(text)
    notes = to_motion(tmp_path / "late.trc", tmp_path / "late.csv")
    assert any("is the time 0" in note for note in notes) and any("1 markers were not seen" in note for note in notes)
    rows = rows_of(tmp_path / "late.csv")
    assert [r["marker"] for r in rows] == ["3"] * 4 + ["5"] * 4 + ["7"] * 3
    assert [float(r["time"]) for r in rows[:4]] == pytest.approx([0, 0.02, 0.04, 0.06])
    assert float(rows[1]["y"]) == 1e-3 * FRAMES[1]["3"][1]
    files.write_generic(tmp_path / "dic.csv", NAMES, REST, REST)
    with pytest.raises(InvalidInput, match="has no times"):
        to_motion(tmp_path / "dic.csv", tmp_path / "dic_motion.csv")


HEAD = ("PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n50\t50\t2\t2\tmm\n"
        "Frame#\tTime\tA\t\t\tB\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n")


def read(tmp_path, name, contents):
    (tmp_path / name).write_bytes(contents if isinstance(contents, bytes) else contents.encode())
    return read_recording(tmp_path / name)


def test_blank_nan_and_origin_of_trc_are_not_seen(tmp_path):
    found = read(tmp_path, "a.trc", HEAD + "1\t0\t\t\t\t4\t5\t6\r\n2\t0.02\tNaN\tNaN\tNaN\t0.000\t0.0\t0\r\n3\t0.04\t1\t2\t3\r\n")
    assert np.isnan(found.positions[..., 0]).tolist() == [[True, False], [True, True], [False, True]]
    assert "NumFrames is 2, but the file has 3" in found.notes[0] and "exactly 0 0 0" in found.notes[1]
    spaces = "PathFileType 4 (X/Y/Z) a.trc\nDataRate NumMarkers Units\n50 1 m\nFrame# Time A\nX1 Y1 Z1\n1 0.0 1 2 3\n"
    assert read(tmp_path, "a.trc", spaces).positions[0, 0, 2] == 3


@pytest.mark.parametrize("name, contents, message", [
    ("a.trc", "time,marker\n", "a.trc:1: does not begin with 'PathFileType'"),
    ("a.trc", HEAD, "has no frames"),
    ("a.trc", HEAD + "1\t0\t1\t2\t3\t4\t5", "a.trc:7: has 7 cells; a frame of 2 markers has 8"),
    ("a.trc", HEAD + "1\t0\t1\t2\t3\t4\t5\t6\t7\n", "'7' follows the last marker"),
    ("a.trc", HEAD + "1\t0\t1\t2\tx\t4\t5\t6\n", "a.trc:7: 'x' is not a number"),
    ("a.trc", HEAD + "1\t0\t1\t2\t3\t4\t5\t6\n2\t0\t1\t2\t3\t4\t5\t6\n", "a.trc:8: time = 0 s follows 0 s"),
    ("a.trc", HEAD.replace("2\t2\tmm", "2\t2000000000\tmm"), "a.trc:4: names 2 markers, but NumMarkers is 2000000000"),
    ("a.c3d", "no C3D file at all", "byte 1: is 111; a C3D file has 80 there"),
    ("a.c3d", "", "the file ends before byte 2"),
    ("a.npz", "no archive", "the archive is damaged"),
    ("a.csv", "X,Y,Z,U,V,W\n1,2,3,0,zero,0\n", "a.csv:2: V = 'zero' is not a number"),
    ("a.csv", "X,Y,Z,U,V\n1,2,3,0,0\n", "a.csv:1: is no table of image correlation; for a table of X, Y, Z, U, V, W it lacks W"),
    ("a.csv", "id,X,Y,Z,U,V,W\n7,1,2,3,0,0,0\n7,1,2,3,0,0,0\n", "a.csv:3: the point '7' is there twice"),
    ("a.csv", "X,Y,Z,U,V,W\n", "has no points"),
    ("a.ply", "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n",
     "a.ply: ends after 1 of 2 entries of 'vertex'"),
    ("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nproperty float marker\n"
     "end_header\n1 2 3 0.5\n", "vertex 0 has marker = 0.5"),
    ("a.obj", "v 0 0 zero\n", "a.obj:1: 'v 0 0 zero' is no vertex"),
    ("a.obj", "v 0 0 0\np 5\n", "a.obj:2: a point names vertex 5 of 1"),
])
def test_damage_is_reported_with_its_place(tmp_path, name, contents, message):
    with pytest.raises(InvalidInput, match=re.escape(message)):
        read(tmp_path, name, contents)


def test_archives_refuse_bombs_and_infinite_values(tmp_path, monkeypatch):
    def refused(message, entries, method=zipfile.ZIP_STORED):
        with zipfile.ZipFile(tmp_path / "a.npz", "w", method) as archive:
            for name, data in entries.items():
                archive.writestr(name, data)
        with pytest.raises(InvalidInput, match=re.escape(message)):
            read_recording(tmp_path / "a.npz")

    refused("positions[1, 0, 1] of '0' is infinite", {"positions.npy": files.npy([0, 0, 0, 0, float("inf"), 0], (2, 1, 3))})
    refused("the number of values is", {"positions.npy": files.npy([], (99999999999, 99999999999, 3))})
    refused("the type of the array is '|O'", {"positions.npy": files.npy([], (1, 1, 3)).replace(b"<f8", b"|O ").replace(b"|O '", b"|O' ")})
    refused("is no array of numpy", {"positions.npy": b"text"})
    refused("names has 1 texts, but positions has 2 points",
            {"positions.npy": files.npy([0] * 6, (1, 2, 3)), "names.npy": files.npy_texts(["A"])})
    bomb = files.npy([0] * 3, (1, 1, 3)) + bytes(10**7)
    with zipfile.ZipFile(tmp_path / "a.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("positions.npy", bomb)
    data = (tmp_path / "a.npz").read_bytes()
    size, huge = len(bomb).to_bytes(4, "little"), (2**32 - 2).to_bytes(4, "little")
    (tmp_path / "a.npz").write_bytes(data.replace(size, huge))
    with pytest.raises(InvalidInput, match="claims 4294967294 bytes"):
        read_recording(tmp_path / "a.npz")
    monkeypatch.setattr("aspic.recordings.npz.free_memory", lambda: 1 << 20)
    refused("there is memory for 262144", {"positions.npy": bytes((1 << 26) + 1)}, zipfile.ZIP_DEFLATED)


HOSTILE = r"""
import pathlib, random, resource, signal, sys
from aspic import InvalidInput
from aspic.recordings import read_recording
resource.setrlimit(resource.RLIMIT_DATA, (2 << 30, 2 << 30))
random, folder = random.Random(int(sys.argv[1])), pathlib.Path(sys.argv[2])
originals = sorted(folder.iterdir())
accepted = refused = 0
for i in range(int(sys.argv[3])):
    original = random.choice(originals)
    data = bytearray(original.read_bytes())
    for _ in range(random.choice((1, 1, 2, 4))):
        at, kind = min(random.randrange(len(data)), random.randrange(len(data))), random.random()
        if kind < 0.4: data[at] = random.randrange(256)
        elif kind < 0.55: del data[at + 1:]
        elif kind < 0.7: del data[at:at + random.randrange(1, 9)]
        elif kind < 0.85: data[at:at] = bytes(random.choice(b"0123456789,.-\t\n\"eE#;\xff\0") for _ in range(4))
        else: data[at:at + 4] = b"\xff" * 4
        data = data or bytearray(b"x")
    file = folder / ("damaged" + original.suffix)
    file.write_bytes(data)
    signal.alarm(20)
    try:
        recording = read_recording(file)
        assert recording.positions.shape == (len(recording.numbers), len(recording.names), 3)
        assert len(set(recording.names)) == len(recording.names)
        accepted += 1
    except InvalidInput as error:
        assert str(file.name) in str(error), error
        refused += 1
    file.unlink()
print(accepted, refused)
"""


def test_damaged_files_never_crash_hang_or_exhaust_memory(tmp_path):
    for write in FORMATS.values():
        write(tmp_path)
    (tmp_path / "capture.toml").unlink()
    run = subprocess.run([sys.executable, "-c", HOSTILE, os.environ.get("SEED", "1"), str(tmp_path), os.environ.get("COUNT", "1500")],
                         capture_output=True, text=True, timeout=300)
    assert run.returncode == 0, run.stderr[-2000:]
    accepted, refused = map(int, run.stdout.split())
    assert accepted > 100 and refused > 500


def test_command_prints_errors_and_notes(data):
    write_trc(data)
    run = lambda *arguments: subprocess.run([sys.executable, "-m", "aspic.recordings", *map(str, arguments)], capture_output=True, text=True)
    assert run(data / "none.trc", data).returncode == 2
    assert "none.trc: cannot be read" in run(data / "none.trc", data).stderr
    done = run(data / "walk.trc", data)
    assert done.returncode == 0 and "wrote" in done.stdout
    assert run(data / "walk.trc", data / "walk.csv").returncode == 0
    assert rows_of(data / "walk.csv")[0]["time"] == "0.0"

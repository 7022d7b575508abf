"""The notebooks of docs/python run from top to bottom, and hold no results."""
import html
import importlib.util
import json
import os
import pathlib
import re
import signal
import subprocess
import urllib.request

import pytest
from conftest import ROOT

import aspic

nbclient = pytest.importorskip("nbclient")
nbformat = pytest.importorskip("nbformat")

PACKAGE = pathlib.Path(aspic.__file__).absolute().parents[1]
NOTEBOOKS = sorted((ROOT / "docs/python").glob("*.ipynb"))
RUNNABLE = [path for path in NOTEBOOKS if "torch" not in path.stem or importlib.util.find_spec("torch")]


@pytest.mark.parametrize("path", RUNNABLE, ids=[path.stem for path in RUNNABLE])
def test_notebook_runs(path, tmp_path, monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    monkeypatch.setenv("PYTHONPATH", str(PACKAGE))
    notebook = nbformat.read(path, as_version=4)
    folder = tmp_path / "docs/python"
    folder.mkdir(parents=True)
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    nbclient.NotebookClient(notebook, timeout=600, resources={"metadata": {"path": folder}}).execute()
    if path.stem == "5_contact":
        assert_page_keeps_the_player(notebook)


def assert_page_keeps_the_player(notebook):
    """The notebook as HTML plays the motion of sim.show() without a server or a kernel."""
    page = pytest.importorskip("nbconvert").HTMLExporter().from_notebook_node(notebook)[0]
    frames = re.findall(r'<iframe sandbox="allow-scripts"[^>]* srcdoc="([^"]*)"', page)
    assert len(frames) == 1
    player = html.unescape(frames[0])
    assert player.lstrip().lower().startswith("<!doctype html") and player.rstrip().endswith("</html>")
    assert not re.search(r"""(src|href)=["']?https?://""", player)


@pytest.fixture
def run_script():
    """./run of the same build."""
    if PACKAGE != ROOT / "build/release/python":
        pytest.skip("./run uses build/release")
    return ROOT / "run"


def test_run_script_runs_a_file(run_script, tmp_path):
    (tmp_path / "file.py").write_text("import sys, aspic; print(aspic.__file__, sys.argv[1])")
    result = subprocess.run([run_script, "python", tmp_path / "file.py", "word"], capture_output=True, text=True)
    assert result.stdout.split() == [str(PACKAGE / "aspic/__init__.py"), "word"], result.stderr


def test_run_script_serves_the_notebooks(run_script):
    pytest.importorskip("notebook")
    server = subprocess.Popen([run_script, "notebook", "--no-browser", "--allow-root", "--ip=127.0.0.1"], text=True,
                              stderr=subprocess.PIPE, start_new_session=True)
    try:
        address = next(match for line in server.stderr if (match := re.search(r"(http://\S+)/\?token=(\w+)", line)))
        with urllib.request.urlopen(f"{address[1]}/api/contents?token={address[2]}", timeout=60) as answer:
            listed = {entry["name"] for entry in json.load(answer)["content"]}
        assert {path.name for path in NOTEBOOKS} <= listed
    finally:
        os.killpg(server.pid, signal.SIGTERM)
        server.stderr.close()
        server.wait(60)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=[path.stem for path in NOTEBOOKS])
def test_notebook_holds_no_results(path):
    cells = json.loads(path.read_text())["cells"]
    assert all(not cell.get("outputs") and cell.get("execution_count") is None for cell in cells)

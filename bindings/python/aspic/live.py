"""The live viewer beside a program or in a notebook."""
import atexit
import json
import os
import shutil
import subprocess
import tempfile
import urllib.parse

from . import _aspic
from ._checks import is_path
from .notebook import in_notebook
from .scenes import scene_of

_running = set()


def _program():
    here = os.path.dirname(os.path.abspath(_aspic.__file__))
    near = [os.path.join(here, up, "bin", "aspic") for up in ("../..", "../../../..")]
    return next((path for path in near if os.path.exists(path)), None) or shutil.which("aspic")


def _notebook_site():
    """The site of the notebook server that started this kernel, such as http://localhost:8888; None if there is none."""
    from jupyter_core.paths import jupyter_runtime_dir  # a kernel has it
    for kind in ("jpserver", "nbserver"):
        path = os.path.join(jupyter_runtime_dir(), f"{kind}-{os.environ.get('JPY_PARENT_PID')}.json")
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                url = urllib.parse.urlsplit(json.load(file)["url"])
            return f"{url.scheme}://{url.netloc}"
    return None


class View:
    """A running `aspic view`. `address` opens in a browser of this machine. stop() ends it, as does the program."""

    def __init__(self, path, browser, embed, folder) -> None:
        program = _program()
        if program is None:
            raise RuntimeError("the program `aspic` was not found; put it on the PATH (cmake --install)")
        options = [] if browser else ["--no-browser"]
        if embed:
            options += ["--embed", embed]
        self._folder, self._embed = folder, embed
        with tempfile.TemporaryFile("w+") as errors:
            # A session of its own, so that Ctrl-C interrupts a step in Python and not the viewer.
            self._process = subprocess.Popen([program, "view", os.fspath(path), *options], stdout=subprocess.PIPE,
                                             stderr=errors, text=True, start_new_session=True)
            lines = iter(self._process.stdout.readline, "")
            self.address = next((line.strip() for line in lines if line.startswith("http://")), None)
            if self.address is None:
                self._process.wait()
                errors.seek(0)
                raise RuntimeError("the viewer did not start: " + errors.read().strip())
        self.is_opened = next(lines, "").startswith("opened")
        _running.add(self)

    def _repr_html_(self):
        link = f'<a href="{self.address}" target="_blank">Open the live viewer</a>'
        if not self._embed:
            return link
        return f'<iframe src="{self.address}&settings" style="width: 100%; height: 600px; border: 0"></iframe><br>{link}'

    def __repr__(self):
        return f"<View {self.address}>"

    def stop(self) -> None:
        """Ends the viewer."""
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()
        _running.discard(self)

    def wait(self) -> None:
        """Returns when the viewer has ended. Ctrl-C ends it."""
        try:
            self._process.wait()
        finally:
            self.stop()

    def __enter__(self) -> "View":
        return self

    def __exit__(self, *_):
        self.stop()


@atexit.register
def _stop_all():
    for view in list(_running):
        view.stop()


def view(scene, browser=True, embed=None) -> View:
    """Shows a Scene, a Simulation's scene or a file live, from its start: in a notebook, else in the browser.

    The viewer ends with the program: view(scene).wait() keeps a script alive. browser: open one, outside notebooks; the
    address is printed where none opens. embed: the site of a notebook, by default that of the server that started it;
    only this site may show the viewer. A scene with energies in Python is refused.
    """
    scene = getattr(scene, "scene", scene)
    is_notebook = in_notebook()
    if is_notebook and embed is None:
        embed = _notebook_site()
    folder = path = None
    if not is_path(scene):
        scene = scene_of(scene)
        folder = tempfile.TemporaryDirectory(prefix="aspic-view-")
        path = scene.save(folder.name)
    started = View(path or scene, browser and not is_notebook, embed, folder)
    if browser and not is_notebook and not started.is_opened:
        print("open this address in a browser:", started.address)
    return started

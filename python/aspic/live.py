"""The live viewer beside a program or a notebook."""
import os
import shutil
import subprocess
import tempfile

from . import _aspic
from .scenes import Scene


def _program():
    here = os.path.dirname(os.path.abspath(_aspic.__file__))
    near = [os.path.join(here, up, "bin", "aspic") for up in ("../..", "../../../..")]
    return next((path for path in near if os.path.exists(path)), None) or shutil.which("aspic")


class View:
    """A running `aspic view`. `address` opens in a browser of this machine; stop() ends it, as does the program."""

    def __init__(self, path, browser, folder):
        program = _program()
        if program is None:
            raise RuntimeError("the program `aspic` was not found; put it on the PATH (cmake --install)")
        options = [] if browser else ["--no-browser"]
        self._folder = folder
        self._process = subprocess.Popen([program, "view", path, *options], stdout=subprocess.PIPE, text=True)
        lines = []
        for line in self._process.stdout:
            lines.append(line)
            if line.startswith("http://"):
                self.address = line.strip()
                return
        raise RuntimeError("the viewer did not start: " + "".join(lines).strip())

    def _repr_html_(self):
        return f'<a href="{self.address}" target="_blank">Open the live viewer</a>'

    def __repr__(self):
        return f"<View {self.address}>"

    def stop(self):
        """Ends the viewer."""
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()


def view(scene, browser=True):
    """Shows a Scene, a Simulation's scene or a file live in the browser, from its start. Energies in Python are left out."""
    scene = getattr(scene, "scene", scene)
    if not isinstance(scene, Scene):
        return View(os.fspath(scene), browser, None)
    folder = tempfile.TemporaryDirectory(prefix="aspic-view-")
    return View(scene.save(folder.name), browser, folder)

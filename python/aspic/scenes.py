"""Scenes written in Python or read from TOML. Both pass the same checks, so docs/scene.md describes every key."""
import os
import pathlib
import tempfile

import numpy as np

from . import _aspic
from .meshes import Mesh, Surface


class Material:
    """A material by its name, see materials(). Values are numbers, formulas of X, Y, Z, or arrays with one per tet."""

    def __init__(self, model="neo_hookean", **values):
        self.model, self.values = model, values

    def __repr__(self):
        return f"Material({self.model!r}, " + ", ".join(f"{k}={v!r}" for k, v in self.values.items()) + ")"


def _where(where, count):
    """A selection as a value of `where`: a formula, a table, a mask or a list of vertices."""
    if where is None or isinstance(where, (str, dict)):
        return where
    array = np.asarray(where)
    if array.dtype == bool:
        if array.shape != (count,):
            raise _aspic.InvalidInput(f"where: a mask of shape {array.shape}; expected ({count},), one per vertex")
        array = np.flatnonzero(array)
    return {"vertices": array.ravel()}


class Body:
    """A soft body of a scene. Methods return the body, so that calls can be chained."""

    def __init__(self, scene, mesh, table):
        self._scene, self._mesh, self.table = scene, mesh, table

    @property
    def name(self):
        return self.table["name"]

    @property
    def mesh(self):
        if self._mesh is None:
            raise _aspic.InvalidInput(f"body '{self.name}' has no Mesh: it is read when the simulation is made")
        return self._mesh

    @property
    def vertices(self):
        """Rest positions, (n, 3) [m]."""
        return self.mesh.vertices

    @property
    def tets(self):
        """Vertices of each tet, (m, 4)."""
        return self.mesh.tets

    def _add(self, kind, where, values):
        count = -1 if self._mesh is None else len(self._mesh.vertices)
        self.table.setdefault(kind, []).append({"where": _where(where, count), **values})
        return self

    def pin(self, where, **values):
        """Prescribes positions: keys name, motion, axes, direction."""
        return self._add("pin", where, values)

    def spring(self, where=None, **values):
        """Springs to points, between vertices or along edges: keys stiffness [N/m], target, between, edges, ..."""
        return self._add("spring", where, values)

    def traction(self, where, **values):
        """A dead load on the surface: keys value or dead_pressure [Pa]."""
        return self._add("traction", where, values)

    def pressure(self, where, value):
        """A follower pressure [Pa]."""
        return self._add("pressure", where, {"value": value})

    def force(self, value, where="all"):
        """A dead load per volume [N/m^3]."""
        return self._add("force", where, {"value": value})

    def set(self, **values):
        """Sets any other key of a body: velocity, deform, damping, friction, ..."""
        self.table.update(values)
        return self


class Scene:
    """Bodies, obstacles and settings. Keywords are top-level keys and sections: time={...}, solver={...}, contact={...}."""

    def __init__(self, gravity=(0.0, -9.81, 0.0), name="scene", **sections):
        self.name, self.bodies, self.energies = name, [], []
        self.document = {"gravity": gravity, **sections}
        self._path, self._overrides = None, {}
        self._inputs = None  # folder of the inputs; lives as long as a simulation needs it

    @classmethod
    def load(cls, path, overrides=None):
        """Reads a .toml file, or makes a scene of a mesh. overrides: {"material.young": 2e5, "time.step": 0.005}."""
        scene = cls(name=pathlib.Path(path).stem)
        scene._path, scene._overrides = os.fspath(path), dict(overrides or {})
        return scene

    def __repr__(self):
        what = self._path or ", ".join(body.name for body in self.bodies)
        return f"<Scene {self.name}: {what}>"

    def _require_code(self, what):
        if self._path is not None:
            raise _aspic.InvalidInput(f"{what} is not possible in a scene from a file; override its keys with set()")

    def _file(self, name):
        if self._inputs is None:
            self._inputs = tempfile.TemporaryDirectory(prefix="aspic-")
        return os.path.join(self._inputs.name, name)

    def add(self, mesh, name=None, material=None, **values):
        """Adds a body. mesh: a Mesh, the path of a mesh file, or a dict such as {"sphere": {"radius": 1, "size": 0.2}}."""
        self._require_code("add()")
        table = {"name": name or f"body{len(self.bodies) + 1}", **values}
        if isinstance(mesh, Mesh):
            table["mesh"] = self._file(f"{len(self.bodies)}.msh")
            mesh.write(table["mesh"], binary=True)
        else:
            table["shape" if isinstance(mesh, dict) else "mesh"] = mesh
            mesh = None
        if material is not None:
            table["material"] = self._material(material, len(self.bodies), mesh)
        self.bodies.append(Body(self, mesh, table))
        return self.bodies[-1]

    def _material(self, material, body, mesh):
        table = {"model": material.model, **material.values} if isinstance(material, Material) else dict(material)
        for key, value in table.items():
            if isinstance(value, (np.ndarray, list)) and np.ndim(value) > 0:
                table[key] = {"file": self._field(key, value, body, mesh)}
        return table

    def _field(self, key, values, body, mesh):
        values = np.asarray(values)
        if values.dtype.kind not in "fiu" or not np.isfinite(values).all():
            raise _aspic.InvalidInput(f"material.{key}: must be finite numbers")
        if mesh is not None and values.shape != (len(mesh.tets),):
            raise _aspic.InvalidInput(f"material.{key}: shape {values.shape}; expected ({len(mesh.tets)},), one per tet")
        path = self._file(f"{body}.{key}.csv")
        np.savetxt(path, values.ravel(), fmt="%.17g")
        return path

    def obstacle(self, mesh=None, **values):
        """Adds an obstacle, which switches contact on: plane={}, sphere={...}, capsule={...}, a Mesh or a Surface."""
        self._require_code("obstacle()")
        obstacles = self.document.setdefault("obstacle", [])
        if isinstance(mesh, (Mesh, Surface)):
            path = self._file(f"obstacle{len(obstacles)}.obj")
            _aspic.write_surface(path, mesh.vertices, mesh.triangles)
            values["mesh"] = path
        elif mesh is not None:
            values["mesh"] = mesh
        obstacles.append(values)
        return self

    def contact(self, **values):
        """Switches contact on: keys friction, reach [m], stiffness [Pa], pair, start, ..."""
        self._require_code("contact()")
        self.document["contact"] = values
        return self

    def energy(self, energy):
        """Adds a term of the potential, see Energy. Returns it."""
        self.energies.append(energy)
        return energy

    def set(self, key, value):
        """Overrides a key by its path, as --set does: scene.set("solver.method", "lbfgs")."""
        if self._path is not None:
            self._overrides[key] = value
            return self
        *sections, last = key.split(".")
        table = self.document
        for section in sections:
            table = table.setdefault(section, {})
        table[last] = value
        return self

    def first_vertex(self, body):
        """Number of the body's first vertex in arrays of the whole scene, for elements of an Energy."""
        return sum(len(b.vertices) for b in self.bodies[:self.bodies.index(body)])

    def save(self, folder):
        """Writes scene.toml and its inputs into a folder, for the command line. Returns the path of the file.

        Raises InvalidInput if the scene has energies in Python, which a file cannot hold.
        """
        if self.energies:
            names = ", ".join(f"'{getattr(e, 'name', type(e).__name__)}'" for e in self.energies)
            raise _aspic.InvalidInput(f"the scene has energies in Python ({names}), which neither a file nor the viewer "
                                      "can hold; play a simulation with show(), or remove them from scene.energies")
        folder = pathlib.Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        simulation = _aspic.Simulation(self._source())
        simulation.write_inputs(folder)
        (folder / "scene.toml").write_text(simulation.resolved)
        return folder / "scene.toml"

    def _source(self, overrides=None):
        if self._path is not None:
            merged = {**self._overrides, **(overrides or {})}
            return _aspic.SceneSource(self._path, [f"{k}={_toml(v)}" for k, v in merged.items()],
                                      self.energies)
        document = {**self.document, "body": [body.table for body in self.bodies]}
        for key, value in (overrides or {}).items():
            section, name = key.split(".")
            document[section] = {**document.get(section, {}), name: value}
        return _aspic.SceneSource(document, self.name, self.energies)


def _toml(value):
    """A value as TOML, on the right of --set."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_quoted(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_quoted(v) for v in value) + "]"
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def _quoted(value):
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return _toml(value)

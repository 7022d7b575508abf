"""Scenes written in Python or read from TOML. Both pass the same checks, so docs/scene.md describes every key.

Every call checks what it adds, and a call that raises changes nothing. Bodies of more than 20 000 tets are checked for
defects of the mesh alone; what their selections and formulas yield is checked when a simulation is made.
"""
from __future__ import annotations

import os
import pathlib
import tempfile
import types
from typing import Any

import numpy as np

from . import _aspic
from ._checks import Floats, Ints, Strict, bounded, frozen, is_path
from .meshes import Mesh, Polyline, Surface, Thin

_MOST_TETS = 20_000  # of a body whose model is built for checks
_PLACEHOLDER = {"name": "body", "shape": {"sphere": {"radius": 1.0, "size": 1.0}}}


def _numbers(key, values):
    """Values per tet as an array of their own."""
    values = bounded(values, f"material.{key}")
    if values.dtype.kind not in "fiu" or values.ndim != 1:
        raise _aspic.InvalidInput(f"material.{key}: shape {values.shape}, dtype {values.dtype}; expected one number per tet")
    if (bad := np.flatnonzero(~np.isfinite(values))).size:
        raise _aspic.InvalidInput(f"material.{key}[{bad[0]}] = {values[bad[0]]}; must be finite")
    return np.array(values)


def _is_list(value):
    return isinstance(value, (np.ndarray, list, tuple)) and np.ndim(value) > 0


class Material(Strict):
    """A material by its name, see materials(). Values are numbers, formulas of X, Y, Z, or arrays with one per tet.

    >>> aspic.Material("neo_hookean", young="1e5 * (1 + X)", poisson=0.4)
    Material('neo_hookean', young='1e5 * (1 + X)', poisson=0.4)
    """

    _advice = "a material is constant: make another one, and give it to body.set(material=...)"

    def __init__(self, model="neo_hookean", **values) -> None:
        values = {key: _numbers(key, value) if _is_list(value) else value for key, value in values.items()}
        self._model, self._values = model, types.MappingProxyType(values)
        for extreme in (np.min, np.max):
            numbers = {key: float(extreme(value)) if _is_list(value) and len(value) else value
                       for key, value in values.items()}
            body = {**_PLACEHOLDER, "material": {"model": model, **numbers}}
            _check_keys({"body": [body]}, "Material", "body.body.material.")

    @property
    def model(self) -> str:
        """The name of the constitutive model."""
        return self._model

    @property
    def values(self) -> types.MappingProxyType[str, Any]:
        """The parameters by name."""
        return self._values

    def __reduce__(self):
        return _material_of, (self.model, dict(self.values))

    def __repr__(self):
        return f"Material({self.model!r}" + "".join(f", {k}={v!r}" for k, v in self.values.items()) + ")"


def _material_of(model, values):
    return Material(model, **values)


def _check_keys(document, name, prefix=""):
    """Raises InvalidInput for unknown keys and bad values. prefix: removed from the places in the message."""
    try:
        return _aspic.SceneSource({"body": [_PLACEHOLDER], **document}, name, [])
    except _aspic.InvalidInput as error:
        raise _aspic.InvalidInput(str(error).replace(f"{name}.{prefix}", f"{name}.")) from None


def _with(table, keys, value):
    """A copy of a table with another value at a path of keys."""
    key, *rest = keys
    inner = table.get(key) or {}
    if rest and not isinstance(inner, dict):
        raise _aspic.InvalidInput(f"{key}: is no table, so that it has no key '{rest[0]}'")
    return {**table, key: _with(inner, rest, value) if rest else value}


def _listed(tables):
    """A list of tables, which may be given as one table."""
    return [tables] if isinstance(tables, dict) else tables or []


def _leaves(spring):
    """Whether a spring leads to another body, which may be added later."""
    return isinstance(spring, dict) and "to_body" in spring


def _is_surface(mesh):
    """Whether this is the path of a mesh of triangles, which takes seconds to fill. Raises InvalidInput if it is damaged."""
    return is_path(mesh) and os.path.exists(mesh) and len(_aspic.read_mesh(os.fspath(mesh))) == 2


class _Folder(tempfile.TemporaryDirectory):
    """A folder of inputs, which copies of a scene share."""

    def __deepcopy__(self, memo):
        return self

    def __reduce__(self):
        raise TypeError("a scene with meshes cannot be pickled: pass the path of scene.save(folder), or a function that makes it")


class Body(Strict):
    """A soft body of a scene. Methods return the body, so that calls can be chained."""

    _attributes = ("table",)
    _advice = "use body.set({name}=...)"

    def __init__(self, scene, mesh, table) -> None:
        self._scene, self._mesh, self.table = scene, mesh, table

    def __repr__(self):
        return f"<Body {self.name}>"

    @property
    def name(self) -> str:
        """Unique in the scene."""
        return self.table["name"]

    @property
    def mesh(self) -> Mesh | Surface:
        """The Mesh, which cannot be changed."""
        if self._mesh is None:
            raise _aspic.InvalidInput(f"body '{self.name}' has no Mesh: it is read when the simulation is made")
        return self._mesh

    @property
    def vertices(self) -> Floats:
        """Rest positions, (n, 3) [m]."""
        return self.mesh.vertices

    @property
    def tets(self) -> Ints:
        """Vertices of each tet, (m, 4)."""
        return self.mesh.tets

    def _where(self, where):
        """A selection as a value of `where`: a formula, a table, a mask or a list of vertices."""
        if where is None or isinstance(where, (str, dict)):
            return where
        array = bounded(where, "where")
        if array.size and array.dtype.kind not in "biu":
            raise _aspic.InvalidInput(f"where: dtype {array.dtype}, shape {array.shape}; expected a mask, such as "
                                      "body.vertices[:, 1] == 0, or numbers of vertices, as integers")
        if self._mesh is not None:
            count = len(self._mesh.vertices)
            if array.dtype == bool and array.shape != (count,):
                raise _aspic.InvalidInput(f"where: a mask of shape {array.shape}; expected ({count},), one per vertex")
            if array.dtype.kind in "iu" and array.size and not (0 <= array.min() and array.max() < count):
                bad = array.max() if array.max() >= count else array.min()
                raise _aspic.InvalidInput(f"where.vertices: {bad}; body '{self.name}' has the vertices 0 to {count - 1}")
            if array.dtype != bool and array.shape == (count,) and array.max() < 2 < count:
                raise _aspic.InvalidInput("where: zeros and ones, which are the vertices 0 and 1; make a mask with .astype(bool)")
        return {"vertices": np.flatnonzero(array) if array.dtype == bool else array.ravel()}

    def _change(self, table):
        self._scene._check_body(table, self)
        self.table = table
        return self

    def _add(self, kind, where, values):
        return self._change({**self.table, kind: [*_listed(self.table.get(kind)), {"where": self._where(where), **values}]})

    def pin(self, where, **values) -> Body:
        """Prescribes positions: keys name, motion, axes, direction."""
        return self._add("pin", where, values)

    def spring(self, where=None, **values) -> Body:
        """Springs to points, between vertices or along edges: keys stiffness [N/m], target, between, edges, ..."""
        return self._add("spring", where, values)

    def traction(self, where, **values) -> Body:
        """A dead load on the surface: keys value or dead_pressure [Pa]."""
        return self._add("traction", where, values)

    def pressure(self, where, value) -> Body:
        """A follower pressure [Pa]."""
        return self._add("pressure", where, {"value": value})

    def force(self, value, where="all") -> Body:
        """A dead load per volume [N/m^3]."""
        return self._add("force", where, {"value": value})

    def set(self, **values) -> Body:
        """Sets any other key of a body: velocity, deform, damping, friction, ... `material` replaces the whole material."""
        for key in ("mesh", "shape"):
            if key in values:
                raise _aspic.InvalidInput(f"{key}: a body keeps its mesh; add another body")
        if values.get("material") is not None:
            values["material"] = self._scene._material(values["material"], self.name, self._mesh)
        return self._change({**self.table, **values})


class Scene(Strict):
    """Bodies, obstacles and settings. Keywords are top-level keys and sections: time={...}, solver={...}, contact={...}.

    >>> scene = aspic.Scene(gravity=(0, -9.81, 0), contact={"friction": 0.3})
    >>> ball = scene.add(aspic.sphere(radius=0.1, size=0.05), name="ball", translate=[0, 0.2, 0])
    >>> scene.obstacle(name="floor", plane={})
    <Scene scene: ball>
    """

    _attributes = ("name", "bodies", "document", "energies")
    _advice = 'use scene.set("{name}", value)'

    def __init__(self, gravity=(0.0, -9.81, 0.0), name="scene", **sections) -> None:
        self.name, self.bodies, self.energies = name, [], []
        self.document = {}
        self._path, self._overrides = None, {}
        self._inputs = None  # folder of the inputs; lives as long as a simulation needs it
        if "body" in sections:
            raise _aspic.InvalidInput("body: add bodies with add()")
        if not isinstance(name, str):
            raise _aspic.InvalidInput(f"name: this is {type(name).__name__}; expected a string")
        self._change({"gravity": gravity, **sections})

    @classmethod
    def load(cls, path, overrides=None) -> Scene:
        """Reads a .toml file, or makes a scene of a mesh. overrides: {"material.young": 2e5, "time.step": 0.005}."""
        scene = cls(name=pathlib.Path(path).stem)
        scene._path = os.fspath(path)
        return scene._override(dict(overrides or {}))

    def __repr__(self):
        what = self._path or ", ".join(body.name for body in self.bodies)
        return f"<Scene {self.name}: {what}>"

    def _require_code(self, what):
        if self._path is not None:
            raise _aspic.InvalidInput(f"{what} is not possible in a scene from a file; override its keys with set()")

    def _file(self, name):
        """A path of an input that no earlier one has."""
        if self._inputs is None:
            self._inputs = _Folder(prefix="aspic-")
        return os.path.join(self._inputs.name, f"{len(os.listdir(self._inputs.name))}.{name}")

    def _change(self, document):
        _check_keys(document, self.name)
        self.document = document
        return self

    def _override(self, overrides):
        _aspic.SceneSource(self._path, _texts(overrides), []).check_keys()
        self._overrides = overrides
        return self

    def _check_body(self, table, body=None):
        """Raises InvalidInput for a bad body. body: the one that it replaces."""
        if any(other is not body and other.name == table["name"] for other in self.bodies):
            raise _aspic.InvalidInput(f'{self.name}.body: name = "{table["name"]}" is taken by another body; choose another')
        springs = _listed(table.get("spring"))
        alone = [{**spring, "to_body": table["name"]} if _leaves(spring) else spring for spring in springs]
        document = {"gravity": self.document["gravity"], "body": [{**table, "spring": alone}]}
        source = _check_keys(document, self.name)
        if alone != springs:  # the vertices of other bodies are unknown
            document["body"] = [{**table, "spring": [spring for spring in springs if not _leaves(spring)]}]
            source = _check_keys(document, self.name)
        if (body and body._mesh) or "shell" in table or "rod" in table or not _is_surface(table.get("mesh")):
            source.check_model(_MOST_TETS)

    def add(self, mesh, name=None, material=None, **values) -> Body:
        """Adds a body. mesh: a Mesh, the path of a mesh file, or a dict such as {"sphere": {"radius": 1, "size": 0.2}}.

        sheet() and rod() make thin bodies: scene.add(aspic.sheet("garment.obj", thickness=1e-3)). The body has a copy
        of a mesh and of arrays.
        """
        self._require_code("add()")
        if isinstance(mesh, Thin):
            mesh, values = mesh.mesh, {**mesh.table, **values}
        if not isinstance(mesh, (Mesh, Surface, Polyline, dict, str, os.PathLike)):
            raise _aspic.InvalidInput(f"mesh: this is {type(mesh).__name__}; expected a Mesh(vertices, tets), a Surface, "
                                      "a sheet or a rod, the path of a file, or a shape as a dict")
        if not isinstance(name, (str, type(None))):
            raise _aspic.InvalidInput(f"name: this is {type(name).__name__}; expected a string; other values need a keyword, "
                                      "such as material=...")
        table = {"name": name or f"body{len(self.bodies) + 1}", **values}
        if isinstance(mesh, Mesh):
            table["mesh"] = self._file("msh")
            mesh = mesh._constant()
            mesh.write(table["mesh"], binary=True)
            mesh._require_sound(f"body '{table['name']}'", _MOST_TETS)
        elif isinstance(mesh, Surface):
            table["mesh"] = self._file("obj")
            mesh = mesh._constant()
            mesh.write(table["mesh"])
        elif isinstance(mesh, Polyline):
            table["mesh"] = self._file("obj")
            mesh.write(table["mesh"])
            mesh = None
        else:
            table["shape" if isinstance(mesh, dict) else "mesh"] = mesh
            mesh = None
        if material is not None:
            table["material"] = self._material(material, table["name"], mesh)
        self._check_body(table)
        self.bodies.append(Body(self, mesh, table))
        return self.bodies[-1]

    def _material(self, material, body, mesh):
        if isinstance(material, Material):
            material = {"model": material.model, **material.values}
        elif not isinstance(material, dict):
            raise _aspic.InvalidInput(f"material: this is {type(material).__name__}; expected a Material or a dict")
        return {key: {"file": self._field(key, _numbers(key, value), body, mesh)} if _is_list(value) else value
                for key, value in material.items()}

    def _field(self, key, values, body, mesh):
        elements = None if mesh is None else mesh.triangles if isinstance(mesh, Surface) else mesh.tets
        if elements is not None and values.shape != (len(elements),):
            raise _aspic.InvalidInput(f"material.{key}: shape {values.shape}; expected ({len(elements)},), one per element")
        path = self._file(f"{key}.csv")
        np.savetxt(path, values, fmt="%.17g")
        return path

    def obstacle(self, mesh=None, **values) -> Scene:
        """Adds an obstacle, which switches contact on: plane={}, sphere={...}, capsule={...}, a Mesh or a Surface."""
        self._require_code("obstacle()")
        if isinstance(mesh, (Mesh, Surface)):
            path = self._file("obj")
            _aspic.write_surface(path, mesh.vertices, mesh.triangles)
            values["mesh"] = path
        elif mesh is not None:
            if is_path(mesh):
                _aspic.read_mesh(os.fspath(mesh))
            values["mesh"] = mesh
        return self._change({**self.document, "obstacle": [*self.document.get("obstacle", []), values]})

    def contact(self, **values) -> Scene:
        """Switches contact on: keys friction, reach [m], stiffness [Pa], pair, start, ..."""
        self._require_code("contact()")
        return self._change({**self.document, "contact": {**self.document.get("contact", {}), **values}})

    def energy(self, energy) -> Any:
        """Adds a term of the potential, see Energy. Returns it."""
        _aspic.check_energy(energy)
        self.energies.append(energy)
        return energy

    def set(self, key, value) -> Scene:
        """Overrides a key by its path, as --set does: scene.set("solver.method", "lbfgs"), "body.jelly.friction"."""
        if self._path is not None:
            return self._override({**self._overrides, key: value})
        section, *keys = key.split(".")
        if section != "body":
            return self._change(_with(self.document, [section, *keys], value))
        body = next((body for body in self.bodies if keys and body.name == keys[0]), None)
        if body is None or len(keys) < 2:
            raise _aspic.InvalidInput(f"{key}: no such key of a body (bodies: {', '.join(b.name for b in self.bodies)})")
        body.set(**{keys[1]: _with(body.table, keys[1:], value)[keys[1]]})
        return self

    def first_vertex(self, body) -> int:
        """Number of the body's first vertex in arrays of the whole scene, for elements of an Energy."""
        return sum(len(b.vertices) for b in self.bodies[:self.bodies.index(body)])

    def save(self, folder) -> pathlib.Path:
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

    def _parts(self):
        """What simulations are made of, for comparisons."""
        parts = {"the file": self._path, "the energies": [(id(e), frozen(np.asarray(e.elements))) for e in self.energies]}
        parts |= {key: frozen(value) for key, value in (*self.document.items(), *self._overrides.items())}
        return parts | {f"body '{b.name}': {key}": frozen(value) for b in self.bodies for key, value in b.table.items()}

    def _source(self, overrides=None):
        if self._path is not None:
            return _aspic.SceneSource(self._path, _texts({**self._overrides, **(overrides or {})}), self.energies)
        document = {**self.document, "body": [body.table for body in self.bodies]}
        for key, value in (overrides or {}).items():
            section, name = key.split(".")
            document[section] = {**document.get(section, {}), name: value}
        return _aspic.SceneSource(document, self.name, self.energies)


def scene_of(scene) -> Scene:
    """A Scene, also from the path of a scene or a mesh."""
    if isinstance(scene, Scene):
        return scene
    if not is_path(scene):
        raise _aspic.InvalidInput(f"scene: this is {type(scene).__name__}; expected a Scene, or the path of a scene or a mesh")
    return Scene.load(scene)


def _texts(overrides):
    return [f"{key}={_toml(value)}" for key, value in overrides.items()]


def _toml(value):
    """A value as TOML, on the right of --set."""
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return value
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {_quoted(v)}" for k, v in value.items()) + "}"
    if isinstance(value, (list, tuple, np.ndarray)):
        if isinstance(value, np.ndarray):
            bounded(value, "override")
        return "[" + ", ".join(_quoted(v) for v in value) + "]"
    return repr(float(value)) if isinstance(value, (float, np.floating)) else str(value)


def _quoted(value):
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return _toml(value)

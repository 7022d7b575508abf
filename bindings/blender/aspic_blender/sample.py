"""Rest shapes, weights and animation of objects, in meters of the world."""
import contextlib

import numpy as np

MODIFIER = "Aspic"

# Modifiers that keep the vertices. Others generate new ones and follow the simulation.
KEEPING = {
    "ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DATA_TRANSFER", "DISPLACE", "HOOK", "LAPLACIANDEFORM",
    "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "MESH_SEQUENCE_CACHE", "NORMAL_EDIT", "SHRINKWRAP",
    "SIMPLE_DEFORM", "SMOOTH", "SOFT_BODY", "SURFACE_DEFORM", "UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT",
    "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY", "VOLUME_DISPLACE", "WARP", "WAVE", "WEIGHTED_NORMAL"
}


SIMULATED = ("BODY", "CLOTH")  # roles


class Refused(Exception):
    """A scene that cannot be baked; the text is for the user."""


def first_generating(ob):
    """Index of the first modifier that changes the number of vertices."""
    own = [m for m in ob.modifiers if m.name != MODIFIER]
    return next((i for i, m in enumerate(own) if m.type not in KEEPING), len(own))


@contextlib.contextmanager
def without_generated(bodies):
    """Hides the cache, and the first generating modifier of each body with all that follow."""
    hidden = []
    for ob in bodies:
        others = [m for m in ob.modifiers if m.name != MODIFIER][first_generating(ob):]
        hidden += [m for m in (*others, ob.modifiers.get(MODIFIER)) if m and m.show_viewport]
    try:
        for modifier in hidden:
            modifier.show_viewport = False
        yield
    finally:
        for modifier in hidden:
            modifier.show_viewport = True


def coordinates(mesh):
    x = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", x)
    return x.reshape(-1, 3).astype(float)


def moved(matrix, x):
    return x @ matrix[:3, :3].T + matrix[:3, 3]


def triangles(mesh, matrix):
    """Triangles that face outwards, also if the matrix mirrors."""
    mesh.calc_loop_triangles()
    t = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", t)
    t = t.reshape(-1, 3)
    return t[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else t


def weights(ob, mesh, group):
    """Weights of a vertex group, also of one that modifiers change."""
    if group not in ob.vertex_groups:
        raise Refused(f"{ob.name} has no vertex group '{group}'; choose another, or clear the field")
    index = ob.vertex_groups[group].index
    w = np.zeros(len(mesh.vertices))
    for i, vertex in enumerate(mesh.vertices):
        for element in vertex.groups:
            if element.group == index:
                w[i] = element.weight
    return w


class Sampled:
    """A body or an obstacle over the frames of the scene."""

    def __init__(self, ob, unit):
        self.ob, self.unit = ob, unit
        self.frames, self.matrices = [], []
        self.rest = self.triangles = self.pin = self.stiffness = None

    def start(self, evaluated):
        settings, matrix = self.ob.aspic, np.array(evaluated.matrix_world)
        is_body = settings.role in SIMULATED
        mesh = self.ob.data if is_body else evaluated.data
        if not len(mesh.polygons):
            raise Refused(f"{self.ob.name} has no faces")
        self.rest = self.unit * moved(matrix, coordinates(mesh))
        self.triangles = triangles(mesh, matrix)
        if abs(np.linalg.det(matrix[:3, :3])) < 1e-12:
            raise Refused(f"{self.ob.name} is scaled to zero along an axis")
        if is_body and settings.pin_group:
            self.pin = weights(self.ob, evaluated.data, settings.pin_group)
        if settings.role == "BODY" and settings.stiffness_group:
            self.stiffness = young(settings, weights(self.ob, evaluated.data, settings.stiffness_group))

    def add(self, evaluated, frame):
        if self.rest is None:
            self.start(evaluated)
        matrix = np.array(evaluated.matrix_world)
        x = self.unit * moved(matrix, coordinates(evaluated.data))
        if len(x) != len(self.rest):
            raise Refused(f"{self.ob.name} has {len(x)} vertices in frame {frame} and {len(self.rest)} at the start; "
                          "its modifiers must keep the vertices")
        bad = np.flatnonzero(~np.isfinite(x).all(axis=1))
        if len(bad):
            raise Refused(f"{self.ob.name}: {len(bad)} of {len(x)} vertices have coordinates that are not finite in frame "
                          f"{frame}; to select the first in object mode, enter in the Python Console: "
                          f"bpy.data.objects[{self.ob.name!r}].data.vertices[{bad[0]}].select = True")
        self.frames.append(x.astype(np.float32))
        self.matrices.append(matrix)

    def finish(self):
        self.frames, self.matrices = np.array(self.frames), np.array(self.matrices)
        size = self.size()
        self.is_moving = bool(np.abs(self.frames - self.frames[0]).max() > 1e-6 * size)
        self.is_posed = bool(np.abs(self.frames[0] - self.rest).max() > 1e-6 * size)

    def size(self):
        """Largest side of the bounding box [m]."""
        return float(np.ptp(self.rest, axis=0).max())

    def median_edge(self):
        a, b, c = (self.rest[self.triangles[:, i]] for i in range(3))
        return float(np.median(np.linalg.norm(np.concatenate([b - a, c - b, a - c]), axis=1)))

    def mesh_size(self):
        """Edge length of tets [m]."""
        return self.ob.aspic.resolution * self.median_edge()


class Wind:
    """A wind field over the frames of the scene: velocities of the air [m/s]."""

    def __init__(self, ob):
        self.ob, self.frames = ob, []

    def add(self, evaluated, _frame):
        axis = np.array(evaluated.matrix_world)[:3, 2]
        self.frames.append(evaluated.field.strength * axis / np.linalg.norm(axis))


def young(settings, weight):
    low, high = settings.young_min, settings.young_max
    if settings.scale == "LOG":
        return low**(1 - weight) * high**weight
    return (1 - weight) * low + weight * high


def sample(context, objects, winds):
    """Samples objects and winds in all frames of the scene."""
    scene, unit = context.scene, context.scene.unit_settings.scale_length
    current = scene.frame_current, scene.frame_subframe
    sampled = [Sampled(ob, unit) for ob in objects]
    with without_generated([ob for ob in objects if ob.aspic.role in SIMULATED]):
        try:
            for frame in range(scene.frame_start, scene.frame_end + 1):
                scene.frame_set(frame)
                graph = context.evaluated_depsgraph_get()
                for each in (*sampled, *winds):
                    each.add(each.ob.evaluated_get(graph), frame)
        finally:
            scene.frame_set(current[0], subframe=current[1])
    for each in sampled:
        each.finish()
    return sampled

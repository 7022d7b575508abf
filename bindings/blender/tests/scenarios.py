"""Scenarios of the add-on, without windows: blender -b --factory-startup --python-exit-code 1 -P scenarios.py -- [NAME ...]"""
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import traceback

import bpy
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
import aspic_blender  # noqa: E402
from aspic_blender import export, files, messages, operators, process, results, sample  # noqa: E402

SCENARIOS = []
SINGLE = 1e-6  # of the size of the scene: round-off of caches


def scenario(function):
    SCENARIOS.append(function)
    return function


def check(condition, *values):
    if not condition:
        raise AssertionError(" ".join(map(str, values)) or "the condition does not hold")


def refused(call):
    """Message of an operator that reports an error."""
    try:
        call()
    except RuntimeError as error:
        return str(error)
    raise AssertionError("was not refused")


def ball(name="Ball", radius=0.1, at=(0, 0, 0.5), subdivisions=2, **settings):
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=radius, location=at)
    ob = bpy.context.object
    ob.name = name
    ob.aspic.role = "BODY"
    ob.aspic.resolution = 2
    for key, value in settings.items():
        setattr(ob.aspic, key, value)
    return ob


def paint(ob, name, weight):
    group = ob.vertex_groups.new(name=name)
    for vertex in ob.data.vertices:
        group.add([vertex.index], weight(vertex.co), "REPLACE")
    return name


def bake(frames=6, start=1):
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = start, start + frames - 1
    check(bpy.ops.aspic.bake() == {"FINISHED"}, scene.aspic.status)
    return export.folder_of(bpy.context)


def shown(ob, frame):
    """What Blender shows: evaluated vertices in the world."""
    bpy.context.scene.frame_set(frame)
    evaluated = ob.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return sample.moved(np.array(evaluated.matrix_world), sample.coordinates(evaluated.data))


def simulated(folder, name):
    return files.read_pc2(os.path.join(folder, "run", "skins", f"skin_{name}.pc2"))


def obj_vertices(path):
    return np.array([line.split()[1:4] for line in path.read_text().splitlines() if line.startswith("v ")], float)


def check_shows(ob, folder, name, start=1, unit=1):
    frames = simulated(folder, name)
    check(len(frames) > 1)
    for k, x in enumerate(frames):
        error = np.abs(shown(ob, start + k) * unit - x).max()
        check(error < SINGLE, "frame", k, "differs by", error)


@scenario
def round_trip():
    ob = ball()
    x = shown(ob, 1)
    folder = bake()
    check_shows(ob, folder, "Ball")
    check(np.abs(simulated(folder, "Ball")[0] - x).max() < SINGLE)
    fallen = x[:, 2].mean() - shown(ob, 6)[:, 2].mean()
    h, n = 1 / 96, 20  # backward Euler in free fall: h^2 g n (n + 1) / 2
    check(abs(fallen - 9.81 * h * h * n * (n + 1) / 2) < 1e-5, "fell by", fallen)
    check(os.path.getsize(os.path.join(folder, "run", "report.html")) > 10000)
    check(ob.aspic.preset == "jelly" and bpy.ops.aspic.report.poll())


def run_variant(folder, young):
    """The last frame of the baked scene with another stiffness."""
    path = pathlib.Path(folder, "scene.toml")
    text, painted = path.read_text(encoding="utf-8"), 'young = { file = "Ball.ply", name = "young" }'
    check(painted in text, text)
    variant, out = path.with_name("variant.toml"), path.with_name("variant")
    variant.write_text(text.replace(painted, f"young = {young}"), encoding="utf-8")
    subprocess.run([operators.program(bpy.context), "run", variant, "--out", out, "--force", "--quiet"], check=True)
    return files.read_pc2(out / "skins" / "skin_Ball.pc2")[-1]


@scenario
def painted_gradient_matches_formula():
    """A linear function is harmonic, so weights linear in z are a formula of Z inside, too."""
    ob = ball(subdivisions=3, young_min=2e3, young_max=2e5)
    ob.aspic.pin_group = paint(ob, "pin", lambda x: float(x.z > 0.09))
    ob.aspic.stiffness_group = paint(ob, "stiff", lambda x: (0.1 + x.z) / 0.2)
    folder = bake(8)
    painted = simulated(folder, "Ball")[-1]
    formula = run_variant(folder, '"2e3 + 198e3 * (Z - 0.4) / 0.2"')
    uniform = run_variant(folder, "101e3")
    difference, effect = np.linalg.norm(painted - formula), np.linalg.norm(uniform - formula)
    check(difference < 0.05 * effect, "differs by", difference, "of", effect)
    print(f"difference of painted stiffness from its formula: {difference / effect:.3f} of that from a uniform one")


@scenario
def logarithmic_stiffness():
    ob = ball(young_min=1e3, young_max=1e5, scale="LOG")
    weight = np.array([0, 0.5, 1])
    check(np.allclose(sample.young(ob.aspic, weight), [1e3, 1e4, 1e5]))
    ob.aspic.scale = "LINEAR"
    check(np.allclose(sample.young(ob.aspic, weight), [1e3, 50500, 1e5]))


@scenario
def pins_follow_armature():
    bpy.ops.object.armature_add(location=(0, 0, 0.4))
    rig = bpy.context.object
    ob = ball()
    ob.aspic.pin_group = paint(ob, "Bone", lambda x: float(x.z > -0.03))
    modifier = ob.modifiers.new("Rig", "ARMATURE")
    modifier.object = rig
    bone = rig.pose.bones["Bone"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((1, 0), (10, 0.6)):
        bone.rotation_euler[0] = angle
        bone.keyframe_insert("rotation_euler", frame=frame)
    free = [shown(ob, f) for f in (1, 5, 10)]
    folder = bake(10)
    pinned = np.array([v.co.z > 0.06 for v in ob.data.vertices])  # the tets around are pinned at all corners
    check(pinned.any() and np.abs(free[0] - free[2])[pinned].max() > 0.03)
    for frame, x in zip((1, 5, 10), free):
        error = np.abs(shown(ob, frame) - x)[pinned].max()
        check(error < SINGLE, "pins differ by", error)
    check(list(ob.modifiers.keys()) == ["Rig", "Aspic"])
    check_shows(ob, folder, "Ball")


@scenario
def pose_at_start_is_reached_in_preroll():
    ob = ball()
    ob.aspic.pin_group = paint(ob, "pin", lambda x: float(x.z > 0.03))
    hook = bpy.data.objects.new("Hook", None)
    bpy.context.collection.objects.link(hook)
    modifier = ob.modifiers.new("Hook", "HOOK")
    modifier.object, modifier.vertex_group = hook, "pin"
    hook.location.x = 0.02
    posed = shown(ob, 1)
    bpy.context.scene.aspic.preroll = 8
    folder = bake(4)
    frames = simulated(folder, "Ball")
    check(len(frames) == 12)
    rest = sample.moved(np.array(ob.matrix_world), sample.coordinates(ob.data))
    check(np.abs(frames[0] - rest).max() < SINGLE)
    top = np.argmax(rest[:, 2])
    check(np.abs(shown(ob, 1)[top] - posed[top]).max() < 1e-3)
    check(np.abs(shown(ob, 1) - frames[8]).max() < SINGLE)


@scenario
def cancelled_bake_continues():
    ob = ball()
    whole = simulated(bake(8), "Ball")
    folder = export.folder_of(bpy.context)
    run = process.Run(operators.program(bpy.context), folder,
                      [os.path.join(folder, "scene.toml"), "--out", results.run_folder(folder), "--force", "--steps",
                       "10"])
    check(run.wait() == process.DONE)
    check(results.can_continue(folder) and results.steps_done(folder) == 10)
    check(results.apply(folder) == 3)
    check_shows(ob, folder, "Ball")
    check(bpy.ops.aspic.continue_bake() == {"FINISHED"})
    check(np.array_equal(simulated(folder, "Ball"), whole))
    check(not bpy.ops.aspic.continue_bake.poll())
    check_shows(ob, folder, "Ball")


@scenario
def interrupt_keeps_frames():
    ob = ball(subdivisions=3, resolution=1)
    bake(2)
    bpy.context.scene.frame_end = 400
    folder = export.write(bpy.context)
    operators.active = process.Run(operators.program(bpy.context), folder,
                                   [os.path.join(folder, "scene.toml"), "--out", results.run_folder(folder), "--force"])
    check(not bpy.ops.aspic.bake.poll() and bpy.ops.aspic.cancel.poll())
    deadline = time.time() + 60
    while operators.active.step < 3 and time.time() < deadline:
        time.sleep(0.02)
    bpy.ops.aspic.cancel()
    kind, text = operators.outcome(operators.active)
    operators.active = None
    check(kind == "WARNING" and "Stopped" in text, text)
    check(results.can_continue(folder))
    check_shows(ob, folder, "Ball")


@scenario
def timer_shows_progress_and_applies():
    """The timer's function, called as the window manager would."""
    ob = ball(subdivisions=3, resolution=1)
    bpy.context.scene.frame_end = 12
    folder = export.write(bpy.context)
    operators.active = process.Run(operators.program(bpy.context), folder,
                                   [os.path.join(folder, "scene.toml"), "--out", results.run_folder(folder), "--force"])
    seen, shown_early, deadline = set(), False, time.time() + 120
    while operators.poll() is not None and time.time() < deadline:
        seen.add(bpy.context.scene.aspic.status)
        shown_early |= "Aspic" in ob.modifiers and 0 < bpy.context.scene.aspic.progress < 100
        time.sleep(0.02)
    check(operators.active is None and bpy.context.scene.aspic.status == "Baked 12 frames")
    check(any(text.endswith("of 44") for text in seen), seen)
    check(shown_early, "no frames before the end")
    check_shows(ob, folder, "Ball")


@scenario
def killed_program_continues():
    ball(subdivisions=3, resolution=1)
    bpy.context.scene.frame_end = 40
    folder = export.write(bpy.context)
    run = process.Run(operators.program(bpy.context), folder,
                      [os.path.join(folder, "scene.toml"), "--out", results.run_folder(folder), "--force", "--set",
                       "output.checkpoint_every=0"])
    deadline = time.time() + 60
    while run.step < 4 and time.time() < deadline:
        time.sleep(0.01)
    run.process.kill()
    run.wait()
    check(results.can_continue(folder), results.steps_done(folder))
    check(bpy.ops.aspic.continue_bake() == {"FINISHED"}, bpy.context.scene.aspic.status)
    check(len(simulated(folder, "Ball")) == 40)


class CheckedLayout:
    """Replaces the layout of a panel: each property and operator must exist."""

    def __init__(self):
        self.drawn = []

    def prop(self, data, name, **_):
        check(name in data.bl_rna.properties, name)
        self.drawn.append(name)

    def prop_search(self, data, name, source, list_name):
        self.prop(data, name)
        check(list_name in source.bl_rna.properties, list_name)

    def operator(self, name):
        check(getattr(bpy.ops.aspic, name.split(".")[1]).get_rna_type())  # raises KeyError for an unknown one
        self.drawn.append(name)

    def label(self, text):
        self.drawn.append(text)

    def nested(self, **_):
        return self

    row = box = nested

    def separator(self):
        pass


@scenario
def panel_draws_all_roles():
    from types import SimpleNamespace
    ob, panel = ball(), aspic_blender.panel.ASPIC_PT_sidebar
    bpy.context.scene.aspic.status = "Baked 3 frames"

    def drawn():
        layout = CheckedLayout()
        panel.draw(SimpleNamespace(layout=layout), bpy.context)
        return layout.drawn

    check({"young", "pin_group", "rebuild", "aspic.bake", "Baked 3 frames"} <= set(drawn()))
    ob.aspic.stiffness_group = "Group"
    check({"young_min", "young_max", "scale"} <= set(drawn()) and "young" not in drawn())
    ob.aspic.role = "OBSTACLE"
    check("friction" in drawn() and "pin_group" not in drawn())
    operators.active = object()
    check("aspic.cancel" in drawn() and "aspic.bake" not in drawn())
    operators.active = None


@scenario
def edited_mesh_is_refused():
    ob = ball()
    folder = bake(3)
    ob.data.vertices.add(1)
    try:
        results.apply(folder)
    except sample.Refused as error:
        check("edited" in str(error))
    else:
        raise AssertionError("was not refused")
    check("vertex group 'gone'" in refused(lambda: [setattr(ob.aspic, "pin_group", "gone"), bpy.ops.aspic.bake()]))


@scenario
def parents_mirror_rotate_and_scale():
    parent = bpy.data.objects.new("Parent", None)
    bpy.context.collection.objects.link(parent)
    ob = ball(at=(0.2, 0, 0))
    ob.parent = parent
    parent.rotation_euler, parent.scale, parent.location = (0.3, 0.5, 1), (-2, 1, 0.7), (1, 2, 3)
    for frame, x in ((1, 0), (6, 0.5)):
        parent.location.x = x
        parent.keyframe_insert("location", frame=frame)
    ob.aspic.pin_group = paint(ob, "pin", lambda x: float(x.z > 0.05))
    pinned = np.array([v.co.z > 0.09 for v in ob.data.vertices])
    free = [shown(ob, f) for f in (1, 4, 6)]
    folder = bake(6)
    check_shows(ob, folder, "Ball")
    for frame, x in zip((1, 4, 6), free):
        error = np.abs(shown(ob, frame) - x)[pinned].max()
        check(error < 0.01, "pins differ by", error)


@scenario
def frame_rates():
    ob = ball()
    for fps, base in ((24, 1), (30, 1), (30, 1.001)):
        bpy.context.scene.render.fps, bpy.context.scene.render.fps_base = fps, base
        folder = bake(7, start=5)
        check(len(simulated(folder, "Ball")) == 7, fps, base)
        check_shows(ob, folder, "Ball", start=5)


@scenario
def unit_scale():
    bpy.context.scene.unit_settings.scale_length = 0.01
    ob = ball(radius=10, at=(0, 0, 0))
    x = shown(ob, 1)
    folder = bake(6)
    check_shows(ob, folder, "Ball", unit=0.01)
    h, n = 1 / 96, 20
    check(abs((x - shown(ob, 6))[:, 2].mean() - 100 * 9.81 * h * h * n * (n + 1) / 2) < 1e-2)


@scenario
def moving_obstacle_pushes():
    bpy.context.scene.use_gravity = False
    ob = ball(at=(0, 0, 0))
    bpy.ops.mesh.primitive_cube_add(size=0.4, location=(-0.35, 0, 0))
    cube = bpy.context.object
    cube.name, cube.aspic.role = "Wall", "OBSTACLE"
    for frame, x in ((1, -0.35), (9, -0.2)):
        cube.location.x = x
        cube.keyframe_insert("location", frame=frame)
    folder = bake(10)
    check_shows(ob, folder, "Ball")
    check(shown(ob, 10)[:, 0].min() > -1e-4, "passed through:", shown(ob, 10)[:, 0].min())


@scenario
def cloth_drapes_over_obstacle():
    ball(name="Head", radius=0.2, at=(0, 0, 0.4), subdivisions=3).aspic.role = "OBSTACLE"
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=14, y_subdivisions=14, size=0.8, location=(0, 0, 0.62))
    cloth = bpy.context.object
    cloth.name, cloth.aspic.role, cloth.aspic.fabric = "Scarf", "CLOTH", "denim"
    check(cloth.aspic.stretching == 3000)
    cloth.aspic.pin_group = paint(cloth, "corner", lambda x: float(x.x > 0.39 and x.y > 0.39))
    folder = bake(12)
    check_shows(cloth, folder, "Scarf")
    x = shown(cloth, 12)
    corner = np.argmax(x[:, 0] + x[:, 1])
    check(abs(x[corner] - shown(cloth, 1)[corner]).max() < SINGLE, "the pinned corner moved")
    check(np.linalg.norm(x - [0, 0, 0.4], axis=1).min() > 0.19, "the cloth enters the head")
    check(x[:, 2].min() < 0.5, "the cloth did not fall")
    stretch = lambda x: np.linalg.norm(x[1:15] - x[:14], axis=1).max()
    check(stretch(x) < 1.1 * stretch(shown(cloth, 1)))


@scenario
def wind_of_blender_blows():
    scene = bpy.context.scene
    scene.use_gravity = False
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=6, y_subdivisions=6, size=0.4)
    cloth = bpy.context.object
    cloth.aspic.role, cloth.name = "CLOTH", "Flag"
    cloth.aspic.pin_group = paint(cloth, "edge", lambda x: float(x.x < -0.19))
    bpy.ops.object.effector_add(type="WIND", rotation=(0.4, 0, 0))
    wind = bpy.context.object
    for frame, strength in ((1, 0), (20, 8), (40, 3)):
        wind.field.strength = strength
        wind.field.keyframe_insert("strength", frame=frame)
    folder = bake(40)
    text = pathlib.Path(folder, "scene.toml").read_text(encoding="utf-8")
    formulas = re.search(r"\[wind\]\nvelocity = (\[.*\])", text).group(1)
    for frame in (1, 7, 20, 40):
        scene.frame_set(frame)
        expected = wind.field.strength * np.array([0, -math.sin(0.4), math.cos(0.4)])
        velocity = [eval(formula, {"t": (frame - 1) / 24, "max": max}) for formula in eval(formulas)]
        check(np.abs(velocity - expected).max() < 0.1, frame, velocity, expected)
    start, x = shown(cloth, 1), shown(cloth, 40)
    check(x[:, 2].max() > 0.02 and np.abs(x - start)[start[:, 0] < -0.199].max() < SINGLE, x[:, 2].max())
    bake(3)  # again: pins stay where the animation has them, not where the first bake left them
    check("recording" not in pathlib.Path(folder, "scene.toml").read_text(encoding="utf-8"))


@scenario
def physics_of_blender_are_adopted():
    cloth, solid, wall, brick = (ball(name, at=(i, 0, 0), role="NONE") for i, name in
                                 enumerate(("Cloth", "Solid", "Wall", "Brick")))
    cloth.modifiers.new("Cloth", "CLOTH").settings.vertex_group_mass = paint(cloth, "held", lambda x: float(x.z > 0))
    solid.modifiers.new("Softbody", "SOFT_BODY")
    wall.modifiers.new("Collision", "COLLISION")
    bpy.ops.object.select_all(action="DESELECT")
    bpy.context.view_layer.objects.active = brick
    bpy.ops.rigidbody.object_add(type="PASSIVE")
    brick.rigid_body.friction = 0.7
    bpy.ops.aspic.adopt()
    check([ob.aspic.role for ob in (cloth, solid, wall, brick)] == ["CLOTH", "BODY", "OBSTACLE", "OBSTACLE"])
    check(cloth.aspic.pin_group == "held" and abs(brick.aspic.friction - 0.7) < SINGLE)
    check(not cloth.modifiers["Cloth"].show_viewport and wall.modifiers["Collision"].show_viewport)


@scenario
def animated_gltf_moves_like_the_armature():
    """An obstacle from a GLB file of Blender has the vertices that Blender evaluates, for sampled and cubic curves."""
    scene = bpy.context.scene
    ball(at=(5, 0, 0))  # a body, which scenes need
    bpy.ops.object.armature_add(location=(0.1, 0, -0.3), rotation=(0.2, 0.1, 0.4), scale=(1, 1, 1))
    rig = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    second = rig.data.edit_bones.new("Upper")
    second.head, second.tail, second.parent = (0, 0, 1), (0, 0.2, 1.8), rig.data.edit_bones["Bone"]
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.scale = (1.2, 1.2, 1.2)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=1)
    figure = bpy.context.object
    figure.parent = rig
    paint(figure, "Bone", lambda x: (1 - x.z) / 2)
    paint(figure, "Upper", lambda x: (1 + x.z) / 2)
    figure.modifiers.new("Rig", "ARMATURE").object = rig
    for frame, angle in ((0, 0), (7, 0.9), (12, -0.5)):
        rig.location.y = angle
        rig.keyframe_insert("location", frame=frame)
        for bone in rig.pose.bones:
            bone.rotation_quaternion = (math.cos(angle / 2), math.sin(angle / 2), 0, 0)
            bone.location.x, bone.scale.y = 0.2 * angle, 1 + 0.3 * angle
            for path in ("rotation_quaternion", "location", "scale"):
                bone.keyframe_insert(path, frame=frame)
    scene.frame_start, scene.frame_end = 0, 12
    scene.frame_set(0)
    expected = [shown(figure, frame) for frame in range(13)]
    folder = pathlib.Path(export.folder_of(bpy.context))
    bpy.ops.object.select_all(action="DESELECT")
    figure.select_set(True)
    rig.select_set(True)
    for is_sampled in (True, False):
        bpy.ops.export_scene.gltf(filepath=str(folder / "figure.glb"), use_selection=True,
                                  export_force_sampling=is_sampled, export_yup=False)
        (folder / "scene.toml").write_text("""
            [time]
            step = 0.041666666666666667
            duration = 0.5
            [output]
            obj = true
            [[body]]
            shape = { box = { upper = [1, 1, 1], cells = [1, 1, 1] } }
            translate = [9, 9, 9]
            [[obstacle]]
            mesh = "figure.glb"
            recording = { file = "figure.glb" }
            """, encoding="utf-8")
        run = folder / "run"
        subprocess.run([operators.program(bpy.context), "run", folder / "scene.toml", "--out", run, "--force", "--quiet"], check=True)
        moved = [obj_vertices(run / "frames" / f"obstacle_obstacle1_{frame:06}.obj") for frame in range(13)]
        nearest = [np.argmin(np.linalg.norm(expected[0] - x, axis=1)) for x in moved[0]]
        check(len(set(nearest)) == len(expected[0]), len(set(nearest)))
        worst = max(np.abs(x[nearest] - y).max() for x, y in zip(expected, moved))
        print(f"GLB {'sampled' if is_sampled else 'cubic'}: largest difference from Blender {worst:.1e} m")
        check(worst < 1e-5, worst)


@scenario
def generating_modifiers_follow():
    ob = ball()
    ob.modifiers.new("Smooth", "SMOOTH").iterations = 0
    ob.modifiers.new("Subdivision", "SUBSURF")
    folder = bake(4)
    check(list(ob.modifiers.keys()) == ["Smooth", "Aspic", "Subdivision"])
    check(all(m.show_viewport for m in ob.modifiers))
    count = len(shown(ob, 4))
    check(count > 3 * len(ob.data.vertices), count)
    fallen = simulated(folder, "Ball")[0][:, 2].mean() - simulated(folder, "Ball")[3][:, 2].mean()
    before = shown(ob, 1)[:, 2].mean()
    check(abs(before - shown(ob, 4)[:, 2].mean() - fallen) < 1e-3)
    bake(3)  # again, with the modifier in place
    check(list(ob.modifiers.keys()).count("Aspic") == 1)
    bpy.ops.aspic.remove()
    check("Aspic" not in ob.modifiers)


@scenario
def render_shows_the_cache():
    ob = ball(at=(0, 0, 0))
    bake(8)
    scene = bpy.context.scene
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    camera.location, camera.rotation_euler, camera.data.type = (0, -3, 0), (math.pi / 2, 0, 0), "ORTHO"
    camera.data.ortho_scale, scene.camera = 1.0, camera
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.film_transparent = True
    heights = []
    for frame in (1, 8):
        scene.frame_set(frame)
        scene.render.filepath = os.path.join(export.folder_of(bpy.context), f"{frame}.png")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        alpha = np.array(image.pixels[:]).reshape(64, 64, 4)[:, :, 3]
        heights.append((np.nonzero(alpha > 0.5)[0].mean() + 0.5) / 64 - 0.5)
    moved = shown(ob, 8)[:, 2].mean() - shown(ob, 1)[:, 2].mean()
    check(moved < -0.1 and abs(heights[1] - heights[0] - moved) < 0.02, heights, moved)


@scenario
def names_are_sanitized_and_distinct():
    first, second = ball("Bäll 1", at=(0, 0, 0)), ball("Bäll_1", at=(1, 0, 0))
    folder = bake(3)
    check_shows(first, folder, "B_ll_1")
    check_shows(second, folder, "B_ll_1_2")


@scenario
def mistakes_are_explained():
    check("no object is a soft body" in refused(bpy.ops.aspic.bake))
    ob = ball()
    ob.aspic.pin_group = paint(ob, "pin", lambda x: 0.2)
    check("above 0.5" in refused(bpy.ops.aspic.bake))
    ob.aspic.pin_group = ""
    os.environ["ASPIC_PROGRAM"], program = "/no/such/aspic", os.environ.get("ASPIC_PROGRAM")
    try:
        check("/no/such/aspic" in refused(bpy.ops.aspic.bake))
    finally:
        os.environ.pop("ASPIC_PROGRAM") if program is None else os.environ.update(ASPIC_PROGRAM=program)
    x, ob.data.vertices[7].co.y = ob.data.vertices[7].co.y, math.nan
    text = refused(bpy.ops.aspic.bake)
    check("Ball: 1 of 42 vertices" in text and "objects['Ball'].data.vertices[7].select" in text, text)
    ob.data.vertices[7].co.y = x
    bpy.ops.mesh.primitive_plane_add(size=0.2)
    bpy.context.object.aspic.role = "BODY"
    text = refused(bpy.ops.aspic.bake)
    check(text == "Error: Plane: the mesh is planar; role Cloth, or apply a Solidify modifier\n", text)


@scenario
def errors_have_words_of_blender():
    ob = ball(name="Open.001")
    x, faces = [tuple(v.co) for v in ob.data.vertices], [tuple(f.vertices) for f in ob.data.polygons]
    ob.data.clear_geometry()
    ob.data.from_pydata(x, [], faces[1:])
    text = refused(bpy.ops.aspic.bake)
    check(text.startswith("Error: Open.001: the surface is open (1 hole); Mesh > Clean Up > Fill Holes"), text)
    ob.data.clear_geometry()
    ob.data.from_pydata(x + [(v[0] + 0.1, v[1], v[2]) for v in x], [],
                        faces + [tuple(v + len(x) for v in f) for f in faces])
    text = refused(bpy.ops.aspic.bake)
    check(text.startswith("Error: Open.001: the surface intersects itself (") and "Remesh" in text, text)
    scene = '[time]\nstep = 1\n[body]\nname = "Open_001"\nfriction = 2\n'
    for place, expected in (("5:1", "Open.001: a value"), ("2:1", "a value")):
        text = messages.error_text(f"error: C:\\my files\\scene.toml:{place}: a value", scene, {"Open_001": "Open.001"})
        check(text == expected, text)


@scenario
def notes_are_warnings():
    ob = ball(name="My ball", young=5)
    ob.aspic.pin_group = paint(ob, "pin", lambda x: float(x.z > 0.05))
    bake(2)
    lines = bpy.context.scene.aspic.status.splitlines()
    check(len(lines) == 2 and lines[0] == "Baked 2 frames, 1 warning:", lines)
    check(lines[1].startswith("My ball: its weight crushes it"), lines)


@scenario
def large_objects_are_warned_of():
    ob = ball(at=(0, 0, 0))
    for unit, scale, expected in ((1, 100, "Ball is 20 m large;"), (0.1, 1000, "Ball is 20 m large, Unit Scale is 0.1;"),
                                  (0.01, 100, "Baked 2 frames")):
        bpy.context.scene.unit_settings.scale_length = unit
        ob.scale = (scale, scale, scale)
        bake(2)
        status = bpy.context.scene.aspic.status
        check(status.splitlines()[-1].startswith(expected), status)


@scenario
def suzanne_is_rebuilt():
    """She is open and intersects herself."""
    bpy.ops.mesh.primitive_monkey_add(size=0.2)
    ob = bpy.context.object
    ob.aspic.role, ob.aspic.resolution = "BODY", 3
    ob.aspic.pin_group = paint(ob, "pin", lambda x: float(x.y > 0.05))
    for frame, z in ((1, 0), (4, 0.02)):
        ob.location.z = z
        ob.keyframe_insert("location", frame=frame)
    check("Rebuild surface" in refused(bpy.ops.aspic.bake))
    ob.aspic.rebuild = True
    rest, free = shown(ob, 1), shown(ob, 4)
    folder = bake(4)
    check(len(ob.data.uv_layers) == 1 and simulated(folder, "Suzanne").shape == (4, len(rest), 3))
    check(np.abs(simulated(folder, "Suzanne")[0] - rest).max() < SINGLE)
    check_shows(ob, folder, "Suzanne")
    pinned = rest[:, 1] > 0.07
    error = np.abs(shown(ob, 4) - free)[pinned].max()
    check(pinned.any() and error < 0.002, "pins differ by", error)
    check(export.rebuilds(folder) == [])
    export.write(bpy.context)
    check(export.rebuilds(folder) == [], "an equal surface is rebuilt")
    ob.data.vertices[0].co.x *= 1.01
    export.write(bpy.context)
    check(len(export.rebuilds(folder)) == 1, "an edited surface is not rebuilt")
    bpy.context.scene.frame_end = 5
    export.write(bpy.context)
    check(not results.can_continue(folder), "continues the run of another surface")
    run = process.Run(operators.program(bpy.context), folder, ["scene.toml"], export.rebuilds(folder))
    check(run.is_running() and run.is_preparing())
    run.cancel()
    check(operators.outcome(run) == ("WARNING", "Stopped before the first frame"))


@scenario
def addon_can_be_disabled_and_enabled():
    ob = ball()
    folder = bake(3)
    aspic_blender.unregister()
    check(not hasattr(ob, "aspic"))
    check_shows(ob, folder, "Ball")  # the modifier is Blender's own
    aspic_blender.register()
    keys = bpy.context.window_manager.keyconfigs.addon.keymaps["Window"].keymap_items
    check([key.type for key in keys if key.idname == "aspic.cancel"] == ["ESC"])
    check(ob.aspic.role == "BODY")
    bake(3)


@scenario
def saved_file_plays_and_continues():
    ball()
    folder = tempfile.mkdtemp()
    try:
        blend = os.path.join(folder, "shot.blend")
        bpy.ops.wm.save_as_mainfile(filepath=blend)
        check(bake(4) == os.path.join(folder, "shot_aspic"))
        bpy.ops.wm.save_mainfile()
        bpy.ops.wm.open_mainfile(filepath=blend)
        ob = bpy.data.objects["Ball"]
        check(ob.modifiers["Aspic"].filepath.startswith("//"))
        check_shows(ob, os.path.join(folder, "shot_aspic"), "Ball")
        check(not bpy.ops.aspic.continue_bake.poll() and bpy.ops.aspic.report.poll())
    finally:
        shutil.rmtree(folder)


@scenario
def large_export_is_fast():
    """30 000 vertices in 250 frames, with an armature's work left out."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=173, y_subdivisions=173, size=1)
    ob = bpy.context.object
    ob.aspic.role = "BODY"
    ob.aspic.pin_group = paint(ob, "pin", lambda x: float(x.x > 0.4))
    wave = ob.modifiers.new("Wave", "WAVE")
    wave.height = 0.1
    bpy.context.scene.frame_end = 250
    start = time.process_time()
    folder = export.write(bpy.context)
    seconds = time.process_time() - start
    frames = files.read_pc2(os.path.join(folder, "Grid.pc2"))
    check(frames.shape[0] >= 250 and frames.shape[1] > 30000, frames.shape)
    print(f"export of {frames.shape[1]} vertices x 250 frames: {seconds:.1f} s CPU")
    check(seconds < 20, "took", seconds)


def main(names):
    aspic_blender.register()
    known = [s.__name__ for s in SCENARIOS]
    if names == ["--list"]:
        print("\n".join(known))
        return
    check(set(names) <= set(known), "unknown scenario in", names)
    failed = []
    for each in SCENARIOS:
        if names and each.__name__ not in names:
            continue
        if aspic_blender.settings.ObjectSettings.is_registered:
            aspic_blender.unregister()
        bpy.ops.wm.read_factory_settings(use_empty=True)
        aspic_blender.register()
        start = time.time()
        with tempfile.TemporaryDirectory() as folder:
            bpy.context.scene.aspic.folder = "" if each is saved_file_plays_and_continues else folder
            try:
                each()
                print(f"passed {each.__name__} ({time.time() - start:.1f} s)", flush=True)
            except Exception:  # the others run, too
                traceback.print_exc()
                failed.append(each.__name__)
    check(not failed, "failed:", ", ".join(failed))


main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])

"""Writes a scene of Blender as a scene of Aspic, with all that is needed to read the results."""
import hashlib
import json
import os
import re

import numpy as np

from . import files, messages, sample

JOB = "bake.json"


def folder_of(context):
    """The folder of the bake."""
    import bpy
    given = context.scene.aspic.folder
    if given:
        return os.path.normpath(bpy.path.abspath(given))
    blend = bpy.data.filepath
    return os.path.splitext(blend)[0] + "_aspic" if blend else os.path.join(bpy.app.tempdir, "aspic")


def names(objects):
    """Names of files and bodies: letters, digits, _ and -; all different."""
    taken, result = set(), []
    for ob in objects:
        stem = re.sub(r"[^A-Za-z0-9_-]", "_", ob.name)[:50] or "object"
        name, number = stem, 1
        while name.lower() in taken:
            number += 1
            name = f"{stem}_{number}"
        taken.add(name.lower())
        result.append(name)
    return result


def with_preroll(sampled, preroll):
    """Frames with `preroll` more at the beginning, from the rest shape to the first one."""
    if preroll == 0:
        return sampled.frames
    start = sampled.rest.astype(np.float32) if sampled.ob.aspic.role in sample.SIMULATED else sampled.frames[0]
    share = (np.arange(preroll) / preroll).astype(np.float32)[:, None, None]
    return np.concatenate([(1 - share) * start + share * sampled.frames[0], sampled.frames])


def body_text(name, sampled, folder, preroll, fps):
    settings, attributes = sampled.ob.aspic, {}
    if sampled.pin is not None:
        if not (sampled.pin > 0.5).any():
            raise sample.Refused(f"{sampled.ob.name}: no vertex of '{settings.pin_group}' has a weight above 0.5")
        attributes["pin"] = sampled.pin
    if sampled.stiffness is not None:
        attributes["young"] = sampled.stiffness
    mesh = name + ".ply"
    files.write_ply(os.path.join(folder, mesh), sampled.rest, sampled.triangles, attributes)
    keys = {"name": name, "mesh": mesh, "friction": settings.friction}
    if settings.role == "CLOTH":
        keys["shell"] = {"thickness": settings.thickness, "moment": settings.bending}
        keys["material"] = {"young": settings.stretching / settings.thickness, "poisson": 0.3,
                            "density": settings.areal_density / settings.thickness}
    else:
        keys["material"] = {"model": settings.model, "poisson": settings.poisson, "density": settings.density,
                            "young": {"file": mesh, "name": "young"} if "young" in attributes else settings.young}
        if settings.rebuild:
            keys.update(mesh=name + ".mesh", skin=mesh)
        else:
            keys["mesh_size"] = sampled.mesh_size()
    text = files.table("[body]", keys)
    if "pin" not in attributes:
        return text
    pin = {"where": {"file": mesh, "name": "pin"}}
    if sampled.is_moving or sampled.is_posed:
        cache = name + ".pc2"
        files.write_pc2(os.path.join(folder, cache), with_preroll(sampled, preroll))
        pin["motion"] = {"recording": {"file": cache, "mesh": mesh, "fps": fps}}
    return text + files.table("[body.pin]", pin)


def obstacle_text(name, sampled, folder, preroll, fps):
    mesh = name + ".ply"
    files.write_ply(os.path.join(folder, mesh), sampled.rest, sampled.triangles)
    keys = {"name": name, "mesh": mesh, "friction": sampled.ob.aspic.friction}
    if sampled.is_moving:
        files.write_pc2(os.path.join(folder, name + ".pc2"), with_preroll(sampled, preroll))
        keys["recording"] = {"file": name + ".pc2", "fps": fps}
    return files.table("[obstacle]", keys)


def wind_text(winds, preroll, fps):
    """The sum of the winds. Formulas are short, so it is linear between at most 24 frames."""
    velocity = np.sum([wind.frames for wind in winds], axis=0)
    kept = np.unique(np.linspace(0, len(velocity) - 1, 24).round().astype(int))
    time, velocity = (kept + preroll) / fps, velocity[kept]
    bends = np.diff(np.diff(velocity, axis=0) / np.diff(time)[:, None], axis=0, prepend=0)
    terms = [[f"{v:.5g}"] + [f"{b:.5g} * max(0, t - {t:.5g})" for b, t in zip(bent, time) if abs(b) > 1e-6]
             for v, bent in zip(velocity[0], bends.T)]
    return files.table("wind", {"velocity": [" + ".join(t) for t in terms]})


def simulated(scene, *roles):
    return [ob for ob in scene.objects if ob.type == "MESH" and ob.aspic.role in roles and not ob.hide_render]


def write(context):
    """Writes scene.toml and its files. Returns the folder."""
    scene, folder = context.scene, folder_of(context)
    bodies, obstacles = simulated(scene, *sample.SIMULATED), simulated(scene, "OBSTACLE")
    if not bodies:
        raise sample.Refused("no object is a soft body or cloth; select one and choose its role")
    for ob in bodies:
        if ob.library or ob.mode == "EDIT":
            raise sample.Refused(f"{ob.name} is " + ("linked; make it local" if ob.library else "in edit mode; leave it"))
    is_windy = any(ob.aspic.role == "CLOTH" for ob in bodies)
    winds = [sample.Wind(ob) for ob in scene.objects if is_windy and ob.field and ob.field.type == "WIND"]
    sampled = sample.sample(context, bodies + obstacles, winds)
    os.makedirs(folder, exist_ok=True)
    preroll = scene.aspic.preroll if any(s.pin is not None and s.is_posed for s in sampled[:len(bodies)]) else 0
    fps = scene.render.fps / scene.render.fps_base
    steps = scene.frame_end - scene.frame_start + preroll
    gravity = list(scene.gravity) if scene.use_gravity else [0.0, 0.0, 0.0]
    text = "gravity = " + files.toml(gravity) + "\n"
    text += files.table("time", {"step": 1 / (fps * scene.aspic.substeps), "duration": steps / fps})
    text += files.table("output", {"every": 1 / fps, "vtu": False, "usd": False})
    if scene.aspic.collide or any(ob.aspic.role == "CLOTH" for ob in bodies):
        text += "[contact]\n"
    if winds:
        text += wind_text(winds, preroll, fps)
    named = list(zip(names(bodies + obstacles), sampled))
    for name, each in named[:len(bodies)]:
        text += body_text(name, each, folder, preroll, fps)
    for name, each in named[len(bodies):]:
        text += obstacle_text(name, each, folder, preroll, fps)
    with open(os.path.join(folder, "scene.toml"), "w", encoding="utf-8") as file:
        file.write(text)
    write_job(folder, scene, named, preroll)
    return folder


def rebuilds(folder):
    """Commands of the program that fill the rebuilt surfaces of the job, without those of an earlier bake."""
    commands = []
    for body in read_job(folder)["bodies"]:
        path = os.path.join(folder, body["name"])
        if body.get("rebuild") and not os.path.exists(path + ".mesh"):
            commands.append(["mesh", path + ".ply", "--rebuild", "--size", repr(body["size"]), "-o", path + ".mesh",
                             "--quiet"])
    return commands


def fingerprint(sampled):
    """Changes with the rebuilt surface; empty for bodies without one."""
    if sampled.ob.aspic.role != "BODY" or not sampled.ob.aspic.rebuild:
        return ""
    content = sampled.rest.tobytes() + sampled.triangles.tobytes() + repr(sampled.mesh_size()).encode()
    return hashlib.sha256(content).hexdigest()


def write_job(folder, scene, named, preroll):
    """What is needed to read the results later, even in another session."""
    job = {"frame_start": scene.frame_start, "frames": scene.frame_end - scene.frame_start + 1, "preroll": preroll,
           "substeps": scene.aspic.substeps, "unit": scene.unit_settings.scale_length, "bodies": [],
           "objects": {name: each.ob.name for name, each in named}}
    bodies = [(name, each) for name, each in named if each.ob.aspic.role in sample.SIMULATED]
    large = [messages.large(each.ob, each.size(), job["unit"]) for _, each in bodies]
    job["warnings"] = [text for text in large if text]
    earlier = {body["name"]: body.get("rebuild") for body in (read_job(folder) or {"bodies": []})["bodies"]}
    for name, each in bodies:
        rebuild, path = fingerprint(each), os.path.join(folder, name + ".mesh")
        if rebuild != earlier.get(name) and os.path.exists(path):
            os.remove(path)
        np.save(os.path.join(folder, name + ".matrices.npy"), each.matrices)
        job["bodies"].append({"object": each.ob.name, "name": name, "vertices": len(each.rest),
                              "triangles": len(each.triangles), "rebuild": rebuild, "size": each.mesh_size()})
    with open(os.path.join(folder, JOB), "w", encoding="utf-8") as file:
        json.dump(job, file, indent=1)


def read_job(folder):
    """The last bake of a folder, or None."""
    try:
        with open(os.path.join(folder, JOB), encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError):
        return None


def steps_of(job):
    return (job["frames"] - 1 + job["preroll"]) * job["substeps"]

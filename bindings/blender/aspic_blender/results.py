"""Puts the results of a bake on the objects: one mesh cache modifier each."""
import os

import bpy
import numpy as np

from . import export, files, sample


def run_folder(folder):
    return os.path.join(folder, "run")


def steps_done(folder):
    """Complete steps of the run in the folder; -1: there is none."""
    try:
        with open(os.path.join(run_folder(folder), "steps.csv"), "rb") as file:
            return max(0, file.read().count(b"\n") - 2)
    except OSError:
        return -1


def can_continue(folder):
    job = export.read_job(folder)
    return job is not None and 0 <= steps_done(folder) < export.steps_of(job) and not export.rebuilds(folder)


def local_frames(folder, job, body):
    """Frames from the start of the scene, in the space of the object."""
    world = files.read_pc2(os.path.join(run_folder(folder), "skins", f"skin_{body['name']}.pc2"))
    world = world[job["preroll"]:].astype(float) / job["unit"]
    matrices = np.load(os.path.join(folder, body["name"] + ".matrices.npy"))
    return np.array([sample.moved(np.linalg.inv(m), x) for m, x in zip(matrices, world)])


def check_same(ob, body):
    if ob is None or ob.type != "MESH":
        raise sample.Refused(f"{body['object']} is gone; bake again")
    ob.data.calc_loop_triangles()
    if (len(ob.data.vertices), len(ob.data.loop_triangles)) != (body["vertices"], body["triangles"]):
        raise sample.Refused(f"{ob.name} has been edited since the bake; bake again")


def move_modifier(ob, modifier, index):
    """Behind the modifiers that keep the vertices, before the first that generates new ones."""
    if hasattr(ob.modifiers, "move"):
        ob.modifiers.move(list(ob.modifiers).index(modifier), index)
        return
    with bpy.context.temp_override(object=ob, active_object=ob):
        bpy.ops.object.modifier_move_to_index(modifier=modifier.name, index=index)


def add_modifier(ob, path, frame_start):
    cache = ob.modifiers.get(sample.MODIFIER)
    if cache and cache.type != "MESH_CACHE":
        raise sample.Refused(f"{ob.name} has another modifier called {sample.MODIFIER}; rename it")
    cache = cache or ob.modifiers.new(sample.MODIFIER, "MESH_CACHE")
    move_modifier(ob, cache, sample.first_generating(ob))
    cache.cache_format = "PC2"
    cache.filepath = bpy.path.relpath(path) if bpy.data.filepath else path
    cache.frame_start, cache.frame_scale = frame_start, 1
    cache.time_mode, cache.play_mode = "FRAME", "SCENE"
    cache.forward_axis, cache.up_axis, cache.flip_axis = "POS_Y", "POS_Z", set()
    cache.deform_mode, cache.interpolation = "OVERWRITE", "LINEAR"


def apply(folder):
    """Returns the number of frames of the objects."""
    job, frames = export.read_job(folder), 0
    if job is None:
        raise sample.Refused("there is no bake")
    for body in job["bodies"]:
        ob = bpy.data.objects.get(body["object"])
        check_same(ob, body)
        local = local_frames(folder, job, body)
        if not len(local):
            continue  # still in the preroll
        path = os.path.join(folder, body["name"] + ".local.pc2")
        files.write_pc2(path, local)
        add_modifier(ob, path, job["frame_start"])
        frames = len(local)
    return frames


def remove(objects):
    for ob in objects:
        cache = ob.modifiers.get(sample.MODIFIER)
        if cache and cache.type == "MESH_CACHE":
            ob.modifiers.remove(cache)

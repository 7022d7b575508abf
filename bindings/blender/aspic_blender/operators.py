"""Bake, continue, cancel, remove, and open the report."""
import os
import pathlib
import time

import bpy
from bpy.app.handlers import persistent

from . import export, messages, process, results, sample, settings

active = None  # the simulation that runs


def program(context):
    addon = context.preferences.addons.get(__package__)
    return os.environ.get("ASPIC_PROGRAM") or (addon.preferences.program if addon else "aspic")


def stop():
    global active
    if active:
        active.cancel()
        active.wait()
        active = None


@persistent
def stop_before_load(*_):
    stop()


def redraw(status=None):
    for window in bpy.context.window_manager.windows:
        window.workspace.status_text_set(status)
        for area in window.screen.areas:
            area.tag_redraw()


def outcome(run):
    """Applies the results of a run that has ended. Returns kind of report and text."""
    code = run.wait()
    if code not in (process.DONE, process.NOT_CONVERGED, process.INTERRUPTED):
        with open(os.path.join(run.folder, "scene.toml"), encoding="utf-8") as scene:
            text = messages.error_text(run.message(), scene.read(), export.read_job(run.folder).get("objects", {}))
        return "ERROR", text or f"aspic ended with code {code}"
    if run.is_preparing():
        return "WARNING", "Stopped before the first frame"
    try:
        frames = results.apply(run.folder)
    except (sample.Refused, OSError) as error:
        return "ERROR", str(error)
    text = f"{frames} frames"
    count, lines = messages.note_lines(run.lines(), export.read_job(run.folder))
    warnings = f", {count} warning{'s' if count > 1 else ''}:\n" + "\n".join(lines) if count else ""
    if code == process.INTERRUPTED:
        return "WARNING", f"Stopped after {text}; Continue resumes{warnings}"
    if code == process.NOT_CONVERGED:
        return "WARNING", f"{text}; some steps did not converge, see the report{warnings}"
    return "WARNING" if count else "INFO", f"Baked {text}{warnings}"


def show_frames(run):
    """Shows the frames so far, for at most a tenth of the time."""
    start = time.monotonic()
    if run.step == 0 or start < run.next_preview:
        return
    try:
        results.apply(run.folder)
    except (sample.Refused, OSError, ValueError):  # the run has not created its files yet
        return
    run.next_preview = time.monotonic() + 10 * (time.monotonic() - start)


def poll():
    """Called by a timer five times a second."""
    global active
    scene = bpy.context.scene
    if active is None:
        return None
    if active.is_running():
        job = export.read_job(active.folder)
        scene.aspic.status = f"Step {active.step} of {export.steps_of(job)}"
        if active.is_preparing():
            scene.aspic.status = "Rebuilding surfaces"
        scene.aspic.progress = 100 * active.step / max(export.steps_of(job), 1)
        show_frames(active)
        redraw(f"Aspic: {scene.aspic.status}. Esc stops and keeps the frames")
        return 0.2
    _, scene.aspic.status = outcome(active)
    active = None
    redraw()
    return None


def launch(operator, context, folder, arguments, preparation=()):
    """Starts a run after its preparation; without windows, where timers never fire, waits for its end."""
    global active
    context.scene.aspic.status = ""
    try:
        active = process.Run(program(context), folder, arguments, preparation)
    except OSError as error:
        operator.report({"ERROR"}, str(error))
        return {"CANCELLED"}
    if not bpy.app.background:
        for text in export.read_job(folder).get("warnings", []):
            operator.report({"WARNING"}, text)
        bpy.app.timers.register(poll, first_interval=0.2)
        return {"FINISHED"}
    kind, text = outcome(active)
    active = None
    context.scene.aspic.status = text
    operator.report({kind}, text)
    return {"CANCELLED"} if kind == "ERROR" else {"FINISHED"}


class Idle:
    """Operators that need that no simulation runs."""

    @classmethod
    def poll(cls, _context):
        return active is None


class ASPIC_OT_bake(Idle, bpy.types.Operator):
    """Simulate all soft bodies of the scene"""
    bl_idname = "aspic.bake"
    bl_label = "Bake"

    def execute(self, context):
        try:
            folder = export.write(context)
        except (sample.Refused, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        run = results.run_folder(folder)
        arguments = [os.path.join(folder, "scene.toml"), "--out", run, "--force"]
        return launch(self, context, folder, arguments, export.rebuilds(folder))


class ASPIC_OT_continue(Idle, bpy.types.Operator):
    """Continue the bake that was stopped"""
    bl_idname = "aspic.continue_bake"
    bl_label = "Continue"

    @classmethod
    def poll(cls, context):
        return active is None and results.can_continue(export.folder_of(context))

    def execute(self, context):
        folder = export.folder_of(context)
        return launch(self, context, folder, [results.run_folder(folder), "--resume"])


class ASPIC_OT_cancel(bpy.types.Operator):
    """Stop the simulation; its frames are kept"""
    bl_idname = "aspic.cancel"
    bl_label = "Cancel"

    @classmethod
    def poll(cls, _context):
        return active is not None

    def execute(self, _context):
        active.cancel()
        return {"FINISHED"}


class ASPIC_OT_adopt(Idle, bpy.types.Operator):
    """Choose the roles by Blender's cloth, soft body, collision and rigid body physics, and switch its simulation off"""
    bl_idname = "aspic.adopt"
    bl_label = "Use physics of Blender"
    bl_options = {"UNDO"}

    def execute(self, context):
        found = [settings.adopt(ob) for ob in context.scene.objects if ob.type == "MESH" and ob.aspic.role == "NONE"]
        self.report({"INFO"}, f"{sum(found)} objects")
        return {"FINISHED"}


class ASPIC_OT_remove(Idle, bpy.types.Operator):
    """Remove the results from the objects of the scene; the files are kept"""
    bl_idname = "aspic.remove"
    bl_label = "Remove results"
    bl_options = {"UNDO"}

    def execute(self, context):
        results.remove(context.scene.objects)
        return {"FINISHED"}


class ASPIC_OT_report(bpy.types.Operator):
    """Open the report of the last bake in the browser"""
    bl_idname = "aspic.report"
    bl_label = "Open report"

    @staticmethod
    def path(context):
        return os.path.join(results.run_folder(export.folder_of(context)), "report.html")

    @classmethod
    def poll(cls, context):
        return os.path.exists(cls.path(context))

    def execute(self, context):
        bpy.ops.wm.url_open(url=pathlib.Path(self.path(context)).as_uri())
        return {"FINISHED"}


CLASSES = (ASPIC_OT_bake, ASPIC_OT_continue, ASPIC_OT_cancel, ASPIC_OT_adopt, ASPIC_OT_remove, ASPIC_OT_report)

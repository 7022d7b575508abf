"""Soft bodies in Blender, simulated by Aspic: exports scenes, runs `aspic run`, plays the results as mesh caches."""
import bpy

from . import operators, panel, settings

bl_info = {
    "name": "Aspic soft bodies",
    "author": "The Aspic authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Aspic",
    "description": "Bakes soft bodies with the simulator Aspic",
    "category": "Physics",
}

CLASSES = (*settings.CLASSES, *operators.CLASSES, *panel.CLASSES)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.aspic = bpy.props.PointerProperty(type=settings.ObjectSettings)
    bpy.types.Scene.aspic = bpy.props.PointerProperty(type=settings.SceneSettings)
    bpy.app.handlers.load_pre.append(operators.stop_before_load)


def unregister():
    operators.stop()
    bpy.app.handlers.load_pre.remove(operators.stop_before_load)
    del bpy.types.Scene.aspic
    del bpy.types.Object.aspic
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

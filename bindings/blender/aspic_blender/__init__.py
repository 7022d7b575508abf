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

KEYS = []
CLASSES = (*settings.CLASSES, *operators.CLASSES, *panel.CLASSES)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Object.aspic = bpy.props.PointerProperty(type=settings.ObjectSettings)
    bpy.types.Scene.aspic = bpy.props.PointerProperty(type=settings.SceneSettings)
    bpy.app.handlers.load_pre.append(operators.stop_before_load)
    keys = bpy.context.window_manager.keyconfigs.addon
    if keys:
        keymap = keys.keymaps.new(name="Window")
        KEYS.append((keymap, keymap.keymap_items.new("aspic.cancel", "ESC", "PRESS")))


def unregister():
    operators.stop()
    while KEYS:
        keymap, item = KEYS.pop()
        keymap.keymap_items.remove(item)
    bpy.app.handlers.load_pre.remove(operators.stop_before_load)
    del bpy.types.Scene.aspic
    del bpy.types.Object.aspic
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

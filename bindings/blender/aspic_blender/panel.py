"""The panel in the sidebar of the 3D view."""
import textwrap

import bpy

from . import operators


def draw_cloth(layout, ob):
    settings = ob.aspic
    layout.prop(settings, "fabric")
    box = layout.box()
    for name in ("thickness", "stretching", "bending", "areal_density"):
        box.prop(settings, name)
    layout.prop_search(settings, "pin_group", ob, "vertex_groups")
    layout.prop(settings, "friction")


def draw_body(layout, ob):
    settings = ob.aspic
    layout.prop(settings, "preset")
    box = layout.box()
    for name in ("model", "poisson", "density") if settings.stiffness_group else ("model", "young", "poisson", "density"):
        box.prop(settings, name)
    layout.prop_search(settings, "pin_group", ob, "vertex_groups")
    layout.prop_search(settings, "stiffness_group", ob, "vertex_groups")
    if settings.stiffness_group:
        row = layout.row(align=True)
        row.prop(settings, "young_min")
        row.prop(settings, "young_max")
        layout.prop(settings, "scale")
    layout.prop(settings, "resolution")
    layout.prop(settings, "rebuild")
    layout.prop(settings, "friction")


class ASPIC_PT_sidebar(bpy.types.Panel):
    bl_label = "Soft bodies"
    bl_idname = "ASPIC_PT_sidebar"
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Aspic"

    def draw(self, context):
        layout, scene, ob = self.layout, context.scene, context.object
        if ob and ob.type == "MESH":
            layout.prop(ob.aspic, "role", expand=True)
            if ob.aspic.role == "BODY":
                draw_body(layout, ob)
            elif ob.aspic.role == "CLOTH":
                draw_cloth(layout, ob)
            elif ob.aspic.role == "OBSTACLE":
                layout.prop(ob.aspic, "friction")
        layout.separator()
        row = layout.row()
        row.prop(scene, "use_gravity")
        if scene.use_gravity:
            layout.prop(scene, "gravity", text="")
        for name in ("collide", "substeps", "preroll", "folder"):
            layout.prop(scene.aspic, name)
        row = layout.row(align=True)
        row.operator("aspic.cancel" if operators.active else "aspic.bake")
        row.operator("aspic.continue_bake")
        row = layout.row(align=True)
        row.operator("aspic.adopt")
        row.operator("aspic.report")
        row.operator("aspic.remove")
        if operators.active:
            layout.prop(scene.aspic, "progress", slider=True)
        width = max(20, context.region.width // 7) if context.region else 60  # characters
        for line in scene.aspic.status.splitlines():
            for part in textwrap.wrap(line, width):
                layout.label(text=part)


CLASSES = (ASPIC_PT_sidebar,)

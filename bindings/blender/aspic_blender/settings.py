"""Properties of objects, of the scene, and of the add-on."""
import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

PRESETS = {  # identifier: label, model, Young's modulus [Pa], Poisson's ratio, density [kg/m^3]
    "jelly": ("Jelly", "stable_neo_hookean", 5e3, 0.45, 1000),
    "skin": ("Soft tissue", "stable_neo_hookean", 3e4, 0.45, 1050),
    "foam": ("Foam", "neo_hookean", 5e4, 0.2, 60),
    "silicone": ("Silicone", "neo_hookean", 2e5, 0.45, 1100),
    "rubber": ("Rubber", "neo_hookean", 2e6, 0.45, 1100),
}
FABRICS = {  # identifier: label, thickness [m], resistance to stretching [N/m], to bending [N m], mass [kg/m^2]
    "silk": ("Silk", 2e-4, 500, 1e-6, 0.08),
    "cotton": ("Cotton", 5e-4, 1000, 1e-5, 0.15),
    "denim": ("Denim", 1e-3, 3000, 1e-4, 0.4),
    "leather": ("Leather", 2e-3, 1e4, 1e-3, 1.5),
}
MODELS = ("neo_hookean", "stable_neo_hookean", "corotated", "stvk")


def apply_preset(settings, _context):
    _, settings.model, settings.young, settings.poisson, settings.density = PRESETS[settings.preset]


def apply_fabric(settings, _context):
    _, settings.thickness, settings.stretching, settings.bending, settings.areal_density = FABRICS[settings.fabric]


class ObjectSettings(bpy.types.PropertyGroup):
    role: EnumProperty(name="Role", items=[("NONE", "None", "Not simulated"), ("BODY", "Soft body", "Simulated"),
                                           ("CLOTH", "Cloth", "Simulated as a sheet"),
                                           ("OBSTACLE", "Obstacle", "Soft bodies collide with this object")])
    preset: EnumProperty(name="Material", items=[(k, v[0], f"{v[1]}, {v[2]:g} Pa") for k, v in PRESETS.items()],
                         update=apply_preset, description="Sets the values below")
    model: EnumProperty(name="Model", items=[(m, m, "") for m in MODELS], default="stable_neo_hookean")
    young: FloatProperty(name="Stiffness [Pa]", default=5e3, min=1, soft_max=1e8, description="Young's modulus")
    poisson: FloatProperty(name="Poisson's ratio", default=0.45, min=0, max=0.49,
                           description="Resistance to changes of volume; 0.45: nearly incompressible")
    density: FloatProperty(name="Density [kg/m^3]", default=1000, min=1, soft_max=2e4)
    pin_group: StringProperty(name="Pin", description="Vertices with a weight above 0.5 follow the animation")
    stiffness_group: StringProperty(name="Stiffness", description="Weight 0: the minimum; weight 1: the maximum")
    young_min: FloatProperty(name="Minimum [Pa]", default=5e3, min=1, soft_max=1e8)
    young_max: FloatProperty(name="Maximum [Pa]", default=5e5, min=1, soft_max=1e8)
    scale: EnumProperty(name="Scale", items=[("LINEAR", "Linear", "Proportional to the weight"),
                                             ("LOG", "Logarithmic", "Equal factors for equal steps of weight")])
    resolution: FloatProperty(name="Element size", default=1, min=0.2, max=20,
                              description="Edge length of the tets, in median edges of the mesh")
    rebuild: BoolProperty(name="Rebuild surface", default=False,
                          description="Fill a closed surface around the mesh, for meshes with holes or overlaps. The mesh follows it")
    fabric: EnumProperty(name="Fabric", items=[(k, v[0], f"{v[2]:g} N/m, {v[4]:g} kg/m^2") for k, v in FABRICS.items()],
                         update=apply_fabric, default="cotton", description="Sets the values below")
    thickness: FloatProperty(name="Thickness [m]", default=5e-4, min=1e-6, soft_max=0.01, precision=5,
                             description="Surfaces keep half of it from the mesh")
    stretching: FloatProperty(name="Stretching [N/m]", default=1000, min=1e-3, soft_max=1e5, description="Force per width for a stretch of 1")
    bending: FloatProperty(name="Bending [N m]", default=1e-5, min=0, soft_max=0.1, precision=7)
    areal_density: FloatProperty(name="Mass [kg/m^2]", default=0.15, min=1e-3, soft_max=10)
    friction: FloatProperty(name="Friction", default=0.4, min=0, soft_max=1.5, description="Coefficient of friction")


def adopt(ob):
    """Sets the role of an object by its physics in Blender. Returns whether it has any."""
    ours = ob.aspic
    for modifier in ob.modifiers:
        if modifier.type == "CLOTH":
            ours.role, ours.pin_group = "CLOTH", modifier.settings.vertex_group_mass
        elif modifier.type == "SOFT_BODY":
            ours.role, ours.pin_group = "BODY", modifier.settings.vertex_group_goal
        elif modifier.type == "COLLISION" and ours.role == "NONE":
            ours.role = "OBSTACLE"
        if modifier.type in ("CLOTH", "SOFT_BODY"):
            modifier.show_viewport = modifier.show_render = False
    if ob.rigid_body and ours.role == "NONE":
        ours.role, ours.friction = "OBSTACLE", ob.rigid_body.friction
    return ours.role != "NONE"


class SceneSettings(bpy.types.PropertyGroup):
    substeps: IntProperty(name="Steps per frame", default=4, min=1, max=100, description="More for fast contact")
    preroll: IntProperty(name="Preroll", default=12, min=1, max=1000,
                         description="Frames before the start in which pins move from the rest shape to the first "
                         "pose. Not used if they are equal")
    collide: BoolProperty(name="Bodies collide", default=False,
                          description="Soft bodies touch each other and themselves; obstacles switch this on")
    folder: StringProperty(name="Folder", subtype="DIR_PATH", description="Default: beside the .blend file")
    progress: FloatProperty(name="Progress", subtype="PERCENTAGE", max=100, options={"SKIP_SAVE"})
    status: StringProperty(name="Status", options={"SKIP_SAVE"})


class Preferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: StringProperty(name="aspic", subtype="FILE_PATH", default="aspic",
                            description="The program; aspic-mesh lies beside it or on the PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")


CLASSES = (ObjectSettings, SceneSettings, Preferences)

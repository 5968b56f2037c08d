"""Panels in the render properties."""

import bpy

from . import labels
from .export.user_paths import COLLECTION

# Blender's own panels that make no sense here.
OTHERS = {"RENDER_PT_simplify", "RENDER_PT_color_management_curves", "VIEWLAYER_PT_filter",
          "VIEWLAYER_PT_layer_passes"}


class KeyholePanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {"KEYHOLE"}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def column(self):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class KEYHOLE_PT_effort(KeyholePanel, bpy.types.Panel):
    bl_label = "Keyhole"

    def draw(self, context):
        chosen, column = context.scene.keyhole, self.column()
        column.prop(chosen, "method")
        column.row().prop(chosen, "effort", expand=True)
        column.prop(chosen, {"TIME": "time", "QUALITY": "quality", "ERROR": "target_error"}[chosen.effort])
        column.prop(chosen, "denoise")
        column.prop(chosen, "seed")


class KEYHOLE_PT_resources(KeyholePanel, bpy.types.Panel):
    bl_label = "Resources"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        column = self.column()
        for name in ("photon_memory", "threads", "options"):
            column.prop(context.scene.keyhole, name)
        column.operator("keyhole.show_photons")


class KEYHOLE_PT_user_paths(KeyholePanel, bpy.types.Panel):
    bl_label = "User Paths"

    def draw_header(self, context):
        self.layout.prop(context.scene.keyhole, "user_paths", text="")

    def draw(self, context):
        column = self.column()
        row = column.row(align=True)
        row.operator("keyhole.check_paths")
        row.operator("keyhole.suggest_paths")
        paths = bpy.data.collections.get(COLLECTION)
        if paths is None:
            column.label(text=f'Draw curves in a collection "{COLLECTION}"', icon="INFO")
            return
        for curve in paths.all_objects:
            if curve.type == "CURVE":
                check = labels.CHECKED.get(curve.name)
                icon = "OUTLINER_OB_CURVE" if check is None else "CHECKMARK" if check.good else "ERROR"
                column.label(text=curve.name if check is None else f"{curve.name}: {check.text}", icon=icon)
        if context.object and context.object.type == "CURVE":
            column.label(text="Custom properties: bounces, weight, beta", icon="PROPERTIES")


class KEYHOLE_PT_passes(KeyholePanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        column = self.column()
        column.prop(context.scene.keyhole, "noise_passes")
        column.prop(context.view_layer, "use_pass_cryptomatte_object", text="Cryptomatte of objects")
        column.prop(context.view_layer, "use_pass_cryptomatte_material", text="of materials")


CLASSES = KEYHOLE_PT_effort, KEYHOLE_PT_resources, KEYHOLE_PT_user_paths, KEYHOLE_PT_passes


def shared_panels():
    """Blender's own panels for cameras, lamps, materials and the output, which suit any engine."""
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        if "BLENDER_RENDER" in engines and panel.__name__ not in OTHERS:
            yield panel
        elif panel.__name__.startswith(("EEVEE_MATERIAL_PT_surface", "EEVEE_WORLD_PT_surface")):
            yield panel


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    for panel in shared_panels():
        panel.COMPAT_ENGINES.add("KEYHOLE")


def unregister():
    for panel in shared_panels():
        panel.COMPAT_ENGINES.discard("KEYHOLE")
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

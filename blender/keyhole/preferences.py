"""Where the program is."""

import os
import shutil

import bpy


class KeyholePreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    __annotations__ = {  # what Blender makes properties of
        "program": bpy.props.StringProperty(
            name="Program", subtype="FILE_PATH", description="The program keyhole; empty: the one on the PATH"),
    }

    def draw(self, _context):
        self.layout.prop(self, "program")
        try:
            self.layout.label(text=program(), icon="CHECKMARK")
        except FileNotFoundError as e:
            self.layout.label(text=str(e), icon="ERROR")


def program():
    """The path of the program: the preference, else the environment variable KEYHOLE, else what is on the PATH.

    Raises FileNotFoundError, with what was looked for.
    """
    addon = bpy.context.preferences.addons.get(__package__)
    named = bpy.path.abspath(addon.preferences.program) if addon and addon.preferences else ""
    name = named or os.environ.get("KEYHOLE") or "keyhole"
    found = shutil.which(name)
    if found is None:
        raise FileNotFoundError(f"found no program '{name}': set it in Edit > Preferences > Add-ons > Keyhole")
    return found


def register():
    bpy.utils.register_class(KeyholePreferences)


def unregister():
    bpy.utils.unregister_class(KeyholePreferences)

"""Operators of the panels: user paths are checked and suggested, photons shown."""

import os
import re
import subprocess
import tempfile

import bpy

from . import labels, path_files, photons
from .export import scene as scene_export
from .export import user_paths
from .preferences import program

KEEP_PHOTONS = "mps", "ipm", "pm"


class Tool:
    """An operator that exports the scene and runs the program on it."""

    def execute(self, context):
        try:
            with tempfile.TemporaryDirectory(prefix="keyhole-") as folder:
                keyhole = program()
                exported = scene_export.export(context.evaluated_depsgraph_get(), folder)
                return self.use(context, keyhole, exported, folder)
        except (OSError, ValueError) as e:
            self.report({"ERROR"}, str(e))
            return {"CANCELLED"}

    def run(self, *command):
        """What the program prints. Raises ValueError with what it says where it fails."""
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL)
        if done.returncode:
            raise ValueError(done.stderr.strip().replace("keyhole: ", "") or f"keyhole ended with {done.returncode}")
        return done.stdout


WHERE = re.compile(r"^\S+:\d+:\d+: (path '.*', )?")  # in the file that was exported, which is gone


def told_of(paths, table):
    """{name of a path: what the lines of `keyhole paths check` say of it}."""
    said = {}
    for line in table.splitlines()[1:]:
        names = [name for name in paths if line.startswith(name)]
        if names:
            name = max(names, key=len)
            said.setdefault(name, []).append(WHERE.sub("", " ".join(line[len(name):].lstrip(", ").split())))
    return said


class KEYHOLE_OT_check_paths(Tool, bpy.types.Operator):
    bl_idname = "keyhole.check_paths"
    bl_label = "Check"
    bl_description = "Say in the viewport whether light can follow the curves"

    def use(self, context, keyhole, exported, _folder):
        labels.CHECKED.clear()
        if not exported.user_paths:
            raise ValueError(f'found no curves in a collection "{user_paths.COLLECTION}"')
        done = subprocess.run([keyhole, "paths", "check", exported.path, exported.user_paths], capture_output=True,
                              text=True, errors="replace", stdin=subprocess.DEVNULL)
        names = [thing.name for thing in user_paths.find(context.scene) if thing.type == "CURVE"]
        for name, lines in told_of(names, done.stdout).items():
            bad = [line for line in lines if "found" in line]
            labels.CHECKED[name] = labels.Check(not bad, (bad or lines)[0])
            self.report({"WARNING" if bad else "INFO"}, f"{name}: {(bad or lines)[0]}")
        if not labels.CHECKED:
            raise ValueError(done.stderr.strip() or "found no answer of keyhole")
        labels.redraw()
        return {"FINISHED"}


class KEYHOLE_OT_suggest_paths(Tool, bpy.types.Operator):
    bl_idname = "keyhole.suggest_paths"
    bl_label = "Suggest"
    bl_description = "Draw curves through openings that light has to pass, or along bright paths that are hard to find"
    bl_options = {"REGISTER", "UNDO"}

    __annotations__ = {"count": bpy.props.IntProperty(name="Most", default=5, min=1, max=1000)}

    def use(self, context, keyhole, exported, folder):
        file = os.path.join(folder, "suggested.yaml")
        self.run(keyhole, "paths", "suggest", exported.path, "-n", str(self.count), "-o", file)
        with open(file, encoding="utf-8") as text:
            made = path_files.draw(text.read())
        self.report({"INFO"}, f"{len(made)} paths in the collection \"{user_paths.COLLECTION}\"")
        return {"FINISHED"}


class KEYHOLE_OT_show_photons(Tool, bpy.types.Operator):
    bl_idname = "keyhole.show_photons"
    bl_label = "Show Photons"
    bl_description = "Make a mesh of where photons arrive, with the attribute \"power\", whose mean is 1; it is not rendered"
    bl_options = {"REGISTER", "UNDO"}

    __annotations__ = {"count": bpy.props.IntProperty(name="Most", default=20000, min=1, max=10_000_000)}

    def use(self, context, keyhole, exported, folder):
        method = context.scene.keyhole.method
        file = os.path.join(folder, "photons")
        command = [keyhole, "render", exported.path, "-q", "--no-png", "-o", os.path.join(folder, "draft.exr"),
                   "--method", method if method in KEEP_PHOTONS else "ipm", "--quality", "draft", "--spp", "1",
                   "--photons", str(self.count), "-D", "plan=all", "--seed", str(context.scene.keyhole.seed), "--save-map", file]
        if exported.user_paths:
            command += ["--user-paths", exported.user_paths, "--skip-bad-paths"]
        self.run(*command)
        thing = photons.show(file, self.count)
        self.report({"INFO"}, f"{len(thing.data.vertices)} photons")
        return {"FINISHED"}


CLASSES = KEYHOLE_OT_check_paths, KEYHOLE_OT_suggest_paths, KEYHOLE_OT_show_photons


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

"""The render engine: what Blender calls for F12 and for animations."""

import os
import tempfile
import time

import bpy

from . import exr, passes, settings
from .export import scene as scene_export
from .live import LiveView
from .preferences import program
from .process import Run

POLL = 0.1  # seconds
PAUSE = 100  # times as long as a picture takes to be shown before the next: the render needs the time


class KeyholeEngine(bpy.types.RenderEngine):
    bl_idname = "KEYHOLE"
    bl_label = "Keyhole"
    bl_use_eevee_viewport = True  # the viewport's material preview is Eevee's
    bl_use_postprocess = True

    def update_render_passes(self, scene=None, renderlayer=None):
        passes.register_all(self, scene, renderlayer)

    def render(self, depsgraph):
        try:
            with tempfile.TemporaryDirectory(prefix="keyhole-") as folder:
                self.render_in(os.environ.get("KEYHOLE_FOLDER") or folder, depsgraph)
        except (OSError, ValueError) as e:
            self.fail(str(e))

    def fail(self, text):
        """Ends the render with an error that Blender shows."""
        self.end_result(self.begin_result(0, 0, 1, 1))  # Blender 3.4 crashes where it is to write what has no layers
        self.error_set(text)
        print("keyhole: error:", text)

    def warn(self, text):
        self.report({"WARNING"}, text)
        print("keyhole: warning:", text)

    def render_in(self, folder, depsgraph):
        keyhole = program()
        self.update_stats("Keyhole", "Exporting")
        exported = scene_export.export(depsgraph, folder)
        for line in exported.messages.lines:
            self.warn(line)
        chosen = depsgraph.scene.keyhole
        output = os.path.join(folder, "picture.exr")
        shown = os.path.join(folder, "shown.exr")  # how Blender takes pictures in
        live = LiveView()
        command = [keyhole, "render", exported.path, "-o", output, "--no-png", "--display-server", live.address,
                   *settings.arguments(chosen)]
        if exported.user_paths:
            command += ["--user-paths", exported.user_paths, "--skip-bad-paths"]
        layer = depsgraph.view_layer
        if any(passes.mattes(layer)):
            command += ["-D", "cryptomatte=true"]
        passes.add_all(self, depsgraph.scene, layer)
        run = Run(command)
        self.follow(run, live, layer, chosen.time if chosen.effort == "TIME" else None, shown)
        live.close()
        self.finish(run, depsgraph.scene, layer, output, shown)

    def follow(self, run, live, layer, seconds, shown):
        """Until the program has ended: progress, pictures, cancelling."""
        start, told, next_picture = time.monotonic(), None, 0.0
        while run.running():
            if self.test_break():
                run.cancel()
            share, line = run.progress()
            if seconds:
                share = min(1, (time.monotonic() - start) / seconds)
            if told != (news := (line, round(share or 0, 2))):  # drawing costs time that the render could have
                told = news
                self.update_progress(share or 0)
                self.update_stats("Keyhole", line)
            begin = time.monotonic()
            if begin >= next_picture and (picture := live.take()) is not None:
                passes.put_picture(self, layer, picture, shown)
                next_picture = begin + PAUSE * (time.monotonic() - begin)
            time.sleep(POLL)

    def finish(self, run, scene, layer, output, shown):
        code = run.finish()
        for line in run.warnings():
            self.warn(line)
        if os.path.exists(output):
            passes.put(self, scene, layer, exr.read(output), passes.manifests(output, layer), shown)
        elif run.interrupted is None:
            self.fail("\n".join(run.errors()) or f"keyhole ended with code {code}")


def register():
    bpy.utils.register_class(KeyholeEngine)


def unregister():
    bpy.utils.unregister_class(KeyholeEngine)

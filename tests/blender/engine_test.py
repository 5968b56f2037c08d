"""The engine: passes, cancelling, a program that isn't there or fails, user paths, settings."""

import os
import time

import bpy

from harness import floor, lamp, render, test
from keyhole import engine, process, settings


@test
def a_missing_program_is_an_error():
    floor()
    kept, os.environ["KEYHOLE"] = os.environ["KEYHOLE"], "/nowhere/keyhole"
    try:
        render_fails_with("found no program '/nowhere/keyhole'")
    finally:
        os.environ["KEYHOLE"] = kept


def render_fails_with(text, options=""):
    try:
        _, messages = render("KEYHOLE", options)
    except RuntimeError as e:  # how Blender hands on an engine's error
        messages = [str(e)]
    assert any(text in line for line in messages), messages


@test
def what_the_program_refuses_is_an_error():
    floor()
    render_fails_with("nonsense", "-D nonsense=1")


@test
def no_camera_is_an_error():
    bpy.context.scene.collection.objects.unlink(bpy.context.scene.camera)
    bpy.context.scene.camera = None
    floor()
    run = engine.scene_export.export
    try:
        run(bpy.context.evaluated_depsgraph_get(), bpy.app.tempdir)
    except ValueError as e:
        assert "camera" in str(e)
    else:
        raise AssertionError("found no error")


@test
def cancelled_within_a_second():
    """What the engine does while it waits, with somebody who presses Escape after half a second."""
    floor()
    lamp("AREA")
    exported = engine.scene_export.export(bpy.context.evaluated_depsgraph_get(), bpy.app.tempdir)
    picture = os.path.join(bpy.app.tempdir, "cancelled.exr")
    run = process.Run([os.environ["KEYHOLE"], "render", exported.path, "-o", picture, "--no-png", "--method", "path",
                       "--spp", "1M"])
    start = time.monotonic()

    class Waiting:
        test_break = staticmethod(lambda: time.monotonic() > start + 0.5)
        update_progress = update_stats = staticmethod(lambda *_: None)

    class NoPictures:
        take = staticmethod(lambda: None)

    engine.KeyholeEngine.follow(Waiting, run, NoPictures, None, None, "")
    assert 0.5 < time.monotonic() - start < 1.5
    assert run.finish() != 0 and os.path.exists(picture), "a picture of what there was"


@test
def a_program_that_does_not_stop_is_killed():
    run = process.Run(["sh", "-c", "trap '' INT; while true; do sleep 0.1; done"])
    time.sleep(0.3)
    start = time.monotonic()
    while run.running():
        run.cancel()
        time.sleep(0.05)
    assert time.monotonic() - start < 1.5


@test
def settings_become_options():
    chosen = bpy.context.scene.keyhole
    chosen.method, chosen.effort, chosen.time, chosen.photon_memory, chosen.seed = "mps", "TIME", 12.5, 64, 7
    assert settings.arguments(chosen) == ["--method", "mps", "--seed", "7", "-t", "0", "--timeout", "12.5",
                                          "--photon-memory", "64MiB", "--denoise", "exr"]
    chosen.effort, chosen.target_error = "ERROR", 0.05
    assert "--target-error" in settings.arguments(chosen)
    chosen.denoise, chosen.noise_passes = False, True
    assert settings.arguments(chosen)[-4:] == ["--denoise", "off", "-D", "noise_layers=true"]

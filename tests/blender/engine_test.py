"""The engine: passes, cancelling, a program that isn't there or fails, user paths, settings."""

import os
import time

import bpy
import numpy as np

from harness import diffuse, empty_scene, expect, floor, lamp, of_operator, render, add, sky, test
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

    engine.KeyholeEngine.follow(Waiting, run, NoPictures, "", None)
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
                                          "--photon-memory", "64MiB"]
    chosen.effort, chosen.target_error = "ERROR", 0.05
    assert "--target-error" in settings.arguments(chosen)


def two_rooms():
    """A lamp behind a wall with a door, a user path drawn through it, and another one that leads nowhere."""
    sky(0)
    floor()
    wall = diffuse("Wall", (0.7, 0.7, 0.7))
    for x in (-2.6, 2.6):
        of_operator(bpy.ops.mesh.primitive_cube_add, wall, location=(x, 0, 1.5)).scale = 2, 0.05, 1.5
    of_operator(bpy.ops.mesh.primitive_cube_add, wall, location=(0, 4, 1.5)).scale = 4, 0.05, 1.5
    lamp("AREA", (2, 2, 2.9), size=0.5, energy=200)
    collection = bpy.data.collections.new("Keyhole Paths")
    bpy.context.scene.collection.children.link(collection)
    door = of_operator(bpy.ops.mesh.primitive_plane_add, size=1, location=(0, 0, 1.5), rotation=(1.5708, 0, 0))
    door.scale = 1.2, 3, 1
    through = curve("Through the door", [(2, 2, 2.9), (0, 0, 1.5), (-1, -2, 0)])
    through["bounces"] = [1, 2]
    bad = curve("From no lamp", [(-3, -3, 1), (2, -2, 0)])
    bad["tolerance"] = 0.01
    for thing in (door, through, bad):
        for owner in list(thing.users_collection):
            owner.objects.unlink(thing)
        collection.objects.link(thing)
    bpy.context.view_layer.update()


def curve(name, points):
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    spline = data.splines.new("POLY")
    spline.points.add(len(points) - 1)
    for point, place in zip(spline.points, points):
        point.co = (*place, 1)
    return add(name, data)


@test
def user_paths_are_used_and_bad_ones_left_out():
    two_rooms()
    with_paths, messages = render("KEYHOLE", "--spp 16 --photons 20k", method="ipm")
    bpy.context.scene.keyhole.user_paths = False
    without, nothing = render("KEYHOLE", "--spp 16 --photons 20k", method="ipm")
    expect(nothing, [])
    expect(messages, ["'From no lamp'"])
    assert not np.array_equal(with_paths["R"], without["R"])
    bright, reference = with_paths["R"].mean(), without["R"].mean()
    assert abs(bright / reference - 1) < 0.1, (bright, reference)
    empty_scene()

"""User paths: drawn, checked, suggested; photons shown."""

import bpy
import numpy as np

from harness import add, diffuse, empty_scene, expect, floor, lamp, of_operator, render, sky, test
from keyhole import labels, path_files, photons
from keyhole.export import user_paths


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


def messages_of(operator, **options):
    """What an operator says, where it is done."""
    assert operator(**options) == {"FINISHED"}


@test
def check_tells_good_paths_from_bad_ones():
    two_rooms()
    messages_of(bpy.ops.keyhole.check_paths)
    assert set(labels.CHECKED) == {"Through the door", "From no lamp"}, labels.CHECKED
    good, bad = labels.CHECKED["Through the door"], labels.CHECKED["From no lamp"]
    assert good.good and "L * D" in good.text, good
    assert not bad.good and bad.text.startswith("point 1: found the nearest emitter"), bad


@test
def a_check_without_paths_is_an_error():
    floor()
    try:
        bpy.ops.keyhole.check_paths()
    except RuntimeError as e:
        assert "found no curves" in str(e)
    else:
        raise AssertionError("found no error")


SUGGESTED = """# User paths
paths:
  - name: 'it''s 1'
    weight: 0.5
    beta: [12, 30]
    points:
      - [2, 2, 2.9]
      - bounces: [1, 2]
      - through: {corner: [-0.6, 0, 0], u: [1.2, 0, 0], v: [0, 0, 3]}
      - [-1, -2, 0]
  - name: '2'
    points:
      - [2, 2, 2.9]
      - [0, -1, 0]
"""


@test
def suggested_paths_become_curves():
    """And those the same paths again, through the same opening."""
    made = path_files.draw(SUGGESTED)
    assert [thing.name for thing in made] == ["it's 1", "2"]
    assert list(made[0]["bounces"]) == [1, 2] and made[0]["weight"] == 0.5
    bpy.context.view_layer.update()
    things = user_paths.find(bpy.context.scene)
    holes = [hole for hole in map(user_paths.opening, things) if hole]
    entries = user_paths.path_points(bpy.context.evaluated_depsgraph_get(),
                                     user_paths.points_of(made[0], made[0].data.splines[0]), holes, set(), [1, 2])
    assert entries[1] == {"bounces": [1, 2]} and len(entries) == 4
    hole = entries[2]["through"]
    assert np.allclose([hole["corner"], hole["u"], hole["v"]], [(-0.6, 0, 0), (1.2, 0, 0), (0, 0, 3)], atol=1e-6)


def box():
    """A closed room with a wall across it, which has a door."""
    sky(0)
    white = diffuse("White", (0.7, 0.7, 0.7))
    of_operator(bpy.ops.mesh.primitive_cube_add, white, location=(0, 0, 1.5)).scale = 4, 8, 1.5
    for x in (-2.15, 2.15):
        of_operator(bpy.ops.mesh.primitive_cube_add, white, location=(x, 0, 1.5)).scale = 1.85, 0.05, 1.5
    lamp("AREA", (2, 4, 2.9), size=0.5, energy=200)


@test
def suggest_finds_the_door():
    box()
    messages_of(bpy.ops.keyhole.suggest_paths, count=3)
    things = user_paths.find(bpy.context.scene)
    curves = [thing for thing in things if thing.type == "CURVE"]
    assert curves
    holes = [hole for hole in map(user_paths.opening, things) if hole]
    assert any(np.allclose([hole[0].y, (hole[0] + hole[1] + hole[2]).y], 0, atol=0.1) for hole in holes), holes
    bpy.context.view_layer.update()
    messages_of(bpy.ops.keyhole.check_paths)
    assert any(check.good for check in labels.CHECKED.values()), labels.CHECKED


@test
def photons_are_shown_as_points():
    box()
    messages_of(bpy.ops.keyhole.show_photons, count=500)
    mesh = bpy.data.objects[photons.NAME].data
    assert 100 < len(mesh.vertices) <= 500, len(mesh.vertices)
    x, y, z = np.array([v.co for v in mesh.vertices]).T
    assert abs(x).max() < 4.01 and abs(y).max() < 8.01 and -0.01 < z.min(), (x.min(), x.max(), y.min(), z.min())
    assert 1 < z.max() < 3.01, z.max()
    powers = np.empty(4 * len(mesh.vertices), np.float32)
    mesh.attributes["power"].data.foreach_get("color", powers)
    total = powers.reshape(-1, 4)[:, :3].sum() / 3
    assert 0.8 < total / len(mesh.vertices) < 1.2, total
    _, messages = render("KEYHOLE", samples=1)
    assert not any(photons.NAME in line for line in messages), messages

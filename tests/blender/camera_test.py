"""Cameras, and which part of the picture is rendered."""

import math

import bpy

from harness import agree, ball, expect, floor, lamp, render, test


def set_up():
    floor()
    ball()
    ball(place=(-1.5, 2, 0.5))
    lamp("AREA", size=2)
    return bpy.context.scene.camera


@test
def roll_and_lens():
    camera = set_up()
    camera.rotation_euler = math.radians(65), math.radians(20), math.radians(5)
    camera.data.lens = 28
    return agree()


@test
def fit_vertical():
    data = set_up().data
    data.sensor_fit, data.sensor_height = "VERTICAL", 30
    return agree()


@test
def upright_picture_with_shift():
    data, output = set_up().data, bpy.context.scene.render
    output.resolution_x, output.resolution_y = 48, 64
    data.shift_x, data.shift_y = 0.1, -0.2
    return agree()


@test
def wide_picture_with_shift():
    data = set_up().data
    data.shift_x, data.shift_y = -0.15, 0.1
    return agree()


@test
def depth_of_field():
    camera = set_up()
    camera.data.dof.use_dof, camera.data.dof.aperture_fstop = True, 0.1
    camera.data.dof.focus_object = bpy.data.objects["Sphere.001"]
    return agree()


@test
def border():
    set_up()
    output = bpy.context.scene.render
    output.resolution_percentage = 150
    output.use_border, output.use_crop_to_border = True, True
    output.border_min_x, output.border_max_x, output.border_min_y, output.border_max_y = 0.3, 0.8, 0.25, 0.9
    return agree()


@test
def orthographic():
    data = set_up().data
    data.type, data.ortho_scale = "ORTHO", 5
    return agree()


@test
def orthographic_upright_with_shift():
    data, output = set_up().data, bpy.context.scene.render
    output.resolution_x, output.resolution_y = 48, 64
    data.type, data.ortho_scale, data.shift_x, data.shift_y = "ORTHO", 4, 0.1, -0.2
    return agree()


@test
def orthographic_depth_of_field():
    camera = set_up()
    camera.data.type, camera.data.ortho_scale = "ORTHO", 5
    camera.data.dof.use_dof, camera.data.dof.aperture_fstop = True, 2
    camera.data.dof.focus_object = bpy.data.objects["Sphere.001"]
    return agree()


@test
def panoramic_is_reported():
    data = set_up().data
    data.type = "PANO"
    expect(render("KEYHOLE", samples=1)[1], ["Camera: a camera of type PANO"])

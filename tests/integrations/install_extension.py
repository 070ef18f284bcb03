"""Installs the add-on as an extension of Blender 4.2 or later and bakes a room with it: `-- COMMAND INTERFLECT.zip`."""

import os
import sys

import bpy

NAME = "bl_ext.user_default.interflect"

command, archive = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.extensions.package_install_files(filepath=archive, repo="user_default", enable_on_install=True)
bpy.context.preferences.addons[NAME].preferences.command = command
bpy.ops.mesh.primitive_plane_add(size=4)
lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
lamp.location, lamp.data.energy = (0, 0, 1), 100
bpy.context.collection.objects.link(lamp)
bpy.context.scene.interflect.rays = 0.1
assert bpy.ops.interflect.bake() == {"FINISHED"}
assert bpy.data.collections["Interflect"].objects
os._exit(0)  # the package bpy 4.2 crashes when Python ends with an extension
